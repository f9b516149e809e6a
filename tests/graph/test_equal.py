"""Graph and implementation are EQUAL only if they are; a planted fault comes with its shortest inputs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from modeproof.graph.device import compared_rests, graph_file
from modeproof.graph.equal import compare
from modeproof.graph.implementation import load_implementation
from modeproof.ground.errors import Unjudged
from modeproof.tlc.check import select
from modeproof.tlc.rests import row_of as said_of
from tests.graph.printed import CODE, Inputs, Memory, Outputs, lamp, lamp_graph, lines, row_of, step
from tests.toy_tree import toy_tree


def test_the_lamp_and_its_graph_are_equal(tmp_path: Path) -> None:
    found = compare(lamp_graph(tmp_path), lamp())
    assert found.verdict == "EQUAL" and found.summary() == "3 states, 54 transitions, EQUAL"
    assert found.replayed == found.transitions == found.scans == 54
    assert found.covered == {"StayOff": (15, 15), "SwitchOn": (3, 3), "StayOn": (18, 18), "Expire": (18, 18)}
    assert found.implementation_states == 3 and found.class_scans == 6 * len(
        lamp_graph(tmp_path).classes[0].members
    )


def test_one_wrong_transition_is_found_by_the_shortest_inputs(tmp_path: Path) -> None:
    def late(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        if state.on and state.elapsed_ms + i.dt_ms == 500:  # > for >=
            after = Memory(state.params, True, 500)
            return after, row_of(after)
        return step(state, i)

    found = compare(lamp_graph(tmp_path), lamp(step=late))
    assert found.verdict == "DIFFERS" and found.difference_count > 0
    first = found.differences[0]
    assert first.step == "Expire" and len(first.scans) == 2
    assert first.scans[0] == {"dt_ms": 0, "press": True, "word": "0FF0"} and first.scans[1]["dt_ms"] == 500
    assert dict(first.expected) == {"LAMP": False, "MW": "0000"}
    assert dict(first.got) == {"LAMP": True, "MW": "0FF0"}


def test_the_shortest_inputs_find_a_fault_that_shows_later(tmp_path: Path) -> None:
    def sticky(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        after, out = step(state, i)
        if state.extra == 0 and not state.on and i.press and i.word == 0:
            return replace(after, extra=1), out  # shows only when switched on afterwards
        if state.extra == 1 and after.on:
            return replace(after, extra=1), Outputs(False, CODE)
        return replace(after, extra=state.extra), out

    found = compare(lamp_graph(tmp_path), lamp(step=sticky))
    assert found.verdict == "DIFFERS"
    assert [scan["word"] for scan in found.differences[0].scans] == ["0000", "0FF0"]


def test_an_extra_state_that_shows_nowhere_is_no_equality(tmp_path: Path) -> None:
    def remembers(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        after, out = step(state, i)
        return replace(after, extra=1 if after.on else state.extra), out

    found = compare(lamp_graph(tmp_path), lamp(step=remembers))
    assert found.verdict == "DIFFERS" and found.difference_count == 0
    assert "meet several states of the implementation" in found.problem


def test_a_timer_without_end_is_unjudged(tmp_path: Path) -> None:
    def counts(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        after, out = step(state, i)
        return replace(after, extra=state.extra + 1), out

    with pytest.raises(Unjudged, match="meets more than 64 states"):
        compare(lamp_graph(tmp_path), lamp(step=counts))


def test_two_graph_states_in_one_code_state_are_not_equal(tmp_path: Path) -> None:
    printed = [line.replace('<<"On", {}, 1>>', '<<"On", {1}, 0>>') for line in lines()]
    twins = [line.replace('<<"Off", {}, 0>>', '<<"Off", {2}, 0>>') for line in printed if "EDGE" in line]
    twins = [line for line in twins if line.startswith('<<"EDGE", <<"Off", {2}')]
    state = '<<"STATE", <<"Off", {2}, 0>>, [LAMP |-> FALSE, MW |-> 0]>>'
    printed = [
        line.replace('"Expire", 2, <<"Off", {}, 0>>', '"Expire", 2, <<"Off", {2}, 0>>') for line in printed
    ]
    found = compare(lamp_graph(tmp_path, [*printed, *twins, state]), lamp())
    assert found.verdict == "DIFFERS" and "are one state of the implementation" in found.problem


def test_a_member_that_acts_unlike_its_representative_is_found(tmp_path: Path) -> None:
    def low_byte(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        return step(state, replace(i, word=CODE) if i.word & 0xFF == CODE & 0xFF else i)

    assert compare(lamp_graph(tmp_path, classes=""), lamp(step=low_byte)).equal
    found = compare(lamp_graph(tmp_path), lamp(step=low_byte))
    assert found.verdict == "DIFFERS" and found.differences[0].kind == "class member"
    assert found.differences[0].scans[-1]["word"][2:] == "F0"


def test_an_integer_for_a_boolean_is_a_difference(tmp_path: Path) -> None:
    def loose(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        after, out = step(state, i)
        return after, Outputs(int(out.LAMP), out.MW)  # type: ignore[arg-type]

    found = compare(lamp_graph(tmp_path), lamp(step=loose))
    assert found.verdict == "DIFFERS" and found.differences[0].kind == "type"


def test_code_that_raises_is_a_difference(tmp_path: Path) -> None:
    def fragile(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
        if state.elapsed_ms == 250:
            raise ZeroDivisionError("planted")
        return step(state, i)

    found = compare(lamp_graph(tmp_path), lamp(step=fragile))
    assert found.verdict == "DIFFERS" and "planted" in str(found.differences[0])


def test_missing_code_is_unjudged() -> None:
    with pytest.raises(Unjudged, match="cannot be imported"):
        load_implementation("refimpl", "no_such_document", "lamp")


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ('rule = "some"', "rule must be"),
        ('rule = "words"\nfield = "word"', "missing or unknown"),
        ('rule = "words"\nfield = "wrod"\nrepresentative = "0001"', "is no input"),
        ('rule = "words"\nfield = "word"\nrepresentative = "0002"', "not in the alphabet"),
        ('rule = "words"\nfield = "word"\nrepresentative = 1', "four hex digits"),
    ],
)
def test_a_class_with_a_typo_is_refused(tmp_path: Path, row: str, said: str) -> None:
    with pytest.raises(Unjudged, match=said):
        lamp_graph(tmp_path, classes=f'[[class]]\ndevice = "lamp"\n{row}\n')


def test_a_step_or_field_that_nobody_declared_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match="step 'GoOff' is not declared"):
        lamp_graph(tmp_path, [line.replace('"Expire"', '"GoOff"') for line in lines()])
    with pytest.raises(Unjudged, match="STATE lines have a field 'LMAP'"):
        lamp_graph(tmp_path, [line.replace("LAMP", "LMAP") for line in lines()])
    with pytest.raises(Unjudged, match="is no value of type word"):
        lamp_graph(tmp_path, [line.replace("word |-> 1]", "word |-> 70000]") for line in lines()])


def test_a_comparison_rests_on_code_registers_specification_and_graph(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "OPEN_toy")
    (run,) = select(root)
    code = root / "code" / "toy" / "toy.py"
    for path in (code, root / "code" / "errors.py", graph_file(root, run), root / "spec/toy/interface.toml"):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("import code.errors\n" if path == code else "")
    wanted = {"code/errors.py", "code/toy/toy.py", "build/graphs/toy/OPEN_toy.txt"}
    wanted |= {f"spec/toy/{name}" for name in ("interface.toml", "Toy.tla", "models/OPEN_toy.cfg")}
    found = compared_rests(root, run, "code")
    assert found.inputs.keys() == wanted and found.said == said_of(run)
    code.unlink()
    with pytest.raises(Unjudged, match=r"code/toy/toy\.py: no such file"):
        compared_rests(root, run, "code")
