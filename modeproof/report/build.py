"""Makes the report: every part from the sources, one page without outer resources, and the same as JSON."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from modeproof.report.part import Part, plain
from modeproof.report.parts import makers
from modeproof.report.sources import NOTE, Sources, Trouble, gather

SCHEMA_VERSION = 1
STYLES = ("report.css", "tables.css")
SCRIPTS = ("report.js",)
"""Files of page/, in the order in which the page has them."""


@dataclass(frozen=True)
class Report:
    """The page, the JSON, what is wrong, and the files beside the page by their names."""

    html: str
    json: str
    troubles: tuple[Trouble, ...]
    attachments: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def status(self) -> int:
        """1 where something is not as expected, else 2 where something is missing, else 0."""
        return min((one.status for one in self.troubles if one.status != NOTE), default=0)


def make(root: Path) -> Report:
    """The report on what lies in `root`. Identical registers and evidence give an identical report."""
    sources = gather(root)
    parts = _with_troubles([maker(sources) for _, maker in makers()], sources)
    return Report(
        _page(sources, parts),
        _as_json(sources, parts),
        tuple(t for p in parts for t in p.troubles),
        {name: content for one in parts for name, content in one.attachments.items()},
    )


def _with_troubles(parts: list[Part], sources: Sources) -> list[Part]:
    """The parts, each with the troubles that concern it; the first has those that concern no other."""
    known = {one.id for one in parts}
    return [
        replace(
            one,
            troubles=(
                *(t for t in sources.troubles if t.part == one.id or (not place and t.part not in known)),
                *one.troubles,
            ),
        )
        for place, one in enumerate(parts)
    ]


def _as_json(sources: Sources, parts: list[Part]) -> str:
    content = {
        "schema_version": SCHEMA_VERSION,
        "digest": sources.digest,
        "troubles": plain([t for one in parts for t in one.troubles]),
        "parts": {one.id: {"title": one.title, **plain(one.data)} for one in parts},
        "files": sources.files,
    }
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _page(sources: Sources, parts: list[Part]) -> str:
    environment = _environment()
    macros = environment.get_template("macros.html.j2").module
    shown = [
        {
            "id": one.id,
            "title": one.title,
            "troubles": one.troubles,
            "html": Markup(environment.get_template(f"{one.id}.html.j2").render(data=one.data, m=macros)),
        }
        for one in parts
    ]
    payload = [(id, _packed(content)) for one in parts for id, content in one.payload.items()]
    payload += [(f"file-{name}", _packed(data)) for one in parts for name, data in one.attachments.items()]
    return environment.get_template("report.html.j2").render(
        parts=shown,
        m=macros,
        digest=sources.digest,
        files=sources.files,
        payload=payload,
        styles=Markup("\n".join(_file(name) for name in STYLES)),
        scripts=[Markup(_file(name)) for name in SCRIPTS],
    )


def _file(name: str) -> str:
    return resources.files("modeproof.report").joinpath("page", name).read_text(encoding="utf-8")


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")


@cache
def _environment() -> jinja2.Environment:
    """Everything that a template writes is escaped, unless it is Markup of ours."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("modeproof.report", "page"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["number"] = number
    environment.filters["script_json"] = script_json
    return environment


def number(value: Any) -> str:
    """A figure as the page shows it: thousands by comma, seconds with one decimal."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return f"{value:,}" if isinstance(value, int) else f"{value:,.1f}"


def script_json(value: Mapping[str, Any]) -> Markup:
    """JSON that cannot end the script element in which it stands."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029"))
