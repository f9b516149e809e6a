"""Verdicts as JUnit XML: a suite for each thing that was judged, a test case for each demand."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

UNPRINTABLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML 1.0 cannot hold."""
ELEMENTS = {
    **dict.fromkeys(("PROVED", "FOLLOWS", "SAME", "CONFORMS"), "system-out"),
    **dict.fromkeys(("REFUTED", "BREAKS", "DIFFERS"), "failure"),
}
"""What JUnit calls a case with such a verdict; what is neither shown nor refuted is an error."""


@dataclass(frozen=True)
class Case:
    """A test case of JUnit: its name, the word and the lines of its verdict, and what else is said of it."""

    name: str
    word: str
    text: str
    properties: Mapping[str, str]
    required: bool = True
    """Whether it can fail: what a program may be or not is only told."""

    @property
    def element(self) -> str:
        """What JUnit calls it."""
        return ELEMENTS.get(self.word, "error") if self.required else "system-out"


@dataclass(frozen=True)
class Suite:
    """Cases that belong together, and how long they took, in seconds."""

    name: str
    cases: Sequence[Case]
    seconds: float


def junit_of(
    suite: str, cases: Sequence[Case], seconds: float, command: str = "modeproof prove-program"
) -> str:
    """One suite as JUnit XML. seconds: of CPU, for all of its cases."""
    return junit_of_suites([Suite(suite, cases, seconds)], command)


def junit_of_suites(suites: Sequence[Suite], command: str) -> str:
    """Suites as JUnit XML."""
    root = ElementTree.Element("testsuites", name=command)
    for suite in suites:
        kinds = Counter(case.element for case in suite.cases)
        attributes = {
            "name": _xml(suite.name),
            "tests": str(len(suite.cases)),
            "failures": str(kinds["failure"]),
            "errors": str(kinds["error"]),
            "skipped": "0",
            "time": str(suite.seconds),
        }
        of = ElementTree.SubElement(root, "testsuite", attributes)
        for case in suite.cases:
            _add(of, suite, case)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _add(of: ElementTree.Element, suite: Suite, case: Case) -> None:
    row = ElementTree.SubElement(of, "testcase", {"classname": _xml(suite.name), "name": _xml(case.name)})
    properties = ElementTree.SubElement(row, "properties")
    for name, value in {"verdict": case.word, **case.properties}.items():
        ElementTree.SubElement(properties, "property", name=_xml(name), value=_xml(value))
    text = _xml(case.text)
    message = {} if case.element == "system-out" else {"message": text.partition("\n")[0]}
    ElementTree.SubElement(row, case.element, message).text = text


def _xml(text: str) -> str:
    return UNPRINTABLE.sub("?", text)
