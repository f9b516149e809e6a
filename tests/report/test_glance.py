"""The verdicts and the parts that only registers fill: scope, limits, glossary."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.report import vendored
from modeproof.report.build import make
from modeproof.report.parts import glossary, limits, reproduce, scope, verdict
from modeproof.report.sources import HOLE, gather
from modeproof.report.terms import Terms
from modeproof.report.text import blocks
from tests.report.paper import change, make_whole, put, put_graph, second, stale, without


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all that a report needs."""
    return make_whole(tmp_path)


def glance(root: Path) -> dict[str, Any]:
    """The data of the only document, and of all."""
    data = verdict.part(gather(root)).data
    return {**data["documents"][0], "all": data}


def counts(root: Path) -> dict[str, tuple[int, int, int]]:
    """Of each group of evidence: good, of, status."""
    data = verdict.part(gather(root)).data
    cells = data["documents"][0]["groups"]
    return {
        group["title"]: (cell["good"].value, cell["of"].value, cell["status"])
        for group, cell in zip(data["groups"], cells, strict=True)
    }


# ---------------------------------------------------------------------------------------------- verdict


def test_a_property_stands_with_verdict_strength_and_count(root: Path) -> None:
    one = glance(root)
    (cell,) = one["rows"][0]["cells"]
    assert (cell["verdict"], cell["status"], cell["run"]) == ("HOLDS", 0, "MC_Box")
    assert cell["distinct"].value == 5 and cell["distinct"].source == "build/evidence/box/MC_Box.json"
    assert one["strengths"] == [{"mark": cell["mark"], "text": "any door"}]
    assert one["environments"][0]["good"].value == one["environments"][0]["of"].value == 1


def test_a_reading_that_fails_as_predicted_is_not_called_violated(root: Path) -> None:
    words, page = "the other reading fails, as predicted</span>", make(root).html
    assert words in page and not re.search(r'✓</span> (<span class="figure"[^>]*>)?VIOLATED', page)
    put(root, "NEG_Box_eager", verdict="HOLDS", as_expected=False, reason="nothing fails")
    assert make(root).html.count(words) < page.count(words)


def test_kinds_of_evidence_are_counted_apart(root: Path) -> None:
    put_graph(root, 4, 4)
    assert counts(root) == {
        "theorems": (1, 1, 0),
        "negatives": (2, 2, 0),
        "witnesses": (1, 1, 0),
        "graphs": (1, 1, 0),
        "conformance": (1, 1, 0),
        "registers": (1, 1, 0),
    }


def test_the_weakest_of_several_runs_counts(root: Path) -> None:
    run = second(root, verdict="INCONCLUSIVE", as_expected=False, reason="time")
    (cell,) = glance(root)["rows"][0]["cells"]
    assert (cell["verdict"], cell["status"], cell["run"]) == ("INCONCLUSIVE", HOLE, run)


def test_holding_with_other_counts_is_merely_not_as_declared(root: Path) -> None:
    put(root, "MC_Box", as_expected=False, reason="distinct states: 5, pinned 6")
    (cell,) = glance(root)["rows"][0]["cells"]
    assert (cell["verdict"], cell["status"]) == ("HOLDS", 1)
    assert cell["why"] == "not as declared: distinct states: 5, pinned 6"
    assert "HOLDS?" not in make(root).html


def test_why_a_property_fell_stands_in_its_cell(root: Path) -> None:
    put(root, "MC_Box", verdict="INCONCLUSIVE", as_expected=False, reason="out of memory")
    assert glance(root)["rows"][0]["cells"][0]["why"] == "out of memory"
    assert "INCONCLUSIVE</span> out of memory" in make(root).html


def test_stale_evidence_counts_nowhere(root: Path) -> None:
    stale(root, "it_shuts_over_the_door_only")
    stale(root, "MC_Box")
    assert counts(root)["theorems"] == (0, 1, HOLE)
    (cell,) = glance(root)["rows"][0]["cells"]
    assert (
        cell["verdict"] == "UNJUDGED" and "(HOLDS) is of another text of spec/box/Box.tla" in cell["strength"]
    )


def test_a_property_without_evidence_is_unjudged_or_of_another_lane(root: Path) -> None:
    without(root, "MC_Box")
    without(root, "MC_Box_lazy")
    (cell,) = glance(root)["rows"][0]["cells"]
    assert (cell["verdict"], cell["strength"]) == ("UNJUDGED", "no evidence of MC_Box")
    runs = root / "spec" / "box" / "runs.toml"
    runs.write_text(runs.read_text().replace('lanes = ["full"]', 'lanes = ["exhaustive"]'))
    (cell,) = glance(root)["rows"][0]["cells"]
    assert cell["aside"] and cell["verdict"] == "not in this lane"
    assert (
        glance(root)["aside"] == ["MC_Box", "MC_Box_lazy", "NEG_Box_hasty", "WIT_Box"]
        or glance(root)["aside"]
    )


def test_the_unexpected_comes_first_and_its_document_is_open(root: Path) -> None:
    second = """
[[property]]
id = "AlwaysShut"
title = "never mind"
sentence = "It is shut."
hazard = "A hand."
clauses = ["BX-1-2"]
tla = "AlwaysShut"
module = "BoxOpen"
kind = "action"
environments = ["arbitrary"]
antecedent = ""
reason = "a toy"
"""
    with (root / "spec" / "box" / "properties.toml").open("a") as file:
        file.write(second)
    assert [row["id"] for row in glance(root)["rows"]] == ["AlwaysShut", "ShutsOverDoor"]
    assert glance(root)["rows"][0]["cells"][0]["strength"] == "no run checks it"
    html = make(root).html
    assert '<details class="matrix" id="verdict-box" open>' in html
    assert "no run checks it" in html


def test_mutants_are_counted_from_the_evidence_of_their_campaigns(root: Path) -> None:
    assert glance(root)["mutants"] == []
    mutants = [
        {"mutant": str(number), "verdict": word, "killers": [], "operator": "x", "module": "Box"}
        for number, word in enumerate(["KILLED", "KILLED", "SURVIVED", "EQUIVALENT", "INVALID", "UNMEASURED"])
    ]
    put(root, "strength_spec", kind="strength", result={"mutants": mutants, "judges": {}})
    (row,) = glance(root)["mutants"]
    assert (row["judge"], row["killed"].value, row["of"].value) == ("properties", 2, 4)
    stale(root, "strength_spec")
    assert glance(root)["mutants"] == []


# ------------------------------------------------------------------------------ scope, limits, reproduce


def test_scope_names_edition_hash_what_was_there_and_what_not(root: Path) -> None:
    change(
        root / "spec" / "box" / "clauses.toml",
        'kind = "behaviour"\ndevice = ["box"]',
        'kind = "not modelled"\ndevice = []\nbecause = "colour decides nothing"',
    )
    (one,) = scope.part(gather(root)).data["documents"]
    assert (one["edition"], one["seed"], one["sha256"].value) == ("first", "none", "0" * 64)
    assert one["available"] == ("text",) and one["not_available"] == ("drawings",)
    assert one["left_out"] == [
        {"id": "BX-1-1", "title": "the box shuts", "because": "colour decides nothing"}
    ]
    assert [(row["kind"], row["count"].value) for row in one["kinds"]] == [
        ("not modelled", 1),
        ("property", 1),
    ]
    assert (one["devices"][0]["states"].value, one["devices"][0]["outputs"].value) == (2, 3)


def test_limits_come_from_the_registers_and_then_from_the_page(root: Path) -> None:
    change(root / "spec" / "box" / "assumptions.toml", 'kind = "assumption"', 'kind = "abstraction"')
    data = limits.part(gather(root)).data
    (one,) = data["documents"]
    assert [row["id"] for row in one["abstractions"]] == ["A-01"]
    assert [row["id"] for row in one["findings"]] == ["E-02"]
    assert [row["id"] for row in one["drawings"]] == ["E-01"]
    assert data["text"][1]["pieces"][0] == {"kind": "bold", "text": "Boxes only."}
    (root / "docs" / "limits.md").unlink()
    assert limits.part(gather(root)).troubles[0].status == HOLE


def test_markdown_becomes_data() -> None:
    text = "# A\nb *c*\n\n| x | y |\n|---|---|\n| `1` | [z](w) |\n\n- one\n- two\n\n```\n<b>\n\nend\n```\n"
    kinds = [one["kind"] for one in blocks(text)]
    assert kinds == ["heading", "paragraph", "table", "list", "code"]
    table = blocks(text)[2]
    assert table["rows"] == [[[{"kind": "code", "text": "1"}], [{"kind": "text", "text": "z"}]]]
    assert blocks(text)[4]["text"] == "<b>\n\nend\n" and blocks("") == []


def test_each_piece_of_evidence_has_its_command_and_its_hash(root: Path) -> None:
    data = reproduce.part(gather(root)).data
    rows = {row["id"]: row for row in data["documents"][0]["evidence"]}
    assert rows["MC_Box"]["command"] == "modeproof check box/MC_Box" and not rows["MC_Box"]["stale"]
    assert rows["MC_Box"]["sha256"].value == gather(root).files["build/evidence/box/MC_Box.json"]
    made = {(row["tool"], row["version"]): row["pieces"].value for row in data["made"]}
    assert made["z3", "5.4.0.0"] == len(rows)


def test_the_page_lists_foreign_parts_with_their_licence(root: Path) -> None:
    packages = {one.name: one for one in vendored.packages()}
    assert packages["itables"].licence.startswith("MIT")
    assert "jQuery" in packages["itables"].notices and "DataTables" in packages["itables"].notices
    assert all(one.licence and one.version != "not installed" for one in packages.values())
    html = make(root).html
    assert "SpryMedia" in html and packages["itables"].version in html


def test_another_build_of_the_tables_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "html").mkdir()
    for name in ("dt_bundle.js", "dt_bundle.css"):
        (tmp_path / "html" / name).write_text("var a=1;")
    monkeypatch.setattr(vendored.resources, "files", lambda package: tmp_path)
    vendored.tables.cache_clear()
    with pytest.raises(Unjudged, match="exports no DataTable"):
        vendored.tables()
    vendored.tables.cache_clear()
    monkeypatch.undo()
    script, style = vendored.tables()
    assert b"globalThis.DataTable=" in script and b"export{" not in script and style


# ---------------------------------------------------------------------------------------------- glossary


def test_each_part_links_a_words_first_use_to_its_meaning(root: Path) -> None:
    html = Terms(gather(root)).linked("scope", "<p>the Doors and <a>door</a> and the door</p>")
    assert html == '<p>the <a class="term" href="#term-door">Doors</a> and <a>door</a> and the door</p>'


@pytest.mark.parametrize(
    "html",
    [
        "<code>door</code>",
        '<p title="door">x</p>',
        "<h3>door</h3>",
        '<span class="figure" role="button">door</span>',
        "<svg><text>door</text></svg>",
        "<p>indoors</p>",
        "<p>door.toml</p>",
        "<p>holds</p>",
    ],
)
def test_names_headings_drawings_and_attributes_keep_their_text(root: Path, html: str) -> None:
    assert Terms(gather(root)).linked("scope", html) == html


def test_a_verdict_word_is_one_in_capitals_only(root: Path) -> None:
    with (root / "docs" / "report.toml").open("a") as file:
        file.write('[[term]]\nword = "HOLDS"\nsays = "always"\n')
    html = Terms(gather(root)).linked("scope", "<p>it holds a HOLDS</p>")
    assert html == '<p>it holds a <a class="term" href="#term-holds">HOLDS</a></p>'


def test_after_what_is_left_alone_words_are_found_again(root: Path) -> None:
    html = Terms(gather(root)).linked("scope", "<code>x</code><svg><path d='M'/></svg> door")
    assert html.endswith('<a class="term" href="#term-door">door</a>')


def test_the_glossary_is_escaped_and_its_words_have_anchors(root: Path) -> None:
    html = make(root).html
    assert '<dt id="term-door">' in html and "What a box shuts over &lt;b&gt;." in html


@pytest.mark.parametrize("text", ["[[term", "term = 3", '[[term]]\nword = "x"\n'])
def test_a_damaged_glossary_is_a_hole(root: Path, text: str) -> None:
    (root / "docs" / "report.toml").write_text(text)
    found = glossary.part(gather(root))
    assert [one.status for one in found.troubles] == [HOLE] and found.data["terms"] == []
    assert make(root).status == HOLE


def test_the_glossary_of_this_repository_explains_every_verdict_word() -> None:
    root = Path(__file__).resolve().parents[2]
    sources = gather(root)
    words = {one["word"] for one in glossary.part(sources).data["terms"]}
    schema = json.loads(
        (Path(__file__).resolve().parents[2] / "modeproof/ground/evidence/schema.json").read_text()
    )
    verdicts = set(schema["properties"]["verdict"]["enum"]) - {"UNREACHED", "DIFFERS"}
    assert verdicts <= words
