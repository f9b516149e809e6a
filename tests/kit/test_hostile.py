"""What others wrote - programs, vector files, paths - breaks nothing, hangs nothing, and forges no line."""

from __future__ import annotations

import copy
import gzip
import json
import lzma
import os
import random
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged as GroundUnjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.adapter import Adapter
from modeproof.kit.again import quoted
from modeproof.kit.compact import FORM, expand
from modeproof.kit.errors import Unjudged, plain
from modeproof.kit.files import write_json, write_text
from modeproof.kit.suite_judge import Options, Plan, run_suite
from modeproof.kit.text import as_junit, as_record, as_text, difference_lines, joined
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from tests.any_machine import PATIENCE_S, until
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp
from tests.kit.programs import IMPATIENT_S, PATIENT_S, program, starter

EVIL = "\x1b]0;owned\x07\x1b[2J\u202e\ud800\r\nCONFORMS(exact, brief)"


@pytest.fixture
def suite(tmp_path: Path) -> Suite:
    graph = lamp_graph(tmp_path)
    write_suite(tmp_path / "tour.jsonl", "tour", [graph])
    return open_suite(tmp_path / "tour.jsonl")


def conform(suite: Suite, folder: Path, fault: str, *more: str) -> list[str]:
    command = shlex.join(program(folder, fault))
    return ["conform", "lamp", "--adapter", command, "--vectors", str(suite.path), "--quiet", *more]


# ---------------------------------------------------------------------------------------------- terminals


def harmless(text: str) -> bool:
    return all(one.isprintable() for line in text.split("\n") for one in line)


def test_foreign_text_is_one_printable_line() -> None:
    assert plain(EVIL) == "\\x1b]0;owned\\x07\\x1b[2J\\u202e\\ud800\\r\\nCONFORMS(exact, brief)"
    assert plain("Größe § 5") == "Größe § 5" and len(plain("x" * 10**6)) == 600
    for kind in (Unjudged, GroundUnjudged):
        assert harmless(str(kind(f"{EVIL} {EVIL}"))) and "\n" not in str(kind(EVIL))


def test_a_program_cannot_write_lines_of_the_verdict(
    suite: Suite, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = ["--json", str(tmp_path / "v.json"), "--junit", str(tmp_path / "v.xml")]
    for fault in (f"HELLO['name'] = {EVIL!r}", f"HELLO['version'] = {EVIL!r}"):
        for wrong in ("", "\nLIMIT = 501"):
            assert kit_main(conform(suite, tmp_path, fault + wrong, *files)) == (1 if wrong else 0)
            told = capsys.readouterr()
            assert harmless(told.out) and "owned" in told.out
            assert sum(line.startswith("CONFORMS") for line in told.out.splitlines()) == (not wrong)
    for fault in (f"def greet(): say({{'error': {EVIL!r}}})", "def greet(): sys.exit('\\x1b[2J')"):
        assert kit_main(conform(suite, tmp_path, fault)) == 2
        told = capsys.readouterr()
        assert harmless(told.out + told.err) and "1b" in told.out


def test_a_vector_file_cannot_write_lines_of_the_verdict(suite: Suite) -> None:
    rows = [json.loads(line) for line in suite.path.read_text().splitlines()]
    rows[1]["why"] = EVIL
    rows[0]["steps"][0]["name"] = EVIL
    suite.path.write_text("\n".join(map(json.dumps, rows)))

    class Dark(Lamp):
        def shown(self, out: Any) -> Any:
            return {**out, "MW": "FFFF"}

    edited = open_suite(suite.path)
    verdict = run_suite(edited, Dark)
    assert verdict.difference is not None
    assert harmless(as_text(verdict, suite=edited)) and harmless(joined(difference_lines(verdict.difference)))
    assert "\x1b" not in as_junit([verdict]) and as_text(verdict).splitlines()[-1].startswith(
        "DIFFERS: case lamp-"
    )


def test_any_code_page_and_lone_surrogates_end_in_a_verdict(suite: Suite, tmp_path: Path) -> None:
    args = conform(suite, tmp_path, "HELLO['name'] = '\\ud800\\u4e2d'", "--json", str(tmp_path / "v.json"))
    for page in ("cp1252", "ascii", "utf-8"):
        done = subprocess.run(
            [sys.executable, "-m", "modeproof.kit", *args],
            capture_output=True,
            env={**os.environ, "PYTHONIOENCODING": page},
            check=False,
        )
        assert (done.returncode, done.stderr) == (0, b""), done.stderr
    assert json.loads((tmp_path / "v.json").read_text())["adapter"].startswith("\\ud800")
    write_json(tmp_path / "half.json", {"x": "\ud800"})
    assert json.loads((tmp_path / "half.json").read_text()) == {"x": "\ud800"}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_a_verdict_that_nobody_can_read_is_unjudged(suite: Suite, tmp_path: Path) -> None:
    for jobs in ("1", "2"):
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                [sys.executable, "-m", "modeproof.kit", *conform(suite, tmp_path, "", "--jobs", jobs)],
                stdout=full,
                stderr=subprocess.PIPE,
                text=True,
                check=False,
            )
        assert done.returncode == 2 and "Traceback" not in done.stderr
        assert "UNJUDGED: the result cannot be printed" in done.stderr


def test_a_command_is_quoted_so_that_sh_reads_it_alike() -> None:
    for text in ("a b", "x", "$(touch /tmp/x)", "`id`", 'say "hi"', "", "~9,10"):
        assert shlex.split(quoted(text)) == [text]
    assert quoted("$HOME") == "'$HOME'", "in double quotes sh would put something in its place"


# -------------------------------------------------------------------------------------------------- files


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no such devices")
def test_a_device_is_written_to_and_never_replaced() -> None:
    before = {name: os.stat(name).st_rdev for name in ("/dev/null", "/dev/full")}
    write_text(Path("/dev/null"), "x")
    write_whole(Path("/dev/null"), b"x")
    with pytest.raises(Unjudged, match="/dev/full: cannot be written"):
        write_text(Path("/dev/full"), "x")
    with pytest.raises(GroundUnjudged, match="/dev/full: cannot be written"):
        write_whole(Path("/dev/full"), b"x")
    assert before == {name: os.stat(name).st_rdev for name in before} and all(before.values())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_pipes_and_links_stay_what_they_are(tmp_path: Path) -> None:
    pipe, link, file = tmp_path / "pipe", tmp_path / "link", tmp_path / "file"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_text(pipe, "through")
    assert os.read(reader, 100) == b"through" and pipe.is_fifo()
    os.close(reader)
    file.write_text("old")
    link.symlink_to(file)
    write_text(link, "new")
    assert link.is_symlink() and file.read_text() == "new"
    with pytest.raises(Unjudged, match="cannot be written"):
        write_text(tmp_path, "x")


def test_an_interruption_leaves_no_part_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    (tmp_path / "v.json").write_text("old")
    monkeypatch.setattr("os.replace", interrupt)
    for write in (
        lambda: write_text(tmp_path / "v.json", "x"),
        lambda: write_whole(tmp_path / "v.json", b"x"),
    ):
        with pytest.raises(KeyboardInterrupt):
            write()
    assert [path.name for path in tmp_path.iterdir()] == ["v.json"]
    assert (tmp_path / "v.json").read_text() == "old"


def test_a_file_that_another_program_has_open_is_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    right, held = os.replace, iter(range(3))
    monkeypatch.setattr("modeproof.kit.files._PAUSE_S", 0)

    def replace(part: str, path: Path) -> None:
        if next(held, None) is not None:
            raise PermissionError(13, "Permission denied")
        right(part, path)

    monkeypatch.setattr("os.replace", replace)
    write_whole(tmp_path / "v.json", b"new")
    assert (tmp_path / "v.json").read_bytes() == b"new" and next(held, "let go") == "let go"
    held = iter(range(1000))
    with pytest.raises(GroundUnjudged, match=r"v\.json: cannot be written: Permission denied"):
        write_whole(tmp_path / "v.json", b"newer")
    assert (tmp_path / "v.json").read_bytes() == b"new" and len(list(tmp_path.iterdir())) == 1


# ----------------------------------------------------------------------------------------------- adapters


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("say_ = say\ndef say(x): say_({'ok': 1} if x == {'ok': True} else x)", "reset was answered with"),
        ("HELLO['unobserved'] = [['MW']]", "unobserved must list outputs"),
        ("HELLO['unobserved'] = [{}]", "unobserved must list outputs"),
        ("HELLO['relations'] = [[]]", "does not offer relation"),
        ("HELLO['time'] = ['virtual']", "needs virtual time"),
        ("HELLO['max_latency_scans'] = 10**39", "allows no latency"),
        ("def greet(): say('{\"ok\":true,\"name\":' + '9' * 5000 + '}\\n')", "not a line of JSON"),
        ('def greet(): say(\'{"ok":true,"name":1e999999}\\n\')', "not a line of JSON"),
        ("def greet(): say({'error': 'x' * 200000})", "refused: "),
        ("def answer(m, out): say('{\"out\":{\"LAMP\":' + '9' * 4000 + '}}\\n')", "not a line of JSON"),
        ("def answer(m, out): say({'out': {**out, 'MW': '\\ud800'}})", "four upper-case hex digits"),
        ("def answer(m, out): say({'out': {**out, '\\x1b[2J': 1}})", "that the target does not have"),
    ],
)
def test_an_odd_answer_is_one_line(suite: Suite, tmp_path: Path, fault: str, said: str) -> None:
    verdict = run_suite(suite, starter(tmp_path, fault))
    assert verdict.word == "UNJUDGED" and said in verdict.reason
    assert verdict.reason.isprintable() and len(verdict.reason) <= 700


@pytest.mark.parametrize("error", ["x" * 200_000, "two\nlines", "\x1b[2J", ""])
def test_a_refusal_is_one_line_of_bearable_length(error: str) -> None:
    code = f"import json; input(); print(json.dumps({{'error': {error[:9]!r} * {len(error) // 9 or 1}}}))"
    with Adapter([sys.executable, "-c", code], PATIENT_S) as adapter:
        assert adapter.refused({"op": "none"}) != {}
    code = 'input(); print(\'{"error": "no"}\', flush=True)'
    with Adapter([sys.executable, "-c", code], PATIENT_S) as adapter:
        assert adapter.refused({"op": "none"}) == {}


def test_an_answer_where_a_refusal_was_due_stays_json(suite: Suite) -> None:
    """Also one that JSON cannot write: it is kept as text."""
    code = "input(); print('{\"out\": ' + '[' * 50 + ']' * 50 + '}', flush=True)"
    with Adapter([sys.executable, "-c", code], PATIENT_S) as adapter:
        answer = adapter.refused({"op": "none"})["answer"]
    assert isinstance(answer, str) and len(answer) <= 60


def test_an_adapter_that_answers_and_never_reads_is_ended() -> None:
    """It fills the pipe with requests that are shorter than the pipe, one by one."""
    code = "import sys, time\nfor _ in range(200): print('{\"ok\":true}', flush=True)\ntime.sleep(600)"
    adapter = Adapter([sys.executable, "-c", code], IMPATIENT_S)
    adapter._lines.waiting = lambda: None  # type: ignore[method-assign]
    began = time.monotonic()
    with adapter, pytest.raises(Unjudged, match="was not read within"):
        for _ in range(200):
            adapter.ask({"op": "hello", "padding": "x" * 3000})
    assert adapter.process.poll() is not None and time.monotonic() - began < PATIENCE_S


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_signal_ends_a_hung_adapter_too(suite: Suite, tmp_path: Path, name: str, jobs: str) -> None:
    pids = tmp_path / "pids"
    hangs = f"import os\nopen({str(pids)!r}, 'a').write(f'{{os.getpid()}}\\n')\n"
    hangs += "def answer(m, out): time.sleep(600)"
    args = conform(suite, tmp_path, hangs, "--jobs", jobs, "--timeout", "500")
    kit = subprocess.Popen(
        [sys.executable, "-m", "modeproof.kit", *args],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    until(lambda: pids.is_file() and len(pids.read_text().split()) == int(jobs), "all adapters")
    time.sleep(0.3)
    kit.send_signal(getattr(signal, name))
    out, err = kit.communicate(timeout=PATIENCE_S)
    assert kit.returncode == 2 and "UNJUDGED: interrupted after 0 cases" in out and "Traceback" not in err
    for pid in map(int, pids.read_text().split()):
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


# --------------------------------------------------------------------------------------------------- files

ODD: list[Any] = [None, 0, -1, 1, 10**30, 1e300, "x", "", [], {}, [[]], {"a": 1}, True, "\ud800", "\x1b[31m"]


def places(value: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    yield at
    for key in value if isinstance(value, dict) else range(min(len(value), 4)) if type(value) is list else ():
        yield from places(value[key], (*at, key))


def edited(rows: list[Any], draw: random.Random) -> list[Any]:
    """The rows with one or two places changed or gone."""
    rows = copy.deepcopy(rows)
    for _ in range(draw.choice((1, 1, 2))):
        row = draw.choice(rows[:1] * 3 + rows)
        *way, last = draw.choice(list(places(row))[1:])
        for key in way:
            row = row[key]
        if draw.random() < 0.2:
            del row[last]
        else:
            row[last] = draw.choice(ODD)
    return rows


@pytest.mark.sampled
@pytest.mark.parametrize("seed", range(20))
def test_an_edited_vector_file_never_breaks_the_kit(suite: Suite, seed: int) -> None:
    draw = random.Random(seed)
    whole = [json.loads(line) for line in suite.path.read_text().splitlines()]
    words = set()
    for _ in range(60):
        suite.path.write_text("\n".join(map(json.dumps, edited(whole, draw))))
        try:
            one = open_suite(suite.path)
        except Unjudged as error:
            assert str(error).isprintable()
            continue
        options = Options(draw.choice(["exact", "monitor"]), codes=draw.random() < 0.5)
        verdict = run_suite(one, Lamp, plan=Plan(options, effort=5))
        text = as_text(verdict, "again", one)
        assert harmless(text) and as_junit([verdict])
        json.dumps(as_record(verdict), allow_nan=False)
        words.add(verdict.word)
    assert "UNJUDGED" in words


def test_a_small_file_cannot_fill_the_memory(
    suite: Suite, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("modeproof.kit.vectors.LONGEST_LINE", 1 << 20)
    header = suite.path.read_bytes().splitlines()[0]
    bomb = tmp_path / "tour.jsonl.gz"
    bomb.write_bytes(gzip.compress(header + b"\n" + b" " * (1 << 22)))
    assert "a line longer than 1,048,576 bytes" in run_suite(open_suite(bomb), Lamp).reason
    bomb.write_bytes(gzip.compress(b" " * (1 << 22)))
    with pytest.raises(Unjudged, match="a line longer than"):
        open_suite(bomb)
    monkeypatch.setattr("modeproof.kit.compact.LARGEST_PART", 1 << 20)
    part = lzma.compress(b" " * (1 << 22))
    with pytest.raises(Unjudged, match="more than 1,048,576 bytes"):
        list(expand(json.dumps({"form": FORM, "parts": [len(part)]}).encode() + b"\n" + part))
