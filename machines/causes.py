"""Why a machine breaks a property: the row of its wiring with which the same scans break nothing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from machines.concrete_runs import Runner, Scan, rule_of
from modeproof.ground.errors import Unjudged
from refimpl.errors import ParameterError


def mended(
    runner: Runner,
    table: Mapping[str, Any],
    scans: Sequence[Scan],
    row: Mapping[str, Any],
    own: Mapping[str, Any],
) -> Iterator[str]:
    """The rows of a wiring that are not as in `own`, and with whose text there the scans break nothing."""
    wiring = runner.wiring
    for path, there in differences(table, own):
        try:
            other = Runner.of(wiring, runner.watched, runner.use, with_row(table, path, there))
            if other.broken(scans, rule_of(row, [], other.named)) is None:
                here = f"{wiring.file}:{wiring.place(path).line}: {path}"
                yield f"{here}; with {there!r}, as in the project's own, these scans break nothing"
        except (Unjudged, ParameterError, KeyError):
            continue


def differences(
    table: Mapping[str, Any], own: Mapping[str, Any], above: str = ""
) -> Iterator[tuple[str, Any]]:
    """The rows of `table` that stand otherwise in `own`, with their value there."""
    for key, value in table.items():
        path = f"{above}{key}"
        if key not in own or key in ("why", "title", "from", "to"):
            continue
        if isinstance(value, dict) and isinstance(own[key], dict):
            yield from differences(value, own[key], f"{path}.")
        elif value != own[key]:
            yield path, own[key]


def with_row(table: Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """The tables with another value in one row."""
    head, _, rest = path.partition(".")
    return {**table, head: with_row(table[head], rest, value) if rest else value}
