"""How pages are made: what a template writes is escaped, and figures and texts have one form."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

import jinja2
from markupsafe import Markup

from modeproof.report.verdicts import ASIDE


@cache
def environment() -> jinja2.Environment:
    """Everything that a template writes is escaped, unless it is Markup of ours."""
    found = jinja2.Environment(
        loader=jinja2.PackageLoader("modeproof.report", "page"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.globals["ASIDE"] = ASIDE
    found.filters["number"] = number
    found.filters["script_json"] = script_json
    found.filters["css_string"] = css_string
    return found


def number(value: Any) -> str:
    """A figure as the page shows it: thousands by comma, seconds with one decimal."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return f"{value:,}" if isinstance(value, int) else f"{value:,.1f}"


def css_string(text: str) -> Markup:
    """A text as a string of a style sheet; whatever is not plain becomes its code."""
    return Markup('"' + re.sub(r"[^\w .,:/()-]", lambda found: f"\\{ord(found.group()):x} ", text) + '"')


def script_json(value: Mapping[str, Any]) -> Markup:
    """JSON that cannot end the script element in which it is."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029"))
