"""A program beside a published target, ready to be judged, and what the verdict will be about."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.registers.profiles import NEITHER, profiles_of, profiles_with
from programs.equality.binding import Binding
from programs.equality.product import Product
from programs.language.shared_memory import completed
from programs.language.subset import check
from programs.language.tool_differences import assumed
from programs.readers.sources import read_sources
from programs.semantics.reference import reference


def make(
    files: list[Path],
    target: str,
    unit: str | None = None,
    binding: Mapping[str, Any] | None = None,
    wrap: bool = False,
    split: tuple[str, ...] = (),
    codes: bool = True,
) -> Product:
    """The program beside the target; binding: see `read_binding`. Raises Unjudged with file, line, cause.

    codes: compare also outputs that the document does not print, such as a code or a state of ours.
    """
    of = reference(target)
    if not codes:
        ours = tuple(name for name, signal in of.signals("outputs").items() if signal.project)
        given = dict(binding or {})
        left = (*given.get("left_out", ()), *ours)
        names = {name: own for name, own in given.get("names", {}).items() if name not in ours}
        binding = given | {"left_out": tuple(dict.fromkeys(left)), "names": names}
    source = read_sources(files)
    chosen = completed(source, source.chosen(unit))
    check(source, chosen)
    return Product(Binding(of, source, chosen, **(binding or {})), wrap, split)


def about(product: Product) -> Iterator[tuple[str, str]]:
    """What a verdict is about, in lines of a label and a text."""
    binding, signals = product.binding, product.binding.reference.signals("parameters")
    yield "compared", ", ".join(binding.compared)
    own = f"; of the program's own: {', '.join(binding.unasked)}" if binding.unasked else ""
    yield "left out", (", ".join(binding.left_out) or "no output") + own
    narrowed = {text.partition(" ")[0]: text for text in binding.narrowed()}
    free = []
    for name in binding.free_parameters:
        signal = signals[name]
        whole = f"{name} {signal.minimum or 0}..{signal.maximum}" if signal.type in ("ms", "int") else name
        free.append(narrowed.get(name, whole))
    yield (
        "parameters",
        "; ".join(
            [
                f"any {', '.join(free)}" if free else "none is an input of the program",
                *(f"{name} = {value}" for name, value in binding.values.items()),
            ]
        ),
    )
    if profile := profile_of(binding):
        yield "profile", profile
    yield "inputs", f"every value, {times_of(product)}"
    yield "numbers", numbers_of(product)
    if choices := list(assumed(binding.source, binding.unit, binding.steady)):
        yield "assumed", "; ".join(choices)


def profile_of(binding: Binding) -> str:
    """The profile that the values of a binding are those of; empty where the target has none."""
    device = binding.reference.device.register
    return (" and ".join(profiles_with(device, binding.values)) or NEITHER) if profiles_of(device) else ""


def times_of(product: Product) -> str:
    """The times between scans that a verdict is about."""
    longest = product.binding.longest_scan
    most = "any elapsed time" if longest is None else f"elapsed times up to {longest:,}"
    return f"{most} of whole milliseconds"


def numbers_of(product: Product) -> str:
    """What integers may do."""
    return "wrap" if product.wrap else "stay within their types"
