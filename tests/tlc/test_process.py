"""How TLC is started."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.tlc.process import command_line
from modeproof.tlc.toolchain import Toolchain
from tests.tlc.outcomes import declared

TOOLS = Toolchain(Path("/java"), "25", Path("/tla2tools.jar"), "0" * 64, True)
QUICK = "-XX:TieredStopAtLevel=1"


@pytest.mark.parametrize(("heap_mb", "small"), [(64, True), (512, True), (513, False), (4096, False)])
def test_only_the_quick_compiler_compiles_a_run_of_little_heap(heap_mb: int, small: bool) -> None:
    command = command_line(declared("MC_toy", heap_mb=heap_mb), TOOLS, Path("/states"))
    assert (QUICK in command) == small
    if small:
        assert command.index(QUICK) < command.index("-cp"), "an option of Java stands before the class path"
