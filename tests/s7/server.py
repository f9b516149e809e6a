"""A PLC for tests: python-snap7's own server, behind which a loop runs the reference F-PLC scan by scan.

The bytes are taken apart here by hand, so that what the kit makes of an address map is not checked by
itself: bits 0 to 5 of DB3 LA, A to D, STR; MW3, MW7 in, MW1, MW5 out; Q0.0 to Q0.5 modes and ERROR;
DB1 settings; DB2 dt_ms, @scan, @done, @cycle, @reset, @magic.
"""

from __future__ import annotations

import struct
from types import TracebackType

from snap7 import Server, SrvArea

from refimpl.mode_selection import fplc
from tests.kit.clocks import Clock

MAP = """symbol,address,type
LA,DB3.DBX0.0,BOOL
A,DB3.DBX0.1,BOOL
B,DB3.DBX0.2,BOOL
C,DB3.DBX0.3,BOOL
D,DB3.DBX0.4,BOOL
STR,DB3.DBX0.5,BOOL
MW03,MW3,WORD
MW07,MW7,WORD
MW01,MW1,WORD
MW05,MW5,WORD
MSO_0,Q0.0,BOOL
MSO_1,Q0.1,BOOL
MSO_2,Q0.2,BOOL
MSO_3,Q0.3,BOOL
MSO_4,Q0.4,BOOL
ERROR,Q0.5,BOOL
T_ON_ms,DB1.DBD0,TIME
T_SEQ_ms,DB1.DBD4,TIME
T_REM_ms,DB1.DBD8,TIME
T_DWELL_ms,DB1.DBD12,TIME
T_SEQ_FROM,DB1.DBX16.0,BOOL
ON_ERROR,DB1.DBX16.1,BOOL
SELECTIONS,DB1.DBX16.2,BOOL
PERMITS_0,DB1.DBB17,BYTE
PERMITS_1,DB1.DBB18,BYTE
PERMITS_2,DB1.DBB19,BYTE
PERMITS_3,DB1.DBB20,BYTE
PERMITS_4,DB1.DBB21,BYTE
@reset,DB2.DBX10.0,BOOL
@magic,DB2.DBD12,DINT
"""
STEPPED = MAP + "@dt_ms,DB2.DBD0,DINT\n@scan,DB2.DBW4,WORD\n@done,DB2.DBW6,WORD\n"
FREE = MAP + "@cycle,DB2.DBW8,WORD\n"
WORDS = ">H"


class Plc:
    """One PLC on a free port of loopback; `most` scans, then it falls silent.

    With `cycle_ms` it runs freely, by a clock of its own: a scan at each telegram, and scan after scan while
    its partner sleeps by that clock.
    """

    def __init__(
        self,
        *,
        order: str = WORDS,
        most: int | None = None,
        cycle_ms: int = 0,
        dead: bool = False,
        magic: bytes = b"RIG!",
    ) -> None:
        self.inputs, self.outputs = bytearray(1), bytearray(1)
        self.flags, self.settings, self.control = bytearray(16), bytearray(32), bytearray(12) + magic
        self.order, self.most, self.cycle_ms, self.dead = order, most, cycle_ms, dead
        self.scans = 0
        self.state = fplc.power_up(fplc.Params())
        self.server = Server(log=False)
        areas = [(SrvArea.DB, 3, self.inputs), (SrvArea.PA, 0, self.outputs), (SrvArea.MK, 0, self.flags)]
        areas += [(SrvArea.DB, 1, self.settings), (SrvArea.DB, 2, self.control)]
        for area, index, memory in areas:
            self.server.register_area(area, index, memory)
        if not dead:
            self.server.set_events_callback(lambda _event: self.look())
        self.server.start_to("127.0.0.1", 0)
        assert self.server.server_socket is not None
        self.address = f"127.0.0.1:{self.server.server_socket.getsockname()[1]}"
        self.clock = PlcClock(self)

    def look(self) -> None:
        """What a test harness in the PLC does when it is asked for power-up or a scan."""
        if self.control[10] & 1:
            self.power_up()
        if self.cycle_ms:
            self.cycle()
        elif self.control[4:6] != self.control[6:8]:
            self.scan(int.from_bytes(self.control[0:4], "big"))
            self.control[6:8] = self.control[4:6]

    def power_up(self) -> None:
        on, seq, rem, dwell, choices, *permits = struct.unpack(">iiii6B", self.settings[:22])
        levels = {
            f"PERMITS_{n}": tuple(bool(one >> m & 1) for m in range(5)) for n, one in enumerate(permits)
        }
        params = fplc.Params(
            T_ON_ms=on,
            T_SEQ_ms=seq,
            T_REM_ms=rem,
            T_DWELL_ms=dwell,
            T_SEQ_FROM="ones" if choices & 1 else "LA",
            ON_ERROR="none" if choices & 2 else "hold",
            SELECTIONS="once" if choices & 4 else "again",
            **levels,  # type: ignore[arg-type]
        )
        self.state = fplc.power_up(params)
        for memory in (self.inputs, self.outputs, self.flags):
            memory[:] = bytes(len(memory))
        self.control[10] = 0

    def scan(self, dt_ms: int) -> None:
        self.scans += 1
        if self.most is not None and self.scans > self.most:
            self.stop()
            return
        (first, second), bits = (
            (struct.unpack_from(self.order, self.flags, at) for at in (3, 7)),
            self.inputs[0],
        )
        LA, A, B, C, D, STR = (bool(bits >> n & 1) for n in range(6))
        self.state, out = fplc.step(self.state, fplc.Inputs(dt_ms, LA, A, B, C, D, STR, first[0], second[0]))
        struct.pack_into(">H", self.flags, 1, out.MW01)
        struct.pack_into(">H", self.flags, 5, out.MW05)
        lamps = (out.MSO_0, out.MSO_1, out.MSO_2, out.MSO_3, out.MSO_4, out.ERROR)
        self.outputs[0] = sum(1 << n for n, on in enumerate(lamps) if on)

    def cycle(self) -> None:
        """One cycle of a PLC that runs freely."""
        self.clock.now_s += self.cycle_ms / 1000
        self.scan(self.cycle_ms)
        self.control[8:10] = ((int.from_bytes(self.control[8:10], "big") + 1) & 0xFFFF).to_bytes(2, "big")

    def stop(self) -> None:
        """The PLC is gone: no answer any more, from any connection."""
        self.server.running = False
        if self.server.server_socket is not None:
            self.server.server_socket.close()

    def __enter__(self) -> Plc:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.server.stop()


class PlcClock(Clock):
    """The time of a PLC that runs freely: as many cycles as it made."""

    def __init__(self, plc: Plc) -> None:
        super().__init__()
        self.plc = plc

    def sleep(self, seconds: float) -> None:
        """The PLC makes the cycles that fall into this time."""
        end = self.now_s + seconds
        while self.now_s < end:
            self.plc.cycle()
