----------------------------- MODULE EDMWitness -----------------------------
(***************************************************************************)
(* What must be reachable, so that the properties are not vacuous: every   *)
(* step, state, transition between states, DiagCode, and some              *)
(* situations.  A step is a witness by its name, which only it sets.       *)
(***************************************************************************)
EXTENDS Sequences, EDMOpen

Report(name) ==
    IF name \in TLCGet(1) THEN TRUE
    ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))

\* What is seen when a step is taken, asked only in that step
Situation ==
    CASE step' = "StayDisabled" ->
            \* EDM-SEQ-2, EDM-SEQ-6
            /\ (~OnTime => Report("ExpiresWithoutResult"))
            \* EDMF-04
            /\ (Scanned.S_OutControl /\ BothAre(TRUE) => Report("RequestHeldOverReset"))
            /\ (~BothAre(TRUE) => Report("DropsOutInTime"))
         \* EDM-SEQ-3
      [] step' = "StayEnabled" ->
            /\ (~BothAre(FALSE) => Report("PicksUpInTime"))
            /\ (~OnTime => Report("StaysPickedUp"))
      [] step' = "MissPickUp" ->
            \* EDMF-08
            /\ (unchanged = MONITORING_TIME => Report("DropsOutLater"))
            \* EDMF-06
            /\ (~Scanned.S_OutControl => Report("StopWithTimeout"))
      [] step' = "MissDropOut" -> (unchanged = MONITORING_TIME => Report("PicksUpLater"))
         \* EDMF-07
      [] step' = "StayInError" -> (ResetEdge => Report("ResetOverWrongFeedback"))
         \* EDMF-04
      [] step' = "EnableOutput" -> (controlWas => Report("RequestWasThere"))
      [] OTHER -> TRUE

Mark ==
    /\ Report(step') /\ Report("at " \o state')
    \* EDM-OUT-DIAG: the code says that another state has come
    /\ (DiagCode' # DiagCode => Report("code of " \o state'))
    /\ (state' # state => Report(state \o " to " \o state'))
    /\ Situation

ASSUME TLCSet(1, {})
=============================================================================
