"""What a machine checks of a judgement on a tool: from texts and evidence, each time a report is made."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from modeproof.registers.made import cfg_text
from modeproof.registers.runs import Run
from modeproof.registers.tools import Condition
from modeproof.report.claims import LANE, texts_of
from modeproof.report.sources import Evidence, Figure, Sources, few

FINGERPRINTS = 2**64
"""So many fingerprints of states there are."""


@dataclass(frozen=True)
class Met:
    """Whether a condition holds (None: there is nothing to judge it by), what it says, and what was found."""

    good: bool | None
    says: str
    found: str
    figure: Figure | None = None


def judged(sources: Sources, condition: Condition) -> Met:
    """Judge one condition."""
    return _JUDGES[condition.name](sources, condition)


def _met(says: str, bad: list[str], count: int, lost: list[str] | None = None) -> Met:
    """What came of it: `bad` speaks against it; of `lost` nothing is known, for it is stale or not there."""
    if bad:
        return Met(False, says, f"not so: {few(sorted(set(bad)))}")
    if lost:
        return Met(None, says, f"not there, or of another text: {few(sorted(set(lost)))}")
    return Met(True, says, f"{count} looked at") if count else Met(None, says, "nothing to judge it by")


def _of(condition: Condition) -> str:
    return f" of kind {', '.join(condition.of)}" if condition.of else ""


def _words(sources: Sources, condition: Condition) -> Met:
    bad, count = [], 0
    for document in sources.documents.values():
        for module in texts_of(sources, document).modules.values():
            count += 1
            bad += [f"{word} in {module.file}" for word in condition.value if word in module.words]
    return _met(f"no module uses {', '.join(condition.value)}", bad, count)


def _cfgs(sources: Sources, condition: Condition) -> Met:
    bad, count = [], 0
    form = re.compile(rf"^[ \t]*(?:{'|'.join(map(re.escape, condition.value))})\b", re.MULTILINE)
    for document in sources.documents.values():
        for run in document.runs:
            if condition.of and run.kind not in condition.of:
                continue
            if run.cfg and sources.content(f"spec/{document.name}/{run.cfg}") is None:
                continue
            count += 1
            if form.search(cfg_text(sources.root, run)):
                bad.append(run.id)
    return _met(f"no cfg of a run{_of(condition)} has {', '.join(condition.value)}", bad, count)


def _texts(sources: Sources, condition: Condition) -> Met:
    bad, count = [], 0
    folder = sources.root / "proofs"
    for path in sorted(folder.rglob("*.py")):
        shown = path.relative_to(sources.root).as_posix()
        content = (sources.content(shown) or b"").decode("utf-8", "replace")
        count += 1
        bad += [f"{text} in {shown}" for text in condition.value if text in content]
    return _met(f"no file of proofs/ has {', '.join(condition.value)}", bad, count)


def _runs(sources: Sources, condition: Condition) -> Iterator[tuple[Run, Evidence]]:
    for name, document in sources.documents.items():
        for run in document.runs:
            one = sources.evidence[name].get(run.id)
            if one is not None and (not condition.of or run.kind in condition.of):
                yield run, one


def _each_run(
    says: str, good: Callable[[Condition, Evidence], bool | None]
) -> Callable[[Sources, Condition], Met]:
    """A condition on each run of the model checker that has evidence; None: its evidence does not say."""

    def judge(sources: Sources, condition: Condition) -> Met:
        answers = [
            (run.id, None if one.changed else good(condition, one)) for run, one in _runs(sources, condition)
        ]
        bad = [id for id, answer in answers if answer is False]
        lost = [id for id, answer in answers if answer is None]
        return _met(says.format(condition.value) + _of(condition), bad, len(answers), lost)

    return judge


def _option(condition: Condition, piece: Evidence) -> bool | None:
    command = piece.result.get("tlc_command")
    return None if command is None else f" {condition.value} " in f" {command} "


def _no_option(condition: Condition, piece: Evidence) -> bool | None:
    given = _option(condition, piece)
    return None if given is None else not given


def _workers(condition: Condition, piece: Evidence) -> bool | None:
    workers: Any = piece.result.get("workers")
    return None if workers is None else bool(workers == condition.value)


def _queue(condition: Condition, piece: Evidence) -> bool | None:
    if piece.record["verdict"] not in ("HOLDS", "REACHED"):
        return True
    queue: Any = piece.result.get("queue")
    return None if queue is None else bool(queue == 0)


def _pinned(condition: Condition, piece: Evidence) -> bool | None:
    pinned: Any = piece.result.get("jar_pinned")
    return None if pinned is None else pinned is True


def _collision(sources: Sources, condition: Condition) -> Met:
    """TLC's own estimate, from its counts; the largest of all runs."""
    worst, where, count = 0.0, "", 0
    for run, one in _runs(sources, condition):
        distinct, generated = one.result.get("distinct"), one.result.get("generated")
        if isinstance(distinct, int) and isinstance(generated, int):
            count += 1
            estimate = distinct * (generated - distinct) / FINGERPRINTS
            if estimate >= worst:
                worst, where = estimate, one.path
                name = run.id
    says = f"the estimate of a collision of fingerprints is below {condition.value:g} for every run"
    if not count:
        return Met(None, says, "nothing to judge it by")
    return Met(
        worst < condition.value, says, f"largest of {count} runs, {name}", Figure(f"{worst:.1e}", where)
    )


def _solvers(sources: Sources, condition: Condition) -> Met:
    bad: list[str] = []
    lost: list[str] = []
    count = 0
    for piece in sources.everything():
        if piece.record["kind"] != "proof":
            continue
        if piece.changed:
            lost.append(piece.id)
            continue
        for query in piece.result.get("queries", ()):
            count += 1
            if not query["z3"] == query["cvc5"] == query["expected"]:
                bad.append(f"{piece.id}: {query['name']}")
    return _met("both solvers give the expected answer to every question", bad, count, lost)


def _compared(sources: Sources, condition: Condition) -> Met:
    bad: list[str] = []
    lost: list[str] = []
    count = 0
    for name, document in sources.documents.items():
        found = {
            str(piece.result["run"]).rpartition("/")[2]: piece
            for piece in sources.of_kind(name, "conformance")
            if "implementation_states" in piece.result
        }
        for run in document.runs:
            if run.graph is None or LANE not in run.lanes:
                continue
            count += 1
            one = found.get(run.id)
            if one is None or one.changed:
                lost.append(run.id)
            elif not one.record["as_expected"]:
                bad.append(run.id)
    return _met("each complete graph of a device equals the implementation", bad, count, lost)


_JUDGES: dict[str, Callable[[Sources, Condition], Met]] = {
    "word_absent": _words,
    "cfg_absent": _cfgs,
    "text_absent": _texts,
    "option": _each_run("TLC was given {} in every run", _option),
    "option_absent": _each_run("TLC was given {} in no run", _no_option),
    "workers": _each_run("workers: {} in every run", _workers),
    "queue_empty": _each_run("nothing was left unexplored in any run that holds", _queue),
    "jar_pinned": _each_run("the jar was the pinned one in every run", _pinned),
    "collision_below": _collision,
    "solvers_agree": _solvers,
    "compared": _compared,
}
