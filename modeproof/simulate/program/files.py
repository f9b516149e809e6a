"""What the user chooses from the disk: vector files, each run and judged in slices."""

from __future__ import annotations

from typing import Any

from browser import document, window
from javascript import JSON

from modeproof.simulate.program.by_name import module_named
from modeproof.simulate.program.play import log_of_case
from modeproof.simulate.program.suites import judge
from modeproof.simulate.program.vectors import hashed, written

SLICE_MS = 60
"""So long a suite runs before the page is drawn again."""


def save_vectors(scene: Any, id: str, say: Any) -> None:
    """Save what a device did as a vector file of one case; say why where that cannot be."""
    try:
        header, case = scene.vectors(id)
    except ValueError as error:
        say(f"No test vectors: {error}.")
        return
    window.digestOf(
        hashed(case),
        lambda digest: window.saveText(f"{id}-played.jsonl", written(header, case, digest)),
        lambda why: say(f"No test vectors: {why}."),
    )


def as_log(rows: list[Any], facts: dict[str, Any], scenes: dict[str, Any]) -> list[Any]:
    """The rows of a log; of a vector file its first case, as a log. Raises ValueError.

    `scenes` are the modules of the documents that are drawn as one cell.
    """
    header = rows[0]
    if "document" not in header:
        return rows
    id = header["target"]
    if header["document"] not in scenes:
        return log_of_case(header, rows[1])
    if id not in facts[header["document"]]["devices"]:
        raise ValueError(f"nothing here is {id!r}")
    log = log_of_case(header, rows[1], id)
    return [scenes[header["document"]].header_of(log[0]["params"]), *log[1:]]


class Files:
    """Runs the chosen vector files one after the other; `facts` are those of the documents."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.facts = facts

    def suites(self, files: list[Any]) -> None:
        """Run the chosen vector files one after the other."""
        if not files:
            document["progress"].text = "All files have been run."
            return
        file = files[0]
        document["progress"].text = f"Reading {file.name} …"
        window.readLines(
            file, lambda lines: self.run_suite(lines, files), lambda why: self.unread(file, why, files)
        )

    def unread(self, file: Any, why: str, files: list[Any]) -> None:
        """A file that is no suite is named."""
        _verdict(file.name, "", "UNJUDGED", why)
        self.suites(files[1:])

    def run_suite(self, lines: Any, files: list[Any]) -> None:
        """All cases of one file, in slices."""
        try:
            header = JSON.parse(lines[0])
            module = self.facts[header["document"]]["module"] + header["target"]
            code = module_named(module)
            header["suite"], header["inputs"], header["cases"]
        except Exception as error:  # whatever the text is; the browser's own complaint is no ValueError
            self.unread(files[0], f"not a vector file of a device in this page: {error}", files)
            return
        going = judge(code, header, (JSON.parse(lines[n]) for n in range(1, len(lines))))

        def slice_() -> None:
            until = window.performance.now() + SLICE_MS
            try:
                for verdict in going:
                    if verdict.difference or verdict.done_cases == verdict.cases:
                        _verdict(verdict.target, verdict.suite, verdict.word, verdict.compared())
                        self.suites(files[1:])
                        return
                    if window.performance.now() > until:
                        document["progress"].text = f"{verdict.target} {verdict.suite}: {verdict.compared()}"
                        window.setTimeout(slice_, 0)
                        return
            except Exception as error:  # as above
                self.unread(files[0], f"a case cannot be run: {error}", files)
                return
            self.unread(files[0], "it has fewer cases than its header says", files)

        slice_()


def _verdict(target: str, suite: str, word: str, compared: str) -> None:
    """A row of the table of verdicts."""
    document["verdicts"].hidden = False
    row = document.createElement("tr")
    for text in (target, suite, word, compared):
        cell = document.createElement("td")
        cell.text = text
        row.appendChild(cell)
    row.children[2].class_name = "good" if word == "CONFORMS" else "bad"
    document["verdicts"].select_one("tbody").appendChild(row)
