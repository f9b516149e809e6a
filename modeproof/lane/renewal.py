"""What `modeproof renew` does for one document, in a copy of the tree: it looks what is stale, lets the
specification judge the change, and only then makes it anew.
"""

from __future__ import annotations

import contextlib
import gzip
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from modeproof.graph.device import open_runs
from modeproof.graph.implementation import REFERENCE
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.progress import Progress
from modeproof.lane.prove_command import prove_documents
from modeproof.lane.render import rendered
from modeproof.lane.walks import walk_evidence
from modeproof.registers.citations import read_sources
from modeproof.registers.document_page import check_document_page
from modeproof.registers.files import read_toml
from modeproof.registers.killers import load_killers, stamps_of
from modeproof.registers.load import load_document
from modeproof.registers.pins import check_pins, load_pins, repin
from modeproof.registers.refuting import load_refuting
from modeproof.registers.refuting import stamps_of as refuting_stamps
from modeproof.registers.replay import has_replay
from modeproof.registers.rows import Document
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.vector_files import ROOM, unfit
from modeproof.simulate.recorded import known, record, unrecorded
from modeproof.strength.refute import judge_refuting
from modeproof.suites.build import make_graphs, published, ready_suite, suite_file
from modeproof.suites.builtin_comparison import compare_run, difference_text
from modeproof.suites.kinds import SUITES
from modeproof.suites.publish import publish
from modeproof.suites.write import NoCases
from modeproof.tlc.check import Checked, check_all, pinned_anew, read_cfg
from modeproof.tlc.check_command import line_of
from modeproof.tlc.killers import judge_killers
from modeproof.tlc.repin import Move, apply, moves
from modeproof.tlc.rests import why_stale
from modeproof.tlc.toolchain import find_toolchain

PACKS = Path("examples/faulty/run.py")
"""The script that keeps vectors of faulty programs, where a tree has it."""
PAGES = {"awl": (), "st": ("--target",)}
"""Beside it, a script for each page about faulty programs in other languages, with its edits in a file of the
same name; and what comes before a target where it can judge the programs of one alone."""

SMALL = 300_000
"""Generated states of a run of seconds: it is judged anew though it is in the exhaustive lane alone."""


class Refused(Exception):
    """The specification does not accept the change, or a pin would move without a reason."""


@dataclass(frozen=True)
class Stale:
    """What of a document was made from another text. `pins` are names of pinned texts."""

    pins: tuple[str, ...] = ()
    killers: tuple[str, ...] = ()
    refuted: tuple[str, ...] = ()
    targets: tuple[str, ...] = ()
    stories: tuple[str, ...] = ()
    page: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return any((self.pins, self.killers, self.refuted, self.targets, self.stories, self.page))

    def __str__(self) -> str:
        parts = {
            "pins": self.pins,
            "edits": self.killers,
            "edits of the code": self.refuted,
            "vectors": self.targets,
            "stories": self.stories,
            "page": self.page,
        }
        return "; ".join(f"{name}: {', '.join(found)}" for name, found in parts.items() if found)


@dataclass
class Renewal:
    """The work on one document. `reason` gives the reason for moved pins and raises Refused without one."""

    tree: Path
    name: str
    reason: Callable[[list[str]], str]
    progress: Progress
    accepted: set[str] = field(default_factory=set)
    """Targets that conform, as far as they were compared now."""
    moved: list[str] = field(default_factory=list)

    @property
    def document(self) -> Document:
        return load_document(self.tree, self.name)


def stale_of(place: Path, name: str) -> Stale:
    """What of a document is stale. Raises Unjudged when a register cannot be read."""
    document = load_document(place, name)
    sources = read_sources(document)
    tables = ("checked.", "theorems.")
    pins = [one.place for one in check_pins(document, sources) if one.place.startswith(tables)]
    stamps = stamps_of(document, sources, load_killers(place, name))
    refuting = refuting_stamps(document, sources, load_refuting(place, name))
    known = load_pins(document)
    targets = [target for target, of in published(place).items() if of == name]
    page = [one.file for one in check_document_page(document, sources)]
    return Stale(
        tuple(pins),
        _moved(stamps, known.killers),
        _moved(refuting, known.refuted),
        tuple(target for target in targets if unfit(place, target)),
        tuple(unrecorded(document)),
        tuple(dict.fromkeys(page)),
    )


def _moved(stamps: Mapping[str, object], known: Mapping[str, str]) -> tuple[str, ...]:
    """The edits that were not judged on the present text, and those of which only the stamp is left."""
    judged = {edit for edit, stamp in stamps.items() if known.get(edit) == stamp}
    return tuple(edit for edit in (*stamps, *(known.keys() - stamps.keys())) if edit not in judged)


def renew_document(work: Renewal, stale: Stale) -> None:
    """Make everything anew that is stale, in this order. Raises Refused, and Unjudged."""
    _accept(work, stale)
    _pins(work, stale)
    _killers(work, stale)
    _refuted(work, stale)
    _vectors(work, stale)
    _stories(work, stale)
    _page(work)
    if left_over := stale_of(work.tree, work.name):
        raise Unjudged(f"{work.name}: still of another text after all was made anew: {left_over}")


# ------------------------------------------------------------ does it accept the change


def _accept(work: Renewal, stale: Stale) -> None:
    """Ask the specification: every run that may have changed, then every target, both ways."""
    runs = [run for run in _runs_to_check(work, stale) if why_stale(work.tree, run)]
    if runs:
        work.progress.say(f"{work.name}: {len(runs)} runs of TLC, for the specification has changed")
        tools = find_toolchain()
        done = check_all(work.tree, runs, tools, work.progress, lambda one: work.progress.say(line_of(one)))
        _judge_runs(work, done, tools)
    for target in stale.targets:
        conform(work, target)


def _runs_to_check(work: Renewal, stale: Stale) -> Iterator[Run]:
    """If vectors or stories are stale, the specification has changed: every run of lane full and every small
    one, and those of the stories. If only pinned texts have, the runs that check one of them. A story of a
    new run has changed nothing.
    """
    told = known(work.document)
    checked = {pin.removeprefix("checked.") for pin in stale.pins}
    for run in load_runs(work.tree, work.name):
        full = "full" in run.lanes or (run.generated or 0) <= SMALL
        changed = (
            stale.targets or told & {*stale.stories} or checked & {*run.properties, *_names(work.tree, run)}
        )
        if run.id in stale.stories or (full and changed):
            yield run


def _names(tree: Path, run: Run) -> tuple[str, ...]:
    cfg = read_cfg(tree, run)[0]
    return (*cfg.checked, *cfg.constraints, *cfg.action_constraints, cfg.view, cfg.specification)


def _judge_runs(work: Renewal, done: list[Checked], tools: object) -> None:
    """Refuse what is another verdict; move the counts of the others, with a reason."""
    changes: dict[str, tuple[Move, ...]] = {}
    wrong: list[str] = []
    again: list[Checked] = []
    for checked in (one for one in done if one.status):
        if not checked.judgement.judged:
            raise Unjudged(f"{checked.run.name}: {checked.judgement.reason}")
        try:
            found = moves(work.tree, checked)
        except Unjudged as error:
            wrong.append(error.message)
            continue
        row = checked.run.of[0] if checked.run.of else checked.run.id
        changes[row] = (*changes.get(row, ()), *found)
        again.append(checked)
    if wrong:
        raise Refused("\n".join(["the specification does not hold any more:", *wrong]))
    if changes:
        lines = [f"{work.name}/{id}: {move}" for id, found in changes.items() for move in found]
        apply(work.tree, {work.name: changes}, work.reason(lines))
        for checked in again:
            pinned_anew(work.tree, checked, find_toolchain())
        work.moved += lines


def conform(work: Renewal, target: str) -> None:
    """Compare the reference with every graph of a target, both ways. Raises Refused with the scans."""
    if target in work.accepted:
        return
    runs = open_runs(work.tree, work.name, target)
    make_graphs(work.tree, runs, quiet=True)
    for run in runs:
        work.progress.say(f"{target}: does the reference implementation do what {run.id} says?")
        found = compare_run(work.tree, run, REFERENCE, work.progress)
        if not found.equal:
            said = f"{target}: specification and reference implementation differ, so nothing is published:"
            raise Refused(f"{said}\n{difference_text(run, found)}")
    work.accepted.add(target)


# ------------------------------------------------------------ what is made


def _pins(work: Renewal, stale: Stale) -> None:
    """Prove the theorems whose texts have changed, then pin what is said now."""
    if not stale.pins:
        return
    document = work.document
    sources = read_sources(document)
    there = {theorem.name for module in sources.proofs for theorem in module.theorems}
    names = [name for pin in stale.pins if (name := pin.removeprefix("theorems.")) in there]
    if names:
        records, troubles = prove_documents(work.tree, [work.name], work.progress, tuple(names))
        if troubles:
            raise Unjudged("; ".join(troubles.values()))
        lost = [f"{one['id']}: {one['verdict']} {one['reason']}" for one in records if not one["as_expected"]]
        if lost:
            raise Refused("\n".join(["the code does not do what a theorem says now:", *lost]))
    work.moved += repin(document, sources, work.reason(list(stale.pins)))


def _killers(work: Renewal, stale: Stale) -> None:
    """Judge the edits that were judged on another text, or whose property is another one now."""
    if not stale.killers:
        return
    lost = judge_killers(work.tree, work.name, find_toolchain(), False, work.progress.say)
    if lost:
        said = "with its edit in killers.toml this property holds all the same, so it says nothing:"
        raise Refused("\n".join([said, *lost, "undo what weakened it, or give it another edit"]))
    work.moved.append(f"{work.name}: {len(stale.killers)} edits judged anew, each breaks its property")


def _refuted(work: Renewal, stale: Stale) -> None:
    """Ask the theorems of the edits of the code that were judged on another text, or of other theorems."""
    if not stale.refuted:
        return
    lost = judge_refuting(work.tree, work.name, False, work.progress.say)
    if lost:
        said = "these theorems hold of the code with the edit that is to refute them, so they say nothing:"
        raise Refused("\n".join([said, *lost, "undo what weakened them, or give them another edit"]))
    work.moved.append(f"{work.name}: {len(stale.refuted)} edits of the code judged anew, each refutes")


def _vectors(work: Renewal, stale: Stale) -> None:
    """Build the suites of each target and put those that are others into the room."""
    tree = work.tree
    for target in stale.targets:
        for suite in [name for name, kind in SUITES.items() if kind.published]:
            try:
                ready_suite(tree, work.name, target, suite, work.progress.say)
            except NoCases:
                suite_file(tree, work.name, target, suite).unlink(missing_ok=True)
    if not stale.targets:
        return
    before = {target: _cases(tree, target) for target in stale.targets}
    done = publish(tree, dict.fromkeys(stale.targets, work.name), whole=False)
    for target in stale.targets:
        own = [name for name in (*done.written, *done.removed) if name.startswith(f"{ROOM}/{target}/")]
        said = f"{len(own)} suites are others now" if own else "the suites are the same"
        work.moved.append(f"{work.name}: {target}: {said}")
        if own:
            _packs(work, target)
        if _cases(tree, target) != before[target]:
            _pages_of_faults(work, target)


def _cases(tree: Path, target: str) -> dict[str, bytes]:
    """The cases of each published suite of a target; without the header, which names their sources."""
    return {
        path.name: gzip.decompress(path.read_bytes()).partition(b"\n")[2]
        for path in (tree / ROOM / target).glob("*.jsonl.gz")
    }


def _packs(work: Renewal, target: str) -> None:
    """Take the vectors of faulty programs anew, of the suites that are not published."""
    script = work.tree / PACKS
    if not script.is_file():
        return

    def call(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(script), "--program", target, *words]
        return subprocess.run(command, cwd=work.tree, capture_output=True, text=True, check=False)

    for suite in call("--unpublished").stdout.split():
        with contextlib.suppress(NoCases):
            ready_suite(work.tree, work.name, target, suite, work.progress.say)
    done = call("--renew", str(suite_file(work.tree, work.name, target, "brief").parent), "--render")
    if done.returncode == 2 and "no pack of" not in done.stderr:
        raise Unjudged(f"{PACKS}: {done.stderr.strip()}")
    if done.returncode == 1:
        wrong = [line for line in done.stdout.splitlines() if line.startswith("NOT")]
        raise Refused(
            "\n".join([f"the C program of {target} and its faults do not do what they should:", *wrong])
        )


def _pages_of_faults(work: Renewal, target: str) -> None:
    """Judge the faulty programs of a target in other languages by its cases, and make their pages anew."""
    for name, option in PAGES.items():
        script = work.tree / PACKS.with_name(f"{name}.py")
        if not script.is_file():
            continue
        edits = read_toml(work.tree, script.with_suffix(".toml"))["fault"]
        if target not in {Path(row["file"]).stem for row in edits}:
            continue
        work.progress.say(f"{target}: does each faulty program of {name}.toml get its verdict?")
        chosen = [*option, target] if option else []
        command = [sys.executable, str(script), "--render", *chosen]
        done = subprocess.run(command, cwd=work.tree, capture_output=True, text=True, check=False)
        if done.returncode == 2:
            raise Unjudged(f"{script.relative_to(work.tree)}: {done.stderr.strip()}")
        if done.returncode:
            wrong = [line for line in done.stdout.splitlines() if line.startswith("NOT")]
            said = f"faulty programs of {name}.toml do not do what they should:"
            raise Refused("\n".join([said, *(wrong or [done.stderr.strip()])]))


def _stories(work: Renewal, stale: Stale) -> None:
    """Follow the counterexamples of the runs that were checked, and keep them."""
    document = work.document
    if not (stale.stories or stale.targets) or not has_replay(work.tree, work.name):
        return
    for walk in walk_evidence(work.tree, [work.name], work.progress):
        if walk["reason"]:
            raise Unjudged(f"{work.name}: {walk['module']}: {walk['reason']}")
    if stale.stories:
        held, changed, _ = record(document)
        work.moved.append(
            f"{work.name}: {held} recorded counterexamples, {len(changed)} of them are others now"
        )


def _page(work: Renewal) -> None:
    """Make the page of the document anew, where it is another one now."""
    document = work.document
    if check_document_page(document, read_sources(document)):
        for name, text in rendered(document).items():
            write_whole(work.tree / name, text.encode("utf-8"))
