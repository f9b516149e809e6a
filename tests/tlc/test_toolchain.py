"""A changed jar or a missing Java is said in one line; another jar is used only when it is named."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.tlc import toolchain


def test_the_installed_jar_is_the_pinned_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TLA2TOOLS_JAR", raising=False)
    jar, digest, pinned = toolchain.find_jar()
    assert jar.name == "tla2tools.jar" and digest == toolchain.JAR_SHA256 and pinned


def test_a_changed_jar_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TLA2TOOLS_JAR", raising=False)
    good, _, _ = toolchain.find_jar()
    changed = tmp_path / "tla2tools.jar"
    shutil.copy(good, changed)
    with changed.open("ab") as stream:
        stream.write(b"\0")
    places = SimpleNamespace(submodule_search_locations=[str(tmp_path)])
    monkeypatch.setattr("importlib.util.find_spec", lambda name: places)
    with pytest.raises(Unjudged, match=r"the TLC jar was changed: .* has SHA-256"):
        toolchain.find_jar()


def test_a_named_jar_is_taken_and_known_as_not_pinned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path / "other.jar"
    other.write_bytes(b"another release")
    monkeypatch.setenv("TLA2TOOLS_JAR", str(other))
    jar, digest, pinned = toolchain.find_jar()
    assert (jar, pinned) == (other, False) and digest == toolchain.sha256(other)


def test_a_missing_jar_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLA2TOOLS_JAR", str(tmp_path / "none.jar"))
    with pytest.raises(Unjudged, match=r"none\.jar: No such file"):
        toolchain.find_jar()


def test_a_missing_java_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEPROOF_JAVA", str(tmp_path / "java"))
    with pytest.raises(Unjudged, match="Java is missing: MODEPROOF_JAVA names"):
        toolchain.find_toolchain()


def test_a_java_that_does_not_run_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEPROOF_JAVA", "/bin/false")
    with pytest.raises(Unjudged, match=r"Java is missing: .*false -version ended with status 1"):
        toolchain.find_toolchain()


def test_no_java_anywhere_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MODEPROOF_JAVA", raising=False)
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(Unjudged, match="run `make venv`"):
        toolchain.find_java()


def test_options_from_the_environment_are_no_part_of_javas_version(monkeypatch: pytest.MonkeyPatch) -> None:
    java = toolchain.find_java()
    plain = toolchain.java_version.__wrapped__(java)
    monkeypatch.setenv("JAVA_TOOL_OPTIONS", "-Xss16m")
    assert toolchain.java_version.__wrapped__(java) == plain and "version" in plain
