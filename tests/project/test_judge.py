"""`judge` judges all entries, keeps what still stands, and says at its end what is not well."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from modeproof.ground.places import TREE
from modeproof.output import outcome
from modeproof.project import basis
from modeproof.project.judging import Judging
from tests.project.conftest import Judge
from tests.project.foreign import BLOCK, TOML, WRONG, write


def test_what_has_not_changed_is_not_judged_again(place: Path, asked: list[list[str]], judge: Judge) -> None:
    status, out, err = judge()
    assert (status, err) == (0, "") and len(asked) == 1
    assert out.splitlines()[1].split() == ["contactors", "PROVED", "sf_edm", "judged", "1.0"]
    assert out.splitlines()[-1] == "1 entry: 1 as expected; 0 kept"
    status, out, err = judge()
    assert (status, err) == (0, "") and len(asked) == 1
    assert out.splitlines()[1].split()[-2:] == ["kept", "1.0"]
    assert judge("--anew")[0] == 0 and len(asked) == 2


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("plc/contactors.st", "END_VAR", "END_VAR ", "plc/contactors.st has changed"),
        ("modeproof.toml", "target", "wrap = true\ntarget", "what modeproof.toml says of it has changed"),
        (".modeproof/records/contactors.json", "PROVED", "REFUTED", "its record was changed since it was"),
        (
            ".modeproof/judged/contactors.json",
            "plc/",
            "plc/./",
            "its record was changed since it was written",
        ),
        (".modeproof/judged/contactors.json", '"version": 1', '"version": 0', "kept by another version of"),
        (".modeproof/judged/contactors.json", "{", "", "what was kept cannot be read"),
    ],
)
def test_what_has_changed_is_judged_again_and_why(
    place: Path, asked: list[list[str]], judge: Judge, file: str, old: str, new: str, said: str
) -> None:
    judge()
    text = (place / file).read_text("utf-8")
    assert old in text
    (place / file).write_text(text.replace(old, new), "utf-8")
    status, out, err = judge()
    assert status == 0 and len(asked) == 2 and "0 kept" in out
    assert err.splitlines()[0].startswith("judged again: contactors: ") and said in err
    assert len(err.splitlines()) == 1
    assert judge()[2] == "" and len(asked) == 2


def test_another_version_of_the_tool_judges_again(
    place: Path, asked: list[list[str]], judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    judge()
    monkeypatch.setattr(basis, "tool", lambda: "another")
    assert "judged by another version of modeproof" in judge()[2] and len(asked) == 2


def test_one_entry_not_as_expected_decides_and_is_kept(
    place: Path, asked: list[list[str]], judge: Judge
) -> None:
    more = "".join(TOML.partition("\n\n")[2].replace("contactors", name) for name in "bc")
    write(place, modeproof_toml=TOML + more, plc__b_st="unknown", plc__c_st=WRONG)
    status, out, _ = judge()
    lines = out.splitlines()
    assert (
        status == 1
        and lines[-1] == "3 entries: 1 as expected, 1 not as expected, 1 not judged or unknown; 0 kept"
    )
    assert lines[3].split() == ["c", "REFUTED", "breaks", "EDMA-01", "judged", "1.0"]
    assert lines[lines.index("c: after 3 scans it is off") + 1] == (
        "  next: modeproof prove-program plc/c.st --target sf_edm"
    )
    assert judge("contactors", "b")[0] == 2 and judge("contactors")[0] == 0
    assert judge()[0] == 1 and len(asked) == 3


def test_a_suite_that_could_not_be_judged_is_never_kept(
    place: Path, asked: list[list[str]], judge: Judge
) -> None:
    write(place, plc__contactors_st="unjudged")
    assert [judge()[0] for _ in (1, 2)] == [2, 2] and len(asked) == 2


def test_what_could_not_be_judged_is_never_kept(place: Path, asked: list[list[str]], judge: Judge) -> None:
    write(place, plc__contactors_st="refused")
    for n in (1, 2):
        status, out, _ = judge()
        assert status == 2 and len(asked) == n
        assert "contactors: plc/contactors.st:1: syntax error" in out and "UNJUDGED" in out
    record = outcome.read(place / ".modeproof/records/contactors.json")
    assert record.word == "UNJUDGED" and record.status == 2


@pytest.mark.parametrize("until_the_end", [True, False])
def test_a_file_written_while_it_is_judged_is_not_kept(
    place: Path,
    asked: list[list[str]],
    judge: Judge,
    monkeypatch: pytest.MonkeyPatch,
    until_the_end: bool,
) -> None:
    run = Judging._run

    def saved(judging: Judging, words: Sequence[str]) -> tuple[int, str]:
        if not until_the_end:
            write(place, plc__contactors_st=WRONG)
        found = run(judging, words)
        write(place, plc__contactors_st=WRONG if until_the_end else BLOCK)
        return found

    with monkeypatch.context() as patch:
        patch.setattr(Judging, "_run", saved)
        judge()
    write(place, plc__contactors_st=BLOCK)
    assert judge()[0] == 0 and len(asked) == 2


def test_a_status_unlike_that_of_the_record_is_no_verdict(
    place: Path, asked: list[list[str]], judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Judging._run
    monkeypatch.setattr(Judging, "_run", lambda judging, words: (-9, f"killed {run(judging, words)[1]}"))
    status, out, _ = judge()
    assert status == 2 and "contactors: the command ended with status -9: killed" in out


def test_an_inline_binding_is_written_for_the_command(
    place: Path, asked: list[list[str]], judge: Judge
) -> None:
    names = '[program.contactors.binding]\nleft_out = ["DiagCode"]\n'
    names += '[program.contactors.binding.names]\nS_EDM1 = "A"\n'
    write(place, modeproof_toml=TOML + names)
    assert judge()[0] == 0
    file = place / ".modeproof/bindings/contactors.toml"
    assert asked[0][-2:] == ["--binding", str(file)]
    assert file.read_text() == 'left_out = ["DiagCode"]\n\n[names]\nS_EDM1 = "A"\n'
    write(place, modeproof_toml=TOML + names.replace('"A"', '"B"'))
    assert judge()[0] == 0 and len(asked) == 2


def test_a_name_still_empty_is_unjudged_with_its_line(
    place: Path, asked: list[list[str]], judge: Judge
) -> None:
    names = '[program.contactors.binding.names]\nS_EDM1 = ""\nS_EDM2 = "B"\n'
    write(place, modeproof_toml=TOML + names)
    status, out, _ = judge()
    assert status == 2 and not asked
    assert (
        "contactors: modeproof.toml:6: program.contactors.binding.names: the names of S_EDM1 are still "
        "empty; write those of your program\n  next: modeproof judge contactors" in out
    )


def test_an_adapter_is_judged_again_unless_its_files_are_named(
    place: Path, asked: list[list[str]], judge: Judge
) -> None:
    text = 'version = 1\n[adapter.own]\ntarget = "sf_edm"\ncommand = "python a.py"\n'
    write(place, modeproof_toml=text, a_py="1", b_py="1", sf_edm="")
    (place / "sf_edm").write_text("")
    judge(), judge()
    assert len(asked) == 2
    write(place, modeproof_toml=text + 'files = ["b.py"]\n')
    judge(), judge()
    assert len(asked) == 3
    for n, file in enumerate(("a.py", "b.py"), 4):
        (place / file).write_text("2")
        judge(), judge()
        assert len(asked) == n


def test_commands_are_said_from_where_the_user_stands(
    place: Path, asked: list[list[str]], judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(place, plc__contactors_st=WRONG)
    monkeypatch.chdir(place / "plc")
    assert "  next: modeproof prove-program contactors.st --target sf_edm\n" in judge()[1]
    assert not (place / "plc/.modeproof").exists()


# ---------------------------------------------------------------- bad input


def test_no_project_file_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, judge: Judge) -> None:
    monkeypatch.chdir(tmp_path)
    assert judge() == (
        *(2, ""),
        f"modeproof: no modeproof.toml in {tmp_path}, nor above it: `modeproof init` writes one from what is "
        "here\n",
    )
    assert not list(tmp_path.iterdir())


def test_a_lost_file_and_an_unknown_target_are_said_together(place: Path, judge: Judge) -> None:
    more = '[log.a]\nfile = "logs/a.csv"\ntarget = "sf_edn"\n[log.b]\nfile = "plc"\ntarget = "sf_edm"\n'
    write(place, modeproof_toml=TOML + more)
    status, out, err = judge()
    assert (status, out) == (2, "")
    first, second, third = err.splitlines()
    assert first == f"modeproof: modeproof.toml:7: log.a.file: logs/a.csv is not in {place}; correct the path"
    assert second.startswith(
        "modeproof: modeproof.toml:8: log.a.target: no target 'sf_edn'; did you mean 'sf_edm'?"
    )
    assert third == "modeproof: modeproof.toml:10: log.b.file: plc is a folder; name its files"
    assert not (place / ".modeproof").exists()


def test_a_file_that_lists_nothing_is_no_pass(place: Path, judge: Judge) -> None:
    write(place, modeproof_toml="version = 1\n")
    status, out, err = judge()
    assert (status, out) == (2, "") and err.startswith("modeproof: modeproof.toml: lists nothing to judge")


def test_a_state_folder_that_is_read_only_is_one_line(place: Path, judge: Judge) -> None:
    (place / ".modeproof").write_text("a file in its place")
    status, out, err = judge("--quiet")
    assert (status, out) == (2, "") and len(err.splitlines()) == 1
    assert str(place / ".modeproof") in err


def test_a_full_disk_is_one_line_and_nothing_is_kept(
    place: Path, asked: list[list[str]], judge: Judge, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("modeproof.kit.files.os.fsync", full)
    status, out, err = judge()
    assert (status, out) == (2, "") and err.splitlines()[-1].endswith("No space left on device")
    assert not [path for path in (place / ".modeproof").rglob("*") if path.is_file()]


# ---------------------------------------------------------------- in processes of its own


def test_a_program_is_judged_by_its_own_command(place: Path, judge: Judge) -> None:
    write(place, plc__contactors_st=WRONG)
    status, out, err = judge("--quiet")
    assert (status, err) == (1, "") and "BREAKS" in out
    record = json.loads((place / ".modeproof/records/contactors.json").read_text("utf-8"))
    assert record["command"] == "prove-program" and record["files"][0]["path"] == "plc/contactors.st"
    said = (
        "import atexit, sys; atexit.register(lambda: print(*sys.modules)); from modeproof.cli import main; "
    )
    again = [sys.executable, "-c", f"{said}sys.exit(main(['judge']))"]
    done = subprocess.run(again, cwd=place, capture_output=True, text=True, env=env())
    modules = set(done.stdout.split())
    assert done.returncode == 1 and "1 kept" in done.stdout
    assert "msgspec" in modules and modules.isdisjoint({"z3", "cvc5", "networkx", "jsonschema"})


def env() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(TREE)}
