----------------------- MODULE GuardLockingAsPrinted ------------------------
(***************************************************************************)
(* What the text of SF_GuardLocking could be taken to say, where we        *)
(* decided otherwise: one section a reading.  Op_Reading takes the place   *)
(* of Op in the runs that try the reading.  What the family's text could   *)
(* be taken to say about Reset (GLF-07) stands in CyclicBlockAsPrinted.    *)
(***************************************************************************)
EXTENDS GuardLocking

----------------------------------------------------------------------------
\* GLF-05, GL-OUT-ERROR, GL-OUT-GUARDLOCKED: a locked guard that is lost withdraws the enable, and is no error
LoseGuard_LossIsNoError(i) ==
    At("GuardClosedAndLocked", i) /\ LockLost(i) /\ GoTo("WaitForOperator") /\ Did("LoseGuard")

----------------------------------------------------------------------------
\* GLF-07, GL-IN-RESET: a Reset that does not move is passed over
ResetStatic_StaticResetUnnoticed(i) == FALSE

----------------------------------------------------------------------------
\* GLF-07, GL-IN-RESET: an edge is looked for only while the block is active, so that a Reset which is held
\* while the block is activated is one
RemembersReset_HeldResetIsAnEdge(i) == resetBefore' = (i.Reset /\ i.Activate /\ state # "Idle")

----------------------------------------------------------------------------
\* GLF-10, GL-IN-SAFETYACTIVE, GL-OUT-UNLOCKGUARD: an open guard is unlocked before the zone is looked at
ZoneOpenToIt_OpenGuardNeedsNoSafeZone(i) == ~i.S_SafetyActive /\ i.S_GuardMonitoring /\ ~i.S_GuardLock

----------------------------------------------------------------------------
\* GLF-11, GL-IN-UNLOCKREQUEST: a request needs an edge also where the block waits for its operator
GoesOnRequest_EdgeWhereNothingIsEnabled(i) == i.S_GuardMonitoring /\ RequestRises(i) /\ i.S_SafetyActive

----------------------------------------------------------------------------
\* GLF-12, GL-IN-UNLOCKREQUEST: a request is looked at before the guard
LoseGuard_RequestBeforeLoss(i) ==
    At("GuardClosedAndLocked", i) /\ ~UnlocksNow(i) /\ LockLost(i) /\ GoTo("SafetyLost") /\ Did("LoseGuard")
Unlock_RequestBeforeLoss(i) ==
    At("GuardClosedAndLocked", i) /\ UnlocksNow(i) /\ GoTo("GuardClosedButUnlocked") /\ Did("Unlock")

----------------------------------------------------------------------------
\* GLF-12, GL-IN-RESET: an edge of Reset is looked at before the guard
LostAgain_ResetBeforeLoss(i) == ~(i.S_GuardMonitoring /\ i.S_GuardLock) /\ ~ResetRises(i)

----------------------------------------------------------------------------
\* GLF-13, GL-IN-AUTORESET: without a restart inhibit an error ends by itself
Acknowledged_AutoResetEndsError(i) == (~i.S_AutoReset => ResetRises(i)) /\ CauseGone(i)

----------------------------------------------------------------------------
\* GLF-16, GL-IN-GUARDLOCK: a lock that is told thrown while the guard is open is an error
ZoneIsLostInOpen_ContradictionIsAnError(i) ==
    \/ ~(i.S_SafetyActive \/ (ZONE_LOST = "tolerated" /\ i.S_GuardMonitoring))
    \/ i.S_GuardLock /\ ~i.S_GuardMonitoring

----------------------------------------------------------------------------
\* GLF-18, GL-IN-UNLOCKREQUEST, GL-SEQ-3: the edge of the request alone unlocks, whether the zone is safe or
\* not
UnlocksNow_UnlocksWithoutSafeZone(i) == Requested(i)

----------------------------------------------------------------------------
\* GLF-19, GL-OUT-GUARDLOCKED, GL-IN-SAFETYACTIVE: a locked guard needs a safe zone as well
LockLost_ZoneMustStaySafe(i) == ~(i.S_GuardMonitoring /\ i.S_GuardLock /\ i.S_SafetyActive)
=============================================================================
