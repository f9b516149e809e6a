-------------------------- MODULE GuardLocking -----------------------------
(***************************************************************************)
(* The block SF_GuardLocking V1.0: a guard that is closed, locked, and     *)
(* unlocked on request; tables of inputs and outputs, steps 0 to 5 of the  *)
(* signal sequence.  (A module cannot have the block's own name: TLA+      *)
(* reads SF_ as fairness.)                                                 *)
(* One step is one call.  i = [Activate, S_GuardMonitoring,                *)
(* S_SafetyActive, S_GuardLock, UnlockRequest, S_StartReset, S_AutoReset,  *)
(* Reset] as the call reads them.                                          *)
(* The document prints outputs and one diagram, and neither states nor     *)
(* codes: both are the family's of V1.0 as the project's reference notes   *)
(* have them (GLF-01), changed where the document's own words ask for it   *)
(* (UNLOCK_ON, UNLOCK_ENDS, ZONE_LOST, START_UP_INHIBIT, CAUSE_OF_LOSS,    *)
(* MESSAGE_OF_LOSS).                                                       *)
(* Leaves out: door, bolt, machine and person (GuardLockingZone), and     *)
(* time: the block has no timer.                                           *)
(***************************************************************************)
EXTENDS CyclicBlock

CONSTANTS
    \* GLF-02: what unlocks a locked guard: "edge", "latched" or "level" of UnlockRequest
    UNLOCK_ON,
    \* GLF-03: the unlock signal ends "with_request", or "when_closed": not before the guard is closed
    UNLOCK_ENDS,
    \* GLF-04: S_SafetyActive FALSE while the guard is closed but unlocked: "error" or "tolerated"
    ZONE_LOST,
    \* GLF-08: lasts "until_reset", or "until_opened": a guard that is not locked at start-up ends it
    START_UP_INHIBIT,
    \* GLF-14: is gone when "what_was_lost" is back, the guard or the zone; or with "guard_and_zone", whatever
    \* was lost, or with the "zone" alone
    CAUSE_OF_LOSS,
    \* GLF-06: lasts "until_reset", or "until_safe": it goes when the zone is safe
    MESSAGE_OF_LOSS

ASSUME UNLOCK_ON \in {"edge", "latched", "level"}
ASSUME ZONE_LOST \in {"error", "tolerated"}
ASSUME START_UP_INHIBIT \in {"until_reset", "until_opened"}
ASSUME UNLOCK_ENDS \in {"with_request", "when_closed"}
ASSUME CAUSE_OF_LOSS \in {"what_was_lost", "guard_and_zone", "zone"}
ASSUME MESSAGE_OF_LOSS \in {"until_reset", "until_safe"}

VARIABLES
    \* UnlockRequest as the call before this one read it
    unlockRequestBefore,
    \* with UNLOCK_ON = "latched": the edge came while the guard is locked, and the request stands since
    requestPending,
    \* the guard was not locked at start-up, and the start-up inhibit is still to be removed
    startUpInhibit,
    \* with CAUSE_OF_LOSS = "what_was_lost": it was the guard or its lock, and no edge of Reset has come since
    guardLost

guardLocking == <<state, resetBefore, unlockRequestBefore, requestPending, startUpInhibit, guardLost>>

ResetErrors == {"ResetError1", "ResetError2", "ResetError3"}
GuardLockingErrors == ResetErrors \cup {"SafetyLost"}
Unlocked == {"GuardOpenAndUnlocked", "GuardClosedButUnlocked"}
AfterLoss == {"SafetyLost", "SafetyReturn", "ResetError2"}
GuardLockingStates ==
    {"Idle", "Init", "GuardClosedAndLocked", "WaitForReset", "WaitForOperator", "SafetyReturn"}
    \cup Unlocked \cup GuardLockingErrors

GuardLockingTypeOK ==
    /\ state \in GuardLockingStates
    /\ {resetBefore, unlockRequestBefore, requestPending, startUpInhibit, guardLost} \subseteq BOOLEAN
    \* What only one parameter needs is remembered only with it, and only where it counts
    /\ requestPending => UNLOCK_ON = "latched" /\ state = "GuardClosedAndLocked" /\ unlockRequestBefore
    /\ guardLost => CAUSE_OF_LOSS = "what_was_lost" /\ state \in AfterLoss
    /\ startUpInhibit =>
        /\ START_UP_INHIBIT = "until_reset"
        /\ state \notin {"Idle", "Init", "ResetError1", "GuardClosedAndLocked"}

\* GL-OUT-READY, GL-IN-DEFAULT, GL-SEQ-0: before the first call nothing is active and nothing is remembered
GuardLockingInit ==
    /\ state = "Idle" /\ resetBefore = FALSE
    /\ unlockRequestBefore = FALSE /\ requestPending = FALSE /\ startUpInhibit = FALSE /\ guardLost = FALSE

----------------------------------------------------------------------------
(* Outputs: the row of the state.                                          *)

\* GL-OUT-READY
Ready == state # "Idle"
\* GL-OUT-GUARDLOCKED
S_GuardLocked == state = "GuardClosedAndLocked"
\* GL-OUT-UNLOCKGUARD, GLF-03
S_UnlockGuard == state \in Unlocked
\* GL-OUT-ERROR, GLF-06
Error ==
    state \in GuardLockingErrors \cup (IF MESSAGE_OF_LOSS = "until_reset" THEN {"SafetyReturn"} ELSE {})
\* GL-OUT-DIAGCODE, GLF-01: codes of the project
DiagCode ==
    CASE state = "Idle" -> \h0000
      [] state = "GuardClosedAndLocked" -> \h8000
      [] state = "Init" -> \h8001
      [] state = "WaitForReset" -> \h8003
      [] state = "WaitForOperator" -> \h8011
      [] state = "GuardOpenAndUnlocked" -> \h8012
      [] state = "GuardClosedButUnlocked" -> \h8013
      [] state = "SafetyReturn" -> \h8014
      [] state = "ResetError1" -> \hC001
      [] state = "ResetError2" -> \hC002
      [] state = "ResetError3" -> \hC003
      [] state = "SafetyLost" -> \hC004
\* The outputs by their names
GuardLockingOutputs ==
    [Ready |-> Ready, S_GuardLocked |-> S_GuardLocked, S_UnlockGuard |-> S_UnlockGuard,
     Error |-> Error, DiagCode |-> DiagCode]

----------------------------------------------------------------------------
(* What a call sees.                                                       *)

\* GL-IN-GUARDMONITORING, GL-IN-GUARDLOCK
LOCAL Secured(i) == i.S_GuardMonitoring /\ i.S_GuardLock
\* GL-IN-UNLOCKREQUEST, GLF-02
RequestRises(i) == Rises(i.UnlockRequest, unlockRequestBefore)
LOCAL RequestStands(i) == i.UnlockRequest /\ (RequestRises(i) \/ requestPending)
Requested(i) ==
    CASE UNLOCK_ON = "edge" -> RequestRises(i)
      [] UNLOCK_ON = "latched" -> RequestStands(i)
      [] OTHER -> i.UnlockRequest
\* GL-IN-UNLOCKREQUEST, GL-IN-SAFETYACTIVE, GL-SEQ-3
UnlocksNow(i) == Requested(i) /\ i.S_SafetyActive
\* GL-OUT-ERROR, GLF-05: the guard or its lock is lost although nobody asked for it
LockLost(i) == ~Secured(i)
\* GL-IN-AUTORESET, GL-IN-STARTRESET, GLF-08
LOCAL RestartsAlone(i) == i.S_AutoReset /\ ~startUpInhibit

----------------------------------------------------------------------------
(* Not active.                                                             *)

\* GL-IN-ACTIVATE, GL-OUT-READY, GL-SEQ-0: first of all, in every state
Deactivate(i) == state # "Idle" /\ ~i.Activate /\ GoTo("Idle") /\ Did("Deactivate")
\* GL-IN-ACTIVATE, GL-SEQ-0
StayInactive(i) == state = "Idle" /\ ~i.Activate /\ GoTo("Idle") /\ Did("StayInactive")
\* GL-IN-ACTIVATE, GL-SEQ-1
StartUp(i) == At("Idle", i) /\ GoTo("Init") /\ Did("StartUp")

----------------------------------------------------------------------------
(* Start-up.                                                               *)

\* GLF-07: where it is waited for, a Reset that does not move is an error
LOCAL StaticAtStartUp(i) == ResetStatic(i) /\ ~i.S_StartReset
\* GL-IN-RESET, GLF-07
FindStaticResetAtStartUp(i) ==
    At("Init", i) /\ StaticAtStartUp(i) /\ GoTo("ResetError1") /\ Did("FindStaticResetAtStartUp")
\* GL-OUT-GUARDLOCKED, GLF-08
FindGuardNotLocked(i) ==
    /\ At("Init", i) /\ ~StaticAtStartUp(i) /\ ~Secured(i)
    /\ GoTo("WaitForOperator")
    /\ Did("FindGuardNotLocked")
\* GL-IN-STARTRESET, GL-IN-RESET, GL-SEQ-2
RemoveStartUpInhibit(i) ==
    /\ At("Init", i) /\ Secured(i) /\ ~i.S_StartReset /\ ResetRises(i)
    /\ GoTo("GuardClosedAndLocked")
    /\ Did("RemoveStartUpInhibit")
\* GL-IN-STARTRESET
StartWithoutInhibit(i) ==
    /\ At("Init", i) /\ Secured(i) /\ i.S_StartReset
    /\ GoTo("GuardClosedAndLocked")
    /\ Did("StartWithoutInhibit")
\* GL-IN-STARTRESET, GL-SEQ-1
AwaitStartReset(i) ==
    /\ At("Init", i) /\ ~StaticAtStartUp(i) /\ Secured(i) /\ ~i.S_StartReset /\ ~ResetRises(i)
    /\ GoTo("Init")
    /\ Did("AwaitStartReset")

----------------------------------------------------------------------------
(* Closed and locked: the one state that enables.                          *)

\* GL-OUT-GUARDLOCKED, GL-OUT-ERROR, GLF-05, GLF-12
LoseGuard(i) == At("GuardClosedAndLocked", i) /\ LockLost(i) /\ GoTo("SafetyLost") /\ Did("LoseGuard")
\* GL-IN-UNLOCKREQUEST, GL-IN-SAFETYACTIVE, GL-SEQ-3, GLF-02
Unlock(i) ==
    /\ At("GuardClosedAndLocked", i) /\ ~LockLost(i) /\ UnlocksNow(i)
    /\ GoTo("GuardClosedButUnlocked")
    /\ Did("Unlock")
\* GL-OUT-GUARDLOCKED, GL-SEQ-2: whatever the zone does
StayLocked(i) ==
    /\ At("GuardClosedAndLocked", i) /\ ~LockLost(i) /\ ~UnlocksNow(i)
    /\ GoTo("GuardClosedAndLocked")
    /\ Did("StayLocked")

----------------------------------------------------------------------------
(* Unlocked.                                                               *)

LOCAL ZoneIsLost(i) == ZONE_LOST = "error" /\ ~i.S_SafetyActive
\* GL-IN-SAFETYACTIVE, GL-OUT-ERROR, GLF-04: the guard can be opened, so the zone must stay safe
LoseZoneWhileClosed(i) ==
    At("GuardClosedButUnlocked", i) /\ ZoneIsLost(i) /\ GoTo("SafetyLost") /\ Did("LoseZoneWhileClosed")
\* GL-IN-UNLOCKREQUEST, GL-SEQ-3, GLF-03: the unlock signal ends in this call
Ends(i, closed) == ~i.UnlockRequest /\ IF UNLOCK_ENDS = "with_request" THEN TRUE ELSE closed
\* GL-IN-GUARDMONITORING, GL-SEQ-4
OpenGuard(i) ==
    /\ At("GuardClosedButUnlocked", i) /\ ~ZoneIsLost(i) /\ ~Ends(i, FALSE) /\ ~i.S_GuardMonitoring
    /\ GoTo("GuardOpenAndUnlocked")
    /\ Did("OpenGuard")
\* GL-IN-UNLOCKREQUEST, GL-SEQ-5
WithdrawRequest(i) ==
    /\ At("GuardClosedButUnlocked", i) /\ ~ZoneIsLost(i) /\ Ends(i, i.S_GuardMonitoring)
    /\ GoTo("WaitForOperator")
    /\ Did("WithdrawRequest")
\* GL-IN-UNLOCKREQUEST, GL-OUT-UNLOCKGUARD, GL-SEQ-3, GL-SEQ-4
StayUnlocked(i) ==
    /\ At("GuardClosedButUnlocked", i) /\ ~ZoneIsLost(i) /\ i.S_GuardMonitoring /\ i.UnlockRequest
    /\ GoTo("GuardClosedButUnlocked")
    /\ Did("StayUnlocked")

\* GLF-04, GLF-16: the guard was open in the call before; where a closed guard need not have a safe zone, one
\* that closes now has none to lose
ZoneIsLostInOpen(i) == ~(i.S_SafetyActive \/ (ZONE_LOST = "tolerated" /\ i.S_GuardMonitoring))
\* GL-IN-SAFETYACTIVE, GL-OUT-ERROR, GLF-09
LoseZoneWhileOpen(i) ==
    At("GuardOpenAndUnlocked", i) /\ ZoneIsLostInOpen(i) /\ GoTo("SafetyLost") /\ Did("LoseZoneWhileOpen")
\* GL-IN-UNLOCKREQUEST, GL-OUT-UNLOCKGUARD, GLF-03: with the request goes the signal, also while it is open
WithdrawWhileOpen(i) ==
    /\ At("GuardOpenAndUnlocked", i) /\ ~ZoneIsLostInOpen(i) /\ Ends(i, FALSE)
    /\ GoTo("WaitForOperator")
    /\ Did("WithdrawWhileOpen")
\* GL-IN-GUARDMONITORING, GL-SEQ-4
CloseGuard(i) ==
    /\ At("GuardOpenAndUnlocked", i) /\ ~ZoneIsLostInOpen(i) /\ ~Ends(i, FALSE) /\ i.S_GuardMonitoring
    /\ GoTo("GuardClosedButUnlocked")
    /\ Did("CloseGuard")
\* GL-OUT-UNLOCKGUARD, GL-SEQ-4, GLF-03
StayOpen(i) ==
    /\ At("GuardOpenAndUnlocked", i) /\ ~ZoneIsLostInOpen(i) /\ ~Ends(i, FALSE) /\ ~i.S_GuardMonitoring
    /\ GoTo("GuardOpenAndUnlocked")
    /\ Did("StayOpen")

----------------------------------------------------------------------------
(* Not unlocked by us, and not locked: the operator has to open or close.  *)

\* GLF-10: the zone is not safe, and the guard does not keep anybody out
ZoneOpenToIt(i) == ~i.S_SafetyActive /\ ~Secured(i)
\* GLF-03: where the signal does not end with the request, an open guard needs none
GoesOpen(i) == ~i.S_GuardMonitoring /\ IF UNLOCK_ENDS = "when_closed" THEN TRUE ELSE i.UnlockRequest
\* GLF-11: nothing is enabled here, so that the request needs no edge
GoesOnRequest(i) == i.S_GuardMonitoring /\ i.UnlockRequest /\ i.S_SafetyActive
\* GL-IN-SAFETYACTIVE, GL-OUT-ERROR, GLF-10
FindZoneUnprotected(i) ==
    At("WaitForOperator", i) /\ ZoneOpenToIt(i) /\ GoTo("SafetyLost") /\ Did("FindZoneUnprotected")
\* GL-OUT-UNLOCKGUARD, GL-SEQ-4, GLF-03
FollowOpenGuard(i) ==
    /\ At("WaitForOperator", i) /\ ~ZoneOpenToIt(i) /\ GoesOpen(i)
    /\ GoTo("GuardOpenAndUnlocked")
    /\ Did("FollowOpenGuard")
\* GL-IN-UNLOCKREQUEST, GL-IN-SAFETYACTIVE, GLF-11
UnlockOnRequest(i) ==
    /\ At("WaitForOperator", i) /\ ~ZoneOpenToIt(i) /\ GoesOnRequest(i)
    /\ GoTo("GuardOpenAndUnlocked")
    /\ Did("UnlockOnRequest")
\* GL-IN-AUTORESET, GL-IN-GUARDLOCK
SeeGuardLocked(i) ==
    /\ At("WaitForOperator", i) /\ ~GoesOnRequest(i) /\ Secured(i)
    /\ GoTo("WaitForReset")
    /\ Did("SeeGuardLocked")
\* GL-OUT-GUARDLOCKED, GL-SEQ-5
AwaitOperator(i) ==
    /\ At("WaitForOperator", i) /\ ~ZoneOpenToIt(i) /\ ~GoesOpen(i) /\ ~GoesOnRequest(i) /\ ~Secured(i)
    /\ GoTo("WaitForOperator")
    /\ Did("AwaitOperator")

----------------------------------------------------------------------------
(* Restart.                                                                *)

LOCAL StaticAtRestart(i) == ResetStatic(i) /\ ~RestartsAlone(i)
\* GLF-12: losing the guard comes before the reset
LostAgain(i) == ~Secured(i)
\* GL-IN-RESET, GLF-07
FindStaticResetAtRestart(i) ==
    At("WaitForReset", i) /\ StaticAtRestart(i) /\ GoTo("ResetError3") /\ Did("FindStaticResetAtRestart")
\* GL-OUT-GUARDLOCKED, GLF-12
LoseGuardAgain(i) ==
    /\ At("WaitForReset", i) /\ ~StaticAtRestart(i) /\ LostAgain(i)
    /\ GoTo("WaitForOperator")
    /\ Did("LoseGuardAgain")
\* GL-IN-AUTORESET, GL-IN-RESET, GL-OUT-GUARDLOCKED
RemoveRestartInhibit(i) ==
    /\ At("WaitForReset", i) /\ ~LostAgain(i) /\ ~RestartsAlone(i) /\ ResetRises(i)
    /\ GoTo("GuardClosedAndLocked")
    /\ Did("RemoveRestartInhibit")
\* GL-IN-AUTORESET
RestartWithoutInhibit(i) ==
    /\ At("WaitForReset", i) /\ ~LostAgain(i) /\ RestartsAlone(i)
    /\ GoTo("GuardClosedAndLocked")
    /\ Did("RestartWithoutInhibit")
\* GL-IN-AUTORESET, GL-OUT-GUARDLOCKED
AwaitReset(i) ==
    /\ At("WaitForReset", i) /\ ~StaticAtRestart(i) /\ ~LostAgain(i) /\ ~RestartsAlone(i) /\ ~ResetRises(i)
    /\ GoTo("WaitForReset")
    /\ Did("AwaitReset")

----------------------------------------------------------------------------
(* Errors.                                                                 *)

\* GL-IN-SAFETYACTIVE, GLF-06
SeeZoneSafe(i) == At("SafetyLost", i) /\ i.S_SafetyActive /\ GoTo("SafetyReturn") /\ Did("SeeZoneSafe")
\* GL-IN-SAFETYACTIVE, GL-OUT-ERROR, GLF-09
StaySafetyLost(i) == At("SafetyLost", i) /\ ~i.S_SafetyActive /\ GoTo("SafetyLost") /\ Did("StaySafetyLost")

\* GLF-14: the guard that was lost must be back
CauseGone(i) == CAUSE_OF_LOSS = "guard_and_zone" \/ guardLost => Secured(i)
\* GL-IN-AUTORESET, GLF-13, GLF-14: an edge of Reset is needed, whatever S_AutoReset says
Acknowledged(i) == ResetRises(i) /\ CauseGone(i)
\* GL-IN-RESET, GLF-07
FindStaticResetAfterError(i) ==
    At("SafetyReturn", i) /\ ResetStatic(i) /\ GoTo("ResetError2") /\ Did("FindStaticResetAfterError")
\* GL-IN-SAFETYACTIVE, GL-OUT-ERROR
LoseZoneAgain(i) ==
    /\ At("SafetyReturn", i) /\ ~ResetStatic(i) /\ ~i.S_SafetyActive
    /\ GoTo("SafetyLost")
    /\ Did("LoseZoneAgain")
\* GL-IN-RESET, GLF-06, GLF-13, GLF-14
AcknowledgeError(i) ==
    /\ At("SafetyReturn", i) /\ ~ResetStatic(i) /\ i.S_SafetyActive /\ Acknowledged(i)
    /\ GoTo("WaitForOperator")
    /\ Did("AcknowledgeError")
\* GL-IN-RESET, GL-OUT-GUARDLOCKED
AwaitAcknowledgment(i) ==
    /\ At("SafetyReturn", i) /\ ~ResetStatic(i) /\ i.S_SafetyActive /\ ~Acknowledged(i)
    /\ GoTo("SafetyReturn")
    /\ Did("AwaitAcknowledgment")

LOCAL ReturnsTo ==
    CASE state = "ResetError1" -> "Init" [] state = "ResetError2" -> "SafetyReturn" [] OTHER -> "WaitForReset"
\* GL-IN-RESET, GLF-07: nothing is reset; a new edge is needed
ReleaseReset(i) ==
    state \in ResetErrors /\ i.Activate /\ ~i.Reset /\ GoTo(ReturnsTo) /\ Did("ReleaseReset")
\* GL-IN-RESET, GL-OUT-ERROR, GLF-07
StayInResetError(i) ==
    state \in ResetErrors /\ i.Activate /\ i.Reset /\ GoTo(state) /\ Did("StayInResetError")

----------------------------------------------------------------------------
\* GL-IN-RESET, GL-IN-UNLOCKREQUEST, GLF-02, GLF-08, GLF-14: what the call leaves for the next one
Remembers(i) ==
    /\ RemembersReset(i)
    /\ unlockRequestBefore' = i.UnlockRequest
    /\ requestPending' = (UNLOCK_ON = "latched" /\ state' = "GuardClosedAndLocked" /\ RequestStands(i))
    /\ startUpInhibit' =
       (CASE state' \in {"Idle", "GuardClosedAndLocked"} -> FALSE
          [] state = "Init" /\ state' = "WaitForOperator" ->
                ~i.S_StartReset /\ START_UP_INHIBIT = "until_reset"
          [] OTHER -> startUpInhibit)
    /\ guardLost' =
       (CASE state' \notin AfterLoss -> FALSE
          [] state = "GuardClosedAndLocked" -> CAUSE_OF_LOSS = "what_was_lost"
          [] OTHER -> guardLost)

\* GL-SEQ-NOTE: one transition a call; grouped by the states in which the steps can fire
GuardLockingStep(i) ==
    \/ Deactivate(i)
    \/ state = "Idle" /\ (StayInactive(i) \/ StartUp(i))
    \/ state = "Init" /\ (\/ FindStaticResetAtStartUp(i) \/ FindGuardNotLocked(i)
                          \/ RemoveStartUpInhibit(i) \/ StartWithoutInhibit(i) \/ AwaitStartReset(i))
    \/ state = "GuardClosedAndLocked" /\ (LoseGuard(i) \/ Unlock(i) \/ StayLocked(i))
    \/ state = "GuardClosedButUnlocked" /\ (\/ LoseZoneWhileClosed(i) \/ OpenGuard(i)
                                            \/ WithdrawRequest(i) \/ StayUnlocked(i))
    \/ state = "GuardOpenAndUnlocked" /\ (\/ LoseZoneWhileOpen(i) \/ WithdrawWhileOpen(i)
                                          \/ CloseGuard(i) \/ StayOpen(i))
    \/ state = "WaitForOperator" /\ (\/ FindZoneUnprotected(i) \/ FollowOpenGuard(i)
                                     \/ UnlockOnRequest(i) \/ SeeGuardLocked(i) \/ AwaitOperator(i))
    \/ state = "WaitForReset" /\ (\/ FindStaticResetAtRestart(i) \/ LoseGuardAgain(i)
                                  \/ RemoveRestartInhibit(i) \/ RestartWithoutInhibit(i) \/ AwaitReset(i))
    \/ state = "SafetyLost" /\ (SeeZoneSafe(i) \/ StaySafetyLost(i))
    \/ state = "SafetyReturn" /\ (\/ FindStaticResetAfterError(i) \/ LoseZoneAgain(i)
                                  \/ AcknowledgeError(i) \/ AwaitAcknowledgment(i))
    \/ ReleaseReset(i) \/ StayInResetError(i)

\* One call of the block
GuardLockingCall(i) == GuardLockingStep(i) /\ Remembers(i)

----------------------------------------------------------------------------
(* What the block promises in every state.                                 *)

\* GL-OUT-GUARDLOCKED, GL-OUT-UNLOCKGUARD: enable and unlock signal exclude each other
NeverEnabledAndUnlocked == ~(S_GuardLocked /\ S_UnlockGuard)
\* GL-OUT-READY, GL-OUT-GUARDLOCKED, GL-OUT-ERROR, GL-SEQ-0: nothing is enabled or unlocked while inactive or
\* in error
NothingWhileInactiveOrInError == (~Ready \/ Error) => ~S_GuardLocked /\ ~S_UnlockGuard
\* GL-OUT-READY, GL-OUT-ERROR: not active is not an error
InactiveIsNoError == ~Ready => ~Error /\ DiagCode = 0
\* GL-OUT-GUARDLOCKED, GL-OUT-ERROR, GL-OUT-DIAGCODE, GLF-01: the code tells the row
RowOfDiagCode ==
    /\ Ready = (DiagCode # 0)
    /\ S_GuardLocked = (DiagCode = \h8000)
    /\ S_UnlockGuard = (DiagCode \in {\h8012, \h8013})
    /\ Error = (DiagCode >= \hC000 \/ (DiagCode = \h8014 /\ MESSAGE_OF_LOSS = "until_reset"))
=============================================================================
