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
=============================================================================
