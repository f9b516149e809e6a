"""Candidates for relations: found in values, true of them, and given up where a value says otherwise."""

from __future__ import annotations

from typing import Any

import pytest
import z3

from programs.invariants.relations import Relation, Values, Vocabulary, like

LEVELS = {"r:level": "Int", "p:permits": "BV", "g:FIRST": "BV", "g:SECOND": "BV"}
TIMES = {"r:time": "Int", "p:clock": "Int", "g:LIMIT": "Int"}


def rows(names: dict[str, str], *values: tuple[int, ...]) -> list[Values]:
    """Samples: the values of these names."""
    return [dict(zip(names, row, strict=True)) for row in values]


def found(names: dict[str, str], seen: list[Values], **more: Any) -> dict[str, Relation]:
    """The candidates that all samples fulfil, by their texts."""
    found = Vocabulary(names, frozenset({"r:level"}), **more).candidates(seen)
    assert all(relation.holds(values) for relation in found for values in seen)
    return {str(relation): relation for relation in found}


def holds(relation: Relation, values: Values) -> bool:
    """Whether the formula is true of these values; so is the relation itself."""

    def term(name: str) -> Any:
        kind = z3.BitVec(name, 16) if name in ("p:permits", "g:FIRST", "g:SECOND") else z3.Int(name)
        return like(kind, values[name])

    true = z3.is_true(z3.simplify(relation.formula(term)))
    assert true == relation.holds(values)
    return true


def test_a_table_may_lead_to_parameters() -> None:
    seen = rows(LEVELS, (-1, 0, 1, 3), (0, 1, 1, 3), (0, 2, 2, 3), (1, 3, 1, 3), (1, 4, 1, 4))
    told = found(LEVELS, seen)
    relation = told["r:level, p:permits: -1, 0, 0, g:FIRST, 1, g:SECOND"]
    assert set(relation.names) == {"r:level", "p:permits", "g:FIRST", "g:SECOND"}
    assert holds(relation, rows(LEVELS, (1, 7, 2, 7))[0])
    assert not holds(relation, rows(LEVELS, (1, 2, 2, 7))[0])
    assert not holds(relation, rows(LEVELS, (2, 7, 2, 7))[0])


def test_a_value_that_no_parameter_gives_ends_the_table() -> None:
    seen = rows(LEVELS, (-1, 0, 1, 3), (0, 1, 1, 3), (0, 2, 2, 3), (0, 5, 2, 3))
    assert not any(text.startswith("r:level, p:permits") for text in found(LEVELS, seen))


def test_a_time_may_stop_where_another_goes_on() -> None:
    seen = rows(TIMES, (0, 0, 500), (20, 20, 500), (500, 3_000, 500), (70, 900, 70))
    relation = found(TIMES, seen)["r:time = min(p:clock, g:LIMIT)"]
    assert holds(relation, rows(TIMES, (80, 90, 80))[0])
    assert not holds(relation, rows(TIMES, (90, 90, 80))[0])
    seen += rows(TIMES, (60, 900, 70))
    assert not any("min" in text for text in found(TIMES, seen))


@pytest.mark.parametrize(("top", "limit"), [(90, 100), (100, 100), (101, 3_600_000), (4_000_000, None)])
def test_a_number_stays_below_a_limit_of_the_program(top: int, limit: int | None) -> None:
    told = found(TIMES, rows(TIMES, (0, 1, 5), (3, top, 6)), limits=[100, 3_600_000])
    limits = {relation.value: relation for relation in told.values() if relation.kind == "up to"}
    mine = [relation for relation in limits.values() if relation.left == "p:clock"]
    assert [relation.value for relation in mine] == ([] if limit is None else [limit])
    for relation in mine:
        assert not holds(relation, rows(TIMES, (0, relation.value + 1, 0))[0])
