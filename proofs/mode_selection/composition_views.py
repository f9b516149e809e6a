"""What the composition argument sees of a device and of one scan of it, as solver terms.

The same records are built twice: from the paths of the shipped `step`, to prove what a scan guarantees, and
from free symbols, to argue about all devices together with nothing but those guarantees. Control states are
their positions in the module's Step; words are 16-bit words, all 65536 of them (so the classes of words are
not needed here); modes and levels are -1 to 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from types import ModuleType
from typing import Any, Final

import z3

from proofs.explorer.device import Device, Scan, scans
from proofs.explorer.ends import TRUE, Tree, always, ends, tree
from proofs.explorer.explore import disjunction
from proofs.explorer.values import Proxy
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.mode_selection.ranges import codes
from proofs.theorem import TheoremError
from proofs.words import BITS, constant
from refimpl.mode_selection import eks, fplc, hmi
from refimpl.mode_selection.code_tables import NONE, ZERO

LEVELS: Final = range(5)
EKS_OUTPUTS: Final = ("A", "B", "C", "D", "STR")
Flags = tuple[z3.BoolRef, ...]
Mode = Any
"""A mode or level -1 to 4, a control state, a position: an integer of a device, a byte of the system, or a
plain number. Formulas compare it with numbers only.
"""

# ---------------------------------------------------------------- words and states


def code(name: str, mode: Mode) -> z3.BitVecRef:
    """The word of the range that means the mode, zero for none. EKS-T2"""
    term: z3.BitVecRef = constant(ZERO)
    for number, value in enumerate(codes(name)):
        term = z3.If(mode == number, constant(value), term)
    return term


def means(name: str, word: z3.BitVecRef, mode: Mode) -> z3.BoolRef:
    """The word means the mode in the range; a word that is no code means none. EKS-T2, EKS-KS-9"""
    found = [z3.And(word == value, mode == number) for number, value in enumerate(codes(name))]
    return z3.Or(*found, z3.And(mode == NONE, *[word != value for value in codes(name)]))


def is_mode(term: Mode) -> z3.BoolRef:
    """0 to 4, not none."""
    return z3.And(term >= 0, term <= 4)


def _position(module: ModuleType, name: str) -> int:
    return [member.value for member in module.Step].index(name)


def _among(module: ModuleType, state: Mode, names: Sequence[str]) -> z3.BoolRef:
    return disjunction([state == _position(module, name) for name in names])


def signals(outputs: Flags, level: Mode) -> z3.BoolRef:
    """Exactly the output of this level is set; with no level, none is."""
    return z3.And(*[flag == (level == number) for number, flag in enumerate(outputs)])


def none_of(flags: Flags) -> z3.BoolRef:
    """No output is set."""
    return z3.Not(z3.Or(*flags))


def permits(rows: tuple[Flags, ...], level: Mode, mode: Mode | int) -> z3.BoolRef:
    """The level permits the mode on this machine; no level permits nothing. E-47"""
    if isinstance(mode, int):
        return z3.Or(*[z3.And(level == number, rows[number][mode]) for number in LEVELS])
    return z3.Or(
        *[z3.And(level == number, mode == two, rows[number][two]) for number in LEVELS for two in LEVELS]
    )


def permissions_fit(rows: tuple[Flags, ...]) -> z3.BoolRef:
    """Each level permits itself and none above it: the total order of Figure 5. EKS-T2-2, E-47"""
    own = [rows[level][level] for level in LEVELS]
    above = [z3.Not(rows[level][mode]) for level in LEVELS for mode in LEVELS if mode > level]
    return z3.And(*own, *above)


# ---------------------------------------------------------------- devices


@dataclass(frozen=True)
class Fplc:
    """Memory of the F-PLC, and what it last wrote."""

    state: Mode
    accepted: Mode
    authority: Mode
    selection: Mode
    mode: Mode
    MW01: z3.BitVecRef
    MW05: z3.BitVecRef
    MSO: Flags
    ERROR: z3.BoolRef

    def at(self, *names: str) -> z3.BoolRef:
        """In one of these control states."""
        return _among(fplc, self.state, names)


@dataclass(frozen=True)
class Hmi:
    """Memory of the panel, what it last wrote, and what it displays."""

    state: Mode
    offered: Mode
    selection: Mode
    SelectMSO: z3.BitVecRef
    SwitchMSO: z3.BitVecRef
    enabled: Flags
    shown: Mode
    active: Mode

    def at(self, *names: str) -> z3.BoolRef:
        """In one of these control states."""
        return _among(hmi, self.state, names)


@dataclass(frozen=True)
class Plc:
    """The four words as the PLC last wrote them."""

    ReadAuthorization: z3.BitVecRef
    MW03: z3.BitVecRef
    CheckMSO: z3.BitVecRef
    MW07: z3.BitVecRef


@dataclass(frozen=True)
class Eks:
    """The level word of the key in the reader's memory, LA and the five outputs."""

    state: Mode
    level: z3.BitVecRef
    LA: z3.BoolRef
    outputs: Flags

    def at(self, *names: str) -> z3.BoolRef:
        """In one of these control states."""
        return _among(eks, self.state, names)


@dataclass(frozen=True)
class FplcScan:
    """One scan of the F-PLC: memory before, inputs, memory and outputs after.

    dwelt: the timer has reached T_DWELL_ms in this scan. switches: the scan writes the mode outputs, also
    where that mode was active before. holds: ON_ERROR is "hold".
    """

    before: Fplc
    after: Fplc
    LA: z3.BoolRef
    outputs: Flags
    MW03: z3.BitVecRef
    MW07: z3.BitVecRef
    dwelt: z3.BoolRef
    switches: z3.BoolRef
    holds: z3.BoolRef
    rows: tuple[Flags, ...]


@dataclass(frozen=True)
class HmiScan:
    """One scan of the panel; `touch` is the position in TOUCHES."""

    before: Hmi
    after: Hmi
    ReadAuthorization: z3.BitVecRef
    CheckMSO: z3.BitVecRef
    ActiveMSO: Mode
    touch: Mode
    rows: tuple[Flags, ...]

    def touches(self, field: str) -> z3.BoolRef:
        """This field is touched."""
        return self.touch == hmi.TOUCHES.index(field)

    def selects(self, mode: Mode) -> z3.BoolRef:
        """The selection field of this mode is touched."""
        return z3.Or(*[z3.And(mode == number, self.touches(f"select:{number}")) for number in LEVELS])


@dataclass(frozen=True)
class PlcScan:
    """One scan of the PLC."""

    before: Plc
    after: Plc
    MW01: z3.BitVecRef
    MW05: z3.BitVecRef
    SelectMSO: z3.BitVecRef
    SwitchMSO: z3.BitVecRef


@dataclass(frozen=True)
class EksScan:
    """One scan of the EKS, whatever its reader holds."""

    before: Eks
    after: Eks


# ---------------------------------------------------------------- free symbols


def flags(name: str, count: int = 5) -> Flags:
    """Free booleans."""
    return tuple(z3.Bool(f"{name}.{number}") for number in range(count))


def permission_symbols() -> tuple[Flags, ...]:
    """Five rows of five free booleans; F-PLC and panel of one machine have the same (E-47)."""
    return tuple(flags(f"permits_{level}") for level in LEVELS)


def word(name: str) -> z3.BitVecRef:
    """A free word."""
    return z3.BitVec(name, BITS)


def small(name: str) -> z3.BitVecRef:
    """A free number of 8 bits, with its sign: for modes, control states and positions."""
    return z3.BitVec(name, 8)


def fplc_symbols(when: str) -> Fplc:
    """An F-PLC of free symbols; `when` is the end of their names."""
    return Fplc(
        state=small(f"fplc.state{when}"),
        accepted=small(f"fplc.accepted{when}"),
        authority=small(f"fplc.authority{when}"),
        selection=small(f"fplc.selection{when}"),
        mode=small(f"fplc.mode{when}"),
        MW01=word(f"fplc.MW01{when}"),
        MW05=word(f"fplc.MW05{when}"),
        MSO=flags(f"fplc.MSO{when}"),
        ERROR=z3.Bool(f"fplc.ERROR{when}"),
    )


def hmi_symbols(when: str) -> Hmi:
    """A panel of free symbols."""
    return Hmi(
        state=small(f"hmi.state{when}"),
        offered=small(f"hmi.offered{when}"),
        selection=small(f"hmi.selection{when}"),
        SelectMSO=word(f"hmi.SelectMSO{when}"),
        SwitchMSO=word(f"hmi.SwitchMSO{when}"),
        enabled=flags(f"hmi.enabled{when}"),
        shown=small(f"hmi.shown{when}"),
        active=small(f"hmi.active{when}"),
    )


def plc_symbols(when: str) -> Plc:
    """A PLC of free symbols."""
    return Plc(*[word(f"plc.{name}{when}") for name in ("ReadAuthorization", "MW03", "CheckMSO", "MW07")])


def eks_symbols(when: str) -> Eks:
    """An EKS of free symbols."""
    return Eks(
        small(f"eks.state{when}"), word(f"eks.level{when}"), z3.Bool(f"eks.LA{when}"), flags(f"eks{when}")
    )


# ---------------------------------------------------------------- from the paths of the shipped code


def _term(value: Any) -> Any:
    """A leaf of a result as a solver term; a plain number is a mode or a level."""
    if isinstance(value, Proxy) or hasattr(value, "premise"):
        return value.term
    if isinstance(value, bool):
        return z3.BoolVal(value)
    if isinstance(value, Enum):
        return z3.IntVal(list(type(value)).index(value))
    return z3.IntVal(value)


def _word(value: Any) -> z3.BitVecRef:
    term: z3.BitVecRef = value.term if not isinstance(value, int) else constant(value)
    return term


def _rows(params: Any) -> tuple[Flags, ...]:
    return tuple(tuple(mode.term for mode in getattr(params, f"PERMITS_{level}")) for level in LEVELS)


def _fplc(state: Any, out: Any) -> Fplc:
    free = fplc_symbols(" before")
    return Fplc(
        state=_term(state.state),
        accepted=_term(state.accepted),
        authority=_term(state.authority),
        selection=_term(state.selection),
        mode=_term(state.mode),
        MW01=_word(out.MW01) if out else free.MW01,
        MW05=_word(out.MW05) if out else free.MW05,
        MSO=tuple(_term(getattr(out, f"MSO_{mode}")) for mode in LEVELS) if out else free.MSO,
        ERROR=_term(out.ERROR) if out else free.ERROR,
    )


def _fplc_scan(scan: Scan, result: Any) -> FplcScan:
    before, seen, params = scan.state, scan.inputs, scan.state.params
    after, out = result
    same_mode = isinstance(after.mode, Proxy) and after.mode.term.eq(before.mode.term)
    on_error = params.ON_ERROR
    return FplcScan(
        _fplc(before, None),
        _fplc(after, out),
        seen.LA.term,
        tuple(getattr(seen, eks_output).term for eks_output in EKS_OUTPUTS),
        seen.MW03.term,
        seen.MW07.term,
        before.elapsed_ms.term + seen.dt_ms.term >= params.T_DWELL_ms.term,
        z3.BoolVal(not same_mode and after.state != fplc.Step.ERROR),
        on_error.term == on_error.values.index("hold"),
        _rows(params),
    )


def _hmi(state: Any, out: Any) -> Hmi:
    free = hmi_symbols(" before")
    return Hmi(
        state=_term(state.state),
        offered=_term(state.offered),
        selection=_term(state.selection),
        SelectMSO=_word(out.SelectMSO) if out else free.SelectMSO,
        SwitchMSO=_word(out.SwitchMSO) if out else free.SwitchMSO,
        enabled=tuple(_term(flag) for flag in out.enabled) if out else free.enabled,
        shown=_term(out.shown) if out else free.shown,
        active=_term(out.active) if out else free.active,
    )


def _hmi_scan(scan: Scan, result: Any) -> HmiScan:
    seen = scan.inputs
    return HmiScan(
        _hmi(scan.state, None),
        _hmi(*result),
        seen.ReadAuthorization.term,
        seen.CheckMSO.term,
        seen.ActiveMSO.term,
        seen.touch.term,
        _rows(scan.state.params),
    )


def _plc(record: Any) -> Plc:
    names = ("ReadAuthorization", "MW03", "CheckMSO", "MW07")
    return Plc(*[_word(getattr(record, name)) for name in names])


def _plc_scan(scan: Scan, result: Any) -> PlcScan:
    seen = scan.inputs
    words = [getattr(seen, name).term for name in ("MW01", "MW05", "SelectMSO", "SwitchMSO")]
    return PlcScan(_plc(scan.state), _plc(result[1]), *words)


def _eks(state: Any, out: Any) -> Eks:
    where, level = _term(state.state), _word(state.key.authorization_level)
    if out is None:
        free = eks_symbols(" before")
        return Eks(where, level, free.LA, free.outputs)
    return Eks(
        where, level, _term(out.LA), tuple(_term(getattr(out, eks_output)) for eks_output in EKS_OUTPUTS)
    )


def _eks_scan(scan: Scan, result: Any) -> EksScan:
    return EksScan(_eks(scan.state, None), _eks(*result))


_VIEW: Final = {"fplc": _fplc_scan, "hmi": _hmi_scan, "plc": _plc_scan, "eks": _eks_scan}


@dataclass(frozen=True)
class Ends:
    """A scan from one control state: the tree of its paths, and what each end of it looks like."""

    scan: Scan
    root: Tree
    views: dict[int, Any]

    def always(self, formula: Callable[[Any], z3.BoolRef], whole: bool = False) -> z3.BoolRef:
        """To whichever end the scan comes, the formula is true of it.

        Left out, unless the whole is asked for, are ends of which it is true as soon as they are put in.
        """
        found = {number: formula(view) for number, view in self.views.items()}
        if not whole:
            found = {number: formula if _is_open(formula) else TRUE for number, formula in found.items()}
        return always(self.root, lambda end: found[id(end)])


def _is_open(formula: z3.BoolRef) -> bool:
    return not z3.is_true(z3.simplify(formula))


def ends_of(device: Device) -> tuple[Ends, ...]:
    """All scans of a device, by control state. Raises TheoremError where a path raises."""
    return tuple(ends_in(device, scan) for scan in scans(device))


def ends_in(device: Device, scan: Scan) -> Ends:
    """The scan from one control state. Raises TheoremError where a path raises."""
    for path in scan.paths:
        if path.raised is not None:
            raise TheoremError(f"from {scan.control.value} step raises: {path.raised}")
    root, view = tree(scan.paths), _VIEW[device.name]
    return Ends(scan, root, {id(end): view(scan, end.result) for end in ends(root)})


def view_of(device: Device, state: Any, outputs: Any) -> Any:
    """The record of a device with this memory and these outputs, from the shipped code."""
    if device is PLC:
        return _plc(outputs)
    build = {FPLC.name: _fplc, HMI.name: _hmi, EKS.name: _eks}
    return build[device.name](state, outputs)


def first_view(device: Device) -> Any:
    """The device as it is after power-up, from the shipped `power_up` and `outputs`. A-19"""
    params = device.module.Params(lambda data: 0) if device is EKS else device.module.Params()
    state = device.module.power_up(params)
    return view_of(device, state, device.module.outputs(state))
