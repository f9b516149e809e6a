"""The register of response times: what contradicts it is found, and its sums are those of its rows."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.registers import Unjudged, load_document, read_sources
from modeproof.registers.responses import bounds, chain_bounds, section
from tests.stated_times import stated_times

FILE = "spec/door/properties.toml"
PROOF = "proofs/door/bolt.py"
ROWS = stated_times("door", "latch", "DR")


@pytest.fixture
def timed(tree: Any) -> Any:
    """The door with response times, and a theorem that names the one that has a bound."""
    tree.write(FILE, (tree.root / FILE).read_text(encoding="utf-8") + ROWS)
    tree.edit(PROOF, 'findings=["E-01"])', 'findings=["E-01"], responses=["DRR-1", "DRR-2"])')
    tree.pin()
    return tree


def test_the_sums_are_those_of_the_rows(timed: Any) -> None:
    assert timed.problems() == []
    document = load_document(timed.root, "door")
    first, second = bounds(document, read_sources(document))
    assert (first.formula, first.example, first.shown) == (
        "T_HOLD + 4 C(latch)",
        "240 ms",
        ("the_bolt_moves",),
    )
    assert (second.formula, second.example) == ("none: a person is waited for", "none")
    (chain,) = chain_bounds(document)
    assert chain.formula == "2 T_HOLD + 4 C(latch) + 4 C(latch) + t + the lamp"
    assert chain.example == "492 ms"


def test_the_page_has_each_row_with_all_its_cells(timed: Any) -> None:
    document = load_document(timed.root, "door")
    text = "".join(section(document, read_sources(document)))
    for table in text.split("\n\n"):
        cells = {line.count("|") for line in table.splitlines() if line.startswith("|")}
        assert len(cells) <= 1, table
    for expected in (
        "| DRR-1 | the door opens **to**",
        "`the_bolt_moves`",
        "| DRC-1 | door to lamp |",
        "t = 5 ms",
    ):
        assert expected in text


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (PROOF, '"DRR-1", ', "", "DRR-1: no theorem names it; exactly one must"),
        (PROOF, ', "DRR-2"', "", "DRR-2: no theorem names it; exactly one must"),
        (PROOF, '"DRR-2"', '"DRR-2", "DRR-9"', "the_bolt_moves: proves the unknown response 'DRR-9'"),
        (FILE, 'device = "latch"', 'device = "lach"', "DRR-1: unknown device 'lach'; did you mean 'latch'?"),
        (FILE, "{ T_HOLD_ms = 1 }", "{ CODE = 1 }", "times: 'CODE' is no time among the parameters"),
        (
            FILE,
            "times = { T_HOLD_ms = 200 }",
            "",
            "DRR-1: [example] of spec/door/properties.toml has no ms for T_HOLD_ms, which DRR-1",
        ),
        (
            FILE,
            "{ latch = 10 }",
            "{ door = 10 }",
            "DRR-1: [example] of spec/door/properties.toml has no ms for latch, which DRR-1 needs",
        ),
        (
            FILE,
            'unbounded = "a',
            'calls = 1\nunbounded = "a',
            "DRR-2: give either `calls`, or in `unbounded`",
        ),
        (FILE, 'unbounded = "a person is waited for"', "", "DRR-2: give either `calls`, or in `unbounded`"),
        (FILE, '"door DRR-1"', '"DRR-2"', "DRC-1: DRR-2 has no bound, so the chain has none"),
        (FILE, '"door DRR-1"', '"door DRR-7"', "DRC-1: steps: there is no response 'door DRR-7'"),
        (FILE, "{ latch = 10 }", "{ latch = 10, door = 3 }", "[example]: no row with a bound needs door"),
        (FILE, "{ T_HOLD_ms = 200 }", "{ T_HOLD_ms = 200, T_OFF_ms = 3 }", "with a bound needs T_OFF_ms"),
        (FILE, 'then = "the lamp"\n', "", "DRC-1: give both `then` and `then_ms`, or neither"),
        (FILE, "then_ms = 7\n", "", "DRC-1: give both `then` and `then_ms`, or neither"),
        (
            FILE,
            'in"\nclauses = ["DR-1-1"',
            'in"\nclauses = ["DR-1-0"',
            "DRR-1: cites DR-1-0, which no register",
        ),
    ],
)
def test_a_contradiction_is_found(timed: Any, file: str, old: str, new: str, expected: str) -> None:
    timed.edit(file, old, new)
    found = timed.problems()
    assert any(expected in problem for problem in found), found


def test_a_bound_of_no_call_is_refused(timed: Any) -> None:
    timed.edit(FILE, "calls = 2", "calls = 0")
    with pytest.raises(Unjudged, match=r"DRR-1: calls: .*0"):
        load_document(timed.root, "door")


def test_a_register_beside_it_without_a_cycle_is_told(timed: Any) -> None:
    timed.write("spec/gate/properties.toml", ROWS.replace("latch = 10", "lamp = 10"))
    timed.edit(FILE, '"door DRR-1"', '"gate DRR-1"')
    expected = f"{FILE}: DRC-1: [example] of spec/gate/properties.toml has no ms for latch, which DRR-1 needs"
    assert [problem for problem in timed.problems() if "DRC-1" in problem] == [expected]


def test_a_chain_of_one_row_has_no_transfer(timed: Any) -> None:
    timed.edit(FILE, '"DRR-1", "door DRR-1"', '"DRR-1"')
    (chain,) = chain_bounds(load_document(timed.root, "door"))
    assert (chain.formula, chain.example) == ("T_HOLD + 4 C(latch) + the lamp", "247 ms")
