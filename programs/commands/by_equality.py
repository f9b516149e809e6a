"""Demands that hold of a program because it is the same as the reference, of which they are proved.

What the wires show of the one they show of the other. So a demand on compared outputs holds of the program
where both are proved, for the parameters that the binding allows: equality, and the demand of the reference.
"""

from __future__ import annotations

from dataclasses import replace

from programs.certificates.demand_certificate import of_reference
from programs.commands.following import Followed
from programs.demands.verdicts import TYPES, Found


def by_equality(followed: Followed) -> Followed:
    """What is known once the program is proved to be the same as the reference: a demand that could not be
    shown of the program is asked of the reference. That it stays within its types is part of equality.
    """
    reference, compared = of_reference(followed.judgement), {*followed.product.binding.compared}
    rows = {row.id: row for row in followed.judgement.beside.rows}
    signals = followed.reference.signals("outputs")
    printed = {signals[name].name for name in compared}
    found: list[Found] = []
    for one in followed.found:
        if one.word != "UNKNOWN" or (one.asked.id != TYPES and not rows[one.asked.id].outputs <= printed):
            found.append(one)
            continue
        if one.asked.id == TYPES:
            found.append(replace(one, word="PROVED", how="part of equality", by_equality=True))
            continue
        shown = reference.one(one.asked.id)
        if shown.word == "PROVED":
            how = f"of the reference by {shown.how}, and the program is the same"
            found.append(replace(one, word="PROVED", how=how, by_equality=True))
        else:
            found.append(one)
    return replace(followed, found=found)
