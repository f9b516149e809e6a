"""The stamp under the rendered page on how strong the vectors are, so that drift shows without judging.

It is the last line of the page. For each document that has a register of survivors it rests on the programs
of its code (without comments), on that register, and on what its vectors are made from: the pins of the runs
that print graphs, the interface, the classes of inputs. Besides these three the page's own text is stamped.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from modeproof.registers.files import read_text, read_toml
from modeproof.registers.rows import Document, Problem

PAGE = "docs/adequacy.md"
REGISTER = "adequacy.toml"
REMEDY = "run modeproof mutate impl --judge vectors, once more with --render"
_STAMP = re.compile(r"<!-- rendered by modeproof mutate: (.*), text (\w{12}) -->\n\Z")


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:12]


def stamped_adequacy(root: Path, names: Sequence[str], text: str) -> str:
    """The page with its stamp; `names` are the documents that have the register."""
    told = ", ".join(f"{key} {value}" for key, value in _rests_on(root, names).items())
    return f"{text}\n<!-- rendered by modeproof mutate: {told}, text {_digest(text)} -->\n"


def check_adequacy_page(root: Path, documents: Sequence[Document]) -> list[Problem]:
    """What has drifted between the page and what it rests on; nothing where no document has the register."""
    names = [one.name for one in documents if (root / "refimpl" / one.name / REGISTER).is_file()]
    if not names:
        return []
    if not (root / PAGE).is_file():
        return [Problem(PAGE, "", f"the page is missing; {REMEDY}")]
    text = read_text(root, root / PAGE)
    found = _STAMP.search(text)
    if found is None:
        return [Problem(PAGE, "", f"the page has no stamp; {REMEDY}")]
    told = dict(one.split(" ", 1) for one in found[1].split(", "))
    problems = []
    for key, value in _rests_on(root, names).items():
        if told.get(key) != value:
            cause = f"the {key} changed since the page was rendered"
            problems.append(Problem(PAGE, "", f"{cause}; {REMEDY}"))
    if found[2] != _digest(text[: found.start() - 1]):
        problems.append(Problem(PAGE, "", f"the page was changed by hand; {REMEDY}"))
    return problems


def _rests_on(root: Path, names: Sequence[str]) -> Mapping[str, str]:
    code: list[str] = []
    registers: list[str] = []
    graphs: list[object] = []
    for name in names:
        folder = root / "spec" / name
        files = [*(root / "refimpl").glob("*.py"), *(root / "refimpl" / name).glob("*.py")]
        code += [f"{path.name} {ast.dump(ast.parse(read_text(root, path)))}" for path in sorted(files)]
        registers.append(json.dumps(read_toml(root, root / "refimpl" / name / REGISTER), sort_keys=True))
        rows = read_toml(root, folder / "runs.toml").get("run", [])
        graphs += [row for row in rows if "graph" in row]
        graphs += [
            read_toml(root, folder / file)
            for file in ("interface.toml", "classes.toml")
            if (folder / file).is_file()
        ]
    made = json.dumps(graphs, sort_keys=True, default=str)
    return {
        "code": _digest("\n".join(code)),
        "explanations": _digest("\n".join(registers)),
        "graphs": _digest(made),
    }
