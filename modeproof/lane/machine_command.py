"""The command `machine`: its options. The room `machines` does the work."""

from __future__ import annotations

import argparse
import re
import shlex
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, first_of
from modeproof.ground.lock import only_one
from modeproof.ground.meaning import is_there, meaning_of, reached
from modeproof.ground.places import TREE, adding, documents, machines, root
from modeproof.ground.solvers import needing_solvers
from modeproof.lane import machine_tlc
from modeproof.lane.summary import machine_line
from modeproof.output.options import About, add_options, carried_out
from modeproof.output.outcome import Outcome, shown_path
from modeproof.report.verdicts import status_of, verdict_on_machine
from modeproof.tlc.start_up import entries
from modeproof.tlc.toolchain import find_toolchain

ID = "machine"
MODELS = "tlc.toml"
CODE = ("modeproof.lane.machine_command", "machines.evidence")
"""What judges a machine, and .."""
MODELS_CODE = ("modeproof.lane.machine_tlc", "machines.tlc_runs")
"""..what makes its runs of TLC, and judges them."""
FILES = ("program", "picture", "model")
WORKS = (("vectors",), ("tlc",), ("trial",), ("killers",), ("evidence",))
"""What is done in the place of a judgement; those in a row are one."""
JUDGED = ("json", "junit", "recheck", "record")
"""What belongs to a judgement."""


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `machine` to the commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "machine",
        description="PROVED (0): each property is true after every scan, for every input. REFUTED (1): scans "
        "from power-up that break one. UNKNOWN (2): neither, or the file was refused. See "
        "docs/wire-your-machine.md.",
    )
    parser.add_argument(
        "file", nargs="?", type=Path, metavar="WIRING", help="yours; spec/machine_cell/wiring.toml without it"
    )
    parser.add_argument("--properties", type=Path, metavar="TOML", help="in the place of safety.toml there")
    parser.add_argument("--use", type=Path, metavar="TOML", help="in the place of use.toml there")
    parser.add_argument(
        "--seconds", type=float, default=120, metavar="S", help="limit of the proof, of CPU (120)"
    )
    parser.add_argument("--recheck", action="store_true", help="z3 and cvc5 judge the proof again")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the verdicts there as well")
    parser.add_argument("--junit", type=Path, metavar="FILE", help="write the verdicts there as JUnit XML")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.add_argument(
        "--program", type=Path, metavar="FILE", help="write the machine as Structured Text there"
    )
    parser.add_argument(
        "--source",
        nargs="+",
        type=Path,
        metavar="FILE",
        help="judge this program (ST, SCL, PLCopen XML, statement list); WIRING says what its names mean",
    )
    parser.add_argument(
        "--equal",
        action="store_true",
        help="with --source: every output is what WIRING gives, in the place of the properties",
    )
    parser.add_argument("--unit", metavar="NAME", help="of --source: the program that is the machine")
    parser.add_argument(
        "--vectors",
        type=Path,
        metavar="FOLDER",
        help="write test vectors of the machine there, for `conform`",
    )
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw the wiring there, as Mermaid")
    parser.add_argument("--model", type=Path, metavar="FILE", help="write the wiring as a TLA+ module there")
    parser.add_argument(
        "--tlc",
        nargs="?",
        const="",
        metavar="PART",
        help="TLC judges the blocks' contracts, and the wiring over them: runs with PART in their name",
    )
    parser.add_argument(
        "--trial",
        nargs="?",
        const="",
        metavar="PART",
        help="judge edits of the wiring whose name has PART in it",
    )
    parser.add_argument(
        "--killers",
        action="store_true",
        help="write killers.toml anew: for each property an edit that breaks it, and the scans",
    )
    parser.add_argument(
        "--evidence", action="store_true", help="judge the project's own as `verify` does, and write evidence"
    )
    add_options(parser, judge, about)
    parser.set_defaults(run=run)
    return parser


def machine_rests(place: Path, name: str) -> evidence.Rests:
    """What the verdicts on a machine of the project's own rest on. Raises Unjudged."""
    folder = place / "spec" / name
    tools: dict[str, Mapping[str, str | None]] = {**evidence.solvers()}
    modules: list[Path] = []
    if (folder / MODELS).exists():
        modules = sorted((place / "spec").glob("*/*.tla"))
        tools |= entries(find_toolchain())
    proofs = _rests_of_proofs(place, name)
    inputs = {**proofs.inputs, **evidence.hashes(place, modules)}
    return evidence.Rests(inputs, (*proofs.code, *MODELS_CODE), tools)


def _rests_of_proofs(place: Path, name: str) -> evidence.Rests:
    """What the proofs and the scans rest on; TLC's runs have more.

    Every document's devices are loaded, by a name that is put together.
    """
    files = [*(place / "spec" / name).glob("*.toml"), *(place / "spec").glob("*/interface.toml")]
    devices = (f"proofs.{document}.devices" for document in documents(place))
    code = (*CODE, *(module for module in devices if is_there(place, module)))
    home = place if is_there(place, CODE[-1]) else TREE
    own = [path for path in reached(home, *code[1:]) if path.is_relative_to(home / "refimpl")]
    inputs = {**evidence.hashes(place, files), **evidence.hashes(home, own)}
    return evidence.Rests(inputs, code, evidence.solvers())


def _rests_of_model(place: Path, task: Any) -> evidence.Rests:
    """What a run of TLC rests on: the text that was made for it, and the modules that are named there."""
    words = {word for text in task.files.values() for word in re.findall(r"\w+", text)}
    named = [path for path in (place / "spec").glob("*/*.tla") if path.stem in words]
    inputs = evidence.hashes(place, reached(place, *named)) if named else {}
    inputs |= {file: meaning_of(file, text.encode()) for file, text in task.files.items()}
    return evidence.Rests(inputs, MODELS_CODE, entries(find_toolchain()))


def judge_machine(place: Path, name: str, anew: bool = True) -> dict[str, Any]:
    """Judge a machine of the project's own and write its evidence; a wiring that is refused is UNJUDGED.

    anew: all of it; else the proofs, and each run of TLC, are taken from the evidence that is there, if what
    they rest on is the same. Raises Unjudged when the evidence cannot be written.
    """
    before = {} if anew else _before(place, name)
    evidence.discard(place, name, ID)
    started = time.time()
    folder = place / "spec" / name
    rests = machine_rests(place, name)  # of what is judged now
    result: dict[str, Any] = {}
    tools = rests.tools
    try:
        of_proofs = _rests_of_proofs(place, name).digest(place)
        if before.get("rests") == of_proofs:
            result = {key: value for key, value in before.items() if key not in ("models", "jar_pinned")}
        else:
            with needing_solvers():
                from machines.evidence import judged
            result = {"rests": of_proofs, "day": evidence.day(started), **judged(folder)}
        result["models"] = []
        if (folder / MODELS).exists():
            toolchain = find_toolchain()
            kept = {row["rests"]: row for row in before.get("models", ()) if row["as_expected"]}
            models = list(_models(place, folder, kept))
            tools = {**tools, **entries(toolchain, models[-1]["tlc"])}
            result |= {"models": models, "jar_pinned": toolchain.pinned}
        verdict, reason = verdict_on_machine(result)
        low, high = result["scan_ms"]
        strength = (
            f"of the composed steps, for any inputs, scans of {low} to {high} ms, from power-up, for ever"
        )
    except Unjudged as error:
        verdict, reason, strength = "UNJUDGED", error.message, ""
    record = evidence.make(
        kind="machine",
        id=ID,
        document=name,
        verdict=verdict,
        expected="PROVED",
        as_expected=verdict == "PROVED",
        strength=strength,
        command="modeproof machine --evidence",
        started=started,
        seconds=time.time() - started,
        inputs=rests.inputs,
        code=rests.code,
        place=place,
        tools=tools,
        result=result,
        reason=reason,
    )
    evidence.write(place, record)
    return record


def _before(place: Path, name: str) -> Mapping[str, Any]:
    """What was found of an earlier day, if it was as expected and nobody changed it since."""
    try:
        record = evidence.read(evidence.evidence_path(place, name, ID))
    except Unjudged:
        return {}
    result: Mapping[str, Any] = record["result"]
    return result if record["as_expected"] and evidence.is_sealed(record) else {}


def _models(place: Path, folder: Path, kept: Mapping[str, dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The runs of TLC: that each block keeps its contract, and the cell over them. Raises Unjudged."""
    with needing_solvers():
        from machines.tlc_runs import tasks
    for task in tasks(None, folder):
        rests = _rests_of_model(place, task).digest(place)
        if rests in kept:
            yield kept[rests]
            continue
        started = time.time()
        verdict, outcome = machine_tlc.judged(place, task, shipped=True)
        counts = outcome.log.counts
        yield {
            "run": task.id,
            "rests": rests,
            "day": evidence.day(started),
            "tlc": outcome.log.version,
            "verdict": verdict.verdict,
            "as_expected": verdict.as_expected,
            "judged": verdict.judged,
            "reason": verdict.reason,
            "checks": list(task.checks),
            "distinct": counts.distinct if counts else None,
            "generated": counts.generated if counts else None,
        }


def troubles_of_machine(place: Path, name: str) -> str:
    """What is wrong with it as far as is seen in a second: the reader, and that each property can fail."""
    try:
        with needing_solvers():
            from machines.evidence import looked_at
        return first_of(looked_at(place / "spec" / name))
    except Unjudged as error:
        return error.message


def _look(args: argparse.Namespace) -> None:
    """Raises Unjudged: two options of which one would have no effect."""
    given = {name for name, value in vars(args).items() if value is not None and value is not False}
    files = [name for name in FILES if name in given]
    works = [name for row in WORKS for name in row if name in given]
    two = "give them in two commands"
    for name in ("source", *JUDGED):
        if name in given and (others := [*works, *files]):
            what = "judges a program" if name == "source" else "is about verdicts"
            raise Unjudged(f"machine: --{name} {what}, and --{others[0]} does not judge that; {two}")
    if len([row for row in WORKS if given & {*row}]) > 1 or (files and {*works} - {*WORKS[0]}):
        first, *_, last = [*files, *works]
        raise Unjudged(f"machine: of --{first} and --{last} only one would be done; {two}")
    if args.equal and args.properties is not None:
        raise Unjudged("machine: --equal asks for equal outputs, not for properties; leave --properties out")


def run(args: argparse.Namespace) -> int:
    """Run it; the exit status is that of the verdicts. Raises Unjudged."""
    _look(args)
    others = [name for name in ("file", "properties", "use") if getattr(args, name) is not None]
    if others and (args.evidence or args.killers):
        raise Unjudged("machine: --evidence and --killers are about the project's own files; leave yours out")
    if args.evidence:
        with only_one(root()):
            records = [judge_machine(root(), name) for name in machines(root())]
        for record in records:
            print(machine_line(record))
            if not record["as_expected"]:
                print(f"NOT AS EXPECTED  {record['reason']}")
        return max(map(status_of, records), default=2)
    if not args.source and (args.unit is not None or args.equal):
        raise Unjudged("machine: --unit and --equal belong to --source")
    _can_read()
    if args.tlc is not None:
        return machine_tlc.run(args)
    others = [name for row in (FILES, *WORKS) for name in row if getattr(args, name) not in (None, False)]
    if not others:
        return carried_out(args).status
    with needing_solvers():
        from machines import machine_command
    return machine_command.run(args)


def judge(args: argparse.Namespace) -> Outcome:
    """Judge a wiring, print the verdicts, and return what was found. Raises Unjudged."""
    _look(args)
    _can_read()
    with needing_solvers():
        from machines import machine_command
    return machine_command.judge(args)


def about(args: argparse.Namespace) -> About:
    """What the arguments ask for."""
    words = ["modeproof", "machine", *([str(args.file)] if args.file else [])]
    for option in ("properties", "use"):
        if (path := getattr(args, option)) is not None:
            words += [f"--{option}", str(path)]
    if args.source:
        words += ["--source", *map(str, args.source)]
    if args.unit is not None:
        words += ["--unit", args.unit]
    words += [f"--{option}" for option in ("equal", "recheck") if getattr(args, option)]
    sources = args.source or [args.file or root() / "spec/machine_cell/wiring.toml"]
    return About(
        command="machine",
        subject=", ".join(map(shown_path, sources)),
        target="equal" if args.equal else shown_path(args.properties) if args.properties else "",
        again=shlex.join(words),
        files={
            "program": args.source or (),
            "wiring": [args.file],
            "properties": [args.properties],
            "use": [args.use],
        },
        part=args.unit or "",
    )


def _can_read() -> None:
    """Raises Unjudged where what reads a wiring is not installed."""
    try:
        import tree_sitter_iec61131_3_st  # noqa: F401
    except ImportError as error:
        raise Unjudged(f"a wiring cannot be read: {error}; {adding('', str(error.name))}") from None
