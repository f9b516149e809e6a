"""Command line (first light: `check RUN..`)."""

from __future__ import annotations

import argparse
import sys

from modeproof.errors import Unjudged
from modeproof.places import documents, root
from modeproof.tlc.cfg import parse_cfg
from modeproof.tlc.judge import judge
from modeproof.tlc.messages import format_trace
from modeproof.tlc.process import run_tlc
from modeproof.tlc.runs import load_runs
from modeproof.tlc.toolchain import find_toolchain, sha256


def main(argv: list[str] | None = None) -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(prog="modeproof")
    commands = parser.add_subparsers(dest="command", required=True)
    check = commands.add_parser("check")
    check.add_argument("runs", nargs="*")
    args = parser.parse_args(argv)
    try:
        place = root()
        tools = find_toolchain()
        worst = 0
        for document in documents(place):
            for run in load_runs(place, document):
                if args.runs and run.id not in args.runs:
                    continue
                outcome = run_tlc(
                    place,
                    run,
                    tools,
                    lambda c: print(f"  .. {c.distinct:,} distinct {c.generated:,} generated", file=sys.stderr),
                )
                path = place / "spec" / document / run.cfg
                verdict = judge(run, parse_cfg(path.read_text(), run.cfg), sha256(path), outcome)
                if outcome.log.trace:
                    print(format_trace(outcome.log.trace, outcome.log.loop))
                counts = outcome.log.counts
                print(
                    f"{run.name}: {verdict.words} {verdict.violated} {verdict.reason}; "
                    f"distinct {counts.distinct if counts else '-'} generated {counts.generated if counts else '-'} "
                    f"trace {len(outcome.log.trace)} printed {outcome.log.tags} {outcome.seconds:.1f} s"
                )
                worst = max(worst, 0 if verdict.as_expected else 1 if verdict.judged else 2)
        return worst
    except Unjudged as error:
        print(f"modeproof: {error.message}", file=sys.stderr)
        return 2
