"""The generated module names what TLC's own checks would stop at, and nothing when nothing is broken."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.registers.load import load_document
from modeproof.registers.made import cfg_text, make
from modeproof.registers.runs import load_runs
from modeproof.strength.mutant_judge import Bench
from modeproof.strength.register import Strength, Tier, load_strength
from modeproof.strength.trial import BROKEN, make_trial
from modeproof.tlc.toolchain import find_toolchain
from tests.strength.shipped import bench_of

DOCUMENT = "mode_selection"
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}
KINDS = {one.id: one.kind for one in load_document(root(), DOCUMENT).properties}
SAFETY = [run.id for run in RUNS.values() if run.kind == "NEG" and KINDS.get(str(run.property)) != "liveness"]


def names_printed(id: str, place: Path) -> set[str]:
    """What the trial of a declared run prints until the name that TLC's own check stops at.

    Its root module and its cfg are made in `place`, where they stand beside the modules of the document.
    """
    run = RUNS[id]
    shutil.copytree(root() / "spec", place / "spec", dirs_exist_ok=True)
    if run.base or not run.cfg:
        made_in, run = make(place, run)
        folder = place / "spec" / DOCUMENT
        shutil.copy(made_in / f"{run.module}.tla", folder)
        shutil.copy(made_in / run.cfg, folder)
    tier = Tier(id, (), run, "properties", "always", {}, "", (), False, 240.0, 1024)
    bench = Bench(place, Strength(DOCUMENT, {}, (tier,), ()), find_toolchain())
    found: set[str] = set()

    def watch(line: bytes) -> bool:
        match = BROKEN.fullmatch(line)
        if match is not None:
            found.add(match[1].decode())
        return run.property in found

    bench._run(tier, None, watch)
    return found


@pytest.mark.parametrize("id", ["NEG_Hmi_shows_any_echo", "NEG_Eks_no_level_check"])
def test_what_tlc_stops_at_is_among_the_names(id: str, tmp_path: Path) -> None:
    """`python -m tests.strength.test_trial` asks this about every negative run."""
    assert RUNS[id].property in names_printed(id, tmp_path)


def test_a_property_of_time_is_not_taken_apart() -> None:
    live = next(run for run in RUNS.values() if run.kind == "LIVE")
    tree = bench_of(DOCUMENT).tree(live.module)
    tier = Tier("live", (), live, "properties", "always", {}, "", (), False, 60.0, 512)
    with pytest.raises(Unjudged, match="ask for it in a tier on liveness"):
        make_trial(tree, tier, cfg_text(root(), live))


def test_another_modules_contract_is_judged_initially_and_in_every_step() -> None:
    flows = next(run for run in RUNS.values() if "RefinesModeSelection" in run.properties)
    tree = bench_of(DOCUMENT).tree(flows.module)
    tier = Tier("flows", (), flows, "properties", "always", {}, "", (), False, 60.0, 512)
    text = make_trial(tree, tier, cfg_text(root(), flows)).module
    assert "Contract!Init" in text and "Contract!Next" in text and "Contract!vars" in text


def test_the_tiers_of_the_document_are_read() -> None:
    strength = load_strength(root(), DOCUMENT)
    assert set(strength.rules) == {module for tier in strength.tiers for module in tier.modules}
    for module in strength.rules:  # every module is compared with its own graph
        assert any(tier.decides for tier in strength.tiers_of(module))


def main() -> None:
    """Ask every negative run whose property is no liveness."""
    for id in SAFETY:
        with tempfile.TemporaryDirectory() as folder:
            found = names_printed(id, Path(folder))
        print(
            "ok " if RUNS[id].property in found else "NOT", id, RUNS[id].property, sorted(found), flush=True
        )


if __name__ == "__main__":
    main()
