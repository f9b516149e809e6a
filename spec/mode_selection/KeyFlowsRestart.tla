--------------------------- MODULE KeyFlowsRestart --------------------------
(***************************************************************************)
(* The F-PLC, or the panel, starts again by itself, at any moment, while   *)
(* the others go on with what they have (E-56, E-70; A-19).                *)
(* Leaves out: a restart of the PLC (E-70, a reading of KeyFlows).         *)
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

\* EKS-GP-5, E-70, A-19: inhibited, and what was touched is forgotten
RestartPanel ==
    /\ hmiState' = "Inhibited" /\ offered' = None /\ hmiSelection' = None
    /\ UNCHANGED <<reader, eks, fplc, plc, history>>
    /\ Took(0) /\ Did("RestartPanel")

PanelRestartNext == Next \/ RestartPanel
PanelRestartSpec == Init /\ [][PanelRestartNext]_vars
=============================================================================
