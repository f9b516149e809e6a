---------------------------- MODULE KeyFlowsLive ----------------------------
(***************************************************************************)
(* What must happen in the end.  Fairness: every device keeps scanning.    *)
(* Three questions, each a specification of its own:                       *)
(*  GoalSpec     from any state that the honest devices can reach, a user  *)
(*               who from now on has a goal, on a machine that from now on *)
(*               keeps its deadlines, gets the mode.                       *)
(*  RemovalSpec  a key that stays out leads back to Idle, whatever the     *)
(*               user did and whatever deadline passed before.             *)
(*  SettleSpec   between two selections the words go back to zero,         *)
(*               whatever the user does, so its deadline meets no user.    *)
(* Leaves out: faults (KeyFlowsRecovery); how long it takes.               *)
(***************************************************************************)
EXTENDS KeyFlows

VARIABLE
    goal            \* the mode that the user wants, or None while the user does anything

liveVars == <<View, goal>>
panel == <<hmi, history>>

LiveInit == Init /\ goal = None

----------------------------------------------------------------------------
(* A user with a goal.                                                     *)

\* From some moment on the user wants one mode and has a key that permits it
TakeGoal == goal = None /\ goal' \in {m \in MSO : \E l \in LEVELS : Permitted(l, m)} /\ UNCHANGED vars

KeyFits == reader \in LEVELS /\ Permitted(reader, goal)
\* EKS-2-1, EKS-8-1, E-23: takes out a key that does not fit, and any key when the error lamp is on or the
\* machine does not answer it
EarnestRemove == (~KeyFits \/ fplcState \in {"Start", "Clear", "AwaitZeros", "Error"}) /\ RemoveKey
\* EKS-2-1: inserts a fitting key when the machine is ready
EarnestInsert == \E k \in LEVELS : Permitted(k, goal) /\ fplcState = "Idle" /\ SwapNoticed /\ InsertKey(k)
\* EKS-2-14, EKS-2-23, EKS-2-25: touches the goal, confirms it when it is shown, rejects anything else
EarnestTouch ==
    CASE hmiState = "Select" /\ goal \in Enabled -> Field(goal)
      [] hmiState = "Confirm" -> (IF Shown = goal THEN "confirm" ELSE "reject")
      [] OTHER -> ""
EarnestUser == EarnestRemove \/ EarnestInsert
EarnestPanel == HmiScan(HmiInput(EarnestTouch)) /\ Took(0) /\ Remember /\ UNCHANGED <<reader, eks, fplc, plc>>

----------------------------------------------------------------------------
(* Deadlines that are kept.                                                *)

\* A-08: the F-PLC scans faster than the halves of the test pulse last
PulseSeen ==
    /\ eksState = "TestOnes" /\ reader = key => fplcState \notin {"Idle", "PulseOnes"}
    /\ eksState = "TestZeros" /\ reader = key => fplcState # "PulseZeros"
\* A deadline passes only where what is waited for cannot come any more
DeadlineIsDue ==
    CASE fplcState = "PulseOnes" -> eksState \in {"TestZeros", "Signal", "Rejected"}
      [] fplcState = "PulseZeros" -> eksState \in {"Signal", "Rejected"}
      [] fplcState = "AwaitZeros" -> reader # None
      [] OTHER -> FALSE
PromptTimes == {0} \cup
    (IF fplcState \in Timed /\ DeadlineIsDue THEN {T_REM} ELSE {}) \cup
    (IF fplcState \in {"Start", "Settle", "AwaitZeros", "Error"} /\ WordsArrived THEN {T_DWELL} ELSE {})
PromptFplc ==
    /\ \E dt \in PromptTimes : FplcScan(FplcInput(dt)) /\ (dt > 0 => fplcState' # fplcState) /\ Took(dt)
    /\ UNCHANGED <<reader, eks, plc, hmi, history>>
PromptEks == EksRuns /\ (eksState' # eksState => PulseSeen)

----------------------------------------------------------------------------
Same == UNCHANGED goal
GoalNext ==
    \/ TakeGoal
    \/ goal = None /\ Next /\ Same
    \/ goal # None /\ (EarnestUser \/ EarnestPanel \/ PromptFplc \/ PromptEks \/ PlcRuns) /\ Same
\* For a reader of a trace: any step of the two questions
AnyNext == GoalNext \/ (Next /\ Same)

\* Each of the four copies is made again and again; where the PLC decides by a word, whatever is due
Copied(copy) == copy /\ UNCHANGED <<reader, eks, fplc, hmi, history>> /\ Same
FairPlc ==
    /\ WF_plc(Copied(CopyReadAuthorization(PlcInput))) /\ WF_plc(Copied(CopyMW03(PlcInput)))
    /\ WF_plc(Copied(CopyCheckMSO(PlcInput))) /\ WF_plc(Copied(CopyMW07(PlcInput)))
    /\ ANY_ORDER \/ WF_plc(Copied(PlcScan(PlcInput)))

GoalSpec ==
    /\ LiveInit /\ [][GoalNext]_<<liveVars, step, took>> /\ FairPlc
    /\ WF_reader(goal # None /\ EarnestUser /\ Same) /\ WF_panel(goal # None /\ EarnestPanel /\ Same)
    /\ WF_fplc(goal # None /\ PromptFplc /\ Same) /\ WF_eks(goal # None /\ PromptEks /\ Same)

\* EKS-2-29, EKS-FD-2, EKS-T2-2: every permitted mode can be activated, from whatever state
GoalReached == (goal # None) ~> (mode = {goal})

FairDevices ==
    FairPlc /\ WF_eks(EksRuns /\ Same) /\ WF_fplc(FplcRuns /\ Same) /\ WF_panel(PanelRuns /\ Same)
RemovalSpec == LiveInit /\ [][Next /\ Same]_<<liveVars, step, took>> /\ FairDevices

\* A user who does anything, on a machine whose deadlines pass only where DeadlineIsDue: in Settle never
SettleSpec ==
    /\ LiveInit /\ [][(User \/ EksRuns \/ PromptFplc \/ PlcRuns \/ PanelRuns) /\ Same]_<<liveVars, step, took>>
    /\ FairPlc /\ WF_fplc(PromptFplc /\ Same) /\ WF_panel(PanelRuns /\ Same)
\* EKS-GP-5, E-15, E-59: no touch keeps the words from zero; a touch that came early is dropped
SettleEnds == fplcState = "Settle" ~> fplcState # "Settle"

\* EKS-8-6 to EKS-8-18, EKS-9-0, EKS-GP-4, EKS-GP-5, E-23: a key that stays out leads back to Idle, and Idle
\* stays
RemovalLeadsToIdle == <>[](reader = None) => <>[](fplcState = "Idle")
=============================================================================
