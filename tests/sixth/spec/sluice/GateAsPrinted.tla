---------------------------- MODULE GateAsPrinted ----------------------------
(***************************************************************************)
(* What the paper could be taken to say about the gate.                    *)
(***************************************************************************)
EXTENDS Gate

\* SL-1-1, SLF-01: the gate opens when it is requested, and the beacon follows
Ready_OpensAtOnce(i) == TRUE
=============================================================================
