"""Pictures of a story: a PNG of the page at one step, by Chromium, or all steps as an animated SVG.

The SVG is drawn from what the scenes show, which run here in Python; scenes/<document>/story.svg.j2 says how.
"""

from __future__ import annotations

import os
import shutil
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.kit.by_name import module_named
from modeproof.registers.load import load_document
from modeproof.simulate import facts
from modeproof.simulate.program.play import actions

WIDE, HIGH = 1500, 900
"""CSS pixels of the window that is photographed; the picture is as high as the drawing."""
EDGE = 10
"""CSS pixels around the drawing."""
LINE = 122
"""Signs in a line of the SVG."""
SECONDS = 4
"""How long each step is shown."""


def svg(place: Path, id: str) -> str:
    """A story as an animation. Raises Unjudged where there is no such story, or nothing that draws it."""
    story = _story(facts.stories(place, facts.scenes(place)), id)
    name = story["of"]
    if not (place / "scenes" / name / "story.svg.j2").is_file():
        raise Unjudged(f"scenes/{name}/story.svg.j2 is missing; it draws the stories of {name}")
    known = facts.of_document(load_document(place, name))
    scene = module_named(f"scenes.{name}.scene").Scene
    cells = [
        (cell["title"], scene(known, cell["params"]))
        for cell in story.get("cell", [{"title": "", "params": {}}])
    ]
    frames: list[dict[str, Any]] = []
    for step in story["step"]:
        for action in actions(step):
            for _, cell in cells:
                cell.do(action)
        before = frames[-1]["cells"] if frames else [{}] * len(cells)
        shown = [cell.show() for _, cell in cells]
        frames.append({"lines": textwrap.wrap(step["say"], LINE), "cells": shown, "before": before})
    last = frames[-1]["cells"]
    frames.append({"lines": textwrap.wrap(story["end"], LINE), "cells": last, "before": last})
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(place / "scenes"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    template = environment.get_template(f"{name}/story.svg.j2")
    return template.render(story=story, titles=[title for title, _ in cells], frames=frames, seconds=SECONDS)


def png(place: Path, page: Path, id: str, step: int) -> bytes:
    """The drawing of a story after so many steps, as it is in the page.

    Raises Unjudged where there is no such story or step, no Chromium, or no playwright.
    """
    scenes = facts.scenes(place)
    told = facts.stories(place, scenes)
    story = _story(told, id)
    if not 0 <= step <= len(story["step"]):
        raise Unjudged(f"the story {id} has no step {step}; it has {len(story['step'])}")
    chromium = shutil.which(os.environ.get("MODEPROOF_CHROMIUM", "chromium"))
    try:
        from playwright.sync_api import Error, FloatRect, sync_playwright
    except ModuleNotFoundError:
        raise Unjudged(
            "playwright is missing, which drives Chromium; only a checkout has it: run `make venv` there"
        ) from None
    if chromium is None:
        raise Unjudged("Chromium is missing, which draws the page; install it, or ask for a .svg")
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
            view = browser.new_page(viewport={"width": WIDE, "height": HIGH}, reduced_motion="reduce")
            view.goto(page.resolve().as_uri())
            view.wait_for_function("() => window.modeproofReady !== undefined")
            view.select_option("#choose", str(told.index(story)))
            for _ in range(step):
                view.click("#next")
            drawn = f".part:not([hidden]) {'.cells' if story['of'] in scenes else '.cards'}"
            box = view.locator(drawn).bounding_box()
            if box is None:
                raise Unjudged(f"the page shows nothing of the story {id}")
            clip = FloatRect(
                x=box["x"] - EDGE,
                y=box["y"] - EDGE,
                width=box["width"] + 2 * EDGE,
                height=box["height"] + 2 * EDGE,
            )
            return view.screenshot(full_page=True, clip=clip)
    except Error as error:
        raise Unjudged(f"Chromium: {str(error).splitlines()[0]}") from None


def _story(stories: Sequence[dict[str, Any]], id: str) -> dict[str, Any]:
    told = {story["id"]: story for story in stories}
    if id not in told:
        raise Unjudged(f"no story {id!r}; {suggestion(id, list(told))}")
    return told[id]
