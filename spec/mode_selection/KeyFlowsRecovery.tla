-------------------------- MODULE KeyFlowsRecovery --------------------------
(***************************************************************************)
(* After the last fault.  Fairness: every device keeps scanning.           *)
(*  RecoverySpec  once the key stays out and the wires are whole, nothing  *)
(*                is left of any insertion, whatever the fault was.        *)
(*  AfterFaultSpec  a user who from then on has a goal, on a machine that  *)
(*                from then on keeps its deadlines, gets the mode.         *)
(* Insert steps 1 to 29, removal steps 1 to 18.                            *)
(* Leaves out: how long it takes; faults that never end; the latched fault *)
(* of the reader, which by EKS-8-4 only a restart of the reader ends.      *)
(***************************************************************************)
EXTENDS KeyFlowsLive, KeyFlowsFaults

\* One element at a time; an extra wire and a crossed pair show only while an output that they touch is on
LOCAL Single == WireClasses \ {"extra wire", "crossed wires"}
SingleElements == Single

\* Each fairness condition has as its subscript what the steps that it is about may change; a scan that meets
\* a fault changes these too
met == <<plc, faultVars>>
Whole == wrong' = {} /\ UNCHANGED faultVars
RecoveryInit == FaultInit /\ goal = None

CopiedOn(copy) == copy /\ UNCHANGED <<reader, eks, fplc, hmi, history, goal>> /\ Took(0) /\ Whole
FairPlcOn ==
    /\ WF_plc(CopiedOn(CopyReadAuthorization(PlcInput))) /\ WF_plc(CopiedOn(CopyMW03(PlcInput)))
    /\ WF_plc(CopiedOn(CopyCheckMSO(PlcInput))) /\ WF_plc(CopiedOn(CopyMW07(PlcInput)))
    /\ ANY_ORDER \/ WF_plc(CopiedOn(PlcScan(PlcInput)))

RecoverySpec ==
    /\ RecoveryInit /\ [][FaultNext /\ Same]_<<everything, goal>>
    /\ FairPlcOn /\ WF_eks(EksRunsFaulty /\ Same) /\ WF_<<fplc, met>>(FplcRunsFaulty /\ Same)
    /\ WF_<<panel, met>>(PanelRunsFaulty /\ Same)

\* EKS-8-6 to EKS-8-18: nothing is left of an insertion
AsBefore ==
    /\ fplcState = "Idle" /\ accepted = None /\ authority = None /\ fplcSelection = None
    /\ eksState = "Empty" /\ hmiState = "Inhibited"
    /\ ReadAuthorization = 0 /\ MW03 = 0 /\ CheckMSO = 0 /\ MW07 = 0
\* EKS-8-18, EKS-9-0, EKS-GP-4, E-23: whatever fault it was
RecoversFully == <>[](reader = None /\ broken = {}) => <>[]AsBefore

----------------------------------------------------------------------------
TakeGoalAfterFaults == faults = FAULTS /\ broken = {} /\ TakeGoal /\ Whole
Steered(device) == goal # None /\ device /\ Same /\ Whole
AfterFaultNext ==
    \/ goal = None /\ FaultNext /\ Same
    \/ TakeGoalAfterFaults
    \/ Steered(EarnestUser) \/ Steered(EarnestPanel)
    \/ Steered(PromptFplc) \/ Steered(PromptEks) \/ Steered(PlcRuns)
AfterFaultSpec ==
    /\ RecoveryInit /\ [][AfterFaultNext]_<<everything, goal>> /\ FairPlcOn
    /\ WF_reader(Steered(EarnestUser)) /\ WF_panel(Steered(EarnestPanel))
    /\ WF_fplc(Steered(PromptFplc)) /\ WF_eks(Steered(PromptEks))

\* EKS-2-29, EKS-8-18, E-23: from whatever state the last fault left
GoalReachedAfterFault == (goal # None) ~> (mode = {goal})
=============================================================================
