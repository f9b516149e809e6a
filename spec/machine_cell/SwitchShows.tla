---------------------------- MODULE SwitchShows -----------------------------
(***************************************************************************)
(* SF_EnableSwitch by the pins of the cell.  Our own design; the block is  *)
(* EnableSwitch, unchanged.                                                *)
(***************************************************************************)
EXTENDS EnableSwitch

Starts == BlockInit
Call(i) == BlockCall(i)

\* What its contract speaks of
Row ==
    [S_EnableSwitchOut |-> S_EnableSwitchOut, Error |-> Error, may |-> state \in {"Stage0", "ChangeToStage1"},
     reset |-> resetBefore]

\* What the refinement tries: everything, and times up to that of a change
Inputs ==
    [Activate : BOOLEAN, S_SafetyActive : BOOLEAN, S_EnableSwitchCh1 : BOOLEAN, S_EnableSwitchCh2 : BOOLEAN,
     S_EnableSwitchCh3 : BOOLEAN, S_AutoReset : BOOLEAN, Reset : BOOLEAN, dt : 0..DiscrepancyTimeCh1_Ch3]

\* The switch is released and nobody resets, in a mode where it enables and in others; and where that leads
RestInputs ==
    {[Activate |-> TRUE, S_SafetyActive |-> active, S_EnableSwitchCh1 |-> FALSE, S_EnableSwitchCh2 |-> TRUE,
      S_EnableSwitchCh3 |-> FALSE, S_AutoReset |-> FALSE, Reset |-> FALSE, dt |-> 1] : active \in BOOLEAN}
Rests == state \in {"BasicMode", "SafeMode", "Stage0"} \cup Released /\ resetBefore = FALSE /\ elapsed = 0
=============================================================================
