---------------------- MODULE TestableSafetySensorLive -----------------------
(***************************************************************************)
(* What must happen in the end.  Until somebody serves the machine any     *)
(* input may stand in any call.  From then on the block stays active, the  *)
(* constants stay as they are, the sensor answers, nobody stands in its    *)
(* field but for the manual test, and somebody presses Reset where the     *)
(* block asks for it or shows an error.  Fairness: the block is called     *)
(* again and again.                                                        *)
(* Error behaviour, the manual test, the two inhibits, the test.           *)
(* Leaves out: a TestTime out of its range; how long it takes (a theorem   *)
(* says it in calls).                                                      *)
(***************************************************************************)
EXTENDS TestableSafetySensorOpen

CONSTANT EAGER     \* TRUE: a test is asked for whenever one is possible

VARIABLES
    served,        \* somebody serves the machine
    fixed          \* NoExternalTest, S_StartReset and S_AutoReset from then on, or nothing

liveVars == <<block, served, fixed>>
Unobserved == UNCHANGED <<observer, in, beat>>

LiveInit == OpenInit /\ served = FALSE /\ fixed = <<>>

ASSUME ~PRINT_GRAPH
AnyCall ==
    /\ ~served /\ (\E n \in 0..N - 1 : SensorScan(Alphabet[n]))
    /\ UNCHANGED <<served, fixed>> /\ Unobserved
TakeOver ==
    /\ ~served /\ served' = TRUE
    /\ fixed' \in [NoExternalTest : BOOLEAN, S_StartReset : BOOLEAN, S_AutoReset : BOOLEAN]
    /\ UNCHANGED <<block, step>> /\ Unobserved

\* TSS-8002: the manual test is to be made, and the sensor was free in the call before
InTheField == state = "ExternalFunctionTest" /\ sensorBefore
\* TSS-OUT-TESTOUT: with its sender switched off the sensor is dark
SensorAnswers == SensorOutputs.S_TestOut /\ ~InTheField
\* TSS-OUT-REQUEST, TSSF-13: C010 does not ask for the reset that begins the manual test; its Error does
Pressed == ~resetBefore /\ (SensorOutputs.ResetRequest \/ SensorOutputs.Error)
ServedInput(start, dt) ==
    [Activate |-> TRUE, S_OSSD_In |-> SensorAnswers, StartTest |-> start,
     NoExternalTest |-> fixed.NoExternalTest, S_StartReset |-> fixed.S_StartReset,
     S_AutoReset |-> fixed.S_AutoReset, Reset |-> Pressed, dt |-> dt]
Starts == IF EAGER THEN {SensorOutputs.TestPossible /\ ~startTestBefore} ELSE BOOLEAN
\* TSSA-03: a call and the answer of the sensor take less than TestTime
ServedCall ==
    /\ served /\ (\E start \in Starts : \E dt \in 0..TEST_TIME - 1 : SensorScan(ServedInput(start, dt)))
    /\ UNCHANGED <<served, fixed>> /\ Unobserved
LiveNext == AnyCall \/ TakeOver \/ ServedCall
LiveSpec == LiveInit /\ [][LiveNext]_<<liveVars, step>> /\ WF_liveVars(ServedCall)

\* TSS-EB-2, TSS-EB-4, TSS-EB-5, TSS-IN-NOEXT-FALSE, TSS-IN-NOEXT-TRUE, TSS-8404, TSSF-12, TSSF-13, TSSF-16:
\* from any state it enables again, and goes on to
EnablesAgain == served ~> []SensorOutputs.S_OSSD_Out
\* TSS-TEST-3, TSS-OUT-EXECUTED, TSS-FN-5: and can be tested again
TestedAgain == served ~> SensorOutputs.TestExecuted
=============================================================================
