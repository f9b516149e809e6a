-------------------------------- MODULE Plc ---------------------------------
(***************************************************************************)
(* The PLC of the note: it forwards four words between the F-PLC and the   *)
(* panel.  Insert steps 13, 16, 21, 26, removal steps 7, 10, 15, 17, and   *)
(* the PLC's rows of Figures 3 and 9, which a cyclic copier fulfils: each  *)
(* change of MW01 is copied on, whatever step the PLC would be in.         *)
(* i = [MW01, MW05, SelectMSO, SwitchMSO], four words.                     *)
(* Leaves out: the PLC's own step counter and its comparisons (E-08, E-43);*)
(* literal readings bring them back for a trial.                           *)
(***************************************************************************)
EXTENDS Integers, CodeTables, StepName, Readings

CONSTANTS
    WORDS,        \* the words that can occur
    ANY_ORDER     \* TRUE: the four copies in any order; FALSE: one after the other

VARIABLES
    turn,               \* the copy that is executed next, where the order is fixed
    ReadAuthorization,  \* the word as last sent to the panel
    MW03,               \* the word as last written for the F-PLC
    CheckMSO,           \* the word as last sent to the panel
    MW07                \* the word as last written for the F-PLC

plc == <<turn, ReadAuthorization, MW03, CheckMSO, MW07>>

\* The outputs by their names
PlcOutputs == [ReadAuthorization |-> ReadAuthorization, CheckMSO |-> CheckMSO, MW03 |-> MW03, MW07 |-> MW07]

LOCAL Turns == {"CopyReadAuthorization", "CopyMW03", "CopyCheckMSO", "CopyMW07"}
               \cup (IF PLC_COUNTS_STEPS THEN {"Done"} ELSE {})

PlcTypeOK ==
    /\ turn \in Turns
    /\ ReadAuthorization \in WORDS /\ MW03 \in WORDS /\ CheckMSO \in WORDS /\ MW07 \in WORDS

PlcInit ==
    /\ turn = "CopyReadAuthorization"
    /\ ReadAuthorization = 0 /\ MW03 = 0 /\ CheckMSO = 0 /\ MW07 = 0

\* EKS-GP-3: one word a scan
LOCAL Turn(this, next) == IF ANY_ORDER THEN UNCHANGED turn ELSE turn = this /\ turn' = next

\* E-08: as printed, an insert step only with ReadAuthorization as MW01, a removal step only with MW01 zero
LOCAL Checked(i) == PLC_CHECKS_FIRST => ReadAuthorization = i.MW01 \/ i.MW01 = 0
\* E-43: the step is taken once in an insertion, in its turn, and waits for a word; while MW01 is zero the removal steps run
LOCAL Counted(this, next, word, i) ==
    IF i.MW01 = 0 THEN turn' = "CopyReadAuthorization" ELSE turn = this /\ word # 0 /\ turn' = next
\* EKS-8-7, EKS-8-15, E-78: as printed, the removal sends the two words to the panel once more and does not fetch them anew
LOCAL Fetched(i) == REMOVAL_FETCHES_NOTHING => i.MW01 # 0
LOCAL Begin(this, next, word, i) ==
    /\ Checked(i)
    /\ IF PLC_COUNTS_STEPS THEN Counted(this, next, word, i) ELSE Turn(this, next)

\* EKS-2-13, EKS-3-1-PLC, EKS-3-2, EKS-3-3, EKS-3-4-PLC, EKS-8-7, EKS-9-1-PLC, EKS-9-2, EKS-9-3, EKS-9-4-PLC, E-05, E-08
CopyReadAuthorization(i) ==
    /\ Begin("CopyReadAuthorization", "CopyMW03", i.MW01, i)
    /\ Fetched(i)
    /\ ReadAuthorization' = i.MW01
    /\ UNCHANGED <<MW03, CheckMSO, MW07>>
    /\ Did("CopyReadAuthorization")
\* EKS-2-16, EKS-8-10, E-33: copied as it is; the F-PLC judges it
CopyMW03(i) ==
    /\ Begin("CopyMW03", "CopyCheckMSO", i.SelectMSO, i)
    /\ PLC_CHECKS_ZERO => i.MW01 # 0 \/ i.SelectMSO = 0
    /\ MW03' = i.SelectMSO
    /\ UNCHANGED <<ReadAuthorization, CheckMSO, MW07>>
    /\ Did("CopyMW03")
\* EKS-2-21, EKS-8-15
CopyCheckMSO(i) ==
    /\ Begin("CopyCheckMSO", "CopyMW07", i.MW05, i)
    /\ Fetched(i)
    /\ CheckMSO' = i.MW05
    /\ UNCHANGED <<ReadAuthorization, MW03, MW07>>
    /\ Did("CopyCheckMSO")
\* EKS-2-26, EKS-8-17
CopyMW07(i) ==
    /\ Begin("CopyMW07", IF PLC_COUNTS_STEPS THEN "Done" ELSE "CopyReadAuthorization", i.SwitchMSO, i)
    /\ MW07' = i.SwitchMSO
    /\ UNCHANGED <<ReadAuthorization, MW03, CheckMSO>>
    /\ Did("CopyMW07")

\* EKS-BD-1, EKS-GP-2, E-43: a cyclic copier
PlcScan(i) == CopyReadAuthorization(i) \/ CopyMW03(i) \/ CopyCheckMSO(i) \/ CopyMW07(i)
=============================================================================
