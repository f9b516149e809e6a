"""How to reproduce: the command behind each piece of evidence, hashes, tools, machines, licences."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from modeproof.report.part import Part
from modeproof.report.sources import Evidence, Figure, Sources, version_of
from modeproof.report.vendored import packages


def part(sources: Sources) -> Part:
    """Evidence by document; what made it; what made this page."""
    return Part(
        "reproduce",
        "How to reproduce",
        {
            "documents": [
                {
                    "id": name,
                    "evidence": [
                        {
                            "id": record.id,
                            "kind": record.record["kind"],
                            "verdict": record.record["verdict"],
                            "as_expected": record.record["as_expected"],
                            "command": record.record["command"],
                            "started": record.record["started"],
                            "seconds": record.figure("seconds", unit="s"),
                            "sha256": Figure(record.sha256, record.path),
                            "result_sha256": Figure(record.result_sha256, record.path),
                            "inputs": len(record.record["inputs"]),
                            "stale": bool(record.changed),
                        }
                        for record in evidence.values()
                    ],
                }
                for name, evidence in _evidence(sources).items()
            ],
            "made": _made(sources),
            "days": _days(sources),
            "packages": packages(),
        },
    )


def _evidence(sources: Sources) -> dict[str, Mapping[str, Evidence]]:
    """By document, and then by machine."""
    machines = {name: {piece.id: piece} for name, piece in sources.machines.items() if piece is not None}
    return {**sources.evidence, **machines}


def _days(sources: Sources) -> list[dict[str, Any]]:
    """On which days the results were judged, and how many on each."""
    days = Counter(str(piece.record["started"])[:10] for piece in sources.everything())
    return [{"day": day, "pieces": Figure(count, "build/evidence/")} for day, count in sorted(days.items())]


def _made(sources: Sources) -> list[dict[str, Any]]:
    """Each tool and machine with the version or hash that evidence names, and how many pieces do."""
    counts: dict[tuple[str, str, str], int] = {}
    for piece in sources.everything():
        for tool, entry in piece.record["tools"].items():
            key = (str(tool), *version_of(tool, entry))
            counts[key] = counts.get(key, 0) + 1
        machine: Mapping[str, Any] = piece.record["machine"]
        words = f"{machine['system']}, {machine['arch']}, {machine.get('cpu', '')}, {machine['cores']} cores"
        key = ("machine", words, "")
        counts[key] = counts.get(key, 0) + 1
    return [
        {"tool": tool, "version": version, "sha256": digest, "pieces": Figure(count, "build/evidence/")}
        for (tool, version, digest), count in sorted(counts.items())
    ]
