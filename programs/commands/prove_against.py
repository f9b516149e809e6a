"""The command `prove-program NEW --against OLD`: two programs give the same outputs in every scan, or not."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import root
from modeproof.kit.files import write_text
from modeproof.output.junit import Case, junit_of
from modeproof.output.options import Clock
from modeproof.output.outcome import Counterexample, Demand, Outcome, Problem, Rule, Scan, shown_path
from modeproof.registers.files import read_own_toml
from programs.certificates import change_certificate
from programs.certificates.certificate_folder import tools
from programs.commands.outcomes import common, spot_of
from programs.commands.results import write_record
from programs.equality.replay import Difference
from programs.equality.two_as_one import product_of, random_runs, shown_scans
from programs.equality.two_programs import Names, Pair
from programs.equality.verdict import Verdict, judge_after
from programs.language.tool_differences import assumed
from programs.language.tree import Place, Source
from programs.properties.property_file import parsed
from programs.readers.sources import read_sources

EXIT = {"PROVED": 0, "REFUTED": 1, "UNKNOWN": 2}
TRUSTED = (*change_certificate.TRUSTED, "z3")


def judge_against(args: argparse.Namespace) -> Outcome:
    """Compare both programs, print the verdict, and return what was found. Raises Unjudged."""
    started, clock = time.process_time(), Clock()
    names = Names() if args.binding is None else read_names(args.binding)
    new, old = read_sources(list(args.files)), read_sources([args.against])
    pair = Pair.of((new, new.chosen(args.unit)), (old, old.chosen(args.old_unit)), names)

    def tell(text: str) -> None:
        if sys.stderr.isatty():
            print(f"\r{text:<100}", end="", file=sys.stderr, flush=True)

    product = product_of(pair, args.wrap)
    found = judge_after(product, random_runs(product), args.seconds, tell)
    tell("")
    lines = list(_certificate(pair, found, (new, old), args))
    seconds = time.process_time() - started
    text = "\n".join([*text_of(pair, found, args, seconds), *lines])
    print(text)
    record = record_of(pair, found, args, seconds)
    write_record(root(), record, args.json)
    if args.junit is not None:
        case = Case(pair.new.name, found.word, text, record["sources"])
        write_text(args.junit, junit_of(record["target"], [case], record["cpu_seconds"]))
    known = common(args, record, text, clock)
    assumptions = list(dict.fromkeys(_assumed(pair)))
    return Outcome(
        target=shown_path(args.against),
        word=found.word,
        strength="induction over pairs of states: every input and time, for ever",
        demands=[_demand(pair, found, args.wrap)],
        assumptions=assumptions,
        **known,
    )


def _certificate(
    pair: Pair, found: Verdict, sources: tuple[Source, Source], args: argparse.Namespace
) -> Iterator[str]:
    """Write the certificate that is asked for; what is said of it."""
    if args.certificate is None:
        return
    if found.word != "PROVED" or found.replayed is None:
        yield f"  certificate none: it is {found.word}"
        return
    of, place = found.product, args.certificate
    unreached = change_certificate.write_change(pair, of, found.replayed, sources, place, args.binding)
    way = f"; no scans were found to {unreached} of its pairs" if unreached else ""
    yield f"  certificate {place}{way}; check it with --recheck {place}"


def read_names(path: Path) -> Names:
    """What the file of a binding says. Raises Unjudged."""
    text, table = read_own_toml(path)
    keys = ("names", "left_out", "assume", "unless")
    for key in table:
        if key not in keys:
            raise Unjudged(f"{path}: unknown key {key!r}; {suggestion(key, keys)}")
    names, left, assume = table.get("names", {}), table.get("left_out", []), table.get("assume", {})
    fits = isinstance(names, dict) and isinstance(left, list) and isinstance(assume, dict)
    constant = assume.get("constant", []) if fits else []
    if not fits or not isinstance(constant, list) or set(assume) - {"constant"}:
        known = '[names] new = "old", left_out = [...], [assume] constant = [...]'
        raise Unjudged(f"{path}: {known} are understood here")
    if not all(isinstance(one, str) for one in (*names.values(), *left, *constant)):
        raise Unjudged(f"{path}: names in quotation marks are needed")
    unless = table.get("unless", "")
    if not isinstance(unless, str):
        raise Unjudged(f"{path}: unless is an expression in quotation marks")
    line = next((n for n, row in enumerate(text.splitlines(), 1) if row.lstrip().startswith("unless")), 1)
    asked = parsed(unless, Place(str(path), line)) if unless.strip() else None
    return Names(names, tuple(left), tuple(constant), asked, " ".join(unless.split()))


def _assumed(pair: Pair) -> Iterator[str]:
    for unit in (pair.new, pair.old):
        yield from assumed(pair.source, unit, pair.constant)


# ---------------------------------------------------------------- what is printed


def text_of(pair: Pair, found: Verdict, args: argparse.Namespace, seconds: float) -> Iterator[str]:
    """The verdict in lines."""
    new = f"{pair.new.name} of {', '.join(map(str, args.files))}"
    old = f"{pair.old.name.removeprefix('OLD_')} of {args.against}"
    except_where = f", except where {pair.names.unless_text}" * bool(pair.names.unless_text)
    match found.word:
        case "PROVED":
            yield f"PROVED: {new} gives the outputs of {old} in every scan, for ever{except_where}"
        case "REFUTED":
            yield f"REFUTED: {new} does not give the outputs of {old}{except_where}"
            assert found.difference is not None
            yield from _scans(pair, found.difference, args.wrap)
        case "UNKNOWN":
            yield f"UNKNOWN: {new} and {old}: no proof and no difference"
            yield f"  missing     {found.missing}"
    yield f"  compared    {', '.join(found.product.binding.compared)}"
    if left := _left_out(pair):
        yield f"  left out    {', '.join(left)}"
    if pair.constant:
        yield f"  constant    {', '.join(sorted(pair.names.constant))}: as in the first scan"
    yield f"  numbers     {'wrap' if args.wrap else 'stay within their types in both'}"
    if choices := list(dict.fromkeys(_assumed(pair))):
        yield f"  assumed     {'; '.join(choices)}"
    if found.word == "PROVED":
        yield f"  trusted     {'; '.join(TRUSTED)}"
    product = found.product
    yield f"  effort      {len(product.nodes)} pairs, {product.queries} questions, {seconds:.1f} s CPU"


def _left_out(pair: Pair) -> list[str]:
    """The outputs that are not compared."""
    ours, theirs = pair.new.of_keys("output"), pair.old.of_keys("output")
    spare = [one.name for key, one in ours.items() if key not in pair.outputs]
    return spare + [f"{one.name} (old)" for key, one in theirs.items() if key not in pair.outputs.values()]


def _scans(pair: Pair, found: Difference, wrap: bool) -> Iterator[str]:
    yield f"  found by    {found.found_by}; run again with plain values on both"
    if found.run.parameters:
        yield "  constant    " + _row(found.run.parameters)
    if found.run.retained:
        yield "  retained    " + _row(found.run.retained)
    rows = list(shown_scans(pair, wrap, found.run))
    before: Mapping[str, Any] = {}
    for number, (dt_ms, inputs) in enumerate(found.scans, 1):
        changed = {name: value for name, value in inputs.items() if before.get(name, ...) != value}
        before = inputs
        yield f"  scan {number:<6} after {dt_ms} ms: {_row(changed) or 'the same inputs'}"
        if number > len(rows):
            yield f"              stops: {found.stopped}"
        elif number < len(found.scans):
            yield f"              both: {_row(rows[number - 1][0])}"
        else:
            new, old = rows[number - 1]
            for name, value in new.items():
                mark = "   <- differs" if value != old[name] else ""
                yield f"              {name:<16} old {_shown(old[name]):<8} new {_shown(value)}{mark}"


def _row(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={_shown(value)}" for name, value in values.items())


def _shown(value: Any) -> str:
    return str(int(value)) if isinstance(value, bool) else str(value)


def record_of(pair: Pair, found: Verdict, args: argparse.Namespace, seconds: float) -> dict[str, Any]:
    """The verdict as JSON."""
    record: dict[str, Any] = {
        "command": "prove-program",
        "verdict": found.word,
        "status": EXIT[found.word],
        "unit": pair.new.name,
        "target": f"against-{args.against.stem}",
        "against": str(args.against),
        "sources": dict(pair.source.files),
        "reference": {},
        "tools": tools(),
        "trusted": list(TRUSTED),
        "not_shown": list(_not_shown(pair, found, args.wrap)),
        "compared": list(found.product.binding.compared),
        "left_out": _left_out(pair),
        "unless": pair.names.unless_text,
        "wrap": args.wrap,
        "pairs": len(found.product.nodes),
        "missing": found.missing,
        "cpu_seconds": round(seconds, 1),
    }
    if (difference := found.difference) is not None:
        rows = list(shown_scans(pair, args.wrap, difference.run))
        record["difference"] = {
            "found_by": difference.found_by,
            "constant": dict(difference.run.parameters),
            "retained": dict(difference.run.retained),
            "scans": [{"dt_ms": dt_ms, "in": dict(inputs)} for dt_ms, inputs in difference.scans],
            "new": [new for new, _ in rows],
            "old": [old for _, old in rows],
            "differing": difference.differing,
            "stopped": difference.stopped,
        }
    return record


def _not_shown(pair: Pair, found: Verdict, wrap: bool) -> Iterator[str]:
    if found.missing:
        yield found.missing
    yield from (f"output {name}: it is not compared" for name in _left_out(pair))
    yield from (f"runs in which {name} changes" for name in pair.names.constant)
    if pair.names.unless_text:
        yield f"scans in which {pair.names.unless_text}"
    if wrap:
        yield "that numbers stay within their types: they wrap"
    yield from (f"a tool for which this is not so: {text}" for text in dict.fromkeys(_assumed(pair)))
    yield "what the compiler and the PLC make of the sources"


def _demand(pair: Pair, found: Verdict, wrap: bool) -> Demand:
    old = pair.old.name.removeprefix("OLD_")
    sentence = f"{pair.new.name} gives the outputs of the old {old} in every scan from power-up."
    rule = Rule(id="same", kind="target", sentence=sentence, source=pair.old.place.file)
    problems: list[Problem] = []
    if (difference := found.difference) is not None:
        rows: Sequence[tuple[dict[str, Any], dict[str, Any]]] = list(shown_scans(pair, wrap, difference.run))
        scans = [
            Scan(dt_ms=dt_ms, inputs=dict(inputs), given=new, expected=old_row)
            for (dt_ms, inputs), (new, old_row) in zip(difference.scans, [*rows, ({}, {})], strict=False)
        ]
        example = Counterexample(
            scans=scans,
            parameters=dict(difference.run.parameters),
            retained=dict(difference.run.retained),
            wrong=difference.differing,
            stopped=difference.stopped,
            found_by=difference.found_by,
        )
        what = (
            difference.stopped or f"{', '.join(difference.differing)} differ in scan {len(difference.scans)}"
        )
        spot = spot_of(pair.new.place)
        problems.append(Problem(rule=rule, message=what, spot=spot, counterexample=example))
    elif found.missing:
        problems.append(Problem(rule=rule, message=found.missing, spot=spot_of(pair.new.place)))
    how = {"PROVED": "induction", "REFUTED": "scans, run on both", "UNKNOWN": "no proof and no difference"}
    return Demand(id="same", word=found.word, sentence=sentence, strength=how[found.word], problems=problems)
