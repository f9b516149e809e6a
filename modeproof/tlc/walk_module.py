"""The module in which TLC walks through recorded counterexamples (modeproof/tlc/walk.py says what for)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.registers.cfg import Constant, parse_cfg
from modeproof.registers.files import read_text
from modeproof.registers.made import Replacement, replacing, root_module
from modeproof.registers.replay import Top, Traces
from modeproof.registers.rows import Device, Interface
from modeproof.registers.tla import WORD, Module, closure

DUMMY = "<<>>"
"""Given to a constant that no operator asked for here depends on."""
AT_ONCE = "TLCEval"
"""TLC's operator that evaluates a value whole. TLC keeps the constants of a module that it checks, but
evaluates those of an instance whenever they are asked for: whole then costs more than what is asked for.
"""
SHADOW = "d_"
"""Before the name of a variable of the decided device."""
_HEADS = re.compile(r"^-{4,}\s*MODULE\s+\w+|^EXTENDS\b(?:\s*\w+\s*,)*\s*\w+|\bINSTANCE\s+\w+", re.MULTILINE)
_INSTANCE = re.compile(r"\bINSTANCE\s+(\w+)")
"""Where a module names itself and others."""


@dataclass(frozen=True)
class Recorded:
    """One counterexample as the evidence holds it: the variables of every state as TLA+ text."""

    run: str
    module: str
    cfg: str
    states: tuple[Mapping[str, str], ...]
    digest: str
    readings: tuple[str, ...] = ()
    stops: bool = False
    """Whether nothing happens any more after the last state."""


def extended(modules: Mapping[str, Module], name: str) -> tuple[Module, ...]:
    """A module of ours and all that it extends."""
    return closure(modules, name, instances=False)


def constants_of(place: Path, modules: Mapping[str, Module], trace: Recorded) -> Mapping[str, Constant]:
    """The constants in the cfg of a run, without the operators of its readings."""
    tried = {each.replaced for each in replacing(modules, trace.module, trace.readings, trace.run)}
    given = parse_cfg(read_text(place, place / trace.cfg), trace.cfg).constants
    return {name: constant for name, constant in given.items() if name not in tried}


def _names(modules: Sequence[Module], kind: str) -> tuple[str, ...]:
    return tuple(sorted({name for module in modules for name in getattr(module, kind)}))


def replaced(
    modules: Mapping[str, Module], name: str, constants: Mapping[str, Constant]
) -> tuple[tuple[str, str], ...]:
    """The definitions that a cfg replaces by others: what it gives to names that are no constants."""
    declared = _names(extended(modules, name), "constants")
    return tuple(sorted((key, constant.text) for key, constant in constants.items() if key not in declared))


@dataclass(frozen=True)
class Copies:
    """What a run with readings needs of its own in the generated module, whose other runs have others.

    TLC replaces an operator in a module, not in one instance of it: so the modules that the replaced
    operators reach are there once more for each such run. `names` are the new ones of these modules, `root`
    is the text of a module that extends them.
    """

    number: int
    tried: tuple[Replacement, ...]
    names: Mapping[str, str]
    root: str

    def operator(self, replacing_operator: Replacement) -> str:
        """The name, in the generated module, of the operator that replaces another."""
        return f"walk{self.number}_{replacing_operator.replaced}"

    def texts(self, place: Path, modules: Mapping[str, Module]) -> Iterator[tuple[str, str]]:
        """The names and texts of the copied modules."""
        for old, new in self.names.items():
            yield new, _HEADS.sub(self._renamed, read_text(place, place / modules[old].file))

    def _renamed(self, head: re.Match[str]) -> str:
        return WORD.sub(lambda word: self.names.get(word.group(), word.group()), head.group())


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

    def further(self, trace: Recorded) -> tuple[str, ...]:
        """The variables that the modules of a run's readings have beside those of the top module."""
        holding = {each.module for each in replacing(self.modules, self.module, trace.readings, trace.run)}
        found = {name for each in holding for name in _names(extended(self.modules, each), "variables")}
        return tuple(sorted(found - set(self.variables)))

    def copies(self, number: int, trace: Recorded) -> Copies:
        """The modules of a run with readings, under names of their own."""
        tried = replacing(self.modules, self.module, trace.readings, trace.run)
        holding = dict.fromkeys(each.module for each in tried)
        whole = [module for each in (self.module, *holding) for module in extended(self.modules, each)]
        owners = {self.owner(each.replaced, each.module) for each in tried}
        names = {
            module.name: f"{module.name}__{number}"
            for module in whole
            if owners & {each.name for each in extended(self.modules, module.name)}
        }
        own = [replace(each, module=names[each.module]) for each in tried]
        root = f"{module_name(self.module)}__{number}"
        return Copies(number, tried, names, root_module(root, names[self.module], own) if tried else "")

    def owner(self, operator: str, module: str) -> str:
        """The module that defines an operator, among those that a module extends."""
        every = extended(self.modules, module)
        return next((candidate.name for candidate in every if operator in candidate.defined), module)

    def reached(self, every: Sequence[Copies]) -> tuple[str, ...]:
        """The modules that the top module and the readings that are tried extend."""
        holding = [each.module for copies in every for each in copies.tried]
        names = [module.name for each in (self.module, *holding) for module in extended(self.modules, each)]
        return tuple(dict.fromkeys(names))

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
        if name == self.traces.no_step and len(self.replayed) == 1:
            return self.replayed[0].id
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
    shadows = [SHADOW + shadow for shadow in plan.all_shadows]
    lines = [
        f"---- MODULE {name} ----",
        "EXTENDS Integers, Sequences, TLC",
        f"VARIABLES walk_run, walk_at, walk_device, walk_from, {', '.join((*plan.variables, *shadows))}",
        "",
    ]
    firsts, nexts, tables = [], [], []
    for number, (trace, constants) in enumerate(traces, 1):
        copies = plan.copies(number, trace)
        lines += _states(plan, number, trace)
        lines += _instances(plan, number, trace, constants, named=bool(definitions) and number == 1)
        for each in copies.tried:
            parameters = each.parameters
            lines.append(f"{copies.operator(each)}{parameters} == L{number}!{each.operator}{parameters}")
        first, following = _behaviour(plan, number, trace, constants)
        lines += following
        firsts.append(first)
        nexts.append(f"Follow{number}")
        if trace.stops:
            lines += _after(plan, number, len(trace.states))
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
        *[f"    \\/ {first}" for first in firsts],
        "Follow ==",
        *[f"    \\/ {following}" for following in nexts],
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
    plan: Plan, number: int, trace: Recorded, constants: Mapping[str, Constant], named: bool
) -> list[str]:
    """The top module with the constants of one run, and each device as it was decided.

    TLC evaluates the constants of every instance at its start, so there is none that is not used: A where a
    constant has the value of one of the module's own names (`named`: also where a definition has), G where
    it is asked what the decided system does after the last state.
    """

    def given(modules: Sequence[Module], last: bool) -> list[str]:
        parts = []
        for name in _names(modules, "constants"):
            constant = constants.get(name)
            if name == plan.traces.recorded:
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
    if named or any(constant.named for constant in constants.values()):
        instances = {"A": given(whole, last=False), **instances}
    if trace.stops:
        instances["G"] = given(whole, last=True)
    own = f"{module_name(plan.module)}__{number}" if trace.readings else plan.module
    at = f"T{number}[IF walk_at > {len(trace.states)} THEN {len(trace.states)} ELSE walk_at]"
    instances["L"] += [f"{name} <- {at}.{name}" for name in plan.further(trace)]
    lines = [
        f"{letter}{number} == INSTANCE {own if letter == 'L' else plan.module} WITH {', '.join(parts)}"
        for letter, parts in instances.items()
    ]
    for device in plan.replayed:
        parts = given(extended(plan.modules, device.module), last=True)
        parts += [f"{name} <- {SHADOW}{name}" for name in plan.shadows(device)]
        lines.append(f"D{number}_{device.id} == INSTANCE {device.module} WITH {', '.join(parts)}")
    return lines


def _states(plan: Plan, number: int, trace: Recorded) -> list[str]:
    rows = []
    names = (*plan.variables, *plan.further(trace))
    for state in trace.states:
        missing = [name for name in names if name not in state]
        if missing:
            raise Unjudged(
                f"{trace.run}: its counterexample has no variable {missing[0]}, so it is of another "
                "specification; "
                f"run modeproof check {trace.run}"
            )
        rows.append("[" + ", ".join(f"{name} |-> {state[name]}" for name in names) + "]")
    return [f"T{number} == <<", ",\n".join(f"    {row}" for row in rows), ">>"]


def _behaviour(
    plan: Plan, number: int, trace: Recorded, constants: Mapping[str, Constant]
) -> tuple[str, list[str]]:
    """The first states of a walk, and its steps."""
    turn = {
        device.id: [
            n + 1 for n in range(1, len(trace.states)) if plan.who(*trace.states[n - 1 : n + 1]) == device.id
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
        f"    /\\ walk_run = {number} /\\ walk_at < {len(trace.states)}",
        "    /\\ walk_at' = walk_at + 1 /\\ UNCHANGED <<walk_run, walk_device, walk_from>>",
        *[f"    /\\ {name}' = T{number}[walk_at + 1].{name}" for name in kept],
    ]
    # The recorded states must still be steps of the specification. This also finds a step that was not
    # recorded.
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
    """What can happen in the last state as decided, where the recorded system does nothing."""
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


def present(plan: Plan, text: str) -> frozenset[str]:
    """The modules of the specification that the generated text has under their own names."""
    instances = [name for name in _INSTANCE.findall(text) if name in plan.modules]
    return frozenset(module.name for name in instances for module in extended(plan.modules, name))


def everywhere(every: Sequence[Copies], operator: str, owner: str, there: frozenset[str]) -> str:
    """The lines of a cfg that replace an operator in the copies of a module, and in it if it is `there`."""
    places = [owner] if owner in there else []
    places += [copies.names[owner] for copies in every if owner in copies.names]
    return "".join(f"CONSTANT {operator} <- [{module}]{replacement(operator)}\n" for module in places)
