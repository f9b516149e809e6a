"""PLCopen XML (TC6 2.0, 2.01) into the language of `tree`: declarations, ST bodies, FBD and LD bodies.

Declarations and ST bodies are handed to the reader of Structured Text, line by line where they are in the
XML. A diagram becomes one statement or more for each of its elements, in the order of `networks`; what
comes out of a gate or a contact is a temporary variable. Whatever is not known here is refused.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from modeproof.ground.errors import Unjudged
from programs.language.pou_actions import Actions
from programs.language.time_literals import time_ms
from programs.language.tree import Body, Place, Source, Task, Unit, Variable
from programs.readers.attributes import retained
from programs.readers.plcopen.diagram_statements import Diagram
from programs.readers.plcopen.diagrams import attributes_of, harmless, only, truth
from programs.readers.plcopen.xml_tree import Element, read_xml
from programs.readers.structured_text.source_text import RETAINS, prepared
from programs.readers.structured_text.units import read_all, read_text

SPACES = ("http://www.plcopen.org/xml/tc6_0201", "http://www.plcopen.org/xml/tc6_0200")
POUS = {"functionBlock": "FUNCTION_BLOCK", "program": "PROGRAM", "function": "FUNCTION"}
SECTIONS = {
    "inputVars": "VAR_INPUT",
    "outputVars": "VAR_OUTPUT",
    "inOutVars": "VAR_IN_OUT",
    "localVars": "VAR",
    "tempVars": "VAR_TEMP",
    "externalVars": "VAR_EXTERNAL",
}
OTHERS = {
    "RSLogix5000Content": "L5X of Rockwell is not read; export the routine as Structured Text",
    "Document": "SimaticML of TIA is not read; let TIA generate the source of the block (.scl)",
    "STSource": "this form of Schneider is not read; export the section as Structured Text",
    "FEFExchangeFile": "XEF of Schneider is not read; export the section as Structured Text",
}
"""Roots of other XML, each with what to do."""
_RETAIN = re.compile(r"\b(?:RETAIN|PERSISTENT)\b", re.IGNORECASE)
_COMMENT = re.compile(r"//[^\n]*|\(\*.*?\*\)", re.DOTALL)
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_ADDRESS = re.compile(r"%[A-Za-z]+(?:\d+(?:\.\d+)*|\*)", re.ASCII)
Lower = Callable[[Source], Unit]
"""Makes the body of a unit once the declarations of all units are known."""


@dataclass
class Project:
    """What one file declares: its units, each with what makes its body, globals, tasks; what is refused.

    words: those in each POU that is refused, in upper case.
    """

    units: list[tuple[Unit, Lower]] = field(default_factory=list)
    refused: dict[str, Unjudged] = field(default_factory=dict)
    shared: list[Variable] = field(default_factory=list)
    tasks: list[Task] = field(default_factory=list)
    words: dict[str, frozenset[str]] = field(default_factory=dict)


def read_plcopen(text: bytes, file: str) -> Project:
    """The project in one file. Raises Unjudged for a file that is none."""
    root = read_xml(text, file)
    if root.name in OTHERS:
        raise root.place.refuse(OTHERS[root.name])
    if root.name != "project" or root.space not in SPACES:
        raise root.place.refuse(
            f"<{root.name}> in {root.space or 'no namespace'!r} is no PLCopen XML of TC6 2"
        )
    types = _Text()
    found = Project()
    for kind in _in_order(list(root.below("dataType"))):
        text_of_kind = _Text([*types.lines])
        try:
            text_of_kind.put(kind.place, f"TYPE {_identifier(kind, 'name')} : {_data_type(kind)}; END_TYPE")
            read_text("\n".join(text_of_kind.lines), file)
            types = text_of_kind
        except Unjudged as error:
            found.refused[kind.attributes.get("name", "").upper()] = error
            found.words[kind.attributes.get("name", "").upper()] = frozenset()
    names: set[str] = set()
    beyond: dict[str, frozenset[str]] = {}
    for pou in root.below("pou"):
        name = pou.get("name").upper()
        if name in names or name in found.refused:
            raise pou.place.refuse(f"there is another unit with the name {pou.get('name')}")
        names.add(name)
        found.words[name] = frozenset(_words(pou))
        try:
            found.units.append(_pou(pou, _Text([*types.lines]), file, beyond))
        except Unjudged as error:
            found.refused[name] = error
    if not names and not found.refused:
        raise root.place.refuse("the project has no POU")
    globals_ = _Text([*types.lines])
    for group in root.below("globalVars"):
        _put_group(group, "VAR_GLOBAL", globals_)
    read = read_all("\n".join(globals_.lines), file)
    found.shared = read.globals
    beyond.update(_beyond(root, found))
    for task in root.below("task"):
        programs = tuple(one.get("typeName") for one in task.all("pouInstance"))
        given = task.attributes.get("interval")
        interval = time_ms(given, task.place) if given and "#" in given else None
        found.tasks.append(Task(task.get("name"), interval, programs, task.place))
    return found


def _beyond(root: Element, project: Project) -> dict[str, frozenset[str]]:
    """For each POU the globals that it, or one that it names, may use: all whose names are in its text."""
    lists = {group.attributes.get("name", "").upper() for group in root.below("globalVars")} - {""}
    shared = lists | {one.name.upper() for one in project.shared}
    shared |= {
        variable.get("name").upper()
        for group in root.below("externalVars")
        for variable in group.all("variable")
    }
    found: dict[str, frozenset[str]] = {}
    for name in project.words:
        below, waiting = {name}, [name]
        while waiting:
            more = (project.words[waiting.pop()] & set(project.words)) - below
            below |= more
            waiting += more
        found[name] = frozenset().union(*(project.words[one] & shared for one in below))
    return found


def _in_order(kinds: list[Element]) -> list[Element]:
    """Data types, each behind those that it needs."""
    names = {kind.attributes.get("name", "").upper(): kind for kind in kinds}
    found: list[Element] = []

    def put(kind: Element, above: tuple[Element, ...]) -> None:
        if any(kind is one for one in (*found, *above)):
            return
        for needed in kind.below("derived"):
            other = names.get(needed.attributes.get("name", "").upper())
            if other is not None:
                put(other, (*above, kind))
        found.append(kind)

    for kind in kinds:
        put(kind, ())
    return found


def _words(element: Element) -> Iterator[str]:
    """The words of an element and of all within it, in upper case."""
    for text in (element.text, *element.attributes.values()):
        yield from re.findall(r"%?\w+", text.upper())
    for child in element.children:
        yield from _words(child)


def _pou(pou: Element, text: _Text, file: str, beyond: Mapping[str, frozenset[str]]) -> tuple[Unit, Lower]:
    """One POU, behind the data types of the project."""
    body = _body(pou, pou.get("name"))
    unit = _with_body(pou, _Text([*text.lines]), body, file)
    expected = [variable.get("name") for _, variable in _variables(pou)]
    expected += [unit.name] * (unit.kind == "function")
    if [variable.name for variable in unit.variables.values()] != expected:
        raise pou.place.refuse(f"{unit.name}: body or values declare other variables than the interface")
    if not any(variable.retained for variable in unit.variables.values()):
        _retains_nothing(pou, file)
    bodies: dict[str, Callable[[], Body]] = {}
    for action in (action for group in pou.all("actions") for action in group.children):
        key = action.get("name").upper()
        if key in bodies or key in unit.variables:
            raise action.place.refuse(f"{unit.name}: {action.get('name')} stands for something else too")
        bodies[key] = partial(_action, pou, action, text, file)
    return replace(unit, place=pou.place), _lower(unit, body, pou.place, bodies, beyond)


def _retains_nothing(pou: Element, file: str) -> None:
    """Refuse an interface that CODESYS keeps as text, too, and that retains there what the XML does not."""
    for kept in pou.below("InterfaceAsPlainText"):
        for part in (kept, *kept.below("xhtml")):
            said, _ = prepared("\n" * (part.text_line - 1) + part.text, file)
            if RETAINS in said or _RETAIN.search(_COMMENT.sub("", said)):
                raise kept.place.refuse("the text of this interface retains a variable, and the XML does not")


def _with_body(pou: Element, text: _Text, body: Element, file: str) -> Unit:
    """A POU with one of its bodies, behind the data types of the project."""
    _declare(pou, text, body)
    units = read_text("\n".join(text.lines), file)
    if len(units) != 1 or units[0].name != pou.get("name"):
        raise body.place.refuse(f"{pou.get('name')}: the body begins or ends another unit")
    return units[0]


def _action(pou: Element, action: Element, text: _Text, file: str) -> Body:
    """The statements of an action that is called."""
    only(action, "body")
    name = f"{pou.get('name')}.{action.get('name')}"
    body = _body(action, name)
    if body.name != "ST":
        raise body.place.refuse(f"{name}: an action in {body.name} is not supported")
    unit = _with_body(pou, _Text([*text.lines]), body, file)
    if not unit.body:
        raise body.place.refuse(f"{name}: the body has no statement")
    return unit.body


@dataclass
class _Text:
    """Structured Text, each piece in the line that it has in the XML."""

    lines: list[str] = field(default_factory=list)

    def put(self, place: Place, text: str, line: int = 0) -> None:
        self.lines += [""] * ((line or place.line) - len(self.lines))
        first, *rest = text.split("\n")
        self.lines[-1] += f" {first}"
        self.lines += rest


# ---------------------------------------------------------------- declarations


def _identifier(element: Element, attribute: str) -> str:
    name = element.get(attribute)
    if not _NAME.fullmatch(name):
        raise element.place.refuse(f"{name!r} is no name")
    return name


def _variables(pou: Element) -> Iterator[tuple[Element, Element]]:
    """Each declared variable with the group in which it is."""
    for interface in pou.all("interface"):
        for group in interface.children:
            for variable in group.children if group.name in SECTIONS else ():
                if variable.name == "variable":
                    yield group, variable


def _put_group(group: Element, section: str, text: _Text) -> None:
    """The variables of one group as Structured Text."""
    for child in group.children:
        if child.name not in ("variable", "documentation", "addData"):
            raise child.place.refuse(f"<{child.name}> in <{group.name}> is not supported")
    harmless(group)
    words = [section, *(["CONSTANT"] if truth(group, "constant") else [])]
    words += ["RETAIN"] if truth(group, "retain") or truth(group, "persistent") else []
    for variable in group.all("variable"):
        only(variable, "type", "initialValue")
        declared, given = variable.child("type"), variable.child("initialValue")
        if declared is None:
            raise variable.place.refuse("the variable has no <type>")
        value = "" if given is None else f" := {_value(given)}"
        name, at = _identifier(variable, "name"), variable.attributes.get("address", "")
        if at and not _ADDRESS.fullmatch(at):
            raise variable.place.refuse(f"AT {at}: no address")
        marks = [f"{{attribute '{said}'}}" for said, _, _ in attributes_of(variable) if retained(said)]
        place = f" AT {at}" if at else ""
        whole = f"{' '.join([*words, *marks])} {name}{place} : {_type(declared)}{value}; END_VAR"
        text.put(variable.place, whole)


def _declare(pou: Element, text: _Text, body: Element) -> None:
    kind = pou.get("pouType")
    if kind not in POUS:
        raise pou.place.refuse(f"{pou.get('name')}: a POU of type {kind} is not supported")
    only(pou, "interface", "body", "actions", "transitions")
    for group in pou.all("transitions"):
        if group.children:
            raise group.place.refuse("<transitions> of a POU are not supported")
    result = [_type(given) for interface in pou.all("interface") for given in interface.all("returnType")]
    if len(result) != (kind == "function"):
        raise pou.place.refuse(
            f"{pou.get('name')}: a function has one <returnType>, and nothing else has one"
        )
    text.put(pou.place, " : ".join([f"{POUS[kind]} {_identifier(pou, 'name')}", *result]))
    for interface in pou.all("interface"):
        only(interface, "returnType", *SECTIONS)
        for group in (group for group in interface.children if group.name in SECTIONS):
            _put_group(group, SECTIONS[group.name], text)
    if body.name == "ST":
        inner = _text_of(body)
        text.put(inner.place, inner.text, inner.text_line)
        text.put(inner.place, "\n" + f"END_{POUS[kind]}")
        return
    text.put(pou.place, f"END_{POUS[kind]}")


def _body(pou: Element, name: str) -> Element:
    """The one body of a POU or of an action; an empty one is refused."""
    bodies = list(pou.all("body"))
    if len(bodies) != 1:
        raise pou.place.refuse(f"{name} has {len(bodies)} bodies; one is needed")
    harmless(bodies[0])
    languages = [child for child in bodies[0].children if child.name not in ("documentation", "addData")]
    if len(languages) != 1:
        raise bodies[0].place.refuse(f"{name}: a body in one language is needed, not {len(languages)}")
    body = languages[0]
    if body.name not in ("ST", "FBD", "LD"):
        raise body.place.refuse(f"{name}: a body in {body.name} is not supported")
    if body.name == "ST" and not _text_of(body).text.strip():
        raise body.place.refuse(f"{name}: the body is empty")
    return body


def _text_of(body: Element) -> Element:
    """The element that holds the text of a body: nothing but text."""
    if not body.children:
        return body
    if len(body.children) > 1 or body.children[0].children or body.text.strip():
        raise body.place.refuse("<ST> holds more than one text")
    return body.children[0]


def _type(element: Element) -> str:
    """A type as Structured Text."""
    if len(element.children) != 1:
        raise element.place.refuse("one type is needed")
    (kind,) = element.children
    if kind.name == "derived":
        return _identifier(kind, "name")
    if kind.name == "array":
        only(kind, "dimension", "baseType")
        ranges, base = list(kind.all("dimension")), kind.child("baseType")
        if not ranges or base is None:
            raise kind.place.refuse("an array has a range and one base type here")
        shown = ", ".join(f"{one.get('lower')}..{one.get('upper')}" for one in ranges)
        return f"ARRAY [{shown}] OF {_type(base)}"
    if kind.children or kind.attributes or kind.name != kind.name.upper():
        raise kind.place.refuse(f"type {kind.name} is not supported")
    return kind.name


def _data_type(kind: Element) -> str:
    only(kind, "baseType", "initialValue")
    base = kind.child("baseType")
    found = None if base is None or len(base.children) != 1 else base.children[0]
    if base is None or found is None:
        raise kind.place.refuse(f"data type {kind.attributes.get('name')}: a base type is needed")
    given = kind.child("initialValue")
    first = "" if given is None else f" := {_value(given)}"
    if found.name == "struct":
        only(found, "variable")
        members = [_member(member) for member in found.all("variable")]
        if first:
            raise kind.place.refuse("a structure with a first value of its own is not supported")
        return f"STRUCT {' '.join(members)} END_STRUCT"
    if found.name != "enum":
        return _type(base) + first
    only(found, "values", "baseType")
    values = [value for group in found.all("values") for value in group.children]
    shown = [
        _identifier(value, "name") + (f" := {value.get('value')}" if "value" in value.attributes else "")
        for value in values
    ]
    return f"({', '.join(shown)}){first}"


def _member(variable: Element) -> str:
    """A member of a structure as Structured Text."""
    only(variable, "type", "initialValue")
    declared, given = variable.child("type"), variable.child("initialValue")
    if declared is None or "address" in variable.attributes:
        raise variable.place.refuse("a member of a structure has a type, and no address here")
    value = "" if given is None else f" := {_value(given)}"
    return f"{_identifier(variable, 'name')} : {_type(declared)}{value};"


def _value(element: Element) -> str:
    """An initial value as Structured Text."""
    kinds = [child for child in element.children if child.name in ("simpleValue", "arrayValue")]
    if len(element.children) != 1 or not kinds:
        raise element.place.refuse("this kind of initial value is not supported")
    (given,) = kinds
    if given.name == "simpleValue":
        return given.get("value")
    values = []
    for part in given.children:
        times = part.attributes.get("repetitionValue", "1")
        values.append(_value(part) if times == "1" else f"{times}({_value(part)})")
    return f"[{', '.join(values)}]"


# ---------------------------------------------------------------- bodies


def _lower(
    unit: Unit,
    body: Element,
    place: Place,
    actions: dict[str, Callable[[], Body]],
    beyond: Mapping[str, frozenset[str]],
) -> Lower:
    def lower(source: Source) -> Unit:
        if body.name == "ST":
            if not unit.body:
                raise body.place.refuse(f"{unit.name}: the body has no statement")
            for key in set(actions) & set(source.units):
                raise place.refuse(f"{unit.name}: {key} is an action and a unit")
            return replace(unit, body=Actions(actions).inlined(unit.body), place=place)
        if unit.kind == "function" or unit.of("in_out"):
            raise body.place.refuse(
                f"{unit.name}: a function, and a block with VAR_IN_OUT, has a body in ST here"
            )
        return Diagram(source, unit, body, beyond).unit(place)

    return lower
