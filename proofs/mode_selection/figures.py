"""Figures 5, 6 and 7: the shipped functions are Table 2's relation for all words, the printed chains are not.

The chains are written here row by row, as the text has them, and run by the explorer like the shipped code.
Constants that are printed with the letter O are read with the digit 0 (E-01). Two things the text leaves
open, so both readings are judged: where a NO of an even row of Figure 7 leads (E-13), and where Figure 5 ends
when no row applies (E-12).

Each chain is compared with the relation on all pairs of words, 2^32 of them: what it accepts of the pairs
that the relation refuses, and of those that it permits. The answers are formulas, proved equal to the sets.
"""

# ruff: noqa: SIM102, SIM300 -- the names of words are upper case, and each comparison is a row of the note
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

import z3

from proofs.explorer import lint
from proofs.explorer.explore import disjunction, explore
from proofs.explorer.values import Number, Word
from proofs.mode_selection.devices import FPLC
from proofs.mode_selection.ranges import MODES
from proofs.theorem import Queries, Query, claim, control, theorem
from proofs.words import constant, one_of, word
from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import CH, NONE, RE, SE, SW, ZERO

RIGHT: Final = SW
PRINTED: Final = (SW[0], SW[1], 0x0FF0, SW[3], SW[4])
"""The words of the odd rows of Figure 7, by mode; row 5 as printed. EKS-7-5, E-01"""

# ---------------------------------------------------------------- the chains, row by row


def figure_5(MW01: int, MW03: int, no_row_applies: bool) -> bool:
    """Figure 5: True is row 9, no error. Only the parameter says what a NO of row 8 means. E-12"""
    if MW01 == 0x3C3C:  # EKS-5-1
        return True
    if MW03 == 0x0F0F:  # EKS-5-2
        return False
    if MW01 == 0x33CC:  # EKS-5-3
        return True
    if MW03 == 0x3C3C:  # EKS-5-4
        return False
    if MW01 == 0x3333:  # EKS-5-5
        return True
    if MW03 == 0x33CC:  # EKS-5-6
        return False
    if MW01 == 0x0FF0:  # EKS-5-7
        return True
    if MW03 == 0x3333:  # EKS-5-8
        return False
    return no_row_applies


def figure_6_exclusive(MW03: int, MW05: int) -> tuple[bool, int]:
    """Figure 6, each row that writes ends the chain: no error, and MW05 afterwards."""
    if MW03 == 0x0F0F:  # EKS-6-1
        return True, 0x0FF0  # EKS-6-2
    if MW03 == 0x3C3C:  # EKS-6-3
        return True, 0x0F0F  # EKS-6-4
    if MW03 == 0x33CC:  # EKS-6-5
        return True, 0x3C3C  # EKS-6-6
    if MW03 == 0x3333:  # EKS-6-7
        return True, 0x33CC  # EKS-6-8
    if MW03 == 0x0FF0:  # EKS-6-9
        return True, 0x3333  # EKS-6-10
    return False, MW05  # EKS-6-12


def figure_6_going_on(MW03: int, MW05: int) -> tuple[bool, int]:
    """Figure 6, each row that writes goes on to the next check: no error, and MW05 afterwards."""
    if MW03 == 0x0F0F:
        MW05 = 0x0FF0
    if MW03 == 0x3C3C:
        MW05 = 0x0F0F
    if MW03 == 0x33CC:
        MW05 = 0x3C3C
    if MW03 == 0x3333:
        MW05 = 0x33CC
    if MW03 == 0x0FF0:
        return True, 0x3333
    return False, MW05


def figure_7_exclusive(MW03: int, MW07: int, rows: tuple[int, ...]) -> bool:
    """Figure 7 with these words in its odd rows, by mode; a NO of an even row is the error of row 12. E-13"""
    if MW07 == rows[4]:  # EKS-7-1
        return MW03 == 0x0F0F  # EKS-7-2
    if MW07 == rows[3]:  # EKS-7-3
        return MW03 == 0x3C3C  # EKS-7-4
    if MW07 == rows[2]:  # EKS-7-5
        return MW03 == 0x33CC  # EKS-7-6
    if MW07 == rows[1]:  # EKS-7-7
        return MW03 == 0x3333  # EKS-7-8
    if MW07 == rows[0]:  # EKS-7-9
        return MW03 == 0x0FF0  # EKS-7-10
    return False


def figure_7_falling_through(MW03: int, MW07: int, rows: tuple[int, ...]) -> bool:
    """Figure 7 with these words in its odd rows; a NO of an even row goes on with the next odd row. E-13"""
    if MW07 == rows[4]:
        if MW03 == 0x0F0F:
            return True
    if MW07 == rows[3]:
        if MW03 == 0x3C3C:
            return True
    if MW07 == rows[2]:
        if MW03 == 0x33CC:
            return True
    if MW07 == rows[1]:
        if MW03 == 0x3333:
            return True
    if MW07 == rows[0]:
        if MW03 == 0x0FF0:
            return True
    return False


def odd_rows_of_figure_7(MW07: int, rows: tuple[int, ...]) -> bool:
    """Step 27 read from Figure 7: some odd row knows the word."""
    return MW07 == rows[4] or MW07 == rows[3] or MW07 == rows[2] or MW07 == rows[1] or MW07 == rows[0]


# ---------------------------------------------------------------- Table 2's relations

LEVEL: Final = word("MW01")
SELECTED: Final = word("MW03")
SHOWN_BEFORE: Final = word("MW05")
ACKNOWLEDGED: Final = word("MW07")


def may_select(MW01: z3.BitVecRef, MW03: z3.BitVecRef) -> z3.BoolRef:
    """MW01 means a level, MW03 a mode, and the mode is not above the level. EKS-T2, EKS-T2-2, E-47"""
    return disjunction([z3.And(MW01 == RE[a], one_of(MW03, SE[: a + 1])) for a in MODES])


def means_the_same(
    first: z3.BitVecRef, range_1: Sequence[int], second: z3.BitVecRef, range_2: Sequence[int]
) -> z3.BoolRef:
    """Both words mean the same mode, each in its range. EKS-T2"""
    return disjunction([z3.And(first == range_1[m], second == range_2[m]) for m in MODES])


# ---------------------------------------------------------------- a function of the code as a term


def term_of(function: Callable[..., Any], arguments: Sequence[Any], part: int | None = None) -> z3.ExprRef:
    """What the function returns, as one term over all its paths; `part`: of a tuple, this one."""
    lint.reach_of(function).refuse_faults()
    exploration = explore(function, arguments)
    last, *others = [(path.condition, _leaf(path.result, part)) for path in reversed(exploration.paths)]
    result = last[1]
    for condition, value in others:
        result = z3.If(condition, value, result)
    return result


def _leaf(result: Any, part: int | None) -> z3.ExprRef:
    value = result if part is None else result[part]
    if isinstance(value, bool):
        return z3.BoolVal(value)
    return value.term if hasattr(value, "term") else constant(value)


def _all_but(term: z3.BitVecRef, listed: Sequence[int]) -> z3.BoolRef:
    return z3.Not(one_of(term, listed))


def _judged(
    name: str, accepts: z3.BoolRef, relation: z3.BoolRef, wrong: z3.BoolRef, right: z3.BoolRef
) -> Iterator[Query]:
    """Of the pairs that the relation refuses exactly `wrong` are accepted, of the others exactly `right`."""
    refused, permitted = (
        {"Table 2 refuses the pair": z3.Not(relation)},
        {"Table 2 permits the pair": relation},
    )
    yield from claim(f"{name}: wrongly accepted", refused, accepts == wrong)
    yield from claim(f"{name}: rightly accepted", permitted, accepts == right)


def _exists(name: str, accepts: z3.BoolRef, relation: z3.BoolRef, accepted: bool) -> Query:
    """A pair that the chain takes wrongly, or refuses wrongly."""
    formulas = {
        "the chain accepts" if accepted else "the chain refuses": accepts if accepted else z3.Not(accepts),
        "Table 2 refuses the pair" if accepted else "Table 2 permits the pair": z3.Not(relation)
        if accepted
        else relation,
    }
    return control(name, formulas)


ALWAYS: Final = z3.BoolVal(True)
NEVER: Final = z3.BoolVal(False)


# ---------------------------------------------------------------- Figure 5


@theorem(
    clauses=["EKS-T2", "EKS-T2-2", "EKS-2-18", "EKS-5-9", "EKS-5-10", "EKS-KS-8"], findings=["E-12", "E-47"]
)
def our_figure_5_is_the_order_of_the_levels_for_all_words() -> Queries:
    """Of all 2^32 pairs of words in MW01 and MW03, the shipped check of Figure 5 accepts exactly the 15 in
    which MW01 means a level and MW03 a mode that is not above it.

    Zero and every word that is no code are refused on either side. Planted: a check that forgets row 8.
    """
    accepts = term_of(fplc.permitted, [Word(LEVEL), Word(SELECTED)])
    relation = may_select(LEVEL, SELECTED)
    yield from _judged("permitted", accepts, relation, NEVER, ALWAYS)
    without_row_8 = z3.Or(accepts, z3.And(LEVEL == RE[0], SELECTED == SE[1]))
    yield _exists("planted: without row 8 level 0 may select mode 1", without_row_8, relation, True)


@theorem(
    clauses=["EKS-2-18", "EKS-2-19", "EKS-5-9", "EKS-6-11", "EKS-T2-2"], findings=["E-14", "E-18", "E-47"]
)
def a_selection_is_accepted_if_and_only_if_level_and_machine_permit_it() -> Queries:
    """With any private level, or none, any word in MW03 and any permissions that a machine may have, step 18
    accepts exactly the words of the modes that are not above the level and that the machine permits to it.
    """
    params, level = FPLC.params(), Number(z3.Int("authority"), NONE, MODES[-1])
    exploration = explore(fplc.within_authority, [params, level, Word(SELECTED)], FPLC.parameters_fit(params))
    accepts = disjunction(
        [
            z3.And(path.condition, _leaf(path.result, None))
            for path in exploration.paths
            if path.raised is None
        ]
    )
    row = [getattr(params, f"PERMITS_{a}") for a in MODES]
    permitted = disjunction(
        [z3.And(level.term == a, SELECTED == SE[m], row[a][m].term) for a in MODES for m in MODES if m <= a]
    )
    given = {"level and parameters in their ranges": exploration.premise}
    yield from claim("step 18", given, accepts == permitted, "ALL")
    above = {**given, "a mode above the level is accepted": accepts, "level 0": level.term == 0}
    yield control("level 0 may select something", above, "ALL")


@theorem(
    clauses=[
        "EKS-5-1",
        "EKS-5-2",
        "EKS-5-3",
        "EKS-5-4",
        "EKS-5-5",
        "EKS-5-6",
        "EKS-5-7",
        "EKS-5-8",
        "EKS-5-9",
        "EKS-KS-8",
    ],
    findings=["E-01", "E-12"],
)
def figure_5_as_printed_takes_every_word_that_is_no_level_for_level_0_and_every_word_that_is_no_mode() -> (
    Queries
):
    """When no row applies and Figure 5 then reports no error, it accepts all 15 right pairs and wrongly
    exactly these: any MW01 with a word in MW03 that is no mode (65536 times 65531 pairs), and any MW01 that
    is no level, zero included, with the word of mode 0 (65531 pairs).

    So zero in MW01, the word of a removed key, and every corrupted word do all that level 0 does.
    """
    accepts = term_of(figure_5, [Word(LEVEL), Word(SELECTED), True])
    relation = may_select(LEVEL, SELECTED)
    no_mode = _all_but(SELECTED, SE)
    wrong = z3.Or(no_mode, z3.And(_all_but(LEVEL, RE), SELECTED == SE[0]))
    yield from _judged("falls through to row 9", accepts, relation, wrong, ALWAYS)
    as_level_0 = z3.substitute(accepts, (LEVEL, constant(RE[0])))
    yield from claim("no level is level 0", {"MW01 is no level": _all_but(LEVEL, RE)}, accepts == as_level_0)
    yield _exists("a pair is wrongly accepted", accepts, relation, True)
    zero = {"MW01 is zero": LEVEL == ZERO, "the chain accepts": accepts, "MW03 means a mode": z3.Not(no_mode)}
    yield control("zero in MW01 selects a mode", zero)
    less = z3.And(z3.Not(relation), accepts != z3.And(wrong, LEVEL != ZERO))
    yield control("planted: the same set without zero in MW01 is not the set", {"they differ": less})


@theorem(clauses=["EKS-5-9", "EKS-5-10", "EKS-2-18", "EKS-2-19", "EKS-6-12"], findings=["E-12", "E-14"])
def figure_6_after_figure_5_leaves_only_the_words_that_are_no_level() -> Queries:
    """Figure 5 as printed followed by Figure 6 wrongly accepts exactly the word of mode 0 with an MW01 that
    is no level: 65531 pairs, zero among them. All 15 right pairs are accepted.

    With the level from private memory, as decided, none of these pairs can occur.
    """
    in_figure_5 = term_of(figure_5, [Word(LEVEL), Word(SELECTED), True])
    in_figure_6 = term_of(figure_6_exclusive, [Word(SELECTED), Word(SHOWN_BEFORE)], 0)
    accepts, relation = z3.And(in_figure_5, in_figure_6), may_select(LEVEL, SELECTED)
    wrong = z3.And(_all_but(LEVEL, RE), SELECTED == SE[0])
    yield from _judged("both figures", accepts, relation, wrong, ALWAYS)
    yield _exists("a pair is wrongly accepted", accepts, relation, True)


@theorem(clauses=["EKS-5-8", "EKS-5-9", "EKS-5-10"], findings=["E-12"])
def figure_5_that_ends_in_an_error_when_no_row_applies_leaves_level_0_nothing() -> Queries:
    """When no row applies and Figure 5 then reports an error, it wrongly refuses exactly level 0 with mode 0,
    and wrongly accepts exactly a word in MW03 that is no mode with a level of 1 to 4 (4 times 65531 pairs).

    With Figure 6 after it nothing is wrongly accepted any more; but a key of level 0 is good for nothing, so
    this cannot be what is meant.
    """
    accepts = term_of(figure_5, [Word(LEVEL), Word(SELECTED), False])
    relation = may_select(LEVEL, SELECTED)
    wrong = z3.And(one_of(LEVEL, RE[1:]), _all_but(SELECTED, SE))
    yield from _judged("ends in row 10", accepts, relation, wrong, LEVEL != RE[0])
    yield _exists("a pair is wrongly refused", accepts, relation, False)
    in_figure_6 = term_of(figure_6_exclusive, [Word(SELECTED), Word(SHOWN_BEFORE)], 0)
    both = z3.And(accepts, in_figure_6)
    yield from _judged("ends in row 10, then Figure 6", both, relation, NEVER, LEVEL != RE[0])


# ---------------------------------------------------------------- Figure 6


@theorem(clauses=["EKS-T2", "EKS-2-19", "EKS-2-20", "EKS-6-11", "EKS-6-12"], findings=["E-01", "E-14"])
def our_figure_6_echoes_the_selected_mode_for_all_words() -> Queries:
    """For every word in MW03 and every word that might be shown, the shipped Figure 6 shows a word if and
    only if both mean the same mode; for each of the 65531 words that are no mode it gives zero.
    """
    shown, echo = word("shown"), term_of(fplc.echo, [Word(SELECTED)])
    relation = means_the_same(SELECTED, SE, shown, CH)
    a_mode = {"MW03 means a mode": one_of(SELECTED, SE)}
    yield from claim("echo of a mode", a_mode, (echo == shown) == relation)
    yield from claim("no echo", {"MW03 means no mode": _all_but(SELECTED, SE)}, echo == ZERO)


@theorem(
    clauses=[
        "EKS-6-1",
        "EKS-6-2",
        "EKS-6-3",
        "EKS-6-4",
        "EKS-6-5",
        "EKS-6-6",
        "EKS-6-7",
        "EKS-6-8",
        "EKS-6-9",
        "EKS-6-10",
        "EKS-6-11",
        "EKS-6-12",
    ],
    findings=["E-01", "E-14"],
)
def figure_6_as_printed_accepts_no_wrong_word_and_leaves_the_old_echo_in_place() -> Queries:
    """With every YES final, Figure 6 as printed reports no error for exactly the five words of the modes and
    shows the right word for each; for every other word MW05 keeps what it had.

    So the only difference to the shipped function is the echo after an error: an old mode stays shown. Our
    step clears MW05 with the error (E-14, E-27). Read with rows that go on, it is the same for mode 0 and
    reports an error for all else, with the right word of modes 1 to 4 already in MW05.
    """
    arguments = [Word(SELECTED), Word(SHOWN_BEFORE)]
    ours = term_of(fplc.echo, [Word(SELECTED)])
    a_mode, no_mode = one_of(SELECTED, SE), _all_but(SELECTED, SE)
    for name, chain, accepted in (
        ("every YES is final", figure_6_exclusive, a_mode),
        ("rows go on", figure_6_going_on, SELECTED == SE[0]),
    ):
        accepts, shows = (term_of(chain, arguments, part) for part in (0, 1))
        yield from claim(f"{name}: modes", {"MW03 means a mode": a_mode}, accepts == accepted)
        yield from claim(f"{name}: others", {"MW03 means no mode": no_mode}, z3.Not(accepts))
        yield from claim(f"{name}: echo", {"MW03 means a mode": a_mode}, shows == ours)
        yield from claim(f"{name}: old echo", {"MW03 means no mode": no_mode}, shows == SHOWN_BEFORE)
        stale = {
            "an error is reported": z3.Not(accepts),
            "MW05 showed a mode": one_of(SHOWN_BEFORE, CH),
            "and still does": shows == SHOWN_BEFORE,
        }
        yield control(f"{name}: an old mode stays shown after an error", stale)


# ---------------------------------------------------------------- Figure 7


@theorem(clauses=["EKS-T2", "EKS-2-27", "EKS-2-28", "EKS-7-11", "EKS-7-12"], findings=["E-01", "E-13"])
def our_figure_7_accepts_an_acknowledgment_if_and_only_if_both_words_mean_the_same_mode() -> Queries:
    """Of all 2^32 pairs of words in MW03 and MW07 the shipped Figure 7 accepts exactly the five that mean the
    same mode; and step 27 knows exactly the five words of SW.
    """
    accepts = term_of(fplc.matches, [Word(SELECTED), Word(ACKNOWLEDGED)])
    relation = means_the_same(SELECTED, SE, ACKNOWLEDGED, SW)
    yield from _judged("matches", accepts, relation, NEVER, ALWAYS)
    known = term_of(fplc.permissible_acknowledgment, [Word(ACKNOWLEDGED)])
    yield from claim("step 27: codes", {"MW07 means a mode": one_of(ACKNOWLEDGED, SW)}, known)
    yield from claim("step 27: others", {"MW07 means no mode": _all_but(ACKNOWLEDGED, SW)}, z3.Not(known))
    planted = z3.Or(accepts, z3.And(SELECTED == SE[2], ACKNOWLEDGED == SW[3]))
    yield _exists("planted: one pair more", planted, relation, True)


@theorem(clauses=["EKS-7-2", "EKS-7-4", "EKS-7-6", "EKS-7-8", "EKS-7-10"], findings=["E-13"])
def with_the_words_of_table_2_both_styles_of_figure_7_are_right() -> Queries:
    """With the word of Table 2 in row 5, Figure 7 accepts exactly the five right pairs, whether a NO of an
    even row is an error or goes on with the next odd row.
    """
    relation = means_the_same(SELECTED, SE, ACKNOWLEDGED, SW)
    for name, chain in (("exclusive", figure_7_exclusive), ("falling through", figure_7_falling_through)):
        accepts = term_of(chain, [Word(SELECTED), Word(ACKNOWLEDGED), RIGHT])
        yield from _judged(name, accepts, relation, NEVER, ALWAYS)


@theorem(
    clauses=["EKS-7-1", "EKS-7-3", "EKS-7-5", "EKS-7-6", "EKS-7-7", "EKS-7-9", "EKS-2-27"],
    findings=["E-01", "E-13"],
)
def figure_7_as_printed_and_exclusive_accepts_nothing_wrong_and_never_mode_2() -> Queries:
    """With 0FF0H in row 5 as printed, and a NO of an even row as an error, Figure 7 accepts exactly the right
    pairs of modes 0, 1, 3 and 4.

    Nothing wrong is accepted, but mode 2 can never be acknowledged: its word is known to no odd row, so that
    step 27 refuses it, and 0FF0H has been judged in row 3.
    """
    accepts = term_of(figure_7_exclusive, [Word(SELECTED), Word(ACKNOWLEDGED), PRINTED])
    relation = means_the_same(SELECTED, SE, ACKNOWLEDGED, SW)
    yield from _judged("printed, exclusive", accepts, relation, NEVER, SELECTED != SE[2])
    yield _exists("a pair is wrongly refused", accepts, relation, False)
    known = term_of(odd_rows_of_figure_7, [Word(ACKNOWLEDGED), PRINTED])
    a_mode = {"MW07 means a mode": one_of(ACKNOWLEDGED, SW)}
    yield from claim("step 27: codes", a_mode, known == (ACKNOWLEDGED != SW[2]))
    no_mode = {"MW07 means no mode": _all_but(ACKNOWLEDGED, SW)}
    yield from claim("step 27: others", no_mode, z3.Not(known))


@theorem(
    clauses=["EKS-7-3", "EKS-7-4", "EKS-7-5", "EKS-7-6", "EKS-2-28", "EKS-2-29"], findings=["E-01", "E-13"]
)
def figure_7_as_printed_and_falling_through_accepts_one_wrong_pair_mode_3_for_mode_2() -> Queries:
    """With 0FF0H in row 5 as printed, and a NO of an even row going on with the next odd row, Figure 7
    wrongly accepts exactly one pair of all 2^32: mode 2 selected, mode 3 acknowledged. It wrongly refuses
    exactly mode 2 acknowledged as mode 2.

    A program that switches to the mode in MW07 (step 29) then activates mode 3, which a key of level 2 does
    not permit.
    """
    accepts = term_of(figure_7_falling_through, [Word(SELECTED), Word(ACKNOWLEDGED), PRINTED])
    relation = means_the_same(SELECTED, SE, ACKNOWLEDGED, SW)
    pair = z3.And(SELECTED == SE[2], ACKNOWLEDGED == SW[3])
    yield from _judged("printed, falling through", accepts, relation, pair, SELECTED != SE[2])
    yield _exists("a pair is wrongly accepted", accepts, relation, True)
    yield _exists("a pair is wrongly refused", accepts, relation, False)
    above = {
        "MW01 means level 2": LEVEL == RE[2],
        "the selection is permitted": may_select(LEVEL, SELECTED),
        "the chain accepts": accepts,
        "MW07 means a mode above the level": z3.Or(*[ACKNOWLEDGED == SW[m] for m in MODES if m > 2]),
    }
    yield control("a key of level 2 and the mode 3 in MW07", above)
