"""The command `modeproof scale`: measures how a document's model grows, and renders page and chart of it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from modeproof import evidence
from modeproof.errors import EXIT_AS_EXPECTED, EXIT_UNJUDGED, Unjudged
from modeproof.evidence.files import write_whole
from modeproof.lock import only_one
from modeproof.places import documents
from modeproof.places import root as repository_root
from modeproof.progress import Progress
from modeproof.registers.pages import SCALING, SCALING_PICTURE, page_of
from modeproof.report.scaling import Curve, Measured, chart, page
from modeproof.tlc.scaling import KIND, Series, has_scaling, load_scaling, measure
from modeproof.tlc.toolchain import find_toolchain

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

COMMAND = ".venv/bin/modeproof scale"


def add_parser(subparsers: Subparsers) -> argparse.ArgumentParser:
    """Add the command; `args.run(args)` returns 0, or 2 when a point was not judged, and raises Unjudged."""
    parser = subparsers.add_parser(
        "scale",
        help="measure how the model grows (docs/<document>/scaling.md)",
        description="Measures the series of spec/<document>/scaling.toml, one TLC run after the other, or "
        "renders scaling.md and scaling.svg in docs/<document> from what was measured. A point beyond its "
        "time limit is left out, and said.",
    )
    parser.add_argument("series", nargs="*", metavar="SERIES", help="only these series")
    parser.add_argument("--document", metavar="NAME", help="which document, if several have series")
    parser.add_argument(
        "--point", type=int, action="append", metavar="X", help="only this point of each series"
    )
    parser.add_argument("--render", action="store_true", help="measure nothing; write the page and the chart")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    found = [name for name in documents(place) if args.document in (None, name) and has_scaling(place, name)]
    if len(found) != 1:
        raise Unjudged(f"one document with a scaling.toml is needed, found {', '.join(found) or 'none'}")
    series = load_scaling(place, found[0])
    known = [one.id for one in series]
    if unknown := [name for name in args.series if name not in known]:
        raise Unjudged(f"no series {unknown[0]!r}; there are: {', '.join(known)}")
    if args.render:
        render(place, found[0], series)
        return EXIT_AS_EXPECTED
    tools, progress, status = find_toolchain(), Progress(quiet=args.quiet), EXIT_AS_EXPECTED
    with only_one(place):
        for one in series:
            if args.series and one.id not in args.series:
                continue
            for point, record in measure(place, _only(one, args.point), tools, progress):
                result = record["result"]
                figures = f"{result['distinct']:,} distinct, " if record["as_expected"] else ""
                figures += f"{result['cpu_seconds']:.1f} s of CPU"
                progress.say(
                    f"{one.id} {point.x}: {record['verdict']}; {figures} {record['reason']}".rstrip()
                )
                if record["verdict"] not in ("HOLDS", "INCONCLUSIVE"):
                    status = EXIT_UNJUDGED
    return status


def _only(series: Series, wanted: Sequence[int] | None) -> Series:
    if not wanted:
        return series
    points = tuple(point for point in series.points if point.x in wanted)
    if not points:
        raise Unjudged(f"series {series.id} has no point {', '.join(map(str, wanted))}")
    return replace(series, points=points)


def render(place: Path, document: str, series: Sequence[Series]) -> None:
    """Write the page and the chart of a document from the evidence that is there."""
    curves = [_curve(place, one) for one in series]
    write_whole(place / page_of(document, SCALING_PICTURE), chart(curves).encode())
    text = page(curves, f"{COMMAND} --document {document}", SCALING_PICTURE)
    write_whole(place / page_of(document, SCALING), text.encode())


def _curve(place: Path, series: Series) -> Curve:
    points = []
    for point in series.points:
        path = evidence.evidence_path(place, series.run.document, series.name(point))
        record = evidence.read(path) if path.is_file() else None
        if record is not None and (record["kind"] != KIND or record["result"]["given"] != dict(point.given)):
            raise Unjudged(f"{path}: is of another point than {series.id} {point.x}; measure it again")
        points.append(Measured(point.x, record))
    return Curve(series.id, series.run.id, series.x, series.title, tuple(points))
