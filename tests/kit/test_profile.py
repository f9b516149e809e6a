"""A program is judged by the profile that was asked for: the letter, unless another is named."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.errors import Unjudged
from modeproof.kit.profile import ALL, CAUTIOUS, LETTER, of_profile
from modeproof.kit.vectors import Suite, open_suite, read_lines
from modeproof.registers.load import load_interface
from modeproof.registers.profiles import profiles_of
from modeproof.suites.write import write_suite
from refimpl.edm import sf_edm
from tests.graph.printed import lamp_graph

ROOT = Path(__file__).resolve().parents[2]


def suite_of(name: str) -> Suite:
    return open_suite(ROOT / f"vectors/sf_edm/{name}.jsonl.gz")


def conform(name: str, package: str, *more: str) -> list[str]:
    path = str(ROOT / f"vectors/sf_edm/{name}.jsonl.gz")
    return ["conform", "sf_edm", "--builtin", package, "--vectors", path, "--quiet", *more]


@pytest.fixture
def fixed(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """Of each value of AFTER_RESET a package whose block has it, whatever is sent."""

    def put(value: str) -> str:
        def power_up(params: Any) -> Any:
            return sf_edm.power_up(sf_edm.Params(params.MonitoringTime_ms, value))

        names = ("Params", "Inputs", "Outputs", "step")
        module = SimpleNamespace(power_up=power_up, **{name: getattr(sf_edm, name) for name in names})
        monkeypatch.setitem(sys.modules, f"{value}.edm.sf_edm", module)  # type: ignore[arg-type]
        return value

    return {value: put(value) for value in ("at_once", "stop_first")}


@pytest.mark.parametrize("name", ["brief", "sequences", "parameters"])
def test_who_follows_the_page_passes_by_default(
    name: str, fixed: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert kit_main(conform(name, "at_once")) == 0
    assert f"CONFORMS(exact, {name}; profile letter; not compared:" in capsys.readouterr().out
    assert kit_main(conform(name, "stop_first")) == 1, "the old default is not what the page says"
    assert kit_main(conform(name, "stop_first", "--profile", "cautious")) == 0
    assert f"CONFORMS(exact, {name}; profile cautious; not" in capsys.readouterr().out
    assert kit_main(conform(name, "at_once", "--profile", "cautious")) == 1
    again = capsys.readouterr().out
    assert "--profile cautious" in again
    assert kit_main(conform(name, "at_once", "--profile", "all")) == 1
    assert kit_main(conform(name, "refimpl", "--profile", "all")) == 0
    assert "profile" not in capsys.readouterr().out.splitlines()[-1]


def test_the_letter_sends_no_choice_and_the_parts_are_counted() -> None:
    for name in ("brief", "parameters", "sequences"):
        suite = suite_of(name)
        parts = {profile: of_profile(suite, profile) for profile in (LETTER, CAUTIOUS)}
        letter, cautious = parts[LETTER], parts[CAUTIOUS]
        assert letter is not None and cautious is not None and of_profile(suite, ALL) is suite
        sent = [dict(case.params) for case in letter.cases()]
        assert len(sent) == letter.case_count > 0 and not any("AFTER_RESET" in params for params in sent)
        assert all(case.params["AFTER_RESET"] == "stop_first" for case in cautious.cases())
        assert letter.case_count + cautious.case_count == suite.case_count
        assert 0 < sum(step.transitions for step in letter.steps) < sum(s.transitions for s in suite.steps)


def test_the_header_has_the_values_of_the_register() -> None:
    device = load_interface(ROOT, "edm").devices["sf_edm"]
    assert suite_of("brief").header["profiles"] == profiles_of(device)
    assert profiles_of(device) == {
        "letter": {"AFTER_RESET": "at_once"},
        "cautious": {"AFTER_RESET": "stop_first"},
    }


def test_a_case_by_its_id_is_run_whatever_its_profile(
    fixed: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    cautious = of_profile(suite_of("sequences"), CAUTIOUS)
    assert cautious is not None
    case = next(cautious.cases())
    assert kit_main(conform("sequences", "stop_first", "--case", case.id)) == 0
    assert kit_main(conform("sequences", "stop_first", "--case", case.id, "--profile", "letter")) == 2
    assert "no case with the id" in capsys.readouterr().out


def test_a_profile_without_a_case_is_no_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [json.loads(line) for line in read_lines(ROOT / "vectors/sf_edm/brief.jsonl.gz")]
    kept = [row for row in rows[1:] if "AFTER_RESET" not in row["params"]]
    head = {**rows[0], "cases": len(kept), "scans": sum(len(row["scans"]) for row in kept)}
    path = tmp_path / "letter.jsonl"
    path.write_text("".join(f"{json.dumps(row)}\n" for row in (head, *kept)), "utf-8")
    given = ["conform", "sf_edm", "--builtin", "refimpl", "--vectors", str(path), "--profile"]
    assert kit_main([*given, "letter"]) == 0
    assert kit_main([*given, "cautious"]) == 2
    assert "no case of brief is for the profile cautious" in capsys.readouterr().err


@pytest.mark.parametrize("asked", [LETTER, CAUTIOUS])
def test_a_profile_is_refused_where_there_are_none(asked: str, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(ROOT / "vectors/plc/sequences.jsonl.gz")
    given = ["conform", "plc", "--builtin", "refimpl", "--vectors", path, "--quiet", "--profile"]
    assert kit_main([*given, asked]) == 2
    assert f"plc has no profiles, so it has none that is {asked}" in capsys.readouterr().err
    assert kit_main([*given, ALL]) == 0
    assert kit_main([*given, ""]) == 2


@pytest.mark.parametrize("name", ["brief", "parameters", "sequences"])
def test_a_choosing_time_has_its_default_in_the_letter_alone(name: str) -> None:
    suite = open_suite(ROOT / f"vectors/fplc/{name}.jsonl.gz")
    letter, cautious = (of_profile(suite, profile) for profile in (LETTER, CAUTIOUS))
    assert letter is not None and cautious is not None
    choices = {"T_SEQ_FROM", "T_DWELL_ms", "SELECTIONS", "ON_ERROR"}
    assert letter.case_count and not any(choices & case.params.keys() for case in letter.cases())
    times = {case.params["T_DWELL_ms"] for case in cautious.cases()}
    assert min(times) > 0 and (len(times) > 1) == (name == "parameters")


def test_a_target_without_profiles_is_left_whole(tmp_path: Path) -> None:
    write_suite(tmp_path / "s", "brief", [lamp_graph(tmp_path)])
    suite = open_suite(tmp_path / "s")
    assert of_profile(suite, CAUTIOUS) is suite


@pytest.mark.parametrize(
    ("profiles", "said"),
    [({"letter": {}}, "it has no profile cautious"), ({"cautious": {"NONE": 1}}, "no parameter NONE")],
)
def test_a_header_that_says_something_else_is_refused(
    profiles: dict[str, Any], said: str, tmp_path: Path
) -> None:
    path = tmp_path / "s.jsonl"
    write_suite(path, "brief", [lamp_graph(tmp_path)])
    head, _, rest = path.read_text().partition("\n")
    path.write_text(json.dumps({**json.loads(head), "profiles": profiles}) + "\n" + rest)
    with pytest.raises(Unjudged, match=said):
        of_profile(open_suite(path), CAUTIOUS)
