"""Judges one mutant: tier after tier, until it is known what becomes of it.

KILLED: a named property is false in a state or step that the mutant reaches. EQUIVALENT: nothing is broken,
and the complete reachable graph of the device equals the original's: views, rows of outputs and transitions;
which step name goes with a transition is left out, for a name decides nothing. INVALID: TLC does not accept
the text, or an expression of the mutant has no value; no property killed it, and it counts nowhere.
UNMEASURED: a limit of time or memory came first. SURVIVED: none of these.
"""

from __future__ import annotations

import shutil
import tempfile
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from modeproof.ground.errors import Unjudged
from modeproof.registers.made import cfg_text
from modeproof.strength.mutant import Mutant, applied
from modeproof.strength.register import Strength, Tier
from modeproof.strength.trial import BROKEN, MODULE, Trial, make_trial
from modeproof.tlc.messages import OUT_OF_MEMORY, Counts, essence
from modeproof.tlc.parse_tree import ParseTree, read_tree
from modeproof.tlc.process import Outcome, run_tlc
from modeproof.tlc.toolchain import Toolchain

CLEAN, BROKE, EQUAL, DIFFERS, ERROR, LIMIT = "clean", "broken", "equal", "differs", "error", "limit"
_OUT_OF_HEAP = 3
"""Exit status of Java under -XX:+ExitOnOutOfMemoryError."""


@dataclass(frozen=True)
class Answer:
    """What one tier says. `result` is clean, broken, equal, differs, error or limit; `asked` the properties
    that it was about, `broken` those found false, in that order; `complete` whether the exploration went to
    its end.
    """

    tier: str
    result: str
    asked: tuple[str, ...] = ()
    broken: tuple[str, ...] = ()
    detail: str = ""
    complete: bool = True
    seconds: float = 0.0
    distinct: int = 0
    generated: int = 0


@dataclass(frozen=True)
class Verdict:
    """KILLED, EQUIVALENT, SURVIVED, INVALID or UNMEASURED; `killers`: the properties, first one first."""

    word: str
    answers: tuple[Answer, ...]
    killers: tuple[str, ...] = ()
    reason: str = ""

    @property
    def seconds(self) -> float:
        """Wall-clock time of all tiers."""
        return sum(answer.seconds for answer in self.answers)


@dataclass
class Bench:
    """What all mutants of a document share: the original's parse trees, trials and printed graphs.

    first: a mutant is explored to the first property that is false, which is quicker and names no other.
    """

    place: Path
    strength: Strength
    tools: Toolchain
    first: bool = False
    _trees: dict[str, ParseTree] = field(default_factory=dict)
    _trials: dict[str, Trial] = field(default_factory=dict)
    _graphs: dict[str, frozenset[int]] = field(default_factory=dict)
    _passed: set[str] = field(default_factory=set)
    _guard: threading.RLock = field(default_factory=threading.RLock)

    @property
    def folder(self) -> Path:
        """The document's folder of the specification."""
        return self.place / "spec" / self.strength.document

    def tree(self, module: str) -> ParseTree:
        """The parse tree behind a root module."""
        with self._guard:
            if module not in self._trees:
                common = self.place / "spec" / "common"
                library = common if common.is_dir() else None
                self._trees[module] = read_tree(self.folder, module, self.tools, library)
            return self._trees[module]

    def tree_of(self, module: str) -> ParseTree:
        """The parse tree of the first tier that judges a device module."""
        return self.tree(self.strength.tiers_of(module)[0].run.module)

    def trial(self, tier: Tier) -> Trial:
        """The generated module and cfg of a tier."""
        with self._guard:
            if tier.id not in self._trials:
                tree = self.tree(tier.run.module)
                self._trials[tier.id] = make_trial(tree, tier, cfg_text(self.place, tier.run))
            return self._trials[tier.id]

    def texts(self, tier: Tier) -> Mapping[str, str]:
        """The modules of ours that a tier uses, by name."""
        tree = self.tree(tier.run.module)
        return {name: "\n".join(lines) + "\n" for name, lines in tree.texts.items()}

    def control(self, tier: Tier) -> Answer:
        """The tier on the original: nothing may be broken, and a graph is remembered.

        Raises Unjudged when the original does not pass: then no mutant can be judged by this tier.
        """
        with self._guard:
            lines: set[int] = set()
            names = _Names()
            outcome = self._run(tier, None, _Collect(lines) if tier.asks == "graph" else names)
            answer = _answer(tier, outcome, self.trial(tier).asked, names.found, "", CLEAN)
            if answer.result != CLEAN:
                what = ", ".join(answer.broken) or answer.detail
                raise Unjudged(f"tier {tier.id} does not pass on the original: {answer.result}: {what}")
            if tier.asks == "graph":
                if not lines:
                    raise Unjudged(f"tier {tier.id}: the original printed no graph")
                self._graphs[tier.id] = frozenset(lines)
            self._passed.add(tier.id)
            return answer

    def ask(self, tier: Tier, mutant: Mutant) -> Answer:
        """One tier's answer about one mutant."""
        if tier.asks != "graph":
            names = _Names(self.first)
            outcome = self._run(tier, mutant, names)
            answer = _answer(tier, outcome, self.trial(tier).asked, names.found, "", CLEAN)
            if answer.result != CLEAN:
                self._original_passes(tier)
            return answer
        self._original_passes(tier)
        compare = _Compare(self._graphs[tier.id])
        outcome = self._run(tier, mutant, compare)
        if outcome.stopped:
            return _answer(tier, outcome, (), (), compare.strange, DIFFERS)
        if compare.missing:
            return _answer(
                tier, outcome, (), (), f"{compare.missing} lines of the original's graph are missing", DIFFERS
            )
        return _answer(tier, outcome, (), (), "", EQUAL)

    def _original_passes(self, tier: Tier) -> None:
        """What a tier says against a mutant counts only when it says nothing against the original."""
        with self._guard:
            if tier.id not in self._passed:
                self.control(tier)

    def _run(self, tier: Tier, mutant: Mutant | None, watch: Callable[[bytes], bool]) -> Outcome:
        trial = self.trial(tier)
        place = Path(tempfile.mkdtemp(prefix="modeproof-strength."))
        try:
            folder = place / "spec" / self.strength.document
            folder.mkdir(parents=True)
            for name, text in self.texts(tier).items():
                if mutant is not None and name == mutant.module:
                    text = applied(self.tree(tier.run.module).texts[name], mutant.edit)
                (folder / f"{name}.tla").write_text(text, encoding="utf-8")
            (folder / f"{MODULE}.tla").write_text(trial.module, encoding="utf-8")
            (folder / "trial.cfg").write_text(trial.cfg, encoding="utf-8")
            run = msgspec.structs.replace(
                tier.run,
                base="",
                kind="MC",
                module=MODULE,
                cfg="trial.cfg",
                workers=1,
                heap_mb=tier.heap_mb,
                timeout_s=tier.timeout_s,
                graph=None,
            )
            return run_tlc(place, run, self.tools, watch=watch)
        finally:
            shutil.rmtree(place, ignore_errors=True)


class _Names:
    """Remembers the names of broken properties in the order in which they are printed."""

    def __init__(self, first: bool = False) -> None:
        self.found: tuple[str, ...] = ()
        self._first = first

    def __call__(self, line: bytes) -> bool:
        match = BROKEN.fullmatch(line)
        if match is not None and (name := match[1].decode()) not in self.found:
            self.found += (name,)
        return self._first and bool(self.found)


class _Collect:
    """Remembers each printed line by its hash, within this process."""

    def __init__(self, lines: set[int]) -> None:
        self._lines = lines

    def __call__(self, line: bytes) -> bool:
        self._lines.add(hash(line))
        return False


class _Compare:
    """Looks for a line that the original does not print; counts what is missing at the end."""

    def __init__(self, original: frozenset[int]) -> None:
        self._original = original
        self._seen: set[int] = set()
        self.strange = ""

    def __call__(self, line: bytes) -> bool:
        key = hash(line)
        if key not in self._original:
            self.strange = line.decode("utf-8", "replace")
            return True
        self._seen.add(key)
        return False

    @property
    def missing(self) -> int:
        return len(self._original) - len(self._seen)


def _answer(
    tier: Tier, outcome: Outcome, asked: tuple[str, ...], names: tuple[str, ...], detail: str, good: str
) -> Answer:
    log = outcome.log
    temporal = {"temporal", "property"} & {kind for kind, _ in log.violations}
    broken = tier.run.properties if tier.asks == "liveness" and temporal else names
    counts = log.counts or Counts(0, 0, 0)
    finished = outcome.status == 0 and log.success and log.finished and not log.broken
    result = good
    if outcome.stopped:
        result = DIFFERS
    elif outcome.timed_out or _no_memory(outcome):
        what = f"{tier.timeout_s:.0f} s" if outcome.timed_out else f"{tier.heap_mb} MiB"
        result, detail = LIMIT, f"the limit of {what} came first"
    elif not finished and not (tier.asks == "liveness" and broken):
        result, detail = ERROR, _complaint(outcome)
    if broken:
        result = BROKE
    complete = finished or (tier.asks == "liveness" and bool(broken)) or (outcome.stopped and not broken)
    return Answer(
        tier=tier.id,
        result=result,
        asked=asked if complete else broken,
        broken=broken,
        detail=detail,
        complete=complete,
        seconds=round(outcome.seconds, 2),
        distinct=counts.distinct,
        generated=counts.generated,
    )


def _no_memory(outcome: Outcome) -> bool:
    return outcome.status == _OUT_OF_HEAP or any(code in OUT_OF_MEMORY for code, _ in outcome.log.errors)


def _complaint(outcome: Outcome) -> str:
    """One line that says why TLC did not come to its end."""
    said = [
        line.strip() for line in outcome.log.unframed if not line.startswith(("***", "Semantic", "Parsing"))
    ]
    for _, text in outcome.log.errors:
        said += essence(text)
    return (
        " ".join(line for line in said if line)[:300]
        or outcome.stderr[-300:]
        or f"exit status {outcome.status}"
    )


def judge(bench: Bench, mutant: Mutant, complete: bool = False) -> Verdict:
    """What becomes of a mutant. `complete`: tiers marked so are asked about killed mutants too."""
    answers: list[Answer] = []
    tiers = bench.strength.tiers_of(mutant.module)
    deciding = {tier.id for tier in tiers if tier.decides}
    equal: set[str] = set()
    killers: dict[str, None] = {}
    differs = ""
    for tier in tiers:
        always = tier.when == "always" or (complete and tier.when == "complete")
        if killers and not always:
            continue
        if tier.asks == "graph" and differs:
            continue
        answer = bench.ask(tier, mutant)
        answers.append(answer)
        killers.update(dict.fromkeys(answer.broken))
        if answer.result == EQUAL and tier.decides:
            equal.add(tier.id)
            if equal == deciding and not killers:
                return Verdict("EQUIVALENT", tuple(answers))
        elif answer.result == DIFFERS:
            differs = answer.detail
        elif answer.result == ERROR:
            if not killers:
                return Verdict("INVALID", tuple(answers), reason=answer.detail)
            break
    return _verdict(answers, tuple(killers), differs)


def _verdict(answers: Sequence[Answer], killers: tuple[str, ...], differs: str) -> Verdict:
    if killers:
        cut_off = [answer.tier for answer in answers if not answer.complete]
        return Verdict(
            "KILLED",
            tuple(answers),
            killers,
            f"not explored to the end in {', '.join(cut_off)}" if cut_off else "",
        )
    limits = [answer for answer in answers if answer.result == LIMIT]
    if limits:
        return Verdict("UNMEASURED", tuple(answers), reason=f"tier {limits[0].tier}: {limits[0].detail}")
    return Verdict("SURVIVED", tuple(answers), reason=differs)


def as_record(verdict: Verdict) -> dict[str, Any]:
    """The verdict as JSON."""
    return {
        "verdict": verdict.word,
        "killers": list(verdict.killers),
        "reason": verdict.reason,
        "answers": [asdict(answer) for answer in verdict.answers],
    }
