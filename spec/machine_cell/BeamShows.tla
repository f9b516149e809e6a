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
     Error |-> Rows[state].Error, reset |-> resetBefore]

\* What the refinement tries: everything, and times around the end of the test
Inputs ==
    [Activate : BOOLEAN, S_OSSD_In : BOOLEAN, StartTest : BOOLEAN, NoExternalTest : BOOLEAN,
     S_StartReset : BOOLEAN, S_AutoReset : BOOLEAN, Reset : BOOLEAN, dt : 0..TEST_TIME]
=============================================================================
