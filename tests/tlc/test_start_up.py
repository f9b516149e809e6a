"""The cache that Java starts from: used when it is there and whole, refused when it is damaged."""

from __future__ import annotations

import dataclasses
import subprocess
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.tlc.start_up import start_up_options, write_cache
from modeproof.tlc.toolchain import Toolchain, find_toolchain


@pytest.fixture(scope="module")
def tools() -> Toolchain:
    return find_toolchain()


@pytest.fixture(scope="module")
def cache(tools: Toolchain, tmp_path_factory: pytest.TempPathFactory) -> Path:
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


def test_a_whole_cache_is_used(tools: Toolchain, cache: Path) -> None:
    said = said_at_start(tools, cache)
    assert "Mapped static" in said and "crc" not in said.lower()


def test_a_damaged_cache_is_refused_by_its_checksum(tools: Toolchain, cache: Path, tmp_path: Path) -> None:
    content = bytearray(cache.read_bytes())
    middle = len(content) // 3
    content[middle : middle + 64] = bytes(byte ^ 0xFF for byte in content[middle : middle + 64])
    damaged = tmp_path / "damaged.aot"
    damaged.write_bytes(content)
    assert "checksum" in said_at_start(tools, damaged).lower()


def test_no_cache_or_another_java_means_no_options(tools: Toolchain, cache: Path) -> None:
    assert start_up_options(tools, cache.parent / "none.aot") == []
    assert start_up_options(dataclasses.replace(tools, pinned=False), cache) == []
    assert start_up_options(dataclasses.replace(tools, java=Path("/usr/bin/java")), cache) == []


def test_no_cache_is_made_from_another_jar(tools: Toolchain, tmp_path: Path) -> None:
    """Java may not tell them apart."""
    with pytest.raises(Unjudged, match="not the pinned jar"):
        write_cache(dataclasses.replace(tools, pinned=False), tmp_path / "start.aot")
    assert list(tmp_path.iterdir()) == []


def test_nothing_half_written_is_left(tools: Toolchain, tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match="Java wrote no cache"):
        write_cache(dataclasses.replace(tools, jar=tmp_path / "none.jar"), tmp_path / "start.aot")
    assert list(tmp_path.iterdir()) == []
