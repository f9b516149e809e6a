----------------------- MODULE EnableSwitchAsPrinted -----------------------
(***************************************************************************)
(* What the document could be taken to say where we decided otherwise, one *)
(* section a reading.  Op_Reading takes the place of Op in the runs that   *)
(* try the reading; what Reset could mean in every block of the family     *)
(* stands in CyclicBlockAsPrinted.                                         *)
(***************************************************************************)
EXTENDS EnableSwitch

----------------------------------------------------------------------------
(* What enables.                                                           *)

\* ES-ORDER-2, ESF-02: stage 1 that follows stage 2 enables
MayEnable_Stage1After2Enables(i) == On("Stage0", i) \/ InTime("ChangeToStage1", i) \/ On("Stage2", i)
MayNotEnable_Stage1After2Enables(i) == InTime("ChangeToStage0", i)

\* ES-SEQ-8, ESF-02: stage 1 that comes back within the time, and not from stage 2, is still the same
BeginReturn_BackToStage1Enables(i) ==
    /\ On("Stage1", i) \/ On("Stage2", i)
    /\ SeesNoStage(i)
    /\ To(IF state = "Stage1" THEN "ChangeToStage1" ELSE "ChangeToStage0", i)
    /\ Did("BeginReturn")

\* ES-SEQ-2, ESF-02: the mode may come while the switch is in stage 1, and stage 1 then enables
MayEnable_ModeAtAnyStage(i) == On("Stage0", i) \/ InTime("ChangeToStage1", i) \/ On("SafeMode", i)
RefuseStage_ModeAtAnyStage(i) ==
    /\ On("SafeMode", i) /\ ~SeesStage0(i) /\ ~SeesStage1(i)
    /\ To("OperationError", i)
    /\ Did("RefuseStage")

\* ES-SEQ-2, ES-NOTE-1, ESF-09: the call that sees the mode sees the stage too
SeeSafetyActive_StageSeenWithTheMode(i) ==
    /\ On("BasicMode", i)
    /\ To(IF SeesStage0(i) THEN "Stage0" ELSE "OperationError", i)
    /\ Did("SeeSafetyActive")

\* ES-SEQ-1, ESF-09: what is no stage 0 is an error without the mode too
AwaitSafetyActive_JudgedWithoutTheMode(i) ==
    /\ At("BasicMode", i) /\ ~i.S_SafetyActive
    /\ To(IF SeesStage0(i) THEN "BasicMode" ELSE "OperationError", i)
    /\ Did("AwaitSafetyActive")

\* ES-ORDER-2, ESF-03: stage 1 after stage 2 is no error; only stage 0 leads on
RefuseStage1_NoErrorAfterStage2(i) == MayNotEnable(i) /\ SeesStage1(i) /\ To("Stage2", i) /\ Did("RefuseStage1")

----------------------------------------------------------------------------
(* What the channels show.                                                 *)

\* ES-STAGE-2, ESF-03: all FALSE after stage 0 is no stage 2: a contact is open, and the others will close
SeesStage2_AllFalseIsAChange(i) ==
    /\ ~i.S_EnableSwitchCh1 /\ ~i.S_EnableSwitchCh2 /\ ~i.S_EnableSwitchCh3
    /\ state \notin {"Stage0", "ChangeToStage1"}

\* ES-STAGE-1, ESF-05: channels 1 and 3 alone make stage 1
SeesStage1_Ch2IsNotRead(i) == i.S_EnableSwitchCh1 /\ i.S_EnableSwitchCh3

----------------------------------------------------------------------------
(* The time of a change.                                                   *)

\* ESF-04: the enable outlives the beginning of a change until its time is over
LOCAL Kept(i) == SeesNoStage(i) /\ elapsed + i.dt < DiscrepancyTimeCh1_Ch3
StayEnabled_KeepsEnableInAChange(i) ==
    /\ On("Stage1", i)
    /\ SeesStage1(i) \/ Kept(i)
    /\ GoTo("Stage1") /\ RemembersReset(i)
    /\ elapsed' = IF SeesStage1(i) THEN 0 ELSE elapsed + i.dt
    /\ Did("StayEnabled")
BeginReturn_KeepsEnableInAChange(i) ==
    /\ On("Stage1", i) \/ On("Stage2", i)
    /\ SeesNoStage(i) /\ ~(state = "Stage1" /\ Kept(i))
    /\ To("ChangeToStage0", i)
    /\ Did("BeginReturn")

\* ES-SEQ-8, ESF-04: only the change from stage 0 to stage 1 is timed
Late_NoTimeForTheWayBack(i) == state # "ChangeToStage0" /\ elapsed + i.dt >= DiscrepancyTimeCh1_Ch3

\* ES-SEQ-3, ESF-05: the time runs only while channels 1 and 3 differ
Late_OnlyCh1Ch3IsTimed(i) == ~SeesContradiction(i) /\ elapsed + i.dt >= DiscrepancyTimeCh1_Ch3
TimeGoesOn_OnlyCh1Ch3IsTimed(i) ==
    elapsed' = IF SeesContradiction(i) THEN 0 ELSE Counted(elapsed, i.dt, DiscrepancyTimeCh1_Ch3)

\* ES-SEQ-3, ESF-07: a change that is complete is accepted, however late
Late_SuccessBeforeExpiry(i) == SeesNoStage(i) /\ elapsed + i.dt >= DiscrepancyTimeCh1_Ch3

----------------------------------------------------------------------------
(* The end of an error.                                                    *)

\* ES-SEQ-5, ESF-06: channels 1 and 3 agree again, and that is taken for the end of the cause
SeesCauseGone_EqualChannelsAreEnough(i) ==
    SeesStage0(i) \/ i.S_EnableSwitchCh1 = i.S_EnableSwitchCh3

\* The reset leads to where only stage 0 leads on, if that is not there
To_EqualChannelsAreEnough(s, i) ==
    /\ GoTo(IF s = "Stage0" /\ ~SeesStage0(i) THEN "Stage2" ELSE s)
    /\ elapsed' = 0 /\ RemembersReset(i)

\* ES-SEQ-5, ES-RESTART, ESF-06: an error ends as soon as its cause is gone
Resets_ErrorEndsWithItsCause(i) == TRUE

\* ES-SEQ-0, ES-SEQ-5, ESF-12: an error is there again after the activation; while the block is not active,
\* elapsed below 0 is the number of its cause
LOCAL Causes == <<"OperationError", "PlausibilityError", "EquivalenceError">>
LOCAL NumberOfCause ==
    CASE state \in {"OperationError", "OperationErrorAtStage0", "ResetError1"} -> 1
      [] state \in {"PlausibilityError", "PlausibilityErrorAtStage0", "ResetError2"} -> 2
      [] state \in {"EquivalenceError", "EquivalenceErrorAtStage0", "ResetError3"} -> 3
      [] OTHER -> 0
Deactivate_ErrorRemembered(i) ==
    state # "Idle" /\ ~i.Activate /\ GoTo("Idle") /\ elapsed' = -NumberOfCause /\ RemembersReset(i) /\ Did("Deactivate")
StayIdle_ErrorRemembered(i) ==
    state = "Idle" /\ ~i.Activate /\ UNCHANGED <<state, elapsed>> /\ RemembersReset(i) /\ Did("StayIdle")
StartUp_ErrorRemembered(i) ==
    At("Idle", i) /\ To(IF elapsed < 0 THEN Causes[-elapsed] ELSE "BasicMode", i) /\ Did("StartUp")
=============================================================================
