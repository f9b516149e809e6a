"""Model checker and theorems, property by property of the whole system: do they say the same?

The rows come from the room of the proofs of a document (module `agreement`, where there is one): each
property and environment that a run of the whole system judges, with the theorem that proves it or the reason
why none does. The model checker's column is what its runs must give; they are judged by themselves.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import first_of
from modeproof.ground.meaning import is_there
from modeproof.report.evidence_judge import agreement_problems

ID = "agreement"


def compare(
    place: Path,
    document: str,
    module: ModuleType,
    verdicts: Mapping[str, str],
    tools: Mapping[str, Mapping[str, str | None]],
) -> dict[str, Any]:
    """Compare the rows with the verdicts on the theorems, by name, and write one piece of evidence.

    EQUAL: where the runs hold the theorem is proved, or a reason is beside it, and no theorem does
    without an assumption that the model checker needs. Else DIFFERS.
    """
    evidence.discard(place, document, ID)
    started = time.time()
    rows: list[dict[str, Any]] = []
    problems: list[str] = []
    try:
        for row in module.rows():
            proved = verdicts.get(row.theorem, "UNJUDGED") if row.theorem else ""
            rows.append({**asdict(row), "proved": proved})
        problems += [*agreement_problems(rows), *module.disagreements()]
    except ValueError as error:  # a property with neither theorem nor reason
        problems.append(" ".join(str(error).split()))
    if not rows and not problems:
        problems.append("no property of the whole system was compared")
    record = evidence.make(
        kind="agreement",
        id=ID,
        document=document,
        verdict="DIFFERS" if problems else "EQUAL",
        expected="EQUAL",
        as_expected=not problems,
        strength="each property of the whole system in each environment",
        command=f"modeproof prove --document {document}",
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, sorted((place / "spec" / document).glob("*.toml"))),
        code=("modeproof.lane.agreement", *filter(partial(is_there, place), [module.__name__])),
        place=place,
        tools=tools,
        result={"rows": rows, "problems": problems},
        reason=first_of(problems),
    )
    evidence.write(place, record)
    return record


def line(records: Sequence[Mapping[str, Any]]) -> str:
    """One line for the summary."""
    rows = [row for record in records for row in record["result"]["rows"]]
    both = sum(1 for row in rows if row["theorem"])
    verdict = "EQUAL" if all(record["as_expected"] for record in records) else "DIFFERS"
    return (
        f"{'agreement':<12} {verdict}; {both} of {len(rows)} properties of the whole system, by environment, "
        f"by the model checker and by theorem, {len(rows) - both} by the model checker alone"
    )
