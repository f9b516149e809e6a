-------------------------- MODULE KeyFlowsEarnest ---------------------------
(***************************************************************************)
(* A user who means it, from the moment the power comes on, on a machine   *)
(* that keeps its deadlines: inserts a key that permits the mode, touches  *)
(* it, confirms it, and may at any moment want a higher mode instead, with *)
(* the same key or with another insertion.  Up to the last change of mind  *)
(* such a behavior is one of GoalSpec without a goal, and after it one of  *)
(* GoalSpec with that goal: a reading that keeps a user from a mode here   *)
(* does so there.  It is small, so that such readings are tried one by one.*)
(* AnyTouchSpec has a user who touches anything, on the same machine.      *)
(* Leaves out: a user who does anything (GoalSpec).                        *)
(***************************************************************************)
EXTENDS KeyFlowsLive

\* EKS-2-14, EKS-2-25, EKS-8-1: the user wants more, with this key or without it
WantMore ==
    /\ goal # None
    /\ goal' \in {m \in MSO : m > goal /\ \E l \in LEVELS : Permitted(l, m)}
    /\ UNCHANGED vars \/ RemoveKey

EarnestInit == Init /\ goal \in {m \in MSO : \E l \in LEVELS : Permitted(l, m)}
EarnestNext == WantMore \/ ((EarnestUser \/ EarnestPanel \/ PromptFplc \/ PromptEks \/ PlcRuns) /\ Same)
EarnestSpec ==
    /\ EarnestInit /\ [][EarnestNext]_<<liveVars, step, took>> /\ FairPlc
    /\ WF_reader(EarnestUser /\ Same) /\ WF_panel(EarnestPanel /\ Same)
    /\ WF_fplc(PromptFplc /\ Same) /\ WF_eks(PromptEks /\ Same)

----------------------------------------------------------------------------
(* A user without a goal, who touches any field at any moment and pulls    *)
(* the key at any moment; only the next key waits until the machine is     *)
(* ready (E-17).                                                           *)
PatientUser == RemoveKey \/ \E k \in LEVELS : fplcState = "Idle" /\ SwapNoticed /\ InsertKey(k)
AnyTouchNext == (PatientUser \/ PanelRuns \/ PromptFplc \/ PromptEks \/ PlcRuns) /\ Same
AnyTouchSpec == LiveInit /\ [][AnyTouchNext]_<<liveVars, step, took>>

\* EKS-GP-4, EKS-KS-6, EKS-2-19: the error mode tells of a fault, and of nothing that an honest machine and a
\* patient user do
NoErrorWithoutFault == ~ERROR

\* A-08 broken, E-39: the pulse may be over before the F-PLC has looked
PulseMayBeMissed == TRUE
=============================================================================
