"""A verdict in words, as JSON, and as JUnit XML."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from typing import IO, Any
from xml.sax.saxutils import escape, quoteattr

from modeproof.kit.constants import changing, constant_inputs
from modeproof.kit.diagnosis import step_there, unseen
from modeproof.kit.errors import Unjudged, plain
from modeproof.kit.files import write_json as write_json
from modeproof.kit.files import write_text as write_text
from modeproof.kit.vectors import EXACT, MONITOR, Case, Suite
from modeproof.kit.verdict import (
    BREAKS,
    CONFORMS,
    DIFFERS,
    EXIT,
    FOLLOWS,
    PROTOCOL,
    UNJUDGED,
    Difference,
    Verdict,
)

LONGEST_LINE = 4000
"""Characters of a line that is printed."""
LONGEST_SHOWN = 40
MOST_CAUSES = 10
MOST_MISSED = 12


def joined(lines: Sequence[str]) -> str:
    """Lines to be printed; what others wrote in them is harmless, and makes no line of its own."""
    return "\n".join(plain(line, LONGEST_LINE) for line in lines)


def say(text: str, stream: IO[str] | None = None) -> None:
    """Print, with escapes for what the stream's code page does not have.

    Raises Unjudged where it cannot be written: a verdict that nobody can read is none.
    """
    stream = stream or sys.stdout
    coding = getattr(stream, "encoding", None) or "utf-8"
    try:
        print(text.encode(coding, "backslashreplace").decode(coding), file=stream, flush=True)
    except (OSError, ValueError) as error:
        raise Unjudged(f"the result cannot be printed: {error}") from None


def left(seconds: float, share: float) -> str:
    """How long the rest takes if `share` (0 to 1) took so many seconds; nothing while nobody can say."""
    if seconds < 2 or not 0.02 <= share < 1:
        return ""
    rest = seconds * (1 - share) / share
    return f", about {rest:.0f} s left" if rest < 100 else f", about {rest / 60:.0f} min left"


def as_text(verdict: Verdict, again: str = "", suite: Suite | None = None, last: bool = True) -> str:
    """What is printed at the end; `again` is the command that runs the shortest case again.

    With the suite, clauses and decisions are told in words. What holds for all suites of a run is said with
    the last one. What the document demands comes first, and the reference after it.
    """
    lines, page = [], ""
    if verdict.page is not None:
        page = as_text(verdict.page, again, suite, last) + "\n\n"
        again = "" if verdict.page.difference is not None else again
    causes = verdict.causes()
    if verdict.difference is not None:
        lines += difference_lines(verdict.difference, suite)
        if again:
            lines += ["", f"again:   {again}"]
        refused = {
            one.case.why.partition(": ")[2] or one.case.why
            for one in verdict.differences
            if one.step == PROTOCOL
        }
        if refused:
            lines += ["", "answered, though protocol 1 tells the adapter to refuse it:"]
            lines += [f"  {what}" for what in sorted(refused)]
        causes = [(cause, those) for cause, those in causes if cause[0] != PROTOCOL]
        if sum(len(those) for _, those in causes) > 1:
            lines += ["", f"{sum(len(those) for _, those in causes)} cases differ, by likely cause:"]
            for cause, found in causes[:MOST_CAUSES]:
                where, *outputs = cause
                lines.append(
                    f"  {len(found):>4}  {where}: {', '.join(outputs)}; first {found[0].case.id}, "
                    f"shortest {min(len(one.shortest.scans) for one in found)} scans"
                )
            if len(causes) > MOST_CAUSES:
                lines.append(f"  and {len(causes) - MOST_CAUSES} other causes")
        lines.append("")
    lines += _coverage(verdict, last)
    lines.append(f"{verdict_word(verdict)}: {verdict.reason}" if verdict.reason else verdict_word(verdict))
    if verdict.word == DIFFERS and not verdict.status:
        lines.append("the program follows the page all the same; --same asks for equality with the reference")
    return page + joined(lines)


def verdict_word(verdict: Verdict) -> str:
    """The word of the verdict, with relation and suite where it conforms, and what was left out."""
    return _word([verdict])


def together(verdicts: Sequence[Verdict]) -> str:
    """A line for several suites, by the page and by the reference; what is wrong counts for more."""
    pages = [verdict.page for verdict in verdicts if verdict.page is not None]
    return "\n".join(joined([_together(rows)]) for rows in (pages, verdicts) if rows)


def _together(verdicts: Sequence[Verdict]) -> str:
    word = joint_word(verdicts)
    if word in (CONFORMS, FOLLOWS):
        return _word(verdicts)
    return f"{word}: {', '.join(f'{verdict.suite} {verdict.word}' for verdict in verdicts)}"


def _word(verdicts: Sequence[Verdict]) -> str:
    """The word of verdicts that are alike, with all that was not judged."""
    first = verdicts[0]
    if first.word == BREAKS and first.difference is not None:
        clauses = ", ".join(first.difference.clauses)
        return f"{BREAKS} {first.difference.broken} ({clauses})" if clauses else first.word
    if first.word not in (CONFORMS, FOLLOWS):
        return first.word
    suites = " ".join(
        f"{verdict.only} of {verdict.suite}" if verdict.only else verdict.suite for verdict in verdicts
    )
    if first.word == FOLLOWS:
        known = {name for verdict in verdicts for name in (*verdict.properties, *verdict.unjudged)}
        scans = "scan" if first.latency == 1 else "scans"
        judged = known - {name for verdict in verdicts for name in verdict.unjudged}
        count = f"{len(known)}" if judged == known else f"{len(judged)} of {len(known)}"
        notes = [f"{count} demands, {suites}; within {first.latency} {scans}"]
        if first.constant:
            notes.append(f"{', '.join(first.constant)} constant, as the page has it")
    else:
        notes = [f"{first.relation}, {suites}"]
    if first.profile and first.word != FOLLOWS:
        notes.append(f"profile {first.profile}")
    hidden = {name: None for verdict in verdicts for name in verdict.unobserved}
    if hidden:
        have, all_ = first.outputs
        notes += [f"{have} of {all_} outputs compared", f"not observed: {', '.join(hidden)}"]
    if first.not_compared and first.word != FOLLOWS:
        notes.append(f"not compared: {', '.join(first.not_compared)}")
    if first.params:
        notes.append(f"with {', '.join(first.params)}")
    if first.relation != MONITOR and any(
        seen < all_ for seen, all_ in (verdict.transitions for verdict in verdicts)
    ):
        seen, all_ = (sum(counts) for counts in zip(*(one.transitions for one in verdicts), strict=True))
        notes.append(f"{seen:,} of {all_:,} transitions")
    if earlier := sum(verdict.earlier for verdict in verdicts):
        notes.append(f"resumed: {earlier:,} cases passed in an earlier run")
    return f"{first.word}({'; '.join(notes)})"


def joint_word(verdicts: Sequence[Verdict]) -> str:
    """The worst word of several."""
    words = {verdict.word for verdict in verdicts}
    return next(word for word in (UNJUDGED, BREAKS, DIFFERS, FOLLOWS, CONFORMS) if word in words)


def joint(verdicts: Sequence[Verdict]) -> tuple[str, int]:
    """The worst word of those that the exit status depends on, and that status."""
    words = [one.word for verdict in verdicts for one in verdict.judged]
    worst = next(word for word in (UNJUDGED, BREAKS, DIFFERS, FOLLOWS, CONFORMS) if word in words)
    return worst, EXIT[worst]


def _coverage(verdict: Verdict, last: bool) -> list[str]:
    seen, total = verdict.transitions
    rate = f", {verdict.scans / verdict.seconds:,.0f} scans a second" if verdict.seconds > 0.05 else ""
    steps = f", {seen:,} of {total:,} transitions" if total and verdict.relation != MONITOR else ""
    lines = [
        f"{verdict.target} {verdict.adapter}: {verdict.cases:,} of {verdict.cases_total:,} cases passed, "
        f"{verdict.scans:,} scans{steps}, {verdict.seconds:.1f} s{rate}"
    ]
    if verdict.word == CONFORMS and verdict.relation != MONITOR and total:
        for what, counts in (("steps", verdict.covered), ("clauses", verdict.clauses)):
            missed = [f"{name} {have}/{all_}" for name, (have, all_) in counts.items() if have < all_]
            if missed:
                more = f" and {len(missed) - MOST_MISSED} more" if len(missed) > MOST_MISSED else ""
                lines.append(f"{what} not covered in full: {', '.join(missed[:MOST_MISSED])}{more}")
            elif counts:
                whole = "as far as the outputs compared show it" if verdict.unobserved else "in full"
                lines.append(f"all {sum(1 for _, n in counts.values() if n)} {what} covered {whole}")
    if verdict.relation == MONITOR and verdict.word != UNJUDGED:
        put = ", ".join(f"{name} {count:,}" for name, count in verdict.properties.items() if count)
        never = [name for name, count in verdict.properties.items() if not count]
        if put:
            lines.append(f"demands, put in so many scans each (within {verdict.latency} scans): {put}")
        if never:
            lines.append("never in a scan for which they say something: " + ", ".join(never))
    if verdict.params and verdict.relation != EXACT:
        lines.append("waits are those of the suite: with these parameters a limit may lie between two scans")
    if verdict.unjudged:
        lines.append("rest on outputs that are not compared, so not judged: " + ", ".join(verdict.unjudged))
    if verdict.unobserved:
        lines.append("not observed, so not judged: " + ", ".join(verdict.unobserved))
    if verdict.not_compared and last and verdict.relation != MONITOR:
        names = ", ".join(verdict.not_compared)
        lines.append(
            f"not compared, for the document does not give the values (--codes does so by ours): {names}"
        )
    return lines


def difference_lines(found: Difference, suite: Suite | None = None, way: bool = True) -> list[str]:
    """One difference in words: where, what, by which clause and decision, and the shortest way there.

    Without `way` the last is left out: nothing was run again as yet.
    """
    clauses = ", ".join(found.clauses) or "none cited"
    lines = [
        f"case {found.case.id}, scan {found.scan} of {len(found.case.scans)}",
        f"why:     {_why(found, suite)}",
        f"step:    {found.step} (clauses: {clauses})",
    ]
    if found.time:
        lines.append(f"time:    {found.time}")
    elif suite is not None and (names := unseen(suite, found)):
        lines.append(f"before:  {', '.join(names)} (no output shows whether the program took them)")
    if found.broken:
        lines.append(f"breaks:  {found.broken}: {found.says}")
    elif found.when:
        lines.append(f"here it  {found.when}")
    if found.findings:
        lines.append(
            f"differs from the reference; the document leaves open here: {', '.join(found.findings)}"
        )
    elif not found.broken and found.clauses:
        lines.append("differs from the reference")
    if suite is not None and not found.broken:
        steady = ", ".join(changing(constant_inputs(suite), found.shortest.scans))
        lines += [f"here     {steady} changes, which the page calls constant"] * bool(steady)
    if found.reading:
        lines.append(f"reading: {found.reading}")
    if suite is not None:
        for id in (*found.clauses, *found.findings):
            if words := suite.text(id):
                lines.append(f"  {id:<12} {words}")
    lines += ["", f"{'output':<20} {'expected':<20} got"]
    for name, wanted in found.expected.items():
        lines.append(f"{name:<20} {json.dumps(wanted):<20} {json.dumps(found.got.get(name, found.got))}")
    return [*lines, "", *_way(found, suite)] if way else lines


def _why(found: Difference, suite: Suite | None) -> str:
    """Why a case exists; of a walk, which is there for all that it passes, what this scan is about."""
    scan = found.case.scans[found.scan - 1]
    if suite is None or scan.request is not None or not found.case.why.startswith("a walk through"):
        return found.case.why
    before = found.case.scans[found.scan - 2].inputs if found.scan > 1 else {}
    inputs = _changed(before, scan.inputs)
    after = f" after {scan.dt_ms:,} ms" if scan.dt_ms else ""
    return f"{step_there(suite, found.case, found.scan - 1)}, with {inputs}{after}"


def _changed(before: Mapping[str, Any], now: Mapping[str, Any]) -> str:
    changed = {name: value for name, value in now.items() if before.get(name, _NEW) != value}
    return ", ".join(f"{name}={json.dumps(value)}" for name, value in changed.items()) or "inputs as before"


def _way(found: Difference, suite: Suite | None) -> list[str]:
    case = found.shortest
    if found.confirmed:
        title = f"shortest way there ({len(case.scans)} scans, which show it; of the case {found.part}):"
    elif found.confirmed is None:
        title = f"the case up to there ({len(case.scans)} scans):"
    else:
        title = (
            f"the case up to there ({len(case.scans)} scans; run again it showed NO difference, so the "
            "program does not always do the same):"
        )
    lines = [title, f"  reset {json.dumps(dict(case.params))}"]
    before: Mapping[str, Any] = {}
    first = max(0, len(case.scans) - LONGEST_SHOWN)
    if first:
        lines.append(f"  ... {first} scans")
        before = case.scans[first - 1].inputs
    for n, scan in enumerate(case.scans[first:], first + 1):
        if scan.request is not None:
            text = scan.request if isinstance(scan.request, str) else json.dumps(scan.request)
            lines.append(f"  request {n}, to be refused: {text}")
            continue
        inputs = _changed(before, scan.inputs)
        there = "" if suite is None else step_there(suite, case, n - 1)
        there = f"  | {there}" if there else ""
        lines.append(f"  scan {n}: +{scan.dt_ms} ms, {inputs}{'' if scan.compared else ' (settling)'}{there}")
        before = scan.inputs
    return lines


_NEW = object()


def as_record(verdict: Verdict) -> dict[str, Any]:
    """The verdict for machines."""
    return {
        "verdict": verdict.word,
        "status": verdict.status,
        "target": verdict.target,
        "suite": verdict.suite,
        "relation": verdict.relation,
        "adapter": verdict.adapter,
        "cases": verdict.cases,
        "cases_total": verdict.cases_total,
        "only": verdict.only,
        "constant": list(verdict.constant),
        "profile": verdict.profile,
        "params": list(verdict.params),
        "cases_of_an_earlier_run": verdict.earlier,
        "scans": verdict.scans,
        "scans_compared": verdict.compared,
        "outputs_compared": list(verdict.outputs),
        "seconds": round(verdict.seconds, 3),
        "unobserved": list(verdict.unobserved),
        "not_compared": list(verdict.not_compared),
        "latency_scans": verdict.latency,
        "covered": {name: list(pair) for name, pair in verdict.covered.items()},
        "clauses": {name: list(pair) for name, pair in verdict.clauses.items()},
        "properties": dict(verdict.properties),
        "properties_unjudged": list(verdict.unjudged),
        "first_difference_s": None
        if verdict.first_difference_s is None
        else round(verdict.first_difference_s, 3),
        "reason": verdict.reason,
        "page": None if verdict.page is None else as_record(verdict.page),
        "difference": None if verdict.difference is None else _record(verdict.difference),
        "causes": [
            {"at": cause[0], "outputs": list(cause[1:]), "cases": [one.case.id for one in found]}
            for cause, found in verdict.causes()
        ],
    }


def _record(found: Difference) -> dict[str, Any]:
    return {
        "case": found.case.id,
        "why": found.case.why,
        "scan": found.scan,
        "step": found.step,
        "property": found.broken,
        "when": found.when,
        "clauses": list(found.clauses),
        "findings": list(found.findings),
        "basis": found.case.basis,
        "expected": dict(found.expected),
        "got": dict(found.got),
        "time": found.time,
        "reading": found.reading,
        "shortest": _scans(found.shortest),
        "shortest_scans_of_case": found.part,
        "shortest_confirmed": found.confirmed,
    }


def as_junit(verdicts: Sequence[Verdict]) -> str:
    """JUnit XML: a suite is a testsuite, a case a testcase, what could not be judged an error."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<testsuites>"]
    for verdict in (one for row in verdicts for one in row.judged):
        found = {difference.case.id: difference for difference in verdict.differences}
        errors = 1 if verdict.word == UNJUDGED else 0
        only = f" {verdict.only}" if verdict.only else ""
        name = quoteattr(plain(f"{verdict.target} {verdict.relation} {verdict.suite}{only}"))
        unseen = sum(1 for state in verdict.ids.values() if state == "not seen")
        lines.append(
            f'<testsuite name={name} tests="{len(verdict.ids) + errors}" failures="{len(found)}" '
            f'errors="{errors}" skipped="{unseen}" time="{verdict.seconds:.3f}">'
        )
        left_out = {"not compared": verdict.not_compared, "not observed": verdict.unobserved}
        lines += ["<properties>"] if any(left_out.values()) else []
        for what, names in left_out.items():
            if names:
                lines.append(f'<property name="{what}" value={quoteattr(", ".join(names))}/>')
        lines += ["</properties>"] if any(left_out.values()) else []
        for id, state in verdict.ids.items():
            case = f"<testcase classname={quoteattr(plain(verdict.target))} name={quoteattr(plain(id))}"
            if state == "not seen":
                lines += [case + ">", '<skipped message="no output that is observed shows it"/></testcase>']
                continue
            if id not in found:
                lines.append(case + "/>")
                continue
            message = quoteattr(plain(f"{found[id].broken or found[id].step}, scan {found[id].scan}"))
            text = escape(joined(difference_lines(found[id])))
            lines += [case + ">", f"<failure message={message}>{text}</failure>", "</testcase>"]
        if errors:
            message = quoteattr(plain(verdict.reason))
            lines += [f'<testcase classname={quoteattr(plain(verdict.target))} name="the run">']
            lines += [f"<error message={message}/>", "</testcase>"]
        lines.append("</testsuite>")
    return "\n".join([*lines, "</testsuites>", ""])


def _scans(case: Case) -> dict[str, Any]:
    scans = [
        {"dt_ms": scan.dt_ms, "in": scan.inputs, "out": scan.outputs}
        if scan.request is None
        else {"refuse": scan.request}
        for scan in case.scans
    ]
    return {"id": case.id, "params": dict(case.params), "scans": scans}
