-------------------------- MODULE GuardLockingLive --------------------------
(***************************************************************************)
(* What must happen in the end, from any state that any inputs can lead    *)
(* to.  From some call on the causes are gone, S_StartReset and            *)
(* S_AutoReset may still be anything, and Reset is pressed and released    *)
(* again and again, at any pace.                                           *)
(*  RecoverySpec  the guard stays closed and locked, nobody asks: enabled. *)
(*  EntrySpec     the zone stays safe, and somebody holds the button of    *)
(*                the request, pressing it anew while the guard is still   *)
(*                enabled: unlocked, if the guard closes and locks.        *)
(* Leaves out how many calls it takes (a theorem says that).               *)
(***************************************************************************)
EXTENDS GuardLocking

VARIABLE calm    \* TRUE: the causes are gone, for good

liveVars == <<guardLocking, step, calm>>

LiveInit == GuardLockingInit /\ step = "" /\ calm = FALSE

Call(on, guard, zone, lock, request, start, auto, reset) ==
    GuardLockingCall(
        [Activate |-> on, S_GuardMonitoring |-> guard, S_SafetyActive |-> zone, S_GuardLock |-> lock,
         UnlockRequest |-> request, S_StartReset |-> start, S_AutoReset |-> auto, Reset |-> reset])

AnyCall ==
    /\ ~calm /\ calm' \in BOOLEAN
    /\ \E on, guard, zone, lock, request, start, auto, reset \in BOOLEAN :
        Call(on, guard, zone, lock, request, start, auto, reset)

\* GL-IN-RESET, GL-IN-AUTORESET, GL-IN-STARTRESET: closed, locked and safe, and nobody asks
QuietCall(reset) ==
    /\ calm /\ UNCHANGED calm
    /\ \E start, auto \in BOOLEAN : Call(TRUE, TRUE, TRUE, TRUE, FALSE, start, auto, reset)
RecoverySpec ==
    /\ LiveInit /\ [][AnyCall \/ \E reset \in BOOLEAN : QuietCall(reset)]_liveVars
    /\ WF_liveVars(QuietCall(~resetBefore))

\* GL-IN-UNLOCKREQUEST, GLF-02: who wants to get in holds the button, and presses it anew while the guard is
\* still enabled
Asks == IF S_GuardLocked THEN ~unlockRequestBefore ELSE TRUE
\* GL-IN-UNLOCKREQUEST, GL-SEQ-3: the zone stays safe, and a guard that is asked to lock is closed and locked
Secured == IF S_UnlockGuard THEN BOOLEAN ELSE {TRUE}
EntryCall(reset) ==
    /\ calm /\ UNCHANGED calm
    /\ \E guard, lock \in Secured, start, auto \in BOOLEAN :
        Call(TRUE, guard, TRUE, lock, Asks, start, auto, reset)
EntrySpec ==
    /\ LiveInit /\ [][AnyCall \/ \E reset \in BOOLEAN : EntryCall(reset)]_liveVars
    /\ WF_liveVars(EntryCall(~resetBefore))

\* GL-IN-RESET, GL-IN-STARTRESET, GL-IN-AUTORESET, GL-SEQ-2: with the causes gone and edges of Reset the block
\* enables again, and stays so
EnablesAgain == calm ~> [](S_GuardLocked)
\* GL-IN-UNLOCKREQUEST, GL-SEQ-3, GL-OUT-UNLOCKGUARD: with the zone safe, who asks gets in
EntryIsGranted == calm ~> S_UnlockGuard
=============================================================================
