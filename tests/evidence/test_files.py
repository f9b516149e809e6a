"""Evidence appears whole or not at all, and only what the schema allows is written or read."""

from __future__ import annotations

import errno
import json
import os
import time
from pathlib import Path
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole


def record(**changes: Any) -> dict[str, Any]:
    made = evidence.make(
        kind="tlc",
        id="MC_toy",
        document="toy",
        verdict="HOLDS",
        expected="HOLDS",
        as_expected=True,
        command="modeproof check MC_toy",
        started=time.time(),
        seconds=1.25,
        inputs={"spec/toy/Toy.tla": "0" * 64},
        result={"distinct": 16},
    )
    return {**made, **changes}


def test_what_was_written_is_read_back(tmp_path: Path) -> None:
    path = evidence.write(tmp_path, record())
    assert path == tmp_path / "build/evidence/toy/MC_toy.json"
    there = evidence.read(path)
    assert evidence.is_sealed(there)
    assert there == record(started=there["started"], seal=there["seal"])
    assert evidence.read_document(tmp_path, "toy") == (evidence.read(path),)


def test_the_machine_and_our_own_code_are_always_recorded() -> None:
    made = record()
    assert made["machine"]["cores"] >= 1 and made["machine"]["memory_mb"] > 0
    assert len(made["tools"]["modeproof"]["sha256"]) == 64 and made["tools"]["python"]["version"]


@pytest.mark.parametrize(
    "changes",
    [
        {"verdict": "PASSED"},
        {"kind": "guess"},
        {"id": "../escape"},
        {"schema_version": 2},
        {"inputs": {"a": "no hash"}},
        {"seconds": -1},
        {"surprise": 1},
        {"started": "yesterday"},
        {"verdict": "INCONCLUSIVE"},  # and yet as expected
        {"verdict": "UNJUDGED"},
        {"as_expected": False},  # without a reason
    ],
)
def test_a_record_that_breaks_the_schema_is_not_written(tmp_path: Path, changes: dict[str, Any]) -> None:
    with pytest.raises(Unjudged, match="not valid evidence at"):
        evidence.write(tmp_path, record(**changes))
    assert not (tmp_path / "build").exists()


def test_a_missing_field_is_not_written(tmp_path: Path) -> None:
    for field in record().keys() - {"seal"}:
        short = {key: value for key, value in record().items() if key != field}
        with pytest.raises((Unjudged, KeyError)):
            evidence.write(tmp_path, short)
    assert not (tmp_path / "build").exists()


@pytest.mark.parametrize("call", ["fsync", "replace"])
def test_a_full_disk_is_one_line_and_keeps_old_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    path = evidence.write(tmp_path, record(seconds=1.0))
    before = path.read_bytes()

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, call, full)
    with pytest.raises(Unjudged, match=r"MC_toy\.json: cannot be written: No space left on device"):
        evidence.write(tmp_path, record(seconds=2.0))
    monkeypatch.undo()
    assert path.read_bytes() == before
    assert [one.name for one in path.parent.iterdir()] == ["MC_toy.json"]


def test_a_disk_that_fills_up_while_writing_leaves_nothing(tmp_path: Path) -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("no /dev/full here")
    (tmp_path / "build").symlink_to("/dev/full")
    with pytest.raises(Unjudged, match="cannot be written"):
        evidence.write(tmp_path, record())


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "build").write_text("a file, not a folder")
    with pytest.raises(Unjudged, match="cannot be written: "):
        write_whole(tmp_path / "build" / "x.json", b"{}")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "not JSON"),
        ('{"schema_version": 1', "not JSON"),
        ("[]", "not valid evidence"),
        ("{}", "not valid"),
    ],
)
def test_evidence_that_is_cut_off_or_empty_is_not_read(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "MC_toy.json"
    path.write_text(text)
    with pytest.raises(Unjudged, match=words):
        evidence.read(path)


def test_evidence_under_another_name_is_not_read(tmp_path: Path) -> None:
    path = evidence.write(tmp_path, record())
    with pytest.raises(Unjudged, match="holds the evidence of toy/MC_toy"):
        evidence.read(path.rename(path.with_name("MC_other.json")))
    with pytest.raises(Unjudged, match="No such file"):
        evidence.read(path)


def test_discarded_evidence_is_gone(tmp_path: Path) -> None:
    path = evidence.write(tmp_path, record())
    evidence.discard(tmp_path, "toy", "MC_toy")
    evidence.discard(tmp_path, "toy", "MC_toy")
    assert not path.exists()


def test_evidence_of_runs_that_are_declared_no_more_is_removed(tmp_path: Path) -> None:
    kept = evidence.write(tmp_path, record())
    stale = evidence.write(tmp_path, record(id="MC_gone"))
    proof = evidence.write(tmp_path, record(id="theorem", kind="proof"))
    broken = stale.with_name("broken.json")
    broken.write_text("{")
    evidence.discard_undeclared(tmp_path, "toy", "tlc", {"MC_toy"})
    assert [path.exists() for path in (kept, stale, proof, broken)] == [True, False, True, False]


def test_inputs_are_hashed_by_their_path_in_the_repository(tmp_path: Path) -> None:
    (tmp_path / "a b").write_bytes(b"")
    empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    assert evidence.hashes(tmp_path, [tmp_path / "a b"]) == {"a b": empty}
    with pytest.raises(Unjudged, match="lies outside"):
        evidence.hashes(tmp_path / "elsewhere", [tmp_path / "a b"])
    with pytest.raises(Unjudged, match="No such file"):
        evidence.hashes(tmp_path, [tmp_path / "none"])


def test_the_schema_is_itself_valid() -> None:
    import jsonschema

    schema = json.loads((Path(evidence.__file__).parent / "schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
