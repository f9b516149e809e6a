"""An assertion in a module beside the tests says with what values it failed, as one in a test does."""

from __future__ import annotations

import ast
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.any_machine import until

HERE = Path(__file__).resolve().parent
BESIDE = [
    path
    for path in sorted(HERE.rglob("*.py"))
    if not path.name.startswith(("test_", "conftest"))
    and path.relative_to(HERE).parts[0] != "sixth"
    and any(isinstance(node, ast.Assert) for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
]


def test_modules_with_assertions_are_found() -> None:
    assert len(BESIDE) >= 15, BESIDE


@pytest.mark.parametrize("path", BESIDE, ids=lambda path: str(path.relative_to(HERE)))
def test_every_one_is_rewritten_by_pytest(path: Path) -> None:
    name = ".".join(("tests", *path.relative_to(HERE).with_suffix("").parts))
    found = find_spec(name)
    assert found is not None and type(found.loader).__name__ == "AssertionRewritingHook"


def test_the_message_shows_the_values(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.any_machine.PATIENCE_S", -1.0)
    with pytest.raises(AssertionError, match=r"nothing: not within -1 s\nassert [\d.]+ < [\d.]+"):
        until(lambda: False, "nothing")
