"""Seals of a report: each of its files holds the SHA-256 of its own text, and the page that of the JSON."""

from __future__ import annotations

import hashlib
import re

BLANK = "0" * 64
"""Stands in the place of a seal while the hash is worked out."""
_PAGE = re.compile(r'(<meta name="modeproof-page" content=")([0-9a-f]{64})(">)')
_OF_JSON = re.compile(r'<meta name="modeproof-json" content="([0-9a-f]{64})">')
_JSON = re.compile(r'(\A\{\n "schema_version": \d+,\n "sha256": ")([0-9a-f]{64})(",)')


def sha256(text: str) -> str:
    """SHA-256 of a text as it lies in a file."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def seal_page(text: str) -> str:
    """The page with its own hash in the place that is blank."""
    return _sealed(_PAGE, text)


def seal_json(text: str) -> str:
    """The JSON with its own hash in the place that is blank."""
    return _sealed(_JSON, text)


def _sealed(form: re.Pattern[str], text: str) -> str:
    digest = sha256(_blank(form, text))
    return form.sub(rf"\g<1>{digest}\g<3>", text, count=1)


def _blank(form: re.Pattern[str], text: str) -> str:
    return form.sub(rf"\g<1>{BLANK}\g<3>", text, count=1)


def seal_of_page(text: str) -> tuple[str, str] | None:
    """The seal that a page holds, and the hash that it has; None: it holds none."""
    return _seal_of(_PAGE, text)


def seal_of_json(text: str) -> tuple[str, str] | None:
    """The seal that a JSON holds, and the hash that it has; None: it holds none."""
    return _seal_of(_JSON, text)


def _seal_of(form: re.Pattern[str], text: str) -> tuple[str, str] | None:
    found = form.search(text)
    return (found.group(2), sha256(_blank(form, text))) if found else None


def json_of_page(text: str) -> str | None:
    """The seal of the JSON that belongs to a page."""
    found = _OF_JSON.search(text)
    return found.group(1) if found else None
