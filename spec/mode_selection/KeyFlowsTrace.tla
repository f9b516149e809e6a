---------------------------- MODULE KeyFlowsTrace ---------------------------
(***************************************************************************)
(* What one line of a log of the whole system says: one device takes one   *)
(* scan and reads what the others last wrote.  The user appears only in    *)
(* what the EKS and the panel read.  Time is the device's own, as in its   *)
(* module; the assumptions of KeyFlows about time (A-06, A-07, A-09) are   *)
(* not demanded of a log.                                                  *)
(***************************************************************************)
EXTENDS KeyFlows, EksTrace, FplcTrace, PlcTrace, HmiTrace

LOCAL Others(u) == UNCHANGED u /\ UNCHANGED history

\* EKS-2-1, EKS-8-1: the reader holds what the EKS finds in it
SystemEks(w) == EksScan(EksRead(w)) /\ reader' = EksRead(w).key /\ Took(w.dt) /\ Others(<<fplc, plc, hmi>>)
\* EKS-BD-1
SystemFplc(w) ==
    FplcRead(w) = FplcInput(w.dt) /\ FplcScan(FplcRead(w)) /\ Took(w.dt) /\ Others(<<reader, eks, plc, hmi>>)
\* EKS-BD-2
SystemPlc(w) == PlcRead(w) = PlcInput /\ PlcScan(PlcRead(w)) /\ Took(0) /\ Others(<<reader, eks, fplc, hmi>>)
\* EKS-8-8: the active mode that is displayed is the one that the F-PLC has set
SystemHmi(w) ==
    /\ HmiRead(w) = HmiInput(w.touch) /\ w.ActiveMSO = ActiveMSO
    /\ HmiScan(HmiRead(w)) /\ Took(0) /\ Others(<<reader, eks, fplc, plc>>)
=============================================================================
