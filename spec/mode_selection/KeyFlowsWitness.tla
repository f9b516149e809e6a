-------------------------- MODULE KeyFlowsWitness ---------------------------
(***************************************************************************)
(* What must be reachable, so that no property holds for want of a case.   *)
(* A step is a witness by its name, which only the step itself sets; a     *)
(* situation by what is seen when a step is taken.  Every name that is met *)
(* is printed once a worker; runs.toml lists the names that must be met.   *)
(***************************************************************************)
EXTENDS KeyFlows

Report(name) ==
    IF name \in TLCGet(1) THEN TRUE
    ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))

\* EKS-2-29, EKS-T2: each mode from each level that permits it
Switchover == Report("Mode" \o ToString(fplcSelection) \o "FromLevel" \o ToString(accepted))

\* What is seen when a step is taken, asked only in that step
Situation ==
    CASE step' = "SwitchMode" -> Switchover
         \* E-52: the return of zeros is a real one, not zeros that were there anyway
      [] step' = "ClearWords" ->
            /\ (MW03 # 0 => Report("MW03NotZeroOnEntryToAwaitZeros"))
            /\ (MW07 # 0 => Report("MW07NotZeroOnEntryToAwaitZeros"))
         \* E-52: the panel reads words that the F-PLC has already taken back
      [] step' = "EnableScreen" -> (ReadAuthorization # MW01 => Report("StaleReadAuthorizationSeen"))
      [] step' = "ShowEcho" -> (CheckMSO # MW05 => Report("StaleEchoSeen"))
         \* E-17: a new key is there before the removal is finished
      [] step' = "InsertKey" -> (fplcState \in Removing => Report("KeyInsertedDuringRemoval"))
      [] step' = "RemoveKey" -> (fplcState = "Switch" => Report("KeyPulledWhileSwitching"))
         \* EKS-8-8: a mode is active while the key is away
      [] step' = "LeaveAwaitZeros" -> (mode # {} => Report("ModeHeldAfterRemoval"))
         \* E-15: a second selection on one insertion
      [] step' = "TouchSelection" ->
            /\ (confirmed # None => Report("SecondSelectionOnOneInsertion"))
            /\ (step = "FinishSelection" /\ confirmed = None => Report("WithdrawnAndSelectedAgain"))
      [] OTHER -> TRUE

Mark ==
    /\ Report(step')
    /\ Situation
    /\ (fplcState' = "Error" /\ mode' # {} => Report("ModeHeldInError"))

ASSUME TLCSet(1, {})
=============================================================================
