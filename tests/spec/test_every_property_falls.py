"""Each property falls to a negative, or to the edit of a device that killers.toml has for it."""

from __future__ import annotations

import re
import shutil
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, root
from modeproof.ground.progress import Progress
from modeproof.lane.verify import check_registers
from modeproof.registers.citations import Sources, read_sources
from modeproof.registers.killers import check_killers, edited, load_killers, run_of, stamps_of, ways_to_fall
from modeproof.registers.load import load_document
from modeproof.registers.pins import check_pins, load_pins, repin
from modeproof.registers.tla import Definition, closure
from modeproof.tlc.killers import judge_killer, judge_killers, run_with
from modeproof.tlc.toolchain import find_toolchain

DOCUMENTS = {name: load_document(root(), name) for name in documents(root())}
SOURCES = {name: read_sources(document) for name, document in DOCUMENTS.items()}
KILLERS = {name: load_killers(root(), name) for name in DOCUMENTS}
EVERY = [(name, edit) for name, killers in KILLERS.items() for edit in killers.edits]
EDITS = [pytest.param(*edit, marks=[pytest.mark.long] if at % 6 else []) for at, edit in enumerate(EVERY)]
"""Each edit was judged when it got its stamp; five of six are judged again on request alone."""
BOUNDS = sorted(
    {(name, killer.run) for name, killers in KILLERS.items() for killer in killers.edits.values()}
)
SMALLER = [
    pytest.param(name, bounds, marks=[pytest.mark.long] * bool(at % 3))
    for at, (name, bounds) in enumerate(BOUNDS)
    if bounds in KILLERS[name].bounds
]


@pytest.mark.sampled(24)
@pytest.mark.parametrize(("document", "edit"), EDITS)
def test_the_property_falls_with_its_edit(document: str, edit: str) -> None:
    killer = KILLERS[document].edits[edit]
    found = judge_killer(DOCUMENTS[document], SOURCES[document], killer, find_toolchain())
    names = {prop.id: prop.tla for prop in DOCUMENTS[document].properties}
    assert (found.verdict, found.violated) == ("VIOLATED", names[killer.property])


@pytest.mark.deep
@pytest.mark.parametrize(("document", "bounds"), SMALLER)
def test_within_smaller_bounds_the_properties_hold(document: str, bounds: str) -> None:
    killers = KILLERS[document]
    runs = [
        run_of(DOCUMENTS[document], killers, edit) for edit in killers.edits.values() if edit.run == bounds
    ]
    every = msgspec.structs.replace(runs[0], properties=tuple({run.properties[0]: 0 for run in runs}))
    assert run_with(DOCUMENTS[document], every, {}, find_toolchain()).verdict == "HOLDS"


@pytest.mark.parametrize("document", DOCUMENTS)
def test_no_property_is_without_a_killer_or_reason(document: str) -> None:
    falls = ways_to_fall(DOCUMENTS[document], SOURCES[document])
    assert set(falls) == {prop.id for prop in DOCUMENTS[document].properties}
    assert check_killers(DOCUMENTS[document], SOURCES[document]) == []


def test_few_properties_are_true_by_construction() -> None:
    every = [
        falls.kind for name in DOCUMENTS for falls in ways_to_fall(DOCUMENTS[name], SOURCES[name]).values()
    ]
    assert "nothing" not in every and every.count("by construction") <= 2 < 200 < len(every)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_definition_of_a_property_falls(document: str) -> None:
    """Some properties are defined for one device and again for all devices together."""
    loaded, modules = DOCUMENTS[document], SOURCES[document].modules
    names = {prop.id: prop.tla for prop in loaded.properties}
    falls = ways_to_fall(loaded, SOURCES[document])
    runs = [run for run in loaded.runs if any(run.id in fall.negatives for fall in falls.values())]
    seen = {(run.property, module.name) for run in runs for module in closure(modules, run.module)}
    for killer in KILLERS[document].edits.values():
        run = run_of(loaded, KILLERS[document], killer)
        seen |= {(names[killer.property], module.name) for module in closure(modules, run.module)}
    spared = set(KILLERS[document].by_construction)
    wanted = {name for id, name in names.items() if id not in spared}
    defined = {(name, module.name) for module in modules.values() for name in module.defined & wanted}
    assert defined and defined - seen == set()


def rewritten(document: str) -> Iterator[tuple[set[str], Sources]]:
    """The sources with properties rewritten to TRUE, and their names: first the first definition of each,
    then the second, until every definition has been rewritten once, in whichever module it stands.
    """
    sources = SOURCES[document]
    names = {prop.tla for prop in DOCUMENTS[document].properties}
    passes: list[list[tuple[str, Definition]]] = []
    seen: Counter[str] = Counter()
    for module in sources.modules.values():
        for definition in module.definitions:
            if definition.name in names:
                passes += [[]] if seen[definition.name] == len(passes) else []
                passes[seen[definition.name]].append((module.name, definition))
                seen[definition.name] += 1
    assert set(seen) == names
    for chosen in passes:
        modules = dict(sources.modules)
        for name, old in chosen:
            new = [
                replace(own, body=f"{own.name} == TRUE") if own is old else own
                for own in modules[name].definitions
            ]
            modules[name] = replace(modules[name], definitions=tuple(new))
        yield {old.name for _, old in chosen}, replace(sources, modules=modules)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_a_property_rewritten_to_true_is_named(document: str) -> None:
    for names, changed in rewritten(document):
        told = check_pins(DOCUMENTS[document], changed)
        moved = {problem.place for problem in told if "is not the text that was pinned" in problem.text}
        assert {f"checked.{name}" for name in names} <= moved
        killers = KILLERS[document]
        ids = {prop.id for prop in DOCUMENTS[document].properties if prop.tla in names}
        stamps = stamps_of(DOCUMENTS[document], changed, killers)
        pinned = load_pins(DOCUMENTS[document]).killers
        kept = {killers.edits[name].property for name, now in stamps.items() if pinned.get(name) == now}
        assert not kept & ids


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of one document's specification, theorems and reference, and the times of the others."""
    for folder in ("spec/edm", "spec/common", "proofs/edm", "refimpl"):
        shutil.copytree(root() / folder, tmp_path / folder)
    for times in root().glob("spec/*/properties.toml"):
        (place := tmp_path / times.relative_to(root())).parent.mkdir(exist_ok=True)
        shutil.copy(times, place)
    return tmp_path


def change(tree: Path, file: str, old: str, new: str) -> None:
    text = (tree / file).read_text()
    assert text.count(old) == 1, old
    (tree / file).write_text(text.replace(old, new))


def problems(tree: Path) -> list[str]:
    document = load_document(tree, "edm")
    return [str(problem) for problem in check_killers(document, read_sources(document))]


def test_weakened_and_pinned_again_it_is_still_refused(tree: Path) -> None:
    assert problems(tree) == []
    weak = "IdleShowsNothing == state \\in EDMStates\nStood"
    change(tree, "spec/edm/EDM.tla", "IdleShowsNothing ==", f"{weak} ==")
    document = load_document(tree, "edm")
    assert any("IdleShowsNothing" in line for line in repin(document, read_sources(document), "planted"))
    (told,) = problems(tree)
    assert "IdleShowsNothing: was judged on another text; if that was not meant, undo it" in told
    said: list[str] = []
    assert judge_killers(tree, "edm", find_toolchain(), False, said.append) == ["IdleShowsNothing"]
    assert said == [
        "edm: IdleShowsNothing: does not fail",
        f"edm: {len(KILLERS['edm'].edits)} edits, 1 judged now, 1 break nothing",
    ]
    assert "IdleShowsNothing: has not been judged" in problems(tree)[0]


def test_verify_names_a_property_that_became_true(tree: Path) -> None:
    def told() -> tuple[str, list[str]]:
        (record,), _ = check_registers(tree, ["edm"], "full", Progress(quiet=True))
        places = [line.split(": ")[0] for line in record["result"]["problems"] if "IdleShows" in line]
        return record["verdict"], places

    assert told() == ("EQUAL", [])
    change(tree, "spec/edm/EDM.tla", "IdleShowsNothing == ~Ready", "IdleShowsNothing == TRUE \\/ ~Ready")
    assert told() == ("DIFFERS", ["spec/edm/pins.toml", "spec/edm/killers.toml"])
    document = load_document(tree, "edm")
    repin(document, read_sources(document), "planted")
    assert told() == ("DIFFERS", ["spec/edm/killers.toml"])


HEAD = "[[killer.IdleShowsNothing]]\n"
ROW = re.compile(r"\n\[\[killer\.IdleShowsNothing\]\]\n(?:.+\n)+")
WRONG: dict[str, tuple[str | re.Pattern[str], str]] = {
    "is broken by nothing": (ROW, ""),
    "was judged on another text": ('state = "Idle" -> 1', 'state = "Idle" -> 2'),
    "unknown property": (HEAD, "[[killer.IdleShowsAll]]\n"),
    "unknown run": (HEAD, f'{HEAD}run = "MC_SF_EDM_nowhere"\n'),
    "does not check IdleShowsNothing": (HEAD, f'{HEAD}run = "MC_SF_EDM_activate_held"\n'),
    "which is no device's": (HEAD, f'{HEAD}in = "EDMOpen"\n'),
    "not once": ("old = 'state = \"Idle\" -> 0'", "old = 'state = \"Idle\"'"),
    "edits nothing": ('state = "Idle" -> 1', 'state = "Idle" -> 0'),
    "edits the property": (
        re.compile(r"old = 'state = \"Idle\" -> 0'"),
        "old = 'IdleShowsNothing =='",
    ),
    "bounds.spare: no edit is judged within these bounds": (
        re.compile(r"\Z"),
        '\n[bounds.spare]\nrun = "MC_SF_EDM_arbitrary"\n',
    ),
    "it is broken by MissedPickUpIsAnError": (
        re.compile(r"\Z"),
        '\n[by_construction]\nIdleShowsNothing = "none"\n',
    ),
}


@pytest.mark.parametrize("told", WRONG)
def test_a_row_of_no_use_is_refused(told: str, tree: Path) -> None:
    path = tree / "spec/edm/killers.toml"
    old, new = WRONG[told]
    text = path.read_text()
    pattern = old if isinstance(old, re.Pattern) else re.compile(re.escape(old))
    path.write_text(pattern.sub(new, text, count=1))
    expected = told.replace("MissedPickUpIsAnError", "IdleShowsNothing")
    assert path.read_text() != text and any(expected in problem for problem in problems(tree))


@pytest.mark.parametrize(
    ("old", "named"),
    [
        ("\n    /\\ ~Error ", "CodeTellsTheRow"),  # an earlier line has it with other spaces before it
        (r"AwaitReleaseInError\(i\)\)\n\n(?:.*\n)*?OutputNeedsAll ==", "OutputNeedsAll"),  # it ends there
    ],
)
def test_an_edit_that_reaches_a_property_is_refused(old: str, named: str) -> None:
    text = (root() / "spec/edm/EDM.tla").read_text()
    found = old if old in text else re.search(old, text)[0]  # type: ignore[index]
    killer = msgspec.structs.replace(KILLERS["edm"].edits["IdleShowsNothing"], old=found)
    with pytest.raises(Unjudged, match=f"edits the property {named} and not the device"):
        edited(DOCUMENTS["edm"], SOURCES["edm"], KILLERS["edm"], killer)


def test_a_killer_is_asked_for_its_property_alone() -> None:
    document = DOCUMENTS["edm"]
    runs = tuple(msgspec.structs.replace(run, deadlock=True) for run in document.runs)
    killer = KILLERS["edm"].edits["IdleShowsNothing"]
    run = run_of(replace(document, runs=runs), KILLERS["edm"], killer)
    assert (run.properties, run.property, run.deadlock) == (("IdleShowsNothing",), "", False)


def test_a_property_that_no_cfg_asks_is_unjudged() -> None:
    run = run_of(DOCUMENTS["edm"], KILLERS["edm"], KILLERS["edm"].edits["StopAtOnce"])
    for name in ("Nothing", "EnablesAgain"):
        with pytest.raises(Unjudged, match=f"{name} specified in the configuration file is not defined"):
            run_with(DOCUMENTS["edm"], msgspec.structs.replace(run, properties=(name,)), {}, find_toolchain())


@pytest.mark.parametrize("wrong", ["bounds = 3", "killer = 3", "killer = [3]", "by_construction = 3"])
def test_a_file_of_another_form_is_refused_in_a_line(tree: Path, wrong: str) -> None:
    (tree / "spec/edm/killers.toml").write_text(wrong)
    with pytest.raises(Unjudged, match=r"^spec/edm/killers.toml: .*must be a"):
        load_killers(tree, "edm")


@pytest.mark.parametrize(
    "row",
    [
        'lanes = ["exhaustive"], reading = "StopBeforeTimeout"',
        'constants = { MONITORING_TIME = "3" }, reading = "StopBeforeTimeout"',
        'specification = "DeactivationSpec", reading = "StopBeforeTimeout"',
        'reading = ["StopBeforeTimeout", "RequestBeforeTimeout"]',
        'reading = "ResetByLevel"',  # two operators
    ],
)
def test_a_negative_of_more_than_one_change_is_no_killer(row: str, tree: Path) -> None:
    change(tree, "spec/edm/runs.toml", 'reading = "StopBeforeTimeout", property', f"{row}, property")
    assert problems(tree) == [
        "spec/edm/properties.toml: MissedPickUpIsAnError: is broken by nothing: "
        "give it an edit of a device in killers.toml, or say why none can be"
    ]


def test_an_edit_that_cannot_be_judged_hides_no_other(tree: Path) -> None:
    file = "spec/edm/killers.toml"
    change(tree, file, "new = 'state = \"Idle\" -> 1'", "new = 'state = ('")
    change(tree, file, "-> \\hC051", "-> \\hC052")
    change(tree, file, "CountsAfterReset(i) == ~i.S_OutControl", "Counts(i) == ~i.S_OutControl")
    said: list[str] = []
    with pytest.raises(Unjudged, match="not judged: IdleShowsNothing, ResetNeverStarts"):
        judge_killers(tree, "edm", find_toolchain(), False, said.append)
    assert "edm: CodeTellsTheRow: fails" in said
    assert [line for line in problems(tree) if "CodeTellsTheRow" in line] == []


@pytest.mark.parametrize(
    ("step", "old", "new"),
    [("EnableOutput", "Granted(i) == Requested(i) /\\ Feedback(i, TRUE)", "Granted(i) == FALSE")],
)
def test_an_antecedent_that_cannot_be_reached_is_refused(step: str, old: str, new: str) -> None:
    document = DOCUMENTS["edm"]
    wanted = [prop.id for prop in document.properties if prop.antecedent == step]
    witness = next(run for run in document.runs if run.id == "WIT_SF_EDM")
    text = (root() / "spec/edm/EDM.tla").read_text()
    assert len(wanted) == 4 and text.count(old) == 1
    found = run_with(document, witness, {"EDM": text.replace(old, new)}, find_toolchain())
    assert found.verdict == "UNREACHED" and not found.as_expected
    assert step in found.reason.removeprefix("not reached: ").split(", ")
