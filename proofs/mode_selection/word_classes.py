"""Why a few words are enough for the models: our code cannot tell the members of one class apart.

The models try a few words: zero, the five codes, and one word for all others. Which inputs they take together
is written by hand, in interface.toml and in the alphabet `Words` of the OPEN_ module; here both are read, and
checked against the paths of the shipped `step`. A class that is too coarse for the code has a counterexample:
two members that lead to two ends.
"""

import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import z3

from proofs.explorer.device import LOGIC, Device, Scan, scans
from proofs.explorer.explore import conjunction, disjunction
from proofs.explorer.records import symbols, terms
from proofs.explorer.values import Word, flag, word
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.mode_selection.ranges import accepted, codes
from proofs.theorem import Queries, TheoremError, claim, control, theorem
from proofs.words import one_of

ROOT: Final = Path(__file__).parents[2]
CLASSES: Final = "spec/mode_selection/interface.toml"
OPEN_MODULE: Final = {"fplc": "spec/mode_selection/FplcOpen.tla", "hmi": "spec/mode_selection/HmiOpen.tla"}


def alphabet(device: Device) -> tuple[int, ...]:
    """The words that the device's model tries one by one, without the one that stands for all others.

    Of an alphabet with a shorter choice the longest counts: what the shorter one leaves out it does not try.
    """
    text = (ROOT / OPEN_MODULE[device.name]).read_text(encoding="utf-8")
    definition = re.search(r"^Words ==(.*(?:\n +.*)*)", text, re.MULTILINE)
    lists = re.findall(r"<<(.*?)>>", definition.group(1)) if definition else []
    items = [item.strip() for item in max(lists, key=len, default="").split(",")]
    if "OtherWord" not in items:
        raise TheoremError(f"{OPEN_MODULE[device.name]}: no alphabet Words with OtherWord in it")
    listed = [item for item in items if item != "OtherWord"]
    known = {"0": 0, **{f"RE[{mode}]": code for mode, code in enumerate(codes("RE"))}}
    for item in listed:
        if item not in known:
            raise TheoremError(f"{OPEN_MODULE[device.name]}: the word {item} is unknown here")
    return tuple(known[item] for item in listed)


def classes(device: Device) -> list[dict[str, Any]]:
    """The rows of interface.toml for the device."""
    rows = tomllib.loads((ROOT / CLASSES).read_text(encoding="utf-8"))["class"]
    return [row for row in rows if row["device"] == device.name]


def _same_end(scan: Scan, changed: Sequence[tuple[z3.ExprRef, z3.ExprRef]]) -> z3.BoolRef:
    """Wherever the first values lead, the second ones do too."""
    pairs = [(result, z3.substitute(result, *changed)) for result in _results(scan).reached]
    moved = [z3.Implies(left, other) for left, other in pairs if not left.eq(other)]
    return conjunction(moved)


@dataclass(frozen=True)
class _Results:
    """When each result of a control state is reached, and on which symbols each place of a result depends."""

    reached: tuple[z3.BoolRef, ...]
    symbols: dict[str, set[str]]


_KEPT: dict[int, tuple[Scan, _Results]] = {}


def _results(scan: Scan) -> _Results:
    """Paths with the same result are taken together, for the code may ask more than it uses."""
    if id(scan) not in _KEPT:
        ends: dict[object, list[z3.BoolRef]] = {}
        names: dict[str, set[str]] = {}
        seen: set[int] = set()
        for path in scan.paths:
            leaves = list(terms(path.result))
            ends.setdefault(tuple(_identity(leaf) for _, leaf in leaves), []).append(path.condition)
            for place, leaf in leaves:
                if isinstance(leaf, z3.ExprRef) and leaf.get_id() not in seen:
                    seen.add(leaf.get_id())
                    names.setdefault(place, set()).update(_names(leaf))
        _KEPT[id(scan)] = scan, _Results(tuple(map(disjunction, ends.values())), names)
    return _KEPT[id(scan)][1]


def _identity(leaf: object) -> object:
    """The same for two equal leaves: z3 keeps one term only of those that are written alike."""
    return ("term", leaf.get_id()) if isinstance(leaf, z3.ExprRef) else repr(leaf)


def _refuse_results_with(scan: Scan, changed: Sequence[z3.ExprRef]) -> None:
    """No result of a path may depend on what was changed. Raises TheoremError."""
    names = {symbol.decl().name() for symbol in changed}
    for place, found in _results(scan).symbols.items():
        if names & found:
            raise TheoremError(f"from {scan.control.value}: {place} depends on {', '.join(sorted(names))}")


def _names(term: z3.ExprRef) -> set[str]:
    if z3.is_const(term):
        return {term.decl().name()}
    return set().union(*[_names(child) for child in term.children()])


def _others(device: Device, row: dict[str, Any], few: int = 0) -> Iterator[tuple[str, Any, Any, z3.BoolRef]]:
    """A class: its name, two members as (old, new) terms, and the premise. `few`: leave out listed words."""
    listed = alphabet(device)[: -few or None]
    old, new = word(f"in.{row['field']}").term, word(f"other.{row['field']}").term
    both = z3.And(z3.Not(one_of(old, listed)), z3.Not(one_of(new, listed)))
    yield f"{row['field']}: words beside the alphabet", [old], [new], both


def _counts(row: dict[str, Any]) -> Iterator[tuple[str, Any, Any, z3.BoolRef]]:
    """As `_others`, for a class of flags by how many of them are set."""
    old = [flag(f"in.{name}").term for name in row["fields"]]
    new = [flag(f"other.{name}").term for name in row["fields"]]
    low, high = row["at_least"], row["at_most"]
    both = z3.And(_counted(old, low, high), _counted(new, low, high))
    yield f"{low} to {high} of {' '.join(row['fields'])}", old, new, both


def _counted(flags: Sequence[z3.BoolRef], low: int, high: int) -> z3.BoolRef:
    total = z3.Sum(*[z3.If(flag, 1, 0) for flag in flags])
    return z3.And(total >= low, total <= high)


def _indistinguishable(device: Device) -> Queries:
    """For each class of the device and each control state: two members lead to the same end."""
    rows = classes(device)
    if not rows:
        raise TheoremError(f"interface.toml has no class of {device.name}")
    for scan in scans(device):
        for row in rows:
            for name, old, new, both in _others(device, row) if row["rule"] == "words" else _counts(row):
                _refuse_results_with(scan, old)
                given = {"all in their ranges": scan.premise, "two members of the class": both}
                then = _same_end(scan, list(zip(old, new, strict=True)))
                if not z3.is_true(then):
                    yield from claim(f"{scan.control.value}: {name}", given, then, LOGIC)


def _too_coarse(device: Device, control_state: str, field: str) -> Queries:
    """A class that also holds the last word of the alphabet is told apart in this control state."""
    (scan,) = [scan for scan in scans(device) if scan.control.value == control_state]
    (row,) = [row for row in classes(device) if row.get("field") == field]
    for name, old, new, both in _others(device, row, few=1):
        moved = _same_end(scan, list(zip(old, new, strict=True)))
        formulas = {"in range": scan.premise, "two members": both, "they do not do the same": z3.Not(moved)}
        yield control(f"planted: {name} and the last code too, {control_state}", formulas, LOGIC)


@theorem(clauses=["EKS-T1", "EKS-T2", "EKS-KS-8", "EKS-KS-9", "EKS-KS-6"], findings=[], slow=True)
def the_fplc_cannot_tell_the_words_of_one_class_apart() -> Queries:
    """In every control state and with all else equal, the F-PLC does the same for any two words in MW03, or
    in MW07, that are neither zero nor a code, and for any two to four outputs that are set.

    So one such word and one such pair of outputs in the models stand for all of them. The classes are read
    from interface.toml and the alphabet of the model; what a scan leaves behind depends on no word itself.
    """
    yield from _indistinguishable(FPLC)
    yield from _too_coarse(FPLC, "CheckSelection", "MW03")
    yield from _too_coarse(FPLC, "CheckAcknowledgment", "MW07")


@theorem(clauses=["EKS-T1", "EKS-T2", "EKS-KS-8", "EKS-KS-9"], findings=[], slow=True)
def the_panel_cannot_tell_the_words_of_one_class_apart() -> Queries:
    """In every control state and with all else equal, the panel does the same for any two words in
    ReadAuthorization, or in CheckMSO, that are neither zero nor a code.

    The classes are read from interface.toml and from the alphabet of the model.
    """
    yield from _indistinguishable(HMI)
    yield from _too_coarse(HMI, "Inhibited", "ReadAuthorization")
    yield from _too_coarse(HMI, "AwaitEcho", "CheckMSO")


@theorem(
    clauses=["EKS-GP-2", "EKS-2-13", "EKS-2-16", "EKS-2-21", "EKS-2-26", "EKS-3-1-PLC", "EKS-9-1-PLC"],
    findings=["E-08"],
)
def the_plc_passes_words_on_and_decides_only_by_its_comparison() -> Queries:
    """In every control state the PLC asks at most whether ReadAuthorization is MW01, and each word that it
    keeps or writes is one that it read in this scan or kept.

    So its words need no classes: any one-to-one renaming of words before a scan is the same one after it.
    """
    for scan in scans(PLC):
        compared = {scan.state.ReadAuthorization.term.get_id(), scan.inputs.MW01.term.get_id()}
        known = [symbol.term for symbol in symbols((scan.state, scan.inputs)) if isinstance(symbol, Word)]
        for path in scan.paths:
            questions = [_without_not(decision.question) for decision in path.decisions]
            if any({part.get_id() for part in asked.children()} != compared for asked in questions):
                raise TheoremError(f"from {scan.control.value} the PLC decides by more than its comparison")
            answers = "".join(", same" if decision.answer else ", other" for decision in path.decisions)
            given = {"all in their ranges": scan.premise, "this path": path.condition}
            written = [leaf for _, leaf in terms(path.result) if isinstance(leaf, z3.ExprRef)]
            then = z3.And(*[z3.Or(*[leaf == value for value in known]) for leaf in written])
            yield from claim(f"{scan.control.value}{answers}: {len(written)} words", given, then, LOGIC)


def _without_not(asked: z3.ExprRef) -> z3.ExprRef:
    return _without_not(asked.arg(0)) if z3.is_not(asked) else asked


@theorem(clauses=["EKS-KS-1", "EKS-KS-5", "EKS-KS-8", "EKS-T1"], findings=["E-41"], slow=True)
def the_eks_cannot_tell_apart_levels_that_are_no_code_nor_keys_by_their_numbers() -> Queries:
    """In every control state and with all else equal, the EKS does the same for any two level words that are
    neither zero nor a code, in the key and in the reader, and for any two key numbers, as long as the same
    ones are equal.

    Of level words and numbers it only asks whether key and reader agree, and which code a level is; so two
    numbers and one word that is no code are enough for the model. The access code is not covered: it is
    compared bit by bit (EKS-KS-4).
    """
    listed = accepted("RE")
    for scan in scans(EKS):
        kept, read = scan.state.key, scan.inputs
        level, level_read = kept.authorization_level.term, read.authorization_level.term
        other, other_read = word("other.authorization_level").term, word("other.read_level").term
        given = {
            "all in their ranges": scan.premise,
            "the level in memory stays or is no code before and after": _stays_or_is_no_code(
                level, other, listed
            ),
            "the level in the reader likewise": _stays_or_is_no_code(level_read, other_read, listed),
            "the same ones are equal": (level == level_read) == (other == other_read),
        }
        then = _same_end(scan, [(level, other), (level_read, other_read)])
        if not z3.is_true(then):
            yield from claim(f"{scan.control.value}: levels", given, then, LOGIC)
        number, number_read = kept.KeyID.term, read.KeyID.term
        second, second_read = z3.Int("other.KeyID"), z3.Int("other.read_KeyID")
        given = {
            "all in their ranges": scan.premise,
            "the same ones are equal": (number == number_read) == (second == second_read),
        }
        then = _same_end(scan, [(number, second), (number_read, second_read)])
        if not z3.is_true(then):
            yield from claim(f"{scan.control.value}: key numbers", given, then, LOGIC)


def _stays_or_is_no_code(old: z3.BitVecRef, new: z3.BitVecRef, listed: Sequence[int]) -> z3.BoolRef:
    return z3.Or(old == new, z3.And(z3.Not(one_of(old, listed)), z3.Not(one_of(new, listed))))
