"""Terms of the field, from docs/report.toml; where a part uses one first, the word leads to its meaning."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass

from markupsafe import Markup, escape

from modeproof.report.sources import HOLE, Sources, Trouble

REGISTER = "docs/report.toml"
PART = "glossary"
_TAG = re.compile(r"(<[^>]*>)")
_NAME = re.compile(r"</?([a-zA-Z0-9]+)")
_APART = frozenset(
    (
        "a",
        "button",
        "caption",
        "code",
        "h2",
        "h3",
        "h4",
        "label",
        "option",
        "pre",
        "script",
        "select",
        "style",
        "summary",
        "svg",
        "textarea",
        "th",
    )
)
"""Elements whose text is left as it is: links within links, headings, names, drawings."""
FIGURE = 'class="figure"'
"""What is in the tag of a figure: it is a button by itself, and no link can be in it."""


@dataclass(frozen=True)
class Term:
    """One word of the field: what it means here, other forms of it, and where it is from."""

    word: str
    says: str
    forms: tuple[str, ...] = ()
    clauses: tuple[str, ...] = ()

    @property
    def anchor(self) -> str:
        """The id of its row."""
        return "term-" + re.sub(r"[^a-z0-9]+", "-", self.word.lower()).strip("-")


def terms_of(sources: Sources) -> tuple[tuple[Term, ...], tuple[Trouble, ...]]:
    """The register in the order of the words; none, with a trouble, where it is not there or damaged."""
    content = sources.content(REGISTER)
    if content is None:
        return (), (Trouble(HOLE, PART, f"{REGISTER} is not there: no word of the field is explained"),)
    try:
        rows = tomllib.loads(content.decode("utf-8"))["term"]
        terms = [
            Term(
                str(row["word"]), str(row["says"]), tuple(row.get("forms", ())), tuple(row.get("clauses", ()))
            )
            for row in rows
        ]
    except (ValueError, KeyError, TypeError) as error:
        return (), (Trouble(HOLE, PART, f"{REGISTER} cannot be read: {error}"),)
    return tuple(sorted(terms, key=lambda one: one.word.lower())), ()


def _key(word: str) -> str:
    """Words in capitals are those of verdicts, and no others; all others are the same in any case."""
    return word if word.isupper() else word.lower()


class Terms:
    """Links the first use of each term in a part."""

    def __init__(self, sources: Sources) -> None:
        self._terms = {_key(form): one for one in terms_of(sources)[0] for form in (one.word, *one.forms)}
        longest_first = sorted(map(re.escape, self._terms), key=len, reverse=True)
        self._form = re.compile(rf"(?<![\w.-])(?:{'|'.join(longest_first)})(?![\w-]|\.\w)", re.IGNORECASE)
        self._signals = {
            signal.name: signal.why
            for document in sources.documents.values()
            for device in document.interface.devices.values()
            for group in (device.inputs, device.outputs, device.memory, device.parameters)
            for signal in group.values()
        }

    def explained(self, html: str) -> Markup:
        """Every term and signal that a text uses, and those that their meanings use, with what each means."""
        found: dict[str, str] = {}
        texts = [" ".join(_TAG.split(html)[::2])]
        while texts:
            text = texts.pop()
            known = [(term.word, term.says) for word in self._form.findall(text) if (term := self._of(word))]
            known += [
                (name, self._signals[name])
                for name in re.findall(r"\b[A-Z]\w+", text)
                if name in self._signals
            ]
            for word, says in known:
                if word not in found:
                    found[word] = says
                    texts.append(says)
        rows = "; ".join(
            f"<dfn>{escape(word)}</dfn> {escape(says.rstrip('.'))}"
            for word, says in sorted(found.items(), key=lambda entry: entry[0].lower())
        )
        return Markup(f'<p class="words"><b>Words.</b> {rows}.</p>' if rows else "")

    def _of(self, word: str) -> Term | None:
        return self._terms.get(_key(word)) if self._terms else None

    def linked(self, part: str, html: str) -> str:
        """The HTML of a part, as a template made it: tags stay as they are, and all text but terms."""
        if not self._terms or part == PART:
            return html
        used: set[str] = set()
        depth = 0

        def link(found: re.Match[str]) -> str:
            term = self._terms.get(_key(found.group()))
            if term is None or term.word in used:
                return found.group()
            used.add(term.word)
            return f'<a class="term" href="#{term.anchor}">{found.group()}</a>'

        pieces = _TAG.split(html)
        for place, piece in enumerate(pieces):
            if place % 2:
                name = _NAME.match(piece)
                if name and name.group(1).lower() in _APART and not piece.endswith("/>"):
                    depth += -1 if piece.startswith("</") else 1
            elif not depth and piece.strip() and FIGURE not in pieces[place - 1]:
                pieces[place] = self._form.sub(link, piece)
        return "".join(pieces)
