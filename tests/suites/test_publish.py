"""The room vectors/: what is published is what is built, and says which specification it was made from."""

from __future__ import annotations

import gzip
import json
import re
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.places import documents, root
from modeproof.kit.vectors import open_suite
from modeproof.registers.load import load_interface
from modeproof.registers.vector_files import check_vectors
from modeproof.suites.kinds import SUITES
from modeproof.suites.lint import lint
from modeproof.suites.publish import _same
from tests.suites.test_conform_command import toy as toy  # the fixture


def test_what_was_built_is_published_unless_it_is_the_same(
    toy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["vectors", "publish"]) == 0
    files = sorted((toy / "vectors/lamp").glob("*"))
    assert {one.name.split(".")[0] for one in files} >= {"brief", "words"}
    for one in files:
        assert one.read_bytes() == (toy / "build/vectors/toy/lamp" / one.name).read_bytes()
    assert (toy / "vectors/vectors.schema.json").is_file()
    (toy / "vectors/lamp/old.jsonl.gz").write_bytes(b"")
    packed_otherwise = gzip.compress(gzip.decompress(files[0].read_bytes()), 1)
    files[0].write_bytes(packed_otherwise)
    capsys.readouterr()
    assert main(["vectors", "publish"]) == 0
    said = capsys.readouterr().out
    assert "vectors/lamp/old.jsonl.gz: removed" in said and "0 files written" in said
    assert files[0].read_bytes() == packed_otherwise


def test_a_file_that_other_code_makes_the_same_is_kept(tmp_path: Path) -> None:
    def packed(name: str, code: str, spec: str, case: str = "{}") -> Path:
        sources = {"modeproof/suites/tour.py": code, "spec/toy/Lamp.tla": spec}
        lines = [json.dumps({"cases": 1, "sources": sources}), case]
        (tmp_path / name).write_bytes(gzip.compress("\n".join(lines).encode()))
        return tmp_path / name

    ours = packed("a.jsonl.gz", "1", "1")
    assert _same(ours, packed("b.jsonl.gz", "2", "1"))
    assert not _same(ours, packed("c.jsonl.gz", "1", "2"))
    assert not _same(ours, packed("d.jsonl.gz", "1", "1", "[]"))


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        ("register", "spec/toy/classes.toml has changed; run modeproof vectors publish"),
        ("cut", "is no file of vectors"),
        ("header", "is no file of vectors"),
        ("sources", "does not say which specification"),
        ("edited", "was changed since it was published, says vectors/SHA256SUMS"),
        ("settling", "compares nothing in case lamp-"),
        ("unlisted", "is not in SHA256SUMS"),
        ("gone", "is not there"),
    ],
)
def test_a_published_file_of_another_text_is_found_without_rebuilding(
    toy: Path, spoil: str, said: str
) -> None:
    assert main(["vectors", "publish"]) == 0
    assert check_vectors(toy) == []
    path = toy / "vectors/lamp/brief.jsonl.gz"
    if spoil == "register":
        (toy / "spec/toy/classes.toml").write_text("")
    elif spoil == "cut":
        path.write_bytes(path.read_bytes()[:40])
    elif spoil in ("edited", "settling"):
        header, *cases = gzip.decompress(path.read_bytes()).splitlines(keepends=True)
        old, new = (b"true", b"false") if spoil == "edited" else (b'"dt_ms"', b'"settling":true,"dt_ms"')
        assert old in cases[0]
        path.write_bytes(gzip.compress(b"".join([header, cases[0].replace(old, new), *cases[1:]])))
        assert spoil == "edited" or any("every scan is settling" in problem for problem in lint(path))
    elif spoil == "unlisted":
        (toy / "vectors/SHA256SUMS").write_text("")
    elif spoil == "gone":
        path.unlink()
    else:
        path.write_bytes(gzip.compress(b"[]\n" if spoil == "header" else b'{"sources":{}}\n'))
    problems = check_vectors(toy)
    assert problems and any(
        said in str(one) and one.file == "vectors/lamp/brief.jsonl.gz" for one in problems
    )


def test_a_file_that_the_linter_refuses_is_not_published(
    toy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("modeproof.suites.publish.lint", lambda path: ["planted"])
    assert main(["vectors", "publish"]) == 2
    assert "is not published: planted" in capsys.readouterr().err and not (toy / "vectors/lamp").exists()


def test_every_published_target_has_its_fast_suites() -> None:
    place = root()
    missing = [
        f"{target} {suite}"
        for document in documents(place)
        for target, device in load_interface(place, document).devices.items()
        if device.published
        for suite, about in SUITES.items()
        if about.published and about.always and not (place / f"vectors/{target}/{suite}.jsonl.gz").is_file()
    ]
    assert missing == []
    assert check_vectors(place) == []
    for path in (place / "vectors").glob("*/*.jsonl.gz"):
        suite = open_suite(path)
        assert (suite.target, f"{suite.name}.jsonl.gz") == (path.parent.name, path.name)


def test_the_lines_of_python_in_the_readme_read_a_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(root())
    code = re.search(r"```python\n(.*?)```", Path("vectors/README.md").read_text(), re.DOTALL)
    assert code is not None
    found: dict[str, object] = {}
    exec(code[1], found)
    header = found["header"]
    assert isinstance(header, dict)
    assert capsys.readouterr().out.count(f"{header['target']}-") == header["cases"]
    assert isinstance(found["outputs"], dict) and len(found["outputs"]) > 1
