"""Which theorems judge the mutants of each device, in the order in which they are asked.

Every theorem that says what a device does or guarantees, whatever surrounds it. Left out are those that
compare the code with itself, with tables written a second time, or with the classes of the models.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType, ModuleType
from typing import Final

from proofs.explorer.device import Device
from proofs.mode_selection import composition_guarantees as guarantees
from proofs.mode_selection import (
    eks_first,
    eks_prompt,
    eks_safety,
    every_device,
    fplc_answers,
    fplc_causes,
    fplc_invariant,
    fplc_order,
    fplc_prompt,
    fplc_response,
    fplc_safety,
    panel_prompt,
    panel_safety,
    plc_safety,
)
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.theorem import Theorem


def _theorems(device: Device, *modules: ModuleType) -> tuple[Theorem, ...]:
    """The theorems of these modules in the order of the text, invariants last; of guarantees the device's."""
    found = [
        var
        for module in modules
        for var in vars(module).values()
        if isinstance(var, Theorem) and var.build.__module__ == module.__name__
    ]
    own = {guarantee.theorem for guarantee in guarantees.GUARANTEES if guarantee.device is device}
    others = {guarantee.theorem for guarantee in guarantees.GUARANTEES} - own
    found.sort(key=lambda scan: "invariant" in scan.name)
    return tuple(judge for judge in found if judge.name not in others)


JUDGES: Final[Mapping[str, tuple[Theorem, ...]]] = MappingProxyType(
    {
        FPLC.name: _theorems(
            FPLC,
            *(every_device, fplc_safety, fplc_order, fplc_prompt, fplc_answers),
            *(guarantees, fplc_response, fplc_invariant, fplc_causes),
        ),
        HMI.name: _theorems(HMI, every_device, panel_safety, panel_prompt, guarantees),
        PLC.name: _theorems(PLC, every_device, plc_safety, guarantees),
        EKS.name: _theorems(EKS, every_device, eks_first, eks_safety, eks_prompt, guarantees),
    }
)
