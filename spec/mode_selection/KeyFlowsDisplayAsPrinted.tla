----------------------- MODULE KeyFlowsDisplayAsPrinted ---------------------
(***************************************************************************)
(* What the note could be taken to say of the mode that the panel          *)
(* displays.  It has a module of its own because it has a variable.        *)
(***************************************************************************)
EXTENDS KeyFlows

VARIABLE remembered     \* the mode that the panel believes to be active

----------------------------------------------------------------------------
(* PanelRemembersMode                                                      *)
\* EKS-8-8, EKS-8-16, E-25: the panel displays as active what it has last seen confirmed to the end.
LOCAL Learn ==
    remembered' = IF hmiState = "AwaitSwitch" /\ hmiState' = "Select" THEN hmiSelection ELSE remembered
Displayed_PanelRemembersMode == remembered
View_PanelRemembersMode == <<reader, eks, fplc, plc, hmi, history, remembered>>
Spec_PanelRemembersMode == Init /\ remembered = None /\ [][Next /\ Learn]_<<vars, remembered>>
=============================================================================
