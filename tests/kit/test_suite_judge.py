"""The kit passes the right program, shows where a wrong one differs, and judges only what it observed."""

from __future__ import annotations

import ast
import json
import sys
from pathlib import Path

import pytest

import modeproof.kit
import modeproof.kit.adapter as adapter_of_the_kit
from modeproof.kit.adapter import Adapter, split_command
from modeproof.kit.errors import Unjudged
from modeproof.kit.suite_judge import Verdict, run_suite
from modeproof.kit.text import as_record, as_text, write_json
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.programs import IMPATIENT_S, MADE, PATIENT_S, program, starter


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    path = tmp_path / "vectors" / "tour.jsonl"
    write_suite(path, "tour", [lamp_graph(tmp_path)], citations=lambda step: ((f"TOY-{step}",), ()))
    return open_suite(path)


def judged(suite: Suite, folder: Path, fault: str = "", hangs_at: int | None = None) -> Verdict:
    verdict = run_suite(suite, starter(folder, fault, hangs_at))
    assert MADE[-1].process.poll() is not None, "the adapter was not ended"
    return verdict


def test_the_right_program_conforms(suite: Suite, tmp_path: Path) -> None:
    verdict = judged(suite, tmp_path)
    assert (verdict.word, verdict.status, verdict.reason) == ("CONFORMS", 0, "")
    assert verdict.cases == suite.case_count and verdict.scans == suite.scan_count
    assert verdict.covered and all(have == total > 0 for have, total in verdict.covered.values())
    assert as_text(verdict).endswith("CONFORMS(exact, tour)")


def test_the_list_form_judges_alike(suite: Suite, tmp_path: Path) -> None:
    lists = 'HELLO["scans"] = True\ndef answer(m, out): sys.exit("a single scan was sent")'
    assert judged(suite, tmp_path, lists).word == "CONFORMS"
    assert judged(suite, tmp_path, lists + "\nLIMIT = 501").word == "DIFFERS"


def test_a_wrong_program_differs_with_scan_step_clauses_and_way(suite: Suite, tmp_path: Path) -> None:
    verdict = judged(suite, tmp_path, "LIMIT = 501")
    assert (verdict.word, verdict.status) == ("DIFFERS", 1)
    found = verdict.difference
    assert found is not None and found.step == "Expire" and found.clauses == ("TOY-Expire",)
    assert dict(found.expected) == {"LAMP": False, "MW": "0000"} and found.got["LAMP"] is True
    assert len(found.shortest.scans) in (2, 3) and found.confirmed
    where = f"case {found.case.id}, scan {found.scan} (Expire): "
    assert verdict.reason == where + 'LAMP is true, expected false; MW is "0FF0", expected "0000"'
    text = as_text(verdict, "the command")
    assert text.endswith(f"DIFFERS: {verdict.reason}")
    for said in (found.case.id, "expected", "TOY-Expire", "again:   the command", "shortest way there"):
        assert said in text
    again = run_suite(suite, starter(tmp_path, "LIMIT = 501"), only=found.case.id)
    assert again.difference is not None and again.difference.scan == found.scan
    record = json.loads(json.dumps(as_record(verdict)))
    assert record["difference"]["shortest"]["scans"][-1]["in"].keys() == suite.inputs.keys()


def test_only_what_differs_is_shown(suite: Suite, tmp_path: Path) -> None:
    fault = 'def answer(m, out): say({"out": {**out, "MW": "0000"}})'
    found = judged(suite, tmp_path, fault).difference
    assert found is not None and dict(found.expected) == {"MW": "0FF0"} and dict(found.got) == {"MW": "0000"}


def test_unobserved_outputs_are_named_and_never_compared(suite: Suite, tmp_path: Path) -> None:
    fault = 'HELLO["unobserved"] = ["MW"]\ndef answer(m, out): say({"out": {"LAMP": out["LAMP"]}})'
    verdict = judged(suite, tmp_path, fault)
    assert verdict.word == "CONFORMS" and verdict.unobserved == ("MW",)
    assert "not observed, so not judged: MW" in as_text(verdict)
    assert judged(suite, tmp_path, 'HELLO["unobserved"] = ["MW", "LAMP"]').word == "UNJUDGED"
    assert judged(suite, tmp_path, 'HELLO["unobserved"] = ["MX"]').word == "UNJUDGED"


LATER = "def answer(m, out):\n    if scans < 3: return say({'out': out})\n    "
THIRD_SCAN = 5
"""The number of its request, after hello, reset and two scans."""


@pytest.fixture
def unhurried(monkeypatch: pytest.MonkeyPatch) -> None:
    """An adapter has the time it needs to end, and to say one thing more."""
    monkeypatch.setattr(adapter_of_the_kit, "ENDING_S", PATIENT_S)
    monkeypatch.setattr(adapter_of_the_kit, "GRACE_S", PATIENT_S)


MISBEHAVIOURS = {
    "hangs": ("time.sleep(600)", "no answer within"),
    "dies": ("sys.exit(3)", "ended with status 3"),
    "dies with a word": ("sys.exit('battery is flat')", "battery is flat"),
    "says garbage": ("say('hello world\\n')", "not a line of JSON"),
    "prints a banner first": ("say('lamp v1\\n'); say({'out': out})", "lamp v1"),
    "answers NaN": ('say(\'{"out":{"LAMP":NaN,"MW":"0000"}}\\n\')', "NaN"),
    "answers a list": ("say('[]\\n')", "not a JSON object"),
    "answers a deep list": ("say('[' * 200000 + '\\n')", "not a line of JSON"),
    "answers a key twice": ('say(\'{"out":{},"out":{}}\\n\')', "a key twice"),
    "answers a line without end": ("[sys.stdout.write('x' * 1000000) for _ in range(100)]", "longer than"),
    "closes its output": ("import os; os.close(1); time.sleep(600)", "closed its output"),
    "refuses": ("say({'error': 'no such word'})", 'refused: "no such word"'),
    "leaves an output out": ("say({'out': {'LAMP': False}})", "output MW is missing"),
    "adds an output": ("say({'out': {**out, 'X': 1}})", "'X' that the target does not have"),
    "adds a field": ("say({'out': out, 'x': 1})", "expected, got"),
    "gives 0 for false": ("say({'out': {**out, 'LAMP': 0}})", "true or false expected, got 0"),
    "gives a number for a word": ("say({'out': {**out, 'MW': 0}})", "four upper-case hex digits"),
    "gives a lower-case word": ("say({'out': {**out, 'MW': '0ff0'}})", "four upper-case hex digits"),
    "gives bytes that are no text": (
        "sys.stdout.buffer.write(b'\\xff\\xfe\\n'); sys.stdout.flush()",
        "not a line",
    ),
}


@pytest.mark.parametrize("name", MISBEHAVIOURS)
def test_an_adapter_that(name: str, suite: Suite, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    code, said = MISBEHAVIOURS[name]
    if name.startswith("dies"):
        request.getfixturevalue("unhurried")
    verdict = judged(suite, tmp_path, LATER + code, THIRD_SCAN if name == "hangs" else None)
    assert (verdict.word, verdict.status, verdict.difference) == ("UNJUDGED", 2, None)
    assert said in verdict.reason and "\n" not in verdict.reason
    assert "scan 3" in verdict.reason or "scan 4" in verdict.reason
    assert verdict.scans in (2, 3), "results so far are kept"


@pytest.mark.usefixtures("unhurried")
def test_an_answer_too_many_is_no_difference(suite: Suite, tmp_path: Path) -> None:
    late = (
        "def answer(m, out):\n    say({'out': out})\n    if scans == 3: time.sleep(0.05); say({'out': out})"
    )
    verdict = judged(suite, tmp_path, late)
    assert verdict.word == "UNJUDGED" and verdict.difference is None


@pytest.mark.usefixtures("unhurried")
def test_an_adapter_that_always_answers_twice_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    verdict = judged(suite, tmp_path, LATER + "say({'out': out}); say({'out': out})")
    assert verdict.word == "UNJUDGED" and verdict.difference is None


def test_a_late_answer_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    late = LATER + "sys.stdin.readline(); say({'out': out})"
    assert f"no answer within {IMPATIENT_S} s" in judged(suite, tmp_path, late, THIRD_SCAN).reason


@pytest.mark.usefixtures("unhurried")
def test_an_extra_line_after_the_end_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    verdict = judged(suite, tmp_path, "import atexit\natexit.register(lambda: say('bye bye\\n'))")
    assert verdict.word == "UNJUDGED" and "bye: a line that nobody asked for" in verdict.reason


@pytest.mark.parametrize(
    ("hello", "said"),
    [
        ('HELLO["ok"] = False', "hello was answered with"),
        ('HELLO["ok"] = 1', "hello was answered with"),
        ('HELLO["relations"] = ["settled"]', "does not offer relation exact"),
        ('HELLO["time"] = "real"', "needs virtual time"),
        ('HELLO["max_latency_scans"] = 2', "allows no latency"),
        ('HELLO["scans"] = "yes"', "true or false"),
        ("def greet(): sys.exit(1)", "hello: the adapter ended with status 1"),
        ("def greet(): time.sleep(600)", "hello: no answer within"),
        ("def greet(): say('Welcome!\\n'); say(HELLO)", "not a line of JSON"),
    ],
)
def test_a_hello_that_does_not_fit_is_unjudged(
    suite: Suite, tmp_path: Path, hello: str, said: str, request: pytest.FixtureRequest
) -> None:
    if "exit" in hello:
        request.getfixturevalue("unhurried")
    verdict = judged(suite, tmp_path, hello, 1 if "sleep" in hello else None)
    assert verdict.word == "UNJUDGED" and said in verdict.reason and verdict.cases == 0


def test_a_flood_on_standard_error_does_no_harm(suite: Suite, tmp_path: Path) -> None:
    assert judged(suite, tmp_path, "sys.stderr.write('x' * 3_000_000)").word == "CONFORMS"


def test_an_adapter_that_does_not_read_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    adapter = Adapter([sys.executable, "-c", "import time; time.sleep(600)"], IMPATIENT_S)
    with adapter, pytest.raises(Unjudged, match="was not read within"):
        adapter.ask({"op": "hello", "padding": "x" * 1_000_000})
    assert adapter.process.poll() is not None


def test_children_of_the_adapter_are_ended_too(tmp_path: Path) -> None:
    child = f"import subprocess, sys; subprocess.run([sys.executable, *{program(tmp_path)[1:]!r}])"
    with Adapter([sys.executable, "-c", child], PATIENT_S) as adapter:
        assert b'"ok"' in adapter.ask({"op": "hello"})
    assert adapter.process.poll() is not None
    assert not adapter._listener.is_alive(), "someone still holds the pipe"


def test_a_program_that_is_not_there_is_unjudged(suite: Suite) -> None:
    verdict = run_suite(suite, lambda: Adapter("no_such_program_at_all --x"))
    assert verdict.word == "UNJUDGED" and "cannot be started: no_such_program_at_all" in verdict.reason
    for command in ("", '"open'):
        with pytest.raises(Unjudged):
            Adapter(command)
    assert split_command('"a b" c') == ["a b", "c"]


def test_a_case_that_does_not_exist_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    verdict = run_suite(suite, starter(tmp_path), only="lamp-000000000000")
    assert verdict.word == "UNJUDGED" and verdict.reason.startswith("no case with the id lamp-0000")
    assert "in the suite " in verdict.reason and "allowed: " in verdict.reason


def test_a_suite_without_cases_shows_nothing(suite: Suite) -> None:
    header = {**suite.header, "cases": 0, "scans": 0}
    suite.path.write_text(json.dumps(header) + "\n")
    with pytest.raises(Unjudged, match="no cases"):
        open_suite(suite.path)


def test_a_vector_file_that_was_cut_or_edited_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    lines = suite.path.read_text().splitlines(keepends=True)
    suite.path.write_text("".join(lines[:-1]))
    assert "the header says" in judged(suite, tmp_path).reason
    suite.path.write_text("".join(lines)[:-40])
    assert "not JSON" in judged(suite, tmp_path).reason
    cases = "".join(lines[1:]).replace('"press":true', '"press":false', 1)
    suite.path.write_text(lines[0] + cases)
    assert "was the file edited" in judged(suite, tmp_path).reason


def test_json_is_written_as_a_whole_or_not_at_all(tmp_path: Path) -> None:
    write_json(tmp_path / "v.json", {"a": 1})
    assert json.loads((tmp_path / "v.json").read_text()) == {"a": 1}
    with pytest.raises(Unjudged, match="cannot be written"):
        write_json(tmp_path / "none" / "v.json", {"a": 1})


def test_the_kit_imports_the_standard_library_alone() -> None:
    files = list(Path(modeproof.kit.__file__).parent.glob("*.py"))
    assert len(files) > 5
    for path in files:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [one.name for one in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0
                names = [str(node.module)]
            for name in names:
                own = name == "modeproof.kit" or name.startswith("modeproof.kit.")
                assert own or name.split(".")[0] in sys.stdlib_module_names, f"{path.name}: {name}"
