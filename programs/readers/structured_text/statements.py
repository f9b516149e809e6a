"""Statements and expressions of Structured Text into the language of `tree`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from modeproof.ground.errors import Unjudged
from programs.language.constants import Known, constant_of, known
from programs.language.time_literals import time_ms
from programs.language.tree import (
    SCALARS,
    TIME,
    Assign,
    Binary,
    Bit,
    Body,
    Call,
    Case,
    Expression,
    For,
    Function,
    If,
    Index,
    Instance,
    Leave,
    Literal,
    Loop,
    Member,
    Name,
    Place,
    Return,
    Statement,
    Unary,
    Variable,
)
from programs.readers.structured_text.source_text import BIT, THEN

COUNTERS = ("CTU", "CTD", "CTUD")
OLD_PINS = {"RESET": "R", "LOAD": "LD"}
"""Of counters: the names of their pins in an older edition of the standard."""
_NUMBER = re.compile(r"(-?)(?:(2|8|16)#)?([0-9A-Fa-f_]+)")


class Bodies:
    """Reads statements and expressions in the tree of one file; `read`: how many statements."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.read = 0
        self.variables: dict[str, Variable] = {}
        """Of the unit that is read, as far as they are known."""

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

    def constant(self, node: Any) -> int:
        """The number that stands there."""
        found = known(self.expression(node), self.look)
        if found.type is not None and found.type.kind not in ("int", "bits"):
            raise self.refuse(node, f"{self.text(node)}: a number is needed here")
        return int(found.value)

    def look(self, name: Name | Member) -> Known | None:
        """The value of a CONSTANT that was declared before."""
        return constant_of(self.variables.get(name.name.upper())) if isinstance(name, Name) else None

    # ------------------------------------------------------------ statements

    def body(self, nodes: Iterable[Any]) -> Body:
        return tuple(self.statement(node) for node in nodes if node.type != "empty_statement")

    def statement(self, node: Any) -> Statement:
        self.read += 1
        place = self.place(node)
        match node.type:
            case "assignment_statement":
                target, value = self.target(self.field(node, "left")), self.field(node, "right")
                if value.type == "call_expression" and any(map(_gives, self.arguments(value))):
                    called = self.call(value, place)
                    if isinstance(called.instance, Name):
                        result = (called.instance.name, target)
                        return replace(called, outputs=(*called.outputs, result))
                return Assign(target, self.expression(value), place)
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
            case "while_statement" | "repeat_statement":
                going = self.expression(self.field(node, "condition"))
                first = node.type == "repeat_statement"
                body = self.body(self.fields(node, "body"))
                return Loop(Unary("NOT", going, place) if first else going, body, first, place)
            case "exit_statement" | "continue_statement":
                return Leave(node.type == "continue_statement", place)
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
        instance = self.target(self.field(node, "function"))
        for argument in self.arguments(node):
            if argument.type != "named_argument":
                inputs.append(("", self.expression(argument)))
                continue
            name = self.pin(instance, self.text(self.field(argument, "name")))
            pair = (name, self.expression(self.field(argument, "value")))
            (outputs if _gives(argument) else inputs).append(pair)
        if len({name == "" for name, _ in (*inputs, *outputs)}) > 1:
            raise place.refuse("arguments with names and without in one call")
        return Call(instance, tuple(inputs), tuple(outputs), place)

    def arguments(self, node: Any) -> list[Any]:
        """The arguments of a call."""
        return self.named(self.field(node, "arguments"))

    def pin(self, instance: Expression, name: str) -> str:
        """The name of a pin today."""
        declared = self.variables.get(instance.name.upper()) if isinstance(instance, Name) else None
        kind = declared.type if declared is not None else None
        if isinstance(kind, Instance) and kind.block.upper().partition("_")[0] in COUNTERS:
            return OLD_PINS.get(name.upper(), name)
        return name

    # ------------------------------------------------------------ expressions

    def target(self, node: Any) -> Expression:
        found = self.expression(node)
        if not isinstance(found, Name | Member | Index | Bit):
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
                of, name = self.expression(self.field(node, "object")), self.text(self.field(node, "member"))
                if name.startswith(BIT):
                    return Bit(of, int(name.removeprefix(BIT)), place)
                return Member(of, self.pin(of, name), place)
            case "index_expression":
                indexes = self.fields(node, "index")
                found = self.target(self.field(node, "object"))
                for index in indexes:
                    found = Index(found, self.expression(index), place)
                return found
            case "unary_expression":
                operator = self.text(self.field(node, "operator")).upper()
                operand = self.expression(self.field(node, "operand"))
                return operand if operator == "+" else Unary(operator, operand, place)
            case "binary_expression":
                operator = self.text(self.field(node, "operator")).upper()
                left, right = (self.expression(self.field(node, side)) for side in ("left", "right"))
                if any(self.text(child) == THEN for child in node.children if child.type == "comment"):
                    operator = {"AND": "AND_THEN", "OR": "OR_ELSE"}[operator]
                return Binary({"&": "AND"}.get(operator, operator), left, right, place)
            case "call_expression":
                arguments = []
                for argument in self.arguments(node):
                    if argument.type == "named_argument":
                        if _gives(argument):
                            raise self.refuse(
                                argument, "=> within an expression: call the function before it"
                            )
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


def _gives(argument: Any) -> bool:
    """Whether an argument of a call is an output."""
    return any(child.type == "=>" for child in argument.children)
