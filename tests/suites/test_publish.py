"""The room vectors/: what is published is what is built, and says which specification it was made from."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents, root
from modeproof.kit.vectors import open_suite
from modeproof.registers.load import load_interface
from modeproof.registers.vector_files import check_vectors
from modeproof.suites.build import published
from modeproof.suites.kinds import SUITES
from modeproof.suites.lint import lint
from modeproof.suites.publish import Published, _same, publish
from tests.suites.test_conform_command import INTERFACE
from tests.suites.test_conform_command import toy as toy  # the fixture


def put(toy: Path) -> Published:
    """Build the suites of the toy, and bring its room up to date."""
    assert main(["vectors", "build"]) == 0
    return publish(toy, published(toy))


def test_what_was_built_is_published_unless_it_is_the_same(
    toy: Path,
) -> None:
    put(toy)
    files = sorted((toy / "vectors/lamp").glob("*"))
    assert {one.name.split(".")[0] for one in files} >= {"brief", "words"}
    for one in files:
        assert one.read_bytes() == (toy / "build/vectors/toy/lamp" / one.name).read_bytes()
    assert (toy / "vectors/vectors.schema.json").is_file()
    (toy / "vectors/lamp/old.jsonl.gz").write_bytes(b"")
    packed_otherwise = gzip.compress(gzip.decompress(files[0].read_bytes()), 1)
    files[0].write_bytes(packed_otherwise)
    done = put(toy)
    assert done.removed == ("vectors/lamp/old.jsonl.gz",) and not done.written
    assert files[0].read_bytes() == packed_otherwise


def test_a_file_with_the_same_lines_is_kept(tmp_path: Path) -> None:
    def packed(name: str, level: int, case: str = "{}") -> Path:
        (tmp_path / name).write_bytes(gzip.compress(f'{{"cases": 1}}\n{case}\n'.encode(), level))
        return tmp_path / name

    ours = packed("a.jsonl.gz", 9)
    other = packed("b.jsonl.gz", 0)
    assert ours.read_bytes() != other.read_bytes() and _same(ours, other)
    assert not _same(ours, packed("c.jsonl.gz", 9, "[]"))


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (
            "register",
            "spec/toy/interface.toml has changed since it was published; if that was not meant, undo it",
        ),
        ("cfg", "spec/toy/runs.toml, OPEN_Lamp has changed"),
        ("comment", ""),
        ("cut", "is no file of vectors"),
        ("header", "is no file of vectors"),
        ("edited", "was changed since it was published, says vectors/SHA256SUMS"),
        ("settling", "compares nothing in case lamp-"),
        ("unlisted", "is not in SHA256SUMS"),
        ("gone", "is not there"),
    ],
)
def test_a_published_file_of_another_text_is_found_without_rebuilding(
    toy: Path, spoil: str, said: str
) -> None:
    put(toy)
    assert check_vectors(toy) == []
    path = toy / "vectors/lamp/brief.jsonl.gz"
    if spoil == "register":
        (toy / "spec/toy/interface.toml").write_text(INTERFACE)
    elif spoil == "cfg":
        (toy / "spec/toy/models/OPEN_Lamp.cfg").write_text("SPECIFICATION Other\nINVARIANT PrintState\n")
    elif spoil == "comment":
        for name in ("Lamp.tla", "interface.toml"):
            text = (toy / "spec/toy" / name).read_text()
            mark = "\\* a comment\n" if name.endswith(".tla") else "# a comment\n"
            end = text.rindex("====") if name.endswith(".tla") else len(text)
            (toy / "spec/toy" / name).write_text(f"{text[:end]}{mark}{text[end:]}")
        assert check_vectors(toy) == []
        return
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
        path.write_bytes(gzip.compress(b"[]\n"))
    problems = check_vectors(toy)
    file = "vectors/lamp" if spoil in ("register", "cfg") else "vectors/lamp/brief.jsonl.gz"
    assert any(said in str(one) and one.file == file for one in problems)


def test_a_file_that_the_linter_refuses_is_not_published(toy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("modeproof.suites.publish.lint", lambda path: ["planted"])
    with pytest.raises(Unjudged, match="is not published: planted"):
        put(toy)
    assert not (toy / "vectors/lamp").exists()


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
