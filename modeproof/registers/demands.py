"""What a document demands of a block seen from outside: the rows of spec/<document>/demands.toml.

Which expressions they may have is judged by modeproof.suites.demands, which reads them for the kit.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from modeproof.ground.errors import Unjudged
from modeproof.registers.files import read_toml
from modeproof.registers.rows import Interface, Property
from modeproof.registers.typed import Clauses, Entry, Name, Text, only_keys, typed

FILE = "demands"
MODULE = "Demands"
"""The end of the name of the module in which TLC judges the demands on a device."""
REASONS = ("definition", "drawing", "open", "unseen")
"""Why nothing is demanded: it defines a name; only a drawing could say; its words allow more than one
behaviour; nothing on the wires shows it.
"""
_HEAD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=A)(?=[A-Z])")


class Demand(Entry, frozen=True, kw_only=True):
    """One sentence of the document as a block's wires show it: `holds` or `comes` where `when` is true.

    `kind` is that of its operator in the specification.
    """

    id: Name
    says: Text
    clauses: Annotated[Clauses, Meta(min_length=1)]
    when: Text
    holds: str = ""
    comes: str = ""
    kind: Literal["invariant", "action"] = "action"


class Undemanded(Entry, frozen=True, kw_only=True):
    """The clauses of which nothing is demanded, by why; `open` with the findings that list what they allow,
    `unseen` with the cause.
    """

    definition: tuple[str, ...] = ()
    drawing: tuple[str, ...] = ()
    open: dict[str, tuple[str, ...]] = msgspec.field(default_factory=dict)
    unseen: dict[str, Text] = msgspec.field(default_factory=dict)

    def reasons(self) -> Iterator[tuple[str, str]]:
        """Each clause, and why nothing is demanded of it."""
        for reason in REASONS:
            for clause in getattr(self, reason):
                yield clause, reason


@dataclass(frozen=True)
class Demands:
    """The register: the demands on each device, the inputs of each that the document calls constant, with the
    clauses that do, by device and demand why it is not proved of the reference in a lane, and the clauses
    that demand nothing.
    """

    of: dict[str, tuple[Demand, ...]] = field(default_factory=dict)
    constant: dict[str, dict[str, Clauses]] = field(default_factory=dict)
    unproved: dict[str, dict[str, str]] = field(default_factory=dict)
    undemanded: Undemanded = field(default_factory=Undemanded)

    @property
    def rows(self) -> tuple[Demand, ...]:
        """All demands, those on the first device first."""
        return tuple(row for rows in self.of.values() for row in rows)


def load_demand_rows(root: Path, name: str) -> Demands:
    """The demands of a document; none where it has no register of them. Raises Unjudged with file and row."""
    source = f"spec/{name}/{FILE}.toml"
    path = root / "spec" / name / f"{FILE}.toml"
    if not path.is_file():
        return Demands()
    data = read_toml(root, path)
    only_keys(source, data, ("device", "undemanded"))
    found, constant, unproved, seen = {}, {}, dict[str, dict[str, str]](), set[str]()
    for device, table in data.get("device", {}).items():
        rows: dict[str, Any] = table.get("demand", {}) if isinstance(table, dict) else {}
        steady = table.get("constant", {}) if isinstance(table, dict) else {}
        constant[device] = typed(dict[str, Clauses], steady, f"{source}: {device}: constant")
        if isinstance(table, dict) and "unproved" in table:
            unproved[device] = typed(dict[str, Text], table["unproved"], f"{source}: {device}: unproved")
            if odd := sorted(unproved[device].keys() - rows.keys()):
                raise Unjudged(f"{source}: {device}: unproved: no demand {odd[0]!r}")
        found[device] = tuple(typed(Demand, {**row, "id": id}, f"{source}: {id}") for id, row in rows.items())
        for row in found[device]:
            if row.id in seen:
                raise Unjudged(f"{source}: two demands have the id {row.id!r}")
            seen.add(row.id)
    return Demands(
        found, constant, unproved, typed(Undemanded, data.get("undemanded", {}), f"{source}: [undemanded]")
    )


def as_properties(root: Path, name: str, demands: Demands, interface: Interface) -> Iterator[Property]:
    """The demands that TLC judges, as what must be true of the model of their device."""
    for device, rows in demands.of.items():
        known = interface.devices.get(device)
        if known is None:
            raise Unjudged(f"spec/{name}/{FILE}.toml: no device {device!r}")
        module = f"{known.module}{MODULE}"
        if not (root / "spec" / name / f"{module}.tla").is_file():
            continue
        for row in rows:
            yield Property(
                id=row.id,
                title=_HEAD.sub(" ", row.id).lower(),
                sentence=row.says,
                hazard="The block does not do what its page demands.",
                clauses=row.clauses,
                module=module,
                kind=row.kind,
                environments=("arbitrary",),
                tla=row.id,
                reason="an edit of the block that breaks it shows that it is asked",
            )
