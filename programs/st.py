"""Structured Text into the language of `tree`.

The parser is tree-sitter's grammar of IEC 61131-3. Whatever it or this module does not know is refused with
file and line: nothing is skipped.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import tree_sitter
import tree_sitter_iec61131_3_st

from modeproof.ground.errors import Unjudged
from programs.st_body import Bodies
from programs.standard import BLOCKS
from programs.tree import (
    SCALARS,
    Array,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Type,
    Unary,
    Unit,
    Variable,
)

LONGEST = 1000
"""Elements of an array."""
MOST_TURNS = 32
"""Of WHILE and REPEAT: that no more are needed is part of the proof."""
SECTIONS = {
    "var_input": "input",
    "var_output": "output",
    "var_block": "var",
    "var_temp": "temp",
    "var_in_out": "in_out",
}
MOST_OPEN = 100
"""Comments that begin and do not end."""
STRUCTURE = "structures are not supported: declare each member as a variable of its own"
_PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_iec61131_3_st.language()))
_NUMBER = re.compile(r"(-?)(?:(2|8|16)#)?([0-9A-Fa-f_]+)")
_MEMBER = re.compile(r"\b([A-Za-z_]\w*)#(?=[A-Za-z_])")
_TIME = re.compile(r"\b(?:L?TIME|L?T)#[\w.]+", re.IGNORECASE)
_PREFIXES = {*SCALARS, "T", "LTIME", "LT", "DATE", "D", "TOD", "DT"}


def read_text(text: str, file: str) -> list[Unit]:
    """The program units of one text. Raises Unjudged with file, line and cause."""
    text = _MEMBER.sub(lambda match: match[0] if match[1].upper() in _PREFIXES else f"{match[1]}.", text)
    text = _TIME.sub(lambda match: match[0].replace("_", ""), text)
    last = text.rfind("*)") + 1
    if text.count("(*", last) > MOST_OPEN:  # the grammar would look for the end of each of them
        line = text.count("\n", 0, text.index("(*", last)) + 1
        raise Place(file, line).refuse("a comment that begins here does not end")
    root = _PARSER.parse(text.encode("utf-8")).root_node
    if root.has_error:
        fault = next(_faults(root))
        shown = " ".join(fault.text.decode("utf-8", "replace").split())[:40]
        raise Place(file, fault.start_point[0] + 1).refuse(
            f"{fault.type!r} is missing here, or what stands here is not Structured Text"
            if fault.is_missing
            else f"syntax error at {shown!r}{_advice(shown)}"
        )
    return _Reader(file).units(root)


def _advice(shown: str) -> str:
    if shown.upper().startswith("STRUCT"):
        return f"; {STRUCTURE}"
    return "; bits (X.0, X.%X0) and addresses are not supported: use AND with a mask" * shown.startswith("%")


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

    def __init__(self, file: str) -> None:
        super().__init__(file)
        self.types: dict[str, Type] = {}

    # ------------------------------------------------------------ declarations

    def units(self, root: Any) -> list[Unit]:
        found = []
        for node in self.named(root):
            if node.type == "type_declaration":
                for definition in self.named(node):
                    self.define(definition)
            elif node.type in ("function_block_declaration", "program_declaration", "function_declaration"):
                found.append(self.unit(node))
            else:
                raise self.refuse(node)
        there = 0
        for node in _nodes(root):
            there += node.is_named and node.type.endswith("_statement") and node.type != "empty_statement"
            if node.type == "comment" and self.text(node).startswith("(*") and "(*" in self.text(node)[2:]:
                raise self.refuse(node, "a comment within a comment is not supported: compilers differ here")
        if self.read != there:
            raise Unjudged(f"{self.file}: {self.read} of {there} statements were read: a defect of ours")
        return found

    def define(self, node: Any) -> None:
        """A type with a name of its own."""
        name = self.text(self.field(node, "name"))
        if name.upper() in {*SCALARS, *BLOCKS, *self.types}:
            raise self.refuse(node, f"there is another type with the name {name}")
        if self.field(node, "default") is not None:
            raise self.refuse(node, f"{name}: give the first value to each variable, not to the type")
        self.types[name.upper()] = self.type(self.field(node, "definition"), name)

    def unit(self, node: Any) -> Unit:
        name = self.text(self.field(node, "name"))
        variables: dict[str, Variable] = {}
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
            if name.upper() in variables:
                raise variables[name.upper()].place.refuse(f"{name} is declared twice: it is the result")
            result = self.type(self.field(node, "return_type"), "")
            variables[name.upper()] = Variable(name, result, "output", None, self.place(node))
        return Unit(name, kind, variables, self.body(body_nodes), self.place(node), enumerations)

    def declared(self, section: Any) -> Iterator[Variable]:
        kind = SECTIONS[section.type]
        for child in self.named(section):
            if child.type == "var_qualifier_list":
                for qualifier in self.named(child):
                    word = self.text(qualifier).upper()
                    if word == "CONSTANT" and kind == "input":
                        continue  # a unit never writes its inputs here
                    if word in ("CONSTANT", "RETAIN") and kind == "var":
                        kind = word.lower()
                    elif word not in ("NON_RETAIN", "PRIVATE", "PUBLIC", "INTERNAL", "PROTECTED"):
                        raise self.refuse(qualifier, f"{word} is not supported here")
                continue
            if child.type != "variable_declaration":
                raise self.refuse(child)
            if self.field(child, "address") is not None:
                raise self.refuse(child, "AT: variables at addresses are not supported; give it a name alone")
            declared = self.type(self.field(child, "type"), "")
            initial = self.initial(self.fields(child, "initial_value"), declared, self.place(child))
            if kind == "retain" and isinstance(declared, Instance):
                raise self.refuse(child, "VAR RETAIN: an instance of a block is not supported there")
            for name in self.fields(child, "names"):
                yield Variable(self.text(name), declared, kind, initial, self.place(name))

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
        if node.type == "array_type":
            ranges = self.fields(node, "range")
            if len(ranges) != 1:
                raise self.refuse(node, "an array has one range here")
            low, high = (self.constant(self.field(ranges[0], part)) for part in ("lower", "upper"))
            if not low <= high < low + LONGEST:
                raise self.refuse(node, f"an array has 1 to {LONGEST:,} elements, not {low}..{high}")
            return Array(low, high, self.type(self.field(node, "element_type"), ""))
        if node.type == "enumerated_type_inline":
            names = []
            for number, member in enumerate(self.named(node)):
                value = self.field(member, "value")
                if value is not None and self.constant(value) != number:
                    raise self.refuse(member, "an enumeration counts from 0 by 1 here")
                names.append(self.text(self.field(member, "name")))
                if names[-1].upper() in map(str.upper, names[:-1]):
                    raise self.refuse(member, f"{names[-1]} stands twice in an enumeration")
            return Scalar(
                name or f"enum at line {node.start_point[0] + 1}", "enum", 0, len(names) - 1, tuple(names)
            )
        raise self.refuse(node, STRUCTURE if node.type == "structure_type_inline" else "")

    def initial(self, nodes: Sequence[Any], declared: Type, place: Place) -> object:
        if not nodes:
            return None
        if isinstance(declared, Array):
            values: list[object] = []
            for node in nodes:
                if node.type == "array_repetition":
                    count, *rest = self.named(node)
                    times = self.constant(count)
                    if not 0 < times <= LONGEST:
                        raise self.refuse(node, f"{times} times: 1 to {LONGEST:,} are possible")
                    values += [self.single(part, declared.element) for part in rest] * times
                else:
                    values.append(self.single(node, declared.element))
            if len(values) > declared.high - declared.low + 1:
                raise place.refuse("more initial values than the array has elements")
            return tuple(values)
        if len(nodes) != 1:
            raise place.refuse("one initial value is needed")
        return self.single(nodes[0], declared)

    def single(self, node: Any, declared: Type) -> object:
        value = self.expression(node)
        if isinstance(declared, Scalar) and declared.kind == "enum" and isinstance(value, Name | Member):
            if value.name not in declared.names:
                raise self.refuse(node, f"{declared.name} has no {value.name}")
            return declared.names.index(value.name)
        number = value.operand if isinstance(value, Unary) and value.operator == "-" else value
        if isinstance(number, Literal) and isinstance(declared, Scalar):
            given = value.value if isinstance(value, Literal) else self.constant(node)
            kind = "bool" if isinstance(given, bool) else number.type.kind if number.type else ""
            fits = declared.kind in ("int", "bits") if not kind else kind == declared.kind
            if not fits or not declared.low <= given <= declared.high:
                raise self.refuse(node, f"initial value {self.text(node)}: no value of {declared.name}")
            return given
        raise self.refuse(node, f"initial value {self.text(node)}: a literal is needed here")
