"""Reads the small part of Markdown that our own pages use, as data that a template writes and escapes."""

from __future__ import annotations

import re
from typing import Any

_PIECE = re.compile(
    r"\*\*(?P<bold>.+?)\*\*|`(?P<code>[^`]+)`|\[(?P<link>[^\]]+)\]\([^)]*\)|\*(?P<em>[^*]+)\*"
)


def blocks(text: str) -> list[dict[str, Any]]:
    """Headings, paragraphs, lists, tables and code, in order; what a link leads to is left out."""
    found: list[dict[str, Any]] = []
    for block in re.split(r"\n\s*\n", text.strip()):
        lines = block.splitlines()
        if not lines:
            continue
        if found and found[-1]["kind"] == "code" and not found[-1].get("closed"):
            found[-1]["text"] += "\n\n" + block.removesuffix("```")
            found[-1]["closed"] = block.endswith("```")
        elif block.startswith("```"):
            closed = block.endswith("```") and len(lines) > 1
            found.append({"kind": "code", "text": "\n".join(lines[1:]).removesuffix("```"), "closed": closed})
        elif lines[0].startswith("#"):
            level, _, title = lines[0].partition(" ")
            found.append({"kind": "heading", "level": len(level), "pieces": pieces(title)})
            if len(lines) > 1:
                found += blocks("\n".join(lines[1:]))
        elif lines[0].startswith("|"):
            rows = [[pieces(cell.strip()) for cell in line.strip().strip("|").split("|")] for line in lines]
            found.append({"kind": "table", "heads": rows[0], "rows": rows[2:]})
        elif lines[0].startswith("- "):
            items = re.split(r"(?:\A|\n)- ", block)[1:]
            found.append({"kind": "list", "items": [pieces(" ".join(item.split())) for item in items]})
        elif not block.startswith("<!--"):
            found.append({"kind": "paragraph", "pieces": pieces(" ".join(block.split()))})
    return found


def pieces(text: str) -> list[dict[str, str]]:
    """Plain, bold and emphasised text, code, and the words of links."""
    found: list[dict[str, str]] = []
    end = 0
    for match in _PIECE.finditer(text):
        if match.start() > end:
            found.append({"kind": "text", "text": text[end : match.start()]})
        kind = str(match.lastgroup)
        text_of = match.group(kind).replace("`", "") if kind == "bold" else match.group(kind)
        found.append({"kind": "text" if kind == "link" else kind, "text": text_of})
        end = match.end()
    if end < len(text):
        found.append({"kind": "text", "text": text[end:]})
    return found
