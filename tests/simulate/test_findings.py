"""Every finding's recorded counterexample in Chromium: played to its end, all rows compared."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser

from modeproof.ground.places import documents
from modeproof.registers.load import load_document
from modeproof.simulate import facts, recorded
from modeproof.simulate.build import make
from tests.report.browser.opened import Opened, open_page
from tests.simulate.conftest import READY, ROOT, RUN, SCENE

PLAY = """async ({ hash, of }) => {
    const told = document.getElementById("told"), next = document.getElementById("next");
    const before = told.textContent;
    location.hash = hash;
    for (let turn = 0; turn < 1000 && told.textContent === before; turn++)
        await new Promise((done) => setTimeout(done));
    const seen = [{ told: told.textContent }];
    const root = document.querySelector(of);
    const by = (query, name, what) => Object.fromEntries(
        [...root.querySelectorAll(query)].map((node) => [node.dataset[name], what(node)]));
    const part = (id) => (node) => node.querySelector(`[data-part-of=${id}]`).textContent;
    while (!next.disabled && seen.length < 200) {
        next.click();
        seen.push({
            told: told.textContent,
            text: by("[data-text]", "text", (node) => node.textContent),
            lit: by("[data-on]", "on", (node) => node.classList.contains("on")),
            open: by("[data-open]", "open", (node) => !node.disabled),
            states: by("[data-device]", "device", part("state")),
            steps: by("[data-device]", "device", part("step")),
        });
    }
    return seen;
}"""
SCREENS = {
    "inhibited": "Insert a key",
    "select": "Select a mode",
    "waiting": "Please wait",
    "confirm": "Is this right?",
}
USABLE_S = 3
DOCUMENTS = documents(ROOT)


def rows_of(run: dict[str, Any]) -> list[dict[str, Any]]:
    """The recorded rows, each with all that stands."""
    rows: list[dict[str, Any]] = []
    for row in json.loads(run["rows"]):
        before = rows[-1] if rows else {}
        rows.append(row | {of: {**before.get(of, {}), **row.get(of, {})} for of in recorded.GROUPS})
    return rows


def drawn_otherwise(seen: dict[str, Any], name: str, value: Any) -> bool:
    """Whether a recorded signal stands nowhere in what the page shows, or with another value."""
    text, lit = seen["text"], seen["lit"]
    if name == "screen":
        return bool(text["screen"] != SCREENS[value])
    if name == "shown":
        return not text["echo"].startswith("" if value == -1 else f"Mode {value}: ")
    if name == "enabled":
        return [mode for mode in range(5) if seen["open"][f"select:{mode}"]] != value
    if isinstance(value, bool) and (name in lit or f"in.{name}" in lit):
        return bool(lit[name if name in lit else f"in.{name}"] != value)
    if name in text:
        return bool(text[name] != f"{value:04X}")
    written = (str(value), "none" if value in (-1, "") else f"{value:04X}" if isinstance(value, int) else "")
    return not any(f"{name} {word}" in text["user"].split("; ") for word in written)


def differences(seen: list[dict[str, Any]], rows: list[dict[str, Any]]) -> list[str]:
    """What the page showed otherwise than it is recorded, row by row."""
    if len(seen) != len(rows) + 1:
        return [f"{len(seen) - 1} rows are shown, {len(rows)} are recorded"]
    found = []
    for number, (shown, row) in enumerate(zip(seen[1:], rows, strict=True), 1):
        head = f"row {number} of {len(rows)}"
        found += [
            f"{head}: {name}" for name, value in row["wires"].items() if drawn_otherwise(shown, name, value)
        ]
        found += [
            f"{head}: {device} is in {shown['states'].get(device)}"
            for device, state in row["states"].items()
            if shown["states"].get(device) != state
        ]
        if row["who"] and shown["steps"][row["who"]] != row["step"]:
            found.append(f"{head}: {row['who']} took {shown['steps'][row['who']]}")
        if not shown["told"].startswith(f"{number} of {len(rows)}: {row['step'] or 'power-up'}"):
            found.append(f"{head}: told {shown['told']}")
    return found


def play(opened: Opened, name: str, about: dict[str, Any], finding: str, run: str) -> list[dict[str, Any]]:
    """What the page shows, told line by told line."""
    of = "[data-cell]" if name == SCENE else f"[data-block={next(iter(about['devices']))}]"
    seen: list[dict[str, Any]] = opened.ask(PLAY, {"hash": f"finding={finding}&run={run}", "of": of})
    return seen


@pytest.mark.sampled
@pytest.mark.parametrize("name", sorted(DOCUMENTS, key=lambda name: (name == SCENE, name)))
def test_every_finding_plays_what_is_recorded(name: str, opened: Opened, known: dict[str, Any]) -> None:
    about = known[name]
    runs = {run["run"]: run for run in about["recorded"]}
    played = 0
    for finding in about["findings"]:
        for id in finding["runs"]:
            seen = play(opened, name, about, finding["id"], id)
            assert seen[0]["told"].startswith(f"{finding['id']}: {finding['title']}")
            assert differences(seen, rows_of(runs[id])) == [], id
            assert f"Here {runs[id]['property']} fails" in seen[-1]["told"]
            played += 1
    assert played >= 10
    opened.page.click("#leave")


@pytest.mark.deep
def test_an_altered_recorded_output_is_noticed(browser: Browser, recorded_place: Path) -> None:
    about = facts_of(recorded_place)
    run = next(run for run in about["recorded"] if run["run"] == RUN)
    html = make(recorded_place)
    planted = html.replace(r"\"MSO_3\":true", r"\"MSO_3\":false", 1)
    assert planted != html
    for text, wrong in ((html, []), (planted, ["row 2 of 2: MSO_3"])):
        file = recorded_place / "simulate.html"
        file.write_text(text, encoding="utf-8")
        with open_page(browser, file) as page:
            page.page.wait_for_function(READY)
            assert differences(play(page, SCENE, about, "E-01", RUN), rows_of(run)) == wrong


def facts_of(place: Path) -> dict[str, Any]:
    """The facts of the note in another tree."""
    return facts.of_document(load_document(place, SCENE))


def test_every_finding_with_a_counterexample_can_be_played(known: dict[str, Any]) -> None:
    """What is missing is made by modeproof renew."""
    for name in DOCUMENTS:
        document, about = load_document(ROOT, name), known[name]
        assert [finding["id"] for finding in about["findings"]] == [of.id for of in document.findings]
        assert [finding["why"] for finding in about["findings"] if "Not recorded" in finding["why"]] == []
        for finding, of in zip(about["findings"], document.findings, strict=True):
            assert bool(finding["runs"]) != bool(finding["why"])
            assert not of.telling or finding["runs"][0] == of.telling.run


def test_nothing_can_be_touched_while_a_record_is_shown(opened: Opened, known: dict[str, Any]) -> None:
    key = opened.page.get_by_role("button", name="Insert the key of level 1")
    seen = play(opened, SCENE, known[SCENE], "E-01", RUN)
    assert seen[-1]["text"]["SelectMSO.says"] == "not recorded"
    assert key.is_disabled()
    opened.page.click("#leave")
    assert key.is_enabled()


@pytest.mark.deep
def test_everyone_can_follow_a_record_at_800_pixels(opened: Opened, known: dict[str, Any]) -> None:
    opened.page.set_viewport_size({"width": 800, "height": 900})
    for name, finding, run in ((SCENE, "E-52", "NEG_KeyFlows_no_dwell"), ("edm", "EDMF-04", "")):
        runs = next(of["runs"] for of in known[name]["findings"] if of["id"] == finding)
        play(opened, name, known[name], finding, run or runs[0])
        assert opened.ask("() => document.documentElement.scrollWidth") <= 800
        assert opened.inaccessible() == []
        opened.page.click("#leave")


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ("E-22", "E-22: five names for what happens on an error"),
        ("E-999", "There is no finding 'E-999' in this page."),
        ("E-01&run=NEG_other", "NEG_other is no run of it that can be played."),
    ],
)
def test_an_address_that_plays_nothing_says_why(wanted: str, said: str, opened: Opened) -> None:
    opened.ask("(hash) => { location.hash = hash; }", f"finding={wanted}")
    opened.page.wait_for_function(
        "(said) => document.getElementById('told').textContent.includes(said)", arg=said
    )
    assert opened.page.locator("#next").is_disabled()


def test_a_link_plays_and_plays_once_more(opened: Opened) -> None:
    told, link = (
        opened.page.locator("#told"),
        opened.page.get_by_role("link", name="Play E-52, NEG_KeyFlows_no_dwell"),
    )
    for _ in range(2):
        opened.page.click("nav [data-part=findings]")
        link.first.click()
        opened.page.wait_for_function(
            "() => document.getElementById('told').textContent.startsWith('E-52: ')"
        )
        opened.page.click("#next")
        assert told.inner_text().startswith("1 of ")
    opened.page.click("#leave")


@pytest.mark.deep
def test_the_page_is_usable_after_little_computing(browser: Browser, page_file: Path) -> None:
    """What it computes until then, of 3 s at most; how long that takes on a machine, `make bench` says."""
    with open_page(browser, page_file) as opened:
        session = opened.page.context.new_cdp_session(opened.page)
        session.send("Performance.enable", {"timeDomain": "threadTicks"})
        opened.page.reload()
        opened.page.wait_for_function(READY)
        spent = {of["name"]: of["value"] for of in session.send("Performance.getMetrics")["metrics"]}
        assert 0.05 < spent["TaskDuration"] < USABLE_S


@pytest.mark.deep
def test_the_page_opens_at_a_finding(browser: Browser, page_file: Path) -> None:
    with open_page(browser, page_file, "#finding=E-52") as opened:
        opened.page.wait_for_function(READY)
        assert opened.page.locator("#told").inner_text().startswith("E-52: ")
        opened.page.keyboard.press("Enter")
        assert opened.page.locator("#told").inner_text().startswith("1 of ")


def test_the_report_links_each_finding_to_its_play() -> None:
    text = (ROOT / "modeproof/report/page/findings.html.j2").read_text(encoding="utf-8")
    entry = text[text.index("<article") : text.index("</article>")]
    assert 'href="{{ data.play }}#finding={{ one.id }}"' in entry
