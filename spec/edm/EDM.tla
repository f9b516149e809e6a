-------------------------------- MODULE EDM ---------------------------------
(***************************************************************************)
(* External device monitoring, V2.0: S_OutControl switches the contactors  *)
(* at S_EDM_Out, and their two feedback contacts are watched: both TRUE    *)
(* while they are dropped out, both FALSE while they are picked up, with   *)
(* MonitoringTime to change over.                                          *)
(* One step is one call; i is the record of its inputs, i.dt the ticks     *)
(* since the call before.  The transitions of a state stand in the order   *)
(* of their priority, and each negates those before it.                    *)
(* The document has the inputs, the outputs and a sequence of signals; the *)
(* states and their DiagCodes are ours, after the family's (EDMF-01).      *)
(* Leaves out: what a time is made of (ticks), and the contactors.         *)
(***************************************************************************)
EXTENDS CyclicBlock

CONSTANTS
    MONITORING_TIME,    \* ticks that the contactors may take to change over
    AFTER_RESET         \* when S_OutControl counts after a reset by hand: "at_once", or "stop_first": once it
                        \* was FALSE

VARIABLES
    outControlBefore,   \* S_OutControl as the call before read it
    stopSeen,           \* in OutputDisable: S_OutControl counts; elsewhere FALSE
    elapsed             \* ticks in OutputDisable or OutputEnable, up to MONITORING_TIME; elsewhere 0

edm == <<state, resetBefore, outControlBefore, stopSeen, elapsed>>

ASSUME MONITORING_TIME \in Nat /\ AFTER_RESET \in {"stop_first", "at_once"}

EDMErrors == <<"EDMError11", "EDMError12", "EDMError13", "EDMError21", "EDMError22", "EDMError23",
               "EDMError31", "EDMError32", "EDMError33">>
ResetErrors == <<"ResetError11", "ResetError12", "ResetError13", "ResetError21", "ResetError22",
                 "ResetError23", "ResetError31", "ResetError32", "ResetError33">>
InEDMError == \E n \in 1..9 : state = EDMErrors[n]
InResetError == \E n \in 1..9 : state = ResetErrors[n]
\* Clocked: the states in which the contactors have MonitoringTime
Clocked == {"OutputDisable", "OutputEnable"}
EDMStates == {"Idle", "Init", "ResetError1", "InitError"} \cup Clocked
    \cup {EDMErrors[n] : n \in 1..9} \cup {ResetErrors[n] : n \in 1..9}

EDMTypeOK ==
    /\ state \in EDMStates
    /\ {resetBefore, outControlBefore, stopSeen} \subseteq BOOLEAN
    /\ elapsed \in 0..MONITORING_TIME
    /\ state \notin Clocked => elapsed = 0
    /\ stopSeen => state = "OutputDisable"

\* EDM-OUT-READY-1, EDM-SEQ-0: at power-up
EDMInit ==
    /\ state = "Idle" /\ resetBefore = FALSE /\ outControlBefore = FALSE
    /\ stopSeen = FALSE /\ elapsed = 0

----------------------------------------------------------------------------
(* Outputs: the row of the state.                                          *)

\* EDM-OUT-READY-1, EDM-OUT-READY-2
Ready == state # "Idle"
\* EDM-OUT-EDM-1, EDM-OUT-EDM-2
S_EDM_Out == state = "OutputEnable"
\* EDM-OUT-DEMAND, EDMF-03, EDMF-04: the output is off, and neither an inhibit nor an error is the reason;
\* with a request that was there before a reset by hand it shows too, though nobody asks for the stop
SafetyDemand == state = "OutputDisable"
\* EDM-OUT-REQUEST, EDMF-02: exactly where an edge of Reset is waited for
ResetRequest == state = "Init" \/ InEDMError
\* EDM-OUT-ERROR
Error == state \in {"ResetError1", "InitError"} \/ InEDMError \/ InResetError
\* EDM-OUT-DIAG, EDMF-01: the code that properties name; its last digit tells nothing
InitErrorCode == \hC100
\* EDM-OUT-DIAG, EDMF-01: the document names the output and not its values
DiagCode ==
    CASE state = "Idle" -> 0 [] state = "Init" -> \h8401
      [] state = "OutputDisable" -> \h8810 [] state = "OutputEnable" -> \h8000
      [] state = "ResetError1" -> \hC001 [] state = "InitError" -> InitErrorCode
      [] state = "EDMError11" -> \hC010  [] state = "ResetError11" -> \hC011
      [] state = "EDMError12" -> \hC020  [] state = "ResetError12" -> \hC021
      [] state = "EDMError13" -> \hC030  [] state = "ResetError13" -> \hC031
      [] state = "EDMError21" -> \hC040  [] state = "ResetError21" -> \hC041
      [] state = "EDMError22" -> \hC050  [] state = "ResetError22" -> \hC051
      [] state = "EDMError23" -> \hC060  [] state = "ResetError23" -> \hC061
      [] state = "EDMError31" -> \hC070  [] state = "ResetError31" -> \hC071
      [] state = "EDMError32" -> \hC080  [] state = "ResetError32" -> \hC081
      [] state = "EDMError33" -> \hC090  [] state = "ResetError33" -> \hC091
\* The outputs by their names
EDMOutputs ==
    [Ready |-> Ready, S_EDM_Out |-> S_EDM_Out, SafetyDemand |-> SafetyDemand,
     ResetRequest |-> ResetRequest, Error |-> Error, DiagCode |-> DiagCode]

----------------------------------------------------------------------------
(* What a call sees.                                                       *)

\* EDM-IN-TIME-1, EDM-IN-TIME-2, EDMF-08, EDMF-09: the contactors have had their time; from there on their
\* feedback counts in every call
Expired(i) == elapsed + i.dt >= MONITORING_TIME
\* EDM-IN-EDM-1: TRUE is dropped out, FALSE is picked up
Feedback(i, dropped) == i.S_EDM1 = dropped /\ i.S_EDM2 = dropped
\* EDMF-01: which of the two is wrong
LOCAL Blamed(i, dropped, first, second, both) ==
    IF i.S_EDM2 = dropped THEN first ELSE IF i.S_EDM1 = dropped THEN second ELSE both

\* EDM-IN-CONTROL-1, EDM-IN-CONTROL-3, EDMF-04: the level counts, but not one that stood there at the Reset
Requested(i) == i.S_OutControl /\ stopSeen
\* EDM-IN-EDM-2, EDMF-05: a request finds a contactor that is not dropped out
Unfounded(i) == Requested(i) /\ ~Feedback(i, TRUE)
\* EDM-IN-TIME-1, EDMF-08: a contactor did not drop out in time
LateInDisable(i) == Expired(i) /\ ~Feedback(i, TRUE)
\* EDM-IN-TIME-1, EDMF-06: a contactor that did not follow is an error also in the call that asks for the stop
LateInEnable(i) == Expired(i) /\ ~Feedback(i, FALSE)

\* EDMF-11: one action would remove the inhibit and ask for the output
Together(i) == ResetRises(i) /\ Rises(i.S_OutControl, outControlBefore)
TogetherInInit(i) == Together(i) /\ ~i.S_StartReset
\* EDM-IN-RESET-1, EDMF-07: the edge resets an error once its cause is gone
Resettable(i) == ResetRises(i) /\ Feedback(i, TRUE)

----------------------------------------------------------------------------
(* What a call leaves.                                                     *)

LOCAL Number(s, names) == CHOOSE n \in 1..9 : names[n] = s
\* Every call remembers the two inputs whose edges count
LOCAL Remembers(i) == RemembersReset(i) /\ outControlBefore' = i.S_OutControl
LOCAL To(s) == GoTo(s) /\ stopSeen' = FALSE /\ elapsed' = 0
LOCAL Stay == UNCHANGED <<state, stopSeen, elapsed>>
Waits(i) == GoTo(state) /\ elapsed' = Counted(elapsed, i.dt, MONITORING_TIME)
\* EDM-IN-RESET-4, EDMF-04: after a reset by hand a request that stands there does not count
CountsAfterReset(i) == ~i.S_OutControl \/ AFTER_RESET = "at_once"
\* The timer starts with 0 in the call that enters
LOCAL Disable(counts) == GoTo("OutputDisable") /\ stopSeen' = counts /\ elapsed' = 0

----------------------------------------------------------------------------
(* Idle.                                                                   *)

\* EDM-IN-ACTIVATE, EDM-OUT-READY-1, EDM-OUT-EDM-1, EDM-SEQ-0: before all else, from every state
Deactivate(i) == state # "Idle" /\ ~i.Activate /\ To("Idle") /\ Did("Deactivate")
\* EDM-IN-ACTIVATE, EDM-OUT-READY-1, EDM-SEQ-0
StayIdle(i) == state = "Idle" /\ ~i.Activate /\ Stay /\ Did("StayIdle")
\* EDM-IN-ACTIVATE, EDM-OUT-READY-2, EDM-IN-START-1, EDM-SEQ-1
Initialize(i) == At("Idle", i) /\ To("Init") /\ Did("Initialize")

----------------------------------------------------------------------------
(* Init: the start-up inhibit.                                             *)

\* EDMF-10: found only where Reset is waited for
LOCAL StaticInInit(i) == ResetStatic(i) /\ ~i.S_StartReset
\* EDM-IN-RESET-1, EDM-IN-START-2, EDMF-10: Reset is held or stuck while the inhibit waits for its edge
FindStaticReset(i) == At("Init", i) /\ StaticInInit(i) /\ To("ResetError1") /\ Did("FindStaticReset")
\* EDM-IN-START-2, EDM-IN-RESET-4, EDMF-11
FindTwoEdges(i) ==
    At("Init", i) /\ ~StaticInInit(i) /\ TogetherInInit(i) /\ To("InitError") /\ Did("FindTwoEdges")
NoErrorInInit(i) == At("Init", i) /\ ~StaticInInit(i) /\ ~TogetherInInit(i)
\* EDM-IN-START-1, EDM-IN-START-3, EDMF-14: no inhibit; S_OutControl counts as it stands, and the time starts
StartWithoutInhibit(i) ==
    NoErrorInInit(i) /\ i.S_StartReset /\ Disable(TRUE) /\ Did("StartWithoutInhibit")
\* EDM-IN-START-2, EDM-IN-RESET-2, EDM-IN-RESET-3, EDM-IN-TIME-1, EDM-SEQ-2, EDMF-04
RemoveInhibit(i) ==
    /\ NoErrorInInit(i) /\ ~i.S_StartReset /\ ResetRises(i)
    /\ Disable(CountsAfterReset(i))
    /\ Did("RemoveInhibit")
\* EDM-IN-START-1, EDM-IN-START-2, EDM-SEQ-1
AwaitReset(i) == NoErrorInInit(i) /\ ~i.S_StartReset /\ ~ResetRises(i) /\ Stay /\ Did("AwaitReset")

LOCAL InStartError(i) == i.Activate /\ state \in {"ResetError1", "InitError"}
\* EDM-IN-RESET-1, EDMF-10, EDMF-11: nothing is reset by letting go; a fresh edge is needed
ReturnToInit(i) == InStartError(i) /\ ~i.Reset /\ To("Init") /\ Did("ReturnToInit")
\* EDM-IN-RESET-1, EDMF-10, EDMF-11
AwaitRelease(i) == InStartError(i) /\ i.Reset /\ Stay /\ Did("AwaitRelease")

----------------------------------------------------------------------------
(* OutputDisable: the contactors drop out, and stay so.                    *)

\* EDM-IN-TIME-1, EDM-OUT-EDM-1, EDM-SEQ-4, EDMF-08
MissDropOut(i) ==
    /\ At("OutputDisable", i) /\ LateInDisable(i)
    /\ To(Blamed(i, TRUE, "EDMError21", "EDMError22", "EDMError23"))
    /\ Did("MissDropOut")
\* EDM-IN-EDM-2, EDM-OUT-EDM-1, EDMF-05
RefuseRequest(i) ==
    /\ At("OutputDisable", i) /\ ~LateInDisable(i) /\ Unfounded(i)
    /\ To(Blamed(i, TRUE, "EDMError11", "EDMError12", "EDMError13"))
    /\ Did("RefuseRequest")
LOCAL NoErrorInDisable(i) == At("OutputDisable", i) /\ ~LateInDisable(i) /\ ~Unfounded(i)
LOCAL Granted(i) == Requested(i) /\ Feedback(i, TRUE)
\* EDM-IN-CONTROL-3, EDM-IN-EDM-2, EDM-OUT-EDM-2, EDM-SEQ-3, EDM-SEQ-5
EnableOutput(i) == NoErrorInDisable(i) /\ Granted(i) /\ To("OutputEnable") /\ Did("EnableOutput")
\* EDM-IN-CONTROL-2, EDM-IN-TIME-1, EDM-SEQ-2, EDM-SEQ-4, EDM-SEQ-6, EDMF-04: the time expires without result
\* where the feedback is right
StayDisabled(i) ==
    /\ NoErrorInDisable(i) /\ ~Granted(i)
    /\ Waits(i) /\ stopSeen' = (stopSeen \/ ~i.S_OutControl)
    /\ Did("StayDisabled")

----------------------------------------------------------------------------
(* OutputEnable: the contactors pick up, and stay so.                      *)

\* EDM-IN-TIME-1, EDM-OUT-EDM-1, EDM-SEQ-5, EDMF-06, EDMF-08
MissPickUp(i) ==
    /\ At("OutputEnable", i) /\ LateInEnable(i)
    /\ To(Blamed(i, FALSE, "EDMError31", "EDMError32", "EDMError33"))
    /\ Did("MissPickUp")
\* EDM-IN-CONTROL-2, EDM-OUT-EDM-1, EDM-SEQ-4
DisableOutput(i) ==
    At("OutputEnable", i) /\ ~LateInEnable(i) /\ ~i.S_OutControl /\ Disable(TRUE) /\ Did("DisableOutput")
\* EDM-IN-CONTROL-3, EDM-OUT-EDM-2, EDM-IN-TIME-1, EDM-SEQ-3
StayEnabled(i) ==
    /\ At("OutputEnable", i) /\ ~LateInEnable(i) /\ i.S_OutControl
    /\ Waits(i) /\ UNCHANGED stopSeen
    /\ Did("StayEnabled")

----------------------------------------------------------------------------
(* The nine errors, and a Reset that is held in each.                      *)

LOCAL InError(i) == i.Activate /\ InEDMError
\* EDM-IN-RESET-1, EDMF-10
FindStaticResetInError(i) ==
    /\ InError(i) /\ ResetStatic(i)
    /\ To(ResetErrors[Number(state, EDMErrors)])
    /\ Did("FindStaticResetInError")
LOCAL NoResetError(i) == InError(i) /\ ~ResetStatic(i)
\* EDM-IN-RESET-1, EDM-IN-RESET-3, EDM-IN-RESET-4, EDM-IN-TIME-1, EDM-SEQ-6, EDMF-04, EDMF-07
ResetError(i) ==
    /\ NoResetError(i) /\ Resettable(i)
    /\ Disable(CountsAfterReset(i))
    /\ Did("ResetError")
\* EDM-OUT-ERROR, EDM-OUT-EDM-1, EDM-IN-RESET-1, EDM-SEQ-5, EDMF-07
StayInError(i) == NoResetError(i) /\ ~Resettable(i) /\ Stay /\ Did("StayInError")

\* EDM-IN-RESET-1, EDMF-10
ReturnToError(i) ==
    /\ i.Activate /\ InResetError /\ ~i.Reset
    /\ To(EDMErrors[Number(state, ResetErrors)])
    /\ Did("ReturnToError")
\* EDM-IN-RESET-1, EDMF-10
AwaitReleaseInError(i) == i.Activate /\ InResetError /\ i.Reset /\ Stay /\ Did("AwaitReleaseInError")

----------------------------------------------------------------------------
\* EDM-INST-1: one call, by the state that the call before left
EDMCall(i) ==
    /\ Remembers(i)
    /\ \/ Deactivate(i)
       \/ state = "Idle" /\ (StayIdle(i) \/ Initialize(i))
       \/ /\ state = "Init"
          /\ \/ FindStaticReset(i) \/ FindTwoEdges(i)
             \/ StartWithoutInhibit(i) \/ RemoveInhibit(i) \/ AwaitReset(i)
       \/ state \in {"ResetError1", "InitError"} /\ (ReturnToInit(i) \/ AwaitRelease(i))
       \/ /\ state = "OutputDisable"
          /\ MissDropOut(i) \/ RefuseRequest(i) \/ EnableOutput(i) \/ StayDisabled(i)
       \/ state = "OutputEnable" /\ (MissPickUp(i) \/ DisableOutput(i) \/ StayEnabled(i))
       \/ InEDMError /\ (FindStaticResetInError(i) \/ ResetError(i) \/ StayInError(i))
       \/ InResetError /\ (ReturnToError(i) \/ AwaitReleaseInError(i))

----------------------------------------------------------------------------
(* What the block promises in every state.                                 *)

\* EDM-OUT-READY-1, EDM-OUT-EDM-1: no output while inactive, in error, or with the inhibit pending
OutputNeedsAll == S_EDM_Out => Ready /\ ~Error /\ ~ResetRequest /\ ~SafetyDemand
\* EDM-OUT-READY-1: an inactive block shows nothing
IdleShowsNothing == ~Ready => ~S_EDM_Out /\ ~SafetyDemand /\ ~ResetRequest /\ ~Error /\ DiagCode = 0
\* EDM-OUT-DIAG, EDM-OUT-ERROR, EDM-OUT-DEMAND, EDMF-01, EDMF-02: bits of the code say what the outputs say;
\* the errors' codes lack the bit of ResetRequest
CodeTellsTheRow ==
    /\ Ready = (DiagCode >= \h8000)
    /\ Error = (DiagCode >= \hC000)
    /\ SafetyDemand = ((DiagCode \div \h0800) % 2 = 1)
    /\ S_EDM_Out = (DiagCode = \h8000)
    /\ ~Error => ResetRequest = ((DiagCode \div \h0400) % 2 = 1)
    /\ Error => ResetRequest = (DiagCode % 16 = 0 /\ DiagCode # InitErrorCode)
=============================================================================
