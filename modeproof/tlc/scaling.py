"""How a model grows: series of a declared run of which one constant is varied, measured one after the other.

The register is spec/<document>/scaling.toml. A point is judged like any run but for its counts, which nothing
pins: a point that does not hold, or that was ended by its time limit, is not in the chart.
"""

from __future__ import annotations

import re
import resource
import shutil
import time
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from modeproof import evidence
from modeproof.errors import Unjudged
from modeproof.places import build
from modeproof.progress import Progress
from modeproof.registers.cfg import COMMENT, parse_cfg
from modeproof.registers.made import cfg_text as cfg_of
from modeproof.registers.runs import Run, load_runs
from modeproof.tlc.judge import HOLDS, Judgement, judge
from modeproof.tlc.process import Outcome, run_tlc
from modeproof.tlc.toolchain import Toolchain

KIND = "scaling"
_SECTIONS = ("SPECIFICATION", "VIEW", "INIT", "NEXT")
_CHECKED = re.compile(r"^[ \t]*(?:INVARIANTS?|PROPERTY|PROPERTIES)\b.*$", re.MULTILINE)
_VALUE = r'(?:\{[^}]*\}|"[^"\n]*"|[^\s{"]+)'


@dataclass(frozen=True)
class Point:
    """One measurement: its place on the axis, and what its cfg is given (constants and sections)."""

    x: int
    given: Mapping[str, str]


@dataclass(frozen=True)
class Series:
    """A declared run, the module that is checked in place of its own (else ""), and the points."""

    id: str
    run: Run
    module: str
    x: str
    title: str
    points: tuple[Point, ...]
    properties: tuple[str, ...]
    """What is checked in place of what the run checks; empty: the same."""
    limit_s: float
    heap_mb: int

    def name(self, point: Point) -> str:
        """The name of a point's evidence."""
        return f"SCALE_{self.id}_{point.x}"


def has_scaling(place: Path, document: str) -> bool:
    """Whether the document has the register."""
    return (place / "spec" / document / "scaling.toml").is_file()


def load_scaling(place: Path, document: str) -> tuple[Series, ...]:
    """The series that spec/<document>/scaling.toml declares, in its order.

    Raises Unjudged, naming the place, when a field is missing, unknown or of the wrong type, when a run is
    not declared, and when a series has less than two points or one twice.
    """
    source = f"spec/{document}/scaling.toml"
    try:
        data = tomllib.loads((place / source).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Unjudged(f"{source}: not found") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{source}: {error}") from None
    runs = {run.id: run for run in load_runs(place, document)}
    if not data.get("series"):
        raise Unjudged(f"{source}: no series is declared")
    found: list[Series] = []
    for values in data["series"]:
        where = f"{source}: series {values.get('id', '?')}"
        if unknown := sorted(
            set(values) - {"id", "run", "module", "x", "title", "set", "points", "properties"}
        ):
            raise Unjudged(f"{where}: unknown field {unknown[0]!r}")
        if missing := [key for key in ("id", "run", "x", "title", "points") if key not in values]:
            raise Unjudged(f"{where}: {missing[0]} is missing")
        if values["run"] not in runs:
            raise Unjudged(f"{where}: no run {values['run']!r} in runs.toml")
        points = tuple(_point(where, values.get("set", {}), one) for one in values["points"])
        places = [point.x for point in points]
        if len(points) < 2 or places != sorted(set(places)):
            raise Unjudged(f"{where}: at least two points, with rising x, not {places}")
        found.append(
            Series(
                id=str(values["id"]),
                run=runs[values["run"]],
                module=str(values.get("module", "")),
                x=str(values["x"]),
                title=str(values["title"]),
                points=points,
                properties=tuple(map(str, values.get("properties", ()))),
                limit_s=float(data.get("limit_s", 180)),
                heap_mb=int(data.get("heap_mb", 2048)),
            )
        )
    if len({one.id for one in found}) != len(found):
        raise Unjudged(f"{source}: two series have one id")
    return tuple(found)


def _point(where: str, common: Mapping[str, Any], values: Mapping[str, Any]) -> Point:
    x = values.get("x")
    given = {**common, **{key: value for key, value in values.items() if key != "x"}}
    if not isinstance(x, int) or isinstance(x, bool) or x < 0:
        raise Unjudged(f"{where}: the x of a point must be a whole number, not {x!r}")
    if not given or not all(isinstance(value, str) for value in given.values()):
        raise Unjudged(f"{where}: point {x}: what it sets must be text, as it stands in a cfg")
    return Point(x, given)


def cfg_text(text: str, given: Mapping[str, str], where: str) -> str:
    """A cfg with other values for the constants and sections named; a constant that it lacks is added.

    Raises Unjudged when a name stands in it twice, or a section not at all.
    """
    bare = COMMENT.sub(" ", text)
    added = ""
    for name, value in given.items():
        section = name in _SECTIONS
        pattern = rf"\b{name}\s+\w+" if section else rf"\b{name}\s*(?:<-|=)\s*{_VALUE}"
        written = f"{name} {value}" if section else f"{name} = {value}"
        bare, count = re.subn(pattern, written.replace("\\", r"\\"), bare)
        if count > 1 or (count == 0 and section):
            raise Unjudged(f"{where}: {name} stands {count} times in the cfg of the run")
        if count == 0:
            added += f"CONSTANT {name} = {value}\n"
    return added + bare.strip() + "\n"


def measure(
    place: Path, series: Series, tools: Toolchain, progress: Progress
) -> Iterator[tuple[Point, dict[str, Any]]]:
    """Measure the points in their order and write the evidence of each.

    After the first point that was ended by its limit, the larger ones are not tried.
    """
    over = ""
    for point in series.points:
        name = series.name(point)
        evidence.discard(place, series.run.document, name)
        started = time.time()
        progress.begin(name)
        try:
            outcome, judgement, cpu_s = (
                _skipped(over) if over else _measure(place, series, point, tools, progress)
            )
        finally:
            progress.end(name)
        if judgement.verdict == "INCONCLUSIVE" and not over:
            over = f"not tried: {point.x} reached the limit of {series.limit_s:.0f} s"
        record = _record(place, series, point, tools, outcome, judgement, cpu_s, started)
        evidence.write(place, record)
        yield point, record


def _skipped(reason: str) -> tuple[Outcome | None, Judgement, float]:
    return None, Judgement("INCONCLUSIVE", False, reason), 0.0


def _measure(
    place: Path, series: Series, point: Point, tools: Toolchain, progress: Progress
) -> tuple[Outcome | None, Judgement, float]:
    name = series.name(point)
    folder = place / "spec" / series.run.document
    module = series.module or series.run.module
    room = build(place) / "scaling" / series.run.document / name
    text = cfg_text(cfg_of(place, series.run), point.given, name)
    if series.properties:
        text = _CHECKED.sub("", text) + f"INVARIANTS {' '.join(series.properties)}\n"
        if parse_cfg(text, name).checked != series.properties:
            raise Unjudged(f"{name}: INVARIANTS and PROPERTIES of the cfg must stand in lines of their own")
    shutil.rmtree(room, ignore_errors=True)
    room.mkdir(parents=True)
    try:
        shutil.copyfile(folder / f"{module}.tla", room / f"{module}.tla")
        (room / f"{name}.cfg").write_text(text, encoding="utf-8")
        run = msgspec.structs.replace(
            series.run,
            base="",
            id=name,
            module=module,
            cfg=f"{name}.cfg",
            workers=1,
            heap_mb=series.heap_mb,
            timeout_s=series.limit_s,
        )
        before = _cpu_s()
        outcome = run_tlc(
            place,
            run,
            tools,
            lambda counts: progress.update(name, f"{counts.distinct:,} distinct"),
            made_in=room,
        )
        cpu_s = _cpu_s() - before
        found = judge(run, parse_cfg(text, name), "", outcome)
        holds = found.verdict == HOLDS
        reason = "" if holds else f"{found.violated} is violated" if found.violated else found.reason
        reason = reason or ("" if holds else f"{found.verdict}, which is not what its run must show")
        return outcome, Judgement(found.verdict, holds, reason, found.violated), cpu_s
    except OSError as error:
        raise Unjudged(f"{name}: {error.strerror or error} ({error.filename or room})") from None
    finally:
        shutil.rmtree(room, ignore_errors=True)


def _cpu_s() -> float:
    """CPU seconds of all programs that have been started and have ended; one point runs at a time."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _record(
    place: Path,
    series: Series,
    point: Point,
    tools: Toolchain,
    outcome: Outcome | None,
    judgement: Judgement,
    cpu_s: float,
    started: float,
) -> dict[str, Any]:
    folder = place / "spec" / series.run.document
    counts = outcome.log.counts if outcome is not None else None
    return evidence.make(
        kind=KIND,
        id=series.name(point),
        document=series.run.document,
        verdict=judgement.verdict,
        expected=HOLDS,
        as_expected=judgement.as_expected,
        environment=series.run.environment,
        strength=", ".join(f"{key} {value}" for key, value in point.given.items()),
        command=f"modeproof scale {series.id}",
        started=started,
        seconds=outcome.seconds if outcome is not None else 0.0,
        inputs=evidence.hashes(
            place, [*sorted(folder.glob("*.tla")), folder / series.run.cfg, folder / "scaling.toml"]
        ),
        tools={
            "tlc": {
                "version": (outcome.log.version if outcome is not None else "") or "not started",
                "sha256": tools.jar_sha256,
            },
            "java": evidence.tool(tools.java_version, tools.java),
        },
        result={
            "series": series.id,
            "run": series.run.id,
            "x": point.x,
            "given": dict(point.given),
            "distinct": counts.distinct if counts is not None else None,
            "generated": counts.generated if counts is not None else None,
            "depth": outcome.log.depth if outcome is not None else None,
            "cpu_seconds": round(cpu_s, 1),
            "limit_s": series.limit_s,
        },
        reason=judgement.reason,
    )
