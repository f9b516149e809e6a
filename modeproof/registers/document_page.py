"""The page of a document, docs/<document>.md: what was shown, what not, and every finding in a few lines.

Only the tables of its counterexamples come from evidence; each is between two marks with a digest of its
text and of the pins of its run. So the page must be what the registers give, around the tables that it holds.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.fitted import fitted
from modeproof.registers.citations import Sources
from modeproof.registers.demands import MODULE
from modeproof.registers.demands_page import demands_name, demands_pages
from modeproof.registers.files import markdown, read_text, read_toml
from modeproof.registers.findings_page import (
    CLASSES,
    counted,
    evidence_of,
    findings_name,
    findings_pages,
    run_of,
    sentence,
)
from modeproof.registers.killers import ways_to_fall
from modeproof.registers.profiles import PROFILES, differing, profile_of, rows_of, value_in
from modeproof.registers.responses import section
from modeproof.registers.rows import Document, Finding, Problem, Property, Telling
from modeproof.registers.runs import ASKING, Run
from modeproof.registers.stale import stale

_TABLE = re.compile(r"<!-- begin trace (\w+) (\w{12}) -->\n(.*?)<!-- end trace -->\n", re.DOTALL)


def page_name(document: str) -> str:
    """The path of a document's page."""
    return f"docs/{document}.md"


def picture_name(document: str) -> str:
    """The path of the chart of how its model grows."""
    return f"docs/{document}-growth.svg"


def tellings(document: Document) -> tuple[tuple[Finding, Telling], ...]:
    """The counterexamples that findings.toml marks as telling: safety first, then in its order."""
    ranked = sorted(document.findings, key=lambda finding: list(CLASSES).index(finding.severity))
    return tuple((finding, finding.telling) for finding in ranked if finding.telling)


# ------------------------------------------------------------------------------------------- the check


def check_document_page(document: Document, sources: Sources) -> list[Problem]:
    """Where a document's page differs from its registers; nothing when it has no page yet."""
    problems = [
        Problem(document.source("findings"), finding.id, f"telling: {telling.run} is no counterexample of it")
        for finding, telling in tellings(document)
        if run_of(document, telling.run) is None or telling.run not in finding.evidence
    ]
    name = page_name(document.name)
    if problems or not (document.root / name).is_file():
        return problems
    text = read_text(document.root, document.root / name)
    tables = tables_of(document, text)
    for _, telling in tellings(document):
        if tables.get(telling.run) is None:
            cause = f"the table of {telling.run} is missing, was changed by hand, or its run has changed"
            problems.append(Problem(name, "", stale(cause, document.name)))
    if not problems:
        pages = {name: page(document, sources, tables), **findings_pages(document), **demands_pages(document)}
        for name, expected in pages.items():
            there = (document.root / name).is_file()
            text = read_text(document.root, document.root / name) if there else ""
            if expected != text:
                line = _first_difference(expected, text)
                cause = f"line {line} is not what the registers give"
                problems.append(Problem(name, "", stale(cause, document.name)))
    return problems


def tables_of(document: Document, text: str) -> dict[str, str]:
    """The tables that a page holds, by their runs: those that are whole and of the runs as declared now."""
    found = {match[1]: (match[2], match[3]) for match in _TABLE.finditer(text)}
    return {run: table for run, (digest, table) in found.items() if digest == _digest(document, run, table)}


def _digest(document: Document, name: str, table: str) -> str:
    """What a table rests on: the pins of its run, and its own text."""
    run = run_of(document, name)
    pins = None if run is None else [run.property, run.trace_length, run.distinct]
    return hashlib.sha256(json.dumps([name, pins, table]).encode("utf-8")).hexdigest()[:12]


def _first_difference(expected: str, text: str) -> int:
    pairs = zip(expected.splitlines(), text.splitlines(), strict=False)
    same = next((n for n, (a, b) in enumerate(pairs) if a != b), None)
    return min(len(expected.splitlines()), len(text.splitlines())) if same is None else same + 1


# -------------------------------------------------------------------------------------------- the page


def page(document: Document, sources: Sources, tables: Mapping[str, str]) -> str:
    """The whole page; `tables` holds the table of each telling counterexample, by its run."""
    parts = [
        _head(document),
        _shown(document, sources),
        *_profiles(document),
        *section(document, sources),
        _limits(document),
        *_counterexamples(document, tables),
        _findings(document),
        *_faults(document),
        *_growth(document),
    ]
    return fitted("\n".join(parts))


def _head(document: Document) -> str:
    about, name = document.about, document.name
    number = "" if about.number == "unknown" else f" Number: {about.number}."
    targets = ", ".join(
        f"`{device.id}`" for device in document.interface.devices.values() if device.published
    )
    return f"""# {about.title}

<!-- made by modeproof render from spec/{name}: edit the registers there, not this page -->
**What it is.** {sentence(about.edition)}{number} Publisher: {about.publisher.removesuffix(".")}.

**What we had.** {sentence("; ".join(about.available))}

**What we did not have.** {sentence("; ".join(about.not_available) or "nothing is missing")}

{about.not_endorsed}

Read on: [registers and TLA+](../spec/{name}), [our program](../refimpl/{name}), [theorems](../proofs/{name}).
Targets for a program of your own, with [test vectors](../vectors/README.md): {targets or "none"}.
Traces, proofs and matrices are in the report: `make verify`, then `build/report/report.html`. Below,
`modeproof` is `.venv/bin/modeproof`.
"""


def _shown(document: Document, sources: Sources) -> str:
    name = document.name
    asking = [run for run in document.runs if run.kind in ASKING]
    holding = [run for run in asking if not run.readings]
    negatives = [run for run in document.runs if run.kind == "NEG"]
    graphs = str(sum(run.graph is not None for run in document.runs))
    witnesses = {witness for run in document.runs if run.kind == "WIT" for witness in run.witnesses}
    verify = f"`modeproof verify --document {name}`"
    kinds = Counter(clause.kind for clause in document.clauses)
    rows = [
        [
            "statements of the text: behaviour, requirements, assumptions, left out with a reason",
            f"{len(document.clauses)}: {kinds['behaviour']}, {kinds['property']}, {kinds['assumption']}, "
            f"{kinds['not modelled']}",
            f"`modeproof registers --matrix --document {name}`",
        ],
        [
            "properties that hold in every state and step, within the bounds of each run",
            f"{len(document.properties)} in {len(holding)} runs",
            f"`modeproof check --document {name} 'MC_*' 'OPEN_*' 'LIVE_*'`",
        ],
        [
            "counterexamples: another reading, a dropped assumption or a planted fault, tried on purpose",
            str(len(negatives)),
            f"`modeproof check --document {name} 'NEG_*'`",
        ],
        *_harmless(document.name, asking),
        _fallen(document, sources),
        [
            "situations that do occur, so the properties are not vacuous",
            str(len(witnesses)),
            f"`modeproof check --document {name} 'WIT_*'`",
        ],
        ["complete graphs of a device, compared with our program both ways", graphs, verify],
        [
            "theorems about our program for all words and times, by two solvers",
            str(sum(len(module.theorems) for module in sources.proofs)),
            f"`modeproof prove --document {name}`",
        ],
    ]
    lanes = [run.id for run in document.runs if not {"smoke", "full"} & set(run.lanes)]
    more = (
        f"\n{len(lanes)} of these runs are no part of `verify`: "
        f"`modeproof verify --document {name} --lane exhaustive`.\n"
        if lanes
        else ""
    )
    return (
        "## What was shown\n\n"
        f"The registers declare these results, with counts; {verify} fails if a run or a proof gives "
        "another one.\n\n" + markdown(["what", "how much", "command"], rows) + more
    )


def _harmless(document: str, asking: Sequence[Run]) -> Iterator[list[str]]:
    """The readings that break nothing, and the runs in which they are asked."""
    alone = [
        run for run in asking if len(run.readings) == 1 and not run.of and not run.module.endswith(MODULE)
    ]
    if alone:
        names = " ".join(run.id for run in alone)
        yield [
            "other readings that break no property, in every module and profile",
            f"{len(alone)} in {len(alone) + sum(bool(run.of) for run in asking)} runs",
            f"`modeproof check --document {document} {names} '*_with_*'`",
        ]


def _fallen(document: Document, sources: Sources) -> list[str]:
    kinds = Counter(falls.kind for falls in ways_to_fall(document, sources).values())
    much = f"{kinds['negative']} above, {kinds['edit']} with an edit of their own"
    if rest := kinds["by construction"]:
        much += f", {rest} by construction (`killers.toml` says why)"
    command = f"`modeproof mutate spec --killers --complete --document {document.name}`"
    return ["properties that fail after one edit of a device", much, command]


def _profiles(document: Document) -> Iterator[str]:
    """Each choice, what it is in either profile, and what happens otherwise."""
    rows = []
    if not differing(document.interface):
        return
    for signal, finding in rows_of(document):
        letter, cautious = (_value(value_in(signal, profile)) for profile in PROFILES)
        rows.append(
            [
                f"`{signal.name}`: {signal.why}",
                letter,
                cautious if cautious != letter else "the same",
                signal.because or sentence(finding.decision),
                f"{sentence(finding.consequence)} {evidence_of(document, finding)}",
            ]
        )
    of = [profile_of(document.root, run, document.interface) for run in document.runs]
    counts = ", ".join(f"{of.count(profile)} of the profile {profile}" for profile in PROFILES)
    only = ", ".join(
        f"`{row.id}` ({' and '.join(row.profiles) or 'neither: with another value alone'})"
        for row in document.properties
        if row.profiles != PROFILES
    )
    yield (
        "## The two profiles\n\n"
        "The document leaves a choice, or we would rather have something else. *Letter*, the default, is "
        "what the words\nsay, in their order, wherever that can work; *cautious* is what we recommend. "
        "Models, vectors and the kit\n(`--profile`) name the profile that they speak of; a theorem holds for "
        "every value, unless its sentence\nnames one.\n\n"
        f"Runs: {counts}. "
        + (
            f"Properties that do not hold in both: {only}.\n\n"
            if only
            else "Every property holds in both.\n\n"
        )
        + markdown(["choice", "letter", "cautious", "why", "what happens otherwise"], rows)
    )


def _value(value: Any) -> str:
    return f"`{str(value).upper()}`" if isinstance(value, bool) else f"`{value}`"


def _limits(document: Document) -> str:
    left_out = [clause for clause in document.clauses if clause.kind == "not modelled"]
    broken = [assumption for assumption in document.assumptions if assumption.breaks]
    lines = [
        "## What this does not show\n",
        "- Nothing about a program other than ours, and nothing about a misreading that specification and "
        "program share.",
        f"- {len(left_out)} of {len(document.clauses)} clauses are not modelled; each says why in "
        f"[clauses.toml](../{document.source('clauses')}).",
        f"- All of it rests on {len(document.assumptions)} assumptions, each with who must ensure it: "
        f"[assumptions.toml](../{document.source('assumptions')}). For {len(broken)} of them a run shows "
        "what happens otherwise.",
        "- What each verdict leaves open is in [limits](limits.md).",
    ]
    return "\n".join(lines) + "\n"


def _counterexamples(document: Document, tables: Mapping[str, str]) -> Iterator[str]:
    found = tellings(document)
    if not found:
        return
    yield (
        "## Counterexamples worth reading\n\n"
        "A scan is one cycle of a program: it reads inputs, decides, and sets outputs. Each row is one\n"
        "scan, or one step of somebody else, with what it read and what is there afterwards; **bold** is new."
        "\n"
        "`dt` is the time since the scan before, in ticks of the model.\n"
    )
    for finding, trace in found:
        run, table = run_of(document, trace.run), tables[trace.run]
        mark = f"trace {trace.run} {_digest(document, trace.run, table)}"
        assert run is not None
        falls = falls_of(document, run)
        requirement = (
            f"{sentence(falls.sentence)} (`{falls.id}`)" if falls is not None else f"`{run.property}`"
        )
        yield (
            f"### {finding.id}: {finding.title}\n\n"
            f"{sentence(trace.story)}\n\n"
            f"What fails: {requirement}\n\n"
            f"<!-- begin {mark} -->\n{table}<!-- end trace -->\n\n"
            f"`modeproof check {trace.run} --trace`{_tried(run)}\n"
        )


def _tried(run: Run) -> str:
    """Under which name the specification has the readings that a run tries."""
    names = ", ".join(f"`{name}`" for name in run.readings)
    return f" tries the reading {names}." if names else ""


def falls_of(document: Document, run: Run) -> Property | None:
    """The property that a run must violate. A property of the run's own module is preferred."""
    rows = [row for row in document.properties if run.property in (row.id, row.tla)]
    return min(
        rows,
        key=lambda row: (row.module != run.module, run.environment not in row.environments),
        default=None,
    )


def _findings(document: Document) -> str:
    page = Path(findings_name(document.name)).name
    demanded = ""
    if demands_pages(document):
        name = Path(demands_name(document.name)).name
        demanded = f"What the sentences demand of a program, and which demand nothing: [demands]({name}).\n\n"
    return (
        "## Demands and findings\n\n"
        f"{demanded}"
        "Where the text contradicts itself, is silent, or can be read in more than one way: "
        f"[{counted(document)}]({page}).\n"
    )


def _faults(document: Document) -> Iterator[str]:
    if not document.faults:
        return
    summary = document.faults_summary
    rows = []
    for fault in document.faults:
        falls = "; ".join(f"`{fall.property}`: {fall.needs}" for fall in fault.falls)
        rows.append(
            [
                fault.title,
                ", ".join(fault.detected_by) or "nothing",
                falls or (f"not modelled: {fault.not_modelled}" if fault.not_modelled else "nothing"),
                fault.not_detected,
            ]
        )
    more = f"[assumptions.toml](../{document.source('assumptions')}) and the report"
    yield (
        f"## Faults from outside\n\n{summary.strip()}\n\nWhat holds under each, and its runs: {more}.\n\n"
        + markdown(["fault", "detected by", "fails, and what that takes", "detected by nothing"], rows)
    )


def _growth(document: Document) -> Iterator[str]:
    data: dict[str, Any] = read_toml(document.root, document.folder / "runs.toml")
    if "series" not in data:
        return
    rows = []
    for series in data["series"]:
        points = [point for point in series["points"] if "distinct" in point]
        counts = ", ".join(f"{point['distinct']:,}" for point in points)
        missing = len(series["points"]) - len(points)
        rows.append(
            [
                f"{series['title']} (`{series['run']}`)",
                f"{series['points'][0]['x']} to {points[-1]['x']} {series['x']}",
                counts + (f"; {missing} not measured" if missing else ""),
                f"{points[0]['cpu_s']:g} to {points[-1]['cpu_s']:g}",
            ]
        )
    picture = Path(picture_name(document.name)).name
    source = f"[runs.toml](../{document.source('runs')})"
    yield (
        f"## How the model grows\n\n![distinct states and CPU seconds]({picture})\n\nMeasured on "
        f"{data['measured_on']}, one worker. All figures: {source}.\n\n"
        + markdown(["series", "varied", "distinct states", "CPU seconds"], rows)
    )
