"""Structured Text into the language of `tree`.

The parser is tree-sitter's grammar of IEC 61131-3. Whatever it or this module does not know is refused with
file and line: nothing is skipped.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from modeproof.ground.errors import Unjudged
from programs.language.addresses import area_of
from programs.language.memory import leaves
from programs.language.standard_blocks import BLOCKS
from programs.language.time_literals import time_ms
from programs.language.tree import (
    SCALARS,
    Place,
    Scalar,
    Task,
    Type,
    Unit,
    Variable,
    blocks_in,
)
from programs.readers.structured_text.declaration_text import (
    Declared,
    taken_apart,
)
from programs.readers.structured_text.source_text import NO_RESULT, RETAINS, prepared
from programs.readers.structured_text.types_and_values import (
    LONGEST,
    PARSER,
    Known,
    TypesAndValues,
    joined,
    undecided,
)

SECTIONS = {
    "var_input": "input",
    "var_output": "output",
    "var_block": "var",
    "var_temp": "temp",
    "var_in_out": "in_out",
    "var_external": "external",
    "var_global": "global",
}

SECTIONS_OF_AREAS = {"I": "input", "Q": "output", "M": "external"}

NOTHING = Known()


@dataclass(frozen=True)
class Read:
    """What one text declares: units, globals, and when programs run."""

    units: list[Unit]
    globals: list[Variable]
    tasks: list[Task]


def read_text(text: str, file: str) -> list[Unit]:
    """The program units of one text. Raises Unjudged with file, line, cause."""
    return read_all(text, file).units


def read_all(text: str, file: str, known: Known = NOTHING, group: str = "") -> Read:
    """All that one text declares. known: that of other files; group: the list to which globals belong."""
    reader, root = _parsed(text, file, known)
    reader.group = group
    return Read(reader.units(root), reader.globals, reader.tasks)


def known_in(text: str, file: str, known: Known, group: str = "") -> Known:
    """The types and the constants that one text declares. Raises Unjudged as `read_all`."""
    reader, root = _parsed(text, file, known)
    reader.group = group
    types = {name: kind for name, kind in reader.own_types(root).items() if name not in known.types}
    reader.own_globals(root)
    constants = {key: one for key, one in reader.constants.items() if known.constants.get(key) is not one}
    return Known(types, constants)


def _parsed(text: str, file: str, known: Known) -> tuple[_Reader, Any]:
    text, using = prepared(text, file)
    apart = taken_apart(text, file)
    root = PARSER.parse(apart.text.encode("utf-8")).root_node
    if root.has_error:
        fault = next(_faults(root))
        shown = " ".join(fault.text.decode("utf-8", "replace").split())[:40]
        raise Place(file, fault.start_point[0] + 1).refuse(
            f"{fault.type!r} is missing here, or what is here is not Structured Text"
            if fault.is_missing
            else f"syntax error at {shown!r}{_advice(shown)}"
        )
    return _Reader(file, tuple((one.namespace, one.place) for one in using), apart, known), root


_NAMED = {
    "EXTENDS": "; inheritance is not supported",
    "IMPLEMENTS": "; inheritance is not supported",
}


def _advice(shown: str) -> str:
    for words, text in _NAMED.items():
        if words in shown.upper():
            return text
    if shown.upper().startswith(("WORD (", "BYTE (", "DWORD (")):
        return "; named values of a bit string are not supported: declare them as CONSTANT"
    return "; an address belongs in VAR alone (AT %IX0.0): give the variable a name" * shown.startswith("%")


def _faults(node: Any) -> Iterator[Any]:
    """The innermost nodes that the grammar could not read."""
    inner = [child for child in node.children if child.has_error or child.is_missing]
    for child in inner:
        yield from _faults(child)
    if not inner:
        yield node


def _nodes(node: Any) -> Iterator[Any]:
    waiting = [node]
    while waiting:
        here = waiting.pop()
        yield here
        waiting += here.children


class _Reader(TypesAndValues):
    """Reads the tree of one file."""

    def __init__(
        self, file: str, using: tuple[tuple[str, Place], ...], apart: Declared, known: Known
    ) -> None:
        super().__init__(file, apart, known)
        self.using = using
        self.placed = False
        """Whether variables may have addresses here."""
        self.group = ""
        """The list of globals that this file is."""
        self.globals: list[Variable] = []
        self.tasks: list[Task] = []
        self.retaining: set[int] = set()
        """The marks RETAINS that were read, by their bytes."""

    # ------------------------------------------------------------ declarations

    def within(self, nodes: Sequence[Any], namespace: str = "") -> Iterator[tuple[Any, str]]:
        """What is declared here and below in namespaces, each with its namespace."""
        for node in nodes:
            if node.type == "namespace_declaration":
                name = self.field(node, "name")
                inner = [child for child in self.named(node) if child != name]
                own = joined(self.text(name))
                yield from self.within(inner, f"{namespace}.{own}" if namespace else own)
            else:
                yield node, namespace

    def own_types(self, root: Any) -> Mapping[str, tuple[Type, str]]:
        """The types that are known after those of this file were read."""
        for node, namespace in self.within(self.named(root)):
            if node.type == "type_declaration":
                self.define_all(node, namespace)
        return {name: (kind, self.spaces[name]) for name, kind in self.types.items()}

    def own_globals(self, root: Any) -> None:
        """Read the globals of this file alone."""
        for node in self.named(root):
            if node.type in ("global_var_declaration_block", "configuration_declaration"):
                self.shared(node)

    def units(self, root: Any) -> list[Unit]:
        found = list(self.declarations(root))
        there = sum(
            node.is_named and node.type.endswith("_statement") and node.type != "empty_statement"
            for node in _nodes(root)
        )
        if self.read != there:
            raise Unjudged(f"{self.file}: {self.read} of {there} statements were read: a defect of ours")
        self.apart.refuse_rest(self.file)
        for node in _nodes(root):
            if (
                node.type == "comment"
                and self.text(node) == RETAINS
                and node.start_byte not in self.retaining
            ):
                text = "this attribute retains one variable in VAR or VAR_OUTPUT: say which with VAR RETAIN"
                raise self.refuse(node, text)
        return found

    def declarations(self, root: Any) -> Iterator[Unit]:
        """The units among what is declared."""
        for node, namespace in self.within(self.named(root)):
            if node.type == "type_declaration":
                self.define_all(node, namespace)
            elif node.type in ("function_block_declaration", "program_declaration", "function_declaration"):
                unit = replace(self.unit(node), namespace=namespace, using=self.using)
                if unit.name.upper() in self.types:
                    raise unit.place.refuse(f"there is a type with the name {unit.name}")
                yield unit
            elif node.type in ("global_var_declaration_block", "configuration_declaration"):
                self.shared(node)
            else:
                raise self.refuse(node)

    def shared(self, node: Any) -> None:
        """Read the globals and the tasks of a configuration, of a resource, or of a list of globals."""
        self.variables, self.placed = {one.name.upper(): one for one in self.globals}, True
        running: dict[str, list[str]] = {}
        parts = self.named(node)
        tasks = [child for child in parts if child.type == "task_declaration"]
        for child in parts:
            if child.type == "var_global":
                for variable in self.declared(child):
                    self.variables[variable.name.upper()] = variable
                    self.globals.append(replace(variable, group=self.group))
                    if variable.section == "constant" and isinstance(variable.type, Scalar):
                        for key in (variable.name.upper(), f"{self.group}.{variable.name}".upper()):
                            self.constants[key] = variable
            elif child.type == "resource_declaration":
                self.shared(child)
            elif child.type == "program_assignment":
                names = [self.text(one) for one in self.named(child)]
                known = {self.text(self.named(task)[0]).upper() for task in tasks}
                if len(names) != 3 or names[1].upper() not in known:
                    raise self.refuse(child, "PROGRAM name WITH task : type alone is understood here")
                running.setdefault(names[1].upper(), []).append(names[2])
            elif child.type not in ("identifier", "task_declaration"):
                raise self.refuse(child)
        for task in tasks:
            name, *given = self.named(task)
            interval = None
            for part in given:
                key, value = (self.text(one) for one in self.named(part))
                if key.upper() == "INTERVAL":
                    interval = time_ms(value, self.place(part))
                elif key.upper() != "PRIORITY":
                    raise self.refuse(part)
            programs = tuple(running.get(self.text(name).upper(), ()))
            self.tasks.append(Task(self.text(name), interval, programs, self.place(task)))

    def define_all(self, node: Any, namespace: str) -> None:
        """Read the types of one declaration."""
        for definition in self.named(node):
            self.define(definition, namespace)

    def define(self, definition: Any, namespace: str) -> None:
        """Read one type and its first value."""
        name = self.text(self.field(definition, "name"))
        if name.upper() in {*SCALARS, *BLOCKS, *self.types}:
            raise self.refuse(definition, f"there is another type with the name {name}")
        kind = self.type(self.field(definition, "definition"), name)
        if nodes := self.fields(definition, "default"):
            if not isinstance(kind, Scalar):
                raise self.refuse(definition, f"{name}: a first value of a type is a single value here")
            kind = kind.starting(int(self.single(nodes[0], kind)))
        self.types[name.upper()], self.spaces[name.upper()] = kind, namespace

    def unit(self, node: Any) -> Unit:
        name = self.text(self.field(node, "name"))
        self.variables = variables = {}
        self.placed = node.type == "program_declaration"
        body_nodes = self.fields(node, "body")
        for child in self.named(node):
            if child in body_nodes or child in (self.field(node, "name"), self.field(node, "return_type")):
                continue
            if child.type.endswith("identifier"):
                raise self.refuse(child, f"inheritance is not supported: {self.text(child)}")
            if child.type not in SECTIONS or child.type == "var_global":
                raise self.refuse(child)
            for variable in self.declared(child):
                if variable.name.upper() in variables:
                    raise variable.place.refuse(f"{variable.name} is declared twice")
                variables[variable.name.upper()] = variable
        enumerations = {name: kind for name, kind in self.types.items() if isinstance(kind, Scalar)}
        kind = node.type.removesuffix("_declaration").replace("_", " ")
        if kind == "function":
            result = self.field(node, "return_type")
            if name.upper() in variables:
                raise variables[name.upper()].place.refuse(f"{name} is declared twice: it is the result")
            if self.text(result).upper() != NO_RESULT:
                variables[name.upper()] = Variable(
                    name, self.type(result, ""), "output", None, self.place(node)
                )
        return Unit(name, kind, variables, self.body(body_nodes), self.place(node), enumerations)

    def declared(self, section: Any) -> Iterator[Variable]:
        kind, retained = SECTIONS[section.type], False
        marks: set[int] = set()
        for child in (child for child in section.children if child.is_named):
            if child.type == "comment":
                marks |= {child.start_byte} if self.text(child) == RETAINS else set()
                continue
            if child.type == "var_qualifier_list":
                for qualifier in self.named(child):
                    word = self.text(qualifier).upper()
                    if word == "CONSTANT" and kind == "input":
                        continue  # a unit never writes its inputs here
                    if word == "CONSTANT" and kind == "external":
                        continue  # its declaration as a global says so too
                    if word == "CONSTANT" and kind in ("var", "global"):
                        kind = "constant"
                    elif word == "RETAIN" and kind in ("var", "output", "global", "external"):
                        retained = True
                    elif word not in ("NON_RETAIN", "PRIVATE", "PUBLIC", "INTERNAL", "PROTECTED"):
                        raise self.refuse(qualifier, f"{word} is not supported here")
                continue
            if child.type != "variable_declaration":
                raise self.refuse(child)
            declared = self.type(self.field(child, "type"), "")
            nodes, place = self.fields(child, "initial_value"), self.place(child)
            initial = self.initial(nodes, self.field(child, "type").end_byte, declared, place)
            kept = retained or bool(marks)
            if kind == "external" and initial is not None:
                raise self.refuse(child, "VAR_EXTERNAL: the first value belongs to VAR_GLOBAL")
            if (kept or kind == "constant") and any(blocks_in(declared)):
                word = "RETAIN" if kept else "CONSTANT"
                raise self.refuse(child, f"{word}: an instance of a block is not supported there")
            self.retaining |= marks if kind in ("var", "output", "global") else set()
            marks = set()
            if len(leaves(declared)) > LONGEST:
                raise self.refuse(child, f"a variable has at most {LONGEST:,} single values")
            if kind != "in_out" and initial is None and undecided(declared):
                raise self.refuse(child, f"{declared.name}: give it a first value; compilers differ here")
            names, own, at = self.fields(child, "names"), kind, ""
            if (address := self.field(child, "address")) is not None:
                if not self.placed or kind not in ("var", "global") or len(names) != 1:
                    what = "a variable in VAR of a PROGRAM or in VAR_GLOBAL, one alone,"
                    raise self.refuse(child, f"AT: {what} has an address here")
                at = self.text(address).upper()
                area = area_of(at, declared, place)
                own = SECTIONS_OF_AREAS[area] if kind == "var" else kind
            for name in names:
                yield Variable(self.text(name), declared, own, initial, self.place(name), kept, at)
