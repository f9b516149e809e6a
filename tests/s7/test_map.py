"""The address map of a PLC: what fits is read, what does not is named with line and symbol."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from modeproof.cli import main
from modeproof.ground.places import documents, root
from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal
from modeproof.registers.load import load_interface
from modeproof.s7.map import Place, decode, encode, parse_address, proposed_map, read_map
from modeproof.s7.program import blocks_of, number_at, split_address
from tests.any_machine import SHARED_FIXTURE
from tests.s7.server import FREE, STEPPED

INPUTS = {"GO": Signal("GO", "bool"), "CODE": Signal("CODE", "word")}
OUTPUTS = {
    "LAMP": Signal("LAMP", "bool"),
    "SHOWN": Signal("SHOWN", "mode", modes=(0, 1, 2)),
    "OPEN": Signal("OPEN", "modes", modes=(0, 1, 2)),
    "TEXT": Signal("TEXT", "text", values=("", "on", "off")),
}
PARAMETERS = {
    "T_ms": Signal("T_ms", "ms", minimum=0, maximum=3_600_000),
    "HOW": Signal("HOW", "text", values=("a", "b")),
}
GOOD = """symbol,address,type
GO,DB3.DBX0.0,BOOL
CODE,MW1,WORD
LAMP,Q0.0,BOOL
SHOWN,DB5.DBW0,INT
OPEN,DB5.DBB2,BYTE
TEXT,-,BYTE
T_ms,DB1.DBD0,TIME
HOW,DB1.DBX4.0,BOOL
@reset,DB2.DBX0.0,BOOL
@cycle,DB2.DBW2,WORD
"""


def written(folder: Path, *changes: tuple[str, str]) -> Path:
    text = GOOD
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = folder / "plc.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_map_that_fits_is_read(tmp_path: Path) -> None:
    found = read_map(written(tmp_path), INPUTS, OUTPUTS, PARAMETERS)
    assert found.inputs == {"GO": Place("DB", 3, 0, 0, "BOOL"), "CODE": Place("M", 0, 1, -1, "WORD")}
    assert found.outputs["SHOWN"] == Place("DB", 5, 0, -1, "INT")
    assert (found.unobserved, set(found.controls)) == (("TEXT",), {"@reset", "@cycle"})
    more = written(tmp_path, ("@reset", "@non_retentive,DB2,\n@non_retentive,MB1-MB2,\n@reset"))
    assert read_map(more, INPUTS, OUTPUTS, PARAMETERS) == found  # those lines are for `prove-program`
    german = written(tmp_path, ("Q0.0", "A0.0"))
    assert read_map(german, INPUTS, OUTPUTS, PARAMETERS) == found


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("CODE,MW1,WORD", "CODE,MW1,WORD\nMORE,MW9,WORD", "line 4: MORE: unknown symbol"),
        ("CODE,MW1,WORD\n", "", "missing: CODE"),
        ("CODE,MW1,WORD", "CODE,MW1,WORD\nCODE,MW9,WORD", "line 4: CODE: is there twice"),
        ("CODE,MW1,WORD", "CODE,MW1,INT", "type INT; a word needs WORD"),
        ("CODE,MW1,WORD", "CODE,MB1,WORD", "MB1 is no address of a WORD"),
        ("CODE,MW1,WORD", "CODE,M1.0,WORD", "M1.0 is no address of a WORD"),
        ("CODE,MW1,WORD", "CODE,X1,WORD", "such as I0.0"),
        ("CODE,MW1,WORD", "CODE,MW1", "three cells"),
        ("CODE,MW1,WORD", "CODE,-,WORD", "CODE"),
        ("LAMP,Q0.0,BOOL", "LAMP,Q0.8,BOOL", "such as I0.0"),
        ("LAMP,Q0.0,BOOL", "LAMP,M2.7,BOOL", "overlap: CODE MW1 and LAMP M2.7"),
        ("SHOWN,DB5.DBW0", "SHOWN,DB5.DBW1", "overlap: SHOWN DB5.DBW1 and OPEN DB5.DBB2"),
        ("LAMP,Q0.0,BOOL", "LAMP,DB3.DBX0.1,BOOL", "GO and LAMP share a byte"),
        ("GO,DB3.DBX0.0,BOOL", "GO,I0.0,BOOL", "GO: I0.0 would be written; use M or a data block"),
        ("GO,DB3.DBX0.0,BOOL", "GO,Q4.0,BOOL", "GO: Q4.0 would be written"),
        ("CODE,MW1,WORD", "CODE,EW4,WORD", "CODE: IW4 would be written"),
        ("T_ms,DB1.DBD0,TIME", "T_ms,QD8,TIME", "T_ms: QD8 would be written"),
        ("@reset,DB2.DBX0.0", "@reset,A1.0", "@reset: Q1.0 would be written"),
        ("@cycle,DB2.DBW2,WORD", "@cycle,DB2.DBW2,WORD\n@magic,MD20,DINT", "@magic must lie in a data block"),
        ("@cycle,DB2.DBW2,WORD", "@cycle,DB2.DBW2,INT", "it needs WORD"),
        ("symbol,address,type", "name,address,type", "first line"),
        ("symbol,address,type", 'symbol,"address,type', "plc.csv"),
    ],
)
def test_an_unfit_map_is_refused_with_line_and_symbol(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(Unjudged, match=r"^plc\.csv: ") as caught:
        read_map(written(tmp_path, (old, new)), INPUTS, OUTPUTS, PARAMETERS)
    assert said in str(caught.value) and "\n" not in str(caught.value)


def test_a_symbol_cannot_write_to_the_terminal(tmp_path: Path) -> None:
    path = written(tmp_path, ("CODE,MW1,WORD", "\x1b]0;x\x07\u202eCODE,MW1,WORD"))
    with pytest.raises(Unjudged, match="unknown symbol") as caught:
        read_map(path, INPUTS, OUTPUTS, PARAMETERS)
    assert str(caught.value).isprintable()


pieces = st.sampled_from(
    [*GOOD.replace("\n", ",").split(","), ",", "\n", '"', "\0", "", "-", "DB70000.DBW0", "MW99999", "é"]
)


@settings(max_examples=200, deadline=None, suppress_health_check=SHARED_FIXTURE)
@given(st.lists(pieces, max_size=40).map("".join))
def test_any_text_fits_or_is_refused_in_one_line(tmp_path: Path, text: str) -> None:
    path = tmp_path / "plc.csv"
    for whole in (text, GOOD + text):
        path.write_text(whole, encoding="utf-8", newline="")
        try:
            found = read_map(path, INPUTS, OUTPUTS, PARAMETERS)
        except Unjudged as error:
            assert str(error).startswith("plc.csv: ") and "\n" not in str(error)
        else:
            assert set(found.inputs) == set(INPUTS)


def test_a_map_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Unjudged, match="No such file"):
        read_map(tmp_path / "none.csv", INPUTS, OUTPUTS, PARAMETERS)


def test_the_proposed_map_fits_and_keeps_the_tags() -> None:
    tags = {"CODE": "MW7", "GO": "FI1", "SHOWN": "MW8"}  # MW8 overlaps MW7
    text = proposed_map(INPUTS, OUTPUTS, PARAMETERS, tags)
    assert "CODE,MW7,WORD\n" in text and "SHOWN,QW2,INT\n" in text
    assert "GO,DB3.DBX0.0,BOOL\n" in text and "@magic,DB2.DBD10,DINT\n" in text


@pytest.mark.parametrize("target", ["fplc", "plc", "hmi"])
def test_the_command_writes_a_map_it_accepts_for_each_target(
    target: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "map.csv"
    assert main(["map", target, "--out", str(path)]) == 0
    assert main(["map", target, "--check", str(path)]) == 0
    assert "parameters without address: none" in capsys.readouterr().out
    path.write_text(path.read_text().replace("WORD", "DINT"), encoding="utf-8")
    assert main(["map", target, "--check", str(path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_maps_of_the_examples_and_tests_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = Path(__file__).resolve().parents[2]
    for target in ("fplc", "plc"):
        assert main(["map", target, "--check", str(root / f"examples/awl/{target}.map.csv")]) == 0
    for name, text in (("stepped", STEPPED), ("free", FREE)):
        path = tmp_path / f"{name}.csv"
        path.write_text(text, encoding="utf-8")
        assert main(["map", "fplc", "--check", str(path)]) == 0
    capsys.readouterr()


KINDS = [
    (Signal("x", "bool"), "BOOL", st.booleans()),
    (Signal("x", "word"), "WORD", st.integers(0, 0xFFFF).map(lambda word: f"{word:04X}")),
    (Signal("x", "mode", modes=(0, 1, 2)), "INT", st.sampled_from([None, 0, 1, 2])),
    (Signal("x", "modes", modes=(0, 1, 2)), "BYTE", st.sets(st.integers(0, 2)).map(sorted)),
    (Signal("x", "text", values=("", "on", "off")), "BYTE", st.sampled_from([None, "on", "off"])),
    (Signal("x", "ms", minimum=0, maximum=3_600_000), "DINT", st.integers(0, 3_600_000)),
]


@given(st.sampled_from(KINDS).flatmap(lambda kind: st.tuples(st.just(kind[:2]), kind[2])), st.integers(0, 9))
def test_every_value_comes_back_from_memory_as_it_went_in(
    chosen: tuple[tuple[Signal, str], object], at: int
) -> None:
    (signal, kind), value = chosen
    size = {"BOOL": 1, "BYTE": 1, "WORD": 2, "INT": 2, "DINT": 4}[kind]
    place = Place("M", 0, at, 3 if kind == "BOOL" else -1, kind)
    number = encode(signal, place, value)
    shift = place.bit if place.bit >= 0 else 0
    memory = bytes(at) + ((number << shift) % (1 << 8 * size)).to_bytes(size, "big") + bytes(2)
    assert decode(signal, number_at(place, memory, 0)) == value


@given(st.sets(st.integers(0, 60)), st.integers(0, 5))
def test_blocks_hold_all_places_and_nothing_far_from_them(bytes_there: set[int], gap: int) -> None:
    places = [Place("M", 0, byte, -1, "BYTE") for byte in bytes_there]
    blocks = blocks_of(places, gap)
    assert all(sum(block.holds(place) for block in blocks) == 1 for place in places)
    held = {byte for block in blocks for byte in range(block.first, block.last + 1)}
    assert bytes_there <= held and (gap or held == bytes_there)


def test_addresses_are_read_as_step_7_writes_them() -> None:
    for address, kind in (("I0.7", "BOOL"), ("MB3", "BYTE"), ("QW8", "WORD"), ("DB12.DBD4", "DINT")):
        assert parse_address(address, kind, "here").address == address
    assert split_address("plc.local") == ("plc.local", 102) and split_address("10.0.0.1:1102") == (
        "10.0.0.1",
        1102,
    )
    for wrong in ("", ":102", "plc:", "plc:x", "plc:0", "plc:70000"):
        with pytest.raises(Unjudged, match="HOST"):
            split_address(wrong)


PUBLISHED = [
    (document, name)
    for document in documents(root())
    for name, device in load_interface(root(), document).devices.items()
    if device.published
]


@pytest.mark.parametrize(("document", "target"), PUBLISHED, ids=[target for _, target in PUBLISHED])
def test_the_starting_map_can_be_used_for_every_published_target(
    document: str, target: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(tmp_path / "map.csv")
    assert main(["map", target, "--document", document, "--out", path]) == 0
    assert main(["map", target, "--document", document, "--check", path]) == 0
    device = load_interface(root(), document).devices[target]
    chosen = [one for one in device.parameters.values() if one.type != "function"]
    symbols = len(device.inputs) + len(device.outputs) + len(chosen)
    symbols += len(("@dt_ms", "@scan", "@done", "@reset", "@magic"))
    assert f"{symbols} symbols of {target}; unobserved: none" in capsys.readouterr().out
