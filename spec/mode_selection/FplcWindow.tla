----------------------------- MODULE FplcWindow -----------------------------
(***************************************************************************)
(* The F-PLC alone, as in FplcOpen: how long the test pulse and the one    *)
(* output after it may take, counted from LA whatever T_SEQ counts from.   *)
(* Insert steps 6 to 11, Figure 4.                                         *)
(***************************************************************************)
EXTENDS FplcOpen

VARIABLE
    sinceLA     \* ticks since LA was seen, until one output is accepted; nothing of the F-PLC reads it

WindowView == <<View, sinceLA>>
LOCAL Longest == T_ON + T_SEQ

WindowInit == OpenInit /\ sinceLA = 0
WindowNext ==
    /\ OpenNext
    /\ LET time == sinceLA + Scanned.dt
       IN  sinceLA' = IF fplcState \notin Inserting \/ fplcState' \notin Inserting THEN 0
                      ELSE IF time > Longest THEN Longest ELSE time
WindowSpec == WindowInit /\ [][WindowNext]_<<View, observer, step, in, beat, sinceLA>>

\* EKS-2-6, EKS-2-8, EKS-4-2, E-38: several outputs are waited out no longer than one time from LA on
OneTimeForThePulse == sinceLA < T_SEQ
=============================================================================
