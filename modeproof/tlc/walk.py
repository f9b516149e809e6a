"""Walks TLC through recorded counterexamples once more, to say what was on the wires in every state, and
what a device of the decided specification does with the same inputs.

A counterexample holds variables; the words on the wires are operators of the state. One module is generated
for all runs of a top module (register replay.toml). It instantiates that module once for each run, with the
constants of the run's cfg, and takes the recorded states one after the other; each must be a step of the
specification still. A run with readings has copies of the modules that they reach, because TLC replaces an
operator in a module and not in one instance of it. Beside the recorded states each device that scans in them
scans as it was decided, on the inputs that the recorded device read: from the memory that the recorded device
had before one of its scans, for every such scan, and from then on from its own. That replay is open loop: the
other devices stay as recorded.

The result is one JSON file a run, build/walks/<document>/<run>.json, good as long as the SHA-256 of the
recorded trace in it is that of the evidence and the specification's files have the hashes in it.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import meaning
from modeproof.ground.places import build
from modeproof.registers.load import load_interface
from modeproof.registers.replay import Traces, load_replay
from modeproof.registers.rows import Device
from modeproof.registers.runs import Run
from modeproof.registers.tla import read_modules
from modeproof.tlc import walk_module
from modeproof.tlc.process import run_tlc
from modeproof.tlc.tla_values import TlaError, parse
from modeproof.tlc.toolchain import Toolchain
from modeproof.tlc.walk_module import (
    AT_ONCE,
    Plan,
    Recorded,
    constants_of,
    everywhere,
    generate,
    module_name,
    present,
    replaced,
)

HEAP_MB = 1024
"""42 traces of one module, most of them with copies of their own, do not fit into half of it."""
LIMIT_S = 900
_INTERVAL = re.compile(r"(-?\d+)\.\.(-?\d+)")


def trace_digest(record: Mapping[str, Any]) -> str:
    """SHA-256 of the counterexample in a piece of evidence."""
    text = json.dumps(
        [sorted(state["variables"].items()) for state in record["result"]["trace"]], separators=(",", ":")
    )
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def recorded(record: Mapping[str, Any]) -> Recorded:
    """The counterexample of a piece of evidence. Raises Unjudged when it has none."""
    result = record["result"]
    if not result.get("trace"):
        raise Unjudged(
            f"{record['id']}: its evidence holds no counterexample; run modeproof check {record['id']}"
        )
    return Recorded(
        run=record["id"],
        module=result["module"],
        cfg=result["cfg"],
        states=tuple(state["variables"] for state in result["trace"]),
        digest=trace_digest(record),
        readings=tuple(result.get("readings", ())),
        stops=result.get("loop") == "stuttering",
    )


def walk_path(place: Path, document: str, run: str) -> Path:
    """Where the walk of a run lies."""
    return build(place) / "walks" / document / f"{run}.json"


def spec_hashes(place: Path, document: str) -> dict[str, str]:
    """The meanings of every module, of the register and of this file, on which a walk rests."""
    folder = place / "spec" / document
    common = (place / "spec" / "common").glob("*.tla")
    found = evidence.hashes(place, sorted([*folder.glob("*.tla"), *common, folder / "replay.toml"]))
    own = (Path(__file__), Path(walk_module.__file__))
    return found | {f"modeproof/tlc/{path.name}": meaning(path) for path in own}


def read_walk(place: Path, document: str, trace: Recorded) -> dict[str, Any] | None:
    """The walk of a run if there is one of this very trace and specification, else None."""
    try:
        walk = json.loads(walk_path(place, document, trace.run).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    current = isinstance(walk, dict) and walk.get("trace_sha256") == trace.digest
    return walk if current and walk.get("inputs") == spec_hashes(place, document) else None


def walk_all(
    place: Path, document: str, traces: Sequence[Recorded], tools: Toolchain
) -> dict[str, dict[str, Any]]:
    """The walks of these counterexamples, by run; TLC is started once for each top module that has a new one.

    Raises Unjudged when TLC cannot follow a trace (evidence of another specification), and then writes
    nothing.
    """
    found = {trace.run: read_walk(place, document, trace) for trace in traces}
    plan = load_replay(place, document)
    modules = read_modules(place, document)
    groups: dict[tuple[str, tuple[tuple[str, str], ...]], list[Recorded]] = {}
    for trace in traces:
        if found[trace.run] is None:
            constants = constants_of(place, modules, trace)
            groups.setdefault((trace.module, replaced(modules, trace.module, constants)), []).append(trace)
    for (module, definitions), missing in groups.items():
        found |= _walk(place, document, plan, module, definitions, missing, tools)
    return {run: walk for run, walk in found.items() if walk is not None}


def _walk(
    place: Path,
    document: str,
    traces: Traces,
    module: str,
    definitions: Sequence[tuple[str, str]],
    missing: Sequence[Recorded],
    tools: Toolchain,
) -> dict[str, dict[str, Any]]:
    top = traces.tops.get(module)
    if top is None:
        raise Unjudged(
            f"spec/{document}/replay.toml: tops: {module} is missing, which {missing[0].run} checks"
        )
    plan = Plan(document, module, top, traces, load_interface(place, document), read_modules(place, document))
    given = [(trace, constants_of(place, plan.modules, trace)) for trace in missing]
    folder = build(place) / "walk" / document / module
    shutil.rmtree(folder, ignore_errors=True)
    name = module_name(module)
    text, cfg = generate(plan, given, definitions), "INIT Begin\nNEXT Follow\nINVARIANT Shown\n"
    every = [plan.copies(number, trace) for number, trace in enumerate(missing, 1)]
    there = present(plan, text)
    for old, _ in definitions:
        cfg += everywhere(every, old, plan.owner(old, module), there)
    for used in plan.reached(every):
        if AT_ONCE in plan.modules[used].words:
            cfg += everywhere(every, AT_ONCE, used, there)
    for copies in every:
        for each in copies.tried:
            owner = copies.names[plan.owner(each.replaced, each.module)]
            cfg += f"CONSTANT {each.replaced} <- [{owner}]{copies.operator(each)}\n"
        for copied, content in copies.texts(place, plan.modules):
            write_whole(folder / f"{copied}.tla", content.encode("utf-8"))
        if copies.root:
            write_whole(folder / f"{name}__{copies.number}.tla", copies.root.encode("utf-8"))
    write_whole(folder / f"{name}.tla", text.encode("utf-8"))
    write_whole(folder / f"{name}.cfg", cfg.encode("utf-8"))
    run = Run(
        document=document,
        id=name,
        module=name,
        cfg=f"{name}.cfg",
        kind="MC",
        lanes=(),
        environment="",
        strength="",
        workers=1,
        heap_mb=HEAP_MB,
        timeout_s=LIMIT_S,
        properties=("Shown",),
    )
    outcome = run_tlc(place, run, tools, made_in=folder)
    log = outcome.log
    if outcome.status != 0 or not log.success or log.violations or log.errors:
        said = " ".join((log.errors[0][1] if log.errors else outcome.stderr).split())[:300]
        raise Unjudged(
            f"{folder / name}.tla: TLC could not follow the traces of {module}: {said or outcome.status}"
        )
    lines = [_line(line, module) for line in sorted(outcome.printed)]
    hashes = spec_hashes(place, document)
    walks = {}
    for number, trace in enumerate(missing, 1):
        walk = _read(plan, number, trace, lines)
        walk |= {"run": trace.run, "trace_sha256": trace.digest, "inputs": hashes}
        walks[trace.run] = walk
    for named, walk in walks.items():
        text = json.dumps(walk, indent=1, ensure_ascii=False, sort_keys=True) + "\n"
        write_whole(walk_path(place, document, named), text.encode("utf-8"))
        walks[named] = json.loads(text)  # what is rendered now is what will be read back later
    return walks


def _spelled(text: str) -> str:
    """The text with intervals such as 0..2 spelled out as sets; TLC prints either."""

    def members(match: re.Match[str]) -> str:
        return "{" + ", ".join(map(str, range(int(match.group(1)), int(match.group(2)) + 1))) + "}"

    return _INTERVAL.sub(members, text)


def _line(line: bytes, module: str) -> tuple[Any, ...]:
    try:
        value = parse(_spelled(line.decode("utf-8")))
    except (TlaError, UnicodeDecodeError) as error:
        raise Unjudged(f"walk of {module}: a printed line cannot be read: {error}") from None
    if not isinstance(value, tuple) or not value:
        raise Unjudged(f"walk of {module}: a printed line is no tuple")
    return value


def _plain(value: Any) -> Any:
    """A TLA+ value as JSON: sets become ascending lists."""
    if isinstance(value, frozenset):
        return sorted((_plain(member) for member in value), key=repr)
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    return value


def _read(plan: Plan, number: int, trace: Recorded, lines: Sequence[tuple[Any, ...]]) -> dict[str, Any]:
    wires = {line[2]: line[3] for line in lines if line[:2] == ("ROW", number)}
    steps: dict[int, str] = {}
    for line in lines:
        if line[:2] == ("STEP", number):
            steps.setdefault(line[2], line[3])
    rows = []
    for at, state in enumerate(trace.states, 1):
        if at not in wires or (at > 1 and at not in steps):
            raise Unjudged(
                f"{trace.run}: the specification does not allow state {at} of its counterexample any more; "
                f"run modeproof check {trace.run}"
            )
        variables = {name: _plain(parse(_spelled(state[name]))) for name in plan.variables}
        step = steps.get(at, "")
        who = plan.who(trace.states[at - 2], {**state, plan.traces.step: f'"{step}"'}) if at > 1 else ""
        rows.append({"at": at, "step": step, "who": who, "wires": _plain(wires[at]), "variables": variables})
    decided, departures = {}, {}
    for device in plan.replayed:
        scans = [line for line in lines if line[:3] == ("SCAN", number, device.id)]
        paths = {
            start: list(_path(plan, device, [line for line in scans if line[3] == start], rows))
            for start in sorted({line[3] for line in scans})
        }
        departing = [start for start, path in paths.items() if _departs(plan, device, path[0], rows)]
        if paths:
            decided[device.id] = paths[_start(list(paths), departing, paths, rows)]
            departures[device.id] = [{"at": at, "step": paths[at][0]["step"]} for at in departing]
    tables = {line[1]: _plain(line[2]) for line in lines if line[0] == "TABLE"}
    outputs = sorted({name for scans in decided.values() for scan in scans for name in scan["outputs"]})
    alone = outputs if len(decided) == 1 and len(plan.replayed) == 1 else []
    after = sorted({line[2] for line in lines if line[:2] == ("AFTER", number)})
    found = {"module": plan.module, "rows": rows, "decided": decided, "departures": departures}
    return found | {"tables": tables, "outputs": alone, "after": after}


def _path(
    plan: Plan, device: Device, scans: Sequence[tuple[Any, ...]], rows: Sequence[Mapping[str, Any]]
) -> Iterator[dict[str, Any]]:
    """The scans of the decided device one after the other; where it has a choice, it does what was
    recorded.
    """
    names = plan.shadows(device)
    state = None
    for at in sorted({line[4] for line in scans}):
        options = [line for line in scans if line[4] == at and state in (None, line[5])]
        if not options:
            return
        line = next((option for option in options if option[7] == rows[at - 1]["step"]), options[0])
        state = line[6]
        yield {
            "at": at,
            "step": line[7],
            "memory": {name: _plain(value) for name, value in zip(names, line[6], strict=True)},
            "outputs": _plain(line[8]),
            "read": _plain(line[9]),
        }


def _departs(plan: Plan, device: Device, scan: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> bool:
    """Whether a scan of the decided device from the recorded memory differs from the recorded scan."""
    row = rows[scan["at"] - 1]
    own = [name for name in plan.shadows(device) if name != plan.traces.step]
    return (
        scan["step"] != row["step"]
        or any(scan["memory"][name] != row["variables"][name] for name in own)
        or any(row["wires"].get(name, value) != value for name, value in scan["outputs"].items())
    )


def _start(
    scans: Sequence[int],
    departures: Sequence[int],
    paths: Mapping[int, Sequence[Mapping[str, Any]]],
    rows: Sequence[Mapping[str, Any]],
) -> int:
    """From which scan the comparison begins: that of the last stretch of departures after which the decided
    device does not end with the recorded step; else the first departure; else the first scan.
    """
    stretches = [
        at for n, at in enumerate(scans) if at in departures and (n == 0 or scans[n - 1] not in departures)
    ]
    for at in reversed(stretches):
        last = paths[at][-1]
        if last["step"] != rows[last["at"] - 1]["step"]:
            return at
    return stretches[0] if stretches else scans[0]
