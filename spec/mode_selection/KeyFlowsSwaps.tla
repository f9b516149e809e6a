---------------------------- MODULE KeyFlowsSwaps ----------------------------
(***************************************************************************)
(* KeyFlows with a bound on how often the key is swapped, for the chart of *)
(* growth (runs.toml).     No run checks anything by it: in KeyFlows a key *)
(* may be swapped without end.                                             *)
(***************************************************************************)
EXTENDS KeyFlows

CONSTANT SWAPS     \* how many keys may be inserted after the first

VARIABLE inserted  \* how many keys were inserted

ASSUME SWAPS \in Nat

SwapsInit == Init /\ inserted = 0
SwapsNext ==
    /\ Next
    /\ inserted' = IF reader = None /\ reader' # None THEN inserted + 1 ELSE inserted
    /\ inserted' <= SWAPS + 1
SwapsView == <<ViewWithoutMode, inserted>>
SwapsSpec == SwapsInit /\ [][SwapsNext]_<<vars, inserted>>
=============================================================================
