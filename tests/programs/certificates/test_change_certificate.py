"""Certificates of two programs: checked again without search, and each cheat is noticed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.certificates import change_certificate
from programs.certificates.certificate_folder import NAME, fill
from programs.certificates.equality_certificate import obligations
from programs.certificates.recheck import recheck
from programs.equality.product import Product
from tests.programs.equality.test_two_programs import NEW, OLD, judged


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A certificate of both programs."""
    assert judged(tmp_path, NEW, OLD, "", "--certificate", str(tmp_path / "c"))[0] == 0
    return tmp_path / "c"


def record_of(folder: Path) -> Any:
    """certificate.json as it stands."""
    return json.loads((folder / NAME).read_text("utf-8"))


def test_both_solvers_show_two_programs_again(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["prove-program", "--recheck", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "PROVED, checked again: Main of" in said and "scans from power-up were replayed to each" in said
    assert recheck(folder).answers.count == 6


@pytest.mark.parametrize("name", ["new.st", "old.st"])
def test_a_changed_source_is_not_believed(name: str, folder: Path) -> None:
    path = folder.parent / name
    path.write_text(path.read_text("utf-8") + "\n", "utf-8")
    with pytest.raises(Unjudged, match=rf"{name} has changed since"):
        recheck(folder)


CLAIMS = {
    "unless": ("unless", "on", "compared is not|not the obligation|queries are not"),
    "constant": (
        "constant",
        ["on"],
        "control is not|the form|not the obligation|queries are not|do not lead",
    ),
    "left_out": ("left_out", ["lamp"], "compared is not"),
    "wrap": ("wrap", True, "not the obligation|queries are not"),
    "old_unit": ("old_unit", "Latch", "has no input|had no|has not|no output|has no output"),
}


@pytest.mark.parametrize("name", CLAIMS)
def test_an_edited_claim_is_refused(name: str, folder: Path) -> None:
    key, value, cause = CLAIMS[name]
    record = record_of(folder) | {key: value}
    (folder / NAME).write_text(json.dumps(record), "utf-8")
    with pytest.raises(Unjudged, match=cause):
        recheck(folder)


def test_a_certificate_without_its_relations_shows_nothing(folder: Path) -> None:
    kept, pair, product = change_certificate.read(folder)
    kept.fill(product, change_certificate.claim_of(pair, product, kept.record))
    record = record_of(folder)
    for row, node in zip(record["pairs"], _nodes(product), strict=True):
        row["relations"], node.relations[:] = [], []
    fill(folder, record, {owed.file: owed.text for owed in obligations(product)})
    assert recheck(folder).status == 1


def _nodes(product: Product) -> list[Any]:
    return [product.nodes[pair] for pair in sorted(product.nodes)]


def test_a_difference_has_no_certificate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = NEW.replace("> 10", ">= 10")
    assert judged(tmp_path, wrong, OLD, "", "--certificate", str(tmp_path / "c"))[0] == 1
    assert "certificate none: it is REFUTED" in capsys.readouterr().out
    assert not (tmp_path / "c").exists()


def test_an_input_that_stays_is_part_of_the_claim(tmp_path: Path) -> None:
    new, old = (
        text.replace("PT := T#50ms", "PT := p").replace("n : SINT", "n : SINT; p : TIME; k : INT(2..5) := 3")
        for text in (NEW, OLD)
    )
    binding, place = '[assume]\nconstant = ["p", "k"]\n', tmp_path / "c"
    assert judged(tmp_path, new, old, binding, "--certificate", str(place))[0] == 0
    assert recheck(place).status == 0 and record_of(place)["constant"] == ["p", "k"]
