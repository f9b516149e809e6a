"""What is no diagram that can be judged: refused with file, line and cause, never left out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.equality.comparison import make
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine
from tests.programs.drawn import block, pou, project, read, reading, wire, writing

A = reading(1, "a")
Q = writing(5, "q", 4)


def edge(number: int, more: str, out: str = "Q", kind: str = "R_TRIG") -> str:
    """A block that waits for an edge of a."""
    return block(number, kind, {"CLK": 1}, out, more)


def order(number: int) -> str:
    """The place in the order."""
    return f'executionOrderId="{number}"'


GOOD = A + writing(5, "q", 1)
HTML = 'xmlns="http://www.w3.org/1999/xhtml"'


def st(text: str, **groups: str) -> str:
    """A function block in Structured Text; the text begins in the fifth line."""
    return pou(f"<p {HTML}>{text}</p>", language="ST", **groups)


PROJECTS = {
    "no XML": ("FUNCTION_BLOCK B", "b.xml:1: not well-formed XML"),
    "XML that ends early": (project(pou(GOOD))[:-9], "b.xml:9: not well-formed XML"),
    "entities": (f"<!DOCTYPE p [<!ENTITY e 'x'>]>{project(pou(GOOD))[21:]}", "b.xml:1: a document type"),
    "an unknown encoding": ("<?xml version='1.0' encoding='latin9000'?><project/>", "b.xml:1: the encoding"),
    "another XML": ("<project/>", "b.xml:1: <project> in 'no namespace' is no PLCopen XML"),
    "another version": (project(pou(GOOD)).replace("0201", "0100"), "b.xml:2: <project> in"),
    "no POU": (project(), "the project has no POU"),
    "a function without a result": (
        project(pou(GOOD).replace("functionBlock", "function", 1)),
        "B: a function has one <returnType>",
    ),
    "two POUs of one name": (project(pou(GOOD), pou(GOOD, name="b")), "another unit with the name b"),
    "a POU with the name of a standard block": (
        project(pou(GOOD, name="TON"), pou(GOOD)),
        "TON is the name of a standard block",
    ),
    "no body": (project(re.sub("<body>.*</body>", "", pou(GOOD), flags=re.DOTALL)), "B has 0 bodies"),
    "two bodies": (project(pou(GOOD).replace("</body>", "</body><body><ST/></body>")), "B has 2 bodies"),
    "a chart": (project(pou("", language="SFC")), "a body in SFC is not supported"),
    "a list": (project(pou("", language="IL")), "a body in IL is not supported"),
    "an empty diagram": (project(pou("")), "B: the body does nothing"),
    "an empty ladder": (project(pou('<leftPowerRail localId="1"/>', language="LD")), "the body does nothing"),
    "an empty text": (project(st(" \n ")), "B: the body is empty"),
    "a text of comments": (project(st("(* q := a; *)")), "B: the body has no statement"),
    "a text in two pieces": (
        project(pou(f"<p {HTML}>q := a;</p><p {HTML}/>", language="ST")),
        "more than one",
    ),
    "transitions of a chart": (
        project(pou(GOOD).replace("<body>", "<transitions><transition name='x'/></transitions><body>")),
        "<transitions> of a POU are not supported",
    ),
    "a method of a vendor": (
        project(pou(GOOD).replace("<body>", '<addData><data name="http://x/method"/></addData><body>')),
        "addData 'http://x/method' may change what the program does",
    ),
    "a body that begins another unit": (
        project(st("q := a; END_FUNCTION_BLOCK FUNCTION_BLOCK C q := a;")),
        "B: the body begins or ends another unit",
    ),
    "a value that declares more": (
        project(pou(GOOD, localVars="x BOOL TRUE; z: BOOL := FALSE, y BOOL")),
        "declare other variables than the interface",
    ),
    "a value with a comment": (
        project(pou(GOOD, localVars="x INT 1 (*, y INT *) 2")),
        "b.xml:3: syntax error",
    ),
    "a name that is none": (project(pou(GOOD).replace('name="x"', 'name="x : INT; z"')), "is no name"),
    "an address": (project(pou(GOOD).replace('name="x"', 'name="x" address="%K0.0"')), "syntax error"),
    "a forged address": (
        project(pou(GOOD).replace('name="x"', 'name="x" address="%I0.0 : BOOL; y"')),
        "AT %I0.0 : BOOL; y: no address",
    ),
    "an in-out": (project(pou(GOOD, inOutVars="z BOOL")), "a block with VAR_IN_OUT, has a body in ST here"),
    "a real number": (project(pou(GOOD, localVars="z REAL")), "type REAL is not supported"),
    "a structure": (
        project(pou(GOOD, "z S"), types='<dataType name="S"><baseType><struct/></baseType></dataType>'),
        "syntax error",
    ),
    "a block in itself": (
        project(pou(A + block(4, "B", {"a": 1}, "q", 'instanceName="z"') + Q, "z B")),
        "B calls B: a block must not contain itself",
    ),
    "a fault in a text": (project(st("q := a;\n\nq := ghost;")), "b.xml:7: ghost is not declared"),
}
BODIES = {
    "an output without a source": (
        A + "<outVariable localId='5'><connectionPointIn/><expression>q</expression></outVariable>",
        "outVariable 5: input is not connected",
    ),
    "an open input of a gate": (
        A + block(4, "AND", {"IN1": 1, "IN2": None}) + Q,
        "AND 4: input IN2 is not connected",
    ),
    "a connection to nothing": (GOOD + writing(6, "r", 77), "connection to 77: there is no such element"),
    "a connection to an output variable": (GOOD + writing(6, "r", 5), "which has no output"),
    "an unknown output": (A + block(4, "NOT", {"IN": 1}) + writing(5, "q", "4.ON"), "has no output 'ON'"),
    "an unknown block": (A + block(4, "TONN", {"IN": 1}, "Q", 'instanceName="z"') + Q, "did you mean 'TON'"),
    "an unknown function": (A + block(4, "SQRT", {"IN": 1}) + Q, "function SQRT is not supported"),
    "an unknown pin": (A + block(4, "AND", {"IN1": 1, "INX": 1}) + Q, "AND 4 has no input INX"),
    "an unknown variable": (A + writing(5, "qq", 1), "qq is not declared; did you mean 'q'"),
    "an unknown element": (GOOD + '<macro localId="7"/>', "<macro> is not supported in FBD"),
    "a jump": (GOOD + '<jump localId="7" label="x"/>', "<jump> is not supported in FBD"),
    "a return": (GOOD + '<return localId="7"/>', "<return> is not supported in FBD"),
    "an element of a vendor": (GOOD + '<vendorElement localId="7"/>', "only a network's title is known"),
    "an unknown attribute": (A + writing(5, "q", 1, 'negatedIn="true"'), "negatedIn of <outVariable>"),
    "an id that stands twice": (GOOD + writing(5, "r", 1), "localId 5 is there twice"),
    "an order that stands twice": (
        A + writing(5, "q", 1, order(3)) + writing(6, "r", 1, order(3)),
        "executionOrderId 3 is there twice",
    ),
    "an order that is no number": (A + writing(5, "q", 1, 'executionOrderId="x"'), "is no whole number"),
    "two sources of an input": (
        A
        + writing(5, "q", 1).replace(
            "</connectionPointIn>", '<connection refLocalId="1"/></connectionPointIn>'
        ),
        "2 connections at one input; use OR",
    ),
    "a loop without an order": (
        A + block(4, "OR", {"IN1": 1, "IN2": 6}) + block(6, "NOT", {"IN": 4}) + Q,
        "is in a loop",
    ),
    "a loop of gates with an order": (
        A
        + block(4, "OR", {"IN1": 1, "IN2": 6}, more=order(1))
        + block(6, "NOT", {"IN": 4}, more=order(2))
        + Q,
        "from the scan before; put a variable between",
    ),
    "a variable whose order is open": (
        A + reading(2, "x") + writing(5, "x", 1) + writing(6, "q", 2),
        "X: outVariable 5 (line 7) and outVariable 6 use it, and nothing says which comes first",
    ),
    "two writers whose order is open": (
        A + reading(2, "b") + writing(5, "q", 1) + writing(6, "q", 2),
        "nothing says which comes first",
    ),
    "a variable written between two uses": (
        reading(1, "x")
        + reading(2, "a")
        + writing(5, "q", 1, order(1))
        + writing(6, "x", 2, order(2))
        + writing(7, "r", 1, order(3)),
        "is written between two uses of it",
    ),
    "a function that is not always enabled": (
        A + block(4, "NOT", {"EN": 1, "IN": 1}, "ENO, OUT") + writing(5, "q", "4.OUT"),
        "EN of a function",
    ),
    "an output taken after the next call": (
        A
        + "".join(edge(n, f'instanceName="z" {order(n)}') for n in (3, 4))
        + writing(5, "q", "3.Q", order(5)),
        "Z is called again before outVariable 5",
    ),
    "a block without an instance": (A + edge(4, "") + Q, "a block needs an instanceName"),
    "an instance of another block": (
        A + edge(4, 'instanceName="z"', kind="F_TRIG") + Q,
        "its instance is no F_TRIG",
    ),
    "an output that the block has not": (
        A + edge(4, 'instanceName="z"', "QQ") + Q,
        "R_TRIG has no output QQ",
    ),
    "a text that is two statements": (reading(1, "a); q := (b") + writing(5, "q", 1), "is no expression"),
    "a continuation of nothing": (
        A + "<continuation localId='3' name='k'/>" + writing(5, "q", 3),
        "continuation k",
    ),
    "a number for a truth": (reading(1, "n") + writing(5, "q", 1), "BOOL := INT needs a conversion"),
    "a write to an input": (A + writing(5, "b", 1), "b is an input and is written"),
}
LADDERS = {
    "a contact without power": (
        f"<contact localId='2'>{wire(1)}<connectionPointOut/><variable>a</variable></contact>".replace(
            '<connection refLocalId="1"/>', ""
        ),
        "contact 2: input is not connected",
    ),
    "a contact of a number": (
        f"<contact localId='2'>{wire(1)}<variable>n</variable></contact>",
        "a value of kind bool is needed",
    ),
    "a coil without a variable": (f"<coil localId='2'>{wire(1)}</coil>", "<coil> names no variable"),
    "a stored coil that is negated": (
        f"<coil localId='2' negated='true' storage='set'>{wire(1)}<variable>q</variable></coil>",
        "set with negation or edge is not supported",
    ),
}


def refusal(text: str, folder: Path) -> str:
    """The line that refuses a project, without the folder."""
    with pytest.raises(Unjudged) as caught:
        source = read(text, folder)
        source.main()
    return caught.value.message.replace(f"{folder}/", "")


@pytest.mark.parametrize("name", PROJECTS)
def test_a_project_that_cannot_be_read_is_refused(name: str, tmp_path: Path) -> None:
    text, cause = PROJECTS[name]
    said = refusal(text, tmp_path)
    assert cause in said and re.match(r"b\.xml:\d+: ", said)


@pytest.mark.parametrize("name", BODIES)
def test_a_diagram_that_is_not_clear_is_refused(name: str, tmp_path: Path) -> None:
    body, cause = BODIES[name]
    said = refusal(project(pou(body, "z R_TRIG")), tmp_path)
    assert cause in said and re.match(r"b\.xml:\d+: ", said)


@pytest.mark.parametrize("name", LADDERS)
def test_a_ladder_that_is_not_clear_is_refused(name: str, tmp_path: Path) -> None:
    body, cause = LADDERS[name]
    said = refusal(project(pou(f"<leftPowerRail localId='1'/>{body}", language="LD")), tmp_path)
    assert cause in said and re.match(r"b\.xml:\d+: ", said)


def test_a_diagram_that_writes_an_output_is_refused(tmp_path: Path) -> None:
    drawn = project(pou(A + writing(5, "z.Q", 1), "z R_TRIG"))
    ladder = f"<leftPowerRail localId='1'/><coil localId='2'>{wire(1)}<variable>z.Q</variable></coil>"
    for text, line in ((drawn, 6), (project(pou(ladder, "z R_TRIG", language="LD")), 5)):
        assert refusal(text, tmp_path) == f"b.xml:{line}: Q is an output of a block and is written"


def test_the_command_refuses_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "b.xml"
    path.write_text(project(st("")), "utf-8")
    assert main(["prove-program", str(path), "--target", "sf_edm"]) == 2
    said = capsys.readouterr()
    assert "B: the body is empty" in said.err and said.err.count("\n") == 1 and said.out == ""


def test_texts_in_a_project_are_read(tmp_path: Path) -> None:
    source = read(project(st("q := a AND NOT b;\nIF a &lt;&gt; b THEN r := TRUE; END_IF")), tmp_path)
    of = Machine(source, source.units["B"])
    assert of.scan({"a": True, "b": False}, 1)["q"] and of.memory.values["R"]
    assert source.units["B"].body[1].place.line == 6


def test_enumerations_of_a_project_are_read(tmp_path: Path) -> None:
    values = "<values><value name='Red'/><value name='Green'/></values>"
    types = f"<dataType name='Colour'><baseType><enum>{values}</enum></baseType></dataType>"
    body = reading(1, "Colour#Green") + reading(2, "z") + block(4, "EQ", {"IN1": 1, "IN2": 2})
    source = read(project(pou(body + Q, "z Colour Green"), types=types), tmp_path)
    assert Machine(source, source.units["B"]).scan({}, 1)["q"]


def test_a_dropped_body_would_be_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from programs.readers.plcopen import project as plcopen

    right = plcopen._text_of

    def emptied(body: plcopen.Element) -> plcopen.Element:
        found = right(body)
        found.text = "(* lost *)" if found.text.strip() else ""
        return found

    monkeypatch.setattr(plcopen, "_text_of", emptied)
    assert "the body has no statement" in refusal(project(st("q := a;")), tmp_path)


def test_a_block_that_is_not_needed_may_be_refused(tmp_path: Path) -> None:
    path = tmp_path / "b.xml"
    own = pou(A + block(4, "Other", {"a": 1}, "q", 'instanceName="z"') + Q, "z Other", name="Uses")
    path.write_text(project(pou(GOOD), pou("", name="Other"), own), "utf-8")
    assert read_sources([path]).units["B"].body
    with pytest.raises(Unjudged, match="Other: the body does nothing"):
        read_sources([path]).main()
    for unit in ("Uses", "Other"):
        with pytest.raises(Unjudged, match="Other: the body does nothing"):
            make([path], "sf_edm", unit=unit)
