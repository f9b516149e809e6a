---------------------- MODULE TestableSafetySensorOpen ----------------------
(***************************************************************************)
(* The block alone with arbitrary inputs in every call: the environment    *)
(* `arbitrary`, and the graph that implementations are compared with.      *)
(* S_StartReset, S_AutoReset and NoExternalTest are inputs like the others *)
(* and may change at any call, so every setting of them is covered.        *)
(* Properties speak of the wires: what an observer of the inputs and       *)
(* outputs sees, and what the document prints of the states.               *)
(* Leaves out the sensor, the machine, and the user.                       *)
(***************************************************************************)
EXTENDS Sequences, TestableSafetySensor

CONSTANTS
    TIMES,          \* the times between two calls that are tried, in ms
    PRINT_GRAPH     \* TRUE: print inputs, states and edges

VARIABLES
    in,             \* the number of the last call's input; hidden by VIEW
    beat,           \* changes in every call, so that no call escapes an action property; hidden by VIEW
    \* What an observer of the wires alone has seen; nothing of the block reads it:
    \* ms since the sensor was first seen dark while S_OSSD_Out stayed TRUE; -1 if it is not dark, or
    \* S_OSSD_Out is FALSE
    dark,
    tested,         \* ms since the test began; -1 outside a test
    phase,          \* ms since this state was entered, as far as the longest test goes
    \* activated; the start-up inhibit neither reset since, nor switched off when the sensor was first judged
    starting,
    cycle           \* the manual test: 0 nothing yet, 1 sensor seen free, 2 then dark, 3 then free

observer == <<dark, tested, phase, starting, cycle>>
View == block
ObservedView == <<View, observer>>

----------------------------------------------------------------------------
(* The input alphabet, numbered.                                           *)

Times == CASE TIMES = "none" -> <<0>>
           [] TIMES = "to 1" -> <<0, 1>>
           [] TIMES = "to 2" -> <<0, 1, 2>>
           [] TIMES = "around 10" -> <<0, 5, 9>>    \* with TestTime 10: 9 is not enough, 5 and 5 are
           [] TIMES = "up to 10" -> <<0, 10>>
           [] TIMES = "around 150" -> <<149, 150>>
\* For a cfg, which cannot write it
BelowZero == -1
LOCAL Bit(n, b) == (n \div b) % 2 = 1
N == 128 * Len(Times)
Alphabet == TLCEval([n \in 0..N - 1 |->
    [Activate |-> Bit(n, 1), S_OSSD_In |-> Bit(n, 2), StartTest |-> Bit(n, 4), NoExternalTest |-> Bit(n, 8),
     S_StartReset |-> Bit(n, 16), S_AutoReset |-> Bit(n, 32), Reset |-> Bit(n, 64),
     dt |-> Times[(n \div 128) + 1]]])

Wire(i) == i
Row == SensorOutputs
ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

----------------------------------------------------------------------------
OpenInit ==
    /\ SensorInit /\ step = "" /\ in = 0 /\ beat = FALSE
    /\ dark = -1 /\ tested = -1 /\ phase = 0 /\ starting = FALSE /\ cycle = 0
    /\ PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>))

Manual == {"ExternalFunctionTest", "ESPEInterruptedExternalTest", "EndExternalTest", "ResetError4"}
\* Whether this output is TRUE in this state, and after this call; in a state without a row nothing is
Now(name) == state \in DOMAIN Rows /\ Rows[state][name]
Then(name) == state' \in DOMAIN Rows /\ Rows[state'][name]
Rise(name) == ~Now(name) /\ Then(name)
Observe(i) ==
    /\ dark' = IF i.S_OSSD_In \/ ~Then("S_OSSD_Out") THEN -1 ELSE IF dark < 0 THEN 0 ELSE dark + i.dt
    /\ tested' = IF state' \notin Testing THEN -1 ELSE IF tested < 0 THEN 0 ELSE tested + i.dt
    /\ phase' = IF state' # state \/ state \notin Testing THEN 0 ELSE phase + i.dt
    /\ starting' = IF state = "Idle" THEN i.Activate
                   ELSE /\ starting /\ i.Activate /\ ~Then("S_OSSD_Out")
                        /\ ~(state = "Init" /\ ~Now("Error") /\ i.S_StartReset)
    /\ cycle' = IF state' \notin Manual THEN 0
                ELSE IF state \notin Manual THEN (IF i.S_OSSD_In THEN 1 ELSE 0)
                ELSE IF cycle = 0 /\ i.S_OSSD_In THEN 1 ELSE IF cycle = 1 /\ ~i.S_OSSD_In THEN 2
                ELSE IF cycle = 2 /\ i.S_OSSD_In THEN 3 ELSE cycle

\* Only the two phases of a test tell times apart; the graph tries every time in every state
InputsToTry == IF PRINT_GRAPH \/ state \in Testing THEN 0..N - 1 ELSE 0..127
OpenNext ==
    \E n \in InputsToTry : \E i \in {Alphabet[n]} :
        /\ SensorScan(i)
        /\ in' = n /\ beat' = ~beat
        /\ IF PRINT_GRAPH THEN UNCHANGED observer ELSE Observe(i)
OpenSpec == OpenInit /\ [][OpenNext]_<<View, observer, step, in, beat>>

Scanned == Alphabet[in']
Before == Alphabet[in]
\* For a reader of a trace: what a call found on the wires and what stands on them after it
Wires == Wire(Alphabet[in]) @@ SensorOutputs

----------------------------------------------------------------------------
(* The enable output.                                                      *)

\* TSS-IN-OSSD, TSS-FN-1, TSS-FN-5, TSS-OUT-OSSD, TSSF-09, TSSF-21, TSSF-22: TRUE while the sensor is dark:
\* only in the second phase of a test
EnableNeedsFreeSensor ==
    [][Then("S_OSSD_Out") /\ ~Scanned.S_OSSD_In => state' = "TestActive"]_beat
\* TSS-TEST-0, TSS-FN-7, TSSF-06, TSSF-09: and for less than TestTime; a test ends within twice TestTime
MaskedTimeIsBounded == dark < TEST_TIME /\ (tested >= 0 => (tested < 2 * TEST_TIME \/ tested = 0))
\* TSS-FN-7, TSS-OUT-TESTOUT, TSS-NOTE-1, TSSF-06: the sender is off for less than TestTime; the call that
\* finds it over switches it on again
SenderOffIsBounded == ~Row.S_TestOut => tested = 0 \/ tested < TEST_TIME
\* TSS-IN-ACTIVATE, TSS-0000: without Activate the call ends in the row of Idle
InactiveAtOnce == [][~Scanned.Activate => Row' = Rows["Idle"] /\ ~Then("S_OSSD_Out")]_beat
\* TSS-OUT-OSSD, TSS-OUT-ERROR, TSS-OUT-DEMAND, TSS-OUT-REQUEST, TSS-EB-1: nothing is pending while it is TRUE
EnableMeansNothingPending ==
    Row.S_OSSD_Out => Row.Ready /\ ~Row.Error /\ ~Row.SafetyDemand /\ ~Row.ResetRequest
\* TSS-IN-TESTTIME
InRange == 0 <= TEST_TIME /\ TEST_TIME <= 150
\* A reset, as an observer of the wires sees it
Edge == Scanned.Reset /\ ~Before.Reset
\* TSS-REL-1, TSS-FN-2, TSS-FN-3, TSS-EB-3, TSS-EB-4, TSS-EB-5, TSS-IN-STARTRESET, TSS-IN-AUTORESET, TSSF-15,
\* TSSF-24: never by itself
NoRestartByItself ==
    [][(Rise("S_OSSD_Out") =>
        /\ Scanned.Activate /\ Scanned.S_OSSD_In
        /\ \/ Edge
           \/ Scanned.S_StartReset /\ state = "Init"
           \/ /\ Scanned.S_AutoReset
              /\ state \in {"ESPEInterrupted1", "WaitForReset1", "ESPEInterrupted2", "WaitForReset2"}
           \/ Scanned.S_AutoReset /\ AUTO_RESET_ERRORS /\ state \in TestErrors \cup Manual)]_beat
\* TSS-EB-2, TSS-EB-3, TSS-IN-NOEXT-FALSE, TSSF-15: after a failed test only a reset enables, S_AutoReset or
\* not; not so with AUTO_RESET_ERRORS
FailedTestNeedsReset == [][Rise("S_OSSD_Out") => Edge \/ (state \notin TestErrors \cup Manual)]_beat
\* TSS-FN-3, TSS-EB-5, TSSF-19: the start-up inhibit outlives an interruption
StartInhibitHolds ==
    [][Rise("S_OSSD_Out") /\ starting => Edge \/ (Scanned.S_StartReset /\ state = "Init")]_beat
\* TSS-OUT-REQUEST, TSSF-18: an edge enables only where the call before asked for it
ResetOnlyWhereRequested ==
    [][Rise("S_OSSD_Out") /\ ~Scanned.S_StartReset /\ ~Scanned.S_AutoReset => Now("ResetRequest")]_beat
\* TSS-IN-STARTRESET, TSS-IN-AUTORESET, TSS-FN-2, TSS-EB-3, TSSF-15, TSSF-19: where a constant switches the
\* inhibit off, a free sensor enables in that call, whatever Reset is; so does the other value of
\* AUTO_RESET_ERRORS with a failed test.  What waits for a reset already is not in this (TSSF-20)
SwitchedOffInhibitEnds ==
    [][Scanned.Activate /\ Scanned.S_OSSD_In =>
        /\ state = "Init" /\ Scanned.S_StartReset /\ InRange => Then("S_OSSD_Out")
        /\ state = "ESPEInterrupted1" /\ Scanned.S_AutoReset /\ ~startInhibit => Then("S_OSSD_Out")
        /\ state = "ESPEInterrupted2" /\ Scanned.S_AutoReset => Then("S_OSSD_Out")
        /\ Scanned.S_AutoReset /\ AUTO_RESET_ERRORS =>
            /\ state = "EndExternalTest" => Then("S_OSSD_Out")
            /\ state = "TestError1C410" /\ Scanned.NoExternalTest => Then("S_OSSD_Out")
            /\ state \in TestErrors /\ ~Scanned.NoExternalTest => state' = "ExternalFunctionTest"]_beat
\* TSS-8802, TSS-8804, TSS-8806, TSS-OUT-DEMAND, TSS-OUT-OSSD: a lost sensor is shown as a demand in that very
\* call, and as long as it is lost
DemandIsShown ==
    [][(state \in {"ESPEFreeNoTest", "ESPEFreeTestOk", "WaitForReset1", "WaitForReset2", "Init",
                   "EndExternalTest", "ESPEInterrupted1", "ESPEInterrupted2", "ESPEInterruptedExternalTest"}
        /\ Scanned.Activate /\ ~Scanned.S_OSSD_In => Then("SafetyDemand") \/ Then("Error"))]_beat
\* TSS-8802, TSS-8804, TSS-8806, TSS-OUT-DEMAND: and never longer: a call that finds the sensor free shows
\* none
DemandNeedsDarkSensor == [][Then("SafetyDemand") => ~Scanned.S_OSSD_In]_beat
\* TSS-OUT-REQUEST, TSS-EB-2, TSS-EB-4, TSS-EB-5, TSS-C410, TSS-IN-NOEXT-FALSE, TSSF-13, TSSF-18: an edge
\* where it is asked for, with the sensor free, enables in that call; where there is a manual test, one in the
\* test error asks for that
ResetEndsAtOnce ==
    [][Scanned.Activate /\ Edge =>
        /\ (/\ Now("ResetRequest") /\ Scanned.S_OSSD_In /\ InRange
            /\ state = "TestError1C410" => Scanned.NoExternalTest) => Then("S_OSSD_Out")
        /\ state \in {"TestError1C410", "TestError1C010"} /\ ~Scanned.NoExternalTest =>
            state' = "ExternalFunctionTest"]_beat

----------------------------------------------------------------------------
(* The test.                                                               *)

\* TSS-IN-STARTTEST, TSS-OUT-POSSIBLE, TSS-NOTE-3, TSS-NOTE-4, TSS-TEST-1, TSSF-23: an edge while TestPossible
\* is FALSE has no effect, then or later
TestNeedsEdgeWhilePossible ==
    [][state' = "TestRequest" /\ state # "TestRequest" =>
        Now("TestPossible") /\ Scanned.StartTest /\ ~Before.StartTest]_beat
\* TSS-TEST-1, TSS-8010, TSS-8000: and one while it is TRUE, with the sensor free, starts the test in that
\* call
TestStartsAtOnce ==
    [][Now("TestPossible") /\ Scanned.Activate /\ Scanned.S_OSSD_In =>
        ((state' = "TestRequest") <=> (Scanned.StartTest /\ ~Before.StartTest))]_beat
\* TSS-OUT-TESTOUT, TSS-TEST-1, TSS-TEST-2, TSS-8020, TSSF-05: the sensor is switched off in the first phase
\* only
TestOutOnlyInTestRequest == ~Row.S_TestOut <=> state = "TestRequest"
\* TSS-ERR-1, TSS-ERR-2, TSS-FN-4, TSS-FN-6A, TSS-FN-6B, TSS-FN-6C, TSS-EB-1, TSSF-07, TSSF-08: a phase as
\* long as TestTime, or without reaction, always fails
SlowTestFails ==
    [][(state \in Testing /\ Scanned.Activate /\ phase + Scanned.dt >= TEST_TIME =>
        Then("Error") /\ ~Then("S_OSSD_Out") /\ state' \in TestErrors)]_beat
\* TSS-TEST-0, TSSF-06: and only such a one
EachPhaseHasItsTime ==
    [][(state \in Testing /\ state' \in TestErrors => phase + Scanned.dt >= TEST_TIME)]_beat
\* TSS-OUT-EXECUTED, TSS-TEST-2, TSS-TEST-3, TSS-FN-6C: TestExecuted rises only with the sensor dark in time,
\* and free in time
TestExecutedIsTrue ==
    [][Rise("TestExecuted") =>
        /\ state = "TestActive" /\ Scanned.S_OSSD_In /\ phase + Scanned.dt < TEST_TIME /\ dark >= 0]_beat
\* TSS-OUT-EXECUTED, TSS-8806, TSS-8406, TSS-C051: it stays until the next test, while the block is active
TestExecutedStays ==
    [][Now("TestExecuted") /\ Scanned.Activate /\ ~Then("TestExecuted") => state' = "TestRequest"]_beat
\* TSS-TEST-2, TSS-TEST-3: a reaction in time is seen in the call that shows it
ReactionIsSeen ==
    [][Scanned.Activate /\ phase + Scanned.dt < TEST_TIME =>
        /\ state = "TestRequest" => state' = (IF Scanned.S_OSSD_In THEN "TestRequest" ELSE "TestActive")
        /\ state = "TestActive" =>
            state' = (IF Scanned.S_OSSD_In THEN "ESPEFreeTestOk" ELSE "TestActive")]_beat

----------------------------------------------------------------------------
(* Errors.                                                                 *)

\* TSS-CX10, TSS-C410, TSS-C010, TSSF-17: x is 4 exactly if the sensor is free and there is no manual test,
\* now
CodeTellsResettable ==
    [][(state' \in TestErrors =>
        (Row'.DiagCode = (IF Scanned.S_OSSD_In /\ Scanned.NoExternalTest THEN \hC410 ELSE \hC010)))]_beat
\* TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051: where each reset error was found
Watched ==
    [ResetError1 |-> {"Init"}, ResetError2 |-> {"WaitForReset1"}, ResetError3 |-> TestErrors,
     ResetError4 |-> {"EndExternalTest"}, ResetError5 |-> {"ParameterError"},
     ResetError6 |-> {"WaitForReset2"}]
\* TSS-EB-1, TSS-EB-2, TSS-ERR-3, TSSF-12, TSSF-13, TSSF-24: a test error ends by an edge, a reset error by
\* the end of Reset, a parameter error not at all
ErrorLeftOnlyAsDocumented ==
    [][(Now("Error") /\ Scanned.Activate /\ state' # state =>
        IF state \in DOMAIN Watched THEN ~Scanned.Reset /\ state' \in Watched[state]
        ELSE \/ state' \in DOMAIN Watched /\ state \in Watched[state'] /\ Scanned.Reset /\ Before.Reset
             \/ /\ state \in TestErrors
                /\ state' \in TestErrors \/ Edge \/ (AUTO_RESET_ERRORS /\ Scanned.S_AutoReset))]_beat
\* TSS-IN-STARTRESET, TSS-IN-AUTORESET, TSS-EB-3: whether the inhibit or the error that this reset error
\* watches is kept in this call
Kept(e) == CASE e = "ResetError1" -> ~Scanned.S_StartReset /\ InRange
             [] e = "ResetError2" -> ~Scanned.S_AutoReset \/ startInhibit
             [] e = "ResetError6" -> ~Scanned.S_AutoReset
             [] e = "ResetError5" -> TRUE
             [] OTHER -> ~(AUTO_RESET_ERRORS /\ Scanned.S_AutoReset)
\* TSS-ERR-3, TSS-IN-RESET, TSSF-01, TSSF-02, TSSF-03, TSSF-24: a static Reset where a reset is waited for is
\* found, and found to be an error
StaticResetIsFound ==
    [][(Scanned.Activate /\ Scanned.Reset /\ Before.Reset =>
        (\A e \in DOMAIN Watched : state \in Watched[e] /\ Kept(e) => state' = e))]_beat
\* TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-ERR-3, TSSF-24: only a Reset that is held
\* is one, and only while it is held; not where the constants leave nothing to reset.  What S_AutoReset does
\* to a reset that is waited for already, and a TestTime out of its range in Init, are not in this (TSSF-20,
\* TSSF-11)
ResetErrorNeedsHeldReset ==
    [][state' \in DOMAIN Watched =>
        /\ Scanned.Reset /\ (state' # state => Before.Reset)
        /\ state' # state /\ state' = "ResetError1" => ~Scanned.S_StartReset
        /\ state' # state /\ state' \in {"ResetError3", "ResetError4"} => Kept(state')]_beat
\* TSS-C051, TSS-OUT-EXECUTED, TSSF-02, TSSF-03: finding it changes neither what is known of the test nor
\* where the block goes on
ResetErrorKeepsTestExecuted ==
    [][(state' \in DOMAIN Watched =>
        state \in Watched[state'] \cup {state'} /\ Then("TestExecuted") = Now("TestExecuted"))]_beat
\* TSS-IN-NOEXT-FALSE, TSS-8002, TSS-8804, TSS-8404, TSSF-14, TSSF-16: after a failed test no output without a
\* manual test from free over dark to free, where there is one; and
\* TSS-IN-NOEXT-TRUE: none is asked for where there is none
ExternalTestIsComplete ==
    [][/\ (state \in Manual /\ Rise("S_OSSD_Out") => cycle = 3 /\ state = "EndExternalTest")
       /\ (state \in TestErrors /\ Rise("S_OSSD_Out") => Scanned.NoExternalTest)
       /\ (state \in TestErrors /\ state' \in Manual => ~Scanned.NoExternalTest)]_beat
\* TSS-8002, TSS-8804, TSS-IN-NOEXT-FALSE, TSSF-16: where a manual test is awaited, a sensor that was free and
\* is dark begins it in that call
ManualTestIsSeen ==
    [][state = "ExternalFunctionTest" /\ Scanned.Activate /\ Before.S_OSSD_In /\ ~Scanned.S_OSSD_In =>
        state' = "ESPEInterruptedExternalTest"]_beat
\* TSS-C000, TSS-ERR-4, TSS-IN-TESTTIME: only a TestTime out of its range is a parameter error
ParameterErrorNeedsCause == [][state' = "ParameterError" => ~InRange]_beat
\* TSS-C000, TSS-ERR-4, TSS-IN-TESTTIME, TSSF-11, TSSF-12: a TestTime out of its range never enables
ParameterErrorStays ==
    [][~InRange /\ Scanned.Activate =>
        /\ ~Then("S_OSSD_Out")
        /\ (state \notin {"Idle", "ResetError1"} => Then("Error"))]_beat

----------------------------------------------------------------------------
(* All states.                                                             *)

\* TSS-OUT-DIAG, TSS-0000, TSS-8000, TSS-C000: four bits of the code say what four outputs say
CodeTellsItsOutputs ==
    LET bit(b) == (Row.DiagCode \div b) % 2 = 1
    IN  /\ bit(32768) = Row.Ready /\ bit(2048) = Row.SafetyDemand /\ bit(1024) = Row.ResetRequest
        /\ (bit(32768) /\ bit(16384)) = Row.Error
\* TSS-OUT-DIAG: the code that the document prints for each state; no two have one
CodeOf ==
    [Idle |-> \h0000, Init |-> \h8401, ESPEInterrupted1 |-> \h8802, WaitForReset1 |-> \h8402,
     ExternalFunctionTest |-> \h8002, ESPEInterruptedExternalTest |-> \h8804, EndExternalTest |-> \h8404,
     ESPEFreeNoTest |-> \h8010, ESPEInterrupted2 |-> \h8806, WaitForReset2 |-> \h8406,
     TestRequest |-> \h8020, TestActive |-> \h8030, ESPEFreeTestOk |-> \h8000, ParameterError |-> \hC000,
     ResetError1 |-> \hC001, ResetError2 |-> \hC011, ResetError3 |-> \hC021,
     ResetError4 |-> \hC031, ResetError5 |-> \hC041,
     ResetError6 |-> \hC051, TestError1C410 |-> \hC410, TestError1C010 |-> \hC010]
ASSUME \A s, t \in DOMAIN CodeOf : s # t => CodeOf[s] # CodeOf[t]
\* TSS-OUT-DIAG, TSS-0000, TSS-8401, TSS-8802, TSS-8402, TSS-8002, TSS-8804, TSS-8404, TSS-8010, TSS-8806,
\* TSS-8406, TSS-8020, TSS-8030, TSS-8000,
\* TSS-C000, TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-C410, TSS-C010, TSSF-02, TSSF-03:
\* every state shows its own
CodeIsThePrintedOne == Row.DiagCode = CodeOf[state]
\* TSS-IN-RESET, TSS-IN-STARTTEST: edges count from the call before, active or not
EdgesAreRemembered ==
    [][/\ resetBefore' = Scanned.Reset
       /\ startTestBefore' = Scanned.StartTest
       /\ sensorBefore' = Scanned.S_OSSD_In
       /\ step # "" =>
            /\ resetBefore = Before.Reset
            /\ startTestBefore = Before.StartTest
            /\ sensorBefore = Before.S_OSSD_In]_beat
\* TSS-OUT-DIAG, TSSF-27: every call takes one of these, or stays
Transitions == TLCEval(
    {<<"Idle", "Init">>, <<"Init", "ParameterError">>, <<"Init", "ResetError1">>,
     <<"Init", "ESPEInterrupted1">>, <<"Init", "ESPEFreeNoTest">>,
     <<"ESPEInterrupted1", "WaitForReset1">>, <<"ESPEInterrupted1", "ESPEFreeNoTest">>,
     <<"WaitForReset1", "ResetError2">>, <<"WaitForReset1", "ESPEInterrupted1">>,
     <<"WaitForReset1", "ESPEFreeNoTest">>,
     <<"ESPEFreeNoTest", "ESPEInterrupted1">>, <<"ESPEFreeNoTest", "TestRequest">>,
     <<"TestRequest", "TestActive">>, <<"TestActive", "ESPEFreeTestOk">>,
     <<"ESPEFreeTestOk", "ESPEInterrupted2">>, <<"ESPEFreeTestOk", "TestRequest">>,
     <<"ESPEInterrupted2", "WaitForReset2">>, <<"ESPEInterrupted2", "ESPEFreeTestOk">>,
     <<"WaitForReset2", "ResetError6">>, <<"WaitForReset2", "ESPEInterrupted2">>,
     <<"WaitForReset2", "ESPEFreeTestOk">>,
     <<"ExternalFunctionTest", "ESPEInterruptedExternalTest">>,
     <<"ESPEInterruptedExternalTest", "EndExternalTest">>,
     <<"EndExternalTest", "ResetError4">>, <<"EndExternalTest", "ESPEInterruptedExternalTest">>,
     <<"EndExternalTest", "ESPEFreeNoTest">>,
     <<"TestError1C410", "ESPEFreeNoTest">>, <<"ParameterError", "ResetError5">>}
    \cup (Testing \X TestErrors) \cup (TestErrors \X TestErrors)
    \cup (TestErrors \X {"ExternalFunctionTest", "ResetError3"})
    \cup UNION {{e} \X Watched[e] : e \in DOMAIN Watched}
    \cup (States \X {"Idle"}) \cup {<<s, s>> : s \in States})
OneTransitionPerCall == [][(<<state, state'>> \in Transitions)]_beat
\* TSS-IN-ACTIVATE: there is no input to which a call has no answer
EveryCallIsAnswered == \A n \in InputsToTry : ENABLED SensorScan(Alphabet[n])
\* TSS-IN-ACTIVATE, TSS-OUT-READY, TSS-8401: a call with Activate ends in a state that is active
ActiveAtOnce == [][Scanned.Activate => Then("Ready")]_beat
\* TSS-0000, TSS-IN-ACTIVATE: before the first call the block is inactive
PowerUpIsSafe == step = "" => Row = Rows["Idle"] /\ ~Row.S_OSSD_Out
=============================================================================
