---------------------------- MODULE PlcAsPrinted ----------------------------
(***************************************************************************)
(* What the note could be taken to say of the PLC, and what we did not     *)
(* decide.  Op_Reading takes the place of Op of Plc where a run tries that *)
(* reading.                                                                *)
(***************************************************************************)
EXTENDS Plc

LOCAL CopyTurns == {"CopyReadAuthorization", "CopyMW03", "CopyCheckMSO", "CopyMW07"}
LOCAL Checked(i) == ReadAuthorization = i.MW01 \/ i.MW01 = 0
LOCAL Counted(this, next, word, i) ==
    IF i.MW01 = 0 THEN turn' = "CopyReadAuthorization" ELSE turn = this /\ word # 0 /\ turn' = next
LOCAL Fetched(i) == i.MW01 # 0

----------------------------------------------------------------------------
(* PlcChecksFirst                                                          *)
\* EKS-3-1-PLC, EKS-3-2, EKS-9-1-PLC, EKS-9-2, E-08: the PLC compares before each step.  It takes an insert
\* step only with ReadAuthorization as MW01, and a removal step only with MW01 zero.
CopyReadAuthorization_PlcChecksFirst(i) ==
    Checked(i) /\ Turn("CopyReadAuthorization", "CopyMW03") /\ WriteReadAuthorization(i)
CopyMW03_PlcChecksFirst(i) == Checked(i) /\ Turn("CopyMW03", "CopyCheckMSO") /\ WriteMW03(i)
CopyCheckMSO_PlcChecksFirst(i) == Checked(i) /\ Turn("CopyCheckMSO", "CopyMW07") /\ WriteCheckMSO(i)
CopyMW07_PlcChecksFirst(i) == Checked(i) /\ Turn("CopyMW07", "CopyReadAuthorization") /\ WriteMW07(i)

----------------------------------------------------------------------------
(* PlcOnlyCopies                                                           *)
\* EKS-GP-2, EKS-3-1-PLC, EKS-9-1-PLC, E-08: the PLC forwards and compares nothing; both routines are the same
\* four copies.
StillSame_PlcOnlyCopies(i) == TRUE

----------------------------------------------------------------------------
(* PlcChecksZero                                                           *)
\* EKS-8-10, E-33: in the removal the PLC itself checks that the selection of the panel is zero, and copies it
\* only then.
CopyMW03_PlcChecksZero(i) ==
    (i.MW01 # 0 \/ i.SelectMSO = 0) /\ Due(i, "CopyMW03", "CopyCheckMSO") /\ WriteMW03(i)

----------------------------------------------------------------------------
(* PlcCountsSteps                                                          *)
\* EKS-3-0, EKS-9-0, E-43: the PLC takes each step once in an insertion, in its turn, and waits in it for a
\* word; while MW01 is zero the removal steps run.
Turns_PlcCountsSteps == CopyTurns \cup {"Done"}
CopyReadAuthorization_PlcCountsSteps(i) ==
    Counted("CopyReadAuthorization", "CopyMW03", i.MW01, i) /\ WriteReadAuthorization(i)
CopyMW03_PlcCountsSteps(i) == Counted("CopyMW03", "CopyCheckMSO", i.SelectMSO, i) /\ WriteMW03(i)
CopyCheckMSO_PlcCountsSteps(i) == Counted("CopyCheckMSO", "CopyMW07", i.MW05, i) /\ WriteCheckMSO(i)
CopyMW07_PlcCountsSteps(i) == Counted("CopyMW07", "Done", i.SwitchMSO, i) /\ WriteMW07(i)

----------------------------------------------------------------------------
(* RemovalFetchesNothing                                                   *)
\* EKS-8-7, EKS-8-15, E-78: the removal sends the two words to the panel once more and does not fetch them.
CopyReadAuthorization_RemovalFetchesNothing(i) ==
    Fetched(i) /\ Turn("CopyReadAuthorization", "CopyMW03") /\ WriteReadAuthorization(i)
CopyCheckMSO_RemovalFetchesNothing(i) == Fetched(i) /\ Turn("CopyCheckMSO", "CopyMW07") /\ WriteCheckMSO(i)

----------------------------------------------------------------------------
(* CopiesAsPrinted                                                         *)
\* E-77: PlcChecksFirst, PlcCountsSteps and RemovalFetchesNothing at once.
Turns_CopiesAsPrinted == CopyTurns \cup {"Done"}
CopyReadAuthorization_CopiesAsPrinted(i) ==
    /\ Checked(i) /\ Fetched(i)
    /\ Counted("CopyReadAuthorization", "CopyMW03", i.MW01, i) /\ WriteReadAuthorization(i)
CopyMW03_CopiesAsPrinted(i) ==
    Checked(i) /\ Counted("CopyMW03", "CopyCheckMSO", i.SelectMSO, i) /\ WriteMW03(i)
CopyCheckMSO_CopiesAsPrinted(i) ==
    Checked(i) /\ Fetched(i) /\ Counted("CopyCheckMSO", "CopyMW07", i.MW05, i) /\ WriteCheckMSO(i)
CopyMW07_CopiesAsPrinted(i) == Checked(i) /\ Counted("CopyMW07", "Done", i.SwitchMSO, i) /\ WriteMW07(i)

----------------------------------------------------------------------------
(* AtomicCopy                                                              *)
\* EKS-GP-2, E-52: the PLC copies all four words in one step.
PlcScan_AtomicCopy(i) ==
    /\ ReadAuthorization' = i.MW01 /\ MW03' = i.SelectMSO /\ CheckMSO' = i.MW05 /\ MW07' = i.SwitchMSO
    /\ UNCHANGED turn
    /\ Did("AtomicCopy")
=============================================================================
