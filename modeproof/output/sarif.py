"""An outcome as SARIF 2.1.0, which forges and editors show beside the lines of the program.

A result is a problem; its rule is the clause, the finding or the property that it is about; its code flow are
the scans of the counterexample, one location each, with the values of the scan as state.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import PurePosixPath, PureWindowsPath
from typing import Any
from urllib.parse import quote

from modeproof.output.outcome import (
    TOOL,
    UNJUDGED,
    Counterexample,
    Demand,
    File,
    Outcome,
    Problem,
    Rule,
    Scan,
    Spot,
    Tool,
)
from modeproof.output.words import in_scan, shown

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
BASE = "%SRCROOT%"
"""The project folder, as forges call it."""
ERRORS = ("REFUTED", "BREAKS", "DIFFERS", UNJUDGED)
"""Words of what is wrong; the others are warnings: something is not shown."""
ROLES = {"program": "analysisTarget", "wiring": "analysisTarget", "log": "analysisTarget"}
_AT = re.compile(r"(.+?):(\d+): ")
_UNJUDGED = Rule(
    id=UNJUDGED.lower(),
    kind="target",
    sentence="What could not be judged is not shown to be right.",
)


def as_sarif(outcome: Outcome) -> str:
    """The text of a SARIF file."""
    return as_sarif_of({_id(outcome): outcome})


def as_sarif_of(outcomes: Mapping[str, Outcome]) -> str:
    """The same, with a run for each outcome; the ids tell the runs apart, in this commit and the next."""
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [_run(*row) for row in outcomes.items()]}
    return json.dumps(log, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _run(id: str, outcome: Outcome) -> dict[str, Any]:
    problems = list(_problems(outcome))
    rules = {rule.id: rule for _, problem in problems for rule in (problem.rule, *problem.others)}
    order = list(rules)
    own, *others = outcome.tools
    driver: dict[str, Any] = {
        "name": own.name,
        "version": own.version,
        "rules": [*map(_rule, rules.values())],
    }
    if own.sha256:
        driver["properties"] = {"sha256": own.sha256}
    extensions = [_tool(tool) for tool in others]
    said = {
        "verdict": outcome.word,
        "subject": outcome.subject,
        "target": outcome.target,
        "strength": outcome.strength,
        "profile": outcome.profile,
        "assumptions": outcome.assumptions,
        "trusted": outcome.trusted,
        "notShown": outcome.not_shown,
        "demands": {demand.id: demand.word for demand in outcome.demands},
    }
    return {
        "tool": {"driver": driver, **({"extensions": extensions} if extensions else {})},
        "automationDetails": {"id": id},
        "invocations": [_invocation(outcome)],
        "originalUriBaseIds": {BASE: {"description": {"text": "The project folder."}}},
        "artifacts": [_artifact(file) for file in outcome.files],
        "results": [_result(outcome, demand, problem, order) for demand, problem in problems],
        "columnKind": "utf16CodeUnits",
        "properties": said,
    }


def _tool(tool: Tool) -> dict[str, Any]:
    found: dict[str, Any] = {"name": tool.name}
    if tool.version:
        found["version"] = tool.version
    if tool.sha256:
        found["properties"] = {"sha256": tool.sha256}
    return found


def _id(outcome: Outcome) -> str:
    """What tells this analysis from others of the same commit, and is the same for the next commit."""
    words = [re.sub(r"[^A-Za-z0-9._-]+", "-", word).strip("-") for word in (outcome.subject, outcome.target)]
    return "/".join(["modeproof", outcome.command, *(word for word in words if word), ""])


def _problems(outcome: Outcome) -> Iterator[tuple[Demand, Problem]]:
    yield from outcome.problems
    if outcome.word == UNJUDGED and not outcome.problems:
        demand = Demand(id=_UNJUDGED.id, word=UNJUDGED, sentence=_UNJUDGED.sentence)
        at = _AT.match(outcome.reason)
        known = {file.path: file.path for file in outcome.files}
        known |= {PurePosixPath(path).name: path for path in known}
        line = known.get(PurePosixPath(at[1]).name) if at else None
        spot = Spot(file=line, line=int(at[2])) if at and line else _first(outcome)
        yield demand, Problem(rule=_UNJUDGED, message=outcome.reason, spot=spot)


def _first(outcome: Outcome) -> Spot | None:
    return Spot(file=outcome.files[0].path) if outcome.files else None


def _invocation(outcome: Outcome) -> dict[str, Any]:
    found: dict[str, Any] = {
        "commandLine": outcome.again,
        "exitCode": outcome.status,
        "executionSuccessful": outcome.word != UNJUDGED,
    }
    if outcome.started:
        found["startTimeUtc"] = outcome.started
    if outcome.reason and outcome.status == 2:
        found["toolExecutionNotifications"] = [{"level": "error", "message": _message(outcome.reason)}]
    return found


def _artifact(file: File) -> dict[str, Any]:
    role = ROLES.get(file.role, "referencedOnCommandLine")
    return {"location": _location(file.path), "hashes": {"sha-256": file.sha256}, "roles": [role]}


def _rule(rule: Rule) -> dict[str, Any]:
    where = f" ({rule.source})" if rule.source else ""
    help = f"{rule.kind} {rule.id}{where}: {rule.sentence}"
    found: dict[str, Any] = {
        "id": rule.id,
        "shortDescription": {"text": rule.sentence},
        "help": {"text": help},
        "properties": {"tags": ["safety", rule.kind], "kind": rule.kind},
    }
    if rule.kind in ("clause", "finding"):
        found["help"]["text"] += f"\n`modeproof explain {rule.id}` says what was shown of it."
    return found


def _result(outcome: Outcome, demand: Demand, problem: Problem, order: list[str]) -> dict[str, Any]:
    rule = _about(problem)
    spot = problem.spot or _first(outcome)
    example = problem.counterexample
    wrong = example.wrong if example is not None else []
    who = [outcome.command, outcome.subject, outcome.target, demand.id, rule.id, *sorted(wrong)]
    found: dict[str, Any] = {
        "ruleId": rule.id,
        "ruleIndex": order.index(rule.id),
        "level": "note" if not demand.required else "error" if demand.word in ERRORS else "warning",
        "message": _message(_text(demand, problem)),
        "partialFingerprints": {"modeproof/v1": hashlib.sha256(json.dumps(who).encode()).hexdigest()},
        "properties": {
            "verdict": demand.word,
            "demand": demand.id,
            "rules": [one.id for one in (problem.rule, *problem.others)],
        },
    }
    if spot is not None:
        found["locations"] = [{"physicalLocation": _physical(spot)}]
    if example is not None:
        found["codeFlows"] = [_flow(example, spot)]
    return found


def _about(problem: Problem) -> Rule:
    """The clause, where the problem is a difference from a target; else the property itself."""
    clauses = [rule for rule in problem.others if rule.kind == "clause"]
    return clauses[0] if clauses and problem.rule.kind != "property" else problem.rule


def _text(demand: Demand, problem: Problem) -> str:
    cited = [rule.id for rule in problem.others]
    about = f" See {', '.join(cited)}." if cited else ""
    return f"{demand.word}: {problem.message.rstrip('.')}.{about}"


def _flow(example: Counterexample, spot: Spot | None) -> dict[str, Any]:
    flow: dict[str, Any] = {"locations": list(_steps(example, spot))}
    first = {**example.parameters, **example.retained}
    if first:
        flow["initialState"] = {name: {"text": shown(value)} for name, value in first.items()}
    return {"message": _message(f"{len(example.scans)} scans; {example.found_by}"), "threadFlows": [flow]}


def _steps(example: Counterexample, spot: Spot | None) -> Iterator[dict[str, Any]]:
    before: Scan | None = None
    for number, scan in enumerate(example.scans, example.first):
        last = scan is example.scans[-1]
        location: dict[str, Any] = {"message": _message(in_scan(number, scan, before, example, last))}
        if (at := scan.spot or spot) is not None:
            location["physicalLocation"] = _physical(at)
        yield {
            "location": location,
            "executionOrder": number,
            "importance": "essential" if last else "important",
            "state": _state(scan),
        }
        before = scan


def _state(scan: Scan) -> dict[str, Any]:
    values = {
        **{f"input {name}": value for name, value in scan.inputs.items()},
        **{f"output {name}": value for name, value in scan.given.items()},
        **{
            f"expected {name}": value
            for name, value in scan.expected.items()
            if value != scan.given.get(name)
        },
    }
    return {name: {"text": shown(value)} for name, value in values.items()}


def _physical(spot: Spot) -> dict[str, Any]:
    found: dict[str, Any] = {"artifactLocation": _location(spot.file)}
    if spot.line:
        found["region"] = {"startLine": spot.line, **({"startColumn": spot.column} if spot.column else {})}
    return found


def _location(path: str) -> Mapping[str, str]:
    """A path as a URI: from the project folder, where it lies in it."""
    if path.startswith(TOOL):
        return {"uri": TOOL + quote(path.removeprefix(TOOL))}
    if PureWindowsPath(path).drive:
        return {"uri": f"file:///{quote(path, safe='/:')}"}
    if PurePosixPath(path).is_absolute():
        return {"uri": f"file://{quote(path)}"}
    return {"uri": quote(path), "uriBaseId": BASE}


def _message(text: str) -> dict[str, str]:
    return {"text": _plain(text)}


def _plain(text: str) -> str:
    """A text in which nothing is a placeholder."""
    return text.replace("{", "{{").replace("}", "}}")
