---------------------------- MODULE FplcWitness -----------------------------
(***************************************************************************)
(* The F-PLC alone, as in FplcOpen: cases of its properties that no run    *)
(* with an honest panel meets.  A case that is met is printed once a       *)
(* worker; runs.toml lists the names that must be met.                     *)
(***************************************************************************)
EXTENDS FplcOrder

Report(name) ==
    IF name \in TLCGet(1) THEN TRUE
    ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))

Mark ==
    \* E-61
    /\ (Signalled /\ fplcState \in Transaction /\ NoCode => Report("NoCodeInATransaction"))
    \* E-15
    /\ (fplcState = "Settle" /\ step' = "DeadlineExpired" => Report("SettleExpired"))
    /\ (fplcState = "Complete" /\ Signalled /\ NoWords(Scanned) => Report("WordsTakenBackAfterTheOneSelection"))

ASSUME TLCSet(1, {})
=============================================================================
