------------------------ MODULE FplcDemandsAsPrinted -------------------------
(***************************************************************************)
(* Two readings take the level from the flag word MW01 (FplcAsPrinted).    *)
(* The demands are asked with MW01 as the F-PLC has written it: who else   *)
(* could overwrite it is on no wire (FplcOpenAsPrinted does).              *)
(***************************************************************************)
EXTENDS FplcDemands

LOCAL WithMW01(n) == [MW01 |-> MW01] @@ Alphabet[n]
Read_AuthorityFromMW01(n) == WithMW01(n)
Read_Figure5ReadsMW01(n) == WithMW01(n)

----------------------------------------------------------------------------
(* EchoStays                                                               *)
\* EKS-8-15, E-27: MW05Kept, but an echo that was not given yet does not come with the removal.
MW05_EchoStays == IF fplcState # "EchoSelection" /\ fplcSelection # None THEN CH[fplcSelection] ELSE 0
EnterClear_EchoStays ==
    /\ fplcState' = "Clear" /\ fplcElapsed' = 0
    /\ accepted' = None /\ authority' = None /\ UNCHANGED mode
    /\ fplcSelection' = IF fplcState = "EchoSelection" THEN None ELSE fplcSelection
=============================================================================
