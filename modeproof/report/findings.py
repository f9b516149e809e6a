"""The page of a finding, the index of all findings, and the table of deviations: rendered from registers and
evidence.

Every page ends with a stamp (`modeproof.registers.stamps`), by which drift is found without running anything.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

from modeproof.registers.cfg import Constant
from modeproof.registers.citations import Sources, ids_of
from modeproof.registers.replay import Traces
from modeproof.registers.rows import Document, Finding, Property
from modeproof.registers.runs import Run
from modeproof.registers.stamps import has_page, index_name, page_name, pins, stamped, table_name
from modeproof.registers.switches import restored
from modeproof.report.cells import Cells
from modeproof.report.scan_table import Comparison, compare, markdown, scan_table, who

COMMAND = ".venv/bin/modeproof"
WORDING = "wording"
LITTLE = 40
"""A sentence of fewer characters does not say by itself what was decided."""
MANY = 3
"""More readings than this are counted in a heading, not listed."""


@dataclass(frozen=True)
class Material:
    """All that pages are made from: the registers of one document, its evidence by id, the walks of its
    counterexamples, and what each run's cfg gives to the constants.
    """

    document: Document
    sources: Sources
    traces: Traces | None
    evidence: Mapping[str, Mapping[str, Any]]
    walks: Mapping[str, Mapping[str, Any]]
    constants: Mapping[str, Mapping[str, Constant]]

    @property
    def index(self) -> str:
        """The path of the index."""
        return index_name(self.document.name)

    @property
    def table(self) -> str:
        """The path of the table of deviations."""
        return table_name(self.document.name)

    def page(self, finding: Finding) -> str:
        """The path of a finding's page."""
        return page_name(self.document.name, finding)

    def run(self, name: str) -> Run | None:
        """A declared run."""
        return next((run for run in self.document.runs if run.id == name), None)

    def readings(self, run: Run) -> tuple[str, ...]:
        """The readings that a run restores, in alphabetical order."""
        if self.traces is None:
            return ()
        return tuple(sorted(restored(self.constants[run.id], self.traces.literal)))

    def chosen(self, run: Run) -> tuple[str, ...]:
        """The parameters that a run's cfg sets to another text than their default, each with its value."""
        given = self.constants[run.id]
        return tuple(
            f"{name} = {given[name].text.strip(chr(34))}"
            for device in self.document.interface.devices.values()
            for name, signal in device.parameters.items()
            if signal.type == "text" and name in given and given[name].text != f'"{signal.default}"'
        )

    def as_decided(self, run: Run) -> bool:
        """Another run must hold at the very bounds and in the environment of this one."""
        return any(
            other.kind == "MC"
            and (other.module, other.environment) == (run.module, run.environment)
            and self.constants[other.id] == self.constants[run.id]
            for other in self.document.runs
            if other.id in self.constants
        )

    def falls(self, run: Run) -> Property | None:
        """The property that a run must violate; the row of the run's module comes first where there are
        several.
        """
        rows = [one for one in self.document.properties if run.property in (one.id, one.tla)]
        rows.sort(key=lambda one: (one.module != run.module, run.environment not in one.environments))
        return rows[0] if rows else None


def render(material: Material) -> dict[str, str]:
    """All pages by their path: one for each finding that has evidence, the index, and the table of
    deviations.
    """
    known = pins(material.document)
    pages = {
        material.page(one): stamped(material.document, one, _page(material, one), known)
        for one in material.document.findings
        if has_page(one)
    }
    pages[material.index] = stamped(material.document, None, _index(material))
    pages[material.table] = stamped(material.document, None, _deviations(material))
    return pages


def _link(page: str, target: str) -> str:
    """A relative link from one page to another place of the repository."""
    return PurePosixPath(os.path.relpath(target, PurePosixPath(page).parent)).as_posix()


def _sentence(text: str) -> str:
    text = text.strip()
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


# ------------------------------------------------------------------------------------------------ one finding


def _page(material: Material, finding: Finding) -> str:
    here = material.page(finding)
    clauses = {clause.id: clause for clause in material.document.clauses}
    lines = [
        f"# {finding.id}: {finding.title}",
        "",
        f"Class: **{finding.severity}**. [All findings]({_link(here, material.index)}), "
        f"[what each deviation does]({_link(here, material.table)}).",
        "",
        "## What the text says",
        "",
        _sentence(finding.says),
        "",
    ]
    lines += [f"- `{name}` {clauses[name].title}" for name in finding.clauses]
    lines += ["", "It can be read as:", ""]
    lines += [f"{n}. {one}" for n, one in enumerate(finding.readings, 1)]
    lines += ["", _drawing(finding), "", "## What we decided", "", _sentence(finding.decision), ""]
    lines += ["## Why it matters on a machine", "", _sentence(finding.consequence), ""]
    runs = [run for name in finding.evidence if (run := material.run(name)) is not None]
    for run in runs:
        if material.evidence[run.id]["result"].get("trace") or material.readings(run):
            lines += _run_section(material, run)
    lines += _checked_section(material, [run for run in runs if not material.readings(run)])
    theorems = [name for name in finding.evidence if material.run(name) is None]
    lines += _theorem_section(material, [name for name in theorems if name not in clauses])
    return "\n".join(lines).rstrip() + "\n"


def _drawing(finding: Finding) -> str:
    if finding.drawing_could_settle:
        return (
            "The drawings themselves were not available to us. A drawing could settle which reading is "
            "meant, so this "
            "is no error of the document; below is what follows where a program is written from its text."
        )
    return "No drawing could settle this: it concerns what the text itself says, or leaves out."


def _bounds(material: Material, run: Run) -> str:
    """The bounds of a run; where they are those of another run, what these are."""
    text = run.strength or "as in its cfg"
    named = next((one for one in material.document.runs if one.id in text.split() and one.strength), None)
    return f"{text} ({named.strength})" if named is not None else text


def _steps(record: Mapping[str, Any]) -> int:
    return int(record["result"]["trace_length"]) - 1


def _cause(material: Material, run: Run, readings: Sequence[str], broken: Sequence[str]) -> str:
    """What a run changes, in a few words."""
    if len(readings) > MANY:
        return f"{len(readings)} readings restored at once"
    if readings:
        return f"`{'`, `'.join(readings)}` restored"
    if broken:
        return f"Without {', '.join(broken)}"
    if chosen := material.chosen(run):
        return f"With {', '.join(chosen)}"
    return "As decided" if material.as_decided(run) else "With a fault"


def _nothing_restored(material: Material, run: Run) -> str:
    """What a run is that restores no reading and breaks no assumption."""
    if material.chosen(run):
        return "This run restores no reading; it sets a parameter to another value than its default."
    if material.as_decided(run):
        return (
            "This run restores no reading: the decided behaviour does not have this property, and here is "
            "what that means."
        )
    return f"This run restores no reading; in its environment, {run.environment}, devices or words fail."


def _in_steps(record: Mapping[str, Any]) -> str:
    """How long a counterexample is, in words."""
    steps = _steps(record)
    return "in the first state" if steps == 0 else "in 1 step" if steps == 1 else f"in {steps} steps"


def _run_section(material: Material, run: Run) -> list[str]:
    record = material.evidence[run.id]
    if not record["result"].get("trace"):
        return _holds_section(material, run, record)
    falls = material.falls(run)
    readings = material.readings(run)
    broken = [one for one in material.document.assumptions if run.id in one.breaks]
    cause = _cause(material, run, readings, [one.id for one in broken])
    lines = [f"## {cause}: `{run.property}` falls {_in_steps(record)}", ""]
    if falls is not None:
        lines += [f"The property: {_sentence(falls.sentence)}", f"Otherwise: {_sentence(falls.hazard)}", ""]
    if len(readings) > MANY:
        lines += [f"Restored at once: {', '.join(f'`{one}`' for one in readings)}.", ""]
    if broken:
        named = "; ".join(f"{one.id}, {one.title}" for one in broken)
        lines += [f"It lets go of what the decided behaviour rests on: {named}.", ""]
    elif not readings:
        lines += [_nothing_restored(material, run), ""]
    lines += [
        f"Verdict: {_verdict(record)}. Environment: {run.environment}; bounds: {_bounds(material, run)}. "
        + ("" if record["result"].get("loop") else "No shorter counterexample exists within them."),
        "",
        "```",
        f"{COMMAND} check {run.id} --trace",
        "```",
        "",
    ]
    walk = material.walks.get(run.id)
    if walk is None or material.traces is None:
        return lines
    return [*lines, *_tables(material, run, record, walk, material.traces)]


def _tables(
    material: Material, run: Run, record: Mapping[str, Any], walk: Mapping[str, Any], traces: Traces
) -> list[str]:
    cells = Cells(material.document.interface, traces, walk["tables"])
    names = traces.tops[run.module].columns
    table = scan_table(walk, names, traces, cells)
    lines = [
        "A row is what stands after one step, and what the step read; **bold** is what has changed since "
        "the row before."
        + (" A word is in hex, with what it means in its own range; 0 is 0000." if traces.words else ""),
        "",
        table.text,
    ]
    if table.constant:
        lines += [f"The same in every row: {table.constant}.", ""]
    loop = str(record["result"].get("loop") or "")
    if loop.startswith("back to state"):
        lines += [f"From here on steps {int(loop.split()[-1])} to {table.steps} repeat for ever.", ""]
    elif loop:
        lines += ["From here on nothing happens any more.", ""]
        if after := walk.get("after"):
            steps = ", ".join(f"`{one}`" for one in after)
            lines += [f"With no reading restored, this same state goes on with {steps}.", ""]
    if any(row["wires"].get("dt") for row in walk["rows"]):
        lines += [_ticks(material, run), ""]
    lines += _comparisons(material, run, walk, traces, cells)
    lines += _legend(material, walk, traces)
    return lines


def _ticks(material: Material, run: Run) -> str:
    """The times of the run's model, in its ticks."""
    given = material.constants[run.id]
    names = {
        name.removesuffix("_ms"): signal.why
        for device in material.document.interface.devices.values()
        for name, signal in device.parameters.items()
        if signal.type == "ms"
    }
    times = [f"{name} = {given[name].text}" for name in names if name in given]
    return f"`dt` is the time since the scan before, in ticks; here {', '.join(times)}."


def _comparisons(
    material: Material, run: Run, walk: Mapping[str, Any], traces: Traces, cells: Cells
) -> Iterator[str]:
    if not material.readings(run):
        yield "No device differs from the decided behaviour here, so there is nothing to put beside it."
        yield ""
        return
    names = traces.tops[run.module].columns
    found = [
        compare(walk, device, names, traces, cells)
        for device in material.document.interface.devices
        if device in walk["decided"]
    ]
    parted = [one for one in found if one.begins is not None]
    yield "### The decided behaviour on the same inputs"
    yield ""
    if not parted:
        yield _nothing_parts(material, run, [traces.devices[one.device].short for one in found], traces)
        yield ""
    for one in parted:
        yield _introduction(one, traces.devices[one.device].short)
        yield ""
        yield one.text


def _nothing_parts(material: Material, run: Run, replayed: Sequence[str], traces: Traces) -> str:
    """Where no scan of a replayed device differs: what the reading changes then."""
    text = (
        f"On what they read here, {', '.join(replayed)} with no reading restored do the same in every scan."
    )
    others = [
        traces.devices[name].short
        for name in material.document.interface.devices
        if name in traces.devices and name not in traces.tops[run.module].inputs
    ]
    if others:
        text += f" Not replayed here: {', '.join(others)}, whose steps the trace shows."
    return text + " What the reading changes is which steps there are."


def _introduction(one: Comparison, short: str) -> str:
    text = (
        f"In step {one.begins} (marked ▶) the {short} with no reading restored does otherwise, with the "
        "same memory and "
        "the same inputs; bold is what differs. From there on it goes by its own memory, on the inputs "
        "that were "
        "recorded: by TLC, on the specification, the other devices as above."
    )
    if one.others:
        before = " and ".join(f"in step {at} (`{step}`)" for at, step in one.others)
        text += f" Before that it would have done otherwise {before}."
    return text


def _legend(material: Material, walk: Mapping[str, Any], traces: Traces) -> list[str]:
    """Which clauses the executed steps carry out, from the comments of the specification."""
    ids = ids_of(material.document)
    comments = {
        definition.name: definition.comment
        for module in material.sources.modules.values()
        for definition in module.definitions
    }
    lines = []
    seen = dict.fromkeys((row["step"], who(traces, row)) for row in walk["rows"] if row["step"])
    for step, actor in seen:
        clauses, findings, _ = ids.read(comments.get(step, ""))
        cited = ", ".join((*clauses, *findings))
        lines.append(f"- `{step}` ({actor})" + (f": {cited}" if cited else ""))
    return ["<details><summary>The clauses behind each step</summary>", "", *lines, "", "</details>", ""]


def _verdict(record: Mapping[str, Any]) -> str:
    """The word for a verdict; only evidence that is as expected gets here."""
    return "VIOLATED, as expected" if record["verdict"] == "VIOLATED" else str(record["verdict"])


def _holds_section(material: Material, run: Run, record: Mapping[str, Any]) -> list[str]:
    """A reading that was restored and broke nothing; or many, and all that still happens."""
    readings = material.readings(run)
    if record["verdict"] == "REACHED":
        reached = ", ".join(f"`{one}`" for one in record["result"]["reached"])
        return [
            f"## {_cause(material, run, readings, [])}: what still happens",
            "",
            *(
                [f"Restored: {', '.join(f'`{one}`' for one in readings)}.", ""]
                if len(readings) > MANY
                else []
            ),
            f"Of all that was asked for, this and no more is reached: {reached}. Environment: "
            f"{run.environment}; bounds: {_bounds(material, run)}.",
            "",
            "```",
            f"{COMMAND} check {run.id}",
            "```",
            "",
        ]
    return [
        f"## `{'`, `'.join(material.readings(run))}` restored: nothing falls",
        "",
        "Restored alone within these bounds, the reading is harmless: every property of the run still holds. "
        f"Verdict: {_verdict(record)}, {record['result']['distinct']:,} distinct states. Environment: "
        f"{run.environment}; "
        f"bounds: {_bounds(material, run)}. Properties: {', '.join(f'`{one}`' for one in run.properties)}.",
        "",
        "```",
        f"{COMMAND} check {run.id}",
        "```",
        "",
    ]


def _checked_section(material: Material, runs: Sequence[Run]) -> list[str]:
    """Runs that restore nothing and break nothing: the decided behaviour, or another choice that is left
    open.
    """
    runs = [run for run in runs if not material.evidence[run.id]["result"].get("trace")]
    if not runs:
        return []
    lines = ["## What was checked", ""]
    for run in runs:
        record = material.evidence[run.id]
        lines.append(
            f"- `{run.id}`: {_verdict(record)}, {record['result']['distinct']:,} distinct states; "
            "environment "
            f"{run.environment}; {_bounds(material, run)}."
        )
    return [*lines, "", "```", f"{COMMAND} check {' '.join(run.id for run in runs)}", "```", ""]


def _theorem_section(material: Material, names: Sequence[str]) -> list[str]:
    if not names:
        return []
    lines = ["## What is proved", ""]
    for name in names:
        record = material.evidence[name]
        lines.append(f"- {record['verdict']}: {_sentence(record['result']['sentence'])} `{name}`")
    return [*lines, "", "```", f"{COMMAND} prove {names[0]}", "```", ""]


# -------------------------------------------------------------------------------------------------- the index


def _index(material: Material) -> str:
    findings = material.document.findings
    count = {
        kind: sum(1 for one in findings if one.severity == kind)
        for kind in ("safety", "availability", WORDING)
    }
    shown = sum(1 for one in findings if has_page(one))
    open_ones = sum(1 for one in findings if one.severity != WORDING and not one.evidence)
    lines = [
        f"# Findings: {material.document.about.title}",
        "",
        "Where the text contradicts itself or is silent, how it can be read, and what "
        f"was decided. {len(findings)} findings: {count['safety']} of class safety, "
        f"{count['availability']} availability, "
        f"{count[WORDING]} wording. {shown} have a page with evidence"
        + (
            f"; for {open_ones} of class safety or availability the last column says why no model shows them."
            if open_ones
            else "."
        ),
        "",
        f"[What each deviation does]({_link(material.index, material.table)}) puts them side by "
        "side: restored alone, which property falls, in "
        "how many steps. The whole text of every finding, with all its readings, is in "
        f"[findings.toml]({_link(material.index, material.document.source('findings'))}).",
        "",
        "*Drawing*: the drawings were not available to us; where one could settle a finding, it is no "
        "error of the "
        "document. Rendered by `modeproof findings --render`.",
        "",
    ]
    rows = []
    for one in findings:
        name = f"[{one.id}]({_link(material.index, material.page(one))})" if has_page(one) else one.id
        rows.append(
            [
                name,
                one.title,
                one.severity,
                "yes" if one.drawing_could_settle else "no",
                _short(one.decision),
                "<br>".join(f"`{switch}`" for switch in one.switches),
                _summary(material, one),
            ]
        )
    heads = ["finding", "what it is about", "class", "drawing", "decided", "switch", "shown by"]
    return "\n".join(lines) + "\n" + markdown(heads, rows)


def _short(text: str) -> str:
    """The first sentence, and the next ones while that says little."""
    end = text.find(". ")
    while 0 <= end < LITTLE:
        end = text.find(". ", end + 1)
    return text if end < 0 else text[: end + 1]


def _summary(material: Material, finding: Finding) -> str:
    parts = []
    theorems = 0
    for name in finding.evidence:
        record = material.evidence.get(name)
        if record is None:
            continue
        if record["kind"] == "proof":
            theorems += 1
        elif record["result"].get("trace"):
            parts.append(f"{_verdict(record)}: `{record['result']['property']}` falls {_in_steps(record)}")
        else:
            parts.append(f"{record['verdict']}: `{name}`")
    if theorems:
        parts.append(f"PROVED: {theorems} theorem{'s' if theorems > 1 else ''}")
    return "<br>".join(parts) if parts else finding.evidence_open


# --------------------------------------------------------------------------------------------- the deviations


def _deviations(material: Material) -> str:
    single, several, without = _deviating_runs(material)
    lines = [
        "# What each deviation does",
        "",
        "The decided behaviour deviates from a literal reading of the text in the places below. Each run "
        "restores one of "
        "these readings alone in the one good model, at its bounds, and must break the property named "
        "here; *steps* is the "
        "length of the shortest counterexample, counted in scans of whatever device (and what the user "
        "does). A reading "
        "that breaks nothing is reported as harmless, with the run that shows it. The traces are on the "
        "pages of the "
        f"[findings]({_link(material.table, material.index)}). Seconds are those of one run on the "
        "machine that rendered this page.",
        "",
        "## One reading restored",
        "",
        markdown(_HEADS, [_deviation(material, run) for run in single]),
        f"{len(single)} runs, {sum(1 for run in single if run.kind == 'NEG')} of which break a property.",
        "",
    ]
    if without:
        lines += [
            "## No reading restored: an assumption let go, or a fault",
            "",
            markdown(_HEADS, [_deviation(material, run) for run in without]),
            "",
        ]
    if several:
        lines += [
            "## Several readings restored at once",
            "",
            markdown(_HEADS, [_deviation(material, run) for run in several]),
            "",
            *_all_at_once(material, several[-1]),
        ]
    return "\n".join(lines).rstrip() + "\n"


def _all_at_once(material: Material, run: Run) -> list[str]:
    """What comes of the run with the most readings, in the words of the findings that name it."""
    if len(material.readings(run)) <= MANY:
        return []
    lines = ["## All of them: does the printed procedure work at all?", ""]
    for one in _findings_of(material, run):
        lines += [
            f"[{one.id}]({_link(material.table, material.page(one))}), {one.title}. "
            f"{_sentence(one.consequence)}",
            "",
        ]
    return lines


_HEADS = ["restored", "finding", "verdict", "what falls", "steps", "seconds", "environment", "run"]


def _deviating_runs(material: Material) -> tuple[list[Run], list[Run], list[Run]]:
    """Runs with one reading restored, with several (the most last), and negatives with none."""
    single, several, without = [], [], []
    for run in material.document.runs:
        if run.id not in material.evidence:
            continue
        count = len(material.readings(run))
        if count == 1:
            single.append(run)
        elif count > 1:
            several.append(run)
        elif record_has_trace(material, run):
            without.append(run)
    order = {one.id: n for n, one in enumerate(material.document.findings)}

    def place(run: Run) -> tuple[int, str]:
        return min((order[one.id] for one in _findings_of(material, run)), default=len(order)), run.id

    return (
        sorted(single, key=place),
        sorted(several, key=lambda run: len(material.readings(run))),
        sorted(without, key=place),
    )


def record_has_trace(material: Material, run: Run) -> bool:
    """Whether the evidence of a run holds a counterexample."""
    return bool(material.evidence[run.id]["result"].get("trace"))


def _findings_of(material: Material, run: Run) -> list[Finding]:
    return [one for one in material.document.findings if run.id in one.evidence]


def _deviation(material: Material, run: Run) -> list[str]:
    record = material.evidence[run.id]
    readings = material.readings(run)
    result = record["result"]
    links = "<br>".join(
        (f"[{one.id}]({_link(material.table, material.page(one))})" if has_page(one) else one.id)
        + f" {one.title}"
        for one in _findings_of(material, run)
    )
    broken = ", ".join(one.id for one in material.document.assumptions if run.id in one.breaks)
    restored_text = (
        f"{len(readings)} readings" if len(readings) > MANY else "<br>".join(f"`{one}`" for one in readings)
    )
    if record["result"].get("trace"):
        falls = f"`{run.property}`"
    elif record["verdict"] == "REACHED":
        falls = f"only these happen: {', '.join(result['reached'])}"
    else:
        falls = "nothing: harmless within the bounds" if len(readings) == 1 else "nothing"
    return [
        restored_text or (f"none; without {broken}" if broken else "none; a fault"),
        links or broken,
        _verdict(record),
        falls,
        str(_steps(record)) if result.get("trace") else "",
        f"{record['seconds']:.1f}",
        run.environment,
        f"`{run.id}`" + (f"<br>{run.strength}" if len(readings) > 1 and run.strength else ""),
    ]
