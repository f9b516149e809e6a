"""A block whose interface and memory are structures and arrays, against a target."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from modeproof.cli import main
from programs.equality.binding import read_binding
from programs.equality.comparison import make

EXAMPLE = Path(__file__).parents[3] / "examples" / "st" / "sf_edm.st"
INPUTS = ("Activate", "S_OutControl", "S_EDM1", "S_EDM2", "S_StartReset", "Reset", "MonitoringTime")
OUTPUTS = ("Ready", "S_EDM_Out", "SafetyDemand", "ResetRequest", "Error", "DiagCode")


def written(folder: Path, fault: tuple[str, str] = ("", "")) -> list[str]:
    """The example with its pins in structures and its timer in an array; and the binding."""
    text = EXAMPLE.read_text("utf-8").replace(*fault) if fault[0] else EXAMPLE.read_text("utf-8")
    head, _, rest = text.partition("VAR_INPUT")
    pins, _, body = rest.partition("\nVAR\n")
    assert "VAR_OUTPUT" in pins and "monitor : TON" in body
    body = body.replace("monitor : TON", "monitor : ARRAY [0..1, 3..4] OF TON").replace(
        "monitor(", "monitor[1, 3]("
    )
    body = body.replace("monitor.", "monitor[1, 3].")
    for group, names in (("Cmd", INPUTS), ("Stat.Out", OUTPUTS)):
        for name in names:
            declared, _, code = body.partition("END_VAR")
            body = f"{declared}END_VAR{_renamed(code, name, f'{group}.{name}')}"
    made = (
        "TYPE Demand : STRUCT Activate, S_OutControl, S_EDM1, S_EDM2, S_StartReset, Reset : BOOL; "
        "MonitoringTime : TIME; END_STRUCT; Result : STRUCT Out : STRUCT Ready, S_EDM_Out, SafetyDemand, "
        "ResetRequest, Error : BOOL; DiagCode : WORD; END_STRUCT; END_STRUCT; END_TYPE\n"
        f"{head}VAR_INPUT Cmd : Demand; END_VAR VAR_OUTPUT Stat : Result; END_VAR VAR\n{body}"
    )
    (folder / "edm.st").write_text(made, "utf-8")
    names = [f'{name} = "Cmd.{name}"' for name in INPUTS[:-1]] + ['MonitoringTime_ms = "Cmd.MonitoringTime"']
    names += [f'{name} = "Stat.Out.{name}"' for name in OUTPUTS]
    (folder / "b.toml").write_text("[names]\n" + "\n".join(names) + "\n", "utf-8")
    return [str(folder / "edm.st"), "--target", "sf_edm", "--binding", str(folder / "b.toml")]


def _renamed(code: str, name: str, by: str) -> str:
    import re

    return re.sub(rf"(?<![\w.]){name}\b(?!\s*:(?!=))", by, code)


def test_a_block_of_structures_is_proved_with_its_certificate(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = written(tmp_path)
    kept = tmp_path / "edm.certificate"
    given += ["--codes", "--json", str(tmp_path / "j.json"), "--certificate", str(kept)]
    assert main(["prove-program", *given]) == 0
    assert "PROVED: function block SF_EDM" in capsys.readouterr().out
    record = json.loads((tmp_path / "j.json").read_text("utf-8"))
    assert record["verdict"] == "PROVED" and record["same"]["compared"] == list(OUTPUTS)
    assert main(["prove-program", "--recheck", str(kept)]) == 0


def test_a_fault_in_a_block_of_structures_is_refuted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = written(tmp_path, ("IF S_EDM1 AND S_EDM2 THEN", "IF S_EDM1 THEN"))
    assert main(["prove-program", *given, "--same", "--vector", str(tmp_path / "v.jsonl")]) == 1
    assert "<- differs" in capsys.readouterr().out and (tmp_path / "v.jsonl").is_file()


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ('"Cmd.Reset"', '"Cmd.Rest"', "the binding names 'Cmd.Rest', which is no input"),
        ('"Cmd.Reset"', '"Cmd"', "the program's is no single value"),
        ('Reset = "Cmd.Reset"\n', "", "SF_EDM has no input Reset"),
        ('"Cmd.Reset"', '"Cmd.Activate"', "Activate and Reset are both bound to CMD.ACTIVATE"),
    ],
)
def test_a_binding_to_no_member_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, cause: str
) -> None:
    given = written(tmp_path)
    place = tmp_path / "b.toml"
    text = place.read_text("utf-8")
    assert old in text
    place.write_text(
        text.replace(old, new, 1) if "\n" not in old else text.replace(f"\n{old}", "\n"), "utf-8"
    )
    assert main(["prove-program", *given]) == 2
    assert cause in capsys.readouterr().err


def test_all_names_that_lack_come_with_a_binding(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = EXAMPLE.read_text("utf-8")
    for old, new in (("S_OutControl", "Demand"), ("S_EDM1", "Fb1_EDM"), ("MonitoringTime", "MonTime")):
        text = text.replace(old, new)
    program, binding = tmp_path / "edm.st", tmp_path / "b.toml"
    program.write_text(text, "utf-8")
    assert main(["prove-program", str(program), "--target", "sf_edm"]) == 2
    said = capsys.readouterr().err
    assert "no input S_OutControl, S_EDM1" in said and "has Demand, Fb1_EDM, MonTime" in said
    binding.write_text(said[said.index("names = {") : said.index("}") + 1] + "\n", "utf-8")
    taken = make([program], "sf_edm", None, read_binding(binding), False).binding
    assert taken.free_parameters == ("MonitoringTime_ms",) and len(taken.bound_paths) == 7
