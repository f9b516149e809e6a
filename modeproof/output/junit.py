"""Outcomes as JUnit XML: a suite for each, a case for each demand.

A demand with a problem is a failure where the outcome is not as expected, else an error: so is a demand that
is not shown, and an outcome that could not be judged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from xml.etree import ElementTree

from modeproof.kit.errors import plain
from modeproof.output.outcome import Demand, Outcome

SHOWN = ("PROVED", "CONFORMS")
"""The words of a demand that is met."""


def as_junit(outcomes: Mapping[str, Outcome]) -> str:
    """The text of a JUnit file; the outcomes by the names of their suites."""
    top = ElementTree.Element("testsuites")
    for name, outcome in outcomes.items():
        top.append(_suite(name, outcome))
    ElementTree.indent(top)
    return ElementTree.tostring(top, "unicode", xml_declaration=True) + "\n"


def _suite(name: str, outcome: Outcome) -> ElementTree.Element:
    cases = list(_cases(outcome))
    kinds = Counter(child.tag for case in cases for child in case)
    suite = ElementTree.Element(
        "testsuite",
        name=plain(name),
        tests=str(len(cases)),
        failures=str(kinds["failure"]),
        errors=str(kinds["error"]),
        skipped="0",
        time=f"{outcome.seconds:.3f}",
        timestamp=outcome.started.removesuffix("Z"),
    )
    said = {"verdict": outcome.word, "target": outcome.target, "again": outcome.again}
    properties = ElementTree.SubElement(suite, "properties")
    for key, value in {**said, **{file.path: file.sha256 for file in outcome.files}}.items():
        ElementTree.SubElement(properties, "property", name=plain(key), value=plain(value))
    suite.extend(cases)
    return suite


def _cases(outcome: Outcome) -> Iterator[ElementTree.Element]:
    for demand in outcome.demands:
        yield _case(outcome, demand)
    if not any(demand.word not in SHOWN for demand in outcome.demands) and outcome.status:
        whole = Demand(id="judged", word=outcome.word, sentence=outcome.reason or outcome.sentence)
        yield _case(outcome, whole)


def _case(outcome: Outcome, demand: Demand) -> ElementTree.Element:
    made = ElementTree.Element("testcase", classname=plain(outcome.subject), name=plain(demand.id))
    made.set("time", "0")
    if demand.word in SHOWN:
        return made
    tag = "failure" if demand.problems and outcome.status == 1 else "error"
    messages = [problem.message for problem in demand.problems] or [outcome.reason or demand.sentence]
    wrong = ElementTree.SubElement(made, tag, type=demand.word, message=plain(messages[0]))
    wrong.text = "\n".join(map(plain, [f"{demand.word}: {demand.sentence}", *messages]))
    return made
