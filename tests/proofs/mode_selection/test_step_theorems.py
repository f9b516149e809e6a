"""The theorems on the paths of each `step`, and the faults that they must see."""

from pathlib import Path

import pytest

from proofs.explorer import device as device_module
from proofs.explorer.errors import LintError
from proofs.mode_selection import step_paths, word_classes
from proofs.mode_selection.devices import HMI, PLC
from proofs.runner import TheoremResult, prove_all
from proofs.solvers import ask_z3
from proofs.theorem import Theorem, TheoremError
from refimpl.mode_selection import hmi, plc
from tests.any_machine import LONG_MS

PLC_PATHS = step_paths.every_scan_of_the_plc_takes_exactly_one_path
PLC_WORDS = word_classes.the_plc_passes_words_on_and_decides_only_by_its_comparison
PANEL_WORDS = word_classes.the_panel_cannot_tell_the_words_of_one_class_apart


def _result(item: Theorem, out: Path) -> TheoremResult:
    return prove_all([item], out, lambda line: None, LONG_MS)[0]


def _fallen(item: Theorem) -> set[str]:
    """The claims that z3 refutes."""
    return {
        query.name
        for query in item.build()
        if query.expected == "unsat" and ask_z3(query, "", LONG_MS).answer == "sat"
    }


@pytest.mark.parametrize("item", [PLC_PATHS, PLC_WORDS], ids=lambda item: item.name)
def test_the_theorems_of_the_plc_are_proved_by_both_solvers(item: Theorem, tmp_path: Path) -> None:
    result = _result(item, tmp_path)
    assert (result.verdict, result.reason) == ("PROVED", "")
    assert len(list(tmp_path.rglob("*.smt2"))) == len(result.queries) >= 8


def _swallows_ones(s: plc.State, i: plc.Inputs) -> plc.State:
    if i.SelectMSO == 0xFFFF:
        return plc.State(s.params, plc.Step.COPY_CHECK_MSO, s.ReadAuthorization, 0, s.CheckMSO, s.MW07)
    return plc.State(s.params, plc.Step.COPY_CHECK_MSO, s.ReadAuthorization, i.SelectMSO, s.CheckMSO, s.MW07)


def _clears_a_bit(s: plc.State, i: plc.Inputs) -> plc.State:
    word = i.SelectMSO & 0xFFFE
    return plc.State(s.params, plc.Step.COPY_CHECK_MSO, s.ReadAuthorization, word, s.CheckMSO, s.MW07)


def _looks_at_the_type(s: plc.State, i: plc.Inputs) -> plc.State:
    if isinstance(i.SelectMSO, int):
        return s
    return s


def _raises(s: plc.State, i: plc.Inputs) -> plc.State:
    if i.SelectMSO == 1:
        raise ValueError("planted")
    return s


def _plant(patch: pytest.MonkeyPatch, module: object, name: str, function: object) -> None:
    patch.setattr(function, "__module__", "refimpl.mode_selection.plc")
    patch.setattr(module, name, function)


def test_a_plc_that_decides_by_a_word_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    _plant(monkeypatch, plc, "_copy_mw03", _swallows_ones)
    with pytest.raises(TheoremError, match="decides by more than its comparison"):
        PLC_WORDS.queries()


def test_a_plc_that_changes_a_word_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    _plant(monkeypatch, plc, "_copy_mw03", _clears_a_bit)
    assert [name.split(":")[0] for name in _fallen(PLC_WORDS)] == ["CopyMW03, same"]


def test_code_that_the_lint_refuses_leaves_the_theorem_unjudged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _plant(monkeypatch, plc, "_copy_mw03", _looks_at_the_type)
    with pytest.raises(LintError, match="isinstance"):
        device_module.scans(PLC)
    result = _result(PLC_PATHS, tmp_path)
    assert result.verdict == "UNJUDGED"
    assert "isinstance" in result.reason


def test_a_path_that_raises_leaves_the_theorem_unjudged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _plant(monkeypatch, plc, "_copy_mw03", _raises)
    result = _result(PLC_PATHS, tmp_path)
    assert result.verdict == "UNJUDGED"
    assert "CopyMW03 step raises: planted" in result.reason


def _knows_a_sixth_word(codes: tuple[int, ...], word: int) -> int:
    if word == codes[0] or word == 0x5555:
        return 0
    if word == codes[1]:
        return 1
    if word == codes[2]:
        return 2
    if word == codes[3]:
        return 3
    if word == codes[4]:
        return 4
    return -1


def test_a_panel_with_a_sixth_word_fails_on_its_classes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_knows_a_sixth_word, "__module__", "refimpl.mode_selection.hmi")
    monkeypatch.setattr(hmi, "decode", _knows_a_sixth_word)
    fallen = _fallen(PANEL_WORDS)
    assert fallen
    assert all("ReadAuthorization" in name for name in fallen)


class _Alphabet:
    """A root whose specification tries one code less."""

    def __init__(self, original: Path) -> None:
        self.original = original

    def __truediv__(self, name: str) -> object:
        if not name.endswith(".tla"):
            return self.original / name
        text = (self.original / name).read_text(encoding="utf-8")
        assert "RE[3], RE[4], OtherWord" in text

        class _File:
            def read_text(self, encoding: str) -> str:
                return text.replace("RE[3], RE[4], OtherWord", "RE[3], OtherWord")

        return _File()


def test_an_alphabet_without_one_of_the_codes_is_too_coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not _fallen(PANEL_WORDS)
    monkeypatch.setattr(word_classes, "ROOT", _Alphabet(word_classes.ROOT))
    assert word_classes.alphabet(HMI) != ()
    assert _fallen(PANEL_WORDS)
