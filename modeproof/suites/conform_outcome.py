"""What `conform` found about a program as an `Outcome`, of which all other forms are made."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.kit import again
from modeproof.kit.adapter import split_command
from modeproof.kit.diagnosis import step_there
from modeproof.kit.text import as_text, difference_lines, joint, verdict_word
from modeproof.kit.vectors import EXACT, MONITOR, Case, Suite
from modeproof.kit.verdict import UNJUDGED, Difference, Verdict
from modeproof.output.options import About, Clock
from modeproof.output.outcome import (
    Counterexample,
    Demand,
    File,
    Outcome,
    Problem,
    Rule,
    Scan,
    Spot,
    files,
    tools,
)
from modeproof.output.rules import rules_of

TRUSTED = ["the adapter: that it puts each input to the program and gives back its outputs", "the kit"]


def outcome_of(
    args: argparse.Namespace, suites: Sequence[Suite], verdicts: Sequence[Verdict], clock: Clock
) -> Outcome:
    """A run of the command. An interrupted run has fewer verdicts than suites."""
    (word, status), own = joint(verdicts), _own_files(args)
    rows = [one for verdict in verdicts for one in (verdict.page, verdict) if one is not None]
    said = [verdict_word(verdict) for verdict in rows]
    first = verdicts[0]
    pairs = list(zip(suites, verdicts, strict=False))
    return Outcome(
        command="conform",
        subject=args.name or first.adapter or _program(args),
        target=args.target,
        document=suites[0].document,
        word=word,
        status=status,  # type: ignore[arg-type]
        sentence="; ".join(said),
        strength=f"relation {args.relation}: so many scans as the suites have; nothing is said of others",
        demands=[
            _demand(args, suite, one, own, one in verdict.judged)
            for suite, verdict in pairs
            for one in (verdict.page, verdict)
            if one is not None
        ],
        files=[*own, *files("vectors", {str(suite.path): _hash(suite.path) for suite in suites})],
        tools=tools(),
        profile=first.profile,
        assumptions=[f"with {', '.join(args.param)}"] if args.param else [],
        trusted=TRUSTED,
        not_shown=list(dict.fromkeys(text for pair in pairs for text in _not_shown(*pair))),
        reason="; ".join(one.reason for row in verdicts for one in row.judged if one.word == UNJUDGED),
        text="\n".join(
            as_text(verdict, again.again(args, suite, verdict), suite, verdict is verdicts[-1])
            for suite, verdict in pairs
        ),
        again=args.about(args).again,
        started=clock.started,
        seconds=clock.seconds,
    )


def _program(args: argparse.Namespace) -> str:
    return str(args.adapter or args.s7 or args.builtin)


def _hash(path: Path) -> str:
    [row] = files("", [path])
    return row.sha256


def _own_files(args: argparse.Namespace) -> list[File]:
    """The files that the command of the adapter names, without the program that only starts them."""
    maps = [args.map] if args.map is not None else []
    return [*files("adapter", _adapter_files(args)), *files("map", maps)]


def _adapter_files(args: argparse.Namespace) -> list[Path]:
    words = split_command(args.adapter) if args.adapter else []
    return [Path(word) for word in words if Path(word).is_file() and word != sys.executable]


def _not_shown(suite: Suite, verdict: Verdict) -> list[str]:
    found = [f"{suite.name}: {text}" for text in (suite.says["does_not_show"],) if text]
    found += [f"output {name}: it was not observed" for name in verdict.unobserved]
    found += [f"output {name}: the document does not give its values" for name in verdict.not_compared]
    found += [f"{name}: it rests on outputs that are not compared" for name in verdict.unjudged]
    return found


def _demand(
    args: argparse.Namespace, suite: Suite, verdict: Verdict, own: Sequence[File], required: bool
) -> Demand:
    done, total = verdict.transitions
    says = suite.says
    problems = [_problem(suite, found[0], len(found), own, args.relation) for _, found in verdict.causes()]
    if verdict.word == UNJUDGED:
        sentence = f"The suite {suite.name} was run to its end."
        rule = Rule(id=suite.name, kind="target", sentence=sentence, source=suite.document)
        problems.append(Problem(rule=rule, message=verdict.reason, spot=_spot(own)))
    how = "scan by scan" if args.relation == EXACT else f"by the relation {args.relation}"
    sentence = (
        f"The program answers each case of the suite {suite.name} as the reference of {suite.target}, {how}."
    )
    text, by_page = says["guarantees"], verdict.relation == MONITOR
    if by_page:
        sentence = f"The program does in the suite {suite.name} what its document demands of {suite.target}."
        text = ", ".join(name for name, count in verdict.properties.items() if count)
    return Demand(
        id=f"{suite.name} by the page" if by_page else suite.name,
        word=verdict.word,
        sentence=sentence,
        text=text,
        required=required,
        strength=f"{verdict.cases:,} of {verdict.cases_total:,} cases passed, {verdict.scans:,} scans, "
        f"{done:,} of {total:,} transitions",
        problems=problems,
    )


def _problem(suite: Suite, found: Difference, count: int, own: Sequence[File], relation: str) -> Problem:
    """A difference that stands for all of its likely cause."""
    cited = rules_of([*found.clauses, *found.findings], suite.document)
    if found.broken:
        about = Rule(id=found.broken, kind="demand", sentence=found.says, source=suite.document)
    else:
        sentence = f"The step {found.step} of {suite.target} gives the outputs of the reference."
        about = Rule(
            id=f"{suite.target}.{found.step}", kind="target", sentence=sentence, source=suite.document
        )
    more = f"; {count - 1:,} more cases differ in the same way" if count > 1 else ""
    timed = f"; {found.time}" if found.time else ""
    timed += f"; reading: {found.reading}" if found.reading else ""
    return Problem(
        rule=about,
        others=cited,
        message=f"{found.in_a_line}{timed}{more}",
        spot=_spot(own),
        counterexample=Counterexample(
            scans=_scans(suite, found.shortest, found, relation),
            parameters=dict(found.shortest.params),
            wrong=list(found.expected),
            found_by=f"case {found.case.id} of {suite.name}: {_first(difference_lines(found, suite, False))}",
        ),
    )


def _first(lines: Sequence[str]) -> str:
    """Why the case is there."""
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("why:")), "")


def _scans(suite: Suite, case: Case, found: Difference, relation: str) -> list[Scan]:
    """The shortest scans. Of those before the last we know what the program gave where all was compared: the
    same as was expected.
    """
    rows = []
    last = len(case.scans) - 1
    for at, scan in enumerate(case.scans):
        expected: Mapping[str, Any] = scan.outputs
        given = dict(expected) if scan.compared and relation == EXACT else {}
        note = step_there(suite, case, at)
        if scan.request is not None:
            note, expected, given = f"a request that must be refused: {scan.request}", {}, {}
        if at == last:
            given = {
                name: found.got.get(name, value) for name, value in {**expected, **found.expected}.items()
            }
            expected = {**expected, **found.expected}
        rows.append(
            Scan(dt_ms=scan.dt_ms, inputs=dict(scan.inputs), given=given, expected=dict(expected), note=note)
        )
    return rows


def _spot(own: Sequence[File]) -> Spot | None:
    """The file of the program, as far as the command of the adapter names it; a line is never known."""
    return Spot(file=own[-1].path) if own else None


def about(args: argparse.Namespace) -> About:
    """What the arguments ask for."""
    words = ["modeproof", "conform", args.target, again.program_words(args)]
    words += [f"--document {args.document}"] if args.document else []
    words += [f"--vectors {again.quoted(str(args.vectors))}"] if args.vectors else []
    words += [f"--suite {name}" for name in args.suite or ()]
    usual = {"relation": EXACT, "latency": None, "hold": 0, "slow": 1, "profile": None, "case": None}
    usual |= {"scans": None}
    words += [f"--{name} {getattr(args, name)}" for name in usual if getattr(args, name) != usual[name]]
    words += [f"--param {again.quoted(text)}" for text in args.param]
    words += ["--codes"] * bool(args.codes) + ["--same"] * bool(args.same) + ["--flips"] * bool(args.flips)
    return About(
        command="conform",
        subject=args.name or _program(args),
        target=args.target,
        again=" ".join(words),
        files={"adapter": _adapter_files(args), "map": [args.map], "vectors": [args.vectors]},
        part=" ".join([*(args.suite or ()), args.relation, args.profile or ""]),
    )
