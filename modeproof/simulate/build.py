"""Makes the page: one HTML file that carries all it needs and asks for nothing."""

from __future__ import annotations

import json
import re
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents
from modeproof.registers.load import load_document
from modeproof.simulate import bundle, facts

PAGE = Path(__file__).with_name("page")
LARGEST = 4_000_000
"""Bytes of the page."""


def make(place: Path) -> str:
    """The page's text. Raises Unjudged where something that it needs is missing, or where it is too large."""
    names = documents(place)
    known = {name: facts.of_document(load_document(place, name)) for name in names}
    scenes = facts.scenes(place)
    told = facts.stories(place, scenes)
    script, notice = bundle.brython()
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader([PAGE, place / "scenes"]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    blocks = {
        device: (name, row)
        for name, about in known.items()
        if name not in scenes
        for device, row in about["devices"].items()
    }
    html = environment.get_template("simulate.html.j2").render(
        style=_palette() + (PAGE / "simulate.css").read_text(encoding="utf-8"),
        script=(PAGE / "simulate.js").read_text(encoding="utf-8"),
        brython=_in_script(script),
        notice=notice,
        modules=_json({"$timestamp": 1, **bundle.modules(place)}),
        facts=_json({"documents": known, "scenes": scenes, "stories": told, "blocks": [*blocks]}),
        known=known,
        scenes=scenes,
        blocks=blocks,
        stories=told,
    )
    return small_enough(html)


def small_enough(html: str) -> str:
    """The page, unless it has more than `LARGEST` bytes: then raises Unjudged."""
    size = len(html.encode("utf-8"))
    if size > LARGEST:
        raise Unjudged(f"the page has {size:,} bytes, more than {LARGEST:,}: not written")
    return html


def _palette() -> str:
    """The colours of the report, so that both pages look alike."""
    text = resources.files("modeproof.report").joinpath("page", "report.css").read_text(encoding="utf-8")
    found = re.search(r":root \{[^}]*\}", text)
    if found is None:
        raise Unjudged(
            "modeproof/report/page/report.css: no rule for :root; the page takes its colours from it"
        )
    return found.group(0) + "\n"


def _json(value: Any) -> str:
    return _in_script(json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False))


def _in_script(text: str) -> str:
    """Text that cannot end the script that it is in."""
    return re.sub(r"<(?=/script|!--|script)", r"\\u003c", text, flags=re.IGNORECASE)
