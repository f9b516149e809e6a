"""The vectors that come with the kit: one packed file for each target and suite, and a list of them."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged, suggestion
from modeproof.kit.vectors import FILE_NAME, Suite, open_suite, same_rows

FOLDER = "vectors"
CONTENTS = "contents.json"
"""The list in the folder: what is inside, and what was left out."""
DEMANDS = "demands.json"
"""In the folder: of each target what its document demands, and what the clauses say in our words."""
FAST = "fast"


@dataclass(frozen=True)
class Bundle:
    """Where the vectors are: a folder, or an archive with this folder in it."""

    place: Path

    @staticmethod
    def own() -> Bundle:
        """That of the archive that this code runs from, if it runs from one."""
        for parent in Path(__file__).resolve().parents:
            if parent.is_file():
                return Bundle(parent)
        raise Unjudged("no vectors are here: --vectors FILE names some")

    def contents(self) -> Mapping[str, Any]:
        """The list. Raises Unjudged where there is none."""
        try:
            with zipfile.ZipFile(self.place) as archive:
                found: Mapping[str, Any] = json.loads(archive.read(f"{FOLDER}/{CONTENTS}"))
        except (OSError, KeyError, ValueError, zipfile.BadZipFile) as error:
            raise Unjudged(f"{self.place.name}: no vectors inside: {error}") from None
        return found

    def suites(self, target: str, names: Sequence[str], relation: str) -> list[Suite]:
        """The suites asked for, in the order of the list. Raises Unjudged for one that is not inside."""
        contents = self.contents()
        targets = contents["targets"]
        if target not in targets:
            raise Unjudged(f"no target {target!r} inside; {suggestion(target, targets)}")
        rows = targets[target]
        chosen = []
        for name, row in rows.items():
            fitting = relation in row["relations"] and row["pace"] == FAST
            if name in names or (FAST in names and fitting):
                chosen.append(open_suite(self.place, f"{FOLDER}/{row['file']}"))
        missing = [name for name in names if name != FAST and name not in rows]
        if missing:
            left_out = contents.get("left_out", {}).get(target, {}).get(missing[0], "")
            why = f": {left_out}" if left_out else f"; {suggestion(missing[0], [FAST, *rows])}"
            raise Unjudged(f"suite {missing[0]} is not inside{why}")
        if not chosen:
            raise Unjudged(f"no suite of {target} is for relation {relation}")
        return self.demanding(chosen)

    def demanding(self, suites: Sequence[Suite]) -> list[Suite]:
        """The suites with what is demanded of their targets. Raises Unjudged where there is no list of it."""
        try:
            with zipfile.ZipFile(self.place) as archive:
                known = json.loads(archive.read(f"{FOLDER}/{DEMANDS}"))
            rows = [(suite, known.get(suite.target, {})) for suite in suites]
            return [
                suite.demanding(row.get("demands"), row.get("texts"), row.get("readings"))
                for suite, row in rows
            ]
        except (OSError, KeyError, ValueError, AttributeError, zipfile.BadZipFile) as error:
            raise Unjudged(f"{self.place.name}: no demands inside: {error}") from None


def not_published(suite: Suite) -> str:
    """What a verdict says of a vector file that somebody handed over: nothing where it is a published one.

    A verdict on cases that were cut short, or on a file of one's own, must not look like one on the suite.
    """
    place = Path(__file__).resolve().parents[2] / FOLDER / suite.target
    try:
        known = open_suite(place / FILE_NAME.format(suite=suite.name))
    except Unjudged:  # the packed kit has them inside
        try:
            (known,) = Bundle.own().suites(suite.target, [suite.name], suite.relations[0])
        except Unjudged:
            return "not published" if place.is_dir() else "of which this kit has no copy"
    return "" if same_rows(known, suite) else "not as published"
