"""The command `modeproof renew`: after a change, makes anew what was made from the text before.

It works in a copy of the tree (modeproof.lane.staging), one document after another, and puts what it made
into the tree only when the specification has accepted the change: all of a document, or nothing.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_AS_EXPECTED, EXIT_NOT_AS_EXPECTED, EXIT_UNJUDGED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.lock import only_one
from modeproof.ground.meaning import meaning, reached
from modeproof.ground.places import add_document_option, chosen_documents, documents, machines, root
from modeproof.ground.progress import Progress
from modeproof.ground.reason import ask_reason, refuse_in_ci
from modeproof.ground.solvers import needing_solvers
from modeproof.lane.machine_command import judge_machine
from modeproof.lane.renewal import Refused, Renewal, conform, renew_document, stale_of
from modeproof.lane.staging import copied, finish
from modeproof.registers.load import load_document, load_interface
from modeproof.registers.machine_pins import check_machine_pins, repin_machine
from modeproof.registers.tables import check_pages, pages, render_blocks
from modeproof.registers.vector_files import ROOM, WIRED, changed, seal, unfit

Reason = Callable[[list[str]], str]
BLOCKS = "README.md and docs"


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0 renewed, 1 refused, 2 not judged."""
    parser = commands.add_parser(
        "renew",
        description="Makes anew what is stale: pins, edits that break properties, vectors, recorded stories, "
        "pages. First the specification judges the change: what it does not accept is not published. Exit "
        "status: 0 renewed or nothing to do, 1 refused and nothing written, 2 could not be judged.",
    )
    add_document_option(parser)
    parser.add_argument("--reason", metavar="TEXT", help="why pins move; kept beside them")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = root()
    names = chosen_documents(place, args.document)
    progress = Progress(quiet=args.quiet)
    with only_one(place):
        if finish(place):
            print("a renewal that was cut short while it put its files has been finished")
        work = [(name, _document) for name in names]
        work += [(name, _machine) for name in machines(place)]
        work += [(BLOCKS, _blocks)]
        status = [
            _carry_out(place, name, partial(make, name=name, reason=_reason(args), progress=progress))
            for name, make in work
        ]
    return EXIT_UNJUDGED if EXIT_UNJUDGED in status else max(status)


def _carry_out(place: Path, name: str, make: Callable[[Path], list[str]]) -> int:
    """Make one document anew in a copy, and put it; the exit status."""
    try:
        with copied(place) as copy:
            said = make(copy.tree)
            files = copy.put()
    except Refused as refused:
        print(f"{name}: REFUSED, and nothing of it was written\n{_indented(str(refused))}")
        return EXIT_NOT_AS_EXPECTED
    except Unjudged as error:
        print(f"{name}: UNJUDGED, and nothing of it was written: {error.message}", file=sys.stderr)
        return EXIT_UNJUDGED
    if not (said or files):
        print(f"{name}: nothing to do")
        return EXIT_AS_EXPECTED
    print(f"{name}: renewed, {len(files)} files")
    print(_indented("\n".join([*said, *files])))
    return EXIT_AS_EXPECTED


def _indented(text: str) -> str:
    return "\n".join(f"  {line}" for line in text.splitlines())


def _reason(args: argparse.Namespace) -> Reason:
    """Gives the reason for moving these pins, asked for once; without one it raises Refused."""

    def reason(moving: list[str]) -> str:
        try:
            refuse_in_ci()
            args.reason = ask_reason(args.reason)
        except Unjudged as error:
            raise Refused("\n".join(["these pins would move:", *moving, error.message])) from None
        return str(args.reason)

    return reason


def _document(tree: Path, name: str, reason: Reason, progress: Progress) -> list[str]:
    stale = stale_of(tree, name)
    if not stale:
        return []
    progress.say(f"{name}: of another text: {stale}")
    if stale.pins:
        reason(list(stale.pins))  # before the work, not after it
    work = Renewal(tree, name, reason, progress)
    renew_document(work, stale)
    return work.moved


# ---------------------------------------------------------------------------------------------- the machine


def _machine(tree: Path, name: str, reason: Reason, progress: Progress) -> list[str]:
    """A machine of the project's own: its vectors, the edits that break its properties, its pins."""
    with needing_solvers():
        from machines.evidence import looked_at
    folder = tree / "spec" / name
    moved_pins = [one.place for one in check_machine_pins(tree, name)]
    sources = changed(tree, name) if (tree / ROOM / name).is_dir() else []
    if not (moved_pins or sources or unfit(tree, name)):
        return []
    if moved_pins:
        reason(moved_pins)
    for document, target in _blocks_of(tree, sources):
        conform(Renewal(tree, document, reason, progress), target)
    said = _machine_vectors(tree, name, progress)
    if said or moved_pins or f"spec/{name}/{WIRED[0]}" in sources:
        progress.say(f"{name}: is every property of the machine still proved?")
        record = judge_machine(tree, name)
        if not record["as_expected"]:
            raise Refused(f"{record['verdict']}: {record['reason']}")
    elif troubles := looked_at(folder):
        raise Refused("\n".join(troubles))
    seal(tree, [name])
    return [*said, *(repin_machine(tree, name, reason(moved_pins)) if moved_pins else [])]


def _blocks_of(tree: Path, sources: Sequence[str]) -> list[tuple[str, str]]:
    """The document and the name of every target whose reference implementation needs one of these files."""
    names = {tree / name for name in sources if name.startswith("refimpl/")}
    found = []
    for document in documents(tree):
        for target in load_interface(tree, document).devices:
            file = tree / "refimpl" / document / f"{target}.py"
            if file.is_file() and names & {*reached(tree, file)}:
                found.append((document, target))
    return found


def _machine_vectors(tree: Path, name: str, progress: Progress) -> list[str]:
    """Write the suites that are others now; what is said of them."""
    folder, room = tree / "spec" / name, tree / ROOM / name
    said = []
    with tempfile.TemporaryDirectory(dir=tree) as place:
        with needing_solvers():
            from machines.vectors import write
        made = {
            path.name: text
            for path, text in write(Path(place), folder / WIRED[0], folder / WIRED[1], progress.say)
            if path.is_file()
        }
        for file in sorted({*made, *(path.name for path in room.glob("*.jsonl.gz"))}):
            old, new = room / file, Path(place) / file
            if not new.is_file():
                old.unlink()
            elif not old.is_file() or meaning(old) != meaning(new):
                write_whole(old, new.read_bytes())
            else:
                continue
            said.append(f"{name}: {file}: {made.get(file, 'no case is needed')}")
    return said


def _blocks(tree: Path, name: str, reason: Reason, progress: Progress) -> list[str]:
    """The rendered blocks of README.md and docs/."""
    loaded = [load_document(tree, name) for name in documents(tree)]
    if not check_pages(tree, loaded):
        return []
    for path in pages(tree):
        text = path.read_text(encoding="utf-8")
        new = render_blocks(text, loaded, path.relative_to(tree).as_posix())
        if new != text:
            write_whole(path, new.encode("utf-8"))
    return ["the tables that are made from the registers"]
