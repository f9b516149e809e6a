"""Draws what a scene shows into elements that say by their data attributes what they hold."""

from __future__ import annotations

from typing import Any

from browser import document


class View:
    """A part of the page and the scene that it draws; only what changed is touched."""

    def __init__(self, root: Any, scene: Any, facts: dict[str, Any]) -> None:
        self.root, self.scene, self.facts = root, scene, facts
        self.texts = _by(root, "data-text")
        self.lit = _by(root, "data-on")
        self.opened = _by(root, "data-open")
        self.hidden = _by(root, "data-shown")
        self.wires = _by(root, "data-wire")
        self.devices = _by(root, "data-device")
        self.whys = root.select("[data-why]")
        self.shown: dict[str, Any] = {"text": {}, "on": {}, "open": {}, "devices": {}, "misread": []}
        self.drawn: dict[tuple[str, str], Any] = {}
        self.changed: list[Any] = list(root.select(".changed"))

    def lay_out(self, code: Any) -> None:
        """Put the fields of the panel where the layout of the implementation has them."""
        for name, (x, y, width, height) in code.places().items():
            field = self.root.select_one(f'[data-open="{name}"]')
            field.style.left, field.style.top = f"{x}%", f"{y}%"
            field.style.width, field.style.height = f"{width}%", f"{height}%"
        for field in self.root.select("[data-mode]"):
            field.text = code.MODE_NAMES[int(field.attrs["data-mode"])]

    def refresh(self) -> str:
        """Draw the scene; what is new for one who listens."""
        return self.draw(self.scene.show())

    def draw(self, shown: dict[str, Any]) -> str:
        """Draw what is given."""
        self.shown = shown
        for node in self.changed:
            node.classList.remove("changed")
        self.changed = []
        news = []
        for kind, nodes in (("text", self.texts), ("on", self.lit), ("open", self.opened)):
            for name, value in shown[kind].items():
                if name in nodes and self.drawn.get((kind, name)) != value:
                    first = (kind, name) not in self.drawn
                    self.drawn[(kind, name)] = value
                    for node in nodes[name]:
                        self._put(kind, node, value)
                    if not first:
                        self._mark(name)
                        if name in ("active", "screen", "echo", "says") and value:
                            news.append(f"{name}: {value}")
        for name, hidden in self.hidden.items():
            for node in hidden:
                node.style.display = "" if shown["on"].get(name) else "none"
        misread = shown.get("misread", [])
        for name, wires in self.wires.items():
            for node in wires:
                _class(node, "misread", name in misread)
        for name, of in shown["devices"].items():
            for node in self.devices.get(name, []):
                self._device(node, name, of)
        for node in self.whys:
            of = shown.get("why", {}).get(node.attrs["data-why"], {"kind": ""})
            if self._why(node, of) and of["say"]:
                news.append(f"{of['head']}: {of['say'][0]}")
        return ". ".join(news)

    def _why(self, node: Any, of: dict[str, Any]) -> bool:
        """Say why a device refuses and how to get out; whether the reason is new."""
        before = self.drawn.get(("why", ""), {})
        if before == of:
            return False
        self.drawn[("why", "")] = of
        node.clear()
        node.hidden = not of["kind"]
        node.class_name = f"why {of['kind']}"
        if not of["kind"]:
            return False
        for head, said in ((of["head"], of["say"]), ("What to do", of["way"])):
            if said:
                line(node, "p", f"{head}: ", said[0])
                listed = document.createElement("ul")
                for id in said[1]:
                    line(listed, "li", f"{id} ", self.facts["texts"].get(id, ""))
                node.appendChild(listed)
        if of["waits"]:
            line(node, "p", "", of["waits"])
        return bool(before.get("say") != of["say"] or before.get("kind") != of["kind"])

    def _put(self, kind: str, node: Any, value: Any) -> None:
        if kind == "text":
            node.textContent = value
        elif kind == "open":
            node.disabled = not value
        else:
            _class(node, "on", bool(value))
            if node.attrs.get("role") == "switch":
                node.attrs["aria-checked"] = "true" if value else "false"
            elif node.tagName == "P":
                node.select_one("b").text = "on" if value else "off"
            elif node.tagName == "circle":
                node.attrs["fill"] = "#2da44e" if value else "#5c6873"
            elif node.attrs.get("class", "").startswith("key"):
                node.attrs["aria-pressed"] = "true" if value else "false"

    def _mark(self, name: str) -> None:
        for node in self.wires.get(name, []):
            node.classList.add("changed")
            self.changed.append(node)

    def _device(self, node: Any, name: str, of: dict[str, Any]) -> None:
        key = ("device", name)
        if self.drawn.get(key) == of:
            return
        self.drawn[key] = dict(of)
        _class(node, "last", of["last"])
        node.select_one('[data-part-of="state"]').text = of["state"]
        node.select_one('[data-part-of="step"]').text = of["step"]
        listed = node.select_one('[data-part-of="clauses"]')
        listed.innerHTML = ""
        for id in self.facts["devices"][name]["steps"].get(of["step"], []):
            line(listed, "li", f"{id} ", self.facts["texts"].get(id, ""))


def line(parent: Any, kind: str, head: str, text: str) -> None:
    """Add an element with a bold head, if there is one, and a text."""
    made = document.createElement(kind)
    if head:
        strong = document.createElement("b")
        strong.text = head
        made.appendChild(strong)
    made.appendChild(document.createTextNode(text))
    parent.appendChild(made)


def _by(root: Any, attribute: str) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for node in root.select(f"[{attribute}]"):
        found.setdefault(node.attrs[attribute], []).append(node)
    if attribute == "data-text" and root.attrs.get(attribute):
        found.setdefault(root.attrs[attribute], []).append(root)
    return found


def _class(node: Any, name: str, there: bool) -> None:
    if there:
        node.classList.add(name)
    else:
        node.classList.remove(name)
