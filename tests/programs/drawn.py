"""Small PLCopen XML projects for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from programs.language.subset import check
from programs.language.tree import Source
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine

SPACE = "http://www.plcopen.org/xml/tc6_0201"
INTERFACE = {
    "inputVars": "a BOOL, b BOOL, c BOOL, n INT, m INT, w WORD, t TIME",
    "outputVars": "q BOOL, r BOOL, i INT, v WORD, e TIME",
    "localVars": "x BOOL, y BOOL",
}


def variable(text: str) -> str:
    """`name TYPE value` as XML; the value may be missing."""
    name, kind, *value = text.split(maxsplit=2)
    own = kind not in ("BOOL", "INT", "WORD", "TIME", "REAL")
    declared = f'<derived name="{kind}"/>' if own else f"<{kind}/>"
    given = f'<initialValue><simpleValue value="{value[0]}"/></initialValue>' if value else ""
    return f'<variable name="{name}"><type>{declared}</type>{given}</variable>'


def pou(body: str, local: str = "", name: str = "B", language: str = "FBD", **groups: str) -> str:
    """A function block; the body begins in its sixth line."""
    every = {**INTERFACE, **groups}
    every["localVars"] += f", {local}" if local else ""
    shown = "".join(
        f"<{group}>{''.join(variable(part) for part in text.split(', ') if part)}</{group}>"
        for group, text in every.items()
    )
    return (
        f'<pou name="{name}" pouType="functionBlock"><interface>{shown}</interface>\n<body><{language}>\n'
        f"{body}\n</{language}></body></pou>\n"
    )


def project(*pous: str, types: str = "") -> str:
    """A project; its first POU begins in the third line."""
    return (
        f'<?xml version="1.0"?>\n<project xmlns="{SPACE}"><types><dataTypes>{types}</dataTypes><pous>\n'
        f"{''.join(pous)}</pous></types></project>\n"
    )


def reading(number: int, text: str, more: str = "") -> str:
    """An inVariable."""
    return (
        f'<inVariable localId="{number}" {more}><connectionPointOut/><expression>{text}</expression>'
        "</inVariable>\n"
    )


def wire(source: int | str) -> str:
    """A connection to an element, or to an output of it: `3` or `3.Q`."""
    target, _, pin = str(source).partition(".")
    named = f' formalParameter="{pin}"' if pin else ""
    return f'<connectionPointIn><connection refLocalId="{target}"{named}/></connectionPointIn>'


def writing(number: int, text: str, source: int | str, more: str = "") -> str:
    """An outVariable."""
    inner = f"{wire(source)}<expression>{text}</expression>"
    return f'<outVariable localId="{number}" {more}>{inner}</outVariable>\n'


def block(number: int, kind: str, pins: dict[str, Any], out: str = "OUT", more: str = "") -> str:
    """A block; a pin is an element's number, or (number, further attributes)."""
    ins = ""
    for name, source in pins.items():
        number_of, extra = source if isinstance(source, tuple) else (source, "")
        point = "<connectionPointIn/>" if number_of is None else wire(number_of)
        ins += f'<variable formalParameter="{name}" {extra}>{point}</variable>'
    outs = "".join(
        f'<variable formalParameter="{name}" {extra}><connectionPointOut/></variable>'
        for name, _, extra in (part.partition(" ") for part in out.split(", "))
    )
    return (
        f'<block localId="{number}" typeName="{kind}" {more}><inputVariables>{ins}</inputVariables>'
        f"<outputVariables>{outs}</outputVariables></block>\n"
    )


def read(text: str, folder: Path, name: str = "b.xml") -> Source:
    """The units of a text, looked at by the check as well."""
    path = folder / name
    path.write_text(text, "utf-8")
    source = read_sources([path])
    check(source, source.units["B"])
    return source


def machine(folder: Path, body: str, local: str = "", language: str = "FBD", more: str = "") -> Machine:
    """A block with this body, ready to run."""
    source = read(project(more, pou(body, local, language=language)), folder)
    return Machine(source, source.units["B"])


def rows(of: Machine, pattern: str, name: str = "q", inputs: str = "abc") -> str:
    """The output in each scan of 10 ms; each word of the pattern has a digit for each input."""
    shown = ""
    for word in pattern.split():
        given = {key: digit == "1" for key, digit in zip(inputs, word, strict=False)}
        shown += str(int(of.scan(given, 10)[name]))
    return shown
