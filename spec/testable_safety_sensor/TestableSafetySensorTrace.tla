---------------------- MODULE TestableSafetySensorTrace ----------------------
(***************************************************************************)
(* What one line of a log says about a call of the block: w holds the      *)
(* inputs by their names, and dt in ms, as the block reads them.           *)
(***************************************************************************)
EXTENDS TestableSafetySensor

\* TSS-C000: states that a TestTime out of its range leads to, and those that it never comes to
LOCAL Refused == {"ParameterError", "ResetError5"}
LOCAL AlwaysThere == {"Idle", "Init"}
LOCAL AfterATest == {"TestActive", "ESPEFreeTestOk", "ESPEInterrupted2", "WaitForReset2", "ResetError6"}
LOCAL CanBe ==
    AlwaysThere \cup (IF ~TestTimeValid THEN Refused
                      ELSE IF TEST_TIME = 0 THEN States \ (Refused \cup AfterATest) ELSE States \ Refused)
LOCAL SeenFree == {"ESPEFreeNoTest", "ESPEFreeTestOk", "TestRequest", "TestError1C410"}
LOCAL SeenDark == {"ESPEInterrupted1", "ESPEInterrupted2", "ESPEInterruptedExternalTest", "TestActive"}
LOCAL Awaiting == {"WaitForReset1", "WaitForReset2", "EndExternalTest"}
\* TSS-TEST-0, TSS-FN-3, TSS-ERR-3, TSS-8002: which memory goes with which state; where an edge of Reset is
\* awaited, one that stands came with the end of an interruption
SensorAnywhere ==
    /\ state \in CanBe
    /\ resetBefore \in IF state \in ResetErrors THEN {TRUE} ELSE BOOLEAN
    /\ startTestBefore \in BOOLEAN
    /\ sensorBefore \in
        IF state \in SeenFree \/ (state \in Awaiting /\ resetBefore) THEN {TRUE}
        ELSE IF state \in SeenDark THEN {FALSE} ELSE BOOLEAN
    /\ startInhibit \in
        IF state \in {"ESPEInterrupted1", "WaitForReset1", "ResetError2"} THEN BOOLEAN ELSE {FALSE}
    /\ elapsed \in IF state \in Testing /\ TEST_TIME > 0 THEN 0..(TEST_TIME - 1) ELSE {0}
    /\ step = ""
=============================================================================
