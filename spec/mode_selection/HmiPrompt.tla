----------------------------- MODULE HmiPrompt ------------------------------
(***************************************************************************)
(* The panel alone, as in HmiOpen: that it shows what it does, and does    *)
(* without delay what the bus and the user ask for.                        *)
(***************************************************************************)
EXTENDS HmiOpen

Level == ModeOf(RE, Scanned.RA)
\* The field of a mode, by the order of the alphabet
FieldOf(m) == TouchSeq[m + 2]

\* EKS-2-14, EKS-2-22, EKS-8-8, EKS-SD-3: an inhibited screen belongs to no level, and a user is asked only
\* for what can be touched
ScreenIsTrue ==
    /\ Screen \in {"inhibited", "select", "confirm", "waiting"}
    /\ (Screen = "inhibited") = (offered = None)
    /\ (Screen = "select") = (Enabled # {})
    /\ (Screen = "confirm") = (Shown # None)

\* EKS-2-14, EKS-2-15: the field of a mode selects that mode
FieldSelectsItsMode ==
    [][SelectMSO = 0 /\ SelectMSO' # 0 =>
        /\ hmiSelection' # None /\ Scanned.touch = FieldOf(hmiSelection')
        /\ SelectMSO' = SE[hmiSelection']]_beat

\* EKS-3-4-HMI, EKS-9-1-HMI, E-55: the screen closes in the scan in which the level is not the one that it was
\* opened with
ClosesAtOnce == [][offered # None /\ Level # offered => Screen' = "inhibited"]_beat

\* EKS-2-14, E-57, E-60: an echo that nobody asked for closes the screen
ClosesOverAnEcho == [][Screen = "select" /\ Scanned.CM # 0 => Screen' = "inhibited"]_beat

\* EKS-2-25, E-15, E-21: a selection that was confirmed or taken back is over in the scan in which the echo is
\* gone, and nothing of it is kept
EndsWithTheEcho ==
    [][(hmiState \in {"AwaitSwitch", "Withdrawn"} /\ Level = offered /\ Scanned.CM = 0) =>
        Screen' = "select" /\ hmiSelection' = None]_beat

\* EKS-GP-3, EKS-2-14, EKS-2-22, EKS-2-23, EKS-9-4-HMI: a scan that changes nothing has seen nothing that it
\* waits for
PanelAnswersAtOnce ==
    [][hmi' = hmi =>
        IF hmiState = "Inhibited" THEN Level = None \/ Scanned.CM # 0
        ELSE /\ Level = offered
             /\ CASE hmiState = "Select" -> Scanned.CM = 0 /\ \A m \in Enabled : Scanned.touch # FieldOf(m)
                  [] hmiState = "AwaitEcho" -> Scanned.CM = 0
                  [] hmiState = "Confirm" ->
                        Scanned.CM = CH[hmiSelection] /\ Scanned.touch \notin {"confirm", "reject"}
                  [] hmiState = "AwaitSwitch" -> Scanned.CM = CH[hmiSelection]
                  [] hmiState = "Withdrawn" -> Scanned.CM # 0]_beat
=============================================================================
