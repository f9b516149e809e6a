"""The register of demands says what a document asks of a device, and what does not fit is refused by name."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.demands import Watch
from modeproof.kit.vectors import open_suite
from modeproof.registers.load import load_interface
from modeproof.suites.demands import load_demands
from tests.suites.test_conform_command import toy as toy  # the fixture

DEMANDS = """
[device.lamp]
constants = { CODE = 0x0FF0 }

[device.lamp.rules]
codes = { recent = "press and word == CODE" }

[device.lamp.demand.LightNeedsCode]
says = "The lamp goes on only with its code."
clauses = ["TOY-1"]
when = "LAMP and not was_LAMP"
holds = "True in codes"
"""


def declare(place: Path, demands: str = DEMANDS) -> None:
    (place / "spec/toy/demands.toml").write_text(demands, encoding="utf-8")


def test_a_document_without_the_register_demands_nothing(toy: Path) -> None:
    assert load_demands(toy, "toy", load_interface(toy, "toy").devices["lamp"]) is None


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("True in codes", "True in code", "unknown name 'code'"),
        ("{ recent", "{ rescent", "rule 'codes' is a text, or a table with recent"),
        ('CODE" }', 'CODE", starts = true }', "rule 'codes': unknown key starts"),
        ("CODE = 0x0FF0", "CODA = 0x0FF0", "unknown name 'CODE'"),
        ('says = "', 'say = "', "unknown key say"),
        ("lamp.demand", "lamp.demands", "unknown key demands"),
        ('holds = "True in codes"', "", "either `holds` or `comes`"),
        ("was_LAMP", "was_lamp", "unknown name 'was_lamp'"),
        ("[device.lamp]", "[device.lamp", "spec/toy/demands.toml"),
        ("[device.lamp]", '[device.lamp]\ntables = ["REE"]', "has no table 'REE'"),
    ],
)
def test_what_does_not_fit_is_refused(toy: Path, old: str, new: str, said: str) -> None:
    assert DEMANDS.count(old) == 1
    declare(toy, DEMANDS.replace(old, new))
    with pytest.raises(Unjudged) as caught:
        load_demands(toy, "toy", load_interface(toy, "toy").devices["lamp"])
    assert said in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("document", "target", "name"),
    [
        ("edm", "sf_edm", "DiagCode"),
        ("edm", "sf_edm", "AFTER_RESET"),
        ("enable_switch", "sf_enable_switch", "ResetRequest"),
    ],
)
def test_a_demand_names_nothing_of_ours(tmp_path: Path, document: str, target: str, name: str) -> None:
    room = tmp_path / "spec" / document
    shutil.copytree(root() / "spec" / document, room)
    (room / "demands.toml").write_text(
        f"[device.{target}.demand.Ours]\nsays = 'o.'\nclauses = ['C']\nwhen = 'True'\nholds = '{name} == 0'\n"
    )
    with pytest.raises(Unjudged, match=f"demand 'Ours': unknown name '{name}'"):
        load_demands(tmp_path, document, load_interface(tmp_path, document).devices[target])


def every_device() -> list[tuple[str, str]]:
    place = root()
    return [
        (path.parent.name, device)
        for path in sorted(place.glob("spec/*/demands.toml"))
        for device in load_interface(place, path.parent.name).devices
    ]


@pytest.mark.parametrize(("document", "device"), every_device())
def test_what_the_repository_declares_fits(document: str, device: str) -> None:
    declared = load_interface(root(), document).devices[device]
    table = load_demands(root(), document, declared)
    assert (table is not None) == declared.published
    if table is not None:
        assert all(row["clauses"] for row in table["demands"])


@pytest.mark.parametrize("target", ["fplc", "plc", "hmi"])
def test_the_specification_itself_does_what_is_demanded(target: str) -> None:
    """In its published sequences: what the graph expects breaks no demand, and puts each to the test."""
    device = load_interface(root(), "mode_selection").devices[target]
    table = load_demands(root(), "mode_selection", device)
    suite = open_suite(root() / f"vectors/{target}/sequences.jsonl.gz").demanding(table)
    demands = suite.demands()
    assert demands is not None
    for latency in (0, 1):
        watch = Watch(demands, latency)
        for case in suite.cases():
            watch.reset(case.params)
            for scan in case.scans:
                assert watch.scan(scan.dt_ms, scan.inputs, scan.outputs) is None, case.id
        assert all(watch.counts.values()), watch.counts
