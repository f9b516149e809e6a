--------------------------- MODULE ModeSelection ----------------------------
(***************************************************************************)
(* The contract: what mode selection with an electronic key does, as seen  *)
(* by the user and the machine.  Nothing here knows a device, a flag word, *)
(* a scan or a timer.  KeyFlows, the model with all devices, refines it.   *)
(*                                                                         *)
(* Models the purpose of the note: functional description, safety          *)
(* description, insert steps 14, 22, 23, 28, 29, removal step 8.           *)
(* Leaves out: when anything happens (see the liveness runs).              *)
(***************************************************************************)
EXTENDS Integers

MSO == 0..4     \* modes of safe operation, and the levels that permit them (EKS-T2)
None == -1

VARIABLES
    level,      \* the authorization level that the key reader signals now, or None
    touched,    \* the mode that the user touched since the key went in, or None
    seen,       \* the mode that the panel then showed back, or None
    confirmed,  \* the mode that the user then confirmed, or None
    mode        \* the active mode, or None before the first switchover

vars == <<level, touched, seen, confirmed, mode>>

Init == level = None /\ touched = None /\ seen = None /\ confirmed = None /\ mode = None

\* EKS-2-1: a key goes in; nothing that was touched before counts any more
Insert == touched' = None /\ seen' = None /\ confirmed' = None /\ UNCHANGED <<level, mode>>

\* EKS-2-7, EKS-8-2: the reader signals another level, or none
Signal == level' \in MSO \cup {None} /\ UNCHANGED <<touched, seen, confirmed, mode>>

\* EKS-2-14: the user touches a mode; this begins a selection
Touch == touched' \in MSO /\ seen' = None /\ confirmed' = None /\ UNCHANGED <<level, mode>>

\* EKS-2-22: the panel shows back what was touched
Show == touched # None /\ seen' = touched /\ UNCHANGED <<level, touched, confirmed, mode>>

\* EKS-2-23: the user confirms what is shown
Confirm == seen # None /\ confirmed' = seen /\ UNCHANGED <<level, touched, seen, mode>>

\* EKS-2-28, EKS-2-29, EKS-T2-2, EKS-SD-2: the one way in which the mode changes.  A confirmation is not
\* spent: until the next touch the same mode could be set again, which changes nothing (E-71)
Switch ==
    /\ confirmed # None
    /\ confirmed = touched /\ confirmed = seen      \* touched, seen and confirmed, in this insertion
    /\ level # None /\ confirmed <= level           \* permitted by the level signalled now
    /\ mode' = confirmed
    /\ UNCHANGED <<level, touched, seen, confirmed>>

Next == Insert \/ Signal \/ Touch \/ Show \/ Confirm \/ Switch

\* EKS-8-8, EKS-SD-7: insertion, removal, error and lapse of time are not among the steps that change the mode
Spec == Init /\ [][Next]_vars
=============================================================================
