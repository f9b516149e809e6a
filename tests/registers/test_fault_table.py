"""The register of faults: every class has a row, every row names what exists."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from modeproof.ground.places import documents, root
from modeproof.registers import load_document
from modeproof.registers.fault_table import check_faults
from modeproof.registers.rows import Document, Fall, Fault, Matrix


@pytest.fixture(scope="module")
def document() -> Document:
    """The first document of the repository that has the register."""
    return next(one for one in (load_document(root(), name) for name in documents(root())) if one.faults)


def changed(document: Document, **fields: object) -> Document:
    """The document with its first fault changed."""
    first: Fault = msgspec.structs.replace(document.faults[0], **fields)
    return replace(document, faults=(first, *document.faults[1:]))


def texts(document: Document) -> str:
    return "\n".join(map(str, check_faults(document)))


def test_the_register_of_the_repository_is_complete(document: Document) -> None:
    assert texts(document) == ""


def test_a_class_without_a_row_is_found(document: Document) -> None:
    kind = document.faults[-1].kind
    left = tuple(one for one in document.faults if one.kind != kind)
    assert f"{kind}: no row" in texts(replace(document, faults=left))


def test_a_row_that_names_no_run_must_say_why(document: Document) -> None:
    bare = {"runs": (), "falls": (), "holds": ()}
    assert "names no run" in texts(changed(document, **bare))
    assert texts(changed(document, **bare, not_modelled="it cannot happen")) == ""


def test_unknown_runs_and_properties_are_found(document: Document) -> None:
    assert "unknown run 'MC_Nothing'" in texts(changed(document, runs=("MC_Nothing",)))
    assert "unknown property 'Nothing'" in texts(changed(document, holds=("Nothing",)))


def test_a_run_that_shows_something_else_is_found(document: Document) -> None:
    falls = [fall for one in document.faults for fall in one.falls]
    first, other = falls[0], next(fall for fall in falls if fall.property != falls[0].property)
    wrong = Fall(property=first.property, run=other.run, needs="nothing")
    assert f"{other.run} does not show that {first.property} fails" in texts(
        changed(document, falls=(wrong,))
    )


def test_a_property_unchecked_by_its_row_is_found(document: Document) -> None:
    checked = {name for run in document.runs if run.id in document.faults[0].runs for name in run.properties}
    other = next(one.id for one in document.properties if one.tla not in checked)
    assert f"none of its runs checks {other}" in texts(changed(document, holds=(other,)))


def test_a_matrix_whose_run_has_no_cells_is_found(document: Document) -> None:
    assert "no run whose witnesses are cells" in texts(
        replace(document, matrix=Matrix(run="MC_Nothing", title="copy"))
    )
