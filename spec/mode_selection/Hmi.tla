-------------------------------- MODULE Hmi ---------------------------------
(***************************************************************************)
(* The touchscreen of the note: insert steps 14, 15, 22 to 25, removal     *)
(* steps 8, 9, 16, and the HMI's rows of Figures 3 and 9.                  *)
(* One step is one scan.  i = [RA, CM, touch]: ReadAuthorization and       *)
(* CheckMSO as they stand on the bus, and the field that the user touched  *)
(* ("" for none).  ActiveMSO, the mode to display, decides nothing (E-25). *)
(* Leaves out: the layout (data of the implementation, checked there).     *)
(***************************************************************************)
EXTENDS Integers, CodeTables, StepName

VARIABLES
    hmiState,      \* the screen and what it waits for
    offered,       \* the authorization level that the screen was opened with
    hmiSelection   \* the mode that was touched

hmi == <<hmiState, offered, hmiSelection>>

Pending == {"AwaitEcho", "Confirm", "AwaitSwitch"}
HmiStates == {"Inhibited", "Select", "Withdrawn"} \cup Pending

Field(m) ==
    CASE m = 0 -> "select:0" [] m = 1 -> "select:1" [] m = 2 -> "select:2" [] m = 3 -> "select:3"
      [] m = 4 -> "select:4"
Touches == {"", "confirm", "reject"} \cup {Field(m) : m \in MSO}

HmiTypeOK ==
    /\ hmiState \in HmiStates
    /\ offered \in MSO \cup {None}
    /\ hmiSelection \in MSO \cup {None}

HmiInit == hmiState = "Inhibited" /\ offered = None /\ hmiSelection = None

----------------------------------------------------------------------------
(* Outputs: the row of the state.                                          *)

\* EKS-2-15, EKS-8-9
SelectMSO == IF hmiState \in Pending THEN SE[hmiSelection] ELSE 0
\* EKS-2-24, EKS-8-16, E-19: made from the echo, which equals the selection in this state
SwitchMSO == IF hmiState = "AwaitSwitch" THEN SW[hmiSelection] ELSE 0
\* EKS-2-14, EKS-8-8, EKS-SD-3
Screen == CASE hmiState = "Inhibited" -> "inhibited" [] hmiState = "Select" -> "select"
            [] hmiState = "Confirm" -> "confirm" [] OTHER -> "waiting"
\* EKS-2-14, EKS-SD-4: only what the key permits
Enabled == IF hmiState = "Select" THEN {m \in MSO : Permitted(offered, m)} ELSE {}
\* EKS-2-22
Shown == IF hmiState = "Confirm" THEN hmiSelection ELSE None
\* EKS-8-8, EKS-8-16, E-25, A-33: the mode that a scan displays as active: what its wire brings
Displays(i) == i.ActiveMSO
\* The outputs by their names
HmiOutputs == [SelectMSO |-> SelectMSO, SwitchMSO |-> SwitchMSO, screen |-> Screen, enabled |-> Enabled,
               shown |-> Shown]

----------------------------------------------------------------------------
LOCAL Level(i) == ModeOf(RE, i.RA)
\* EKS-3-4-HMI, E-46: one of the five words, and nothing else
Authorizes(i) == Level(i) # None
\* EKS-3-1-HMI, EKS-9-1-HMI, EKS-GP-4, E-46, E-55: enabled by the very word that the screen was opened with
Enable(i) == Level(i) = offered
\* EKS-2-22, E-20: the echo of the selection, or of something else
Echoed(i) == i.CM = CH[hmiSelection]
OtherEcho(i) == i.CM # 0 /\ ~Echoed(i)
\* EKS-2-22, EKS-2-23, E-19: the user may answer as long as the echo stands
Answerable(i) == Echoed(i)
LOCAL GoTo(s) == hmiState' = s /\ UNCHANGED <<offered, hmiSelection>>
LOCAL Stay == UNCHANGED hmi
LOCAL Drop(s) == hmiState' = s /\ hmiSelection' = None /\ UNCHANGED offered

\* E-55, E-60: the check before every step; in Select the screen closes also over an echo that came unasked
StaysOpen(i) == Enable(i) /\ (hmiState = "Select" => i.CM = 0)
\* EKS-3-4-HMI, EKS-8-8, EKS-8-9, EKS-8-16, EKS-9-1-HMI, E-55, E-60
InhibitScreen(i) ==
    /\ hmiState # "Inhibited" /\ ~StaysOpen(i)
    /\ hmiState' = "Inhibited" /\ offered' = None /\ hmiSelection' = None
    /\ Did("InhibitScreen")
\* E-46, E-57
Opens(i) == Authorizes(i) /\ i.CM = 0
\* EKS-2-14, EKS-9-4-HMI, EKS-SD-3, E-46, E-57: opened by a code word, and only when the old echo is gone
EnableScreen(i) ==
    /\ hmiState = "Inhibited" /\ Opens(i)
    /\ hmiState' = "Select" /\ offered' = Level(i) /\ UNCHANGED hmiSelection
    /\ Did("EnableScreen")
\* EKS-8-8, EKS-9-1-HMI, EKS-9-2
StayInhibited(i) == hmiState = "Inhibited" /\ ~Opens(i) /\ Stay /\ Did("StayInhibited")

\* EKS-2-14, EKS-2-15, EKS-3-2
TouchSelection(i) ==
    /\ hmiState = "Select" /\ i.CM = 0
    /\ \E m \in Enabled : i.touch = Field(m) /\ hmiSelection' = m
    /\ hmiState' = "AwaitEcho" /\ UNCHANGED offered
    /\ Did("TouchSelection")
\* EKS-2-14, EKS-SD-4: a field that is not enabled does nothing
OfferModes(i) ==
    hmiState = "Select" /\ i.CM = 0 /\ (\A m \in Enabled : i.touch # Field(m)) /\ Stay /\ Did("OfferModes")

\* EKS-2-22
AwaitCheckMSO(i) == hmiState = "AwaitEcho" /\ i.CM = 0 /\ Stay /\ Did("AwaitCheckMSO")
\* EKS-2-22, E-20, E-69: the panel compares by itself, then asks
ShowEcho(i) == hmiState = "AwaitEcho" /\ Echoed(i) /\ GoTo("Confirm") /\ Did("ShowEcho")
\* EKS-2-22, EKS-2-25, E-20, E-21: an echo of something else, or an echo that goes away
AbandonSelection(i) ==
    /\ \/ hmiState \in {"AwaitEcho", "AwaitSwitch"} /\ OtherEcho(i)
       \/ hmiState = "Confirm" /\ ~Answerable(i)
    /\ Drop("Withdrawn")
    /\ Did("AbandonSelection")

\* EKS-2-22, EKS-2-23
AskConfirmation(i) ==
    /\ hmiState = "Confirm" /\ Answerable(i) /\ i.touch \notin {"confirm", "reject"}
    /\ Stay /\ Did("AskConfirmation")
\* EKS-2-23, EKS-2-24, EKS-SD-5, E-69
TouchConfirm(i) ==
    hmiState = "Confirm" /\ Answerable(i) /\ i.touch = "confirm" /\ GoTo("AwaitSwitch") /\ Did("TouchConfirm")
\* E-21: the word of the selection goes back to zero
TakeBack == Drop("Withdrawn")
\* EKS-2-25, E-21, E-53: a negative acknowledgment takes the selection back, but not after the confirmation
TouchReject(i) ==
    hmiState = "Confirm" /\ Answerable(i) /\ i.touch = "reject" /\ TakeBack /\ Did("TouchReject")

\* E-15, E-53
AwaitCleared(i) == hmiState = "AwaitSwitch" /\ Echoed(i) /\ Stay /\ Did("AwaitCleared")
\* E-15: both words go back to zero when the echo does, then the next selection may begin
FinishSelection(i) ==
    /\ hmiState = "AwaitSwitch" \/ hmiState = "Withdrawn"
    /\ i.CM = 0
    /\ Drop("Select")
    /\ Did("FinishSelection")
\* E-15, E-21
AwaitWithdrawn(i) == hmiState = "Withdrawn" /\ i.CM # 0 /\ Stay /\ Did("AwaitWithdrawn")

\* The steps, grouped by the states in which they can fire
HmiStep(i) ==
    CASE hmiState = "Inhibited" -> EnableScreen(i) \/ StayInhibited(i)
      [] hmiState = "Select" -> TouchSelection(i) \/ OfferModes(i)
      [] hmiState = "AwaitEcho" -> AwaitCheckMSO(i) \/ ShowEcho(i) \/ AbandonSelection(i)
      [] hmiState = "Confirm" ->
            AbandonSelection(i) \/ AskConfirmation(i) \/ TouchConfirm(i) \/ TouchReject(i)
      [] hmiState = "AwaitSwitch" -> AwaitCleared(i) \/ FinishSelection(i) \/ AbandonSelection(i)
      [] hmiState = "Withdrawn" -> FinishSelection(i) \/ AwaitWithdrawn(i)

\* EKS-GP-3, EKS-GP-4, EKS-3-2, EKS-9-2: first the check, then one step
HmiScan(i) == IF hmiState = "Inhibited" \/ StaysOpen(i) THEN HmiStep(i) ELSE InhibitScreen(i)

----------------------------------------------------------------------------
(* What the panel promises whatever the bus shows.                         *)

\* EKS-2-14, EKS-SD-4: nothing beyond the level is ever sent
SelectionWithinOffer == hmiSelection # None => Permitted(offered, hmiSelection)
\* EKS-8-8, EKS-8-9, EKS-8-16: an inhibited panel sends zeros
InhibitedSendsZeros == hmiState = "Inhibited" => SelectMSO = 0 /\ SwitchMSO = 0
=============================================================================
