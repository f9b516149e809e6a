"""The graph of the toy document `box`: as a model checker would print it, exported and named in evidence."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from modeproof.graph.device import graph_file, read_device_graph
from modeproof.graph.export import write_export
from modeproof.ground.evidence import hashes
from modeproof.registers.runs import load_runs
from tests.report.conftest import declared
from tests.report.paper import change, put

CFG = "VIEW View\nSPECIFICATION Spec\nPROPERTY ShutsOverDoor\n"
LETTERS = [(door, dt) for door in ("FALSE", "TRUE") for dt in (0, 1)]
OPEN, SHUT = '<<"Open", 0>>', '<<"Shut", 1>>'
PRINTED = [
    *(f'<<"INPUT", {n}, [door |-> {door}, dt |-> {dt}]>>' for n, (door, dt) in enumerate(LETTERS)),
    f'<<"INIT", {OPEN}>>',
    f'<<"STATE", {OPEN}, [WORD |-> 0, LAMP |-> FALSE, SPARE |-> FALSE]>>',
    f'<<"STATE", {SHUT}, [WORD |-> 3856, LAMP |-> TRUE, SPARE |-> FALSE]>>',
    *(f'<<"EDGE", {OPEN}, "Wait", {n}, {OPEN}>>' for n in (0, 1)),
    *(f'<<"EDGE", {OPEN}, "Close", {n}, {SHUT}>>' for n in (2, 3)),
    *(f'<<"EDGE", {SHUT}, "Stay", {n}, {SHUT}>>' for n in range(len(LETTERS))),
]
SEQUENCES = '[tables]\nCODE = ["0F0F", "0F10"]\n'
GRAPH = '[run.graph]\ndevice = "box"\ntick_ms = 250\nparams = { T_HOLD_ms = 1 }\nstates = 2\nedges = 8\n'
EXPORT = "build/export/box/OPEN_Box.json.gz"


def add_graph(root: Path) -> Path:
    """Give the box of `make_paper` an OPEN run, its graph, and evidence of the comparison; the export."""
    folder = root / "spec" / "box"
    (folder / "models" / "OPEN_Box.cfg").write_text(CFG)
    (folder / "sequences.toml").write_text(SEQUENCES)
    change(folder / "BoxOpen.tla", "Nothing == FALSE", "Nothing == FALSE\nView == <<boxState, shut>>")
    with (folder / "runs.toml").open("a") as runs:
        runs.write(declared("OPEN_Box", "any door", "distinct = 2\ngenerated = 9\n" + GRAPH, CFG))
    run = next(one for one in load_runs(root, "box") if one.id == "OPEN_Box")
    printed = graph_file(root, run)
    printed.parent.mkdir(parents=True)
    printed.write_text("\n".join(PRINTED) + "\n")
    export = write_export(root, run, read_device_graph(root, run))
    put(root, "OPEN_Box", verdict="HOLDS", expected="HOLDS")
    compared(root)
    return export


def compared(root: Path, **changes: Any) -> None:
    """Write the evidence of the comparison: as expected, but for the changes of its result."""
    result = {
        "run": "box/OPEN_Box",
        "device": "box",
        "implementation": "refimpl.box.box",
        "states": 2,
        "inputs": 4,
        "transitions": 8,
        "replayed": 8,
        "artefacts": hashes(root, [root / EXPORT]),
    }
    put(root, "refimpl_OPEN_Box", kind="conformance", result={**result, **changes})
