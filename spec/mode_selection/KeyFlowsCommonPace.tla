------------------------- MODULE KeyFlowsCommonPace -------------------------
(***************************************************************************)
(* A machine that does not exist: F-PLC, PLC and panel take their scans in *)
(* turn, as if one clock kept them together (E-43); with AtomicCopy of     *)
(* PlcAsPrinted the PLC copies all four words in its turn.  Only user and  *)
(* EKS are free.  What holds here alone holds by the clock: see            *)
(* NEG_KeyFlows_atomic_copy for the same devices without it.               *)
(* Leaves out: every other interleaving.                                   *)
(***************************************************************************)
EXTENDS KeyFlows

VARIABLE pace    \* whose scan is next

PaceView == <<View, pace>>

InTurn(this, next) == pace = this /\ pace' = next
\* In its turn the PLC copies whether or not a word is new
Copies == PlcScan(PlcInput) /\ Took(0) /\ UNCHANGED <<reader, eks, fplc, hmi, history>>
\* EKS-3-0, EKS-9-0, EKS-GP-3: one step of each in each cycle
PaceNext ==
    \/ (User \/ EksRuns) /\ UNCHANGED pace
    \/ InTurn("F-PLC", "to the panel") /\ FplcRuns
    \/ InTurn("to the panel", "panel") /\ Copies
    \/ InTurn("panel", "to the F-PLC") /\ PanelRuns
    \/ InTurn("to the F-PLC", "F-PLC") /\ Copies
PaceSpec == Init /\ pace = "F-PLC" /\ [][PaceNext]_<<vars, pace>>
=============================================================================
