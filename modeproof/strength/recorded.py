"""A whole campaign as one piece of evidence, which the report is made from.

The results themselves are one line a mutant, with those of earlier texts among them; here stands what holds
now.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof import evidence
from modeproof.strength.campaign import Judged
from modeproof.strength.explain import explanation_of, explanation_problems, unexplained
from modeproof.strength.mutant import Mutant
from modeproof.strength.register import Explained

KIND = "strength"


@dataclass(frozen=True)
class Record:
    """What a campaign is: `what` is spec, impl or vectors; `judges` are all that can kill, in their order.

    `asked` gives from the record of a mutant whom it was put to; `rests_on` are the files that it rests on.
    """

    document: str
    what: str
    command: str
    judges: Sequence[str]
    asked: Callable[[Mapping[str, Any]], Iterable[str]]
    rests_on: Iterable[Path]
    tools: Mapping[str, Mapping[str, str | None]]
    out_of_scope: int = 0


def record(
    place: Path,
    campaign: Record,
    every: Sequence[Mutant],
    judged: Sequence[Judged],
    explained: Sequence[Explained],
) -> dict[str, Any]:
    """Write the evidence of a campaign over `every` mutant, of which `judged` have a verdict that holds now.

    KILLED: each mutant is killed, proved equivalent, refused by the tools, or a survivor that is explained.
    UNMEASURED where one is not judged, SURVIVED where a survivor is not explained. Raises Unjudged when it
    cannot be written.
    """
    counts = Counter(one.word for one in judged)
    missing = len(every) - len(judged)
    open_ones = unexplained(explained, judged)
    problems = explanation_problems(explained, judged, complete=not missing)
    verdict, reason = "KILLED", ""
    if missing or counts["UNMEASURED"]:
        verdict = "UNMEASURED"
        reason = f"{missing + counts['UNMEASURED']} of {len(every)} mutants are not judged"
    elif open_ones:
        verdict = "SURVIVED"
        reason = f"{open_ones[0].mutant.id} survives without an explanation ({len(open_ones)} in all)"
    elif problems:
        reason = problems[0]
    asked = Counter(name for one in judged for name in dict.fromkeys(campaign.asked(one.record)))
    names = dict.fromkeys([*campaign.judges, *sorted(asked)])
    made = evidence.make(
        kind=KIND,
        id=f"{KIND}_{campaign.what}",
        document=campaign.document,
        verdict=verdict,
        expected="KILLED",
        as_expected=verdict == "KILLED" and not problems,
        strength=f"every single edit by the rules: {len(every)} mutants",
        command=campaign.command,
        started=time.time(),
        seconds=float(sum(one.record["seconds"] for one in judged)),
        inputs=evidence.hashes(place, campaign.rests_on),
        tools=campaign.tools,
        result={
            "campaign": campaign.what,
            "every": len(every),
            "out_of_scope": campaign.out_of_scope,
            "judges": {name: asked[name] for name in names},
            "mutants": [_mutant(one, explained) for one in judged],
            "problems": problems,
        },
        reason=reason,
    )
    evidence.write(place, made)
    return made


def _mutant(one: Judged, explained: Sequence[Explained]) -> dict[str, Any]:
    found = explanation_of(explained, one.mutant.id) if one.word == "SURVIVED" else None
    return {
        "id": one.mutant.id,
        "module": one.mutant.module,
        "definition": one.mutant.definition,
        "operator": one.mutant.operator,
        "line": one.mutant.line,
        "old": one.mutant.old,
        "new": one.mutant.new,
        "verdict": one.word,
        "killers": list(one.killers),
        **(
            {"reason": str(one.record["reason"])[:200]}
            if one.record["reason"] and one.word != "KILLED"
            else {}
        ),
        **({"kind": found.kind, "why": found.why} if found is not None else {}),
    }
