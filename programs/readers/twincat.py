"""The files of TwinCAT 3 (.TcPOU, .TcDUT, .TcGVL, .TcTTO, .plcproj) as Structured Text and tasks.

Declarations and bodies are Structured Text within XML; each piece stays in the line that it has there.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from modeproof.ground.errors import Unjudged
from programs.language.tree import Task
from programs.readers.plcopen.xml_tree import Element, read_xml

SUFFIXES = (".tcpou", ".tcdut", ".tcgvl")
TASKS = ".tctto"
PROJECT = ".plcproj"
_NO_TEXT = re.compile(r"//[^\n]*|\(\*.*?\*\)|\{[^{}]*\}", re.DOTALL)
_HEAD = re.compile(r"\s*(PROGRAM|FUNCTION_BLOCK|FUNCTION|TYPE|VAR_GLOBAL|INTERFACE)\b", re.IGNORECASE)
_OTHERS = (".tcvis", ".tcvmo", ".tctlo", ".tcgtlo", ".tcimo", ".tcio", ".tcrmo")
IMPLICIT = ("FB_INIT", "FB_REINIT", "FB_EXIT")
"""Methods that the controller calls by itself."""


@dataclass
class Container:
    """One file: its text with the lines of the XML, its actions as texts, and what it is called.

    methods: methods and properties, which only others call.
    """

    text: str
    name: str
    list: str = ""
    actions: dict[str, str] = field(default_factory=dict)
    methods: tuple[str, ...] = ()


def read_container(text: bytes, file: str) -> Container:
    """What is in a file. Raises Unjudged with file, line and cause."""
    root = read_xml(text, file)
    if root.name != "TcPlcObject" or len(root.children) != 1:
        raise root.place.refuse(f"<{root.name}> is no file of TwinCAT 3 with one POU, type or list")
    (what,) = root.children
    declared = what.child("Declaration")
    if what.name not in ("POU", "DUT", "GVL") or declared is None:
        raise what.place.refuse(f"<{what.name}> of TwinCAT is not supported")
    head = _HEAD.match(_NO_TEXT.sub(" ", declared.text))
    word = head[1].upper() if head is not None else "?"
    expected = {"DUT": ("TYPE",), "GVL": ("VAR_GLOBAL",)}
    if word not in expected.get(what.name, ("PROGRAM", "FUNCTION_BLOCK", "FUNCTION")):
        raise declared.place.refuse(f"a declaration of {what.name} does not begin with {word}")
    name = what.get("Name")
    found = Container(_at(declared), name, name if what.name == "GVL" else "")
    if what.name != "POU":
        return found
    body = _body(what, name)
    end = f"\nEND_{word}\n"
    found.text = _joined(found.text, body) + end
    methods = []
    for child in what.children:
        match child.name:
            case "Action":
                key = child.get("Name").upper()
                if key in found.actions:
                    raise child.place.refuse(f"{name}: the action {child.get('Name')} is there twice")
                found.actions[key] = _joined(_at(declared), _body(child, f"{name}.{child.get('Name')}")) + end
            case "Method" | "Property":
                if child.get("Name").upper() in IMPLICIT:
                    raise child.place.refuse(
                        f"{name}: {child.get('Name')}, which runs by itself, is not supported"
                    )
                methods.append(child.get("Name"))
            case "Declaration" | "Implementation" | "Folder" | "LineIds":
                pass
            case _:
                raise child.place.refuse(f"{name}: <{child.name}> is not supported")
    found.methods = tuple(methods)
    return found


def _body(element: Element, name: str) -> Element | None:
    """The text of a body; None: it is empty."""
    given = element.child("Implementation")
    if given is None:
        return None
    if len(given.children) != 1 or given.children[0].name != "ST":
        kind = given.children[0].name if given.children else "nothing"
        raise given.place.refuse(f"{name}: a body in {kind} is not supported; export it as PLCopen XML")
    return given.children[0]


def _at(element: Element) -> str:
    """The text of an element, in its line."""
    return "\n" * (max(element.text_line, 1) - 1) + element.text


def _joined(text: str, body: Element | None) -> str:
    """A declaration with a body behind it, in its line."""
    if body is None or not body.text_line:
        return text
    missing = body.text_line - 1 - text.count("\n")
    return text + ("\n" * missing if missing > 0 else "\n") + body.text


def tasks_in(text: bytes, file: str) -> list[Task]:
    """The task of a file (.TcTTO). Raises Unjudged."""
    found = []
    for task in read_xml(text, file).below("Task"):
        cycle = task.child("CycleTime")
        micros = cycle.text.strip() if cycle is not None else ""
        if not micros.isdigit():
            raise task.place.refuse("the task has no <CycleTime>")
        if int(micros) % 1000:
            raise task.place.refuse(f"a cycle of {micros} microseconds is no whole number of ms")
        names = [name.text.strip() for call in task.all("PouCall") for name in call.all("Name")]
        found.append(Task(task.get("Name"), int(micros) // 1000, tuple(names), task.place))
    return found


def files_of(project: Path, text: bytes) -> list[Path]:
    """The files that a project (.plcproj) is built of, in its order. Raises Unjudged."""
    found = []
    for item in read_xml(text, str(project)).below("Compile"):
        name = Path(*item.get("Include").replace("\\", "/").split("/"))
        excluded = item.child("ExcludeFromBuild")
        if excluded is not None and excluded.text.strip().lower() == "true":
            continue
        if name.suffix.lower() in (*SUFFIXES, TASKS):
            found.append(project.parent / name)
        elif name.suffix.lower() not in (
            ".tcvis",
            ".tcvmo",
            ".tctlo",
            ".tcgtlo",
            ".tcimo",
            ".tcio",
            ".tcrmo",
        ):
            raise item.place.refuse(f"{name}: a file of this kind in a project is not supported")
    if not found:
        raise Unjudged(f"{project}: the project lists no POU")
    return found
