--------------------------- MODULE FPLCContract ----------------------------
(***************************************************************************)
(* What the cell needs of the F-PLC of the note.  Our own design.          *)
(* A contract is a relation between what the block shows after the call    *)
(* before (`was`), the inputs of a call (`i`) and what it shows after it   *)
(* (`now`).  It assumes nothing: any key and any word at any time.         *)
(* AtOnce, where there is one, is the part of it that needs no `was`.      *)
(* Leaves out: both words, the level, and every time.  That a mode begins  *)
(* only within the authorization is FPLCShows!WithinAuthorization.         *)
(***************************************************************************)
EXTENDS Integers

\* `up`: it has left its start, so that a mode may come
Row(mode, error, up) ==
    [MSO_0 |-> mode = 0, MSO_1 |-> mode = 1, MSO_2 |-> mode = 2, MSO_3 |-> mode = 3, MSO_4 |-> mode = 4,
     ERROR |-> error, up |-> up]
\* EKS-KS-5, EKS-SD-6: no row has two modes
Rows == {Row(mode, error, up) : mode \in -1..4, error \in BOOLEAN, up \in BOOLEAN}
\* E-25c: at power-up no mode is active
Start == Row(-1, FALSE, FALSE)

Modes(row) == <<row.MSO_0, row.MSO_1, row.MSO_2, row.MSO_3, row.MSO_4>>

Assumes(was, i) == TRUE

\* EKS-2-29, EKS-SD-2, E-24, E-25c: a mode comes in the place of the one before in one scan, with a key in
\* the reader, and never in the first scan or with an error; nothing else changes it
Guarantees(was, i, now) ==
    /\ was.up => now.up
    /\ Modes(now) # Modes(was) => was.up /\ i.LA /\ ~was.ERROR /\ ~now.ERROR
=============================================================================
