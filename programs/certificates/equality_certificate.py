"""The certificate of a proof: what a second reader needs in order to check it without any search.

A folder with certificate.json (the claim, hashes of what it is about, the pairs with their relations, and
scans from power-up to each pair) and one SMT-LIB file for power-up and for each pair. The obligations are
over the program as it was translated, and each must be `unsat`. To recheck is to make them anew from the
sources and the relations; what is stored must be the same text, and is never believed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import z3

from modeproof.ground.errors import Unjudged
from programs.certificates.certificate_folder import (
    VERSION,
    Obligation,
    Stored,
    digest,
    empty,
    fill,
    obligation,
    record_in,
    reference_files,
    tools,
)
from programs.certificates.smt_lib import Printer
from programs.equality.binding import Binding
from programs.equality.product import OUTPUTS, RANGES, START, Node, Pair, Product, shown
from programs.equality.replay import Difference, Met, Replayed, Run, run_of, steps
from programs.equality.shortest_path import way_to
from programs.invariants.relations import KINDS, Relation

FORMAT: Final = "modeproof-program-certificate"
TYPES: Final = "the program stays within its types"
LONGEST: Final = 40
"""Scans of a way to a pair."""
TRACE_S: Final = 20.0
"""CPU seconds for one way to a pair."""
TRUSTED: Final = (
    "the reader and translator of programs (compared with a separate interpreter in random scans)",
    "the model of the timers and of the other standard blocks",
    "the binding of names",
    "the path explorer, which reads the reference implementation",
)
"""Besides the solver."""


# ---------------------------------------------------------------- obligations


def obligations(product: Product) -> Iterator[Obligation]:
    """What must be `unsat`, over the program as it was translated: for power-up, and for each pair."""
    printer = Printer()
    start = product.owed_at_start()
    asked = {f"not: {START}": z3.Not(start.formula)}
    yield obligation(printer, 0, "power-up", "What must hold at power-up.", {}, asked)
    for number, pair in enumerate(sorted(product.nodes), 1):
        *owed, _ = product.owed(pair, whole=True)
        kinds: dict[str, list[z3.BoolRef]] = {OUTPUTS: [], TYPES: [], RANGES: []}
        for part in owed:
            kinds[part.what if part.what in kinds else TYPES].append(part.formula)
        asked = {f"not: {what}": z3.Not(z3.And(formulas)) for what, formulas in kinds.items() if formulas}
        both = product.both(pair, True)
        after = sorted(target for target in product.nodes[pair].successors if target in product.nodes)
        somewhere = z3.Or([product.at(both.where, target) for target in after])
        asked["not: the scan leads to one of the pairs named below"] = z3.Not(somewhere)
        for target in after:
            there = [relation.formula(both.after.__getitem__) for relation in product.nodes[target].relations]
            asked[f"not: where it leads to {shown(target)} the relations of that pair hold"] = z3.And(
                product.at(both.where, target), z3.Not(z3.And(there))
            )
        known = {
            "ranges, parameters, and the control variables of the pair": both.premise,
            **{
                f"relation: {relation}": relation.formula(product.symbols.__getitem__)
                for relation in product.nodes[pair].relations
            },
        }
        sentence = f"What must hold in every scan from the pair {shown(pair)}."
        yield obligation(printer, number, shown(pair), sentence, known, asked)


# ---------------------------------------------------------------- writing


def write(
    product: Product,
    replayed: Replayed,
    folder: Path,
    binding: Path | None = None,
    claim: Mapping[str, Any] | None = None,
) -> dict[Pair, Run]:
    """Write the certificate of a proof into a folder that is new, empty, or an older certificate.

    binding: the binding file; claim: what is claimed, if it is not equality with a reference. Returns the
    scans that lead to each pair, as far as some were found.

    Raises Unjudged: the folder holds something else, or cannot be written.
    """
    try:
        texts = {owed.file: owed.text for owed in obligations(product)}
    except NotImplementedError as error:
        raise Unjudged(f"{folder}: no certificate can be written: {error}") from None
    record: dict[str, Any] = {
        **(_claim(product) if claim is None else claim),
        "binding_file": {} if binding is None else {str(binding): digest(binding)},
        "pairs": [],
    }
    ways = _ways(product, replayed)
    for pair in sorted(product.nodes):
        node, way = product.nodes[pair], ways[pair]
        record["pairs"].append(
            {
                "reference": pair[0],
                "program": list(pair[1]),
                "relations": [_written(relation) for relation in node.relations],
                "leads_to": [[target[0], *target[1]] for target in sorted(node.successors)],
                "reached_by": None if way is None else _run_written(way),
            }
        )
    empty(folder)
    fill(folder, record, texts)
    return {pair: run for pair, run in ways.items() if run is not None}


def _claim(product: Product) -> dict[str, Any]:
    binding = product.binding
    return {
        "format": FORMAT,
        "version": VERSION,
        "target": binding.reference.device.name,
        "document": binding.reference.document,
        "unit": binding.unit.name,
        "compared": list(binding.compared),
        "free_parameters": list(binding.free_parameters),
        "fixed_parameters": binding.values,
        "binding": {
            "names": dict(binding.names),
            "parameters": binding.chosen,
            "left_out": list(binding.left_out),
        },
        "wrap": product.wrap,
        "split": list(product.split),
        "control": list(product.control),
        "sources": dict(binding.source.files),
        "reference": reference_files(binding.reference.document),
        "trusted": list(TRUSTED),
        "tools": tools(),
    }


def _written(relation: Relation) -> dict[str, Any]:
    return {
        "kind": relation.kind,
        "left": relation.left,
        "right": relation.right,
        "value": relation.value,
        "text": str(relation),
    }


def _ways(product: Product, replayed: Replayed) -> dict[Pair, Run | None]:
    """The fewest scans known to each pair, replayed; None: none was found."""
    known = replayed.ways(product)
    start, _ = product.start
    found: dict[Pair, Run | None] = {}
    for pair in product.nodes:
        if pair == start:
            found[pair] = Run(product.binding.reference.with_defaults(product.binding.fixed_parameters()), [])
            continue
        run = known.get(pair)
        if run is None:
            try:
                way = way_to(product, pair, LONGEST, TRACE_S)
            except TimeoutError:
                way = None
            run = None if way is None else run_of(product, way)
        found[pair] = run if run is not None and not _unlike(product, pair, run) else None
    return found


def _unlike(product: Product, pair: Pair, run: Run) -> str:
    """What is wrong with scans that should lead to a pair; nothing: they do, and all its relations hold."""
    if not run.scans:
        return "" if pair == product.start[0] else "there are no scans"
    last: Difference | Met | None = None
    for last in steps(product.binding, product.wrap, run):
        if isinstance(last, Difference):
            return "the outputs differ on the way"
    assert isinstance(last, Met)
    if last.pair(product) != pair:
        return f"they lead to {shown(last.pair(product))}"
    for relation in product.nodes[pair].relations:
        if not relation.holds(last.values):
            return f"{relation} does not hold there"
    return ""


def _outside(product: Product, run: Run) -> str:
    """What scans start from or take that the claim is not about; nothing: it is about all of it."""
    binding = product.binding
    if not binding.allows(run.parameters):
        return "their parameters are none of the claim"
    for path, value in run.retained.items():
        slot = product.every_slot[path]
        if slot.initial is not None or not slot.type.low <= value <= slot.type.high:
            return f"{path} is no RETAIN variable that may have {value}"
    longest = max((dt_ms for dt_ms, _ in run.scans), default=0)
    return "a scan is too long" if longest > (binding.longest_scan or longest) else ""


def _run_written(run: Run) -> dict[str, Any]:
    return {
        "parameters": dict(run.parameters),
        "retained": dict(run.retained),
        "scans": [{"dt_ms": dt_ms, "in": dict(inputs)} for dt_ms, inputs in run.scans],
    }


# ---------------------------------------------------------------- reading


class Kept(Stored):
    """A certificate as it was read: its pairs and relations can be given to a product."""

    def fill(self, product: Product, claim: Mapping[str, Any] | None = None) -> dict[Pair, Run | None]:
        """Give the product the pairs and relations of the certificate; returns the way to each pair.

        claim: what it must claim, as in `write`. Raises Unjudged for what is no pair or relation of this
        program.
        """
        self.claims(_claim(product) if claim is None else claim)
        ways: dict[Pair, Run | None] = {}
        product.nodes = {}
        try:
            for row in self.record["pairs"]:
                pair = row["reference"], tuple(row["program"])
                if pair in product.nodes or pair[0] not in product.binding.reference.controls:
                    raise self.refuse(f"pair {shown(pair)} is there twice, or is none of the target")
                if len(pair[1]) != len(product.control) or not all(type(value) is int for value in pair[1]):
                    raise self.refuse(f"pair {shown(pair)} has not the control variables of the program")
                relations = [self._relation(product, found) for found in row["relations"]]
                product.nodes[pair] = Node(relations, {(to[0], tuple(to[1:])) for to in row["leads_to"]})
                ways[pair] = self._run(product.binding, row["reached_by"])
        except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
            raise self.refuse(f"not the form of a certificate: {error!r:.100}") from None
        if product.start[0] not in product.nodes:
            raise self.refuse(f"the pair of power-up, {shown(product.start[0])}, is not there")
        return ways

    def _relation(self, product: Product, row: Mapping[str, Any]) -> Relation:
        value = row["value"]
        if row["kind"] == "table":
            value = tuple((key, other) for key, other in value)
        elif isinstance(value, list):
            value = tuple(value)
        relation = Relation(row["kind"], row["left"], row["right"], value)
        if relation.kind not in KINDS or any(name not in product.symbols for name in relation.names):
            raise self.refuse(f"{relation} is no relation between memories of the two")
        return relation

    def _run(self, binding: Binding, row: Mapping[str, Any] | None) -> Run | None:
        if row is None:
            return None
        signals = {**binding.reference.signals("parameters"), **binding.reference.signals("inputs")}

        def values(table: Mapping[str, Any]) -> dict[str, Any]:
            return {
                name: tuple(value) if signals[name].type == "modes" else value
                for name, value in table.items()
            }

        scans = [(int(scan["dt_ms"]), values(scan["in"])) for scan in row["scans"]]
        return Run(values(row["parameters"]), scans, dict(row["retained"]))

    def follow(self, product: Product, ways: Mapping[Pair, Run | None]) -> Sequence[Pair]:
        """Replay the way to each pair; the pairs that have none. Raises Unjudged: one leads elsewhere."""
        for pair, run in ways.items():
            if run is not None:
                try:
                    odd = _outside(product, run) or _unlike(product, pair, run)
                except (KeyError, TypeError, ValueError) as error:
                    odd = f"{error!r:.100}"
                if odd:
                    raise self.refuse(f"the scans to pair {shown(pair)} do not lead there: {odd}")
        return [pair for pair, run in ways.items() if run is None]


def read(folder: Path) -> Kept:
    """The certificate in a folder, its reference being what it was. Raises Unjudged."""
    kept = Kept(folder, record_in(folder, FORMAT))
    document = kept.record.get("document")
    known = isinstance(document, str) and document.isidentifier()
    kept.same("reference", reference_files(str(document)) if known else {})
    return kept
