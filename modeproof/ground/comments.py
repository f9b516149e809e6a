"""Where the comments and strings of a TLA+ text are."""

from __future__ import annotations

import re

_TOKEN = re.compile(r'\\\\|(?P<line>\\\*[^\n]*)|(?P<block>\(\*)|(?P<string>"(?:[^"\\\n]|\\.)*"?)')
_MARK = re.compile(r"\(\*|\*\)")
_VISIBLE = re.compile(r"[^\n]")


def split(text: str) -> tuple[str, str, list[tuple[int, int]]]:
    """The text without comments, the same without strings, and the spans of the comments.

    Blanks are in the place of what is left out, so that all else keeps its line and column.
    """
    code: list[str] = []
    bare: list[str] = []
    comments: list[tuple[int, int]] = []
    done, token = 0, _TOKEN.search(text)
    while token:
        begin, end = token.span()
        if token["block"]:
            end = _block_end(text, begin)
        if token["string"] or token["block"] or token["line"]:
            blank = _VISIBLE.sub(" ", text[begin:end])
            code += text[done:begin], text[begin:end] if token["string"] else blank
            bare += text[done:begin], blank
            done = end
            if not token["string"]:
                comments.append((begin, end))
        token = _TOKEN.search(text, end)
    return "".join([*code, text[done:]]), "".join([*bare, text[done:]]), comments


def _block_end(text: str, start: int) -> int:
    depth, end = 0, start
    while mark := _MARK.search(text, end):
        depth += 1 if mark.group() == "(*" else -1
        end = mark.end()
        if not depth:
            return end
    return len(text)
