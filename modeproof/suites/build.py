"""Keeps vector files up to date: build/vectors/<document>/<target>/<suite>.jsonl.gz."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from modeproof import kit
from modeproof.graph.device import current_graph, load_device_graph, open_runs
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import build, documents
from modeproof.ground.progress import Progress
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import FILE_NAME, Suite, open_suite
from modeproof.registers.citations import citations, read_sources
from modeproof.registers.load import load_document, load_interface
from modeproof.registers.rows import Device
from modeproof.registers.runs import Run
from modeproof.suites.at import every_pair
from modeproof.suites.contract import load_contract
from modeproof.suites.kinds import SUITES
from modeproof.suites.write import Citations, NoCases, write_suite
from modeproof.tlc.rests import why_stale


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
    sources = _sources(place, document, [current_graph(place, run) for run in runs])
    devices = [load_device_graph(place, run) for run in runs]
    if suite in SUITES and SUITES[suite].pairs:
        devices += every_pair(place, document, devices, on_built)
    contract = load_contract(place, document, devices[0].device, list(devices[0].forms.modes))
    stats = write_suite(
        path,
        suite,
        devices,
        citations=step_citations(place, document, target, on_built),
        sources=sources,
        contract=contract,
        texts=document_texts(place, document),
    )
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
    sources = _sources(place, document, [current_graph(place, run) for run in runs])
    try:
        there = path.is_file() and open_suite(path).header.get("sources") == sources
    except KitUnjudged:
        there = False  # a leftover of another version is built anew
    return path if there else None


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


def step_citations(
    place: Path, document: str, target: str, on_trouble: Callable[[str], None] = lambda line: None
) -> Citations:
    """What the specification's step actions cite. Nothing, and a line says so, without registers."""
    try:
        registers = load_document(place, document)
        found = citations(registers, read_sources(registers))
    except Unjudged as error:
        on_trouble(f"{target}: no clauses are cited: {error}")
        return lambda step: ((), ())
    module = registers.interface.devices[target].module
    table = {
        citation.name: (citation.clauses, citation.findings)
        for citation in found
        if citation.kind == "definition" and citation.room == "spec"
    }
    return lambda step: table.get(f"{module}!{step}", ((), ()))


def document_texts(place: Path, document: str) -> dict[str, str]:
    """What the registers say of each clause, and what was decided in each finding; nothing without them."""
    try:
        registers = load_document(place, document)
    except Unjudged:
        return {}
    texts = {clause.id: clause.text for clause in registers.clauses}
    return texts | {finding.id: f"{finding.title}: {finding.decision}" for finding in registers.findings}


def _sources(place: Path, document: str, graphs: list[Path]) -> dict[str, str]:
    folder = place / "spec" / document
    own = Path(__file__).resolve().parent
    code = [*own.glob("*.py"), *(own.parent / "graph").glob("*.py"), Path(kit.__file__).parent / "vectors.py"]
    registers = [
        folder / "interface.toml",
        folder / "classes.toml",
        folder / "contracts.toml",
        folder / "properties.toml",
        folder / "runs.toml",
        folder / "sequences.toml",
        folder / "clauses.toml",
        folder / "findings.toml",
    ]
    paths = [*graphs, *(path for path in registers if path.is_file()), *folder.glob("*.tla")]
    hashes = evidence.hashes(place, paths)
    for path in code:  # by name: the package may be installed elsewhere
        name = f"modeproof/{path.parent.name}/{path.name}"
        hashes[name] = next(iter(evidence.hashes(path.parent, [path]).values()))
    return dict(sorted(hashes.items()))


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
