"""Changes since the previous report: verdicts, counts, mutants, and pins with the reason why they moved."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from modeproof.report.part import Part
from modeproof.report.snapshot import snapshot
from modeproof.report.sources import HOLE, Sources, Trouble

NONE = "none"


def part(sources: Sources) -> Part:
    """What differs from the baseline that the shelf holds; nothing where there is none."""
    baseline = sources.cache.get("baseline")
    before = baseline.report if baseline is not None else None
    now = sources.cache.get("snapshot") or snapshot(sources)
    troubles: tuple[Trouble, ...] = ()
    if baseline is not None and baseline.problem:
        what = f"the previous report cannot be compared with: {baseline.problem}"
        troubles = (Trouble(HOLE, "changes", what, "modeproof report --previous FILE"),)
    data: dict[str, Any] = {"baseline": None, "groups": []}
    if before is not None:
        data = {
            "baseline": {"digest": before["digest"], "sha256": before["sha256"]},
            "groups": list(_groups(before["snapshot"], now)),
        }
    return Part("changes", "Changes since the previous report", data, troubles)


def _groups(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """One group for each kind of change that there is."""
    for title, rows in (
        ("Verdicts of properties", _rows(before, now, "verdicts", str)),
        ("Verdicts of evidence", _rows(before, now, "results", lambda one: one["verdict"])),
        ("Counts", _counts(before, now)),
        ("Mutants", _rows(before, now, "mutants", _words)),
        ("Pins", _pins(before, now)),
        ("Tools", _rows(before, now, "tools", ", ".join)),
    ):
        found = list(rows)
        if found:
            yield {"title": title, "rows": found}


def _rows(before: Mapping[str, Any], now: Mapping[str, Any], key: str, show: Any) -> Iterator[dict[str, str]]:
    old, new = before.get(key, {}), now[key]
    for name in sorted({*old, *new}):
        was = show(old[name]) if name in old else NONE
        is_now = show(new[name]) if name in new else NONE
        if was != is_now:
            yield {"what": name, "before": was, "now": is_now, "why": ""}


def _words(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count:,} {verdict}" for verdict, count in sorted(counts.items()))


def _counts(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[dict[str, str]]:
    """Counts of evidence that both reports have."""
    old, new = before.get("results", {}), now["results"]
    for name in sorted(old.keys() & new.keys()):
        for key in sorted({*old[name]["counts"], *new[name]["counts"]}):
            was, is_now = old[name]["counts"].get(key), new[name]["counts"].get(key)
            if was != is_now:
                yield {"what": f"{name}: {key}", "before": _number(was), "now": _number(is_now), "why": ""}


def _number(value: int | None) -> str:
    return NONE if value is None else f"{value:,}"


def _pins(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[dict[str, str]]:
    """Pins that moved, with the reasons that runs.toml has given since."""
    old, new = before.get("pins", {}), now["pins"]
    for name in sorted({*old, *new}):
        was, is_now = old.get(name, {}), new.get(name, {})
        document = name.partition("/")[0]
        known = before.get("moved", {}).get(document, ())
        why = "; ".join(reason for reason in now["moved"].get(document, ()) if reason not in known)
        for key in sorted({*was, *is_now}):
            a, b = was.get(key, NONE), is_now.get(key, NONE)
            if a != b:
                yield {"what": f"{name}: {key}", "before": a[:16], "now": b[:16], "why": why}
