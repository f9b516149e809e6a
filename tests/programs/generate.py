"""Random programs of the subset, well typed, as text."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

INTEGERS = ("SINT", "USINT", "INT", "UINT", "DINT")
BITS = {"BYTE": 8, "WORD": 16, "DWORD": 32}
LOW = {"SINT": -128, "USINT": 0, "INT": -32768, "UINT": 0, "DINT": -(2**31)}
HIGH = {"SINT": 127, "USINT": 255, "INT": 32767, "UINT": 65535, "DINT": 2**31 - 1}
DEEPEST = 3
TYPES = """TYPE Pair : STRUCT n : INT := 2; on, off : BOOL; l : ARRAY [1..2, 0..1] OF INT; END_STRUCT;
END_TYPE
TYPE Colour : (Red, Green, Blue); Level : (Low := 10, Mid := 5, High) := Mid; END_TYPE
TYPE Few : INT (-3..9) := 1; Count : DINT := 4; END_TYPE
"""
SPLIT = """FUNCTION Split
VAR_INPUT of : INT; up : BOOL; END_VAR VAR_OUTPUT odd : BOOL; END_VAR VAR_IN_OUT sum : INT; END_VAR
odd := of MOD 2 <> 0;
FOR sum := 1 TO 3 DO IF up THEN RETURN; END_IF END_FOR
sum := of / 2;
END_FUNCTION
FUNCTION Half : INT
VAR_INPUT of : INT; END_VAR VAR_OUTPUT odd : BOOL; END_VAR
Half := of / 2; odd := of MOD 2 <> 0;
END_FUNCTION
"""


@dataclass
class Generator:
    """Writes one program from a seed."""

    values: random.Random
    writable: dict[str, list[str]] = field(default_factory=dict)
    readable: dict[str, list[str]] = field(default_factory=dict)
    loops: int = 0

    def text(self) -> str:
        """A function block P, and a block Below that it may have instances of."""
        return f"{TYPES}{SPLIT}{self._below()}\n{self._main()}"

    def _main(self) -> str:
        self.readable = {kind: [] for kind in (*INTEGERS, *BITS, "BOOL", "TIME", "Colour")}
        self.writable = {kind: [] for kind in self.readable}
        lines = ["FUNCTION_BLOCK P"]
        lines += self._section("VAR_INPUT", "i", 6, False)
        lines += self._section("VAR_OUTPUT", "o", 6, True)
        lines += self._section("VAR", "v", 6, True)
        lines += self._section("VAR_TEMP", "t", 2, True)
        lines.append("VAR CONSTANT six : INT := 6; no : BOOL := FALSE; two : INT := six / 3; END_VAR")
        lines.append("VAR few : Few; some : Count; level : Level; word : WORD; octet : BYTE; END_VAR")
        lines.append("VAR words : ARRAY [two - 1..two] OF WORD; up : CTU; down : CTD; both : CTUD; END_VAR")
        lines.append("VAR pair : Pair; pairs : ARRAY [0..2] OF Pair; times : ARRAY [0..1] OF TON; END_VAR")
        self.readable["INT"] += ["pair.n", "pairs[1].n", "pair.l[1, 0]"]
        self.readable["BOOL"] += ["pair.on", "times[1].Q"]
        self.writable["INT"] += ["pair.n", "pairs[1].l[2][1]"]
        self.writable["BOOL"] += ["pairs[2].on"]
        lines.append("VAR list : ARRAY [2..4] OF INT := [3(1)]; bits : ARRAY [0..2] OF BOOL; END_VAR")
        lines.append(
            "VAR n1, n2, n3, m : INT; on : TON; off : TOF; pulse : TP; rise : R_TRIG; fall : F_TRIG;"
        )
        lines.append("set : SR; reset : RS; below, other : Below; spare : TIME; END_VAR")
        self.readable["INT"] += ["six", "below.total", "list[3]"]
        self.readable["BOOL"] += ["no", "on.Q", "off.Q", "pulse.Q", "rise.Q", "fall.Q", "set.Q1", "below.q"]
        self.readable["TIME"] += ["on.ET", "off.ET", "pulse.ET"]
        self.readable["INT"] += ["m", "up.CV", "both.CV", "few", "TO_INT(level)"]
        self.readable["BOOL"] += [
            "up.Q",
            "down.Q",
            "both.QU",
            "both.QD",
            "word.5",
            "octet.%X7",
            "words[1].15",
        ]
        self.readable["DINT"] += ["some"]
        self.writable["INT"] += ["list[2]", "few"]
        self.writable["BOOL"] += ["bits[1]", "word.5", "octet.%X7", "words[2].0"]
        self.writable["WORD"] += ["word", "words[1]"]
        lines += self._body(0, self.values.randint(4, 9))
        return "\n".join([*lines, "END_FUNCTION_BLOCK", ""])

    def _below(self) -> str:
        self.readable = {"INT": ["n", "total", "part"], "BOOL": ["up", "q"]}
        self.writable = {"INT": ["total", "part"], "BOOL": ["q"]}
        for kind in (*INTEGERS, *BITS, "TIME", "Colour"):
            self.readable.setdefault(kind, [])
            self.writable.setdefault(kind, [])
        body = [self._assignment(), self._assignment(), "IF up THEN RETURN; END_IF", self._assignment()]
        head = (
            "FUNCTION_BLOCK Below\nVAR_INPUT up : BOOL; n : INT; END_VAR VAR_OUTPUT q : BOOL; total : INT; "
            "END_VAR VAR_TEMP part : INT := 2; END_VAR"
        )
        return "\n".join([head, *body, "END_FUNCTION_BLOCK"])

    def _section(self, word: str, prefix: str, most: int, writable: bool) -> list[str]:
        rows = [word]
        for number in range(self.values.randint(2, most)):
            kind = self.values.choice(list(self.readable))
            name = f"{prefix}{number}"
            self.readable[kind].append(name)
            if writable:
                self.writable[kind].append(name)
            rows.append(f"    {name} : {kind};")
        if word in ("VAR_INPUT", "VAR_OUTPUT"):
            rows.append(f"    {prefix}x : BOOL;")
            self.readable["BOOL"].append(f"{prefix}x")
            if writable:
                self.writable["BOOL"].append(f"{prefix}x")
        return [*rows, "END_VAR"]

    # ------------------------------------------------------------ statements

    def _body(self, depth: int, size: int) -> list[str]:
        return [self._statement(depth) for _ in range(size)]

    def _assignment(self) -> str:
        kinds = [kind for kind, names in self.writable.items() if names]
        kind = self.values.choice(kinds)
        return f"{self.values.choice(self.writable[kind])} := {self.of(kind, 0)};"

    def _statement(self, depth: int) -> str:
        plain = depth >= DEEPEST
        chosen = self.values.choices(
            ("assign", "if", "case", "for", "call", "array", "return", "leave"),
            (
                6,
                0 if plain else 3,
                0 if plain else 1,
                0 if plain else 1,
                3,
                1,
                0 if plain else 0.3,
                2 if self.loops else 0,
            ),
        )[0]
        inner = "\n".join(self._body(depth + 1, self.values.randint(1, 2))) if not plain else ""
        match chosen:
            case "if":
                more = f"ELSIF {self.of('BOOL', 1)} THEN {self._assignment()}" if self._coin() else ""
                last = f"ELSE {self._assignment()}" if self._coin() else ""
                return f"IF {self.of('BOOL', 1)} THEN\n{inner}\n{more} {last} END_IF"
            case "case":
                if self._coin():
                    label = self.values.choice(("Red, Blue", "Green"))
                    return (
                        f"CASE {self.of('Colour', 1)} OF {label}: {inner} ELSE {self._assignment()} END_CASE"
                    )
                low = self.values.randint(-3, 5)
                asked, last = self.of("INT", 1), self._assignment()
                return f"CASE {asked} OF {low}..{low + 4}: {inner} 6, 9: {last} END_CASE"
            case "for":
                self.loops += 1
                name = f"n{min(self.loops, 3)}"
                if self.loops > 3:
                    self.loops -= 1
                    return self._assignment()
                low, high = self.values.choice(((2, 4), (4, 2), (3, 2), (2, 4)))
                by = " BY -1" if low > high and self._coin() else ""
                body = f"list[{name}] := {self.of('INT', 2)};" if by or low < high else self._assignment()
                more = self._statement(depth + 1) if self._coin() else ""
                self.loops -= 1
                body = f"{body} {more}"
                if low < high and self._coin():
                    turn = f"{name} := {name} + 1; {body}" if more else f"{body} {name} := {name} + 1;"
                    if self._coin():
                        return f"{name} := {low}; WHILE {name} < {high} DO {turn} END_WHILE"
                    ends = f"{self.of('BOOL', 1)} OR {name} > {high}"
                    return f"{name} := {low}; REPEAT {turn} UNTIL {ends} END_REPEAT"
                if more and low == 2 and high == 4 and self._coin():
                    high = "two * 2"  # type: ignore[assignment]
                return f"FOR {name} := {low} TO {high}{by} DO {body} END_FOR"
            case "call":
                return self._call()
            case "array":
                return f"IF i_n THEN list[{self.of('INT', 2)}] := 1; END_IF".replace(
                    "i_n", self.of("BOOL", 2)
                )
            case "leave":
                word = self.values.choice(("EXIT", "CONTINUE", "RETURN"))
                return f"IF {self.of('BOOL', 1)} THEN {word}; END_IF"
            case "return":
                return f"IF {self.of('BOOL', 1)} AND {self.of('BOOL', 1)} THEN RETURN; END_IF"
        return self._assignment()

    def _call(self) -> str:
        one, two = self.of("BOOL", 1), self.of("BOOL", 1)
        return self.values.choice(
            (
                "pair := pairs[1];",
                f"pairs[{self.of('INT', 2)}] := pair;",
                f"times[1](IN := {one}, PT := T#10ms);",
                f"IF pair.n >= 0 AND pair.n <= 1 THEN times[pair.n](IN := {two}, PT := T#10ms); END_IF",
                f"on(IN := {one}, PT := {self.of('TIME', 2)});",
                f"off(IN := {one}, PT := T#20ms, Q => {self.values.choice(self.writable['BOOL'])});",
                f"pulse(IN := {one}, PT := T#25ms);",
                "on();",
                f"rise(CLK := {one});",
                f"fall(CLK := {one});",
                f"set(S1 := {one}, R := {two});",
                f"reset(S := {one}, R1 := {two});",
                f"below(up := {one}, n := {self.of('INT', 2)});",
                f"other(n := {self.of('INT', 2)});",
                f"below({one}, {self.of('INT', 2)});",
                f"on({one}, T#10ms);",
                f"on({one}, T#10ms, bits[0], {self.values.choice(self.writable['TIME'] or ['spare'])});",
                f"up(CU := {one}, RESET := {two}, PV := {self.of('INT', 3)});",
                f"down({one}, {two}, {self.of('INT', 2)});",
                f"both(CU := {one}, CD := {two}, LOAD := {self.of('BOOL', 3)}, PV := {self.of('INT', 3)});",
                f"Split(of := {self.of('INT', 2)}, up := {one}, odd => bits[2], sum := m);",
                f"m := Half(of := {self.of('INT', 2)}, odd => bits[0]);",
                f"level := {self.values.choice(('Low', 'Level.Mid', 'Level#High'))};",
            )
        )

    # ------------------------------------------------------------ expressions

    def _coin(self) -> bool:
        return self.values.random() < 0.5

    def of(self, kind: str, depth: int) -> str:
        """An expression of this type."""
        names = self.readable.get(kind, [])
        if names and self.values.random() < (0.4 if depth < 2 else 0.75):
            return self.values.choice(names)
        deeper = depth + 1
        if kind == "BOOL":
            return self._bool(depth)
        if kind in INTEGERS:
            return self._integer(kind, depth)
        if kind in BITS:
            if depth >= 3:
                return f"{kind}#16#{self.values.getrandbits(BITS[kind]):X}"
            one, two = self.of(kind, deeper), self.of(kind, deeper)
            other = self.values.choice(list(BITS))
            return self.values.choice(
                (
                    f"({one} AND {two})",
                    f"({one} OR {two})",
                    f"({one} XOR NOT {two})",
                    f"SHL({one}, {self.values.randint(0, 7)})",
                    f"SHR({one}, 3)",
                    f"ROL({one}, {self.values.randint(0, 40)})",
                    f"ROR({one}, 5)",
                    f"{other}_TO_{kind}({self.of(other, 3)})" if other != kind else one,
                    f"INT_TO_{kind}({self.of('INT', deeper)})",
                    f"BOOL_TO_{kind}({self.of('BOOL', deeper)})",
                )
            )
        if kind == "TIME":
            small = f"T#{self.values.choice((0, 5, 20, 1000))}ms"
            if depth >= 2:
                return small
            return self.values.choice(
                (small, f"({self.of('TIME', deeper)} + {small})", f"MIN({small}, T#20ms)")
            )
        return self.values.choice(("Red", "Green", "Colour#Blue"))

    def _integer(self, kind: str, depth: int) -> str:
        number = self.values.choice((0, 1, 2, 3, 7, 100, HIGH[kind], LOW[kind]))
        literal = f"({kind}#{number})" if number < 0 else f"{kind}#{number}"
        if depth >= 3:
            return literal
        one, two = self.of(kind, depth + 1), self.of(kind, depth + 1)
        return self.values.choice(
            (
                literal,
                f"({one} + {two})",
                f"({one} - {two})",
                f"({one} * {literal})",
                f"({one} / {self.values.choice((two, '3'))})",
                f"({one} MOD {self.values.choice((two, '4'))})",
                f"MAX({one}, {two})",
                f"LIMIT({kind}#1, {one}, {kind}#9)",
                f"SEL({self.of('BOOL', 3)}, {one}, {two})",
                f"ABS({one})",
                f"-{one}" if kind in ("INT", "DINT") else one,
                f"WORD_TO_{kind}({self.of('WORD', 3)})",
                f"BOOL_TO_{kind}({self.of('BOOL', 3)})",
            )
        )

    def _bool(self, depth: int) -> str:
        if depth >= 3:
            return self.values.choice(("TRUE", "FALSE"))
        one, two = self.of("BOOL", depth + 1), self.of("BOOL", depth + 1)
        kind = self.values.choice((*INTEGERS, *BITS, "TIME"))
        sign = self.values.choice(("=", "<>", "<", "<=", ">", ">="))
        return self.values.choice(
            (
                f"({one} AND {two})",
                f"({one} OR {two})",
                f"({one} XOR {two})",
                f"NOT {one}",
                f"({one} AND_THEN {two})",
                f"({one} OR_ELSE {two})",
                f"({self.of(kind, depth + 1)} {sign} {self.of(kind, depth + 1)})",
                f"({self.of('Colour', 3)} = {self.of('Colour', 3)})",
                f"bits[{self.values.randint(0, 2)}]" if "no" in self.readable["BOOL"] else one,
            )
        )


def program(seed: int) -> str:
    """The random program of this seed."""
    return Generator(random.Random(seed)).text()
