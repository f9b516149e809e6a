--------------------------- MODULE EnableSwitch ---------------------------
(***************************************************************************)
(* The enable switch with three channels and three stages: released (0),   *)
(* enabled (1), pressed through (2).  One step is one call.  i holds the   *)
(* inputs of the call by the names of interface.toml, and dt in ticks.     *)
(* The document (clauses.toml)  gives one signal sequence, ES-SEQ-0 to     *)
(* ES-SEQ-9.  The states, their codes, the priorities and every reaction   *)
(* that the sequence does not show are this project's design: findings     *)
(* ESF-01 and those that the comments name.                                *)
(* Leaves out: the wiring of the contacts and the input filters (ESA-02),  *)
(* what the enabled machine does.                                          *)
(***************************************************************************)
EXTENDS CyclicBlock

CONSTANTS
    DiscrepancyTimeCh1_Ch3,   \* ticks that a change between two stages may last; 0 is the initial value
    MODE_ENDS_ERROR,          \* TRUE: the end of the operating mode also ends an error
    AUTO_RESET_ERRORS         \* TRUE: S_AutoReset takes the place of the edge that ends an error

VARIABLES elapsed             \* ticks since the call that saw the change begin; 0 outside the timed states

block == <<state, resetBefore, elapsed>>

ASSUME DiscrepancyTimeCh1_Ch3 \in Nat /\ MODE_ENDS_ERROR \in BOOLEAN /\ AUTO_RESET_ERRORS \in BOOLEAN

\* A change between two stages is under way: the only states with a timer
Timed == {"ChangeToStage1", "ChangeToStage0"}
\* An error whose cause is still there
Faulty == {"OperationError", "PlausibilityError", "EquivalenceError"}
\* The same with stage 0 back: a reset is possible, ESF-06
Released == {"OperationErrorAtStage0", "PlausibilityErrorAtStage0", "EquivalenceErrorAtStage0"}
ResetErrors == {"ResetError1", "ResetError2", "ResetError3"}
Errors == (Faulty \cup Released) \cup ResetErrors
\* The operating mode is on, and there is no error
Operating == {"SafeMode", "Stage0", "Stage1", "Stage2"} \cup Timed
States == {"Idle", "BasicMode"} \cup Operating \cup Errors

BlockTypeOK ==
    /\ state \in States
    /\ resetBefore \in BOOLEAN
    /\ elapsed \in 0..DiscrepancyTimeCh1_Ch3
    /\ state \in Timed => elapsed = 0 \/ elapsed < DiscrepancyTimeCh1_Ch3
    /\ state \notin Timed => elapsed = 0

BlockInit == state = "Idle" /\ resetBefore = FALSE /\ elapsed = 0

----------------------------------------------------------------------------
(* Outputs: the row of the state after the call.                           *)

\* ES-SEQ-0: the only output that is TRUE in one state alone
S_EnableSwitchOut == state = "Stage1"
\* ES-SEQ-3, ES-SEQ-4, ES-SEQ-5
Error == state \in Errors
\* ESF-01: not in the document
Ready == state # "Idle"
\* ESF-01: not in the document; the mode is on, and the switch is not where it enables
SafetyDemand == state \in {"Stage0", "Stage2"} \cup Timed
\* ESF-01: not in the document; a rising edge of Reset would be accepted now
ResetRequest == state \in Released
\* ESF-01, ES-NOTE-3: the document prints no code
DiagCode ==
    CASE state = "Idle" -> \h0000               [] state = "BasicMode" -> \h8002
      [] state = "SafeMode" -> \h8004           [] state = "Stage0" -> \h8802
      [] state = "ChangeToStage1" -> \h8812     [] state = "Stage1" -> \h8000
      [] state = "ChangeToStage0" -> \h8822     [] state = "Stage2" -> \h8832
      [] state = "OperationError" -> \hC020     [] state = "OperationErrorAtStage0" -> \hC420
      [] state = "PlausibilityError" -> \hC030  [] state = "PlausibilityErrorAtStage0" -> \hC440
      [] state = "EquivalenceError" -> \hC050   [] state = "EquivalenceErrorAtStage0" -> \hC450
      [] state = "ResetError1" -> \hC001        [] state = "ResetError2" -> \hC011
      [] state = "ResetError3" -> \hC021
\* The outputs by their names
BlockOutputs == [Ready |-> Ready, S_EnableSwitchOut |-> S_EnableSwitchOut, SafetyDemand |-> SafetyDemand,
                 ResetRequest |-> ResetRequest, Error |-> Error, DiagCode |-> DiagCode]

----------------------------------------------------------------------------
(* What a call finds: the stage, and the time of a change.                 *)

\* ES-STAGE-0: released
SeesStage0(i) == ~i.S_EnableSwitchCh1 /\ i.S_EnableSwitchCh2 /\ ~i.S_EnableSwitchCh3
\* ES-STAGE-1, ESF-05: enabled; channel 2 has to be FALSE
SeesStage1(i) == i.S_EnableSwitchCh1 /\ ~i.S_EnableSwitchCh2 /\ i.S_EnableSwitchCh3
\* ES-STAGE-2, ES-SEQ-4: pressed through, and also a device that is not plugged in
SeesStage2(i) == ~i.S_EnableSwitchCh1 /\ ~i.S_EnableSwitchCh2 /\ ~i.S_EnableSwitchCh3
\* ES-NOTE-1, ESF-04: the other five patterns are on the way from one stage to another
SeesNoStage(i) == ~SeesStage0(i) /\ ~SeesStage1(i) /\ ~SeesStage2(i)
\* ESF-05: all three TRUE: channels 1 and 3 agree, and channel 2 contradicts both
SeesContradiction(i) == i.S_EnableSwitchCh1 /\ i.S_EnableSwitchCh2 /\ i.S_EnableSwitchCh3
\* ES-SEQ-5, ESF-06: what has to be seen before an error can be reset
SeesCauseGone(i) == SeesStage0(i)

\* ES-SEQ-3, ESF-04, ESF-07: the time of the change is over; equality counts as over, and it is judged first
Late(i) == elapsed + i.dt >= DiscrepancyTimeCh1_Ch3
\* ES-SEQ-3, ESF-05: the time goes on whichever of the five patterns follow each other
TimeGoesOn(i) == elapsed' = Counted(elapsed, i.dt, DiscrepancyTimeCh1_Ch3)

----------------------------------------------------------------------------
(* How a step is guarded.  First the end of Activate, then the end of the  *)
(* mode, then the time, then the stage that is seen.                       *)

\* ES-SEQ-2: the mode is on
On(s, i) == At(s, i) /\ i.S_SafetyActive
InTime(s, i) == On(s, i) /\ ~Late(i)
\* ESF-08: whether the end of the mode ends an error too
LOCAL Held(errors, i) == state \in errors /\ i.Activate /\ (MODE_ENDS_ERROR => i.S_SafetyActive)
LOCAL Rest(i) == elapsed' = 0 /\ RemembersReset(i)
To(s, i) == GoTo(s) /\ Rest(i)
LOCAL Stay(i) == To(state, i)

\* ESF-06: the states of one error, which belong together
LOCAL Family == {
    [cause |-> "OperationError", released |-> "OperationErrorAtStage0", static |-> "ResetError1"],
    [cause |-> "PlausibilityError", released |-> "PlausibilityErrorAtStage0", static |-> "ResetError2"],
    [cause |-> "EquivalenceError", released |-> "EquivalenceErrorAtStage0", static |-> "ResetError3"]}

----------------------------------------------------------------------------
(* Not active, and without the operating mode.                             *)

\* ES-SEQ-0
StayIdle(i) == state = "Idle" /\ ~i.Activate /\ Stay(i) /\ Did("StayIdle")
\* ES-SEQ-0: before everything else, from every state
Deactivate(i) == state # "Idle" /\ ~i.Activate /\ To("Idle", i) /\ Did("Deactivate")
\* ES-SEQ-1
StartUp(i) == At("Idle", i) /\ To("BasicMode", i) /\ Did("StartUp")
\* ES-SEQ-1, ESF-09: the channels are not judged without the mode
AwaitSafetyActive(i) == At("BasicMode", i) /\ ~i.S_SafetyActive /\ Stay(i) /\ Did("AwaitSafetyActive")
\* ES-SEQ-2
SeeSafetyActive(i) == On("BasicMode", i) /\ To("SafeMode", i) /\ Did("SeeSafetyActive")
\* ES-SEQ-1, ESF-08: the mode ends, and with it the enable, in this very call
LoseSafetyActive(i) ==
    state \in Operating /\ i.Activate /\ ~i.S_SafetyActive /\ To("BasicMode", i) /\ Did("LoseSafetyActive")

\* ES-SEQ-2
AcceptStage0(i) == On("SafeMode", i) /\ SeesStage0(i) /\ To("Stage0", i) /\ Did("AcceptStage0")
\* ESF-02: the mode comes, and the switch is not released
RefuseStage(i) == On("SafeMode", i) /\ ~SeesStage0(i) /\ To("OperationError", i) /\ Did("RefuseStage")

----------------------------------------------------------------------------
(* The stages and the changes between them.                                *)

\* ES-STAGE-0, ES-SEQ-5
StayAtStage0(i) == On("Stage0", i) /\ SeesStage0(i) /\ Stay(i) /\ Did("StayAtStage0")
\* ES-SEQ-3, ES-SEQ-6: the time of the change begins
BeginChange(i) == On("Stage0", i) /\ SeesNoStage(i) /\ To("ChangeToStage1", i) /\ Did("BeginChange")
\* ES-ORDER-2, ESF-02: stage 1 enables where it comes out of stage 0
MayEnable(i) == On("Stage0", i) \/ InTime("ChangeToStage1", i)
\* ES-ORDER-2, ESF-02: and not where it comes out of stage 2, or back on the way to stage 0
MayNotEnable(i) == On("Stage2", i) \/ InTime("ChangeToStage0", i)
\* ES-SEQ-6, ES-SEQ-9, ES-STAGE-1: out of stage 0, and within the time
Enable(i) == MayEnable(i) /\ SeesStage1(i) /\ To("Stage1", i) /\ Did("Enable")
\* ES-STAGE-1
StayEnabled(i) == On("Stage1", i) /\ SeesStage1(i) /\ Stay(i) /\ Did("StayEnabled")
\* ES-SEQ-7, ES-SEQ-8, ESF-04: out of stage 1 the enable is off at once, out of stage 2 it never was on
BeginReturn(i) ==
    /\ On("Stage1", i) \/ On("Stage2", i)
    /\ SeesNoStage(i)
    /\ To("ChangeToStage0", i)
    /\ Did("BeginReturn")
\* ES-SEQ-3, ES-SEQ-8, ESF-05
AwaitChange(i) ==
    /\ state \in Timed /\ InTime(state, i)
    /\ SeesNoStage(i)
    /\ GoTo(state) /\ RemembersReset(i) /\ TimeGoesOn(i)
    /\ Did("AwaitChange")
\* ES-SEQ-8, ES-STAGE-0
ReachStage0(i) ==
    /\ On("Stage1", i) \/ On("Stage2", i) \/ (state \in Timed /\ InTime(state, i))
    /\ SeesStage0(i)
    /\ To("Stage0", i)
    /\ Did("ReachStage0")
\* ES-SEQ-7, ES-STAGE-2, ESF-03
ReachStage2(i) ==
    /\ On("Stage0", i) \/ On("Stage1", i) \/ (state \in Timed /\ InTime(state, i))
    /\ SeesStage2(i)
    /\ To("Stage2", i)
    /\ Did("ReachStage2")
\* ES-STAGE-2
StayAtStage2(i) == On("Stage2", i) /\ SeesStage2(i) /\ Stay(i) /\ Did("StayAtStage2")
\* ES-ORDER-2, ESF-02: stage 1 that does not come out of stage 0
RefuseStage1(i) == MayNotEnable(i) /\ SeesStage1(i) /\ To("PlausibilityError", i) /\ Did("RefuseStage1")
\* ES-SEQ-3, ESF-04, ESF-07: the channels do not come together in time
FindUnequal(i) ==
    /\ state \in Timed /\ On(state, i) /\ Late(i) /\ ~SeesContradiction(i)
    /\ To("EquivalenceError", i)
    /\ Did("FindUnequal")
\* ESF-05: channel 2 does not follow in time
FindContradiction(i) ==
    /\ state \in Timed /\ On(state, i) /\ Late(i) /\ SeesContradiction(i)
    /\ To("PlausibilityError", i)
    /\ Did("FindContradiction")

----------------------------------------------------------------------------
(* Errors.  Each waits for stage 0, then for the reset.                    *)

\* ES-SEQ-4, ES-STAGE-2: whatever else the channels show, also of a device that is not plugged in
AwaitStage0(i) == Held(Faulty, i) /\ ~SeesCauseGone(i) /\ Stay(i) /\ Did("AwaitStage0")
\* ES-SEQ-4
SeeStage0(i) ==
    /\ Held(Faulty, i) /\ SeesCauseGone(i)
    /\ \E f \in Family : f.cause = state /\ To(f.released, i)
    /\ Did("SeeStage0")
\* ESF-06: stage 0 is lost before the reset
LoseStage0(i) ==
    /\ Held(Released, i) /\ ~SeesCauseGone(i)
    /\ \E f \in Family : f.released = state /\ To(f.cause, i)
    /\ Did("LoseStage0")
LOCAL Waiting(i) == Held(Released, i) /\ SeesCauseGone(i)
\* ES-RESTART, ESF-14: no edge is needed
AutoReset(i) == AUTO_RESET_ERRORS /\ i.S_AutoReset
\* ES-RESTART, ESF-10: where an edge is waited for, a Reset that is held is an error
FindStaticReset(i) ==
    /\ Waiting(i) /\ ResetStatic(i) /\ ~AutoReset(i)
    /\ \E f \in Family : f.released = state /\ To(f.static, i)
    /\ Did("FindStaticReset")
\* ES-SEQ-5, ES-RESTART, ESF-06
Resets(i) == ~AutoReset(i) => ResetRises(i)
\* ES-SEQ-5, ES-RESTART
LeaveError(i) ==
    /\ Waiting(i) /\ ~(ResetStatic(i) /\ ~AutoReset(i)) /\ Resets(i)
    /\ To(IF i.S_SafetyActive THEN "Stage0" ELSE "BasicMode", i)
    /\ Did("LeaveError")
\* ES-SEQ-4
AwaitReset(i) ==
    Waiting(i) /\ ~(ResetStatic(i) /\ ~AutoReset(i)) /\ ~Resets(i) /\ Stay(i) /\ Did("AwaitReset")
\* ESF-10
AwaitResetReleased(i) == Held(ResetErrors, i) /\ i.Reset /\ Stay(i) /\ Did("AwaitResetReleased")
\* ESF-10: back to where the held Reset was found; it resets nothing
SeeResetReleased(i) ==
    /\ Held(ResetErrors, i) /\ ~i.Reset
    /\ \E f \in Family : f.static = state /\ To(f.released, i)
    /\ Did("SeeResetReleased")
\* ESF-08: only where the parameter says so
ModeEndsError(i) ==
    /\ state \in Errors /\ i.Activate /\ ~i.S_SafetyActive /\ MODE_ENDS_ERROR
    /\ To("BasicMode", i)
    /\ Did("ModeEndsError")

\* One call: exactly one of these
BlockCall(i) ==
    \/ StayIdle(i) \/ StartUp(i) \/ Deactivate(i)
    \/ AwaitSafetyActive(i) \/ SeeSafetyActive(i) \/ LoseSafetyActive(i)
    \/ AcceptStage0(i) \/ RefuseStage(i)
    \/ StayAtStage0(i) \/ BeginChange(i) \/ Enable(i) \/ StayEnabled(i) \/ BeginReturn(i) \/ AwaitChange(i)
    \/ ReachStage0(i) \/ ReachStage2(i) \/ StayAtStage2(i) \/ RefuseStage1(i)
    \/ FindUnequal(i) \/ FindContradiction(i)
    \/ AwaitStage0(i) \/ SeeStage0(i) \/ LoseStage0(i) \/ FindStaticReset(i) \/ LeaveError(i) \/ AwaitReset(i)
    \/ AwaitResetReleased(i) \/ SeeResetReleased(i) \/ ModeEndsError(i)
=============================================================================
