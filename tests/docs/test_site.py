"""The site of the docs: each page is in it, each link leads somewhere, and nothing comes from elsewhere."""

from __future__ import annotations

import importlib.util
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
_spec = importlib.util.spec_from_file_location("site_build", ROOT / "docs" / "site" / "build.py")
assert _spec is not None and _spec.loader is not None
build = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(build)


def listed(nav: Any) -> list[str]:
    """The pages of a navigation."""
    if isinstance(nav, str):
        return [nav]
    inner = nav.values() if isinstance(nav, dict) else nav
    return [page for one in inner for page in listed(one)]


def test_every_page_is_behind_a_door_once() -> None:
    nav = tomllib.loads((ROOT / "docs/site/zensical.toml").read_text(encoding="utf-8"))["project"]["nav"]
    assert sorted(listed(nav)) == sorted(path.name for path in (ROOT / "docs").glob("*.md"))
    assert [next(iter(door)) for door in nav[1:5]] == [
        "Prove my block",
        "Wire my machine",
        "Assess",
        "Carry this on",
    ]


def test_every_link_of_the_tree_becomes_one_of_the_site() -> None:
    made = build.pages()
    assert {
        "index.md",
        "files/vectors/README.md",
        "files/spec/edm.md",
        "files/examples/st/cell.st.md",
    } <= made.keys()
    assert "](files/spec/machine_cell/wiring.toml.md)" in made["wire-your-machine.md"]
    for path, text in made.items():
        for match in build.LINK.finditer(text):
            target = (Path("/site") / path).parent / match[2]
            known = match[2].split(":")[0] in ("http", "https") or match[2].endswith((".png", ".svg"))
            assert known or str(Path(*target.parts)).count("..") or str(target.relative_to("/site")) in made


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    (tmp_path / "docs").mkdir()
    (tmp_path / "spec").mkdir()
    (tmp_path / "spec" / "a.toml").write_text('text = "```"\n')
    (tmp_path / "README.md").write_text("[a page](docs/a.md#part) and [a file](spec/a.toml)")
    (tmp_path / "docs" / "a.md").write_text(
        "[out](../README.md) [file](../spec/a.toml) [web](https://x.org/a.md)"
    )
    return tmp_path


def test_links_out_of_the_docs_lead_to_pages_of_files(tree: Path) -> None:
    made = build.pages(tree)
    assert made["a.md"] == "[out](files/README.md) [file](files/spec/a.toml.md) [web](https://x.org/a.md)"
    assert made["files/README.md"] == "[a page](../a.md#part) and [a file](spec/a.toml.md)"
    assert made["files/spec/a.toml.md"].endswith('````toml\ntext = "```"\n````\n')


def test_a_link_to_nothing_is_refused(tree: Path) -> None:
    (tree / "docs" / "b.md").write_text("[gone](../spec/gone.toml)")
    with pytest.raises(build.Wrong, match=r"docs/b.md: link to ../spec/gone.toml, which is not there"):
        build.pages(tree)


def test_what_a_page_lacks_or_loads_is_found(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        "<h1 id=top></h1><a href='#top'></a><a href='b.html#gone'></a><a href='c.html'></a><a href='https://x.org'></a>"
        "<script src='https://x.org/a.js'></script><img src='data:,'><link rel=stylesheet href='none.css'>"
    )
    (tmp_path / "b.html").write_text("<a href='a.html#top'></a>")
    assert build.wrong_links(tmp_path) == [
        "a.html leads to b.html#gone, and there is no such place in that page",
        "a.html leads to c.html, which is not there",
        "a.html loads https://x.org/a.js",
        "a.html leads to none.css, which is not there",
    ]


def test_fences_and_pictures_are_as_the_site_knows_them() -> None:
    assert build.fenced("```sh not run\n```toml a.toml\n```sh\n") == '```sh\n```toml title="a.toml"\n```sh\n'
    drawn = build.drawn("a\n```mermaid\nflowchart\n```\nb", lambda text: f"<svg>\n\n{text}</svg>")
    assert drawn == 'a\n<div class="drawing"><svg> flowchart </svg></div>\nb'


def test_a_list_within_a_list_stays_one() -> None:
    assert build.nested("- a\n  - b\n    more\n") == "- a\n    - b\n        more\n"
    assert (
        build.nested("```\n  x\n```\n- a\n  ```\n  y\n  ```") == "```\n  x\n```\n- a\n    ```\n    y\n    ```"
    )


def test_what_makes_the_site_is_pinned_by_its_hashes() -> None:
    lock = (ROOT / "docs" / "requirements.lock").read_text(encoding="utf-8")
    pins = [line for line in lock.splitlines() if "==" in line and not line.startswith(("#", " "))]
    assert {"zensical==0.0.73", "mermaidx==0.10.1"} <= {pin.split()[0] for pin in pins}
    assert lock.count("--hash=sha256:") >= len(pins)
