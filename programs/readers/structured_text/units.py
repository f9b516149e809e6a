"""Structured Text into the language of `tree`.

The parser is tree-sitter's grammar of IEC 61131-3. Whatever it or this module does not know is refused with
file and line: nothing is skipped.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any, TypeGuard

import tree_sitter
import tree_sitter_iec61131_3_st

from modeproof.ground.errors import Unjudged
from programs.language.addresses import Addresses
from programs.language.constants import known
from programs.language.memory import leaves
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    SCALARS,
    Array,
    Instance,
    Member,
    Name,
    Place,
    Scalar,
    Struct,
    Type,
    Unit,
    Variable,
    blocks_in,
    shown,
)
from programs.readers.structured_text.declaration_text import (
    Declared,
    elements,
    is_fields,
    is_list,
    named,
    taken_apart,
)
from programs.readers.structured_text.source_text import NO_RESULT, RETAINS, prepared
from programs.readers.structured_text.statements import Bodies

LONGEST = 1000
"""Elements of an array."""
SECTIONS = {
    "var_input": "input",
    "var_output": "output",
    "var_block": "var",
    "var_temp": "temp",
    "var_in_out": "in_out",
}
_PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_iec61131_3_st.language()))


KnownTypes = Mapping[str, tuple[Type, str]]
"""Types by their names in upper case, each with its namespace."""


def read_text(text: str, file: str, types: KnownTypes = MappingProxyType({})) -> list[Unit]:
    """The program units of one text. types: those of other files. Raises Unjudged with file, line, cause."""
    reader, root = _parsed(text, file, types)
    return reader.units(root)


def types_in(text: str, file: str, types: KnownTypes) -> KnownTypes:
    """The types that one text declares; types: those of other files. Raises Unjudged as `read_text`."""
    reader, root = _parsed(text, file, types)
    return {name: kind for name, kind in reader.own_types(root).items() if name not in types}


def _parsed(text: str, file: str, types: KnownTypes) -> tuple[_Reader, Any]:
    text, using = prepared(text, file)
    apart = taken_apart(text, file)
    root = _PARSER.parse(apart.text.encode("utf-8")).root_node
    if root.has_error:
        fault = next(_faults(root))
        shown = " ".join(fault.text.decode("utf-8", "replace").split())[:40]
        raise Place(file, fault.start_point[0] + 1).refuse(
            f"{fault.type!r} is missing here, or what is here is not Structured Text"
            if fault.is_missing
            else f"syntax error at {shown!r}{_advice(shown)}"
        )
    return _Reader(file, tuple((one.namespace, one.place) for one in using), apart, types), root


def _advice(shown: str) -> str:
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


class _Reader(Bodies):
    """Reads the tree of one file."""

    def __init__(
        self, file: str, using: tuple[tuple[str, Place], ...], apart: Declared, types: KnownTypes
    ) -> None:
        super().__init__(file)
        self.using, self.apart = using, apart
        self.types: dict[str, Type] = {name: kind for name, (kind, _) in types.items()}
        self.spaces: dict[str, str] = {name: space for name, (_, space) in types.items()}
        """The namespace of each type."""
        self.addresses: Addresses | None = None
        self.retaining: set[int] = set()
        """The marks RETAINS that were read, by their bytes."""

    # ------------------------------------------------------------ declarations

    def within(self, nodes: Sequence[Any], namespace: str = "") -> Iterator[tuple[Any, str]]:
        """What is declared here and below in namespaces, each with its namespace."""
        for node in nodes:
            if node.type == "namespace_declaration":
                name = self.field(node, "name")
                inner = [child for child in self.named(node) if child != name]
                own = _joined(self.text(name))
                yield from self.within(inner, f"{namespace}.{own}" if namespace else own)
            else:
                yield node, namespace

    def own_types(self, root: Any) -> KnownTypes:
        """The types that are known after those of this file were read."""
        for node, namespace in self.within(self.named(root)):
            if node.type == "type_declaration":
                self.define_all(node, namespace)
        return {name: (kind, self.spaces[name]) for name, kind in self.types.items()}

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
            else:
                raise self.refuse(node)

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
        self.addresses = Addresses() if node.type == "program_declaration" else None
        body_nodes = self.fields(node, "body")
        for child in self.named(node):
            if child in body_nodes or child in (self.field(node, "name"), self.field(node, "return_type")):
                continue
            if child.type not in SECTIONS:
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
                    if word == "CONSTANT" and kind == "var":
                        kind = "constant"
                    elif word == "RETAIN" and kind in ("var", "output"):
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
            if (kept or kind == "constant") and any(blocks_in(declared)):
                word = "RETAIN" if kept else "CONSTANT"
                raise self.refuse(child, f"{word}: an instance of a block is not supported there")
            self.retaining |= marks if kind in ("var", "output") else set()
            marks = set()
            if len(leaves(declared)) > LONGEST:
                raise self.refuse(child, f"a variable has at most {LONGEST:,} single values")
            if kind != "in_out" and initial is None and _undecided(declared):
                raise self.refuse(child, f"{declared.name}: give it a first value; compilers differ here")
            names, own = self.fields(child, "names"), kind
            if (address := self.field(child, "address")) is not None:
                if self.addresses is None or kind != "var" or len(names) != 1 or initial is not None or kept:
                    what = "a variable in VAR of a PROGRAM, one alone, without a first value"
                    raise self.refuse(child, f"AT: {what} has an address here")
                own = self.addresses.section(self.text(address), declared, self.text(names[0]), place)
            for name in names:
                yield Variable(self.text(name), declared, own, initial, self.place(name), kept)

    def type(self, node: Any, name: str) -> Type:
        if node.type in ("elementary_type", "identifier"):
            word = self.text(node)
            if word.upper() in SCALARS:
                return SCALARS[word.upper()]
            if word.upper() in self.types:
                return self.types[word.upper()]
            if node.type == "elementary_type":
                raise self.refuse(node, f"type {word} is not supported")
            return Instance(word)
        if node.type == "qualified_identifier":
            space, _, tail = _joined(self.text(node)).rpartition(".")
            if self.spaces.get(tail.upper(), "").upper() == space.upper():
                return self.types[tail.upper()]
            return Instance(f"{space}.{tail}")
        if node.type == "subrange_type":
            return self.subrange(node)
        if node.type == "array_type":
            element = self.type(self.field(node, "element_type"), "")
            if _undecided(element):
                raise self.refuse(node, f"an array of {element.name} is not supported: compilers differ here")
            for part in reversed([node for node in self.fields(node, "range") if node.type != ","]):
                low, high = (self.constant(self.field(part, end)) for end in ("lower", "upper"))
                if not low <= high < low + LONGEST:
                    raise self.refuse(node, f"an array has 1 to {LONGEST:,} elements, not {low}..{high}")
                element = Array(low, high, element)
            return element
        if node.type == "structure_type_inline":
            return self.structure(node, name)
        if node.type == "enumerated_type_inline":
            return self.enumeration(node, name)
        raise self.refuse(node)

    def structure(self, node: Any, name: str) -> Struct:
        """The members in their order with their first values."""
        members: list[tuple[str, Type, object]] = []
        for child in self.named(node):
            if child.type != "structure_field":
                raise self.refuse(child)
            kind_node, first = self.field(child, "type"), self.field(child, "name")
            declared = self.type(kind_node, "")
            initial = self.initial(
                self.fields(child, "default"), kind_node.end_byte, declared, self.place(child)
            )
            if initial is None and _undecided(declared):
                raise self.refuse(child, f"{declared.name}: give it a first value; compilers differ here")
            for own in (self.text(first), *self.apart.also(first.start_byte)):
                if own.upper() in (other.upper() for other, _, _ in members):
                    raise self.refuse(child, f"{own} is declared twice")
                members.append((own, declared, initial))
        return Struct(name or f"STRUCT at line {node.start_point[0] + 1}", tuple(members))

    def subrange(self, node: Any) -> Scalar:
        """INT (0..10): a calculation with it is one with INT, and each value that it is given is in range."""
        word = self.text(self.named(node)[0]).upper()
        low, high = (self.constant(self.field(node, end)) for end in ("lower", "upper"))
        base = SCALARS.get(word)
        if base is None or base.kind != "int":
            raise self.refuse(node, f"a range of {word} is not supported")
        if not base.low <= low <= high <= base.high:
            raise self.refuse(node, f"{low}..{high} is no range of {base.name}")
        return Scalar(f"{base.name} ({low}..{high})", "int", low, high, base=base)

    def enumeration(self, node: Any, name: str) -> Scalar:
        """The members in their order, and their numbers where they do not count from 0 by 1."""
        names: list[str] = []
        numbers: list[int] = []
        for member in self.named(node):
            value = self.field(member, "value")
            numbers.append(self.constant(value) if value is not None else numbers[-1] + 1 if numbers else 0)
            names.append(self.text(self.field(member, "name")))
        if len({one.upper() for one in names}) != len(names) or len(set(numbers)) != len(numbers):
            raise self.refuse(node, "two members of an enumeration with one name or one number")
        counted = numbers == list(range(len(names)))
        return Scalar(
            name or f"enum at line {node.start_point[0] + 1}",
            "enum",
            0,
            len(names) - 1,
            tuple(names),
            () if counted else tuple(numbers),
        )

    def initial(self, nodes: Sequence[Any], behind: int, declared: Type, place: Place) -> object:
        """What a variable has at power-up; behind: the byte after its type."""
        given = self.apart.value(behind)
        if given is not None:
            return self.whole(given, declared, place)
        if not nodes:
            return None
        if len(nodes) != 1:
            raise place.refuse("one initial value is needed")
        return self.single(nodes[0], declared)

    def whole(self, text: str, declared: Type, place: Place) -> object:
        """The initial value of an array or a structure, or of a part of one."""
        if isinstance(declared, Struct) and is_fields(text):
            found: dict[str, object] = {}
            for name, value in named(text, place):
                member = next((one for one in declared.members if one[0].upper() == name.upper()), None)
                if member is None or name.upper() in found:
                    cause = "is given twice" if member else f"is no member of {declared.name}"
                    raise place.refuse(f"initial value: {name} {cause}")
                if isinstance(member[2], tuple) and not isinstance(member[1], Scalar):
                    raise place.refuse(f"{name} has first values in its type and here: compilers differ here")
                found[name.upper()] = self.whole(value, member[1], place)
            return tuple(found.items())
        if isinstance(declared, Array) and is_list(text):
            parts = elements(text, place)
            if isinstance(declared.element, Array) and not any(map(is_list, parts)):
                rest = iter(parts)
                return self.rows(declared, rest, place)
            if len(parts) > declared.high - declared.low + 1:
                raise place.refuse("more initial values than the array has elements")
            return tuple(self.whole(part, declared.element, place) for part in parts)
        if not isinstance(declared, Scalar):
            raise place.refuse(f"initial value {' '.join(text.split())[:40]}: no value of {shown(declared)}")
        head = "\n" * (place.line - 1) + "FUNCTION_BLOCK x x := "
        root = _PARSER.parse(f"{head}{text}; END_FUNCTION_BLOCK".encode()).root_node
        nodes = [] if root.has_error else self.fields(self.named(root)[0], "body")
        if len(nodes) != 1 or nodes[0].type != "assignment_statement":
            raise place.refuse(f"initial value {' '.join(text.split())[:40]}: a literal is needed here")
        return self.single(self.field(nodes[0], "right"), declared)

    def rows(self, declared: Array, rest: Iterator[str], place: Place, inner: bool = False) -> object:
        """An array of several dimensions; the last index counts first."""
        found: list[object] = []
        for _ in range(declared.low, declared.high + 1):
            if isinstance(declared.element, Array):
                found.append(self.rows(declared.element, rest, place, True))
            elif (part := next(rest, None)) is not None:
                found.append(self.whole(part, declared.element, place))
        if not inner and next(rest, None) is not None:
            raise place.refuse("more initial values than the array has elements")
        return tuple(found)

    def single(self, node: Any, declared: Type) -> bool | int:
        value = self.expression(node)
        if not isinstance(declared, Scalar):
            raise self.refuse(node, f"initial value {self.text(node)}: no value of {shown(declared)}")
        if declared.kind == "enum" and isinstance(value, Name | Member):
            number = declared.member(value.name)
            owner = value.of.name if isinstance(value, Member) and isinstance(value.of, Name) else ""
            if number is None or owner.upper() not in ("", declared.name.upper()):
                raise self.refuse(node, f"{declared.name} has no {self.text(node)}")
            return number
        given = known(value, self.look)
        if given.type is None and declared.kind == "bool" and given.value in (0, 1):
            return bool(given.value)
        fits = declared.kind in ("int", "bits") if given.type is None else given.type.kind == declared.kind
        if declared.kind == "enum" or not fits or not declared.low <= given.value <= declared.high:
            raise self.refuse(node, f"initial value {self.text(node)}: no value of {declared.name}")
        return given.value


def _undecided(kind: Type) -> TypeGuard[Scalar]:
    """Whether a variable of this type needs a first value: one begins at 0, another at the lower bound."""
    return isinstance(kind, Scalar) and kind.base is not None and kind.low != 0 and kind.start == 0


def _joined(text: str) -> str:
    """A name with namespaces, without blanks."""
    return "".join(text.split())
