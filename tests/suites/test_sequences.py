"""The document's diagrams become cases; what is declared wrongly, or does not go so, is refused."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.graph.columns import merge_columns
from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, machines
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import Case, open_suite
from modeproof.registers.citations import citations, read_sources
from modeproof.registers.load import load_document, load_interface
from modeproof.suites.sequences import plan, read
from modeproof.suites.write import write_suite
from tests.graph.printed import SEQUENCES, lamp_graph
from tests.kit.programs import starter
from tests.suites.relay import relay_graph
from tests.suites.test_conform_command import toy as toy  # the fixture

ROOT = Path(__file__).resolve().parents[2]
NOTE = "mode_selection"


def test_flows_and_branches_are_cases_a_good_program_passes(tmp_path: Path) -> None:
    write_suite(tmp_path / "s", "sequences", [lamp_graph(tmp_path)])
    suite = open_suite(tmp_path / "s")
    cases = list(suite.cases())
    assert [(case.why, case.basis, len(case.scans)) for case in cases] == [
        ("Figure 0: the button is pressed with the code, and the lamp shines for its time.", "document", 5),
        ("Figure 0: a word that is no code, and SwitchOn does not come.", "finding:T-01", 2),
        ("Figure 0: and once more.", "document", 6),
    ]
    assert all(case.clauses == ("TOY-1",) for case in cases)
    assert cases[0].scans[2].outputs == {"LAMP": True, "MW": "0FF0"}, "from the graph: nobody declared it"
    assert run_suite(suite, starter(tmp_path)).word == CONFORMS
    assert run_suite(suite, starter(tmp_path, "LIMIT = 501")).word == DIFFERS


def test_a_list_of_steps_takes_one_scan_each(tmp_path: Path) -> None:
    old = 'times = 2, step = "StayOn"'
    assert old in SEQUENCES
    graphs = [
        lamp_graph(tmp_path / name, sequences=SEQUENCES.replace(old, new))
        for name, new in (("times", old), ("list", 'step = ["StayOn", "StayOn"]'))
    ]
    scans = [[case.scans for case in _cases(tmp_path, graph)] for graph in graphs]
    assert scans[0] == scans[1]


def _cases(folder: Path, graph: DeviceGraph) -> list[Case]:
    write_suite(folder / "s", "sequences", [graph])
    return list(open_suite(folder / "s").cases())


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('step = "SwitchOn"', 'step = "StayOff"', "scan 2 takes the step SwitchOn, not StayOff"),
        ("dt_ms = 500", "dt_ms = 501", "scan 5: the graph OPEN_Lamp has no such input"),
        ('word = "0000"', 'wrod = "0000"', "no input 'wrod'"),
        (', word = "0000"', "", r"scan 1 does not say \['word'\]"),
        ("CODE[n]", "CODE[m]", "'m' is no name"),
        ("CODE[n]", "CODES[n]", "no table has the entry CODES"),
        ("n = [0]", "n = [1]", "no table has the entry CODE"),
        ('of = "shine"', 'of = "shone"', "'shone', which is no flow"),
        ('at = ["SwitchOn"]', 'at = ["Expires"]', "Expires, which is no step of it"),
        ('clauses = ["TOY-1"]', "", "'clauses' is missing or unknown"),
        ("times = 2", "tmies = 2", "a scan needs `step`"),
        ("[[branch]]", "when = 'n is 0'\n[[branch]]", "when = 'n is 0'"),
        ('buttons = ["press"], word', 'buttons = ["push"], word', "not all in the group buttons"),
        ("[tables]", "[tables", "sequences.toml"),
    ],
)
def test_what_is_declared_wrongly_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in SEQUENCES
    graph = lamp_graph(tmp_path, sequences=SEQUENCES.replace(old, new, 1))
    with pytest.raises(Unjudged, match=said):
        plan(graph, merge_columns(graph))


@pytest.mark.parametrize("document", [name for name in documents(ROOT) if name not in machines(ROOT)])
def test_what_each_document_declares_can_be_read(document: str) -> None:
    declared = read(ROOT, document)
    assert declared.flows and declared.branches


def test_two_flows_of_one_name_are_refused(tmp_path: Path) -> None:
    begin = SEQUENCES.index("[[flow]]")
    flow = SEQUENCES[begin : SEQUENCES.index("[[branch]]")]
    graph = lamp_graph(tmp_path, sequences=SEQUENCES + flow)
    with pytest.raises(Unjudged, match="two flows have the same name"):
        plan(graph, merge_columns(graph))


def test_words_that_are_only_passed_on_stand_for_any_two(tmp_path: Path) -> None:
    def rows(second: str) -> str:
        return f"""
[[flow]]
name = "pass"
device = "relay"
graph = "OPEN_Relay"
why = "two words pass through"
clauses = ["TOY-2"]
scans = [
    {{ set = {{ A = "1234", B = "0000" }}, dt_ms = 10, step = "CopyA" }},
    {{ set = {{ B = "ABCD" }}, step = "CopyB" }},
    {{ set = {{ A = "{second}" }}, step = "CopyA" }},
]
"""

    graph = relay_graph(tmp_path)
    (tmp_path / "spec" / "toy" / "sequences.toml").write_text(rows("ABCD"), encoding="utf-8")
    write_suite(tmp_path / "s", "sequences", [graph])
    (case,) = open_suite(tmp_path / "s").cases()
    assert [scan.outputs for scan in case.scans] == [
        {"X": "1234", "Y": "0000"},
        {"X": "1234", "Y": "ABCD"},
        {"X": "ABCD", "Y": "ABCD"},
    ]
    (tmp_path / "spec" / "toy" / "sequences.toml").write_text(rows("0FF0"), encoding="utf-8")
    with pytest.raises(Unjudged, match="more words at once than the graph has"):
        plan(graph, merge_columns(graph))


def test_a_document_without_sequences_has_every_other_suite(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (toy / "spec" / "toy" / "sequences.toml").unlink()
    assert main(["vectors", "build", "lamp"]) == 0
    assert "lamp sequences: the suite would have no cases; left out" in capsys.readouterr().out
    assert main(["vectors", "build", "lamp", "--suite", "sequences"]) == 2
    assert "the suite would have no cases" in capsys.readouterr().err


# -------------------------------------------------------------------------------------------- the note's own


def clauses_of(device: str) -> set[str]:
    """What the flows and branches of a device name, tables resolved as far as they list clauses."""
    rows = tomllib.loads((ROOT / "spec" / NOTE / "sequences.toml").read_text(encoding="utf-8"))
    mine = {row["name"] for row in rows["flow"] if row["device"] == device}
    named = [row for row in rows["flow"] if row["name"] in mine]
    named += [row for row in rows["branch"] if row["of"] in mine]
    found: set[str] = set()
    for one in (clause for row in named for clause in row["clauses"]):
        found.update(rows["tables"][one.split("[")[0]] if "[" in one else [one])
    return found


@pytest.mark.parametrize("device", ["fplc", "plc", "hmi"])
def test_every_figure_box_is_in_a_sequence_of_its_device(device: str) -> None:
    """Of Figures 2 to 9, what the clauses call behaviour of the device."""
    boxes = {
        clause.id
        for clause in load_document(ROOT, NOTE).clauses
        if clause.kind == "behaviour"
        and device in clause.device
        and clause.id.split("-")[1] in "23456789"
        and clause.id.count("-") >= 2
    }
    assert boxes and boxes - clauses_of(device) == set()


@pytest.mark.parametrize("device", ["fplc", "plc", "hmi"])
def test_the_specification_cites_every_clause_of_a_sequence(device: str) -> None:
    registers = load_document(ROOT, NOTE)
    module = load_interface(ROOT, NOTE).devices[device].module
    cited = {
        clause
        for one in citations(registers, read_sources(registers))
        if one.room == "spec" and one.name.startswith(f"{module}!")
        for clause in one.clauses
    }
    known = {clause.id for clause in registers.clauses}
    assert clauses_of(device) <= known
    if device != "fplc":
        assert clauses_of(device) - cited <= {"EKS-3-0", "EKS-9-0"}
    else:
        assert clauses_of(device) <= cited
