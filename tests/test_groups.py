"""Tests that share what is made once are run in one process, and all others where there is room."""

from __future__ import annotations

from pathlib import PurePath

import pytest

from tests.groups import group_of

DOCUMENTS = frozenset({"lamp", "door"})


@pytest.mark.parametrize(
    ("file", "group"),
    [
        ("proofs/lamp/test_a.py", "proofs/lamp"),
        ("proofs/lamp/test_b.py", "proofs/lamp"),
        ("proofs/door/test_a.py", "proofs/door"),
        ("proofs/explorer/test_a.py", "proofs"),
        ("proofs/test_a.py", "proofs"),
        ("trace/test_a.py", "trace"),
        ("kit/test_a.py", "kit/test_a.py"),
        ("test_a.py", "test_a.py"),
    ],
)
def test_a_document_or_a_room_or_a_file(file: str, group: str) -> None:
    assert group_of(PurePath(file), DOCUMENTS) == group


def test_every_test_of_this_run_has_a_group(request: pytest.FixtureRequest) -> None:
    for item in request.session.items:
        (mark,) = item.iter_markers("xdist_group")
        assert mark.args
