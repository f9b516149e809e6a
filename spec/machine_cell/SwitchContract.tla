--------------------------- MODULE SwitchContract ---------------------------
(***************************************************************************)
(* What the cell needs of SF_EnableSwitch.  Our own design.  The form is   *)
(* that of FPLCContract.                                                   *)
(* Leaves out: the discrepancy time; that it ever enables.                 *)
(***************************************************************************)
EXTENDS Integers

\* `may`: stage 0 was seen, and since then no other stage; `reset`: Reset as the call read it
Row(shows, reset) ==
    [S_EnableSwitchOut |-> shows = "on", Error |-> shows = "error", may |-> shows = "may", reset |-> reset]
Rows == {Row(shows, reset) : shows \in {"on", "error", "may", "none"}, reset \in BOOLEAN}
Start == Row("none", FALSE)

\* ESA-08: it is never switched off, for then it forgets its error; ESF-14: an error needs an edge of Reset
Assumes(was, i) == i.Activate /\ ~i.S_AutoReset

Stage(i, ch1, ch2, ch3) == <<i.S_EnableSwitchCh1, i.S_EnableSwitchCh2, i.S_EnableSwitchCh3>> = <<ch1, ch2, ch3>>
Stage0(i) == Stage(i, FALSE, TRUE, FALSE)
Stage1(i) == Stage(i, TRUE, FALSE, TRUE)
Stage2(i) == Stage(i, FALSE, FALSE, FALSE)
\* ES-STAGE-1, ES-SEQ-1: it enables only in the middle position, in a mode where it may
AtOnce(i, now) == now.S_EnableSwitchOut => Stage1(i) /\ i.S_SafetyActive
Guarantees(was, i, now) ==
    /\ now.reset = i.Reset /\ AtOnce(i, now)
    \* ES-ORDER-2, ESF-02: and only out of stage 0
    /\ ~was.S_EnableSwitchOut /\ now.S_EnableSwitchOut => was.may
    /\ now.may => Stage0(i) \/ (was.may /\ ~Stage1(i) /\ ~Stage2(i))
    \* ES-SEQ-5, ESF-06, ESF-08: an error ends by an edge of Reset with the switch released
    /\ was.Error /\ ~now.Error => i.Reset /\ ~was.reset /\ Stage0(i)
=============================================================================
