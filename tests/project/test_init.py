"""`init` proposes what fits, shows all names that fit nearly, and says why the rest is not listed."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.project.file import read
from modeproof.project.names import likeness, matched
from tests.project.foreign import BLOCK, EXAMPLES, renamed, write

Init = Callable[[], tuple[int, list[str], str]]
NEAR = renamed(
    BLOCK,
    **{"SF_EDM": "Contactors", "ResetRequest": "RequestReset", "S_EDM1": "EDM_1", "S_EDM2": "EDM_2"},
    **{"MonitoringTime": "MonitorTime", "S_OutControl": "Demand"},
)
OPEN = renamed(BLOCK, SF_EDM="Feedback", S_EDM1="Left", S_EDM2="Right")
BLINK = (
    "FUNCTION_BLOCK Blink VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR q := a; END_FUNCTION_BLOCK"
)


@pytest.fixture
def init(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Init:
    monkeypatch.chdir(tmp_path)

    def run() -> tuple[int, list[str], str]:
        status = main(["init"])
        said = capsys.readouterr()
        return status, said.out.splitlines(), said.err

    return run


def test_a_program_that_fits_a_target_is_proposed(tmp_path: Path, init: Init) -> None:
    write(tmp_path, plc__edm_st=BLOCK, plc__blink_st=BLINK, plc__bad_st="x(", venv__x_st=BLOCK)
    write(tmp_path, venv__pyvenv_cfg="", plc__Old_TcPOU="<xml/>", notes_xml="<notes/>")
    status, out, err = init()
    assert (status, err) == (0, "")
    assert out == [
        "modeproof.toml is written, with 1 entry:",
        "  program.sf_edm  SF_EDM of plc/edm.st fits sf_edm",
        "found, and not listed:",
        "  plc/Old.TcPOU: a file of a tool, which only it can read; export the program as PLCopen XML, or as "
        "text (.st), and run `modeproof init` then",
        "  plc/bad.st: plc/bad.st:1: syntax error at 'x('",
        "  plc/blink.st: Blink has the names of no target, and calls no block of the documents",
        "next: modeproof judge",
    ]
    (entry,) = read(tmp_path / "modeproof.toml", "modeproof.toml").entries
    assert entry.row.words(str) == ["prove-program", "plc/edm.st", "--target", "sf_edm"]


def test_names_that_fit_nearly_are_bound_and_shown_at_once(tmp_path: Path, init: Init) -> None:
    write(tmp_path, near_st=NEAR)
    status, out, _ = init()
    said = "S_OutControl = Demand"
    assert status == 0 and "nearly fits sf_edm" in out[1] and said not in out[1]
    for pair in ("EDM_1 is taken for S_EDM1", "RequestReset is taken for ResetRequest"):
        assert pair in out[1]
    table = tomllib.loads((tmp_path / "modeproof.toml").read_text("utf-8"))
    assert table["program"]["contactors"]["binding"]["names"] == {
        **{"S_EDM1": "EDM_1", "S_EDM2": "EDM_2", "S_OutControl": "Demand"},
        **{"ResetRequest": "RequestReset", "MonitoringTime_ms": "MonitorTime"},
    }


def test_names_that_only_the_user_knows_are_left_to_write(tmp_path: Path, init: Init) -> None:
    write(tmp_path, open_st=OPEN)
    status, out, _ = init()
    assert status == 0 and "write your names for S_EDM1, S_EDM2" in out[1]
    assert out[-1] == "next: write the empty names in modeproof.toml, then `modeproof judge`"
    text = (tmp_path / "modeproof.toml").read_text("utf-8")
    assert 'S_EDM1 = ""  # one of Left, Right\n' in text and 'S_EDM2 = ""  # one of Left, Right\n' in text
    assert main(["judge"]) == 2


def test_an_existing_file_is_left_as_it_is(tmp_path: Path, init: Init) -> None:
    write(tmp_path, edm_st=BLOCK, modeproof_toml="mine")
    status, out, err = init()
    assert (status, out) == (2, []) and (tmp_path / "modeproof.toml").read_text() == "mine"
    assert err.startswith(
        "modeproof: modeproof.toml is here already, and it is left as it is: `modeproof judge`"
    )


def test_where_nothing_fits_no_file_is_written(tmp_path: Path, init: Init) -> None:
    write(tmp_path, blink_st=BLINK)
    status, out, err = init()
    assert status == 2 and len(err.splitlines()) == 1 and "nothing here fits a target" in err
    assert out[-1].startswith("  blink.st: Blink has") and not (tmp_path / "modeproof.toml").exists()


def test_a_folder_that_may_not_be_written_is_one_line(
    tmp_path: Path, init: Init, monkeypatch: pytest.MonkeyPatch
) -> None:
    def closed(*words: object, **others: object) -> None:
        raise PermissionError(13, "Permission denied")

    write(tmp_path, edm_st=BLOCK)
    monkeypatch.setattr("modeproof.kit.files.tempfile.mkstemp", closed)
    status, out, err = init()
    assert (status, out) == (2, []) and len(err.splitlines()) == 1
    assert "modeproof.toml: cannot be written: Permission denied" in err


def test_a_full_disk_leaves_no_half_of_a_file(
    tmp_path: Path, init: Init, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    write(tmp_path, edm_st=BLOCK)
    monkeypatch.setattr("modeproof.kit.files.os.fsync", full)
    status, out, err = init()
    assert (status, out) == (2, []) and "modeproof.toml: cannot be written: No space left on device" in err
    assert [path.name for path in tmp_path.iterdir()] == ["edm.st"]


def test_logs_go_to_the_target_whose_names_they_have(tmp_path: Path, init: Init) -> None:
    for name, new in (("fplc_good.csv", "monday.csv"), ("fplc_cut.jsonl", "cut.jsonl")):
        (tmp_path / new).write_bytes((EXAMPLES / "logs" / name).read_bytes())
    write(tmp_path, prices_csv="a;b\n1;2\n")
    status, out, _ = init()
    assert status == 0 and out[1] == "  log.monday  monday.csv is a log of fplc"
    assert out[3].startswith("  cut.jsonl: it seems to be a log of fplc: cut.jsonl: line ")
    assert out[4] == "  prices.csv: no log: its first lines name no signal of a target"


@pytest.mark.parametrize(
    ("ours", "yours", "alike"),
    [
        *[("S_OutControl", "s_outcontrol", True), ("S_EDM1", "EDM_1", True), ("Reset", "xReset", True)],
        *[("ResetRequest", "RequestReset", True), ("Activate", "Activete", True), ("Ready", "Raedy", True)],
        *[("S_EDM1", "S_EDM2", False), ("S_EDM1", "EDM", False), ("Error", "Ready", False)],
    ],
)
def test_which_names_are_alike(ours: str, yours: str, alike: bool) -> None:
    assert (likeness(ours, yours) > 0) == alike


def test_two_names_that_fit_alike_are_left_to_the_user() -> None:
    found, doubtful = matched(["Reset", "Error"], ["Error", "xReset", "yReset"], lambda ours, yours: True)
    assert found == {"Error": "Error"} and doubtful == {"Reset": ["xReset", "yReset"]}
