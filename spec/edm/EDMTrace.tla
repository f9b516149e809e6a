------------------------------ MODULE EDMTrace ------------------------------
(***************************************************************************)
(* What one line of a log says about a call of the block: w holds the      *)
(* inputs by their names, and dt in ms, as EDM reads them.                 *)
(***************************************************************************)
EXTENDS EDM

\* EDM-INST-1, EDMF-04: which memory goes with which state
EDMAnywhere ==
    /\ state \in EDMStates
    /\ resetBefore \in BOOLEAN
    /\ outControlBefore \in IF state = "OutputEnable" THEN {TRUE} ELSE BOOLEAN
    /\ stopSeen \in IF state = "OutputDisable" THEN BOOLEAN ELSE {FALSE}
    /\ elapsed \in IF state \in Clocked THEN 0..MONITORING_TIME ELSE {0}
    /\ step = ""
=============================================================================
