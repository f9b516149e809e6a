"""Judges every faulty program of st.toml (ST, SCL, FBD, LD, statement list) by `modeproof prove-program`.

    .venv/bin/python examples/faulty/st.py                        all faults
    .venv/bin/python examples/faulty/st.py st-edm-precedence      these
    .venv/bin/python examples/faulty/st.py --render               all, and st.md anew; or lines of --target T

Exit status: 0 all as expected, 1 not, 2 could not be judged.
"""

from __future__ import annotations

import argparse
import re
import shutil
import sys
import tempfile
import time
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))

from modeproof.ground.errors import Unjudged  # noqa: E402
from modeproof.ground.fitted import fitted  # noqa: E402
from programs.equality.binding import read_binding  # noqa: E402
from programs.equality.comparison import make  # noqa: E402
from programs.equality.replay import replay  # noqa: E402
from programs.equality.verdict import Verdict  # noqa: E402
from programs.equality.verdict import judge as judge_product  # noqa: E402

HERE = Path(__file__).resolve().parent
PACK, PAGE = HERE / "st.toml", HERE / "st.md"
SECONDS = 60.0
HEAD_PROVED = "| fault | the edit | why it changes nothing |"
LINE = r"^(?=\| ((?:st|scl|fbd|ld|stl)-\S+) \|)(.*)$"
"""A line of the page, and the fault that it is about."""
BINDINGS = {
    "examples/st/fplc.st": "examples/cautious.toml",
    "examples/st/sf_edm.scl": "examples/cautious.toml",
    "examples/plcopen/sf_edm.xml": "examples/cautious.toml",
    "examples/plcopen/sf_guard_locking.xml": "examples/plcopen/sf_guard_locking.toml",
}
"""Of the programs that do not make the choices of the letter."""


@dataclass(frozen=True)
class Fault:
    """One edit of one file: `old`, which stands there exactly once, becomes `new`.

    It is REFUTED; one with a `reason` is PROVED equal, and that is why.
    """

    id: str
    file: str
    old: str
    new: str
    mistake: str
    reason: str = ""

    @property
    def target(self) -> str:
        """What the program is compared with."""
        return Path(self.file).stem

    @property
    def expected(self) -> str:
        """The verdict."""
        return "PROVED" if self.reason else "REFUTED"


def load_faults(path: Path = PACK) -> tuple[Fault, ...]:
    """The faults in the order of the file. Raises Unjudged naming the fault that cannot be used."""
    try:
        faults = tuple(Fault(**row) for row in tomllib.loads(path.read_text("utf-8"))["fault"])
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise Unjudged(f"{path.name}: {type(error).__name__} {error}") from None
    for fault in faults:
        times = (ROOT / fault.file).read_text("utf-8").count(fault.old)
        if times != 1 or fault.old == fault.new:
            raise Unjudged(f"{path.name}: {fault.id}: `old` stands {times} times in {fault.file}")
    if len({fault.id for fault in faults}) != len(faults):
        raise Unjudged(f"{path.name}: two faults have the same id")
    return faults


def judge(fault: Fault, folder: Path) -> Verdict:
    """The verdict on the program with the fault; scans that refute it are replayed once more."""
    whole = ROOT / fault.file
    path = folder / fault.id / whole.name
    path.parent.mkdir()
    path.write_text(whole.read_text("utf-8").replace(fault.old, fault.new), "utf-8")
    if path.suffix == ".awl":
        for beside in whole.parent.glob("*.csv"):
            shutil.copy(beside, path.parent)
    binding = read_binding(ROOT / BINDINGS[fault.file]) if fault.file in BINDINGS else {}
    product = make([path], fault.target, binding=binding)
    search = fault.target != "fplc"  # half a minute each, to save a few scans
    found = judge_product(product, ROOT / "vectors" / fault.target, SECONDS, lambda text: None, search)
    if found.difference is not None:
        again = replay(product.binding, False, found.difference.run, "")
        if again is None or again.differing != found.difference.differing:
            raise Unjudged(f"{fault.id}: the scans did not come out again")
    return found


def as_page(faults: Sequence[Fault], rows: Mapping[str, str]) -> str:
    """st.md: every fault with what came out. rows: the line of each that is refuted."""
    refuted = [fault for fault in faults if not fault.reason]
    lines = [
        "# Programs that are wrong in one place, judged by a proof",
        "",
        "Each fault is one edit of a program in [Structured Text or SCL](../st) (`st-`, `scl-`), of "
        "[a function block diagram or a ladder](../plcopen) (`fbd-`, `ld-`), or of "
        "[statement list](../awl) (`stl-`). [`st.toml`](st.toml) has the edits.",
        "",
        "```",
        ".venv/bin/python examples/faulty/st.py",
        "```",
        "",
        f"{len(refuted)} faults are REFUTED by `modeproof prove-program`, with scans from power-up that were "
        "run again on the reference implementation and on the program's interpreter. *Scans* counts them; "
        "the last one differs.",
        "",
        "| fault | the mistake | scans | found by |",
        "|---|---|---:|---|",
        *(rows[fault.id] for fault in refuted),
        "",
        "PROVED equal in spite of the edit:",
        "",
        HEAD_PROVED,
        "|---|---|---|",
        *(f"| {fault.id} | {fault.mistake} | {fault.reason} |" for fault in faults if fault.reason),
    ]
    return fitted("\n".join(lines))


def row(fault: Fault, verdict: Verdict) -> str:
    """The line of the table for a fault that is refuted."""
    assert verdict.difference is not None
    by = verdict.difference.found_by
    suite = f"suite `{by.partition(' of ')[2].partition(',')[0]}`" if by.startswith("published") else by
    return f"| {fault.id} | {fault.mistake} | {len(verdict.difference.scans)} | {suite} |"


def main(argv: Sequence[str]) -> int:
    """The command; see the module's text."""
    parser = argparse.ArgumentParser(description="Judge the faulty programs.")
    parser.add_argument("ids", nargs="*", metavar="FAULT", help="only these")
    parser.add_argument("--target", metavar="T", help="only those of programs that are compared with T")
    parser.add_argument("--render", action="store_true", help="write st.md anew, as far as judged")
    args = parser.parse_args(argv)
    try:
        every = load_faults()
        unknown = set(args.ids) - {fault.id for fault in every}
        if unknown:
            raise Unjudged(f"no fault {', '.join(sorted(unknown))}")
        faults = [
            fault
            for fault in every
            if (not args.ids or fault.id in args.ids) and args.target in (None, fault.target)
        ]
        if not faults:
            raise Unjudged(f"no fault of {args.target}")
        rows, wrong = dict(re.findall(LINE, PAGE.read_text("utf-8"), re.M)), 0
        with tempfile.TemporaryDirectory() as folder:
            for fault in faults:
                began = time.process_time()
                found = judge(fault, Path(folder))
                good = found.word == fault.expected
                if found.word == "REFUTED":
                    rows[fault.id] = row(fault, found)
                    print(rows[fault.id], flush=True)
                wrong += not good
                seconds = time.process_time() - began
                print(f"{'ok ' if good else 'NOT'} {fault.id}: {found.word} {found.missing} {seconds:.1f} s")
        unknown = {fault.id for fault in every if not fault.reason} - {*rows}
        if args.render and unknown:
            raise Unjudged(f"{PAGE.name} has no line yet for {', '.join(sorted(unknown))}: judge these too")
        if args.render and not wrong:
            PAGE.write_text(as_page(every, rows), "utf-8")
        return 1 if wrong else 0
    except Unjudged as error:
        print(f"UNJUDGED: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
