"""The name of a test is a claim of at most ten words."""

from __future__ import annotations

import ast
from pathlib import Path

TESTS = Path(__file__).resolve().parent
MOST_WORDS = 10


def long_names(text: str) -> list[str]:
    """The names of tests in this text that have more words than a claim may have."""
    functions = (ast.FunctionDef, ast.AsyncFunctionDef)
    names = [node.name for node in ast.walk(ast.parse(text)) if isinstance(node, functions)]
    claims = [name for name in names if name.startswith("test_")]
    return [name for name in claims if len(name.removeprefix("test_").split("_")) > MOST_WORDS]


def test_every_test_is_named_in_at_most_ten_words() -> None:
    files = sorted(TESTS.rglob("*.py"))
    assert Path(__file__) in files
    found = {str(path.relative_to(TESTS)): long_names(path.read_text(encoding="utf-8")) for path in files}
    assert {file: names for file, names in found.items() if names} == {}


def test_a_name_of_eleven_words_is_found() -> None:
    ten, eleven = ("test_" + "_".join(["word"] * count) for count in (10, 11))
    text = f"def {ten}(): pass\nclass Test:\n    async def {eleven}(self): pass\ndef not_a_{eleven}(): pass\n"
    assert long_names(text) == [eleven]
