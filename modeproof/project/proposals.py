"""What `init` proposes: an entry for each program, wiring and log that fits, and a reason for all others."""

from __future__ import annotations

import itertools
import re
import tomllib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from machines.use import read_use
from machines.user_program import ProgramMachine
from machines.verdicts import Machine
from machines.wiring import Wiring, read_wiring
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, machines, root
from modeproof.kit.builtin import REFERENCE
from modeproof.kit.machine_reference import Wired
from modeproof.project.blocks import Fit, best_fit
from modeproof.project.entries import KINDS
from modeproof.project.found import Found
from modeproof.trace import machine_log
from modeproof.trace.lines import read_lines
from modeproof.trace.log import Log
from modeproof.trace.table import read_table
from modeproof.trace.targets import Target, targets_of
from programs.language.tree import Source, Unit
from programs.properties.property_file import Questions, read_questions
from programs.properties.transition_system import Cell
from programs.readers.sources import read_sources
from programs.semantics import document_blocks

LARGEST = 30_000_000
"""Bytes of a log that is read whole here."""


@dataclass(frozen=True)
class Proposal:
    """An entry: kind, name, keys with their values, what is said of it; `fit` where names differ."""

    kind: str
    name: str
    keys: dict[str, str | list[str]]
    said: str
    fit: Fit | None = None


@dataclass
class Proposals:
    """The entries, and what cannot be one. tell: what is looked at."""

    found: Found
    tell: Callable[[str], None] = field(default=lambda text: None)
    entries: list[Proposal] = field(default_factory=list)
    others: dict[str, str] = field(default_factory=dict)
    """By file, and unit, why it is not listed."""
    wirings: dict[str, Wiring] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)
    """Files of properties and uses that an entry has."""

    def make(self) -> None:
        """Find all of them."""
        self.others |= self.found.others
        for name in self.found.wirings:
            self.tell(name)
            self._wiring(name)
        for name in self.found.programs:
            self.tell(name)
            self._program(name)
        for name in self.found.logs:
            self.tell(name)
            self._log(name)
        self.entries.sort(key=lambda entry: [kind.KIND for kind in KINDS].index(entry.kind))
        for name in (*self.found.properties, *self.found.uses):
            if name not in self.used:
                what = "properties" if name in self.found.properties else "the use of a machine"
                self.others.setdefault(name, f"{what}: no program and no wiring here has all its names")

    def _add(
        self, kind: str, name: str, keys: dict[str, str | list[str]], said: str, fit: Fit | None = None
    ) -> None:
        bare = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-").lower()[:50] or kind
        taken = {entry.name for entry in self.entries}
        tries = itertools.chain([bare], (f"{bare}-{n}" for n in itertools.count(2)))
        unused = next(one for one in tries if one not in taken)
        self.entries.append(Proposal(kind, unused, keys, said, fit))

    def _path(self, name: str) -> Path:
        return self.found.folder / name

    # ------------------------------------------------------------ wirings

    def _wiring(self, name: str) -> None:
        try:
            wiring = read_wiring(self._path(name))
        except Unjudged as error:
            self.others[name] = f"a wiring that is refused: {self._short(error)}"
            return
        self.wirings[name] = wiring
        keys: dict[str, str | list[str]] = {"wiring": name, **self._beside(name, wiring)}
        of = "your properties" if "properties" in keys else "the published properties"
        self._add("machine", Path(name).stem, keys, f"a wiring, with {of}")

    def _beside(self, name: str, wiring: Wiring) -> dict[str, str]:
        """The files of properties and of use that are of this wiring."""
        keys: dict[str, str] = {}
        for other in self.found.uses:
            try:
                use = read_use(self._path(other))
            except Unjudged as error:
                self.others[other] = self._short(error)
                continue
            rows = [use.rest, use.follows, *(row for story in use.story for row in story["row"])]
            if {name for row in rows for name in row} & set(wiring.table.inputs):
                self._take(keys, "use", name, other)
        for other in self.found.properties:
            text = self._path(name).read_text("utf-8")
            machine = Machine(text, name, self._path(other), _shipped("use"))
            try:
                assert machine.questions
                assert machine.asked
            except Unjudged:
                continue
            self._take(keys, "properties", name, other)
        return keys

    def _take(self, keys: dict[str, str], key: str, name: str, file: str) -> None:
        self.used.add(file)
        if (first := keys.setdefault(key, file)) != file:
            self.others[file] = f"of {name} as well; its entry has {first}, and you may write this one there"

    # ------------------------------------------------------------ programs

    def _program(self, name: str) -> None:
        try:
            files, source = self._source(name)
        except Unjudged as error:
            self.others[name] = self._short(error)
            return
        own = [unit for unit in source.units.values() if unit.place.file == str(self._path(name))]
        own = [unit for unit in own if unit.kind != "function"]
        if not own:
            self.others[name] = "declares no PROGRAM and no FUNCTION_BLOCK that can be read"
        several = len([unit for unit in source.units.values() if unit.kind != "function"]) > 1
        for unit in own:
            keys: dict[str, str | list[str]] = {"files": files}
            if several:
                keys["unit"] = unit.name
            if not (list(self._of_unit(name, source, unit, keys))):
                self.others[f"{name} {unit.name}" if len(own) > 1 else name] = self._no_use(source, unit)

    def _source(self, name: str) -> tuple[list[str], Source]:
        """The program of a file: alone, or with the others of its folder, whose types it may need."""
        path = self._path(name)
        try:
            return [name], read_sources([path])
        except Unjudged as error:
            others = [
                other
                for other in self.found.programs
                if other != name
                and Path(other).parent == Path(name).parent
                and Path(other).suffix.lower() == path.suffix.lower()
            ]
            if path.suffix.lower() not in (".st", ".scl") or not others:
                raise
            for other in others:
                try:
                    return [name, other], read_sources([path, self._path(other)])
                except Unjudged:
                    continue
            raise error from None

    def _of_unit(
        self, name: str, source: Source, unit: Unit, keys: dict[str, str | list[str]]
    ) -> Iterator[str]:
        """Propose what a unit may be; the words for each."""
        where = f"{unit.name} of {name}"
        fit = best_fit(source, unit)
        if fit is not None:
            said = f"{where} fits {fit.target}"
            if not fit.exact:
                said = f"{where} nearly fits {fit.target}{_what_is_bound(fit)}"
            bound = None if fit.exact else fit
            self._add("program", unit.name, {**keys, "target": fit.target}, said, bound)
            yield said
            return
        for other in self.found.properties:
            if self._answers(source, unit, other):
                self.used.add(other)
                said = f"{where} has the names of {other}"
                self._add("program", unit.name, {**keys, "property": other}, said)
                yield said
        for file in self.wirings:
            if self._is_machine(file, keys, unit):
                said = f"{where} has the names of {file}"
                whole: dict[str, str | list[str]] = {"wiring": file, "source": keys["files"]}
                whole |= {key: value for key, value in keys.items() if key == "unit"}
                entry = next(one for one in self.entries if one.keys.get("wiring") == file)
                whole |= {key: entry.keys[key] for key in ("properties", "use") if key in entry.keys}
                self._add("machine", unit.name, whole, said)
                yield said

    def _answers(self, source: Source, unit: Unit, properties: str) -> bool:
        """Whether the questions of a file can be asked of a unit."""
        try:
            questions: Questions = read_questions(self._path(properties))
        except Unjudged:
            return False
        texts = [
            str(value)
            for row in questions.rows
            for key, value in row.items()
            if key not in ("id", "sentence")
        ]
        words = {word.upper() for text in texts for word in re.findall(r"[A-Za-z_]\w*", text)}
        if not words & set(unit.variables):
            return False
        try:
            return bool(questions.asked(Cell.of(source, unit, questions.scan_time, False)))
        except Unjudged as error:
            self.others[properties] = f"properties, not of {unit.name}: {self._short(error)}"
            return False

    def _is_machine(self, file: str, keys: dict[str, str | list[str]], unit: Unit) -> bool:
        table = self.wirings[file].table
        if not {name.upper() for name in table.inputs} & set(unit.variables):
            return False
        sources = [self._path(name) for name in keys["files"]]
        machine = ProgramMachine(
            self._path(file).read_text("utf-8"),
            file,
            _shipped("safety"),
            _shipped("use"),
            leave_out=True,
            sources=sources,
            unit=unit.name,
        )
        try:
            return machine.own is not None
        except Unjudged:
            return False

    def _no_use(self, source: Source, unit: Unit) -> str:
        blocks = [block.reference.device.name for _, block in document_blocks.instances(source, unit)]
        if blocks:
            called = ", ".join(dict.fromkeys(blocks))
            return f"{unit.name} calls {called}; write what must be true of it in a file of properties"
        return f"{unit.name} has the names of no target, and calls no block of the documents"

    def _short(self, error: Unjudged) -> str:
        return error.message.replace(f"{self.found.folder}/", "")

    # ------------------------------------------------------------ logs

    def _log(self, name: str) -> None:
        path = self._path(name)
        if not self._words(path):
            self.others[name] = "no log: its first lines name no signal of a target"
            return
        why = ""
        for target, wiring in self._targets(path):
            try:
                self._read(path, target)
            except Unjudged as error:
                why = why or f"it seems to be a log of {target.id}: {self._short(error)}"
                continue
            keys: dict[str, str | list[str]] = {"file": name, "target": target.id}
            if wiring is not None:
                keys["wiring"] = wiring
            self._add("log", Path(name).stem, keys, f"{name} is a log of {target.id}")
            return
        self.others[name] = why or "a table, but its columns are not those of one target"

    def _words(self, path: Path) -> set[str]:
        """The names of signals in the first lines."""
        try:
            with path.open(encoding="utf-8", errors="replace") as lines:
                words = set(re.findall(r"\w+", "".join(itertools.islice(lines, 40))))
        except OSError:
            return set()
        return words & frozenset[str]().union(*(names for _, _, names in self._known))

    def _targets(self, path: Path) -> Sequence[tuple[Target, str | None]]:
        """The targets that have all names of the first lines that any target has; the smallest first."""
        told = self._words(path)
        fitting = [(len(names), target, wiring) for target, wiring, names in self._known if told <= names]
        fitting.sort(key=lambda row: row[0])
        return [(target, wiring) for _, target, wiring in fitting]

    @cached_property
    def _known(self) -> list[tuple[Target, str | None, frozenset[str]]]:
        """Of what a log can be: each target, a wiring where it is of a machine, and the names."""
        place = root()
        found = [(target, target.names) for name in documents(place) for target in targets_of(place, name)]
        known: list[tuple[Target, str | None, frozenset[str]]] = [(one, None, names) for one, names in found]
        for machine in machines(place):
            for file in self.wirings:
                table = tomllib.loads(self._path(file).read_text("utf-8"))
                first = Wired(REFERENCE, machine, table).first()
                target = machine_log.target_of(machine, table, first)
                known.append((target, file, target.names))
        return known

    def _read(self, path: Path, target: Target) -> Log | None:
        if path.stat().st_size > LARGEST:
            return None
        return read_table(path, target) if path.suffix.lower() == ".csv" else read_lines(path, target)


def _shipped(name: str) -> Path:
    """A file of the machine that is published."""
    return root() / "spec" / machines(root())[0] / f"{name}.toml"


def _what_is_bound(fit: Fit) -> str:
    parts = []
    if fit.names:
        parts.append(", ".join(f"{name} is taken for {signal}" for signal, name in fit.names.items()))
    if fit.empty:
        parts.append(f"write your names for {', '.join(fit.empty)}")
    if fit.why:
        parts.append(fit.why)
    return f": {'; '.join(parts)}"
