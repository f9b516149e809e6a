"""Chooses cases of a vector file: python examples/c/sample.py FROM.jsonl.gz TO.jsonl.gz

Every step that the whole file takes with some inputs is taken with these inputs, by few cases.
settled.jsonl.gz beside it is chosen so from the suite sic, for fplc_boxes.c to be judged in seconds and
without the specification's graphs.
"""

from __future__ import annotations

import gzip
import heapq
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from modeproof.kit.vectors import open_suite, read_lines


def sample(source: Path, target: Path) -> None:
    """The cases that take most of what is left, one after the other; they stay in their order."""
    takes = [
        {(scan.step, tuple(map(str, scan.inputs.values()))) for scan in case.scans}
        for case in open_suite(source).cases()
    ]
    left = set().union(*takes)
    queue = [(-len(taken), number) for number, taken in enumerate(takes)]
    heapq.heapify(queue)
    chosen = []
    while left:
        most, number = heapq.heappop(queue)
        now = len(takes[number] & left)
        if now == -most:
            chosen.append(number)
            left -= takes[number]
        elif now:
            heapq.heappush(queue, (-now, number))
    header, *rows = read_lines(source)
    rows = [rows[number] for number in sorted(chosen)]
    about = json.loads(header)
    scans = sum("refuse" not in scan for row in rows for scan in json.loads(row)["scans"])
    guarantees = f"of the suite {about['suite']} some cases: each of its steps with each of its inputs"
    about |= {"cases": len(rows), "scans": scans, "guarantees": guarantees}
    text = json.dumps(about, separators=(",", ":")).encode() + b"\n" + b"".join(rows)
    target.write_bytes(gzip.compress(text, 9, mtime=0))


if __name__ == "__main__":
    sample(Path(sys.argv[1]), Path(sys.argv[2]))
