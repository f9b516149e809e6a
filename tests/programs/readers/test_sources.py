"""Which reader a file gets, and what several files make together."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from programs.equality.comparison import make
from programs.language.subset import check
from programs.properties.transition_system import Cell
from programs.readers.sources import LARGEST, read_sources
from programs.semantics.interpreter import Machine
from tests.programs.drawn import block, pou, project, reading, writing
from tests.programs.fuzz import difference_of_translator

ST = "FUNCTION_BLOCK {}\nVAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR\n{}\nEND_FUNCTION_BLOCK\n"

GOOD = reading(1, "a") + writing(5, "q", 1)


def written(folder: Path, name: str, text: str | bytes) -> Path:
    """A source file."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_a_diagram_may_call_a_block_of_another_file(tmp_path: Path) -> None:
    body = reading(1, "a") + block(4, "Own", {"a": 1}, "q", 'instanceName="z"') + writing(5, "q", 4)
    files = [
        written(tmp_path, "b.xml", project(pou(body, "z Own"))),
        written(tmp_path, "own.scl", ST.format('"Own"', "#q := NOT #a;")),
    ]
    source = read_sources(files)
    assert source.main().name == "B" and set(source.units) == {"B", "OWN"}
    assert list(source.files) == [str(path) for path in files]


@pytest.mark.parametrize(
    ("name", "body"), [("SF_EDM", "q := e.Ready;"), ("MAX", "n := MAX(1, 2); q := n = 2;")]
)
def test_an_own_unit_that_is_refused_is_replaced_by_none(name: str, body: str, tmp_path: Path) -> None:
    kind = "INT" if name == "MAX" else name
    declared = f"VAR_OUTPUT q : BOOL; END_VAR VAR n : INT; e : {kind}; END_VAR"
    files = [
        written(tmp_path, "own.xml", project(pou("", name=name, language="SFC"))),
        written(tmp_path, "p.st", f"PROGRAM P {declared}\n{body}\nEND_PROGRAM\n"),
    ]
    with pytest.raises(Unjudged, match=f"{name}: a body in SFC is not supported"):
        source = read_sources(files)
        Cell.of(source, source.units["P"])


@pytest.mark.parametrize(
    ("texts", "cause"),
    [
        ({"b.st": b"\xff"}, "b.st: byte 0 is not UTF-8"),
        ({"b.st": b" " * (LARGEST + 1)}, "b.st: 1,000,001 bytes; a source has at most 1,000,000"),
        ({"b.st": ""}, "b.st: no PROGRAM and no FUNCTION_BLOCK"),
        (
            {"b.st": ST.format("B", "q := a;"), "c.scl": ST.format("b", "q := a;")},
            "c.scl:1: there is another",
        ),
        ({"b.st": ST.format("TON", "q := a;")}, "b.st:1: TON is the name of a standard block"),
        (
            {"b.xml": project(pou("", name="TON", language="SFC"), pou(GOOD))},
            "TON: a body in SFC is not supported",
        ),
        ({"b.xml": ST.format("B", "q := a;")}, "b.xml:1: not well-formed XML"),
        ({"b.st": project(pou(""))}, "b.st:3: syntax error"),
    ],
)
def test_files_that_cannot_be_read_are_refused(texts: dict[str, str], cause: str, tmp_path: Path) -> None:
    with pytest.raises(Unjudged) as caught:
        make([written(tmp_path, name, text) for name, text in texts.items()], "sf_edm")
    assert cause in caught.value.message


TYPES = {
    "row.st": "TYPE Row : ARRAY [0..1] OF Pair; END_TYPE\n",
    "pair.scl": 'TYPE "Pair" STRUCT on : Bool; kind : "Colour"; END_STRUCT; END_TYPE\n',
    "colour.st": "TYPE Colour : (Red, Green); END_TYPE\n",
}
USER = """FUNCTION_BLOCK B VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR VAR r : Row; END_VAR
r[1].on := a; r[0].kind := Green; q := r[1].on AND r[0].kind = Colour.Green;
END_FUNCTION_BLOCK
"""


@pytest.mark.parametrize("order", [1, -1])
def test_a_type_may_stand_in_another_file(order: int, tmp_path: Path) -> None:
    files = [written(tmp_path, name, text) for name, text in {"b.st": USER, **TYPES}.items()]
    source = read_sources(files[::order])
    check(source, source.main())
    assert Machine(source, source.main()).scan({"a": True}, 1) == {"q": True}
    assert difference_of_translator(source, source.main(), 1, 5) == ""


def test_a_type_in_two_files_is_refused(tmp_path: Path) -> None:
    texts = {"b.st": USER, **TYPES, "other.st": "TYPE Colour : (Green, Red); END_TYPE\n"}
    with pytest.raises(Unjudged, match=r"other\.st: the type COLOUR is in .*colour\.st too"):
        read_sources([written(tmp_path, name, text) for name, text in texts.items()])


def test_a_type_that_cannot_be_read_says_why(tmp_path: Path) -> None:
    texts = {"b.st": USER, **TYPES, "colour.st": "TYPE Colour : (Red, red); END_TYPE\n"}
    with pytest.raises(Unjudged, match=r"colour\.st:1: two members of an enumeration"):
        read_sources([written(tmp_path, name, text) for name, text in texts.items()])
