"""Outcomes for tests, built from logs that the pinned jar wrote for the runs of tests/toy_tree.py."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec

from modeproof.registers.cfg import Cfg, parse_cfg
from modeproof.registers.runs import Run, _run
from modeproof.tlc.messages import Log, LogReader
from modeproof.tlc.process import Outcome
from modeproof.tlc.run_judge import Judgement, judge
from tests.toy_tree import CFGS, declaration, sha256

STATUS = {"MC_toy": 0, "NEG_small": 12, "NEG_reaches": 13}


def log_lines(name: str) -> list[bytes]:
    """The recorded log of a toy run."""
    return (Path(__file__).parent / "logs" / f"{name}.log").read_bytes().splitlines(keepends=True)


def read_log(lines: Sequence[bytes]) -> Log:
    """What LogReader makes of the lines."""
    reader = LogReader()
    for line in lines:
        reader.feed(line)
    return reader.close()


def outcome(
    name: str, lines: Sequence[bytes] | None = None, status: int | None = None, printed: Sequence[bytes] = ()
) -> Outcome:
    """The outcome of a toy run, as recorded or with other lines, exit status or printed lines."""
    return Outcome(
        status=STATUS[name] if status is None else status,
        seconds=1.0,
        timed_out=False,
        log=read_log(log_lines(name) if lines is None else lines),
        command=("java",),
        printed=frozenset(printed),
    )


def declared(name: str, **changes: object) -> Run:
    """The declaration of a toy run, with some fields changed."""
    import tomllib

    run = _run("toy", "runs.toml", tomllib.loads(declaration(name))["run"][0])
    return msgspec.structs.replace(run, **changes)


def judged(run: Run, found: Outcome, cfg_text: str | None = None) -> Judgement:
    """The judgement with the cfg of the toy run, or with another text in its place."""
    text = CFGS[run.id] if cfg_text is None else cfg_text
    cfg: Cfg = parse_cfg(text, run.cfg)
    return judge(run, cfg, sha256(text), found)
