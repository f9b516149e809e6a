"""The larger trials of prove-program: nothing here is a test.

    python -m tests.bench_programs fuzz [PROGRAMS [SCANS]]     random programs, interpreter against terms
    python -m tests.bench_programs mutants [NUMBER [SEED]]     one-edit mutants of examples/st/sf_*.st
    python -m tests.bench_programs coverage FOLDER...          blocks of public collections: read, translated
    python -m tests.bench_programs composed FOLDER [NAME]      specifications of a public collection, judged

Exit status: 0 nothing found, 1 something that must not be.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.ground.processes import in_forks
from programs.equality import replay as replay_room
from programs.equality.comparison import make
from programs.equality.replay import Difference, published, replay
from programs.equality.verdict import judge
from tests.programs import composed
from tests.programs.coverage import Collection, table
from tests.programs.fuzz import difference_of_text
from tests.programs.generate import program
from tests.programs.mutants import Mutant, mutants

LIMIT_S = 400.0
"""Wall-clock time for one mutant."""
SEARCH_S = 20.0
SUITES = ("sequences", "brief", "parameters", "sic", "times")
MOST_SCANS = 30_000
PROPERTY_S = 60.0
"""CPU time for one specification."""


def fuzz(programs: int, scans: int) -> int:
    """Random programs, each for so many scans; every second one with integers that wrap."""
    began, found = time.process_time(), 0
    for seed in range(programs):
        difference = difference_of_text(program(seed), seed, scans, wrap=bool(seed % 2))
        if difference:
            found += 1
            print(f"program {seed}: {difference}", flush=True)
    seconds = time.process_time() - began
    print(f"{programs:,} programs, {programs * scans:,} scans, {found} differences, {seconds:.0f} s CPU")
    return 1 if found else 0


# ---------------------------------------------------------------- mutants


def chosen(number: int, seed: int) -> list[Mutant]:
    """So many mutants, in turn from each example."""
    paths = sorted((root() / "examples/st").glob("sf_*.st"))
    streams = [mutants(path.stem, path.read_text("utf-8"), seed) for path in paths]
    found: list[Mutant] = []
    while len(found) < number and streams:
        for stream in list(streams):
            mutant = next(stream, None)
            if mutant is None:
                streams.remove(stream)
            elif len(found) < number:
                found.append(mutant)
    return found


def verdict_on(mutant: Mutant) -> tuple[str, str]:
    """What prove-program says, and what contradicts it."""
    vectors = root() / "vectors" / mutant.file
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "mutant.st")
        path.write_text(mutant.text, "utf-8")
        try:
            product = make([path], mutant.file)
        except Unjudged:
            return "refused", ""
        found = judge(product, vectors, SEARCH_S, lambda text: None, fewest=False)
    if found.word == "REFUTED":
        assert found.difference is not None
        scans = found.difference
        again = replay(product.binding, product.wrap, scans.run, "")
        same = again is not None and again.differing == scans.differing and again.stopped == scans.stopped
        return found.word, "" if same else "the scans do not come out again"
    if found.word == "PROVED":
        for name, value in (("SUITES", SUITES), ("MOST_SCANS", MOST_SCANS)):
            setattr(replay_room, name, value)
        other = published(product.binding, product.wrap, vectors)
        return found.word, f"{other.found_by} differs" if isinstance(other, Difference) else ""
    return found.word, ""


def try_mutants(number: int, seed: int) -> int:
    """Judge mutants one by one, each in a process of its own."""
    began = time.monotonic()
    every = chosen(number, seed)
    words: Counter[str] = Counter()
    wrong = 0
    for outcome in in_forks(verdict_on, every, 1, LIMIT_S):
        if outcome is None:
            continue
        mutant = every[outcome.number]
        word, contradiction = outcome.result or ("no verdict", outcome.why)
        words[word] += 1
        if contradiction and word != "no verdict":
            wrong += 1
        if word != "REFUTED" or contradiction:
            print(f"{word:<10} {mutant} {contradiction}", flush=True)
        if words.total() % 25 == 0:
            print(f"{words.total()} judged: {dict(words)}; {wrong} false", flush=True)
    print(f"{len(every)} mutants: {dict(words)}; {wrong} false; {time.monotonic() - began:.0f} s")
    return 1 if wrong else 0


# ---------------------------------------------------------------- composed programs


def judge_composed(folder: Path, name: str) -> int:
    """Judge the specifications of the units with this text in their names (see `tests.programs.composed`)."""
    words: Counter[str] = Counter()
    for of in composed.specifications(folder):
        if name not in of.unit:
            continue
        found, seconds = composed.judge(of, folder, PROPERTY_S)
        scans = len(found.trace.scans) if found.trace else found.scans or ""
        words[found.word] += 1
        print(
            f"| {of.unit} | `{of.formula}` | {of.bound} | {found.word} | {scans} | {seconds:.1f} |",
            flush=True,
        )
    print(f"{words.total()} specifications: {dict(words)}")
    return 0 if words.total() and not {*words} - {"PROVED", "REFUTED", "EMPTY"} else 1


def main(arguments: list[str]) -> int:
    """The command; see the module's text."""
    match arguments:
        case ["fuzz", *numbers]:
            return fuzz(*[int(number) for number in (*numbers, *("1000", "100")[len(numbers) :])])
        case ["mutants", *numbers]:
            return try_mutants(*[int(number) for number in (*numbers, *("300", "1")[len(numbers) :])])
        case ["coverage", *folders] if folders:
            wrong = 0
            for folder in folders:
                collection = Collection(Path(folder))
                print("\n".join(table(collection)), flush=True)
                wrong += len(collection.wrong)
            return 1 if wrong else 0
        case ["composed", folder, *names] if len(names) < 2:
            return judge_composed(Path(folder), *(names or [""]))
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
