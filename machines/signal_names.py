"""The names in an expression of a wiring: signals, and output pins of blocks."""

from __future__ import annotations

from collections.abc import Iterator

from programs.language.tree import Binary, Expression, Member, Name, Unary


def leaves(tree: Expression) -> Iterator[Name | Member]:
    """The inputs, signals and pins that an expression reads, from left to right."""
    match tree:
        case Name() | Member():
            yield tree
        case Unary(_, operand, _):
            yield from leaves(operand)
        case Binary(_, left, right, _):
            yield from leaves(left)
            yield from leaves(right)


def names(tree: Expression) -> Iterator[str]:
    """The inputs and signals in an expression, and the blocks whose outputs it reads."""
    for leaf in leaves(tree):
        of = leaf.of if isinstance(leaf, Member) else leaf
        if isinstance(of, Name):
            yield of.name
