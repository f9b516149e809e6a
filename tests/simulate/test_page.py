"""The page in Chromium: it runs the devices, tells the stories, judges suites, and asks for nothing."""

from __future__ import annotations

import gzip
import itertools
import json
import os
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser

from modeproof.simulate.program.device import Device, take
from modeproof.suites.lint import lint
from scenes.mode_selection.scene import ROUND, Scene
from tests.report.browser.opened import WAIT_MS, Opened, open_page
from tests.simulate.conftest import READY, ROOT, SCENE, scenes_of
from tests.simulate.test_program import STORIES, play, wrong_ends

WORDS = (
    "MW01",
    "MW03",
    "MW05",
    "MW07",
    "ReadAuthorization",
    "CheckMSO",
    "SelectMSO",
    "SwitchMSO",
    "active",
    "screen",
)
STANDS = """(root) => Object.fromEntries([...root.querySelectorAll("[data-text]")].map(
    (node) => [node.dataset.text, node.textContent]))"""
LIT = """(root) => [...root.querySelectorAll(".on[data-on]")].map((node) => node.dataset.on).sort()"""
TARGETS = (
    "fplc",
    "plc",
    "hmi",
    "sf_edm",
    "sf_guard_locking",
    "sf_enable_switch",
    "sf_testable_safety_sensor",
)
SUITES = ("brief", "words", "times", "sequences")
PUBLISHED = [
    f"{target}/{suite}"
    for suite in SUITES
    for target in TARGETS
    if (ROOT / f"vectors/{target}/{suite}.jsonl.gz").is_file()
]
SOON_MS = 2_500
"""From opening the file to a page that can be used."""
MOST_SCANS = 2_000
"""Of a larger suite the test looks at every n-th case; with MODEPROOF_LONG it runs all."""


def stands(opened: Opened, root: str, number: int = 0) -> tuple[dict[str, str], list[str]]:
    """The texts and the lit lamps of a drawing."""
    node = opened.page.locator(root).nth(number).element_handle()
    return opened.ask(STANDS, node), opened.ask(LIT, node)


def as_shown(scene: Any) -> tuple[dict[str, str], list[str]]:
    """The same of a scene that ran in Python."""
    shown = scene.show()
    return shown["text"], sorted(name for name, lit in shown["on"].items() if lit)


def agree(opened: Opened, root: str, scene: Any, number: int = 0) -> None:
    texts, lit = stands(opened, root, number)
    expected, on = as_shown(scene)
    assert texts == {name: expected[name] for name in texts}
    assert set(lit) == {name for name in on if name in lit or name not in ("key", "fault", "error")}


@pytest.fixture
def cell(opened: Opened) -> Opened:
    """The open page with a cell that is ready for a key."""
    opened.page.click("nav [data-part^=scene]")
    opened.page.select_option("#choose", "0")
    opened.page.click("#leave")
    return opened


def test_a_whole_change_stepped_by_hand_is_that_of_python(cell: Opened, known: dict[str, Any]) -> None:
    scene, page = Scene(known[SCENE], {}), cell.page
    page.get_by_role("button", name="Power off and on").first.click()
    page.get_by_role("button", name="Insert the key of level 2").click()
    scene.do("insert 2")
    for _ in range(62):
        page.get_by_role("button", name="Step: every device once").click()
        scene.do("round 1")
    agree(cell, "[data-cell]", scene)
    page.get_by_role("button", name="One scan of the F-PLC").click()
    scene.do("scan fplc")
    page.get_by_role("button", name="Pull the key out").click()
    scene.do("remove")
    for _ in range(31):
        page.get_by_role("button", name="Step: every device once").click()
        scene.do("round 1")
    page.get_by_role("button", name="Insert the key of level 2").press("Enter")
    scene.do("insert 2")
    for _ in range(31):
        page.get_by_role("button", name="Step: every device once").press("Enter")
        scene.do("round 1")
    page.get_by_role("button", name="1 Automatic mode", exact=True).click()
    scene.do("touch select:1")
    for _ in range(6):
        page.get_by_role("button", name="Step: every device once").click()
        scene.do("round 1")
        agree(cell, "[data-cell]", scene)
    page.get_by_role("button", name="Confirm").click()
    scene.do("touch confirm")
    for _ in range(8):
        page.get_by_role("button", name="Step: every device once").click()
        scene.do("round 1")
        agree(cell, "[data-cell]", scene)
    assert "MSO_1" in stands(cell, "[data-cell]")[1]
    assert page.locator("#said").inner_text().startswith("active: 1: Automatic mode")


def test_the_first_play_of_a_visitor_succeeds(browser: Browser, page_file: Path) -> None:
    with open_page(browser, page_file) as fresh:
        page = fresh.page
        page.wait_for_function(READY)
        page.get_by_role("button", name="Insert the key of level 2").press("Enter")
        page.locator("[data-go=play]").first.press("Enter")
        for field in ("1 Automatic mode", "Confirm"):
            button = page.get_by_role("button", name=field, exact=True)
            page.wait_for_function("(node) => !node.disabled", arg=button.element_handle())
            button.press("Enter")
        page.wait_for_selector("[data-on=MSO_1].on")
        assert page.locator("[data-on=ERROR].on").count() == 0


def box(opened: Opened, root: str = "[data-why=fplc]") -> str:
    """What the page says about a refusal."""
    node = opened.page.locator(root)
    return node.inner_text() if node.is_visible() else ""


def rounds(opened: Opened, number: int) -> None:
    step = opened.page.get_by_role("button", name="Step: every device once")
    for _ in range(number):
        step.click()


def test_an_error_says_why_and_how_to_get_out(cell: Opened) -> None:
    page = cell.page
    page.select_option("[data-go=profile]", "cautious")
    assert page.locator("[data-text=dwell]").inner_text() == "500 ms" and box(cell) == ""
    page.get_by_role("button", name="Power off and on").first.click()
    assert box(cell).startswith("What to do: The F-PLC has just been switched on.")
    page.get_by_role("button", name="Insert the key of level 2").press("Enter")
    rounds(cell, 12)
    said = box(cell)
    assert said.startswith(
        "Error mode: Two or more outputs of the key reader came on before the F-PLC was ready"
    )
    assert "EKS-KS-6 The safe controller checks" in said and "What to do: Pull the key out." in said
    assert page.locator("#said").inner_text().count("Error mode: Two or more outputs") == 1
    page.get_by_role("button", name="Pull the key out").press("Enter")
    rounds(cell, 30)
    assert box(cell).startswith("That is over: Two or more outputs")
    page.get_by_role("button", name="Insert the key of level 2").press("Enter")
    rounds(cell, 31)
    assert box(cell) == ""
    page.select_option("[data-go=profile]", "letter")
    assert page.locator("[data-text=dwell]").inner_text() == "0 ms"


def link_of(opened: Opened, root: str) -> str:
    opened.page.locator(f"{root} [data-go=link]").click()
    return str(opened.ask("() => location.hash"))


def test_a_link_carries_the_play(cell: Opened, browser: Browser, page_file: Path) -> None:
    page = cell.page
    page.select_option("[data-go=profile]", "cautious")
    assert link_of(cell, ".scene") == "" and "nothing has been played" in page.locator("#told").inner_text()
    page.get_by_role("button", name="Insert the key of level 2").press("Enter")
    rounds(cell, 31)
    page.click("[data-fault=loss]")
    rounds(cell, 2)
    hash = link_of(cell, ".scene")
    assert hash.endswith("&profile=cautious&do=insert%202%3B%20round%2031%3B%20fault%20loss%3B%20round%202")
    with open_page(browser, page_file, hash) as again:
        again.page.wait_for_function(READY)
        assert stands(again, "[data-cell]") == stands(cell, "[data-cell]")
        assert "Go on from here." in again.page.locator("#told").inner_text()
        assert link_of(again, ".scene") == hash
        again.page.get_by_role("button", name="Pull the key out").click()
        assert stands(again, "[data-cell]") != stands(cell, "[data-cell]")
    page.select_option("[data-go=profile]", "letter")


@pytest.mark.parametrize(
    ("hash", "said"),
    [
        ("play=robot&do=round 1", "The link cannot be played: nothing here is 'robot'."),
        ("play=mode_selection&profile=letter&do=insert 2; dance", "'dance' is no action of this cell."),
        ("play=mode_selection&profile=<b>x</b>&do=round 1", "there is no profile '<b>x</b>'."),
        ("play=mode_selection&profile=letter&do=round 99999999", "it has no actions, or too many."),
        ("play=sf_edm&do=set Activate 1; call -5", "dt_ms: expected an integer >= 0, got -5."),
        (
            "play=sf_edm&do=set Activate 1; call 20 3",
            "This play came with the link: set Activate 1; call 20 3.",
        ),
        ("%E0%A4%A", "The address cannot be read"),
    ],
)
def test_a_link_from_elsewhere_is_played_or_refused(hash: str, said: str, opened: Opened) -> None:
    opened.ask("(hash) => { location.hash = hash; }", hash)
    opened.page.wait_for_function(
        "(said) => document.getElementById('told').textContent.includes(said)", arg=said
    )
    opened.ask("() => { history.replaceState(null, '', location.pathname); }")
    opened.page.click("nav [data-part^=scene]")


def test_another_profile_ends_a_story(opened: Opened) -> None:
    page = opened.page
    page.select_option("#choose", str(STORIES.index("stale_confirmation")))
    page.click("#next")
    assert page.locator("[data-cell]").count() == 2
    page.select_option("[data-go=profile]", "cautious")
    assert page.locator("[data-cell]").count() == 1 and page.locator("#next").is_disabled()
    assert page.locator("[data-text=dwell]").inner_text() == "500 ms"
    page.select_option("[data-go=profile]", "letter")
    assert page.locator("#told").inner_text() == page.locator("#choose").input_value() == ""


def test_the_choices_of_a_fault_are_those_in_force(cell: Opened) -> None:
    page = cell.page
    page.select_option("[data-choose=word]", "MW03")
    page.select_option("[data-choose=mode]", "4")
    page.get_by_role("button", name="Power off and on").first.click()
    assert page.locator("[data-choose=word]").input_value() == "MW07"
    assert page.locator("[data-choose=mode]").input_value() == "0"


def test_an_error_of_a_block_says_why(opened: Opened) -> None:
    page, root = opened.page, "[data-block=sf_edm] "
    page.click("nav [data-part=blocks]")
    page.locator(f'{root}[data-do="reset"]').click()
    assert box(opened, f"{root}[data-why]") == ""
    for name in ("Activate", "S_StartReset", "S_OutControl"):
        page.locator(f'{root}[data-do="flip {name}"]').click()
    for _ in range(4):
        page.locator(f'{root}[data-do="call 20"]').click()
    said = box(opened, f"{root}[data-why]")
    assert said.startswith("Error mode: The output is off, but a contactor has not dropped out within 0 ms")
    assert "What to do: Let both contactors drop out" in said
    page.locator(f'{root}[data-do="reset"]').click()


def test_the_page_can_be_used_soon(browser: Browser, page_file: Path) -> None:
    with open_page(browser, page_file) as fresh:
        fresh.page.wait_for_function(READY)
        assert fresh.ask("() => window.modeproofReady") < SOON_MS


def test_what_is_closed_on_the_panel_cannot_be_touched(cell: Opened) -> None:
    assert cell.page.get_by_role("button", name="Confirm").is_disabled()
    assert cell.page.get_by_role("button", name="0 Manual mode", exact=True).is_disabled()


@pytest.mark.sampled
@pytest.mark.parametrize("id", STORIES)
def test_a_story_is_told_to_its_end(
    id: str, opened: Opened, told: dict[str, Any], known: dict[str, Any]
) -> None:
    story, page = told[id], opened.page
    page.select_option("#choose", str(STORIES.index(id)))
    for _ in story["step"]:
        page.click("#next")
    assert page.locator("#told").inner_text().endswith(story["end"])
    assert page.locator("#next").is_disabled()
    root = "[data-cell]" if story["of"] == SCENE else f"[data-block={story['of']}]"
    for number, scene in enumerate(scenes_of(story, known)):
        play(scene, story)
        assert not wrong_ends(scene, story["ends"][number])
        agree(opened, root, scene, number)
    page.click("#leave")


def test_a_fault_is_shown_with_what_detects_it(cell: Opened, known: dict[str, Any]) -> None:
    page = cell.page
    for fault in known[SCENE]["faults"]:
        page.click(f"[data-fault={fault['id']}]")
        about = page.locator("[data-about]").inner_text()
        assert f"Detected by: {', '.join(fault['detected_by']) or 'nothing'}" in about
        assert fault["not_detected"] in about
    page.get_by_role("button", name="Take the fault out").click()
    assert page.locator("[data-about]").inner_text() == "No fault is in."


def test_what_came_of_a_fault_is_said_beside_it(cell: Opened) -> None:
    page = cell.page
    noticed = page.locator("[data-at=noticed]")
    page.get_by_role("button", name="Insert the key of level 2").click()
    rounds(cell, 31)
    page.select_option("[data-choose=word]", "MW03")
    page.click("[data-fault=loss]")
    below = "(node) => node.nextElementSibling.contains(document.querySelector('[data-about]'))"
    assert page.locator("[data-fault=loss]").evaluate(below)
    assert noticed.inner_text() == "In this run: until now every device has read what was written."
    page.get_by_role("button", name="1 Automatic mode", exact=True).click()
    rounds(cell, 6)
    assert noticed.inner_text().endswith("The F-PLC refused nothing.")
    page.click("[data-fault=corruption]")
    rounds(cell, 6)
    assert "the F-PLC refused after it was put in. MW03 is not a selection" in noticed.inner_text()
    page.get_by_role("button", name="Take the fault out").click()
    assert noticed.inner_text() == ""


def test_a_fault_is_marked_where_it_is_read(cell: Opened) -> None:
    page = cell.page
    page.select_option("[data-choose=word]", "MW03")
    page.click("[data-fault=corruption]")
    page.get_by_role("button", name="One scan of the F-PLC").click()
    assert page.locator("[data-wire=MW03]").get_attribute("class") == "wire misread"
    page.get_by_role("button", name="Take the fault out").click()
    assert page.locator("[data-wire=MW03]").get_attribute("class") == "wire"


def test_playing_goes_on_by_itself_and_pauses(cell: Opened) -> None:
    button = cell.page.locator("[data-go=play]").first
    button.click()
    cell.page.wait_for_function("() => parseInt(document.querySelector('[data-at=scans]').textContent) > 20")
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    before = cell.page.locator("[data-at=scans]").inner_text()
    cell.page.wait_for_timeout(400)
    assert cell.page.locator("[data-at=scans]").inner_text() == before


def test_a_saved_log_is_played_again(cell: Opened, tmp_path: Path) -> None:
    page = cell.page
    page.get_by_role("button", name="Insert the key of level 1").click()
    for _ in range(4):
        page.get_by_role("button", name="Step: every device once").click()
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save the log").first.click()
    log = tmp_path / "log.jsonl"
    saved.value.save_as(log)
    scans = len(log.read_text().splitlines()) - 1
    assert scans > 4 * len(ROUND), "the log begins at power-up"
    page.click("nav [data-part=suites]")
    text = log.read_text().replace('"LA":false', '"LA":true', 1)
    for content, difference in ((log.read_text(), ""), (text, "the log has True")):
        log.write_text(content)
        page.set_input_files("#log", [])
        page.set_input_files("#log", log)
        page.wait_for_function(
            f"() => document.getElementById('told').textContent.startsWith('A log of {scans}')"
        )
        for _ in range(scans):
            page.click("#next")
        assert "The log is at its end." in page.locator("#told").inner_text()
        assert page.locator("[data-cell] [data-text=differs]").inner_text().endswith(difference)
        assert bool(difference) == bool(page.locator("[data-cell] [data-text=differs]").inner_text())
    page.click("#leave")


def test_a_play_is_saved_as_test_vectors(cell: Opened, tmp_path: Path) -> None:
    page = cell.page
    page.get_by_role("button", name="Insert the key of level 1").click()
    rounds(cell, 30)
    file = tmp_path / "played.jsonl"
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save as test vectors of fplc").click()
    saved.value.save_as(file)
    assert lint(file) == [] and saved.value.suggested_filename == "fplc-played.jsonl"
    target, suite, word, compared = verdict(cell, file)
    assert (target, suite, word) == ("fplc", "played", "CONFORMS")
    assert compared == "1 of 1 cases, 31 scans"
    page.click("nav [data-part=blocks]")
    card = "[data-block=sf_guard_locking] "
    page.click(f'{card}[data-do="reset"]')
    page.click(f"{card}[data-go=vectors]")
    assert page.locator("#told").inner_text() == "No test vectors: sf_guard_locking has not been called yet."


@pytest.mark.parametrize(("id", "root"), [("fplc", "[data-cell]"), ("sf_edm", "[data-block=sf_edm]")])
def test_a_case_of_a_vector_file_is_played(id: str, root: str, opened: Opened, tmp_path: Path) -> None:
    page, file = opened.page, tmp_path / "difference.jsonl"
    with gzip.open(ROOT / f"vectors/{id}/sequences.jsonl.gz", "rt", encoding="utf-8") as packed:
        header, case = (json.loads(line) for line in itertools.islice(packed, 2))
    for value, differs in ((False, False), (True, True)):
        if value:
            name = "ERROR" if id == "fplc" else "Error"
            case["scans"][0]["out"][name] = True
        file.write_text(f"{json.dumps(header)}\n{json.dumps(case)}\n", encoding="utf-8")
        page.click("nav [data-part=suites]")
        page.set_input_files("#log", [])
        page.set_input_files("#log", file)
        intro = f"A log of {len(case['scans'])} scans"
        page.wait_for_function(
            "(intro) => document.getElementById('told').textContent.startsWith(intro)", arg=intro
        )
        for _ in case["scans"]:
            page.click("#next")
        assert "The log is at its end." in page.locator("#told").inner_text()
        assert bool(page.locator(f"{root} [data-text=differs]").inner_text()) == differs
        page.click("#leave")


def reached(about: dict[str, Any], header: dict[str, Any], case: dict[str, Any]) -> set[tuple[Any, ...]]:
    """Each way of a case from state to state, and the outputs that changed on it."""
    target, kinds = header["target"], header["parameters"]
    params = {name: take(kinds[name], value) for name, value in case["params"].items()}
    device = Device(about["module"] + target, "", params)
    code, state, out = device.code, device.state, device.out
    given: dict[str, Any] = {}
    found = set()
    for scan in case["scans"]:
        given |= {name: take(header["inputs"][name], value) for name, value in scan["in"].items()}
        after, wrote = code.step(state, code.Inputs(scan["dt_ms"], **given))
        changed = tuple(name for name in header["outputs"] if getattr(out, name) != getattr(wrote, name))
        found.add((device.control(state), device.control(after), changed))
        state, out = after, wrote
    return found


def thinned(path: Path, to: Path, about: dict[str, Any]) -> dict[str, Any]:
    """A published suite as a file: of every n-th case, shortest first, those that reach something new."""
    with gzip.open(path, "rt", encoding="utf-8") as file:
        first, *lines = file
    header: dict[str, Any] = json.loads(first)
    if "MODEPROOF_LONG" not in os.environ:
        seen: set[tuple[Any, ...]] = set()
        kept = []
        for line in sorted(lines[:: max(1, header["scans"] // MOST_SCANS)], key=len):
            if new := reached(about, header, json.loads(line)) - seen:
                seen |= new
                kept.append(line)
        lines = kept
    header |= {"cases": len(lines), "scans": sum(len(json.loads(line)["scans"]) for line in lines)}
    to.write_text("".join([json.dumps(header) + "\n", *lines]), encoding="utf-8")
    return header


def verdict(opened: Opened, file: Path) -> list[str]:
    """The new row of the table after a file was chosen."""
    page, rows = opened.page, "#verdicts tbody tr"
    page.click("nav [data-part=suites]")
    before = page.locator(rows).count()
    page.set_input_files("#vectors", [])
    page.set_input_files("#vectors", file)
    page.wait_for_function(
        f"() => document.querySelectorAll('{rows}').length > {before}", timeout=10 * WAIT_MS
    )
    return page.locator(rows).last.locator("td").all_inner_texts()


@pytest.mark.sampled
@pytest.mark.parametrize("name", sorted(PUBLISHED, key=lambda name: (name != "sf_edm/sequences", name)))
def test_the_page_passes_a_published_suite(
    name: str, opened: Opened, tmp_path: Path, known: dict[str, Any]
) -> None:
    target, suite = name.split("/")
    about = next(about for about in known.values() if target in about["devices"])
    header = thinned(ROOT / "vectors" / f"{name}.jsonl.gz", tmp_path / "suite.jsonl", about)
    compared = f"{header['cases']:,} of {header['cases']:,} cases, {header['scans']:,} scans"
    assert verdict(opened, tmp_path / "suite.jsonl") == [target, suite, "CONFORMS", compared]


def test_the_page_says_where_it_differs_from_a_suite(opened: Opened, tmp_path: Path) -> None:
    with gzip.open(ROOT / "vectors/sf_edm/sequences.jsonl.gz", "rt", encoding="utf-8") as file:
        header, *cases = (json.loads(line) for line in file)
    cases[2]["scans"][0]["out"]["Error"] = True
    file = tmp_path / "planted.jsonl"
    file.write_text("".join(json.dumps(row) + "\n" for row in (header, *cases)))
    target, suite, word, compared = verdict(opened, file)
    assert (target, suite, word) == ("sf_edm", "sequences", "DIFFERS")
    assert compared.endswith(f"{cases[2]['id']}, scan 1: Error is False, expected True")


def test_a_file_that_is_no_suite_is_unjudged(opened: Opened, tmp_path: Path) -> None:
    file = tmp_path / "words.jsonl"
    file.write_text("nothing\n")
    assert verdict(opened, file)[::2] == ["words.jsonl", "UNJUDGED"]


def test_the_page_asks_for_nothing_and_says_nothing(opened: Opened, page_file: Path) -> None:
    assert [url for url in opened.asked if not url.startswith(("blob:", "data:"))] == [page_file.as_uri()]
    assert [text for text in opened.said if "upgrade needed" not in text] == []


@pytest.mark.sampled
@pytest.mark.parametrize("part", ["scene-mode_selection", "blocks", "findings", "suites"])
def test_everyone_can_use_the_page_down_to_a_phone(part: str, opened: Opened) -> None:
    page = opened.page
    page.click(f"nav [data-part={part}]")
    assert opened.inaccessible() == []
    for width in (800, 390):
        page.set_viewport_size({"width": width, "height": 900})
        assert opened.ask("() => document.documentElement.scrollWidth") <= width
    page.set_viewport_size({"width": 1280, "height": 900})


TAB_TO = """(words) => {
    const node = document.activeElement;
    return (node.getAttribute("aria-label") || node.textContent).trim() === words;
}"""


def tab_to(opened: Opened, words: str) -> None:
    """Press Tab until the focus is on what has this name, as one who has no mouse does."""
    for _ in range(80):
        opened.page.keyboard.press("Tab")
        if opened.ask(TAB_TO, words):
            return
    raise AssertionError(f"Tab does not lead to {words}")


def test_a_phone_and_a_keyboard_are_enough_for_an_error(cell: Opened) -> None:
    page = cell.page
    page.set_viewport_size({"width": 390, "height": 900})
    page.select_option("[data-go=profile]", "cautious")
    tab_to(cell, "Power off and on")
    page.keyboard.press("Enter")
    tab_to(cell, "Insert the key of level 2")
    page.keyboard.press("Enter")
    rounds(cell, 12)
    tab_to(cell, "Take the fault out")
    tab_to(cell, "Two outputs are wired to each other's inputextra wire; detected by nothing")
    page.keyboard.press("Space")
    assert "Detected by: nothing" in page.locator("[data-about]").inner_text()
    assert box(cell).startswith("Error mode: ")
    assert cell.ask("() => document.documentElement.scrollWidth") <= 390
    assert cell.inaccessible() == []
    page.set_viewport_size({"width": 1280, "height": 900})
    page.select_option("[data-go=profile]", "letter")
