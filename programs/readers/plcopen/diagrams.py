"""Function block diagrams and ladders of PLCopen XML: the elements of one body, as they are drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from programs.language.tree import Expression, Index, Member, Name, Place
from programs.readers.attributes import dropped, refusal, retained
from programs.readers.plcopen.xml_tree import Element

RUN = ("block", "outVariable", "inOutVariable", "contact", "coil")
"""The elements that do something."""
QUIET = ("inVariable", "connector", "continuation", "leftPowerRail", "rightPowerRail")
ATTRIBUTES = (
    *("localId", "globalId", "width", "height", "executionOrderId", "typeName", "instanceName", "name"),
    *("negated", "edge", "storage"),
)
HARMLESS = (
    *("objectid", "fbdcalltype", "inputparamtypes", "attributes", "projectstructure", "buildproperties"),
    *("interfaceasplaintext", "outputparamtypes", "sfcsettings"),
)
"""Ends of the names of vendors' data that do not change what a program does."""
MOST = 5_000
"""Elements of a body."""


@dataclass(frozen=True)
class Pin:
    """An input of an element: where its value comes from (element, its output), or an expression."""

    name: str
    place: Place
    sources: tuple[tuple[str, str], ...] = ()
    expression: Expression | None = None
    negated: bool = False
    edge: str = "none"


@dataclass(frozen=True)
class Out:
    """An output of a block; `targets`: variables that are written directly at the pin."""

    name: str
    place: Place
    negated: bool
    targets: tuple[Expression, ...]


@dataclass(frozen=True)
class Node:
    """An element of a body."""

    id: str
    kind: str
    place: Place
    pins: tuple[Pin, ...]
    outs: tuple[Out, ...] = ()
    variable: Expression | None = None
    """What a variable, contact or coil names."""
    block: str = ""
    instance: Expression | None = None
    label: str = ""
    """Of a connector or continuation."""
    negated: bool = False
    edge: str = "none"
    storage: str = "none"
    order: int | None = None
    network: int = 0
    area: tuple[int, int, int] = (0, 0, 0)
    """Top, bottom, left."""

    @property
    def runs(self) -> bool:
        """Whether it does something of its own in a scan."""
        return self.kind in RUN and not (self.kind == "inOutVariable" and not self.pins)

    def what(self) -> str:
        """For messages."""
        return f"{self.block or self.kind} {self.id}"


Parse = Callable[[str, Place], Expression]


def harmless(element: Element) -> None:
    """Refuse vendors' data that may change what the program does."""
    for data in (child for inner in element.all("addData") for child in inner.children):
        name = data.attributes.get("name", "?")
        if name.rpartition("/")[2].lower() not in HARMLESS:
            raise data.place.refuse(f"addData {name!r} may change what the program does: it is not supported")
        for part in (part for inner in data.all("BuildProperties") for part in inner.children):
            if part.name != "LinkAlways":
                raise part.place.refuse(
                    f"<{part.name}> may leave this out of the program; it is not supported"
                )
    for attribute, value, place in attributes_of(element):
        if not dropped(attribute, value) and not (element.name == "variable" and retained(attribute)):
            raise place.refuse(refusal(attribute))


def attributes_of(element: Element) -> Iterator[tuple[str, str, Place]]:
    """The attributes that CODESYS and TwinCAT keep beside an element: name and value."""
    for data in (child for inner in element.all("addData") for child in inner.children):
        for one in data.below("Attribute"):
            yield one.get("Name"), one.attributes.get("Value", ""), one.place


def only(element: Element, *names: str) -> None:
    """Refuse children that are not among these."""
    for child in element.children:
        if child.name not in (*names, "documentation", "addData"):
            raise child.place.refuse(f"<{child.name}> in <{element.name}> is not supported")
    harmless(element)


def choice(element: Element, name: str, *allowed: str) -> str:
    """An attribute that is one of these words; the first if it is not there."""
    value = element.attributes.get(name, allowed[0]).lower()
    if value not in allowed:
        raise element.place.refuse(f"{name}={value!r}: one of {', '.join(allowed)} is needed")
    return value


def truth(element: Element, name: str) -> bool:
    """An attribute that is true or false."""
    return choice(element, name, "false", "true", "0", "1") in ("true", "1")


def number(element: Element, name: str, least: int) -> int:
    """An attribute that is a whole number."""
    text = element.attributes.get(name, "0")
    try:
        value = int(float(text))
    except (ValueError, OverflowError):
        value = least - 1
    if value < least:
        raise element.place.refuse(f"{name}={text!r} is no whole number from {least} on")
    return value


# ---------------------------------------------------------------- what is drawn


def read_nodes(body: Element, parse: Parse) -> dict[str, Node]:
    """The elements of an FBD or LD body by their ids. Raises Unjudged with the line."""
    found: dict[str, Node] = {}
    network = 0
    harmless(body)
    for element in body.children:
        if element.name in ("comment", "addData", "documentation"):
            continue
        if element.name == "vendorElement":
            network += _separates(element)
            continue
        if element.name not in (*RUN, *QUIET):
            raise element.place.refuse(f"<{element.name}> is not supported in {body.name}")
        node = _node(element, parse, network)
        if node.id in found:
            raise element.place.refuse(f"localId {node.id} is there twice")
        found[node.id] = node
    if len(found) > MOST:
        raise body.place.refuse(f"{len(found):,} elements; a body has at most {MOST:,}")
    return found


def _separates(element: Element) -> bool:
    """Whether a vendor's element begins a network (3S), and does not only say how it is written; refuse any
    other."""
    for data in (child for inner in element.all("addData") for child in inner.children):
        name = data.attributes.get("name", "").rpartition("/")[2]
        kinds = [child.text.strip() for child in data.children]
        flags = [flag.attributes.get("name") for child in data.children for flag in child.children]
        if name == "fbdelementtype" and kinds == ["networktitle"]:
            return True
        if name == "implementationattributes" and flags == ["BoxInputFlagsSupported"]:
            return False
    raise element.place.refuse("<vendorElement>: only a network's title is known")


def _node(element: Element, parse: Parse, network: int) -> Node:
    kind, place = element.name, element.place
    for attribute in element.attributes:
        if attribute not in ATTRIBUTES:
            raise place.refuse(f"{attribute} of <{kind}> is not supported")
    if not element.get("localId").isdecimal():
        raise place.refuse(f"localId {element.get('localId')!r} is no number")
    position = element.child("position")
    top = 0 if position is None else number(position, "y", -(10**9))
    left = 0 if position is None else number(position, "x", -(10**9))
    order = number(element, "executionOrderId", 0) if "executionOrderId" in element.attributes else None
    if kind not in RUN and order:
        raise place.refuse(f"executionOrderId of <{kind}> is not supported")
    pins: list[Pin] = []
    outs: list[Out] = []
    variable: Expression | None = None
    instance: Expression | None = None
    allowed = ["position"]
    match kind:
        case "block":
            allowed += ["inputVariables", "inOutVariables", "outputVariables"]
            pins, outs = _block_pins(element, parse)
            if "instanceName" in element.attributes:
                instance = parse(element.get("instanceName"), place)
        case "inVariable" | "outVariable" | "inOutVariable":
            allowed += ["connectionPointIn", "connectionPointOut", "expression"]
            variable = _named(element, "expression", parse)
        case "contact" | "coil":
            allowed += ["connectionPointIn", "connectionPointOut", "variable"]
            variable = _named(element, "variable", parse)
        case _:
            allowed += ["connectionPointIn", "connectionPointOut"]
    only(element, *allowed)
    if kind in ("outVariable", "inOutVariable", "contact", "coil", "connector"):
        for point in element.all("connectionPointIn"):
            pins.append(_pin(point, "", parse))
        if len(pins) > 1 or (not pins and kind != "inOutVariable"):
            raise place.refuse(f"<{kind}> has {len(pins)} inputs; one is needed")
        if kind == "inOutVariable" and not (pins[0].sources if pins else ()):
            pins = []
    if kind in ("outVariable", "inOutVariable", "coil") and not isinstance(variable, Name | Member | Index):
        raise place.refuse(f"<{kind}>: a variable is needed, which can be written")
    return Node(
        element.get("localId"), kind, place, tuple(pins), tuple(outs), variable,
        element.get("typeName") if kind == "block" else "", instance,
        element.get("name") if kind in ("connector", "continuation") else "",
        truth(element, "negated"), choice(element, "edge", "none", "rising", "falling"),
        choice(element, "storage", "none", "set", "reset"), order, network,
        (top, top + number(element, "height", 0), left),
    )  # fmt: skip


def _named(element: Element, child: str, parse: Parse) -> Expression:
    found = element.child(child)
    if found is None or not found.text.strip():
        raise element.place.refuse(f"<{element.name}> names no variable")
    return parse(found.text, found.place)


def _block_pins(element: Element, parse: Parse) -> tuple[list[Pin], list[Out]]:
    pins, outs = [], []
    for group in element.children:
        if group.name == "inOutVariables" and group.children:
            raise group.place.refuse("VAR_IN_OUT is not supported")
        for variable in group.children if group.name in ("inputVariables", "outputVariables") else ():
            only(variable, "connectionPointIn", "connectionPointOut")
            if variable.name != "variable":
                raise variable.place.refuse(f"<{variable.name}> is not supported here")
            name, negated = variable.attributes.get("formalParameter", "").upper(), truth(variable, "negated")
            if choice(variable, "storage", "none", "set", "reset") != "none":
                raise variable.place.refuse("storage at the pin of a block is not supported")
            points = list(variable.all("connectionPointIn"))
            if group.name == "inputVariables":
                edge = choice(variable, "edge", "none", "rising", "falling")
                pin = _pin(points[0], name, parse, negated, edge) if points else Pin(name, variable.place)
                if len(points) > 1 or (negated and edge != "none") or variable.child("connectionPointOut"):
                    raise variable.place.refuse(f"input {name}: one connection, negated or at an edge")
                pins.append(pin)
                continue
            if points:
                raise variable.place.refuse(f"output {name} has a connectionPointIn")
            targets = [
                parse(expression.text, expression.place)
                for point in variable.all("connectionPointOut")
                for expression in point.all("expression")
                if expression.text.strip()
            ]
            if not all(isinstance(target, Name | Member | Index) for target in targets):
                raise variable.place.refuse(f"output {name} goes to something that is no variable")
            outs.append(Out(name, variable.place, negated, tuple(targets)))
    for names in ([pin.name for pin in pins], [out.name for out in outs]):
        for name in names:
            if names.count(name) > 1:
                raise element.place.refuse(f"pin {name or 'without a name'} is there twice")
    return pins, outs


def _pin(point: Element, name: str, parse: Parse, negated: bool = False, edge: str = "none") -> Pin:
    only(point, "relPosition", "connection", "expression")
    sources = []
    for connection in point.all("connection"):
        only(connection, "position")
        sources.append(
            (connection.get("refLocalId"), connection.attributes.get("formalParameter", "").upper())
        )
    written = [child for child in point.all("expression") if child.text.strip()]
    if len(written) + bool(sources) > 1:
        raise point.place.refuse("a connection and an expression at one input")
    expression = parse(written[0].text, written[0].place) if written else None
    return Pin(name, point.place, tuple(sources), expression, negated, edge)
