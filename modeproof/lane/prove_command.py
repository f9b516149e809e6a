"""The command `modeproof prove`: the theorems of documents in one queue, each with its evidence."""

from __future__ import annotations

import argparse
import contextlib
import fnmatch
import functools
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.lock import only_one
from modeproof.ground.options import add_command, write_json
from modeproof.ground.places import add_document_option, chosen_documents, root
from modeproof.ground.processes import Task, in_processes, meanwhile
from modeproof.ground.progress import Progress
from modeproof.kit.by_name import module_named
from modeproof.lane import agreement
from modeproof.lane.agreement import line as agreement_line
from modeproof.lane.coverage import cover_documents
from modeproof.lane.keep import NOTHING, Keep
from modeproof.lane.summary import counted
from modeproof.lane.theorem import prove_theorem, rests_of, theorems_of
from modeproof.report.verdicts import never_needed, status_of


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns the worst status of the theorems and raises Unjudged."""
    parser = add_command(commands, "prove", run)
    parser.add_argument("theorems", nargs="*", metavar="THEOREM", help="name or pattern (default: all)")
    add_document_option(parser)
    parser.add_argument(
        "--limit", type=int, default=20_000, metavar="MS", help="time limit a query (default 20000)"
    )
    parser.add_argument(
        "--coverage", action="store_true", help="instead: what of each step the feasible paths pass through"
    )


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = root()
    progress = Progress(quiet=args.quiet)
    chosen = chosen_documents(place, args.document)
    names = [name for name in chosen if args.document or _has_proofs(place, name)]
    if not names:
        raise Unjudged("no document has proofs (proofs/<document>/)")
    if args.coverage:
        return cover_documents(args, place, names, progress)
    theorems = [theorem.name for name in names if args.theorems for theorem in theorems_of(name)]
    for pattern in args.theorems:  # a name need not be one of every document
        if not fnmatch.filter(theorems, pattern):
            raise Unjudged(f"no theorem is called {pattern!r}; {suggestion(pattern, theorems)}")
    with only_one(place):
        records, troubles = prove_documents(place, names, progress, tuple(args.theorems), args.limit)
    if troubles and not args.theorems:
        raise Unjudged("; ".join(troubles.values()))
    status = max(status_of(record) for record in records)
    proofs = [record for record in records if record["kind"] == "proof"]
    for name in never_needed(proofs) if not args.theorems else ():
        print(f"no proof needs the premise: {name}")
    print(_work_line(proofs))
    print(counted("proofs", proofs, "PROVED by Z3, re-checked by cvc5"))
    if compared := [record for record in records if record["kind"] == "agreement"]:
        print("\n".join([agreement_line(compared), *compared[0]["result"]["problems"]]))
    write_json(args, status, proofs=records)
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
    keep: Keep = NOTHING,
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """Prove the theorems of documents and write one piece of evidence for each, and for all theorems of one
    document together one on their agreement with the model checker. Those of all documents are one queue.

    The lane smoke leaves out the slow ones, and so does not compare. By document comes why nothing was
    proved: there is no theorem, or the proofs cannot be imported. `beside` are other tasks that go first in
    the queue, so that no core waits for the longest of them; `on_beside` gets each of their results. What
    `keep` keeps is not proved again.
    """
    whole = not patterns and lane != "smoke"
    tools = evidence.solvers()  # hashed before the processes are copies of this one
    troubles: dict[str, str] = {}
    theorems: dict[str, list[Any]] = {}
    rests: dict[tuple[str, str], evidence.Rests] = {}
    of_module: dict[str, evidence.Rests] = {}
    records: list[dict[str, Any]] = []
    for document in names:
        try:
            every = _theorems_to_prove(document, patterns, lane)
            again = theorems[document] = []
            for theorem in every:
                key = document, theorem.name
                module = theorem.build.__module__
                if module not in of_module:
                    of_module[module] = rests_of(place, document, module)
                rests[key] = of_module[module]
                kept = keep.record(place, *key, rests[key])
                if kept is None:
                    again.append(theorem)
                else:
                    records.append(kept)
        except Unjudged as error:
            troubles[document] = error.message
    keep.say(progress)

    def slow_first(documents: Iterable[str]) -> list[Task[dict[str, Any]]]:
        every = [
            (theorem.slow, document, theorem.name) for document in documents for theorem in theorems[document]
        ]
        return [
            (prove_theorem, (place, document, name, rests[document, name], limit_ms, shared[document]))
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
    with contextlib.ExitStack() as stack:

        def prepare(document: str) -> None:
            needed = whole and theorems[document]
            shared[document] = stack.enter_context(_prepared(document)) if needed else 0.0

        *fewer, most = sorted(theorems, key=lambda name: len(theorems[name])) or [""]
        for document in fewer:
            prepare(document)
        if most:  # of all it takes longest to prepare; meanwhile the theorems of the others are proved
            first = slow_first(fewer) if whole else []
            soon = meanwhile("proofs", first, functools.partial(prepare, most))
            records += soon
            for record in soon:
                done(record)
        proved = {(record["document"], record["id"]) for record in records}
        tasks = [task for task in slow_first(theorems) if task[1][1:3] not in proved]
        made = in_processes("proofs", [*beside, *tasks], progress, done, fork=whole)
        records += made[len(beside) :]
    for document in names:
        if whole and document not in troubles and _has_agreement(place, document):
            module = module_named(f"proofs.{document}.agreement")
            verdicts = {str(r["id"]): str(r["verdict"]) for r in records if r["document"] == document}
            records.append(agreement.compare(place, document, module, verdicts, tools))
    return records, troubles


def _theorems_to_prove(document: str, patterns: Sequence[str], lane: str) -> list[Any]:
    """The theorems that are asked for. Raises Unjudged for none."""
    theorems = [
        theorem
        for theorem in theorems_of(document)
        if (not patterns or any(fnmatch.fnmatchcase(theorem.name, p) for p in patterns))
        and (patterns or lane != "smoke" or not theorem.slow)
    ]
    if not theorems:
        raise Unjudged(f"no theorem of {document} is called {' or '.join(patterns) or 'anything'}")
    return theorems


@contextlib.contextmanager
def _prepared(document: str) -> Iterator[float]:
    """What the theorems of a document share is made on entering, where its proofs say how; the seconds of the
    processor for it.

    Where that fails nothing is shared, and every theorem that needs it says why it cannot be judged.
    """
    begun = time.process_time()
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(Exception):
            stack.enter_context(module_named(f"proofs.{document}.prepared").prepared())
        yield time.process_time() - begun


def _has_agreement(place: Path, document: str) -> bool:
    return (place / "proofs" / document / "agreement.py").is_file()
