"""What is not there though a register declares it, and evidence that cannot count: one trouble a cause."""

from __future__ import annotations

from collections.abc import Iterator

from modeproof.registers.rows import Document
from modeproof.report.claims import LANE, theorem_rows
from modeproof.report.demanded import KIND, id_of, subjects
from modeproof.report.sources import DIFFERS, HOLE, NOTE, Sources, Trouble, few, version_of
from modeproof.report.verdicts import status_of

PART_OF = {
    "tlc": "verdict",
    "conformance": "conformance",
    "proof": "proofs",
    "coverage": "proofs",
    "agreement": "proofs",
    "registers": "matrix",
    "strength": "strength",
    "machine": "machine",
    KIND: "proofs",
}


def theorems_of(sources: Sources, document: Document) -> tuple[str, ...]:
    """The names of a document's theorems, as their text has them."""
    return tuple(one.name for _, one in theorem_rows(sources, document))


def missing(sources: Sources) -> Iterator[Trouble]:
    """Declared in a register, and without evidence; and evidence of what no register declares."""
    for name, document in sources.documents.items():
        found = sources.evidence[name]
        if not found:
            continue  # said once, where the folder is read
        for kind, ids in _declared(sources, document).items():
            there = {
                id for piece in found.values() if piece.record["kind"] == kind for id in _ids(piece.record)
            }
            lost = tuple(id for id in ids if id not in there)
            if lost:
                word = {
                    "tlc": "runs",
                    "proof": "theorems",
                    "conformance": "graphs",
                    KIND: "proofs of demands",
                }.get(kind, kind)
                what = f"{name}: {len(lost)} of {len(ids)} {word} without evidence: {few(lost)}"
                if kind == "conformance":
                    what = (
                        f"{name}: {len(lost)} of {len(ids)} graphs are compared with no program: {few(lost)}"
                    )
                remedy = f"modeproof verify --document {name}"
                yield Trouble(HOLE, PART_OF[kind], what, remedy, lost)
        known = {"tlc": {run.id for run in document.runs}, "proof": set(theorems_of(sources, document))}
        for kind, ids_known in known.items():
            strange = tuple(
                piece.id
                for piece in found.values()
                if piece.record["kind"] == kind and piece.id not in ids_known
            )
            if strange:
                what = (
                    f"{name}: {len(strange)} pieces of evidence of what is declared no more: {few(strange)}"
                )
                yield Trouble(HOLE, PART_OF[kind], what, f"modeproof verify --document {name}", strange)


def _declared(sources: Sources, document: Document) -> dict[str, tuple[str, ...]]:
    runs = [run for run in document.runs if LANE in run.lanes]
    return {
        "tlc": tuple(run.id for run in runs),
        "proof": theorems_of(sources, document),
        "conformance": tuple(f"{document.name}/{run.id}" for run in runs if run.graph is not None),
        "registers": ("registers",),
        KIND: tuple(id_of(*one) for one in subjects(sources.root, document.name)),
    }


def _ids(record: object) -> tuple[str, ...]:
    """What a piece of evidence is evidence of: of a comparison, the run that printed the graph."""
    assert isinstance(record, dict)
    if record["kind"] == "conformance":
        return (str(record["result"].get("run", "")),)
    return (str(record["id"]),)


def unexpected(sources: Sources) -> Iterator[Trouble]:
    """Evidence that says itself that it is not as expected, or not judged; one trouble each."""
    for piece in sources.everything():
        status = status_of(piece.record)
        if status:
            what = (
                f"{piece.record['document']}/{piece.id}: {piece.record['verdict']}: {piece.record['reason']}"
            )
            part = PART_OF.get(str(piece.record["kind"]), "verdict")
            yield Trouble(DIFFERS if status == 1 else HOLE, part, what, str(piece.record["command"]))


def mixed(sources: Sources) -> Iterator[Trouble]:
    """Evidence by different versions of a tool or on different machines: said, not hidden."""
    made: dict[tuple[str, str], list[str]] = {}
    for piece in sources.everything():
        name = f"{piece.record['document']}/{piece.id}"
        for tool, entry in piece.record["tools"].items():
            version, digest = version_of(tool, entry)
            version += f" ({digest[:12]})" if digest else ""
            made.setdefault((str(tool), version), []).append(name)
        computer = piece.record["machine"]
        words = f"{computer['system']}, {computer.get('cpu', '')}, {computer['cores']} cores"
        made.setdefault(("machine", words), []).append(name)
    sources.cache["made"] = made
    for tool in dict.fromkeys(tool for tool, _ in made):
        versions = {version: names for (of, version), names in made.items() if of == tool}
        if len(versions) > 1:
            most = max(versions, key=lambda version: (len(versions[version]), version))
            others = tuple(
                f"{version}: {id}" for version, ids in versions.items() if version != most for id in ids
            )
            listed = "; ".join(f"{len(ids)} by {version}" for version, ids in versions.items())
            text = f"the evidence was made with {len(versions)} versions of {tool}: {listed}"
            if tool == "machine":
                text = f"the evidence was made on {len(versions)} machines: {listed}"
            yield Trouble(NOTE, "reproduce", text, "", others)
