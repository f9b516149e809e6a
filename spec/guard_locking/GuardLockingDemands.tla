------------------------ MODULE GuardLockingDemands -------------------------
(***************************************************************************)
(* What the sentences of the page demand of the block, seen from outside:  *)
(* a second reading beside demands.toml, written from the clauses.  Any of *)
(* the 256 inputs may come in every call.  The observer reads inputs and   *)
(* printed outputs alone, never the state of the block.                    *)
(* What must never be is judged in the very call, as a call reads its      *)
(* inputs at once; what must come has LATENCY calls for each step that a   *)
(* block may need.  demands.toml asks less of a user's program: S_AutoReset*)
(* must have been TRUE since the activation for a restart by itself, and   *)
(* the loss of a guard may be an error where it was not enabled too.       *)
(* Leaves out door, bolt, machine and person (GuardLockingZone).           *)
(***************************************************************************)
EXTENDS GuardLockingOpen

CONSTANT LATENCY    \* calls that a block may take for a step
ASSUME LATENCY \in Nat

VARIABLES
    lastReset,      \* Reset in the call before
    lastRequest,    \* UnlockRequest in the call before
    freed,          \* since the activation an edge of Reset came, or S_StartReset was TRUE
    started,        \* something was enabled since the activation
    opened,         \* since the guard was enabled it was not closed and locked
    released,       \* since it is again, an edge of Reset came, or S_AutoReset was TRUE
    own,            \* the error that is shown came without Reset
    uninhibited,    \* S_StartReset was TRUE in every call since the activation
    calm,           \* so was everything that asks for the safety function away, and Reset
    troubled,       \* an error was shown since the last enable
    waiting,        \* calls for which an inhibit alone can have kept the enable back
    gone,           \* calls for which an error was shown that has no cause any more
    late            \* for each answer that must come: the calls for which it has not

watched ==
    <<lastReset, lastRequest, freed, started, opened, released, own, uninhibited, calm, troubled, waiting,
      gone, late>>
DemandsView == <<View, watched>>

Answers == {"ready", "unlock", "lock", "start", "restart", "removed", "mended"}
LOCAL AtMost(n, limit) == IF n > limit THEN limit ELSE n

DemandsInit ==
    /\ OpenInit
    /\ lastReset = FALSE /\ lastRequest = FALSE /\ freed = FALSE /\ started = FALSE /\ opened = FALSE
    /\ released = FALSE /\ own = FALSE /\ uninhibited = FALSE /\ calm = FALSE /\ troubled = FALSE
    /\ waiting = 0 /\ gone = 0 /\ late = [answer \in Answers |-> 0]

LOCAL Secures(i) == i.Activate /\ i.S_GuardMonitoring /\ i.S_GuardLock
LOCAL Rising(i) == i.Reset /\ ~lastReset
\* Nothing asks for the safety function, and nobody resets
LOCAL Quiet(i) == Secures(i) /\ i.S_SafetyActive /\ ~i.UnlockRequest /\ ~i.Reset
\* What is asked for in this call, and stays due until it has come
LOCAL Due(i) == [
    ready |-> i.Activate,
    unlock |-> /\ Secures(i) /\ i.S_SafetyActive /\ i.UnlockRequest
               /\ late["unlock"] > 0 \/ (S_GuardLocked /\ ~lastRequest),
    lock |-> i.S_GuardMonitoring /\ ~i.UnlockRequest,
    start |-> calm',
    restart |-> Quiet(i) /\ i.S_AutoReset /\ (started \/ uninhibited') /\ ~troubled' /\ ~S_UnlockGuard',
    removed |-> /\ Secures(i) /\ i.S_SafetyActive /\ ~i.UnlockRequest
                /\ late["removed"] > 0 \/ (Rising(i) /\ waiting > LATENCY),
    mended |-> /\ Secures(i) /\ i.S_SafetyActive
               /\ late["mended"] > 0 \/ (Rising(i) /\ gone > LATENCY)]
LOCAL Came == [
    ready |-> Ready', unlock |-> S_UnlockGuard', lock |-> ~S_UnlockGuard', start |-> S_GuardLocked',
    restart |-> S_GuardLocked', removed |-> S_GuardLocked', mended |-> ~Error']

Watch(i) ==
    /\ lastReset' = i.Reset /\ lastRequest' = i.UnlockRequest
    /\ freed' = (i.Activate /\ (freed \/ Rising(i) \/ i.S_StartReset))
    /\ started' = (i.Activate /\ (started \/ S_GuardLocked'))
    /\ opened' = (i.Activate /\ (~Secures(i) \/ (opened /\ ~S_GuardLocked')))
    /\ released' = (Secures(i) /\ (released \/ Rising(i) \/ i.S_AutoReset))
    /\ own' = (Error' /\ IF Error THEN own ELSE ~i.Reset)
    /\ uninhibited' = (i.Activate /\ i.S_StartReset /\ (uninhibited \/ ~Ready))
    /\ calm' = (Quiet(i) /\ i.S_StartReset /\ (calm \/ ~Ready))
    /\ troubled' = (i.Activate /\ (Error' \/ (troubled /\ ~S_GuardLocked')))
    /\ waiting' =
        IF Quiet(i) /\ Ready' /\ ~Error' /\ ~S_UnlockGuard' /\ ~S_GuardLocked'
        THEN AtMost(waiting + 1, LATENCY + 1) ELSE 0
    /\ gone' = IF Quiet(i) /\ Error' THEN AtMost(gone + 1, LATENCY + 1) ELSE 0
    /\ \E due \in {Due(i)}, came \in {Came} :
        late' = [answer \in Answers |-> IF due[answer] /\ ~came[answer] THEN late[answer] + 1 ELSE 0]

DemandsNext ==
    \E n \in Inputs : \E i \in {Alphabet[n]} :
        GuardLockingCall(i) /\ in' = n /\ beat' = ~beat /\ UNCHANGED observer /\ Watch(i)
DemandsSpec == DemandsInit /\ [][DemandsNext]_<<View, observer, watched, step, in, beat>>

----------------------------------------------------------------------------
(* Active and not.                                                         *)

\* GL-IN-ACTIVATE, GL-OUT-READY, GL-OUT-GUARDLOCKED, GL-SEQ-0
InactiveShowsNothing ==
    [][~Scanned.Activate => ~Ready' /\ ~S_GuardLocked' /\ ~S_UnlockGuard' /\ ~Error']_beat
\* GL-IN-ACTIVATE, GL-OUT-READY, GL-SEQ-1
ActiveIsReady == [][late'["ready"] <= LATENCY]_beat

----------------------------------------------------------------------------
(* The enable.                                                             *)

\* GL-DOC-2, GL-IN-GUARDMONITORING, GL-OUT-GUARDLOCKED, GL-SEQ-4
EnableNeedsClosedGuard == [][~Scanned.S_GuardMonitoring => ~S_GuardLocked']_beat
\* GL-DOC-2, GL-IN-GUARDLOCK, GL-OUT-GUARDLOCKED, GL-SEQ-4, GL-SEQ-5
EnableNeedsLockedGuard == [][~Scanned.S_GuardLock => ~S_GuardLocked']_beat
\* GL-OUT-ERROR, GL-OUT-GUARDLOCKED
ErrorTakesBothSignals == [][Error' => ~S_GuardLocked' /\ ~S_UnlockGuard']_beat
\* GL-DOC-2, GL-IN-STARTRESET, GL-IN-RESET, GL-OUT-GUARDLOCKED, GL-SEQ-INHIBITS, GL-SEQ-1
StartInhibitGoesByHand == [][Enables /\ ~started => freed']_beat
\* GL-DOC-2, GL-IN-AUTORESET, GL-IN-RESET, GL-OUT-GUARDLOCKED, GL-SEQ-INHIBITS
RestartInhibitGoesByHand == [][Enables /\ started /\ opened => released']_beat
\* GL-IN-SAFETYACTIVE, GL-OUT-GUARDLOCKED, GL-SEQ-2, GL-SEQ-3
EnableLasts ==
    [][S_GuardLocked /\ ~S_GuardLocked' =>
        ~Scanned.Activate \/ ~Secure \/ (Scanned.UnlockRequest /\ Scanned.S_SafetyActive)]_beat
\* GL-IN-STARTRESET, GL-OUT-GUARDLOCKED
StartsByItself == [][late'["start"] <= LATENCY]_beat
\* GL-IN-AUTORESET, GL-OUT-GUARDLOCKED
RestartsByItself == [][late'["restart"] <= 2 * LATENCY]_beat
\* GL-IN-STARTRESET, GL-IN-AUTORESET, GL-IN-RESET, GL-IN-EDGE, GL-WARN-2, GL-OUT-GUARDLOCKED, GL-SEQ-2
ResetRemovesInhibit == [][late'["removed"] <= LATENCY]_beat

----------------------------------------------------------------------------
(* The unlock signal.                                                      *)

\* GL-IN-UNLOCKREQUEST, GL-OUT-UNLOCKGUARD, GL-SEQ-3
UnlockIsRequested == [][Unlocks => Scanned.UnlockRequest \/ ~Scanned.S_GuardMonitoring]_beat
\* GL-IN-SAFETYACTIVE, GL-OUT-UNLOCKGUARD, GL-SEQ-3
UnlockWaitsForSafeZone == [][Unlocks => Scanned.S_SafetyActive \/ ~Scanned.S_GuardMonitoring]_beat
\* GL-IN-UNLOCKREQUEST, GL-IN-SAFETYACTIVE, GL-OUT-UNLOCKGUARD, GL-SEQ-3
RequestIsServed == [][late'["unlock"] <= LATENCY]_beat
\* GL-OUT-UNLOCKGUARD, GL-SEQ-3
UnlockTakesEnable == [][~(S_GuardLocked' /\ S_UnlockGuard')]_beat
\* GL-IN-UNLOCKREQUEST, GL-OUT-UNLOCKGUARD, GL-SEQ-3, GL-SEQ-4
UnlockLastsWithRequest ==
    [][S_UnlockGuard /\ ~S_UnlockGuard' =>
        ~Scanned.UnlockRequest \/ ~Scanned.Activate \/ ~Scanned.S_SafetyActive \/ Error']_beat
\* GL-IN-UNLOCKREQUEST, GL-OUT-UNLOCKGUARD, GL-SEQ-5
UnlockGoesWithRequest == [][late'["lock"] <= LATENCY]_beat

----------------------------------------------------------------------------
(* Errors.                                                                 *)

\* GL-IN-RESET, GL-IN-EDGE
ErrorGoesByHand ==
    [][Error /\ ~Error' /\ own => ~Scanned.Activate \/ (Scanned.Reset /\ ~lastReset)]_beat
\* GL-IN-RESET
ResetEndsError == [][late'["mended"] <= LATENCY]_beat
\* GL-OUT-ERROR
ErrorNeedsReason ==
    [][~Error /\ Error' =>
        \/ S_GuardLocked /\ ~Secure
        \/ ~Scanned.S_SafetyActive /\ ~(S_GuardLocked /\ S_GuardLocked')
        \/ Scanned.Reset /\ (lastReset \/ ~Ready)
        \/ Scanned.S_GuardLock /\ ~Scanned.S_GuardMonitoring]_beat
=============================================================================
