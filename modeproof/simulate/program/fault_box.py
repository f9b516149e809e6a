"""The box beside the button of a fault: what detects it, by the table of faults, or that nothing does."""

from __future__ import annotations

from typing import Any

from modeproof.simulate.program.view import line

NOTHING = "No fault is in."


def draw_fault(root: Any, faults: list[dict[str, Any]], active: str) -> None:
    """Draw the box anew: `active` is the id of the fault, or empty."""
    for button in root.select("[data-fault]"):
        button.attrs["aria-pressed"] = "true" if button.attrs["data-fault"] == active else "false"
    about = root.select_one("[data-about]")
    about.clear()
    frame = about.parentElement
    pressed = root.select_one(f'[data-fault="{active}"]') if active else None
    if pressed is None:
        frame.parentElement.insertBefore(frame, frame.parentElement.firstElementChild)
    else:
        pressed.parentElement.insertBefore(frame, pressed.nextElementSibling)
    for fault in [fault for fault in faults if fault["id"] == active]:
        line(about, "p", "In: ", f"{fault['title']}. {fault['model']}")
        line(about, "p", "Detected by: ", ", ".join(fault["detected_by"]) or "nothing")
        for fall in fault["falls"]:
            line(about, "p", f"{fall['property']} fails: ", fall["needs"])
        line(about, "p", "Not detected: ", fault["not_detected"])
    if not active:
        line(about, "p", "", NOTHING)
