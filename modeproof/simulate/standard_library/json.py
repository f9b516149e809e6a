"""`dumps` and `loads` for what goes over a wire: objects, lists, texts, whole numbers, true, false, null."""

from __future__ import annotations

MARKS = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def dumps(value, separators=(",", ":")):
    """The text of a value. Raises TypeError for any other type."""
    if value is None:
        return "null"
    if value is True or value is False:
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + "".join([MARKS.get(c, c) for c in value]) + '"'
    if isinstance(value, int):
        return str(value)
    comma, colon = separators
    if isinstance(value, dict):
        return (
            "{" + comma.join([dumps(str(k)) + colon + dumps(v, separators) for k, v in value.items()]) + "}"
        )
    if isinstance(value, (list, tuple)):
        return "[" + comma.join([dumps(v, separators) for v in value]) + "]"
    raise TypeError(f"{value!r} is not written as JSON")


def loads(text):
    """The value of a text, read by the browser. Raises ValueError."""
    from javascript import JSON

    return JSON.parse(text)
