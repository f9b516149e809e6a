"""No verdict says more than was done: what was not judged is no pass, and the word says what was left out."""

from __future__ import annotations

import gzip
import itertools
import json
import shlex
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.suite_judge import Options, Plan, Verdict, run_suite
from modeproof.kit.text import as_junit, as_record, as_text
from modeproof.kit.vectors import Case, Suite, read_lines
from tests.kit.lamps import DEMANDS, Lamp, Slow, SlowAndWrong, made
from tests.kit.programs import program

TWO_RULES = {
    **DEMANDS,
    "demands": [
        *DEMANDS["demands"],  # type: ignore[misc]
        {"id": "Always", "says": "x", "clauses": [], "when": "True", "holds": "True"},
    ],
}


def judged(
    suite: Suite, start: Callable[[], Any], relation: str = "exact", jobs: int = 1, **options: Any
) -> Verdict:
    return run_suite(suite, start, plan=Plan(Options(relation, **options), jobs=jobs))


class Dead(Lamp):
    """Never does anything."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"LAMP": False, "MW": "0000"}


# ------------------------------------------------------------------------------------------------ monitor


def test_a_dead_program_keeps_every_property_and_never_passes(tmp_path: Path) -> None:
    verdict = judged(made(tmp_path, "sic", TWO_RULES), Dead, "monitor")
    assert verdict.word == "UNJUDGED" and verdict.properties["Always"] > 0
    assert "1 of 2 demands were never put" in verdict.reason
    assert verdict.reason.endswith(": LightNeedsCode")


def test_what_a_suite_cannot_put_is_counted_in_the_word(tmp_path: Path) -> None:
    rule = {"id": "Never", "says": "x", "clauses": [], "when": "False", "holds": "True"}
    demands = {**DEMANDS, "demands": [*DEMANDS["demands"], rule]}  # type: ignore[misc]
    text = as_text(judged(made(tmp_path, "sic", demands), Lamp, "monitor"))
    assert text.endswith("FOLLOWS(2 demands, sic; within 1 scan)")


def test_latency_hides_nothing_where_inputs_are_not_held(tmp_path: Path) -> None:
    """In every scan something of the last 500 allows what stands there."""
    verdict = judged(made(tmp_path, "tour"), SlowAndWrong, "monitor", latency=500)
    assert verdict.word == "UNJUDGED" and "use a suite that holds inputs (sic)" in verdict.reason
    assert judged(made(tmp_path, "sic"), SlowAndWrong, "monitor", latency=500).word == "BREAKS"


# ------------------------------------------------------------------------------------------------ outputs


class Half(Lamp):
    """Does not observe LAMP."""

    hello_says = {"unobserved": ["LAMP"]}  # noqa: RUF012

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"MW": out["MW"]}


def test_the_word_counts_the_outputs_that_were_compared(tmp_path: Path) -> None:
    verdict = judged(made(tmp_path, "tour"), Half)
    assert verdict.outputs == (1, 2) and as_record(verdict)["outputs_compared"] == [1, 2]
    text = as_text(verdict)
    assert text.endswith("CONFORMS(exact, tour; 1 of 2 outputs compared; not observed: LAMP)")
    assert "covered in full" not in text
    (junit,) = ElementTree.fromstring(as_junit([verdict]))
    assert junit.find("properties/property").attrib == {"name": "not observed", "value": "LAMP"}  # type: ignore[union-attr]


class Unlike(Suite):
    """The lamp, with a word that never changes: what happens shows in LAMP alone."""

    def cases(self) -> Iterator[Case]:
        for case in super().cases():
            scans = (replace(scan, outputs={**scan.outputs, "MW": "0000"}) for scan in case.scans)
            yield replace(case, scans=tuple(scans))


def test_what_no_observed_output_shows_is_not_covered(tmp_path: Path) -> None:
    suite = made(tmp_path, "tour")
    names = Suite.__dataclass_fields__
    unlike = Unlike(**{name: getattr(suite, name) for name in names})

    class Blind(Half):
        def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
            return {"MW": "0000"}

    verdict = judged(unlike, Blind)
    seen, total = verdict.transitions
    assert verdict.word == "CONFORMS" and 0 < seen < total
    assert verdict.covered["SwitchOn"][0] == 0 if "SwitchOn" in verdict.covered else True
    assert f"{seen} of {total} transitions)" in as_text(verdict)
    assert any(have == 0 for have, _ in verdict.covered.values()), "switching on shows in LAMP alone"
    assert verdict.clauses["TOY-1"][0] == seen


# -------------------------------------------------------------------------------------------------- cases


@pytest.mark.parametrize("broken", [RuntimeError("x"), SystemExit(1), RecursionError(), OSError(28, "full")])
@pytest.mark.parametrize("jobs", [2, 3])
def test_a_worker_that_dies_of_anything_is_no_pass(
    broken: BaseException, jobs: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("threading.excepthook", lambda args: None)
    scans = itertools.count()  # of all workers: which of them gets there first is the machine's choice

    class Dying(Lamp):
        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            if next(scans) == 20:
                raise broken
            return super().scan(dt_ms, inputs)

    verdict = judged(made(tmp_path, "words"), Dying, jobs=jobs)
    assert verdict.word == "UNJUDGED" and verdict.reason and verdict.cases < verdict.cases_total


def test_programs_that_say_different_things_of_themselves_are_unjudged(tmp_path: Path) -> None:
    count: list[int] = []

    class Other(Lamp):
        def hello(self, target: str) -> Mapping[str, Any]:
            count.append(1)
            return {**super().hello(target), "name": f"lamp {len(count)}"}

    verdict = judged(made(tmp_path, "words"), Other, jobs=2)
    assert verdict.word == "UNJUDGED" and "what the others do not" in verdict.reason


def test_fewer_cases_than_planned_are_no_pass(tmp_path: Path) -> None:
    """However they were lost: here the suite itself ends early and says nothing."""
    suite = made(tmp_path, "words")

    class Short(Suite):
        def cases(self) -> Iterator[Case]:
            yield from list(super().cases())[: self.case_count - 1]

    class Empty(Suite):
        def cases(self) -> Iterator[Case]:
            yield from ()

    values = {name: getattr(suite, name) for name in Suite.__dataclass_fields__}
    for kind, said in ((Short, f"of {suite.case_count:,} cases were judged"), (Empty, "0 of ")):
        verdict = judged(kind(**values), Lamp)
        assert verdict.word == "UNJUDGED" and said in verdict.reason


def test_a_file_in_which_every_scan_settles_shows_nothing(tmp_path: Path) -> None:
    suite = made(tmp_path, "sic")

    class Settling(Suite):
        def cases(self) -> Iterator[Case]:
            for case in super().cases():
                yield replace(case, scans=tuple(replace(scan, compared=False) for scan in case.scans))

    values = {name: getattr(suite, name) for name in Suite.__dataclass_fields__}
    verdict = judged(Settling(**values), Dead)
    assert verdict.word == "UNJUDGED" and "no output was compared" in verdict.reason


def test_a_part_of_a_case_gets_its_own_word(tmp_path: Path) -> None:
    suite = made(tmp_path, "tour")
    case = next(iter(suite.cases()))
    for part, said in ((None, f"case {case.id} of tour"), ("1", f"scans 1 of case {case.id} of tour")):
        verdict = run_suite(suite, Lamp, plan=Plan(only=case.id, part=part))
        assert verdict.word == "CONFORMS" and as_record(verdict)["only"] == said.removesuffix(" of tour")
        assert as_text(verdict).splitlines()[-1].startswith(f"CONFORMS(exact, {said}")


# ------------------------------------------------------------------------------------------------ settled


class Late(Slow):
    """Settles well, and in the first scan of each change of inputs shows what belongs nowhere."""

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        changed, self.before = inputs != getattr(self, "before", None), inputs
        out = super().scan(dt_ms, inputs)
        return {**out, "MW": "FFFF"} if changed else out


class Restless(Lamp):
    """Right in the last scan that is asked for, and wrong in the one before, where it should stand."""

    delay = 3
    hold = 3 + 2

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.held = 0 if inputs != getattr(self, "before", None) else getattr(self, "held", 0) + 1
        self.before = inputs
        out = super().scan(dt_ms, inputs)
        wrong = {"LAMP": not out["LAMP"], "MW": "0000" if out["LAMP"] else "0FF0"}
        return wrong if self.held == self.hold - 1 and self.was_on(out) else out

    def was_on(self, out: Mapping[str, Any]) -> bool:
        return bool(out["LAMP"])


def test_settled_judges_the_first_scan_of_a_change_too(tmp_path: Path) -> None:
    verdict = judged(made(tmp_path, "sic"), Late, "settled")
    assert verdict.word == "DIFFERS"
    assert verdict.difference is not None and dict(verdict.difference.got) == {"MW": "FFFF"}


def test_settled_outputs_must_stand_not_just_end_well(tmp_path: Path) -> None:
    assert judged(made(tmp_path, "sic"), Slow, "settled").word == "CONFORMS"
    verdict = judged(made(tmp_path, "sic"), Restless, "settled")
    assert verdict.difference is not None and "not what it settles to" in verdict.difference.when


# ------------------------------------------------------------------------------------------------- resume


def words(folder: Path, suite: Suite, *more: str) -> list[str]:
    command = shlex.join(program(folder))
    note = ["--resume", str(folder / "note.json")]
    return ["conform", "lamp", "--adapter", command, "--vectors", str(suite.path), "--quiet", *note, *more]


def shortened(folder: Path) -> None:
    """As if the run had been interrupted: the note lacks the last case."""
    path = folder / "note.json"
    note = json.loads(path.read_text())
    note["passed"][-1][1] -= 1
    path.write_text(json.dumps(note))


def test_a_resumed_run_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    suite = made(tmp_path, "words")
    assert kit_main(words(tmp_path, suite)) == 0
    capsys.readouterr()
    assert kit_main(words(tmp_path, suite)) == 2, "nothing was left to run"
    assert "all cases passed in an earlier run" in capsys.readouterr().out
    shortened(tmp_path)
    assert kit_main(words(tmp_path, suite)) == 0
    earlier = suite.case_count - 1
    assert f"resumed: {earlier:,} cases passed in an earlier run)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("program", "(files "),
        ("vectors", "(vectors "),
        ("--codes", "(codes False)"),
        ("--latency=0", "(latency None)"),
        ("--hold=1", "(hold 0)"),
        ("--slow=2", "(slow 1)"),
        ("version", "(version 1)"),
    ],
)
def test_a_note_is_of_one_program_suite_and_choice(
    change: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    suite = made(tmp_path, "words")
    if change == "version":  # what the program reads is not in the command
        (tmp_path / "version").write_text("1")
        code = f"HELLO['version'] = open({str(tmp_path / 'version')!r}).read()"
    else:
        code = ""
    args = words(tmp_path, suite)
    program(tmp_path, code)
    assert kit_main(args) == 0
    shortened(tmp_path)
    if change == "program":
        program(tmp_path, "same = lambda word: True")
    elif change == "vectors":
        rows = [json.loads(line) for line in read_lines(suite.path)]
        rows[1]["why"] = "another case"
        _write(suite.path, rows)
    elif change == "version":
        (tmp_path / "version").write_text("2")
    else:
        args.append(change)
    assert kit_main(args) == 2
    told = capsys.readouterr()
    assert f"the note is of another run {said}" in told.err + told.out


def _write(path: Path, rows: list[Any]) -> None:
    path.write_bytes(gzip.compress("".join(json.dumps(row) + "\n" for row in rows).encode()))


@pytest.mark.parametrize("passed", [[[0, 10**12]], [[-1, 1]], [["0", "1"]], [[True, 1]], 5, [[0]]])
def test_an_edited_note_is_refused(passed: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    suite = made(tmp_path, "words")
    assert kit_main(words(tmp_path, suite)) == 0
    note = json.loads((tmp_path / "note.json").read_text())
    (tmp_path / "note.json").write_text(json.dumps({**note, "passed": passed}))
    assert kit_main(words(tmp_path, suite)) == 2
    assert "not a note of a run" in capsys.readouterr().err
