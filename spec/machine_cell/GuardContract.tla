--------------------------- MODULE GuardContract ----------------------------
(***************************************************************************)
(* What the cell needs of SF_GuardLocking.  Our own design.  The form is   *)
(* that of FPLCContract.                                                   *)
(* Leaves out: that it ever locks or unlocks; which error it is.           *)
(***************************************************************************)
EXTENDS Integers

\* `reset`: Reset as the call read it
Row(shows, reset) ==
    [S_GuardLocked |-> shows = "locked", S_UnlockGuard |-> shows = "unlocked", Error |-> shows = "error",
     reset |-> reset]
\* GL-OUT-GUARDLOCKED, GL-OUT-UNLOCKGUARD, GL-OUT-ERROR: one of three, or none
Rows == {Row(shows, reset) : shows \in {"locked", "unlocked", "error", "none"}, reset \in BOOLEAN}
Start == Row("none", FALSE)

\* GLA-10: it is never switched off, for then it forgets its error; GLF-08: both inhibits are on
Assumes(was, i) == i.Activate /\ ~i.S_StartReset /\ ~i.S_AutoReset

Edge(was, i) == i.Reset /\ ~was.reset
AtOnce(i, now) ==
    \* GL-IN-GUARDMONITORING, GL-IN-GUARDLOCK: locked only while door and bolt are
    /\ now.S_GuardLocked => i.S_GuardMonitoring /\ i.S_GuardLock
    \* GL-IN-UNLOCKREQUEST, GL-IN-SAFETYACTIVE, GLF-04: unlocked only while it is asked for and the zone is safe
    /\ now.S_UnlockGuard => i.UnlockRequest /\ i.S_SafetyActive
Guarantees(was, i, now) ==
    /\ now.reset = i.Reset /\ AtOnce(i, now)
    \* GL-IN-AUTORESET, GL-WARN-3: and only by a reset, which no error or open door precedes
    /\ ~was.S_GuardLocked /\ now.S_GuardLocked => Edge(was, i) /\ ~was.Error /\ ~was.S_UnlockGuard
    \* GL-OUT-ERROR, GLF-07, GLF-13: an error ends by an edge of Reset, or by letting go a Reset that was stuck
    /\ was.Error /\ ~now.Error => Edge(was, i) \/ (was.reset /\ ~i.Reset)
=============================================================================
