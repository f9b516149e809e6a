----------------------------- MODULE FplcTrace ------------------------------
(***************************************************************************)
(* What one line of a log says about a scan of the F-PLC.  w holds the     *)
(* inputs by their names in interface.toml, and dt.  A log may begin in    *)
(* any state that power-up reaches, with any time on its clock.            *)
(* Leaves out: nothing of Fplc.                                            *)
(***************************************************************************)
EXTENDS Fplc, Sequences

LOCAL LoggedVector(w) == {l \in MSO : <<w.A, w.B, w.C, w.D, w.STR>>[l + 1]}
FplcRead(w) == [LA |-> w.LA, vec |-> LoggedVector(w), MW03 |-> w.MW03, MW07 |-> w.MW07, dt |-> w.dt]

\* The times that a scan can find on the clock of each state (EKS-2-6, EKS-4-2, EKS-8-3, E-38, E-52)
LOCAL Clock == CASE fplcState = "PulseOnes" -> 0..T_ON - 1
                 [] fplcState \in {"PulseZeros", "OneOutput"} -> 0..T_SEQ - 1
                 [] fplcState \in {"AwaitZeros", "Settle"} -> 0..T_REM - 1
                 [] fplcState \in {"Start", "Error"} -> 0..T_DWELL
                 [] OTHER -> {0}
LOCAL Selections == IF fplcState \in Chosen THEN {m \in MSO : Permitted(authority, m)} ELSE {None}
\* E-25c, EKS-2-12, EKS-2-29, E-24: which memory goes with which state
FplcAnywhere ==
    /\ fplcState \in FplcStates \ (IF SELECTIONS = "once" THEN {} ELSE {"Complete"})
    /\ accepted \in IF fplcState \in Holding THEN MSO ELSE {None}
    /\ authority = IF fplcState \in Holding \ {"Authorize"} THEN accepted ELSE None
    /\ fplcSelection \in Selections
    /\ mode \in IF fplcState = "Start" \/ (fplcState = "Error" /\ ON_ERROR = "none") THEN {{}}
                ELSE IF fplcState = "Complete" THEN {{fplcSelection}}
                ELSE {{}} \cup {{m} : m \in MSO}
    /\ fplcElapsed \in Clock
    /\ step = ""
=============================================================================
