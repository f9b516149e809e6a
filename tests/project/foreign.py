"""A small repository of somebody else: its programs are those of examples/ under other names."""

from __future__ import annotations

from pathlib import Path

from modeproof.ground.places import TREE

EXAMPLES = TREE / "examples"
BLOCK = (EXAMPLES / "st/sf_edm.st").read_text("utf-8")
WRONG = BLOCK.replace("IF S_EDM1 AND S_EDM2 THEN", "IF S_EDM1 THEN")
TOML = 'version = 1\n\n[program.contactors]\nfiles = ["plc/contactors.st"]\ntarget = "sf_edm"\n'


def write(folder: Path, **texts: str) -> Path:
    """Write texts to files; `plc__a_st` is plc/a.st."""
    for name, text in texts.items():
        *parts, end = name.replace("__", "/").rpartition("_")
        path = folder / f"{parts[0]}.{end}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
    return folder


def renamed(text: str, **names: str) -> str:
    """The text with other names."""
    for old, new in names.items():
        assert old in text
        text = text.replace(old, new)
    return text
