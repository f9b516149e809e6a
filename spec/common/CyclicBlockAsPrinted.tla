------------------------ MODULE CyclicBlockAsPrinted ------------------------
(***************************************************************************)
(* What the text of the family could be taken to say about Reset, where we *)
(* decided otherwise.  Each block adds its own readings in its own module. *)
(* Op_Reading takes the place of Op in the runs that try the reading.      *)
(***************************************************************************)
EXTENDS CyclicBlock

----------------------------------------------------------------------------
\* EDMF-10, ESF-10, GLF-07, TSSF-24: Reset acts for as long as it is TRUE, and is never found static
ResetRises_ResetByLevel(i) == i.Reset
ResetStatic_ResetByLevel(i) == FALSE

----------------------------------------------------------------------------
\* EDMF-10, ESF-10, GLF-07, TSSF-24: Reset is read only while the block is active, so that one which is
\* held while the block is switched on counts as an edge
RemembersReset_ResetSeenOnlyWhileActive(i) == resetBefore' = (i.Reset /\ i.Activate)
=============================================================================
