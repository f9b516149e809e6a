"""The dossier about a user's project: what is wrong stands first, what is stale counts for nothing."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.evidence import sha256
from modeproof.ground.progress import Progress
from modeproof.output.outcome import File, Outcome, read, write
from modeproof.project import basis
from modeproof.project import file as project_file
from modeproof.project.judging import Judging
from tests.output.outcomes import FOREIGN, outcome

PROJECT = """version = 1
[program.good]
files = ["plc/good.st"]
target = "sf_edm"
[program.bad]
files = ["plc/bad.st"]
target = "sf_edm"
[program.never]
files = ["plc/good.st"]
target = "sf_edm"
"""


def file_of(path: Path, project: Path) -> File:
    return File(path=path.relative_to(project).as_posix(), sha256=sha256(path), role="program")


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with a program that stands, one that does not, and one that nobody judged."""
    place = tmp_path / "press"
    (place / "plc").mkdir(parents=True)
    (place / "modeproof.toml").write_text(PROJECT, "utf-8")
    for name in ("good", "bad"):
        (place / f"plc/{name}.st").write_text(name, "utf-8")
    records = place / ".modeproof/records"
    good = outcome(word="PROVED", status=0, sentence="PROVED: good", demands=[])
    keep(records / "good.json", good, file_of(place / "plc/good.st", place))
    keep(records / "bad.json", outcome(), file_of(place / "plc/bad.st", place))
    monkeypatch.chdir(place)
    return place


def keep(path: Path, found: Outcome, *files: File) -> None:
    changed = {name: getattr(found, name) for name in found.__struct_fields__} | {"files": list(files)}
    write(path, Outcome(**changed))


def made(project: Path, *words: str) -> tuple[int, str]:
    status = main(["report", "--date", "2026-11-24", *words])
    return status, (project / ".modeproof/report/dossier.html").read_text("utf-8")


def states(project: Path) -> dict[str, str]:
    main(["report", "--json", str(project / "states.json")])
    rows = json.loads((project / "states.json").read_text("utf-8"))["entries"]
    return {row["name"]: row["state"] for row in rows}


def test_what_is_wrong_stands_first(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, page = made(project)
    assert status == 1
    assert states(project) == {"bad": "failed", "never": "open", "good": "stands"}
    assert list(states(project)) == ["bad", "never", "good"]
    names = enumerate(("bad", "never", "good"), 1)
    order = [page.index(f'id="entry-{number}-title">{name}') for number, name in names]
    assert order == sorted(order)
    assert "never judged" in capsys.readouterr().out


def test_a_changed_or_lost_file_makes_a_verdict_stale(project: Path) -> None:
    assert states(project)["good"] == "stands"
    (project / "plc/good.st").write_text("changed", "utf-8")
    assert states(project)["good"] == "stale"
    _, page = made(project)
    assert "plc/good.st has changed since" in page
    first = page.partition('id="entry-1"')[0]
    assert re.search(r'hole"><span aria-hidden="true">\?</span> PROVED', first)  # no tick for what is stale
    (project / "plc/good.st").unlink()
    assert states(project)["good"] == "stale"
    _, page = made(project)
    assert "plc/good.st is gone" in page


def test_a_row_that_changed_makes_a_verdict_stale(project: Path) -> None:
    file = project / "modeproof.toml"
    listed = project_file.read(file, file.name)
    judging = Judging(listed, 1, Progress(quiet=True), lambda line: None)
    record = project / ".modeproof/records/good.json"
    basis.keep("good", judging.basis(listed.entries[0]), read(record))
    assert states(project)["good"] == "stands"
    file.write_text(PROJECT.replace('target = "sf_edm"', 'target = "sf_edm"\nseconds = 5', 1), "utf-8")
    assert states(project)["good"] == "stale"
    assert "what modeproof.toml says of it has changed" in made(project)[1]


def test_a_record_that_was_edited_counts_for_nothing(project: Path) -> None:
    path = project / ".modeproof/records/bad.json"
    text = path.read_text("utf-8").replace('"REFUTED"', '"PROVED"').replace('"status": 1', '"status": 0')
    path.write_text(text, "utf-8")
    assert states(project)["bad"] == "open"
    status, page = made(project)
    assert status == 2
    assert "it was changed since it was written" in page


def test_only_when_all_stands_the_status_is_0(project: Path) -> None:
    for name in ("bad", "never"):
        shutil.copy(project / ".modeproof/records/good.json", project / f".modeproof/records/{name}.json")
    assert made(project)[0] == 0
    (project / "modeproof.toml").write_text("version = 1\n[nothing]\n", "utf-8")
    status, page = made(project)
    assert status == 2
    assert "unknown key" in page


def test_a_difference_has_clause_line_diagram_and_command(project: Path) -> None:
    _, page = made(project)
    assert "plc/my lamp.st, line 7" in page
    assert "AB-1" in page and "The lamp follows the key" in page
    assert page.count('class="td"') == 1
    assert "modeproof judge bad" in page
    assert "Wrong: Lamp is FALSE, expected TRUE" in page
    assert "prefers-color-scheme" not in page


def test_the_page_is_alone_and_the_same_again(project: Path) -> None:
    _, page = made(project)
    assert page == made(project)[1]
    assert not re.search(r'(?:src|href)="(?!#|data:)', page)
    assert "<script" not in page
    assert str(project) not in page


def test_foreign_text_is_text(project: Path) -> None:
    text = FOREIGN.encode("utf-8", "replace").decode()
    found = outcome(subject=text, sentence=text, not_shown=[text], target=text, again=text)
    keep(project / ".modeproof/records/bad.json", found, file_of(project / "plc/bad.st", project))
    _, page = made(project)
    assert "<script" not in page


def test_an_empty_folder_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["report"]) == 2
    assert "nothing was judged here yet" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_record_by_hand_stands_in_it_too(project: Path) -> None:
    keep(project / ".modeproof/records/by-hand.json", outcome(), file_of(project / "plc/bad.st", project))
    assert states(project)["by-hand"] == "failed"
    assert read(project / ".modeproof/records/by-hand.json").word == "REFUTED"


def test_in_the_checkout_it_is_the_assessors(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["report", "--help"])
    assert "--review" in capsys.readouterr().out
