"""The devices of the mode selection: proved as they are, and refuted with a fault."""

from __future__ import annotations

from pathlib import Path

import pytest

from programs.certificates import equality_certificate as certificate
from programs.certificates.recheck import recheck
from programs.equality.comparison import make
from programs.equality.replay import replay
from programs.equality.verdict import Verdict, judge

ROOT = Path(__file__).parents[3]
PROGRAMS = ROOT / "examples" / "st"
FAULTS = {
    "an echo of another mode": ("16#3C3C: MW05 := 16#0F0F;", "16#3C3C: MW05 := 16#0FF0;"),
    "a selection from the wrong word": ("selected := MW03", "selected := MW07"),
    "a key that is gone and not noticed": ("ELSIF NOT LA OR word <> level", "ELSIF word <> level"),
}


def silent(text: str) -> None:
    """Nothing is told."""


def judged(path: Path, target: str, wrap: bool = False, profile: str = "letter") -> Verdict:
    """The verdict on a program; the scans of a difference are only made fewer by leaving some out."""
    return judge(
        make([path], target, binding={"profile": profile}, wrap=wrap),
        ROOT / "vectors" / target,
        120,
        silent,
        fewest=False,
    )


@pytest.mark.deep
def test_the_fplc_is_proved_equal() -> None:
    found = judged(PROGRAMS / "fplc.st", "fplc", profile="cautious")
    word, pairs = found.word, len(found.product.nodes)  # a product takes pytest minutes to print
    assert (word, pairs) == ("PROVED", 18)
    relations = {str(relation) for node in found.product.nodes.values() for relation in node.relations}
    assert "r:elapsed_ms + p:LEFT = g:T_DWELL_ms" in relations


@pytest.mark.long
def test_the_other_encoding_is_proved_and_checked_again(tmp_path: Path) -> None:
    found = judged(PROGRAMS / "fplc_flags.st", "fplc", wrap=True)
    assert found.word == "PROVED" and found.replayed is not None
    made = certificate.write(found.product, found.replayed, tmp_path / "made")
    assert made.keys() == found.product.nodes.keys()
    again = recheck(tmp_path / "made")
    assert again.status == 0 and again.product.wrap and not again.unreached


@pytest.mark.long
def test_the_fplc_in_statement_list_is_proved_equal() -> None:
    found = judged(ROOT / "examples" / "awl" / "fplc.awl", "fplc")
    word, pairs = found.word, len(found.product.nodes)  # a product takes pytest minutes to print
    assert (word, pairs) == ("PROVED", 18)
    relations = {str(relation) for node in found.product.nodes.values() for relation in node.relations}
    assert any("g:PERMITS_4" in text for text in relations)
    assert "r:elapsed_ms = min(p:DB10_D22, g:T_DWELL_ms)" in relations
    assert "p:DB10_D22 <= 3600000" in relations


@pytest.mark.deep
@pytest.mark.parametrize("target", ["plc", "hmi"])
def test_the_other_devices_are_proved_equal(target: str) -> None:
    found = judged(PROGRAMS / f"{target}.st", target)
    assert found.word == "PROVED" and not found.product.binding.left_out


@pytest.mark.deep
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_of_the_fplc_is_refuted(name: str, tmp_path: Path) -> None:
    text = (PROGRAMS / "fplc.st").read_text("utf-8")
    assert text.count(FAULTS[name][0]) == 1
    path = tmp_path / "fplc.st"
    path.write_text(text.replace(*FAULTS[name]), "utf-8")
    found = judged(path, "fplc", profile="cautious")
    assert found.word == "REFUTED" and found.difference is not None
    again = replay(found.product.binding, False, found.difference.run, "")
    assert again is not None and again.differing == found.difference.differing
    assert len(found.difference.scans) <= 14
