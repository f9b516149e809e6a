"""What cannot be shown of a program is shown of the reference, if the program is proved to be the same."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from programs.certificates.demand_certificate import judgement_of
from programs.certificates.recheck import folders_of
from programs.commands import prove_program
from programs.commands.by_equality import by_equality
from programs.commands.following import Followed
from programs.demands.verdicts import TYPES, Asked, Found, Judgement
from programs.equality.comparison import make

SWITCH = root() / "examples/st/sf_enable_switch.st"


class Tired(Judgement):
    """Shows nothing of one demand."""

    left = "NoEnableInError"

    def all(self) -> list[Found]:
        return [
            Found(one.asked, "UNKNOWN", "no proof") if one.asked.id == self.left else one
            for one in super().all()
        ]


def tired(*given: Any) -> Judgement:
    judgement = judgement_of(*given)
    return Tired(judgement.beside, judgement.vectors, judgement.seconds, judgement.tell, judgement.wrap)


def unknown() -> Followed:
    """A program of which nothing is shown."""
    product = make([SWITCH], "sf_enable_switch", codes=False)
    judgement = judgement_of(product, {}, 1, None, 20.0, lambda text: None)
    found = [Found(Asked(TYPES, "types"), "UNKNOWN", "no proof")]
    found += [Found(Asked.of(row), "UNKNOWN", "no proof") for row in judgement.beside.rows]
    return Followed(product, judgement, found)


@pytest.mark.deep
def test_each_demand_is_asked_of_the_reference() -> None:
    followed = by_equality(unknown())
    assert followed.word == "FOLLOWS" and all(one.by_equality for one in followed.found)
    assert followed.found[0].how == "part of equality"
    assert all(one.how.startswith("of the reference by ") for one in followed.rows)


def test_what_the_reference_does_not_keep_stays_open(monkeypatch: pytest.MonkeyPatch) -> None:
    denied: Callable[..., Found] = lambda self, id: Found(Asked(id, ""), "BROKEN", "scans")  # noqa: E731
    monkeypatch.setattr(Judgement, "one", denied)
    assert {one.word for one in by_equality(unknown()).rows} == {"UNKNOWN"}


@pytest.mark.deep
@pytest.mark.long
def test_both_certificates_are_written_and_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(prove_program, "judgement_of", tired)
    folder = tmp_path / "certificate"
    args = ["prove-program", str(SWITCH), "--target", "sf_enable_switch", "--certificate", str(folder)]
    assert main(args) == 0
    said = capsys.readouterr().out
    assert "FOLLOWS" in said and f"by equality {Tired.left}" in said
    assert "of equality" in said and "of the demands, of the reference" in said
    assert main(["prove-program", "--recheck", str(folder)]) == 0
    assert "the certificate in the folder above shows it to be equal" in capsys.readouterr().out
    with pytest.raises(Unjudged, match="name the folder above"):
        folders_of(folder / "follows")
    file = folder / "follows" / "certificate.json"
    file.write_text(json.dumps({**json.loads(file.read_text("utf-8")), "unit": "Other"}), "utf-8")
    with pytest.raises(Unjudged, match="its unit is not that of the certificate"):
        folders_of(folder)
