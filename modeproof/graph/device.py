"""The graph of an OPEN_ run together with what the registers say about its device: names, types, times."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from modeproof.graph.classes import Copied, InputClass, load_classes, load_copied
from modeproof.graph.graph import Graph
from modeproof.graph.read import read_graph
from modeproof.graph.values import ValueForms
from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.meaning import reached
from modeproof.ground.places import build
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device
from modeproof.registers.runs import Run, load_runs
from modeproof.tlc.rests import inputs_of, row_of, why_stale

TIME = "dt"
"""The field of an INPUT line that holds the time since the scan before, in ticks."""


@dataclass(frozen=True)
class DeviceGraph:
    """A graph whose values are in Python form.

    `alphabet` holds for each input of the graph the values of all inputs and `dt_ms`; `rows` for each state
    the outputs that depend on the state alone; `passed` names the output that repeats an input of the same
    scan; `params` are wire values, as the run declares them; `place` is where the document's room is;
    `tick_ms` is the length of a tick in the model.
    """

    document: str
    run: str
    device: Device
    forms: ValueForms
    graph: Graph
    alphabet: tuple[Mapping[str, Any], ...]
    rows: tuple[Mapping[str, Any], ...]
    passed: Mapping[str, str]
    params: Mapping[str, Any]
    classes: tuple[InputClass, ...]
    copied: Copied | None = None
    place: Path | None = None
    tick_ms: int = 1

    @property
    def name(self) -> str:
        """The run's name across documents."""
        return f"{self.document}/{self.run}"

    @property
    def codes(self) -> tuple[str, ...]:
        """The outputs whose values the document does not give."""
        return tuple(name for name, of in self.device.outputs.items() if of.project)

    @cached_property
    def seen(self) -> tuple[tuple[tuple[str, Any], ...], ...]:
        """For each state the outputs by which states may be told apart: those that every judge compares."""
        outputs = self.device.outputs
        return tuple(
            tuple(sorted((name, value) for name, value in row.items() if not outputs[name].project))
            for row in self.rows
        )

    def expected(self, state: int, values: Mapping[str, Any]) -> dict[str, Any]:
        """All outputs (Python form) after a scan with input `values` that ended in `state`."""
        row = self.rows[state]
        return {
            name: values[self.passed[name]] if name in self.passed else row[name]
            for name in self.device.outputs
        }

    def wire_inputs(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The inputs of a scan on the wire, without `dt_ms`."""
        return {name: self.forms.to_wire(of, values[name]) for name, of in self.device.inputs.items()}

    def wire_outputs(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Outputs on the wire."""
        return {name: self.forms.to_wire(of, values[name]) for name, of in self.device.outputs.items()}


def open_runs(place: Path, document: str, device: str | None = None) -> tuple[Run, ...]:
    """The OPEN_ runs of a document, or of one of its devices."""
    return tuple(
        run
        for run in load_runs(place, document)
        if run.graph is not None and device in (None, run.graph.device)
    )


def graph_file(place: Path, run: Run) -> Path:
    """Where the TLC runner leaves the printed lines of an OPEN_ run."""
    return build(place) / "graphs" / run.document / f"{run.id}.txt"


def current_graph(place: Path, run: Run) -> Path:
    """The same file. Raises Unjudged when it does not hold the graph of the specification as it is now."""
    if why := why_stale(place, run):
        raise Unjudged(f"{run.name}: no graph of the present text: {why}; run modeproof check {run.id}")
    return graph_file(place, run)


COMPARED_BY = ("modeproof/suites/conform_command.py",)
"""The module that compares a graph with an implementation."""


def compared_rests(place: Path, run: Run, package: str) -> evidence.Rests:
    """What a comparison of this run's graph with an implementation in `package` rests on.

    Raises Unjudged when a file is missing.
    """
    folder = place / "spec" / run.document
    registers = [path for path in [folder / "interface.toml"] if path.is_file()]
    assert run.graph is not None
    code = reached(place, f"{package}/{run.document}/{run.graph.device}.py")
    inputs = evidence.hashes(place, [*code, *registers, graph_file(place, run)])
    return evidence.Rests({**inputs_of(place, run), **inputs}, COMPARED_BY, said=row_of(run))


def load_device_graph(place: Path, run: Run) -> DeviceGraph:
    """Read and check the graph of an OPEN_ run.

    Raises Unjudged when there is none of the specification as it is now, and as `read_device_graph` does.
    """
    current_graph(place, run)
    return read_device_graph(place, run)


def read_device_graph(place: Path, run: Run) -> DeviceGraph:
    """The same, whatever text the graph was made from.

    Raises Unjudged when the graph is not there or not complete (see `read_graph`), or when its names and
    values are not those of interface.toml.
    """
    if run.graph is None:
        raise Unjudged(f"{run.name} prints no graph")
    path = graph_file(place, run)
    interface = load_interface(place, run.document)
    device = interface.devices.get(run.graph.device)
    if device is None:
        raise Unjudged(f"{run.name}: no device {run.graph.device!r} in interface.toml")
    graph = read_graph(path, states=run.graph.states, edges=run.graph.edges)
    forms = ValueForms([int(mode) for mode in interface.constants.get("MODES", ())])
    return join(
        run.document,
        run.id,
        device,
        forms,
        graph,
        tick_ms=run.graph.tick_ms,
        params=run.graph.params,
        passed=run.graph.passed,
        place=place,
    )


def join(
    document: str,
    run: str,
    device: Device,
    forms: ValueForms,
    graph: Graph,
    *,
    tick_ms: int,
    params: Mapping[str, Any],
    passed: Mapping[str, str],
    place: Path | None = None,
) -> DeviceGraph:
    """Put a graph and the declared names together. Raises Unjudged where they do not fit."""
    source = graph.source
    for output, given in passed.items():
        if output not in device.outputs or given not in device.inputs:
            raise Unjudged(f"{source}: pass: {output} = {given!r}: no such output or input")
    _same_names(source, "INPUT", set(graph.inputs[0]), {*device.inputs, TIME})
    _same_names(source, "STATE", set(graph.outputs[0]), set(device.outputs) - set(passed))
    for step in graph.steps:
        if step not in device.steps:
            raise Unjudged(f"{source}: step {step!r} is not declared for {device.id}")
    alphabet = []
    for number, letter in zip(graph.input_numbers, graph.inputs, strict=True):
        where = f"{source}: input {number}"
        ticks = letter[TIME]
        if type(ticks) is not int or ticks < 0:
            raise Unjudged(f"{where}: {TIME} must be a number of ticks, not {ticks!r}")
        values = {name: forms.from_tla(of, letter[name], where) for name, of in device.inputs.items()}
        alphabet.append({"dt_ms": ticks * tick_ms, **values})
    rows = []
    for view, row in zip(graph.views, graph.outputs, strict=True):
        where = f"{source}: state {view}"
        rows.append({name: forms.from_tla(device.outputs[name], row[name], where) for name in row})
    return DeviceGraph(
        document=document,
        run=run,
        device=device,
        forms=forms,
        graph=graph,
        alphabet=tuple(alphabet),
        rows=tuple(rows),
        passed=dict(passed),
        params=dict(params),
        classes=() if place is None else load_classes(place, document, device.id, alphabet),
        copied=None if place is None else load_copied(place, document, device.id, alphabet),
        place=place,
        tick_ms=tick_ms,
    )


def _same_names(source: str, kind: str, printed: set[str], declared: set[str]) -> None:
    for name in sorted(printed - declared):
        raise Unjudged(f"{source}: {kind} lines have a field {name!r} that interface.toml does not declare")
    for name in sorted(declared - printed):
        raise Unjudged(f"{source}: {kind} lines lack {name!r}")
