"""Files that say how a cell is used: what is wrong in one is refused in one line, with its row or story."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from machines.concrete_runs import read_use
from machines.verdicts import Machine
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from tests.machines.test_small_machine import CLOSED, USE, WIRING, asked

FOLDER = Path(__file__).parents[2] / "spec/machine_cell"
CODE = 'Code = { type = "WORD", from = "desk", why = "a number" }'
NUMBERED = WIRING.replace("[inputs]", f"[inputs]\n{CODE}")
PATTERN = '[[pattern]]\ninputs = ["Start", "Stop"]\nrows = '
STORY = '[[story]]\nid = "a"\n'
WRONG = {
    "rest is no table": ('rest = "x"', ":1: rest: must be a table, not 'x'"),
    "a table of nobody": ("[other]\nx = 1", ": unknown key 'other'; did you mean 'pattern'?"),
    "a text for a value": ('[rest]\nStart = "x"', ":2: rest.Start: must be true or false or an integer"),
    "a number for a BOOL": ("[rest]\nStart = 1", ":2: rest: Start is a BOOL, true or false, not 1"),
    "too much for a WORD": ("[rest]\nCode = 65536", ":2: rest: Code is a WORD, 0 to 65535, not 65536"),
    "a BOOL for a WORD": ("[rest]\nCode = true", ":2: rest: Code is a WORD, 0 to 65535, not True"),
    "it follows a number": ("[follows]\nStart = 3", ":2: follows.Start: must be a text in quotes, not 3"),
    "it follows a WORD": ('[follows]\nStart = "Code"', ":2: follows.Start: 'Code' is a WORD, and Start is a"),
    "a WORD follows a BOOL": (
        '[follows]\nCode = "Start"',
        ":2: follows.Code: 'Start' is a BOOL, and Code is",
    ),
    "it follows no signal": ('[follows]\nStart = "NOT ("', ":2: 'NOT (': syntax error"),
    "it follows a comparison": (
        '[follows]\nStart = "Stop = Key"',
        ":2: follows.Start: 'Stop = Key': a wire has",
    ),
    "another sign for AND": ('[follows]\nStart = "Stop & Key"', "names, AND, OR, NOT and brackets: no &"),
    "a pattern without inputs": (
        "[[pattern]]\nrows = [[true]]",
        ":1: [[pattern]] 1: key 'inputs' is missing",
    ),
    "a pattern without rows": (f"{PATTERN}[]", ":1: [[pattern]] 1: rows: must not be empty"),
    "a row of another length": (
        f"{PATTERN}[[true]]",
        ":1: [[pattern]] 1: a row has a value for each of its 2",
    ),
    "a number in a pattern": (
        f"{PATTERN}[[true, 2]]",
        ":1: [[pattern]] 1: Stop is a BOOL, true or false, not 2",
    ),
    "stories that are none": ("story = 3", ":1: story: must be a list, not 3"),
    "a story without an id": ("\n[[story]]\nrow = [{}]", ":2: story 1: key 'id' is missing"),
    "a story without rows": (STORY, ":1: story 'a': key 'row' is missing"),
    "a story of no row": (f"{STORY}row = []", ":1: story 'a': row: must not be empty"),
    "a misspelt key": (
        f"{STORY}row = [{{}}]\nfrist = true",
        ":1: story 'a': unknown key 'frist'; did you mean",
    ),
    "scans as a text": (f'{STORY}row = [{{ scans = "3" }}]', ":1: story 'a': row[0].scans: must be"),
    "scans as a BOOL": (
        f"{STORY}row = [{{ scans = true }}]",
        ":1: story 'a': row 1: scans is a number, 1 or",
    ),
    "no scans": (
        f"{STORY}row = [{{ scans = 0 }}]",
        ":1: story 'a': row 1: scans is a number, 1 or more, not 0",
    ),
    "a number in a story": (f"{STORY}row = [{{}}, {{ Start = 5 }}]", ":1: story 'a': row 2: Start is a BOOL"),
    "two stories of one id": (
        f"{STORY}row = [{{}}]\n{STORY}row = [{{}}]",
        ":4: story 'a': another story has",
    ),
    "then a story that is none": (f'{STORY}row = [{{}}]\nthen = ["b"]', ":1: story 'a': then: no story 'b'"),
    "no TOML": ("rest", ": says nothing about the use of a cell"),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_use_is_refused_in_one_line(
    what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, cause = WRONG[what]
    for name, content in (("my", NUMBERED), ("own", asked(CLOSED)), ("use", text)):
        (tmp_path / f"{name}.toml").write_text(content, "utf-8")
    mine, own, use = (str(tmp_path / f"{name}.toml") for name in ("my", "own", "use"))
    assert main(["machine", mine, "--properties", own, "--use", use, "--quiet"]) == 2
    said = capsys.readouterr()
    assert (said.out, said.err.count("\n")) == ("", 1)
    assert f"modeproof: {use}:" in said.err
    assert cause in said.err


def test_a_use_file_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=r"none\.toml: cannot be read: No such file"):
        read_use(tmp_path / "none.toml")


def test_rows_of_other_wirings_are_left_out(tmp_path: Path) -> None:
    path, use = tmp_path / "own.toml", tmp_path / "use.toml"
    path.write_text(asked(CLOSED), "utf-8")
    beam = '[rest]\nBeam = 7\n[follows]\nBeam = "Key"\nKey = "Start AND NOT Beam"\nDoor = "NOT S_Drive"\n'
    use.write_text(f"{beam}{PATTERN.replace('Stop', 'Beam')}[[true, 9]]\n{USE}", "utf-8")
    runner = Machine(WIRING, "my.toml", path, use).runner
    assert list(runner.follows) == ["Door"]
    assert list(runner.stories()) == ["start"]


def test_the_shipped_use_is_read_as_it_stands() -> None:
    path = FOLDER / "use.toml"
    use, table = read_use(path), tomllib.loads(path.read_text("utf-8"))
    assert {name: getattr(use, name) for name in table} == table
    assert (
        use.place("rest.S_Standstill").line
        == path.read_text("utf-8").splitlines().index("S_Standstill = true") + 1
    )
