"""The cell of the note: keys, reader, F-PLC, PLC, panel and user, wired as `key_flows` wires them.

Every scan is one call of the reference implementation. `do` takes what the page sends, `show` says what
stands where, `log` gives what was played as a log for `modeproof trace key_flows`.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from modeproof.simulate.program.device import Device, give, inputs_of, on_wire, take
from modeproof.simulate.program.reasons import NOTHING, Reasons
from modeproof.simulate.program.vectors import played
from refimpl.mode_selection import eks, hmi, key_flows
from refimpl.mode_selection.code_tables import MODE_NAMES, NONE, RE, decode, encode
from scenes.mode_selection.faults import KINDS, OUTPUTS, RANGE_OF, Faults

CHECKSUM = 0x1234
"""What the stand-in for the maker's checksum answers: it is not public."""
DIP_SWITCHES = 3
ROUND = (("eks", 20), ("fplc", 20), ("plc", 5), ("plc", 5), ("plc", 5), ("plc", 5), ("hmi", 20))
"""One round of 20 ms: each device scans once, the PLC once for each of its four copies."""
ROUND_MS = 20
LEVELS = range(5)


class Scene:
    """One cell after power-up. `facts` are the words of the registers; `params` are as in a log.

    `params` may also hold `reading`: the device concerned then runs the program of that reading.
    """

    document = "mode_selection"

    def __init__(self, facts: dict[str, Any], params: dict[str, Any]) -> None:
        self.facts, self.rows = facts, facts["devices"]
        self.params = params
        self.reset()

    def reset(self) -> None:
        """Power off and on: no key, no fault, an empty log."""
        self.devices = {
            name: Device(self.facts["module"] + name, *self._program(name)) for name in key_flows.DEVICES
        }
        states = [self.devices[name].state for name in key_flows.DEVICES]
        outs = [self.devices[name].out for name in key_flows.DEVICES]
        self.system = key_flows.System(*states, *outs)
        self.faults = Faults()
        self.lines: list[dict[str, Any]] = []
        self.took: list[list[str]] = []
        self.wrote = {name: on_wire(self.rows[name]["outputs"], self.devices[name].out) for name in self.rows}
        self.since = dict.fromkeys(self.rows, 0)
        self.read: dict[str, Any] = {}
        self.reasons = Reasons(self.facts["reasons"].get("fplc", NOTHING), self._given("fplc"))
        self.clock = self.scans = 0
        self.last = ""
        self.misread: dict[str, dict[str, Any]] = {}
        self.was_misread = False
        self.level = self.touched = self.confirmed = NONE
        self.differs = ""

    def _program(self, name: str) -> tuple[str, dict[str, Any], str]:
        """What names the steps of a device, its parameters, and its text where it is not the shipped one."""
        reading = self.facts["readings"].get(self.params.get("reading", ""), {})
        own = reading if reading.get("device") == name else {"labelled": self.facts["labelled"][name]}
        return own["labelled"], self._params(name), own.get("source", "")

    def _given(self, name: str) -> dict[str, Any]:
        """All parameters of a device as wire values."""
        own = self.rows[name]["parameters"]
        defaults = {key: of["default"] for key, of in own.items() if "default" in of}
        return {**defaults, **self.params.get(name, {})}

    def _params(self, name: str) -> dict[str, Any]:
        """The parameters of a device; the panel permits what the F-PLC does. E-47"""
        given = self.params.get("fplc" if name == "hmi" else name, {})
        own = self.rows[name]["parameters"]
        values = {
            key: take(own[key], value) for key, value in given.items() if key in own and key != "checksum"
        }
        if name != "eks":
            return values
        answer = int(given.get("checksum", f"{CHECKSUM:04X}"), 16)
        return {"dip_switches": DIP_SWITCHES, **values, "checksum": lambda data: answer}

    # ------------------------------------------------------------------------------------------ what is done

    def do(self, text: str) -> None:
        """One action: `insert 2`, `remove`, `touch confirm`, `scan eks fplc 3`, `fault loss`, `settle`.

        Raises ValueError for what is no action.
        """
        word, _, rest = text.strip().partition(" ")
        if word not in ("round", "scan", "settle"):
            self.reasons.acted(self.devices["fplc"].control())
        if word == "round":
            for _ in range(int(rest or 1)):
                for device, dt_ms in ROUND:
                    self.scan(device, dt_ms)
        elif word == "settle":
            self.settle()
        elif word == "scan":
            *names, times = rest.split(" ") if rest[-1:].isdigit() else [*rest.split(" "), "1"]
            if any(name not in self.rows for name in names):
                raise ValueError(f"{text!r} is no action of this cell")
            for _ in range(int(times)):
                for name in names:
                    self.scan(name, dict(ROUND)[name])
        elif word == "insert" and rest in map(str, LEVELS):
            self.level, self.touched, self.confirmed = int(rest), NONE, NONE
            key = eks.KeyMemory(6, encode(RE, self.level), DIP_SWITCHES, CHECKSUM, 1 + self.level)
            self.system = key_flows.insert_key(self.system, key)
        elif word == "remove":
            self.level = NONE
            self.system = key_flows.remove_key(self.system)
        elif word == "touch" and rest in places():
            self.touch(rest)
        elif word == "fault" and rest in KINDS:
            self.faults.begin(rest, self.words())
            self.reasons.latest, self.was_misread = "", False
        elif word == "mend":
            self.faults.end()
            self.misread = {}
        elif word in ("word", "other", "output") and (rest in RANGE_OF or rest in ("LA", *OUTPUTS)):
            setattr(self.faults, word, rest)
        elif word == "mode" and rest in map(str, LEVELS):
            self.faults.mode = int(rest)
        elif word == "reset":
            self.reset()
        else:
            raise ValueError(f"{text!r} is no action of this cell")

    def settle(self) -> None:
        """Whole rounds until the F-PLC has left Start and is ready for a key. E-25c, E-52

        Without a key and a fault that takes the dwell time and one round. Raises ValueError after that.
        """
        fplc = self.devices["fplc"]
        for _ in range(self.system.fplc_state.params.T_DWELL_ms // ROUND_MS + 2):
            if fplc.control() != "Start":
                return
            self.do("round 1")
        raise ValueError("the F-PLC does not become ready for a key")

    def touch(self, field: str) -> None:
        """The user touches a field; it counts in the panel's next scan."""
        self.system = key_flows.touch(self.system, field)
        screen = self.devices["hmi"].out
        if field == hmi.CONFIRM and screen.screen == "confirm":
            self.confirmed = screen.shown
        elif field.startswith("select:") and screen.enabled[int(field[-1])]:
            self.touched, self.confirmed = int(field[-1]), NONE

    def scan(self, name: str, dt_ms: int) -> None:
        """One scan of one device, with what the active fault makes of its inputs."""
        read = {
            "eks": key_flows.eks_inputs,
            "fplc": key_flows.fplc_inputs,
            "plc": key_flows.plc_inputs,
            "hmi": key_flows.hmi_inputs,
        }[name](self.system, dt_ms)
        faulty = self.faults.read(name, read, self.words())
        fields = self.rows[name]["inputs"]
        differing = [of for of in fields if getattr(faulty, of) != getattr(read, of)]
        self.misread[name] = {of: give(fields[of], getattr(faulty, of)) for of in differing}
        self.was_misread = self.was_misread or bool(differing)
        self._step(name, faulty, dt_ms)

    def _step(self, name: str, inputs: Any, dt_ms: int) -> None:
        before = self.words()
        device = self.devices[name]
        state = device.control()
        out = device.scan(inputs)
        if name == "fplc":
            self.reasons.scanned(state, device.step, device.control())
        self.system = replace(self.system, **{f"{name}_state": device.state, f"{name}_out": out})
        if name == "hmi":
            self.system = replace(self.system, touch=hmi.NO_TOUCH)
        for word, value in self.words().items():
            self.faults.written(word, before[word], value)
        self.read[name] = read = on_wire(self.rows[name]["inputs"], inputs)
        self.wrote[name] = on_wire(self.rows[name]["outputs"], out)
        self.lines.append({"device": name, "dt_ms": dt_ms, "in": read, "out": self.wrote[name]})
        self.took.append([device.step, device.control()])
        self.since[name] += dt_ms
        self.clock = max(self.since.values())
        self.scans += 1
        self.last = name

    def words(self) -> dict[str, int]:
        """All eight words as they were last written."""
        f, p, h = self.system.fplc_out, self.system.plc_out, self.system.hmi_out
        return {
            "MW01": f.MW01, "MW05": f.MW05, "MW03": p.MW03, "MW07": p.MW07, "CheckMSO": p.CheckMSO,
            "ReadAuthorization": p.ReadAuthorization, "SelectMSO": h.SelectMSO, "SwitchMSO": h.SwitchMSO,
        }  # fmt: skip

    # ------------------------------------------------------------------------------------------------- logs

    def log(self) -> str:
        """Every scan since power-up as JSON Lines, with the parameters in front."""
        params = {
            "fplc": self.params.get("fplc", {}),
            "eks": {
                "checksum": f"{CHECKSUM:04X}",
                "dip_switches": DIP_SWITCHES,
                **self.params.get("eks", {}),
            },
        }
        head = {"target": "key_flows", "params": params}
        return "".join([json.dumps(row, separators=(",", ":")) + "\n" for row in [head, *self.lines]])

    def vectors(self, name: str) -> tuple[dict[str, Any], dict[str, Any]]:
        """What one device did since power-up, as a test case. Raises ValueError where it did nothing."""
        own = [at for at, line in enumerate(self.lines) if line["device"] == name]
        lines, took = [self.lines[at] for at in own], [self.took[at] for at in own]
        return played(self.facts, name, self.params.get(name, {}), lines, took)

    @staticmethod
    def params_of(header: dict[str, Any]) -> dict[str, Any]:
        """The F-PLC's parameters in the header of a log. Raises ValueError for a log of something else."""
        if header.get("target") != "key_flows":
            raise ValueError(
                f"a log of {header.get('target')!r} cannot be played here, only one of 'key_flows'"
            )
        params: dict[str, Any] = header["params"]
        return params

    def begin_log(self, header: dict[str, Any]) -> None:
        """Power up with the parameters of a log."""
        self.params = self.params_of(header)
        self.reset()

    def play(self, line: dict[str, Any]) -> None:
        """One line of a log: the device scans with the inputs that the line shows."""
        name, dt_ms = line["device"], line["dt_ms"]
        rows = self.rows[name]["inputs"]
        inputs = inputs_of(self.devices[name].code, rows, dt_ms, line["in"])
        self._step(name, inputs, dt_ms)
        if name == "eks":
            held = decode(RE, inputs.authorization_level) if inputs.inserted else NONE
            self.level = held
        for output, logged in line.get("out", {}).items():
            if self.wrote[name][output] != logged and not self.differs:
                self.differs = f"scan {self.scans} ({name}): {output} is {self.wrote[name][output]}, "
                self.differs += f"the log has {logged}"

    # ------------------------------------------------------------------------------------------- what stands

    def show(self) -> dict[str, Any]:
        """What stands where: texts, what is lit, what can be touched, and the step of each device."""
        signals = {name: value for out in self.wrote.values() for name, value in out.items()}
        shown = picture(self.facts, signals)
        shown["text"] |= {
            "time": f"{self.clock / 1000:.2f} s",
            "scans": str(self.scans),
            "user": self.user(),
            "differs": self.differs,
            "noticed": self.noticed(),
            "level": "" if self.level == NONE else str(self.level),
            "dwell": f"{self.system.fplc_state.params.T_DWELL_ms} ms",
        }
        shown["misread"] = [name for names in self.misread.values() for name in names]
        shown["text"] |= {
            f"{name}.says": f"{shown['text'][f'{name}.says']}, read as {value}: {self.says(name, value)}"
            for values in self.misread.values()
            for name, value in values.items()
            if name in RANGE_OF
        }
        shown["on"] |= {f"key.{level}": self.level == level for level in LEVELS}
        shown["on"] |= {
            "key": self.system.key is not None or self.level != NONE,
            "fault": bool(self.faults.active),
        }
        shown["devices"] = {
            name: {"state": device.control(), "step": device.step, "last": name == self.last}
            for name, device in self.devices.items()
        }
        state = self.devices["fplc"].control()
        shown["why"] = {"fplc": self.reasons.show(state, shown["on"]["ERROR"], self.waits_for(state))}
        return shown

    def noticed(self) -> str:
        """What came of the fault that is in, in this run."""
        if not self.faults.active:
            return ""
        if not self.was_misread:
            return "In this run: until now every device has read what was written."
        if self.reasons.latest:
            return f"In this run: the F-PLC refused after it was put in. {self.reasons.latest}"
        return (
            "In this run: a device has read something else than what was written. The F-PLC refused nothing."
        )

    def waits_for(self, state: str) -> list[str]:
        """What keeps the F-PLC where it stands, by what it read last. E-15, E-23, E-25c, E-52"""
        read = self.read.get("fplc", {"LA": False, "MW03": "0000", "MW07": "0000"})
        things = ["the fault to be taken out"] if self.misread.get("fplc") else []
        if state != "Settle" and self.level != NONE:
            things.append("the key to be pulled out")
        elif state != "Settle":
            things += [f"{name} to go off" for name in ("LA", *OUTPUTS) if read.get(name)]
        if state == "Complete":
            return things
        things += [f"{name} to be zero" for name in ("MW03", "MW07") if read[name] != "0000"]
        fplc = self.system.fplc_state
        rest = fplc.params.T_DWELL_ms - fplc.elapsed_ms
        return [*things, f"{rest} ms to pass"] if rest > 0 else things

    def says(self, name: str, word: str) -> str:
        """What a word means where it stands."""
        return meaning(self.facts, name, word)

    def user(self) -> str:
        """What the user did with the key that is in."""
        if self.level == NONE and self.system.key is None:
            return "No key is in the reader."
        key = f"Key of level {self.level} is in. "
        if self.touched == NONE:
            confirmed = (
                "nothing" if self.confirmed == NONE else f"nothing and confirmed mode {self.confirmed}"
            )
            return f"{key}The user touched {confirmed}."
        confirmed = "and confirmed it" if self.confirmed == self.touched else "and has not confirmed it"
        return f"{key}The user touched mode {self.touched} {confirmed}."


def header_of(params: dict[str, Any]) -> dict[str, Any]:
    """The header of a log of the cell in which the F-PLC has these parameters (wire values)."""
    return {"target": "key_flows", "params": {"fplc": params}}


def meaning(facts: dict[str, Any], name: str, word: str) -> str:
    """What a word means where it stands."""
    mode = decode(RANGE_OF[name], int(word, 16))
    if word == "0000":
        return "nothing"
    return "no code" if mode == NONE else f"{facts['says'][name]} {mode}"


def picture(facts: dict[str, Any], signals: dict[str, Any]) -> dict[str, Any]:
    """Signals (wire form) as the drawing shows them; also those of a recorded run."""
    text: dict[str, str] = {}
    on: dict[str, bool] = {}
    for name, value in signals.items():
        if isinstance(value, bool):
            on[name] = value
        elif name in RANGE_OF:
            text[name], text[f"{name}.says"] = value, meaning(facts, name, value)
    active = [mode for mode in LEVELS if signals.get(f"MSO_{mode}")]
    text["active"] = f"{active[0]}: {MODE_NAMES[active[0]]}" if active else "none"
    screen, shown = signals.get("screen", ""), signals.get("shown")
    enabled = signals.get("enabled", [])
    on["error"] = bool(signals.get("ERROR"))
    text["screen"] = {
        "inhibited": "Insert a key",
        "select": "Select a mode",
        "waiting": "Please wait",
        "confirm": "Is this right?",
    }.get(str(screen), "")
    text["echo"] = "" if shown is None else f"Mode {shown}: {MODE_NAMES[shown]}"
    can = {f"select:{mode}": mode in enabled for mode in LEVELS}
    can |= {hmi.CONFIRM: screen == "confirm", hmi.REJECT: screen == "confirm"}
    return {"text": text, "on": on, "open": can}


def recorded(facts: dict[str, Any], told: list[dict[str, Any]]) -> dict[str, Any]:
    """The last of some recorded rows as the drawing shows it: what the evidence has, and nothing else."""
    last, rows = told[-1], facts["devices"]
    wires = last["wires"]
    types = {name: of for row in rows.values() for name, of in {**row["inputs"], **row["outputs"]}.items()}
    signals = {
        name: value if types[name]["type"] == "modes" else give(types[name], value)
        for name, value in wires.items()
        if name in types
    }
    shown = picture(facts, signals)
    for name in RANGE_OF:
        if name not in signals:
            shown["text"] |= {name: "", f"{name}.says": "not recorded"}
    hand = [row["step"] for row in told if row["step"] in ("InsertKey", "RemoveKey")]
    shown["on"]["key"] = wires.get("inserted", hand[-1:] == ["InsertKey"])
    placed = {*RANGE_OF, *rows["fplc"]["inputs"], *rows["fplc"]["outputs"], *rows["hmi"]["outputs"]}
    beside = [name for name in signals if name not in placed]
    said = "; ".join([f"{name} {'none' if signals[name] is None else signals[name]}" for name in beside])
    shown["text"] |= {"level": "", "user": said or "What the user did stands above.", "dwell": "not recorded"}
    shown["devices"] = {
        name: {
            "state": last["states"].get(name, "not in this model"),
            "step": last["step"] if name == last["who"] else "",
            "last": name == last["who"],
        }
        for name in rows
    }
    return shown


def places() -> dict[str, list[float]]:
    """Where the fields of the panel lie, in per cent of its screen. EKS-2-22"""
    layout = hmi.DEFAULT_LAYOUT
    named = {f"select:{mode}": field for mode, field in enumerate(layout.selection)}
    named |= {hmi.CONFIRM: layout.confirm, hmi.REJECT: layout.reject}
    width, height = layout.screen.width, layout.screen.height
    return {
        name: [100 * of.x / width, 100 * of.y / height, 100 * of.width / width, 100 * of.height / height]
        for name, of in named.items()
    }
