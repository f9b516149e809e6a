"""A statement-list source as JSON: its blocks, instructions, addresses and data, as awlsim resolves them.

Usage: python examples/awl/tree.py PROGRAM     an AWL source; if it has symbols, symbols.csv lies beside it

`modeproof prove-program FILE.awl` runs this in a process of its own, for awlsim is GPL-2.0-or-later and is
imported in this folder alone. Mnemonics come out in English. Exit status 3: the source cannot be read.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

SYMBOLS = "symbols.csv"


def operand(of: Any, kinds: dict[int, str]) -> dict[str, Any]:
    """An operand: its kind, width in bits, address, value and text."""
    offset = of.offset
    return {
        "kind": kinds[of.operType],
        "width": of.width,
        "byte": 0 if offset is None else offset.byteOffset,
        "bit": 0 if offset is None else offset.bitOffset,
        "db": -1 if offset is None else offset.dbNumber,
        "value": of.immediate if isinstance(of.immediate, int) else 0,
        "label": of.labelIndex if kinds[of.operType] == "LBL_REF" else -1,
        "text": str(of),
    }


def instruction(of: Any, names: dict[int, str], kinds: dict[int, str], labels: list[int]) -> dict[str, Any]:
    """An instruction with its line, operands, parameters of a call, and where it jumps to."""
    operands = [operand(one, kinds) for one in of.ops]
    targets = [labels[one["label"]] for one in operands if one["label"] >= 0]
    return {
        "line": of.getLineNr(),
        "op": names[of.insnType],
        "operands": operands,
        "target": targets[0] if targets else -1,
        "parameters": [
            {"name": one.lvalueName, "operand": operand(one.rvalueOp, kinds)} for one in of.params
        ],
    }


def fields(struct: Any) -> list[dict[str, Any]]:
    """The named fields of a structure with their addresses."""
    return [
        {
            "name": field.name,
            "byte": field.offset.byteOffset,
            "bit": field.offset.bitOffset,
            "width": field.bitSize,
            "type": str(field.dataType),
        }
        for field in (struct.fields if struct else [])
        if field.name
    ]


def program(path: Path) -> dict[str, Any]:
    """The whole program. Raises AwlSimError."""
    from awlsim.core.instructions.types import AwlInsnTypes
    from awlsim.core.operatortypes import AwlOperatorTypes
    from awlsim_loader.core import AwlSim, SymTabParser  # isort: skip -- the compiler needs it first
    from awlsim_loader.awlcompiler import AwlParser

    parser, sim = AwlParser(), AwlSim()
    parser.parseText(path.read_text(encoding="utf-8"))
    symbols = path.parent / SYMBOLS
    if symbols.is_file():
        sim.loadSymbolTable(SymTabParser.parseText(symbols.read_text(encoding="utf-8")))
    sim.load(parser.getParseTree())
    sim.build()
    cpu = sim.cpu
    names = AwlInsnTypes.type2name_english
    kinds = {value: key for key, value in vars(AwlOperatorTypes).items() if isinstance(value, int)}
    kinds |= {v: k for k, v in vars(type(AwlOperatorTypes)).items() if isinstance(v, int) and k.isupper()}
    blocks = {}
    for kind, found in (("OB", cpu.allOBs()), ("FB", cpu.allFBs()), ("FC", cpu.allFCs())):
        for block in found:
            labels = [label.insn.getIP() for label in block.labels or []]
            face = block.interface
            groups = {"in": face.fields_IN, "out": face.fields_OUT, "inout": face.fields_INOUT}
            blocks[f"{kind} {block.index}"] = {
                "sections": {field.name.upper(): name for name, group in groups.items() for field in group},
                "fields": fields(face._struct),
                "temporary": [
                    {"name": field.name, "type": str(field.dataType)} for field in face.fields_TEMP
                ],
                "instructions": [instruction(one, names, kinds, labels) for one in block.insns],
            }
    data = {
        f"DB {block.index}": {
            "fields": fields(block.struct),
            "bytes": bytes(block.structInstance.memory.getDataBytes()).hex(),
        }
        for block in cpu.allDBs()
        if block.structInstance
    }
    return {"blocks": blocks, "data": data}


def main(arguments: list[str]) -> int:
    """Print the program."""
    if len(arguments) != 1:
        print("usage: python tree.py PROGRAM", file=sys.stderr)
        return 2
    answers, sys.stdout = sys.stdout, sys.stderr  # whatever awlsim may print is no answer
    try:
        from awlsim.common.exceptions import AwlSimError
    except ImportError as error:
        print(f"{error}; pip install -r examples/awl/requirements.lock", file=sys.stderr)
        return 2
    try:
        found = program(Path(arguments[0]))
    except AwlSimError as error:
        line = error.getLineNr()
        text = " ".join(str(error.message if hasattr(error, "message") else error).split())
        print(json.dumps({"line": line if isinstance(line, int) else 0, "text": text[:300]}), file=answers)
        return 3
    print(json.dumps(found), file=answers)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
