"""What the theorems of a document share: made once, and no theorem is lost where it cannot be made."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from modeproof.lane import prove_command as prove


def test_theorems_are_asked_without_sharing_when_preparing_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[str] = []

    @contextmanager
    def made() -> Iterator[None]:
        yield
        left.append("left")

    @contextmanager
    def broken() -> Iterator[None]:
        raise ValueError("the code cannot be explored")
        yield

    for prepared, expected in ((made, ["left"]), (broken, [])):
        left.clear()
        monkeypatch.setattr(prove, "module_named", lambda name, it=prepared: SimpleNamespace(prepared=it))
        with prove._prepared("any") as seconds:
            assert seconds >= 0 and left == []
        assert left == expected
