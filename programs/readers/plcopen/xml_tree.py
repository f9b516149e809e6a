"""XML as a tree that knows its lines. No document type, no entities, nothing is fetched."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from programs.language.tree import Place

DEEPEST = 200
"""Elements within elements."""


@dataclass
class Element:
    """An element: its name without namespace, its attributes, and the text directly within it."""

    name: str
    space: str
    attributes: dict[str, str]
    place: Place
    children: list[Element] = field(default_factory=list)
    text: str = ""
    text_line: int = 0
    """The line in which the text begins; 0: there is none."""

    def child(self, name: str) -> Element | None:
        """The first child of this name."""
        return next((child for child in self.children if child.name == name), None)

    def all(self, name: str) -> Iterator[Element]:
        """The children of this name."""
        return (child for child in self.children if child.name == name)

    def below(self, name: str) -> Iterator[Element]:
        """All elements of this name within it, at any depth, in their order."""
        for child in self.children:
            if child.name == name:
                yield child
            yield from child.below(name)

    def get(self, name: str) -> str:
        """An attribute. Raises Unjudged if it is not there."""
        if name not in self.attributes:
            raise self.place.refuse(f"<{self.name}> has no {name}")
        return self.attributes[name]


def read_xml(text: bytes, file: str) -> Element:
    """The root of a document. Raises Unjudged with the line: not well-formed, a document type, too deep."""
    parser = expat.ParserCreate(namespace_separator=" ")
    open_elements: list[Element] = []
    roots: list[Element] = []

    def here() -> Place:
        return Place(file, parser.CurrentLineNumber)

    def start(name: str, attributes: dict[str, str]) -> None:
        space, _, plain = name.rpartition(" ")
        made = Element(plain, space, attributes, here())
        (open_elements[-1].children if open_elements else roots).append(made)
        open_elements.append(made)
        if len(open_elements) > DEEPEST:
            raise here().refuse(f"more than {DEEPEST} elements within each other")

    def end(_: str) -> None:
        open_elements.pop()

    def data(text: str) -> None:
        if not open_elements[-1].text_line:
            open_elements[-1].text_line = parser.CurrentLineNumber
        open_elements[-1].text += text

    def document_type(*_: object) -> None:
        raise here().refuse("a document type or entities are not read; remove <!DOCTYPE ...>")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = data, document_type
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise Place(file, error.lineno).refuse(
            f"not well-formed XML: {expat.ErrorString(error.code)}"
        ) from None
    except (LookupError, ValueError) as error:
        raise Place(file, 1).refuse(f"the encoding of the XML: {error}") from None
    return roots[0]
