"""A device whose inputs need several scans to have all their effects, its suites, and programs for it.

`go` arms it in one scan and fires it in the next; after 500 ms it expires. Without `go` it is lowered and
then released. It is small enough to say by hand which step changes which output.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from modeproof.kit.ids import case_id
from modeproof.kit.signals import Signal
from modeproof.kit.vectors import Case, Scan, Step, Suite, changes

OFF, ARMED, FIRED, LOWERED, SPENT = range(5)
STEPS = ("Stay", "Arm", "Fire", "Hold", "Lower", "Release", "Expire")
TRANSITIONS = (2, 1, 1, 1, 2, 1, 1)
ROWS = {
    OFF: {"A": False, "B": False, "CODE": "0000"},
    ARMED: {"A": True, "B": False, "CODE": "0001"},
    FIRED: {"A": True, "B": True, "CODE": "0002"},
    LOWERED: {"A": False, "B": True, "CODE": "0003"},
    SPENT: {"A": False, "B": False, "CODE": "0004"},
}
DEMANDS = {
    "constants": {},
    "rules": [{"name": "asked", "kind": "recent", "is": "go"}],
    "demands": [
        {
            "id": "BNeedsGo",
            "says": "B.",
            "clauses": ["S-9"],
            "when": "B and not was_B",
            "holds": "True in asked",
        },
        {"id": "AFirst", "says": "A.", "clauses": ["S-8"], "when": "B and not was_B and A", "holds": "was_A"},
        {
            "id": "BLasts",
            "says": "BL.",
            "clauses": [],
            "when": "was_A and was_B and not A and B",
            "holds": "not go or True",
        },
    ],
}


@dataclass
class Stages:
    """The device itself: one call is one scan."""

    limit_ms: int = 500
    state: int = OFF
    elapsed: int = 0

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> tuple[int, int]:
        """The number of the step, and the state after it."""
        go, before = inputs["go"], self.state
        self.elapsed = self.elapsed + dt_ms if before == FIRED else 0
        if before == OFF:
            name, self.state = ("Arm", ARMED) if go else ("Stay", OFF)
        elif before == ARMED:
            name, self.state = ("Fire", FIRED) if go else ("Lower", LOWERED)
        elif before == FIRED:
            name, self.state = ("Hold", FIRED) if go else ("Lower", LOWERED)
            if go and self.elapsed >= self.limit_ms:
                name, self.state = "Expire", SPENT
        elif before == LOWERED:
            name, self.state = "Release", OFF
        else:
            name, self.state = ("Stay", SPENT) if go else ("Release", OFF)
        return STEPS.index(name), self.state


class Program:
    """The right program in this process. What is worked out stands on the outputs `delay` scans later."""

    delay = 0
    says: Mapping[str, Any] = {}
    keeps_answers = False

    def __init__(self) -> None:
        self.closed = self.resets = 0
        self.reset({})

    def hello(self, target: str) -> Mapping[str, Any]:
        relations = ["settled"] if self.delay else ["exact"]
        return {
            "ok": True,
            "name": "stages",
            "relations": relations,
            "max_latency_scans": self.delay,
            **self.says,
        }

    def reset(self, params: Mapping[str, Any]) -> None:
        self.resets += 1
        self.device = Stages(params.get("T_ms", 500))
        self.count = 0
        self.late = [ROWS[OFF]] * self.delay

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.count += 1
        _, state = self.device.scan(dt_ms, inputs)
        self.late.append(ROWS[state])
        return dict(self.shown(self.late.pop(0)))

    def shown(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        return row

    def close(self) -> None:
        self.closed += 1


class Spoiled(Program):
    """Shows other values in some scans: by the number of the scan since reset, output and value."""

    def __init__(self, faults: Mapping[tuple[int, str], Any], delay: int = 0, **says: Any) -> None:
        self.faults, self.delay, self.says = faults, delay, says
        super().__init__()

    def shown(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        return {name: self.faults.get((self.count, name), value) for name, value in row.items()}


@dataclass(frozen=True)
class Given(Suite):
    """A suite whose cases are here and in no file."""

    given: tuple[Case, ...] = field(default=())

    def cases(self) -> Iterator[Case]:
        yield from self.given


def case(moves: Sequence[tuple[int, bool, bool]], why: str = "by hand", reset: bool = True) -> Case:
    """A case of the device: for each scan its ms, `go`, and whether it is compared."""
    device, scans = Stages(), []
    for dt_ms, go, compared in moves:
        step, to = device.scan(dt_ms, {"go": go})
        scans.append(Scan(dt_ms, {"go": go}, dict(ROWS[to]), step, to, 2 * to + go, compared))
    return Case(case_id("stages", {}, changes(scans)), why, "document", (), {}, 0, OFF, tuple(scans), reset)


def requested(of: Case, at: int, request: str = "?") -> Case:
    """The case with a request that must be refused before scan `at`."""
    before = of.scans[at - 1] if at else replace(of.scans[0], outputs=ROWS[OFF], to=OFF)
    scans = (*of.scans[:at], replace(before, dt_ms=0, request=request), *of.scans[at:])
    return replace(of, id=f"{of.id}-refuse", why=f"refused: {request}", scans=scans)


def suite(
    cases: Sequence[Case],
    relations: Sequence[str] = ("exact", "monitor"),
    demands: Mapping[str, Any] | None = DEMANDS,
    **header: Any,
) -> Given:
    """A suite of these cases."""
    head = {"graphs": [{"params": {}, "initial": OFF, "views": [f'"{n}"' for n in range(5)]}], **header}
    if demands is not None:
        head["demands"] = demands
    return Given(
        path=Path("stages.jsonl"),
        header=head,
        target="stages",
        document="toy",
        name="by hand",
        relations=tuple(relations),
        inputs={"go": Signal("go", "bool")},
        outputs={
            "A": Signal("A", "bool"),
            "B": Signal("B", "bool"),
            "CODE": Signal("CODE", "word", project=True),
        },
        parameters={"T_ms": {"type": "ms", "default": 500}, "N": {"type": "int", "default": 3}},
        steps=tuple(
            Step(name, (f"S-{n}", "S-all"), (f"F-{n}",) if n % 2 else (), count)
            for n, (name, count) in enumerate(zip(STEPS, TRANSITIONS, strict=True))
        ),
        case_count=len(cases),
        scan_count=sum(len(one.scans) for one in cases),
        given=tuple(cases),
    )


def walks(count: int, settled: bool, seed: int = 1) -> list[Case]:
    """Random cases; of relation settled each change of `go` is held until nothing moves any more."""
    chance, found = random.Random(seed), []
    for _ in range(count):
        moves: list[tuple[int, bool, bool]] = []
        for _ in range(chance.randint(2, 7)):
            go = chance.random() < 0.7
            hold = chance.choice((1, 2, 3)) if settled else 1
            ms = [chance.choice((0, 10, 250, 500)), *(chance.choice((0, 10)) for _ in range(hold - 1))]
            moves += [(one, go, n == hold - 1) for n, one in enumerate(ms)]
        found.append(case(moves))
    return found


def faulty(count: int, delay: int, seed: int = 1) -> list[Callable[[], Spoiled]]:
    """Programs that show one or two wrong values in one or several scans, and the right one first."""
    chance = random.Random(seed)
    programs: list[Callable[[], Spoiled]] = [lambda: Spoiled({}, delay)]
    for _ in range(count):
        faults: dict[tuple[int, str], Any] = {}
        for _ in range(chance.choice((1, 1, 2))):
            name = chance.choice(("A", "B", "CODE"))
            first, lasts = chance.randint(1, 12), chance.choice((1, 2, 40))
            value = chance.choice(("0000", "0002", "FFFF") if name == "CODE" else (False, True))
            faults |= {(n, name): value for n in range(first, first + lasts)}
        programs.append(lambda faults=faults: Spoiled(faults, delay))  # type: ignore[misc]
    return programs
