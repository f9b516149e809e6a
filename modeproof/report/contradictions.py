"""Evidence that contradicts other evidence: two engines, two counts of one thing, two texts of one file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from modeproof.report.claims import claims
from modeproof.report.sources import DIFFERS, Sources, Trouble, few


def contradictions(sources: Sources) -> Iterator[Trouble]:
    """All of them; stale evidence, which is named elsewhere, is compared too."""
    yield from _two_texts(sources)
    for name in sources.documents:
        yield from _engines(sources, name)
        yield from _solvers(sources, name)
        yield from _counts(sources, name)


def _two_texts(sources: Sources) -> Iterator[Trouble]:
    """One file with two hashes: evidence of different source trees lies in one folder."""
    texts: dict[str, dict[str, list[str]]] = {}
    for piece in sources.everything():
        for path, digest in piece.record["inputs"].items():
            texts.setdefault(path, {}).setdefault(digest, []).append(f"{piece.record['document']}/{piece.id}")
    double = {path: of for path, of in sorted(texts.items()) if len(of) > 1}
    if double:
        items = tuple(
            f"{path} as {digest[:12]}: {few(ids)}"
            for path, of in double.items()
            for digest, ids in sorted(of.items())
        )
        what = f"the evidence is of different texts of {few(tuple(double))}"
        yield Trouble(DIFFERS, "verdict", what, "modeproof verify", items)


def _engines(sources: Sources, name: str) -> Iterator[Trouble]:
    """A property that one engine holds and another refutes."""
    for claim in claims(sources, sources.documents[name]):
        if claim.disagreement:
            text = f"{name}: {claim.of.id} ({claim.environment}): two engines disagree: {claim.disagreement}"
            yield Trouble(DIFFERS, "properties", text, f"modeproof verify --document {name}")


def _solvers(sources: Sources, name: str) -> Iterator[Trouble]:
    """A query to which two solvers give opposite answers."""
    for proof in sources.of_kind(name, "proof"):
        for query in proof.result.get("queries", ()):
            if {query.get("z3"), query.get("cvc5")} == {"sat", "unsat"}:
                text = f"{name}/{proof.id}: {query['name']}: z3 says {query['z3']}, cvc5 {query['cvc5']}"
                yield Trouble(DIFFERS, "proofs", text, str(proof.record["command"]))


def _counts(sources: Sources, name: str) -> Iterator[Trouble]:
    """The graph that a run printed beside the one that a program was compared with: states, transitions."""
    graphs = {
        piece.id: piece.result["graph"] for piece in sources.of_kind(name, "tlc") if "graph" in piece.result
    }
    for piece in sources.of_kind(name, "conformance"):
        run = str(piece.result.get("run", "")).partition("/")[2]
        graph = graphs.get(run)
        if not isinstance(graph, Mapping):
            continue
        for of_graph, of_comparison in (("states", "states"), ("edges", "transitions")):
            before, after = graph.get(of_graph), piece.result.get(of_comparison)
            if None not in (before, after) and before != after:
                text = f"{name}: {run} printed {before:,} {of_graph}, and {piece.id} compared {after:,}"
                yield Trouble(DIFFERS, "conformance", text, str(piece.record["command"]))
        recorded = {
            path: digest for path, digest in piece.record["inputs"].items() if path == graph.get("file")
        }
        if recorded and graph.get("sha256") not in recorded.values():
            text = f"{name}: {piece.id} is of another graph than {run} printed"
            yield Trouble(DIFFERS, "conformance", text, str(piece.record["command"]))
