--------------------------- MODULE ContactorShows ---------------------------
(***************************************************************************)
(* SF_EDM by the pins of the cell.  Our own design; the block is EDM,      *)
(* unchanged.                                                              *)
(***************************************************************************)
EXTENDS EDM

Starts == EDMInit
Call(i) == EDMCall(i)

\* What its contract speaks of
Row ==
    [S_EDM_Out |-> S_EDM_Out, Error |-> Error, waits |-> state \notin Clocked, inhibited |-> state = "Init",
     asked |-> outControlBefore, reset |-> resetBefore]

\* What the refinement tries: everything, and times up to MonitoringTime
Inputs ==
    [Activate : BOOLEAN, S_OutControl : BOOLEAN, S_EDM1 : BOOLEAN, S_EDM2 : BOOLEAN, S_StartReset : BOOLEAN,
     Reset : BOOLEAN, dt : 0..MONITORING_TIME]

\* Nobody asks or resets, both contactors are dropped out, for a tick a call; and where that leads
RestInputs ==
    {[Activate |-> TRUE, S_OutControl |-> FALSE, S_EDM1 |-> TRUE, S_EDM2 |-> TRUE, S_StartReset |-> FALSE,
      Reset |-> FALSE, dt |-> 1]}
Rests ==
    /\ state \in {"Init", "OutputDisable"} \cup {EDMErrors[n] : n \in 1..9}
    /\ resetBefore = FALSE /\ outControlBefore = FALSE
    /\ stopSeen = (state = "OutputDisable")
    /\ elapsed = IF state = "OutputDisable" THEN MONITORING_TIME ELSE 0
=============================================================================
