-------------------------- MODULE ContactorContract -------------------------
(***************************************************************************)
(* What the cell needs of SF_EDM.  Our own design.  The form is that of    *)
(* FPLCContract.                                                           *)
(* Leaves out: MonitoringTime; which error it is.                          *)
(***************************************************************************)
EXTENDS Integers

\* `waits`: neither switched on nor ready to be: at first, in an error, and while a reset is asked for
\* `asked`, `reset`: S_OutControl and Reset as the call read them; `inhibited`: the start-up inhibit waits
Row(shows, asked, reset) ==
    [S_EDM_Out |-> shows = "on", Error |-> shows = "error", waits |-> shows \in {"idle", "inhibited", "error"},
     inhibited |-> shows = "inhibited", asked |-> asked, reset |-> reset]
Rows ==
    {Row(shows, asked, reset) :
        shows \in {"on", "off", "inhibited", "error", "idle"}, asked \in BOOLEAN, reset \in BOOLEAN}
Start == Row("idle", FALSE, FALSE)

\* EDMA-08: it is never switched off; EDMA-06: while it waits for a reset nobody asks for the output
Assumes(was, i) == i.Activate /\ ~i.S_StartReset /\ (was.waits => ~i.S_OutControl)

Edge(was, i) == i.Reset /\ ~was.reset
\* EDM-IN-CONTROL-2: on only while it is asked for
AtOnce(i, now) == now.S_EDM_Out => i.S_OutControl
Guarantees(was, i, now) ==
    /\ now.reset = i.Reset /\ now.asked = i.S_OutControl /\ AtOnce(i, now)
    \* EDM-IN-EDM-2, EDM-IN-CONTROL-3, EDMA-06: it switches on when somebody begins to ask, and finds both
    \* contactors dropped out; a reset alone never does
    /\ ~was.S_EDM_Out /\ now.S_EDM_Out => ~was.asked /\ ~was.waits /\ i.S_EDM1 /\ i.S_EDM2
    \* EDM-OUT-ERROR, EDMF-10: an error ends by an edge of Reset, or by letting go a Reset that was stuck
    /\ was.Error /\ ~now.Error => Edge(was, i) \/ (was.reset /\ ~i.Reset)
    \* EDM-IN-RESET-2: the start-up inhibit begins in the first call or after such an error, and ends with an edge
    /\ was.inhibited /\ Edge(was, i) => ~now.waits
    /\ was = Start => now.inhibited
    /\ was.waits /\ ~now.waits => Edge(was, i)
    /\ now.waits /\ ~now.Error => now.inhibited
    /\ now.inhibited /\ ~was.inhibited => was = Start \/ (was.Error /\ was.reset /\ ~i.Reset)
    /\ was.inhibited /\ now.Error => was.reset /\ i.Reset
=============================================================================
