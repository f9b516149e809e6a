"""The register of contracts gives the header its contract, and what does not fit is refused by name."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from modeproof.kit.contract import Watch
from modeproof.kit.vectors import open_suite
from modeproof.registers.load import load_interface
from modeproof.suites.contract import load_contract
from modeproof.suites.lint import lint
from tests.suites.test_conform_command import toy as toy  # the fixture

PROPERTIES = '[[property]]\nid = "LightNeedsCode"\nclauses = ["TOY-1"]\n'
CONTRACT = """
[contract.lamp]
constants = { CODE = 0x0FF0 }

[contract.lamp.rules]
codes = { recent = "press and word == CODE" }

[contract.lamp.property.LightNeedsCode]
says = "The lamp goes on only with its code."
when = "LAMP and not was_LAMP"
holds = "True in codes"
"""


def declare(place: Path, contract: str = CONTRACT, properties: str = PROPERTIES) -> None:
    (place / "spec/toy/contracts.toml").write_text(contract, encoding="utf-8")
    (place / "spec/toy/properties.toml").write_text(properties, encoding="utf-8")


def built(place: Path) -> Path:
    assert main(["vectors", "build", "lamp", "--suite", "sic"]) == 0
    return place / "build/vectors/toy/lamp/sic.jsonl.gz"


def test_a_document_without_contracts_has_no_relation_monitor(toy: Path) -> None:
    suite = open_suite(built(toy))
    assert suite.relations == ("exact", "settled") and suite.contract() is None


def test_a_contract_enters_the_header_with_clauses_and_rebuilds(toy: Path) -> None:
    before = built(toy).read_bytes()
    declare(toy)
    path = built(toy)
    assert path.read_bytes() != before, "a suite older than the contract was kept"
    suite = open_suite(path)
    contract = suite.contract()
    assert suite.relations == ("exact", "settled", "monitor") and contract is not None
    (one,) = contract.properties
    assert (one.id, one.clauses) == ("LightNeedsCode", ("TOY-1",)) and one.outputs == {"LAMP"}
    assert lint(path) == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (".LightNeedsCode]", ".LightNeedsCod]", "'LightNeedsCod' is not in properties.toml"),
        ("True in codes", "True in code", "unknown name 'code'"),
        ("{ recent", "{ rescent", "rule 'codes' is a text, or a table with recent"),
        ('CODE" }', 'CODE", starts = true }', "rule 'codes': unknown key starts"),
        ("CODE = 0x0FF0", "CODA = 0x0FF0", "unknown name 'CODE'"),
        ('says = "', 'say = "', "unknown key say"),
        ("lamp.property", "lamp.properties", "unknown key properties"),
        ("was_LAMP", "was_lamp", "unknown name 'was_lamp'"),
        ("[contract.lamp]", "[contract.lamp", "spec/toy/contracts.toml"),
        ("[contract.lamp]", '[contract.lamp]\ntables = ["REE"]', "has no table 'REE'"),
    ],
)
def test_what_does_not_fit_is_refused(toy: Path, old: str, new: str, said: str) -> None:
    assert CONTRACT.count(old) == 1
    declare(toy, CONTRACT.replace(old, new))
    with pytest.raises(Unjudged) as caught:
        load_contract(toy, "toy", load_interface(toy, "toy").devices["lamp"], [])
    assert said in str(caught.value) and "\n" not in str(caught.value)


def repository_contracts() -> list[tuple[str, str]]:
    place = root()
    return [
        (path.parent.name, device)
        for path in sorted(place.glob("spec/*/contracts.toml"))
        for device in load_interface(place, path.parent.name).devices
    ]


@pytest.mark.parametrize(("document", "device"), repository_contracts())
def test_what_the_repository_declares_fits(document: str, device: str) -> None:
    declared = load_interface(root(), document).devices[device]
    table = load_contract(root(), document, declared, [0, 1, 2, 3, 4])
    assert (table is not None) == declared.published
    if table is not None:
        assert all(row["clauses"] for row in table["properties"])


def test_the_specification_itself_keeps_the_contracts() -> None:
    """On the vectors at hand: what the graph expects breaks no property, and puts each to the test."""
    suite = open_suite(root() / "examples/c/settled.jsonl.gz")
    contract = suite.contract()
    assert contract is not None
    watch = Watch(contract)
    for case in suite.cases():
        watch.reset(case.params)
        for scan in case.scans:
            assert watch.scan(scan.dt_ms, scan.inputs, scan.outputs) is None, case.id
    assert all(watch.counts.values())
