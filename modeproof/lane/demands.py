"""The demands of each page, proved of our own reference implementation in each profile, by both solvers."""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.meaning import reached
from modeproof.ground.processes import Task
from modeproof.ground.solvers import needing_solvers
from modeproof.lane.keep import Keep
from modeproof.registers.demands import FILE, load_demand_rows
from modeproof.report.demanded import KIND, id_of, subjects

CODE = ("modeproof.lane.demands", "programs.commands.reference_demands")
SECONDS = 120.0
"""CPU seconds for the proof of one demand."""
Record = dict[str, Any]


def proofs_of_demands(
    place: Path, documents: Sequence[str], keep: Keep
) -> tuple[list[Task[Record]], list[Record]]:
    """What is to be proved, and what is kept."""
    tasks: list[Task[Record]] = []
    found: list[Record] = []
    for document in documents:
        for target, profile in subjects(place, document):
            rests = partial(rests_of, place, document, target)
            if kept := keep.record(place, document, id_of(target, profile), rests):
                found.append(kept)
            else:
                tasks.append((prove_demands, (place, document, target, profile)))
    return tasks, found


def rests_of(place: Path, document: str, target: str) -> evidence.Rests:
    """What the verdicts rest on. Raises Unjudged."""
    code = [
        path
        for path in reached(place, *CODE, f"proofs.{document}.devices")
        if path.is_relative_to(place / "refimpl")
    ]
    registers = [place / "spec" / document / f"{name}.toml" for name in ("interface", FILE, "sequences")]
    inputs = evidence.hashes(place, [*code, *(path for path in registers if path.is_file())])
    return evidence.Rests(inputs, (*CODE, f"proofs.{document}.devices"), evidence.solvers())


def prove_demands(place: Path, document: str, target: str, profile: str) -> Record:
    """Prove the demands of one target in one profile, and write the evidence."""
    with needing_solvers():
        from programs.commands.reference_demands import judgement_of, shown
    rests = rests_of(place, document, target)
    evidence.discard(place, document, id_of(target, profile))
    started, verdict, reason = time.time(), "UNJUDGED", ""
    rows: list[dict[str, str]] = []
    answers: dict[str, Any] = {}
    try:
        left_out = load_demand_rows(place, document).unproved.get(target, {})
        found = shown(judgement_of(target, profile, SECONDS, left_out=[*left_out]))
        rows = [{"id": one.asked.id, "word": one.word, "how": one.how} for one in found.found]
        answers = {
            "files": found.answers.files,
            "other_than_unsat": {name: dict(said) for name, said in found.answers.answers.items()},
        }
        verdict = ("PROVED", "REFUTED", "UNKNOWN")[found.status]
        bad = [f"{row['id']}: {row['word']}: {row['how']}" for row in rows if row["word"] != "PROVED"]
        reason = "; ".join([*bad, *([] if bad or not found.status else found.answers.lines())][:3])
    except (Unjudged, TimeoutError) as error:
        reason = str(error) or "there was not enough time"
    record = evidence.make(
        kind=KIND,
        id=id_of(target, profile),
        document=document,
        verdict=verdict,
        expected="PROVED",
        as_expected=verdict == "PROVED",
        strength=f"{len(rows)} demands on {target}, profile {profile}: every input and time, for ever; by "
        "induction, each question asked of two solvers",
        command=f"modeproof verify --document {document}",
        started=started,
        seconds=time.time() - started,
        inputs=rests.inputs,
        code=rests.code,
        place=place,
        tools=rests.tools,
        result={"device": target, "profile": profile, "demands": rows, "answers": answers},
        reason=reason,
    )
    evidence.write(place, record)
    return record
