"""Which comment belongs to which definition of a TLA+ module."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from modeproof.registers.tla import Module, closure, scan

TEXT = r"""Words before the module. X-0
---------------- MODULE Sample ----------------
(* Box on top: X-1 *)
EXTENDS Naturals, Other,
    Third

CONSTANTS A,      \* comment, with a comma X-2
    F(_, _), C
VARIABLES v, w

\* X-3
\* X-4
First == 1   \* X-5

\* stray X-6

Second(a, b) ==    (* X-7 (* nested X-8 *) *)
    /\ a = "\* no comment, X-9"
    \* X-10
    /\ b = "== (* X-11"
(* X-12
   X-13 *)
Third[x \in {1}] == x
\* the end X-14
-----------------------------------------------
LOCAL Fourth == INSTANCE Other WITH v <- w
THEOREM Spec => []First   \* X-15
===============================================
After == 1 \* X-16
"""


def comments(module: Module) -> dict[str, str]:
    return {one.name: one.comment for one in module.definitions}


def test_comments_before_and_inside_belong_to_a_definition() -> None:
    found = comments(scan(TEXT, "Sample", "Sample.tla"))
    cited = {
        name: [word for word in text.replace("*", " ").split() if word.startswith("X-")]
        for name, text in found.items()
    }
    assert cited == {
        "First": ["X-3", "X-4", "X-5"],
        "Second": ["X-7", "X-8", "X-10"],
        "Third": ["X-12", "X-13"],
        "Fourth": [],
    }


def test_all_other_comments_belong_to_the_module() -> None:
    stray = scan(TEXT, "Sample", "Sample.tla").stray
    for word in ("X-1 ", "X-2", "X-6", "X-14", "X-15"):
        assert word in stray
    for word in ("X-0", "X-3", "X-7", "X-9", "X-16"):
        assert word not in stray


def test_declarations_strings_and_words_are_read() -> None:
    module = scan(TEXT, "Sample", "Sample.tla")
    assert module.name == "Sample"
    assert module.constants == {"A", "F", "C"}
    assert module.variables == {"v", "w"}
    assert module.extends == ("Naturals", "Other", "Third")
    assert module.instances == ("Other",)
    assert "== (* X-11" in module.strings
    assert "comment" not in module.words and "Second" in module.words
    assert [one.line for one in module.definitions if one.name == "First"] == [13]


def test_the_closure_follows_extends_and_instances() -> None:
    other = scan("---- MODULE Other ----\nLeaf == 1\n====\n", "Other", "Other.tla")
    sample = scan(TEXT, "Sample", "Sample.tla")
    reached = closure({"Sample": sample, "Other": other}, "Sample")
    assert {module.name for module in reached} == {"Sample", "Other"}
    assert closure({"Sample": sample}, "Missing") == ()


@given(st.text(alphabet='\\*()"=- \nAaV,[]x', max_size=200))
def test_no_text_breaks_the_scanner_or_loses_or_doubles_comments(body: str) -> None:
    text = f"---- MODULE M ----\n{body}\nLast == 1\n"
    module = scan(text, "M", "M.tla")
    whole = "\n".join([module.stray, *(one.comment for one in module.definitions)])
    assert len(whole) <= len(text) + len(module.definitions) + 1
