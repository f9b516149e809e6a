"""Keeps vector files up to date: build/vectors/<document>/<target>/<suite>.jsonl.gz."""

from __future__ import annotations

import contextlib
import hashlib
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from modeproof.graph.device import current_graph, load_device_graph, open_runs
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import meanings
from modeproof.ground.places import TREE, build, documents
from modeproof.ground.progress import Progress
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import FILE_NAME, Suite, open_suite
from modeproof.registers.load import load_document, load_interface
from modeproof.registers.profiles import rows_of
from modeproof.registers.rows import Device
from modeproof.registers.runs import Run
from modeproof.registers.vector_files import made_from, step_citations
from modeproof.suites.at import every_pair
from modeproof.suites.kinds import SUITES
from modeproof.suites.write import Citations, NoCases, write_suite
from modeproof.tlc.rests import why_stale

SAYING = ("properties", "clauses", "findings")
"""Registers of which a header repeats sentences."""
CODE = ("modeproof/suites/*.py", "modeproof/graph/*.py", "modeproof/kit/vectors.py")
"""The code that writes a suite."""


def find_target(place: Path, target: str, document: str | None = None) -> tuple[str, Device]:
    """The document and the device of a target. Raises Unjudged when there is none, or more than one."""
    known: list[str] = []
    found = []
    for name in documents(place):
        if not (place / "spec" / name / "interface.toml").is_file():
            continue
        devices = load_interface(place, name).devices
        known += devices if document in (None, name) else ()
        if target in devices and document in (None, name):
            found.append((name, devices[target]))
    if not found:
        where = f" in {document}" if document else ""
        raise Unjudged(f"no target {target!r}{where}; {suggestion(target, known)}")
    if len(found) > 1:
        raise Unjudged(f"{target} is in {' and '.join(name for name, _ in found)}; choose with --document")
    return found[0]


def published(place: Path) -> dict[str, str]:
    """Every published target that has graphs, and its document."""
    return {
        name: document
        for document in documents(place)
        if (place / "spec" / document / "interface.toml").is_file()
        for name, device in load_interface(place, document).devices.items()
        if device.published and open_runs(place, document, name)
    }


def suite_file(place: Path, document: str, target: str, suite: str) -> Path:
    """Where the file of a suite is."""
    return build(place) / "vectors" / document / target / FILE_NAME.format(suite=suite)


def ready_suite(
    place: Path, document: str, target: str, suite: str, on_built: Callable[[str], None] = lambda line: None
) -> Suite:
    """Open a suite of a target, and build it before when it is missing or older than its sources.

    `on_built` gets a line with the figures of a suite that was built. Raises Unjudged when a graph is
    missing, of another text, or not complete.
    """
    if (path := current_suite(place, document, target, suite)) is not None:
        return open_suite(path)
    path = suite_file(place, document, target, suite)
    runs = open_runs(place, document, target)
    made_with = _made_with(place, document, target, [current_graph(place, run) for run in runs])
    known = _key_file(path)
    known.unlink(missing_ok=True)
    devices = [load_device_graph(place, run) for run in runs]
    if suite in SUITES and SUITES[suite].pairs:
        devices += every_pair(place, document, devices, on_built)
    stats = write_suite(
        path,
        suite,
        devices,
        citations=citations_of(place, document, target),
        texts=document_texts(place, document),
    )
    write_whole(known, made_with.encode())
    on_built(f"{target} {suite}: {stats}")
    return open_suite(path)


def current_suite(place: Path, document: str, target: str, suite: str) -> Path | None:
    """The file of a suite that was built of the present text; None: it has to be built.

    Raises Unjudged when a graph is missing or of another text.
    """
    path = suite_file(place, document, target, suite)
    runs = open_runs(place, document, target)
    if not runs:
        raise Unjudged(f"{document}: no OPEN run prints a graph of {target}")
    made_with = _made_with(place, document, target, [current_graph(place, run) for run in runs])
    known = _key_file(path)
    if path.is_file() and known.is_file() and known.read_text(encoding="utf-8") == made_with:
        with contextlib.suppress(KitUnjudged):  # a leftover of another version is built anew
            open_suite(path)
            return path
    return None


def _key_file(path: Path) -> Path:
    return path.with_name(f"{path.name.partition('.')[0]}.key")


def ready_suites(place: Path, document: str, names: Sequence[str], quiet: bool) -> list[Suite]:
    """These suites (none named: every one) of each published target of a document that has cases of them.

    Graphs are made where they are missing. Raises Unjudged when a name is no suite's, or nothing is found.
    """
    strange = [name for name in names if name not in SUITES]
    if strange:
        raise Unjudged(f"no suite {strange[0]!r}; {suggestion(strange[0], SUITES)}")
    found = []
    for target, device in load_interface(place, document).devices.items():
        runs = open_runs(place, document, target)
        if device.published and runs:
            make_graphs(place, runs, quiet)
            for name in names or SUITES:
                with contextlib.suppress(NoCases):
                    found.append(ready_suite(place, document, target, name, say))
    if not found:
        raise Unjudged(f"{document}: no published target has vectors")
    return found


def citations_of(place: Path, document: str, target: str) -> Citations:
    """What the specification's step actions cite; nothing without registers."""
    table = step_citations(place, document, load_interface(place, document).devices[target])
    return lambda step: table.get(step, ((), ()))


def document_texts(place: Path, document: str) -> dict[str, str]:
    """What the registers say of each clause, and what was decided in each finding; nothing without them."""
    try:
        registers = load_document(place, document)
    except Unjudged:
        return {}
    texts = {clause.id: clause.text for clause in registers.clauses}
    return texts | {finding.id: f"{finding.title}: {finding.decision}" for finding in registers.findings}


def document_readings(place: Path, document: str) -> dict[str, str]:
    """For each parameter that chooses between readings its finding; nothing without registers."""
    try:
        return {signal.name: finding.id for signal, finding in rows_of(load_document(place, document))}
    except Unjudged:
        return {}


def _made_with(place: Path, document: str, target: str, graphs: Sequence[Path]) -> str:
    """A hash of all that a suite is made from: what decides it, its sentences, the graphs, and our code."""
    folder = place / "spec" / document
    sentences = [path for name in SAYING if (path := folder / f"{name}.toml").is_file()]
    files = meanings(place, [*sentences, *graphs]) | dict(made_from(place, target))
    code = meanings(TREE, [path for names in CODE for path in TREE.glob(names)])
    return hashlib.sha256(repr(sorted([*files.items(), *code.items()])).encode()).hexdigest()


def make_graphs(place: Path, runs: Sequence[Run], quiet: bool) -> None:
    """Let TLC make the graphs that are missing or of another text. Raises Unjudged when one does not come."""
    missing = [run for run in runs if why_stale(place, run)]
    if not missing:
        return
    from modeproof.tlc.check import check_all
    from modeproof.tlc.toolchain import find_toolchain

    say(f"TLC makes {', '.join(run.id for run in missing)} first")
    done = check_all(place, missing, find_toolchain(), Progress(quiet=quiet))
    for run, checked in zip(missing, done, strict=True):
        if checked.status != 0:
            raise Unjudged(f"{run.name}: its graph cannot be used: {checked.record['reason']}")


def say(line: str) -> None:
    """A line for a person, on standard error."""
    print(line, file=sys.stderr, flush=True)
