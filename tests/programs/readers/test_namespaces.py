"""Namespaces: a name is used from where it stands, or it is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.language.tree import Instance, Source
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine

LIBRARY = """NAMESPACE Safe.Inner
TYPE Level : (low, high) := high; END_TYPE
FUNCTION_BLOCK Latch
VAR_INPUT set : BOOL; END_VAR VAR_OUTPUT q : BOOL; level : Level; END_VAR
q := q OR set;
END_FUNCTION_BLOCK
FUNCTION Both : BOOL VAR_INPUT a, b : BOOL; END_VAR Both := a AND b; END_FUNCTION
END_NAMESPACE
NAMESPACE Safe
FUNCTION_BLOCK Twice VAR_INPUT set : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR VAR l : Inner.Latch; END_VAR
l(set); q := l.q;
END_FUNCTION_BLOCK
END_NAMESPACE
"""


def program(using: str, kind: str, body: str, place: str = "PROGRAM P\n{}\n") -> str:
    """A program with one instance `l`."""
    pins = "VAR_INPUT a, b : BOOL; END_VAR VAR_OUTPUT y : BOOL; END_VAR"
    return f"{place.format(using)}{pins} VAR l : {kind}; END_VAR\n{body}\nEND_PROGRAM\n"


def read(folder: Path, *texts: str) -> Source:
    """The units of these files, looked at from the main one."""
    paths = []
    for number, text in enumerate(texts):
        paths.append(folder / f"{number}.st")
        paths[-1].write_text(text, "utf-8")
    source = read_sources(paths)
    check(source, source.main())
    return source


@pytest.mark.parametrize(
    ("using", "kind", "both"),
    [
        ("USING Safe.Inner;", "Latch", "Both"),
        ("using SAFE . INNER, Safe;", "latch", "BOTH"),
        ("", "Safe.Inner.Latch", "Safe.Inner.Both"),
        ("USING Safe;", "Twice", "safe.inner.both"),
        ("USING Safe;", "Safe.Twice", "Safe.Inner.Both"),
    ],
)
def test_a_name_is_known_by_using_or_in_full(using: str, kind: str, both: str, tmp_path: Path) -> None:
    body = f"l(set := a); y := {both}(l.q, b);"
    for place in ("PROGRAM P\n{}\n", "{}\nPROGRAM P\n"):
        source = read(tmp_path, program(using, kind, body, place), LIBRARY)
        of = Machine(source, source.units["P"])
        scans = [(False, True), (True, False), (False, True)]
        assert [of.scan({"a": a, "b": b}, 10)["y"] for a, b in scans] == [False, False, True]


@pytest.mark.parametrize(
    ("using", "kind", "body", "cause"),
    [
        (
            "",
            "Latch",
            "y := a;",
            "0.st:3: Latch: Latch is in the namespace Safe.Inner; write Safe",
        ),
        ("USING Safe;", "Latch", "y := a;", "Latch is in the namespace Safe.Inner"),
        ("USING Safe;", "Inner.Latch", "y := a;", "Latch is in the namespace Safe.Inner"),
        ("USING Other;", "TON", "y := a;", "0.st:2: USING Other: no file that is given has this namespace"),
        ("", "Safe.Latch", "y := a;", "Latch is in the namespace Safe.Inner"),
        ("", "Safe.Lach", "y := a;", "Safe.Lach is not known; did you mean 'Safe.Inner.Latch'"),
        ("", "TON", "y := Both(a, b);", "Both is in the namespace Safe.Inner"),
        ("", "TON", "y := l.Both(a, b);", "function L.BOTH is not supported"),
    ],
)
def test_a_name_that_is_not_used_here_is_refused(
    using: str, kind: str, body: str, cause: str, tmp_path: Path
) -> None:
    with pytest.raises(Unjudged) as caught:
        read(tmp_path, program(using, kind, body), LIBRARY)
    assert cause in caught.value.message


def test_one_name_in_two_namespaces_is_refused(tmp_path: Path) -> None:
    other = LIBRARY.replace("NAMESPACE Safe", "NAMESPACE Own").replace("Level", "Grade")
    with pytest.raises(Unjudged, match="name Latch; it is in two namespaces, and either could be meant"):
        read(tmp_path, LIBRARY, other)


def test_a_library_beside_a_program_leaves_no_doubt(tmp_path: Path) -> None:
    source = read(tmp_path, program("USING Safe;", "Twice", "l(a); y := l.q;"), LIBRARY)
    assert source.main().name == "P"
    assert source.units["TWICE"].variables["L"].type == Instance("Latch")
    two = program("", "TON", "y := a;") + program("", "TON", "y := b;").replace("PROGRAM P", "PROGRAM Q")
    with pytest.raises(Unjudged, match="which program is meant"):
        read(tmp_path, two)
