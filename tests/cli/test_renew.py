"""`modeproof renew`, in the tree of the sixth document: what is stale is made anew, and nothing that the
specification does not accept.
"""

from __future__ import annotations

import gzip
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from modeproof.ground import places
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import TREE
from modeproof.ground.progress import Progress
from modeproof.lane import staging
from modeproof.lane.renew import _blocks_of
from modeproof.lane.renewal import Refused, Renewal, Stale, _cases, _pages_of_faults, _runs_to_check
from tests.cli.test_sixth_document import edit, empty_root, with_the_sixth

DRIVER = """
import contextlib, io, json, sys
from modeproof.cli import main
from modeproof.suites.kinds import SUITES
for name in [name for name in SUITES if name not in ("brief", "sequences")]:
    del SUITES[name]  # the others take long
found = []
for words in json.loads(sys.argv[1]):
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        status = main(words.split())
    found.append([status, out.getvalue()])
print(json.dumps(found))
"""
GATE, CODE, PROOF = "spec/sluice/Gate.tla", "refimpl/sluice/gate.py", "proofs/sluice/gate_safety.py"
BRIEF, SUMS, PINS = "vectors/gate/brief.jsonl.gz", "vectors/SHA256SUMS", "spec/sluice/pins.toml"


def modeproof(root: Path, *commands: str) -> list[tuple[int, str]]:
    """Exit status and output of each command; only the short suites are built."""
    env = {**os.environ, "MODEPROOF_ROOT": str(root), "PYTHONPATH": str(root)}
    env.pop("CI", None)
    done = subprocess.run(
        [sys.executable, "-c", DRIVER, json.dumps(commands)],
        cwd=root,
        env=env,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return [(int(status), str(text)) for status, text in json.loads(done.stdout.splitlines()[-1])]


def files(root: Path) -> dict[str, bytes]:
    """Every file of the tree that is not built."""
    return {name: (root / name).read_bytes() for name in staging.hashes(root)}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tree of the sixth document, with its vectors and its page."""
    root = with_the_sixth(empty_root(tmp_path_factory.mktemp("renew") / "root"))
    answers = modeproof(root, "renew --quiet", "render", "renew --quiet")
    assert [status for status, _ in answers] == [0, 0, 0], answers
    assert "gate: 2 suites are others now" in answers[0][1] and f"\n  {BRIEF}\n" in answers[0][1]
    assert "sluice: nothing to do" in answers[2][1]
    return root


@pytest.fixture
def root(made: Path) -> Iterator[Path]:
    """The same, put back afterwards."""
    before = files(made)
    yield made
    for name in files(made).keys() - before.keys():
        (made / name).unlink()
    for name, content in before.items():
        (made / name).write_bytes(content)


def test_comments_docstrings_and_layout_make_nothing_stale(root: Path) -> None:
    edit(root, GATE, "Leaves out how the motor moves it.", "How the motor moves it is left out.")
    edit(root, GATE, "Ready(i) == i.BeaconLit\n", "Ready(i) == i.BeaconLit    \\* lit\n\n")
    edit(root, CODE, "What one scan reads; dt_ms", "One scan reads: dt_ms")
    edit(root, PROOF, '"""What gate and beacon promise, whatever they read."""', '"""What both promise."""')
    edit(root, "spec/sluice/interface.toml", "[devices.gate]\n", "# the gate\n[devices.gate]\n")
    before = files(root)
    (status, said), (renewed, told) = modeproof(root, "registers", "renew --quiet")
    assert status == 0 and "0 problems" in said and "registers: as expected" in said
    assert renewed == 0 and "sluice: nothing to do" in told
    assert files(root) == before


def _without(root: Path, file: str, line: str) -> None:
    text = (root / file).read_text()
    assert line in text
    kept = [one for one in text.splitlines(keepends=True) if line not in one]
    (root / file).write_text("".join(kept))


def _edited_vectors(root: Path) -> None:
    lines = gzip.decompress((root / BRIEF).read_bytes()).replace(b"true", b"false", 1)
    (root / BRIEF).write_bytes(gzip.compress(lines))


def _no_vectors(root: Path) -> None:
    (root / BRIEF).unlink()


def _of_another_text(root: Path) -> None:
    _without(root, SUMS, "spec/sluice/Gate.tla")


def _not_judged(root: Path) -> None:
    text, table, _ = (root / PINS).read_text().partition("[killers]\n")
    (root / PINS).write_text(text + table)


def _page_by_hand(root: Path) -> None:
    edit(root, "docs/sluice-findings.md", "`OpensOverBeacon` fails", "`OpensOverBeacon` holds")


def _block_by_hand(root: Path) -> None:
    (root / "README.md").write_text("<!-- begin documents -->\nnone\n<!-- end documents -->\n")


STALE = {
    f"{BRIEF}: was changed since it was published": _edited_vectors,
    f"{BRIEF}: is not there": _no_vectors,
    f"vectors/gate: {GATE} has changed since it was published": _of_another_text,
    "MotorOnlyOpen: has not been judged": _not_judged,
    "docs/sluice-findings.md: line": _page_by_hand,
    "README.md: a rendered block has drifted": _block_by_hand,
}


@pytest.mark.parametrize("said", STALE)
def test_what_is_stale_names_one_command_which_mends_it(said: str, root: Path) -> None:
    before = files(root)
    STALE[said](root)
    (first, told), (status, _), (again, nothing), (last, text) = modeproof(
        root, "registers", "renew --quiet", "renew --quiet", "registers"
    )
    (line,) = (one for one in told.splitlines() if said in one)
    assert first == 1
    if "is not there" not in said:
        assert "if that was not meant, undo it; if it was: modeproof renew" in line
    assert (status, again, last) == (0, 0, 0), text
    assert "sluice: nothing to do" in nothing and "README.md and docs: nothing to do" in nothing
    if said != "README.md: a rendered block has drifted":
        assert files(root) == before


def test_a_pin_moves_with_a_reason_alone(root: Path) -> None:
    edit(root, PROOF, "only in a scan in which it reads", "only in one scan, in which it reads")
    before = files(root)
    (refused, why), (done, moved), (last, _) = modeproof(
        root, "renew --quiet", "renew --quiet --reason plainer", "registers"
    )
    assert refused == 1 and "these pins would move:\n  theorems.the_gate_opens_only_over" in why
    assert (done, last) == (0, 0) and "theorems.the_gate_opens_only_over_a_lit_beacon: " in moved
    assert {name for name, content in files(root).items() if before[name] != content} == {PINS}
    assert ": plainer" in (root / PINS).read_text()


REFUSED = {
    "a theorem that the code does not fulfil": (
        (PROOF, "return TRUE, one.inputs.BeaconLit", "return TRUE, one.inputs.OpenRequest"),
        "the code does not do what a theorem says now:",
    ),
    "a theorem that its edit refutes no more": (
        (PROOF, "return TRUE, one.inputs.BeaconLit", "return TRUE, TRUE"),
        "these theorems hold of the code with the edit that is to refute them, so they say nothing:",
    ),
    "a property that its edit breaks no more": (
        (
            GATE,
            "MotorOnlyOpen == (GateOutputs.GateMotor =>",
            "MotorOnlyOpen == (GateOutputs.GateMotor /\\ elapsed > 9 =>",
        ),
        "with its edit in killers.toml this property holds all the same, so it says nothing:",
    ),
    "a specification that opens over a dark beacon": (
        (GATE, "Ready(i) == i.BeaconLit", "Ready(i) == i.OpenRequest"),
        "the specification does not hold any more:",
    ),
    "a specification that the code does not follow": (
        (GATE, 'gateState\' = "Calling"', 'gateState\' = (IF i.BeaconLit THEN "Open" ELSE "Calling")'),
        "specification and reference implementation differ",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_the_specification_rejects_is_not_published(what: str, root: Path) -> None:
    (file, old, new), said = REFUSED[what]
    edit(root, file, old, new)
    before = files(root)
    ((status, text),) = modeproof(root, "renew --quiet --reason meant")
    assert status == 1 and said in text, text
    assert files(root) == before


def test_unsafe_code_is_refused_with_the_scans(root: Path) -> None:
    _of_another_text(root)
    edit(root, CODE, "if i.BeaconLit:", "if i.OpenRequest:")
    before = files(root)
    ((status, text),) = modeproof(root, "renew --quiet")
    assert status == 1 and "specification and reference implementation differ" in text, text
    assert "shortest inputs from power-up:" in text and "scan 2: " in text
    assert files(root) == before


SCRIPT = """
import pathlib, sys
here = pathlib.Path(__file__)
print("NOT st-one: PROVED")
with here.with_suffix(".md").open("a") as page:
    print(*sys.argv[1:], file=page)
sys.exit(int(here.with_suffix(".status").read_text()))
"""


def test_pages_of_faulty_programs_follow_the_cases_of_their_target(tmp_path: Path) -> None:
    folder = tmp_path / "examples/faulty"
    folder.mkdir(parents=True)
    for name in ("awl", "st"):
        (folder / f"{name}.py").write_text(SCRIPT, "utf-8")
        (folder / f"{name}.status").write_text("0", "utf-8")
        (folder / f"{name}.toml").write_text(f'[[fault]]\nfile = "examples/{name}/gate.{name}"\n', "utf-8")
    work = Renewal(tmp_path, "sluice", lambda pins: "", Progress(quiet=True))
    _pages_of_faults(work, "lock")
    assert not (folder / "st.md").exists() and not (folder / "awl.md").exists()
    _pages_of_faults(work, "gate")
    assert (folder / "st.md").read_text("utf-8") == "--render --target gate\n"
    assert (folder / "awl.md").read_text("utf-8") == "--render\n"
    (folder / "st.status").write_text("1", "utf-8")
    with pytest.raises(Refused, match="NOT st-one: PROVED"):
        _pages_of_faults(work, "gate")
    (folder / "st.status").write_text("2", "utf-8")
    with pytest.raises(Unjudged, match=r"examples/faulty/st\.py"):
        _pages_of_faults(work, "gate")


def test_another_header_is_no_other_case(tmp_path: Path) -> None:
    room = tmp_path / "vectors/gate"
    room.mkdir(parents=True)
    found = []
    for text in (b"header\ncase\n", b"another header\ncase\n", b"header\nanother case\n"):
        (room / "brief.jsonl.gz").write_bytes(gzip.compress(text))
        found.append(_cases(tmp_path, "gate"))
    assert found[0] == found[1] != found[2]


def test_vectors_of_a_machine_wait_for_every_changed_block() -> None:
    assert _blocks_of(TREE, ["refimpl/guard_locking/sf_guard_locking.py"]) == [
        ("guard_locking", "sf_guard_locking")
    ]
    assert len(_blocks_of(TREE, ["refimpl/cyclic_block.py"])) == 4
    assert _blocks_of(TREE, ["spec/machine_cell/use.toml"]) == []


# ------------------------------------------------------------------------------------------ all or nothing


def test_a_story_of_a_new_run_has_changed_nothing() -> None:
    work = Renewal(places.root(), "edm", "".join, Progress(quiet=True))
    there = next(run.id for run in work.document.runs if run.kind == "NEG")
    assert list(_runs_to_check(work, Stale(stories=("NEG_SF_EDM_new",)))) == []
    assert len(list(_runs_to_check(work, Stale(stories=(there,))))) > 10


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """Two files in a tree."""
    for name in ("spec/a.toml", "docs/b.md"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text("old")
    return tmp_path


def write(tree: Path) -> None:
    for name in ("spec/a.toml", "docs/b.md", "docs/c.md"):
        (tree / name).write_text("new")


def texts(place: Path) -> list[str]:
    return [path.read_text() for path in (*place.glob("spec/*"), *sorted(place.glob("docs/*")))]


def test_interrupted_work_leaves_the_old_state(small: Path) -> None:
    with pytest.raises(KeyboardInterrupt), staging.copied(small) as copy:
        write(copy.tree)
        raise KeyboardInterrupt
    assert texts(small) == ["old", "old"] and not (small / "build/renew").exists()


def test_files_are_put_all_at_once(small: Path) -> None:
    with staging.copied(small) as copy:
        write(copy.tree)
        assert texts(small) == ["old", "old"]
        assert copy.put() == ["docs/b.md", "docs/c.md", "spec/a.toml"]
    assert texts(small) == ["new", "new", "new"] and not (small / "build/renew").exists()


def test_renames_that_were_cut_short_are_finished(small: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rename, done = os.replace, []

    def cut(source: Path, target: Path) -> None:
        if len(done) == 2:
            raise KeyboardInterrupt
        rename(source, target)
        done.append(target)

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt), staging.copied(small) as copy:
        write(copy.tree)
        patch.setattr("modeproof.lane.staging.os.replace", cut)
        copy.put()
    assert texts(small) == ["old", "new"]  # the journal itself was the first
    assert staging.finish(small) and texts(small) == ["new", "new", "new"]
    assert not staging.finish(small)


def test_a_tree_that_was_written_to_meanwhile_is_left_alone(small: Path) -> None:
    with pytest.raises(Unjudged, match=r"spec/a\.toml was written to while"), staging.copied(small) as copy:
        write(copy.tree)
        (small / "spec/a.toml").write_text("mine")
        copy.put()
    assert texts(small) == ["mine", "old"]
