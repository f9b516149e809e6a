------------------------- MODULE ModeSelectionAlone -------------------------
(***************************************************************************)
(* The contract by itself: how strong it is.  KeyFlows refines the         *)
(* contract; that says nothing of a contract that allows too much.  So it  *)
(* is judged here variable by variable: when may each of them change, and  *)
(* to what.  The contract itself says it step by step.                     *)
(*                                                                         *)
(* From power-up several of its conditions follow from others: what is     *)
(* confirmed was seen and touched.  So each step is judged from any        *)
(* values too (Anywhere), where a condition that is lost cannot hide       *)
(* behind another.                                                         *)
(***************************************************************************)
EXTENDS ModeSelection

Values == MSO \cup {None}
AnyValues == level \in Values /\ touched \in Values /\ seen \in Values /\ confirmed \in Values /\ mode \in Values
Anywhere == AnyValues /\ [][Next]_vars

\* EKS-2-23, EKS-SD-5: what is confirmed is what was touched and seen
ConfirmedWasSeen == AnyValues /\ (confirmed # None => confirmed = seen /\ confirmed = touched)

\* EKS-2-28, EKS-2-29, EKS-FD-2, EKS-T2-2, EKS-SD-5: the mode that becomes active was touched, seen and
\* confirmed, and the level signalled now permits it
ModeNeedsConfirmation ==
    [][mode' # mode =>
        /\ mode' \in MSO /\ mode' = touched /\ mode' = seen /\ mode' = confirmed
        /\ mode' <= level
        /\ UNCHANGED <<level, touched, seen, confirmed>>]_vars

\* EKS-2-1, EKS-2-14: another touch, or another key, forgets what was seen and confirmed before
TouchBeginsAnew ==
    [][touched' # touched =>
        touched' \in Values /\ seen' = None /\ confirmed' = None /\ UNCHANGED <<level, mode>>]_vars

\* EKS-2-22, EKS-2-23: the panel shows what was touched, the user confirms what is shown, one after the other
ShownThenConfirmed ==
    [][/\ seen' # seen => IF seen' = None THEN confirmed' = None /\ UNCHANGED <<level, mode>>
                          ELSE seen' = touched /\ UNCHANGED <<level, touched, confirmed, mode>>
       /\ confirmed' # confirmed => IF confirmed' = None THEN seen' = None /\ UNCHANGED <<level, mode>>
                                    ELSE confirmed' = seen /\ UNCHANGED <<level, touched, seen, mode>>]_vars

\* EKS-2-7, EKS-8-2, EKS-SD-7: another level, or none, changes nothing else
LevelChangesNothingElse ==
    [][level' # level => level' \in Values /\ UNCHANGED <<touched, seen, confirmed, mode>>]_vars
=============================================================================
