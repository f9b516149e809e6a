"""Several programs at once, runs that go on where they were, differences by cause, the first one at once."""

from __future__ import annotations

import json
import shlex
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.adapter import Adapter
from modeproof.kit.errors import Unjudged
from modeproof.kit.lines import ThreadedLines, lines_of
from modeproof.kit.suite_judge import Difference, Plan, run_suite
from modeproof.kit.text import as_junit, as_text
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp
from tests.kit.programs import PATIENT_S, Hanging, program


@pytest.fixture
def words(tmp_path: Path) -> Suite:
    write_suite(tmp_path / "words.jsonl.gz", "words", [lamp_graph(tmp_path)])
    return open_suite(tmp_path / "words.jsonl.gz")


class Gullible(Lamp):
    """Takes every word, and is late as well."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.limit = 501

    def right(self, word: str) -> bool:
        return True


@pytest.mark.parametrize("jobs", [1, 3])
def test_several_programs_at_once_judge_alike(words: Suite, jobs: int) -> None:
    made: list[Lamp] = []

    def start() -> Lamp:
        made.append(Lamp())
        return made[-1]

    verdict = run_suite(words, start, plan=Plan(jobs=jobs))
    assert (verdict.word, verdict.cases, verdict.scans) == ("CONFORMS", words.case_count, words.scan_count)
    assert len(made) == jobs and all(one.closed for one in made)
    assert sorted(verdict.passed) == list(range(words.case_count))
    assert run_suite(words, Gullible, plan=Plan(jobs=jobs, most=10**6)).cases < words.case_count


def test_one_that_cannot_be_judged_ends_them_all(words: Suite) -> None:
    made: list[Lamp] = []

    class Tired(Lamp):
        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            if self.scans > 40:
                raise Unjudged("gone")
            return super().scan(dt_ms, inputs)

    def start() -> Lamp:
        made.append(Tired())
        return made[-1]

    verdict = run_suite(words, start, plan=Plan(jobs=3))
    assert verdict.word == "UNJUDGED" and "gone" in verdict.reason and 0 < verdict.cases < words.case_count
    assert all(one.closed for one in made)


def test_differences_are_gathered_by_likely_cause(words: Suite) -> None:
    verdict = run_suite(words, Gullible, plan=Plan(most=1000))
    causes = verdict.causes()
    assert len(verdict.differences) > 100 > len(causes) > 0
    assert sum(len(found) for _, found in causes) == len(verdict.differences)
    text = as_text(verdict)
    assert f"{len(verdict.differences)} cases differ, by likely cause:" in text
    few = run_suite(words, Gullible, plan=Plan(most=5))
    assert len(few.differences) == 5


def test_the_first_difference_is_told_before_anything_else_is_done(words: Suite) -> None:
    told: list[tuple[Difference, int]] = []
    lamp = Gullible()
    verdict = run_suite(
        words, lambda: lamp, plan=Plan(most=50), on_difference=lambda one: told.append((one, lamp.scans))
    )
    (first, scans), *more = told
    assert not more and first.case == verdict.differences[0].case
    assert scans < lamp.scans and verdict.first_difference_s is not None


def test_an_interrupted_run_keeps_what_it_has(words: Suite) -> None:
    class Interrupting(Lamp):
        def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
            if self.scans == 500:
                raise KeyboardInterrupt
            return super().scan(dt_ms, inputs)

    lamp = Interrupting()
    verdict = run_suite(words, lambda: lamp)
    assert verdict.word == "UNJUDGED" and "interrupted after" in verdict.reason and lamp.closed
    assert verdict.cases > 10 and verdict.covered
    rest = run_suite(words, Lamp, plan=Plan(skip=set(verdict.passed)))
    assert rest.word == "CONFORMS" and rest.cases == words.case_count and rest.scans < words.scan_count
    assert rest.covered == run_suite(words, Lamp).covered


def test_a_run_goes_on_from_its_note(
    words: Suite, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    note, count = tmp_path / "note.json", tmp_path / "count"
    counting = f"""
n = 0
def answer(m, out):
    global n
    n += 1
    open({str(count)!r}, "w").write(str(n))
    if n == 300 and not __import__("os").path.exists({str(tmp_path / "well")!r}): sys.exit("battery is flat")
    say({{"out": out}})
"""
    command = " ".join(f'"{word}"' for word in program(tmp_path, counting))
    args = [
        "conform",
        "lamp",
        "--adapter",
        command,
        "--vectors",
        str(words.path),
        "--quiet",
        "--resume",
        str(note),
    ]
    assert kit_main(args) == 2
    assert "battery is flat" in capsys.readouterr().out
    passed = sum(last - first + 1 for first, last in json.loads(note.read_text())["passed"])
    assert passed > 10
    (tmp_path / "well").touch()
    assert kit_main(args) == 0
    assert f"{words.case_count:,} of {words.case_count:,} cases passed" in capsys.readouterr().out
    assert int(count.read_text()) < words.scan_count - 100, "what had passed was run again"
    assert (
        kit_main([*args[:4], "--vectors", str(words.path), "--resume", str(note), "--relation", "monitor"])
        == 2
    )
    assert "the note is of another run" in capsys.readouterr().err
    note.write_text('{"kind": 3}')
    assert kit_main(args) == 2 and "not a note of a run" in capsys.readouterr().err


def test_the_command_that_is_given_runs_the_shortest_part_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_suite(tmp_path / "tour.jsonl.gz", "tour", [lamp_graph(tmp_path)])
    command = " ".join(f'"{word}"' for word in program(tmp_path, "LIMIT = 501"))
    args = ["conform", "lamp", "--adapter", command, "--vectors", str(tmp_path / "tour.jsonl.gz"), "--quiet"]
    assert kit_main(args) == 1
    said = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("again:"))
    tail = shlex.split(said[said.index("--case") :])
    assert kit_main([*args, *tail]) == 1
    assert "of 1 cases" in capsys.readouterr().out
    (tmp_path / "good").mkdir()
    good = " ".join(f'"{word}"' for word in program(tmp_path / "good"))
    assert kit_main([*args[:3], good, *args[4:], *tail]) == 0


def test_junit_has_each_case_and_always_stays_xml(words: Suite, tmp_path: Path) -> None:
    for lamp, failures in ((Lamp, 0), (Gullible, 3)):
        tree = ElementTree.fromstring(as_junit([run_suite(words, lamp, plan=Plan(most=3))]))
        (suite,) = tree
        assert int(suite.attrib["tests"]) == len(suite) and int(suite.attrib["failures"]) == failures
        assert len(suite.findall(".//failure")) == failures
    odd = program(
        tmp_path, "def greet(): sys.exit('<&\\x00\\x1b]\\ud800'.encode('utf-8', 'replace').decode())"
    )
    (suite,) = ElementTree.fromstring(as_junit([run_suite(words, lambda: Adapter(odd, PATIENT_S))]))
    assert suite.attrib["errors"] == "1" and suite.findall(".//error")


HANGS = "def answer(m, out): time.sleep(600)"
TWICE = "def answer(m, out): say({'out': out}); say({'out': out})"
ODD = (
    "",
    "same = lambda word: True",
    "def answer(m, out): say('[' * 99 + '\\n')",
    "def answer(m, out): [sys.stdout.write('x' * 1000000) for _ in range(100)]",
    "def answer(m, out): sys.exit(3)",
    TWICE,
    HANGS,
)


@pytest.mark.parametrize("fault", ODD)
def test_the_way_for_systems_without_poll_judges_alike(
    words: Suite, tmp_path: Path, fault: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if fault != HANGS:
        monkeypatch.setattr("modeproof.kit.adapter.ENDING_S", PATIENT_S)
    if fault == TWICE:
        monkeypatch.setattr("modeproof.kit.adapter.GRACE_S", PATIENT_S)
    command = program(tmp_path, fault)
    made: list[Adapter] = []

    def start(threads: bool) -> Adapter:
        lines = ThreadedLines if threads else lines_of
        made.append(Hanging(command, 3, lines) if fault == HANGS else Adapter(command, PATIENT_S, lines))
        return made[-1]

    plain, threaded = (run_suite(words, lambda threads=threads: start(threads)) for threads in (False, True))
    assert (plain.word, plain.cases) == (threaded.word, threaded.cases)
    if fault == TWICE:  # seen before the next request is sent, or instead of its answer: the system decides
        too_many = ("a line that nobody asked for", "reset was answered with", "expected, got")
        assert all(any(said in one.reason for said in too_many) for one in (plain, threaded))
    else:
        assert plain.reason == threaded.reason
    assert all(one.process.poll() is not None for one in made)


def test_in_real_time_an_answer_may_take_its_scan_time() -> None:
    hello = '{"ok": True, "time": "real", "relations": ["settled"]}'
    slow = f"time.sleep(m.get('dt_ms', 0) / 1000); return {hello} if m['op'] == 'hello' else {{'out': {{}}}}"
    code = f"import json, sys, time\ndef answer(m):\n    {slow}\n"
    code += "for line in sys.stdin: print(json.dumps(answer(json.loads(line))), flush=True)"
    with Adapter([sys.executable, "-c", code], 0.5) as adapter:
        adapter.timeout_s = 10.0
        adapter.hello("lamp")
        adapter.timeout_s = 0.1
        assert adapter.scan(400, {}) == {}
        adapter._real_time = False
        with pytest.raises(Unjudged, match=r"no answer within 0.1 s"):
            adapter.scan(400, {})
