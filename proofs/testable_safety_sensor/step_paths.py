"""The block's `step`, path by path: every call takes exactly one path, and none of them raises."""

from proofs.sentences import exactly_one_path
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.theorem import Queries, theorem


@theorem(
    clauses=["TSS-IN-ACTIVATE", "TSS-IN-TESTTIME"], findings=["TSSF-27"], properties=["EveryCallIsAnswered"]
)
def every_call_of_the_block_takes_exactly_one_path() -> Queries:
    """In every state of the block, with any memory, inputs, times and TestTime, exactly one path of `step`
    applies, and it ends with a state and outputs: the priorities of each state make the block deterministic.

    TestTime is any number that a TIME can hold, also a negative one. Nothing is assumed about how the memory
    came about.
    """
    yield from exactly_one_path(SENSOR)
