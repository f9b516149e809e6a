"""The block's `step`, path by path: every call takes exactly one path, and none of them raises."""

from proofs.edm.devices import BLOCK
from proofs.sentences import exactly_one_path
from proofs.theorem import Queries, theorem


@theorem(
    clauses=["EDM-INST-1", "EDM-IN-ACTIVATE"],
    findings=["EDMF-06", "EDMF-12"],
    properties=["EveryCallIsAnswered"],
)
def every_call_takes_exactly_one_path() -> Queries:
    """In every state, with any memory, inputs, times and parameters, exactly one path of `step` applies, and
    it ends with a state and outputs: the priorities make the block deterministic.

    Nothing is assumed about how the memory came about.
    """
    yield from exactly_one_path(BLOCK)
