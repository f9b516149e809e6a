"""The block's `step`, path by path: every call takes exactly one path, and none of them raises."""

from proofs.guard_locking.devices import BLOCK
from proofs.sentences import exactly_one_path
from proofs.theorem import Queries, theorem


@theorem(clauses=["GL-SEQ-NOTE"], findings=["GLF-01", "GLF-12"], properties=["EveryCallIsAnswered"])
def every_call_takes_exactly_one_path() -> Queries:
    """In every state, with any memory, inputs and parameters, exactly one path of `step` applies, and it ends
    with a state and outputs: the priorities make the block deterministic.

    Nothing is assumed about how the memory came about.
    """
    yield from exactly_one_path(BLOCK)
