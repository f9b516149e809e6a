---------------------------- MODULE FplcAsPrinted ----------------------------
(***************************************************************************)
(* What the note could be taken to say about the F-PLC, and what was not   *)
(* decided that way.  A reading is tried by putting its operators in the   *)
(* place of the decided ones of Fplc: Op_Reading for Op.  Each stands with *)
(* its clauses and its finding; findings.toml says why it was not taken.   *)
(***************************************************************************)
EXTENDS Fplc

----------------------------------------------------------------------------
(* The check before every step, and its timers.                            *)

\* EKS-SD-1, EKS-SD-8, EKS-SD-9, E-06b: the safety description names four outputs, so STR is not counted
Many_STRLeftOut(i) == Cardinality(i.vec \ {4}) >= 2
NoSignal_STRLeftOut(i) == ~i.LA /\ i.vec \ {4} = {}

\* EKS-3-1-FPLC, E-07: no output at 1 is a removal also while the pulse runs
IsGone_CheckInPulse(i) ==
    \/ ~i.LA /\ fplcState \in WithKey
    \/ i.vec = {} /\ fplcState \in Inserting

\* EKS-2-11, E-09: the step that accepts the output counts the outputs, and no other step does
IsMany_OneOutputCheckedOnce(i) == Many(i) /\ fplcState = "OneOutput"

\* EKS-KS-6, E-09: more than one output is a fault at every moment, the pulse included
IsMany_OneOutputAlways(i) == Many(i) /\ fplcState \notin OwnRules
DetectKey_OneOutputAlways(i) ==
    /\ fplcState = "Idle" /\ i.LA
    /\ IF Many(i) THEN EnterError /\ Did("TooManyOutputs") ELSE Proceed("PulseOnes") /\ Did("DetectKey")

\* EKS-3-1-FPLC, EKS-8-2, EKS-8-5, E-62: an output without LA is a fault
IsMany_OutputNeedsLA(i) ==
    /\ Many(i) \/ (~i.LA /\ i.vec # {})
    /\ fplcState \notin OwnRules /\ fplcState \notin Pulse

\* EKS-GP-4, EKS-KS-6, E-63: the key is looked at before the number of outputs
IsMany_KeyBeforeFaults(i) == Many(i) /\ fplcState \notin OwnRules /\ fplcState \notin Pulse /\ ~IsGone(i)

\* EKS-3-1-FPLC, E-68: only the loss of the output is a removal, another output is none
IsChanged_OnlyNoneIsRemoval(i) == i.vec = {} /\ fplcState \in Holding

\* EKS-SD-2, E-42: step 29 compares words and does not look at the key
CheckPasses_NoLAAtSwitch(i) ==
    /\ ~IsMany(i) /\ ~IsExpired(i)
    /\ fplcState # "Switch" => ~IsGone(i) /\ ~IsChanged(i)

\* EKS-8-3, EKS-8-11, E-06, E-30: the timer of the removal is watched by the panel alone
IsExpired_NoRemovalTimer(i) == Now(i) >= Deadline /\ fplcState \in Timed \ Removing

\* EKS-8-3, EKS-8-11, E-15: the note has no time for the return to zero between two selections
IsExpired_NoSettleDeadline(i) == Now(i) >= Deadline /\ fplcState \in Timed \ {"Settle"}

\* EKS-2-8, E-25d: the F-PLC has no reaction of its own to the expiry of step 8
IsExpired_NoInsertionTimer(i) == Now(i) >= Deadline /\ fplcState \in Returning

\* EKS-4-4, E-64: what the state waits for is tested before its timer, as the rows of Figure 4 stand
LOCAL Awaited(i) ==
    CASE fplcState = "PulseOnes" -> i.vec = MSO
      [] fplcState = "PulseZeros" -> i.vec = {}
      [] fplcState = "OneOutput" -> i.vec # {}
      [] fplcState = "AwaitZeros" -> ZerosReturned(i)
      [] fplcState = "Settle" -> NoWords(i) /\ Dwelt(i)
      [] OTHER -> FALSE
IsExpired_SuccessBeforeExpiry(i) == Now(i) >= Deadline /\ fplcState \in Timed /\ ~Awaited(i)

----------------------------------------------------------------------------
(* Power-up and the test pulse.                                            *)

\* EKS-2-1, E-25c: after power-up the F-PLC is ready at once, whatever stands on its inputs
LeaveStart_KeyAtPowerUp(i) == fplcState = "Start" /\ ~Many(i) /\ Proceed("Idle") /\ Did("LeaveStart")
AwaitPowerUpZeros_KeyAtPowerUp(i) == FALSE

\* EKS-2-6, E-73: no output may be set when LA comes
DetectKey_NoOutputBeforeLA(i) ==
    /\ fplcState = "Idle" /\ i.LA
    /\ IF i.vec # {} THEN EnterError /\ Did("TooManyOutputs") ELSE Proceed("PulseOnes") /\ Did("DetectKey")

LOCAL TakeOutput(i) ==
    /\ \E a \in i.vec : accepted' = a
    /\ fplcState' = "Authorize" /\ fplcElapsed' = 0
    /\ UNCHANGED <<authority, fplcSelection, mode>>
    /\ Did("AcceptOutput")

\* EKS-2-6, EKS-2-7, E-10: one output within the time is enough, without all of them before it
AwaitOnes_NoPulseNeeded(i) ==
    /\ fplcState = "PulseOnes" /\ i.vec # MSO
    /\ IF Cardinality(i.vec) = 1 THEN TakeOutput(i) ELSE Wait(i, T_ON) /\ Did("AwaitOnes")

\* EKS-4-6, EKS-4-8, E-03: the sequence has two good endings, its expiry with one output is the other
LOCAL EndsWell(i) == fplcState \in {"PulseZeros", "OneOutput"} /\ Cardinality(i.vec) = 1
IsExpired_ExpiryIsSuccess(i) == Now(i) >= Deadline /\ fplcState \in Timed /\ ~EndsWell(i)
AwaitPulseZeros_ExpiryIsSuccess(i) ==
    /\ fplcState = "PulseZeros" /\ i.vec # {}
    /\ IF Now(i) >= Deadline /\ EndsWell(i) THEN TakeOutput(i) ELSE Wait(i, T_SEQ) /\ Did("AwaitPulseZeros")

----------------------------------------------------------------------------
(* Authorization and selection.                                            *)

\* EKS-2-12, E-54: step 12 publishes the level whatever stands in MW03 and MW07
EarlyWord_EarlyWordsAccepted(i) == FALSE

\* EKS-T2-3, E-02: the example after Table 2 gives level 3 the output C
LevelOf_OutputCIsLevel3(output) == IF output = 2 THEN 3 ELSE output

\* EKS-2-17, EKS-2-20, E-65: MW07 is not looked at before step 27
Silent_EarlyAcknowledgmentIgnored(i) == TRUE

\* EKS-2-12, E-18: the level is what stands in the flag word MW01, which something else may have overwritten
MayBeSelected_AuthorityFromMW01(i) == Permitted(ModeOf(RE, i.MW01), ModeOf(SE, i.MW03))

\* EKS-5-1 to the end of Figure 5, E-12: row by row; a selection is refused by a row, and nothing else is
LOCAL Figure5(level, word) ==
    \/ level = 4
    \/ /\ word # SE[4]
       /\ level = 3 \/ (word # SE[3] /\ (level = 2 \/ (word # SE[2] /\ (level = 1 \/ word # SE[1]))))
\* E-12: for a level that is one of five, with Figure 6 after it, the rows say for every word what the total
\* order says
ASSUME PERMITS # TotalOrder \/ \A level \in MSO : \A word \in WordClasses :
    (Figure5(level, word) /\ ModeOf(SE, word) # None) = Permitted(level, ModeOf(SE, word))
MayBeSelected_Figure5FallsThrough(i) == Figure5(authority, i.MW03) /\ ModeOf(SE, i.MW03) # None
\* EKS-5-1, E-12: the same rows, with whatever stands in MW01
MayBeSelected_Figure5ReadsMW01(i) == Figure5(ModeOf(RE, i.MW01), i.MW03) /\ ModeOf(SE, i.MW03) # None

\* EKS-2-29, E-71: there is nothing to do for the mode that is active
AcceptSelection_ActiveModeSkipped(i) ==
    /\ fplcState = "CheckSelection" /\ Silent(i) /\ MayBeSelected(i)
    /\ IF ModeOf(SE, i.MW03) \in mode THEN EnterSettle /\ Did("WithdrawSelection")
       ELSE /\ fplcState' = "EchoSelection" /\ fplcElapsed' = 0
            /\ fplcSelection' = ModeOf(SE, i.MW03)
            /\ KeepKey /\ UNCHANGED mode
            /\ Did("AcceptSelection")

----------------------------------------------------------------------------
(* Echo, acknowledgment, switchover.                                       *)

\* EKS-2-19, EKS-2-28, E-61: step 19 is over once the selection was accepted; what MW03 shows later takes it
\* back, be it a code or not
IsNoCode_CodeCheckedOnce(i) == FALSE

\* EKS-2-20, E-14: the step that echoes reads MW03 once more, and takes any word of the range
SelectionStands_SplitCheck(i) ==
    IF fplcState = "EchoSelection" THEN ModeOf(SE, i.MW03) # None ELSE i.MW03 = SE[fplcSelection]
PublishEcho_SplitCheck(i) ==
    /\ StandsIn("EchoSelection", i) /\ Silent(i)
    /\ fplcSelection' = ModeOf(SE, i.MW03)
    /\ fplcState' = "AwaitAcknowledgment" /\ fplcElapsed' = 0
    /\ KeepKey /\ UNCHANGED mode
    /\ Did("PublishEcho")

\* EKS-2-27, E-11: the text has no wait for the acknowledgment: the step reads MW07, and zero is no code
AwaitMW07_NoWaitForMW07(i) ==
    StandsIn("AwaitAcknowledgment", i) /\ i.MW07 = 0 /\ EnterError /\ Did("RefuseAcknowledgment")

\* EKS-2-27, E-66: MW07 is judged in step 27 and not looked at again
IsAcknowledgment_AcknowledgmentReadOnce(i) == i.MW07 = SW[fplcSelection]
Matches_AcknowledgmentReadOnce(i) == TRUE
WithdrawAcknowledgment_AcknowledgmentReadOnce(i) ==
    StandsIn("CheckAcknowledgment", i) /\ i.MW07 = 0 /\ EnterSettle /\ Did("WithdrawAcknowledgment")

LOCAL Switchover(i, m, next) ==
    /\ StandsIn("Switch", i) /\ Matches(i)
    /\ mode' = {m} /\ fplcSelection' = None /\ KeepKey
    /\ fplcState' = next /\ fplcElapsed' = 0
    /\ Did("SwitchMode")

\* EKS-7-5, E-01: row 5 of Figure 7 has the word of MSO 3 in the row of MSO 2; in a chain that falls through,
\* MSO 3 confirms MSO 2, and the mode that is set is the one in MW07
LOCAL Row5 == SW[IF fplcSelection = 2 THEN 3 ELSE fplcSelection]
Matches_Figure7(i) == i.MW07 = Row5
SwitchMode_Figure7(i) == Switchover(i, ModeOf(SW, i.MW07), "Settle")
\* EKS-7-5, E-01: in a chain whose rows exclude one another, nothing confirms MSO 2
Matches_Figure7Exclusive(i) == i.MW07 = SW[fplcSelection] /\ fplcSelection # 2

\* EKS-2-28, E-16: step 28 compares MW07 with MW03 as it stands then
LOCAL LivePair(i) == ModeOf(SW, i.MW07) # None /\ ModeOf(SW, i.MW07) = ModeOf(SE, i.MW03)
SelectionStands_LiveMW03(i) == ModeOf(SE, i.MW03) # None
Matches_LiveMW03(i) == i.MW07 = SW[fplcSelection] \/ LivePair(i)
SwitchMode_LiveMW03(i) == Switchover(i, ModeOf(SW, i.MW07), "Settle")

\* EKS-GP-5, E-15: nothing takes the words back after a switchover
SwitchMode_NoSettle(i) == Switchover(i, fplcSelection, "AwaitSelection")

\* EKS-2-12, EKS-2-17, E-59: the level stays on MW01 while the words return to zero
MW01_SettleKeepsMW01 == IF fplcState \in Authorized \cup {"Settle"} THEN RE[authority] ELSE 0

\* EKS-8-15, E-27: no step takes the last echo back
MW05_MW05Kept == IF fplcState # "EchoSelection" /\ fplcSelection # None THEN CH[fplcSelection] ELSE 0
EnterClear_MW05Kept ==
    /\ fplcState' = "Clear" /\ fplcElapsed' = 0
    /\ accepted' = None /\ authority' = None
    /\ UNCHANGED <<fplcSelection, mode>>

----------------------------------------------------------------------------
(* Zeros that return, and for how long.                                    *)

\* EKS-8-12, EKS-8-14, EKS-8-18, E-52: zeros count as soon as they are seen; everywhere, or in one of the four
\* states that wait for them
Dwelt_NoDwell(i) == TRUE
Dwelt_NoDwellAtStart(i) == Now(i) >= T_DWELL \/ fplcState = "Start"
Dwelt_NoDwellInSettle(i) == Now(i) >= T_DWELL \/ fplcState = "Settle"
Dwelt_NoDwellInRemoval(i) == Now(i) >= T_DWELL \/ fplcState = "AwaitZeros"
Dwelt_NoDwellInError(i) == Now(i) >= T_DWELL \/ fplcState = "Error"

\* EKS-9-1-FPLC, E-28: LA alone says that the key is out
NoSignal_LAEndsRemoval(i) == ~i.LA
\* EKS-8-13, E-29: the removal tests the outputs and not LA
NoSignal_LANotChecked(i) == i.vec = {}

----------------------------------------------------------------------------
(* Removal, and the way out of the error mode.                             *)

\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-31: MW03, LA and the outputs are tested first, and step 18 then
\* looks at MW07 alone
LOCAL FirstZeros(i) == i.MW03 = 0 /\ NoSignal(i)
ZerosReturned_ZerosOneByOne(i) ==
    /\ (NoSignal(i) /\ NoWords(i)) \/ (fplcState = "AwaitZeros" /\ i.MW07 = 0)
    /\ Dwelt(i)
ClearWords_ZerosOneByOne(i) ==
    /\ fplcState = "Clear"
    /\ IF FirstZeros(i) THEN GoOn("AwaitZeros", i) /\ Did("ClearWords")
       ELSE Wait(i, T_REM) /\ Did("AwaitReturnedZeros")

\* EKS-9-2, EKS-9-3, E-34: Figure 9 goes on with the first step of the insertion
ClearWords_RemovalRunsInsertSteps(i) == fplcState = "Clear" /\ Proceed("PulseOnes") /\ Did("ClearWords")

\* EKS-9-4-FPLC, E-36: each change of LA begins the removal anew
AwaitReturnedZeros_BounceRestartsTimer(i) ==
    /\ fplcState = "AwaitZeros" /\ ~ZerosReturned(i)
    /\ IF i.LA THEN Proceed("AwaitZeros") ELSE Wait(i, T_REM)
    /\ Did("AwaitReturnedZeros")

\* EKS-9-4-FPLC, E-17, E-36: a key starts the insertion at once, the removal is not finished
LOCAL InsertDuringRemoval(i) == i.LA /\ Proceed("PulseOnes") /\ Did("InsertDuringRemoval")
AwaitReturnedZeros_InsertDuringRemoval(i) ==
    /\ fplcState = "AwaitZeros" /\ ~ZerosReturned(i)
    /\ InsertDuringRemoval(i) \/ (~i.LA /\ Wait(i, T_REM) /\ Did("AwaitReturnedZeros"))

\* EKS-8-18, E-32: MW07 is tested once, and what is not zero then is an error
LOCAL LateMW07(i) == NoSignal(i) /\ i.MW03 = 0 /\ i.MW07 # 0 /\ Dwelt(i)
LOCAL RefuseLateZero(i) == LateMW07(i) /\ EnterError /\ Did("RefuseLateZero")
AwaitReturnedZeros_MW07TestedOnce(i) ==
    /\ fplcState = "AwaitZeros" /\ ~ZerosReturned(i)
    /\ RefuseLateZero(i) \/ (~LateMW07(i) /\ Wait(i, T_REM) /\ Did("AwaitReturnedZeros"))

\* EKS-GP-4, E-23: the same key goes on where it was
EnterError_RecoverIntoTransaction ==
    /\ fplcState' = "Error" /\ fplcElapsed' = 0
    /\ IF fplcSelection # None THEN KeepKey /\ UNCHANGED fplcSelection ELSE DropKey
    /\ mode' = IF ON_ERROR = "none" THEN {} ELSE mode
StayInError_RecoverIntoTransaction(i) ==
    /\ fplcState = "Error" /\ ~ZerosReturned(i)
    /\ IF fplcSelection # None /\ i.LA /\ i.vec = {accepted}
       THEN Proceed("EchoSelection") /\ Did("ResumeTransaction")
       ELSE /\ UNCHANGED <<fplcState, mode>> /\ DropKey
            /\ fplcElapsed' = IF Now(i) < T_DWELL THEN Now(i) ELSE T_DWELL
            /\ Did("StayInError")
LeaveError_RecoverIntoTransaction(i) ==
    /\ fplcState = "Error" /\ ZerosReturned(i)
    /\ fplcState' = "Idle" /\ fplcElapsed' = 0 /\ DropKey /\ UNCHANGED mode
    /\ Did("LeaveError")

\* EKS-3-0, EKS-9-0, E-23b: the error mode goes into the removal once no key is signalled, whose timer leads
\* back
StayInError_ErrorIntoRemoval(i) ==
    /\ fplcState = "Error"
    /\ IF NoSignal(i) THEN Proceed("AwaitZeros") /\ Did("ErrorIntoRemoval")
       ELSE Wait(i, T_DWELL) /\ Did("StayInError")
LeaveError_ErrorIntoRemoval(i) == FALSE

----------------------------------------------------------------------------
(* Readings that meet in one operator, for all of the note at once (E-77). *)

\* Figure7, SplitCheck, LiveMW03 and NoSettle
SelectionStands_SwitchoverAsPrinted(i) == SelectionStands_LiveMW03(i)
PublishEcho_SwitchoverAsPrinted(i) == PublishEcho_SplitCheck(i)
Matches_SwitchoverAsPrinted(i) == i.MW07 = Row5 \/ LivePair(i)
SwitchMode_SwitchoverAsPrinted(i) == Switchover(i, ModeOf(SW, i.MW07), "AwaitSelection")

\* ExpiryIsSuccess, NoRemovalTimer and SuccessBeforeExpiry
IsExpired_DeadlinesAsPrinted(i) == IsExpired_NoRemovalTimer(i) /\ ~EndsWell(i) /\ ~Awaited(i)
AwaitPulseZeros_DeadlinesAsPrinted(i) == AwaitPulseZeros_ExpiryIsSuccess(i)

\* InsertDuringRemoval and MW07TestedOnce
AwaitReturnedZeros_RemovalAsPrinted(i) ==
    /\ fplcState = "AwaitZeros" /\ ~ZerosReturned(i)
    /\ \/ InsertDuringRemoval(i) \/ RefuseLateZero(i)
       \/ ~i.LA /\ ~LateMW07(i) /\ Wait(i, T_REM) /\ Did("AwaitReturnedZeros")

\* ZerosOneByOne and RemovalRunsInsertSteps
ZerosReturned_ClearAsPrinted(i) == ZerosReturned_ZerosOneByOne(i)
ClearWords_ClearAsPrinted(i) ==
    /\ fplcState = "Clear"
    /\ IF FirstZeros(i) THEN Proceed("PulseOnes") /\ Did("ClearWords")
       ELSE Wait(i, T_REM) /\ Did("AwaitReturnedZeros")
=============================================================================
