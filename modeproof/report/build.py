"""Makes the report: every part from the sources, one page without outer resources, and the same as JSON."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path, PurePosixPath
from typing import Any

import jinja2
from markupsafe import Markup

from modeproof.ground.errors import Unjudged
from modeproof.report.baseline import Baseline
from modeproof.report.contradictions import contradictions
from modeproof.report.environment import environment as made_environment
from modeproof.report.filing import Filing, commit_of
from modeproof.report.integrity import BLANK, seal_json, seal_of_json, seal_page
from modeproof.report.missing import missing, mixed, unexpected
from modeproof.report.part import Maker, Part, plain
from modeproof.report.parts import FILED, makers
from modeproof.report.parts.review import sheet
from modeproof.report.snapshot import snapshot
from modeproof.report.sources import HOLE, NOTE, Sources, Trouble, gather
from modeproof.report.terms import Terms
from modeproof.report.vendored import SCRIPT, STYLE, tables

SCHEMA_VERSION = 1
SCHEMA = Path(__file__).with_name("report.schema.json")
"""What the JSON is; a test holds it against this."""
SCRIPTS = ("report.js", "review.js", "explorer.js", "charts.js", "traces.js")
"""Files of page/, in the order in which the page has them."""
FIRST = FILED[0]
"""The part that shows the troubles of all."""
LAST = "changes"
"""The part that is made after all others, for what it is compared with rests on what they read."""
SHOWN = 4
"""So many troubles of one part and kind are on the first screen; the part has all."""
UNMADE = "unmade"
"""The key of a part's data that says why there is nothing else."""
ODD = (Unjudged, LookupError, TypeError, ValueError, AttributeError, AssertionError, jinja2.TemplateError)
"""What reading evidence of an unknown form raises."""
CHECKS = (missing, unexpected, contradictions, mixed)
NOTHING: dict[str, Any] = {"verdicts": {}, "results": {}, "mutants": {}, "pins": {}, "moved": {}, "tools": {}}
WORDS = {0: "as expected", 1: "NOT as expected", 2: "NOT judged completely"}


@dataclass(frozen=True)
class Report:
    """The page, the JSON, what is wrong, and the files beside the page by their names."""

    html: str
    json: str
    troubles: tuple[Trouble, ...]
    attachments: Mapping[str, bytes] = field(default_factory=dict)
    baseline: Baseline = field(default_factory=Baseline)

    @property
    def status(self) -> int:
        """1 where something is not as expected, else 2 where something is missing, else 0."""
        return _status(self.troubles)


def _status(troubles: Sequence[Trouble]) -> int:
    return min((trouble.status for trouble in troubles if trouble.status != NOTE), default=0)


def make(
    root: Path,
    baseline: Callable[[str], Baseline] = lambda digest: Baseline(),
    filing: Filing | None = None,
    said: Callable[[str, float], None] = lambda part, share: None,
) -> Report:
    """The report on what lies in `root`. Identical registers, evidence and filing give an identical report.

    `baseline` gives, for the digest of all that was read, the earlier report to compare with. `said` is told
    which part is made now, and which share of the parts there is already (0 to 1).
    """
    said("evidence", 0)
    sources = gather(root, filing)
    if sources.filing.answers is not None:
        sheet(sources)
    found = [trouble for check in CHECKS for trouble in _checked(check, sources)]
    sources = replace(sources, troubles=(*sources.troubles, *found))
    made: dict[str, Part] = {}
    parts_to_make = [(id, maker) for id, maker in makers() if id != LAST]
    for number, (id, maker) in enumerate(parts_to_make):
        said(id, number / len(parts_to_make))
        made[id] = _made(id, maker, sources)
    try:
        sources.cache["snapshot"] = snapshot(sources)
    except ODD as error:
        sources.cache["snapshot"] = {**NOTHING, "verdicts": {"all": f"UNJUDGED: {_says(error)}"}}
    sources.cache["baseline"] = baseline(sources.digest)
    made |= {id: _made(id, maker, sources) for id, maker in makers() if id == LAST}
    parts = _with_troubles([made[id] for id, _ in makers()], sources)
    troubles = tuple(dict.fromkeys(t for part in parts for t in part.troubles))
    text = seal_json(_as_json(sources, parts, troubles))
    seal = seal_of_json(text)
    return Report(
        seal_page(_page(sources, parts, troubles, seal[0] if seal else BLANK)),
        text,
        troubles,
        {name: content for part in parts for name, content in part.attachments.items()},
        sources.cache["baseline"],
    )


def _made(id: str, maker: Maker, sources: Sources) -> Part:
    """The part; where evidence of a valid form holds what it should not, a part that says so in its place."""
    try:
        part = maker(sources)
        html = _rendered(part, ())
        plain(part.data)
        if id != FIRST:
            sources.cache[f"html of {id}"] = html
        return part
    except ODD as error:
        what = (
            f"the part {id} cannot be made: {_says(error)}; a register or evidence has not the form it should"
        )
        title = id.capitalize()
        return Part(id, title, {UNMADE: what}, (Trouble(HOLE, id, what, "modeproof verify"),))


def _checked(check: Callable[[Sources], Iterator[Trouble]], sources: Sources) -> Iterator[Trouble]:
    """What a check finds; where evidence has not the form that it should have, that."""
    try:
        yield from check(sources)
    except ODD as error:
        what = (
            f"not checked ({check.__name__}): {_says(error)}; evidence has not the form that it should have"
        )
        yield Trouble(HOLE, "verdict", what, "modeproof verify")


def _says(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _rendered(part: Part, troubles: tuple[Trouble, ...]) -> str:
    """The HTML of a part, as its template makes it."""
    environment = made_environment()
    name = "unmade" if UNMADE in part.data else part.id
    macros = environment.get_template("macros.html.j2").module
    return environment.get_template(f"{name}.html.j2").render(
        data=part.data, m=macros, troubles=troubles, shown=SHOWN
    )


def _with_troubles(parts: list[Part], sources: Sources) -> list[Part]:
    """The parts, each with the troubles that concern it; the first has those that concern no other."""
    known = {part.id for part in parts}
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


def _as_json(sources: Sources, parts: list[Part], troubles: tuple[Trouble, ...]) -> str:
    content = {
        "schema_version": SCHEMA_VERSION,
        "sha256": BLANK,
        "digest": sources.digest,
        "documents": list(sources.filing.documents),
        "status": _status(troubles),
        "troubles": plain(troubles),
        "parts": {part.id: {"title": part.title, **plain(part.data)} for part in parts},
        "snapshot": sources.cache["snapshot"],
        "attachments": {
            name: hashlib.sha256(data).hexdigest()
            for part in parts
            for name, data in part.attachments.items()
        },
        "files": dict(sorted(sources.files.items())),
        "results": sources.results,
    }
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _page(sources: Sources, parts: list[Part], troubles: tuple[Trouble, ...], json_sha256: str) -> str:
    environment = made_environment()
    macros = environment.get_template("macros.html.j2").module
    terms = Terms(sources)
    shown = [
        {
            "id": part.id,
            "title": part.title,
            "troubles": part.troubles,
            "bad": sum(1 for trouble in part.troubles if trouble.status),
            "filed": part.id in FILED,
            "html": Markup(
                terms.linked(part.id, sources.cache.get(f"html of {part.id}") or _rendered(part, troubles))
            ),
        }
        for part in parts
    ]
    payload = [(id, _packed(content)) for part in parts for id, content in part.payload.items()]
    payload += [(f"file-{name}", _packed(data)) for part in parts for name, data in part.attachments.items()]
    payload += _packed_tables()
    status = _status(troubles)
    scripts = [_file(name) for name in SCRIPTS]
    commit = sources.once("commit", lambda: commit_of(sources.root))
    titles = [document.about.title for document in sources.documents.values()]
    shown[0]["html"] = Markup(shown[0]["html"]) + terms.explained(f"{shown[0]['html']} {parts[0].title}")
    return environment.get_template("report.html.j2").render(
        parts=shown,
        title=titles[0] if len(titles) == 1 else f"{len(titles)} safety procedures",
        day=sources.filing.day or "no date given",
        commit=f"commit {commit}" if commit else "no commit",
        chosen=" ".join(sources.filing.documents),
        state={"word": WORDS[status], "good": (True, False, None)[status]},
        m=macros,
        blank=BLANK,
        json_sha256=json_sha256,
        digest=sources.digest,
        files=dict(sorted(sources.files.items())),
        results=sources.results,
        folders=_folders(sources),
        payload=payload,
        styles=Markup(_file("report.css")),
        scripts=[Markup(text) for text in scripts],
        script_hashes=Markup(_policy([*(text.encode() for text in scripts), tables()[0]])),
    )


def _policy(scripts: Sequence[bytes]) -> str:
    """The scripts that a page may run, each by its hash, as its policy names them; it runs no other."""
    digests = (base64.b64encode(hashlib.sha256(script).digest()).decode() for script in scripts)
    return " ".join(f"'sha256-{digest}'" for digest in digests)


def _folders(sources: Sources) -> dict[str, str]:
    """For each folder, with its files: one SHA-256 over the list of their hashes; "" is all."""
    names = {
        "",
        *(f"{parent.as_posix()}/" for path in sources.files for parent in PurePosixPath(path).parents),
    }
    return {name: sources.digest_of(name) for name in sorted(names - {"./"})}


def _file(name: str) -> str:
    return resources.files("modeproof.report").joinpath("page", name).read_text(encoding="utf-8")


@cache
def _packed_tables() -> tuple[tuple[str, str], ...]:
    return tuple((id, _packed(data)) for id, data in zip((SCRIPT, STYLE), tables(), strict=True))


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")
