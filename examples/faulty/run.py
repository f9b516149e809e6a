"""Builds every faulty program of faults.toml and lets the kit judge it. Needs gcc and nothing else.

    python examples/faulty/run.py                       all faults, each by its suite
    python examples/faulty/run.py no-settle LA-edge     these
    python examples/faulty/run.py --render              all, and README.md anew
    python examples/faulty/run.py --renew FOLDER        all, with vectors anew from the suites there

Exit status: 0 all as expected, 1 not, 2 could not be judged.
"""

from __future__ import annotations

import argparse
import gzip
import json
import os
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))

from modeproof.kit.adapter import Adapter  # noqa: E402
from modeproof.kit.errors import Unjudged  # noqa: E402
from modeproof.kit.judge import Verdict, run_suite  # noqa: E402
from modeproof.kit.text import as_text  # noqa: E402
from modeproof.kit.vectors import Suite, case_id, open_suite, read_lines  # noqa: E402

HERE = Path(__file__).resolve().parent
PACK, PAGE, VECTORS = HERE / "faults.toml", HERE / "README.md", HERE / "vectors"
PROGRAM = "examples/c"
SOURCES = ("fplc.c", "wire.c", "adapter.c")
HEADERS = ("fplc.h", "wire.h")
SUITES = {"brief": False, "tour": False, "words": False, "wp": False, "times": False, "none": True}
"""For each suite whether its faults need a reason: why they pass all suites."""
WHOLE, PARTS = "brief", ("tour", "words", "wp", "times")
"""The suite of which the pack holds all, and those of which it holds what catches a fault."""
COMPILE = ("gcc", "-std=c99", "-O0", "-w")
"""Not optimized: most of the time goes into compiling. No warnings: mistakes are the point."""


@dataclass(frozen=True)
class Fault:
    """One edit of one file: `old`, which stands there exactly once, becomes `new`.

    `breaks` names clauses and findings. `suite` is the first that catches it of brief, tour, words, wp and
    times; none of them catches one that has a `reason`.
    """

    id: str
    file: str
    old: str
    new: str
    breaks: tuple[str, ...]
    mistake: str
    suite: str
    reason: str = ""


def load_faults(path: Path = PACK) -> tuple[Fault, ...]:
    """The faults in the order of the file. Raises Unjudged naming the fault that cannot be used."""
    try:
        rows = tomllib.loads(path.read_text(encoding="utf-8"))["fault"]
        faults = tuple(Fault(**row | {"breaks": tuple(row["breaks"])}) for row in rows)
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise Unjudged(f"{path.name}: {type(error).__name__} {error}") from None
    for fault in faults:
        text = (ROOT / fault.file).read_text(encoding="utf-8")
        if text.count(fault.old) != 1 or fault.old == fault.new:
            raise Unjudged(
                f"{path.name}: {fault.id}: `old` stands {text.count(fault.old)} times in {fault.file}"
            )
        if fault.suite not in SUITES or SUITES[fault.suite] != bool(fault.reason):
            raise Unjudged(f"{path.name}: {fault.id}: suite {fault.suite!r} with reason {fault.reason!r}")
    if len({fault.id for fault in faults}) != len(faults):
        raise Unjudged(f"{path.name}: two faults have the same id")
    return faults


def build(folder: Path, fault: Fault | None = None, good: Path | None = None) -> Path:
    """Compile the program into `folder`, with the fault if one is given; returns what to start.

    `good` is the folder of the program without fault: its objects are taken where the fault does not touch
    them. Raises Unjudged with the compiler's first line.
    """
    folder.mkdir(parents=True, exist_ok=True)
    touched = () if fault is None else (Path(fault.file).name,)
    for name in (*SOURCES, *HEADERS):
        text = (ROOT / PROGRAM / name).read_text(encoding="utf-8")
        if fault is not None and name in touched:
            text = text.replace(fault.old, fault.new)
        (folder / name).write_text(text, encoding="utf-8")
    fresh = [name for name in SOURCES if good is None or name in touched or set(touched) & set(HEADERS)]
    for name in fresh:
        _call([*COMPILE, "-c", name], folder)
    objects = [
        str((folder if name in fresh or good is None else good) / name.replace(".c", ".o"))
        for name in SOURCES
    ]
    _call(["gcc", "-o", "program", *objects], folder)
    return folder / "program"


def _call(command: Sequence[str], folder: Path) -> None:
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    except OSError as error:
        raise Unjudged(f"{command[0]}: {error.strerror}; install gcc") from None
    if done.returncode:
        raise Unjudged(f"{folder.name}: {next(iter(done.stderr.splitlines()), 'the compiler failed')}")


def build_all(folder: Path, faults: Iterable[Fault]) -> dict[str, Path]:
    """Every faulty program by the id of its fault, and the good one by the empty name."""
    made = {"": build(folder / "good")}
    chosen = list(faults)
    with ThreadPoolExecutor() as pool:
        paths = pool.map(lambda fault: build(folder / fault.id, fault, folder / "good"), chosen)
        made |= {fault.id: path for fault, path in zip(chosen, paths, strict=True)}
    return made


def vectors(suite: str) -> Path:
    """The pack's own vectors of a suite."""
    return VECTORS / f"{suite}.jsonl.gz"


def open_all() -> dict[str, Suite]:
    """The suites of the pack. Raises Unjudged for one that is missing or damaged."""
    return {name: open_suite(vectors(name)) for name in (WHOLE, *PARTS)}


def judge(program: Path, suite: Suite) -> Verdict:
    """What the kit says about a program."""
    return run_suite(suite, lambda: Adapter([str(program)]))


def judge_all(
    made: Mapping[str, Path], faults: Sequence[Fault], suites: Mapping[str, Suite]
) -> dict[str, Verdict]:
    """What the kit says about each fault by its suite; by `brief` where it has a reason to pass.

    Several at a time, for the kit waits a moment before it believes a difference.
    """
    with ThreadPoolExecutor(8) as pool:
        chosen = [suites[WHOLE if fault.reason else fault.suite] for fault in faults]
        verdicts = pool.map(lambda fault, suite: judge(made[fault.id], suite), faults, chosen)
        return {fault.id: verdict for fault, verdict in zip(faults, verdicts, strict=True)}


def as_expected(fault: Fault, verdict: Verdict) -> bool:
    """A fault that the pack's vectors show is rejected; any other program conforms to them."""
    return verdict.word == ("CONFORMS" if fault.reason else "DIFFERS")


def as_page(faults: Sequence[Fault], verdicts: Mapping[str, Verdict], suites: Mapping[str, Suite]) -> str:
    """README.md: every fault with what caught it."""
    caught = [fault for fault in faults if not fault.reason]
    by_suite = {name: sum(fault.suite == name for fault in caught) for name in (WHOLE, *PARTS)}
    lines = [
        "# Programs that are wrong in one place",
        "",
        "Is a verdict CONFORMS worth anything? Only if wrong programs do not get it. Each fault here is one",
        "edit of [the C program](../c/README.md), a mistake that a good programmer makes;",
        "[`faults.toml`](faults.toml) has the edits.",
        "",
        "```",
        "python3 examples/faulty/run.py             # builds and judges all of them; needs gcc, nothing else",
        "python3 examples/faulty/run.py LA-edge     # one of them, with the kit's report",
        "```",
        "",
        f"{len(caught)} faults are rejected with relation `exact`: {by_suite['brief']} by suite `brief`",
        f"({suites['brief'].scan_count:,} scans), {by_suite['tour']} more by `tour`,",
        f"{by_suite['words']} more by `words`, {by_suite['wp']} by `wp` and {by_suite['times']} by `times`.",
        f"{len(faults) - len(caught)} others stand at the end, with the reason why all suites let them pass.",
        "The program without a fault conforms.",
        "",
        "*Scans* counts up to the first wrong output. *At* is the step that the specification took there,",
        "which may come later than the mistake. Of all suites but `brief` the pack holds the beginnings of",
        "the cases that catch a fault, and counts in them.",
        "",
        "| fault | the mistake | breaks | suite | scans | at |",
        "|---|---|---|---|---:|---|",
    ]
    for fault in caught:
        verdict = verdicts[fault.id]
        step = verdict.difference.step if verdict.difference else ""
        cells = [fault.id, fault.mistake, ", ".join(fault.breaks), fault.suite, f"{verdict.scans:,}", step]
        lines.append(f"| {' | '.join(cells)} |")
    lines += [
        "",
        "Not shown by any suite:",
        "",
        "| fault | the mistake | why not |",
        "|---|---|---|",
    ]
    lines += [f"| {fault.id} | {fault.mistake} | {fault.reason} |" for fault in faults if fault.reason]
    return "\n".join(lines) + "\n"


def renew(faults: Sequence[Fault], made: Mapping[str, Path], source: Path) -> None:
    """Take the pack's vectors from the suites in `source`: `brief` as it is, of the others what catches a
    fault.

    Raises Unjudged when a suite is not there.
    """
    for name in (WHOLE, *PARTS):
        if not (source / f"{name}.jsonl.gz").is_file():
            raise Unjudged(
                f"{source}: no {name}.jsonl.gz; `modeproof conform fplc --suite {name} ..` makes it"
            )
    VECTORS.mkdir(exist_ok=True)
    whole = "".join(line.decode() for line in read_lines(source / f"{WHOLE}.jsonl.gz"))
    _write(vectors(WHOLE), whole.splitlines())
    for name in PARTS:
        chosen = [fault for fault in faults if fault.suite == name]
        _write(vectors(name), _beginnings(source / f"{name}.jsonl.gz", chosen, made))


def _beginnings(path: Path, faults: Sequence[Fault], made: Mapping[str, Path]) -> list[str]:
    """The header, and of each case that catches a fault what comes up to the scan that does."""
    suite = open_suite(path)
    ends: dict[str, int] = {}
    for fault in faults:
        found = judge(made[fault.id], suite).difference
        if found is None:
            raise Unjudged(f"{fault.id}: the suite {suite.name} does not catch it")
        ends[found.case.id] = max(ends.get(found.case.id, 0), found.scan)
    rows = []
    lines = read_lines(path)
    header = json.loads(next(lines))
    for line in lines:
        row = json.loads(line)
        if row["id"] in ends:
            row["scans"] = row["scans"][: ends[row["id"]]]
            row["why"] = f"beginning of {row['id']}: {row['why']}"
            going_in = [(scan["dt_ms"], scan["in"]) for scan in row["scans"]]
            row["id"] = case_id(header["target"], row["params"], going_in)
            rows.append(row)
    header |= {
        "guarantees": f"what of the suite {suite.name} catches a program of the faulty pack",
        "cases": len(rows),
        "scans": sum(len(row["scans"]) for row in rows),
    }
    return [json.dumps(row, separators=(",", ":")) for row in (header, *rows)]


def _write(path: Path, lines: Iterable[str]) -> None:
    text = "".join(f"{line}\n" for line in lines).encode()
    part = path.with_suffix(".part")
    part.write_bytes(gzip.compress(text, 9, mtime=0))
    os.replace(part, path)


def main(argv: Sequence[str]) -> int:
    """The command; see the module's text."""
    parser = argparse.ArgumentParser(description="Judge the faulty programs.")
    parser.add_argument("ids", nargs="*", metavar="FAULT", help="only these")
    parser.add_argument("--render", action="store_true", help="write README.md anew")
    parser.add_argument(
        "--renew", type=Path, metavar="FOLDER", help="take the vectors anew from brief and tour there"
    )
    args = parser.parse_args(argv)
    try:
        return _run(args)
    except Unjudged as error:
        print(f"UNJUDGED: {error}", file=sys.stderr)
        return 2


def _run(args: argparse.Namespace) -> int:
    every = load_faults()
    unknown = set(args.ids) - {fault.id for fault in every}
    if unknown or (args.ids and (args.render or args.renew)):
        raise Unjudged(
            f"no fault {', '.join(sorted(unknown))}" if unknown else "the page and the vectors are of all"
        )
    chosen = [fault for fault in every if not args.ids or fault.id in args.ids]
    good = True
    with tempfile.TemporaryDirectory() as folder:
        made = build_all(Path(folder), chosen)
        if args.renew:
            renew(chosen, made, args.renew)
        suites = open_all()
        if not args.ids:
            for name, suite in suites.items():
                verdict = judge(made[""], suite)
                good &= verdict.word == "CONFORMS"
                mark = "ok " if verdict.word == "CONFORMS" else "NOT"
                print(f"{mark} without a fault: {verdict.word}, {name}, {verdict.scans:,} scans")
        verdicts = judge_all(made, chosen, suites)
    for fault in chosen:
        verdict = verdicts[fault.id]
        expected = as_expected(fault, verdict)
        good &= expected
        mark = "ok " if expected else "NOT"
        why = f"; {verdict.reason}" if verdict.reason else ""
        print(f"{mark} {fault.id}: {verdict.word}, {verdict.suite}, {verdict.scans:,} scans{why}")
        if args.ids:
            print(as_text(verdict))
    if args.render and good:
        PAGE.write_text(as_page(every, verdicts, suites), encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
