"""Judges one TLC run against its declaration: a pure function of declaration, cfg and outcome.

First the outcome alone gives a verdict word; then the declaration says whether that was expected. An outcome
that is cut off, contradicts itself or is not understood is never a pass.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from modeproof.registers.cfg import Cfg
from modeproof.registers.runs import Run
from modeproof.tlc.messages import OUT_OF_MEMORY, essence
from modeproof.tlc.process import Outcome

HOLDS = "HOLDS"
VIOLATED = "VIOLATED"
REACHED = "REACHED"
UNREACHED = "UNREACHED"
INCONCLUSIVE = "INCONCLUSIVE"
UNJUDGED = "UNJUDGED"

_EXIT = {"invariant": (12,), "property": (12, 13), "temporal": (13,), "deadlock": (11,)}
_MEMORY_SIGNS = ("OutOfMemoryError", "Too small maximum heap", "Could not reserve enough space")
_REACHED = re.compile(r'^<<"REACHED", "([^"]+)">>$')


@dataclass(frozen=True)
class Judgement:
    """A verdict word, the violated property if there is one, whether this was expected, and why not."""

    verdict: str
    as_expected: bool
    reason: str = ""
    violated: str = ""
    reached: tuple[str, ...] = ()

    @property
    def judged(self) -> bool:
        """False when no judgement was possible; the exit status is then 2."""
        return self.verdict not in (INCONCLUSIVE, UNJUDGED)

    @property
    def words(self) -> str:
        """The verdict as it is shown: a violation that was expected says so."""
        return f"{VIOLATED}, as expected" if self.verdict == VIOLATED and self.as_expected else self.verdict


def judge(run: Run, cfg: Cfg, cfg_sha256: str, outcome: Outcome) -> Judgement:
    """The judgement of one run. `cfg` and `cfg_sha256` are those of the file that TLC read."""
    found = _verdict(run, cfg, outcome)
    if not found.judged:
        return found
    problem = _declaration(run, cfg, cfg_sha256) or _expectation(run, found, outcome)
    return replace(found, as_expected=not problem, reason=problem)


def _unjudged(reason: str) -> Judgement:
    return Judgement(UNJUDGED, False, reason)


def _first_line(text: str) -> str:
    return " ".join(line.strip() for line in essence(text)[:3])[:300]


def _verdict(run: Run, cfg: Cfg, outcome: Outcome) -> Judgement:
    log = outcome.log
    if outcome.timed_out:
        return Judgement(INCONCLUSIVE, False, f"time limit of {run.timeout_s:g} s reached")
    if outcome.broken_off:
        return Judgement(INCONCLUSIVE, False, outcome.broken_off)
    if _out_of_memory(outcome):
        return Judgement(INCONCLUSIVE, False, f"out of memory with heap_mb = {run.heap_mb}")
    if outcome.status < 0:
        return _unjudged(f"TLC was killed by signal {-outcome.status}")
    if log.errors:
        code, text = log.errors[0]
        return _unjudged(f"TLC error {code}: {_first_line(text)}")
    if not log.version or not log.started:
        said = _first_line("\n".join([outcome.stderr, *log.unframed])) or "no output"
        return _unjudged(f"TLC did not start (exit status {outcome.status}): {said}")
    if log.broken:
        return _unjudged(f"TLC's log cannot be read: {log.broken}")
    if not log.finished:
        return _unjudged(f"TLC's log ends early (exit status {outcome.status})")
    if log.initially and log.violations:
        return _violation(cfg, outcome)
    if log.counts is None or not log.final:
        return _unjudged("TLC's log has no final counts")
    if log.violations:
        return _violation(cfg, outcome)
    if outcome.status != 0 or not log.success:
        return _unjudged(f"TLC ended with exit status {outcome.status} and no verdict")
    if log.counts.queue != 0:
        return _unjudged(f"TLC left {log.counts.queue} states unexplored")
    return _witnesses(run, outcome) if run.kind == "WIT" else Judgement(HOLDS, False)


def _out_of_memory(outcome: Outcome) -> bool:
    return outcome.status != 0 and (
        any(code in OUT_OF_MEMORY for code, _ in outcome.log.errors)
        or outcome.status == 3
        or any(sign in text for sign in _MEMORY_SIGNS for text in (outcome.stderr, *outcome.log.unframed))
        or any(sign in text for sign in _MEMORY_SIGNS for _, text in outcome.log.errors)
    )


def _violation(cfg: Cfg, outcome: Outcome) -> Judgement:
    log = outcome.log
    kind, name = log.violations[0]
    if log.success or outcome.status not in _EXIT.get(kind, ()):
        return _unjudged(f"TLC reports a violated {kind} but ended with exit status {outcome.status}")
    if kind == "temporal":
        # TLC does not name it: only a cfg with a single property leaves no doubt.
        name = cfg.properties[0] if len(cfg.properties) == 1 else ""
    if kind == "property" and not name and len(cfg.properties) == 1:
        name = cfg.properties[0]  # of an initial state TLC says the place of the formula, not its name
    if kind == "deadlock":
        name = "deadlock"
    if [state.number for state in log.trace] != list(range(1, len(log.trace) + 1)) or not log.trace:
        return _unjudged("TLC's counterexample is incomplete")
    return Judgement(VIOLATED, False, violated=name)


def _witnesses(run: Run, outcome: Outcome) -> Judgement:
    if not outcome.printed_all:
        return _unjudged("the model printed more distinct lines than can be kept")
    reached: set[str] = set()
    for raw in outcome.printed:
        line = raw.decode("utf-8", "replace")
        if not line.startswith('<<"REACHED"'):
            continue
        match = _REACHED.match(line)
        if match is None:
            return _unjudged(f"a witness line cannot be read: {line[:100]}")
        reached.add(match.group(1))
    verdict = REACHED if set(run.witnesses) <= reached else UNREACHED
    return Judgement(verdict, False, reached=tuple(sorted(reached)))


def _declaration(run: Run, cfg: Cfg, cfg_sha256: str) -> str:
    """What is wrong with the declaration against the cfg that TLC read; empty when nothing is."""
    if run.kind != "WIT":  # a WIT run shows its witnesses; their list is never empty
        if not cfg.checked:
            return f"{run.config} checks no property"
        if not run.properties:
            return "runs.toml lists no property"
    if missing := [name for name in run.properties if name not in cfg.checked]:
        return f"{run.config} does not check {', '.join(missing)}"
    if extra := [name for name in cfg.checked if name not in run.properties]:
        return f"{run.config} checks {', '.join(extra)}, which runs.toml does not list"
    if run.property and run.property not in (*cfg.checked, "deadlock"):
        return f"{run.config} does not check {run.property}"
    if run.kind == "LIVE" and len(cfg.properties) != 1:
        return f"{run.config} must check exactly one temporal property, it checks {len(cfg.properties)}"
    if cfg.view and run.kind == "LIVE":
        return f"{run.config} has a VIEW, which makes a liveness run unsound"
    if run.base:  # the row itself is the pin
        return ""
    if run.cfg_sha256 is None:
        return "not pinned yet: cfg_sha256"
    if run.cfg_sha256 != cfg_sha256:
        return f"{run.config} was changed since its counts were pinned"
    return ""


def _expectation(run: Run, found: Judgement, outcome: Outcome) -> str:
    """What differs from the expectation; empty when nothing does."""
    if run.kind == "NEG":
        return _expected_violation(run, found, outcome)
    if found.verdict == VIOLATED:
        return f"{found.violated or 'a temporal property'} is violated"
    if found.verdict == UNREACHED:
        return "not reached: " + ", ".join(name for name in run.witnesses if name not in found.reached)
    if unknown := [name for name in found.reached if name not in run.witnesses]:
        return f"reached, but not listed: {', '.join(unknown)}"
    return _counts(run, outcome) or _graph(run, outcome)


def _expected_violation(run: Run, found: Judgement, outcome: Outcome) -> str:
    if found.verdict != VIOLATED:
        return f"{run.property} was to be violated, and is not"
    if found.violated != run.property:
        return f"{found.violated or 'an unnamed property'} is violated, not {run.property}"
    if run.workers == 1:
        if run.trace_length is None:
            return "not pinned yet: trace_length"
        if len(outcome.log.trace) != run.trace_length:
            return f"the counterexample has {len(outcome.log.trace)} states, not {run.trace_length}"
    return _counts(run, outcome) if run.distinct is not None or run.generated is not None else ""


def _counts(run: Run, outcome: Outcome) -> str:
    """The pinned counts; of a violated run they are those so far, and only those that are pinned."""
    counts = outcome.log.counts
    if counts is None:
        return "TLC counted no states, so none can be pinned"
    for name, pinned, got in (
        ("distinct", run.distinct, counts.distinct),
        ("generated", run.generated, counts.generated),
    ):
        if pinned is None and run.kind == "NEG":
            continue
        if pinned is None:
            return f"not pinned yet: {name}"
        if pinned != got:
            return f"{name} states: {got:,}, pinned {pinned:,}"
    return ""


def _graph(run: Run, outcome: Outcome) -> str:
    if run.graph is None:
        return ""
    log = outcome.log
    states, edges = log.tags.get("STATE", 0), log.tags.get("EDGE", 0)
    assert log.counts is not None
    if log.initial is None:
        return "TLC did not say how many initial states it generated"
    if edges != log.counts.generated - log.initial:
        return (
            f"{edges:,} edges were printed, but TLC took {log.counts.generated - log.initial:,} transitions"
        )
    if states != log.counts.distinct:
        return f"{states:,} states were printed, but TLC found {log.counts.distinct:,}"
    for name, pinned, got in (("states", run.graph.states, states), ("edges", run.graph.edges, edges)):
        if pinned is None:
            return f"not pinned yet: graph.{name}"
        if pinned != got:
            return f"graph {name}: {got:,}, pinned {pinned:,}"
    return ""
