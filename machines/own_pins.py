"""Blocks of one's own in a wiring: `of = "plc/estop.st:ESTOP"` names a function block and the file it is in.

Its source is read as `prove-program` reads one. Inputs of type BOOL and WORD are wired; all others are
parameters, which have a value in the wiring unless the block gives one. Outputs that are no BOOL and no WORD
are no pins.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from modeproof.ground.errors import Unjudged, suggestion
from programs.language.tree import BOOL, SCALARS, Scalar, Source, Unit
from programs.readers.sources import read_sources
from programs.semantics import document_blocks

FORM = re.compile(r"(?P<file>.+):(?P<unit>[A-Za-z_]\w*)")
PINS = (BOOL, SCALARS["WORD"])
"""What a wire carries."""


def file_of(of: str, wiring: str) -> tuple[Path, str] | None:
    """The file, named from the folder of the wiring, and the block; None: it is no block of one's own."""
    found = FORM.fullmatch(of)
    return None if found is None else (Path(wiring).parent / found["file"], found["unit"])


def source_of(files: Iterable[Path]) -> Source:
    """All blocks of these files. Raises Unjudged: file, line and cause; a name that is a document's."""
    source = read_sources(list(dict.fromkeys(files)))
    for refusal in source.refused.values():
        raise refusal
    for unit in source.units.values():
        if document_blocks.block(unit.name) is not None:
            raise unit.place.refuse(
                f"{unit.name} is the name of a document's block, and would take its place; give yours "
                "another name, or prove it alone with prove-program --target"
            )
    return source


def block_of(source: Source, name: str, file: Path) -> Unit:
    """The function block of this name. Raises Unjudged: there is none, or it cannot be called like one."""
    found = source.find(name)
    if found is None or found.kind != "function block":
        known = [unit.name for unit in source.units.values() if unit.kind == "function block"]
        raise Unjudged(f"{file} has no function block {name}; {suggestion(name, known)}")
    for variable in found.of("in_out").values():
        raise variable.place.refuse(f"{variable.name}: a block of a wiring has no VAR_IN_OUT")
    for variable in found.of("input").values():
        if not isinstance(variable.type, Scalar):
            raise variable.place.refuse(f"{variable.name}: an input of a block of a wiring is no structure")
    return found


def pins_of(unit: Unit) -> tuple[Mapping[str, Scalar], Mapping[str, Scalar], Mapping[str, Scalar]]:
    """Inputs, parameters and outputs by name."""
    ins = {name: one.type for name, one in unit.of("input").items() if isinstance(one.type, Scalar)}
    outs = {name: one.type for name, one in unit.of("output").items() if isinstance(one.type, Scalar)}
    return (
        {name: kind for name, kind in ins.items() if kind in PINS},
        {name: kind for name, kind in ins.items() if kind not in PINS},
        {name: kind for name, kind in outs.items() if kind in PINS},
    )
