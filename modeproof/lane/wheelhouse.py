"""Fills a folder with all that `pip install --no-index --find-links FOLDER modeproof` needs: `make wheels`.

The tool itself and the grammar are built here, from this tree and from .venv/wheels. All other wheels are
those that requirements.lock names, of this system; what is there already is not fetched again.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterable, Mapping
from email.parser import Parser
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name, parse_wheel_filename

from modeproof.ground.errors import EXIT_UNJUDGED, Unjudged
from modeproof.ground.evidence import sha256
from modeproof.ground.places import TREE

BUILT = Path(sys.prefix) / "wheels"
"""Where `make venv` has put the wheels that it has built."""
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check")


def fill(folder: Path, extras: Iterable[str] = ()) -> list[Path]:
    """Put every wheel that the tool needs, with these extras, into the folder, and no others.

    Raises Unjudged where a wheel cannot be built or fetched, or the tool has no such extra.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("modeproof-*.whl"):
        old.unlink()
    _run("the wheel of modeproof", "wheel", "--no-deps", "--no-build-isolation", "-w", str(folder), str(TREE))
    [own] = folder.glob("modeproof-*.whl")
    names = needed(own, extras)
    lock = locked((TREE / "requirements.lock").read_text(encoding="utf-8"))
    for wheel in BUILT.glob("*.whl"):
        shutil.copy(wheel, folder)
    kept = {own, *(folder / wheel.name for wheel in BUILT.glob("*.whl"))}
    for wheel in set(folder.glob("*.whl")) - kept:
        name = parse_wheel_filename(wheel.name)[0]
        if name in names and f"sha256:{sha256(wheel)}" in lock.get(name, ""):
            kept.add(wheel)
        else:
            wheel.unlink()
    there = {parse_wheel_filename(wheel.name)[0] for wheel in kept}
    if rows := [lock[name] for name in sorted(names - there)]:
        listed = folder / "requirements.lock"
        listed.write_text("".join(rows), encoding="utf-8")
        strict = ("--no-deps", "--only-binary", ":all:", "--require-hashes")
        _run("the other wheels", "download", *strict, "-r", str(listed), "-d", str(folder))
        listed.unlink()
    return sorted(folder.glob("*.whl"))


def needed(wheel: Path, extras: Iterable[str]) -> set[str]:
    """The packages that this wheel needs on this system, and those that they need. Raises Unjudged."""
    with zipfile.ZipFile(wheel) as archive:
        [name] = [name for name in archive.namelist() if re.fullmatch(r"[^/]+\.dist-info/METADATA", name)]
        about = Parser().parsestr(archive.read(name).decode())
    known = about.get_all("Provides-Extra", [])
    if strange := sorted(set(extras) - set(known)):
        raise Unjudged(f"modeproof has no extra {strange[0]!r}; it has {', '.join(known)}")
    found: set[str] = set()
    waiting = _required(about.get_all("Requires-Dist", []), ("", *extras))
    while waiting:
        one = waiting.pop()
        if one not in found:
            found.add(one)
            waiting |= _required(metadata.requires(one) or (), ("",))
    return found


def _required(lines: Iterable[str], extras: tuple[str, ...]) -> set[str]:
    rows = map(Requirement, lines)
    return {
        canonicalize_name(row.name)
        for row in rows
        if row.marker is None or any(row.marker.evaluate({"extra": extra}) for extra in extras)
    }


def locked(text: str) -> Mapping[str, str]:
    """For each package of a lock its rows, with hashes: one for each Python that it names."""
    found: dict[str, str] = {}
    for row in re.findall(r"^[\w.-]+==.*\n(?: .*\n)*", text, re.MULTILINE):
        name = canonicalize_name(row.partition("==")[0])
        found[name] = found.get(name, "") + row
    return found


def _run(what: str, *words: str) -> None:
    done = subprocess.run([*PIP, *words, "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode:
        said = (done.stderr or done.stdout).strip().splitlines()
        raise Unjudged(f"{what}: pip ended with status {done.returncode}: {' '.join(said[-2:])}")


def main() -> int:
    """Fill the folder that is named, and say what is in it."""
    parser = argparse.ArgumentParser(prog="make wheels", description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("extras", nargs="*")
    args = parser.parse_args()
    try:
        wheels = fill(args.folder, args.extras)
    except (Unjudged, OSError) as error:
        print(f"modeproof: {error}", file=sys.stderr)
        return EXIT_UNJUDGED
    size = sum(wheel.stat().st_size for wheel in wheels) / 1e6
    print(f"{args.folder}: {len(wheels)} wheels, {size:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
