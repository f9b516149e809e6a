"""Function block diagrams and ladders: what each element does, and in which order."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest

from programs.equality.binding import read_binding
from programs.equality.comparison import make
from programs.equality.verdict import Verdict, judge
from programs.semantics.interpreter import Machine
from tests.programs.drawn import block, machine, pou, reading, rows, wire, writing

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "examples" / "plcopen"
ABC = reading(1, "a") + reading(2, "b") + reading(3, "c")
EVERY = "000 001 010 011 100 101 110 111"
GATES = {"AND": "00000001", "OR": "01111111", "XOR": "01101001"}
NUMBERS = {
    "ADD": [7, 9, 2],
    "SUB": [3, 1, 8],
    "MUL": [10, 20, -15],
    "DIV": [2, 1, -1],
    "MOD": [1, 1, 2],
    "MIN": [2, 4, -3],
    "MAX": [5, 5, 5],
}
"""Of 5 and 2, 5 and 4, 5 and -3."""
COMPARE = {"GT": "100", "GE": "110", "EQ": "010", "LE": "011", "LT": "001", "NE": "101"}


# ---------------------------------------------------------------- gates and pins


@pytest.mark.parametrize("gate", GATES)
def test_each_gate_has_its_table(gate: str, tmp_path: Path) -> None:
    body = ABC + block(4, gate, {"IN1": 1, "IN2": 2, "IN3": 3}) + writing(5, "q", 4)
    assert rows(machine(tmp_path, body), EVERY) == GATES[gate]


@pytest.mark.parametrize("pin", ["IN1", "IN2", "IN3", "OUT", "variable"])
def test_each_negation_counts(pin: str, tmp_path: Path) -> None:
    no = 'negated="true"'
    pins = {f"IN{n}": (n, no if pin == f"IN{n}" else "") for n in (1, 2, 3)}
    gate = block(4, "AND", pins, f"OUT {no if pin == 'OUT' else ''}")
    body = ABC + gate + writing(5, "q", 4, no if pin == "variable" else "")
    expected = {"IN1": "00010000", "IN2": "00000100", "IN3": "00000010"}.get(pin, "11111110")
    assert rows(machine(tmp_path, body), EVERY) == expected


def test_a_negated_variable_is_read_negated(tmp_path: Path) -> None:
    body = reading(1, "a", 'negated="true"') + block(4, "NOT", {"IN": 1}) + writing(5, "q", 4)
    assert rows(machine(tmp_path, body), "0 1") == "01"


@pytest.mark.parametrize("name", NUMBERS)
def test_each_calculation_is_its_own(name: str, tmp_path: Path) -> None:
    body = reading(1, "n") + reading(2, "m") + block(4, name, {"IN1": 1, "IN2": 2}) + writing(5, "i", 4)
    of = machine(tmp_path, body)
    assert [of.scan({"n": 5, "m": m}, 1)["i"] for m in (2, 4, -3)] == NUMBERS[name]


@pytest.mark.parametrize("name", COMPARE)
def test_each_comparison_is_its_own(name: str, tmp_path: Path) -> None:
    body = reading(1, "n") + reading(2, "m") + block(4, name, {"IN1": 1, "IN2": 2}) + writing(5, "q", 4)
    of = machine(tmp_path, body)
    assert "".join(str(int(of.scan({"n": n, "m": 3}, 1)["q"])) for n in (4, 3, 2)) == COMPARE[name]


def test_inputs_are_taken_by_their_numbers(tmp_path: Path) -> None:
    body = reading(1, "n") + reading(2, "m") + block(4, "SUB", {"IN2": 2, "IN1": 1}) + writing(5, "i", 4)
    assert machine(tmp_path, body).scan({"n": 5, "m": 2}, 1)["i"] == 3


def test_a_selection_takes_its_second_value_when_true(tmp_path: Path) -> None:
    body = reading(1, "a") + reading(2, "n") + reading(3, "m")
    body += block(4, "SEL", {"G": 1, "IN0": 2, "IN1": 3}) + block(6, "MOVE", {"IN": 4}) + writing(5, "i", 6)
    of = machine(tmp_path, body)
    assert [of.scan({"a": a, "n": 5, "m": 7}, 1)["i"] for a in (False, True)] == [5, 7]


@pytest.mark.parametrize(
    ("kind", "pins", "out", "pattern", "expected"),
    [
        ("SR", {"S1": 1, "R": 2}, "Q1", "00 10 00 11 01 00", "011100"),
        ("RS", {"S": 1, "R1": 2}, "Q1", "00 10 00 11 00 01", "011000"),
        ("R_TRIG", {"CLK": 1}, "Q", "00 10 10 00 10", "01001"),
        ("F_TRIG", {"CLK": 1}, "Q", "00 10 10 00 10", "00010"),
        ("TON", {"IN": 1, "PT": 9}, "Q", "00 10 10 10 10 00", "000110"),
        ("TOF", {"IN": 1, "PT": 9}, "Q", "10 00 00 00 00 10", "111001"),
        ("TP", {"IN": 1, "PT": 9}, "Q", "10 00 10 00 10 10", "110011"),
    ],
)
def test_each_standard_block_is_called(
    kind: str, pins: dict[str, Any], out: str, pattern: str, expected: str, tmp_path: Path
) -> None:
    body = ABC + reading(9, "T#20ms") + block(4, kind, pins, out, 'instanceName="one"')
    of = machine(tmp_path, body + writing(5, "q", f"4.{out}"), f"one {kind}")
    assert rows(of, pattern) == expected


@pytest.mark.parametrize(("edge", "expected"), [("rising", "0100100"), ("falling", "0001001")])
def test_an_edge_at_a_pin_lasts_one_scan(edge: str, expected: str, tmp_path: Path) -> None:
    body = reading(1, "a") + reading(2, "FALSE")
    body += block(4, "OR", {"IN1": (1, f'edge="{edge}"'), "IN2": 2}) + writing(5, "q", 4)
    assert rows(machine(tmp_path, body), "0 1 1 0 1 1 0") == expected


@pytest.mark.parametrize(("storage", "expected"), [("set", "0111"), ("reset", "0000")])
def test_a_stored_output_changes_only_on_true(storage: str, expected: str, tmp_path: Path) -> None:
    body = reading(1, "a") + writing(5, "q", 1, f'storage="{storage}"')
    assert rows(machine(tmp_path, body), "0 1 0 0") == expected


def test_connectors_carry_a_value(tmp_path: Path) -> None:
    body = reading(1, "a") + f'<connector localId="2" name="k">{wire(1)}</connector>'
    body += '<continuation localId="3" name="k"><connectionPointOut/></continuation>' + writing(5, "q", 3)
    assert rows(machine(tmp_path, body), "0 1") == "01"


def test_blocks_of_ones_own_are_called(tmp_path: Path) -> None:
    own = pou(reading(1, "a") + writing(2, "q", 1, 'negated="true"'), name="Own")
    body = reading(1, "b") + block(4, "Own", {"a": 1}, "q", 'instanceName="one"') + writing(5, "q", 4)
    assert rows(machine(tmp_path, body, "one Own", more=own), "00 01") == "10"


def test_a_function_in_text_and_an_in_out_are_read(tmp_path: Path) -> None:
    html = 'xmlns="http://www.w3.org/1999/xhtml"'
    twice = pou(f"<p {html}>Twice := z + z;</p>", "", "Twice", "ST", outputVars="", inputVars="z INT")
    twice = twice.replace('pouType="functionBlock"', 'pouType="function"')
    twice = twice.replace("<interface>", "<interface><returnType><INT/></returnType>", 1)
    more = pou(f"<p {html}>n := Twice(n); done := n > 4;</p>", "", "More", "ST", inputVars="",
        outputVars="done BOOL", inOutVars="n INT")  # fmt: skip
    body = f"<p {html}>IF a THEN adds(n := k); END_IF q := adds.done;</p>"
    of = machine(tmp_path, body, "k INT 1, adds More", "ST", twice + more)
    assert rows(of, "1 1 0 1 1", inputs="a") == "00011"


def test_a_block_without_enable_keeps_its_outputs(tmp_path: Path) -> None:
    body = ABC + block(4, "R_TRIG", {"EN": 2, "CLK": 1}, "ENO, Q", 'instanceName="one"')
    of = machine(tmp_path, body + writing(5, "q", "4.Q") + writing(6, "r", "4.ENO"), "one R_TRIG")
    assert rows(of, "00 11 10 11 00") == "01100"
    assert rows(of, "01 00", "r") == "10"


def test_a_variable_may_stand_at_the_pin(tmp_path: Path) -> None:
    gate = block(4, "AND", {"IN1": 1, "IN2": None}).replace(
        "<connectionPointIn/>", "<connectionPointIn><expression>b</expression></connectionPointIn>"
    )
    body = reading(1, "a") + gate.replace(
        "<connectionPointOut/>", "<connectionPointOut><expression>q</expression></connectionPointOut>"
    )
    assert rows(machine(tmp_path, body), "00 01 10 11") == "0001"


# ---------------------------------------------------------------- order


def ordered(first: int, second: int) -> str:
    """Two outputs: x is a; q is x."""
    one, two = f'executionOrderId="{first}"', f'executionOrderId="{second}"'
    return reading(1, "a") + reading(2, "x") + writing(3, "x", 1, one) + writing(4, "q", 2, two)


def test_the_written_order_is_kept(tmp_path: Path) -> None:
    assert rows(machine(tmp_path, ordered(1, 2)), "0 1 0 0") == "0100"
    assert rows(machine(tmp_path, ordered(2, 1)), "0 1 0 0") == "0010"


def test_titles_of_networks_tell_their_order(tmp_path: Path) -> None:
    title = (
        '<vendorElement localId="9{}"><addData><data name="http://x/fbdelementtype" handleUnknown="discard">'
        '<ElementType xmlns="">networktitle</ElementType></data></addData></vendorElement>'
    )
    one, two = reading(1, "a") + writing(3, "x", 1), reading(2, "x") + writing(4, "q", 2)
    titled = title.format(1) + one + title.format(2) + two
    assert rows(machine(tmp_path, titled), "0 1 0 0") == "0100"
    assert rows(machine(tmp_path, title.format(1) + two + title.format(2) + one), "0 1 0 0") == "0010"


def loop(edge: str, gate: str) -> str:
    """A gate that takes the edge of itself, with these orders."""
    return (
        reading(1, "a")
        + block(4, "R_TRIG", {"CLK": 6}, "Q", f'instanceName="one" {edge}')
        + block(6, "AND", {"IN1": 1, "IN2": ("4.Q", 'negated="true"')}, more=gate)
        + writing(5, "q", 6)
    )


def test_a_loop_with_an_order_takes_the_value_before(tmp_path: Path) -> None:
    body = loop('executionOrderId="2"', 'executionOrderId="1"')
    assert rows(machine(tmp_path, body, "one R_TRIG"), "0 1 1 1 1 0 1") == "0101001"


# ---------------------------------------------------------------- ladders


def rail() -> str:
    """The left power rail, element 1."""
    return '<leftPowerRail localId="1"><connectionPointOut formalParameter=""/></leftPowerRail>'


def contact(number: int, name: str, sources: list[int], more: str = "") -> str:
    """A contact behind these elements."""
    links = "".join(f'<connection refLocalId="{source}"/>' for source in sources)
    return (
        f'<contact localId="{number}" {more}><connectionPointIn>{links}</connectionPointIn>'
        f"<connectionPointOut/><variable>{name}</variable></contact>\n"
    )


def coil(number: int, name: str, sources: list[int], more: str = "") -> str:
    """A coil behind these elements."""
    return contact(number, name, sources, more).replace("contact", "coil")


def ladder(folder: Path, body: str) -> Machine:
    """A block with this ladder."""
    return machine(folder, rail() + body, language="LD")


def test_contacts_in_series_and_in_parallel(tmp_path: Path) -> None:
    series = contact(2, "a", [1]) + contact(3, "b", [2]) + coil(4, "q", [3])
    assert rows(ladder(tmp_path, series), "00 01 10 11") == "0001"
    parallel = contact(2, "a", [1]) + contact(3, "b", [1]) + coil(4, "q", [2, 3])
    assert rows(ladder(tmp_path, parallel), "00 01 10 11") == "0111"


def test_each_kind_of_contact_and_coil(tmp_path: Path) -> None:
    patterns = {
        ('negated="true"', ""): "1001",
        ('edge="rising"', ""): "0100",
        ('edge="falling"', ""): "0001",
        ("", 'negated="true"'): "1001",
        ("", 'storage="set"'): "0111",
        ("", 'edge="rising"'): "0100",
        ("", 'edge="falling"'): "0001",
    }
    for (of_contact, of_coil), expected in patterns.items():
        body = contact(2, "a", [1], of_contact) + coil(4, "q", [2], of_coil)
        assert rows(ladder(tmp_path, body), "0 1 1 0") == expected, (of_contact, of_coil)


def test_a_coil_passes_on_what_reaches_it(tmp_path: Path) -> None:
    body = contact(2, "a", [1]) + coil(3, "q", [2], 'negated="true"') + coil(4, "r", [3])
    assert rows(ladder(tmp_path, body), "0 1", "r") == "01"


# ---------------------------------------------------------------- the shipped examples


def judged(path: Path, target: str) -> Verdict:
    """The verdict on a program."""
    name = "cautious.toml" if target == "sf_edm" else "plcopen/sf_guard_locking.toml"
    product = make([path], target, binding=read_binding(ROOT / "examples" / name))
    return judge(product, ROOT / "vectors" / target, 120, lambda text: None)


@pytest.mark.deep
@pytest.mark.parametrize("target", ["sf_edm", "sf_guard_locking"])
def test_the_diagrams_are_proved(target: str) -> None:
    assert judged(EXAMPLES / f"{target}.xml", target).word == "PROVED"


FAULTS = {
    "a gate": ("sf_edm", 'executionOrderId="71"', 'typeName="OR"', 'typeName="AND"'),
    "a negation at a pin": ("sf_edm", 'executionOrderId="73"', ' negated="true"', ""),
    "a pin of a latch": ("sf_edm", 'instanceName="running"', 'refLocalId="127"', 'refLocalId="43"'),
    "an order": ("sf_edm", 'executionOrderId="28"', 'executionOrderId="28"', 'executionOrderId="81"'),
    "a constant": ("sf_edm", "<expression>WORD#16#C060<", "WORD#16#C060", "WORD#16#C050"),
    "a contact": ("sf_guard_locking", "<contact", ' negated="true"', ""),
    "a coil": ("sf_guard_locking", "<coil", ' storage="reset"', ""),
    "an edge": ("sf_guard_locking", "<contact", ' edge="rising"', ""),
    "a branch": ("sf_guard_locking", "<variable>closed<", '<connection refLocalId="157"/>', ""),
}
"""Of each: the example, where to begin, the text that is changed there, the new one."""


def changed(name: str, folder: Path) -> tuple[Path, str]:
    """An example with one change."""
    target, where, old, new = FAULTS[name]
    before, found, after = (EXAMPLES / f"{target}.xml").read_text("utf-8").partition(where)
    line = before.rpartition("\n")[2]
    assert found and old in line + found + after, name
    text = before[: len(before) - len(line)] + (line + found + after).replace(old, new, 1)
    path = folder / f"{target}.xml"
    path.write_text(text, "utf-8")
    return path, target


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", FAULTS)
def test_a_change_in_a_diagram_is_refuted(name: str, tmp_path: Path) -> None:
    path, target = changed(name, tmp_path)
    found = judged(path, target)
    assert found.word == "REFUTED" and found.difference is not None


# ---------------------------------------------------------------- random diagrams

RULES: dict[str, Any] = {
    "AND": lambda left, right: left and right,
    "OR": lambda left, right: left or right,
    "XOR": lambda left, right: left != right,
    "RS": lambda left, right, before: not right and (left or before),
    "SR": lambda left, right, before: left or (not right and before),
}


class Drawing:
    """A random diagram, as XML and as rules that are carried out here."""

    def __init__(self, seed: int, folder: Path) -> None:
        self.values = random.Random(seed)
        self.gates = []
        body, latches = ABC, []
        for number in range(10, 30):
            kind = self.values.choice(list(RULES))
            pins = [
                (self.values.choice([1, 2, 3, *range(10, number)]), self.values.random() < 0.4) for _ in "lr"
            ]
            out = self.values.random() < 0.3
            self.gates.append((number, kind, pins, out))
            names = {"RS": ["S", "R1"], "SR": ["S1", "R"]}.get(kind, ["IN1", "IN2"])
            given = {
                name: (self.source(place), 'negated="true"' if negated else "")
                for name, (place, negated) in zip(names, pins, strict=True)
            }
            pin, more = ("Q1", f'instanceName="l{number}"') if kind in ("RS", "SR") else ("OUT", "")
            latches += [f"l{number} {kind}"] if more else []
            body += block(number, kind, given, pin + ' negated="true"' * out, more)
        shuffled = body.splitlines()
        self.values.shuffle(shuffled)
        drawn = "\n".join([*shuffled, writing(90, "q", 29)])
        self.machine = machine(folder, drawn, ", ".join(latches) or "z BOOL")
        self.memory: dict[int, bool] = {}

    def source(self, place: int) -> str:
        """The output of an element."""
        latch = place >= 10 and next(kind for number, kind, _, _ in self.gates if number == place) in (
            "RS",
            "SR",
        )
        return f"{place}.{'Q1' if latch else 'OUT'}" if place >= 10 else str(place)

    def scan(self, inputs: list[bool]) -> bool:
        """What the rules say."""
        now = dict(enumerate(inputs, 1))
        for number, kind, pins, out in self.gates:
            given = [now[place] != negated for place, negated in pins]
            if kind in ("RS", "SR"):
                self.memory[number] = RULES[kind](*given, self.memory.get(number, False))
                now[number] = self.memory[number] != out
            else:
                now[number] = RULES[kind](*given) != out
        return now[29]


@pytest.mark.sampled(10)
@pytest.mark.parametrize("seed", range(30))
def test_random_diagrams_do_what_their_gates_say(seed: int, tmp_path: Path) -> None:
    of = Drawing(seed, tmp_path)
    for _ in range(60):
        inputs = [of.values.random() < 0.5 for _ in "abc"]
        given = dict(zip("abc", inputs, strict=True))
        assert of.machine.scan(given, 10)["q"] == of.scan(inputs)
