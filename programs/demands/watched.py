"""A subject beside the observer of its demands, as a transition system; and the same with plain values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import z3

from modeproof.ground.errors import Unjudged
from modeproof.kit.demands import Demand, Demands, Watch
from programs.demands.assumptions import Assumed
from programs.demands.observer import LATENCY, Observer
from programs.demands.subject import Step, Subject, Wires, plain_value
from programs.equality.replay import Run
from programs.invariants.induction import System, conjuncts
from programs.semantics.terms import TRUE


@dataclass(frozen=True)
class Broken:
    """A demand, and the scans of which the last breaks it; `stopped`: the program stops in it."""

    run: Run
    steps: tuple[Step, ...]
    found_by: str
    stopped: str = ""


@dataclass(frozen=True)
class Beside:
    """A subject with the demands on it. latency: scans that a reaction may take."""

    subject: Subject
    demands: Demands
    assumed: Assumed
    latency: int = LATENCY

    @cached_property
    def wires(self) -> Wires:
        """The wires of the subject."""
        return Wires(self.subject, self.assumed.constant)

    @cached_property
    def rows(self) -> tuple[Demand, ...]:
        """The demands that rest on what is observed alone."""
        return tuple(row for row in self.demands.rows if row.outputs <= {*self.wires.terms})

    @cached_property
    def unjudged(self) -> tuple[Demand, ...]:
        """The demands that rest on an output that is not observed."""
        return tuple(row for row in self.demands.rows if row not in self.rows)

    @cached_property
    def observer(self) -> Observer:
        """What watches the wires."""
        return Observer(self.demands, self.rows, self.wires.terms, self.wires.parameters, self.latency)

    @cached_property
    def watched(self) -> Any:
        """One scan of the observer as terms."""
        return self.observer.terms(self.wires.terms, self.wires.dt_ms)

    @cached_property
    def system(self) -> System:
        """Both, as one scan over symbols."""
        wires, subject = self.wires, self.subject
        own = {
            name: (symbol, first, self.watched.after[name])
            for name, (symbol, first) in self.observer.state.items()
        }
        own |= self.assumed.memory
        held, free = wires.ranges
        free = [*free, *self.assumed.formulas]
        state = {**subject.state, **wires.steady, **{name: symbol for name, (symbol, _, _) in own.items()}}
        start = {
            **subject.start,
            **dict.fromkeys(wires.steady),
            **{name: first for name, (_, first, _) in own.items()},
        }
        after = {
            **{name: wires.put(term) for name, term in subject.after.items()},
            **wires.steady,
            **{name: z3.simplify(term) for name, (_, _, term) in own.items()},
        }
        fits = [*(wires.put(part) for part in subject.fits), *held]
        return System(
            state,
            wires.inputs,
            start,
            after,
            z3.And([TRUE, *free]),
            wires.put(subject.inside),
            z3.And([TRUE, *(part for whole in fits for part in conjuncts(whole))]),
        )

    def bad(self, id: str) -> z3.BoolRef:
        """The scans that break a demand."""
        found: z3.BoolRef = z3.simplify(z3.And(self.system.inside, self.watched.broken[id]))
        return found

    def asked(self, id: str) -> z3.BoolRef:
        """The scans in which a demand is asked."""
        found: z3.BoolRef = z3.simplify(z3.And(self.system.inside, self.watched.asked[id]))
        return found

    def check(self) -> None:
        """Raises Unjudged: no run fulfils what is assumed."""
        solver = z3.Solver()
        solver.add(self.system.first, self.system.assumed, self.system.within)
        if solver.check() != z3.sat:
            raise Unjudged("[assume]: no run fulfils it")

    # ------------------------------------------------------------ with plain values

    def watch(self, run: Run, only: Sequence[str] | None = None) -> Watch:
        """The kit's own reading of the demands, at power-up."""
        found = Watch(self.demands, self.latency, self.unobserved)
        if only is not None:
            found.judged = tuple(row for row in found.judged if row.id in only)
        found.reset(self.subject.reference.to_wire("parameters", run.parameters))
        return found

    @property
    def unobserved(self) -> tuple[str, ...]:
        """The outputs that are not observed."""
        return tuple(name for name in self.demands.outputs if name not in self.wires.terms)

    def broken(self, run: Run, id: str, found_by: str) -> Broken | None:
        """The scans up to the one that breaks a demand; None: none does. An empty id: the program stops."""
        watch, steps = self.watch(run, [id]), list[Step]()
        for number, step in enumerate(self.subject.run(run), 1):
            steps.append(step)
            if step.stopped:
                return None if id else Broken(run.upto(number), tuple(steps), found_by, step.stopped)
            if watch.scan(step.dt_ms, step.inputs, step.outputs) is not None:
                return Broken(run.upto(number), tuple(steps), found_by)
        return None

    def samples(self, run: Run) -> Iterator[Mapping[str, Any]]:
        """The memory of the subject and of the observer after each scan, by the names of the symbols."""
        observer, of = self.observer, self.subject.reference
        memory: Mapping[str, Any] = {
            name: z3.is_true(one) if z3.is_bool(one) else one.as_long()
            for name, (_, one) in observer.state.items()
        }
        given = of.to_wire("parameters", run.parameters)
        signals = {**of.signals("inputs"), **of.signals("outputs")}
        parameters = of.signals("parameters")
        steady = {of.name: plain_value(of, given[name]) for name, of in parameters.items() if name in given}
        held = self._held(run)
        slow = dict.fromkeys(self.assumed.memory, 0)  # nothing is sampled of these
        for step in self.subject.run(run):
            if step.stopped:
                return
            wires = {
                signals[name].name: plain_value(signals[name], value)
                for name, value in {**step.inputs, **step.outputs}.items()
            }
            memory = observer.plain(wires, steady, memory, step.dt_ms).after
            yield {**{name: step.memory[name] for name in self.subject.state}, **held, **memory, **slow}

    def _held(self, run: Run) -> dict[str, Any]:
        """What is steady, by the names of the symbols."""
        of = self.subject.reference
        found: dict[str, Any] = {}
        inputs = run.scans[0][1] if run.scans else {}
        for group, values, terms in (
            ("parameters", run.parameters, of.parameter_terms),
            ("inputs", inputs, of.input_terms),
        ):
            for name, signal in of.signals(group).items():
                if name not in values:
                    continue
                if signal.type == "modes":
                    found |= {str(terms[f"{name}[{mode}]"]): values[name][mode] for mode in range(5)}
                elif signal.type == "text":
                    found[str(terms[name])] = signal.values.index(values[name])
                elif name in terms:
                    found[str(terms[name])] = values[name]
        return {name: value for name, value in found.items() if name in self.wires.steady}
