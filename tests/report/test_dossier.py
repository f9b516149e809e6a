"""What is filed: the first page, safety functions, findings by class, and what they are filed under."""

from __future__ import annotations

import json
import re
import subprocess
from html import unescape
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.report import build
from modeproof.report.bearing import heaviest, worst
from modeproof.report.build import make
from modeproof.report.environment import css_string
from modeproof.report.filing import Filing, commit_of
from modeproof.report.parts import functions, summary
from modeproof.report.sources import DIFFERS, HOLE, Sources, gather
from modeproof.report.terms import Terms
from tests.report.paper import change, entry, make_whole, put, without

ROOT = Path(__file__).resolve().parents[2]


DEMANDS = '[device.box.demand.ShutsOverDoor]\nsays = "x"\nclauses = ["BOX-1"]\nwhen = "x"\nholds = "x"\n'


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The box with all that a report needs; the command line works on it."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    return make_whole(tmp_path)


@pytest.fixture(scope="module")
def ours(tmp_path_factory: pytest.TempPathFactory) -> Sources:
    """The registers of this repository, without any evidence."""
    place = tmp_path_factory.mktemp("ours")
    for folder in ("spec", "docs", "refimpl", "proofs"):
        (place / folder).symlink_to(ROOT / folder)
    return gather(place)


def text_of(html: str) -> str:
    """The words of a piece of a page."""
    return unescape(" ".join(re.sub(r"<[^>]*>", " ", html).split()))


def first_page(root: Path, filing: Filing | None = None) -> str:
    """The words of the first page."""
    html = make(root, filing=filing).html
    return text_of(html[html.index('<section id="summary"') : html.index('<section id="functions"')])


def conclusions(root: Path) -> dict[str, tuple[int, int, int]]:
    """Of each conclusion: good, of, status."""
    found = summary.part(gather(root)).data["conclusions"]
    return {name: (one["good"].value, one["of"].value, one["status"]) for name, one in found.items()}


# ------------------------------------------------------------------------------------------ the first page


def test_the_first_page_names_text_tools_and_the_given_day(root: Path) -> None:
    text = first_page(root, Filing(day="2026-11-23"))
    assert "A box , first." in text and "TLC 2.15, Z3 5.4.0.0" in text and "Date 2026-11-23 " in text
    assert "none was given: modeproof report --date" in first_page(root)


def test_each_conclusion_counts_what_the_evidence_says(root: Path) -> None:
    assert conclusions(root) == {
        "required": (1, 1, 0),
        "readings": (2, 2, 0),
        "program": (1, 1, 0),
        "agreement": (0, 0, 0),
        "faults": (1, 1, 0),
    }
    text = first_page(root)
    assert "Of 2 other readings, each tried alone, 1 break" in text
    assert "1 requirements fail where a fault was planted for them" in text
    assert "Faults by rule were not planted in this text: make exhaustive" in text


def test_a_conclusion_falls_with_its_evidence(root: Path) -> None:
    put(root, "MC_Box", verdict="VIOLATED", as_expected=False, reason="it falls")
    without(root, "NEG_Box_eager")
    found = conclusions(root)
    assert found["required"] == (0, 1, DIFFERS) and found["readings"] == (1, 2, HOLE)
    assert "✗ Not so: The procedures, as decided here" in first_page(root)


def test_nothing_compared_is_no_agreement(root: Path) -> None:
    assert conclusions(root)["agreement"][:2] == (0, 0)
    assert "? Not shown in full: The model and the program are the same" in first_page(root)


def test_troubles_stand_before_the_conclusions(root: Path) -> None:
    for number in range(7):
        put(root, f"MC_{number}", verdict="VIOLATED", as_expected=False, reason="it fell")
    html = make(root).html
    first = html[html.index('id="troubles"') : html.index('class="conclusions"')]
    assert first.count("trouble line") == 4 and first.count("it fell") == 4 + 7


def test_the_heaviest_assumptions_and_worst_findings_are_named(root: Path) -> None:
    text = first_page(root)
    assert "A-01 one door . If not: it shuts on a hand. To be ensured by: the builder." in text
    assert "E-01 does it wait for the door . What can follow: it shuts on a hand." in text
    assert "E-02" not in text


def test_what_most_rests_on_comes_first(ours: Sources) -> None:
    every = heaviest(ours)
    breaks = [len(row.breaks) for _, row in every]
    assert all(row.kind == "assumption" for _, row in every) and breaks[-1] == 0 < breaks[0]
    top = [row for _, row in worst(ours)[:5]]
    assert len({document.name for document, _ in worst(ours)[:5]}) == 5
    assert all(row.severity == "safety" and not row.drawing_could_settle and row.telling for row in top)


def unexplained(page: str, sources: Sources) -> set[str]:
    """Words of a page that it does not explain: abbreviations, names of signals, words of the glossary."""
    body, _, words = page.partition("Words.")
    titles = " ".join(f"{one.about.title} {one.about.edition}" for one in sources.documents.values())
    ids = {row.id for one in sources.documents.values() for row in (*one.findings, *one.assumptions)}
    shouted = set(re.findall(r"[\w-]*[A-Z][\w-]*[A-Z_][\w-]*", page)) - ids - {"FALSE", "YYYY-MM-DD"}
    told = {word for word in shouted if re.search(rf"(?<!\w){re.escape(word)} [A-Z]", words)}
    asked = re.findall(r"<dfn>(.*?)</dfn>", Terms(sources).explained(body))
    lost = {word for word in shouted - told if word not in titles and word not in words}
    return lost | {word for word in asked if f"{word} " not in words}


def test_every_word_on_the_first_page_is_explained_there(ours: Sources) -> None:
    page = build._rendered(summary.part(ours), ()) + " ".join(summary.ENGINES.values())
    assert unexplained(text_of(f"{page} {Terms(ours).explained(page)}"), ours) == set()


def test_a_word_that_is_not_explained_would_be_found(ours: Sources) -> None:
    assert unexplained("The FOOBAR of a theorem. Words. PLC A controller.", ours) >= {"FOOBAR", "theorem"}


def test_meanings_explain_the_words_that_they_use(root: Path) -> None:
    with (root / "docs" / "report.toml").open("a") as file:
        file.write('[[term]]\nword = "hatch"\nsays = "A door that has a LAMP."\n')
    html = Terms(gather(root)).explained("<p>the hatch</p>")
    assert re.findall("<dfn>(.*?)</dfn>", html) == ["door", "hatch", "LAMP"] and "&lt;b&gt;" in html


# ------------------------------------------------------------------------------------ filed under, printed


@pytest.mark.parametrize("day", ["tomorrow", "2026-13-01", "</style>", ""])
def test_a_day_that_is_none_is_refused_in_one_line(
    root: Path, day: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["report", f"--date={day}"]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1 and "is no day; give it as in 2026-11-23" in err


def test_the_commit_is_that_of_the_tree_and_says_changes(root: Path) -> None:
    assert commit_of(root) == ""

    def git(*words: str) -> str:
        names = ["-c", "user.name=x", "-c", "user.email=x@y"]
        return subprocess.run(
            ["git", "-C", str(root), *names, *words], check=True, capture_output=True, text=True
        ).stdout.strip()

    git("init", "-q")
    assert commit_of(root) == "", "there is no commit yet"
    git("add", "spec")
    git("commit", "-qm", "x")
    assert commit_of(root) == git("rev-parse", "HEAD")[:12]
    assert commit_of(root / "spec") == "", "a folder of a tree has no commit of its own"
    change(root / "spec/box/Box.tla", "it shuts", "it shuts now")
    assert commit_of(root).endswith(", and files changed since")


def test_foreign_text_cannot_leave_its_place_in_the_style(root: Path) -> None:
    change(root / "spec/box/clauses.toml", 'title = "A box"', "title = '\"; } </style><b>'")
    html = make(root).html
    assert r'@top-left { content: "\22 \3b  \7d  \3c /style\3e \3c b\3e "; }' in html
    assert css_string('a"\\\n') == r'"a\22 \5c \a "'


def test_a_report_of_one_document_has_its_own_folder(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "spec" / "lid").mkdir()
    (root / "spec/lid/interface.toml").write_text("damaged")
    other = json.loads((root / "build/evidence/box/MC_Box.json").read_text())
    other["tools"]["modeproof"] = {"version": "0", "sha256": "0" * 64}
    (root / "build/evidence/lid").mkdir()
    (root / "build/evidence/lid/MC_Lid.json").write_text(json.dumps(other))
    assert main(["report", "--quiet", "--document", "box", "--date", "2026-11-23"]) == 0
    page = root / "build/report/box/report.html"
    assert "spec/lid" not in page.read_text() and 'href="../../simulate.html#' in page.read_text()
    assert str(page) in capsys.readouterr().out
    assert main(["report", "--verify", str(page)]) == 0, "the other document is no news to it"
    assert main(["report", "--verify", str(page.with_suffix(".json"))]) == 0
    assert main(["report", "--document", "bx"]) == 2
    assert "unknown document 'bx'; did you mean" in capsys.readouterr().err


def test_making_it_says_which_part_and_how_much_there_is(root: Path) -> None:
    said: list[tuple[str, float]] = []
    make(root, said=lambda part, share: said.append((part, share)))
    shares = [share for _, share in said]
    assert said[0] == ("evidence", 0) and shares == sorted(shares) and 0.9 < shares[-1] < 1
    assert "traces" in dict(said)


# -------------------------------------------------------------------------------------- safety functions


def test_a_safety_function_has_hazard_evidence_and_who_confirms(root: Path) -> None:
    (row,) = entry(functions, root)["rows"]
    assert (row["hazard"], row["title"]) == ("It shuts on a hand.", "it shuts over the door")
    assert row["evidence"] == {
        "good": True,
        "searched": ["arbitrary"],
        "proved": True,
        "wrong": [],
        "aside": False,
    }
    assert row["assumptions"] == [{"id": "A-01", "title": "one door", "who": "the builder"}]
    assert row["row"] == "box ShutsOverDoor"


def test_functions_come_from_demands_and_from_assumptions_that_break(root: Path) -> None:
    change(root / "spec/box/assumptions.toml", 'breaks = ["NEG_Box_hasty"]', 'breaks_open = "no"')
    assert entry(functions, root)["rows"] == [] and entry(functions, root)["others"] == 1
    (root / "spec/box/demands.toml").write_text(DEMANDS)
    assert [row["id"] for row in entry(functions, root)["rows"]] == ["ShutsOverDoor"]


def test_a_function_without_its_evidence_is_not_good(root: Path) -> None:
    without(root, "it_shuts_over_the_door_only")
    (row,) = entry(functions, root)["rows"]
    assert (row["evidence"]["good"], row["evidence"]["wrong"]) == (None, ["a proof: not there"])
    put(root, "MC_Box", verdict="VIOLATED", as_expected=False, reason="it falls", result={"violated": "x"})
    (row,) = entry(functions, root)["rows"]
    assert row["evidence"]["good"] is False and row["evidence"]["searched"] == []


@pytest.mark.deep
def test_every_hazard_function_and_confirmer_of_this_repository_is_named(ours: Sources) -> None:
    documents = functions.part(ours).data["documents"]
    rows = [row for document in documents for row in document["rows"]]
    assert len(rows) > 50 and {document["id"] for document in documents if not document["rows"]} == set()
    assert [row["id"] for row in rows if not (row["hazard"] and row["sentence"] and row["row"])] == []
    assert [one["id"] for row in rows for one in row["assumptions"] if not one["who"]] == []


# ------------------------------------------------------------------------------------- findings by class


def test_findings_stand_by_class_the_worst_first(root: Path) -> None:
    html = make(root).html
    order = [html.index(f'id="finding-{id}"') for id in ("E-01", "E-02")]
    assert order == sorted(order) and html.index("a drawing could settle it</h3>") < order[0]
    assert html.index("Not judged by a run: no reading") < order[1]


def test_a_finding_names_the_shortest_ways_and_what_is_missing(root: Path) -> None:
    finding = text_of(make(root).html.partition('id="finding-E-01"')[2].partition("<details")[0])
    assert "the other reading fails, as predicted in 1 step ( NEG_Box_eager ) and in 1 step (" in finding
    assert "1 more run as expected" in finding and "VIOLATED" not in finding
    without(root, "NEG_Box_eager")
    finding = text_of(make(root).html.partition('id="finding-E-01"')[2].partition("<details")[0])
    assert "? not there : 1 of its runs and proofs" in finding
