------------------- MODULE TestableSafetySensorAsPrinted --------------------
(***************************************************************************)
(* What the text of SF_TestableSafetySensor could be taken to say, where   *)
(* we decided otherwise: one section a reading.  Op_Reading takes the      *)
(* place of Op in the runs that try the reading.  What the family's text   *)
(* could be taken to say about Reset (TSSF-24) stands in                   *)
(* CyclicBlockAsPrinted.                                                   *)
(***************************************************************************)
EXTENDS TestableSafetySensor

----------------------------------------------------------------------------
\* TSSF-02, TSS-C031, TSS-C051: C031 as printed, in 8406.  A Reset that is held after the manual test is then
\* no error, and C051 is never shown
FindStaticReset4_C031In8406(i) ==
    At("WaitForReset2", i) /\ StaticInWait(i) /\ To("ResetError4") /\ Did("FindStaticReset4")
FindStaticReset6_C031In8406(i) == FALSE
Tested_C031In8406(i) == At("EndExternalTest", i)
CameFrom_C031In8406(i) ==
    CASE state = "ResetError1" -> "Init"
      [] state = "ResetError2" -> "WaitForReset1"
      [] state = "ResetError3" -> TestErrorShown(i)
      [] state = "ResetError4" -> "WaitForReset2"
      [] state = "ResetError5" -> "ParameterError"

----------------------------------------------------------------------------
\* TSSF-05, TSS-0000, TSS-OUT-TESTOUT: all outputs are FALSE in Idle, S_TestOut too
IdleRow_TestOutFalseInIdle == OutputRow(\h0000, FALSE, FALSE, FALSE, FALSE, FALSE, FALSE, FALSE, FALSE)

----------------------------------------------------------------------------
\* TSSF-06, TSS-TEST-0: one time for both phases of the test
SeeDark_OneMeasurement(i) ==
    /\ At("TestRequest", i) /\ ~Expired(i) /\ ~Free(i)
    /\ GoTo("TestActive") /\ UNCHANGED startInhibit
    /\ elapsed' = Counted(elapsed, i.dt, TEST_TIME)
    /\ Did("SeeDark")

----------------------------------------------------------------------------
\* TSSF-07, TSS-ERR-1, TSS-ERR-2: a reaction in the call in which the time is over still counts
Expired_SuccessBeforeExpiry(i) ==
    elapsed + i.dt >= TEST_TIME /\ (IF state = "TestRequest" THEN Free(i) ELSE ~Free(i))

----------------------------------------------------------------------------
\* TSSF-08, TSS-TEST-0, TSS-ERR-1, TSS-ERR-2: the time is over only after TestTime
Expired_ExpiresAfterTestTime(i) == elapsed + i.dt > TEST_TIME

----------------------------------------------------------------------------
\* TSSF-11, TSS-C000, TSS-C001: a static Reset is found before TestTime is looked at
RefuseTestTime_StaticResetBeforeTestTime(i) ==
    At("Init", i) /\ ~StaticAtStart(i) /\ ~TestTimeValid /\ To("ParameterError") /\ Did("RefuseTestTime")
FindStaticReset1_StaticResetBeforeTestTime(i) ==
    At("Init", i) /\ StaticAtStart(i) /\ To("ResetError1") /\ Did("FindStaticReset1")

----------------------------------------------------------------------------
\* TSSF-12, TSS-C000, TSS-ERR-4: an edge of Reset leaves the parameter error
StayInParameterError_ResetLeavesParameterError(i) ==
    /\ At("ParameterError", i) /\ ~ResetStatic(i)
    /\ IF ResetRises(i) THEN To("Init") ELSE Stay
    /\ Did("StayInParameterError")

----------------------------------------------------------------------------
\* TSSF-13, TSS-IN-NOEXT-FALSE: the manual test begins by itself, without a reset
NeedsExternalTest_ExternalTestWithoutReset(i) == ~i.NoExternalTest

----------------------------------------------------------------------------
\* TSSF-14, TSS-EB-2, TSS-IN-NOEXT-FALSE: a reset of any test error enables where the sensor is free, and the
\* manual test is made only where it is not
EnablesAtOnce_ResetEnablesDespiteExternalTest(i) == ErrorEnds(i) /\ Free(i)
NeedsExternalTest_ResetEnablesDespiteExternalTest(i) == ErrorEnds(i) /\ ~i.NoExternalTest /\ ~Free(i)

----------------------------------------------------------------------------
\* TSSF-16, TSS-8002, TSS-8804: a sensor that is dark begins the manual test, without an edge
Falls_ExternalTestByLevel(i) == ~Free(i)

----------------------------------------------------------------------------
\* TSSF-17, TSS-CX10: x stays as it was when the time expired
ShowTestError_XDecidedAtExpiry(i) ==
    Failed(i) /\ ~EnablesAtOnce(i) /\ ~NeedsExternalTest(i) /\ To(state) /\ Did("ShowTestError")

----------------------------------------------------------------------------
\* TSSF-18, TSS-EB-2, TSS-C410: an edge of Reset counts also in the call in which the sensor becomes free
\* again
EnablesAtOnce_EdgeCountsWhenSensorReturns(i) == ErrorEnds(i) /\ Resettable(i)

----------------------------------------------------------------------------
\* TSSF-19, TSS-FN-3, TSS-IN-STARTRESET: an interruption at the start is one like others, and ends the
\* start-up inhibit
InterruptStart_StartInhibitEndsWithInterruption(i) ==
    Starting(i) /\ ~Free(i) /\ Released("ESPEInterrupted1") /\ Did("InterruptStart")

----------------------------------------------------------------------------
\* TSSF-20, TSS-IN-AUTORESET, TSS-8402, TSS-8406: who waits for a reset waits for its edge, also when
\* S_AutoReset comes
LOCAL StillInhibited(i) == (i.S_AutoReset => startInhibit) \/ state \in {"WaitForReset1", "WaitForReset2"}
StaticInWait_WaitForResetNeedsEdge(i) == ResetStatic(i) /\ StillInhibited(i)
RestartAllowed_WaitForResetNeedsEdge(i) == StillInhibited(i) => ResetRises(i)

----------------------------------------------------------------------------
\* TSSF-21, TSS-REL-1, TSS-IN-RESET: a reset comes before the loss of the sensor
LostAgain_ResetBeforeInterruption(i) == ~Free(i) /\ ~RestartAllowed(i)

----------------------------------------------------------------------------
\* TSSF-22, TSS-TEST-1, TSS-FN-1: a test comes before the loss of the sensor
Lost_TestBeforeInterruption(i) == ~Free(i) /\ ~TestAsked(i)

----------------------------------------------------------------------------
\* TSSF-23, TSS-IN-STARTTEST, TSS-NOTE-4: StartTest acts for as long as it is TRUE
TestAsked_StartTestByLevel(i) == i.StartTest

----------------------------------------------------------------------------
\* TSSF-31, TSS-8404, TSS-8804: an interruption at the end of the manual test is none
InterruptExternal_ManualTestSeenOnce(i) == FALSE
EndManualTest_ManualTestSeenOnce(i) ==
    Tested(i) /\ ErrorEnds(i) /\ Released("ESPEFreeNoTest") /\ Did("EndManualTest")
AwaitExternalReset_ManualTestSeenOnce(i) == Tested(i) /\ ~ErrorEnds(i) /\ Stay /\ Did("AwaitExternalReset")
=============================================================================
