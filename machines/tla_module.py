"""The text of the TLA+ module of a wiring; machines/tla_model.py says what the model is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from machines.tla_model import LOOSE, Model, Step
from programs.language.tree import Name


class Module(Model):
    """The model of a wiring as text."""

    def text(self, module: str, comment: Sequence[str] = ()) -> str:
        """The module."""
        return "\n".join(self._lines(module, comment)) + "\n"

    def _lines(self, module: str, comment: Sequence[str]) -> Iterator[str]:
        yield f"{'-' * 20} MODULE {module} {'-' * 20}"
        yield from (f"\\* {line}" for line in comment)
        yield "EXTENDS Integers"
        yield "CONSTANT Words    \\* the words that are tried"
        rows = [name for name in self.blocks if self.stand[name] != "whole"]
        whole = [name for name in self.blocks if self.stand[name] == "whole"]
        inner = [f"{name}_{variable}" for name in whole for variable in self.blocks[name].variables]
        plan = ["scan", "goal"] if self.helped else []
        variables = ["at", "broken", *rows, *inner, *(["step"] if whole else []), *self.kept, *plan]
        yield "VARIABLES"
        yield "    at,        \\* the step of the scan that comes next"
        yield "    broken,    \\* what was found broken in the step before"
        yield f"    {', '.join(variables[2:])}"
        yield f"vars == <<{', '.join(variables)}>>"
        if self.helped:
            yield "helper == INSTANCE MachineHelper"
        for name in rows:
            yield f"{name}_is == INSTANCE {self.blocks[name].name}Contract"
        for name in whole:
            yield from self._instance(name)
        yield ""
        yield "Init =="
        yield "    /\\ at = 1 /\\ broken = {}"
        yield from (f"    /\\ {name} = {self.shown(name, f'{name}_is!Start')}" for name in rows)
        yield from (f"    /\\ {name}_is!{'Rests' if self.helped else 'Starts'}" for name in whole)
        if whole:
            yield '    /\\ step = ""'
        if self.helped:
            yield "    /\\ scan = 1 /\\ goal = 0"
        rested = self._rested() if self.helped else {}
        yield from (f"    /\\ {name} \\in {rested[name]}" for name in rested)
        yield from (f"    /\\ {name} = {start}" for name, start in self.kept.items() if name not in rested)
        for step in self.steps:
            yield ""
            yield from self._step(step, variables)
        yield ""
        yield "Next == " + " \\/ ".join(f"Step{step.number}" for step in self.steps)
        yield "Spec == Init /\\ [][Next]_vars"
        yield ""
        if whole and self.held:
            same = ", ".join(f"{name} <- {name}" for name in whole)
            yield "\\* The same with the contracts of the blocks that are whole here"
            yield f"Over == INSTANCE {module}Over WITH {same}"
            yield "IsOverContracts == Over!Spec"
        yield "\\* What each contract assumes is true wherever the block is called"
        for name in self.blocks:
            yield f'Assumes_{name} == "{name}" \\notin broken'
        for rule in self.asked:
            yield f'{rule.name} == "{rule.id}" \\notin broken'
        if self.helped:
            number = Step(0)
            modes = ", ".join(
                self.expression(number, Name(name, self.place)) for name in self.wiring.table.modes
            )
            yield "GoalIsReached == at = 1 /\\ scan = helper!Last + 1 =>"
            yield f"    {self.expression(number, self.helped)} /\\ <<{modes}>>[goal + 1]"
        yield "=" * 77

    def _rested(self) -> dict[str, str]:
        """What the memory of each standard block may be once everything rests."""
        step, found = Step(0), dict[str, str]()
        for name in (*self.wiring.table.order, *self.needed):
            if name in self.blocks:
                continue
            kind = self.kind(name)
            if kind in ("R_TRIG", "F_TRIG"):
                found[f"{name}_CLK"] = f"{{{self.expression(step, self.pin(name, 'CLK'))}}}"
            elif kind == "RS":
                found[f"{name}_Q1"] = (
                    f"IF {self.expression(step, self.pin(name, 'R1'))} THEN {{FALSE}} ELSE BOOLEAN"
                )
            else:
                found[f"{name}_Q1"] = (
                    f"IF {self.expression(step, self.pin(name, 'S1'))} THEN {{TRUE}} ELSE BOOLEAN"
                )
        return found

    def _instance(self, name: str) -> Iterator[str]:
        block, row = self.blocks[name], self.wiring.table.block[name]
        constants = dict(block.constants)
        for pin, value in row.parameters.items():
            if pin in constants and not isinstance(value, int):
                constants[pin] = f'"{value}"'
            elif isinstance(value, bool) and pin in constants:
                constants[pin] = str(value).upper()
        given = [f"{key} <- {value}" for key, value in constants.items()]
        given += ["RECORD_STEPS <- FALSE", "step <- step"]
        given += [f"{variable} <- {name}_{variable}" for variable in block.variables]
        yield f"{name}_is == INSTANCE {block.name}Shows WITH {', '.join(given)}"
        yield f"{name}_keeps == INSTANCE {block.name}Contract"
        yield f"{name} == {name}_is!Row"

    def _step(self, step: Step, variables: Sequence[str]) -> Iterator[str]:
        name, after, last = step.document, dict(step.after), step is self.steps[-1]
        stand = self.stand[name]
        chosen = [f"new_{at} \\in {self._values(at)}" for at in step.chosen]
        ticks = "{helper!Gives(scan, goal).dt}" if self.helped else f"0..{self.blocks[name].ticks}"
        chosen += [f"{free} \\in BOOLEAN" for free in step.free]
        chosen += [f"dt \\in {ticks}"] if stand == "whole" else []
        for at in step.chosen:
            if at in self.kept and self.lives(at, step.number):
                after[at] = f"new_{at}"
        after |= self.forgotten(step)
        changed = {"at", "broken", *after, name}
        if self.helped and last:
            changed |= {"scan", "goal"}
        yield f"Step{step.number} =="
        yield f"    /\\ at = {step.number} /\\ at' = {1 if last else step.number + 1}"
        if self.helped:
            yield "    /\\ scan <= helper!Last"
        if self.helped and last:
            yield "    /\\ scan' = scan + 1 /\\ goal' \\in helper!Goals(scan, goal)"
        lead = "    "
        if chosen:
            yield f"    /\\ \\E {', '.join(chosen)} :"
            lead = "       "
        if step.before:
            yield from _let(step.before, lead if chosen else f"{lead}/\\ ")
            lead = "       "
        assumed = "TRUE"
        if stand == "contract":
            yield f"{lead}/\\ \\E row \\in {name}_is!Rows :"
            yield f"{lead}      {name}_is!Guarantees({name}, i, row) /\\ {name}' = row"
            assumed = f"{name}_is!Assumes({name}, i)"
        elif stand in LOOSE:
            rows = f"{name}_is!Rows"
            if stand == "at_once":
                rows = f"{{row \\in {rows} : {name}_is!AtOnce(i, row)}}"
            yield f"{lead}/\\ {name}' \\in {{{self.shown(name, 'row')} : row \\in {rows}}}"
        else:
            yield f"{lead}/\\ {name}_is!Call(i)"
            changed |= {"step", *(f"{name}_{variable}" for variable in self.blocks[name].variables)}
            assumed = f"{name}_keeps!Assumes({name}, i)"
        if step.lets:
            yield from _let(step.lets, f"{lead}/\\ ")
            lead = "          "
        found = [f'(IF bad_{rule.name} THEN {{"{rule.id}"}} ELSE {{}})' for rule in self.asked if last]
        fine = " \\cup ".join(found) or "{}"
        yield f'{lead}/\\ broken\' = IF {assumed} THEN {fine} ELSE {{"{name}"}}'
        yield from (f"{lead}/\\ {key}' = {value}" for key, value in after.items())
        yield f"{lead}/\\ UNCHANGED <<{', '.join(key for key in variables if key not in changed)}>>"

    def _values(self, name: str) -> str:
        if self.helped:
            return f"{{helper!Gives(scan, goal).{name}}}"
        if name in self.held:
            return f"{{{self.held[name]}}}"
        return "BOOLEAN" if self.wiring.table.inputs[name].type == "BOOL" else "Words"


def _let(lines: Sequence[str], lead: str) -> Iterator[str]:
    """Names for values. A set of one value, because TLC works out a LET anew wherever its name is."""
    for line in lines:
        name, _, text = line.partition(" == ")
        yield f"{lead}\\E {name} \\in {{{text}}} :"
        lead = " " * len(lead)
