----------------------------- MODULE FplcPrompt -----------------------------
(***************************************************************************)
(* The F-PLC alone, as in FplcOpen: what it does without delay, and what   *)
(* it never does without a cause.  Nothing here speaks of which mode is    *)
(* set; a machine that breaks one of these stands still, or stops for      *)
(* nothing, or remembers what it must forget.                              *)
(***************************************************************************)
EXTENDS FplcOpen

Time == fplcElapsed + Scanned.dt
NoWord == Scanned.MW03 = 0 /\ Scanned.MW07 = 0
AllZero == ~Scanned.LA /\ Scanned.vec = {} /\ NoWord

\* EKS-GP-3, EKS-2-6, EKS-2-17, EKS-2-20, EKS-4-3, EKS-4-5, EKS-8-18, EKS-9-4-FPLC: a scan that waits has not
\* seen what it waits for, and a state that waits for nothing is left in one scan
NoNeedlessWait ==
    [][fplcState' = fplcState =>
        CASE fplcState \in {"Start", "AwaitZeros", "Error"} -> ~(AllZero /\ Time >= T_DWELL)
          [] fplcState = "Complete" -> Scanned.LA /\ Scanned.vec = {accepted}
          [] fplcState = "Settle" -> ~(NoWord /\ Time >= T_DWELL)
          [] fplcState = "Idle" -> ~Scanned.LA
          [] fplcState = "PulseOnes" -> Scanned.vec # MSO
          [] fplcState = "PulseZeros" -> Scanned.vec # {}
          [] fplcState = "OneOutput" -> Scanned.vec = {}
          [] fplcState = "AwaitSelection" -> NoWord
          [] fplcState = "AwaitAcknowledgment" -> Scanned.MW07 = 0
          [] OTHER -> FALSE]_beat

\* EKS-KS-6, EKS-2-8, EKS-2-11, EKS-2-19, EKS-2-27, EKS-4-4, EKS-8-11, E-07: two outputs outside the pulse, a
\* deadline that passed while LA stood, or a word
ErrorNeedsCause ==
    [][~ERROR /\ ERROR' =>
        \/ Cardinality(Scanned.vec) >= 2 /\ fplcState \notin Pulse
        \/ fplcState \in Timed /\ Time >= Deadline /\ (fplcState \in Removing \/ Scanned.LA)
        \/ fplcState \in Holding /\ Scanned.LA /\ Scanned.vec = {accepted} /\ ~NoWord]_beat

\* EKS-3-1-FPLC, EKS-3-4-FPLC, EKS-8-3, E-07: LA fell, or the accepted output
RemovalNeedsCause ==
    [][fplcState \notin Removing /\ fplcState' \in Removing =>
        \/ fplcState \in Inserting \cup Holding /\ ~Scanned.LA
        \/ fplcState \in Holding /\ Scanned.vec # {accepted}]_beat

\* EKS-2-6, EKS-9-4-FPLC, E-17, E-25c: an insertion begins in Idle, with LA
InsertionNeedsKey ==
    [][fplcState \notin Inserting /\ fplcState' \in Inserting => fplcState = "Idle" /\ Scanned.LA]_beat

\* EKS-8-6, EKS-8-15, EKS-GP-5, E-18, E-23: what belongs to one insertion, or to one selection, is gone after
\* it, the time too
NothingIsKept ==
    /\ fplcState \notin Holding => accepted = None /\ authority = None
    /\ fplcState \notin Chosen => fplcSelection = None
    /\ fplcState \notin Clocked \/ step = "" => fplcElapsed = 0
=============================================================================
