"""Statement list: equal to awlsim scan by scan, proved or refuted, and refused where it is not understood."""

from __future__ import annotations

import importlib.util
import shutil
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import z3

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.commands.prove_program import limits, text_of
from programs.equality.comparison import make
from programs.equality.verdict import Verdict, judge
from programs.language.tool_differences import assumed
from programs.language.tree import Place
from programs.readers.sources import read_sources
from programs.readers.statement_list import program as awl
from programs.readers.statement_list import translation as stl
from programs.readers.statement_list.instructions import Step
from programs.semantics.terms import slots
from tests.programs.beside_awlsim import MAP, difference, random_difference, random_program

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "examples" / "awl"
CODES = [0, 0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C]
LIKELY = {"MW03": CODES, "MW07": CODES, "DT_MS": [0, 10, 50, 400, 900]}
GROUPS = range(0, 40, 10)


@cache
def reader() -> Any:
    """examples/awl/tree.py, in this process so that awlsim is imported once."""
    spec = importlib.util.spec_from_file_location("awl_tree", EXAMPLES / "tree.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(autouse=True)
def in_this_process(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Read sources here, but for the tests of the command."""
    if "capsys" in request.fixturenames:
        return

    def parsed(path: Path) -> Any:
        from awlsim.common.exceptions import AwlSimError

        try:
            return reader().program(path)
        except AwlSimError as error:
            raise Place(str(path), error.getLineNr() or 0).refuse(str(error.message)) from None

    monkeypatch.setattr(awl, "_parsed", parsed)


def judged(path: Path, target: str) -> Verdict:
    """The verdict on a program."""
    return judge(make([path], target), ROOT / "vectors" / target, 120, lambda text: None)


def code(text: str) -> str:
    """Instructions that are separated by semicolons, each in a line of its own."""
    return text.replace("; ", "\n")


def written(folder: Path, body: str, more: str = "", signals: str = "") -> Path:
    """A program whose OB1 has this body, which begins in the third line."""
    path = folder / "p.awl"
    path.write_text(
        f"ORGANIZATION_BLOCK OB 1\nBEGIN\n{code(body)}\nEND_ORGANIZATION_BLOCK\n{code(more)}\n", "utf-8"
    )
    given = "symbol,address,type\nx,I0.0,BOOL\nw,IW2,WORD\nq,Q0.0,BOOL\nv,QW2,WORD\n"
    path.with_suffix(".map.csv").write_text(signals or given, "utf-8")
    (folder / "symbols.csv").write_text("", "utf-8")
    return path


def changed(folder: Path, old: str, new: str) -> Path:
    """The shipped PLC with one edit."""
    for name in ("plc.map.csv", "symbols.csv"):
        shutil.copy(EXAMPLES / name, folder / name)
    text = (EXAMPLES / "plc.awl").read_text("utf-8")
    assert old in text
    (folder / "plc.awl").write_text(text.replace(old, new, 1), "utf-8")
    return folder / "plc.awl"


# ---------------------------------------------------------------- verdicts


def test_the_shipped_plc_is_proved() -> None:
    found = judged(EXAMPLES / "plc.awl", "plc")
    assert found.word == "PROVED" and found.replayed is not None and found.replayed.cases > 50
    assert len(found.product.nodes) == 4


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('L     "SelectMSO"', 'L     "SwitchMSO"'),
        ('T     "CheckMSO"\n      L     3', 'T     "CheckMSO"\n      L     0'),
        ("JU    SELE", "JU    CHEC"),
        ('      T     "MW07"\nEND_ORG', '      L     1\n      T     "MW07"\nEND_ORG'),
    ],
)
@pytest.mark.sampled
def test_another_plc_is_refuted(old: str, new: str, tmp_path: Path) -> None:
    if "END_ORG" in old:
        old, new = 'T     "MW07"\n      T     "Read', 'L     1\n      T     "MW07"\n      T     "Read'
    found = judged(changed(tmp_path, old, new), "plc")
    assert found.word == "REFUTED" and found.difference is not None and found.difference.differing


def test_the_command_reads_with_awlsim_apart(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    import sys

    loaded = {name for name in sys.modules if name.startswith("awlsim")}
    path = changed(tmp_path, "JL    LOST", "JLX   LOST")
    assert main(["prove-program", str(path), "--target", "plc"]) == 2
    said = capsys.readouterr().err
    assert "plc.awl:40: Cannot translate instruction: 'JLX'" in said and said.count("\n") == 1
    assert {name for name in sys.modules if name.startswith("awlsim")} == loaded


# ---------------------------------------------------------------- beside awlsim


@pytest.mark.deep
@pytest.mark.parametrize("name", ["plc", "fplc"])
def test_the_shipped_programs_run_as_in_awlsim(name: str) -> None:
    assert difference(EXAMPLES / f"{name}.awl", 1, 400, LIKELY if name == "fplc" else None) == ""


@pytest.mark.deep
def test_sets_of_modes_are_words_and_two_texts_a_bit() -> None:
    binding = make([EXAMPLES / "fplc.awl"], "fplc").binding
    reference = binding.reference
    parameters = reference.with_defaults(
        {"T_SEQ_FROM": "ones", "PERMITS_2": (True, False, True, False, False)}
    )
    inputs = dict.fromkeys(reference.signals("inputs"), 0)
    given = binding.plain_inputs(inputs, parameters, 5)
    assert given["PERMITS_2"] == 0b101 and given["T_SEQ_FROM"] is True and given["DT_MS"] == 5
    terms = reference.parameter_terms
    where = [(terms[f"PERMITS_2[{mode}]"], z3.BoolVal(mode in (0, 2))) for mode in range(5)]
    assert z3.simplify(z3.substitute(binding.term("PERMITS_2"), *where)).as_long() == 0b101
    ones = z3.substitute(binding.term("T_SEQ_FROM"), (terms["T_SEQ_FROM"], z3.IntVal(1)))
    assert z3.is_true(z3.simplify(ones))


def group(folder: Path, first: int, size: int = 10) -> tuple[int, list[str]]:
    """Ten random programs: how many were accepted, and the differences."""
    said = [random_difference(folder, seed, 20) for seed in range(first, first + size)]
    refused = [text for text in said if text.startswith("refused")]
    return len(said) - len(refused), [text for text in said if text and text not in refused]


@pytest.mark.sampled
@pytest.mark.parametrize("first", GROUPS)
def test_random_programs_run_as_in_awlsim(first: int, tmp_path: Path) -> None:
    accepted, differences = group(tmp_path, first)
    assert accepted >= 2 and differences == []


@pytest.mark.parametrize("fault", ["sides of a comparison", "an edge", "a lost O"])
def test_a_wrong_translation_is_noticed(fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if fault == "sides of a comparison":
        monkeypatch.setitem(stl.COMPARE, "<", ">")
        body = "L IW 2; L 5; <I; = Q 0.0; L 0; T QW 2"
    elif fault == "an edge":
        right = stl.Instructions.edge
        monkeypatch.setattr(
            stl.Instructions,
            "edge",
            lambda self, operand, rising, place: right(self, operand, not rising, place),
        )
        body = "A I 0.0; FP M 1.0; = Q 0.0; L 0; T QW 2"
    else:
        right_step = stl.Instructions.step

        def without(self: Any, step: Step) -> None:
            if step.op != "O" or step.operands:
                right_step(self, step)

        monkeypatch.setattr(stl.Instructions, "step", without)
        body = "A I 0.0; O; AN I 0.0; = Q 0.0; L 0; T QW 2"
    assert "awlsim has" in difference(written(tmp_path, body), 1, 20)


def test_a_random_program_uses_every_kind_of_instruction() -> None:
    text = "".join(random_program(seed) for seed in range(40))
    for word in (" FP ", " JCN ", "BEC", "CALL FC 1", " SRD ", " XN ", "O(", " TAK", ">=D", " ITD", " T QD"):
        assert word in text, word
    assert MAP.count("\n") == 9


# ---------------------------------------------------------------- power-up

START = "ORGANIZATION_BLOCK OB 100\nBEGIN\n{}\nEND_ORGANIZATION_BLOCK\n"
COPY = "A I 0.0; = Q 0.0; L MW 10; T QW 2\n"


def test_power_up_is_what_the_start_block_leaves(tmp_path: Path) -> None:
    path = written(tmp_path, COPY, START.format("L W#16#1234; T MW 10"))
    unit = read_sources([path]).main()
    assert unit.variables["M_W10"].initial == 0x1234
    assert difference(path, 1, 5) == ""


def test_a_start_that_depends_on_inputs_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, COPY, START.format("L IW 2; T MW 10"))
    with pytest.raises(Unjudged, match="OB 100: what it leaves in M_W10 depends on an input or on what was"):
        read_sources([path])


def without_start(folder: Path) -> Path:
    """The shipped PLC without its OB100."""
    text = (EXAMPLES / "plc.awl").read_text("utf-8")
    start = text[text.index("ORGANIZATION_BLOCK OB 100") : text.index("ORGANIZATION_BLOCK OB 1\n")]
    return changed(folder, start, "")


def test_a_data_block_that_nothing_clears_begins_anywhere(tmp_path: Path) -> None:
    path = without_start(tmp_path)
    source = read_sources([path])
    kept = {slot.path for slot in slots(source, source.main()) if slot.initial is None}
    assert kept == {"DB20_W0", "MW03", "MW07"}  # flags too; outputs are cleared by the CPU
    found = judged(path, "plc")
    assert found.word == "REFUTED" and found.difference is not None and found.difference.run.retained


def test_what_is_not_retentive_stands_in_map_and_verdict(tmp_path: Path) -> None:
    path = without_start(tmp_path)
    with path.with_suffix(".map.csv").open("a", encoding="utf-8") as stream:
        stream.write("@non_retentive,DB20,\n@non_retentive,MB0-MB8,\n")
    found = judged(path, "plc")
    assert found.word == "PROVED"
    said = "\n".join(text_of(found, 1.0))
    assert "  assumed     DB20 is not retentive (" in said and "; MB0-MB8 is not retentive (" in said
    assert sum("DB20 is not retentive" in line for line in limits(found.product)) == 1


@pytest.mark.parametrize("address", ["DB", "MB9-MB8", "M0.0", "QB0-QB1", ""])
def test_an_area_that_cannot_be_cleared_is_refused(address: str, tmp_path: Path) -> None:
    path = written(tmp_path, COPY, signals=f"symbol,address,type\n@non_retentive,{address},\n")
    with pytest.raises(Unjudged, match=r"p.map.csv:2: @non_retentive, .*: DB10 or MB16-MB255 is needed"):
        read_sources([path])


def test_what_the_start_block_leaves_alone_begins_anywhere(tmp_path: Path) -> None:
    body = "L IW 2; T MW 10; T MW 12; T DB1.DBW 0; A I 0.0; = Q 0.0; L MW 10; T QW 2"
    path = written(tmp_path, body, DB1 + "; " + START.format("L MW 10; T MW 10; L 5; T MW 12"))
    variables = read_sources([path]).main().variables
    assert [variables[name].retained for name in ("M_W10", "M_W12", "DB1_W0", "V")] == [
        True,
        False,
        True,
        False,
    ]
    assert variables["M_W12"].initial == 5


def test_a_start_that_depends_on_what_was_kept_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, "L IW 2; T MW 12; " + COPY, START.format("L MW 12; T MW 10"))
    with pytest.raises(Unjudged, match="what it leaves in M_W10 depends on an input or on what was there"):
        read_sources([path])


@pytest.mark.parametrize(("address", "name"), [("M 50.0", "flag M_X50_0"), ("Q 9.0", "output Q_X9_0")])
def test_what_is_never_written_must_not_matter(address: str, name: str, tmp_path: Path) -> None:
    path = written(tmp_path, f"A {address}; = Q 0.0; L 0; T QW 2")
    with pytest.raises(Unjudged, match=f"reads {name}, which is no signal of the map, and never writes it"):
        read_sources([path])


def test_data_that_nothing_writes_is_said(tmp_path: Path) -> None:
    path = written(tmp_path, "L DB1.DBW 0; T QW 2; CLR; = Q 0.0", DB1)
    source = read_sources([path])
    said = list(assumed(source, source.main()))
    assert said == ["nothing writes DB1_W0, so what is loaded stays there"]
    source = read_sources([EXAMPLES / "plc.awl"])
    assert list(assumed(source, source.main())) == []


def test_pieces_of_memory_that_overlap_are_one(tmp_path: Path) -> None:
    body = "L IW 2; T MW 10; A M 11.0; = Q 0.0; L MB 10; T QW 2"
    path = written(tmp_path, body)
    assert "M_X10_7" in read_sources([path]).main().variables
    assert difference(path, 1, 20) == ""


def test_an_input_without_a_name_must_not_matter(tmp_path: Path) -> None:
    masked = "L IW 0; L W#16#100; AW; T QW 2; CLR; = Q 0.0"
    assert difference(written(tmp_path, masked), 1, 10) == ""
    path = written(tmp_path, masked.replace("100", "300"))
    with pytest.raises(Unjudged, match="the program reads input I_X0_1, which is no signal of the map"):
        read_sources([path])


# ---------------------------------------------------------------- what is refused

DB1 = "DATA_BLOCK DB 1; STRUCT; a : WORD;; END_STRUCT;; BEGIN; END_DATA_BLOCK"
FC1 = (
    "FUNCTION FC 1 : VOID; VAR_INPUT; a : WORD;; END_VAR; VAR_OUTPUT; b : WORD;; END_VAR; "
    "VAR_TEMP; t : WORD;; END_VAR; BEGIN; {}; END_FUNCTION"
)
REFUSED = {
    "an unknown instruction": ("FOO", "", "p.awl:3: Cannot translate instruction: 'FOO'"),
    "a missing label": ("JU AAA", "", "p.awl:3:"),
    "a jump back": (
        "AAA: SET; = Q 0.0; JU AAA",
        "",
        "p.awl:5: JU: a jump back is not supported",
    ),
    "a loop": ("L 3; AAA: T MB 5; LOOP AAA", "", "p.awl:5: LOOP: a jump back"),
    "a timer": ("A T 1; = Q 0.0", "", "p.awl:3: operand T 1 is not supported"),
    "a counter": ("A I 0.0; CU C 1", "", "p.awl:4: operand"),
    "a real number": ("L 1.0; T MD 4", "", "p.awl:3: operand"),
    "an address register": ("LAR1 P#1.0", "", "p.awl:3: operand"),
    "a memory address in an address": ("L MW [MD 4]", "", "p.awl:3: operand"),
    "an open data block": (
        "OPN DB 1; L DBW 0; T QW 2",
        DB1,
        "p.awl:3: operand DB 1 is not supported",
    ),
    "status bits": ("A OV; = Q 0.0", "", "p.awl:3: operand"),
    "a jump on status bits": (
        "L IW 2; + 1; JZ AAA; AAA: NOP 0",
        "",
        "p.awl:5: instruction JZ is not supported",
    ),
    "a system function": ("CALL SFC 46", "", "p.awl:3: CALL SFC 46: no such block is in the source"),
    "a call without parameters": ("UC FC 1", FC1.format("NOP 0"), "p.awl:3: operand"),
    "recursion": (
        "CALL FC 2",
        "FUNCTION FC 2 : VOID\nBEGIN; CALL FC 2\nEND_FUNCTION",
        "OB 1 calls FC 2 calls FC 2: a block must not call itself",
    ),
    "an accumulator that was not loaded": (
        "T QW 2",
        "",
        "p.awl:3: what is in the accumulator here is not known",
    ),
    "an accumulator after a call": (
        "L 5; CALL FC 1 (a := IW 2, b := QW 2); T MW 20",
        FC1.format("L #a; T #b"),
        "p.awl:5: what is in the accumulator",
    ),
    "a result that is not there": (
        "= Q 0.0",
        "",
        "p.awl:3: the result of logic operation is not known",
    ),
    "a temporary that was not written": (
        "CALL FC 1 (a := IW 2, b := QW 2)",
        FC1.format("L #t; T #b"),
        "temporary L2 W0 may be read before it is written",
    ),
    "a temporary written on one way": (
        "CALL FC 1 (a := IW 2, b := QW 2)",
        FC1.format("A I 0.0; JC AAA; L 1; T #t; AAA: L #t; T #b"),
        "may be read before it is written",
    ),
    "parameters that share memory": (
        "CALL FC 1 (a := QW 2, b := QW 2)",
        FC1.format("L #a; T #b"),
        "CALL FC 1: A and B share memory",
    ),
    "a parameter that the function reads itself": (
        "CALL FC 1 (a := IW 2, b := QW 2)",
        FC1.format("L QW 2; T #b"),
        "it uses AW 2 by itself, too",
    ),
    "a way out of a bracket": (
        "A(; A I 0.0; JC AAA; ); = Q 0.0; AAA: NOP 0",
        "",
        "p.awl:5: a way leads out of a bracket",
    ),
    "a logic operation that depends on the way": (
        "A I 0.0; JC AAA; A I 0.0; AAA: A M 1.0; = Q 0.0",
        "",
        "p.awl:6: whether a logic operation begins here",
    ),
    "a written input": ("SET; = I 0.0", "", "input I X0 0 is written"),
    "another organization block": (
        "SET; = Q 0.0",
        "ORGANIZATION_BLOCK OB 35\nBEGIN\nEND_ORGANIZATION_BLOCK",
        "OB 35 is not supported",
    ),
    "no text": ("", "", "p.awl: OB 1 writes nothing"),
}
MAPS = {
    "no address": ("symbol,address,type\nx,I0,BOOL\n", "p.map.csv:2: x, I0, BOOL: a symbol, an address"),
    "another type": ("symbol,address,type\nx,IW2,REAL\n", "a symbol, an address and a type are needed"),
    "a width that does not fit": (
        "symbol,address,type\nx,IW2,DINT\n",
        "p.map.csv:2: x: DINT does not have the 16 bits of IW2",
    ),
    "a name twice": ("symbol,address,type\nx,IW2,WORD\nX,IW4,WORD\n", "p.map.csv:3: X is there twice"),
    "an address twice": (
        "symbol,address,type\nx,IW2,WORD\ny,IW2,WORD\n",
        "p.map.csv:3: y: IW2 is there twice",
    ),
    "a name that is none": ("symbol,address,type\na b,IW2,WORD\n", "p.map.csv:2: 'a b' is no name"),
    "a part of other memory": (
        "symbol,address,type\nx,I0.0,BOOL\nw,IW0,WORD\nq,Q0.0,BOOL\n",
        "w of the map overlaps other memory in part",
    ),
}


def refusal(path: Path) -> str:
    """The line that refuses a program."""
    with pytest.raises(Unjudged) as caught:
        make([path], "plc")
    return caught.value.message


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_understood_is_refused(name: str, tmp_path: Path) -> None:
    body, more, cause = REFUSED[name]
    said = refusal(written(tmp_path, body, more))
    assert cause in said, said


@pytest.mark.parametrize("name", MAPS)
def test_a_map_that_cannot_be_right_is_refused(name: str, tmp_path: Path) -> None:
    signals, cause = MAPS[name]
    said = refusal(written(tmp_path, "      A     I 0.0\n      =     Q 0.0", signals=signals))
    assert cause in said, said


def test_a_source_without_a_map_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, "      A     I 0.0\n      =     Q 0.0")
    path.with_suffix(".map.csv").unlink()
    assert "p.map.csv: cannot be read" in refusal(path)


def test_map_and_symbols_belong_to_the_sources() -> None:
    names = [EXAMPLES / name for name in ("plc.awl", "plc.map.csv", "symbols.csv")]
    found = read_sources([names[0]])
    assert list(found.files) == [str(path) for path in names]
    assert read_sources([Path(name) for name in found.files]).files == found.files
    with pytest.raises(Unjudged):
        read_sources([names[1]])
