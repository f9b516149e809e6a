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
=============================================================================
