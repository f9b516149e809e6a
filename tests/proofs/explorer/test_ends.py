"""The tree of a scan says the same as its paths one by one, and nothing is lost where ends are joined."""

import pytest
import z3

from proofs.explorer.device import Device, scans
from proofs.explorer.ends import TRUE, End, always, ends, in_terms, some, tree, value
from proofs.explorer.explore import Path, explore
from proofs.explorer.records import filled, terms
from proofs.explorer.scanned import outputs_of
from proofs.explorer.values import flag, word
from proofs.mode_selection.devices import EKS, HMI


def _same(one: z3.BoolRef, other: z3.BoolRef, premise: z3.BoolRef = TRUE) -> bool:
    solver = z3.SimpleSolver()
    solver.add(premise, one != other)
    return bool(solver.check() == z3.unsat)


def _says(end: End) -> z3.BoolRef:
    """Some formula that differs from end to end."""
    state, _ = end.result
    return z3.Bool(f"ends in {state.state.value}")


def _leads_to(path: Path) -> z3.BoolRef:
    return z3.Bool(f"ends in {path.result[0].state.value}")


@pytest.mark.parametrize("device", [HMI, EKS], ids=lambda device: device.name)
def test_a_tree_says_the_same_as_its_single_paths(device: Device) -> None:
    for scan in scans(device):
        root = tree(scan.paths)
        each = [z3.Implies(path.condition, _leads_to(path)) for path in scan.paths]
        assert _same(always(root, _says), z3.And(*each))
        one = [z3.And(path.condition, _leads_to(path)) for path in scan.paths]
        assert _same(some(root, _says), z3.Or(*one))


def test_a_path_that_is_left_out_is_noticed() -> None:
    for scan in scans(HMI):
        whole, less = tree(scan.paths), tree(scan.paths[1:])
        assert not _same(some(whole, lambda _: TRUE), some(less, lambda _: TRUE), scan.premise)


def test_ends_of_a_tree_differ_and_none_is_lost() -> None:
    for scan in scans(HMI):
        found = ends(tree(scan.paths))
        results = [repr([str(part) for part in _leaves(end.result)]) for end in found]
        assert len(set(results)) == len(results) <= len(scan.paths)
        assert {repr([str(part) for part in _leaves(path.result)]) for path in scan.paths} == set(results)


def _leaves(result: object) -> list[object]:
    return [leaf for _, leaf in terms(result)]


def _picks(a: bool, b: int) -> int:
    if a:
        return 1
    if b == 7:
        return 2
    return 1


def _asks_for_nothing(b: int) -> int:
    if b == 7:
        return 1
    return 1


def test_a_question_that_decides_no_end_is_left_out() -> None:
    found = explore(_asks_for_nothing, (word("b"),))
    assert len(found.paths) == 2
    assert isinstance(tree(found.paths), End)
    found = explore(_picks, (flag("a"), word("b")))
    assert len(found.paths) == 3
    assert len(ends(tree(found.paths))) == 2


def test_a_value_over_all_paths_is_what_the_function_returns() -> None:
    found = explore(_picks, (flag("a"), word("b")))
    term = value(found, z3.IntVal)
    for a in (True, False):
        for b in (0, 7, 0xFFFF):
            put = [(flag("a").term, z3.BoolVal(a)), (word("b").term, z3.BitVecVal(b, 16))]
            assert z3.simplify(z3.substitute(term, *put)).as_long() == _picks(a, b)


def test_outputs_as_terms_are_those_of_the_shipped_function() -> None:
    device = HMI
    for scan in scans(device):
        sent = outputs_of(device, scan.state)
        for path in scan.paths[:12]:
            state = filled(scan.state, path.example)
            real = in_terms(device.module.outputs(state), device.register.outputs)
            for name in real.__dataclass_fields__:
                mine, theirs = getattr(sent, name), getattr(real, name)
                parts = zip(mine, theirs, strict=True) if isinstance(mine, tuple) else [(mine, theirs)]
                for one, other in parts:
                    got = path.example.eval(one, model_completion=True) if z3.is_expr(one) else one
                    assert got.eq(other) if z3.is_expr(other) else got == other


def test_a_record_in_terms_has_a_term_for_every_signal() -> None:
    scan = scans(HMI)[0]
    record = in_terms(scan.inputs, HMI.register.inputs)
    assert all(isinstance(getattr(record, name), z3.ExprRef) for name in record.__dataclass_fields__)
