"""A small project, and its commands without their work: what they find is decided by the source."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.output import outcome
from modeproof.project.judging import Judging
from tests.project.foreign import BLOCK, TOML, WRONG, write

Judge = Callable[..., tuple[int, str, str]]


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("MODEPROOF_STATE", raising=False)
    return write(tmp_path, modeproof_toml=TOML, plc__contactors_st=BLOCK)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The commands that were run; each gives a record, by the words of the source that it is asked of."""
    given: list[list[str]] = []

    def run(judging: Judging, words: Sequence[str]) -> tuple[int, str]:
        *own, _, record = words
        given.append(own)
        text = (judging.folder / own[1]).read_text("utf-8") if own[0] == "prove-program" else ""
        if "refused" in text:
            return 2, f"{own[1]}:1: syntax error"
        status: Any = 1 if text == WRONG else 2 if text in ("unknown", "unjudged") else 0
        word = outcome.UNJUDGED if "unjudged" in text else ("PROVED", "REFUTED", "UNKNOWN")[status]
        rule = outcome.Rule(id="EDMA-01", kind="clause", sentence="")
        problems = [outcome.Problem(rule=rule, message="after 3 scans it is off")] if status else []
        demand = outcome.Demand(id="equal", word=word, sentence="", problems=problems)
        found = outcome.Outcome(
            **{"command": own[0], "subject": own[1], "target": "sf_edm", "word": word, "status": status},
            **{"sentence": word, "again": " ".join(own), "started": "", "seconds": 1.0, "demands": [demand]},
            files=outcome.files("program", [judging.folder / own[1]]),
            tools=outcome.tools(),
        )
        outcome.write(Path(record), found)
        return status, ""

    monkeypatch.setattr(Judging, "_run", run)
    return given


@pytest.fixture
def judge(capsys: pytest.CaptureFixture[str]) -> Judge:
    def run(*words: str) -> tuple[int, str, str]:
        status = main(["judge", *words])
        said = capsys.readouterr()
        return status, said.out, said.err

    return run
