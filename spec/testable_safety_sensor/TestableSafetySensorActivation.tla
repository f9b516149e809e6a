------------------- MODULE TestableSafetySensorActivation --------------------
(***************************************************************************)
(* What the end of Activate forgets.  A block that is switched off and on  *)
(* again starts anew: also after a failed test (TSSF-32).  Idle, Init, and *)
(* the error behaviour of the document.                                    *)
(* Leaves out what drives Activate (TSSA-08).                              *)
(***************************************************************************)
EXTENDS TestableSafetySensorOpen

CONSTANT STAYS_ACTIVE     \* TRUE: a block that is active stays so (TSSA-08)

VARIABLE owed             \* a test has failed, and S_OSSD_Out was not TRUE since

ActivationView == <<block, owed>>
ASSUME STAYS_ACTIVE \in BOOLEAN /\ ~PRINT_GRAPH

ActivationInit == OpenInit /\ owed = FALSE
InputsHere == {n \in InputsToTry : Alphabet[n].Activate \/ ~STAYS_ACTIVE \/ state = "Idle"}
ActivationNext ==
    \E n \in InputsHere : \E i \in {Alphabet[n]} :
        /\ SensorScan(i)
        /\ in' = n /\ beat' = ~beat /\ UNCHANGED observer
        /\ owed' = (state' \in TestErrors \/ (owed /\ ~Then("S_OSSD_Out")))
ActivationSpec == ActivationInit /\ [][ActivationNext]_<<ActivationView, observer, step, in, beat>>

\* TSS-EB-1, TSS-EB-2, TSS-IN-NOEXT-FALSE, TSSF-32: the output comes back from a failed test by its reset, or
\* at the end of its manual test
FailedTestIsMended == [][Rise("S_OSSD_Out") /\ owed => (state \in TestErrors \cup Manual)]_beat
=============================================================================
