"""`make docs`: the docs as a site with search, in build/site. It opens as files and loads nothing else.

Lays the pages into build/site-source first: links that lead out of docs/ go to pages of those files, and
pictures are drawn. Then zensical makes the site, and every link in it is followed. Exit status 0, or 2 with
one line for what is wrong.
"""

from __future__ import annotations

import html.parser
import posixpath
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
SOURCES = "files"
"""The folder of the site with a page for each file or folder of the tree that a page leads to."""
STATIC = ("iframe-worker.js", "site.css")
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")
MERMAID = re.compile(r"^```mermaid\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FENCE = re.compile(r"^```(sh|toml) (.+)$", re.MULTILINE)
"""A fence that says more than its language, to whoever runs the block: the name of a file, or how it ends."""
LANGUAGES = {".py": "python", ".toml": "toml", ".c": "c", ".st": "pascal", ".json": "json"}


class Wrong(Exception):
    """What keeps the site from being made: one line."""


def leads_outside(page: str, text: str, root: Path = ROOT) -> Iterator[tuple[str, str]]:
    """The links of a page that lead out of docs/: as they are written, and the path from the root.

    `page` is the path of the page from the root. Raises Wrong for a link to nothing.
    """
    for match in LINK.finditer(text):
        link = match[2]
        if re.match(r"[a-z]+:", link):
            continue
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), link))
        if not (root / path).exists():
            raise Wrong(f"{page}: link to {link}, which is not there")
        if not path.startswith("docs/"):
            yield link, path


def site_path(path: str) -> str:
    """Where the site has the Markdown of a page, file or folder of the tree."""
    if path.startswith("docs/"):
        return path.removeprefix("docs/")
    return f"{SOURCES}/{path}" if path.endswith(".md") else f"{SOURCES}/{path}.md"


def redirected(page: str, text: str, root: Path = ROOT) -> str:
    """The page with its links as they must be in the site."""
    outside = dict(leads_outside(page, text, root))
    here = posixpath.dirname(site_path(page))

    def turn(match: re.Match[str]) -> str:
        link = match[2]
        if re.match(r"[a-z]+:", link):
            return match[0]
        path = outside.get(link) or posixpath.normpath(posixpath.join(posixpath.dirname(page), link))
        new = posixpath.relpath(site_path(path), here or ".")
        return f"{match[1]}{new}{match[3] or '' if path.endswith('.md') else ''}{match[4]}"

    return LINK.sub(turn, text)


def file_page(path: str, root: Path = ROOT) -> str:
    """The page of a file, or of a folder with its list. Raises Wrong like `leads_outside`."""
    place = root / path
    if path.endswith(".md"):
        return redirected(path, place.read_text(encoding="utf-8"), root)
    head = f"# {place.name}\n\n`{path}`\n\n"
    if place.is_dir():
        return head + "".join(f"- `{one.name}`\n" for one in sorted(place.iterdir()) if one.is_file())
    try:
        text = place.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return f"{head}This file is not text; it is in the repository.\n"
    fence = "`" * max([3, *(len(run) + 1 for run in re.findall(r"`{3,}", text))])
    return f"{head}{fence}{LANGUAGES.get(place.suffix, 'text')}\n{text.rstrip()}\n{fence}\n"


def pages(root: Path = ROOT) -> dict[str, str]:
    """All pages of the site by their paths in it: those of docs/, and of the files that these lead to."""
    made: dict[str, str] = {}
    waiting = [path.relative_to(root).as_posix() for path in sorted((root / "docs").glob("*.md"))]
    seen = set(waiting)
    while waiting:
        path = waiting.pop()
        made[site_path(path)] = file_page(path, root)
        if path.endswith(".md"):
            text = (root / path).read_text(encoding="utf-8")
            new = [one for _, one in leads_outside(path, text, root) if one not in seen]
            seen.update(new)
            waiting += dict.fromkeys(new)
    return made


def fenced(text: str) -> str:
    """The page with fences as the site's Markdown knows them."""
    return FENCE.sub(lambda found: f"```{found[1]}" + f' title="{found[2]}"' * (found[1] == "toml"), text)


def nested(text: str) -> str:
    """The page with lists within lists indented by four, and not by two, as the site wants them."""
    lines: list[str] = []
    inside: str | None = None
    for line in text.split("\n"):
        indent = line[: len(line) - len(line.lstrip(" "))]
        fence = line.lstrip(" ").startswith("```")
        lines.append((inside if inside is not None else indent if line.strip() else "") + line)
        if fence:
            inside = indent if inside is None else None
    return "\n".join(lines)


def drawn(text: str, draw: Callable[[str], str]) -> str:
    """The page with each Mermaid picture as a drawing in one line, so that Markdown takes it for HTML."""
    return MERMAID.sub(lambda found: f'<div class="drawing">{" ".join(draw(found[1]).split())}</div>', text)


class _Links(html.parser.HTMLParser):
    """What a page of the site leads to and loads, and its anchors."""

    def __init__(self) -> None:
        super().__init__()
        self.leads: list[str] = []
        self.loads: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a" and "href" in given:
            self.leads.append(given["href"])
        elif tag == "link" and given.get("rel") not in ("canonical", "prev", "next"):
            self.loads.append(given.get("href", ""))
        elif "src" in given:
            self.loads.append(given["src"])


def wrong_links(site: Path) -> list[str]:
    """Every link and file of the pages that is not there, and everything that is loaded from elsewhere."""
    read: dict[Path, _Links] = {}
    for path in sorted(site.rglob("*.html")):
        read[path] = _Links()
        read[path].feed(path.read_text(encoding="utf-8"))
    wrong: list[str] = []
    for path, links in read.items():
        page = path.relative_to(site).as_posix()
        for link in dict.fromkeys([*links.leads, *links.loads]):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in links.loads and parts.scheme != "data":
                    wrong.append(f"{page} loads {link}")
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                wrong.append(f"{page} leads to {link}, which is not there")
            elif parts.fragment and target in read and unquote(parts.fragment) not in read[target].anchors:
                wrong.append(f"{page} leads to {link}, and there is no such place in that page")
    return wrong


def main() -> int:
    """Make the site."""
    import mermaidx

    def draw(picture: str) -> str:
        return str(mermaidx.render(picture).svg())

    source, site = ROOT / "build" / "site-source", ROOT / "build" / "site"
    for old in (source, site):
        shutil.rmtree(old, ignore_errors=True)
    try:
        for path, text in pages().items():
            target = source / "pages" / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(drawn(fenced(nested(text)), draw), encoding="utf-8")
        for path in (
            *(HERE / name for name in STATIC),
            *(ROOT / "docs").glob("*.svg"),
            *(ROOT / "docs").glob("*.png"),
        ):
            shutil.copyfile(path, source / "pages" / path.name)
        shutil.copyfile(HERE / "zensical.toml", source / "zensical.toml")
        done = subprocess.run(
            [sys.executable, "-m", "zensical", "build", "--strict"],
            cwd=source,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode or not (source / "site" / "index.html").is_file():
            raise Wrong(f"zensical: {done.stdout}{done.stderr}")
        shutil.move(source / "site", site)
        (site / "404.html").unlink(missing_ok=True)  # a server's page: its links are from the root of one
        if wrong := wrong_links(site):
            raise Wrong("; ".join(wrong[:20]))
    except Wrong as error:
        print(f"modeproof: docs: {error}", file=sys.stderr)
        return 2
    print(f"wrote {(site / 'index.html').relative_to(ROOT)}: {len(list(site.rglob('*.html')))} pages")
    return 0


if __name__ == "__main__":
    sys.exit(main())
