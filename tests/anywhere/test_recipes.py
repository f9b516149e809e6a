"""The recipes for a server: the commands that stand in them run on somebody else's repository."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest

from modeproof.ground.places import TREE
from tests.anywhere.installed import Installed, recipe, spent
from tests.project.foreign import BLOCK, TOML, WRONG, write

INSTALL = 'pip install --find-links "$WHEELS" modeproof'
JUDGE = "modeproof judge --junit modeproof.xml --sarif modeproof.sarif --markdown modeproof.md"
AGAIN_S = 2.0
"""Of CPU."""
WORKFLOWS = ("action.yml", ".github/workflows/release.yml", "examples/ci/github.yml")


def of_action() -> list[str]:
    steps = recipe("action.yml")["runs"]["steps"]
    return [step["run"] for step in steps if "run" in step]


def of_gitlab() -> list[str]:
    return list(recipe("examples/ci/gitlab-ci.yml")["modeproof"]["script"])


def of_hook() -> list[str]:
    [hook] = recipe(".pre-commit-hooks.yaml")
    assert hook["language"] == "python" and hook["pass_filenames"] is False
    return [hook["entry"]]


def of_dockerfile() -> list[str]:
    """Its RUN steps without their mounts, then what a container runs."""
    lines = (TREE / "examples/ci/Dockerfile").read_text(encoding="utf-8").splitlines()
    steps = [line.partition(" ")[2] for line in lines if line.startswith("RUN ")]
    ran = [re.sub(r"^(--\S+ )+", "", step) for step in steps]
    entry, given = (
        json.loads(line.partition(" ")[2]) for line in lines if line.startswith(("ENTRYPOINT ", "CMD "))
    )
    user = next(line for line in lines if line.startswith("USER "))
    assert not user.startswith(("USER root", "USER 0")) and lines.index(user) > lines.index(
        f"RUN {steps[-1]}"
    )
    return [*ran, shlex.join([*entry, *given])]


RECIPES = {
    "action.yml": of_action,
    "examples/ci/gitlab-ci.yml": of_gitlab,
    ".pre-commit-hooks.yaml": of_hook,
    "examples/ci/Dockerfile": of_dockerfile,
}


def test_install_and_judge_are_alike_in_all() -> None:
    page = re.search(r"```sh\n(.*?)\n```", (TREE / "docs/recipes.md").read_text("utf-8"), re.S)
    assert page is not None and page[1].splitlines() == [INSTALL, JUDGE] == of_gitlab()
    assert of_action() == [INSTALL, JUDGE.replace("modeproof.md", '"$GITHUB_STEP_SUMMARY"')]
    assert of_dockerfile() == [INSTALL, "modeproof judge"]
    assert of_hook() == ["modeproof judge --quiet"]


def actions(text: str) -> list[str]:
    """The actions of a workflow that are not pinned by a hash."""
    used = re.findall(r"uses: (\S+)", text)
    return [name for name in used if not re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", name)]


def test_actions_are_pinned_by_their_hash() -> None:
    found = {name: actions((TREE / name).read_text("utf-8")) for name in WORKFLOWS}
    ours = ["OWNER/modeproof@v0.2.0", "github/codeql-action/upload-sarif@v3"]
    assert found == {"action.yml": [], ".github/workflows/release.yml": [], "examples/ci/github.yml": ours}
    assert actions("- uses: a/b@v4\n- uses: a/c@0123abc") == ["a/b@v4", "a/c@0123abc"]


def test_no_job_of_the_release_may_more_than_it_needs() -> None:
    workflow = recipe(".github/workflows/release.yml")
    assert workflow["permissions"] == {}
    may = {name: job.get("permissions", {}) for name, job in workflow["jobs"].items()}
    assert [name for name, granted in may.items() if granted != {"contents": "read"}] == ["attach"]
    assert may["attach"] == {"contents": "write"}
    for name in ("modeproof", "prove-program", "doctor"):
        assert any(name in step.get("run", "") for step in workflow["jobs"]["prove"]["steps"])


@pytest.mark.deep
def test_each_recipe_judges_a_foreign_repository(installed: Installed, tmp_path: Path) -> None:
    folder = write(tmp_path / "theirs", plc__contactors_st=BLOCK)
    installed.run(folder, "modeproof", "example", "fplc_good.csv")
    assert "with 2 entries" in installed.run(folder, "modeproof", "init").stdout
    summary = tmp_path / "summary.md"
    for number, (name, commands) in enumerate(RECIPES.items()):
        ran = [command for command in commands() if command != INSTALL]  # what is installed was by this line
        assert len(ran) == 1, name
        done = installed.run(folder, "sh", "-c", ran[0], GITHUB_STEP_SUMMARY=str(summary))
        assert re.search(r"^sf_edm +FOLLOWS +", done.stdout, re.M), name
        assert re.search(r"^fplc_good +CONFORMS +fplc", done.stdout, re.M), name
        assert f"2 as expected; {2 if number else 0} kept" in done.stdout
    assert "FOLLOWS" in summary.read_text("utf-8") and "FOLLOWS" in (folder / "modeproof.md").read_text(
        "utf-8"
    )
    assert json.loads((folder / "modeproof.sarif").read_text("utf-8"))["runs"][0]["results"] == []


@pytest.mark.deep
def test_a_program_that_differs_fails_in_each_form(installed: Installed, tmp_path: Path) -> None:
    folder = write(tmp_path / "theirs", modeproof_toml=TOML, plc__contactors_st=WRONG)
    installed.run(folder, "sh", "-c", JUDGE, status=1)
    [suite] = ElementTree.parse(folder / "modeproof.xml").getroot()
    assert suite.get("name") == "contactors" and suite.get("errors") == "0"
    assert int(suite.get("failures") or 0) > 0, "the demands that it breaks"
    [run] = json.loads((folder / "modeproof.sarif").read_text("utf-8"))["runs"]
    result = run["results"][0]
    where = result["locations"][0]["physicalLocation"]
    assert where["artifactLocation"]["uri"] == "plc/contactors.st" and where["region"]["startLine"] > 1
    assert "REFUTED" in (folder / "modeproof.md").read_text("utf-8")


@pytest.mark.long
def test_four_kinds_of_entries_are_judged_once(installed: Installed, tmp_path: Path) -> None:
    for name in (
        "sf_edm.st",
        "cell.st",
        "cell.toml",
        "wiring.toml",
        "safety.toml",
        "use.toml",
        "fplc_good.csv",
    ):
        installed.run(tmp_path, "modeproof", "example", name)
    assert "with 4 entries" in installed.run(tmp_path, "modeproof", "init").stdout
    assert "4 as expected; 0 kept" in installed.run(tmp_path, "modeproof", "judge").stdout
    began = spent()
    assert "4 as expected; 4 kept" in installed.run(tmp_path, "modeproof", "judge").stdout
    assert spent() - began <= AGAIN_S
