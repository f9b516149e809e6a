"""A demand is judged as it is written, and what could do harm or says nothing is refused."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.kit.demands import Demands, Watch, read_demands
from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal

INPUTS = {"press": Signal("press", "bool"), "word": Signal("word", "word")}
OUTPUTS = {
    "LAMP": Signal("LAMP", "bool"),
    "MW": Signal("MW", "word"),
    "mode": Signal("mode", "mode", modes=(0, 1)),
}
PARAMETERS = {"LIMIT": {"type": "int", "default": 3}}


def demands(when: str, holds: str, *rules: dict[str, Any]) -> Demands:
    table = {
        "constants": {"CODE": 0x0FF0},
        "rules": list(rules),
        "demands": [{"id": "P", "says": "p.", "clauses": ["TOY-1"], "when": when, "holds": holds}],
    }
    return read_demands(table, INPUTS, OUTPUTS, PARAMETERS, "toy")


def rule(name: str, text: str, kind: str = "value", **more: Any) -> dict[str, Any]:
    return {"name": name, "kind": kind, "is": text, **more}


def fate(watch: Watch, *scans: tuple[bool, str, bool]) -> list[bool]:
    """For each scan (press, word, LAMP) whether the property was broken."""
    watch.reset({})
    found = []
    for press, word, lamp in scans:
        outputs = {"LAMP": lamp, "MW": "0000", "mode": None}
        found.append(watch.scan(10, {"press": press, "word": word}, outputs) is not None)
    return found


def test_a_property_is_judged_and_counted_only_where_it_applies() -> None:
    watch = Watch(demands("LAMP", "word == CODE"))
    assert fate(watch, (True, "0FF0", True), (True, "0001", False), (True, "0001", True)) == [0, 0, 1]
    assert watch.counts == {"P": 2}


def test_words_are_numbers_and_a_missing_word_is_minus_one() -> None:
    watch = Watch(demands("True", "mode == -1 and MW == 0 and word in [CODE, 1] and LIMIT == 3"))
    assert fate(watch, (False, "0FF0", False), (False, "0001", False), (False, "0002", False)) == [0, 0, 1]


def test_the_scan_before_is_known_and_starts_all_off() -> None:
    watch = Watch(demands("LAMP and not was_LAMP", "was_press"))
    assert fate(watch, (True, "0000", False), (False, "0000", True)) == [0, 0]
    assert fate(watch, (True, "0000", True)) == [1]


def test_a_memory_keeps_its_value_until_its_place_comes() -> None:
    rules = (rule("before", "seen"), rule("seen", "seen or press", "memory", starts=False))
    watch = Watch(demands("LAMP", "before", *rules))
    assert fate(watch, (True, "0000", True)) == [1], "in the scan itself it was not seen before"
    assert fate(watch, (True, "0000", False), (False, "0000", True)) == [0, 0]


@pytest.mark.parametrize(("latency", "broken"), [(0, [0, 1]), (1, [0, 0])])
def test_what_was_lately_true_counts_while_a_program_may_settle(latency: int, broken: list[int]) -> None:
    watch = Watch(demands("LAMP", "True in presses", rule("presses", "press", "recent")), latency)
    assert fate(watch, (True, "0000", True), (False, "0000", True)) == broken


def test_each_case_begins_anew() -> None:
    watch = Watch(demands("LAMP", "True in presses", rule("presses", "press", "recent")), 5)
    assert fate(watch, (True, "0000", True)) == [0]
    assert fate(watch, (False, "0000", True)) == [1]


def test_what_needs_an_unobserved_output_is_not_judged() -> None:
    rules = (rule("lit", "LAMP"), rule("was_lit", "lit or was_lit", "memory", starts=False))
    watch = Watch(demands("True", "not was_lit", *rules), unobserved=["LAMP"])
    assert watch.judged == () and watch.unjudged == ("P",)
    assert Watch(demands("True", "not was_lit", *rules), unobserved=["MW"]).judged


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("lamp", "unknown name 'lamp'"),
        ("open('x')", "unknown name 'open'"),
        ("LAMP.__class__", "Attribute is not for demands"),
        ("(lambda: 1)()", "a call of another kind"),
        ("[x for x in [1]]", "is not for demands"),
        ("9 ** 9 ** 9", "is not for demands"),
        ("'a' * 1000000000", "is not for demands"),
        ("f'{LAMP}'", "is not for demands"),
        ("1.5 > LIMIT", "a constant of another kind"),
        ("max(LAMP, default=1)", "a call of another kind"),
        ("count", "unknown name 'count'"),
        ("LAMP and", "invalid syntax"),
        ("__builtins__", "unknown name"),
    ],
)
def test_an_expression_that_is_not_of_the_notation_is_refused(text: str, said: str) -> None:
    with pytest.raises(Unjudged, match="toy: demand 'P'") as caught:
        demands(text, "True")
    assert said in str(caught.value)


def test_rules_need_new_names_and_come_in_order() -> None:
    for rules, said in (
        ([rule("LAMP", "True")], "a new name"),
        ([rule("a", "True", "sometimes")], "one of the kinds"),
        ([rule("a", "b"), rule("b", "True")], "unknown name 'b'"),
    ):
        with pytest.raises(Unjudged, match=said):
            demands("True", "True", *rules)
    with pytest.raises(Unjudged, match="no demand"):
        read_demands({"constants": {}, "rules": [], "demands": []}, INPUTS, OUTPUTS, {}, "toy")
    with pytest.raises(Unjudged, match="toy: KeyError 'rules'"):
        read_demands({"constants": {}}, INPUTS, OUTPUTS, {}, "toy")


def test_a_rule_that_fails_is_named() -> None:
    watch = Watch(demands("True", "[1][word] == 1"))
    with pytest.raises(Unjudged, match="demands: P: IndexError"):
        fate(watch, (True, "0FF0", True))


@given(st.text(alphabet="LAMPword=!<>()[]+-'0123456789 andortif.,_:*{}", max_size=40))
def test_no_text_does_anything_but_be_judged_or_refused(text: str) -> None:
    try:
        watch = Watch(demands("True", text))
        fate(watch, (True, "0FF0", True))
    except Unjudged as error:
        assert "\n" not in str(error)
