"""What comes of one wrong copy between the flag words in a nominal selection, by refimpl.

The same question as KeyFlowsCopies.tla asks of the specification, asked here of the code: every key, every
mode, the devices in step, one flag word (or one word that begins a byte beside it) over another at every step
of the F-PLC, for one round or for five. Words are whole words here, not classes of words.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from refimpl.mode_selection import eks, fplc, hmi, key_flows, plc
from refimpl.mode_selection.code_tables import NONE, RE
from refimpl.mode_selection.key_flows import System

TICK_MS = 200
EKS_PARAMS = eks.Params(lambda data: len(data), T_PULSE_ms=TICK_MS)
FPLC_PARAMS = fplc.Params(
    T_ON_ms=5 * TICK_MS,
    T_SEQ_ms=5 * TICK_MS,
    T_REM_ms=9 * TICK_MS,
    T_DWELL_ms=2 * TICK_MS,
    T_SEQ_FROM="LA",
    SELECTIONS="again",
)

BESIDE = {"MW01": ("MW02",), "MW03": ("MW02", "MW04"), "MW05": ("MW04", "MW06"), "MW07": ("MW06",)}
"""The words that begin one byte after a flag word, or one byte before it, and overlap only flag words."""

HOLDING = {
    fplc.Step.AUTHORIZE: "Authorize",
    fplc.Step.AWAIT_SELECTION: "AwaitSelection",
    fplc.Step.CHECK_SELECTION: "CheckSelection",
    fplc.Step.ECHO_SELECTION: "EchoSelection",
    fplc.Step.AWAIT_ACKNOWLEDGMENT: "AwaitAcknowledgment",
    fplc.Step.CHECK_ACKNOWLEDGMENT: "CheckAcknowledgment",
    fplc.Step.MATCH: "Match",
    fplc.Step.SWITCH: "Switch",
    fplc.Step.COMPLETE: "Complete",
    fplc.Step.SETTLE: "Settle",
}
"""The steps of the F-PLC in which a key is accepted."""

PLACES = {"MW01": "ReadAuthorization", "MW03": "MW03", "MW05": "CheckMSO", "MW07": "MW07"}
"""Where a word that was written wrong to a flag word is read next."""


@dataclass(frozen=True)
class Play:
    """A selection on its way: the system, what the user did and saw, the wrong copy, what was switched."""

    system: System
    goal: int
    touched: int = NONE
    seen: int = NONE
    confirmed: int = NONE
    waited: int = 0
    stays: int = 0
    place: str = ""
    made: tuple[str, ...] = ()


def flag_word(system: System, name: str) -> int:
    """A flag word as F-PLC and PLC hold it, or the word at an even address between two of them."""
    words = {1: system.fplc_out.MW01, 3: system.plc_out.MW03, 5: system.fplc_out.MW05, 7: system.plc_out.MW07}
    address = int(name[2:])
    if address in words:
        return words[address]
    return (words[address - 1] & 0xFF) << 8 | words[address + 1] >> 8


def written(system: System, place: str, word: int) -> System:
    """The system with another word in one of the four places that the PLC writes."""
    state = system.plc_state
    if place == "ReadAuthorization":
        state = replace(state, ReadAuthorization=word)
    elif place == "MW03":
        state = replace(state, MW03=word)
    elif place == "CheckMSO":
        state = replace(state, CheckMSO=word)
    else:
        state = replace(state, MW07=word)
    return replace(system, plc_state=state, plc_out=plc.outputs(state))


def eks_turn(play: Play) -> Play:
    return replace(play, system=key_flows.scan_eks(play.system, TICK_MS))


def fplc_turn(play: Play) -> Play:
    before = key_flows.active_mode(play.system)
    system = key_flows.scan_fplc(play.system, TICK_MS)
    mode = key_flows.active_mode(system)
    made = play.made if mode == before else (*play.made, what_was_made(play, mode))
    return replace(play, system=system, made=made)


def what_was_made(play: Play, mode: int) -> str:
    if play.touched != mode:
        return "not touched"
    return "as confirmed" if play.seen == play.confirmed == mode else "not confirmed"


def plc_turn(play: Play) -> Play:
    """Four copies; the wrong word is not yet written anew while it stays."""
    kept = getattr(play.system.plc_out, play.place) if play.stays else 0
    system = play.system
    for _ in range(4):
        system = key_flows.scan_plc(system, 0)
    if play.stays:
        system = written(system, play.place, kept)
    return replace(play, system=system, stays=max(0, play.stays - 1))


def hmi_turn(play: Play) -> Play:
    screen = play.system.hmi_state.state
    system = play.system
    if screen == hmi.Step.SELECT and play.touched == NONE:
        system = key_flows.touch(system, f"select:{play.goal}")
    elif screen == hmi.Step.CONFIRM and play.waited >= 6:
        system = key_flows.touch(system, "confirm")
    system = key_flows.scan_hmi(system, TICK_MS)
    after = system.hmi_state.state
    waited = play.waited + 1 if after == hmi.Step.CONFIRM else 0
    play = replace(play, system=system, waited=waited)
    if screen == hmi.Step.SELECT and after == hmi.Step.AWAIT_ECHO:
        return replace(play, touched=play.goal, seen=NONE, confirmed=NONE)
    if after == hmi.Step.CONFIRM and play.touched == system.hmi_out.shown:
        play = replace(play, seen=play.touched)
    if screen == hmi.Step.CONFIRM and after == hmi.Step.AWAIT_SWITCH:
        play = replace(play, confirmed=play.seen)
    return play


TURNS = (eks_turn, fplc_turn, plc_turn, hmi_turn)


def ended(play: Play) -> bool:
    """The F-PLC has refused, or all are back where the next selection begins."""
    words = play.system.plc_out
    quiet = words.MW03 == words.CheckMSO == words.MW07 == 0 and (
        words.ReadAuthorization == play.system.fplc_out.MW01
    )
    return play.system.fplc_state.state == fplc.Step.ERROR or (
        play.touched != NONE
        and play.system.fplc_state.state == fplc.Step.AWAIT_SELECTION
        and play.system.hmi_state.state == hmi.Step.SELECT
        and quiet
        and not play.stays
    )


def outcome(play: Play, turn: int) -> str:
    """Plays on from the given turn to the end, and says what came of it."""
    for _ in range(400):
        refused = play.system.fplc_state.state == fplc.Step.ERROR
        if refused or (turn == 0 and ended(play)):
            return ", ".join([*play.made, *(["refused"] if refused else [])]) or "withdrawn"
        play = TURNS[turn](play)
        turn = (turn + 1) % len(TURNS)
    raise AssertionError(f"no end: {play}")


def overwritten(play: Play, turn: int, level: int) -> Iterator[str]:
    """The outcomes of every wrong copy that can be made before this turn."""
    step = HOLDING.get(play.system.fplc_state.state)
    targets = {1: ("MW03", "MW07"), 3: ("MW01", "MW05")}.get(turn, ())
    if step is None or play.waited > 1:
        return
    for target in targets:
        others = (*(name for name in PLACES if name != target), *BESIDE[target])
        for source in others:
            word = flag_word(play.system, source)
            if word == getattr(play.system.plc_out, PLACES[target]):
                continue
            system = written(play.system, PLACES[target], word)
            for rounds, how_long in ((1, "one scan"), (5, "five scans")):
                wrong = replace(play, system=system, stays=rounds - 1, place=PLACES[target])
                what = outcome(wrong, turn)
                wished = what in ("refused", "withdrawn", "as confirmed")
                whose = "" if wished else f" (level {level}, mode {play.goal})"
                yield f"{source} over {target} at {step}, {how_long}: {what}{whose}"


def single_copies() -> set[str]:
    """Every cell of the matrix with each of its outcomes."""
    cells: set[str] = set()
    for level in range(5):
        for goal in range(level + 1):
            key = eks.written_key(6, RE[level], 1, 1, EKS_PARAMS.checksum)
            system = key_flows.insert_key(key_flows.power_up(EKS_PARAMS, FPLC_PARAMS), key)
            play, turn = Play(system, goal), 0
            while not (turn == 0 and ended(play)):
                cells.update(overwritten(play, turn, level))
                play = TURNS[turn](play)
                turn = (turn + 1) % len(TURNS)
    return cells
