------------------------ MODULE GuardLockingOpen -------------------------
(***************************************************************************)
(* SF_GuardLocking alone, with any of its 256 inputs in every call: the    *)
(* environment `arbitrary`, S_StartReset and S_AutoReset included, and the *)
(* graph that implementations of target sf_guard_locking are compared      *)
(* with.                                                                   *)
(* Leaves out door, bolt, machine and person (GuardLockingZone).           *)
(***************************************************************************)
EXTENDS Sequences, TLC, GuardLocking

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges

VARIABLES
    in,            \* the number of the last call's input; hidden by VIEW
    beat,          \* changes in every call, so that no call escapes an action property; hidden by VIEW
    \* What an observer of the wires alone remembers; nothing of the block reads it:
    resetSeen,     \* Reset in the call before
    requestSeen,   \* UnlockRequest in the call before
    asked,         \* UnlockRequest rose while the guard is locked, and is TRUE since
    starting,      \* since Activate nothing was enabled, and no call of a start-up without inhibit was seen
    lost,          \* the guard, its lock or the zone was lost, and no edge of Reset has acknowledged it
    unguarded      \* the guard was lost while enabled, and none has come with the guard closed and locked

observer == <<resetSeen, requestSeen, asked, starting, lost, unguarded>>
View == guardLocking
ObservedView == <<View, observer>>

----------------------------------------------------------------------------
Bit(n, k) == (n \div (2^k)) % 2 = 1
Inputs == 0..255
Alphabet == [n \in Inputs |->
    [Activate |-> Bit(n, 0), S_GuardMonitoring |-> Bit(n, 1), S_SafetyActive |-> Bit(n, 2),
     S_GuardLock |-> Bit(n, 3), UnlockRequest |-> Bit(n, 4), S_StartReset |-> Bit(n, 5),
     S_AutoReset |-> Bit(n, 6), Reset |-> Bit(n, 7)]]

Wire(i) == i @@ [dt |-> 1]
Row == GuardLockingOutputs

ASSUME PRINT_GRAPH => \A n \in Inputs : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit ==
    /\ GuardLockingInit /\ step = "" /\ in = 0 /\ beat = FALSE
    /\ resetSeen = FALSE /\ requestSeen = FALSE /\ asked = FALSE
    /\ starting = FALSE /\ lost = FALSE /\ unguarded = FALSE
    /\ PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>))

\* GL-IN-RESET, GL-IN-UNLOCKREQUEST: edges as they stand on the wires
ResetEdge(i) == i.Reset /\ ~resetSeen
RequestEdge(i) == i.UnlockRequest /\ ~requestSeen

\* The observer reads the inputs of a call, and the outputs before it and after it
Observe(i) ==
    /\ resetSeen' = i.Reset /\ requestSeen' = i.UnlockRequest
    /\ asked' = (S_GuardLocked' /\ i.UnlockRequest /\ (RequestEdge(i) \/ asked))
    /\ starting' =
        (Ready' /\ ~S_GuardLocked' /\ (~Ready \/ (starting /\ ~(DiagCode = \h8001 /\ i.S_StartReset))))
    /\ unguarded' =
        (/\ Ready'
         /\ (S_GuardLocked /\ DiagCode' = \hC004) \/ (unguarded /\ ~(/\ DiagCode = \h8014 /\ i.S_SafetyActive
                                                                  /\ i.S_GuardMonitoring /\ i.S_GuardLock
                                                                  /\ ResetEdge(i))))
    /\ lost' =
        (/\ Ready'
         /\ DiagCode' = \hC004 \/ (lost /\ ~(DiagCode = \h8014 /\ i.S_SafetyActive /\ ResetEdge(i))))

OpenNext ==
    \E n \in Inputs : \E i \in {Alphabet[n]} :
        /\ GuardLockingCall(i)
        /\ in' = n /\ beat' = ~beat
        /\ IF PRINT_GRAPH THEN UNCHANGED observer ELSE Observe(i)

OpenSpec == OpenInit /\ [][OpenNext]_<<View, observer, step, in, beat>>

----------------------------------------------------------------------------
(* Action properties, judged in every call; Scanned is that call's input.  *)
Scanned == Alphabet[in']
\* For a reader of a trace: what a call found on the wires and what stands on them after it
Wires == Alphabet[in] @@ GuardLockingOutputs
Secure == Scanned.S_GuardMonitoring /\ Scanned.S_GuardLock
Enables == ~S_GuardLocked /\ S_GuardLocked'
Unlocks == ~S_UnlockGuard /\ S_UnlockGuard'
\* GL-IN-STARTRESET, GLF-08: the start-up inhibit is still to be removed, after a start-up that found the
\* guard not locked too
StartUpInhibited == starting /\ START_UP_INHIBIT = "until_reset"

\* GL-IN-ACTIVATE, GL-OUT-READY, GL-SEQ-0: in the call without Activate every output is FALSE, and only then
\* is Ready
InactiveAtOnce ==
    [][/\ Ready' = Scanned.Activate
       /\ ~Scanned.Activate => ~S_GuardLocked' /\ ~S_UnlockGuard' /\ ~Error' /\ DiagCode' = 0]_beat

\* GL-OUT-GUARDLOCKED, GL-SEQ-4: the enable needs Activate, a closed and a locked guard in this very call
EnableNeedsSecuredGuard == [][S_GuardLocked' => Scanned.Activate /\ Secure]_beat

\* GL-IN-STARTRESET, GL-IN-AUTORESET, GL-SEQ-1, GL-SEQ-2: no enable without an edge of Reset, unless the input
\* of this inhibit allows it
NoAutomaticRestart ==
    [][Enables =>
        \/ ResetEdge(Scanned)
        \/ IF DiagCode = \h8001 THEN Scanned.S_StartReset ELSE Scanned.S_AutoReset]_beat

\* GL-IN-STARTRESET, GLF-08: a start-up inhibit ends by an edge of Reset, also where the restart inhibit is
\* off
StartUpInhibitNeedsReset ==
    [][Enables /\ starting => ResetEdge(Scanned) \/ (DiagCode = \h8001 /\ Scanned.S_StartReset)]_beat

\* GL-IN-RESET, GL-OUT-ERROR, GLF-13: after a loss nothing is enabled before an edge of Reset, whatever
\* S_AutoReset says
LossNeedsReset == [][S_GuardLocked' => ~lost']_beat

\* GL-IN-RESET, GLF-07: a Reset that does not move takes nothing away, neither an inhibit nor an error
StaticResetNeverResets ==
    [][Scanned.Reset /\ resetSeen =>
        /\ Enables => IF DiagCode = \h8001 THEN Scanned.S_StartReset ELSE Scanned.S_AutoReset
        /\ DiagCode \in {\h8014, \hC001, \hC002, \hC003} => DiagCode' \in {DiagCode, \hC002, \hC004, 0}]_beat

\* GL-IN-RESET, GL-IN-STARTRESET, GL-IN-AUTORESET, GLF-07, GLF-08: where an edge of Reset is waited for
EdgeAwaited ==
    CASE DiagCode = \h8001 -> ~Scanned.S_StartReset
      [] DiagCode = \h8003 -> ~Scanned.S_AutoReset \/ StartUpInhibited
      [] OTHER -> DiagCode = \h8014

\* GL-IN-RESET, GLF-07: where an edge is waited for, a Reset that does not move is an error in that call
StaticResetIsFound ==
    [][Scanned.Activate /\ Scanned.Reset /\ resetSeen =>
        /\ DiagCode = \h8001 /\ EdgeAwaited => DiagCode' = \hC001
        /\ DiagCode = \h8014 => DiagCode' = \hC002
        /\ DiagCode = \h8003 /\ EdgeAwaited => DiagCode' = \hC003]_beat

\* GL-IN-SAFETYACTIVE, GL-SEQ-3: the guard is unlocked only with the zone safe, or when it is open already
UnlockNeedsSafeZone == [][Unlocks => Scanned.S_SafetyActive \/ ~Scanned.S_GuardMonitoring]_beat

\* GL-IN-SAFETYACTIVE, GL-OUT-UNLOCKGUARD, GLF-04, GLF-10: and it is unlocked no longer than the zone is safe
UnlockedOnlyWhileSafe == [][S_UnlockGuard' => Scanned.S_SafetyActive]_beat

\* GL-IN-UNLOCKREQUEST, GL-OUT-UNLOCKGUARD, GL-SEQ-3, GLF-03: and no longer than it is requested
UnlockedOnlyWhileRequested == [][S_UnlockGuard' => Scanned.UnlockRequest]_beat

\* GL-IN-UNLOCKREQUEST, GL-SEQ-3: a guard that is locked and closed is unlocked only on request
UnlockNeedsRequest == [][Unlocks => Scanned.UnlockRequest \/ ~Scanned.S_GuardMonitoring]_beat

\* GL-IN-UNLOCKREQUEST, GLF-02: the request that unlocks a locked guard comes while it is locked
UnlockNeedsRequestWhileLocked == [][S_GuardLocked /\ S_UnlockGuard' => RequestEdge(Scanned) \/ asked]_beat

\* GL-IN-UNLOCKREQUEST, GLF-02: and it comes in the very call that unlocks
UnlockNeedsRequestNow == [][S_GuardLocked /\ S_UnlockGuard' => RequestEdge(Scanned)]_beat

\* GL-IN-UNLOCKREQUEST, GLF-02: a request that stands unlocks as soon as the zone is safe
HeldRequestUnlocks ==
    [][S_GuardLocked /\ Scanned.Activate /\ Secure /\ Scanned.UnlockRequest /\ Scanned.S_SafetyActive =>
        S_UnlockGuard']_beat

\* GL-IN-UNLOCKREQUEST, GL-SEQ-3, GLF-02: a request that came while the guard is locked, and stands, unlocks
\* as soon as the zone is safe
LatchedRequestUnlocks ==
    [][(/\ S_GuardLocked /\ asked
        /\ Scanned.Activate /\ Secure /\ Scanned.UnlockRequest /\ Scanned.S_SafetyActive) =>
            S_UnlockGuard']_beat

\* GL-IN-UNLOCKREQUEST, GL-SEQ-3: a request that comes with the zone safe unlocks at once, and withdraws the
\* enable
RequestUnlocksAtOnce ==
    [][S_GuardLocked /\ Scanned.Activate /\ Secure /\ RequestEdge(Scanned) /\ Scanned.S_SafetyActive =>
        S_UnlockGuard' /\ ~S_GuardLocked']_beat

\* GL-OUT-UNLOCKGUARD, GL-SEQ-3, GL-SEQ-4: as long as the request stands and the zone is safe the guard stays
\* unlocked
StaysUnlockedWhileRequested ==
    [][S_UnlockGuard /\ Scanned.Activate /\ Scanned.UnlockRequest /\ Scanned.S_SafetyActive =>
        S_UnlockGuard']_beat

\* GL-OUT-UNLOCKGUARD, GL-SEQ-4, GLF-03: the bolt is not thrown while the guard is open
StaysUnlockedWhileOpen ==
    [][S_UnlockGuard /\ Scanned.Activate /\ ~Scanned.S_GuardMonitoring /\ Scanned.S_SafetyActive =>
        S_UnlockGuard']_beat

\* GL-IN-UNLOCKREQUEST, GL-SEQ-5: without a request a closed guard is locked again
LocksWithoutRequest ==
    [][DiagCode = \h8013 /\ Scanned.S_GuardMonitoring /\ ~Scanned.UnlockRequest => ~S_UnlockGuard']_beat

\* GL-SEQ-2: while the guard is locked the zone need not be safe
LockedWhateverTheZone ==
    [][S_GuardLocked /\ Scanned.Activate /\ Secure /\ ~Scanned.S_SafetyActive => S_GuardLocked']_beat

\* GL-OUT-GUARDLOCKED, GL-SEQ-2: without a request a locked guard stays enabled
StaysLocked ==
    [][S_GuardLocked /\ Scanned.Activate /\ Secure /\ ~Scanned.UnlockRequest => S_GuardLocked']_beat

\* GL-OUT-GUARDLOCKED, GL-OUT-ERROR, GLF-05: a locked guard that is lost is an error in that call, whatever is
\* requested
LossIsAnError ==
    [][S_GuardLocked /\ Scanned.Activate /\ ~Secure => Error' /\ ~S_GuardLocked' /\ ~S_UnlockGuard']_beat

\* GL-OUT-ERROR, GL-OUT-UNLOCKGUARD, GLF-09, GLF-16: no error takes the unlock signal away while the zone is
\* safe
NoErrorLocksSafeZone == [][S_UnlockGuard /\ Error' => ~Scanned.S_SafetyActive]_beat

\* GL-OUT-ERROR, GL-IN-SAFETYACTIVE, GLF-04, GLF-05, GLF-10: what is a loss in each state
LossSeen ==
    CASE DiagCode = \h8000 -> ~Secure
      [] DiagCode = \h8013 -> ~Scanned.S_SafetyActive /\ ZONE_LOST = "error"
      [] DiagCode = \h8012 -> ~Scanned.S_SafetyActive /\ (ZONE_LOST = "error" \/ ~Scanned.S_GuardMonitoring)
      [] DiagCode = \h8011 -> ~Scanned.S_SafetyActive /\ ~Secure
      [] DiagCode = \h8014 -> ~Scanned.S_SafetyActive
      [] OTHER -> FALSE
\* GL-OUT-ERROR, GL-IN-SAFETYACTIVE, GLF-07, GLF-09, GLF-10: an error has a cause in that very call
ErrorNeedsCause ==
    [][~Error /\ Error' =>
        IF DiagCode' = \hC004 THEN LossSeen ELSE Scanned.Reset /\ resetSeen /\ EdgeAwaited]_beat

\* GL-IN-RESET, GL-OUT-ERROR, GLF-06, GLF-07: an error ends with its cause, and leads back to where it was
\* found
ErrorEndsWithCause ==
    [][Error /\ ~Error' =>
        \/ ~Scanned.Activate
        \/ DiagCode = \hC004 /\ Scanned.S_SafetyActive /\ DiagCode' = \h8014
        \/ DiagCode = \h8014 /\ Scanned.S_SafetyActive /\ ResetEdge(Scanned) /\ DiagCode' = \h8011
        \/ /\ ~Scanned.Reset
           /\ <<DiagCode, DiagCode'>> \in {<<\hC001, \h8001>>, <<\hC002, \h8014>>, <<\hC003, \h8003>>}]_beat

\* GL-IN-RESET, GLF-06: where the message of an error goes out only with the edge that ends the error
MessageUntilReset ==
    [][Error /\ ~Error' /\ Scanned.Activate =>
        CASE DiagCode = \h8014 -> ResetEdge(Scanned)
          [] DiagCode = \hC004 -> FALSE
          [] OTHER -> ~Scanned.Reset]_beat

\* GL-IN-RESET, GL-OUT-ERROR, GLF-14: after the loss of a locked guard nothing is enabled before an edge of
\* Reset that found it closed and locked
LossNeedsGuardBack == [][S_GuardLocked' => ~unguarded']_beat

\* GL-IN-RESET, GL-OUT-ERROR, GLF-14: after a loss of the zone alone an edge of Reset needs no guard
LossOfZoneNeedsNoGuard ==
    [][/\ DiagCode = \h8014 /\ ~unguarded
       /\ Scanned.Activate /\ ResetEdge(Scanned) /\ Scanned.S_SafetyActive
       => DiagCode' = \h8011]_beat

\* GL-OUT-DIAGCODE, GL-IN-GUARDMONITORING, GLF-11: the code of an unlocked guard tells whether it is open
CodeTellsTheGuard ==
    [][/\ DiagCode' = \h8013 => Scanned.S_GuardMonitoring
       /\ DiagCode' = \h8012 => ~Scanned.S_GuardMonitoring \/ DiagCode = \h8011]_beat

\* GL-SEQ-NOTE, GLF-01: one transition a call, and only these
Transitions == {
    <<\h0000, \h8001>>, <<\h8001, \hC001>>, <<\h8001, \h8011>>, <<\h8001, \h8000>>,
    <<\h8000, \hC004>>, <<\h8000, \h8013>>, <<\h8013, \hC004>>, <<\h8013, \h8012>>,
    <<\h8013, \h8011>>, <<\h8012, \hC004>>, <<\h8012, \h8013>>, <<\h8012, \h8011>>, <<\h8011, \hC004>>,
    <<\h8011, \h8012>>, <<\h8011, \h8003>>, <<\h8003, \hC003>>, <<\h8003, \h8011>>,
    <<\h8003, \h8000>>, <<\hC004, \h8014>>, <<\h8014, \hC002>>, <<\h8014, \hC004>>,
    <<\h8014, \h8011>>, <<\hC001, \h8001>>, <<\hC002, \h8014>>, <<\hC003, \h8003>>}
OneTransitionACall == [][DiagCode' \in {0, DiagCode} \/ <<DiagCode, DiagCode'>> \in Transitions]_beat

\* GLF-03, GLF-14: what the parameters ask for
WithRequest == UNLOCK_ENDS = "with_request"
GuardMustBeBack == CAUSE_OF_LOSS = "guard_and_zone" \/ (CAUSE_OF_LOSS = "what_was_lost" /\ unguarded)
\* GL-IN-RESET, GL-IN-AUTORESET, GL-IN-STARTRESET, GL-SEQ-2: a call that stays in its state has not seen what
\* it waits for
AnswersAtOnce ==
    [][DiagCode' = DiagCode /\ Scanned.Activate =>
        CASE DiagCode = \h8001 -> Secure /\ ~Scanned.S_StartReset /\ ~Scanned.Reset
          [] DiagCode = \h8000 -> Secure /\ ~(RequestEdge(Scanned) /\ Scanned.S_SafetyActive)
          [] DiagCode = \h8013 -> Scanned.S_GuardMonitoring /\ Scanned.UnlockRequest
          [] DiagCode = \h8012 ->
                ~Scanned.S_GuardMonitoring /\ Scanned.S_SafetyActive /\ (WithRequest => Scanned.UnlockRequest)
          [] DiagCode = \h8011 ->
                /\ (Scanned.S_GuardMonitoring \/ WithRequest) /\ ~Secure
                /\ Scanned.S_SafetyActive /\ ~Scanned.UnlockRequest
          [] DiagCode = \h8003 -> Secure /\ ~Scanned.Reset /\ (~Scanned.S_AutoReset \/ StartUpInhibited)
          [] DiagCode = \h8014 -> (~Scanned.Reset \/ (GuardMustBeBack /\ ~Secure)) /\ Scanned.S_SafetyActive
          [] DiagCode = \hC004 -> ~Scanned.S_SafetyActive
          [] DiagCode \in {\hC001, \hC002, \hC003} -> Scanned.Reset]_beat

\* GL-SEQ-2, GL-SEQ-3, GL-SEQ-4, GL-SEQ-5, GLF-04, GLF-11, GLF-12, GLF-14: and a call that leaves its state
\* has seen why (why an error is shown, ErrorNeedsCause says)
LeavesForACause ==
    [][DiagCode' # DiagCode /\ Scanned.Activate /\ DiagCode' < \hC000 =>
        CASE DiagCode = \h8001 ->
                IF S_GuardLocked' THEN Secure /\ (Scanned.S_StartReset \/ ResetEdge(Scanned)) ELSE ~Secure
          [] DiagCode = \h8000 -> Secure /\ Scanned.UnlockRequest /\ Scanned.S_SafetyActive
          [] DiagCode = \h8013 ->
                /\ Scanned.S_SafetyActive \/ ZONE_LOST = "tolerated"
                /\ IF S_UnlockGuard'
                    THEN ~Scanned.S_GuardMonitoring
                    ELSE (Scanned.S_GuardMonitoring \/ WithRequest) /\ ~Scanned.UnlockRequest
          [] DiagCode = \h8012 ->
                /\ IF S_UnlockGuard' THEN Scanned.S_GuardMonitoring
                                     ELSE WithRequest /\ ~Scanned.UnlockRequest
                /\ Scanned.S_SafetyActive \/ (ZONE_LOST = "tolerated" /\ Scanned.S_GuardMonitoring)
          [] DiagCode = \h8011 ->
                IF S_UnlockGuard'
                    THEN Scanned.S_SafetyActive /\ (Scanned.UnlockRequest \/ ~Scanned.S_GuardMonitoring)
                    ELSE Secure /\ ~(Scanned.UnlockRequest /\ Scanned.S_SafetyActive)
          [] DiagCode = \h8003 ->
                IF S_GuardLocked'
                    THEN Secure /\ (ResetEdge(Scanned) \/ (Scanned.S_AutoReset /\ ~StartUpInhibited))
                    ELSE ~Secure
          [] DiagCode = \h8014 ->
                ResetEdge(Scanned) /\ Scanned.S_SafetyActive /\ (GuardMustBeBack => Secure)
          [] DiagCode = \hC004 -> Scanned.S_SafetyActive
          [] DiagCode \in {\hC001, \hC002, \hC003} -> ~Scanned.Reset
          [] OTHER -> ~Ready]_beat

\* GL-SEQ-NOTE: there is no input to which a call has no answer
EveryCallIsAnswered == \A n \in Inputs : ENABLED GuardLockingCall(Alphabet[n])
\* GL-OUT-READY, GL-SEQ-0: before the first call every output is FALSE
PowerUpIsSafe == step = "" => ~Ready /\ ~S_GuardLocked /\ ~S_UnlockGuard /\ ~Error /\ DiagCode = 0
=============================================================================
