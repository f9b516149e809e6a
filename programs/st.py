"""Structured Text into the language of `tree`.

The parser is tree-sitter's grammar of IEC 61131-3. Whatever it or this module does not know is refused with
file and line: nothing is skipped.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import tree_sitter
import tree_sitter_iec61131_3_st

from modeproof.ground.errors import Unjudged
from programs.times import time_ms
from programs.tree import (
    SCALARS,
    TIME,
    Array,
    Assign,
    Binary,
    Body,
    Call,
    Case,
    Expression,
    For,
    Function,
    If,
    Index,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Return,
    Scalar,
    Statement,
    Stop,
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
    root = _PARSER.parse(text.encode("utf-8")).root_node
    if root.has_error:
        fault = next(_faults(root))
        shown = " ".join(fault.text.decode("utf-8", "replace").split())[:40]
        raise Place(file, fault.start_point[0] + 1).refuse(
            f"{shown!r} is missing or not Structured Text"
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


class _Reader:
    """Reads the tree of one file."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.types: dict[str, Type] = {}
        self.read = 0

    def place(self, node: Any) -> Place:
        return Place(self.file, node.start_point[0] + 1)

    def refuse(self, node: Any, text: str = "") -> Unjudged:
        shown = " ".join(self.text(node).split())[:50]
        return self.place(node).refuse(text or f"{node.type.replace('_', ' ')} is not supported: {shown}")

    def text(self, node: Any) -> str:
        return str(node.text.decode("utf-8"))

    def named(self, node: Any) -> list[Any]:
        return [child for child in node.children if child.is_named and child.type != "comment"]

    def field(self, node: Any, name: str) -> Any:
        return node.child_by_field_name(name)

    def fields(self, node: Any, name: str) -> list[Any]:
        return [
            child for child in node.children_by_field_name(name) if child.is_named and child.type != "comment"
        ]

    # ------------------------------------------------------------ declarations

    def units(self, root: Any) -> list[Unit]:
        found = []
        for node in self.named(root):
            if node.type == "type_declaration":
                for definition in self.named(node):
                    name = self.text(self.field(definition, "name"))
                    self.types[name.upper()] = self.type(self.field(definition, "definition"), name)
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
            return Scalar(
                name or f"enum at line {node.start_point[0] + 1}", "enum", 0, len(names) - 1, tuple(names)
            )
        raise self.refuse(node, STRUCTURE if node.type == "structure_type_inline" else "")

    def constant(self, node: Any) -> int:
        value = self.expression(node)
        if isinstance(value, Unary) and value.operator == "-" and isinstance(value.operand, Literal):
            return -int(value.operand.value)
        if not isinstance(value, Literal) or isinstance(value.value, bool):
            raise self.refuse(node, f"{self.text(node)}: a number is needed here")
        return value.value

    def initial(self, nodes: Sequence[Any], declared: Type, place: Place) -> object:
        if not nodes:
            return None
        if isinstance(declared, Array):
            values: list[object] = []
            for node in nodes:
                if node.type == "array_repetition":
                    count, *rest = self.named(node)
                    values += [self.single(part, declared.element) for part in rest] * self.constant(count)
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

    # ------------------------------------------------------------ statements

    def body(self, nodes: Iterable[Any]) -> Body:
        found: list[Statement] = []
        for node in nodes:
            if node.type in ("while_statement", "repeat_statement"):
                found += self.loop(node, self.place(node))
            elif node.type != "empty_statement":
                found.append(self.statement(node))
        return tuple(found)

    def loop(self, node: Any, place: Place) -> Iterator[Statement]:
        """WHILE and REPEAT, turn by turn; after the last one nothing may be left to do."""
        self.read += 1
        going, inner = self.expression(self.field(node, "condition")), self.body(self.fields(node, "body"))
        if node.type == "repeat_statement":
            yield from inner
            going = Unary("NOT", going, place)
        yield from (If(((going, inner),), (), place) for _ in range(MOST_TURNS))
        stop = Stop(f"the loop ends after {MOST_TURNS} turns at most", place)
        yield If(((going, (stop,)),), (), place)

    def statement(self, node: Any) -> Statement:
        self.read += 1
        place = self.place(node)
        match node.type:
            case "assignment_statement":
                return Assign(
                    self.target(self.field(node, "left")), self.expression(self.field(node, "right")), place
                )
            case "if_statement":
                branches = [(self.field(node, "condition"), self.fields(node, "consequence"))]
                otherwise: Body = ()
                for child in self.named(node):
                    if child.type == "elsif_clause":
                        branches.append((self.field(child, "condition"), self.fields(child, "body")))
                    elif child.type == "else_clause":
                        otherwise = self.body(self.fields(child, "body"))
                made = tuple((self.expression(asked), self.body(body)) for asked, body in branches)
                return If(made, otherwise, place)
            case "case_statement":
                return self.case(node, place)
            case "for_statement":
                control = self.expression(self.field(node, "control"))
                if not isinstance(control, Name):
                    raise self.refuse(node, "the control variable of FOR must be a variable")
                step = self.field(node, "step")
                return For(
                    control,
                    self.expression(self.field(node, "start")),
                    self.expression(self.field(node, "end")),
                    None if step is None else self.expression(step),
                    self.body(self.fields(node, "body")),
                    place,
                )
            case "invocation_statement":
                return self.call(self.named(node)[0], place)
            case "return_statement":
                return Return(place)
        raise self.refuse(node)

    def case(self, node: Any, place: Place) -> Case:
        clauses = []
        otherwise: Body = ()
        for child in self.named(node):
            if child.type == "case_clause":
                ranges = []
                for value in self.named(child):
                    if value.type == "case_value":
                        (inner,) = self.named(value)
                        ends = ("lower", "upper") if inner.type == "subrange" else None
                        low, high = (self.field(inner, end) for end in ends) if ends else (inner, inner)
                        ranges.append((self.expression(low), self.expression(high)))
                clauses.append((tuple(ranges), self.body(self.fields(child, "body"))))
            elif child.type == "else_clause":
                otherwise = self.body(self.fields(child, "body"))
            elif child != self.field(node, "subject"):
                raise self.refuse(child)
        return Case(self.expression(self.field(node, "subject")), tuple(clauses), otherwise, place)

    def call(self, node: Any, place: Place) -> Call:
        if node.type != "call_expression":
            raise self.refuse(node)
        inputs: list[tuple[str, Expression]] = []
        outputs: list[tuple[str, Expression]] = []
        for argument in self.named(self.field(node, "arguments")):
            if argument.type != "named_argument":
                raise self.refuse(argument, "a block is called with named arguments: instance(NAME := value)")
            pair = (self.text(self.field(argument, "name")), self.expression(self.field(argument, "value")))
            (outputs if any(child.type == "=>" for child in argument.children) else inputs).append(pair)
        return Call(self.target(self.field(node, "function")), tuple(inputs), tuple(outputs), place)

    # ------------------------------------------------------------ expressions

    def target(self, node: Any) -> Expression:
        found = self.expression(node)
        if not isinstance(found, Name | Member | Index):
            raise self.refuse(node, f"{self.text(node)}: a variable is needed here")
        return found

    def expression(self, node: Any) -> Expression:
        place = self.place(node)
        match node.type:
            case "identifier":
                return Name(self.text(node), place)
            case "parenthesized_expression":
                (inner,) = self.named(node)
                return self.expression(inner)
            case "boolean_literal":
                return Literal(self.text(node).upper().endswith("TRUE"), SCALARS["BOOL"], place)
            case "integer_literal":
                return Literal(self.number(node), None, place)
            case "time_literal":
                return Literal(time_ms(self.text(node), place), TIME, place)
            case "typed_literal":
                return self.typed(node, place)
            case "member_access_expression":
                return Member(
                    self.expression(self.field(node, "object")), self.text(self.field(node, "member")), place
                )
            case "index_expression":
                indexes = self.fields(node, "index")
                if len(indexes) != 1:
                    raise self.refuse(node, "an array has one index here")
                return Index(self.target(self.field(node, "object")), self.expression(indexes[0]), place)
            case "unary_expression":
                operator = self.text(self.field(node, "operator")).upper()
                operand = self.expression(self.field(node, "operand"))
                return operand if operator == "+" else Unary(operator, operand, place)
            case "binary_expression":
                operator = self.text(self.field(node, "operator")).upper()
                left, right = (self.expression(self.field(node, side)) for side in ("left", "right"))
                return Binary({"&": "AND"}.get(operator, operator), left, right, place)
            case "call_expression":
                arguments = []
                for argument in self.named(self.field(node, "arguments")):
                    if argument.type == "named_argument":
                        if any(child.type == "=>" for child in argument.children):
                            raise self.refuse(argument)
                        value = self.expression(self.field(argument, "value"))
                        arguments.append((self.text(self.field(argument, "name")).upper(), value))
                    else:
                        arguments.append(("", self.expression(argument)))
                return Function(self.text(self.field(node, "function")).upper(), tuple(arguments), place)
        raise self.refuse(node)

    def number(self, node: Any) -> int:
        match = _NUMBER.fullmatch(self.text(node))
        if match is None:
            raise self.refuse(node, f"{self.text(node)}: not a whole number")
        try:
            return int(match[1] + match[3].replace("_", ""), int(match[2] or 10))
        except ValueError:
            raise self.refuse(node, f"{self.text(node)}: not a whole number") from None

    def typed(self, node: Any, place: Place) -> Literal:
        name = self.text(self.field(node, "type")).upper()
        value = self.field(node, "value")
        if name not in SCALARS:
            raise self.refuse(node)
        kind = SCALARS[name]
        if kind.kind == "bool":
            text = self.text(value).upper()
            if text not in ("TRUE", "FALSE", "0", "1"):
                raise self.refuse(node)
            return Literal(text in ("TRUE", "1"), kind, place)
        number = self.constant(value)
        if not kind.low <= number <= kind.high:
            raise self.refuse(node, f"{self.text(node)}: outside {kind.low}..{kind.high}")
        return Literal(number, kind, place)
