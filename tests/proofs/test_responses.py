"""Response times: a theorem proves the bound of its row, and no smaller or greater one passes."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest
import z3

from modeproof.ground.places import documents, root
from modeproof.registers import Response, load_responses
from proofs.edm import response_times
from proofs.edm.block_safety import both_are
from proofs.edm.invariant import JUDGE
from proofs.explorer.scanned import Scanned
from proofs.responses import waits_without_end
from proofs.theorem import Theorem, TheoremError, theorems_of
from tests.proofs.block import wrong_answers

STATED = [
    pytest.param(theorem, row, id=row.id, marks=[pytest.mark.long] if row.device == "fplc" else [])
    for document in documents(root())
    if load_responses(root(), document).rows
    for theorem in theorems_of(document)
    for row in theorem.rows()
]


def wrong(row: Response) -> list[Response]:
    """The row with a call more, a call less, and each time more often or not at all; or with a bound."""
    if row.calls is None:
        return [msgspec.structs.replace(row, calls=1, unbounded="")]
    found = [msgspec.structs.replace(row, calls=row.calls + n) for n in (1, -1)]
    for name, often in row.times.items():
        other = {key: value for key, value in row.times.items() if key != name}
        found += [msgspec.structs.replace(row, times={**other, name: often + 1})]
        found += [msgspec.structs.replace(row, times={**other, name: often - 1} if often > 1 else other)]
    return found


def refuses(theorem: Theorem, row: Response) -> bool:
    """The theorem does not prove the row: a question has another answer, or it cannot be asked."""
    try:
        return bool(wrong_answers(theorem.build(row)))
    except TheoremError:
        return True


@pytest.mark.sampled(8)
@pytest.mark.parametrize(("theorem", "row"), STATED)
def test_a_theorem_refuses_every_bound_but_its_own(theorem: Theorem, row: Response) -> None:
    assert not refuses(theorem, row)
    for other in wrong(row):
        assert refuses(theorem, other), (other.calls, other.times)


def test_an_answered_response_is_not_shown_to_wait_for_ever() -> None:
    (row,) = [row for row in load_responses(root(), "edm").rows if row.id == "EDMR-06"]

    def demanded(scan: Scanned) -> z3.BoolRef:
        stuck = z3.And(scan.inputs.Activate, z3.Not(both_are(scan, True)))
        return z3.And(scan.sent.SafetyDemand, stuck)

    assert wrong_answers(waits_without_end(JUDGE, row, demanded, lambda scan: scan.sends.Error))


def test_a_person_is_shown_to_be_waited_for_forever() -> None:
    (row,) = [row for row in load_responses(root(), "edm").rows if row.id == "EDMR-06"]

    def nobody(scan: Scanned) -> z3.BoolRef:
        return z3.And(scan.sent.ResetRequest, z3.Not(scan.inputs.Reset))

    assert not wrong_answers(waits_without_end(JUDGE, row, nobody, lambda scan: scan.inputs.Reset))


def test_every_document_states_its_response_times() -> None:
    assert {document for document in documents(root()) if load_responses(root(), document).rows} == set(
        documents(root())
    )
    assert len(STATED) >= 34


def test_a_theorem_without_its_row_says_so() -> None:
    lost = replace(response_times.a_stop_request_is_answered_in_the_calls_of_its_row, responses=("EDMR-99",))
    with pytest.raises(TheoremError, match=r"spec/edm/properties\.toml has no EDMR-99"):
        lost.queries()
