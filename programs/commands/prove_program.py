"""The command `prove-program`: a PLC program against a published target."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import os
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from modeproof.ground.places import build, root
from modeproof.kit.again import quoted
from modeproof.kit.files import write_text
from modeproof.output.junit import Case, junit_of
from modeproof.output.options import Clock
from modeproof.output.outcome import Outcome
from programs.certificates import certificate_folder as folder
from programs.certificates import demand_certificate
from programs.certificates import equality_certificate as certificate
from programs.certificates.demand_certificate import judgement_of, of_reference
from programs.certificates.recheck import FOLLOWS, folders_of, recheck
from programs.commands import following
from programs.commands.by_equality import by_equality
from programs.commands.following import Followed
from programs.commands.outcomes import outcome_of_target
from programs.commands.results import vector_of, write_record
from programs.demands.observer import LATENCY
from programs.demands.steady import changing, steady_difference
from programs.equality.binding import read_assumed, read_binding
from programs.equality.comparison import about, make
from programs.equality.product import Pair, Product, shown
from programs.equality.readings import reading_of
from programs.equality.replay import Difference, Run, published
from programs.equality.verdict import Verdict, judge
from programs.language.tool_differences import assumed

FIRST_S = 4.0
"""CPU seconds for the plain questions on each demand before equality is asked, which settles many at once."""
SAME_S = 60.0
"""CPU seconds for the second answer, if it was not asked for."""
EXIT = {"PROVED": 0, "REFUTED": 1, "UNKNOWN": 2}
TRUSTED = (*certificate.TRUSTED, "z3")


def run_recheck(args: argparse.Namespace) -> int:
    """Check a certificate; the exit status is that of the check."""
    started = time.process_time()
    statuses = []
    for one in folders_of(args.recheck):
        found = recheck(one)
        statuses.append(found.status)
        print("\n".join(found.lines(time.process_time() - started)))
    return 1 if 1 in statuses else max(statuses)


def judge_program(args: argparse.Namespace) -> Outcome:
    """Judge the program, print the verdicts, and return what was found. Raises Unjudged.

    Whether it follows the page comes first, then whether it is the same as the reference.
    """
    started, clock = time.process_time(), Clock()
    given, assumed = (
        ({}, {}) if args.binding is None else (read_binding(args.binding), read_assumed(args.binding))
    )
    assumed = {**assumed, "flips": True} if args.flips else assumed
    product = make(args.files, args.target, args.unit, given, args.wrap, codes=args.codes)
    vectors = root() / "vectors" / args.target

    def tell(text: str) -> None:
        if sys.stderr.isatty():
            print(f"\r{text:<100}", end="", file=sys.stderr, flush=True)

    latency = LATENCY if args.latency is None else args.latency
    first_s = min(args.seconds, FIRST_S)
    judgement = judgement_of(product, assumed, latency, vectors, first_s, tell)
    judgement.brief = True
    judgement.at_once = lambda broken, asked: print(
        following.at_once(broken, asked.id, asked.clauses), file=sys.stderr, flush=True
    )
    followed, same = Followed(product, judgement, judgement.all()), None
    if followed.word == "UNKNOWN":
        same = _same(args, followed, vectors, tell)
        if same is not None and same.word == "PROVED":
            tell("what could not be shown of the program is asked of the reference")
            followed = by_equality(followed)
    if followed.word == "UNKNOWN":
        followed = replace(followed, found=judgement.longer(args.seconds, followed.found))
    tell("")
    lines = list(following.text_of(followed, time.process_time() - started))
    print("\n".join(lines), flush=True)
    same = same or _same(args, followed, vectors, tell)
    more, ways = _certificates(args, followed, same, tell)
    tell("")
    seconds = time.process_time() - started
    last = list(_lines_of_same(args, followed, same, seconds, more))
    print("\n".join(last))
    lines += last
    record = record_of_all(args, followed, same, seconds, ways)
    if args.binding is not None:
        record["binding_file"] = {str(args.binding): hashlib.sha256(args.binding.read_bytes()).hexdigest()}
    write_record(root(), record, args.json)
    text = "\n".join(lines)
    if args.junit is not None:
        said = {
            "compared": ", ".join(product.binding.compared),
            "left out": ", ".join(product.binding.left_out),
        }
        case = Case(record["unit"], record["verdict"], text, said | record["sources"])
        write_text(args.junit, junit_of(record["target"], [case], record["cpu_seconds"]))
    return outcome_of_target(args, followed, same, record, text, clock)


def _same(args: argparse.Namespace, followed: Followed, vectors: Path, tell: Any) -> Verdict | None:
    """Whether it is the same as the reference; None: nobody asked, and no published vector denies it.

    If that is not asked for, a program that breaks the page is compared by the published vectors alone.
    """
    product = followed.product
    if args.same or followed.word != "BREAKS":
        seconds = args.seconds if args.same else min(args.seconds, SAME_S)
        found = judge(product, vectors, seconds, tell, fewest=args.same)
    else:
        first = published(product.binding, product.wrap, vectors)
        if not isinstance(first, Difference):
            return None
        found = Verdict("REFUTED", product, difference=first)
    if found.difference is not None:
        assumed = followed.judgement.beside.assumed
        tell("looking for the reading that the program has")
        shown = steady_difference(assumed, product, found.difference, vectors)
        said = [reading_of(product, shown, vectors)]
        if flips := ", ".join(changing(assumed, shown)):
            said.append(f"in these scans {flips} changes, which the page calls constant")
        found = replace(found, difference=shown, reading="; ".join(filter(None, said)))
    return found


def _certificates(
    args: argparse.Namespace, followed: Followed, found: Verdict | None, tell: Any
) -> tuple[list[str], Mapping[Pair, Run]]:
    """Lines on the certificates that were asked for and written, and the scans to each pair."""
    lines: list[str] = []
    ways: Mapping[Pair, Run] = {}
    if found is not None and found.replayed is not None:
        ways = found.replayed.ways(found.product)
    if args.certificate is None:
        return lines, ways
    tell("writing the certificate")
    equality = args.same or (followed.by_equality and followed.word == "FOLLOWS")
    if equality and found is not None and found.word == "PROVED":
        assert found.replayed is not None
        ways = certificate.write(found.product, found.replayed, args.certificate, args.binding)
        unreached = len(found.product.nodes) - len(ways)
        way = f"; no scans were found to {unreached} of its pairs" if unreached else ""
        about = ", of equality" if followed.by_equality else ""
        lines.append(
            f"  certificate {args.certificate}{about}{way}; check it with --recheck {args.certificate}"
        )
    if followed.word == "FOLLOWS":
        place = args.certificate / FOLLOWS if lines else args.certificate
        judgement, rows = followed.judgement, followed.found
        if followed.by_equality:
            judgement = of_reference(judgement)
            rows = judgement.all()
        demand_certificate.write(judgement, followed.product, rows, place, args.binding)
        whose = "the demands, of the reference" if followed.by_equality else "the demands"
        lines.append(f"  certificate {place}, of {whose}; check it with --recheck {args.certificate}")
    return lines, ways


def _lines_of_same(
    args: argparse.Namespace, followed: Followed, found: Verdict | None, seconds: float, more: list[str]
) -> Iterator[str]:
    """The second answer in lines; in full if it was asked for."""
    if found is None:
        yield "Not the same as the reference: that keeps all demands of the page"
    elif args.same:
        yield from text_of(found, seconds)
    else:
        yield from brief_of(found)
    yield from more
    if found is not None and found.difference is not None:
        yield f"  vector      {_keep(found, args.vector)}"


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
            yield from _reading(found)
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


def brief_of(found: Verdict) -> Iterator[str]:
    """The second answer in few lines."""
    binding = found.product.binding
    lines = dict(about(found.product))
    chosen = f" ({lines['profile']})" if "profile" in lines else ""
    match found.word:
        case "PROVED":
            yield f"SAME AS the reference{chosen}: equal outputs in every scan from power-up, for ever"
        case "REFUTED":
            assert found.difference is not None
            scans = len(found.difference.scans)
            where = f"in scan {scans} of the {found.difference.found_by}"
            yield f"Not the same as the reference{chosen}: it differs {where}: {_last(found.difference)}"
            yield from _reading(found)
        case "UNKNOWN":
            yield f"Not known to be the same as the reference{chosen}: {found.missing}"
    yield f"  compared    {', '.join(binding.compared)}; --same asks for this too"


def _reading(found: Verdict) -> Iterator[str]:
    if found.reading:
        yield f"  reading     {found.reading}"


def _last(found: Difference) -> str:
    """What differs in the last scan."""
    if found.stopped:
        return f"the program stops: {found.stopped}"
    own, expected = found.given[-1], found.expected[-1]
    return "; ".join(
        f"{name} is {_shown(own[name])}, and {_shown(expected[name])} there" for name in found.differing
    )


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


def not_shown(followed: Followed, found: Verdict | None) -> Iterator[str]:
    """What the verdicts say nothing about, in words."""
    for one in followed.found:
        if one.word == "UNKNOWN":
            yield f"{one.asked.id}: {one.how}"
    for row in followed.judgement.beside.unjudged:
        yield f"{row.id}: an output that it needs is left out"
    if found is not None and found.missing:
        yield found.missing
    yield from (f"runs in which this is not so: {text}" for text in followed.judgement.beside.assumed.words())
    yield from limits(followed.product)


def limits(product: Product) -> Iterator[str]:
    """Of which outputs, parameters, times and tools a verdict says nothing, in words."""
    binding = product.binding
    yield from (f"output {name}: it is not compared" for name in binding.left_out)
    yield from (f"output {name} of the program: the target has none such" for name in binding.unasked)
    yield from (f"{name} other than {value}" for name, value in binding.values.items())
    yield from (f"parameters outside {text}" for text in binding.narrowed())
    if binding.longest_scan is not None:
        yield f"a time above {binding.longest_scan:,} ms between two scans"
    if product.wrap:
        yield "that numbers stay within their types: they wrap"
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


def record_of_all(
    args: argparse.Namespace,
    followed: Followed,
    same: Verdict | None,
    seconds: float,
    ways: Mapping[Pair, Run],
) -> dict[str, Any]:
    """Both answers as JSON. The status is that of the first; with --same also that of the second."""
    binding = followed.product.binding
    word: str = followed.word
    status: int = following.EXIT[followed.word]
    if args.same and same is not None and word != "BREAKS":
        word, status = same.word, EXIT[same.word]
    return {
        "command": "prove-program",
        "verdict": word,
        "status": status,
        "unit": binding.unit.name,
        "sources": dict(binding.source.files),
        "target": binding.reference.device.name,
        "reference": {
            **folder.reference_files(binding.reference.document),
            **demand_certificate.register_files(binding.reference.document),
        },
        "tools": folder.tools(),
        "trusted": list(dict.fromkeys([*demand_certificate.TRUSTED, *TRUSTED])),
        "not_shown": list(not_shown(followed, same)),
        "states": [] if same is None else states(same.product, ways),
        "follows": following.record_of(followed),
        "same_asked": args.same,
        "same": None if same is None else record_of(same),
        "cpu_seconds": round(seconds, 1),
    }


def record_of(found: Verdict) -> dict[str, Any]:
    """The second answer as JSON."""
    binding = found.product.binding
    record: dict[str, Any] = {
        "verdict": found.word,
        "compared": list(binding.compared),
        "left_out": list(binding.left_out),
        "free_parameters": list(binding.free_parameters),
        "narrowed": binding.narrowed(),
        "fixed_parameters": binding.values,
        "wrap": found.product.wrap,
        "pairs": len(found.product.nodes),
        "queries": found.product.queries,
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
            "reading": found.reading,
        }
    return record
