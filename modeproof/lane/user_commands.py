"""The commands of users as functions: the words of a command line give an outcome, and nothing is printed."""

from __future__ import annotations

from collections.abc import Sequence

from modeproof.kit.by_name import module_named
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.parser import Parser
from modeproof.output.options import found_by
from modeproof.output.outcome import Outcome, unjudged

MODULES = {
    "prove-program": "modeproof.lane.prove_program_command",
    "conform": "modeproof.suites.conform_command",
    "machine": "modeproof.lane.machine_command",
    "trace": "modeproof.trace.trace_command",
}


def outcome_of(words: Sequence[str]) -> Outcome:
    """Do what `modeproof WORDS` does, without printing: the outcome, whose record is written as there.

    `--record FILE` says where. What cannot be judged is an outcome with the word UNJUDGED, and its reason; so
    are words that the command refuses. Progress goes to standard error, if `--quiet` does not forbid it.
    Raises Unjudged where a record cannot be written, and KeyboardInterrupt.
    """
    parser = Parser(prog="modeproof")
    module_named(MODULES[words[0]]).add_parser(parser.add_subparsers(dest="command", required=True))
    try:
        args = parser.parse_args(list(words))
    except KitUnjudged as error:
        return unjudged(words[0], " ".join(words[1:]), "", " ".join(["modeproof", *words]), str(error))
    return found_by(args)
