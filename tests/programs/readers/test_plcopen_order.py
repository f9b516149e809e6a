"""Diagrams whose result depends on which element runs first: tools differ, so the order must be clear."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.readers.sources import read_sources
from tests.programs.drawn import block, machine, pou, project, reading, rows, writing
from tests.programs.readers.test_plcopen import coil, contact, rail


def at(text: str, x: int, y: int) -> str:
    """Elements, each at this place."""
    return text.replace("<connectionPoint", f'<position x="{x}" y="{y}"/><connectionPoint', 1)


def order(number: int) -> str:
    """The place in the order."""
    return f'executionOrderId="{number}"'


def edge(y: int, numbers: tuple[int, int] | None = None) -> str:
    """An edge of a, which nothing is connected to, at this height; q, at 50, is what it shows."""
    one, two = ("", "") if numbers is None else map(order, numbers)
    call = block(4, "R_TRIG", {"CLK": 1}, "Q", f'instanceName="z" {one} ')
    call = call.replace("<inputVariables>", f'<position x="9" y="{y}"/><inputVariables>', 1)
    return (
        at(reading(1, "a"), 1, y) + call + at(reading(2, "z.Q"), 1, 50) + at(writing(5, "q", 2, two), 9, 50)
    )


def written(x_first: bool, y_of_x: int, y_of_q: int) -> str:
    """x is a, q is x: in this order in the file, at these heights."""
    of_x = at(reading(1, "a"), 1, y_of_x) + at(writing(3, "x", 1), 9, y_of_x)
    of_q = at(reading(2, "x"), 1, y_of_q) + at(writing(4, "q", 2), 9, y_of_q)
    return of_x + of_q if x_first else of_q + of_x


DEPENDS = {
    "a block that no output asks for": edge(10),
    "networks in another order than in the file": written(False, 10, 90),
    "networks beside each other": written(True, 10, 10),
    "an output numbered before its block": (
        reading(1, "a")
        + block(4, "R_TRIG", {"CLK": 1}, "Q", f'instanceName="z" {order(2)}')
        + writing(5, "q", "4.Q", order(1))
    ),
    "a number that is zero": reading(1, "a")
    + reading(2, "x")
    + writing(3, "x", 1, order(1))
    + writing(4, "q", 2, order(0)),
    "a gate without a number before a numbered block": (
        reading(1, "a")
        + block(3, "NOT", {"IN": 1})
        + block(4, "R_TRIG", {"CLK": 3}, "Q", f'instanceName="z" {order(1)}')
        + writing(5, "q", "4.Q", order(2))
    ),
}


@pytest.mark.parametrize("name", DEPENDS)
def test_an_order_in_which_tools_differ_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match=r"b\.xml:\d+: .*(the other way round|nothing says which)"):
        machine(tmp_path, DEPENDS[name], "z R_TRIG")


def test_the_order_decides_what_is_shown(tmp_path: Path) -> None:
    shown = [
        rows(machine(tmp_path, edge(10, numbers), "z R_TRIG"), "0 1 1 0 1") for numbers in ((1, 2), (2, 1))
    ]
    assert shown == ["01001", "00100"]


def test_the_same_order_in_each_tool_is_read(tmp_path: Path) -> None:
    assert rows(machine(tmp_path, written(True, 10, 90)), "0 1 0 0") == "0100"
    assert rows(machine(tmp_path, written(False, 90, 10)), "0 1 0 0") == "0010"


def test_a_contact_whose_variable_changes_between_is_refused(tmp_path: Path) -> None:
    toggles = rail() + contact(2, "x", [1], 'negated="true"')
    with pytest.raises(Unjudged, match=r"X: contact 2 .* feeds several elements"):
        machine(tmp_path, toggles + coil(4, "x", [2]) + coil(5, "q", [2]), language="LD")
    with pytest.raises(Unjudged, match=r"X: contact 2 .* feeds several elements"):
        machine(tmp_path, toggles + coil(4, "x", [2]) + coil(5, "q", [4]), language="LD")
    alone = rail() + contact(2, "q", [1], 'negated="true"') + coil(4, "q", [2])
    assert rows(machine(tmp_path, alone, language="LD"), "0 0 0") == "101"


def shared(y_of_call: int) -> str:
    """A program whose block writes the global g, called at this height; q, at 50, is g."""
    outside = '<externalVars><variable name="g"><type><BOOL/></type></variable></externalVars></interface>'
    text = '<p xmlns="http://www.w3.org/1999/xhtml">g := a;</p>'
    inner = pou(text, name="Writes", language="ST").replace("</interface>", outside)
    call = block(4, "Writes", {"a": 1}, "q", 'instanceName="z"')
    call = call.replace("<inputVariables>", f'<position x="9" y="{y_of_call}"/><inputVariables>', 1)
    body = (
        at(reading(1, "a"), 1, y_of_call)
        + call
        + at(reading(2, "g"), 1, 50)
        + at(writing(5, "q", 2), 9, 50)
        + at(writing(6, "r", "4.q"), 90, y_of_call)
    )
    whole = project(inner, pou(body, "z Writes").replace("</interface>", outside))
    group = '<globalVars><variable name="g"><type><BOOL/></type></variable></globalVars>'
    there = f'<instances><configurations><configuration name="c">{group}</configuration></configurations>'
    return whole.replace("</project>", f"{there}</instances></project>")


def test_a_global_that_a_block_writes_has_an_order(tmp_path: Path) -> None:
    path = tmp_path / "b.xml"
    for height, said in ((10, "G: Writes 4 .* the other way round"), (50, "G: .* nothing says which")):
        path.write_text(shared(height), "utf-8")
        with pytest.raises(Unjudged, match=said):
            read_sources([path]).find("B")


def test_the_command_refuses_what_depends_on_the_order(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rule = tmp_path / "rule.toml"
    rule.write_text('[[property]]\nid = "edge"\nsentence = "q"\nnever = "q AND NOT a"\n', "utf-8")
    path = tmp_path / "b.xml"
    for numbers, status in (((1, 2), 0), ((2, 1), 1), (None, 2)):
        path.write_text(project(pou(edge(10, numbers), "z R_TRIG")), "utf-8")
        assert main(["prove-program", str(path), "--property", str(rule)]) == status
    assert "the generator of Beremiz and OpenPLC takes them" in capsys.readouterr().err
