"""Types, and the values of variables at power-up, in the tree of one file of Structured Text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeGuard

import tree_sitter
import tree_sitter_iec61131_3_st

from programs.language.constants import Known as Constant
from programs.language.constants import constant_of, known
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
    Variable,
    shown,
)
from programs.readers.structured_text.declaration_text import (
    Declared,
    elements,
    is_fields,
    is_list,
    named,
)
from programs.readers.structured_text.statements import Bodies

LONGEST = 1000
"""Elements of an array."""
PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_iec61131_3_st.language()))


@dataclass(frozen=True)
class Known:
    """What other files declare: types by their names in upper case, each with its namespace; constants.

    A constant is here by its name and by that of its list (`LIST.NAME`).
    """

    types: Mapping[str, tuple[Type, str]] = field(default_factory=dict)
    constants: Mapping[str, Variable] = field(default_factory=dict)

    @staticmethod
    def joined(parts: Iterable[Known]) -> Known:
        """All of these; a constant that two of them have is none."""
        types: dict[str, tuple[Type, str]] = {}
        constants: dict[str, Variable] = {}
        twice: set[str] = set()
        for part in parts:
            types |= part.types
            twice |= set(constants) & set(part.constants)
            constants |= part.constants
        return Known(types, {key: one for key, one in constants.items() if key not in twice})


class TypesAndValues(Bodies):
    """Reads types and first values. known: those of other files; apart: what the text had besides."""

    def __init__(self, file: str, apart: Declared, known: Known) -> None:
        super().__init__(file)
        self.apart = apart
        self.types: dict[str, Type] = {name: kind for name, (kind, _) in known.types.items()}
        self.spaces: dict[str, str] = {name: space for name, (_, space) in known.types.items()}
        """The namespace of each type."""
        self.constants = dict(known.constants)

    def look(self, name: Name | Member) -> Constant | None:
        """The value of a CONSTANT that was declared before, or in another file."""
        if isinstance(name, Name) and name.name.upper() in self.variables:
            return super().look(name)
        key = name.name.upper()
        if isinstance(name, Member):
            if not isinstance(name.of, Name) or name.of.name.upper() in self.variables:
                return None
            key = f"{name.of.name.upper()}.{key}"
        return constant_of(self.constants.get(key))

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
            space, _, tail = joined(self.text(node)).rpartition(".")
            if self.spaces.get(tail.upper(), "").upper() == space.upper():
                return self.types[tail.upper()]
            return Instance(f"{space}.{tail}")
        if node.type == "subrange_type":
            return self.subrange(node)
        if node.type == "array_type":
            element = self.type(self.field(node, "element_type"), "")
            if undecided(element):
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
            if initial is None and undecided(declared):
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
        root = PARSER.parse(f"{head}{text}; END_FUNCTION_BLOCK".encode()).root_node
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


def undecided(kind: Type) -> TypeGuard[Scalar]:
    """Whether a variable of this type needs a first value: one begins at 0, another at the lower bound."""
    return isinstance(kind, Scalar) and kind.base is not None and kind.low != 0 and kind.start == 0


def joined(text: str) -> str:
    """A name with namespaces, without blanks."""
    return "".join(text.split())
