-------------------------- MODULE KeyFlowsAsPrinted -------------------------
(***************************************************************************)
(* What the note could be taken to say of the whole system, and what we    *)
(* did not decide.  Op_Reading takes the place of Op of KeyFlows where a   *)
(* run tries that reading.  A reading of a device that the others notice   *)
(* stands here beside its device's module.                                 *)
(***************************************************************************)
EXTENDS KeyFlows

LOCAL RestartPlc ==
    /\ ReadAuthorization' = 0 /\ MW03' = 0 /\ CheckMSO' = 0 /\ MW07' = 0
    /\ UNCHANGED <<turn, reader, eks, fplc, hmi, history>>
    /\ Took(0) /\ Did("RestartPlc")

----------------------------------------------------------------------------
(* PlcRestarts                                                             *)
\* EKS-GP-5, E-70: the PLC restarts alone, at any moment, with zeros; the others go on (breaks A-19).
Next_PlcRestarts == User \/ EksRuns \/ FplcRuns \/ PlcRuns \/ PanelRuns \/ RestartPlc

----------------------------------------------------------------------------
(* CheckBeforeClear                                                        *)
\* EKS-8-4, EKS-8-5, E-26: outputs that step 4 finds set are no removal that can be merged (A-16).
Clears_CheckBeforeClear == eksState \in Working \ {"Signal"} /\ reader # key

----------------------------------------------------------------------------
(* PulseRunsOn                                                             *)
\* EKS-8-2, EKS-8-5, E-58: a pulse that runs on is cleared in a scan of its own.
Clears_PulseRunsOn ==
    \/ eksState \in {"ClearOutputs", "PulseRunsOn"}
    \/ eksState \in Working \ {"Signal", "TestOnes"} /\ reader # key

----------------------------------------------------------------------------
(* TouchBeforeEchoCounts                                                   *)
\* EKS-2-23, E-69: the confirmation can be touched before its screen is there.
Fields_TouchBeforeEchoCounts ==
    {""} \cup {Field(m) : m \in Enabled} \cup (IF hmiState = "Confirm" THEN {"confirm", "reject"} ELSE {})
    \cup (IF hmiState = "AwaitEcho" THEN {"confirm"} ELSE {})

----------------------------------------------------------------------------
(* WithdrawsAfterConfirm                                                   *)
\* EKS-2-25, E-53: the withdrawal can be touched after the confirmation, and what was confirmed is not wanted
\* any more.
Fields_WithdrawsAfterConfirm ==
    {""} \cup {Field(m) : m \in Enabled} \cup (IF hmiState = "Confirm" THEN {"confirm", "reject"} ELSE {})
    \cup (IF hmiState = "AwaitSwitch" THEN {"reject"} ELSE {})
Remember_WithdrawsAfterConfirm ==
    CASE hmiState' = hmiState -> UNCHANGED history
      [] hmiState = "Select" /\ hmiState' = "AwaitEcho" ->
            touched' = hmiSelection' /\ seen' = None /\ confirmed' = None
      [] hmiState # "Confirm" /\ hmiState' = "Confirm" ->
            seen' = (IF touched = Shown' THEN touched ELSE seen) /\ UNCHANGED <<touched, confirmed>>
      [] hmiState = "Confirm" /\ hmiState' = "AwaitSwitch" -> confirmed' = seen /\ UNCHANGED <<touched, seen>>
      [] hmiState = "AwaitSwitch" /\ hmiState' = "Withdrawn" ->
            confirmed' = None /\ UNCHANGED <<touched, seen>>
      [] OTHER -> UNCHANGED history

----------------------------------------------------------------------------
(* Figure5ReadsMW01, AuthorityFromMW01                                     *)
\* EKS-5-1, E-12, E-18: the F-PLC reads MW01 back (FplcAsPrinted); here nothing else has written it.
LOCAL InputWithMW01(dt) ==
    [LA |-> LA, vec |-> Vector, MW01 |-> MW01, MW03 |-> MW03, MW07 |-> MW07, dt |-> dt]
FplcInput_Figure5ReadsMW01(dt) == InputWithMW01(dt)
FplcInput_AuthorityFromMW01(dt) == InputWithMW01(dt)
=============================================================================
