"""A part of the report: its data, the same in the page and in the JSON, and its troubles."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from enum import Enum
from typing import Any

from markupsafe import Markup

from modeproof.report.sources import Figure, Sources, Trouble


@dataclass(frozen=True)
class Part:
    """`id` is the anchor in the page, the key in the JSON and the template's name (page/<id>.html.j2)."""

    id: str
    title: str
    data: Mapping[str, Any]
    troubles: tuple[Trouble, ...] = ()
    payload: Mapping[str, bytes] = field(default_factory=dict)
    """What only scripts of the page read, by the id of its element: compressed by gzip, written as base64."""
    attachments: Mapping[str, bytes] = field(default_factory=dict)
    """Files for other programs (a CSV, JUnit XML) by their name: they lie beside the page and in it, where
    `m.attachment(name, label)` offers them."""


@dataclass(frozen=True)
class Picture:
    """SVG that we made, and what it shows in words. The JSON has the words; the rows beside it the rest."""

    title: str
    svg: Markup


Maker = Callable[[Sources], Part]
"""How a part is made; it never raises for evidence that is missing: that is a trouble."""


def plain(value: Any) -> Any:
    """The data as JSON has them; a figure keeps its source."""
    if isinstance(value, Figure):
        return {"value": value.value, "source": value.source, **({"unit": value.unit} if value.unit else {})}
    if isinstance(value, Picture):
        return {"picture": value.title}
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple, set, frozenset)):
        return [plain(one) for one in (sorted(value) if isinstance(value, (set, frozenset)) else value)]
    if isinstance(value, Enum):
        return value.value
    if is_dataclass(value) and not isinstance(value, type):
        return plain({field_.name: getattr(value, field_.name) for field_ in fields(value)})
    return value
