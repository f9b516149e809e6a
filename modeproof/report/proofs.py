"""The page of proofs, from evidence: every theorem as one sentence, with what it cites and rests on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from modeproof.registers.proofs_page import stamped_proofs, theorems_by_file
from modeproof.registers.rows import Document

Record = Mapping[str, Any]

INTRODUCTION = """# What is proved of the shipped code

Each row is a theorem about the very Python in `refimpl/{document}/`, run path by path on symbolic
values, or about the tables. PROVED means: z3 found no counterexample among all values named, and cvc5, which
reads the exported file alone, found none either. A *claim* is one such question; its *twin* shows that its
premises can be met; an *example* must be found, mostly one that shows that a planted fault or the
printed text is noticed.

```
.venv/bin/modeproof prove --document {document}               # all of it; one theorem by its name
.venv/bin/modeproof prove --document {document} --coverage    # what of each step the paths pass through
.venv/bin/modeproof prove --document {document} --render      # this page, from the evidence of these two
```

Every question is a file, `build/proofs/{document}/<theorem>/*.smt2`, with theorem, clauses and expected
answer at its top. What the proofs do not show is in [limits](../limits.md).
"""


def render_proofs(document: Document, evidence: Mapping[str, Record]) -> str:
    """The page of a document, stamped. `evidence`: by the name of the theorem, and `coverage`."""
    lines = [INTRODUCTION.format(document=document.name), *_section(document, evidence)]
    return stamped_proofs(document, "\n".join(lines))


def _section(document: Document, records: Mapping[str, Record]) -> Iterator[str]:
    theorems = theorems_by_file(document)
    own = [records[one.name] for rows in theorems.values() for one in rows]
    yield f"## {document.about.title}"
    yield ""
    versions = own[0]["tools"]
    asked = f"z3 {versions['z3']['version']} and cvc5 {versions['cvc5']['version']}"
    queries = [query for record in own for query in record["result"]["queries"]]
    yield (
        f"{len(own)} theorems, {len(queries):,} questions to each of {asked}: {_counts(queries)}. "
        "Seconds are those of one theorem with both solvers, and of its cores; two run at once."
    )
    for file, rows in theorems.items():
        yield ""
        yield f"### `{file}`"
        yield ""
        yield "| theorem | cites | strength | questions | seconds |"
        yield "|---|---|---|---|---|"
        for one in rows:
            record = records[one.name]
            cited = ", ".join([*record["result"]["clauses"], *record["result"]["findings"]])
            named = ", ".join(record["result"].get("properties", ()))
            result = f"{record['verdict']}{f'; proves {named}' if named else ''}"
            sentence = record["result"]["sentence"].replace("|", "\\|")
            yield (
                f"| {sentence} `{one.name}` | {cited} | {result} | "
                f"{_counts(record['result']['queries'])} | {record['seconds']:,.1f} |"
            )
    total = sum(float(record["seconds"]) for record in own)
    shared = max(float(record["result"]["shared"]) for record in own)
    yield ""
    yield "| all theorems | seconds |"
    yield "|---|---|"
    yield f"| {len(own)} | {total:,.1f} |"
    yield f"| exploring the devices, once for all of them | {shared:,.1f} |"
    if "agreement" in records:
        yield from _agreement(records["agreement"])
    yield from _premises(own)
    yield from _coverage(records["coverage"])


def _counts(queries: Sequence[Mapping[str, Any]]) -> str:
    claims = sum(1 for query in queries if query["expected"] == "unsat")
    twins = sum(1 for query in queries if query["twin_of"])
    examples = len(queries) - claims - twins
    return f"{claims:,} claims, {twins:,} twins, {examples:,} examples"


def never_needed(records: Sequence[Record]) -> list[str]:
    """Premises, by name, that some theorem has and no proof of any theorem needs."""
    names = dict.fromkeys(name for record in records for name in record["result"]["unused"])
    needed = {
        name
        for record in records
        for name in record["result"]["premises"]
        if name not in record["result"]["unused"]
    }
    return [name for name in names if name not in needed]


def _agreement(record: Record) -> Iterator[str]:
    """Model checker and theorems, property by property of the whole system."""
    rows = record["result"]["rows"]
    yield ""
    yield "### The whole system: model checker and theorems"
    yield ""
    yield (
        "Each property of all devices together that TLC's runs find to hold within their bounds, by "
        "environment, and the theorem that proves it of the shipped devices without bounds. A theorem rests "
        "on the assumptions named, and on no fewer than those without which TLC finds a counterexample."
    )
    yield ""
    yield f"{record['verdict']}: {sum(1 for row in rows if row['theorem'])} of {len(rows)} by both."
    yield ""
    yield "| property | environment | TLC | theorems | which, or why none | rests on |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        which = f"`{row['theorem']}`" if row["theorem"] else row["reason"]
        note = f": {row['note']}" if row["note"] else ""
        yield (
            f"| {row['id']} | {row['environment']} | {row['tlc']} | {row['proved'] or 'not proved'} | "
            f"{which}{note} | {', '.join(row['rests_on'])} |"
        )


def _premises(records: Sequence[Record]) -> Iterator[str]:
    """Premises that no proof needs: of any theorem, and theorem by theorem."""
    yield ""
    yield "### Premises that no proof needs"
    yield ""
    claims = [
        query for record in records for query in record["result"]["queries"] if query["expected"] == "unsat"
    ]
    known = sum(1 for query in claims if query["core"] is not None)
    yield (
        f"By a set of formulas of which none can be left out, known for {known:,} of {len(claims):,} claims. "
        "Where none is known (products of reals) all premises count as needed."
    )
    yield ""
    yield f"In no theorem at all: {'; '.join(never_needed(records)) or 'none'}."
    yield ""
    yield "Beyond these, a theorem holds without:"
    yield ""
    everywhere = set(never_needed(records))
    rows = [
        (record["id"], [name for name in record["result"]["unused"] if name not in everywhere])
        for record in records
    ]
    yield from (f"- `{theorem}`: {'; '.join(names)}" for theorem, names in rows if names)


def _coverage(record: Record) -> Iterator[str]:
    """What the feasible paths pass through."""
    yield ""
    yield "### What of each step lies on a feasible path"
    yield ""
    yield "A member of every feasible path is run in the plain interpreter, and watched."
    yield ""
    yield "| device | control states | paths | lines | branches | answers of guards by control state |"
    yield "|---|---|---|---|---|---|"
    devices = record["result"]["devices"]
    for name, one in devices.items():
        counts = " | ".join(f"{one[key][0]} of {one[key][1]}" for key in ("lines", "branches", "answers"))
        yield f"| `{name}` | {one['states']} | {one['paths']:,} | {counts} |"
    yield ""
    yield "All that is missing is unreachable for every memory, input and parameter in range:"
    yield ""
    whys: dict[str, list[str]] = {}
    for name, one in devices.items():
        for entry in one["unreachable"]:
            whys.setdefault(entry["why"], []).append(f"`{name}` {entry['what']}")
    for why, places in whys.items():
        yield f"- {why}"
        yield from (f"  - {place}" for place in places)
