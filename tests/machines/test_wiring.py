"""Wirings of a machine: what the reader refuses, and that the composed program runs as the wired steps do."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from machines.composed_program import NONE, cell_of, text_of, unit
from machines.concrete_runs import Runner, read_use
from machines.wiring import wiring_of
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.language.tree import Source
from programs.properties.transition_system import Cell
from programs.readers.structured_text.units import read_text

FOLDER = Path(__file__).parents[2] / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")
RESET = 'Reset = "ResetGuard"\n'
REFUSED = {
    "a signal that does not exist": (
        'CLK = "Start"',
        'CLK = "Strat"',
        "inputs.CLK: no signal 'Strat'; did you",
    ),
    "a block that does not exist": (
        '"beam.S_OSSD_Out"',
        '"beem.S_OSSD_Out"',
        "safeguards.beam: no block 'beem'",
    ),
    "a pin that does not exist": ("guard.S_GuardLocked", "guard.Locked", "guard has no output 'Locked'"),
    "a BOOL into a word": ('MW03 = "MW03"', 'MW03 = "LA"', "inputs.MW03: is a WORD, and 'LA' is a BOOL"),
    "a word into a BOOL": ('LA = "LA"', 'LA = "MW07"', "inputs.LA: is a BOOL, and 'MW07' is a WORD"),
    "a word in an AND": ('"running.Q1"', '"running.Q1 AND MW03"', "take a BOOL, not a WORD"),
    "two sources for one input": (
        RESET,
        RESET + 'Reset = "Reset"\n',
        "Reset: two sources for one input; the first",
    ),
    "an input without a source": (
        RESET,
        "",
        "inputs.Reset: an input without a source: SF_GuardLocking reads",
    ),
    "an input the block does not have": (RESET, RESET + 'Foo = "LA"\n', "SF_GuardLocking has no input 'Foo'"),
    "a loop without memory": (
        '"armed.Q1 AND',
        '"ready AND',
        "is a loop without memory; put a block into it",
    ),
    "a mode without a row": ('setup = [["enable"]]\n', "", "modes.setup: a mode without a row in [matrix]"),
    "a row without a mode": ("[matrix]\n", '[matrix]\nspeed = [["beam"]]\n', "matrix.speed: no mode 'speed'"),
    "a set without a safeguard": ('setup = [["enable"]]', 'setup = [["enabled"]]', "no safeguard 'enabled'"),
    "a time between two cycles": (
        "TestTime = 100",
        "TestTime = 105",
        "105 ms is no multiple of the cycle, 10 ms",
    ),
    "a time that is none": ("TestTime = 100", 'TestTime = "1s"', "TestTime: a time in whole ms, not '1s'"),
    "a cycle that no scan has": (
        "scan_ms = [5, 50]",
        "scan_ms = [20, 50]",
        "does not contain cycle_ms, 10 ms",
    ),
    "a block that is not called": ('"edm",\n', "", "block.edm: is not called"),
    "an operator that no wire has": ('"running.Q1"', '"running.Q1 XOR LA"', "and nothing else"),
    "a block that is called twice": ('    "edm",\n', '    "edm", "fplc",\n', "order holds 'fplc' twice"),
    "a key that no row has": ('of = "SF_EDM"', 'off = "SF_EDM"', "block.edm: unknown key 'off'"),
    "another sign for AND": ('"running.Q1"', '"running.Q1 & LA"', "names, AND, OR, NOT and brackets: no &"),
    "a comment in a wire": ('"running.Q1"', '"running.Q1 (* x *)"', "brackets: no & for AND, no comment"),
    "a literal with its type": ('"running.Q1"', '"running.Q1 AND BOOL#FALSE"', "no comment, no BOOL#"),
    "a name that is a word of Python": (
        "LA = {",
        "lambda = {",
        "inputs.lambda: lambda is a keyword of Python",
    ),
    "a time that is needed": (
        "[block.start_edge]\n",
        '[block.late]\nof = "TON"\nwhy = "late"\ninputs.IN = "Start"\n[block.start_edge]\n',
        "block.late.parameters.PT: a parameter without a value: TON has no default",
    ),
    "a block of nobody": ('of = "SF_EDM"', 'of = "SF_EMD"', "no block 'SF_EMD'; did you mean"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_wrong_row_is_refused_in_one_line(
    what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new, cause = REFUSED[what]
    assert old in TEXT
    mine = tmp_path / "my.toml"
    mine.write_text(TEXT.replace(old, new, 1), "utf-8")
    assert main(["machine", str(mine)]) == 2
    said = capsys.readouterr()
    assert not said.out
    assert said.err.count("\n") == 1
    assert cause in said.err
    row = re.search(r"my\.toml:(\d+): [\w.]+(: | )", said.err)
    assert row is not None
    assert 1 <= int(row[1]) <= TEXT.count("\n") + 1


def test_the_line_of_a_refusal_is_that_of_the_row() -> None:
    text = TEXT.replace('MW03 = "MW03"', 'MW03 = "LA"')
    with pytest.raises(Unjudged) as caught:
        wiring_of(text, "my.toml")
    line = text.splitlines()[int(caught.value.message.split(":")[1]) - 1]
    assert line == 'MW03 = "LA"'


@pytest.fixture(scope="module")
def runner() -> Runner:
    wiring = wiring_of(TEXT, "wiring.toml")
    return Runner.of(wiring, NONE, read_use(FOLDER / "use.toml"), tomllib.loads(TEXT))


@pytest.mark.deep
def test_program_and_wired_steps_give_the_same_outputs(runner: Runner) -> None:
    read_again = read_text(text_of(unit(runner.wiring)), "made.st")
    source = Source({made.name.upper(): made for made in read_again}, {})
    cells = [cell_of(runner.wiring), Cell.of(source, source.main())]
    outputs = list(runner.wiring.table.outputs)
    moved = 0
    for seed in (2, 6):
        machines = [cell.machine({}) for cell in cells]
        for (dt_ms, inputs), _, values in runner.random_run(seed, 60):
            for machine in machines:
                machine.scan({name.upper(): value for name, value in inputs.items()}, dt_ms)
                shown = {name: machine.memory.values[name.upper()] for name in outputs}
                assert shown == {name: values[name] for name in outputs}
            moved += bool(values["S_DriveEnable"])
    assert moved


@pytest.mark.deep
def test_a_program_with_crossed_wires_gives_other_outputs(runner: Runner) -> None:
    crossed = TEXT.replace('S_GuardLock = "S_GuardBolt"', 'S_GuardLock = "S_GuardClosed"')
    cell = cell_of(wiring_of(crossed, "crossed.toml"))
    differs, outputs = False, runner.wiring.table.outputs
    for seed in range(8):
        machine = cell.machine({})
        for (dt_ms, inputs), _, values in runner.random_run(seed, 70):
            machine.scan({name.upper(): value for name, value in inputs.items()}, dt_ms)
            differs |= any(machine.memory.values[name.upper()] != values[name] for name in outputs)
    assert differs
