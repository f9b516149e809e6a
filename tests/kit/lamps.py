"""The lamp of tests/graph/printed.py as programs in this process: a right one, slow ones, and wrong ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from modeproof.graph.device import DeviceGraph
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph

DEMANDS = {
    "constants": {"CODE": 0x0FF0},
    "rules": [{"name": "codes", "kind": "recent", "is": "press and word == CODE"}],
    "demands": [
        {
            "id": "LightNeedsCode",
            "says": "The lamp goes on only with its code.",
            "clauses": ["TOY-1"],
            "when": "LAMP and not was_LAMP",
            "holds": "True in codes",
        }
    ],
}


class Lamp:
    """Right, scan by scan. What a scan has worked out stands on the outputs `delay` scans later."""

    delay = 0
    hello_says: Mapping[str, Any] = {}

    def __init__(self) -> None:
        self.scans = 0
        self.closed = 0
        self.reset({})

    def hello(self, target: str) -> Mapping[str, Any]:
        relations = ["settled"] if self.delay else ["exact"]
        says = {"ok": True, "name": "lamp", "version": "1", "relations": relations}
        return {**says, "max_latency_scans": self.delay, **self.hello_says}

    def reset(self, params: Mapping[str, Any]) -> None:
        self.on, self.elapsed, self.limit = False, 0, params.get("T_ms", 500)
        self.late = [{"LAMP": False, "MW": "0000"}] * self.delay

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.scans += 1
        self.elapsed += dt_ms
        if not self.on and inputs["press"] and self.right(inputs["word"]):
            self.on, self.elapsed = True, 0
        elif not self.on or self.elapsed >= self.limit:
            self.on, self.elapsed = False, 0
        self.late.append({"LAMP": self.on, "MW": "0FF0" if self.on else "0000"})
        return self.shown(self.late.pop(0))

    def right(self, word: str) -> bool:
        return word == "0FF0"

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return out

    def close(self) -> None:
        self.closed += 1


class Slow(Lamp):
    """Right, but each input needs three scans more."""

    delay = 3


class SlowAndFlickering(Slow):
    """Shows a word that belongs nowhere whenever the lamp changes; right when all is settled."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.before = False

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        changed, self.before = out["LAMP"] != self.before, out["LAMP"]
        return {**out, "MW": "FFFF"} if changed else out


class SlowerThanItSays(Slow):
    """Needs eight scans and says three."""

    delay = 8
    hello_says = {"max_latency_scans": 3}  # noqa: RUF012


class SlowAndWrong(Slow):
    """Takes any word."""

    def right(self, word: str) -> bool:
        return True


class Late(Lamp):
    """Goes off too late: no safety property says anything about it."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.limit = 501


def made(
    folder: Path,
    name: str,
    demands: Mapping[str, Any] | None = DEMANDS,
    graph: Callable[[Path], DeviceGraph] = lamp_graph,
) -> Suite:
    """A suite of the lamp, with its demands."""
    path = folder / f"{name}.jsonl.gz"
    write_suite(path, name, [graph(folder)], citations=lambda step: (("TOY-1",), ()))
    return open_suite(path).demanding(demands)
