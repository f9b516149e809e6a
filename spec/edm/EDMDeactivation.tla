-------------------------- MODULE EDMDeactivation ---------------------------
(***************************************************************************)
(* The block alone, as in EDMOpen, with an observer who remembers an error *)
(* about contactors until somebody resets it, whatever Activate does.      *)
(* The document clears everything when Activate ends (EDMF-15): with       *)
(* ACTIVATE_HELD it does not end while an error shows (EDMA-08).           *)
(***************************************************************************)
EXTENDS EDMOpen

CONSTANT ACTIVATE_HELD  \* Activate stays TRUE while an error shows

VARIABLE unreset        \* an error about contactors came, and no reset by hand has ended it

ASSUME ACTIVATE_HELD \in BOOLEAN

DeactivationView == <<ObservedView, unreset>>

DeactivationInit == OpenInit /\ unreset = FALSE
DeactivationNext ==
    \E n \in 0..N - 1 : \E i \in {Alphabet[n]} :
        /\ ACTIVATE_HELD /\ Error => i.Activate
        /\ EDMCall(i) /\ in' = n /\ beat' = ~beat /\ Observe(i)
        /\ unreset' = IF Error' /\ (S_EDM_Out \/ SafetyDemand) THEN TRUE
                      ELSE IF Error /\ SafetyDemand' THEN FALSE ELSE unreset
DeactivationSpec == DeactivationInit /\ [][DeactivationNext]_<<edm, observer, step, in, beat, unreset>>

\* EDM-IN-RESET-1, EDM-IN-ACTIVATE, EDM-IN-START-3, EDMF-15
ErrorOutlivesDeactivation == [][~S_EDM_Out /\ S_EDM_Out' => ~unreset]_beat
=============================================================================
