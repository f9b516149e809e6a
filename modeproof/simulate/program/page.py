"""The page: draws what the scenes show, takes what the user does, plays stories, logs and recorded runs."""

from __future__ import annotations

from typing import Any

from browser import document, window
from javascript import JSON

from modeproof.simulate.program.block import Block, recorded
from modeproof.simulate.program.by_name import module_named
from modeproof.simulate.program.fault_box import draw_fault
from modeproof.simulate.program.files import Files, as_log, save_vectors
from modeproof.simulate.program.links import NoPlay, added, read, written
from modeproof.simulate.program.play import Player, of_log, of_recorded, of_story
from modeproof.simulate.program.view import View

FACTS: dict[str, Any] = JSON.parse(document["facts"].textContent)
PROFILE = '[data-go="profile"]'


class Page:
    """All that is open: the views by part, the story that is told, and what plays by itself."""

    def __init__(self) -> None:
        self.views: dict[str, list[View]] = {}
        self.player: Player | None = None
        self.running: dict[Any, Any] = {}
        self.told: Any = None
        self.done: dict[str, list[str]] = {}
        self.keys = 0
        self.drawn_fault: dict[str, str] = {}
        self.code: dict[str, Any] = {}
        for name in FACTS["scenes"]:
            self.code[name] = module_named(f"scenes.{name}.scene")
            self.open_free(name)
        self.parts = [nav.attrs["data-part"] for nav in document.select("nav [data-part]")]
        for nav in document.select("nav [data-part]"):
            nav.bind("click", lambda event: self.show_part(event.currentTarget.attrs["data-part"]))
        self.show_part(self.parts[0])
        document["choose"].bind("change", lambda event: self.choose(event.target.value))
        document["findings"].bind("click", lambda event: self.again(event.target))
        window.bind("hashchange", lambda event: self.follow())
        document["next"].bind("click", lambda event: self.next())
        document["leave"].bind("click", lambda event: self.leave())
        document["run"].bind("click", lambda event: self.toggle(event.currentTarget, self.next, 1200))
        files = Files(FACTS["documents"])
        document["vectors"].bind("change", lambda event: files.suites(list(event.target.files)))
        document["log"].bind("change", lambda event: self.read_log(event.target))

    # ---------------------------------------------------------------------------------------------- parts

    def show_part(self, id: str) -> None:
        """One part alone; the blocks are made when they are first looked at."""
        if id == "blocks":
            self.open_blocks()
        for nav in document.select("nav [data-part]"):
            part = nav.attrs["data-part"]
            document[part].hidden = part != id
            nav.attrs["aria-current"] = "page" if part == id else "false"

    def open_blocks(self) -> None:
        """A view of each card."""
        for card in document.select("[data-block]"):
            id = card.attrs["data-block"]
            if id not in self.views:
                facts = FACTS["documents"][card.attrs["data-document"]]
                self.views[id] = [View(card, Block(id, facts, {}), facts)]
                self.listen(card, id)
                for field in card.select("[data-param]"):
                    field.bind("change", lambda event, id=id: self.set_param(id, event.currentTarget))
                self.after(id)

    def set_param(self, id: str, field: Any) -> None:
        """Another parameter of a block; a value out of range is said and not taken."""
        self.act(id, f"param {field.attrs['data-param']} {field.value}")

    def open_free(self, name: str) -> None:
        """One cell to play freely: it has been on for a while and is ready for a key."""
        self.open_cells(name, [{"title": "", "params": self.profile(name)}])
        self.act(name, "settle")
        self.done[name] = []

    def begin_anew(self, name: str) -> None:
        """Free play with the profile that is chosen, also in the middle of a story."""
        self.leave()
        self.open_free(name)

    def profile(self, name: str) -> dict[str, Any]:
        """The parameters of the profile that is chosen, of each device that has profiles."""
        field = document[f"scene-{name}"].select_one(PROFILE)
        devices = FACTS["documents"][name]["devices"]
        return {id: row["profiles"][field.value] for id, row in devices.items() if row["profiles"]}

    def open_cells(self, name: str, cells: list[dict[str, Any]]) -> None:
        """One drawing a cell, all of the same scene, each with its own parameters."""
        root = document[f"scene-{name}"]
        frame = root.select_one(".cells")
        drawn = frame.select("[data-cell]")
        for extra in drawn[1:]:
            extra.remove()
        fresh = name not in self.views
        for _ in cells[1:]:
            frame.appendChild(drawn[0].clone(True))
        facts, code = FACTS["documents"][name], self.code[name]
        self.views[name] = []
        for of, node in zip(cells, frame.select("[data-cell]"), strict=True):
            node.select_one("[data-title]").text = of["title"]
            view = View(node, code.Scene(facts, of["params"]), facts)
            self.views[name].append(view)
            view.lay_out(code)
            if not fresh and node is not drawn[0] and node != drawn[0]:
                self.listen(node, name)
        if fresh:
            self.listen(root, name)
            for field in root.select("[data-choose]"):
                field.bind("change", lambda event: self.aim(root, name, event.currentTarget))
        frame.classList.toggle("two", len(cells) > 1)
        _allow(root, True)
        self.after(name)

    def listen(self, root: Any, name: str) -> None:
        """Buttons of a part: what they do, and what plays the time."""
        for button in root.select("[data-do]"):
            button.bind("click", lambda event: self.act(name, event.currentTarget.attrs["data-do"]))
        for button in root.select("[data-go]"):
            go = button.attrs["data-go"]
            if go == "profile":
                button.bind("change", lambda event: self.begin_anew(name))
            elif go != "speed":
                button.bind("click", lambda event, go=go: self.go(name, go, root, event.currentTarget))

    # -------------------------------------------------------------------------------------------- actions

    def act(self, name: str, text: str) -> None:
        """One action in every view of a part; what is refused is said."""
        try:
            self.take(name, text)
        except ValueError as error:
            self.say(f"Refused: {error}")
        self.after(name)

    def take(self, name: str, text: str) -> None:
        """One action in every view; of a free play it is remembered. Raises ValueError."""
        for view in self.views[name]:
            view.scene.do(text)
        if self.player is None:
            self.done[name] = added(self.done.get(name, []), text)

    def after(self, name: str) -> None:
        """Draw a part anew, and say what is new to one who listens."""
        news = [view.refresh() for view in self.views[name]]
        for line in news:
            if line:
                document["said"].text = line
        view = self.views[name][0]
        root = document.select_one(f'[data-scene="{name}"]')
        if root is not None:
            shown = view.shown["text"]
            for node in root.select("[data-at]"):
                node.text = shown.get(node.attrs["data-at"], "")
            for field in root.select("[data-choose]"):
                field.value = str(getattr(view.scene.faults, field.attrs["data-choose"]))
            active = view.scene.faults.active
            if active != self.drawn_fault.get(root.id):
                self.drawn_fault[root.id] = active
                draw_fault(root, view.facts["faults"], active)

    def aim(self, root: Any, name: str, field: Any) -> None:
        """Where the fault is."""
        self.act(name, f"{field.attrs['data-choose']} {field.value}")

    def go(self, name: str, go: str, root: Any, button: Any) -> None:
        """A button of the time: one round, play and pause, power off and on, save."""
        if go == "round":
            self.act(name, "round 1")
        elif go == "reset":
            self.act(name, "reset")
        elif go == "play":
            speed = root.select_one('[data-go="speed"]')
            every = int(speed.value) if speed is not None else 100
            self.toggle(button, lambda: self.act(name, "round 1"), every)
        elif go == "link":
            self.link(name)
        elif go == "vectors":
            save_vectors(self.views[name][0].scene, button.attrs["data-of"], self.say)
        elif go == "save":
            view = self.views[name][0]
            window.saveText(f"{name}.jsonl", view.scene.log())

    def link(self, name: str) -> None:
        """Put the play into the address of the page."""
        try:
            if self.player is not None:
                raise NoPlay("only a free play has one; choose Leave first")
            profile = document[f"scene-{name}"].select_one(PROFILE).value if name in FACTS["scenes"] else ""
            text = written(name, profile, self.done.get(name, []), window.encodeURIComponent)
        except NoPlay as error:
            self.say(f"No link: {error}.")
            return
        window.setAddress(f"#{text}")
        self.say("The address of this page now carries this play. Copy it: whoever opens it sees the same.")

    def begin_play(self, wanted: dict[str, str]) -> None:
        """Play what an address carries, all at once; then the user goes on."""
        name, profile = wanted["play"], wanted.get("profile", "")
        try:
            actions = read(wanted.get("do", ""))
            if name in FACTS["scenes"]:
                field = document[f"scene-{name}"].select_one(PROFILE)
                field.value = profile
                if field.value != profile or not profile:
                    field.value = "letter"
                    raise NoPlay(f"there is no profile {profile!r}")
                self.show_part(f"scene-{name}")
                self.open_free(name)
            elif name in FACTS["blocks"]:
                self.show_part("blocks")
                self.anew(name)
                self.views[name][0].root.scrollIntoView()
            else:
                raise NoPlay(f"nothing here is {name!r}")
            for text in actions:
                self.take(name, text)
        except ValueError as error:
            self.say(f"The link cannot be played: {error}.")
        else:
            self.say(f"This play came with the link: {'; '.join(actions)}. Go on from here.")
        if name in self.views:
            self.after(name)

    def anew(self, id: str) -> None:
        """A block after power-up, with the default parameters."""
        view = self.views[id][0]
        view.scene.params = {}
        view.scene.reset()
        for field in view.root.select("[data-param]"):
            default = view.scene.row["parameters"][field.attrs["data-param"]]["default"]
            field.value = str(default).lower() if isinstance(default, bool) else str(default)
        self.done[id] = []

    def toggle(self, button: Any, work: Any, every_ms: int) -> None:
        """Play or pause; each button plays by itself."""
        if "data-key" not in button.attrs:
            self.keys += 1
            button.attrs["data-key"] = str(self.keys)
        key = button.attrs["data-key"]
        if key in self.running:
            window.clearInterval(self.running.pop(key)[0])
            button.attrs["aria-pressed"], button.text = "false", "Play"
        else:
            self.running[key] = (window.setInterval(work, every_ms), button)
            button.attrs["aria-pressed"], button.text = "true", "Pause"

    def pause(self) -> None:
        """Whatever plays stops."""
        for number, button in self.running.values():
            window.clearInterval(number)
            button.attrs["aria-pressed"], button.text = "false", "Play"
        self.running = {}

    # -------------------------------------------------------------------------------------------- stories

    def choose(self, value: str) -> None:
        """Begin a story or a recorded run, or leave both."""
        self.leave(keep=True)
        if value:
            self.begin_story(FACTS["stories"][int(value)])

    def follow(self) -> None:
        """Play what the address names: #finding=E-52, one of its runs, #finding=E-52&run=NAME, or a play."""
        try:
            hash = window.decodeURIComponent(window.location.hash[1:])
        except Exception as error:  # of JavaScript: the text is no encoded one
            self.say(f"The address cannot be read: {error}")
            return
        wanted = {name: value for name, _, value in [part.partition("=") for part in hash.split("&")]}
        if "play" in wanted:
            self.leave()
            self.begin_play(wanted)
        if "finding" not in wanted:
            return
        self.leave()
        for name, about in FACTS["documents"].items():
            for finding in about["findings"]:
                if finding["id"] == wanted["finding"]:
                    self.begin_finding(name, finding, wanted.get("run", ""))
                    return
        self.say(f"There is no finding {wanted['finding']!r} in this page.")

    def again(self, link: Any) -> None:
        """A link to what the address names already: it is played once more."""
        if link.tagName == "A" and link.hash == window.location.hash:
            self.follow()

    def begin_finding(self, name: str, finding: dict[str, Any], wanted: str) -> None:
        """Play a run of a finding, the first where none is named; say why where there is none."""
        runs = [id for id in finding["runs"] if wanted in ("", id)]
        if not runs:
            self.show_part("findings")
            why = finding["why"] or f"{wanted} is no run of it that can be played."
            self.say(f"{finding['id']}: {finding['title']}. {why}")
            return
        run = next(run for run in FACTS["documents"][name]["recorded"] if run["run"] == runs[0])
        self.begin_recorded(name, run, finding)
        document["next"].focus()

    def begin_story(self, story: dict[str, Any]) -> None:
        """Power up what the story needs and tell its beginning."""
        of = story["of"]
        cells = story.get("cell", [{"title": "", "params": {}}])
        if of in FACTS["scenes"]:
            self.show_part(f"scene-{of}")
            self.open_cells(of, cells)
        else:
            self.show_part("blocks")
            view = self.views[of][0]
            view.scene.params = cells[0]["params"]
            view.scene.reset()
            self.after(of)
            view.root.scrollIntoView()
        self.told = of
        self.begin(of_story(story, lambda text: self.act(of, text)))

    def begin_recorded(self, name: str, run: dict[str, Any], finding: dict[str, Any]) -> None:
        """Show the recorded rows one by one, in the drawing of the document or on the block's card."""
        if name in FACTS["scenes"]:
            self.show_part(f"scene-{name}")
            self.open_cells(name, [{"title": "", "params": {}}])
            root, told = document[f"scene-{name}"], name
        else:
            self.show_part("blocks")
            told = next(iter(FACTS["documents"][name]["devices"]))
            root = self.views[told][0].root
            root.scrollIntoView()
        _allow(root, False)
        view = self.views[told][0]

        def draw(rows: list[dict[str, Any]]) -> None:
            if name in FACTS["scenes"]:
                view.draw(self.code[name].recorded(view.facts, rows))
            else:
                view.draw(recorded(view.facts["devices"][told], told, rows))

        self.told = told
        self.begin(of_recorded(run, JSON.parse(run["rows"]), finding, draw))

    def begin(self, player: Player) -> None:
        """A player takes over the box of the tour."""
        self.player = player
        document["told"].text = player.intro
        for id in ("next", "run", "leave"):
            document[id].disabled = False
        self.draw_place()

    def draw_place(self) -> None:
        """How far what is told has come."""
        player = self.player
        document["bar"].hidden = player is None
        if player is not None:
            document["bar"].max, document["bar"].value = len(player.steps), player.at

    def next(self) -> None:
        """The next step of what is told; at its end nothing more."""
        player = self.player
        if player is None:
            return
        document["told"].text = player.next()
        self.draw_place()
        if player.ended:
            document["next"].disabled = document["run"].disabled = True
            self.pause()

    def leave(self, keep: bool = False) -> None:
        """Free play again, with everything powered up anew."""
        self.pause()
        if self.player is not None and self.told in FACTS["scenes"]:
            self.open_free(self.told)
        elif self.player is not None and self.told is not None:
            self.anew(self.told)
            _allow(self.views[self.told][0].root, True)
            self.after(self.told)
        self.player = self.told = None
        self.draw_place()
        document["told"].text = ""
        for id in ("next", "run", "leave"):
            document[id].disabled = True
        if not keep:
            document["choose"].value = ""

    # ------------------------------------------------------------------------------------ logs

    def read_log(self, field: Any) -> None:
        """Play a log where its device is drawn."""
        for file in list(field.files)[:1]:
            window.readLines(file, self.begin_log, lambda why: self.say(f"The log cannot be read: {why}"))

    def begin_log(self, lines: Any) -> None:
        """Power up with the log's parameters; each step is one line."""
        self.leave()
        try:
            rows = as_log([JSON.parse(line) for line in lines], FACTS["documents"], self.code)
            self.open_blocks()
            name = self.owner_of(rows[0])
            view = self.views[name][0]
            view.scene.begin_log(rows[0])
        except Exception as error:  # as above
            self.say(f"The log cannot be played: {error}")
            return
        self.show_part(f"scene-{name}" if name in FACTS["scenes"] else "blocks")
        self.told = name

        def play(row: dict[str, Any]) -> str:
            view.scene.play(row)
            self.after(name)
            return str(view.scene.differs)

        self.after(name)
        self.begin(of_log(rows[1:], play))

    def owner_of(self, header: dict[str, Any]) -> str:
        """The part that plays a log. Raises ValueError where none does."""
        target = header["target"]
        if target in self.views:
            return str(target)
        for name in FACTS["scenes"]:
            self.code[name].Scene.params_of(header)
            return str(name)
        raise ValueError(f"nothing here is {target!r}")

    def say(self, text: str) -> None:
        """Tell something in the box of the tour."""
        document["told"].text = text


def _allow(root: Any, free: bool) -> None:
    """Whether the user may act in a part; what the panel has open is for the view to say."""
    for button in root.select("[data-do], [data-go]"):
        if not button.attrs.get("data-open"):
            button.disabled = not free


PAGE = Page()
window.modeproofReady = window.performance.now()
document["loading"].hidden = True
document["app"].hidden = False
PAGE.follow()
