"""All suites: a function that yields the cases of a graph, and what the header says of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from modeproof.graph.device import DeviceGraph
from modeproof.kit.vectors import EXACT, MONITOR, SETTLED
from modeproof.suites import parameters, refusals, sequences, sic, soak, times, words
from modeproof.suites.script import Plan
from modeproof.suites.tour import every_step, every_transition
from modeproof.suites.walks import covering, telling


@dataclass(frozen=True)
class Kind:
    """A suite: its `plan` yields the cases of a graph, and the header says the rest.

    `counted_by` is what makes a transition besides state and step: the column or the next state. `relations`
    are those by which a program can be judged with it, the closest first; `fast` suites end within a minute
    or so, and one that is slow is `published` all the same if it says so. Not `always` is there a suite of
    every target. `variants` gives the graphs that are walked for those of the OPEN runs; with `pairs` these
    are joined by graphs at which each value of each parameter is there with each of each other.
    """

    plan: Plan
    guarantees: str
    hypothesis: str
    does_not_show: str
    counted_by: str
    relations: tuple[str, ...] = (EXACT, MONITOR)
    fast: bool = True
    always: bool = True
    published: bool = True
    variants: Callable[[Sequence[DeviceGraph]], list[DeviceGraph]] = list
    pairs: bool = False


SUITES = {
    "tour": Kind(
        plan=covering(every_transition, bounded=True),
        guarantees="every transition of the specification's graph with merged input columns is taken",
        hypothesis="the program treats all inputs of a column alike; members take turns, not all are tried",
        does_not_show="a memory of the program beyond the states of the graph; inputs that were not used",
        counted_by="column",
        fast=False,
        published=False,
    ),
    "brief": Kind(
        plan=covering(every_step),
        guarantees="from every state of the specification every step to every next state is taken",
        hypothesis="the program treats all inputs alike that lead from one state by one step to one state",
        does_not_show="what `tour` shows besides: every column in every state",
        counted_by="next state",
    ),
    "wp": Kind(
        plan=telling,
        guarantees=(
            "a program with at most n states (k = 0 more than the graph) that treats all inputs of a column "
            "alike and passes is equal to the graph, over all columns; n is under `complete` of each "
            "graph; a column is a set of inputs that take the graph by the same step to the same state from "
            "whatever state, time included; `modeproof vectors lint` proves this from the file alone"
        ),
        hypothesis=(
            "the program has at most n states, counted as an observer of its outputs would count them, and "
            "treats all inputs of a column alike; members take turns, not all are tried"
        ),
        does_not_show=(
            "a program that remembers more than n states; inputs of a column that were not used; that a "
            "reset is one is taken for granted"
        ),
        counted_by="column",
        fast=False,
        published=False,
    ),
    "words": Kind(
        plan=words.plan,
        guarantees=(
            "in every control state where a word decides, the one-bit neighbours of every code that decides "
            "there, its swapped bytes, complement and shifts, and the boundaries are tried; in one of these "
            "control states each word that agrees with the code in one byte only; after each, inputs follow "
            "by which outputs tell the right state from the one that the code leads to"
        ),
        hypothesis=(
            "the program compares a word in one way in all states of a control state, and a word that agrees "
            "with a code in one byte in one way in all control states"
        ),
        does_not_show="each of the 65,536 words in each state; two wrong words at once",
        counted_by="next state",
        always=False,
    ),
    "refusals": Kind(
        plan=refusals.plan,
        guarantees=(
            "each form of request that protocol 1 forbids is sent once, in a control state where it would "
            "change the state without its fault; and in every control state well-formed inputs that no "
            "adapter may refuse are answered by the program as specified"
        ),
        hypothesis="the adapter checks a request in one way, whatever the program behind it is doing",
        does_not_show="every combination of faults in one request; what the program does besides",
        counted_by="next state",
        relations=(EXACT,),
    ),
    "sic": Kind(
        plan=sic.plan,
        guarantees=(
            "inputs change one at a time and are held until all has settled; every step from every state to "
            "every next state that such changes can take is taken, and each value that leads out of a state "
            "with each settled row of outputs there; the header lists the others; the diagrams of "
            "`sequences` are walked with single changes"
        ),
        hypothesis="the program settles in the scans given, and treats all inputs of a column alike",
        does_not_show="what outputs are while they settle; the transitions that single changes do not reach",
        counted_by="next state",
        relations=(EXACT, SETTLED, MONITOR),
    ),
    "times": Kind(
        plan=times.plan,
        guarantees=(
            "in every control state where time passes, the time of one scan is sent in pieces too, to the "
            "millisecond; and where a state stays as it is, it is held for more than 32,768 ms and for about "
            "65,536 ms; after each, inputs follow by which outputs tell the right state from the same "
            "control state at another time"
        ),
        hypothesis="the program counts time in one way in all states of a control state",
        does_not_show="every split of every time; waits of days",
        counted_by="next state",
        always=False,
    ),
    "sequences": Kind(
        plan=sequences.plan,
        guarantees=(
            "the document's diagrams are walked as drawn: every good flow, and every other ending that is "
            "printed, from power-up; the clauses that a case is about are those of its boxes"
        ),
        hypothesis="none beyond these inputs: they are examples",
        does_not_show="anything off the ways that are drawn",
        counted_by="next state",
        always=False,
    ),
    "parameters": Kind(
        plan=parameters.plan,
        guarantees=(
            "each choice of a parameter is there with each choice of each other one; times are odd, a few "
            "milliseconds, above 65,535 ms, and the longest allowed, in scans as long; what has its default "
            "is not sent; at each, every step of every control state is taken at every time in it"
        ),
        hypothesis="the program treats parameters alike that are in proportion to the times of the scans",
        does_not_show="each value of each parameter; three choices at once; a change while the program runs",
        counted_by="column",
        variants=parameters.variants,
        pairs=True,
    ),
    "soak": Kind(
        plan=soak.plan,
        guarantees=(
            "in control states nothing changes for 300 scans, and in some for 66,000; for each step "
            "a way round that "
            "takes it is gone 300 times, and a shortest one 66,000 times; 100,000 scans mix "
            "them; after each, "
            "every step of every control state is taken, and no reset comes between"
        ),
        hypothesis="what a program counts beside the specification are scans or rounds, in 16 bits at most",
        does_not_show="counters of 32 bits; a combination of rounds that does not occur; days",
        counted_by="next state",
        variants=soak.first,
        fast=False,
        always=False,
    ),
}
"""All suites by name."""
