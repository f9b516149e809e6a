----------------------------- MODULE GuardShows -----------------------------
(***************************************************************************)
(* SF_GuardLocking by the pins of the cell.  Our own design; the block is  *)
(* GuardLocking, unchanged.                                                *)
(***************************************************************************)
EXTENDS GuardLocking

Starts == GuardLockingInit
Call(i) == GuardLockingCall(i)

\* What its contract speaks of
Row ==
    [S_GuardLocked |-> S_GuardLocked, S_UnlockGuard |-> S_UnlockGuard, Error |-> Error, reset |-> resetBefore]

\* What the refinement tries: everything
Inputs ==
    [Activate : BOOLEAN, S_GuardMonitoring : BOOLEAN, S_SafetyActive : BOOLEAN, S_GuardLock : BOOLEAN,
     UnlockRequest : BOOLEAN, S_StartReset : BOOLEAN, S_AutoReset : BOOLEAN, Reset : BOOLEAN]

\* Nobody touches it, the door is closed and bolted, the zone is safe; and where that leads
RestInputs ==
    {[Activate |-> TRUE, S_GuardMonitoring |-> TRUE, S_SafetyActive |-> TRUE, S_GuardLock |-> TRUE,
      UnlockRequest |-> FALSE, S_StartReset |-> FALSE, S_AutoReset |-> FALSE, Reset |-> FALSE]}
Rests ==
    /\ state \in {"Init", "GuardClosedAndLocked", "WaitForReset", "SafetyReturn"}
    /\ resetBefore = FALSE /\ unlockRequestBefore = FALSE /\ requestPending = FALSE
    /\ startUpInhibit \in BOOLEAN /\ guardLost \in BOOLEAN
    /\ GuardLockingTypeOK
=============================================================================
