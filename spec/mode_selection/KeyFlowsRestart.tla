--------------------------- MODULE KeyFlowsRestart --------------------------
(***************************************************************************)
(* The F-PLC starts again by itself, at any moment, while EKS, PLC and     *)
(* panel go on with what they have (E-56, breaks A-19).                    *)
(* Leaves out: a restart of the PLC or the panel (E-70).                   *)
(***************************************************************************)
EXTENDS KeyFlows

\* EKS-GP-4, EKS-GP-5, E-25c, E-56: back to power-up, with no mode
RestartFplc ==
    /\ fplcState # "Start"
    /\ fplcState' = "Start" /\ accepted' = None /\ authority' = None /\ fplcSelection' = None
    /\ mode' = {} /\ fplcElapsed' = 0
    /\ UNCHANGED <<reader, eks, plc, hmi, history>>
    /\ Took(0) /\ Did("RestartFplc")

RestartNext == Next \/ RestartFplc
RestartSpec == Init /\ [][RestartNext]_vars
=============================================================================
