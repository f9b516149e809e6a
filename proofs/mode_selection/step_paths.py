"""Each device's `step`, path by path: every scan takes exactly one path, and none of them raises."""

from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.sentences import exactly_one_path
from proofs.theorem import Queries, theorem


@theorem(
    clauses=["EKS-GP-2-FPLC", "EKS-GP-3"],
    findings=["E-38", "E-47"],
    properties=["EveryScanIsAnswered"],
    slow=True,
)
def every_scan_of_the_fplc_takes_exactly_one_path() -> Queries:
    """In every control state of the F-PLC, with any memory, inputs, times and parameters in their ranges,
    exactly one path of `step` applies, and it ends with a state and outputs.

    All 65536 words in MW03 and MW07, levels and modes 0 to 4 or none, times without limit, all parameters
    that the code accepts. Nothing is assumed about how the memory came about.
    """
    yield from exactly_one_path(FPLC)


@theorem(clauses=["EKS-GP-2", "EKS-GP-3"], findings=["E-08"], properties=["EveryScanIsAnswered"])
def every_scan_of_the_plc_takes_exactly_one_path() -> Queries:
    """In every control state of the PLC, with any words, exactly one path of `step` applies: the copy that is
    due, or the first one.
    """
    yield from exactly_one_path(PLC)


@theorem(
    clauses=["EKS-GP-3", "EKS-3-0", "EKS-9-0"],
    findings=["E-47"],
    properties=["EveryScanIsAnswered"],
    slow=True,
)
def every_scan_of_the_panel_takes_exactly_one_path() -> Queries:
    """In every control state of the panel, with any memory, words, touch and permissions in their ranges,
    exactly one path of `step` applies, and it ends with a state and outputs.
    """
    yield from exactly_one_path(HMI)


@theorem(clauses=["EKS-GP-3", "EKS-KS-1", "EKS-KS-7"], findings=["E-41"], properties=["EveryScanIsAnswered"])
def every_scan_of_the_eks_takes_exactly_one_path() -> Queries:
    """In every control state of the EKS, with any key in memory and in the reader and any settings, exactly
    one path of `step` applies, and it ends with a state and outputs.

    The maker's checksum is not public: whether it agrees is left open, so both answers are covered.
    """
    yield from exactly_one_path(EKS)
