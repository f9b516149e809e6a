"""The two profiles of a document: named sets of values of its parameters.

`letter` is the defaults: what the words say, in their order, wherever that can work. `cautious` is what we
recommend: the value `cautious` of each parameter that has one, the defaults else. A time that chooses is in
the profile `letter` with its default alone, and with any other value in `cautious`, for the machine gives it.
Of which profile a run is, is not declared: it follows from the constants of its cfg.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.registers.load import load_interface
from modeproof.registers.made import read_cfg
from modeproof.registers.rows import Device, Document, Finding, Interface, Problem, Property, Signal
from modeproof.registers.runs import Run

LETTER, CAUTIOUS = "letter", "cautious"
PROFILES = (LETTER, CAUTIOUS)
NEITHER = "neither"
"""What a run is that mixes the two, or has another value."""
_CHOICES = ("text", "bool")
"""Types of the parameters that choose between readings, whatever their values."""
_TIME = "ms"


def value_in(signal: Signal, profile: str) -> Any:
    """The value of a parameter in a profile, as TOML has it."""
    return signal.cautious if profile == CAUTIOUS and signal.cautious is not None else signal.default


def choices_of(device: Device) -> dict[str, Signal]:
    """The parameters of a device that choose between readings, and those that are our own."""
    return {
        name: signal
        for name, signal in device.parameters.items()
        if signal.default is not None
        and (signal.type in _CHOICES or signal.project or signal.cautious is not None)
    }


def is_in(signal: Signal, profile: str, value: Any) -> bool:
    """Whether a value of a parameter, as TOML has it, is that of a profile."""
    other = signal.type == _TIME and signal.cautious is not None and profile == CAUTIOUS
    return bool(value != signal.default if other else value == value_in(signal, profile))


def profiles_with(device: Device, values: Mapping[str, Any]) -> list[str]:
    """The profiles of a device that parameters with these values belong to."""
    chosen = {name: signal for name, signal in choices_of(device).items() if name in values}
    return [
        profile
        for profile in PROFILES
        if all(is_in(signal, profile, values[name]) for name, signal in chosen.items())
    ]


def profiles_of(device: Device) -> dict[str, dict[str, Any]]:
    """Of each profile what each choice of a device is; nothing where they are the same."""
    chosen = choices_of(device)
    if all(signal.cautious is None for signal in chosen.values()):
        return {}
    return {
        profile: {name: value_in(signal, profile) for name, signal in chosen.items()} for profile in PROFILES
    }


def choices(interface: Interface) -> dict[str, Signal]:
    """The choices of all devices by their names in the specification; its sets of modes are operators."""
    return {
        signal.tla: signal
        for device in interface.devices.values()
        for signal in choices_of(device).values()
        if signal.type != "modes"
    }


def differing(interface: Interface) -> dict[str, Signal]:
    """Those in which the profiles differ; none where a document has one profile only."""
    return {name: signal for name, signal in choices(interface).items() if signal.cautious is not None}


def profile_of(root: Path, run: Run, interface: Interface) -> str:
    """The profile of a run; empty where the document has no two, or the run has no choice to make.

    Raises Unjudged where the cfg cannot be read.
    """
    if not differing(interface):
        return ""
    given = {name: constant.text for name, constant in read_cfg(root, run).constants.items()}
    asked = {name: signal for name, signal in choices(interface).items() if name in given}
    if not asked:
        return ""
    printed = run.graph
    of_graph = (
        PROFILES if printed is None else profiles_with(interface.devices[printed.device], printed.params)
    )
    fits = (
        profile
        for profile in PROFILES
        if profile in of_graph
        and all(is_in(signal, profile, _value(given[name])) for name, signal in asked.items())
    )
    return next(fits, NEITHER)


def _value(text: str) -> Any:
    """A constant of a cfg, as TOML has the value of a choice."""
    if text.isdigit():
        return int(text)
    return text == "TRUE" if text in ("TRUE", "FALSE") else text.strip('"')


def strength_of(root: Path, run: Run) -> str:
    """The bounds of a run, after the profile that it speaks of. Raises Unjudged like `profile_of`."""
    if not (root / "spec" / run.document / "interface.toml").is_file():
        return run.strength
    profile = profile_of(root, run, load_interface(root, run.document))
    return f"profile {profile}; {run.strength}" if profile else run.strength


def rows_of(document: Document) -> Iterator[tuple[Signal, Finding]]:
    """Each choice of a document with the finding that it belongs to, in the order of the interface."""
    by_parameter = {finding.parameter: finding for finding in document.findings if finding.parameter}
    for name, signal in choices(document.interface).items():
        if name in by_parameter:
            yield signal, by_parameter[name]


def check_profiles(document: Document, value_fault: Callable[[Signal, object], str]) -> Iterator[Problem]:
    """Each difference has a finding, a reason and a counterexample; each property, its profiles."""
    file = document.source("interface")
    shown = {signal.name: finding for signal, finding in rows_of(document)}
    negatives = {run.id for run in document.runs if run.kind == "NEG"}
    for device in document.interface.devices.values():
        for signal in device.parameters.values():
            place = f"devices.{device.id}.parameters.{signal.name}"
            if signal.cautious is None:
                continue
            if fault := value_fault(signal, signal.cautious):
                yield Problem(file, place, f"cautious {signal.cautious!r} {fault}")
            elif signal.cautious == signal.default:
                yield Problem(file, place, "cautious is the default; leave it out")
            elif signal.type not in (*_CHOICES, _TIME):
                kinds = ", ".join((*_CHOICES, _TIME))
                yield Problem(file, place, f"cautious belongs to {kinds}, not to {signal.type}")
            elif signal.name not in shown:
                yield Problem(file, place, f"no finding has parameter = {signal.tla!r}")
            elif not signal.because:
                yield Problem(file, place, "cautious differs, and `because` does not say why")
            elif not negatives & set(shown[signal.name].evidence):
                cause = f"no counterexample is evidence of {shown[signal.name].id}"
                yield Problem(file, place, f"cautious differs, and {cause}")
    yield from _properties(document)


def _properties(document: Document) -> Iterator[Problem]:
    if not differing(document.interface):
        return
    of = {run.id: profile_of(document.root, run, document.interface) for run in document.runs}
    for prop in document.properties:
        runs = [
            run
            for run in document.runs
            if prop.tla in run.properties and run.kind != "NEG" and not run.readings
        ]
        have = {of[run.id] for run in runs}
        for profile in prop.profiles:
            if runs and not have & {profile, ""}:
                yield Problem(
                    document.source("properties"), prop.id, f"no run checks it in the profile {profile}"
                )
        if prop.profiles == (CAUTIOUS,) and not _falls(document, prop, of):
            text = "is of the profile cautious alone, and no counterexample shows that the letter breaks it"
            yield Problem(document.source("properties"), prop.id, text)
        odd: Sequence[str] = [p for p in PROFILES if p in have and p not in prop.profiles]
        if odd:
            text = f"holds in the profile {odd[0]} too, by a run; leave `profiles` out"
            yield Problem(document.source("properties"), prop.id, text)


def _falls(document: Document, prop: Property, of: Mapping[str, str]) -> bool:
    """Whether a counterexample of what was decided, and not of the profile cautious, breaks a property, or is
    evidence of a finding that the property names.
    """
    shown = {id for one in document.findings if one.id in prop.findings for id in one.evidence}
    return any(
        run.property == prop.tla or run.id in shown
        for run in document.runs
        if run.kind == "NEG" and not run.readings and of[run.id] != CAUTIOUS
    )
