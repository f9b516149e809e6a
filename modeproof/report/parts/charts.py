"""State charts of every device, from the complete graphs: as a picture and as a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.citations import Citation
from modeproof.registers.rows import Device, Document
from modeproof.report.claims import citations_of
from modeproof.report.drawing.state_chart import Box, Step, state_chart
from modeproof.report.part import Part, Picture
from modeproof.report.sources import HOLE, Evidence, Figure, Sources, Trouble

ERROR_WORDS = ("error", "fault")
"""In the name of a control state, or of an output that is on in it (any case): then it is one of error."""


def part(sources: Sources) -> Part:
    """One entry a device: the chart of its first graph, and how the charts of its other graphs differ."""
    troubles: list[Trouble] = []
    documents = [
        {
            "id": document.name,
            "title": document.about.title,
            "devices": [
                _device(sources, document, device, troubles) for device in document.interface.devices.values()
            ],
        }
        for document in sources.documents.values()
    ]
    return Part("charts", "State charts", {"documents": documents}, tuple(troubles))


def _device(sources: Sources, document: Document, device: Device, troubles: list[Trouble]) -> dict[str, Any]:
    found = _charts(sources, document, device, troubles)
    row: dict[str, Any] = {"id": device.id, "title": device.title, "register": document.source("interface")}
    if not found:
        return row | {"chart": None, "variants": []}
    (run, first), *others = found.items()
    return row | {
        "chart": _chart(document, device, run, first, _cited(sources, document, device)),
        "variants": [_variant(name, one, first) for name, one in others],
    }


def _charts(
    sources: Sources, document: Document, device: Device, troubles: list[Trouble]
) -> dict[str, Evidence]:
    """The comparisons that hold a chart of this device, by run, in the order of runs.toml."""
    by_run = {
        str(piece.result.get("run", "")).rsplit("/", 1)[-1]: piece
        for piece in sources.of_kind(document.name, "conformance")
        if piece.result.get("device") == device.id
    }
    found, missing = {}, []
    for run in document.runs:
        if run.graph is None or run.graph.device != device.id:
            continue
        one = by_run.get(run.id)
        if one is not None and _is_chart(one.result.get("chart")):
            found[run.id] = one
        elif one is None or one.record["verdict"] != "EQUAL" or one.result.get("chart", "") is not None:
            missing.append(run.id)  # else its states show no control state: there is nothing to draw
    if missing:
        what = f"{document.name}: no state chart of {device.id} in the evidence of {', '.join(missing)}"
        troubles.append(Trouble(HOLE, "charts", what, f"modeproof verify --document {document.name}"))
    return found


def _cited(sources: Sources, document: Document, device: Device) -> dict[str, Citation]:
    """By step of the device: the clauses and findings named over its action in the specification."""
    actions = {f"{device.module}!{step}": step for step in device.steps}
    return {
        actions[citation.name]: citation
        for citation in citations_of(sources, document)
        if citation.kind == "definition" and citation.room == "spec" and citation.name in actions
    }


def _is_chart(value: Any) -> bool:
    """Whether a piece of evidence holds a chart as modeproof.graph.chart makes it."""
    return (
        isinstance(value, Mapping)
        and {"initial", "states", "outputs", "moves"} <= set(value)
        and bool(value["moves"])
        and all({"source", "step", "target", "transitions"} <= set(one) for one in value["moves"])
    )


def _chart(
    document: Document, device: Device, run: str, piece: Evidence, cites: Mapping[str, Citation]
) -> dict[str, Any]:
    chart = piece.result["chart"]
    boxes = [
        Box(
            name,
            on=tuple(key for key, value in chart["outputs"].get(name, {}).items() if value is True),
            error=_is_error(name, chart["outputs"].get(name, {})),
            initial=name == chart["initial"],
            entered=count > 0,
        )
        for name, count in chart["states"].items()
    ]
    steps = [Step(move["source"], move["step"], move["target"]) for move in chart["moves"]]
    ids = {step: (*known.clauses, *known.findings) for step, known in cites.items()}
    title = f"State chart of {device.id}, {device.title}"
    anchor = f"chart-{document.name}-{device.id}"
    return {
        "run": run,
        "source": piece.path,
        "states": [
            {
                "id": box.name,
                "states": Figure(chart["states"][box.name], piece.path),
                "initial": box.initial,
                "error": box.error,
                "outputs": {key: _word(value) for key, value in chart["outputs"].get(box.name, {}).items()},
            }
            for box in boxes
        ],
        "moves": [
            {
                "from": move["source"],
                "step": move["step"],
                "to": move["target"],
                "clauses": cites[move["step"]].clauses if move["step"] in cites else (),
                "findings": cites[move["step"]].findings if move["step"] in cites else (),
                "transitions": Figure(move["transitions"], piece.path),
            }
            for move in chart["moves"]
        ],
        "never_taken": sorted(set(device.steps) - {step.name for step in steps}),
        "picture": Picture(title, state_chart(boxes, steps, ids, id=anchor, title=title)),
    }


def _is_error(name: str, outputs: Mapping[str, Any]) -> bool:
    on = [key for key, value in outputs.items() if value is True]
    return any(word in one.lower() for word in ERROR_WORDS for one in (name, *on))


def _word(value: Any) -> str:
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    return "none" if value is None or value == "" else str(value)


def _variant(run: str, piece: Evidence, first: Evidence) -> dict[str, Any]:
    """What is another in the chart of another graph of the same device."""
    here, there = _moves(piece), _moves(first)
    return {
        "run": run,
        "environment": piece.record["environment"],
        "source": piece.path,
        "added": [{"from": a, "step": b, "to": c} for a, b, c in here if (a, b, c) not in there],
        "missing": [{"from": a, "step": b, "to": c} for a, b, c in there if (a, b, c) not in here],
        "never_entered": sorted(name for name, count in piece.result["chart"]["states"].items() if not count),
    }


def _moves(piece: Evidence) -> dict[tuple[str, str, str], None]:
    return {(move["source"], move["step"], move["target"]): None for move in piece.result["chart"]["moves"]}
