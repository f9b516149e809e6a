"""Lets the kit judge every faulty statement-list program of awl.toml. Needs awlsim (examples/awl).

    python examples/faulty/awl.py                       all faults, each by its suite
    python examples/faulty/awl.py awl-byte-compared     these, with the kit's report
    python examples/faulty/awl.py --render              all, and awl.md anew

Exit status: 0 all as expected, 1 not, 2 could not be judged.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))

from examples.faulty.run import HEAD, HEAD_PASSED, HERE, WHOLE, Fault, load_faults, vectors  # noqa: E402
from modeproof.ground.fitted import fitted  # noqa: E402
from modeproof.kit.adapter import Adapter  # noqa: E402
from modeproof.kit.errors import Unjudged  # noqa: E402
from modeproof.kit.suite_judge import Plan, Verdict, run_suite  # noqa: E402
from modeproof.kit.text import as_text  # noqa: E402
from modeproof.kit.vectors import Suite, open_suite  # noqa: E402

PACK, PAGE = HERE / "awl.toml", HERE / "awl.md"
AWL = ROOT / "examples/awl"
ADAPTER = AWL / "adapter.py"
SOURCES = ("fplc.awl", "plc.awl", "symbols.csv")
TIMEOUT_S = 60.0


def target_of(fault: Fault) -> str:
    """The target whose program has the fault; the symbols are tried on the F-PLC."""
    return "plc" if fault.file.endswith("/plc.awl") else "fplc"


def write(folder: Path, fault: Fault | None = None) -> Path:
    """The programs in `folder`, with the fault if one is given; returns the one to start."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in SOURCES:
        text = (AWL / name).read_text(encoding="utf-8")
        if fault is not None and Path(fault.file).name == name:
            text = text.replace(fault.old, fault.new)
        (folder / name).write_text(text, encoding="utf-8")
    return folder / f"{target_of(fault) if fault else 'fplc'}.awl"


def suite_of(fault: Fault) -> Suite:
    """The pack's vectors that show the fault; the fast suite where none does."""
    if target_of(fault) == "plc":
        return open_suite(ROOT / "vectors" / "plc" / f"{WHOLE}.jsonl.gz")
    return open_suite(vectors(WHOLE if fault.reason else fault.suite))


def judge(program: Path, suite: Suite, timeout_s: float = TIMEOUT_S, plan: Plan | None = None) -> Verdict:
    """What the kit says about a program."""
    command = [sys.executable, str(ADAPTER), suite.target, str(program)]
    return run_suite(suite, lambda: Adapter(command, timeout_s), plan=plan)


def judge_all(
    folder: Path, faults: Sequence[Fault], timeout_s: float = TIMEOUT_S, plan: Plan | None = None
) -> dict[str, Verdict]:
    """What the kit says about each fault, two at a time."""
    with ThreadPoolExecutor(2) as pool:
        verdicts = pool.map(
            lambda fault: judge(write(folder / fault.id, fault), suite_of(fault), timeout_s, plan),
            faults,
        )
        return {fault.id: verdict for fault, verdict in zip(faults, verdicts, strict=True)}


def row(fault: Fault, verdict: Verdict) -> str:
    """The line of the table for a fault that is caught."""
    step = verdict.difference.step if verdict.difference else ""
    cells = [fault.id, fault.mistake, ", ".join(fault.breaks), fault.suite, f"{verdict.scans:,}", step]
    return f"| {' | '.join(cells)} |"


def as_page(faults: Sequence[Fault], verdicts: Mapping[str, Verdict]) -> str:
    """awl.md: every fault with what caught it."""
    caught = [fault for fault in faults if not fault.reason]
    lines = [
        "# Statement-list programs that are wrong in one place",
        "",
        "Each fault is one edit of [the programs in AWL](../awl/README.md); [`awl.toml`](awl.toml) has the",
        "edits. Those of the C program have [a page of their own](README.md), which explains the columns.",
        "",
        "```",
        ".venv/bin/python examples/faulty/awl.py",
        "```",
        "",
        f"{len(caught)} faults are rejected with relation `exact`.",
        "",
        HEAD,
        "|---|---|---|---|---:|---|",
        *(row(fault, verdicts[fault.id]) for fault in caught),
        "",
        "Not shown by any suite here:",
        "",
        HEAD_PASSED,
        "|---|---|---|",
        *(f"| {fault.id} | {fault.mistake} | {fault.reason} |" for fault in faults if fault.reason),
    ]
    return fitted("\n".join(lines))


def main(argv: Sequence[str]) -> int:
    """The command; see the module's text."""
    parser = argparse.ArgumentParser(description="Judge the faulty statement-list programs.")
    parser.add_argument("ids", nargs="*", metavar="FAULT", help="only these")
    parser.add_argument("--render", action="store_true", help="write awl.md anew")
    args = parser.parse_args(argv)
    try:
        every = load_faults(PACK)
        unknown = set(args.ids) - {fault.id for fault in every}
        if unknown:
            raise Unjudged(f"no fault {', '.join(sorted(unknown))}")
        chosen = [fault for fault in every if not args.ids or fault.id in args.ids]
        with tempfile.TemporaryDirectory() as folder:
            verdicts = judge_all(Path(folder), chosen)
    except Unjudged as error:
        print(f"UNJUDGED: {error}", file=sys.stderr)
        return 2
    good = True
    for fault in chosen:
        verdict = verdicts[fault.id]
        expected = verdict.word == ("CONFORMS" if fault.reason else "DIFFERS")
        good &= expected
        why = f"; {verdict.reason}" if verdict.reason else ""
        print(f"{'ok ' if expected else 'NOT'} {fault.id}: {verdict.word}, {verdict.scans:,} scans{why}")
        if args.ids:
            print(as_text(verdict))
    if args.render and good and not args.ids:
        PAGE.write_text(as_page(every, verdicts), encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
