"""The command `prove-program`: a PLC program against a published target."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import os
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.ground.places import build, root
from modeproof.kit.files import write_text
from modeproof.kit.kit_command import quoted
from modeproof.output.junit import Case, junit_of
from modeproof.output.options import Clock
from modeproof.output.outcome import Outcome
from programs.certificates import certificate_folder as folder
from programs.certificates import equality_certificate as certificate
from programs.certificates.recheck import recheck
from programs.commands.outcomes import outcome_of_equality
from programs.commands.results import vector_of, write_record
from programs.equality.binding import read_binding
from programs.equality.comparison import about, make
from programs.equality.product import Pair, Product, shown
from programs.equality.replay import Difference, Run
from programs.equality.verdict import Verdict, judge
from programs.language.tool_differences import assumed

EXIT = {"PROVED": 0, "REFUTED": 1, "UNKNOWN": 2}
TRUSTED = (*certificate.TRUSTED, "z3")


def run_recheck(args: argparse.Namespace) -> int:
    """Check a certificate; the exit status is that of the check."""
    started = time.process_time()
    found = recheck(args.recheck)
    print("\n".join(found.lines(time.process_time() - started)))
    return found.status


def judge_program(args: argparse.Namespace) -> Outcome:
    """Judge the program, print the verdict, and return what was found. Raises Unjudged."""
    started, clock = time.process_time(), Clock()
    given = {} if args.binding is None else read_binding(args.binding)
    product = make(args.files, args.target, args.unit, given, args.wrap)

    def tell(text: str) -> None:
        if sys.stderr.isatty():
            print(f"\r{text:<100}", end="", file=sys.stderr, flush=True)

    found = judge(product, root() / "vectors" / args.target, args.seconds, tell)
    lines = []
    ways = {} if found.replayed is None else found.replayed.ways(found.product)
    if args.certificate is not None and found.word == "PROVED":
        assert found.replayed is not None
        tell("writing the certificate")
        ways = certificate.write(found.product, found.replayed, args.certificate, args.binding)
        unreached = len(found.product.nodes) - len(ways)
        way = f"; no scans were found to {unreached} of its pairs" if unreached else ""
        lines.append(f"  certificate {args.certificate}{way}; check it with --recheck {args.certificate}")
    if found.difference is not None:
        lines.append(f"  vector      {_keep(found, args.vector)}")
    tell("")
    seconds = time.process_time() - started
    text = "\n".join([*text_of(found, seconds), *lines])
    print(text)
    record = record_of(found, seconds, ways)
    if args.binding is not None:
        record["binding_file"] = {str(args.binding): hashlib.sha256(args.binding.read_bytes()).hexdigest()}
    write_record(root(), record, args.json)
    if args.junit is not None:
        said = {"compared": ", ".join(record["compared"]), "left out": ", ".join(record["left_out"])}
        case = Case(record["unit"], found.word, "\n".join(text_of(found, seconds)), said | record["sources"])
        write_text(args.junit, junit_of(record["target"], [case], record["cpu_seconds"]))
    return outcome_of_equality(args, found, record, text, clock)


def _keep(found: Verdict, path: Path | None) -> str:
    """Save the scans of a difference as a vector file; returns what is printed of it."""
    assert found.difference is not None
    run, reference = found.difference.run, found.product.binding.reference
    if run.retained:
        return "none: a vector file cannot hold the first values of RETAIN variables"
    name = f"{reference.device.name}-{found.product.binding.unit.name}.jsonl"
    place = path or build(root()) / "programs" / name
    if path is None:
        place.parent.mkdir(parents=True, exist_ok=True)
    write_text(place, vector_of(found.difference, found.product.binding))
    here = quoted(_from_here(place))
    return f"{here}; test it with `modeproof conform {reference.device.name} --vectors {here} ...`"


def _from_here(path: Path) -> str:
    """A path from the current folder, where there is one: there is none to another drive."""
    with contextlib.suppress(ValueError):
        return os.path.relpath(path)
    return str(path)


# ---------------------------------------------------------------- what is printed


def text_of(found: Verdict, seconds: float) -> Iterator[str]:
    """The verdict in lines."""
    binding = found.product.binding
    name = f"{binding.unit.kind} {binding.unit.name} of {', '.join(binding.source.files)}"
    target = f"{binding.reference.device.name} ({binding.reference.document})"
    match found.word:
        case "PROVED":
            yield f"PROVED: {name} has the outputs of {target} in every scan from power-up, for ever"
        case "REFUTED":
            yield f"REFUTED: {name} is not equal to {target}"
            assert found.difference is not None
            yield from _difference(found.difference)
        case "UNKNOWN":
            yield f"UNKNOWN: {name} and {target}: no proof and no difference"
            yield f"  missing     {found.missing}"
    for label, text in about(found.product):
        yield f"  {label:<11} {text}"
    if found.replayed is not None:
        cases, scans = found.replayed.cases, found.replayed.scans
        yield f"  vectors     {cases} published cases, {scans:,} scans, no difference"
    if found.word == "PROVED":
        yield f"  trusted     {'; '.join(TRUSTED)}"
    pairs, queries = len(found.product.nodes), found.product.queries
    yield f"  effort      {pairs} pairs, {queries} questions, {seconds:.1f} s CPU"


def _difference(found: Difference) -> Iterator[str]:
    yield f"  found by    {found.found_by}; replayed on the reference and on the program's interpreter"
    yield "  set         " + (_row(found.parameters) or "no parameters")
    if found.run.retained:
        yield "  retained    " + _row(found.run.retained)
    before: Mapping[str, Any] = {}
    for number, (dt_ms, inputs) in enumerate(found.scans, 1):
        changed = {
            name: value for name, value in inputs.items() if name not in before or before[name] != value
        }
        before = inputs
        yield f"  scan {number:<6} after {dt_ms} ms: {_row(changed) or 'the same inputs'}"
        if number < len(found.scans):
            yield f"              both: {_row(found.expected[number - 1])}"
    if found.stopped:
        yield f"    reference {_row(found.expected[-1])}"
        yield f"    program   stops: {found.stopped}"
        return
    for name, value in found.expected[-1].items():
        own = found.given[-1][name]
        mark = "   <- differs" if own != value else ""
        yield f"              {name:<16} reference {_shown(value):<8} program {_shown(own)}{mark}"


def _row(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={_shown(value)}" for name, value in values.items())


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, tuple):
        return "{" + ",".join(str(mode) for mode, there in enumerate(value) if there) + "}"
    return f"{value} ({value:04X}H)" if isinstance(value, int) and value > 9 else str(value)


def not_shown(found: Verdict) -> Iterator[str]:
    """What the verdict says nothing about, in words."""
    binding = found.product.binding
    if found.missing:
        yield found.missing
    yield from (f"output {name}: it is not compared" for name in binding.left_out)
    yield from (f"output {name} of the program: the target has none such" for name in binding.unasked)
    yield from (f"{name} other than {value}" for name, value in binding.values.items())
    yield from (f"parameters outside {text}" for text in binding.narrowed())
    if binding.longest_scan is not None:
        yield f"a time above {binding.longest_scan:,} ms between two scans"
    if found.product.wrap:
        yield "whether numbers stay within their types: they wrap"
    choices = assumed(binding.source, binding.unit, binding.steady)
    yield from (f"a tool for which this is not so: {text}" for text in choices)
    yield "what the compiler and the PLC make of the source"


def states(product: Product, ways: Mapping[Pair, Run]) -> list[dict[str, Any]]:
    """Each pair of states, how many relations hold there, and the scans that are known to lead to it."""
    start, _ = product.start
    return [
        {
            "pair": shown(pair),
            "relations": len(product.nodes[pair].relations),
            "reached_after": 0 if pair == start else len(ways[pair].scans) if pair in ways else None,
        }
        for pair in sorted(product.nodes)
    ]


def record_of(found: Verdict, seconds: float, ways: Mapping[Pair, Run]) -> dict[str, Any]:
    """The verdict as JSON. ways: the scans known to lead to each pair."""
    binding = found.product.binding
    record: dict[str, Any] = {
        "command": "prove-program",
        "verdict": found.word,
        "status": EXIT[found.word],
        "unit": binding.unit.name,
        "sources": dict(binding.source.files),
        "target": binding.reference.device.name,
        "reference": folder.reference_files(binding.reference.document),
        "tools": folder.tools(),
        "trusted": list(TRUSTED),
        "not_shown": list(not_shown(found)),
        "states": states(found.product, ways),
        "compared": list(binding.compared),
        "left_out": list(binding.left_out),
        "free_parameters": list(binding.free_parameters),
        "narrowed": binding.narrowed(),
        "fixed_parameters": binding.values,
        "wrap": found.product.wrap,
        "pairs": len(found.product.nodes),
        "queries": found.product.queries,
        "cpu_seconds": round(seconds, 1),
        "missing": found.missing,
    }
    if found.difference is not None:
        difference = found.difference
        record["difference"] = {
            "found_by": difference.found_by,
            "parameters": difference.parameters,
            "retained": difference.run.retained,
            "scans": [{"dt_ms": dt_ms, "in": inputs} for dt_ms, inputs in difference.scans],
            "reference": difference.expected,
            "program": difference.given,
            "differing": difference.differing,
            "stopped": difference.stopped,
        }
    return record
