"""Actions of a POU in PLCopen XML, and what a vendor adds that changes nothing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from programs.semantics.interpreter import Machine
from programs.semantics.terms import slots
from tests.programs.drawn import machine, pou, project, read, reading, rows, writing
from tests.programs.fuzz import difference_of_translator

HTML = 'xmlns="http://www.w3.org/1999/xhtml"'


def action(name: str, text: str, language: str = "ST") -> str:
    """An action; its text begins in its own line."""
    return f'<action name="{name}"><body><{language}>\n<p {HTML}>{text}</p></{language}></body></action>'


def with_actions(text: str, *actions: str, local: str = "") -> str:
    """A project of one block in Structured Text with actions."""
    made = pou(f"<p {HTML}>{text}</p>", local, language="ST")
    return project(made.replace("</interface>", f"</interface><actions>{''.join(actions)}</actions>"))


def run(folder: Path, text: str, *actions: str, local: str = "") -> Machine:
    """The block, after a look at the translator too."""
    source = read(with_actions(text, *actions, local=local), folder)
    assert not difference_of_translator(source, source.units["B"], 1, 30)
    return Machine(source, source.units["B"])


def test_an_action_runs_where_it_is_called(tmp_path: Path) -> None:
    of = run(tmp_path, "x := a; Take(); x := FALSE; r := b;", action("Take", "q := x;"))
    assert rows(of, "10 00 11") == "101"


def test_an_action_runs_only_when_called(tmp_path: Path) -> None:
    of = run(tmp_path, "IF b THEN TOGGLE(); END_IF", action("Toggle", "q := NOT q;"))
    assert rows(of, "00 01 00 01 01") == "01101"


def test_actions_call_actions_and_keep_timers(tmp_path: Path) -> None:
    outer, inner = (
        action("Outer", "Inner(); r := NOT q;"),
        action("Inner", "t1(IN := a, PT := T#20ms); q := t1.Q;"),
    )
    of = run(tmp_path, "Outer();", outer, inner, local="t1 TON")
    assert rows(of, "1 1 1 0 1") == "00100"


def test_an_action_in_a_loop_runs_each_turn(tmp_path: Path) -> None:
    body = "i := 0; FOR k := 1 TO 3 DO IF a THEN More(); END_IF END_FOR q := i = 3;"
    of = run(tmp_path, body, action("More", "i := i + 1;"), local="k INT")
    assert rows(of, "0 1 0") == "010"


def test_a_chart_that_is_not_called_does_nothing(tmp_path: Path) -> None:
    of = run(tmp_path, "q := a;", action("Chart", "", "SFC"), action("Other", "q := TRUE;"))
    assert rows(of, "0 1 0") == "010"


REFUSED = {
    "a chart": ("Act();", [action("Act", "", "SFC")], "B.Act: a body in SFC is not supported"),
    "a diagram": ("Act();", [action("Act", "", "FBD")], "B.Act: an action in FBD is not supported"),
    "an empty action": ("Act();", [action("Act", " ")], "B.Act: the body is empty"),
    "an action of comments": ("Act();", [action("Act", "(* q *)")], "B.Act: the body has no statement"),
    "arguments": ("Act(a := b);", [action("Act", "q := a;")], "ACT is an action: it has no arguments"),
    "a ring": (
        "One();",
        [action("One", "Two();"), action("Two", "One();")],
        "ONE calls TWO calls ONE: an action must not call itself",
    ),
    "RETURN": ("Act();", [action("Act", "IF a THEN RETURN; END_IF q := a;")], "RETURN or EXIT that ends"),
    "a variable of that name": ("q := a;", [action("x", "q := a;")], "x stands for something else too"),
    "two of a name": (
        "q := a;",
        [action("Act", "q := a;"), action("ACT", "q := b;")],
        "ACT stands for something else too",
    ),
    "an action that begins a unit": (
        "Act();",
        [action("Act", "q := a; END_FUNCTION_BLOCK FUNCTION_BLOCK C q := a;")],
        "begins or ends another unit",
    ),
    "an action of another unit": ("t1.Act();", [action("Act", "q := a;")], "TON has no Act"),
    "a fault in an action": ("Act();", [action("Act", "q := ghost;")], "ghost is not declared"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_an_action_that_is_not_clear_is_refused(name: str, tmp_path: Path) -> None:
    text, actions, cause = REFUSED[name]
    with pytest.raises(Unjudged) as caught:
        read(with_actions(text, *actions, local="t1 TON"), tmp_path).main()
    said = caught.value.message.replace(f"{tmp_path}/", "")
    assert cause in said and re.match(r"b\.xml:\d+: ", said)


def test_a_fault_in_an_action_has_its_line(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=r"b\.xml:4: ghost"):
        read(with_actions("Act();", action("Act", "q := ghost;")), tmp_path)


def test_leaving_a_loop_of_an_action_is_read(tmp_path: Path) -> None:
    text = "FOR k := 1 TO 3 DO IF a THEN EXIT; END_IF i := k; END_FOR"
    of = run(tmp_path, "i := 0; Act(); q := i = 3;", action("Act", text), local="k INT")
    assert rows(of, "0 1") == "10"


def vendor(name: str, inner: str) -> str:
    """An element of a vendor."""
    data = f'<data name="http://x/plcopenxml/{name}" handleUnknown="implementation">{inner}</data>'
    return f'<vendorElement localId="9"><addData>{data}</addData></vendorElement>'


def test_how_boxes_are_written_changes_nothing(tmp_path: Path) -> None:
    flag = '<fbdattributes xmlns=""><attribute name="{}" value="true"/></fbdattributes>'
    body = reading(1, "a") + writing(5, "q", 1)
    known = vendor("fbd/implementationattributes", flag.format("BoxInputFlagsSupported"))
    assert rows(machine(tmp_path, known + body), "0 1") == "01"
    with pytest.raises(Unjudged, match="only a network's title is known"):
        machine(tmp_path, vendor("fbd/implementationattributes", flag.format("Reversed")) + body)


def attributed(name: str, where: str) -> str:
    """A block with a variable and an attribute, as CODESYS saves it."""
    given = (
        '<addData><data name="http://www.3s-software.com/plcopenxml/attributes">'
        f'<Attributes><Attribute Name="{name}" Value="1"/></Attributes></data></addData>'
    )
    made = pou(f"<p {HTML}>q := k; k := a;</p>", "k BOOL", language="ST")
    at = {"variable": '<variable name="k"><type><BOOL/></type>', "pou": "</interface>"}[where]
    assert made.count(at) == 1
    return project(made.replace(at, at + given))


def test_an_attribute_beside_a_variable_retains_it(tmp_path: Path) -> None:
    for name, initial in (("TcRetain", None), ("hide", False)):
        source = read(attributed(name, "variable"), tmp_path)
        found = {slot.path: slot.initial for slot in slots(source, source.units["B"])}
        assert found["K"] is initial


@pytest.mark.parametrize(("name", "where"), [("TcRetain", "pou"), ("no_init", "variable")])
def test_an_attribute_that_may_change_something_is_refused(name: str, where: str, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=f"attribute '{name}' may change what the program does"):
        read(attributed(name, where), tmp_path)


@pytest.mark.parametrize("part", ["ExcludeFromBuild", "External"])
def test_a_block_that_is_not_built_is_refused(part: str, tmp_path: Path) -> None:
    data = (
        '<addData><data name="http://www.3s-software.com/plcopenxml/buildproperties">'
        f"<BuildProperties><{part}>true</{part}></BuildProperties></data></addData>"
    )
    made = project(
        pou(f"<p {HTML}>q := a;</p>", language="ST").replace("</interface>", "</interface>" + data)
    )
    with pytest.raises(Unjudged, match=f"<{part}> may leave this out of the program"):
        read(made, tmp_path)
    assert read(made.replace(part, "LinkAlways"), tmp_path)


@pytest.mark.parametrize(
    "line", ["VAR RETAIN", "VAR PERSISTENT", "VAR {attribute 'TcRetain'}", "VAR // RETAIN\n"]
)
def test_an_interface_that_is_kept_as_text_says_the_same(line: str, tmp_path: Path) -> None:
    data = (
        '<addData><data name="http://www.3s-software.com/plcopenxml/interfaceasplaintext">'
        f"<InterfaceAsPlainText><xhtml {HTML}>{line} k : BOOL; END_VAR</xhtml></InterfaceAsPlainText>"
        "</data></addData>"
    )
    made = project(
        pou(f"<p {HTML}>q := k;</p>", "k BOOL", language="ST").replace("</interface>", data + "</interface>")
    )
    if "//" in line:
        assert read(made, tmp_path)
        return
    with pytest.raises(Unjudged, match="the text of this interface retains a variable, and the XML does not"):
        read(made, tmp_path)
    assert read(made.replace("<localVars>", '<localVars retain="true">'), tmp_path)
