"""The parse tree of a TLA+ specification, from the XML exporter that comes with TLC's own parser.

Every definition of our own modules (standard modules are left out), with the place and text of every
expression in it. `conjuncts` and `disjuncts` take an action apart as TLC does: a list of bullets and the
infix operator alike.
"""

from __future__ import annotations

import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.tlc.start_up import start_up_options
from modeproof.tlc.toolchain import Toolchain

AND = frozenset({"\\land", "$ConjList"})
OR = frozenset({"\\lor", "$DisjList"})
TIME_LIMIT_S = 120.0
_KINDS = {
    "BuiltInKindRef": "builtin",
    "UserDefinedOpKindRef": "defined",
    "FormalParamNodeRef": "parameter",
    "OpDeclNodeRef": "declared",
}
_CONSTANT, _VARIABLE = "2", "3"
"""Kinds of declarations, as SANY numbers them."""
_Texts = Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, order=True)
class Place:
    """A piece of a module's text: lines and columns from 1, both ends included."""

    module: str
    first_line: int
    first_column: int
    last_line: int
    last_column: int

    def __str__(self) -> str:
        return f"{self.module}.tla:{self.first_line}"


@dataclass(frozen=True)
class Node:
    """One expression.

    `kind`: builtin, defined, parameter, declared (an operator applied to `operands`; `operator` is its name
    as SANY has it, such as `\\land`, `$ConjList`, `=`, `'`, `$IfThenElse`, `Up`), string or number
    (`operator` is the value as text), let (`operands` holds the body, `definitions` its own), or other. A
    `$Case` or a record has `$Pair` nodes for operands; `bound` lists the names and the set of each quantifier
    (None: no set). `level` is 0 constant, 1 state, 2 action, 3 temporal.
    """

    kind: str
    operator: str
    operands: tuple[Node, ...]
    place: Place
    level: int
    bound: tuple[tuple[tuple[str, ...], Node | None], ...] = ()
    definitions: tuple[Definition, ...] = ()

    def walk(self) -> Iterator[Node]:
        """This node and all below it, from left to right, the sets of quantifiers and LETs first."""
        yield self
        for _, domain in self.bound:
            if domain is not None:
                yield from domain.walk()
        for definition in self.definitions:
            yield from definition.body.walk()
        for operand in self.operands:
            yield from operand.walk()


@dataclass(frozen=True)
class Definition:
    """`name(params) == body`, the place of all of it (with LOCAL, if there), and the level of the body.

    `local`: a module that extends this one does not see it.
    """

    name: str
    params: tuple[str, ...]
    body: Node
    place: Place
    level: int
    local: bool = False


@dataclass(frozen=True)
class ParseTree:
    """Our modules behind one root module.

    `files` has the path of each module, `definitions` those of column 1 of each module by name, in the order
    of the text, `assumes` the bodies of ASSUME, `constants` and `variables` the names that each declares.
    """

    root: str
    files: Mapping[str, Path]
    definitions: Mapping[str, Mapping[str, Definition]]
    assumes: Mapping[str, tuple[Node, ...]]
    constants: Mapping[str, tuple[str, ...]]
    variables: Mapping[str, tuple[str, ...]]
    texts: _Texts = field(repr=False, default_factory=dict)

    def find(self, name: str) -> Definition | None:
        """The definition of this name, in whichever module it is; LOCAL ones only when no other has it."""
        found = [table[name] for table in self.definitions.values() if name in table]
        return next((definition for definition in found if not definition.local), found[0] if found else None)

    def text(self, place: Place, joined: bool = True) -> str:
        """The source text at a place; lines are joined and shortened to single blanks unless told not to."""
        lines = self.texts[place.module][place.first_line - 1 : place.last_line]
        last = place.last_column - (place.first_column - 1 if len(lines) == 1 else 0)
        cut = [lines[0][place.first_column - 1 :], *lines[1:]]
        cut[-1] = cut[-1][:last]
        if not joined:
            return "\n".join(cut)
        return " ".join(" ".join(line.split("\\*")[0] for line in cut).split())


def conjuncts(node: Node) -> tuple[Node, ...]:
    """The parts of a conjunction, nested ones taken apart; a node that is none is alone."""
    return _parts(node, AND)


def disjuncts(node: Node) -> tuple[Node, ...]:
    """The parts of a disjunction, nested ones taken apart; a node that is none is alone."""
    return _parts(node, OR)


def _parts(node: Node, operators: frozenset[str]) -> tuple[Node, ...]:
    if node.kind != "builtin" or node.operator not in operators:
        return (node,)
    return tuple(part for operand in node.operands for part in _parts(operand, operators))


def read_tree(folder: Path, module: str, tools: Toolchain, library: Path | None = None) -> ParseTree:
    """Parse `folder`/`module`.tla and all that it extends.

    `library` is another folder in which modules are looked for. Raises Unjudged with SANY's first complaint
    when the text is not right, or when the exporter cannot be run.
    """
    if not (folder / f"{module}.tla").is_file():
        raise Unjudged(f"{folder / module}.tla is missing")
    xml = _export(folder, module, tools, library)
    try:
        root = ElementTree.fromstring(xml)
    except ElementTree.ParseError as error:
        raise Unjudged(f"{module}: the parse tree is no XML: {error}") from None
    files = {}
    for name in {text for element in root.iter("filename") if (text := element.text or "")}:
        for place in (folder, library):
            if place is not None and (path := place / f"{name}.tla").is_file():
                files[name] = path
                break
    return _Reader(root, files).tree()


def _export(folder: Path, module: str, tools: Toolchain, library: Path | None) -> bytes:
    java = [str(tools.java), "-XX:TieredStopAtLevel=1", "-XX:+UseParallelGC", "-Xss16m"]
    java += start_up_options(tools)
    places = [] if library is None else ["-I", str(library)]
    parser = ["-cp", str(tools.jar), "tla2sany.xml.XMLExporter", "-o", *places, f"{module}.tla"]
    try:
        # SANY unpacks its own modules into the folder, and removes them: two at once must not share one
        with tempfile.TemporaryFile() as output, tempfile.TemporaryDirectory() as own:
            done = subprocess.run(
                [*java, f"-Djava.io.tmpdir={own}", *parser],
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.PIPE,
                timeout=TIME_LIMIT_S,
                check=False,
            )
            output.seek(0)
            xml = output.read()
    except subprocess.TimeoutExpired:
        raise Unjudged(f"{module}: no parse tree after {TIME_LIMIT_S:.0f} s") from None
    except OSError as error:
        raise Unjudged(f"{module}: the parser cannot be run: {error.strerror or error}") from None
    if done.returncode != 0 or not xml.strip():
        raise Unjudged(f"{module}: cannot be parsed: {_complaint(done.stderr.decode('utf-8', 'replace'))}")
    return xml


def _complaint(said: str) -> str:
    """The first thing that SANY minds, without its progress and Java's stack."""
    lines = [line.strip() for line in said.splitlines()]
    dull = ("Semantic processing", "Parsing file", "at ", "***", "Semantic errors", "Picked up ")
    kept = [line for line in lines if line and not line.startswith(dull)]
    return " ".join(kept[:3])[:300] or "the parser says nothing"


class _Reader:
    """Turns the exporter's XML into nodes; an entry of its context table is read once, when it is needed."""

    def __init__(self, root: ElementTree.Element, files: Mapping[str, Path]) -> None:
        self._root = root
        self._entries = {_text(entry, "UID"): entry[1] for entry in root.iterfind("context/entry")}
        self._files = files
        self._nowhere = Place("", 0, 0, 0, 0)
        self._texts = {
            name: tuple(path.read_text(encoding="utf-8", errors="replace").splitlines())
            for name, path in files.items()
        }

    def tree(self) -> ParseTree:
        inner = {
            _text(reference, "UID")
            for reference in self._root.iterfind("context//opDefs/UserDefinedOpKindRef")
        }
        definitions: dict[str, list[Definition]] = {name: [] for name in self._files}
        assumes: dict[str, list[Node]] = {name: [] for name in self._files}
        declared: dict[str, dict[str, list[tuple[Place, str]]]] = {
            kind: {name: [] for name in self._files} for kind in (_CONSTANT, _VARIABLE)
        }
        for uid, entry in self._entries.items():
            place = self._place(entry)
            if place.module not in self._files:
                continue
            if entry.tag == "UserDefinedOpKind" and uid not in inner:
                definition = self._definition(entry)
                if (
                    definition is not None and "!" not in definition.name
                ):  # not the copies that INSTANCE makes
                    definitions[place.module].append(definition)
            elif entry.tag == "AssumeNode":
                assumes[place.module] += [self._node(body[0]) for body in entry.iterfind("body") if len(body)]
            elif entry.tag == "OpDeclNode" and (kind := _text(entry, "kind")) in declared:
                declared[kind][place.module].append((place, _text(entry, "uniquename")))
        names = {
            kind: {module: tuple(name for _, name in sorted(found)) for module, found in table.items()}
            for kind, table in declared.items()
        }
        return ParseTree(
            root=_text(self._root, "RootModule"),
            files=dict(sorted(self._files.items())),
            definitions={
                module: {
                    definition.name: definition
                    for definition in sorted(found, key=lambda definition: definition.place)
                }
                for module, found in definitions.items()
            },
            assumes={
                name: tuple(sorted(found, key=lambda assumed: assumed.place))
                for name, found in assumes.items()
            },
            constants=names[_CONSTANT],
            variables=names[_VARIABLE],
            texts=self._texts,
        )

    def _definition(self, entry: ElementTree.Element) -> Definition | None:
        body = entry.find("body")
        if body is None or not len(body):
            return None
        names = [
            self._name(parameter) for parameter in entry.iterfind("params/leibnizparam/FormalParamNodeRef")
        ]
        place = self._place(entry)
        line = self._texts[place.module][place.first_line - 1] if place.module in self._texts else ""
        return Definition(
            name=_text(entry, "uniquename"),
            params=tuple(names),
            body=self._node(body[0]),
            place=place,
            level=int(_text(entry, "level") or 0),
            local=line[place.first_column - 1 :].startswith("LOCAL"),
        )

    def _node(self, element: ElementTree.Element) -> Node:
        tag = element.tag
        place = self._place(element)
        level = int(_text(element, "level") or 0)
        if tag == "OpApplNode":
            reference = element.find("operator")
            assert reference is not None
            target = reference[0]
            operands = element.find("operands")
            bound = [
                (
                    tuple(self._name(child) for child in part if child.tag == "FormalParamNodeRef"),
                    next((self._node(child) for child in part if _is_expression(child)), None),
                )
                for part in element.iterfind("boundSymbols/*")
            ]
            return Node(
                kind=_KINDS.get(target.tag, "other"),
                operator=self._name(target),
                operands=tuple(self._node(operand) for operand in (() if operands is None else operands)),
                place=place,
                level=level,
                bound=tuple(bound),
            )
        if tag == "StringNode":
            return Node("string", _text(element, "StringValue"), (), place, level)
        if tag in ("NumeralNode", "DecimalNode"):
            return Node("number", _text(element, "IntValue"), (), place, level)
        body = element.find("body")
        inner = () if body is None or not len(body) else (self._node(body[0]),)
        if tag == "LetInNode":
            own = [
                definition
                for reference in element.iterfind("opDefs/UserDefinedOpKindRef")
                if (definition := self._definition(self._entries[_text(reference, "UID")])) is not None
            ]
            return Node("let", "LET", inner, place, level, definitions=tuple(own))
        return Node("other", tag, inner, place, level)

    def _name(self, reference: ElementTree.Element) -> str:
        entry = self._entries.get(_text(reference, "UID"))
        return "" if entry is None else _text(entry, "uniquename")

    def _place(self, element: ElementTree.Element) -> Place:
        location = element.find("location")
        if location is None:
            return self._nowhere
        line, column = location.find("line"), location.find("column")
        assert line is not None and column is not None
        return Place(
            _text(location, "filename"),
            int(_text(line, "begin")),
            int(_text(column, "begin")),
            int(_text(line, "end")),
            int(_text(column, "end")),
        )


def _is_expression(element: ElementTree.Element) -> bool:
    return element.tag.endswith("Node")


def _text(element: ElementTree.Element, name: str) -> str:
    return (element.findtext(name) or "").strip()
