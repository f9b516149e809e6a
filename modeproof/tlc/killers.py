"""Judges by TLC whether a property fails with the edit that killers.toml has for it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

import msgspec

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build
from modeproof.registers.cfg import parse_cfg
from modeproof.registers.citations import Sources, read_sources
from modeproof.registers.edits import write_stamps
from modeproof.registers.killers import Killer, edited, load_killers, run_of, stamps_of
from modeproof.registers.load import load_document
from modeproof.registers.made import cfg_text, root_module
from modeproof.registers.pins import load_pins
from modeproof.registers.rows import Document
from modeproof.registers.runs import Run
from modeproof.tlc import children
from modeproof.tlc.process import run_tlc
from modeproof.tlc.run_judge import VIOLATED, Judgement, judge
from modeproof.tlc.toolchain import Toolchain

ROOT = "Killed"
"""The root module of such a run."""


def judge_killer(document: Document, sources: Sources, killer: Killer, tools: Toolchain) -> Judgement:
    """What TLC says of the property, which alone is asked, with the edit.

    Raises Unjudged: the row cannot be used; TLC gives no verdict.
    """
    killers = load_killers(document.root, document.name)
    text = edited(document, sources, killers, killer)
    return run_with(document, run_of(document, killers, killer), {killer.module: text}, tools)


def run_with(document: Document, run: Run, texts: Mapping[str, str], tools: Toolchain) -> Judgement:
    """What TLC says of a run of `run_of`, with these texts in the place of the modules of these names.

    Raises Unjudged when it says nothing, or the cfg does not ask every property of the run.
    """
    cfg = cfg_text(document.root, run)
    asked = parse_cfg(cfg, run.config)
    if lost := [name for name in run.properties if name not in asked.checked]:
        raise Unjudged(f"{document.name}: {run.id}: its cfg does not check {', '.join(lost)}")
    rooms = build(document.root) / "tlc" / document.name
    rooms.mkdir(parents=True, exist_ok=True)
    with children.room("killer.", rooms) as folder:
        for name, text in {**texts, ROOT: root_module(ROOT, run.module, ())}.items():
            (folder / f"{name}.tla").write_text(text, encoding="utf-8")
        (folder / f"{ROOT}.cfg").write_text(cfg, encoding="utf-8")
        id = folder.name.replace(".", "_")
        by_hand = msgspec.structs.replace(run, id=id, module=ROOT, cfg=f"{ROOT}.cfg", base="", workers=1)
        outcome = run_tlc(document.root, by_hand, tools, made_in=folder)
        found = judge(by_hand, asked, hashlib.sha256(cfg.encode()).hexdigest(), outcome)
        (rooms / f"{id}.log").unlink(missing_ok=True)
    if not found.judged:
        raise Unjudged(f"{document.name}: {', '.join(run.properties)}: {found.reason}")
    return found


def judge_killers(
    place: Path, name: str, tools: Toolchain, everything: bool, say: Callable[[str], None]
) -> Collection[str]:
    """Judge the edits of a document whose stamps are not of the present text, or `everything`; stamp them.

    The names of those with which their property does not fail, which are not stamped. Raises Unjudged when
    some cannot be judged: the others have been judged and stamped by then.
    """
    document = load_document(place, name)
    sources, killers = read_sources(document), load_killers(place, name)
    old = dict(load_pins(document).killers)
    new: dict[str, str] = {}
    lost: list[str] = []
    unjudged: list[str] = []
    judged = 0
    try:
        for edit, now in stamps_of(document, sources, killers).items():
            if not isinstance(now, Unjudged) and old.get(edit) == now and not everything:
                new[edit] = now
                continue
            try:
                if isinstance(now, Unjudged):
                    raise now
                found = judge_killer(document, sources, killers.edits[edit], tools)
            except Unjudged as error:
                unjudged.append(edit)
                say(f"{name}: {edit}: cannot be judged: {error.message}")
                continue
            judged += 1
            say(f"{name}: {edit}: {'fails' if found.verdict == VIOLATED else 'does not fail'}")
            if found.verdict == VIOLATED:
                new[edit] = now
            else:
                lost.append(edit)
    finally:
        kept = {edit: stamp for edit, stamp in old.items() if edit in killers.edits and edit not in lost}
        stamps = {edit: stamp for edit in killers.edits if (stamp := (kept | new).get(edit))}
        if stamps != old:
            write_stamps(document, "killers", stamps)
    say(f"{name}: {len(killers.edits)} edits, {judged} judged now, {len(lost)} break nothing")
    if unjudged:
        raise Unjudged(f"spec/{name}/killers.toml: not judged: {', '.join(unjudged)}")
    return lost
