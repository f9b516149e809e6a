"""`judge --watch` judges again what a saved file touches, and ends with the status of what it found last."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from modeproof.project import watch
from tests.any_machine import until
from tests.project.conftest import Judge
from tests.project.foreign import BLOCK, TOML, WRONG, write

pytestmark = pytest.mark.usefixtures("asked", "deaf")


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The lines of the watch."""
    lines: list[str] = []
    say = watch.Watch._say

    def heard(self: watch.Watch, changed: list[Path], text: str) -> None:
        say(self, changed, text)
        lines.append(text)

    monkeypatch.setattr(watch.Watch, "_say", heard)
    monkeypatch.setattr(watch, "EVERY_S", 0.02)
    return lines


def watched(judge: Judge, said: list[str], *steps: Callable[[], object]) -> tuple[int, str]:
    """Do the steps, each once the one before was answered, then press Ctrl-C."""

    def user() -> None:
        try:
            for number, step in enumerate(steps, 1):
                step()
                until(lambda: len(said) >= number, "a line")  # noqa: B023
        finally:
            signal.raise_signal(signal.SIGINT)

    begun = watch.Watch.run

    def run(self: watch.Watch, found: object) -> int:
        threading.Thread(target=user).start()
        return begun(self, found)  # type: ignore[arg-type]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(watch.Watch, "run", run)
        status, out, _ = judge("--watch")
    return status, out


def test_a_saved_file_is_judged_again_in_one_line(
    place: Path, asked: list[list[str]], judge: Judge, said: list[str]
) -> None:
    more = TOML + TOML.partition("\n\n")[2].replace("contactors", "other")
    write(place, modeproof_toml=more, plc__other_st=BLOCK)
    status, out = watched(judge, said, lambda: write(place, plc__other_st=WRONG))
    assert status == 1 and len(asked) == 3
    assert out.splitlines()[-1].endswith(f"  other.st: {said[0]}") and said[0].startswith(
        "other REFUTED, breaks EDMA-01, "
    )


def test_the_status_is_that_of_what_was_found_last(place: Path, judge: Judge, said: list[str]) -> None:
    write(place, plc__contactors_st=WRONG)
    assert watched(judge, said, lambda: write(place, plc__contactors_st=BLOCK))[0] == 0
    assert said[0].startswith("contactors PROVED, ")


def test_a_file_saved_without_a_change_is_not_judged(
    place: Path, asked: list[list[str]], judge: Judge, said: list[str]
) -> None:
    def save() -> None:
        write(place, plc__contactors_st=BLOCK)
        write(place, modeproof_toml=TOML + "# a remark\n")

    status, _ = watched(judge, said, save)
    assert status == 0 and len(asked) == 1 and said[0].startswith("nothing to judge again, ")


def test_a_wrong_project_file_is_one_line_until_mended(
    place: Path, asked: list[list[str]], judge: Judge, said: list[str]
) -> None:
    def spoil() -> None:
        write(place, modeproof_toml=TOML.replace("target", "tarket"))

    status, _ = watched(judge, said, spoil)
    assert status == 2 and "modeproof.toml:5: program.contactors.tarket: unknown key" in said[0]
    said.clear()
    write(place, modeproof_toml=TOML)
    assert watched(judge, said, spoil, lambda: write(place, modeproof_toml=TOML))[0] == 0
    assert len(asked) == 1


def test_a_lost_file_is_said_and_read_when_back(place: Path, judge: Judge, said: list[str]) -> None:
    file = place / "plc/contactors.st"
    status, _ = watched(judge, said, file.unlink, lambda: write(place, plc__contactors_st=WRONG))
    assert status == 1 and "plc/contactors.st is not in" in said[0] and "REFUTED" in said[1]


def test_a_save_during_the_judgement_is_not_missed(
    place: Path, asked: list[list[str]], judge: Judge, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from modeproof.project.judging import Judging

    run = Judging._run

    def slow(judging: Judging, words: list[str]) -> tuple[int, str]:
        found = run(judging, words)
        if len(asked) == 2:
            write(place, plc__contactors_st=WRONG)
        return found

    monkeypatch.setattr(Judging, "_run", slow)
    first = BLOCK.replace("END_VAR", "END_VAR ")
    status, _ = watched(judge, said, lambda: write(place, plc__contactors_st=first), lambda: None)
    assert status == 1 and "PROVED" in said[0] and "REFUTED" in said[1]
