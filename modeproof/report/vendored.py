"""What the page carries of other people's programs: DataTables, from the package itables, with licences."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib import metadata, resources

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import adding

SCRIPT, STYLE = "datatables-script", "datatables-style"
"""The ids of the payload; the page unpacks them when the first table comes into view."""
_EXPORT = re.compile(r"export\s*\{([^}]*)\};?")
_LICENCES = "/*! Bundled license information:"


@dataclass(frozen=True)
class Package:
    """A package whose work is in the page or made it; `notices` are those of what it bundles."""

    name: str
    version: str
    licence: str
    use: str
    notices: str = ""


@cache
def tables() -> tuple[bytes, bytes]:
    """The script of DataTables as one that runs in a page (`globalThis.DataTable`), and its style.

    Raises Unjudged when the package is not there or is built in another way.
    """
    try:
        folder = resources.files("itables").joinpath("html")
        script = folder.joinpath("dt_bundle.js").read_text(encoding="utf-8")
        style = folder.joinpath("dt_bundle.css").read_text(encoding="utf-8")
    except (ModuleNotFoundError, OSError) as error:
        raise Unjudged(
            f"itables, which carries DataTables, cannot be read: {error}; {adding('report', 'itables')}"
        ) from None
    found = list(_EXPORT.finditer(script))
    names = {
        exported: inner
        for one in (found[-1].group(1).split(",") if found else ())
        for inner, _, exported in [one.strip().partition(" as ")]
    }
    if "default" not in names:
        raise Unjudged("itables: dt_bundle.js exports no DataTable; this version is not known")
    export = found[-1]
    body = script[: export.start()] + f"globalThis.DataTable={names['default']};" + script[export.end() :]
    return f'(()=>{{"use strict";{body}\n}})();'.encode(), style.encode()


def packages() -> tuple[Package, ...]:
    """What is in the page, and what made it, with versions and licences as the packages give them."""
    rows = (
        ("itables", "in the page: DataTables, jQuery and their kin, which filter and sort tables"),
        ("jinja2", "made the page"),
        ("markupsafe", "made the page: escapes every text"),
        ("grandalf", "made the page: places the states of a chart"),
        ("jsonschema", "checked registers and evidence"),
    )
    return tuple(_package(name, use) for name, use in rows)


def _package(name: str, use: str) -> Package:
    try:
        about = metadata.metadata(name)
    except metadata.PackageNotFoundError:
        return Package(name, "not installed", "", use)
    classifiers = [
        classifier.rpartition(" :: ")[2]
        for classifier in about.get_all("Classifier") or ()
        if classifier.startswith("License")
    ]
    texts = [about[key] for key in ("License-Expression", "License") if key in about]
    text = str(texts[0]).strip() if texts else ""
    licence = text.splitlines()[0] if text else "; ".join(classifiers)
    notices = ""
    if name == "itables":
        script = tables()[0].decode("utf-8")
        notices = script.partition(_LICENCES)[2].partition("*/")[0].strip()
    return Package(name, str(about["Version"]), licence or "not stated", use, notices)
