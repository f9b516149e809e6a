"""Edits of what the tool made: evidence, graphs, vectors, report, and texts changed after it. Data, no code.

The tree is the sixth document (tests/sixth), verified, with its vectors and its report.
"""

from __future__ import annotations

from tests.deep.tamper.trees import Case

EVIDENCE = "build/evidence/sluice"
GATE, CODE = "spec/sluice/Gate.tla", "refimpl/sluice/gate.py"
READY = ("Ready(i) == i.BeaconLit\n", "Ready(i) == i.OpenRequest\n")


SCANS = (
    '[{"dt_ms":500,"in":{"BeaconCall":false},"out":{"BeaconLit":false,"LAMP_CODE":"0000"},"step":0,"to":0,'
    '"column":0}'
    ',{"dt_ms":500,"in":{"BeaconCall":true},"out":{"BeaconLit":true,"LAMP_CODE":"AAAA"},"step":1,"to":1,'
    '"column":1}'
    ',{"dt_ms":500,"in":{},"out":{},"step":2,"to":1,"column":1}'
    ',{"dt_ms":500,"in":{"BeaconCall":false},"out":{"BeaconLit":false,"LAMP_CODE":"0000"},"step":3,"to":0,'
    '"column":0}]'
)
"""All scans of the one case."""


def seen(name: str, file: str, old: str, new: str | None, of: str = "") -> Case:
    """A file that the report rests on is changed: the report that is there does not fit any more."""
    return Case(name, file, old, new, "report --verify", 1, of or file)


def believed(name: str, file: str, old: str, new: str) -> Case:
    """Evidence is edited by hand, and then a report is made of it."""
    return Case(f"{name}, then a report", file, old, new, "report", 1, file.split("/")[-1][:9])


def vectors(name: str, file: str, old: str, new: str, of: str) -> Case:
    """A file of vectors is edited."""
    return Case(name, f"build/vectors/sluice/{file}", old, new, "vectors lint", 1, of)


RECORDS = (
    seen("the specification is changed after the report", GATE, *READY),
    seen("the code is changed after the report", CODE, "if i.BeaconLit:", "if i.OpenRequest:"),
    seen(
        "a property is changed after the report",
        "spec/sluice/Sluice.tla",
        "=> BeaconOutputs.BeaconLit]_vars",
        "=> TRUE]_vars",
    ),
    seen(
        "a register is changed after the report",
        "spec/sluice/clauses.toml",
        "The beacon is amber.",
        "The beacon is blue.",
    ),
    seen(
        "a count in the evidence is changed",
        f"{EVIDENCE}/MC_Sluice.json",
        '"verdict": "HOLDS"',
        '"verdict": "VIOLATED"',
    ),
    seen(
        "a theorem's answer in the evidence is changed",
        f"{EVIDENCE}/the_gate_opens_only_over_a_lit_beacon.json",
        '"as_expected": true',
        '"as_expected": false',
    ),
    Case(
        "a piece of evidence is gone",
        f"{EVIDENCE}/NEG_Sluice_opens_at_once.json",
        "",
        None,
        "report --verify",
        2,
        "gone     build/evidence/sluice/NEG_Sluice_opens_at_once.json",
    ),
    seen("the report itself is changed", "build/report/report.html", '<html lang="en">', '<html lang="de">'),
    believed(
        "evidence with other counts than its pins",
        f"{EVIDENCE}/WIT_Sluice.json",
        '  "distinct": 6,\n  "generated": 31,\n  "queue"',
        '  "distinct": 7,\n  "generated": 31,\n  "queue"',
    ),
    believed(
        "evidence that is EQUAL with differences",
        f"{EVIDENCE}/refimpl_OPEN_Gate.json",
        '"differences": []',
        '"differences": ["in state Open"]',
    ),
    believed(
        "evidence that HOLDS with another exit status",
        f"{EVIDENCE}/MC_Sluice.json",
        '"exit_status": 0',
        '"exit_status": 12',
    ),
    Case(
        "the code is not what the graph says",
        CODE,
        "if i.BeaconLit:",
        "if i.OpenRequest:",
        "conform gate --builtin refimpl --quiet",
        1,
        "DIFFERS",
    ),
    Case(
        "the code shuts one scan late",
        CODE,
        "if elapsed >= s.params.T_OPEN_ms:",
        "if elapsed > s.params.T_OPEN_ms:",
        "conform gate --builtin refimpl --quiet",
        1,
        "DIFFERS",
    ),
    Case(
        "a stale graph is compared with the code",
        GATE,
        *READY,
        "conform gate --builtin refimpl --quiet",
        1,
        "TLC makes OPEN_Gate first",
    ),
    Case(
        "vectors are built from a stale graph",
        GATE,
        *READY,
        "vectors build gate --suite brief",
        0,  # it makes the graph anew, and the vectors from that one
        "TLC makes OPEN_Gate first",
    ),
    Case(
        "a graph is edited by hand",
        "build/graphs/sluice/OPEN_Gate.txt",
        '<<"EDGE", <<"Shut", 0>>, "CallBeacon", 1, <<"Calling", 0>>>>',
        '<<"EDGE", <<"Shut", 0>>, "CallBeacon", 1, <<"Shut", 0>>>>',
        "conform gate --builtin refimpl --quiet",
        0,  # the edited graph is not used: the right one is made anew
        "TLC makes OPEN_Gate first",
    ),
    vectors(
        "an input in the vectors is changed",
        "beacon/brief.jsonl.gz",
        '"in":{"BeaconCall":true},"out":{"BeaconLit":true,"LAMP_CODE":"AAAA"},"step":1',
        '"in":{"BeaconCall":false},"out":{"BeaconLit":true,"LAMP_CODE":"AAAA"},"step":1',
        "NOT",
    ),
    vectors(
        "the header counts other scans",
        "beacon/brief.jsonl.gz",
        '"cases":1,"scans":4',
        '"cases":1,"scans":5',
        "NOT",
    ),
    vectors(
        "the header counts other cases",
        "beacon/brief.jsonl.gz",
        '"cases":1,"scans":4',
        '"cases":2,"scans":4',
        "NOT",
    ),
    vectors(
        "an output that nobody declares",
        "beacon/brief.jsonl.gz",
        '"outputs":{"BeaconLit":{"type":"bool"},',
        '"outputs":{',
        "NOT",
    ),
    vectors(
        "a vector file without a case",
        "beacon/brief.jsonl.gz",
        '"scans":[{"dt_ms":500,',
        '"scans":[],"was":[{"dt_ms":500,',
        "NOT",
    ),
    vectors(
        "every scan of a case is settling",
        "beacon/brief.jsonl.gz",
        SCANS,
        SCANS.replace('"column":', '"settling":true,"column":'),
        "NOT",
    ),
    Case(
        "a theorem of another name is dropped",
        CODE,
        "if i.BeaconLit:",
        "if i.BeaconLit :",
        "prove the_gate_opens_only_over_a_lit_beacon the_gate_opens_never --quiet",
        2,
        "the_gate_opens_never",
    ),
    Case(
        "a run that is not in the lane is dropped",
        CODE,
        "if i.BeaconLit:",
        "if i.BeaconLit :",
        "check MC_Sluice NEG_Sluice_opens_at_once --lane smoke --quiet",
        2,
        "NEG_Sluice_opens_at_once",
    ),
    Case(
        "a run that does not exist",
        CODE,
        "if i.BeaconLit:",
        "if i.BeaconLit :",
        "check MC_Sluice MC_Sluices --quiet",
        2,
        "MC_Sluices",
    ),
    Case(
        "the negative is of the decided reading",
        "spec/sluice/GateAsPrinted.tla",
        "Ready_OpensAtOnce(i) == TRUE",
        "Ready_OpensAtOnce(i) == i.BeaconLit",
        "check NEG_Sluice_opens_at_once --quiet",
        1,
        "NOT",
    ),
    Case(
        "the witness is printed from the start",
        "spec/sluice/Sluice.tla",
        'PrintWitness == step = "OpenGate" =>',
        'PrintWitness == step # "OpenGate" =>',
        "stage sluice",
        1,
        "PrintWitness",
    ),
)
