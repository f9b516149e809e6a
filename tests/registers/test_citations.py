"""What counts as a citation in a text, and to which Python definition it belongs."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.registers import citations, load_document, read_sources
from modeproof.registers.citations import Ids, ids_of
from modeproof.registers.python_source import scan_python


@pytest.mark.parametrize(
    ("text", "clauses", "findings", "unknown"),
    [
        ("DR-1-1, DR-1-2; E-01", ("DR-1-1", "DR-1-2"), ("E-01",), ()),
        ("(DR-1-1) and again DR-1-1.", ("DR-1-1",), (), ()),
        ("DR-1-1-LATCH", (), (), ("DR-1-1-LATCH",)),
        ("XDR-1-1 DR_1 dr-1-1", (), (), ()),
        ("A-01 is an assumption, A-02 is not", (), (), ("A-02",)),
        ("E-01b", (), (), ("E-01b",)),
        ("1.2E-12 and GS-E-26", (), (), ()),
        ("DR-1-1..4", ("DR-1-1",), (), ("DR-1-1..4",)),
        ("DR-1-1/2", ("DR-1-1",), (), ("DR-1-1/2",)),
        ("DR-1-1/DR-1-2", ("DR-1-1", "DR-1-2"), (), ()),
    ],
)
def test_ids_in_a_text(
    tree: Any, text: str, clauses: tuple[str, ...], findings: tuple[str, ...], unknown: tuple[str, ...]
) -> None:
    ids = ids_of(load_document(tree.root, "door"))
    assert ids.read(text) == (clauses, findings, unknown)


PYTHON = '''"""Module X-1."""

import os  # X-2

# X-3
LIMIT = 1  # X-4


# X-5
@decorated("X-6")
def first():
    """X-7"""
    # X-8
    return "X-9"


class Both:
    """X-10"""

    # X-11
    LOW = 1  # X-12
    """X-13"""

    def method(self):
        """X-14"""  # X-15
'''


def test_python_comments_belong_to_their_definition() -> None:
    module = scan_python(PYTHON, "sample", "sample.py")
    cited = {
        one.name: [word.strip("\"'.") for word in one.comment.replace("#", " ").split() if "X-" in word]
        for one in module.definitions
    }
    assert cited == {
        "LIMIT": ["X-3", "X-4"],
        "first": ["X-7", "X-5", "X-8"],
        "Both": ["X-10", "X-13", "X-11", "X-12"],
        "Both.method": ["X-14", "X-15"],
    }
    assert "X-1." in module.stray and "X-2" in module.stray
    assert not any(word in module.stray for word in ("X-3", "X-5", "X-6", "X-9", "X-15"))


def test_spec_common_serves_several_documents_but_is_read_for_one(tree: Any) -> None:
    tree.write(
        "spec/common/Block.tla", "---- MODULE Block ----\n\\* DR-1-1, GL-4-4, E-99\nShared == 1\n====\n"
    )
    door = load_document(tree.root, "door")
    found = [one for one in citations(door, read_sources(door)) if one.name == "Block!Shared"]
    assert [(one.clauses, one.findings, one.unknown) for one in found] == [(("DR-1-1",), (), ())]


@given(
    number=st.integers(0, 3), before=st.sampled_from([" ", "(", "* ", ", ", '"']), after=st.text(max_size=5)
)
def test_no_declared_id_is_overlooked(number: int, before: str, after: str) -> None:
    names = ["DR-1-1", "DR-1-2", "DR-10-1", "DR-1-1-LATCH"]
    clauses, _, _ = Ids("DR", names, (), ()).read(f"{before}{names[number]} {after}")
    assert names[number] in clauses
