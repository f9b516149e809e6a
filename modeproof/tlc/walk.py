"""Walks TLC through recorded counterexamples once more, to say what stood on the wires in every state, and
what a device of the decided specification does with the same inputs.

A counterexample holds variables; the words on the wires are operators of the state. One module is generated
for all runs of a top module (register replay.toml). It instantiates that module once for each run, with the
constants of the run's cfg, and takes the recorded states one after the other; each must be a step of the
specification still. Beside them it lets each device that scans in them scan with no reading restored, on the
inputs that the recorded device read: from the memory that the recorded device had before one of its scans,
for every such scan, and from then on from its own. That replay is open loop: the other devices stay as
recorded.

The result is one JSON file a run, build/walks/<document>/<run>.json, good as long as the SHA-256 of the
recorded trace in it is that of the evidence and the specification's files have the hashes in it.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof import evidence
from modeproof.errors import Unjudged
from modeproof.evidence.files import write_whole
from modeproof.graph.tla import TlaError, parse
from modeproof.places import build
from modeproof.registers.cfg import Constant, parse_cfg
from modeproof.registers.files import read_text
from modeproof.registers.load import load_interface
from modeproof.registers.replay import Top, Traces, load_replay
from modeproof.registers.rows import Device, Interface
from modeproof.registers.runs import Run
from modeproof.registers.tla import Module, read_modules
from modeproof.tlc.process import run_tlc
from modeproof.tlc.toolchain import Toolchain, sha256

DUMMY = "<<>>"
"""Given to a constant that no operator asked for here depends on."""
AT_ONCE = "TLCEval"
"""TLC's operator that evaluates a value whole. TLC keeps the constants of a module that it checks, but
evaluates those of an instance whenever they are asked for: whole then costs more than what is asked for.
"""
SHADOW = "d_"
"""Before the name of a variable of the decided device."""
HEAP_MB = 512
LIMIT_S = 300
_INTERVAL = re.compile(r"(-?\d+)\.\.(-?\d+)")


@dataclass(frozen=True)
class Recorded:
    """One counterexample as the evidence holds it: the variables of every state as TLA+ text."""

    run: str
    module: str
    cfg: str
    states: tuple[Mapping[str, str], ...]
    digest: str
    stops: bool = False
    """Whether nothing happens any more after the last state."""


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
        stops=result.get("loop") == "stuttering",
    )


def walk_path(place: Path, document: str, run: str) -> Path:
    """Where the walk of a run lies."""
    return build(place) / "walks" / document / f"{run}.json"


def spec_hashes(place: Path, document: str) -> dict[str, str]:
    """The hashes of every module, of the register and of this file, which a walk depends on."""
    folder = place / "spec" / document
    common = (place / "spec" / "common").glob("*.tla")
    found = evidence.hashes(place, sorted([*folder.glob("*.tla"), *common, folder / "replay.toml"]))
    return {**found, "modeproof/tlc/walk.py": sha256(Path(__file__))}


def read_walk(place: Path, document: str, one: Recorded) -> dict[str, Any] | None:
    """The walk of a run if there is one of this very trace and specification, else None."""
    try:
        walk = json.loads(walk_path(place, document, one.run).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    current = isinstance(walk, dict) and walk.get("trace_sha256") == one.digest
    return walk if current and walk.get("inputs") == spec_hashes(place, document) else None


def walk_all(
    place: Path, document: str, traces: Sequence[Recorded], tools: Toolchain
) -> dict[str, dict[str, Any]]:
    """The walks of these counterexamples, by run; TLC is started once for each top module that has a new one.

    Raises Unjudged when TLC cannot follow a trace (evidence of another specification), and then writes
    nothing.
    """
    found = {one.run: read_walk(place, document, one) for one in traces}
    plan = load_replay(place, document)
    modules = read_modules(place, document)
    groups: dict[tuple[str, tuple[tuple[str, str], ...]], list[Recorded]] = {}
    for one in traces:
        if found[one.run] is None:
            constants = parse_cfg(read_text(place, place / one.cfg), one.cfg).constants
            groups.setdefault((one.module, replaced(modules, one.module, constants)), []).append(one)
    for (module, definitions), missing in groups.items():
        found |= _walk(place, document, plan, module, definitions, missing, tools)
    return {run: walk for run, walk in found.items() if walk is not None}


# ------------------------------------------------------------------------------------------- what to generate


def extended(modules: Mapping[str, Module], name: str) -> tuple[Module, ...]:
    """A module of ours and all that it extends."""
    reached: dict[str, Module] = {}
    waiting = [name]
    while waiting:
        one = waiting.pop()
        if one in modules and one not in reached:
            reached[one] = modules[one]
            waiting += modules[one].extends
    return tuple(reached.values())


def _names(modules: Sequence[Module], kind: str) -> tuple[str, ...]:
    return tuple(sorted({name for module in modules for name in getattr(module, kind)}))


def replaced(
    modules: Mapping[str, Module], name: str, constants: Mapping[str, Constant]
) -> tuple[tuple[str, str], ...]:
    """The definitions that a cfg replaces by others: what it gives to names that are no constants."""
    declared = _names(extended(modules, name), "constants")
    return tuple(sorted((key, one.text) for key, one in constants.items() if key not in declared))


@dataclass(frozen=True)
class Plan:
    """What the generated module of one top module is made from."""

    document: str
    module: str
    top: Top
    traces: Traces
    interface: Interface
    modules: Mapping[str, Module]

    @property
    def variables(self) -> tuple[str, ...]:
        """The variables of the top module."""
        return _names(extended(self.modules, self.module), "variables")

    @property
    def replayed(self) -> tuple[Device, ...]:
        """The devices whose scans can be replayed."""
        return tuple(self.interface.devices[name] for name in self.top.inputs)

    def shadows(self, device: Device) -> tuple[str, ...]:
        """The variables of a device's module."""
        return _names(extended(self.modules, device.module), "variables")

    @property
    def all_shadows(self) -> tuple[str, ...]:
        """The variables of all replayed devices."""
        return tuple(sorted({name for device in self.replayed for name in self.shadows(device)}))

    def who(self, before: Mapping[str, str], after: Mapping[str, str]) -> str:
        """The device that executed a step, by the step's name, else by the variables that changed; or ""."""
        name = after.get(self.traces.step, "").strip('"')
        for device in self.interface.devices.values():
            if name and name in device.steps:
                return device.id
        if name in self.traces.nobody:
            return ""
        changed = {key for key in after if before.get(key) != after[key]}
        own = [
            device.id
            for device in self.interface.devices.values()
            if device.module in self.modules and changed & self.modules[device.module].variables
        ]
        return own[0] if len(own) == 1 else ""


def generate(
    plan: Plan,
    traces: Sequence[tuple[Recorded, Mapping[str, Constant]]],
    definitions: Sequence[tuple[str, str]] = (),
) -> str:
    """The text of the module that walks through the traces of one top module; `definitions` are those that
    every cfg replaces, each with what takes its place.
    """
    name = module_name(plan.module)
    shadows = [SHADOW + one for one in plan.all_shadows]
    lines = [
        f"---- MODULE {name} ----",
        "EXTENDS Integers, Sequences, TLC",
        f"VARIABLES walk_run, walk_at, walk_device, walk_from, {', '.join((*plan.variables, *shadows))}",
        "",
    ]
    firsts, nexts, tables = [], [], []
    for number, (one, constants) in enumerate(traces, 1):
        lines += _instances(plan, number, one, constants, named=bool(definitions) and number == 1)
        lines += _states(plan, number, one)
        first, following = _behaviour(plan, number, one, constants)
        lines += following
        firsts.append(first)
        nexts.append(f"Follow{number}")
        if one.stops:
            lines += _after(plan, number, len(one.states))
            nexts.append(f"After{number}")
    for words in plan.traces.words:
        table = f"L1!{words.table}"
        tables.append(
            f'PrintT(ToString(<<"TABLE", "{words.table}", {{<<k, {table}[k]>> : k \\in DOMAIN {table}}}>>))'
        )
    lines += [
        *[f"{replacement(old)} == A1!{new}" for old, new in definitions],
        f"{replacement(AT_ONCE)}(value) == value",
        "Begin ==",
        *[f"    \\/ {one}" for one in firsts],
        "Follow ==",
        *[f"    \\/ {one}" for one in nexts],
        "Shown ==",
        '    walk_device = "" => PrintT(ToString(<<"ROW", walk_run, walk_at, CASE '
        + " [] ".join(f"walk_run = {n} -> L{n}!{plan.top.wires}" for n in range(1, len(traces) + 1))
        + ">>))",
        "ASSUME " + " /\\ ".join(["TRUE", *tables]),
        "====",
        "",
    ]
    return "\n".join(lines)


def module_name(module: str) -> str:
    """The name of the generated module."""
    return f"Walk_{module}"


def replacement(name: str) -> str:
    """The name in the generated module of what takes the place of a definition."""
    return f"walk_{name}"


def _instances(
    plan: Plan, number: int, one: Recorded, constants: Mapping[str, Constant], named: bool
) -> list[str]:
    """The top module with the constants of one run, and each device with no reading restored.

    TLC evaluates the constants of every instance at its start, so there is none that is not used: A where a
    constant has the value of one of the module's own names (`named`: also where a definition has), G where
    it is asked what the decided system does after the last state.
    """

    def given(modules: Sequence[Module], last: bool, decided: bool = False) -> list[str]:
        parts = []
        for name in _names(modules, "constants"):
            constant = constants.get(name)
            if decided and name == plan.traces.literal:
                value = "{}"
            elif name == plan.traces.recorded:
                value = "TRUE"
            elif constant is None:
                value = DUMMY
            elif constant.named:
                value = f"A{number}!{constant.text}" if last else DUMMY
            else:
                value = constant.text
            parts.append(f"{name} <- {value}")
        return parts

    whole = extended(plan.modules, plan.module)
    instances = {"L": given(whole, last=True)}
    if named or any(one.named for one in constants.values()):
        instances = {"A": given(whole, last=False), **instances}
    if one.stops:
        instances["G"] = given(whole, last=True, decided=True)
    lines = [
        f"{letter}{number} == INSTANCE {plan.module} WITH {', '.join(parts)}"
        for letter, parts in instances.items()
    ]
    for device in plan.replayed:
        parts = given(extended(plan.modules, device.module), last=True, decided=True)
        parts += [f"{name} <- {SHADOW}{name}" for name in plan.shadows(device)]
        lines.append(f"D{number}_{device.id} == INSTANCE {device.module} WITH {', '.join(parts)}")
    return lines


def _states(plan: Plan, number: int, one: Recorded) -> list[str]:
    rows = []
    for state in one.states:
        missing = [name for name in plan.variables if name not in state]
        if missing:
            raise Unjudged(
                f"{one.run}: its counterexample has no variable {missing[0]}, so it is of another "
                "specification; "
                f"run modeproof check {one.run}"
            )
        rows.append("[" + ", ".join(f"{name} |-> {state[name]}" for name in plan.variables) + "]")
    return [f"T{number} == <<", ",\n".join(f"    {row}" for row in rows), ">>"]


def _behaviour(
    plan: Plan, number: int, one: Recorded, constants: Mapping[str, Constant]
) -> tuple[str, list[str]]:
    """The first states of a walk, and its steps."""
    turn = {
        device.id: [
            n + 1 for n in range(1, len(one.states)) if plan.who(*one.states[n - 1 : n + 1]) == device.id
        ]
        for device in plan.replayed
    }
    starts = ['<<"", 0>>']
    starts += [f'<<"{device.id}", {at}>>' for device in plan.replayed for at in turn[device.id]]
    first = [f"walk_run = {number} /\\ walk_at = 1"]
    first.append(
        f"(\\E start \\in {{{', '.join(starts)}}} : walk_device = start[1] /\\ walk_from = start[2])"
    )
    first += [f"{name} = T{number}[1].{name}" for name in plan.variables]
    first += [f"{SHADOW}{name} = T{number}[1].{name}" for name in plan.all_shadows]
    given = constants.get(plan.traces.recorded)
    computed = () if given is None or given.text == "TRUE" else (plan.traces.step, *plan.traces.with_step)
    kept = [name for name in plan.variables if name not in computed]
    lines = [
        f"Follow{number} ==",
        f"    /\\ walk_run = {number} /\\ walk_at < {len(one.states)}",
        "    /\\ walk_at' = walk_at + 1 /\\ UNCHANGED <<walk_run, walk_device, walk_from>>",
        *[f"    /\\ {name}' = T{number}[walk_at + 1].{name}" for name in kept],
    ]
    # The recorded states are steps of the specification still; where the step was not recorded, this
    # finds it.
    allowed = f"L{number}!{plan.top.next}"
    lines.append(
        f"    /\\ {allowed}" if computed else f'    /\\ IF walk_device = "" THEN {allowed} ELSE TRUE'
    )
    step = plan.traces.step
    lines.append(f'    /\\ walk_device = "" => PrintT(ToString(<<"STEP", {number}, walk_at\', {step}\'>>))')

    def follow(names: Sequence[str]) -> str:
        return " /\\ ".join(f"{SHADOW}{name}' = {name}'" for name in names) or "TRUE"

    for device in plan.replayed:
        own = plan.shadows(device)
        state = ", ".join(SHADOW + name for name in own)
        outputs = f"D{number}_{device.id}!{plan.traces.devices[device.id].outputs}"
        lines += [
            f'    /\\ IF walk_device # "{device.id}" THEN TRUE',
            f"        ELSE IF walk_at' < walk_from THEN {follow(plan.all_shadows)}",
            f"        ELSE IF walk_at' \\in {{{', '.join(map(str, turn[device.id]))}}}",
            f"        THEN LET read == L{number}!{plan.top.inputs[device.id]} IN",
            f"             /\\ D{number}_{device.id}!{plan.traces.devices[device.id].scan}(read)",
            f"             /\\ {follow([name for name in plan.all_shadows if name not in own])}",
            f'             /\\ PrintT(ToString(<<"SCAN", {number}, "{device.id}", walk_from, walk_at\', '
            f"<<{state}>>, "
            f"<<{state}>>', {SHADOW}{step}', {outputs}', read>>))",
            f"        ELSE UNCHANGED <<{', '.join(SHADOW + name for name in plan.all_shadows)}>>",
        ]
    lines.append(f'    /\\ IF walk_device = "" THEN {follow(plan.all_shadows)} ELSE TRUE')
    return "(" + " /\\ ".join(first) + ")", lines


def _after(plan: Plan, number: int, last: int) -> list[str]:
    """What can happen in the last state with no reading restored, where the recorded system does nothing."""
    shadows = ", ".join(SHADOW + name for name in plan.all_shadows)
    own = ", ".join(name for name in plan.all_shadows if name != plan.traces.step)
    printed = f'PrintT(ToString(<<"AFTER", {number}, {plan.traces.step}\'>>))'
    return [
        f"After{number} ==",
        f'    /\\ walk_run = {number} /\\ walk_at = {last} /\\ walk_device = ""',
        "    /\\ walk_at' = walk_at + 1 /\\ UNCHANGED <<walk_run, walk_device, walk_from>>",
        f"    /\\ G{number}!{plan.top.next} /\\ UNCHANGED <<{shadows}>>",
        f"    /\\ <<{own}>>' # <<{own}>> => {printed}",
    ]


# ----------------------------------------------------------------------------------------------- carry it out


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
    given = [(one, parse_cfg(read_text(place, place / one.cfg), one.cfg).constants) for one in missing]
    folder = build(place) / "walk" / document / module
    shutil.rmtree(folder, ignore_errors=True)
    name = module_name(module)
    text, cfg = generate(plan, given, definitions), "INIT Begin\nNEXT Follow\nINVARIANT Shown\n"
    for old, _ in definitions:
        owner = next((one.name for one in extended(plan.modules, module) if old in one.defined), module)
        cfg += f"CONSTANT {old} <- [{owner}]{replacement(old)}\n"
    for used in extended(plan.modules, module):
        if AT_ONCE in used.words:
            cfg += f"CONSTANT {AT_ONCE} <- [{used.name}]{replacement(AT_ONCE)}\n"
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
    for number, one in enumerate(missing, 1):
        walk = _read(plan, number, one, lines)
        walk |= {"run": one.run, "trace_sha256": one.digest, "inputs": hashes}
        walks[one.run] = walk
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
        return sorted((_plain(one) for one in value), key=repr)
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    return value


def _read(plan: Plan, number: int, one: Recorded, lines: Sequence[tuple[Any, ...]]) -> dict[str, Any]:
    wires = {line[2]: line[3] for line in lines if line[:2] == ("ROW", number)}
    steps: dict[int, str] = {}
    for line in lines:
        if line[:2] == ("STEP", number):
            steps.setdefault(line[2], line[3])
    rows = []
    for at, state in enumerate(one.states, 1):
        if at not in wires or (at > 1 and at not in steps):
            raise Unjudged(
                f"{one.run}: the specification does not allow state {at} of its counterexample any more; "
                f"run modeproof check {one.run}"
            )
        variables = {name: _plain(parse(_spelled(state[name]))) for name in plan.variables}
        step = steps.get(at, "")
        who = plan.who(one.states[at - 2], {**state, plan.traces.step: f'"{step}"'}) if at > 1 else ""
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
        line = next((one for one in options if one[7] == rows[at - 1]["step"]), options[0])
        state = line[6]
        yield {
            "at": at,
            "step": line[7],
            "memory": {name: _plain(value) for name, value in zip(names, line[6], strict=True)},
            "outputs": _plain(line[8]),
            "read": _plain(line[9]),
        }


def _departs(plan: Plan, device: Device, scan: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> bool:
    """Whether one scan of the decided device, from the recorded memory, is another than the recorded one."""
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
