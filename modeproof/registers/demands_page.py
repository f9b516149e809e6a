"""What the sentences of a document demand, and which demand nothing: the check and the page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from modeproof.ground.errors import suggestion
from modeproof.ground.fitted import fitted
from modeproof.registers.demands import FILE, MODULE, REASONS, Demands, load_demand_rows
from modeproof.registers.rows import Clause, Document, Problem

DEMANDED = "demanded"
ASKING = ("behaviour", "property")
"""Kinds of clauses that a program can follow or break; others say what is taken for granted, or left out."""
SAID = {
    DEMANDED: "a demand cites it",
    "definition": "it says what a name, a type or a first value is",
    "drawing": "only a drawing could settle it",
    "open": "its words allow more than one behaviour; each was tried, or a finding says why not",
    "unseen": "nothing on the wires of the block shows it",
}


def demands_name(document: str) -> str:
    """The path of the page."""
    return f"docs/{document}-demands.md"


def standing_of(clause: Clause, demands: Demands) -> str:
    """Whether a clause is demanded, or why nothing is demanded of it; of another kind its kind; empty: nobody
    says.
    """
    if any(clause.id in row.clauses for row in demands.rows):
        return DEMANDED
    reason = dict(demands.undemanded.reasons()).get(clause.id, "")
    return reason or ("" if clause.kind in ASKING else clause.kind)


def check_demands(document: Document) -> Iterator[Problem]:
    """Where the register of demands leaves a clause over, names one twice, or one that is not there."""
    demands = load_demand_rows(document.root, document.name)
    if not demands.rows:
        return
    file = document.source(FILE)
    clauses = {clause.id for clause in document.clauses}
    findings = {finding.id for finding in document.findings}
    properties = {prop.id for prop in document.properties if not prop.module.endswith(MODULE)}
    for row in demands.rows:
        for id in row.clauses:
            if id not in clauses:
                yield Problem(file, row.id, f"unknown clause {id!r}; {suggestion(id, clauses)}")
    for device, steady in demands.constant.items():
        inputs = document.interface.devices[device].inputs if device in document.interface.devices else {}
        for name, said in steady.items():
            place = f"devices.{device}: constant: {name}"
            if name not in inputs:
                yield Problem(file, place, f"no such input; {suggestion(name, inputs)}")
            if not said or not clauses >= {*said}:
                yield Problem(
                    file, place, f"clauses {', '.join(said) or 'none'}: of the document one is needed"
                )
    for row in demands.rows:
        if row.id in properties:
            yield Problem(file, row.id, "is the id of a property, too; a demand is what the page says")
    reasons = Counter(id for id, _ in demands.undemanded.reasons())
    cited = {id for row in demands.rows for id in row.clauses}
    for id, count in reasons.items():
        if id not in clauses:
            yield Problem(file, "[undemanded]", f"unknown clause {id!r}; {suggestion(id, clauses)}")
        if count > 1:
            yield Problem(file, "[undemanded]", f"{id} has {count} reasons; one is enough")
        if id in cited:
            yield Problem(file, "[undemanded]", f"{id} is cited by a demand")
    for id, named in demands.undemanded.open.items():
        unknown = next((one for one in named if one not in findings), "")
        if unknown or not named:
            why = f"unknown finding {unknown!r}" if unknown else "which finding lists what it allows?"
            yield Problem(file, f"[undemanded.open] {id}", why)
    for clause in document.clauses:
        if not standing_of(clause, demands):
            yield Problem(file, clause.id, "no demand cites it, and [undemanded] does not say why not")


def demands_pages(document: Document) -> dict[str, str]:
    """The page by its path; none where the document has no register of demands."""
    demands = load_demand_rows(document.root, document.name)
    if not demands.rows:
        return {}
    counts = Counter(standing_of(clause, demands) for clause in document.clauses)
    told = ", ".join(f"{counts[name]} {name}" for name in (DEMANDED, *REASONS) if counts[name])
    aside = ", ".join(f"{count} {name}" for name, count in counts.items() if name not in SAID)
    made = f"made by modeproof render from spec/{document.name}: edit the registers there, not this page"
    lines = [
        f"# What this page demands: {document.about.title}",
        "",
        f"<!-- {made} -->",
        f"This page belongs to [what was shown]({document.name}.md). It is what a program is judged by first "
        "(`modeproof conform`, `modeproof prove-program`): what the sentences ask of a block seen from "
        "outside, in our words. No decision of ours is in it. What must come may take a scan more "
        "(`--latency`); times are met within a scan.",
        "",
        f"{len(document.clauses)} clauses: {told}; besides {aside or 'nothing'}. "
        f"{len(demands.rows)} demands.",
    ]
    for device, rows in demands.of.items():
        lines += ["", f"## `{device}`", ""]
        for id, why in demands.unproved.get(device, {}).items():
            lines += [f"{id} is proved in no lane: {why}.", ""]
        for name, cited in demands.constant[device].items():
            lines.append(
                f"- `{name}` is constant during a run ({', '.join(cited)}); `--flips` lets it change."
            )
        for row in rows:
            lines.append(f"- **{row.id}** ({', '.join(row.clauses)}): {row.says}")
    lines += ["", "## Clauses that demand nothing", ""]
    for name in REASONS:
        ids = [id for id, reason in demands.undemanded.reasons() if reason == name]
        if not ids:
            continue
        if name == "open":
            shown = [f"{id} ({', '.join(demands.undemanded.open[id])})" for id in ids]
        elif name == "unseen":
            shown = [f"{id} ({demands.undemanded.unseen[id]})" for id in ids]
        else:
            shown = ids
        lines.append(f"- *{name}*, {SAID[name]}: {', '.join(shown)}.")
    return {demands_name(document.name): fitted("\n".join(lines))}
