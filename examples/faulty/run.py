"""Builds every faulty program of every pack and lets the kit judge it. Needs gcc and nothing else.

    python examples/faulty/run.py                       all faults of all programs, each by its suite
    python examples/faulty/run.py no-settle LA-edge     these
    python examples/faulty/run.py --program fplc        those of one program
    python examples/faulty/run.py --render              all, and the pages anew
    python examples/faulty/run.py --program fplc --renew FOLDER    with vectors anew from the suites there

faults.toml, README.md and vectors/ are the pack of fplc.c. A function block SF of examples/c has SF.toml,
SF.md and vectors/SF/ here, and needs no line in this file.

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
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))

from modeproof.ground.fitted import fitted  # noqa: E402
from modeproof.kit.adapter import Adapter  # noqa: E402
from modeproof.kit.errors import Unjudged  # noqa: E402
from modeproof.kit.suite_judge import Verdict, run_suite  # noqa: E402
from modeproof.kit.text import as_text  # noqa: E402
from modeproof.kit.vectors import Suite, case_id, open_suite, read_lines  # noqa: E402

HERE = Path(__file__).resolve().parent
PACK, PAGE, VECTORS = HERE / "faults.toml", HERE / "README.md", HERE / "vectors"
FOLDER = ROOT / "examples/c"
HEAD = "| fault | the mistake | breaks | suite | scans | at |"
HEAD_PASSED = "| fault | the mistake | why not |"
"""Of the faults that a suite shows, and of those that none does."""
WHOLE, PARTS = "brief", ("tour", "words", "wp", "times", "parameters", "soak")
"""The first suite that a fault meets, and the others. Of those that are not published the pack holds what
catches a fault."""
SUITES = dict.fromkeys((WHOLE, *PARTS), False) | {"none": True}
"""For each suite whether its faults need a reason: why they pass all suites."""
COMPILE = ("gcc", "-std=c99", "-O0", "-w")
"""Not optimized: most of the time goes into compiling. No warnings: mistakes are the point."""


@dataclass(frozen=True)
class Program:
    """A program of examples/c that has a pack of faults: what it is built from, and where its pack is."""

    target: str
    sources: tuple[str, ...]
    pack: Path
    page: Path
    vectors: Path


FPLC = Program("fplc", ("fplc.c", "wire.c", "adapter.c"), PACK, PAGE, VECTORS)


def block(target: str) -> Program:
    """A function block, whose files have its name."""
    sources = (f"{target}.c", f"{target}_adapter.c", "wire.c", "adapter_block.c")
    return Program(target, sources, HERE / f"{target}.toml", HERE / f"{target}.md", VECTORS / target)


def programs() -> tuple[Program, ...]:
    """The F-PLC, and every function block that has a pack."""
    blocks = (block(path.stem.removesuffix("_adapter")) for path in sorted(FOLDER.glob("*_adapter.c")))
    return (FPLC, *(one for one in blocks if one.pack.is_file()))


def headers() -> tuple[str, ...]:
    """Every header of examples/c."""
    return tuple(sorted(path.name for path in FOLDER.glob("*.h")))


@dataclass(frozen=True)
class Fault:
    """One edit of one file: `old`, which stands there exactly once, becomes `new`.

    `breaks` names clauses and findings. `suite` is the first that catches it of brief, tour, words, wp,
    times, parameters and soak; none of them catches one that has a `reason`.
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


def build(
    folder: Path, fault: Fault | None = None, good: Path | None = None, program: Program = FPLC
) -> Path:
    """Compile the program into `folder`, with the fault if one is given; returns what to start.

    `good` is the folder of the program without fault: its objects are taken where the fault does not touch
    them. Raises Unjudged with the compiler's first line.
    """
    folder.mkdir(parents=True, exist_ok=True)
    touched = () if fault is None else (Path(fault.file).name,)
    for name in (*program.sources, *headers()):
        text = (FOLDER / name).read_text(encoding="utf-8")
        if fault is not None and name in touched:
            text = text.replace(fault.old, fault.new)
        (folder / name).write_text(text, encoding="utf-8")
    everywhere = bool(set(touched) & set(headers()))
    fresh = [name for name in program.sources if good is None or name in touched or everywhere]
    for name in fresh:
        _call([*COMPILE, "-c", name], folder)
    objects = [
        str((folder if name in fresh or good is None else good) / name.replace(".c", ".o"))
        for name in program.sources
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


def build_all(folder: Path, faults: Iterable[Fault], program: Program = FPLC) -> dict[str, Path]:
    """Every faulty program by the id of its fault, and the good one by the empty name."""
    made = {"": build(folder / "good", program=program)}
    chosen = list(faults)
    with ThreadPoolExecutor() as pool:
        paths = pool.map(lambda fault: build(folder / fault.id, fault, folder / "good", program), chosen)
        made |= {fault.id: path for fault, path in zip(chosen, paths, strict=True)}
    return made


def vectors(suite: str, program: Program = FPLC) -> Path:
    """The vectors of a suite: as it is published, or what the pack holds of one that is not."""
    path = ROOT / "vectors" / program.target / f"{suite}.jsonl.gz"
    return path if path.is_file() else program.vectors / path.name


def open_all(program: Program = FPLC) -> dict[str, Suite]:
    """The suites that the pack needs: `brief`, and those that catch another fault.

    Raises Unjudged for one that is missing or damaged.
    """
    return {name: open_suite(vectors(name, program)) for name in used(load_faults(program.pack))}


def used(faults: Iterable[Fault]) -> tuple[str, ...]:
    """The suites that a pack with these faults needs."""
    needed = {fault.suite for fault in faults}
    return (WHOLE, *(name for name in PARTS if name in needed))


def unpublished(faults: Iterable[Fault], program: Program) -> tuple[str, ...]:
    """Those of them that are not published, so that the pack holds what it needs of them."""
    return tuple(name for name in used(faults) if vectors(name, program).parent == program.vectors)


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


def as_page(
    program: Program, faults: Sequence[Fault], verdicts: Mapping[str, Verdict], suites: Mapping[str, Suite]
) -> str:
    """The page of a pack: every fault with what caught it."""
    caught = [fault for fault in faults if not fault.reason]
    by_suite = {name: sum(fault.suite == name for fault in caught) for name in suites}
    first = f"{by_suite[WHOLE]} by suite `{WHOLE}` ({suites[WHOLE].scan_count:,} scans)"
    more = [f"{by_suite[name]} more by `{name}`" for name in suites if name != WHOLE]
    only = f" --program {program.target}"
    about = "../c/README.md" if program == FPLC else f"../c/{program.sources[0]}"
    lines = [
        "# Programs that are wrong in one place" + ("" if program == FPLC else f": {program.target}"),
        "",
        "Is a verdict CONFORMS worth anything? Only if wrong programs do not get it. Each fault here is one",
        f"edit of [the C program]({about}), a mistake that a good programmer makes;",
        f"[`{program.pack.name}`]({program.pack.name}) has the edits.",
        "",
        "```",
        f"{f'python3 examples/faulty/run.py{only}':<50} # builds and judges all of them; needs gcc alone",
        f"{f'python3 examples/faulty/run.py {caught[-1].id}':<50} # one of them, with the kit's report",
        "```",
        "",
        f"{len(caught)} faults are rejected with relation `exact`:",
        f"{', '.join([first, *more])}.",
    ]
    passed = [fault for fault in faults if fault.reason]
    if passed:
        lines.append(f"{len(passed)} others stand at the end, with the reason why all suites let them pass.")
    lines += [
        "The program without a fault conforms.",
        *(["Each function block has a page of its own beside this one."] if program == FPLC else []),
        "",
        "*Scans* counts the scans up to the first wrong output. *At* is the step that the specification took",
        "there; it may come later than the mistake. Of suites that are not published the pack holds only the",
        "beginnings of the cases that catch a fault, and *scans* counts in these.",
        "",
        HEAD,
        "|---|---|---|---|---:|---|",
        *(row(fault, verdicts[fault.id]) for fault in caught),
    ]
    if passed:
        lines += ["", "Not shown by any suite:", "", HEAD_PASSED, "|---|---|---|"]
        lines += [f"| {fault.id} | {fault.mistake} | {fault.reason} |" for fault in passed]
    return fitted("\n".join(lines))


def row(fault: Fault, verdict: Verdict) -> str:
    """The line of the page for a fault that is caught."""
    step = verdict.difference.step if verdict.difference else ""
    cells = [fault.id, fault.mistake, ", ".join(fault.breaks), fault.suite, f"{verdict.scans:,}", step]
    return f"| {' | '.join(cells)} |"


def renew(faults: Sequence[Fault], made: Mapping[str, Path], source: Path, program: Program = FPLC) -> None:
    """Take the pack's vectors from the suites in `source`: what catches a fault that `brief` does not.

    Raises Unjudged when a suite is not there.
    """
    chosen = unpublished(faults, program)
    for name in chosen:
        if not (source / f"{name}.jsonl.gz").is_file():
            command = f"modeproof conform {program.target} --suite {name} .."
            raise Unjudged(f"{source}: no {name}.jsonl.gz; `{command}` makes it")
    for name in chosen:
        program.vectors.mkdir(exist_ok=True, parents=True)
        those = [fault for fault in faults if fault.suite == name]
        _write(vectors(name, program), _beginnings(source / f"{name}.jsonl.gz", those, made))


def _beginnings(path: Path, faults: Sequence[Fault], made: Mapping[str, Path]) -> list[str]:
    """The header, and of each case that catches a fault what comes up to the scan that does.

    Of a case with other parameters than the one before also the first scan: a program may remember them.
    """
    suite = open_suite(path)
    ends: dict[str, int] = {}
    for fault in faults:
        found = judge(made[fault.id], suite).difference
        if found is None:
            raise Unjudged(f"{fault.id}: the suite {suite.name} does not catch it")
        ends[found.case.id] = max(ends.get(found.case.id, 0), found.scan)
    rows: list[dict[str, Any]] = []
    lines = read_lines(path)
    header = json.loads(next(lines))
    sent: Any = None
    for line in lines:
        row = json.loads(line)
        if row["id"] in ends or row["params"] != sent:
            rows.append(_beginning(header, row, ends.get(row["id"], 1)))
        sent = row["params"]
    header |= {
        "guarantees": f"what of the suite {suite.name} catches a program of the faulty pack",
        "cases": len(rows),
        "scans": sum(len(row["scans"]) for row in rows),
    }
    return [json.dumps(row, separators=(",", ":")) for row in (header, *rows)]


def _beginning(header: Mapping[str, Any], row: dict[str, Any], scans: int) -> dict[str, Any]:
    """The first scans of a case, as a case of its own."""
    kept = row["scans"][:scans]
    id = case_id(header["target"], row["params"], [(scan["dt_ms"], scan["in"]) for scan in kept])
    return row | {"scans": kept, "why": f"beginning of {row['id']}: {row['why']}", "id": id}


def _write(path: Path, lines: Iterable[str]) -> None:
    text = "".join(f"{line}\n" for line in lines).encode()
    part = path.with_suffix(".part")
    part.write_bytes(gzip.compress(text, 9, mtime=0))
    os.replace(part, path)


def main(argv: Sequence[str]) -> int:
    """The command; see the module's text."""
    parser = argparse.ArgumentParser(description="Judge the faulty programs.")
    parser.add_argument("ids", nargs="*", metavar="FAULT", help="only these")
    parser.add_argument("--program", metavar="TARGET", help="only those of one program")
    parser.add_argument("--render", action="store_true", help="write the pages anew")
    parser.add_argument(
        "--renew", type=Path, metavar="FOLDER", help="take the vectors anew from the suites there"
    )
    parser.add_argument("--unpublished", action="store_true", help="name the suites that --renew needs")
    args = parser.parse_args(argv)
    try:
        return _run(args)
    except Unjudged as error:
        print(f"UNJUDGED: {error}", file=sys.stderr)
        return 2


def _run(args: argparse.Namespace) -> int:
    asked = [one for one in programs() if args.program in (None, one.target)]
    every = {one.target: load_faults(one.pack) for one in asked}
    unknown = set(args.ids) - {fault.id for faults in every.values() for fault in faults}
    if not asked or unknown:
        raise Unjudged(f"no fault {', '.join(sorted(unknown))}" if asked else f"no pack of {args.program}")
    if args.ids and (args.render or args.renew):
        raise Unjudged("the page and the vectors are of all")
    if args.renew and args.program is None:
        raise Unjudged("--renew needs --program: each has vectors of its own")
    if args.unpublished:
        print(*(name for one in asked for name in unpublished(every[one.target], one)))
        return 0
    good = True
    for program in asked:
        chosen = [fault for fault in every[program.target] if not args.ids or fault.id in args.ids]
        if chosen:
            good &= _judge_pack(program, chosen, args)
    return 0 if good else 1


def _judge_pack(program: Program, chosen: Sequence[Fault], args: argparse.Namespace) -> bool:
    """Build, judge and print the faults of one program; whether all is as expected."""
    good = True
    with tempfile.TemporaryDirectory() as folder:
        made = build_all(Path(folder), chosen, program)
        if args.renew:
            renew(chosen, made, args.renew, program)
        suites = open_all(program)
        if not args.ids:
            for name, suite in suites.items():
                verdict = judge(made[""], suite)
                good &= verdict.word == "CONFORMS"
                mark = "ok " if verdict.word == "CONFORMS" else "NOT"
                found = f"{verdict.word}, {name}, {verdict.scans:,} scans"
                print(f"{mark} {program.target} without a fault: {found}")
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
        program.page.write_text(as_page(program, chosen, verdicts, suites), encoding="utf-8")
    return good


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
