"""spec/<document>/scores.toml: what the last complete campaign of each kind found, and on which texts.

`modeproof mutate ... --record` writes a row. `files` has a hash of each text that the campaign rests on:
the path of a file, `run ID` for the cfg of a run, or `program MODULE` for a module and all that it imports.
Comments, explanations of survivors and prose of registers are left out: they decide nothing. A row says that
it is of an earlier text, or its hashes must fit the present one.
"""

from __future__ import annotations

import hashlib
import io
import json
import tokenize
import tomllib
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from datetime import date
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.registers.made import cfg_text
from modeproof.registers.runs import load_runs
from modeproof.registers.scores import Score, load_scores, scores_path
from modeproof.strength.campaign import Campaign, Judged, unexplained
from modeproof.strength.code import files_of
from modeproof.strength.published import contents
from modeproof.strength.results import without_comments

DIGITS = 16
"""Of a hash so many are kept."""
_PROSE = frozenset({"why", "title", "clauses", "survivor", "rejudged"})
_COUNTS = ("killed", "equivalent", "invalid", "survived", "survived_explained", "unmeasured")
_HEAD = """\
# Written by `modeproof mutate ... --record`: what the last complete campaign of each kind found, and hashes
# of the texts that it rests on. Where `earlier_text` is true, it was judged on a text before the present one.
"""


def record_score(campaign: Campaign, judged: Sequence[Judged]) -> Score:
    """Write the row of a campaign in the place of the one before.

    Raises Unjudged when a mutant is not judged: a part of a campaign is no score.
    """
    judges = campaign.judges
    missing = len(campaign.mutants) - len(judged)
    if missing:
        raise Unjudged(f"{judges.document}: {missing} mutants are not judged, so nothing is recorded")
    counts = Counter(judgement.word.lower() for judgement in judged)
    counts["survived_explained"] = counts["survived"] - len(unexplained(judges.explained, judged))
    score = Score(
        what=judges.what,
        judged_on=date.today().isoformat(),
        command=judges.command,
        earlier_text=False,
        files={name: fingerprint(judges.place, judges.document, name) for name in judges.texts},
        **{name: counts[name] for name in _COUNTS},
    )
    others = [row for row in load_scores(judges.place, judges.document) if row.what != judges.what]
    write_scores(judges.place, judges.document, [*others, score])
    return score


def write_scores(place: Path, document: str, scores: Sequence[Score]) -> None:
    """Write the whole record."""
    order = ("spec", "impl", "vectors")
    rows = sorted(scores, key=lambda score: order.index(score.what))
    text = f'{_HEAD}\ndocument = "{document}"\n' + "".join(f"\n{_row(score)}" for score in rows)
    write_whole(scores_path(place, document), text.encode("utf-8"))


def _row(score: Score) -> str:
    lines = ["[[campaign]]"]
    for name in ("what", "judged_on", "command", *_COUNTS, "earlier_text"):
        lines.append(f"{name} = {json.dumps(getattr(score, name))}")
    files = [f'"{name}" = "{value}"' for name, value in sorted(score.files.items())]
    return "\n".join([*lines, "", "[campaign.files]", *files, ""])


def stale(place: Path, document: str) -> list[str]:
    """What has changed under the rows that claim to be of the present text."""
    problems = []
    for score in load_scores(place, document):
        for name, known in {} if score.earlier_text else score.files.items():
            try:
                now = fingerprint(place, document, name)
            except Unjudged as error:
                now = error.message
            if now != known:
                problems.append(
                    f"spec/{document}/scores.toml: campaign {score.what}: {name} is not what was judged; run "
                    f"`{score.command} --record`, or set earlier_text = true"
                )
    return problems


def fingerprint(place: Path, document: str, name: str) -> str:
    """The hash of a text that a campaign rests on. Raises Unjudged when it is not there."""
    kind, _, rest = name.partition(" ")
    if kind == "run":
        runs = [run for run in load_runs(place, document) if run.id == rest]
        if not runs:
            raise Unjudged(f"{rest}: no such run")
        text = without_comments(cfg_text(place, runs[0]))
    elif kind == "program":
        files = files_of(place, [rest])
        if not files:
            raise Unjudged(f"{rest}: no such module")
        text = "\n".join(f"{module}\n{_python(path)}" for module, path in files.items())
    elif not (place / name).is_file():
        raise Unjudged(f"{name}: not found")
    else:
        text = _READ[Path(name).suffix](place / name)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:DIGITS]


def _python(path: Path) -> str:
    """A program without comments and empty lines: the same for every version of Python."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for token in tokenize.generate_tokens(io.StringIO("\n".join(lines) + "\n").readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column]
    return "\n".join(line.rstrip() for line in lines if line.strip())


def _toml(path: Path) -> str:
    """A register without what is said for people only."""
    try:
        return json.dumps(
            _facts(tomllib.loads(path.read_text(encoding="utf-8"))), sort_keys=True, default=str
        )
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path.name}: {error}") from None


def _facts(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _facts(inner) for key, inner in value.items() if key not in _PROSE}
    return [_facts(inner) for inner in value] if isinstance(value, list) else value


_READ: Mapping[str, Callable[[Path], str]] = {
    ".tla": lambda path: without_comments(path.read_text(encoding="utf-8")),
    ".toml": _toml,
    ".gz": contents,
}
