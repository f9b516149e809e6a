---------------------------- MODULE EDMAsPrinted ----------------------------
(***************************************************************************)
(* What the document could be taken to say where we decided otherwise, one *)
(* section a reading.  Op_Reading takes the place of Op in the runs that   *)
(* try the reading; what Reset could mean in every block of the family     *)
(* stands in CyclicBlockAsPrinted.                                         *)
(***************************************************************************)
EXTENDS EDM

----------------------------------------------------------------------------
(* The time.                                                               *)

\* EDM-IN-TIME-1, EDMF-06: a stop that comes with the timeout hides it
LateInEnable_StopBeforeTimeout(i) == Expired(i) /\ ~Feedback(i, FALSE) /\ i.S_OutControl

\* EDM-IN-TIME-1, EDMF-08: the feedback is looked at when the time expires, and not again
Expired_CheckedOnce(i) == elapsed < MONITORING_TIME /\ elapsed + i.dt >= MONITORING_TIME

\* EDM-IN-TIME-1, EDMF-08: the time has expired when more than MonitoringTime has passed
Expired_ExpiresAfter(i) == elapsed + i.dt > MONITORING_TIME

\* EDM-IN-TIME-2, EDMF-09: a MonitoringTime of 0 switches the monitoring off
Expired_ZeroTimeIsOff(i) == MONITORING_TIME # 0 /\ elapsed + i.dt >= MONITORING_TIME

\* EDM-IN-TIME-1, EDM-IN-START-3, EDMF-14: the start without inhibit starts no time
LOCAL NotStarted == -1
StartWithoutInhibit_NoTimeWithoutInhibit(i) ==
    /\ NoErrorInInit(i) /\ i.S_StartReset
    /\ GoTo("OutputDisable") /\ stopSeen' = TRUE /\ elapsed' = NotStarted
    /\ Did("StartWithoutInhibit")
Waits_NoTimeWithoutInhibit(i) ==
    /\ GoTo(state)
    /\ elapsed' = IF elapsed = NotStarted THEN NotStarted ELSE Counted(elapsed, i.dt, MONITORING_TIME)
Expired_NoTimeWithoutInhibit(i) == elapsed # NotStarted /\ elapsed + i.dt >= MONITORING_TIME

----------------------------------------------------------------------------
(* The request.                                                            *)

\* EDM-IN-EDM-2, EDMF-05: a request waits for the feedback as long as MonitoringTime lasts
Unfounded_RequestWaits(i) == FALSE

\* EDM-IN-CONTROL-1, EDM-SEQ-3, EDM-SEQ-5, EDMF-04: S_OutControl acts by its edge, also where there is no inhibit
Requested_ControlByEdge(i) == Rises(i.S_OutControl, outControlBefore)

\* EDM-IN-RESET-2, EDM-OUT-REQUEST, EDMF-16: after each stop an edge of Reset is needed
DisableOutput_RestartInhibit(i) ==
    /\ At("OutputEnable", i) /\ ~LateInEnable(i) /\ ~i.S_OutControl
    /\ GoTo("Init") /\ stopSeen' = FALSE /\ elapsed' = 0
    /\ Did("DisableOutput")

\* EDM-IN-EDM-2, EDM-IN-TIME-1, EDMF-06: a request at the timeout is what the error is named after
LateInDisable_RequestBeforeTimeout(i) == Expired(i) /\ ~Feedback(i, TRUE) /\ ~Unfounded(i)

----------------------------------------------------------------------------
(* Reset.                                                                  *)

\* EDM-IN-RESET-1, EDMF-07: an error is reset while a contactor still shows what it must not
Resettable_ResetDespiteFeedback(i) == ResetRises(i)

\* EDM-IN-RESET-1, EDMF-10: Reset that is held is no error
ResetStatic_StaticResetIgnored(i) == FALSE

\* EDM-IN-START-2, EDM-IN-RESET-4, EDMF-11: Reset and S_OutControl may rise together
TogetherInInit_NoInitError(i) == FALSE

\* EDM-IN-START-2, EDM-IN-START-3, EDMF-11: they may not even where Reset is not waited for
TogetherInInit_InitErrorWithoutInhibit(i) == Together(i)

\* EDM-IN-RESET-1, EDM-IN-RESET-4, EDMF-11: nor where Reset is to reset an error; that is as wrong as a Reset
\* that is held
ResetStatic_TwoEdgesInErrors(i) == i.Reset /\ (resetBefore \/ (InEDMError /\ Together(i)))

\* EDM-IN-RESET-1, EDM-IN-START-2, EDMF-10: the block reads Reset only in calls that it begins active, so that one
\* which is held while it is switched on is an edge in the next call
RemembersReset_HeldResetIsAnEdge(i) == resetBefore' = (i.Reset /\ state # "Idle")

----------------------------------------------------------------------------
(* The end of Activate.                                                    *)

\* EDM-IN-ACTIVATE, EDM-OUT-ERROR, EDMF-15: an error about contactors is there again after the activation; below 0
\* elapsed is the number of the one to be shown
LOCAL Kept == IF InEDMError THEN CHOOSE n \in 1..9 : state = EDMErrors[n]
              ELSE IF InResetError THEN CHOOSE n \in 1..9 : state = ResetErrors[n] ELSE 0
Deactivate_ErrorRemembered(i) ==
    /\ state # "Idle" /\ ~i.Activate
    /\ GoTo("Idle") /\ stopSeen' = FALSE /\ elapsed' = -Kept
    /\ Did("Deactivate")
StayIdle_ErrorRemembered(i) ==
    state = "Idle" /\ ~i.Activate /\ UNCHANGED <<state, stopSeen, elapsed>> /\ Did("StayIdle")
Initialize_ErrorRemembered(i) ==
    /\ At("Idle", i)
    /\ GoTo(IF elapsed < 0 THEN EDMErrors[-elapsed] ELSE "Init") /\ stopSeen' = FALSE /\ elapsed' = 0
    /\ Did("Initialize")
=============================================================================
