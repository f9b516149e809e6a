---------------------------- MODULE CyclicBlock -----------------------------
(***************************************************************************)
(* What the safety function blocks share.  A block is called once a cycle. *)
(* A call reads its inputs once, takes at most one transition out of the   *)
(* state that the call before it left behind, and its outputs are the row  *)
(* of the state after it: a change shows in the very call that sees its    *)
(* cause, and every state lasts one call at least.                         *)
(* i is the record of one call's inputs, by the names of interface.toml,   *)
(* and i.dt the ticks since the call before.                               *)
(* Where several transitions are possible the priorities of the state      *)
(* decide; a guard says it by negating those before it.  First of all, in  *)
(* every state, comes the end of Activate.                                 *)
(* Leaves out: data types, instances, what the platform does beside the    *)
(* block.                                                                  *)
(***************************************************************************)
EXTENDS Integers, StepName

VARIABLES
    state,           \* the state; DiagCode and the row of outputs follow from it
    resetBefore      \* Reset as the call before this one read it

\* A call of an active block in this state: there is no transition but to Idle without Activate
At(s, i) == state = s /\ i.Activate
GoTo(s) == state' = s

\* An input acts on its rising edge: TRUE now and FALSE in the call before
Rises(now, before) == now /\ ~before

\* The edge that removes an inhibit or an error
ResetRises(i) == Rises(i.Reset, resetBefore)
\* Reset is held, or stuck: where it is waited for, that is an error and never a reset
ResetStatic(i) == i.Reset /\ resetBefore
\* Every call remembers Reset, whether the block is active or not
RemembersReset(i) == resetBefore' = i.Reset

\* A timer that stops at its limit: from there on it has elapsed
Counted(ticks, dt, limit) == IF ticks + dt >= limit THEN limit ELSE ticks + dt
=============================================================================
