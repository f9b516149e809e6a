"""A program by a suite, twice: what the document demands of it, and whether it is as the reference."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from modeproof.kit.adapter import Program
from modeproof.kit.constants import constant_inputs, with_constants
from modeproof.kit.readings import find_readings
from modeproof.kit.relation import Options
from modeproof.kit.suite_judge import run_suite
from modeproof.kit.vectors import DEMANDS, MONITOR, Suite
from modeproof.kit.verdict import Plan, Verdict


def judge_both(
    suite: Suite,
    start: Callable[[], Program],
    plan: Plan | None = None,
    same: bool = False,
    flips: bool = False,
    page: dict[str, Any] | None = None,
    **reference: Any,
) -> Verdict:
    """The verdict beside the reference, with that of the page as its `page` where the suite has demands.

    `same`: the exit status asks for both. `flips`: what the page calls constant
    may change when it is asked. `page` and `reference` are handed to `run_suite`. Where the first
    is interrupted there is no second.
    """
    plan = plan or Plan()
    first, steady = None, () if flips else constant_inputs(suite)
    paged = with_constants(suite) if steady else suite
    demanded = suite.header.get(DEMANDS) is not None and MONITOR in suite.relations
    if demanded and plan.options.relation != MONITOR:
        options: Options = replace(plan.options, relation=MONITOR)
        first = run_suite(paged, start, plan=replace(plan, options=options, skip=()), **(page or {}))
        first.constant = steady
        if first.interrupted:
            return first
    by_page = plan.options.relation == MONITOR
    verdict = run_suite(paged if by_page else suite, start, plan=plan, **reference)
    verdict.constant = steady if by_page else ()
    if not verdict.interrupted:
        find_readings(suite, start, plan, verdict)
    verdict.page, verdict.same = first, same
    return verdict
