------------------------------ MODULE HmiTrace ------------------------------
(***************************************************************************)
(* What one line of a log says about a scan of the panel.  w holds the     *)
(* inputs by their names in interface.toml.  Leaves out the active mode,   *)
(* which is passed through (E-25).                                         *)
(***************************************************************************)
EXTENDS Hmi

HmiRead(w) == [RA |-> w.ReadAuthorization, CM |-> w.CheckMSO, touch |-> w.touch]

\* EKS-2-14, EKS-2-15, EKS-8-8: which memory goes with which screen
HmiAnywhere ==
    /\ hmiState \in HmiStates
    /\ offered \in IF hmiState = "Inhibited" THEN {None} ELSE MSO
    /\ hmiSelection \in IF hmiState \in Pending THEN {m \in MSO : Permitted(offered, m)} ELSE {None}
    /\ step = ""
=============================================================================
