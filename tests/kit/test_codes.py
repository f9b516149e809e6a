"""Outputs whose values the document does not give: compared only where asked, named always, never passed."""

from __future__ import annotations

import json
import shlex
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from msgspec import structs

from modeproof.graph.device import DeviceGraph
from modeproof.graph.equal import compare
from modeproof.kit.__main__ import main as kit_main
from modeproof.kit.adapter import Adapter
from modeproof.kit.builtin import Builtin
from modeproof.kit.suite_judge import Options, Plan, Verdict, run_suite
from modeproof.kit.text import as_junit, as_record, as_text
from modeproof.kit.vectors import Suite, open_suite
from modeproof.suites.kinds import SUITES
from modeproof.suites.lint import lint
from modeproof.suites.write import write_suite
from tests.graph.printed import Inputs, Memory, Outputs, Params, lamp, lamp_graph, power_up, step
from tests.kit.lamps import DEMANDS, Lamp, Slow, made
from tests.kit.programs import program

CODES = "MW"
ON_THE_CODE = {
    **DEMANDS,
    "demands": [{**DEMANDS["demands"][0], "holds": "MW == CODE"}],  # type: ignore[index]
}


def project_graph(folder: Path) -> DeviceGraph:
    """The lamp, whose document prints no word for MW."""
    graph = lamp_graph(folder)
    outputs = {**graph.device.outputs, CODES: structs.replace(graph.device.outputs[CODES], project=True)}
    return replace(graph, device=structs.replace(graph.device, outputs=outputs))


suite_of = partial(made, graph=project_graph)


class OwnCodes(Lamp):
    """Right but for the words, which are its own."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {**out, CODES: "AAAA" if out["LAMP"] else "BBBB"}


class SlowOwnCodes(Slow):
    shown = OwnCodes.shown


class NoCodes(Lamp):
    """Has no such output at all."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"LAMP": out["LAMP"]}


class Dark(OwnCodes):
    """Wrong in what the document does give."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {**out, "LAMP": False}


class Bright(OwnCodes):
    """Never dark."""

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        return {**out, "LAMP": True}


def judged(suite: Suite, start: Callable[[], Any], relation: str = "exact", codes: bool = False) -> Verdict:
    return run_suite(suite, start, plan=Plan(Options(relation, codes=codes), effort=10))


def test_the_header_marks_them_and_the_vectors_carry_them(tmp_path: Path) -> None:
    suite = suite_of(tmp_path, "tour")
    assert suite.codes == (CODES,) and suite.header["outputs"][CODES] == {"type": "word", "project": True}
    assert {scan.outputs[CODES] for case in suite.cases() for scan in case.scans} == {"0000", "0FF0"}


@pytest.mark.parametrize("start", [OwnCodes, NoCodes])
def test_they_are_left_out_and_named_and_compared_when_asked(tmp_path: Path, start: type[Lamp]) -> None:
    suite = suite_of(tmp_path, "brief")
    verdict = judged(suite, start)
    assert (verdict.word, verdict.not_compared) == ("CONFORMS", (CODES,))
    text = as_text(verdict)
    assert text.endswith("CONFORMS(exact, brief; not compared: MW)")
    assert "not compared, for the document does not give the values (--codes does so by ours): MW" in text
    assert as_record(verdict)["not_compared"] == [CODES]
    (junit,) = ElementTree.fromstring(as_junit([verdict]))
    assert junit.find("properties/property").attrib == {"name": "not compared", "value": CODES}  # type: ignore[union-attr]
    asked = judged(suite, start, codes=True)
    assert asked.word == ("DIFFERS" if start is OwnCodes else "UNJUDGED")
    if start is OwnCodes:
        assert asked.difference is not None and set(asked.difference.expected) == {CODES}


def test_a_program_with_our_codes_conforms_and_nothing_is_omitted(tmp_path: Path) -> None:
    verdict = judged(suite_of(tmp_path, "brief"), Lamp, codes=True)
    assert as_text(verdict).endswith("CONFORMS(exact, brief)") and verdict.not_compared == ()


@pytest.mark.parametrize("relation", ["exact", "settled", "monitor"])
def test_relations_ignore_codes_and_still_find_what_is_wrong(tmp_path: Path, relation: str) -> None:
    suite = suite_of(tmp_path, "sic")
    start = OwnCodes if relation == "exact" else SlowOwnCodes
    assert judged(suite, start, relation).word == ("FOLLOWS" if relation == "monitor" else "CONFORMS")
    if relation != "monitor":
        assert judged(suite, start, relation, codes=True).word == "DIFFERS"
        assert judged(suite, Dark, relation).word == "DIFFERS"


def test_a_safety_property_that_needs_codes_is_named_not_judged(tmp_path: Path) -> None:
    suite = suite_of(tmp_path, "sic", ON_THE_CODE)
    assert "nothing is demanded of the outputs" in judged(suite, SlowOwnCodes, "monitor").reason
    assert judged(suite, SlowOwnCodes, "monitor", codes=True).word == "BREAKS"


def test_an_output_the_adapter_does_not_observe_is_named_once(tmp_path: Path) -> None:
    class Blind(NoCodes):
        hello_says = {"unobserved": [CODES]}  # noqa: RUF012

    verdict = judged(suite_of(tmp_path, "brief"), Blind)
    assert (verdict.word, verdict.unobserved, verdict.not_compared) == ("CONFORMS", (CODES,), ())

    class Nothing(Lamp):
        hello_says = {"unobserved": ["LAMP"]}  # noqa: RUF012

    assert "its values are ours alone" in judged(suite_of(tmp_path, "brief"), Nothing).reason


@pytest.mark.parametrize("suite", [name for name, kind in SUITES.items() if kind.always or name == "words"])
def test_no_suite_tells_states_apart_by_them(tmp_path: Path, suite: str) -> None:
    """What a suite claims of itself holds, and a lamp that is never dark is found without the codes."""
    write_suite(tmp_path / f"{suite}.jsonl.gz", suite, [project_graph(tmp_path)])
    assert lint(tmp_path / f"{suite}.jsonl.gz") == []
    if suite == "refusals":  # judges the adapter, which a program in this process has none of
        return
    assert judged(open_suite(tmp_path / f"{suite}.jsonl.gz"), OwnCodes).word == "CONFORMS"
    assert judged(open_suite(tmp_path / f"{suite}.jsonl.gz"), Bright).word == "DIFFERS"


def test_a_repeated_or_resumed_run_keeps_its_choice_of_codes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    suite = suite_of(tmp_path, "brief")
    command = shlex.join(program(tmp_path, 'def answer(m, out): say({"out": {**out, "MW": "FFFF"}})'))
    words = ["conform", "lamp", "--adapter", command, "--vectors", str(suite.path), "--quiet"]
    note = ["--resume", str(tmp_path / "note.json")]
    assert kit_main([*words, *note, "--json", str(tmp_path / "v.json")]) == 0
    assert json.loads((tmp_path / "v.json").read_text())["not_compared"] == [CODES]
    assert "not compared: MW)" in capsys.readouterr().out
    assert kit_main([*words, "--codes"]) == 1
    assert " --codes --case lamp-" in capsys.readouterr().out
    assert kit_main([*words, *note, "--codes"]) == 2
    assert "the note is of another run (codes False)" in capsys.readouterr().err
    lists = 'HELLO["scans"] = True\n' + "scan_ = scan\ndef scan(m): return {**scan_(m), 'MW': 'FFFF'}"
    verdict = run_suite(suite, lambda: Adapter(program(tmp_path, lists)))
    assert (verdict.word, verdict.not_compared) == ("CONFORMS", (CODES,))


def own_codes(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
    after, out = step(state, i)
    return after, replace(out, MW=0xAAAA)


def dark(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
    after, _ = step(state, i)
    return after, Outputs(False, 0)


def test_a_package_in_this_process_is_compared_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def package(step: Any) -> str:
        module = SimpleNamespace(Params=Params, Inputs=Inputs, Outputs=Outputs, power_up=power_up, step=step)
        monkeypatch.setitem(sys.modules, "own.toy.lamp", module)  # type: ignore[arg-type]
        return "own"

    suite = suite_of(tmp_path, "brief")
    for code, codes, word in (
        (own_codes, False, "CONFORMS"),
        (own_codes, True, "DIFFERS"),
        (dark, False, "DIFFERS"),
    ):
        name = package(code)
        assert judged(suite, lambda name=name: Builtin(name, suite), codes=codes).word == word  # type: ignore[misc]


def test_graphs_compare_every_output_unless_codes_are_left_out(tmp_path: Path) -> None:
    graph = project_graph(tmp_path)
    assert compare(graph, lamp(step=own_codes)).verdict == "DIFFERS"
    found = compare(graph, lamp(step=own_codes), codes=False)
    assert (found.verdict, found.not_compared) == ("EQUAL", (CODES,))
    assert "not compared (--codes compares them): MW" in found.summary()
    wrong = compare(graph, lamp(step=dark), codes=False)
    assert wrong.verdict == "DIFFERS" and set(wrong.differences[0].expected) == {"LAMP"}
    assert compare(graph, lamp()).not_compared == ()
