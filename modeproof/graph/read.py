"""Reads the graph that an OPEN_ model printed: lines INPUT, INIT, STATE and EDGE, each one TLA+ tuple.

    <<"INPUT", 17, [LA |-> TRUE, W1 |-> 4080, dt |-> 1]>>       one letter of the input alphabet
    <<"INIT", <<"Start", {}, 0>>>>                                the view of the power-up state
    <<"STATE", <<"Start", {}, 0>>, [W2 |-> 0]>>                 a view and its row of outputs
    <<"EDGE", <<..view..>>, "StepName", 17, <<..view..>>>>        one transition

TLC prints them as strings; both that form, with quotes and escapes, and the unquoted one are read.
Views are names and no more. A line of another form, a cut last line, an edge to a view without STATE line, a
pair of state and input without edge or with two, and counts other than those of TLC are refused: a graph that
is not complete is never used. TLC's own framed messages (-tool) may be between the lines; then their
counts are compared too.
"""

from __future__ import annotations

import re
from array import array
from pathlib import Path
from typing import Any

from modeproof.graph.graph import Graph
from modeproof.ground.errors import Unjudged
from modeproof.tlc.tla_values import TlaError, canonical, parse, unquote

_EDGE = re.compile(rb'<<"EDGE", (<<.*>>), "(\w+)", (-?\d+), (<<.*>>)>>\r?\n')
_QUOTED_EDGE = re.compile(rb'"<<\\"EDGE\\", (<<.*>>), \\"(\w+)\\", (-?\d+), (<<.*>>)>>"\r?\n')
_EDGE_STARTS = (b'<<"EDGE", ', b'"<<\\"EDGE\\", ')
_START = re.compile(rb"@!@!@STARTMSG (\d+)(?::\d+)? @!@!@\s*")
_END = re.compile(rb"@!@!@ENDMSG \d+ @!@!@\s*")
_CHATTER = (b"Parsing file ", b"Semantic processing of module ", b"Linting of module ")
_INITIAL = re.compile(r"Finished computing initial states: (\d[\d,]*)")
_GENERATED = re.compile(r"(\d[\d,]*) states generated")
_LONGEST = 1 << 20


def read_graph(path: Path, *, states: int | None = None, edges: int | None = None) -> Graph:
    """Read and check a printed graph.

    `states` and `edges` are the pinned counts, None where there is no pin. Raises Unjudged, naming file and
    line, for everything that is listed at the top.
    """
    try:
        size = path.stat().st_size
        with path.open("rb") as stream:
            found = _Reader(path.name)
            found.read(stream)
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None
    if size == 0:
        raise Unjudged(f"{path.name}: the file is empty")
    return found.graph(states, edges)


class _Reader:
    def __init__(self, name: str) -> None:
        self.name = name
        self.line = 0
        self.inputs: dict[int, dict[str, Any]] = {}
        self.initial: set[int] = set()
        self.rows: dict[int, dict[str, Any]] = {}
        self.views: dict[str, int] = {}
        self.spelled: dict[bytes, int] = {}
        self.first_line: list[int] = []
        self.steps: dict[bytes, int] = {}
        self.pre, self.step, self.by, self.post = array("l"), array("l"), array("l"), array("l")
        self.messages: dict[int, str] = {}
        self.framed = False

    def refuse(self, cause: str, line: int | None = None) -> Unjudged:
        return Unjudged(f"{self.name}: line {line or self.line}: {cause}")

    def read(self, stream: Any) -> None:
        match_edge = _EDGE.fullmatch
        match_quoted = _QUOTED_EDGE.fullmatch
        spelled = self.spelled.get
        steps = self.steps.get
        add_pre, add_step = self.pre.append, self.step.append
        add_by, add_post = self.by.append, self.post.append
        for line in stream:
            self.line += 1
            edge = match_edge(line) or match_quoted(line)
            if edge is None:
                self._other(line, stream)
                continue
            before, name, number, after = edge.groups()
            pre, post, step = spelled(before), spelled(after), steps(name)
            if pre is None:
                pre = self._view_of(before, line)
            if post is None:
                post = self._view_of(after, line)
            if step is None:
                step = self.steps.setdefault(name, len(self.steps))
            add_pre(pre)
            add_step(step)
            add_by(int(number))
            add_post(post)

    def _view_of(self, spelling: bytes, line: bytes) -> int:
        try:
            text = spelling.decode("utf-8")
            if line.startswith(b'"'):
                text = unquote(text)
            value = parse(text)
        except (TlaError, UnicodeDecodeError) as error:
            raise self.refuse(f"a view cannot be read: {error}") from None
        return self._view(value, spelling)

    def _view(self, value: Any, spelling: bytes | None = None) -> int:
        name = canonical(value)
        index = self.views.setdefault(name, len(self.views))
        if index == len(self.first_line):
            self.first_line.append(self.line)
        if spelling is not None:
            self.spelled[spelling] = index
        return index

    def _other(self, line: bytes, stream: Any) -> None:
        if not line.endswith(b"\n"):
            raise self.refuse("the last line is cut off")
        if len(line) > _LONGEST:
            raise self.refuse(f"longer than {_LONGEST} bytes")
        start = _START.fullmatch(line)
        if start:
            self._message(int(start.group(1)), stream)
            return
        if line.startswith(_CHATTER) or not line.strip():
            return
        shown = line.strip().decode("utf-8", "replace")[:80]
        bare = line.rstrip()
        quoted = bare.startswith(b'"<<') and bare.endswith(b'>>"')
        if not quoted and not (bare.startswith(b"<<") and bare.endswith(b">>")):
            raise self.refuse(f"not one whole printed tuple (was it wrapped?): {shown}")
        try:
            text = bare.decode("utf-8")
            row = parse(unquote(text[1:-1]) if quoted else text)
        except (TlaError, UnicodeDecodeError) as error:
            raise self.refuse(f"cannot be read: {error}: {shown}") from None
        self._row(row, shown)

    def _message(self, code: int, stream: Any) -> None:
        self.framed = True
        text: list[bytes] = []
        for line in stream:
            self.line += 1
            if _END.fullmatch(line):
                self.messages[code] = b"".join(text).decode("utf-8", "replace")
                return
            if line.startswith(_EDGE_STARTS):
                raise self.refuse("an edge inside a message of TLC")
            text.append(line)
        raise self.refuse("TLC's last message is cut off")

    def _row(self, row: Any, shown: str) -> None:
        tag = row[0] if isinstance(row, tuple) and row else None
        if tag == "INPUT" and len(row) == 3 and type(row[1]) is int and isinstance(row[2], dict):
            if canonical(self.inputs.setdefault(row[1], row[2])) != canonical(row[2]):
                raise self.refuse(f"input {row[1]} is declared twice, differently")
        elif tag == "INIT" and len(row) == 2 and isinstance(row[1], tuple):
            self.initial.add(self._view(row[1]))
        elif tag == "STATE" and len(row) == 3 and isinstance(row[1], tuple) and isinstance(row[2], dict):
            index = self._view(row[1])
            if canonical(self.rows.setdefault(index, row[2])) != canonical(row[2]):
                raise self.refuse("two different rows of outputs for one view (does the view hide memory?)")
        elif tag == "EDGE" and len(row) == 5:
            if not (isinstance(row[1], tuple) and isinstance(row[2], str) and isinstance(row[4], tuple)):
                raise self.refuse(f"not an EDGE line: {shown}")
            if type(row[3]) is not int:
                raise self.refuse(f"not an EDGE line: {shown}")
            self.pre.append(self._view(row[1]))
            self.step.append(self.steps.setdefault(row[2].encode(), len(self.steps)))
            self.by.append(row[3])
            self.post.append(self._view(row[4]))
        else:
            raise self.refuse(f"neither INPUT, INIT, STATE nor EDGE: {shown}")

    # -------------------------------------------------------------------------------------------- checks

    def graph(self, states: int | None, edges: int | None) -> Graph:
        names = tuple(self.views)
        if not self.inputs:
            raise Unjudged(f"{self.name}: no INPUT line")
        if len(self.initial) != 1:
            raise Unjudged(f"{self.name}: {len(self.initial)} INIT views; a device has one power-up state")
        for index, view in enumerate(names):
            if index not in self.rows:
                raise self.refuse(f"view without STATE line: {view}", self.first_line[index])
        numbers = sorted(self.inputs)
        step_of, next_of = self._table(names, numbers)
        self._counts(len(names), states, edges)
        graph = Graph(
            source=self.name,
            views=names,
            outputs=tuple(self.rows[index] for index in range(len(names))),
            inputs=tuple(self.inputs[number] for number in numbers),
            input_numbers=tuple(numbers),
            steps=tuple(name.decode() for name in self.steps),
            step_of=step_of,
            next_of=next_of,
            initial=next(iter(self.initial)),
        )
        self._fields(graph)
        for index, before in enumerate(graph.shortest_paths()):
            if before is None and index != graph.initial:
                raise Unjudged(f"{self.name}: view that power-up never reaches: {names[index]}")
        return graph

    def _table(
        self, names: tuple[str, ...], numbers: list[int]
    ) -> tuple[tuple[array[int], ...], tuple[array[int], ...]]:
        place = {number: index for index, number in enumerate(numbers)}
        width = len(numbers)
        step_of = tuple(array("l", [-1]) * width for _ in names)
        next_of = tuple(array("l", [-1]) * width for _ in names)
        for pre, step, number, post in zip(self.pre, self.step, self.by, self.post, strict=True):
            n = place.get(number)
            if n is None:
                raise Unjudged(f"{self.name}: an edge names input {number}, which no INPUT line declares")
            row = next_of[pre]
            if row[n] != -1:
                raise Unjudged(f"{self.name}: two edges for input {number} at {names[pre]}")
            row[n] = post
            step_of[pre][n] = step
        missing = width * len(names) - len(self.pre)
        if missing:
            for index, row in enumerate(next_of):
                if -1 in row:
                    where = f"input {numbers[row.index(-1)]} at {names[index]}"
                    raise Unjudged(f"{self.name}: {missing:,} edges are missing; the first: {where}")
        return step_of, next_of

    def _counts(self, states: int, pinned_states: int | None, pinned_edges: int | None) -> None:
        printed = len(self.pre)
        if pinned_states is not None and pinned_states != states:
            raise Unjudged(f"{self.name}: {states:,} states printed, {pinned_states:,} pinned")
        if pinned_edges is not None and pinned_edges != printed:
            raise Unjudged(f"{self.name}: {printed:,} edges printed, {pinned_edges:,} pinned")
        if not self.framed:
            return
        if 2186 not in self.messages:
            raise Unjudged(f"{self.name}: TLC did not finish")
        generated = _GENERATED.search(self.messages.get(2199, ""))
        initial = _INITIAL.search(self.messages.get(2190, ""))
        if generated is None or initial is None:
            raise Unjudged(f"{self.name}: TLC's counts are missing")
        made = int(generated.group(1).replace(",", "")) - int(initial.group(1).replace(",", ""))
        if made != printed:
            raise Unjudged(f"{self.name}: {printed:,} edges printed, TLC generated {made:,}")

    def _fields(self, graph: Graph) -> None:
        for kind, rows in (("INPUT", graph.inputs), ("STATE", graph.outputs)):
            if len({tuple(sorted(row)) for row in rows}) != 1:
                raise Unjudged(f"{self.name}: {kind} lines with different fields")
        letters = [canonical(dict(row)) for row in graph.inputs]
        if len(set(letters)) != len(letters):
            again = next(n for n, letter in enumerate(letters) if letter in letters[:n])
            raise Unjudged(f"{self.name}: input {graph.input_numbers[again]} repeats an earlier one")
