"""The elements of a function block diagram or a ladder as statements, in the order of `networks`.

What comes out of a gate or a contact is kept in a temporary variable, so that all who are connected to it
get the same value. What comes out of a block is a variable of its instance.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace

from modeproof.ground.errors import suggestion
from programs.language.calls import sides
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    BOOL,
    Assign,
    Binary,
    Body,
    Call,
    Expression,
    Function,
    If,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Statement,
    Type,
    Unary,
    Unit,
    Variable,
)
from programs.language.types import Types
from programs.readers.plcopen.diagrams import Node, Out, Pin, read_nodes
from programs.readers.plcopen.evaluation_order import Order, roots
from programs.readers.plcopen.xml_tree import Element
from programs.readers.structured_text.units import read_text

CHAINS = {"AND": "AND", "OR": "OR", "XOR": "XOR", "ADD": "+", "MUL": "*"}
PAIRS = {
    **{"SUB": "-", "DIV": "/", "MOD": "MOD"},
    **{"GT": ">", "GE": ">=", "EQ": "=", "LE": "<=", "LT": "<", "NE": "<>"},
}
_NAME = re.compile(r"(?!(?:true|false)$)[a-z_]\w*", re.ASCII | re.IGNORECASE)


def read_expression(text: str, place: Place) -> Expression:
    """One expression of Structured Text."""
    if _NAME.fullmatch(text.strip()):
        return Name(text.strip(), place)
    lines = "\n" * (place.line - 1)
    (unit,) = read_text(f"{lines}PROGRAM p value := ({text}\n); END_PROGRAM", place.file) or (None,)
    match unit and unit.body:
        case (Assign(_, value, _),) if unit is not None and not unit.variables:
            return value
    raise place.refuse(f"{text!r} is no expression")


class Diagram:
    """Makes the statements of one FBD or LD body."""

    def __init__(
        self, source: Source, unit: Unit, body: Element, beyond: Mapping[str, frozenset[str]]
    ) -> None:
        self.source, self.body = source, body
        self.variables = dict(unit.variables)
        self.made = replace(unit, variables=self.variables)
        self.types = Types(source, self.made)
        self.order = Order(read_nodes(body, read_expression), beyond)
        self.statements: list[Statement] = []
        self.outputs: dict[tuple[str, str], Expression] = {}
        self.versions: dict[str, int] = defaultdict(int)
        self.seen: dict[str, dict[str, int]] = {}
        self.last: dict[str, str] = {}

    def unit(self, place: Place) -> Unit:
        """The unit with its body."""
        sequence = self.order.sequence
        if not sequence:
            raise self.body.place.refuse(f"{self.made.name}: the body does nothing")
        for node in sequence:
            self.run(node)
            for name in self.order.writes(node):
                self.versions[name] += 1
                self.last[name] = node.id
        return replace(self.made, body=tuple(self.statements), place=place)

    def run(self, node: Node) -> None:
        if node.kind == "block":
            self.block(node)
        elif node.kind == "contact":
            passed = Binary("AND", self.power(node), self.contact(node), node.place)
            self.keep(node, "", passed)
        else:
            value = self.power(node) if node.kind == "coil" else self.input(node, node.pins[0])
            if node.kind == "coil":
                self.keep(node, "", value)
                value = self.outputs[node.id, ""]
            if node.negated:
                value = Unary("NOT", value, node.place)
            value = self.edge(node, "", node.edge, value)
            self.store(node, value)

    def store(self, node: Node, value: Expression) -> None:
        """What an outVariable or a coil does to its variable."""
        assert node.variable is not None
        if node.storage == "none":
            self.statements.append(Assign(node.variable, value, node.place))
            return
        if node.negated or node.edge != "none":
            raise node.place.refuse(f"{node.what()}: {node.storage} with negation or edge is not supported")
        new = Literal(node.storage == "set", BOOL, node.place)
        self.statements.append(If(((value, (Assign(node.variable, new, node.place),)),), (), node.place))

    def contact(self, node: Node) -> Expression:
        assert node.variable is not None
        self.boolean(node.variable, node.place)
        value = self.edge(node, "", node.edge, node.variable)
        if node.negated and node.edge != "none":
            raise node.place.refuse(f"{node.what()}: negated and at an edge is not supported")
        return Unary("NOT", value, node.place) if node.negated else value

    def power(self, node: Node) -> Expression:
        """What reaches a contact or a coil."""
        value = self.input(node, node.pins[0])
        self.boolean(value, node.place)
        return value

    def boolean(self, value: Expression, place: Place) -> None:
        self.types.scalar(value, place, ("bool",))

    def keep(self, node: Node, pin: str, value: Expression) -> None:
        """Keep a value for whoever is connected to it, in a temporary variable."""
        kind = self.types.of(value)
        assert isinstance(kind, Scalar)
        name = self.declare(f"%{node.id}_{pin}", kind, "temp", node.place)
        self.statements.append(Assign(name, value, node.place))
        self.outputs[node.id, pin] = name

    def declare(self, name: str, kind: Type, section: str, place: Place) -> Name:
        self.variables[name.upper()] = Variable(name, kind, section, None, place)
        return Name(name, place)

    def edge(self, node: Node, pin: str, which: str, value: Expression) -> Expression:
        """TRUE in the scan in which the value changes this way."""
        if which == "none":
            return value
        block = "R_TRIG" if which == "rising" else "F_TRIG"
        name = f"%edge{node.id}_{pin}"
        instance = self.declare(name, Instance(block), "var", node.place)
        self.statements.append(Call(instance, (("CLK", value),), (), node.place))
        return Member(instance, "Q", node.place)

    # ------------------------------------------------------------ values

    def input(self, node: Node, pin: Pin) -> Expression:
        """The value at an input. Raises Unjudged: nothing is connected."""
        if pin.expression is not None:
            values = [pin.expression]
        else:
            values = [self.output(node, pin, source) for source in pin.sources]
        if not values:
            raise pin.place.refuse(f"{node.what()}: input {pin.name} is not connected".replace("  ", " "))
        if len(values) > 1 and self.body.name != "LD":
            raise pin.place.refuse(f"{node.what()}: {len(values)} connections at one input; use OR")
        for value in values if len(values) > 1 else ():
            self.boolean(value, pin.place)
        found = values[0]
        for value in values[1:]:
            found = Binary("OR", found, value, pin.place)
        if pin.negated:
            found = Unary("NOT", found, pin.place)
        return self.edge(node, pin.name, pin.edge, found)

    def output(self, node: Node, pin: Pin, source: tuple[str, str]) -> Expression:
        """The value at the other end of a connection."""
        end, wanted = self.order.end(pin, source)
        if end.kind == "leftPowerRail":
            return Literal(True, BOOL, pin.place)
        if not end.runs or end.kind == "inOutVariable":
            return self.variable(end)
        if end.kind != "block":
            return self.outputs[end.id, ""]
        return self.of_block(node, end, self.wanted(end, wanted, pin))

    def variable(self, node: Node) -> Expression:
        """What an inVariable gives. It must be the same for all that are connected to it."""
        assert node.variable is not None
        now = {name: self.versions[name] for name in roots(node.variable)}
        if not node.runs and self.seen.setdefault(node.id, now) != now:
            raise node.place.refuse(f"{node.what()} is written between two uses of it; draw it twice")
        if node.edge != "none" or node.storage != "none":
            raise node.place.refuse(f"{node.what()}: edge and storage are not supported there")
        return Unary("NOT", node.variable, node.place) if node.negated and not node.runs else node.variable

    def wanted(self, block: Node, name: str, pin: Pin) -> Out:
        """The output of a block to which a connection leads."""
        outs = [out for out in block.outs if out.name == name or (not name and out.name != "ENO")]
        if len(outs) != 1:
            names = [out.name for out in block.outs]
            raise pin.place.refuse(f"{block.what()} has no output {name!r}; {suggestion(name, names)}")
        return outs[0]

    def of_block(self, node: Node, block: Node, out: Out) -> Expression:
        if block.instance is None or out.name == "ENO":
            if (block.id, out.name) not in self.outputs:
                raise node.place.refuse(
                    f"{node.what()} takes {out.name} of {block.what()} from the scan before;"
                    " put a variable between"
                )
            return self.outputs[block.id, out.name]
        for name in roots(block.instance):
            callers = [other for other in self.order.running if name in self.order.writes(other)]
            if len(callers) > 1 and self.last.get(name) != block.id:
                raise node.place.refuse(f"{name} is called again before {node.what()} takes its output")
        value = Member(block.instance, out.name, out.place)
        return Unary("NOT", value, out.place) if out.negated else value

    # ------------------------------------------------------------ blocks

    def block(self, node: Node) -> None:
        own = self.source.find(node.block)
        if own is not None or node.block.upper() in BLOCKS:
            self.call(node)
            return
        if node.instance is not None:
            known = [*BLOCKS, *(unit.name for unit in self.source.units.values())]
            raise node.place.refuse(f"no block {node.block!r} is known; {suggestion(node.block, known)}")
        value = self.gate(node)
        outs = [out for out in node.outs if out.name != "ENO"]
        if len(outs) != 1:
            raise node.place.refuse(f"{node.what()} has {len(outs)} outputs; one is needed")
        if outs[0].negated:
            value = Unary("NOT", value, node.place)
        self.keep(node, outs[0].name, value)
        for out in node.outs:
            if out.name == "ENO":
                self.keep(node, "ENO", Literal(not out.negated, BOOL, out.place))
        self.write_out(node)

    def write_out(self, node: Node) -> None:
        """Variables that are directly at the outputs of a block."""
        for out in node.outs:
            for target in out.targets:
                value = self.of_block(node, node, out)
                self.statements.append(Assign(target, value, out.place))

    def gate(self, node: Node) -> Expression:
        """The value of a function."""
        given = []
        for pin in node.pins:
            value = self.input(node, pin)
            if pin.name == "EN":
                if value != Literal(True, BOOL, value.place):
                    raise pin.place.refuse(
                        f"{node.what()}: EN of a function: what it gives without EN differs between tools;"
                        " use SEL, or a block"
                    )
                continue
            given.append((pin.name, value))
        name, place = node.block.upper(), node.place
        if name in CHAINS or name in PAIRS:
            values = [value for _, value in self.in_order(node, given)]
            least, most = 2, 2 if name in PAIRS else len(values)
            if not least <= len(values) <= most:
                raise place.refuse(f"{node.what()} has {len(values)} inputs")
            found = values[0]
            for value in values[1:]:
                found = Binary({**CHAINS, **PAIRS}[name], found, value, place)
            return found
        if name == "NOT":
            if len(given) != 1:
                raise place.refuse(f"{node.what()} has {len(given)} inputs")
            return Unary("NOT", given[0][1], place)
        if len(given) == 1:
            given = [("", given[0][1])]
        found = Function(name, tuple(given), place)
        self.types.of(found)
        return found

    def in_order(self, node: Node, given: list[tuple[str, Expression]]) -> list[tuple[str, Expression]]:
        """Inputs IN1, IN2 .. by their numbers; without names as they are."""
        if not any(name for name, _ in given):
            return given
        numbered = {}
        for name, value in given:
            digits = name.removeprefix("IN")
            if name == digits or not digits.isdecimal():
                raise node.place.refuse(f"{node.what()} has no input {name}; its inputs are IN1, IN2 ..")
            numbered[int(digits)] = (name, value)
        return [numbered[number] for number in sorted(numbered)]

    def call(self, node: Node) -> None:
        """A call of a function block."""
        if node.instance is None:
            raise node.place.refuse(f"{node.what()}: a block needs an instanceName")
        kind = self.types.of(node.instance)
        if not isinstance(kind, Instance) or kind.block.upper() != node.block.upper():
            raise node.place.refuse(f"{node.what()}: its instance is no {node.block}")
        _, outs = sides(self.source, kind)
        for out in node.outs:
            if out.name != "ENO" and out.name not in [name.upper() for name in outs]:
                raise out.place.refuse(f"{node.block} has no output {out.name}; {suggestion(out.name, outs)}")
        inputs = []
        enabled: Expression | None = None
        for pin in node.pins:
            if pin.expression is None and not pin.sources and pin.name != "EN":
                if pin.negated or pin.edge != "none":
                    raise pin.place.refuse(f"{node.what()}: input {pin.name} is not connected")
                continue  # keeps its value
            value = self.input(node, pin)
            if pin.edge != "none" and any(other.name == "EN" for other in node.pins):
                raise pin.place.refuse(f"{node.what()}: an edge at an input beside EN is not supported")
            if pin.name == "EN":
                self.boolean(value, pin.place)
                enabled = value
            else:
                inputs.append((pin.name, value))
        body: Body = (Call(node.instance, tuple(inputs), (), node.place),)
        if enabled is not None:
            self.keep(node, "ENO", enabled)
            body = (If(((self.outputs[node.id, "ENO"], body),), (), node.place),)
        elif any(out.name == "ENO" for out in node.outs):
            self.keep(node, "ENO", Literal(True, BOOL, node.place))
        self.statements += body
        for out in node.outs:
            if out.name == "ENO" and out.negated:
                raise out.place.refuse("a negated ENO is not supported")
        for name in self.order.writes(node):
            self.last[name] = node.id
        self.write_out(node)
