"""The block's `step`, path by path: every call takes exactly one path, and none of them raises."""

from proofs.enable_switch.devices import SWITCH
from proofs.sentences import exactly_one_path
from proofs.theorem import Queries, theorem


@theorem(clauses=["ES-SEQ-0", "ES-NOTE-1"], findings=["ESF-01", "ESF-04"], properties=["EveryCallIsAnswered"])
def every_call_of_the_switch_takes_exactly_one_path() -> Queries:
    """In every state of the block, with any memory, inputs, times and parameters in their ranges, exactly one
    path of `step` applies, and it ends with a state and outputs.

    So the priorities make the block deterministic. Nothing is assumed about how the memory came about.
    """
    yield from exactly_one_path(SWITCH)
