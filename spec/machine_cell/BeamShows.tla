----------------------------- MODULE BeamShows ------------------------------
(***************************************************************************)
(* SF_TestableSafetySensor by the pins of the cell.  Our own design; the   *)
(* block is TestableSafetySensor, unchanged.                               *)
(***************************************************************************)
EXTENDS TestableSafetySensor

Starts == SensorInit
Call(i) == SensorScan(i)

\* What its contract speaks of
Row ==
    [S_OSSD_Out |-> Rows[state].S_OSSD_Out, TestPossible |-> Rows[state].TestPossible,
     S_TestOut |-> Rows[state].S_TestOut, Error |-> Rows[state].Error, reset |-> resetBefore]

\* What the refinement tries: everything, and times around the end of the test
Inputs ==
    [Activate : BOOLEAN, S_OSSD_In : BOOLEAN, StartTest : BOOLEAN, NoExternalTest : BOOLEAN,
     S_StartReset : BOOLEAN, S_AutoReset : BOOLEAN, Reset : BOOLEAN, dt : 0..TEST_TIME]

\* Nobody touches it, the beam is free, for a tick a call; and where that leads
RestInputs ==
    {[Activate |-> TRUE, S_OSSD_In |-> TRUE, StartTest |-> FALSE, NoExternalTest |-> TRUE,
      S_StartReset |-> FALSE, S_AutoReset |-> FALSE, Reset |-> FALSE, dt |-> 1]}
Rests ==
    /\ state \in {"Init", "WaitForReset1", "ESPEFreeNoTest", "ESPEFreeTestOk", "WaitForReset2", "TestError1C410"}
    /\ resetBefore = FALSE /\ startTestBefore = FALSE /\ sensorBefore = TRUE /\ elapsed = 0
    /\ startInhibit \in BOOLEAN
    /\ SensorTypeOK
=============================================================================
