"""Table 2 was written down in TLA+ and in Python: all readers agree, and a wrong digit is seen."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from modeproof.tlc.toolchain import find_toolchain
from proofs.mode_selection.transcriptions import SPECIFICATION, TranscriptionError, tables_in
from refimpl.mode_selection.code_tables import RANGES, SET_OF_VALUES

TEXT = SPECIFICATION.read_text(encoding="utf-8")


def _tables_by_tlc(text: str, folder: Path) -> dict[str, tuple[int, ...]]:
    """The ranges as TLC itself evaluates them in the module with this text."""
    (folder / "CodeTables.tla").write_text(text, encoding="utf-8")
    prints = "\n".join(f'ASSUME PrintT(<<"{name}", {m}, {name}[{m}]>>)' for name in RANGES for m in range(5))
    probe = f"---- MODULE Probe ----\nEXTENDS CodeTables, TLC\n{prints}\n====\n"
    (folder / "Probe.tla").write_text(probe, encoding="utf-8")
    (folder / "Probe.cfg").write_text("CONSTANT PERMITS <- TotalOrder", encoding="utf-8")
    tools = find_toolchain()
    own = f"-Djava.io.tmpdir={folder}"  # TLC unpacks its modules there, and removes them
    command = [str(tools.java), "-XX:+UseSerialGC", "-Xmx256m", own, "-cp", str(tools.jar), "tlc2.TLC"]
    done = subprocess.run(
        [*command, "-workers", "1", "-metadir", str(folder / "states"), "Probe.tla"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    found = re.findall(r'^<<"(\w+)", (\d), (\d+)>>$', done.stdout, flags=re.M)
    assert len(found) == 20, done.stdout + done.stderr
    rows: dict[str, list[int]] = {}
    for name, mode, value in found:
        row = rows.setdefault(name, [])
        assert len(row) == int(mode)
        row.append(int(value))
    return {name: tuple(row) for name, row in rows.items()}


def test_the_specification_has_the_tables_of_the_implementation() -> None:
    assert tables_in(TEXT) == RANGES


def test_tlc_evaluates_the_tables_to_those_of_the_implementation(tmp_path: Path) -> None:
    assert _tables_by_tlc(TEXT, tmp_path) == RANGES


def test_tlc_and_the_reader_see_a_wrong_specified_digit(tmp_path: Path) -> None:
    wrong = TEXT.replace(r"m = 2 -> \h0F0F", r"m = 2 -> \h0FF0")
    assert wrong != TEXT
    without_checks = re.sub(r"^ASSUME .*$", "", wrong, flags=re.M)
    assert _tables_by_tlc(without_checks, tmp_path)["SW"] == (0x33CC, 0x3C3C, 0x0FF0, 0x0FF0, 0x3333)
    assert tables_in(wrong) != RANGES


@pytest.mark.parametrize("name", RANGES)
@pytest.mark.parametrize("mode", range(5))
def test_every_single_wrong_digit_in_the_text_is_seen(name: str, mode: int) -> None:
    pattern = re.compile(rf"(^{name} == .*?m = {mode} -> \\h.)(.)", re.M | re.S)
    wrong = pattern.sub(lambda m: m[1] + format(int(m[2], 16) ^ 1, "X"), TEXT, count=1)
    assert wrong != TEXT
    assert tables_in(wrong) != RANGES


def test_an_older_table_in_a_comment_is_not_read() -> None:
    comment = r"\* RE == [m \in MSO |-> CASE m = 0 -> \h1111 [] m = 1 -> \h1111]"
    block = f"(* {comment[3:]}\n *)"
    assert tables_in(f"{comment}\n{block}\n{TEXT}") == RANGES


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("SW ==", "SV ==", "expected .'CH', 'RE', 'SE', 'SW'."),
        ("SW ==", "SE ==", "SE is defined twice"),
        (r" [] m = 4 -> \h3C3C", "", r"modes \[0, 1, 2, 3\]"),
        ("m = 4 ->", "m = 3 ->", "mode 3 has two words"),
        ("m = 4 ->", "m = 5 ->", "not 0 to 4"),
        (r"\h3C3C", r"\h3C3", "cannot read"),
        (r"\h3C3C", "15420", "cannot read"),
        ("m = 4 ->", "OTHER ->", "cannot read"),
    ],
)
def test_a_table_in_another_form_is_refused_and_never_guessed(old: str, new: str, message: str) -> None:
    assert old in TEXT
    with pytest.raises(TranscriptionError, match=message):
        tables_in(TEXT.replace(old, new))


PHRASES = {
    "RE": r"level (\d) \(([0-9A-F]{4}) in MW01\)",
    "SE": r"mode (\d) \(([0-9A-F]{4}) in MW03\)|selection word of mode (\d) \(([0-9A-F]{4})\)",
    "CH": r"check word of mode (\d) \(([0-9A-F]{4})\)",
    "SW": r"switchover word of mode (\d) \(([0-9A-F]{4})\)",
}


def _words_in_clauses(texts: list[str]) -> dict[str, dict[int, set[int]]]:
    """Per range and mode, the words that the paraphrases of Figures 5 to 7 give in passing."""
    found: dict[str, dict[int, set[int]]] = {name: {} for name in PHRASES}
    for name, phrase in PHRASES.items():
        for groups in re.findall(phrase, " ".join(texts)):
            mode, value = [group for group in groups if group]
            found[name].setdefault(int(mode), set()).add(int(value, 16))
    return found


def _clause_texts() -> list[str]:
    with (SPECIFICATION.parent / "clauses.toml").open("rb") as file:
        return [clause["text"] for clause in tomllib.load(file)["clause"].values()]


def test_steps_of_figures_5_to_7_have_the_table_words() -> None:
    found = _words_in_clauses(_clause_texts())
    assert {name: len(modes) for name, modes in found.items()} == {"RE": 4, "SE": 5, "CH": 5, "SW": 4}
    for name, modes in found.items():
        assert modes == {mode: {RANGES[name][mode]} for mode in modes}


def test_a_wrong_word_in_a_paraphrased_step_is_seen() -> None:
    wrong = [text.replace("(3C3C in MW01)", "(3C3D in MW01)") for text in _clause_texts()]
    assert wrong != _clause_texts()
    assert _words_in_clauses(wrong)["RE"][4] != {RANGES["RE"][4]}


def test_the_paraphrase_of_table_1_lists_the_set_of_values() -> None:
    texts = [text for text in _clause_texts() if text.startswith("The level on a key is one of")]
    assert [sorted(int(w, 16) for w in re.findall(r"\b[0-9A-F]{4}\b", text)) for text in texts] == [
        sorted(SET_OF_VALUES)
    ]
