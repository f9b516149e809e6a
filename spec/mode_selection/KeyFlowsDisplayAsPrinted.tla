----------------------- MODULE KeyFlowsDisplayAsPrinted ---------------------
(***************************************************************************)
(* What the note could be taken to say of the mode that the panel          *)
(* displays.  Op_Reading takes the place of Op of KeyFlowsDisplay or Hmi   *)
(* where a run tries that reading.                                         *)
(***************************************************************************)
EXTENDS KeyFlowsDisplay

----------------------------------------------------------------------------
(* PanelRemembersMode                                                      *)
\* EKS-8-8, EKS-8-16, E-25: the panel displays as active what it has last seen confirmed to the end.
Displays_PanelRemembersMode(i) ==
    IF hmiState = "AwaitSwitch" /\ hmiState' = "Select" THEN hmiSelection ELSE displayed

----------------------------------------------------------------------------
(* DisplayFromMW07                                                         *)
\* EKS-2-29, EKS-8-8, E-25: step 29 switches to the mode from MW07, so that the last one there is displayed.
Read_DisplayFromMW07 == IF MW07 = 0 THEN carried ELSE ModeOf(SW, MW07)
=============================================================================
