-------------------------------- MODULE Plc ---------------------------------
(***************************************************************************)
(* The PLC of the note: it forwards four words between the F-PLC and the   *)
(* panel.  Insert steps 13, 16, 21, 26, removal steps 7, 10, 15, 17, and   *)
(* the PLC's rows of Figures 3 and 9: from step 13 on each other copy is   *)
(* preceded by the check, and where it fails the routine begins anew with  *)
(* the copy of MW01 (E-08).                                                *)
(* i = [MW01, MW05, SelectMSO, SwitchMSO], four words.                     *)
(* Leaves out: which of its two routines the PLC is in: both make the same *)
(* copies, and MW01 tells them apart (E-08, E-43).                         *)
(***************************************************************************)
EXTENDS Integers, CodeTables, StepName

CONSTANTS
    WORDS,        \* the words that can occur
    ANY_ORDER     \* FALSE: the PLC as decided; TRUE: any copy at any time, which is also what a slow bus does

VARIABLES
    turn,               \* the copy that is executed next, where the order is fixed
    ReadAuthorization,  \* the word as last sent to the panel
    MW03,               \* the word as last written for the F-PLC
    CheckMSO,           \* the word as last sent to the panel
    MW07                \* the word as last written for the F-PLC

plc == <<turn, ReadAuthorization, MW03, CheckMSO, MW07>>

\* The outputs by their names
PlcOutputs == [ReadAuthorization |-> ReadAuthorization, CheckMSO |-> CheckMSO, MW03 |-> MW03, MW07 |-> MW07]

Turns == {"CopyReadAuthorization", "CopyMW03", "CopyCheckMSO", "CopyMW07"}

PlcTypeOK ==
    /\ turn \in Turns
    /\ ReadAuthorization \in WORDS /\ MW03 \in WORDS /\ CheckMSO \in WORDS /\ MW07 \in WORDS

PlcInit ==
    /\ turn = "CopyReadAuthorization"
    /\ ReadAuthorization = 0 /\ MW03 = 0 /\ CheckMSO = 0 /\ MW07 = 0

----------------------------------------------------------------------------
(* What a copy writes.                                                     *)

WriteReadAuthorization(i) ==
    ReadAuthorization' = i.MW01 /\ UNCHANGED <<MW03, CheckMSO, MW07>> /\ Did("CopyReadAuthorization")
WriteMW03(i) ==
    MW03' = i.SelectMSO /\ UNCHANGED <<ReadAuthorization, CheckMSO, MW07>> /\ Did("CopyMW03")
WriteCheckMSO(i) ==
    CheckMSO' = i.MW05 /\ UNCHANGED <<ReadAuthorization, MW03, MW07>> /\ Did("CopyCheckMSO")
WriteMW07(i) ==
    MW07' = i.SwitchMSO /\ UNCHANGED <<ReadAuthorization, MW03, CheckMSO>> /\ Did("CopyMW07")

----------------------------------------------------------------------------
(* When it is made.                                                        *)

\* EKS-GP-3: one word a scan
Turn(this, next) == IF ANY_ORDER THEN UNCHANGED turn ELSE turn = this /\ turn' = next
\* EKS-3-1-PLC, EKS-9-1-PLC, E-08: in the removal both words are zero, so that one comparison is both
StillSame(i) == ReadAuthorization = i.MW01
\* A-12: the copies in any order stand for PLC and bus; what arrives late is late whatever the PLC has compared
Passes(i) == IF ANY_ORDER THEN TRUE ELSE StillSame(i)
\* EKS-GP-4, EKS-GP-5, EKS-3-2, EKS-3-3, EKS-9-2, EKS-9-3: the check, then the step, then on to the next
Due(i, this, next) == Passes(i) /\ Turn(this, next)

\* EKS-2-13, EKS-3-4-PLC, EKS-8-7, EKS-9-4-PLC, E-08: at its turn, and where the check fails: the other
\* routine begins with it too
CopyReadAuthorization(i) ==
    /\ IF Passes(i) THEN Turn("CopyReadAuthorization", "CopyMW03") ELSE turn' = "CopyMW03"
    /\ WriteReadAuthorization(i)
\* EKS-2-16, EKS-8-10, E-33: copied as it is; the F-PLC judges it
CopyMW03(i) == Due(i, "CopyMW03", "CopyCheckMSO") /\ WriteMW03(i)
\* EKS-2-21, EKS-8-15, E-78
CopyCheckMSO(i) == Due(i, "CopyCheckMSO", "CopyMW07") /\ WriteCheckMSO(i)
\* EKS-2-26, EKS-8-17
CopyMW07(i) == Due(i, "CopyMW07", "CopyReadAuthorization") /\ WriteMW07(i)

\* EKS-BD-1, EKS-GP-2, E-43: round and round
PlcScan(i) == CopyReadAuthorization(i) \/ CopyMW03(i) \/ CopyCheckMSO(i) \/ CopyMW07(i)
=============================================================================
