-------------------------- MODULE EnableSwitchTrace --------------------------
(***************************************************************************)
(* What one line of a log says about a call of the block: w holds the      *)
(* inputs by their names, and dt in ms, as EnableSwitch reads them.        *)
(***************************************************************************)
EXTENDS EnableSwitch

\* ES-SEQ-3, ESF-10: which memory goes with which state
BlockAnywhere ==
    /\ state \in States
    /\ resetBefore \in IF state \in ResetErrors THEN {TRUE} ELSE BOOLEAN
    /\ elapsed \in IF state \in Timed /\ DiscrepancyTimeCh1_Ch3 > 0
                  THEN 0..(DiscrepancyTimeCh1_Ch3 - 1) ELSE {0}
    /\ step = ""
=============================================================================
