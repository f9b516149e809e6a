------------------------ MODULE GuardLockingWitness -------------------------
(***************************************************************************)
(* What must be reachable, so that the properties are not vacuous.         *)
(* A step is a witness by its name, which only the step itself sets; a     *)
(* state by its name after the call, a code by its digits, a transition by *)
(* both states; a situation by what is seen in the call.                   *)
(***************************************************************************)
EXTENDS GuardLockingOpen

Report(name) ==
    IF name \in TLCGet(1) THEN TRUE
    ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))

\* GL-OUT-DIAGCODE, GLF-01
CodeSeen ==
    CASE DiagCode' = \h0000 -> "DiagCode0000" [] DiagCode' = \h8000 -> "DiagCode8000"
      [] DiagCode' = \h8001 -> "DiagCode8001" [] DiagCode' = \h8003 -> "DiagCode8003"
      [] DiagCode' = \h8011 -> "DiagCode8011" [] DiagCode' = \h8012 -> "DiagCode8012"
      [] DiagCode' = \h8013 -> "DiagCode8013" [] DiagCode' = \h8014 -> "DiagCode8014"
      [] DiagCode' = \hC001 -> "DiagCodeC001" [] DiagCode' = \hC002 -> "DiagCodeC002"
      [] DiagCode' = \hC003 -> "DiagCodeC003" [] DiagCode' = \hC004 -> "DiagCodeC004"

Situation ==
    /\ (Enables /\ ResetEdge(Scanned) => Report("EnabledByReset"))
       \* GL-IN-EDGE, GLF-15: before Reset has fallen again
    /\ (Enables /\ Scanned.Reset => Report("EnabledWhileResetIsPressed"))
    /\ (Enables /\ ~Scanned.S_SafetyActive => Report("EnabledWithZoneNotSafe"))
    /\ (Enables /\ starting /\ DiagCode = \h8003 => Report("StartUpInhibitRemovedLate"))
       \* GLF-06: the error message lasts one call
    /\ (DiagCode = \hC004 /\ DiagCode' = \h8014 /\ ~Error' /\ ~Scanned.S_GuardMonitoring =>
            Report("MessageGoneWithGuardOpen"))
    /\ (S_GuardLocked /\ Scanned.Activate /\ ~Secure /\ Scanned.S_SafetyActive => Report("LossWithZoneSafe"))
       \* GLF-12: the edge of Reset that comes with a loss is lost
    /\ (DiagCode = \h8003 /\ ~Secure /\ ResetEdge(Scanned) => Report("ResetWithLoss"))
       \* GLF-11: the state of an open guard is passed with a closed one
    /\ (DiagCode' = \h8012 /\ Scanned.S_GuardMonitoring => Report("OpenStateWithGuardClosed"))
       \* GLF-03
    /\ (S_UnlockGuard' /\ ~Scanned.UnlockRequest => Report("UnlockedWithoutRequest"))
       \* GLF-16: the feedback says locked while we unlock
    /\ (S_UnlockGuard /\ S_UnlockGuard' /\ Scanned.S_GuardLock => Report("UnlockedWithLockFeedback"))
       \* GLF-17
    /\ (~Scanned.Activate /\ S_UnlockGuard /\ ~Scanned.S_GuardMonitoring =>
            Report("SwitchedOffWithGuardOpen"))
       \* GLF-21: a loss that nobody has acknowledged is forgotten with Activate
    /\ (~Scanned.Activate /\ lost => Report("LossForgottenWithActivate"))
       \* GLF-09
    /\ (Error' /\ ~Scanned.S_GuardMonitoring => Report("ErrorWithGuardOpen"))
    /\ (DiagCode' = \hC004 /\ DiagCode = \h8011 /\ step = "FindGuardNotLocked" => Report("ErrorAtStartUp"))

Mark ==
    /\ Report(step') /\ Report(state') /\ Report(CodeSeen)
    /\ (state' # state => Report(state \o "To" \o state'))
    /\ Situation

ASSUME TLCSet(1, {})
=============================================================================
