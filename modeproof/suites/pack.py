"""Packs the kit into one file that needs nothing but Python: modeproof.kit, modeproof.s7,
the reference implementations and vectors.

Inside are the fast suites of every published target, and what is published of a whole machine. The same
inputs give the same bytes: no dates, names in order.
"""

from __future__ import annotations

import contextlib
import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof import kit, s7
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.kit.builtin import REFERENCE
from modeproof.kit.bundle import CONTENTS, DEMANDS, FOLDER
from modeproof.kit.compact import compact, same
from modeproof.kit.vectors import COMPACT, open_suite, read_lines
from modeproof.registers.load import load_interface
from modeproof.registers.vector_files import of_machine, published_files, suite_name
from modeproof.suites.build import document_readings, document_texts, suite_file
from modeproof.suites.demands import load_demands
from modeproof.suites.kinds import SUITES

LARGEST = 5_000_000
"""Bytes of the whole file."""
NAME = "modeproof-kit.pyz"
_MAIN = "import sys\n\nfrom modeproof.kit.__main__ import main\n\nsys.exit(main())\n"
_FIRST_DATE = (1980, 1, 1, 0, 0, 0)
_SHEBANG = b"#!/usr/bin/env python3\n"


def pack(place: Path, targets: Mapping[str, str], path: Path, every: bool = False) -> dict[str, Any]:
    """Write the kit with the vectors of `targets` (target to document), which must have been built.

    Inside are the fast suites, or `every` suite. Returns its list of contents. Raises Unjudged where a suite
    is missing, or the file would be larger than `LARGEST`; then none is written.
    """
    contents: dict[str, Any] = {"targets": {}, "left_out": {}}
    members: dict[str, bytes] = {"__main__.py": _MAIN.encode(), "modeproof/__init__.py": b""}
    for package in (kit, s7):
        for source in sorted(Path(str(package.__file__)).parent.glob("*.py")):
            members[f"modeproof/{source.parent.name}/{source.name}"] = source.read_bytes()
    ours = Path(__file__).parents[2]
    for source in sorted((ours / REFERENCE).rglob("*.py")):  # says what to expect with other parameters
        members[str(source.relative_to(ours))] = source.read_bytes()
    with contextlib.suppress(OSError):
        members["LICENSE"] = (place / "LICENSE").read_bytes()
    for target, document in sorted(targets.items()):
        inside, outside = {}, {}
        for name, about in SUITES.items():
            file = suite_file(place, document, target, name)
            if not (about.fast or every):
                outside[name] = (
                    f"it is none of the fast ones; `modeproof vectors build {target} --suite {name}` makes it"
                )
                continue
            if not file.is_file():
                if about.always:
                    raise Unjudged(f"{target}: suite {name} is not built; `modeproof vectors build` does it")
                continue
            inside[name] = _inside(file, target, name, members)
        contents["targets"][target] = inside
        contents["left_out"][target] = outside
    demanded = {target: _demanded(place, document, target) for target, document in sorted(targets.items())}
    members[f"{FOLDER}/{DEMANDS}"] = json.dumps(demanded, sort_keys=True).encode()
    for file in published_files(place):
        if of_machine(file):
            target, name = file.parent.name, suite_name(file)
            of_target = contents["targets"].setdefault(target, {})
            of_target[name] = _inside(file, target, name, members)
    members[f"{FOLDER}/{CONTENTS}"] = json.dumps(contents, indent=1, sort_keys=True).encode()
    _write(path, members)
    return contents


def _demanded(place: Path, document: str, target: str) -> dict[str, Any]:
    """What a document demands of a target, and what the clauses say in our words."""
    table = load_demands(place, document, load_interface(place, document).devices[target])
    if table is None:
        return {}
    texts, cited = document_texts(place, document), {id for row in table["demands"] for id in row["clauses"]}
    said = {id: texts[id] for id in sorted(cited & texts.keys())}
    return {"demands": table, "texts": said, "readings": document_readings(place, document)}


def _inside(file: Path, target: str, name: str, members: dict[str, bytes]) -> dict[str, Any]:
    """The row of a vector file in the list of contents; the file is put to the members."""
    suite = open_suite(file)
    ending, data = _smaller(file)
    row = {
        "file": f"{target}/{name}{ending}",
        "bytes": len(data),
        "relations": list(suite.relations),
        "pace": suite.header["pace"],
        "cases": suite.case_count,
        "scans": suite.scan_count,
        "guarantees": suite.header["guarantees"],
    }
    members[f"{FOLDER}/{row['file']}"] = data
    return row


def _smaller(source: Path) -> tuple[str, bytes]:
    """A vector file as it goes in, and the ending of its name: compact where that can be, and read back."""
    packed = source.read_bytes()
    try:
        data = compact(read_lines(source))
    except ValueError:
        return ".jsonl.gz", packed
    if len(data) >= len(packed):
        return ".jsonl.gz", packed
    if not same(read_lines(source), data):
        raise Unjudged(f"{source.name}: its compact form does not give the same rows")
    return COMPACT, data


def _write(path: Path, members: Mapping[str, bytes]) -> None:
    packed = io.BytesIO()
    packed.write(_SHEBANG)
    with zipfile.ZipFile(packed, "w") as archive:
        for name, data in sorted(members.items()):
            info = zipfile.ZipInfo(name, _FIRST_DATE)
            info.external_attr = 0o644 << 16
            info.create_system = 3
            method = zipfile.ZIP_STORED if name.endswith((".gz", COMPACT)) else zipfile.ZIP_DEFLATED
            archive.writestr(info, data, method, 9)
    content = packed.getvalue()
    if len(content) > LARGEST:
        raise Unjudged(
            f"{path.name}: {len(content):,} bytes, more than {LARGEST:,}; a suite must stay outside"
        )
    write_whole(path, content, 0o755)
