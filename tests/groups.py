"""Which tests share a process when several run at once: those that share what is made once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path, PurePath

ROOT = Path(__file__).resolve().parents[1]
SHARING = frozenset({"anywhere", "proofs", "report", "simulate", "spec", "strength", "trace"})
"""Rooms whose tests share explored devices, parse trees, runs of TLC, graphs or a page, by document."""
APART = frozenset({"report/browser"})
"""Rooms within such a room that share nothing with the rest of it."""
FIRST = (
    *("trace", "simulate", "anywhere", "strength", "spec/mode_selection", "report/browser"),
    *(
        "docs/test_tutorials.py",
        "deep/tamper/test_tamper.py",
        "kit/test_claims.py",
        "machines/test_own_blocks.py",
    ),
    *(
        "docs/test_for_assessors.py",
        "demands/test_literal.py",
        "deep/second_explorer/test_second_explorer.py",
    ),
    *("examples/test_check_your_plc.py", "docs/test_prove_your_program.py", "examples/test_faulty_pack.py"),
    *("examples/test_awl_program.py", "programs/equality/test_data_verdicts.py", "kit/test_reproductions.py"),
    *(
        "examples/test_faulty_st.py",
        "machines/test_tla_model.py",
        "cli/test_renew.py",
        "output/test_forms.py",
    ),
)
"""Groups that take long for their number of tests: begun first, so that nobody waits for one at the end."""
DOCUMENTS = frozenset(path.parent.name for path in ROOT.glob("spec/*/interface.toml"))


def group_of(file: PurePath, documents: frozenset[str] = DOCUMENTS) -> str:
    """The group of a test file, given below tests/: its room, or room and document, or the file alone."""
    room, *rest = file.parts
    if room not in SHARING or not rest:
        return file.as_posix()
    return f"{room}/{rest[0]}" if rest[0] in documents or f"{room}/{rest[0]}" in APART else room


def in_order(groups: Sequence[str]) -> list[int]:
    """The places of tests, given by their groups, in the order in which they are run: first the groups of
    FIRST, then those with most tests; a group is kept together.
    """
    count = Counter(groups)
    known = {group: place for place, group in enumerate(FIRST)}
    begins = {group: place for place, group in reversed(list(enumerate(groups)))}

    def rank(place: int) -> tuple[int, int, int, int]:
        group = groups[place]
        return known.get(group, len(FIRST)), -count[group], begins[group], place

    return sorted(range(len(groups)), key=rank)
