"""Small blocks in Structured Text for tests: what they give, and why they are refused."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.semantics.interpreter import Machine
from tests.programs.fuzz import difference_of_text, source_of

HEAD = "FUNCTION_BLOCK B\nVAR_INPUT x : INT; in, on : BOOL; END_VAR\n"
END = "\nEND_FUNCTION_BLOCK\n"


def ready(text: str, wrap: bool = False) -> Machine:
    """The block B of a text, looked at; the translator agrees with the interpreter in random scans."""
    source = source_of(text)
    check(source, source.units["B"])
    assert difference_of_text(text, 1, 60, wrap) == ""
    return Machine(source, source.units["B"], wrap)


def given(declared: str, body: str, scans: list[dict[str, Any]], before: str = "") -> list[Any]:
    """The output `y` after each scan."""
    of = ready(f"{before}{HEAD}{declared}\n{body}{END}")
    start = {"x": 0, "in": False, "on": False}
    return [of.scan(start | inputs, 10)["y"] for inputs in scans]


def refusal(declared: str, body: str, before: str = "") -> str:
    """Why a text is refused."""
    with pytest.raises(Unjudged) as caught:
        source = source_of(f"{before}{HEAD}{declared}\n{body}{END}")
        check(source, source.units["B"])
    return caught.value.message


INT = "VAR_OUTPUT y : INT; END_VAR VAR i, n : INT; END_VAR "
BOOL = "VAR_OUTPUT y : BOOL; END_VAR "
