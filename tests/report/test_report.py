"""The report as a whole: identical for identical evidence, escaped, and made even where evidence is not."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents
from modeproof.registers.load import load_document
from modeproof.report import build, environment, parts
from modeproof.report.build import SCHEMA, make
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, HOLE, NOTE, Figure, Sources, Trouble, gather
from modeproof.report.vendored import tables
from tests.report.paper import change, make_whole, put, put_graph, stale, without


@pytest.fixture
def real_root() -> Path:
    """The root of this repository."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The box with all that a report needs; the command line works on it."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    return make_whole(tmp_path)


def troubles(root: Path, status: int) -> list[str]:
    """What a report says that is of this status."""
    return [one.what for one in make(root).troubles if one.status == status]


def test_complete_evidence_gives_a_report_without_troubles(root: Path) -> None:
    report = make(root)
    assert [one for one in report.troubles if one.status != NOTE] == []
    assert report.status == 0 and "as expected" in report.html


def test_identical_evidence_gives_an_identical_file_wherever_it_lies(
    root: Path, tmp_path_factory: Any
) -> None:
    other = make_whole(tmp_path_factory.mktemp("elsewhere"))
    for path in (root / "build" / "evidence").rglob("*.json"):  # times and machine are part of the evidence
        (other / path.relative_to(root)).write_bytes(path.read_bytes())
    once, again = make(root), make(other)
    assert (once.html, once.json) == (again.html, again.json)
    put(root, "MC_Box", seconds=2.5)
    assert make(root).html != once.html


def test_every_part_is_there_in_the_order_of_the_page(root: Path) -> None:
    names = [id for id, _ in parts.makers()]
    assert names == [id for id in parts.ORDER if id in names]
    html = make(root).html
    sections = re.findall(r'<section id="([a-z]+)"', html)
    assert re.findall(r'<section id="([a-z]+)" class="annex"', html) == names[len(parts.FILED) :]
    assert sections == names and tuple(sections[: len(parts.FILED)]) == parts.FILED


def test_the_parts_are_exactly_those_of_the_order(real_root: Path) -> None:
    folder = real_root / "modeproof" / "report"
    modules = {path.stem for path in (folder / "parts").glob("*.py")} - {"__init__"}
    assert modules == set(parts.ORDER)
    assert [id for id in parts.ORDER if not (folder / "page" / f"{id}.html.j2").is_file()] == []


def test_every_property_of_this_repository_has_sentence_hazard_and_clause(real_root: Path) -> None:
    properties = [one for name in documents(real_root) for one in load_document(real_root, name).properties]
    assert len(properties) > 100
    assert [one.id for one in properties if not (one.sentence and one.hazard and one.clauses)] == []


def test_text_of_logs_and_adapters_is_escaped_everywhere(root: Path) -> None:
    attack = '<script>alert("x")</script><img src=x onerror=alert(1)>'
    put(
        root,
        "MC_Box",
        verdict="UNJUDGED",
        as_expected=False,
        reason=f"log says {attack}",
        strength=attack,
        command=f"modeproof check {attack}",
    )
    put(
        root,
        "adapter_x",
        kind="conformance",
        verdict="CONFORMS",
        result={"adapter": attack, "device": attack},
    )
    change(root / "spec" / "box" / "clauses.toml", "It shuts.", "It shuts. <script>alert(2)</script>")
    (root / "docs" / "limits.md").write_text(f"# Limits\n\n{attack} `{attack}`\n")
    report = make(root)
    assert attack not in report.html and "alert(" in report.html
    assert "<img" not in report.html and "<script>alert" not in report.html
    assert json.loads(report.json)["status"] == HOLE


def test_a_script_element_cannot_be_ended_by_data(root: Path) -> None:
    assert "</script" not in str(environment.script_json({"a": "</script><script>alert(1)"}))


def test_no_figure_is_typed_by_hand_in_a_template(real_root: Path) -> None:
    found = []
    for path in sorted((real_root / "modeproof" / "report" / "page").glob("*.j2")):
        for number, text in hand_typed(path.read_text(encoding="utf-8")):
            found.append(f"{path.name}: {number} in {text!r}")
    assert found == []


@pytest.mark.parametrize(
    ("template", "figures"),
    [
        ("<p>all 131 hold</p>", ["131"]),
        ("<td>5</td>", ["5"]),
        ("<h2>two of {{ m.figure(x) }}</h2>", []),
        ('<p class="n1">{{ rows[:4] }} {% if x > 2 %}<code>--lane 3</code>{% endif %}</p>', []),
        ("<p>SHA-256, cvc5, z3, UTF-8, A4</p>", []),
    ],
)
def test_a_figure_that_was_typed_is_found(template: str, figures: list[str]) -> None:
    assert [number for number, _ in hand_typed(template)] == figures


def hand_typed(template: str) -> list[tuple[str, str]]:
    """Numbers in the text of a template, outside expressions, tags, code and comments; names keep theirs."""
    text = re.sub(
        r"\{#.*?#\}|<code>.*?</code>|<svg.*?</svg>|\{\{.*?\}\}|\{%.*?%\}|<[^>]*>",
        "\0",
        template,
        flags=re.DOTALL,
    )
    return [
        (number, piece.strip())
        for piece in text.split("\0")
        for number in re.findall(r"(?<![\w-])\d[\d,.]*\b(?!\w)", piece)
    ]


def test_the_json_is_what_its_schema_says(root: Path) -> None:
    content = json.loads(make(root).json)
    validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))
    validator.check_schema(validator.schema)
    assert list(validator.iter_errors(content)) == []
    for key in ("digest", "troubles", "parts", "snapshot", "files"):
        broken = {name: value for name, value in content.items() if name != key}
        assert list(validator.iter_errors(broken)), key
    content["status"] = 3
    assert list(validator.iter_errors(content))


def test_a_figure_shows_its_source_and_has_a_known_hash(root: Path) -> None:
    html = make(root).html
    sources = json.loads(re.search(r'id="sources">(.*?)</script>', html)[1])  # type: ignore[index]
    folders = json.loads(re.search(r'id="folders">(.*?)</script>', html)[1])  # type: ignore[index]
    used = set(re.findall(r'data-source="([^"]+)"', html))
    assert {one for one in used if one not in sources and one not in folders} == set()
    assert "build/evidence/box/MC_Box.json" in used and "build/evidence/box/" in folders


def test_the_page_runs_its_own_scripts_and_no_other(root: Path) -> None:
    html = make(root).html
    (policy,) = re.findall(r"script-src ([^;]*);", html)
    own = [text.encode() for text in re.findall(r"<script>(.*?)</script>", html, re.DOTALL)]
    named = {base64.b64encode(hashlib.sha256(text).digest()).decode() for text in (*own, tables()[0])}
    assert len(own) == 5 and set(policy.split()) == {f"'sha256-{digest}'" for digest in named}
    assert " on" not in {name[:3] for name in re.findall(r"<\w+[^>]*?( on\w+)=", html)}


def test_every_inner_link_leads_somewhere_and_ids_are_unique(root: Path) -> None:
    put_graph(root, 4, 4)
    html = make(root).html
    lost = {one for one in lost_links(html) if not one.startswith("trace-")}
    assert lost == set()  # the box's counterexamples have no states to draw
    planted = lost_links(f'{html}<a href="#nowhere">x</a><p id="scope">') - lost_links(html)
    assert planted == {"nowhere", "scope twice"}


def lost_links(html: str) -> set[str]:
    """What a link leads to and is not there, or is there twice."""
    ids = re.findall(r'\sid="([^"]+)"', html)
    lost = {target for target in re.findall(r'href="#([^"]+)"', html) if target not in ids}
    return lost | {f"{one} twice" for one in ids if ids.count(one) > 1}


def test_missing_evidence_is_a_hole_in_its_place(root: Path) -> None:
    without(root, "NEG_Box_eager")
    report = make(root)
    assert report.status == HOLE
    assert "box: 1 of 5 runs without evidence: NEG_Box_eager" in troubles(root, HOLE)
    without(root, "it_shuts_over_the_door_only")
    assert any("1 of 1 theorems without evidence" in one for one in troubles(root, HOLE))


def test_no_evidence_at_all_still_gives_a_report(root: Path) -> None:
    for path in (root / "build" / "evidence" / "box").glob("*.json"):
        path.unlink()
    report = make(root)
    assert report.status == HOLE and "there is no evidence in build/evidence/box/" in report.html


@pytest.mark.parametrize("damage", ["", "{", '{"kind": "tlc"}', "\udcff"])
def test_damaged_evidence_is_named_and_the_rest_is_read(root: Path, damage: str) -> None:
    path = root / "build" / "evidence" / "box" / "MC_Box.json"
    path.write_bytes(damage.encode("utf-8", "surrogateescape"))
    report = make(root)
    assert report.status == HOLE and any("MC_Box.json" in one.what for one in report.troubles)
    assert "NEG_Box_hasty" in report.html and str(root) not in report.html


def test_a_damaged_register_is_a_hole_and_no_crash(root: Path) -> None:
    (root / "spec" / "box" / "findings.toml").write_text("[[finding")
    report = make(root)
    assert report.status == HOLE and any("findings.toml" in one for one in troubles(root, HOLE))


def test_stale_evidence_is_one_line_a_document_and_judges_nothing(root: Path) -> None:
    change(root / "spec" / "box" / "Box.tla", "CODE == TLCEval", "CODE  == TLCEval")
    lines = [one for one in make(root).troubles if "of another text" in one.what and one.part == "verdict"]
    assert len(lines) == 1 and lines[0].status == HOLE and len(lines[0].items) == 7
    assert lines[0].what == "box: 7 of 7 pieces of evidence are of another text (spec/box/Box.tla)"
    data = json.loads(make(root).json)["parts"]["verdict"]["documents"][0]
    assert data["rows"][0]["cells"][0]["verdict"] == "UNJUDGED"


def test_evidence_of_two_texts_of_one_file_is_a_contradiction(root: Path) -> None:
    stale(root, "MC_Box_lazy")
    report = make(root)
    assert report.status == DIFFERS
    assert "the evidence is of different texts of spec/box/Box.tla" in troubles(root, DIFFERS)


def test_different_counts_of_run_and_comparison_are_a_contradiction(root: Path) -> None:
    put_graph(root, states=4, compared=4)
    assert troubles(root, DIFFERS) == []
    without(root, "refimpl_OPEN_Box")
    put(
        root,
        "refimpl_OPEN_Box",
        kind="conformance",
        result={"run": "box/OPEN_Box", "device": "box", "states": 5, "transitions": 7},
    )
    assert "box: OPEN_Box printed 4 states, and refimpl_OPEN_Box compared 5" in troubles(root, DIFFERS)
    assert make(root).status == DIFFERS


def test_two_solvers_that_disagree_are_a_contradiction(root: Path) -> None:
    queries = [
        {"name": "claim", "expected": "unsat", "z3": "unsat", "cvc5": "sat", "twin_of": "", "core": []}
    ]
    put(root, "it_shuts_over_the_door_only", result={"queries": queries})
    found = "box/it_shuts_over_the_door_only: claim: z3 says unsat, cvc5 sat"
    assert found in troubles(root, DIFFERS)


def test_a_holding_run_and_a_falling_theorem_are_a_contradiction(root: Path) -> None:
    put(root, "it_shuts_over_the_door_only", verdict="VIOLATED", as_expected=False, reason="a model")
    assert make(root).status == DIFFERS
    assert any("two engines disagree" in one for one in troubles(root, DIFFERS))


@pytest.mark.parametrize(("verdict", "status"), [("VIOLATED", DIFFERS), ("INCONCLUSIVE", HOLE)])
def test_evidence_that_is_not_as_expected_says_so(root: Path, verdict: str, status: int) -> None:
    put(root, "MC_Box", verdict=verdict, as_expected=False, reason="it fell")
    assert make(root).status == status
    assert f"box/MC_Box: {verdict}: it fell" in troubles(root, status)


def test_what_differs_comes_before_what_is_missing(root: Path) -> None:
    put(root, "MC_Box", verdict="VIOLATED", as_expected=False, reason="it fell")
    without(root, "WIT_Box")
    assert make(root).status == DIFFERS and troubles(root, HOLE)


def test_evidence_that_no_register_declares_is_named(root: Path) -> None:
    put(root, "MC_Gone")
    assert any("declared no more: MC_Gone" in one for one in troubles(root, HOLE))


def test_different_tool_versions_are_named_and_change_no_status(root: Path) -> None:
    tools = {"tlc": {"version": "another", "sha256": "6" * 64}}
    put(root, "MC_Box", tools=tools)
    report = make(root)
    assert report.status == 0
    assert any("2 versions of tlc" in one and "1 by another" in one for one in troubles(root, NOTE))


def test_parts_have_their_own_troubles_and_the_first_the_rest(root: Path) -> None:
    sources = gather(root)
    strange = Trouble(HOLE, "nowhere", "x")
    sources = type(sources)(sources.root, sources.documents, sources.evidence, sources.files, (strange,))
    with_them = build._with_troubles([Part("a", "A", {}), Part("b", "B", {})], sources)
    assert [one.troubles for one in with_them] == [(strange,), ()]


def test_a_report_of_the_largest_inputs_stays_under_ten_megabytes(root: Path) -> None:
    """Six hundred pieces of evidence of eighty inputs each: as many as five documents have."""
    inputs = {f"proofs/box/{number:04}.py": f"{number:064x}" for number in range(80)}
    put(root, "it_shuts_over_the_door_only", inputs=inputs)
    folder = root / "build" / "evidence" / "box"
    text = (folder / "it_shuts_over_the_door_only.json").read_text()
    for number in range(600):
        name = f"it_shuts_over_the_door_only_{number:04}"
        (folder / f"{name}.json").write_text(text.replace("it_shuts_over_the_door_only", name))
    report = make(root)
    assert report.html.count("it_shuts_over_the_door_only_0599")
    assert len(report.html.encode()) < 10_000_000 and len(report.json.encode()) < 10_000_000


@pytest.mark.parametrize(
    ("name", "result"),
    [
        ("it_shuts_over_the_door_only", {"queries": 3}),
        ("it_shuts_over_the_door_only", {"queries": [1], "unused": None}),
        ("MC_Box", {"properties": None, "run": []}),
        ("MC_Box", {"graph": {"states": "many"}, "distinct": "five"}),
        ("NEG_Box_eager", {"trace": 1, "trace_length": "x"}),
        ("coverage", {"devices": 1}),
        ("strength_spec", {"mutants": {}}),
        ("agreement", {"rows": [0]}),
    ],
)
def test_strangely_formed_evidence_is_a_hole_and_no_crash(
    root: Path, name: str, result: dict[str, Any]
) -> None:
    kinds = {"coverage": "coverage", "strength_spec": "strength", "agreement": "agreement"}
    put(root, name, kind=kinds.get(name, ""), result=result)
    report = make(root)
    assert '<section id="review"' in report.html and json.loads(report.json)["parts"]
    assert [one for one in report.troubles if one.status == HOLE] or name in ("MC_Box", "NEG_Box_eager")


def test_a_part_that_fails_says_so_and_others_are_there(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(sources: Sources) -> Part:
        raise KeyError("planted")

    monkeypatch.setattr(parts.scope, "part", broken)
    report = make(root)
    assert report.status == HOLE
    assert "the part scope cannot be made: KeyError: &#39;planted&#39;" in report.html
    assert '<section id="review"' in report.html
    monkeypatch.setattr(parts.scope, "part", lambda sources: Part("scope", "Scope", {"documents": [1]}))
    assert "the part scope cannot be made: UndefinedError" in make(root).html


# ------------------------------------------------------------------------------------------ the command


def test_the_command_writes_page_json_sheet_and_gives_the_status(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["report", "--json", str(root / "result.json")]) == 0
    folder = root / "build" / "report"
    assert {"report.html", "report.json", "review.csv"} <= {one.name for one in folder.iterdir()}
    result = json.loads((root / "result.json").read_text())
    assert (result["command"], result["status"]) == ("report", 0)
    assert result["report"] == str(folder / "report.html")
    without(root, "MC_Box")
    assert main(["report"]) == HOLE
    assert (
        "NOT THERE  box: 1 of 5 runs without evidence: MC_Box; run modeproof verify"
        in capsys.readouterr().out
    )


def test_many_troubles_of_one_part_are_counted_on_the_terminal(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for number in range(9):
        put(root, f"MC_{number}", verdict="VIOLATED", as_expected=False, reason="x")
    assert main(["report"]) == DIFFERS
    out = capsys.readouterr().out
    assert "NOT AS EXPECTED  and 5 more in the part verdict of the page" in out


@pytest.mark.parametrize("option", ["--out", "--json"])
def test_a_place_that_cannot_be_written_is_one_line(
    root: Path, option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (root / "file").write_text("")
    assert main(["report", option, str(root / "file" / "below")]) == 2
    err = capsys.readouterr().err
    assert "cannot be written" in err and len(err.splitlines()) == 1


@pytest.mark.parametrize("text", [None, "", "{}", '{"snapshot": {}}', "[1]"])
def test_a_previous_report_that_is_none_is_one_line(
    root: Path, text: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    previous = root / "old.json"
    if text is not None:
        previous.write_text(text)
    assert main(["report", "--previous", str(previous)]) == 2
    err = capsys.readouterr().err
    assert "old.json" in err and len(err.splitlines()) == 1
    assert not (root / "build" / "report" / "report.html").exists()


def test_a_root_without_documents_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "spec").mkdir()
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    assert main(["report"]) == 2
    assert "there is nothing to report" in capsys.readouterr().err
    with pytest.raises(Unjudged):
        make(tmp_path)


def test_a_figure_without_a_value_is_shown_as_a_hole() -> None:
    macros: Any = environment.environment().get_template("macros.html.j2").module
    assert "not there" in macros.figure(Figure(None, "x")) and "not there" in macros.figure(None)
    assert 'data-source="a.json"' in macros.figure(Figure(1234, "a.json")) and "1,234" in macros.figure(
        Figure(1234, "a.json")
    )
