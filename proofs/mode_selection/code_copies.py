"""What happens to a code word that lands in the wrong flag word: it stays in range and its meaning moves."""

from typing import Final

import z3

from proofs.mode_selection.ranges import FLAG_WORD, free_mode, is_code, mode_of, word_of
from proofs.theorem import Queries, claim, theorem
from proofs.words import word

SHIFT: Final = {
    ("RE", "SE"): 4,
    ("RE", "CH"): 3,
    ("RE", "SW"): 2,
    ("SE", "RE"): 1,
    ("SE", "CH"): 4,
    ("SE", "SW"): 3,
    ("CH", "RE"): 2,
    ("CH", "SE"): 1,
    ("CH", "SW"): 4,
    ("SW", "RE"): 3,
    ("SW", "SE"): 2,
    ("SW", "CH"): 1,
}
"""For a copy from one range to another: what is added to the mode, modulo 5."""


def _pairs(first: z3.BitVecRef, second: z3.BitVecRef, listed: tuple[tuple[int, int], ...]) -> z3.BoolRef:
    """The two modes are one of the listed pairs."""
    return z3.Or(*[z3.And(first == word, second == two) for word, two in listed])


@theorem(clauses=["EKS-T2", "EKS-T2-1", "EKS-SD-17"], findings=["E-18"])
def every_copy_between_two_flag_words_stays_in_range_and_moves_the_mode_by_a_fixed_number() -> Queries:
    """A code word copied from one flag word to another is a code there too, and means the mode k further on,
    modulo 5.

    k, in the order from MW01, MW03, MW05, MW07: MW01 to the others 4, 3, 2; MW03 to MW01, MW05, MW07 1, 4, 3;
    MW05 to MW01, MW03, MW07 2, 1, 4; MW07 to MW01, MW03, MW05 3, 2, 1. No range check sees any of the twelve
    copies; only a comparison with private memory, or the order in time, can.
    """
    read = word("read")
    for (source, target), shift in SHIFT.items():
        given = {f"the word is a code of {source}": is_code(source, read)}
        moved = z3.URem(mode_of(source, read) + shift, 5)
        name = f"{FLAG_WORD[source]} to {FLAG_WORD[target]}: plus {shift}, modulo 5"
        yield from claim(name, given, z3.And(is_code(target, read), mode_of(target, read) == moved))


@theorem(clauses=["EKS-T2-1", "EKS-2-27", "EKS-2-28"], findings=["E-18"])
def an_acknowledgment_copied_from_mw01_matches_in_exactly_two_cases_and_from_mw03_or_mw05_never() -> Queries:
    """Of all permitted pairs (level, selection), MW01 copied to MW07 acknowledges the selection only for (3,
    0) and (4, 1).

    A copy of MW03 or MW05 to MW07 never does. In the two cases no user is needed: that is why an
    acknowledgment counts only if MW07 was seen as zero after the selection.
    """
    level, is_level = free_mode("level")
    selection, is_selection = free_mode("selection")
    given = {
        "level is 0 to 4": is_level,
        "selection is 0 to 4": is_selection,
        "it is permitted": z3.ULE(selection, level),
    }
    matches = word_of("RE", level) == word_of("SW", selection)
    yield from claim("MW01 to MW07", given, matches == _pairs(level, selection, ((3, 0), (4, 1))))
    selected = {"selection is 0 to 4": is_selection}
    for source in ("SE", "CH"):
        stranger = word_of(source, selection) != word_of("SW", selection)
        yield from claim(f"{FLAG_WORD[source]} to MW07", selected, stranger)


@theorem(clauses=["EKS-T2-1", "EKS-T2-2", "EKS-2-18"], findings=["E-18"])
def mw01_copied_to_mw03_selects_the_mode_below_the_level_and_is_refused_only_for_level_0() -> Queries:
    """MW01 copied to MW03 reads as the mode just below the level, which is permitted, for levels 1 to 4; for
    level 0 as mode 4.

    So a selection can appear that nobody made, within the authority of the key; it is never above it, except
    that level 0 yields mode 4, which the level check refuses.
    """
    level, is_level = free_mode("level")
    selected = mode_of("SE", word_of("RE", level))
    above = {"level is 1 to 4": z3.And(is_level, level != 0)}
    yield from claim("levels 1 to 4: one below", above, selected == level - 1)
    yield from claim("level 0: mode 4", {"level is 0": level == 0}, selected == 4)
    permitted = {"level is 0 to 4": is_level, "the level check passes": z3.ULE(selected, level)}
    yield from claim("a selection that passes is below the level", permitted, z3.ULT(selected, level))


@theorem(clauses=["EKS-T2-1", "EKS-T2-2", "EKS-2-12"], findings=["E-18"])
def a_word_copied_into_mw01_would_authorize_its_own_selection() -> Queries:
    """A selection copied from MW03 into MW01 reads as one level higher, MW05 as two, MW07 as three, modulo 5.

    The selections that would then authorize themselves are 0 to 3 for MW03, 0 to 2 for MW05, 0 and 1 for
    MW07. MW01 must therefore never be where the F-PLC takes the level from.
    """
    selection, is_selection = free_mode("selection")
    given = {"selection is 0 to 4": is_selection}
    for source, rise in (("SE", 1), ("CH", 2), ("SW", 3)):
        level = mode_of("RE", word_of(source, selection))
        name = f"{FLAG_WORD[source]} to MW01"
        yield from claim(f"{name}: plus {rise}", given, level == z3.URem(selection + rise, 5))
        authorizes = z3.ULE(selection, level)
        yield from claim(f"{name}: authorizes itself", given, authorizes == z3.ULE(selection, 4 - rise))


@theorem(clauses=["EKS-T2-1", "EKS-2-21", "EKS-2-22"], findings=["E-18"])
def an_echo_copied_from_mw01_is_right_by_chance_in_three_cases_and_from_mw03_or_mw07_never() -> Queries:
    """Of all permitted pairs (level, selection), MW01 copied to MW05 shows the selected mode only for (2, 0),
    (3, 1) and (4, 2).

    MW03 copied to MW05 always shows the mode below the selected one (for 0 the mode 4) and MW07 the mode
    above it (for 4 the mode 0), so the panel and the user can see that.
    """
    level, is_level = free_mode("level")
    selection, is_selection = free_mode("selection")
    given = {
        "level is 0 to 4": is_level,
        "selection is 0 to 4": is_selection,
        "it is permitted": z3.ULE(selection, level),
    }
    right = mode_of("CH", word_of("RE", level)) == selection
    yield from claim("MW01 to MW05", given, right == _pairs(level, selection, ((2, 0), (3, 1), (4, 2))))
    selected = {"selection is 0 to 4": is_selection}
    for source, shift in (("SE", 4), ("SW", 1)):
        shown = mode_of("CH", word_of(source, selection))
        moved = z3.And(shown == z3.URem(selection + shift, 5), shown != selection)
        yield from claim(f"{FLAG_WORD[source]} to MW05", selected, moved)


@theorem(clauses=["EKS-T2-1", "EKS-2-28"], findings=["E-16", "E-18"])
def a_selection_overwritten_by_mw05_or_mw07_differs_from_the_one_that_was_latched() -> Queries:
    """MW05 or MW07 of a selection copied to MW03 never equals the word of that selection, so a comparison
    with it sees the copy.
    """
    selection, is_selection = free_mode("selection")
    given = {"selection is 0 to 4": is_selection}
    for source in ("CH", "SW"):
        differs = word_of(source, selection) != word_of("SE", selection)
        yield from claim(f"{FLAG_WORD[source]} to MW03", given, differs)
