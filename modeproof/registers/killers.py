"""What breaks each property: spec/<document>/killers.toml, and the negatives that try a reading.

A property that no device could break says nothing. So each has a fault of a device's specification that makes
it fall: a negative whose reading replaces one operator of a device, or one edit (`[[killer.PROPERTY]]`).
Where neither can be, a row says why (`[by_construction]`). `modeproof renew` judges the edits and writes a
stamp for each to pins.toml: a hash of the edit, the text that it edits, and the text of the property.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.citations import Sources
from modeproof.registers.edits import applied, check_stamps
from modeproof.registers.files import read_text, read_toml
from modeproof.registers.made import cfg_text, replaced_by
from modeproof.registers.pins import checked_texts, digest
from modeproof.registers.rows import Document, Problem, Property
from modeproof.registers.runs import ASKING, Run
from modeproof.registers.tla import Module, closure
from modeproof.registers.typed import Entry, Name, RunId, Text, grouped, only_keys, typed


class Killer(Entry, frozen=True, kw_only=True):
    """One edit of a device's specification, and the property that it breaks.

    `run` gives the model and its bounds, where no entry of `[bounds]` has this name; `in` a module the text
    `old`, which is there once, becomes `new`. `slip` says what the programmer did wrong.
    """

    property: Name
    run: Name
    module: Name = msgspec.field(name="in")
    old: Text
    new: str
    slip: str = ""


class Bounds(Entry, frozen=True, kw_only=True):
    """A run whose bounds are smaller: other constants, and another root module that extends its own."""

    run: RunId
    root: Name | None = None
    constants: dict[Name, Text] = msgspec.field(default_factory=dict)


@dataclass(frozen=True)
class Killers:
    """The file. `edits` are by their names: the property, with a number from its second edit on."""

    edits: Mapping[str, Killer]
    bounds: Mapping[str, Bounds]
    by_construction: Mapping[str, str]
    """Properties that no edit of a device breaks, and why they are kept all the same."""


@dataclass(frozen=True)
class Falls:
    """What breaks a property: the negatives and the edits, by name; or why it cannot."""

    negatives: tuple[str, ...]
    edits: tuple[str, ...]
    reason: str

    @property
    def kind(self) -> str:
        """The first that applies: negative, edit, by construction; nothing."""
        kinds = {"negative": self.negatives, "edit": self.edits, "by construction": self.reason}
        return next((kind for kind, found in kinds.items() if found), "nothing")


def load_killers(root: Path, document: str) -> Killers:
    """The killers of a document; none where it has no such file. Raises Unjudged like `load_document`."""
    file = f"spec/{document}/killers.toml"
    if not (root / file).is_file():
        return Killers({}, {}, {})
    data = read_toml(root, root / file)
    only_keys(file, data, ("document", "bounds", "killer", "by_construction"))
    if data.get("document", document) != document:
        raise Unjudged(f"{file}: document is not the name of its folder, {document!r}")
    edits: dict[str, Killer] = {}
    for row in grouped(file, data, "killer", "property"):
        killer = typed(Killer, row, f"{file}: killer.{row['property']}")
        same = sum(other.property == killer.property for other in edits.values())
        edits[killer.property + (f"_{same + 1}" if same else "")] = killer
    bounds = typed(dict[Name, Bounds], data.get("bounds", {}), f"{file}: [bounds]")
    reasons = typed(dict[Name, Text], data.get("by_construction", {}), f"{file}: [by_construction]")
    return Killers(edits, bounds, reasons)


def ways_to_fall(document: Document, sources: Sources) -> dict[str, Falls]:
    """For each property what breaks it, in the order of the register. Raises Unjudged like `load_killers`."""
    killers = load_killers(document.root, document.name)
    found: dict[str, Falls] = {}
    for prop in document.properties:
        negatives = [run.id for run in document.runs if _is_killer(document, sources.modules, run, prop)]
        edits = [name for name, killer in killers.edits.items() if killer.property == prop.id]
        reason = killers.by_construction.get(prop.id, "")
        found[prop.id] = Falls(tuple(negatives), tuple(edits), reason)
    return found


def _is_killer(document: Document, modules: Mapping[str, Module], run: Run, prop: Property) -> bool:
    """Whether a negative of lane full breaks this property by one replaced operator of a device alone."""
    base = next((other for other in document.runs if other.id == run.base), run)
    more = run.constants or run.specification or base.kind not in ASKING
    if run.kind != "NEG" or run.property != prop.tla or more or "full" not in run.lanes:
        return False
    try:
        replaced = [replacement.replaced for replacement in replaced_by(modules, run)]
    except Unjudged:
        return False  # told elsewhere
    own = {name for module in _devices(document, modules, run.module) for name in module.defined}
    return len(replaced) == 1 and replaced[0] in own


def _devices(document: Document, modules: Mapping[str, Module], root: str) -> tuple[Module, ...]:
    """The modules of the devices that a model is made of, with all that they extend.

    A model without a device (a contract) is made of its own module.
    """
    names = {device.module for device in document.interface.devices.values()}
    there = [module.name for module in closure(modules, root) if module.name in names]
    found = {m.name: m for name in there or [root] for m in closure(modules, name, instances=False)}
    return tuple(found.values())


def check_killers(document: Document, sources: Sources) -> list[Problem]:
    """Every property that no fault breaks, and every row that is of no use or not judged."""
    file = document.source("killers")
    killers = load_killers(document.root, document.name)
    problems: list[Problem] = []
    for name, falls in ways_to_fall(document, sources).items():
        if falls.kind == "nothing":
            text = "is broken by nothing: give it an edit of a device in killers.toml, or say why none can be"
            problems.append(Problem(document.source("properties"), name, text))
        if falls.reason and (falls.negatives or falls.edits):
            text = f"is no property by construction: it is broken by {[*falls.negatives, *falls.edits][0]}"
            problems.append(Problem(file, name, text))
    known = [prop.id for prop in document.properties]
    for name in killers.by_construction:
        if name not in known:
            text = f"by construction: unknown property; {suggestion(name, known)}"
            problems.append(Problem(file, name, text))
    asked = {killer.run for killer in killers.edits.values()}
    spare = (name for name in killers.bounds if name not in asked)
    problems += [Problem(file, f"bounds.{name}", "no edit is judged within these bounds") for name in spare]
    stamps = stamps_of(document, sources, killers)
    return [*problems, *check_stamps(document, "killers", file, stamps)]


def edited(document: Document, sources: Sources, killers: Killers, killer: Killer) -> str:
    """The text of the module with the edit.

    Raises Unjudged like `run_of`; a module that is not the device's; a text that is not there once; an edit
    that is none, or of the definition of a property.
    """
    return _edit(document, sources, killers, killer)[0]


def _edit(document: Document, sources: Sources, killers: Killers, killer: Killer) -> tuple[str, str]:
    """The text with the edit, and that of the definitions that it edits."""
    root = run_of(document, killers, killer).module
    own = {module.name: module for module in _devices(document, sources.modules, root)}
    if killer.module not in own:
        raise Unjudged(f"edits {killer.module}, which is no device's; {suggestion(killer.module, own)}")
    module = own[killer.module]
    text = read_text(document.root, document.root / module.file)
    changed, first, last = applied(text, module.file, killer.old, killer.new)
    before = [definition for definition in module.definitions if definition.line <= first]
    if not before:
        raise Unjudged(f"edits {module.file} outside its definitions")
    touched = [before[-1], *(own for own in module.definitions if first < own.line <= last)]
    properties = {prop.tla for prop in document.properties}
    if asked := next((definition.name for definition in touched if definition.name in properties), ""):
        raise Unjudged(f"edits the property {asked} and not the device")
    return changed, "\n".join(definition.body for definition in touched)


def run_of(document: Document, killers: Killers, killer: Killer) -> Run:
    """The run that must show that the property fails: the declared one, which asks for this property alone.

    Raises Unjudged: no such property or run; a run that is not of what was decided, or does not check it.
    """
    bounds = killers.bounds.get(killer.run, Bounds(run=killer.run) if _is_id(killer.run) else None)
    declared = {run.id: run for run in document.runs}
    if bounds is None or bounds.run not in declared:
        raise Unjudged(f"unknown run {killer.run!r}; {suggestion(killer.run, [*killers.bounds, *declared])}")
    run = declared[bounds.run]
    names = {prop.id: prop.tla for prop in document.properties}
    if killer.property not in names:
        raise Unjudged(f"unknown property; {suggestion(killer.property, names)}")
    tla = names[killer.property]
    if run.kind not in ("MC", "LIVE", "OPEN") or run.readings:
        raise Unjudged(f"{run.id} is no run of what was decided")
    if tla not in run.properties:
        raise Unjudged(f"{run.id} does not check {tla}; {suggestion(tla, run.properties)}")
    return msgspec.structs.replace(
        run,
        base=run.base or run.id,
        kind="LIVE" if run.kind == "LIVE" else "MC",
        module=bounds.root or run.module,
        constants={**run.constants, **bounds.constants},
        properties=(tla,),
        property="",
        deadlock=False,
        graph=None,
    )


def _is_id(name: str) -> bool:
    return name.startswith(("MC_", "LIVE_", "OPEN_"))


def stamps_of(document: Document, sources: Sources, killers: Killers) -> dict[str, str | Unjudged]:
    """For each edit a hash of what its judgement rests on, or why it cannot be judged.

    It rests on the edit, the definitions that it edits, the property with all that it refers to outside the
    steps of the devices, and the cfg. Another change of the device does not move it: the tests judge one edit
    in six again, and `--complete` all.
    """
    said = checked_texts(document, sources)
    found: dict[str, str | Unjudged] = {}
    for name, killer in killers.edits.items():
        try:
            body = _edit(document, sources, killers, killer)[1]
            run = run_of(document, killers, killer)
            words = (killer.module, killer.old, killer.new, body, said.get(run.properties[0], ""))
            found[name] = digest("\x00".join((*words, run.module, cfg_text(document.root, run))))
        except Unjudged as error:
            found[name] = error
    return found
