"""The command `modeproof map`: an address map to start from, and the check of one that was written."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_AS_EXPECTED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import root
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.signals import Signal, read_signals
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device
from modeproof.s7.map import proposed_map, read_map
from modeproof.suites.build import find_target
from modeproof.suites.demands import declare, declare_parameters


def add_parser(commands: Any) -> None:
    """Add `map`; its exit status is 0, or 2 for a map that cannot be used."""
    parser = commands.add_parser("map")
    parser.add_argument("target", metavar="TARGET", help="a device of the interface register")
    parser.add_argument("--document", metavar="NAME", help="the document of the target, where two have one")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write there instead of to standard output")
    parser.add_argument("--check", type=Path, metavar="FILE", help="instead: check this map")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Run `map`. Raises Unjudged naming line and symbol of a map that cannot be used."""
    place = root()
    document, device = find_target(place, args.target, args.document)
    modes = [int(mode) for mode in load_interface(place, document).constants.get("MODES", ())]
    inputs, outputs, parameters = signals_of(device, modes)
    if args.check is not None:
        try:
            found = read_map(args.check, inputs, outputs, parameters)
        except KitUnjudged as error:
            raise Unjudged(str(error)) from None
        count = len(found.inputs) + len(found.outputs) + len(found.parameters) + len(found.controls)
        left = [name for name in parameters if name not in found.parameters]
        print(
            f"{args.check}: {count} symbols of {args.target}; "
            f"unobserved: {', '.join(found.unobserved) or 'none'}; "
            f"parameters without address: {', '.join(left) or 'none'}"
        )
        return EXIT_AS_EXPECTED
    tags = {name: signal.tag for table in (device.inputs, device.outputs) for name, signal in table.items()}
    text = proposed_map(inputs, outputs, parameters, tags)
    if args.out is not None:
        write_whole(args.out, text.encode("utf-8"))
    else:
        sys.stdout.write(text)
    return EXIT_AS_EXPECTED


def signals_of(
    device: Device, modes: list[int]
) -> tuple[dict[str, Signal], dict[str, Signal], dict[str, Signal]]:
    """Inputs, outputs and parameters as the header of a vector file declares them."""
    tables = declare(device.inputs, modes), declare(device.outputs, modes), declare_parameters(device, modes)
    inputs, outputs, parameters = (read_signals(table, device.id) for table in tables)
    return inputs, outputs, parameters
