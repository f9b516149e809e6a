---------------------------- MODULE BeamContract ----------------------------
(***************************************************************************)
(* What the cell needs of SF_TestableSafetySensor.  Our own design.  The   *)
(* form is that of FPLCContract.                                           *)
(* Leaves out: how long a test lasts.                                      *)
(***************************************************************************)
EXTENDS Integers

\* `reset`: Reset as the call read it; in a test it is first "asked", with the sender off, then "testing"
Row(shows, reset) ==
    [S_OSSD_Out |-> shows \in {"free", "asked", "testing"}, TestPossible |-> shows = "free",
     S_TestOut |-> shows # "asked", Error |-> shows = "error", reset |-> reset]
\* TSS-8010, TSS-8020, TSS-8030, TSS-8000, TSS-EB-1
Rows == {Row(shows, reset) : shows \in {"free", "asked", "testing", "error", "none"}, reset \in BOOLEAN}
Start == Row("none", FALSE)

\* TSSA-08: it is never switched off, for then it forgets its error; both inhibits are on, and a failed test
\* needs no test by hand
Assumes(was, i) == i.Activate /\ i.NoExternalTest /\ ~i.S_StartReset /\ ~i.S_AutoReset

Testing(row) == row.S_OSSD_Out /\ ~row.TestPossible
Edge(was, i) == i.Reset /\ ~was.reset
Guarantees(was, i, now) ==
    /\ now.reset = i.Reset
    \* TSS-FN-1, TSSF-09: with a dark beam it enables only in the second phase of a test
    /\ now.S_OSSD_Out /\ ~i.S_OSSD_In => Testing(was) /\ Testing(now)
    \* TSS-TEST-1, TSSF-23: a test begins out of a free beam, when it is asked for
    /\ Testing(now) /\ ~Testing(was) => was.TestPossible /\ i.StartTest
    \* TSS-FN-2, TSS-EB-4, TSS-EB-5: it enables again only by a reset, with a free beam
    /\ ~was.S_OSSD_Out /\ now.S_OSSD_Out => Edge(was, i) /\ i.S_OSSD_In /\ now.TestPossible
    \* TSS-EB-3, TSS-ERR-3: an error ends by an edge of Reset, or by letting go a Reset that was stuck
    /\ was.Error /\ ~now.Error => Edge(was, i) \/ (was.reset /\ ~i.Reset)
=============================================================================
