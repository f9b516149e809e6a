"""The HMI: a touchscreen that offers the permitted modes, shows the echo of the selection, and asks for a
confirmation.

Covers steps 14, 15, 22 to 25 of the insert flow and 8, 9, 16 of the remove flow, with the HMI's rows of
Figures 3 and 9. One call of ``step`` is one scan; it sees at most one touch. Where the fields lie on the
screen is data: ``Layout``.

The panel is not safe. That it keeps to its duties (only permitted modes, automatic comparison, question to
the user, fields apart) is what the F-PLC cannot see, and what the user relies on (E-45).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.errors import LayoutError, StateError, check_int, check_text, check_word
from refimpl.mode_selection.code_tables import CH, NONE, RE, SE, SW, ZERO, decode, encode
from refimpl.mode_selection.permissions import (
    NO_MODES,
    UP_TO_0,
    UP_TO_1,
    UP_TO_2,
    UP_TO_3,
    UP_TO_4,
    check_permits,
    is_among,
    permitted_modes,
)

NO_TOUCH = ""
CONFIRM = "confirm"
REJECT = "reject"
TOUCHES = (NO_TOUCH, "select:0", "select:1", "select:2", "select:3", "select:4", CONFIRM, REJECT)


class Step(Enum):
    """The screen, and what it waits for. EKS-GP-3"""

    INHIBITED = "Inhibited"
    SELECT = "Select"
    AWAIT_ECHO = "AwaitEcho"
    CONFIRM = "Confirm"
    AWAIT_SWITCH = "AwaitSwitch"
    WITHDRAWN = "Withdrawn"


@dataclass(frozen=True, slots=True)
class Params:
    """What a level permits, the same as in the F-PLC; the layout of the screen is data of its own.

    PERMITS_0 to PERMITS_4: the modes that a level permits, one boolean a mode: itself and none above it
    (EKS-T2-2, E-47). Raises ParameterError.
    """

    PERMITS_0: tuple[bool, bool, bool, bool, bool] = UP_TO_0
    PERMITS_1: tuple[bool, bool, bool, bool, bool] = UP_TO_1
    PERMITS_2: tuple[bool, bool, bool, bool, bool] = UP_TO_2
    PERMITS_3: tuple[bool, bool, bool, bool, bool] = UP_TO_3
    PERMITS_4: tuple[bool, bool, bool, bool, bool] = UP_TO_4

    def __post_init__(self) -> None:
        check_permits("PERMITS_0", self.PERMITS_0, 0)
        check_permits("PERMITS_1", self.PERMITS_1, 1)
        check_permits("PERMITS_2", self.PERMITS_2, 2)
        check_permits("PERMITS_3", self.PERMITS_3, 3)
        check_permits("PERMITS_4", self.PERMITS_4, 4)


@dataclass(frozen=True, slots=True)
class State:
    """Memory of the panel between two scans: ``offered`` the level that the screen was opened with,
    ``selection`` the mode that was touched; both 0..4, or -1 for none.
    """

    params: Params
    state: Step
    offered: int
    selection: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one scan reads. Building it checks every field and raises InputError; nothing is coerced.

    ``dt_ms`` >= 0 (not used by the panel). ``ReadAuthorization``, ``CheckMSO``: words 0..65535 from the PLC.
    ``ActiveMSO``: the mode to display as active, 0..4 or -1. ``touch``: one of TOUCHES, "" when nothing was
    touched.
    """

    dt_ms: int
    ReadAuthorization: int
    CheckMSO: int
    ActiveMSO: int
    touch: str

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_word("ReadAuthorization", self.ReadAuthorization)
        check_word("CheckMSO", self.CheckMSO)
        check_int("ActiveMSO", self.ActiveMSO, NONE, 4)
        check_text("touch", self.touch, TOUCHES)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one scan writes and shows: two words to the PLC, the screen, the enabled selection fields (one
    boolean a mode), the echoed mode in the confirmation field, and the mode displayed as active (both 0..4 or
    -1).
    """

    SelectMSO: int
    SwitchMSO: int
    screen: str
    enabled: tuple[bool, bool, bool, bool, bool]
    shown: int
    active: int


def power_up(params: Params) -> State:
    """The state after power-up: access to the screen is inhibited, nothing is selected. EKS-8-8"""
    return State(params, Step.INHIBITED, NONE, NONE)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan: the check of Figures 3 and 9 first, then one step.

    EKS-GP-3, EKS-GP-4, EKS-3-0, EKS-9-0, EKS-3-2, EKS-9-2
    """
    after = _next_state(state, inputs)
    return after, outputs(after, inputs.ActiveMSO)


def outputs(s: State, active: int = NONE) -> Outputs:
    """What belongs to a state; ``active`` is passed through from this scan.

    SelectMSO goes out from the touch until the end or withdrawal (EKS-2-15, EKS-8-9, EKS-8-16), SwitchMSO
    only after the confirmation (EKS-2-24); the fields that the level does not permit stay closed (EKS-2-14,
    EKS-SD-4, E-47); the active mode is displayed always, also when the screen is inhibited (EKS-8-8, E-25).
    """
    c = s.state
    if c == Step.INHIBITED:
        return Outputs(ZERO, ZERO, "inhibited", NO_MODES, NONE, active)
    if c == Step.SELECT:
        return Outputs(ZERO, ZERO, "select", _open_fields(s), NONE, active)
    if c == Step.AWAIT_ECHO:
        return Outputs(encode(SE, s.selection), ZERO, "waiting", NO_MODES, NONE, active)
    if c == Step.CONFIRM:
        return Outputs(encode(SE, s.selection), ZERO, "confirm", NO_MODES, s.selection, active)
    if c == Step.AWAIT_SWITCH:
        return Outputs(encode(SE, s.selection), encode(SW, s.selection), "waiting", NO_MODES, NONE, active)
    return Outputs(ZERO, ZERO, "waiting", NO_MODES, NONE, active)


def _open_fields(s: State) -> tuple[bool, bool, bool, bool, bool]:
    """The modes that the offered level permits on this machine. EKS-2-14, EKS-T2-2, E-47"""
    p = s.params
    return permitted_modes(s.offered, p.PERMITS_0, p.PERMITS_1, p.PERMITS_2, p.PERMITS_3, p.PERMITS_4)


def _touched_mode(touch: str) -> int:
    """The mode of the selection field that was touched, or -1. EKS-2-14"""
    if touch == "select:0":
        return 0
    if touch == "select:1":
        return 1
    if touch == "select:2":
        return 2
    if touch == "select:3":
        return 3
    if touch == "select:4":
        return 4
    return NONE


def _next_state(s: State, i: Inputs) -> State:
    """The enable is the authorization word itself, no separate bit (E-46).

    EKS-3-1-HMI, EKS-3-4-HMI, EKS-9-1-HMI, EKS-9-4-HMI

    A level is one of the five words of RE (EKS-T2); zero is none (EKS-KS-8). Whenever the level is gone or
    is another one, the screen closes and the selection goes (EKS-8-8, EKS-SD-3, E-55), also while nothing is
    going on (EKS-GP-5).
    """
    level = decode(RE, i.ReadAuthorization)
    if s.state == Step.INHIBITED:
        return _inhibited(s, i, level)
    if level == NONE or level != s.offered:
        return _inhibit(s)  # InhibitScreen
    if s.state == Step.SELECT:
        return _select(s, i)
    if s.state == Step.AWAIT_ECHO:
        return _await_echo(s, i)
    if s.state == Step.CONFIRM:
        return _confirm(s, i)
    if s.state == Step.AWAIT_SWITCH:
        return _await_switch(s, i)
    if s.state == Step.WITHDRAWN:
        return _withdrawn(s, i)
    raise StateError("state", s.state, "a Step of the HMI")


def _inhibit(s: State) -> State:
    """Close the screen; the selection and with it both words go to zero.

    EKS-3-4-HMI, EKS-8-8, EKS-8-9, EKS-8-16
    """
    return State(s.params, Step.INHIBITED, NONE, NONE)


def _withdraw(s: State) -> State:
    """Take the selection back, which tells the F-PLC to give it up: SelectMSO goes to zero. EKS-2-25, E-21"""
    return State(s.params, Step.WITHDRAWN, s.offered, NONE)


def _inhibited(s: State, i: Inputs, level: int) -> State:
    """Wait for a level, and for an old echo to be gone; then open the screen.

    EKS-2-14, EKS-9-1-HMI, EKS-9-4-HMI, E-46, E-57
    """
    if level != NONE and i.CheckMSO == ZERO:
        return State(s.params, Step.SELECT, level, NONE)  # EnableScreen
    return s  # StayInhibited


def _select(s: State, i: Inputs) -> State:
    """Step 14: the user touches one of the enabled fields; step 15 sends it. EKS-2-14, EKS-2-15, EKS-FD-1

    An echo that nobody asked for closes the screen. A touch of a field that is not enabled has no effect.
    """
    if i.CheckMSO != ZERO:
        return _inhibit(s)  # InhibitScreen
    touched = _touched_mode(i.touch)
    if is_among(touched, _open_fields(s)):
        return State(s.params, Step.AWAIT_ECHO, s.offered, touched)  # TouchSelection
    return s  # OfferModes


def _await_echo(s: State, i: Inputs) -> State:
    """Wait until the F-PLC shows the selection back; another mode than the touched one is given up.

    EKS-2-22, E-19, E-20
    """
    if i.CheckMSO == ZERO:
        return s  # AwaitCheckMSO
    if i.CheckMSO == encode(CH, s.selection):
        return State(s.params, Step.CONFIRM, s.offered, s.selection)  # ShowEcho
    return _withdraw(s)  # AbandonSelection


def _confirm(s: State, i: Inputs) -> State:
    """Steps 22 to 25: the echoed mode is shown in a field of its own, and the user accepts or refuses it.

    EKS-2-22, EKS-2-23

    The echo must still be there in the scan of the touch (E-19, E-20). Accepting sends SwitchMSO (EKS-2-24);
    refusing takes the selection back (EKS-2-25, E-21).
    """
    if i.CheckMSO != encode(CH, s.selection):
        return _withdraw(s)  # AbandonSelection
    if i.touch == CONFIRM:
        return State(s.params, Step.AWAIT_SWITCH, s.offered, s.selection)  # TouchConfirm
    if i.touch == REJECT:
        return _withdraw(s)  # TouchReject
    return s  # AskConfirmation


def _await_switch(s: State, i: Inputs) -> State:
    """Step 24: both words stand until the F-PLC takes the echo away; no withdrawal is offered any more.

    EKS-2-24, E-15, E-53
    """
    if i.CheckMSO == encode(CH, s.selection):
        return s  # AwaitCleared
    if i.CheckMSO == ZERO:
        return State(s.params, Step.SELECT, s.offered, NONE)  # FinishSelection
    return _withdraw(s)  # AbandonSelection


def _withdrawn(s: State, i: Inputs) -> State:
    """Wait until the F-PLC has taken the echo away; then offer the modes again. EKS-2-25, E-15, E-21"""
    if i.CheckMSO == ZERO:
        return State(s.params, Step.SELECT, s.offered, NONE)  # FinishSelection
    return s  # AwaitWithdrawn


# ---------------------------------------------------------------- layout of the screen


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A field in pixels from the upper left corner; it covers x..x+width-1 and y..y+height-1."""

    x: int
    y: int
    width: int
    height: int

    def shares_columns(self, other: Rectangle) -> bool:
        """Whether some X coordinate lies in both."""
        return self.x < other.x + other.width and other.x < self.x + self.width

    def shares_rows(self, other: Rectangle) -> bool:
        """Whether some Y coordinate lies in both."""
        return self.y < other.y + other.height and other.y < self.y + self.height

    def covers(self, x: int, y: int) -> bool:
        """Whether the point lies in the field."""
        return self.x <= x < self.x + self.width and self.y <= y < self.y + self.height


@dataclass(frozen=True, slots=True)
class Layout:
    """Where the fields lie: ``screen`` is the whole display, ``selection`` one field a mode 0..4."""

    screen: Rectangle
    selection: tuple[Rectangle, Rectangle, Rectangle, Rectangle, Rectangle]
    confirm: Rectangle
    reject: Rectangle


DEFAULT_LAYOUT = Layout(
    screen=Rectangle(0, 0, 800, 480),
    selection=(
        Rectangle(20, 20, 300, 50),
        Rectangle(20, 80, 300, 50),
        Rectangle(20, 140, 300, 50),
        Rectangle(20, 200, 300, 50),
        Rectangle(20, 260, 300, 50),
    ),
    confirm=Rectangle(560, 380, 220, 80),
    reject=Rectangle(330, 380, 220, 80),
)


def check_layout(layout: Layout) -> None:
    """Refuse a layout whose confirmation field shares an X or a Y coordinate with any selection field.

    EKS-2-22

    Also refused, for the touch would be ambiguous or impossible: a field that is empty or leaves the screen,
    selection fields that overlap, a rejection field that overlaps the confirmation field. Raises LayoutError
    naming the field.
    """
    named = [(f"selection[{mode}]", field) for mode, field in enumerate(layout.selection)]
    if len(named) != 5:
        raise LayoutError("selection", len(named), "five fields, one a mode")
    for name, field in [
        ("screen", layout.screen),
        *named,
        ("confirm", layout.confirm),
        ("reject", layout.reject),
    ]:
        _check_field(name, field, layout.screen)
    for name, field in named:
        if layout.confirm.shares_columns(field):
            raise LayoutError("confirm", layout.confirm, f"no X coordinate in common with {name}")
        if layout.confirm.shares_rows(field):
            raise LayoutError("confirm", layout.confirm, f"no Y coordinate in common with {name}")
        for other_name, other in named:
            if other_name != name and field.shares_columns(other) and field.shares_rows(other):
                raise LayoutError(name, field, f"no point in common with {other_name}")
    if layout.reject.shares_columns(layout.confirm) and layout.reject.shares_rows(layout.confirm):
        raise LayoutError("reject", layout.reject, "no point in common with confirm")


def _check_field(name: str, field: Rectangle, screen: Rectangle) -> None:
    """A field has whole-number sides, is not empty and lies on the screen."""
    check_int(f"{name}.x", field.x, 0, None, LayoutError)
    check_int(f"{name}.y", field.y, 0, None, LayoutError)
    check_int(f"{name}.width", field.width, 1, None, LayoutError)
    check_int(f"{name}.height", field.height, 1, None, LayoutError)
    right, bottom = screen.x + screen.width, screen.y + screen.height
    if (
        field.x < screen.x
        or field.y < screen.y
        or field.x + field.width > right
        or field.y + field.height > bottom
    ):
        raise LayoutError(name, field, "a field on the screen")


def layout_record(layout: Layout) -> dict[str, list[int] | list[list[int]]]:
    """The layout as the panel tells it in the protocol: x, y, width, height of each field. EKS-2-22"""
    return {
        "screen": _sides(layout.screen),
        "selection": [_sides(field) for field in layout.selection],
        "confirm": _sides(layout.confirm),
        "reject": _sides(layout.reject),
    }


def _sides(field: Rectangle) -> list[int]:
    return [field.x, field.y, field.width, field.height]


def touch_at(layout: Layout, shown: Outputs, x: int, y: int) -> str:
    """The touch that a finger at (x, y) means while ``shown`` is on the screen; "" where no open field lies.

    EKS-2-14, EKS-2-22
    """
    if shown.screen == "select":
        for mode, field in enumerate(layout.selection):
            if shown.enabled[mode] and field.covers(x, y):
                return f"select:{mode}"
    if shown.screen == "confirm":
        if layout.confirm.covers(x, y):
            return CONFIRM
        if layout.reject.covers(x, y):
            return REJECT
    return NO_TOUCH
