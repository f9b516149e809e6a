---------------------------- MODULE HmiAsPrinted ----------------------------
(***************************************************************************)
(* What the note could be taken to say of the panel, and what we did not   *)
(* decide.  Op_Reading takes the place of Op of Hmi where a run tries that *)
(* reading.                                                                *)
(***************************************************************************)
EXTENDS Hmi

LOCAL Level(i) == ModeOf(RE, i.RA)
\* What is on the bus is shown, and what is shown is what is asked for
LOCAL Other(i) == ModeOf(CH, i.CM) # None
LOCAL ShowOther(i) ==
    hmiState' = "Confirm" /\ hmiSelection' = ModeOf(CH, i.CM) /\ UNCHANGED offered /\ Did("ShowOtherEcho")
LOCAL Goes(s) == hmiState' = s /\ UNCHANGED <<offered, hmiSelection>>
\* A refusal that leaves the selection on the bus
LOCAL Refused == hmiState = "Withdrawn" /\ hmiSelection # None
LOCAL SelectMSOStays == IF hmiState \in Pending \/ Refused THEN SE[hmiSelection] ELSE 0

----------------------------------------------------------------------------
(* AcknowledgesOwnSelection                                                *)
\* EKS-2-23, EKS-2-24, E-19: the panel acknowledges from its own memory, whatever CheckMSO shows by then.
Answerable_AcknowledgesOwnSelection(i) == TRUE

----------------------------------------------------------------------------
(* PanelComparesAlone                                                      *)
\* EKS-2-22, E-20: the panel compares by itself, and nobody is asked.
ShowEcho_PanelComparesAlone(i) ==
    hmiState = "AwaitEcho" /\ Echoed(i) /\ Goes("AwaitSwitch") /\ Did("ShowEcho")

----------------------------------------------------------------------------
(* UserComparesAlone                                                       *)
\* EKS-2-22, E-20: the panel compares nothing: any echo is shown, and the user compares.
ShowEcho_UserComparesAlone(i) ==
    /\ hmiState = "AwaitEcho"
    /\ IF Echoed(i) THEN Goes("Confirm") /\ Did("ShowEcho") ELSE Other(i) /\ ShowOther(i)
OtherEcho_UserComparesAlone(i) == i.CM # 0 /\ ~Echoed(i) /\ (hmiState = "AwaitEcho" => ~Other(i))

----------------------------------------------------------------------------
(* RejectIsSilent                                                          *)
\* EKS-2-25, E-21: a negative acknowledgment sends nothing at all, and the selection stays on the bus.
TakeBack_RejectIsSilent == Goes("Withdrawn")
SelectMSO_RejectIsSilent == SelectMSOStays

----------------------------------------------------------------------------
(* RejectIsAWord                                                           *)
\* EKS-2-25, E-21: a negative acknowledgment is a word outside the range of SwitchMSO.
TakeBack_RejectIsAWord == Goes("Withdrawn")
SelectMSO_RejectIsAWord == SelectMSOStays
SwitchMSO_RejectIsAWord ==
    IF hmiState = "AwaitSwitch" THEN SW[hmiSelection] ELSE IF Refused THEN OtherWord ELSE 0

----------------------------------------------------------------------------
(* EnabledByAnyWord                                                        *)
\* EKS-3-4-HMI, EKS-9-4-HMI, E-46: any word but zero enables the screen, not only the five of Table 1.
Authorizes_EnabledByAnyWord(i) == i.RA # 0
Enable_EnabledByAnyWord(i) == i.RA # 0 /\ Level(i) \in {None, offered}

----------------------------------------------------------------------------
(* StaysOpenAtNewLevel                                                     *)
\* EKS-3-1-HMI, E-55: the screen stays open when the level becomes another one.
Enable_StaysOpenAtNewLevel(i) == Level(i) # None

----------------------------------------------------------------------------
(* EnableAsPrinted                                                         *)
\* E-77: EnabledByAnyWord and StaysOpenAtNewLevel at once.
Authorizes_EnableAsPrinted(i) == i.RA # 0
Enable_EnableAsPrinted(i) == i.RA # 0

----------------------------------------------------------------------------
(* WithdrawsAfterConfirm                                                   *)
\* EKS-2-25, E-53: the panel goes on offering the withdrawal after the confirmation.
AwaitCleared_WithdrawsAfterConfirm(i) ==
    /\ hmiState = "AwaitSwitch" /\ Echoed(i)
    /\ IF i.touch = "reject" THEN TakeBack /\ Did("TouchReject") ELSE UNCHANGED hmi /\ Did("AwaitCleared")

----------------------------------------------------------------------------
(* OpensOverEcho                                                           *)
\* EKS-2-14, E-57: the screen opens whatever stands in CheckMSO.
Opens_OpensOverEcho(i) == Authorizes(i)

----------------------------------------------------------------------------
(* ShowsAnyEcho                                                            *)
\* EKS-2-22, E-60: an echo that nobody asked for is shown, and asked for.
StaysOpen_ShowsAnyEcho(i) == Enable(i) /\ (hmiState = "Select" => i.CM = 0 \/ Other(i))
OfferModes_ShowsAnyEcho(i) ==
    /\ hmiState = "Select"
    /\ IF Other(i) THEN ShowOther(i)
       ELSE i.CM = 0 /\ (\A m \in Enabled : i.touch # Field(m)) /\ UNCHANGED hmi /\ Did("OfferModes")

----------------------------------------------------------------------------
(* TouchBeforeEchoCounts                                                   *)
\* EKS-2-23, E-69: a confirmation counts that is touched in the scan that reads the echo.
ShowEcho_TouchBeforeEchoCounts(i) ==
    /\ hmiState = "AwaitEcho" /\ Echoed(i)
    /\ Goes(IF i.touch = "confirm" THEN "AwaitSwitch" ELSE "Confirm")
    /\ Did("ShowEcho")
=============================================================================
