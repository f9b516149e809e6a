------------------------ MODULE TestableSafetySensor ------------------------
(***************************************************************************)
(* SF_TestableSafetySensor: an opto-electronic safety sensor whose sending *)
(* part the block switches off for a test, while its enable output stays   *)
(* TRUE.  The whole document: interface, test phases, four error rules,    *)
(* and the table of 22 codes with its rows of outputs.                     *)
(* One call is SensorScan(i), i being the inputs by their names and dt.    *)
(* The transitions are nowhere printed (TSSF-27); each action says from    *)
(* which clauses and findings it comes.                                    *)
(* Leaves out: bus and sensor response times (TSS-NOTE-1), data types, and *)
(* a TestTime that changes: it is a constant of the document.              *)
(***************************************************************************)
EXTENDS Integers, TLC, CyclicBlock

CONSTANTS
    TEST_TIME,           \* TestTime in ms; one tick is one ms
    AUTO_RESET_ERRORS    \* TSSF-15: TRUE: S_AutoReset ends test errors and manual tests too

VARIABLES
    startTestBefore,     \* StartTest as the call before this one read it
    sensorBefore,        \* S_OSSD_In as the call before this one read it
    startInhibit,        \* TSSF-19: the start-up inhibit outlives an interruption
    elapsed              \* time in this phase of the test

block == <<state, resetBefore, startTestBefore, sensorBefore, startInhibit, elapsed>>

ASSUME TEST_TIME \in Int /\ AUTO_RESET_ERRORS \in BOOLEAN

Testing == {"TestRequest", "TestActive"}
\* TSS-CX10: one error of the document, which shows one of two codes
TestErrors == {"TestError1C010", "TestError1C410"}
ResetErrors == {"ResetError1", "ResetError2", "ResetError3", "ResetError4", "ResetError5", "ResetError6"}
States ==
    {"Idle", "Init", "ESPEInterrupted1", "WaitForReset1", "ESPEFreeNoTest",
     "ExternalFunctionTest", "ESPEInterruptedExternalTest", "EndExternalTest",
     "ESPEFreeTestOk", "ESPEInterrupted2", "WaitForReset2", "ParameterError"}
    \cup Testing \cup TestErrors \cup ResetErrors

SensorTypeOK ==
    /\ state \in States
    /\ {resetBefore, startTestBefore, sensorBefore, startInhibit} \subseteq BOOLEAN
    /\ elapsed \in 0..(IF TEST_TIME > 0 THEN TEST_TIME ELSE 0)
    /\ state \notin Testing => elapsed = 0
    /\ state \notin {"ESPEInterrupted1", "WaitForReset1", "ResetError2"} => ~startInhibit

SensorInit ==
    /\ state = "Idle" /\ elapsed = 0 /\ startInhibit = FALSE
    /\ resetBefore = FALSE /\ startTestBefore = FALSE /\ sensorBefore = FALSE

----------------------------------------------------------------------------
(* Outputs: the row of the state, in the order of the document's table.    *)

LOCAL T == TRUE
LOCAL F == FALSE
\* TSS-OUT-READY, TSS-OUT-OSSD, TSS-OUT-TESTOUT, TSS-OUT-POSSIBLE, TSS-OUT-EXECUTED, TSS-OUT-DEMAND,
\* TSS-OUT-REQUEST, TSS-OUT-ERROR, TSS-OUT-DIAG
OutputRow(code, ready, ossd, testOut, possible, executed, demand, request, error) ==
    [DiagCode |-> code, Ready |-> ready, S_OSSD_Out |-> ossd, S_TestOut |-> testOut,
     TestPossible |-> possible, TestExecuted |-> executed, SafetyDemand |-> demand,
     ResetRequest |-> request, Error |-> error]

\* TSS-0000, TSSF-05: an inactive block does not switch the sender of the sensor off
IdleRow == OutputRow(\h0000, F, F, T, F, F, F, F, F)

\* TSS-0000, TSS-8401, TSS-8802, TSS-8402, TSS-8002, TSS-8804, TSS-8404, TSS-8010, TSS-8806, TSS-8406,
\* TSS-8020, TSS-8030, TSS-8000,
\* TSS-C000, TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-C410, TSS-C010, TSS-EB-1,
\* TSSF-05, TSSF-30
Rows == TLCEval([s \in States |->
    CASE s = "ParameterError"              -> OutputRow(\hC000, T, F, T, F, F, F, F, T)
      [] s = "ResetError1"                 -> OutputRow(\hC001, T, F, T, F, F, F, F, T)
      [] s = "ResetError2"                 -> OutputRow(\hC011, T, F, T, F, F, F, F, T)
      [] s = "ResetError3"                 -> OutputRow(\hC021, T, F, T, F, F, F, F, T)
      [] s = "ResetError4"                 -> OutputRow(\hC031, T, F, T, F, F, F, F, T)
      [] s = "ResetError5"                 -> OutputRow(\hC041, T, F, T, F, F, F, F, T)
      [] s = "ResetError6"                 -> OutputRow(\hC051, T, F, T, F, T, F, F, T)
      [] s = "TestError1C410"              -> OutputRow(\hC410, T, F, T, F, F, F, T, T)
      [] s = "TestError1C010"              -> OutputRow(\hC010, T, F, T, F, F, F, F, T)
      [] s = "Idle"                        -> IdleRow
      [] s = "Init"                        -> OutputRow(\h8401, T, F, T, F, F, F, T, F)
      [] s = "ESPEInterrupted1"            -> OutputRow(\h8802, T, F, T, F, F, T, F, F)
      [] s = "WaitForReset1"               -> OutputRow(\h8402, T, F, T, F, F, F, T, F)
      [] s = "ExternalFunctionTest"        -> OutputRow(\h8002, T, F, T, F, F, F, F, F)
      [] s = "ESPEInterruptedExternalTest" -> OutputRow(\h8804, T, F, T, F, F, T, F, F)
      [] s = "EndExternalTest"             -> OutputRow(\h8404, T, F, T, F, F, F, T, F)
      [] s = "ESPEFreeNoTest"              -> OutputRow(\h8010, T, T, T, T, F, F, F, F)
      [] s = "ESPEInterrupted2"            -> OutputRow(\h8806, T, F, T, F, T, T, F, F)
      [] s = "WaitForReset2"               -> OutputRow(\h8406, T, F, T, F, T, F, T, F)
      [] s = "TestRequest"                 -> OutputRow(\h8020, T, T, F, F, F, F, F, F)
      [] s = "TestActive"                  -> OutputRow(\h8030, T, T, T, F, F, F, F, F)
      [] s = "ESPEFreeTestOk"              -> OutputRow(\h8000, T, T, T, T, T, F, F, F)])
SensorOutputs == Rows[state]

----------------------------------------------------------------------------
(* Guards and moves.                                                       *)

\* TSS-IN-TESTTIME, TSS-ERR-4
TestTimeValid == TEST_TIME \in 0..150
\* TSS-IN-OSSD
Free(i) == i.S_OSSD_In
\* TSS-IN-STARTTEST, TSS-NOTE-4, TSSF-23
TestAsked(i) == Rises(i.StartTest, startTestBefore)
\* TSS-TEST-0, TSS-ERR-1, TSS-ERR-2, TSSF-07, TSSF-08: the time is over, whether
\* or not the sensor reacts in this call
Expired(i) == elapsed + i.dt >= TEST_TIME
\* TSS-IN-AUTORESET, TSS-FN-2, TSSF-19, TSSF-20: somebody has to reset before the output may come again
LOCAL Inhibited(i) == i.S_AutoReset => startInhibit
\* TSS-EB-3, TSSF-15
LOCAL EndsByItself(i) == AUTO_RESET_ERRORS /\ i.S_AutoReset
\* TSS-EB-2, TSS-CX10: the error can be reset as it stands
Resettable(i) == Free(i) /\ i.NoExternalTest
\* TSS-CX10, TSS-C010, TSS-C410
TestErrorShown(i) == IF Resettable(i) THEN "TestError1C410" ELSE "TestError1C010"

To(s) == GoTo(s) /\ elapsed' = 0 /\ UNCHANGED startInhibit
\* No start-up inhibit is pending any more
Released(s) == GoTo(s) /\ elapsed' = 0 /\ startInhibit' = FALSE
Stay == UNCHANGED <<state, elapsed, startInhibit>>
LOCAL Remembers(i) == RemembersReset(i) /\ startTestBefore' = i.StartTest /\ sensorBefore' = i.S_OSSD_In

----------------------------------------------------------------------------
(* Activation.                                                             *)

\* TSS-IN-ACTIVATE, TSS-0000: first of all, from every state
Deactivate(i) == ~i.Activate /\ state # "Idle" /\ Released("Idle") /\ Did("Deactivate")
\* TSS-IN-ACTIVATE, TSS-0000
StayIdle(i) == ~i.Activate /\ state = "Idle" /\ Stay /\ Did("StayIdle")
\* TSS-IN-ACTIVATE, TSS-8401, TSSF-24: an edge of Reset in this call acts on nothing
BecomeActive(i) == At("Idle", i) /\ To("Init") /\ Did("BecomeActive")

\* TSS-ERR-4, TSS-C000, TSS-IN-TESTTIME, TSSF-11: the first thing that an active block looks at
RefuseTestTime(i) == At("Init", i) /\ ~TestTimeValid /\ To("ParameterError") /\ Did("RefuseTestTime")
StaticAtStart(i) == ResetStatic(i) /\ ~i.S_StartReset
\* TSS-C001, TSS-ERR-3, TSS-IN-STARTRESET, TSSF-11
FindStaticReset1(i) ==
    At("Init", i) /\ TestTimeValid /\ StaticAtStart(i) /\ To("ResetError1") /\ Did("FindStaticReset1")
Starting(i) == At("Init", i) /\ TestTimeValid /\ ~StaticAtStart(i)
\* TSS-8802, TSS-FN-3, TSSF-19: the start-up inhibit outlives the interruption
InterruptStart(i) ==
    /\ Starting(i) /\ ~Free(i)
    /\ GoTo("ESPEInterrupted1") /\ UNCHANGED elapsed
    /\ startInhibit' = ~i.S_StartReset
    /\ Did("InterruptStart")
LOCAL StartAllowed(i) == ~i.S_StartReset => ResetRises(i)
\* TSS-EB-5, TSS-FN-3, TSS-IN-STARTRESET, TSS-IN-RESET, TSS-8010
EndStartInhibit(i) ==
    Starting(i) /\ Free(i) /\ StartAllowed(i) /\ Released("ESPEFreeNoTest") /\ Did("EndStartInhibit")
\* TSS-8401, TSS-EB-5
AwaitStartReset(i) == Starting(i) /\ Free(i) /\ ~StartAllowed(i) /\ Stay /\ Did("AwaitStartReset")
Activation(i) ==
    \/ Deactivate(i) \/ StayIdle(i) \/ BecomeActive(i)
    \/ RefuseTestTime(i) \/ FindStaticReset1(i)
    \/ InterruptStart(i) \/ EndStartInhibit(i) \/ AwaitStartReset(i)

----------------------------------------------------------------------------
(* The sensor is interrupted and free again: before a test (1), and after  *)
(* one that was passed (2).                                                *)

\* TSS-8802
AwaitFree1(i) == At("ESPEInterrupted1", i) /\ ~Free(i) /\ Stay /\ Did("AwaitFree1")
\* TSS-8402, TSS-8802, TSS-REL-1, TSSF-04, TSSF-19
BecomeFree1(i) ==
    At("ESPEInterrupted1", i) /\ Free(i) /\ Inhibited(i) /\ To("WaitForReset1") /\ Did("BecomeFree1")
\* TSS-IN-AUTORESET, TSS-FN-2, TSS-8010
Restart1(i) ==
    At("ESPEInterrupted1", i) /\ Free(i) /\ ~Inhibited(i) /\ Released("ESPEFreeNoTest") /\ Did("Restart1")
\* TSS-8806
AwaitFree2(i) == At("ESPEInterrupted2", i) /\ ~Free(i) /\ Stay /\ Did("AwaitFree2")
\* TSS-8406, TSS-8806, TSS-REL-1, TSSF-04
BecomeFree2(i) ==
    At("ESPEInterrupted2", i) /\ Free(i) /\ Inhibited(i) /\ To("WaitForReset2") /\ Did("BecomeFree2")
\* TSS-IN-AUTORESET, TSS-FN-2, TSS-8000
Restart2(i) ==
    At("ESPEInterrupted2", i) /\ Free(i) /\ ~Inhibited(i) /\ Released("ESPEFreeTestOk") /\ Did("Restart2")

\* TSSF-20: where S_AutoReset ends the inhibit there is nothing to wait for
StaticInWait(i) == ResetStatic(i) /\ Inhibited(i)
RestartAllowed(i) == Inhibited(i) => ResetRises(i)
\* TSSF-21: losing the sensor comes before the reset
LostAgain(i) == ~Free(i)
\* TSS-C011, TSS-ERR-3, TSSF-01
FindStaticReset2(i) ==
    At("WaitForReset1", i) /\ StaticInWait(i) /\ To("ResetError2") /\ Did("FindStaticReset2")
LOCAL Waiting1(i) == At("WaitForReset1", i) /\ ~StaticInWait(i)
\* TSS-8802, TSS-FN-1, TSSF-21
InterruptWait1(i) == Waiting1(i) /\ LostAgain(i) /\ To("ESPEInterrupted1") /\ Did("InterruptWait1")
\* TSS-8402, TSS-EB-4, TSS-REL-1, TSS-IN-RESET, TSSF-20
EndRestartInhibit1(i) ==
    /\ Waiting1(i) /\ ~LostAgain(i) /\ RestartAllowed(i)
    /\ Released("ESPEFreeNoTest") /\ Did("EndRestartInhibit1")
\* TSS-8402
AwaitReset1(i) == Waiting1(i) /\ ~LostAgain(i) /\ ~RestartAllowed(i) /\ Stay /\ Did("AwaitReset1")

\* TSS-C051, TSS-ERR-3, TSSF-02, TSSF-03
FindStaticReset6(i) ==
    At("WaitForReset2", i) /\ StaticInWait(i) /\ To("ResetError6") /\ Did("FindStaticReset6")
LOCAL Waiting2(i) == At("WaitForReset2", i) /\ ~StaticInWait(i)
\* TSS-8806, TSS-FN-1, TSSF-21
InterruptWait2(i) == Waiting2(i) /\ LostAgain(i) /\ To("ESPEInterrupted2") /\ Did("InterruptWait2")
\* TSS-8406, TSS-EB-4, TSS-REL-1, TSS-IN-RESET, TSSF-20
EndRestartInhibit2(i) ==
    /\ Waiting2(i) /\ ~LostAgain(i) /\ RestartAllowed(i)
    /\ Released("ESPEFreeTestOk") /\ Did("EndRestartInhibit2")
\* TSS-8406
AwaitReset2(i) == Waiting2(i) /\ ~LostAgain(i) /\ ~RestartAllowed(i) /\ Stay /\ Did("AwaitReset2")
Interruption(i) ==
    \/ AwaitFree1(i) \/ BecomeFree1(i) \/ Restart1(i) \/ AwaitFree2(i) \/ BecomeFree2(i) \/ Restart2(i)
    \/ FindStaticReset2(i) \/ InterruptWait1(i) \/ EndRestartInhibit1(i) \/ AwaitReset1(i)
    \/ FindStaticReset6(i) \/ InterruptWait2(i) \/ EndRestartInhibit2(i) \/ AwaitReset2(i)

----------------------------------------------------------------------------
(* The sensor is free, and its test.                                       *)

\* TSSF-22: losing the sensor comes before the test
Lost(i) == ~Free(i)
\* TSS-FN-1, TSS-8802, TSSF-22
Interrupt1(i) == At("ESPEFreeNoTest", i) /\ Lost(i) /\ To("ESPEInterrupted1") /\ Did("Interrupt1")
\* TSS-TEST-1, TSS-IN-STARTTEST, TSS-8020, TSSF-23
StartTest1(i) ==
    At("ESPEFreeNoTest", i) /\ ~Lost(i) /\ TestAsked(i) /\ To("TestRequest") /\ Did("StartTest1")
\* TSS-8010
StayFree1(i) == At("ESPEFreeNoTest", i) /\ ~Lost(i) /\ ~TestAsked(i) /\ Stay /\ Did("StayFree1")
\* TSS-FN-1, TSS-8806, TSSF-22
Interrupt2(i) == At("ESPEFreeTestOk", i) /\ Lost(i) /\ To("ESPEInterrupted2") /\ Did("Interrupt2")
\* TSS-TEST-1, TSS-IN-STARTTEST, TSS-8020, TSSF-23
StartTest2(i) ==
    At("ESPEFreeTestOk", i) /\ ~Lost(i) /\ TestAsked(i) /\ To("TestRequest") /\ Did("StartTest2")
\* TSS-8000, TSS-OUT-EXECUTED
StayFree2(i) == At("ESPEFreeTestOk", i) /\ ~Lost(i) /\ ~TestAsked(i) /\ Stay /\ Did("StayFree2")

\* TSS-ERR-2, TSS-CX10, TSS-FN-6C, TSSF-07, TSSF-08, TSSF-29
ExpireRequest(i) ==
    At("TestRequest", i) /\ Expired(i) /\ To(TestErrorShown(i)) /\ Did("ExpireRequest")
\* TSS-TEST-2, TSS-TEST-0, TSS-8030, TSSF-06, TSSF-09
SeeDark(i) ==
    At("TestRequest", i) /\ ~Expired(i) /\ ~Free(i) /\ To("TestActive") /\ Did("SeeDark")
LOCAL Waits(i) ==
    UNCHANGED <<state, startInhibit>> /\ elapsed' = Counted(elapsed, i.dt, TEST_TIME)
\* TSS-8020, TSS-TEST-1
AwaitDark(i) ==
    At("TestRequest", i) /\ ~Expired(i) /\ Free(i) /\ Waits(i) /\ Did("AwaitDark")
\* TSS-ERR-1, TSS-CX10, TSS-FN-6A, TSS-FN-6B, TSSF-07, TSSF-08, TSSF-29
ExpireActive(i) ==
    At("TestActive", i) /\ Expired(i) /\ To(TestErrorShown(i)) /\ Did("ExpireActive")
\* TSS-TEST-3, TSS-8000, TSS-FN-5, TSS-OUT-EXECUTED
SeeFree(i) ==
    At("TestActive", i) /\ ~Expired(i) /\ Free(i) /\ To("ESPEFreeTestOk") /\ Did("SeeFree")
\* TSS-8030, TSS-TEST-2, TSSF-09
AwaitFree(i) == At("TestActive", i) /\ ~Expired(i) /\ ~Free(i) /\ Waits(i) /\ Did("AwaitFree")
Test(i) ==
    \/ Interrupt1(i) \/ StartTest1(i) \/ StayFree1(i) \/ Interrupt2(i) \/ StartTest2(i) \/ StayFree2(i)
    \/ ExpireRequest(i) \/ SeeDark(i) \/ AwaitDark(i) \/ ExpireActive(i) \/ SeeFree(i) \/ AwaitFree(i)

----------------------------------------------------------------------------
(* A failed test, and the manual test where there is one.                  *)

LOCAL AtTestError(i) == state \in TestErrors /\ i.Activate
LOCAL StaticInError(i) == ResetStatic(i) /\ ~EndsByItself(i)
ErrorEnds(i) == ~EndsByItself(i) => ResetRises(i)
\* TSS-C021, TSS-ERR-3
FindStaticReset3(i) == AtTestError(i) /\ StaticInError(i) /\ To("ResetError3") /\ Did("FindStaticReset3")
\* TSS-EB-2, TSS-C410, TSS-IN-NOEXT-TRUE, TSSF-14, TSSF-18: only where the call before asked for the reset
EnablesAtOnce(i) == ErrorEnds(i) /\ Resettable(i) /\ state = "TestError1C410"
\* TSS-IN-NOEXT-FALSE, TSSF-13
NeedsExternalTest(i) == ErrorEnds(i) /\ ~i.NoExternalTest
Failed(i) == AtTestError(i) /\ ~StaticInError(i)
\* TSS-EB-2, TSS-EB-3, TSS-C410, TSS-IN-NOEXT-TRUE, TSS-IN-RESET, TSSF-14, TSSF-15, TSSF-18
ResetTestError(i) == Failed(i) /\ EnablesAtOnce(i) /\ Released("ESPEFreeNoTest") /\ Did("ResetTestError")
\* TSS-IN-NOEXT-FALSE, TSS-8002, TSS-C010, TSSF-13, TSSF-15
RequireExternalTest(i) ==
    Failed(i) /\ NeedsExternalTest(i) /\ To("ExternalFunctionTest") /\ Did("RequireExternalTest")
\* TSS-CX10, TSS-C010, TSS-C410, TSS-EB-1, TSSF-17
ShowTestError(i) ==
    Failed(i) /\ ~EnablesAtOnce(i) /\ ~NeedsExternalTest(i) /\ To(TestErrorShown(i)) /\ Did("ShowTestError")

\* TSSF-16: a negative edge
Falls(i) == ~Free(i) /\ sensorBefore
\* TSS-8002, TSS-8804, TSSF-16
BeginExternalTest(i) ==
    At("ExternalFunctionTest", i) /\ Falls(i) /\ To("ESPEInterruptedExternalTest") /\ Did("BeginExternalTest")
\* TSS-8002, TSSF-16
AwaitExternalTest(i) == At("ExternalFunctionTest", i) /\ ~Falls(i) /\ Stay /\ Did("AwaitExternalTest")
\* TSS-8804, TSS-8404
BecomeFreeExternal(i) ==
    At("ESPEInterruptedExternalTest", i) /\ Free(i) /\ To("EndExternalTest") /\ Did("BecomeFreeExternal")
\* TSS-8804
AwaitFreeExternal(i) == At("ESPEInterruptedExternalTest", i) /\ ~Free(i) /\ Stay /\ Did("AwaitFreeExternal")
\* TSS-C031, TSS-ERR-3, TSSF-02
FindStaticReset4(i) ==
    At("EndExternalTest", i) /\ StaticInError(i) /\ To("ResetError4") /\ Did("FindStaticReset4")
Tested(i) == At("EndExternalTest", i) /\ ~StaticInError(i)
\* TSS-8804, TSS-8404, TSSF-31
InterruptExternal(i) ==
    Tested(i) /\ ~Free(i) /\ To("ESPEInterruptedExternalTest") /\ Did("InterruptExternal")
\* TSS-8404, TSS-IN-NOEXT-FALSE, TSS-IN-RESET, TSS-8010, TSSF-15, TSSF-31
EndManualTest(i) ==
    Tested(i) /\ Free(i) /\ ErrorEnds(i) /\ Released("ESPEFreeNoTest") /\ Did("EndManualTest")
\* TSS-8404
AwaitExternalReset(i) == Tested(i) /\ Free(i) /\ ~ErrorEnds(i) /\ Stay /\ Did("AwaitExternalReset")
TestFailed(i) ==
    \/ FindStaticReset3(i) \/ ResetTestError(i) \/ RequireExternalTest(i) \/ ShowTestError(i)
    \/ BeginExternalTest(i) \/ AwaitExternalTest(i) \/ BecomeFreeExternal(i) \/ AwaitFreeExternal(i)
    \/ FindStaticReset4(i) \/ InterruptExternal(i) \/ EndManualTest(i) \/ AwaitExternalReset(i)

----------------------------------------------------------------------------
(* A TestTime out of its range, and a Reset that is held or stuck.         *)

\* TSS-C041, TSS-ERR-3
FindStaticReset5(i) ==
    At("ParameterError", i) /\ ResetStatic(i) /\ To("ResetError5") /\ Did("FindStaticReset5")
\* TSS-C000, TSSF-12: TestTime is a constant, so that no reset can help
StayInParameterError(i) ==
    At("ParameterError", i) /\ ~ResetStatic(i) /\ Stay /\ Did("StayInParameterError")

\* TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSSF-01, TSSF-02, TSSF-03: back to where the
\* static Reset was found
CameFrom(i) ==
    CASE state = "ResetError1" -> "Init"
      [] state = "ResetError2" -> "WaitForReset1"
      [] state = "ResetError3" -> TestErrorShown(i)
      [] state = "ResetError4" -> "EndExternalTest"
      [] state = "ResetError5" -> "ParameterError"
      [] state = "ResetError6" -> "WaitForReset2"
\* TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-ERR-3, TSSF-24
LeaveResetError(i) ==
    state \in ResetErrors /\ i.Activate /\ ~i.Reset /\ To(CameFrom(i)) /\ Did("LeaveResetError")
\* TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051
StayInResetError(i) == state \in ResetErrors /\ i.Activate /\ i.Reset /\ Stay /\ Did("StayInResetError")
Errors(i) == FindStaticReset5(i) \/ StayInParameterError(i) \/ LeaveResetError(i) \/ StayInResetError(i)

\* One call: every call remembers its inputs, and takes exactly one of these
SensorScan(i) == Remembers(i) /\ (Activation(i) \/ Interruption(i) \/ Test(i) \/ TestFailed(i) \/ Errors(i))
=============================================================================
