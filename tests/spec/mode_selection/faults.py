"""Faults of the device specifications, each with the property that must fall to it. Data, no code.

A fault is a slip that a programmer can make: a guard forgotten, a row of another table, one state too few.
"""

from __future__ import annotations

from dataclasses import dataclass

from tests.spec.mode_selection.planted import Base, Fault

KEY_FLOWS = Base("MC_KeyFlows_smoke")
NO_FAULT = Base("MC_KeyFlows_no_fault")
FPLC = Base(
    "MC_Fplc_arbitrary",
    (('VECTORS = "classes"', 'VECTORS = "classes"  InputsToTry <- SmallInputs'),),
    module="FplcSmall",
)
TEXT_ORDER = Base(
    "MC_Fplc_text_order",
    (('VECTORS = "few"', 'VECTORS = "classes"  InputsToTry <- SmallInputs'),),
    module="FplcSmall",
)
ANSWERS = Base(
    "MC_Fplc_answers",
    (('VECTORS = "few"', 'VECTORS = "classes"  InputsToTry <- SmallInputs'),),
    module="FplcPromptSmall",
)
ORDER = Base(
    "MC_Fplc_order",
    (('VECTORS = "few"', 'VECTORS = "classes"  InputsToTry <- SmallInputs'),),
    module="FplcOrderSmall",
)
HMI_PROMPT = Base("MC_Hmi_prompt")
EKS_PROMPT = Base("MC_Eks6_prompt")
FPLC_SMOKE = Base(
    "MC_Fplc_smoke",
    (('VECTORS = "few"', 'VECTORS = "classes"  InputsToTry <- SmallInputs'),),
    module="FplcSmall",
)
DEADLINES = Base(
    "MC_Fplc_deadlines",
    (('VECTORS = "one"', 'VECTORS = "one"  InputsToTry <- OneLevelInputs'),),
    module="FplcSmall",
)
NO_MODE = Base(
    "MC_Fplc_on_error_none",
    (('VECTORS = "few"', 'VECTORS = "classes"  InputsToTry <- SmallInputs'),),
    module="FplcSmall",
)
EKS = Base("OPEN_Eks6", (("PRINT_GRAPH = TRUE", "PRINT_GRAPH = FALSE"),))
HMI = Base("OPEN_Hmi", (("PRINT_GRAPH = TRUE", "PRINT_GRAPH = FALSE"),))
PLC = Base("OPEN_Plc", (("PRINT_GRAPH = TRUE", "PRINT_GRAPH = FALSE"),))
CONTRACT = Base("MC_ModeSelection")
CONTRACT_ANYWHERE = Base("MC_ModeSelection_anywhere")
EARNEST = Base("MC_KeyFlows_earnest")
LEAST = (
    ("BAD_KEY = TRUE", "BAD_KEY = FALSE"),
    ("LEVELS = {1}", "LEVELS = {0}"),
)
GOAL = Base("LIVE_KeyFlows_goal", LEAST)
REMOVAL = Base("LIVE_KeyFlows_removal", LEAST)
RECOVERY = Base("LIVE_KeyFlows_recovery")
AFTER_FAULT = Base("LIVE_KeyFlows_after_fault")
CORRUPTING = Base(
    "MC_KeyFlows_corrupting",
    (
        ("LEVELS = {0, 1, 2}", "LEVELS = {0}"),
        ("FAULT_CLASSES <- AllWordClasses", 'FAULT_CLASSES = {"corruption", "loss", "masquerade"}'),
    ),
)
FAULTY_EKS = Base(
    "MC_KeyFlows_faulty_eks",
    (
        ("LEVELS = {1}", "LEVELS = {0}"),
        ("FAULT_CLASSES <- AllButCrossedWires", 'FAULT_CLASSES = {"output stuck at 1", "LA stuck at 1"}'),
    ),
)


@dataclass(frozen=True)
class Falls:
    """A fault, the property that it breaks, and the base on which this is seen."""

    property: str
    base: Base
    fault: Fault


FAULTS = (
    Falls(
        "AuthorizationRespected",
        KEY_FLOWS,
        Fault(
            "a key of level 1 signals level 2",
            "Eks.tla",
            "-> {KeyLevel(key)}",
            "-> {KeyLevel(key) + 1}",
        ),
    ),
    Falls(
        "LADropsAtOnce",
        EKS,
        Fault(
            "the access code is not compared",
            "Eks.tla",
            "IF OPERATING_STATE = 6 THEN code = DIP_SWITCHES",
            "IF OPERATING_STATE = 6 THEN TRUE",
        ),
    ),
    Falls(
        "LADropsAtOnce",
        EKS,
        Fault(
            "the operating state on the key is not compared",
            "Eks.tla",
            "KEY[k].operating_state = OPERATING_STATE /\\",
            "TRUE /\\",
        ),
    ),
    Falls(
        "LADropsAtOnce",
        EKS,
        Fault(
            "a removed key is not noticed while its output stands (a scan that changes nothing)",
            "Eks.tla",
            '"TestOnes", "TestZeros", "Signal", "Rejected"}',
            '"TestOnes", "TestZeros", "Rejected"}',
        ),
    ),
    Falls(
        "LAOnlyForAcceptedKeys",
        EKS,
        Fault(
            "a key of every level sets STR",
            "Eks.tla",
            "-> {KeyLevel(key)}",
            "-> {4}",
        ),
    ),
    Falls(
        "UserIntent",
        KEY_FLOWS,
        Fault(
            "another mode is shown than the one that is confirmed",
            "Hmi.tla",
            'Shown == IF hmiState = "Confirm" THEN hmiSelection',
            'Shown == IF hmiState = "Confirm" THEN offered',
        ),
    ),
    Falls(
        "AcknowledgmentNeedsConfirm",
        HMI,
        Fault(
            "another mode is shown than the one that is confirmed",
            "Hmi.tla",
            'Shown == IF hmiState = "Confirm" THEN hmiSelection',
            'Shown == IF hmiState = "Confirm" THEN offered',
        ),
    ),
    Falls(
        "SelectionNeedsEnable",
        HMI,
        Fault(
            "the screen opens over an old echo",
            "Hmi.tla",
            "Opens(i) == Authorizes(i) /\\ i.CM = 0",
            "Opens(i) == Authorizes(i)",
        ),
    ),
    Falls(
        "InhibitAtOnce",
        HMI,
        Fault(
            "the panel may miss that the level is gone while it waits for the echo (no state changes)",
            "Hmi.tla",
            'IF hmiState = "Inhibited" \\/ StaysOpen(i)',
            'IF hmiState \\in {"Inhibited", "AwaitEcho"} \\/ StaysOpen(i)',
        ),
    ),
    Falls(
        "TwoOutputsLeadToError",
        FPLC,
        Fault(
            "two outputs without LA may go unnoticed in Idle (a scan that changes nothing)",
            "Fplc.tla",
            'AwaitKey(i) == fplcState = "Idle" /\\ ~i.LA /\\ ~Many(i)',
            'AwaitKey(i) == fplcState = "Idle" /\\ ~i.LA',
        ),
    ),
    Falls(
        "TwoOutputsLeadToError",
        FPLC,
        Fault(
            "the error lamp is never lit",
            "Fplc.tla",
            'ERROR == fplcState = "Error"',
            "ERROR == FALSE",
        ),
    ),
    Falls(
        "AuthorizationByTheText",
        TEXT_ORDER,
        Fault(
            "the order of Figure 5 is built in",
            "CodeTables.tla",
            "m \\in PERMITS[level]",
            "m <= level",
        ),
    ),
    Falls(
        "SelectionNeedsTouch",
        HMI,
        Fault(
            "whatever is touched, the highest mode is selected",
            "Hmi.tla",
            "i.touch = Field(m) /\\ hmiSelection' = m",
            "i.touch = Field(m) /\\ hmiSelection' = offered",
        ),
    ),
    Falls(
        "DisplayIsTheMode",
        KEY_FLOWS,
        Fault(
            "the panel displays the mode that was touched",
            "KeyFlows.tla",
            "Displayed == ActiveMSO",
            "Displayed == touched",
        ),
    ),
    Falls(
        "NoErrorWithoutFault",
        EARNEST,
        Fault(
            "a selection that is taken back is an error",
            "Fplc.tla",
            '    /\\ EnterSettle\n    /\\ Did("WithdrawSelection")',
            '    /\\ EnterError\n    /\\ Did("WithdrawSelection")',
        ),
    ),
    Falls(
        "SelectionNeedsLevel",
        FPLC,
        Fault(
            "a selection that no row refuses is accepted",
            "Fplc.tla",
            "MayBeSelected(i) == Permitted(authority, ModeOf(SE, i.MW03))",
            "MayBeSelected(i) == ModeOf(SE, i.MW03) # None",
        ),
    ),
    Falls(
        "ErrorOnlyOverZeros",
        FPLC,
        Fault(
            "the error mode ends when the key is out",
            "Fplc.tla",
            'fplcState = "Error" /\\ ZerosReturned(i)',
            'fplcState = "Error" /\\ ~i.LA',
        ),
    ),
    Falls(
        "RemovalTimerGoesOn",
        FPLC,
        Fault(
            "each scan that waits for the zeros starts the timer anew",
            "Fplc.tla",
            "    /\\ Wait(i, T_REM)\n",
            '    /\\ Proceed("AwaitZeros")\n',
        ),
    ),
    # ------------------------------------------------------------------ F-PLC
    Falls(
        "AtMostOneModeOutput",
        FPLC,
        Fault(
            "the new mode is set and the old one stays",
            "Fplc.tla",
            "mode' = {fplcSelection}",
            "mode' = mode \\cup {fplcSelection}",
        ),
    ),
    Falls(
        "TwoOutputsLeadToError",
        FPLC,
        Fault(
            "two outputs are not yet too many",
            "Fplc.tla",
            "Cardinality(i.vec) >= 2",
            "Cardinality(i.vec) > 2",
        ),
    ),
    Falls(
        "TwoOutputsLeadToError",
        FPLC,
        Fault(
            "two outputs are looked at only while LA is on",
            "Fplc.tla",
            "IsMany(i) == Many(i)",
            "IsMany(i) == i.LA /\\ Many(i)",
        ),
    ),
    Falls(
        "SwitchNeedsMatchingPair",
        FPLC,
        Fault(
            "any acknowledgment matches any selection",
            "Fplc.tla",
            "Matches(i) == i.MW07 = SW[fplcSelection]",
            "Matches(i) == ModeOf(SW, i.MW07) # None",
        ),
    ),
    Falls(
        "SwitchNeedsMatchingPair",
        FPLC,
        Fault(
            "the selection is not looked at again after the echo",
            "Fplc.tla",
            "SelectionStands(i) == i.MW03 = SE[fplcSelection]",
            'SelectionStands(i) == i.MW03 = SE[fplcSelection] \\/ fplcState = "Switch"',
        ),
    ),
    Falls(
        "SwitchNeedsMatchingPair",
        KEY_FLOWS,
        Fault(
            "the level is switched on, not the selection",
            "Fplc.tla",
            "mode' = {fplcSelection}",
            "mode' = {authority}",
        ),
    ),
    Falls(
        "AuthorizationRespected",
        FPLC,
        Fault(
            "the range of a selection is checked and the level is not",
            "Fplc.tla",
            "Permitted(authority, ModeOf(SE, i.MW03))",
            "ModeOf(SE, i.MW03) # None",
        ),
    ),
    Falls(
        "AuthorizationRespected",
        KEY_FLOWS,
        Fault(
            "every key is taken for one of the highest level",
            "Fplc.tla",
            "\\E a \\in i.vec : authority' = LevelOf(a)",
            "authority' = 4",
        ),
    ),
    Falls(
        "NoChangeWithoutLA",
        FPLC,
        Fault(
            "LA is not looked at in the scan that switches",
            "Fplc.tla",
            "IsGone(i) == ~i.LA /\\ fplcState",
            'IsGone(i) == ~i.LA /\\ fplcState # "Switch" /\\ fplcState',
        ),
    ),
    Falls(
        "NoChangeWithoutLA",
        KEY_FLOWS,
        Fault(
            "LA is not looked at in the scan that switches",
            "Fplc.tla",
            "IsGone(i) == ~i.LA /\\ fplcState",
            'IsGone(i) == ~i.LA /\\ fplcState # "Switch" /\\ fplcState',
        ),
    ),
    Falls(
        "NoChangeBesideSwitchover",
        FPLC,
        Fault(
            "the error mode drops the mode although it is to be held",
            "Fplc.tla",
            'mode\' = IF ON_ERROR = "none"',
            'mode\' = IF ON_ERROR = "hold"',
        ),
    ),
    Falls(
        "NoChangeBesideSwitchover",
        KEY_FLOWS,
        Fault(
            "removal drops the mode",
            "Fplc.tla",
            'EnterClear == GoTo("Clear") /\\ DropKey /\\ UNCHANGED mode',
            'EnterClear == GoTo("Clear") /\\ DropKey /\\ mode\' = {}',
        ),
    ),
    Falls(
        "EchoIsTheSelection",
        FPLC,
        Fault(
            "the echo is taken from the table of the acknowledgments",
            "Fplc.tla",
            "THEN CH[fplcSelection]",
            "THEN SW[fplcSelection]",
        ),
    ),
    Falls(
        "WordsZeroWithoutKey",
        FPLC,
        Fault(
            "MW01 falls only when the removal is over",
            "Fplc.tla",
            "THEN RE[authority] ELSE 0",
            "THEN RE[authority] ELSE IF fplcState \\in Removing THEN RE[0] ELSE 0",
        ),
    ),
    Falls(
        "SelectionWithinAuthority",
        FPLC,
        Fault(
            "the selection is latched through the table of the echo",
            "Fplc.tla",
            "fplcSelection' = ModeOf(SE, i.MW03)",
            "fplcSelection' = ModeOf(CH, i.MW03)",
        ),
    ),
    Falls(
        "IdleOnlyOverZeros",
        FPLC,
        Fault(
            "MW07 need not return to zero",
            "Fplc.tla",
            "NoWords(i) == i.MW03 = 0 /\\ i.MW07 = 0",
            "NoWords(i) == i.MW03 = 0",
        ),
    ),
    Falls(
        "IdleOnlyOverZeros",
        FPLC,
        Fault(
            "a forgotten output does not keep the error mode",
            "Fplc.tla",
            "NoSignal(i) == ~i.LA /\\ i.vec = {}",
            "NoSignal(i) == ~i.LA",
        ),
    ),
    Falls(
        "RemovalSeenAtOnce",
        FPLC,
        Fault(
            "a lost output is not seen before the level is published, nor in Settle",
            "Fplc.tla",
            "IsChanged(i) == i.vec # {accepted} /\\ fplcState \\in Holding",
            "IsChanged(i) == i.vec # {accepted} /\\ fplcState \\in Authorized",
        ),
    ),
    Falls(
        "EchoNeedsSelection",
        FPLC,
        Fault(
            "while MW07 is awaited MW03 is not looked at",
            "Fplc.tla",
            'AwaitMW07(i) == StandsIn("AwaitAcknowledgment", i)',
            'AwaitMW07(i) == fplcState = "AwaitAcknowledgment"',
        ),
    ),
    Falls(
        "LevelNeedsPulse",
        FPLC,
        Fault(
            "any output counts as the ones of the pulse",
            "Fplc.tla",
            'fplcState = "PulseOnes" /\\ i.vec = MSO\n',
            'fplcState = "PulseOnes" /\\ i.vec # {}\n',
        ),
    ),
    Falls(
        "NoWaitBeyondDeadline",
        FPLC,
        Fault(
            "a deadline passes one tick too late",
            "Fplc.tla",
            "IsExpired(i) == Now(i) >= Deadline",
            "IsExpired(i) == Now(i) > Deadline",
        ),
    ),
    # ------------------------------------------------------------------ the devices together
    Falls(
        "UserIntent",
        KEY_FLOWS,
        Fault(
            "the panel acknowledges as soon as it shows the echo",
            "Hmi.tla",
            'SwitchMSO == IF hmiState = "AwaitSwitch"',
            'SwitchMSO == IF hmiState \\in {"Confirm", "AwaitSwitch"}',
        ),
    ),
    Falls(
        "EchoIsTheTouch",
        KEY_FLOWS,
        Fault(
            "the panel sends the selection in the words of the level",
            "Hmi.tla",
            "THEN SE[hmiSelection]",
            "THEN RE[hmiSelection]",
        ),
    ),
    Falls(
        "IdleMeansZeros",
        KEY_FLOWS,
        Fault(
            "zeros count as returned without the dwell time",
            "Fplc.tla",
            "ZerosReturned(i) == NoSignal(i) /\\ NoWords(i) /\\ Dwelt(i)",
            "ZerosReturned(i) == NoSignal(i) /\\ NoWords(i)",
        ),
    ),
    Falls(
        "RefinesModeSelection",
        KEY_FLOWS,
        Fault(
            "the level becomes active, not the selection",
            "Fplc.tla",
            "mode' = {fplcSelection}",
            "mode' = {authority}",
        ),
    ),
    Falls(
        "ModeNeedsConfirmation",
        CONTRACT_ANYWHERE,
        Fault(
            "the contract asks for no touch and no display",
            "ModeSelection.tla",
            "    /\\ confirmed = touched /\\ confirmed = seen ",
            "    ",
        ),
    ),
    Falls(
        "ConfirmedWasSeen",
        CONTRACT,
        Fault(
            "a touch keeps what was confirmed before",
            "ModeSelection.tla",
            "touched' \\in MSO /\\ seen' = None /\\ confirmed' = None",
            "touched' \\in MSO /\\ seen' = None /\\ UNCHANGED confirmed",
        ),
    ),
    Falls(
        "TouchBeginsAnew",
        CONTRACT,
        Fault(
            "another key changes the mode",
            "ModeSelection.tla",
            "confirmed' = None /\\ UNCHANGED <<level, mode>>\n\n\\* EKS-2-7",
            "confirmed' = None /\\ UNCHANGED level /\\ mode' = None\n\n\\* EKS-2-7",
        ),
    ),
    Falls(
        "ShownThenConfirmed",
        CONTRACT,
        Fault(
            "the panel shows any mode",
            "ModeSelection.tla",
            "seen' = touched /\\",
            "seen' \\in MSO /\\",
        ),
    ),
    Falls(
        "LevelChangesNothingElse",
        CONTRACT,
        Fault(
            "a level that is gone takes the mode with it",
            "ModeSelection.tla",
            "UNCHANGED <<touched, seen, confirmed, mode>>",
            "mode' = None /\\ UNCHANGED <<touched, seen, confirmed>>",
        ),
    ),
    Falls(
        "GoalReached",
        GOAL,
        Fault(
            "the F-PLC waits for the ones of the pulse twice",
            "Fplc.tla",
            'SeePulseZeros(i) == fplcState = "PulseZeros" /\\ i.vec = {}',
            'SeePulseZeros(i) == fplcState = "PulseZeros" /\\ i.vec = MSO',
        ),
    ),
    Falls(
        "RemovalLeadsToIdle",
        REMOVAL,
        Fault(
            "zeros never count as returned after power-up",
            "Fplc.tla",
            "LeaveStart(i) \\/ AwaitPowerUpZeros(i)",
            "AwaitPowerUpZeros(i)",
        ),
    ),
    # ------------------------------------------------------------------ panel
    Falls(
        "SelectionWithinOffer",
        HMI,
        Fault(
            "all selection fields can be touched",
            "Hmi.tla",
            "{m \\in MSO : Permitted(offered, m)}",
            "MSO",
        ),
    ),
    Falls(
        "InhibitedSendsZeros",
        HMI,
        Fault(
            "the resting acknowledgment is not zero",
            "Hmi.tla",
            "THEN SW[hmiSelection] ELSE 0",
            "THEN SW[hmiSelection] ELSE OtherWord",
        ),
    ),
    Falls(
        "SelectionNeedsEnable",
        HMI,
        Fault(
            "another level on the bus leaves the screen open",
            "Hmi.tla",
            "Enable(i) == Level(i) = offered",
            "Enable(i) == Level(i) # None",
        ),
    ),
    Falls(
        "AcknowledgmentNeedsConfirm",
        HMI,
        Fault(
            "whatever is not a rejection confirms",
            "Hmi.tla",
            'Answerable(i) /\\ i.touch = "confirm"',
            'Answerable(i) /\\ i.touch # "reject"',
        ),
    ),
    Falls(
        "InhibitAtOnce",
        HMI,
        Fault(
            "any word but zero keeps the screen open",
            "Hmi.tla",
            "Enable(i) == Level(i) = offered",
            "Enable(i) == i.RA # 0",
        ),
    ),
    # ------------------------------------------------------------------ PLC
    Falls(
        "CopiesUnchanged",
        PLC,
        Fault(
            "the acknowledgment is copied to where the selection belongs",
            "Plc.tla",
            "MW03' = i.SelectMSO",
            "MW03' = i.SwitchMSO",
        ),
    ),
    # ------------------------------------------------------------------ EKS
    Falls(
        "OneOutputOutsideThePulse",
        EKS,
        Fault(
            "a level sets the outputs of all lower levels too",
            "Eks.tla",
            '{"Signal", "ClearOutputs"} -> {KeyLevel(key)}',
            '{"Signal", "ClearOutputs"} -> 0..KeyLevel(key)',
        ),
    ),
    Falls(
        "NoOutputWithoutLA",
        EKS,
        Fault(
            "LA is on in the pulse only",
            "Eks.tla",
            '{"StartTest", "TestOnes", "TestZeros", "Signal"}',
            '{"StartTest", "TestOnes", "TestZeros"}',
        ),
    ),
    Falls(
        "LAOnlyForAcceptedKeys",
        EKS,
        Fault(
            "the checksum is calculated and not compared",
            "Eks.tla",
            "/\\ KEY[key].KEYCRC = CHECKSUM[key] /\\ GoTo",
            "/\\ GoTo",
        ),
    ),
    Falls(
        "LAOnlyForAcceptedKeys",
        EKS,
        Fault(
            "the level is looked at and not judged",
            "Eks.tla",
            'At("CheckLevel", i) /\\ Accepted(key)',
            'At("CheckLevel", i)',
        ),
    ),
    Falls(
        "LADropsAtOnce",
        EKS,
        Fault(
            "a swapped key is not noticed",
            "Eks.tla",
            "Taken(i) == eksState \\in Working /\\ i.key # key",
            "Taken(i) == eksState \\in Working /\\ i.key = None",
        ),
    ),
    Falls(
        "PulseBeforeOutput",
        EKS,
        Fault(
            "the one output is set without a pulse",
            "Eks.tla",
            'GoTo("TestOnes")',
            'GoTo("Signal")',
        ),
    ),
    Falls(
        "PulseHalvesLast",
        EKS,
        Fault(
            "the second half of the pulse is over at once",
            "Eks.tla",
            'At("TestZeros", i) /\\ Over(i) /\\ GoTo("Signal")',
            'At("TestZeros", i) /\\ GoTo("Signal")',
        ),
    ),
    Falls(
        "PulseHalvesLast",
        EKS,
        Fault(
            "a half of the pulse lasts one scan longer",
            "Eks.tla",
            "Over(i) == eksElapsed + i.dt >= T_PULSE",
            "Over(i) == eksElapsed >= T_PULSE",
        ),
    ),
    Falls(
        "FaultIsLatched",
        EKS,
        Fault(
            "registers that are not zero are forgotten",
            "Eks.tla",
            'GoTo("Fault")',
            'GoTo("Empty")',
        ),
    ),
    Falls(
        "EveryScanIsAnswered",
        EKS,
        Fault(
            "a key that is refused leaves the device without a step",
            "Eks.tla",
            "(HoldOneOutput(i) \\/ StayRejected(i))",
            "HoldOneOutput(i)",
        ),
    ),
    # ------------------------------------------------------------------ deadlines, answers
    Falls(
        "SharedDeadlineHolds",
        DEADLINES,
        Fault(
            "the sequence timer starts again when all outputs are off",
            "Fplc.tla",
            'GoOn("OneOutput", i)',
            'Proceed("OneOutput")',
        ),
    ),
    Falls(
        "SharedDeadlineHolds",
        FPLC,
        Fault(
            "the removal timer starts again when the words are cleared",
            "Fplc.tla",
            'GoOn("AwaitZeros", i)',
            'Proceed("AwaitZeros")',
        ),
    ),
    Falls(
        "ErrorDropsMode",
        NO_MODE,
        Fault(
            "the error mode keeps the mode although it is to be dropped",
            "Fplc.tla",
            'mode\' = IF ON_ERROR = "none"',
            'mode\' = IF ON_ERROR = "hold"',
        ),
    ),
    Falls(
        "EveryScanIsAnswered",
        ANSWERS,
        Fault(
            "a key that is refused in Idle has no step",
            "Fplc.tla",
            "AwaitKey(i) \\/ DetectKey(i)",
            "DetectKey(i)",
        ),
    ),
    Falls(
        "EveryScanIsAnswered",
        HMI,
        Fault(
            "a touch beside the fields has no answer",
            "Hmi.tla",
            "TouchSelection(i) \\/ OfferModes(i)",
            "TouchSelection(i)",
        ),
    ),
    Falls(
        "EveryScanIsAnswered",
        PLC,
        Fault(
            "one of the four copies is forgotten",
            "Plc.tla",
            "\\/ CopyMW03(i) \\/ CopyCheckMSO(i)",
            "\\/ CopyMW03(i)",
        ),
    ),
    # ------------------------------------------------------------------ power-up, turns
    Falls(
        "PowerUpIsSafe",
        FPLC_SMOKE,
        Fault(
            "a mode is active from the first moment",
            "Fplc.tla",
            "    /\\ mode = {} /\\ fplcElapsed = 0",
            "    /\\ mode = {0} /\\ fplcElapsed = 0",
        ),
    ),
    Falls(
        "PowerUpIsSafe",
        PLC,
        Fault(
            "the word of the last day is still there",
            "Plc.tla",
            "ReadAuthorization = 0 /\\ MW03 = 0",
            "ReadAuthorization = OtherWord /\\ MW03 = 0",
        ),
    ),
    Falls(
        "PowerUpIsSafe",
        HMI,
        Fault(
            "the screen is open after power-up",
            "Hmi.tla",
            'HmiInit == hmiState = "Inhibited" /\\ offered = None',
            'HmiInit == hmiState = "Select" /\\ offered = 0',
        ),
    ),
    Falls(
        "PowerUpIsSafe",
        EKS,
        Fault(
            "LA is on from the first moment",
            "Eks.tla",
            'EksInit == eksState = "Empty" /\\ key = None',
            'EksInit == eksState = "StartTest" /\\ key = 0',
        ),
    ),
    Falls(
        "CopiesTakeTurns",
        PLC,
        Fault(
            "the turn is not passed on",
            "Plc.tla",
            "turn = this /\\ turn' = next",
            "turn = this /\\ turn' = this",
        ),
    ),
    # ------------------------------------------------------------------ with faults from outside
    Falls(
        "NothingButTheTouch",
        NO_FAULT,
        Fault(
            "the level is switched on, not the selection",
            "Fplc.tla",
            "mode' = {fplcSelection}",
            "mode' = {authority}",
        ),
    ),
    Falls(
        "NoOfferBeyondTheLevel",
        NO_FAULT,
        Fault(
            "all selection fields can be touched",
            "Hmi.tla",
            "{m \\in MSO : Permitted(offered, m)}",
            "MSO",
        ),
    ),
    Falls(
        "NoWordIsRefused",
        NO_FAULT,
        Fault(
            "all selection fields can be touched",
            "Hmi.tla",
            "{m \\in MSO : Permitted(offered, m)}",
            "MSO",
        ),
    ),
    Falls(
        "NeverBeyondTheKey",
        NO_FAULT,
        Fault(
            "a key of level 1 signals level 2",
            "Eks.tla",
            "-> {KeyLevel(key)}",
            "-> {KeyLevel(key) + 1}",
        ),
    ),
    # ------------------------------------------------------------------ detections that faults need
    Falls(
        "NeverBeyondTheKey",
        CORRUPTING,
        Fault(
            "any code is accepted as a selection, whatever the level",
            "Fplc.tla",
            "Permitted(authority, ModeOf(SE, i.MW03))",
            "ModeOf(SE, i.MW03) # None",
        ),
    ),
    Falls(
        "SwitchNeedsMatchingPair",
        CORRUPTING,
        Fault(
            "any code is accepted as an acknowledgment",
            "Fplc.tla",
            "Matches(i) == i.MW07 = SW[fplcSelection]",
            "Matches(i) == ModeOf(SW, i.MW07) # None",
        ),
    ),
    Falls(
        "SwitchNeedsMatchingPair",
        CORRUPTING,
        Fault(
            "the selection need not stand until the switchover",
            "Fplc.tla",
            "SelectionStands(i) == i.MW03 = SE[fplcSelection]",
            "SelectionStands(i) == TRUE",
        ),
    ),
    Falls(
        "NeverBeyondTheKey",
        FAULTY_EKS,
        Fault(
            "the accepted output need not stay",
            "Fplc.tla",
            "IsChanged(i) == i.vec # {accepted}",
            "IsChanged(i) == FALSE",
        ),
    ),
    Falls(
        "NeverBeyondTheKey",
        FAULTY_EKS,
        Fault(
            "LA need not stay",
            "Fplc.tla",
            "IsGone(i) == ~i.LA",
            "IsGone(i) == FALSE",
        ),
    ),
    # ------------------------------------------------------------------ promptness, causes, memory
    Falls(
        "NoNeedlessWait",
        ANSWERS,
        Fault(
            "an output that is there may be waited for",
            "Fplc.tla",
            'fplcState = "OneOutput" /\\ i.vec = {} /\\ Wait',
            'fplcState = "OneOutput" /\\ Wait',
        ),
    ),
    Falls(
        "ErrorNeedsCause",
        ANSWERS,
        Fault(
            "a key that went leaves an error when the deadline passed too",
            "Fplc.tla",
            "IsExpired(i) /\\ ~IsGone(i) /\\ ~IsMany(i)",
            "IsExpired(i) /\\ ~IsMany(i)",
        ),
    ),
    Falls(
        "ErrorNeedsCause",
        ANSWERS,
        Fault(
            "a key that went in the test pulse leaves an error when two outputs stand",
            "Fplc.tla",
            'fplcState = "Idle" /\\ ~i.LA /\\ Many(i)',
            "~i.LA /\\ Many(i)",
        ),
    ),
    Falls(
        "RemovalNeedsCause",
        ANSWERS,
        Fault(
            "a key that is not yet there begins a removal",
            "Fplc.tla",
            "IsGone(i) == ~i.LA /\\ fplcState \\in WithKey",
            'IsGone(i) == ~i.LA /\\ fplcState \\in WithKey \\cup {"Idle"}',
        ),
    ),
    Falls(
        "InsertionNeedsKey",
        ANSWERS,
        Fault(
            "power-up leads into the test pulse",
            "Fplc.tla",
            '    /\\ Proceed("Idle")\n    /\\ Did("LeaveStart")',
            '    /\\ Proceed("PulseOnes")\n    /\\ Did("LeaveStart")',
        ),
    ),
    Falls(
        "NothingIsKept",
        ANSWERS,
        Fault(
            "the error mode keeps the level",
            "Fplc.tla",
            "DropKey == accepted' = None /\\ authority' = None",
            "DropKey == accepted' = None /\\ authority' = authority",
        ),
    ),
    Falls(
        "NothingIsKept",
        ANSWERS,
        Fault(
            "the dwell time of power-up is over at power-up",
            "Fplc.tla",
            "mode = {} /\\ fplcElapsed = 0",
            "mode = {} /\\ fplcElapsed = 1",
        ),
    ),
    Falls(
        "RecoversFully",
        RECOVERY,
        Fault(
            "the reader latches its fault where its test pulse should begin",
            "Eks.tla",
            'At("StartTest", i) /\\ GoTo("TestOnes")',
            'At("StartTest", i) /\\ GoTo("Fault")',
        ),
    ),
    Falls(
        "GoalReachedAfterFault",
        AFTER_FAULT,
        Fault(
            "the reader latches its fault where its test pulse should begin",
            "Eks.tla",
            'At("StartTest", i) /\\ GoTo("TestOnes")',
            'At("StartTest", i) /\\ GoTo("Fault")',
        ),
    ),
    # ------------------------------------------------------------------ order of steps, answers
    Falls(
        "StepsInOrder",
        ORDER,
        Fault(
            "the echo is on the wire before the selection was checked a second time",
            "Fplc.tla",
            '    /\\ GoTo("EchoSelection")\n    /\\ KeepKey /\\ UNCHANGED mode\n',
            '    /\\ GoTo("AwaitAcknowledgment")\n    /\\ KeepKey /\\ UNCHANGED mode\n',
        ),
    ),
    Falls(
        "TimeGoesOn",
        ORDER,
        Fault(
            "the dwell time of the error mode is not counted",
            "Fplc.tla",
            'Wait(i, T_DWELL) /\\ Did("StayInError")',
            'Untimed /\\ Did("StayInError")',
        ),
    ),
    Falls(
        "AcknowledgmentNeedsEcho",
        ORDER,
        Fault(
            "an early acknowledgment is overlooked while the selection is seen",
            "Fplc.tla",
            'fplcState = "AwaitSelection" /\\ Silent(i) /\\ i.MW03 # 0',
            'fplcState = "AwaitSelection" /\\ i.MW03 # 0',
        ),
    ),
    Falls(
        "ChangedSelectionIsWithdrawn",
        ORDER,
        Fault(
            "a changed selection beside an acknowledgment is an error",
            "Fplc.tla",
            '{"AwaitSelection", "CheckSelection"} \\/ StandsIn("EchoSelection", i)\n',
            '{"AwaitSelection", "CheckSelection", "EchoSelection"}\n',
        ),
    ),
    Falls(
        "AcknowledgmentIsJudged",
        ORDER,
        Fault(
            "an acknowledgment that is no code passes step 27",
            "Fplc.tla",
            'StandsIn("CheckAcknowledgment", i) /\\ IsAcknowledgment(i)',
            'StandsIn("CheckAcknowledgment", i) /\\ i.MW07 # 0',
        ),
    ),
    Falls(
        "AcknowledgmentIsJudged",
        ORDER,
        Fault(
            "an acknowledgment that is no code is refused before step 27",
            "Fplc.tla",
            '    /\\ Proceed("CheckAcknowledgment")\n    /\\ Did("SeeAcknowledgment")',
            '    /\\ IF ModeOf(SW, i.MW07) # None THEN Proceed("CheckAcknowledgment") ELSE EnterError\n'
            '    /\\ Did("SeeAcknowledgment")',
        ),
    ),
    Falls(
        "ScreenIsTrue",
        HMI_PROMPT,
        Fault(
            "the screen waits while it asks",
            "Hmi.tla",
            'hmiState = "Confirm" -> "confirm"',
            'hmiState = "AwaitSwitch" -> "confirm"',
        ),
    ),
    Falls(
        "FieldSelectsItsMode",
        HMI_PROMPT,
        Fault(
            "two fields have one name",
            "Hmi.tla",
            'm = 1 -> "select:1"',
            'm = 1 -> "select:2"',
        ),
    ),
    Falls(
        "ClosesAtOnce",
        HMI_PROMPT,
        Fault(
            "a selection is given up before the screen closes",
            "Hmi.tla",
            'IF hmiState = "Inhibited" \\/ StaysOpen(i)',
            'IF hmiState = "Inhibited" \\/ StaysOpen(i) \\/ (hmiState = "AwaitEcho" /\\ i.CM # 0)',
        ),
    ),
    Falls(
        "ClosesOverAnEcho",
        HMI_PROMPT,
        Fault(
            "an echo that nobody asked for leaves the screen open",
            "Hmi.tla",
            "hmiState' = \"Inhibited\" /\\ offered'",
            "hmiState' = (IF Enable(i) THEN hmiState ELSE \"Inhibited\") /\\ offered'",
        ),
    ),
    Falls(
        "EndsWithTheEcho",
        HMI_PROMPT,
        Fault(
            "an echo that is gone counts as another echo",
            "Hmi.tla",
            "OtherEcho(i) == i.CM # 0 /\\ ~Echoed(i)",
            'OtherEcho(i) == (hmiState = "AwaitEcho" => i.CM # 0) /\\ ~Echoed(i)',
        ),
    ),
    Falls(
        "EndsWithTheEcho",
        HMI_PROMPT,
        Fault(
            "what was selected is kept when it is over",
            "Hmi.tla",
            "hmiState' = s /\\ hmiSelection' = None /\\ UNCHANGED offered",
            "hmiState' = s /\\ UNCHANGED <<hmiSelection, offered>>",
        ),
    ),
    Falls(
        "PanelAnswersAtOnce",
        HMI_PROMPT,
        Fault(
            "an echo may be waited for that is there",
            "Hmi.tla",
            'hmiState = "AwaitEcho" /\\ i.CM = 0 /\\ Stay',
            'hmiState = "AwaitEcho" /\\ Stay',
        ),
    ),
    Falls(
        "ReaderStepsInOrder",
        EKS_PROMPT,
        Fault(
            "the checksum is calculated before the key is read",
            "Eks.tla",
            "eksState' = \"Read\" /\\ key' = i.key",
            "eksState' = \"CheckChecksum\" /\\ key' = i.key",
        ),
    ),
    Falls(
        "LABeforeOutputs",
        EKS_PROMPT,
        Fault(
            "LA comes with the pulse",
            "Eks.tla",
            'LA == eksState \\in {"StartTest", "TestOnes"',
            'LA == eksState \\in {"TestOnes"',
        ),
    ),
    Falls(
        "RightKeysPass",
        EKS_PROMPT,
        Fault(
            "a right checksum may be refused",
            "Eks.tla",
            "KEY[key].KEYCRC # CHECKSUM[key] /\\ GoTo",
            "GoTo",
        ),
    ),
    Falls(
        "FaultNeedsCause",
        EKS_PROMPT,
        Fault(
            "registers that are zero may be latched as a fault",
            "Eks.tla",
            'eksState = "CheckRegisters" /\\ ~i.registers_zero /\\',
            'eksState = "CheckRegisters" /\\',
        ),
    ),
    Falls(
        "KeyIsForgotten",
        EKS_PROMPT,
        Fault(
            "the reader keeps the key after the outputs are cleared",
            "Eks.tla",
            '/\\ key\' = None\n    /\\ Did("ResetOutputs")',
            '/\\ UNCHANGED key\n    /\\ Did("ResetOutputs")',
        ),
    ),
    Falls(
        "ReaderAnswersAtOnce",
        EKS_PROMPT,
        Fault(
            "a key in the reader may be overlooked",
            "Eks.tla",
            'eksState = "Empty" /\\ i.key = None /\\ Stay',
            'eksState = "Empty" /\\ Stay',
        ),
    ),
)
