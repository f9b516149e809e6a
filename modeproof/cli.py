"""The command line: verify, check, prove, conform, trace, doctor.

Exit status 0: as expected; 1: not as expected; 2: could not be judged (and then one line says why).
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import importlib
import importlib.util
import json
import os
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

from modeproof.errors import EXIT_NOT_AS_EXPECTED, EXIT_UNJUDGED, Unjudged
from modeproof.places import add_document_option, build, chosen_documents, root

if TYPE_CHECKING:
    from modeproof.processes import Task
    from modeproof.progress import Progress
    from modeproof.verify import Stage

LANES = ("smoke", "full", "exhaustive")


def main(argv: list[str] | None = None) -> int:
    """Run one command and return its exit status. Expected errors end in one line on standard error and 2."""
    parser = make_parser()
    args = parser.parse_args(argv)
    previous = _stop_on_signals()
    try:
        place = root()
        if str(place) not in sys.path:
            sys.path.insert(0, str(place))
        run: Callable[[argparse.Namespace], int] = args.run
        return int(run(args))
    except Unjudged as error:
        if args.debug:
            raise
        _complain(error.message)
    except KeyboardInterrupt:
        _stop_tools()
        _complain("interrupted: no verdict; what was finished before is kept")
    except BrokenPipeError:
        # Whoever read our output has gone; Python would complain once more while flushing at exit.
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        if args.debug:
            raise
        _complain(f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}")
    except Exception as error:  # a defect of ours: still one line, and never a pass
        if args.debug:
            raise
        if type(error).__module__ == "modeproof.kit.errors":  # the kit has an Unjudged of its own
            _complain(" ".join(str(error).split()))
            return EXIT_UNJUDGED
        text = " ".join(str(error).split())[:300]
        _complain(f"internal error: {type(error).__name__}: {text} (--debug shows where)")
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
    return EXIT_UNJUDGED


def make_parser() -> argparse.ArgumentParser:
    """All commands and their options."""
    parser = argparse.ArgumentParser(
        prog="modeproof",
        description="Checks published safety procedures by TLA+ models and proofs. It certifies nothing.",
        epilog="exit status: 0 as expected, 1 not as expected, 2 could not be judged",
    )
    parser.add_argument("--debug", action="store_true", help="show where an error comes from")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    verify = _command(
        commands, "verify", _verify, "registers, TLC, conformance and proofs; ends with a summary"
    )
    verify.add_argument(
        "--lane", choices=LANES, default="full", help="smoke: under a minute; full: the default"
    )
    add_document_option(verify)

    check = _command(commands, "check", _check, "run TLC on declared runs and judge them")
    check.add_argument(
        "runs", nargs="*", metavar="RUN", help="id or pattern, such as MC_* (default: the full lane)"
    )
    check.add_argument("--lane", choices=LANES, help="only runs of this lane")
    check.add_argument("--document", metavar="NAME", help="only runs of this document")
    spread = check.add_argument_group("TLC's distributed mode (docs/distributed.md)")
    spread.add_argument("--distributed", action="store_true", help="a server and workers, over RMI")
    spread.add_argument(
        "--workers", type=int, metavar="N", help="worker processes on this machine (default: its cores)"
    )
    spread.add_argument(
        "--listen",
        metavar="ADDRESS[:PORT]",
        help="where workers of other machines reach the server (default: 127.0.0.1, any free port)",
    )
    spread.add_argument(
        "--wait-for", type=int, metavar="N", help="begin when N workers of other machines are there"
    )
    check.add_argument("--trace", action="store_true", help="show expected counterexamples too")
    check.add_argument("--all-variables", action="store_true", help="show every variable in every state")
    check.add_argument("--list", action="store_true", help="list the runs, run nothing")
    check.add_argument(
        "--repin", action="store_true", help="move the pins of these runs to what they give now"
    )
    check.add_argument("--reason", metavar="TEXT", help="why the pins move (with --repin)")
    check.add_argument(
        "--resume", action="store_true", help="keep runs whose evidence still fits, run only the others"
    )

    prove = _command(
        commands, "prove", _prove, "prove the theorems of a document with Z3, re-checked by cvc5"
    )
    prove.add_argument("theorems", nargs="*", metavar="THEOREM", help="name or pattern (default: all)")
    add_document_option(prove)
    prove.add_argument(
        "--limit", type=int, default=20_000, metavar="MS", help="time limit a query (default 20000)"
    )
    prove.add_argument(
        "--coverage", action="store_true", help="instead: what of each step the feasible paths pass through"
    )

    _plug_in(commands, "conform", "modeproof.suites.command", "modeproof.kit.command")
    _plug_in(commands, "vectors", "modeproof.suites.vectors_command")
    _plug_in(commands, "map", "modeproof.suites.map_command")
    _plug_in(commands, "trace", "modeproof.trace.command")
    _plug_in(commands, "registers", "modeproof.registers.command")
    _plug_in(commands, "render", "modeproof.render")
    _plug_in(commands, "walks", "modeproof.walks")
    _plug_in(commands, "report", "modeproof.report.command")
    _plug_in(commands, "mutate", "modeproof.strength.command")

    _command(commands, "doctor", _doctor, "tell what this machine lacks, and how to mend it")
    return parser


def _plug_in(commands: Any, name: str, *modules: str) -> None:
    """A command that another room brings along; the first module that exists.

    If its packages are missing, the command says so when it is called.
    """
    try:
        there = [module for module in modules if importlib.util.find_spec(module) is not None]
        importlib.import_module((there or modules)[0]).add_parser(commands)
    except ImportError as error:
        cause = str(error)

        def refuse(args: argparse.Namespace) -> int:
            raise Unjudged(f"{name} cannot be loaded: {cause}; `modeproof doctor` tells how to mend it")

        parser = commands.add_parser(name, help=f"cannot be loaded: {cause}")
        parser.add_argument("rest", nargs=argparse.REMAINDER)
        parser.set_defaults(run=refuse)


def _command(
    commands: Any, name: str, run: Callable[[argparse.Namespace], int], text: str
) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(
        name, help=text, description=text[0].upper() + text[1:] + "."
    )
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the result as JSON as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)
    return parser


def _complain(line: str) -> None:
    with contextlib.suppress(OSError):
        print(f"modeproof: {line}", file=sys.stderr, flush=True)


def _stop_tools() -> None:
    loaded = sys.modules.get("modeproof.tlc.children")
    if loaded is not None:
        loaded.stop_all()


def _stop_on_signals() -> dict[int, Any]:
    """Treat SIGTERM and SIGHUP like Ctrl-C, so that Java never outlives us."""

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        raise KeyboardInterrupt

    previous: dict[int, Any] = {}
    for number in (signal.SIGTERM, signal.SIGHUP):
        with contextlib.suppress(ValueError, AttributeError):  # not the main thread
            previous[number] = signal.signal(number, stop)
    return previous


def _write_json(args: argparse.Namespace, status: int, **content: Any) -> None:
    if args.json is None:
        return
    from modeproof.evidence.files import write_whole

    text = json.dumps({"command": args.command, "status": status, **content}, indent=1, ensure_ascii=False)
    write_whole(args.json, (text + "\n").encode("utf-8"))


# ------------------------------------------------------------------------------------------------ check


def _check(args: argparse.Namespace) -> int:
    from modeproof.lock import only_one
    from modeproof.progress import Progress
    from modeproof.tlc.check import check_all, register_problems, select
    from modeproof.tlc.repin import refuse_in_ci
    from modeproof.tlc.toolchain import find_toolchain
    from modeproof.verify import line_of

    place = root()
    if args.repin:
        refuse_in_ci()
        if not args.runs:
            raise Unjudged("--repin needs the runs by name")
    elif args.reason is not None:
        raise Unjudged("--reason belongs to --repin")
    if args.resume and args.repin:
        raise Unjudged("--resume keeps what is as expected, --repin makes anew: give one of them")
    lane = args.lane or (None if args.runs else "full")
    runs = select(place, args.runs, lane, args.document)
    if args.list:
        for run in runs:
            print(f"{run.name}  {run.expect}  {','.join(run.lanes)}  {run.environment}")
        return 0
    tools = find_toolchain()
    progress = Progress(quiet=args.quiet)
    spread = _spread(args, place, runs)
    with only_one(place):
        still = _resumed(args, place, runs, tools, progress)
        again = [run for run in runs if run.name not in still]
        done = list(still.values())
        if again:
            done += check_all(place, again, tools, progress, lambda one: progress.say(line_of(one)), spread)
        for one in done if not args.repin or args.trace else ():
            _show_trace(one, args)
        status: int = max(one.status for one in done)
        problems: list[str] = []
        for document in sorted({run.document for run in runs}):
            problems += [f"{document}: {problem}" for problem in register_problems(place, document)]
        for problem in problems:
            _complain(problem)
        if problems and not args.runs:
            status = max(status, EXIT_NOT_AS_EXPECTED)
        if args.repin:
            status = _repin(place, done, args.reason)
    if len(done) > 1 and not args.repin:
        good = sum(1 for one in done if one.status == 0)
        print(f"{good} of {len(done)} runs as expected")
    _write_json(args, status, runs=[one.record for one in done], problems=problems)
    return status


def _resumed(
    args: argparse.Namespace, place: Path, runs: Sequence[Any], tools: Any, progress: Any
) -> dict[str, Any]:
    """With --resume: the runs that are kept, by their names; each run is said, with why it is run again."""
    from modeproof.tlc.check import kept
    from modeproof.tlc.resume import why_again
    from modeproof.verify import line_of

    found: dict[str, Any] = {}
    for run in runs if args.resume else ():
        if reason := why_again(place, run, tools):
            progress.say(f"again {run.name}: {reason}")
        else:
            found[run.name] = kept(place, run)
            progress.say(line_of(found[run.name]))
    return found


def _spread(args: argparse.Namespace, place: Path, runs: Sequence[Any]) -> dict[str, Any]:
    """Which runs are checked in distributed mode, by their names, and where.

    Of a lane, those that this mode cannot judge are checked as usual, and that is said; a run that was named
    is refused. Raises Unjudged for that, and for options that do not fit.
    """
    from modeproof.tlc.check import read_cfg
    from modeproof.tlc.distributed import Where, refusal
    from modeproof.tlc.schedule import cores

    given = [name for name in ("workers", "listen", "wait_for") if getattr(args, name) is not None]
    if not args.distributed:
        if given:
            raise Unjudged(f"--{given[0].replace('_', '-')} belongs to --distributed")
        return {}
    if args.repin:
        raise Unjudged("pins are taken from local runs: --repin without --distributed")
    address, _, port = (args.listen or "127.0.0.1").partition(":")
    if not address or (port and not (port.isdigit() and 0 < int(port) < 65536)):
        raise Unjudged(f"--listen takes ADDRESS or ADDRESS:PORT, not {args.listen!r}")
    waited = args.wait_for or 0
    workers = cores() if args.workers is None else args.workers
    if workers < 0 or waited < 0 or workers + waited == 0:
        raise Unjudged("--workers and --wait-for are 0 or more, and together at least 1")
    where = Where(workers, address, int(port or 0), waited)
    found: dict[str, Any] = {}
    for run in runs:
        reason = refusal(run, read_cfg(place, run)[0])
        if reason and args.runs:
            raise Unjudged(f"{run.name} cannot be judged in distributed mode: {reason}")
        if reason:
            print(f"{run.name}: on this machine alone: {reason}")
        else:
            found[run.name] = where
    return found


def _show_trace(one: Any, args: argparse.Namespace) -> None:
    from modeproof.tlc.messages import essence, format_trace

    if one.outcome is not None and not one.judgement.judged:
        for _, text in one.outcome.log.errors[:4]:
            print("\n".join(f"    {line}" for line in essence(text)[:12]))
    if one.outcome is None or not one.outcome.log.trace:
        return
    if one.judgement.as_expected and not args.trace:
        return
    print(
        f"counterexample of {one.run.name}"
        + (f" ({one.judgement.violated})" if one.judgement.violated else "")
    )
    print(format_trace(one.outcome.log.trace, one.outcome.log.loop, args.all_variables))


def _repin(place: Path, done: list[Any], given: str | None) -> int:
    from modeproof.tlc.repin import Move, apply, ask_reason, cfg_diff, moves

    changes: dict[str, dict[str, tuple[Move, ...]]] = {}
    for one in done:
        moved = moves(place, one)
        print(f"{one.run.name}:" + ("" if moved else " pins stay as they are"))
        for move in moved:
            print(f"  {move}")
        if moved:
            print("  " + cfg_diff(place, one).replace("\n", "\n  "))
            changes.setdefault(one.run.document, {})[one.run.id] = moved
    if not changes:
        return 0
    reason = ask_reason(given)
    apply(place, changes, reason)
    count = sum(len(of_run) for of_run in changes.values())
    print(f"pins of {count} run{'s' if count != 1 else ''} moved; reason: {reason}")
    return 0


# ------------------------------------------------------------------------------------------------ prove


def _prove(args: argparse.Namespace) -> int:
    from modeproof.agreement import line as agreement_line
    from modeproof.lock import only_one
    from modeproof.progress import Progress
    from modeproof.report.proofs import never_needed
    from modeproof.report.verdicts import status_of
    from modeproof.summary import counted

    place = root()
    progress = Progress(quiet=args.quiet)
    chosen = chosen_documents(place, args.document)
    names = [name for name in chosen if args.document or _has_proofs(place, name)]
    if not names:
        raise Unjudged("no document has proofs (proofs/<document>/)")
    if args.coverage:
        return _coverage(args, place, names, progress)
    with only_one(place):
        records, troubles = prove_documents(place, names, progress, tuple(args.theorems), args.limit)
    if troubles and (not args.theorems or len(troubles) == len(names)):
        raise Unjudged("; ".join(troubles.values()))  # a name need not be one of every document
    status = max(status_of(record) for record in records)
    proofs = [record for record in records if record["kind"] == "proof"]
    for name in never_needed(proofs) if not args.theorems else ():
        print(f"no proof needs the premise: {name}")
    print(_work_line(proofs))
    print(counted("proofs", proofs, "PROVED by Z3, re-checked by cvc5"))
    if compared := [record for record in records if record["kind"] == "agreement"]:
        print("\n".join([agreement_line(compared), *compared[0]["result"]["problems"]]))
    _write_json(args, status, proofs=records)
    return status


def _work_line(records: Sequence[dict[str, Any]]) -> str:
    """What the processor did, so that the figure is the same on a busy machine; two theorems run at once."""
    parts = [query["work"] for record in records for query in record["result"]["queries"]]
    z3, cvc5, cores = (sum(float(part[n]) for part in parts) for n in range(3))
    whole = sum(float(record["result"]["work"]) for record in records)
    rest = whole - z3 - cvc5 - cores
    once = {record["document"]: float(record["result"]["shared"]) for record in records}
    shared = sum(once.values())
    return (
        f"{'processor':<12} exploring, once for all, {shared:.1f} s; "
        f"building and writing {rest:.1f} s, z3 {z3:.1f} s, cvc5 {cvc5:.1f} s, cores {cores:.1f} s"
    )


def _has_proofs(place: Path, document: str) -> bool:
    return (place / "proofs" / document / "__init__.py").is_file()


def prove_documents(
    place: Path,
    names: Sequence[str],
    progress: Any,
    patterns: tuple[str, ...] = (),
    limit_ms: int = 20_000,
    lane: str = "full",
    beside: Sequence[Task[dict[str, Any]]] = (),
    on_beside: Callable[[dict[str, Any]], None] = lambda record: None,
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """Prove the theorems of documents and write one piece of evidence for each, and for all theorems of one
    document together one on their agreement with the model checker. Those of all documents are one queue.

    The lane smoke leaves out the slow ones, and so does not compare. By document comes why nothing was
    proved: there is no theorem, or the proofs cannot be imported. `beside` are other tasks that go first in
    the queue, so that no core waits for the longest of them; `on_beside` gets each of their results.
    """
    from modeproof import agreement
    from modeproof.processes import in_processes, meanwhile

    whole = not patterns and lane != "smoke"
    troubles: dict[str, str] = {}
    theorems: dict[str, list[Any]] = {}
    inputs: dict[str, dict[str, str]] = {}
    for document in names:
        try:
            theorems[document], inputs[document] = _theorems_to_prove(place, document, patterns, lane)
        except Unjudged as error:
            troubles[document] = error.message

    def slow_first(documents: Iterable[str]) -> list[Task[dict[str, Any]]]:
        every = [(one.slow, document, one.name) for document in documents for one in theorems[document]]
        return [
            (prove_theorem, (place, document, name, inputs[document], limit_ms, shared[document]))
            for _, document, name in sorted(every, key=lambda one: not one[0])
        ]

    def done(record: dict[str, Any]) -> None:
        if record["kind"] != "proof":
            on_beside(record)
            return
        progress.say(
            f"{'ok ' if record['as_expected'] else 'NOT'} {record['document']}/{record['id']}: "
            f"{record['verdict']}; {record['seconds']:.1f} s"
            + (f"; {record['reason']}" if record["reason"] else "")
        )

    shared: dict[str, float] = {}
    records: list[dict[str, Any]] = []
    with contextlib.ExitStack() as stack:

        def prepare(document: str) -> None:
            shared[document] = stack.enter_context(_prepared(document)) if whole else 0.0

        *fewer, most = sorted(theorems, key=lambda name: len(theorems[name])) or [""]
        for document in fewer:
            prepare(document)
        if most:  # of all it takes longest to prepare; meanwhile the theorems of the others are proved
            first = slow_first(fewer) if whole else []
            records += meanwhile("proofs", first, functools.partial(prepare, most))
        for record in records:
            done(record)
        proved = {(record["document"], record["id"]) for record in records}
        tasks = [task for task in slow_first(theorems) if task[1][1:3] not in proved]
        made = in_processes("proofs", [*beside, *tasks], progress, done, knowing=whole)
        records += made[len(beside) :]
    for document in names:
        if whole and document not in troubles and _has_agreement(place, document):
            module = importlib.import_module(f"proofs.{document}.agreement")
            verdicts = {str(r["id"]): str(r["verdict"]) for r in records if r["document"] == document}
            records.append(agreement.compare(place, document, module, verdicts, inputs[document], _solvers()))
    return records, troubles


def _theorems_to_prove(
    place: Path, document: str, patterns: Sequence[str], lane: str
) -> tuple[list[Any], dict[str, str]]:
    """The theorems that are asked for, and the hashes of what they rest on. Raises Unjudged for none."""
    import fnmatch

    from modeproof import evidence

    theorems = [
        one
        for one in _theorems_of(document)
        if (not patterns or any(fnmatch.fnmatchcase(one.name, p) for p in patterns))
        and (patterns or lane != "smoke" or not one.slow)
    ]
    if not theorems:
        raise Unjudged(f"no theorem of {document} is called {' or '.join(patterns) or 'anything'}")
    sources = [*(place / "proofs").glob("*.py"), *(place / "proofs" / document).glob("*.py")]
    sources += [*(place / "proofs" / "explorer").glob("*.py")]
    sources += [*(place / "refimpl").glob("*.py"), *(place / "refimpl" / document).glob("*.py")]
    sources += [*(place / "spec" / document).glob("*.tla"), *(place / "spec" / document).glob("*.toml")]
    return theorems, evidence.hashes(place, sources)


@contextlib.contextmanager
def _prepared(document: str) -> Iterator[float]:
    """What the theorems of a document share is made on entering, where its proofs say how; the seconds of the
    processor for it.

    Where that fails nothing is shared, and every theorem that needs it says why it cannot be judged.
    """
    begun = time.process_time()
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(Exception):
            stack.enter_context(importlib.import_module(f"proofs.{document}.prepared").prepared())
        yield time.process_time() - begun


def _has_agreement(place: Path, document: str) -> bool:
    return (place / "proofs" / document / "agreement.py").is_file()


def _solvers() -> dict[str, dict[str, str | None]]:
    from modeproof import evidence

    packages = {"z3": "z3-solver", "cvc5": "cvc5"}
    return {tool: evidence.tool(_version(package)) for tool, package in packages.items()}


def _theorems_of(document: str) -> list[Any]:
    try:
        theorem = importlib.import_module("proofs.theorem")
        # libz3 refuses wrong sorts by itself; its Python layer would check every argument once more.
        vars(importlib.import_module("z3.z3"))["Z3_DEBUG"] = False
    except ImportError as error:
        raise Unjudged(f"proofs cannot be run: {error}") from None
    try:
        return list(theorem.theorems_of(document))
    except (theorem.TheoremError, ImportError) as error:
        raise Unjudged(f"proofs of {document}: {error}") from None


def prove_theorem(
    place: Path, document: str, name: str, inputs: dict[str, str], limit_ms: int, shared_s: float
) -> dict[str, Any]:
    """Prove one theorem and write its evidence; `inputs` are the hashes of what it rests on, shared_s the
    seconds of the processor for what was made for all theorems together.

    Raises Unjudged when the proofs cannot be imported or a file cannot be written.
    """
    from modeproof import evidence

    if str(place) not in sys.path:
        sys.path.insert(0, str(place))
    one = next(one for one in _theorems_of(document) if one.name == name)
    runner = importlib.import_module("proofs.runner")
    out = build(place) / "proofs" / document
    evidence.discard(place, document, name)
    started = time.time()
    try:
        (result,) = runner.prove_all([one], out, lambda line: None, limit_ms)
    except OSError as error:
        raise Unjudged(f"{out}: {error.strerror or error}") from None
    good = result.verdict == "PROVED"
    record = evidence.make(
        kind="proof",
        id=name,
        document=document,
        verdict=result.verdict,
        expected="PROVED",
        as_expected=good,
        strength=f"{len(result.queries)} queries, each asked of two solvers",
        command=f"modeproof prove --document {document} {name}",
        started=started,
        seconds=result.seconds,
        inputs=inputs,
        tools=_solvers(),
        result={
            "sentence": result.sentence,
            "remark": result.remark,
            "clauses": list(result.clauses),
            "findings": list(result.findings),
            "properties": list(one.properties),
            "premises": list(result.premises),
            "unused": list(result.unused),
            "work": round(result.work, 3),
            "shared": round(shared_s, 3),
            "queries": [
                {
                    "name": query.name,
                    "expected": query.expected,
                    "z3": query.z3,
                    "cvc5": query.cvc5,
                    "twin_of": query.twin_of,
                    "seconds": round(query.seconds, 3),
                    "detail": query.detail,
                    "core": None if query.core is None else list(query.core),
                    "work": [round(part, 3) for part in query.work],
                    "smt2": query.smt2.relative_to(place).as_posix(),
                }
                for query in result.queries
            ],
        },
        reason=result.reason if not good else "",
    )
    evidence.write(place, record)
    return record


def code_under_proof() -> Any:
    """What says of a document's code which of it is to be changed, and judges changed copies of it.

    Raises Unjudged when the proofs cannot be imported.
    """
    return _of_proofs("proofs.mutants.bench")


def copies_of_code() -> Any:
    """What makes a copy of a package of code with one definition changed. Raises Unjudged."""
    return _of_proofs("proofs.mutants.copies")


def observer_of_code() -> Any:
    """What proves that nobody can tell a changed copy by inputs and outputs. Raises Unjudged."""
    return _of_proofs("proofs.mutants.observed")


def _of_proofs(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Unjudged(f"proofs cannot be run: {error}") from None


def _coverage(args: argparse.Namespace, place: Path, names: Sequence[str], progress: Any) -> int:
    from modeproof.lock import only_one
    from modeproof.report.verdicts import status_of

    if args.theorems:
        raise Unjudged("--coverage speaks of devices, not of theorems: give it no name")
    with only_one(place):
        records = [cover_document(place, name, progress) for name in names]
    for record in records:
        print("\n".join(_coverage_lines(record)))
    status = max(status_of(record) for record in records)
    _write_json(args, status, coverage=records)
    return status


def cover_document(place: Path, document: str, progress: Any) -> dict[str, Any]:
    """What of each device's step its feasible paths pass through, beside the register of what they do not.

    EQUAL: nothing is passed over that the register does not explain, and it explains nothing else. Writes
    one piece of evidence. Raises Unjudged when the document has no devices or they cannot be explored.
    """
    from modeproof import evidence

    id = "coverage"
    evidence.discard(place, document, id)
    register = place / "proofs" / document / "unreached.toml"
    started = time.time()
    devices: dict[str, Any] = {}
    try:
        coverage = importlib.import_module("proofs.explorer.coverage")
        errors = importlib.import_module("proofs.explorer.errors")
        known = importlib.import_module(f"proofs.{document}.devices").DEVICES
    except ImportError as error:
        raise Unjudged(f"{document}: no devices to explore: {error}") from None
    for device in known:
        progress.say(f"{document}/{device.name}: every path from every control state")
        try:
            found = coverage.explained(device, register)
        except errors.ExplorationError as error:
            raise Unjudged(f"{document}/{device.name}: {' '.join(str(error).split())}") from None
        own = found.coverage
        devices[device.name] = {
            "states": own.states,
            "paths": own.paths,
            "lines": [len(own.passed_lines), len(own.lines)],
            "branches": [len(own.passed_branches), len(own.branches)],
            "answers": [len(own.passed_guards), len(own.guards)],
            "unreachable": [{"what": what, "why": why} for what, why in found.reasons],
            "unexplained": list(found.unexplained),
            "idle": list(found.idle),
        }
    problems = [
        f"{name}: {text}: {what}"
        for name, one in devices.items()
        for text, places in (
            ("on no feasible path, and not explained", one["unexplained"]),
            (f"{register.name} explains what is passed or not there", one["idle"]),
        )
        for what in places
    ]
    paths = [*(place / "proofs" / "explorer").glob("*.py"), register]
    paths += [*(place / "refimpl").glob("*.py"), *(place / "refimpl" / document).glob("*.py")]
    record = evidence.make(
        kind="coverage",
        id=id,
        document=document,
        verdict="DIFFERS" if problems else "EQUAL",
        expected="EQUAL",
        as_expected=not problems,
        strength="a member of every feasible path, run in the plain interpreter",
        command=f"modeproof prove --coverage --document {document}",
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, paths),
        tools={"z3": evidence.tool(_version("z3-solver"))},
        result={"devices": devices, "problems": problems},
        reason=problems[0] + (f" (and {len(problems) - 1} more)" if len(problems) > 1 else "")
        if problems
        else "",
    )
    evidence.write(place, record)
    return record


def _coverage_lines(record: dict[str, Any]) -> list[str]:
    """The coverage of a document for people: a table, what cannot be reached, and what is wrong."""
    devices = record["result"]["devices"]
    rows = [("device", "control states", "paths", "lines", "branches", "answers of guards by control state")]
    for name, one in devices.items():
        counts = [f"{one[key][0]} of {one[key][1]}" for key in ("lines", "branches", "answers")]
        rows.append((name, str(one["states"]), f"{one['paths']:,}", *counts))
    widths = [max(len(row[column]) for row in rows) for column in range(6)]
    lines = [f"== {record['document']}"]
    lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    lines.append("unreachable for every memory, input and parameter in range:")
    for name, one in devices.items():
        for why in dict.fromkeys(entry["why"] for entry in one["unreachable"]):
            lines += [f"  {name}  {entry['what']}" for entry in one["unreachable"] if entry["why"] == why]
            lines.append(f"      {why}")
    lines += record["result"]["problems"]
    count = sum(len(one["unreachable"]) for one in devices.values())
    words = "" if record["as_expected"] else f"; NOT: {len(record['result']['problems'])} problems"
    lines.append(
        f"coverage     {record['verdict']}; all but {count} unreachable places lie on a feasible path, "
        f"{record['seconds']:.1f} s{words}"
    )
    return lines


def _version(package: str) -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


# ------------------------------------------------------------------------------------------------ verify


def stages_of_verify() -> list[tuple[str, Stage]]:
    """The stages of `verify`, each with its title, in their order.

    The comparisons with the implementation go first in the queue of the theorems: the longest of them keeps
    one core for half a minute. Their stage tells what came of them; where the theorems could not be asked it
    makes them itself.
    """
    from modeproof.conformance import compare_reference, comparisons, say
    from modeproof.verify import check_lane, check_registers

    compared: list[tuple[list[dict[str, Any]], dict[str, str]]] = []

    def prove(
        place: Path, names: Sequence[str], lane: str, progress: Progress
    ) -> tuple[list[dict[str, Any]], dict[str, str]]:
        tasks, missing = comparisons(place, names, lane)
        found: list[dict[str, Any]] = []

        def take(record: dict[str, Any]) -> None:
            found.append(record)
            say(record, progress)

        result = prove_documents(place, names, progress, lane=lane, beside=tasks, on_beside=take)
        compared.append((found, missing))
        return result

    def compare(
        place: Path, names: Sequence[str], lane: str, progress: Progress
    ) -> tuple[list[dict[str, Any]], dict[str, str]]:
        return compared.pop() if compared else compare_reference(place, names, lane, progress)

    return [
        ("registers", check_registers),
        ("TLC", check_lane),
        ("proofs", prove),
        ("conformance", compare),
    ]


def _verify(args: argparse.Namespace) -> int:
    from modeproof import evidence
    from modeproof.lock import only_one
    from modeproof.progress import Progress
    from modeproof.verify import verify

    place = root()
    progress = Progress(quiet=args.quiet)
    names = chosen_documents(place, args.document)
    with only_one(place):
        status, records = verify(place, names, args.lane, stages_of_verify(), progress)
        for name in names:  # everything that was written can be read back
            evidence.read_document(place, name)
        if args.lane == "full" and args.document is None:
            from modeproof.report.command import made_by_verify
            from modeproof.walks import walk_evidence

            progress.say("-- walks of the counterexamples")
            try:
                walk_evidence(place, names, progress)
            except Unjudged as error:  # the report then shows variables, and says so
                progress.say(f"walks: UNJUDGED: {error.message}")
            for line in made_by_verify(place):
                progress.say(line)
    _write_json(args, status, records=records)
    return status


# ------------------------------------------------------------------------------------------------ doctor


def _doctor(args: argparse.Namespace) -> int:
    from modeproof.doctor import examine, report

    findings = examine(root())
    text, status = report(findings)
    print(text)
    if args.json is not None:
        rows = [dict(one.__dict__) for one in findings]
        try:
            args.json.write_text(
                json.dumps({"command": "doctor", "status": status, "findings": rows}, indent=1) + "\n"
            )
        except OSError as error:
            raise Unjudged(f"{args.json}: {error.strerror or error}") from None
    return status
