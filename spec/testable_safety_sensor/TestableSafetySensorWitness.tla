--------------------- MODULE TestableSafetySensorWitness ---------------------
(***************************************************************************)
(* What must be reachable, so that the properties are not vacuous:         *)
(* every step by its name, which only the step itself sets, every          *)
(* transition by the states it joins, and every code as it stands on the   *)
(* wires.  Each name that is met is printed once; runs.toml lists the      *)
(* names that must be met.                                                 *)
(***************************************************************************)
EXTENDS TestableSafetySensorOpen

Report(name) ==
    IF name \in TLCGet(1) THEN TRUE
    ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))

LOCAL Digit == <<"0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "A", "B", "C", "D", "E", "F">>
\* TSS-OUT-DIAG: a code in four hex digits
Code(n) ==
    Digit[(n \div 4096) + 1] \o Digit[((n \div 256) % 16) + 1]
    \o Digit[((n \div 16) % 16) + 1] \o Digit[(n % 16) + 1]

Mark ==
    /\ Report(step')
    /\ Report("DiagCode" \o Code(Row'.DiagCode))
    /\ (state # state' => Report(state \o "To" \o state'))
    \* TSSF-15: what the parameter changes
    /\ (step' = "ResetTestError" /\ ~Scanned.Reset => Report("TestErrorEndsByItself"))
    \* TSSF-19: the start-up inhibit outlives an interruption where the restart inhibit is switched off
    /\ (step' = "BecomeFree1" /\ Scanned.S_AutoReset => Report("StartInhibitOutlivesInterruption"))
    \* TSSF-21: a reset and the loss of the sensor in one call
    /\ (step' \in {"InterruptWait1", "InterruptWait2"} /\ ~resetBefore /\ Scanned.Reset =>
            Report("ResetAndLossAtOnce"))
    \* TSSF-23: an edge of StartTest that has no effect
    /\ (~Now("TestPossible") /\ Scanned.StartTest /\ ~startTestBefore => Report("StartTestWithoutEffect"))

ASSUME TLCSet(1, {})
=============================================================================
