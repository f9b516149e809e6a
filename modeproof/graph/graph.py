"""The complete graph of one device: from every state, with every input, one step to one state."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Graph:
    """States and inputs are numbered from 0, in the order in which TLC printed them.

    `views` names the states (canonical TLA+ text), `outputs` holds the row of outputs of each state,
    `inputs` the records of the alphabet (`input_numbers` are the numbers that the model gave them), `steps`
    the names of all steps that occur. From state s with input i the device takes the step
    `steps[step_of[s][i]]` to state `next_of[s][i]`. `initial` is the state after power-up.
    """

    source: str
    views: tuple[str, ...]
    outputs: tuple[Mapping[str, Any], ...]
    inputs: tuple[Mapping[str, Any], ...]
    input_numbers: tuple[int, ...]
    steps: tuple[str, ...]
    step_of: tuple[array[int], ...]
    next_of: tuple[array[int], ...]
    initial: int

    @property
    def edges(self) -> int:
        """The number of transitions: states times inputs."""
        return len(self.views) * len(self.inputs)

    def edges_of_steps(self) -> dict[str, int]:
        """How many transitions take each step."""
        counts: Counter[int] = Counter()
        for row in self.step_of:
            counts.update(row)
        return {self.steps[step]: counts[step] for step in range(len(self.steps))}

    def shortest_paths(self) -> tuple[tuple[int, int] | None, ...]:
        """For each state the last move (state before, input) of a shortest way to it from power-up.

        None for the power-up state itself and for a state that cannot be reached. Breadth first and in the
        order of the inputs, so the answer is always the same.
        """
        before: list[tuple[int, int] | None] = [None] * len(self.views)
        seen = bytearray(len(self.views))
        seen[self.initial] = 1
        queue = [self.initial]
        for state in queue:
            for n, after in enumerate(self.next_of[state]):
                if not seen[after]:
                    seen[after] = 1
                    before[after] = (state, n)
                    queue.append(after)
        return tuple(before)
