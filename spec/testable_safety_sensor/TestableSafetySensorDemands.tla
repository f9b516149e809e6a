-------------------- MODULE TestableSafetySensorDemands ---------------------
(***************************************************************************)
(* What the sentences of the page demand of the block, seen from outside:  *)
(* a second reading beside demands.toml, written from the clauses.  The    *)
(* observer reads inputs and outputs, never the state of the block.  What  *)
(* must never be is judged in the very call, as a call reads its inputs at *)
(* once; what must come has LATENCY calls for each step that a block may   *)
(* need.  The phases of a test are what the table shows: S_OSSD_Out        *)
(* without TestPossible, and S_TestOut tells the two apart.  NoExternalTest*)
(* is a constant of the page, and does not change here.                    *)
(* Leaves out what the page leaves open: an error while S_AutoReset is     *)
(* TRUE (TSSF-15), and which inhibit an input switches off (TSSF-34).      *)
(***************************************************************************)
EXTENDS TestableSafetySensorOpen

CONSTANT LATENCY    \* calls that a block may take for a step
ASSUME LATENCY \in Nat

VARIABLES
    lastReset,      \* Reset in the call before
    lastStart,      \* StartTest in the call before
    lastFree,       \* S_OSSD_In in the call before
    noManualTest,   \* NoExternalTest
    spent,          \* ms for which this phase of a test is shown
    passed,         \* the last test ended with the sensor free
    wasTested,      \* TestExecuted, as it was shown with the enable and outside a test
    failed,         \* a test has failed, and nothing was enabled since
    switched,       \* since then the sensor went dark by hand (1), and is free again (2)
    uninhibited,    \* S_StartReset and S_AutoReset were TRUE in every call since the activation
    troubled,       \* an error was shown since the last enable
    ripe,           \* calls for which this code is shown, the sensor is free and Reset is FALSE
    waits           \* of what must come: calls for which it has not

watched ==
    <<lastReset, lastStart, lastFree, noManualTest, spent, passed, wasTested, failed, switched, uninhibited,
      troubled, ripe, waits>>
DemandsView == <<View, watched>>

MustCome ==
    {"ready", "runs", "enable", "lost", "return", "test", "sender", "end", "failure", "mend", "manual", "dark",
     "cycle", "held", "stuck", "refused"}

DemandsInit ==
    /\ OpenInit
    /\ lastReset = FALSE /\ lastStart = FALSE /\ lastFree = FALSE /\ noManualTest \in BOOLEAN
    /\ spent = 0 /\ passed = FALSE /\ wasTested = FALSE /\ failed = FALSE /\ switched = 0
    /\ uninhibited = FALSE /\ troubled = FALSE /\ ripe = 0 /\ waits = [m \in MustCome |-> 0]

----------------------------------------------------------------------------
(* What a call shows.                                                      *)

Code == SensorOutputs.DiagCode
TestErrorCodes == {\hC010, \hC410}
\* TSS-8020, TSS-8030
InTest == Now("S_OSSD_Out") /\ ~Now("TestPossible")
StillInTest == Then("S_OSSD_Out") /\ ~Then("TestPossible")
\* TSS-TEST-3: a test ends without an error
Passes == InTest /\ Then("S_OSSD_Out") /\ Then("TestPossible")
\* TSS-ERR-1, TSS-ERR-2
Fails == InTest /\ Then("Error")
ResetEdge(i) == i.Reset /\ ~lastReset
Asks(i) == i.StartTest /\ ~lastStart
\* TSS-EB-4, TSS-EB-5, TSS-REL-1
ByHand(i) == ResetEdge(i) /\ i.S_OSSD_In
\* TSS-IN-TESTTIME
TooLong == TEST_TIME > 150

\* What is asked for in this call, and stays due until it has come
LOCAL Due(m, i) ==
    LET pending == waits[m] > 0
        on == i.Activate
        free == i.S_OSSD_In
    IN
    CASE m = "ready" -> on
      [] m = "runs" -> uninhibited' /\ free /\ ~i.Reset /\ InRange /\ ~troubled'
      [] m = "enable" ->
            /\ on /\ free
            /\ pending \/ (ResetEdge(i) /\ ripe > LATENCY /\ Now("ResetRequest") /\ ~Now("Error"))
      [] m = "lost" ->
            on /\ ~free /\ (pending \/ (Now("S_OSSD_Out") /\ Now("TestPossible") /\ ~Asks(i)))
      [] m = "return" ->
            /\ on /\ free /\ ~i.Reset /\ ~i.S_StartReset /\ ~i.S_AutoReset
            /\ pending \/ Code \in {\h8802, \h8806}
      [] m = "test" -> on /\ free /\ (pending \/ (Asks(i) /\ Now("TestPossible")))
      [] m = "sender" -> on /\ ~free /\ (pending \/ (InTest /\ ~Now("S_TestOut")))
      [] m = "end" ->
            on /\ free /\ Then("S_OSSD_Out") /\ Then("S_TestOut") /\ (pending \/ (InTest /\ Now("S_TestOut")))
      [] m = "failure" -> on /\ ~Then("S_OSSD_Out") /\ (pending \/ InTest)
      [] m \in {"mend", "manual"} ->
            /\ on /\ free /\ noManualTest = (m = "mend")
            /\ pending \/ (ResetEdge(i) /\ ripe > LATENCY /\ Code \in TestErrorCodes)
      [] m = "dark" -> on /\ ~free /\ (pending \/ (ripe > LATENCY /\ Code = \h8002))
      [] m = "cycle" -> on /\ free /\ (pending \/ Code = \h8804)
      [] m = "held" ->
            /\ on /\ free /\ i.Reset /\ ~i.S_StartReset /\ ~i.S_AutoReset /\ InRange /\ ~Then("S_OSSD_Out")
            /\ pending \/ (lastReset /\ Code' # Code /\ Code' \in {\h8401, \h8402, \h8406})
      [] m = "stuck" ->
            /\ on /\ free /\ i.Reset /\ ~(i.S_AutoReset /\ InRange) /\ Then("Error")
            /\ pending \/ (lastReset /\ ~Now("Error") /\ Code' \in TestErrorCodes \cup {\hC000})
      [] m = "refused" -> on /\ ~i.Reset /\ TooLong
LOCAL Came(m) ==
    CASE m = "ready" -> Then("Ready")
      [] m \in {"runs", "enable", "mend"} -> Then("S_OSSD_Out")
      [] m = "lost" -> Code' = IF wasTested THEN \h8806 ELSE \h8802
      [] m = "return" -> Code' = IF wasTested THEN \h8406 ELSE \h8402
      [] m = "test" -> ~Then("S_TestOut")
      [] m = "sender" -> Then("S_TestOut")
      [] m = "end" -> Then("TestPossible")
      [] m = "failure" -> Code' \in TestErrorCodes
      [] m = "manual" -> Code' \in {\h8002, \h8804, \h8404}
      [] m = "dark" -> Code' = \h8804
      [] m = "cycle" -> Code' = \h8404 \/ Then("S_OSSD_Out") \/ Then("Error")
      [] m = "held" -> Then("Error")
      [] m = "stuck" -> Code' \in {\hC021, \hC041}
      [] m = "refused" -> Code' \in {\hC000, \hC041}

----------------------------------------------------------------------------
(* The observer.                                                           *)

Watch(i) ==
    /\ lastReset' = i.Reset /\ lastStart' = i.StartTest /\ lastFree' = i.S_OSSD_In /\ UNCHANGED noManualTest
    /\ spent' = IF ~StillInTest \/ ~InTest \/ Now("S_TestOut") # Then("S_TestOut") THEN 0
                ELSE Counted(spent, i.dt, TEST_TIME + 1)
    /\ passed' = (i.Activate /\ Then("S_TestOut") /\ (Passes \/ (passed /\ ~(InTest /\ ~Then("S_OSSD_Out")))))
    /\ wasTested' = (i.Activate /\ IF Then("S_OSSD_Out") /\ Then("TestPossible")
                                   THEN Then("TestExecuted") ELSE wasTested)
    /\ failed' = (i.Activate /\ (Fails \/ (failed /\ ~Then("S_OSSD_Out"))))
    /\ switched' = IF ~i.Activate \/ ~(failed \/ Fails) THEN 0
                   ELSE IF lastFree /\ ~i.S_OSSD_In /\ (Fails \/ switched = 0) THEN 1
                   ELSE IF Fails THEN 0 ELSE IF switched = 1 /\ i.S_OSSD_In THEN 2 ELSE switched
    /\ uninhibited' = (i.Activate /\ i.S_StartReset /\ i.S_AutoReset /\ (uninhibited \/ ~Now("Ready")))
    /\ troubled' = (i.Activate /\ (Then("Error") \/ (troubled /\ ~Then("S_OSSD_Out"))))
    /\ ripe' = IF ~i.Activate \/ ~i.S_OSSD_In \/ i.Reset THEN 0
               ELSE IF Code' = Code THEN Counted(ripe, 1, LATENCY + 1) ELSE 1
    /\ waits' = [m \in MustCome |->
                    IF Due(m, i) /\ ~Came(m) THEN Counted(waits[m], 1, 2 * LATENCY + 1) ELSE 0]

DemandsNext ==
    \E n \in InputsToTry : \E i \in {Alphabet[n]} :
        /\ i.NoExternalTest = noManualTest
        /\ SensorScan(i)
        /\ in' = n /\ beat' = ~beat /\ UNCHANGED observer /\ Watch(i)
DemandsSpec == DemandsInit /\ [][DemandsNext]_<<View, observer, watched, step, in, beat>>

HasCome(m) == waits'[m] <= LATENCY

----------------------------------------------------------------------------
(* The tables.                                                             *)

\* TSS-0000, TSS-8000, TSS-8002, TSS-8010, TSS-8020, TSS-8030, TSS-8401, TSS-8402, TSS-8404, TSS-8406, TSS-8802,
\* TSS-8804, TSS-8806, TSS-C000, TSS-C001, TSS-C010, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-C410:
\* the codes, and the outputs that are TRUE with each beside S_TestOut, which is FALSE with 8020 alone
Printed ==
    (\h0000 :> {}) @@ (\h8401 :> {"Ready", "ResetRequest"}) @@
    (\h8802 :> {"Ready", "SafetyDemand"}) @@ (\h8402 :> {"Ready", "ResetRequest"}) @@
    (\h8002 :> {"Ready"}) @@ (\h8804 :> {"Ready", "SafetyDemand"}) @@ (\h8404 :> {"Ready", "ResetRequest"}) @@
    (\h8010 :> {"Ready", "S_OSSD_Out", "TestPossible"}) @@
    (\h8806 :> {"Ready", "SafetyDemand", "TestExecuted"}) @@
    (\h8406 :> {"Ready", "ResetRequest", "TestExecuted"}) @@
    (\h8020 :> {"Ready", "S_OSSD_Out"}) @@ (\h8030 :> {"Ready", "S_OSSD_Out"}) @@
    (\h8000 :> {"Ready", "S_OSSD_Out", "TestPossible", "TestExecuted"}) @@
    (\hC000 :> {"Ready", "Error"}) @@ (\hC001 :> {"Ready", "Error"}) @@ (\hC011 :> {"Ready", "Error"}) @@
    (\hC021 :> {"Ready", "Error"}) @@ (\hC031 :> {"Ready", "Error"}) @@ (\hC041 :> {"Ready", "Error"}) @@
    (\hC051 :> {"Ready", "Error", "TestExecuted"}) @@ (\hC010 :> {"Ready", "Error"}) @@
    (\hC410 :> {"Ready", "Error", "ResetRequest"})

\* TSS-IN-ACTIVATE, TSS-OUT-READY, TSS-0000
InactiveIsIdle == [][~Scanned.Activate => ~Then("Ready") /\ ~Then("S_OSSD_Out") /\ Code' = 0]_beat
\* TSS-IN-ACTIVATE, TSS-OUT-READY, TSS-8401
ActiveIsReady == [][HasCome("ready")]_beat
\* TSS-OUT-DIAG
CodeIsInTheTable == [][Code' \in DOMAIN Printed]_beat
\* TSS-OUT-READY, TSS-OUT-OSSD, TSS-OUT-TESTOUT, TSS-OUT-POSSIBLE, TSS-OUT-EXECUTED, TSS-OUT-DEMAND,
\* TSS-OUT-REQUEST, TSS-OUT-ERROR, TSS-EB-1
OutputsAreTheRowOfTheCode ==
    [][Code' \in DOMAIN Printed =>
        \A name \in DOMAIN SensorOutputs \ {"DiagCode"} :
            Then(name) = IF name = "S_TestOut" THEN Code' # \h8020 ELSE name \in Printed[Code']]_beat

----------------------------------------------------------------------------
(* The enable.                                                             *)

\* TSS-IN-OSSD, TSS-OUT-OSSD, TSS-FN-1
DarkSensorSwitchesOff ==
    [][Then("S_OSSD_Out") /\ Then("TestPossible") => Scanned.S_OSSD_In]_beat
\* TSS-OUT-OSSD, TSS-FN-1, TSS-FN-5, TSS-TEST-0, TSS-8020, TSS-8030
EnableLasts ==
    [][Now("S_OSSD_Out") /\ ~Then("S_OSSD_Out") =>
        \/ ~Scanned.Activate
        \/ IF InTest THEN spent + Scanned.dt >= TEST_TIME ELSE ~Scanned.S_OSSD_In]_beat
\* TSS-FN-2, TSS-FN-3, TSS-REL-1, TSS-EB-4, TSS-EB-5, TSS-IN-RESET, TSS-IN-STARTRESET, TSS-IN-AUTORESET
InhibitGoesByHand ==
    [][Rise("S_OSSD_Out") => ByHand(Scanned) \/ Scanned.S_StartReset \/ Scanned.S_AutoReset]_beat
\* TSS-EB-1, TSS-EB-2, TSS-EB-3
FailedTestNeedsEdge == [][Rise("S_OSSD_Out") /\ failed => ByHand(Scanned) \/ Scanned.S_AutoReset]_beat
\* TSS-FN-1, TSS-FN-2, TSS-FN-3, TSS-OUT-OSSD, TSS-IN-STARTRESET, TSS-IN-AUTORESET
RunsByItself == [][waits'["runs"] <= 2 * LATENCY]_beat
\* TSS-EB-4, TSS-EB-5, TSS-REL-1, TSS-IN-RESET, TSS-8401, TSS-8402, TSS-8406, TSS-8404
ResetEndsInhibit == [][HasCome("enable")]_beat
\* TSS-8802, TSS-8806, TSS-OUT-DEMAND, TSS-IN-OSSD
LostSensorIsShown == [][HasCome("lost")]_beat
\* TSS-FN-2, TSS-REL-1, TSS-8402, TSS-8406, TSS-OUT-REQUEST
ReturnAsksForReset == [][HasCome("return")]_beat

----------------------------------------------------------------------------
(* The test.                                                               *)

LOCAL SenderGoesOff == Now("S_TestOut") /\ ~Then("S_TestOut")
\* TSS-IN-STARTTEST, TSS-TEST-1, TSS-NOTE-4, TSS-OUT-TESTOUT
TestNeedsEdge == [][SenderGoesOff => Asks(Scanned)]_beat
\* TSS-OUT-POSSIBLE, TSS-8010, TSS-8000
TestNeedsTestPossible == [][SenderGoesOff => Now("TestPossible")]_beat
\* TSS-IN-STARTTEST, TSS-OUT-TESTOUT, TSS-OUT-POSSIBLE, TSS-TEST-1, TSS-NOTE-4, TSS-8020
TestBegins == [][HasCome("test")]_beat
\* TSS-TEST-2, TSS-8020, TSS-FN-6C, TSS-ERR-2
SenderStaysOffUntilDark ==
    [][InTest /\ ~Now("S_TestOut") /\ Then("S_TestOut") => ~Then("S_OSSD_Out") \/ ~Scanned.S_OSSD_In]_beat
\* TSS-TEST-2, TSS-8030
DarkSensorTurnsSenderOn == [][HasCome("sender")]_beat
\* TSS-TEST-3, TSS-8000, TSS-8030
FreeSensorEndsTest == [][HasCome("end")]_beat
\* TSS-TEST-3, TSS-8030, TSS-FN-6A, TSS-ERR-1
TestEndsWithFreeSensor == [][Passes => Now("S_TestOut") /\ Scanned.S_OSSD_In]_beat
\* TSS-OUT-EXECUTED, TSS-8000
PassedTestIsShown == [][Passes => Then("TestExecuted")]_beat
\* TSS-OUT-EXECUTED, TSS-8000, TSS-8010
TestExecutedIsEarned == [][Then("TestExecuted") => passed']_beat
\* TSS-IN-TESTTIME, TSS-TEST-0, TSS-FN-4, TSS-FN-6A, TSS-FN-6B, TSS-FN-6C, TSS-FN-7, TSS-ERR-1, TSS-ERR-2,
\* TSS-CX10
PhaseEndsInTime == [][spent' <= TEST_TIME]_beat

----------------------------------------------------------------------------
(* A failed test.                                                          *)

\* TSS-FN-4, TSS-ERR-1, TSS-ERR-2, TSS-EB-1, TSS-CX10, TSS-OUT-ERROR
FailedTestIsShown == [][HasCome("failure")]_beat
\* TSS-CX10, TSS-C410, TSS-C010
CodeTellsTheSensor ==
    [][InTest /\ Code' \in TestErrorCodes =>
        Code' = IF Scanned.S_OSSD_In /\ Scanned.NoExternalTest THEN \hC410 ELSE \hC010]_beat
\* TSS-EB-2, TSS-IN-NOEXT-TRUE, TSS-C410
ResetEndsTestError == [][HasCome("mend")]_beat
\* TSS-IN-NOEXT-FALSE, TSS-8002, TSS-C010
ResetBeginsManualTest == [][HasCome("manual")]_beat
\* TSS-IN-NOEXT-FALSE, TSS-8002, TSS-8804, TSS-8404
ManualTestComesFirst == [][failed /\ ~noManualTest /\ Rise("TestPossible") => switched' = 2]_beat
\* TSS-8002, TSS-8804
ManualTestIsFollowed == [][HasCome("dark")]_beat
\* TSS-8804, TSS-8404
ManualTestShows == [][HasCome("cycle")]_beat

----------------------------------------------------------------------------
(* A Reset that is held, and a TestTime out of its range.                  *)

\* TSS-ERR-3, TSS-C001, TSS-C011, TSS-C031, TSS-C051
HeldResetIsAnError == [][HasCome("held")]_beat
\* TSS-ERR-3, TSS-C021, TSS-C041
HeldResetHasItsCode == [][HasCome("stuck")]_beat
\* TSS-IN-TESTTIME, TSS-ERR-4, TSS-C000
InvalidTimeIsRefused == [][waits'["refused"] <= 2 * LATENCY]_beat
\* TSS-IN-TESTTIME, TSS-ERR-4, TSS-EB-1
InvalidTimeNeverEnables == [][TooLong => ~Then("S_OSSD_Out")]_beat
\* TSS-OUT-ERROR, TSS-ERR-1, TSS-ERR-2, TSS-ERR-3, TSS-ERR-4
ErrorNeedsReason == [][~Now("Error") /\ Then("Error") => InTest \/ Scanned.Reset \/ ~InRange]_beat
=============================================================================
