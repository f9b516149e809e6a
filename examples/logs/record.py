"""Records logs of refimpl's composition, good ones and such with a planted fault, for `modeproof trace`.

    python examples/logs/record.py            writes all logs of this folder anew

`Recorder` is the way to record others: let a device scan, do what the user does, take the lines. A log of the
system has a line a scan of any device; a log of one device has the lines of that device alone.
"""

from __future__ import annotations

import csv
import io
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
if __name__ == "__main__":
    sys.path.insert(0, str(HERE.parents[1]))

from refimpl.mode_selection import eks, fplc, key_flows  # noqa: E402
from refimpl.mode_selection.code_tables import RE, encode  # noqa: E402

Line = dict[str, Any]
FPLC: dict[str, Any] = {
    **{"T_ON_ms": 300, "T_SEQ_ms": 500, "T_REM_ms": 400, "T_DWELL_ms": 100},
    **{"T_SEQ_FROM": "LA", "SELECTIONS": "again"},
}
"""The profile cautious, with times of its own."""
PULSE_MS = 40
CHECKSUM = 0x1234
DIP_SWITCHES = 3
PARAMS = {
    "eks": {"checksum": f"{CHECKSUM:04X}", "dip_switches": DIP_SWITCHES, "T_PULSE_ms": PULSE_MS},
    "fplc": FPLC,
}


def key_of_level(level: int) -> eks.KeyMemory:
    """A key that the recorded EKS accepts."""
    return eks.KeyMemory(6, encode(RE, level), DIP_SWITCHES, CHECKSUM, 1)


class Recorder:
    """Lets the devices scan and keeps a line for each scan. Times in ms."""

    def __init__(self) -> None:
        device = eks.Params(dip_switches=DIP_SWITCHES, checksum=lambda data: CHECKSUM, T_PULSE_ms=PULSE_MS)
        self.system = key_flows.power_up(device, fplc.Params(**FPLC))
        self.lines: list[Line] = []

    def scan(self, device: str, dt_ms: int) -> None:
        """One scan of one device, `dt_ms` after its last one."""
        self.lines.append(json.loads(key_flows.log_line(self.system, device, dt_ms)))
        self.system = key_flows.scan(self.system, device, dt_ms)

    def rounds(self, number: int, dt_ms: int = 20) -> None:
        """So many rounds: the EKS, the F-PLC, the four copies of the PLC, the panel."""
        for _ in range(number):
            for device in ("eks", "fplc"):
                self.scan(device, dt_ms)
            for _ in range(4):
                self.scan("plc", dt_ms // 4)
            self.scan("hmi", dt_ms)

    def of(self, device: str) -> list[Line]:
        """The lines of one device, without its name."""
        return [
            {key: value for key, value in line.items() if key != "device"}
            for line in self.lines
            if line["device"] == device
        ]


def one_switchover() -> Recorder:
    """Power-up, a key of level 2, mode 1 selected and confirmed, the key taken out, Idle."""
    recorder = Recorder()
    recorder.rounds(7)
    recorder.system = key_flows.insert_key(recorder.system, key_of_level(2))
    recorder.rounds(16)
    recorder.system = key_flows.touch(recorder.system, "select:1")
    recorder.rounds(5)
    recorder.system = key_flows.touch(recorder.system, "confirm")
    recorder.rounds(14)
    recorder.system = key_flows.remove_key(recorder.system)
    recorder.rounds(10)
    return recorder


# ------------------------------------------------------------------------------------------------ planted


def wrong_echo(lines: list[Line]) -> list[Line]:
    """The first echo in MW05 is the word of another mode."""
    first = next(n for n, line in enumerate(lines) if line["out"]["MW05"] != "0000")
    lines[first]["out"]["MW05"] = "0FF0"
    return lines


def short_dwell(lines: list[Line]) -> list[Line]:
    """One scan in Settle comes a ms earlier: the level is shown again after T_DWELL less one ms."""
    switched = next(n for n, line in enumerate(lines) if line["out"]["MSO_1"])
    lines[switched + 1]["dt_ms"] -= 1
    return lines


def skipped_step(lines: list[Line]) -> list[Line]:
    """The mode is switched one scan early: step 28 was left out."""
    switched = next(n for n, line in enumerate(lines) if line["out"]["MSO_1"])
    del lines[switched - 1]
    return lines


def lost_word(lines: list[Line]) -> list[Line]:
    """The F-PLC reads zero in MW07 although the PLC has written the acknowledgment."""
    first = next(
        n for n, line in enumerate(lines) if line["device"] == "fplc" and line["in"]["MW07"] != "0000"
    )
    lines[first]["in"]["MW07"] = "0000"
    return lines


# -------------------------------------------------------------------------------------------------- files


def as_lines(target: str, params: dict[str, Any], lines: list[Line]) -> str:
    """JSON Lines with a header."""
    rows = [{"target": target, "params": params}, *lines]
    return "".join(json.dumps(row, separators=(",", ":")) + "\n" for row in rows)


def as_table(lines: list[Line], tags: dict[str, str], settings: dict[str, Any]) -> str:
    """As a PLC's trace tool exports it: tags for names, time since the start, words with 16#, 0 and 1."""
    text = io.StringIO()
    for name, value in settings.items():
        text.write(f"# {name} = {value}\n")
    table = csv.writer(text, delimiter=";", lineterminator="\n")
    names = [*lines[0]["in"], *lines[0]["out"]]
    table.writerow(["t_ms", *(tags.get(name, name) for name in names)])
    now = 0
    for line in lines:
        now += line["dt_ms"]
        values = {**line["in"], **line["out"]}
        cells = [int(one) if isinstance(one, bool) else f"16#{one}" for one in map(values.get, names)]
        table.writerow([now, *cells])
    return text.getvalue()


def without(lines: list[Line], *names: str) -> list[Line]:
    """The same log as seen by somebody who does not observe these signals."""
    return [
        {
            **line,
            "in": {name: value for name, value in line["in"].items() if name not in names},
            "out": {name: value for name, value in line["out"].items() if name not in names},
        }
        for line in lines
    ]


def sampled(lines: list[Line]) -> list[Line]:
    """What a recorder keeps that looks by itself: a line before and after each change of an input."""
    kept: list[Line] = []
    skipped = 0
    for n, line in enumerate(lines):
        before, after = lines[max(n - 1, 0)], lines[min(n + 1, len(lines) - 1)]
        if n == 0 or n == len(lines) - 1 or before["in"] != line["in"] or line["in"] != after["in"]:
            kept.append({**line, "dt_ms": line["dt_ms"] + skipped})
            skipped = 0
        else:
            skipped += line["dt_ms"]
    return kept


TAGS = {
    "LA": "FI1", "A": "FI2", "B": "FI3", "C": "FI4", "D": "FI5", "STR": "FI6",
    "MW01": "MW1", "MW03": "MW3", "MW05": "MW5", "MW07": "MW7",
}  # fmt: skip


def fplc_log(edit: Callable[[list[Line]], list[Line]] = lambda lines: lines) -> str:
    """A log of the F-PLC as JSON Lines."""
    return as_lines("fplc", FPLC, edit(one_switchover().of("fplc")))


def logs() -> dict[str, str]:
    """Every log of this folder by its name."""
    whole = one_switchover()
    lines = whole.of("fplc")
    return {
        "fplc_good.jsonl": fplc_log(),
        "fplc_good.csv": as_table(lines, TAGS, FPLC),
        "fplc_partial.csv": as_table(without(lines, "MW07", "MSO_0", "MSO_3"), TAGS, FPLC),
        "fplc_sampled.csv": as_table(sampled(lines), TAGS, FPLC),
        "fplc_from_the_middle.jsonl": fplc_log(lambda lines: lines[30:]),
        "fplc_wrong_echo.jsonl": fplc_log(wrong_echo),
        "fplc_short_dwell.jsonl": fplc_log(short_dwell),
        "fplc_skipped_step.jsonl": fplc_log(skipped_step),
        "fplc_cut.jsonl": fplc_log()[:-40],
        "key_flows_good.jsonl": as_lines("key_flows", PARAMS, whole.lines),
        "key_flows_lost_word.jsonl": as_lines("key_flows", PARAMS, lost_word(one_switchover().lines)),
    }


def main() -> None:
    """Write every log."""
    for name, text in logs().items():
        (HERE / name).write_text(text, encoding="utf-8", newline="")
        print(name, text.count("\n"), "lines")


if __name__ == "__main__":
    main()
