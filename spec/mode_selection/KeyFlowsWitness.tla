-------------------------- MODULE KeyFlowsWitness ---------------------------
(***************************************************************************)
(* What must be reachable, so that no property holds for want of a case.   *)
(* A step is a witness by its name, which only the step itself sets; a     *)
(* situation by what is seen when a step is taken.  Every name that is met *)
(* is printed once a worker; runs.toml lists the names that must be met.   *)
(***************************************************************************)
EXTENDS KeyFlows

\* EKS-2-29, EKS-T2: each mode from each level that permits it
Switchover ==
    IF step' = "SwitchMode" THEN {"Mode" \o ToString(fplcSelection) \o "FromLevel" \o ToString(accepted)} ELSE {}

Case(name, met) == IF met THEN {name} ELSE {}
Situations ==
    \* E-52: the return of zeros is a real one, not zeros that were there anyway
    Case("MW03NotZeroOnEntryToAwaitZeros", step' = "ClearWords" /\ MW03 # 0)
    \cup Case("MW07NotZeroOnEntryToAwaitZeros", step' = "ClearWords" /\ MW07 # 0)
    \* E-52: the panel reads words that the F-PLC has already taken back
    \cup Case("StaleReadAuthorizationSeen", step' = "EnableScreen" /\ ReadAuthorization # MW01)
    \cup Case("StaleEchoSeen", step' = "ShowEcho" /\ CheckMSO # MW05)
    \* E-17: a new key is there before the removal is finished
    \cup Case("KeyInsertedDuringRemoval", step' = "InsertKey" /\ fplcState \in Removing)
    \cup Case("KeyPulledWhileSwitching", step' = "RemoveKey" /\ fplcState = "Switch")
    \* EKS-8-8: a mode is active while the key is away
    \cup Case("ModeHeldAfterRemoval", step' = "LeaveAwaitZeros" /\ mode # {})
    \cup Case("ModeHeldInError", fplcState' = "Error" /\ mode' # {})
    \* E-15: a second selection on one insertion
    \cup Case("SecondSelectionOnOneInsertion", step' = "TouchSelection" /\ confirmed # None)
    \cup Case("WithdrawnAndSelectedAgain", step' = "TouchSelection" /\ step = "FinishSelection" /\ hmiState = "Select" /\ confirmed = None)

Met == {step'} \cup Switchover \cup Situations
Report(name) == IF name \in TLCGet(1) THEN TRUE ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))
Mark == \A name \in Met : Report(name)

ASSUME TLCSet(1, {})
=============================================================================
