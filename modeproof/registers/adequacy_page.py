"""The stamp under the rendered page on how strong the vectors are, so that drift shows without judging.

It is the last line of the page. Of a document that has a register of survivors it rests on the programs
of its code (without comments), on that register, and on what its vectors are made from: the pins of the runs
that print graphs, the interface, the classes of inputs. Besides these three the page's own text is stamped.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
from collections.abc import Mapping
from pathlib import Path

from modeproof.registers.files import read_text, read_toml
from modeproof.registers.pages import ADEQUACY, page_of
from modeproof.registers.rows import Document, Problem

REGISTER = "adequacy.toml"
REMEDY = "run modeproof mutate impl --judge vectors with --document, once more with --render"
_STAMP = re.compile(r"<!-- rendered by modeproof mutate: (.*), text (\w{12}) -->\n\Z")


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:12]


def adequacy_page(document: str) -> str:
    """The path of a document's page."""
    return page_of(document, ADEQUACY)


def stamped_adequacy(root: Path, document: str, text: str) -> str:
    """The page with its stamp."""
    told = ", ".join(f"{key} {value}" for key, value in _rests_on(root, document).items())
    return f"{text}\n<!-- rendered by modeproof mutate: {told}, text {_digest(text)} -->\n"


def check_adequacy_page(document: Document) -> list[Problem]:
    """What has drifted between the page and what it rests on; nothing where the document has no register."""
    root, page = document.root, adequacy_page(document.name)
    if not (root / "refimpl" / document.name / REGISTER).is_file():
        return []
    if not (root / page).is_file():
        return [Problem(page, "", f"the page is missing; {REMEDY}")]
    text = read_text(root, root / page)
    found = _STAMP.search(text)
    if found is None:
        return [Problem(page, "", f"the page has no stamp; {REMEDY}")]
    told = dict(one.split(" ", 1) for one in found[1].split(", "))
    problems = []
    for key, value in _rests_on(root, document.name).items():
        if told.get(key) != value:
            cause = f"the {key} changed since the page was rendered"
            problems.append(Problem(page, "", f"{cause}; {REMEDY}"))
    if found[2] != _digest(text[: found.start() - 1]):
        problems.append(Problem(page, "", f"the page was changed by hand; {REMEDY}"))
    return problems


def _programs(root: Path, name: str) -> dict[Path, ast.Module]:
    """The programs of a document's code, and those beside its folder that they import."""
    beside = {path.stem: path for path in (root / "refimpl").glob("*.py")}
    found: dict[Path, ast.Module] = {}
    todo = [*(root / "refimpl" / name).glob("*.py"), *filter(None, [beside.get("__init__")])]
    while todo:
        path = todo.pop()
        if path not in found:
            found[path] = tree = ast.parse(read_text(root, path))
            modules = {one.module or "" for one in ast.walk(tree) if isinstance(one, ast.ImportFrom)}
            named = {module.removeprefix("refimpl.") for module in modules}
            todo += [beside[one] for one in named if one in beside]
    return found


def _rests_on(root: Path, name: str) -> Mapping[str, str]:
    folder = root / "spec" / name
    code = [f"{path.name} {ast.dump(tree)}" for path, tree in sorted(_programs(root, name).items())]
    rows = read_toml(root, folder / "runs.toml").get("run", [])
    graphs: list[object] = [row for row in rows if "graph" in row]
    graphs += [
        read_toml(root, folder / file)
        for file in ("interface.toml", "classes.toml")
        if (folder / file).is_file()
    ]
    return {
        "code": _digest("\n".join(code)),
        "explanations": _digest(
            json.dumps(read_toml(root, root / "refimpl" / name / REGISTER), sort_keys=True)
        ),
        "graphs": _digest(json.dumps(graphs, sort_keys=True, default=str)),
    }
