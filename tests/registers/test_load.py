"""A register that cannot be used is refused with one line: file, row, what is wrong, what is allowed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.places import documents
from modeproof.registers import Unjudged, load_document, load_interface, rows, typed

REGISTERS = ("clauses", "interface", "properties", "findings", "assumptions")


def refusal(tree: Any) -> str:
    with pytest.raises(Unjudged) as caught:
        load_document(tree.root, "door")
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_a_sound_document_loads_with_types(tree: Any) -> None:
    door = load_document(tree.root, "door")
    assert documents(tree.root) == ("door",)
    assert [clause.id for clause in door.clauses] == ["DR-1-1", "DR-1-2", "DR-1-3", "DR-1-4"]
    latch = door.interface.devices["latch"]
    assert latch.parameters["T_HOLD_ms"].default == 100
    assert door.assumptions[0].breaks == ("NEG_Latch",)
    assert door.runs[3].graph is not None and door.runs[3].graph.params == {"T_HOLD_ms": 20}
    assert load_interface(tree.root, "door") == door.interface


KEYED = """
[default.clause]
kind = "behaviour"
device = ["latch"]
[clause.DR-1-1]
title = "the latch shuts"
text = "It shuts."
[clause.DR-1-2]
title = "colour"
device = []
text = "It is green."
"""


def paper(tree: Any) -> str:
    """The head of the clauses as they are."""
    text = (tree.root / "spec/door/clauses.toml").read_text(encoding="utf-8")
    return str(text[: text.index("[[clause]]")])


def test_rows_by_id_take_the_rest_from_the_default(tree: Any) -> None:
    tree.write("spec/door/clauses.toml", paper(tree) + KEYED)
    first, second = load_document(tree.root, "door").clauses
    assert (first.id, first.kind, first.device) == ("DR-1-1", "behaviour", ("latch",))
    assert (second.id, second.kind, second.device) == ("DR-1-2", "behaviour", ())


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[default.clause]", "[default.clauses]", "unknown key 'clauses'"),
        ('kind = "behaviour"', 'knd = "behaviour"', "[[clause]] DR-1-1: unknown key 'knd'"),
        ("[clause.DR-1-2]", "[clause.DR-1-1]", "not valid TOML"),
        ("[clause.DR-1-2]", '[clause.DR-1-2]\nid = "DR-1-1"', "declared twice"),
    ],
)
def test_a_default_or_an_id_that_is_wrong_is_refused(tree: Any, old: str, new: str, words: str) -> None:
    assert old in KEYED
    tree.write("spec/door/clauses.toml", paper(tree) + KEYED.replace(old, new, 1))
    assert words in refusal(tree)


@pytest.mark.parametrize(
    ("register", "old", "new", "words"),
    [
        ("clauses", "kind = ", "knd = ", ["[[clause]] DR-1-1", "unknown key 'knd'", "did you mean 'kind'?"]),
        ("clauses", '"behaviour"', '"behavior"', ["DR-1-1: kind", "'behavior'", "did you mean 'behaviour'?"]),
        ("clauses", 'id = "DR-1-1"', 'id = "dr 1"', ["id: 'dr 1'", "clause id"]),
        ("clauses", 'title = "the latch shuts"\n', "", ["[[clause]] DR-1-1", "'title' is missing"]),
        ("clauses", 'id = "DR-1-2"', 'id = "DR-1-1"', ["[[clause]] DR-1-1", "declared twice (rows 1 and 2)"]),
        ("clauses", "[[clause]]", "[[clauses]]", ["unknown key 'clauses'", "did you mean 'clause'?"]),
        ("clauses", 'title = "colour"', "title = 7", ["DR-1-4: title", "must be a text in quotes, not 7"]),
        ("clauses", 'title = "colour"', 'title = ""', ["DR-1-4: title", "must not be empty"]),
        ("clauses", "prefix", "prefixx", ["unknown key 'prefixx'", "did you mean 'prefix'?"]),
        ("clauses", 'sha256 = "0', 'sha256 = "x', ["sha256", "SHA-256"]),
        ("interface", "published", "publised", ["devices.latch", "unknown key 'publised'"]),
        (
            "interface",
            'type = "ms"',
            'type = "sec"',
            ["devices.latch.parameters.T_HOLD_ms: type", "'sec'", "bool"],
        ),
        ("interface", 'document = "door"', 'document = "gate"', ["'gate'", "'door'"]),
        ("interface", '"Open", "Shut"', '"Open", "Open"', ["devices.latch: states holds 'Open' twice"]),
        ("interface", '"CloseLatch", "OpenLatch"', "", ["devices.latch: steps: must not be empty"]),
        ("properties", '"invariant"', '"invariants"', ["OpenIsUnlocked: kind", "did you mean 'invariant'?"]),
        ("findings", "says", "sayz", ["[[finding]] E-01", "did you mean 'says'?"]),
        ("findings", "= true", '= "yes"', ["drawing_could_settle", "must be true or false, not 'yes'"]),
        ("assumptions", '"assumption"', '"guess"', ["[[assumption]] A-01: kind", "'guess'", "merged step"]),
        ("runs", '"smoke"', '"smok"', ["run MC_Latch: lanes[0]", "did you mean 'smoke'?"]),
        (
            "runs",
            "tick_ms = 10",
            "tick_ms = 0",
            ["run OPEN_Latch: graph.tick_ms", "0 is too small; it must be at least 1"],
        ),
        ("runs", 'property = "OpenIsUnlocked"\n', "", ["run NEG_Latch", "`property` must name"]),
        ("runs", 'witnesses = ["open_seen"]', "", ["run WIT_Latch", "witnesses is empty"]),
    ],
)
def test_a_typo_gives_one_line(tree: Any, register: str, old: str, new: str, words: list[str]) -> None:
    tree.edit(f"spec/door/{register}.toml", old, new)
    message = refusal(tree)
    assert message.startswith(f"spec/door/{register}.toml: ")
    for word in words:
        assert word in message


@pytest.mark.parametrize("register", REGISTERS)
def test_a_missing_register_is_named(tree: Any, register: str) -> None:
    (tree.root / f"spec/door/{register}.toml").unlink()
    assert refusal(tree) == f"spec/door/{register}.toml: not found"


@pytest.mark.parametrize("register", REGISTERS)
def test_an_empty_register_is_refused(tree: Any, register: str) -> None:
    tree.write(f"spec/door/{register}.toml", "")
    assert refusal(tree).startswith(f"spec/door/{register}.toml: ")


def test_broken_toml_is_refused_with_its_line(tree: Any) -> None:
    tree.edit("spec/door/runs.toml", 'environment = "', "environment = ")
    assert refusal(tree).startswith("spec/door/runs.toml: not valid TOML: ")
    assert "line 6" in refusal(tree)


def test_a_key_given_twice_is_refused(tree: Any) -> None:
    tree.edit("spec/door/clauses.toml", 'number = "D-1"', 'number = "D-1"\nnumber = "D-2"')
    assert "not valid TOML: Cannot overwrite a value (at line 4" in refusal(tree)


def test_bytes_that_are_no_text_are_refused(tree: Any) -> None:
    (tree.root / "spec/door/findings.toml").write_bytes(b'[[finding]]\nid = "\xff"\n')
    assert refusal(tree) == "spec/door/findings.toml: byte 18 is not UTF-8"


def test_an_unreadable_register_is_refused(tree: Any) -> None:
    path: Path = tree.root / "spec/door/runs.toml"
    path.unlink()
    path.mkdir()
    assert refusal(tree).startswith("spec/door/runs.toml: cannot be read: ")


def test_an_unknown_document_is_refused_with_the_known_ones(tree: Any) -> None:
    with pytest.raises(Unjudged, match=r"spec/dor: no such document; did you mean 'door'\? allowed: door"):
        load_document(tree.root, "dor")


TABLES = [
    value for value in vars(rows).values() if isinstance(value, type) and issubclass(value, typed.Entry)
]


@pytest.mark.parametrize("table", TABLES, ids=[table.__name__ for table in TABLES])
def test_every_table_refuses_unknown_keys(table: type) -> None:
    with pytest.raises(Unjudged, match=r"here: unknown key 'colour'"):
        typed.typed(table, {"colour": "red"}, "here")
