----------------------------- MODULE HmiDemands ------------------------------
(***************************************************************************)
(* What the sentences of the note demand of the panel, read a second time: *)
(* demands.toml says the same for programs.  An observer keeps what stood  *)
(* on the bus, what was touched and what was displayed, and no state of    *)
(* the panel.  It watches one mode, which is any of the five: a demand     *)
(* that speaks of a mode is asked of that one.  What must come has the     *)
(* scans of STEPS; all else is asked in the scan itself.                   *)
(* Leaves out a panel that needs another scan for what it has read.        *)
(***************************************************************************)
EXTENDS HmiOpen

CONSTANT STEPS      \* scans for the three rows of Figure 3 or 9 on the way to what must come (EKS-3-2, EKS-9-2)
ASSUME STEPS \in Nat \ {0}

VARIABLES
    about,          \* the mode that is watched
    level,          \* the level in ReadAuthorization in the scan before
    highest,        \* the highest level since one came
    touched,        \* since then the field of the mode was touched
    sent,           \* the last selection that was sent is that mode
    displayed,      \* the last echo that was displayed is that mode
    confirmed,      \* since the last selection a displayed echo was confirmed
    away,           \* scans for which ReadAuthorization has been zero
    quiet,          \* ... and CheckMSO
    course,         \* how far a good course has come, see Course; None
    stay,           \* scans for which it has been there
    wrong,          \* scans for which another mode than the active one is displayed, ...
    active          \* ... which is this one; None

watched == <<about, level, highest, touched, sent, displayed, confirmed, away, quiet, course, stay, wrong, active>>
DemandsView == <<View, watched>>

\* The modes that are touched, echoed and watched
Asked == {0, 1, 3}
LOCAL Counted(scans) == IF scans > STEPS THEN scans ELSE scans + 1
LOCAL Higher(a, b) == IF a > b THEN a ELSE b

DemandsInit ==
    /\ OpenInit /\ about \in Asked
    /\ level = None /\ highest = None /\ touched = FALSE /\ sent = FALSE /\ displayed = FALSE /\ confirmed = FALSE
    /\ away = 0 /\ quiet = 0 /\ course = None /\ stay = 0 /\ wrong = 0 /\ active = None

Selects == SelectMSO' \notin {0, SelectMSO}
Acknowledges == SwitchMSO' # SwitchMSO /\ ModeOf(SW, SwitchMSO') # None
Displayed == Shown' \notin {None, Shown}

\* 0 no level, no echo, no touch.  1 a level.  2 its field of the mode is touched.  3 its selection was sent.
\* 4 its echo.  5 the echo was displayed, and is confirmed.
Course(i) ==
    LET same == ModeOf(RE, i.RA) = level /\ level # None
        field == i.touch = Field(about)
    IN  CASE quiet' > STEPS /\ i.touch = "" -> 0
          [] i.CM = 0 /\ i.touch = "" /\ course = 0 /\ ModeOf(RE, i.RA) # None -> 1
          [] i.CM = 0 /\ i.touch = "" /\ course = 1 /\ same -> 1
          [] i.CM = 0 /\ field /\ course = 1 /\ same /\ Screen = "select" /\ about \in Enabled -> 2
          [] i.CM = 0 /\ field /\ course = 2 /\ same /\ SelectMSO # SE[about] -> 2
          [] /\ i.CM = 0 /\ (field \/ i.touch = "") /\ same
             /\ course = 3 \/ (course = 2 /\ SelectMSO = SE[about]) -> 3
          [] i.CM = CH[about] /\ i.touch = "" /\ course \in {3, 4} /\ same -> 4
          [] /\ i.CM = CH[about] /\ i.touch = "confirm" /\ same
             /\ course = 5 \/ (course = 4 /\ Shown = about) -> 5
          [] OTHER -> None

Watch(i) ==
    /\ UNCHANGED about
    /\ level' = ModeOf(RE, i.RA)
    /\ highest' = IF level' = None THEN highest ELSE IF level = None THEN level' ELSE Higher(level', highest)
    /\ touched' = ((touched /\ ~(level = None /\ level' # None)) \/ (level' # None /\ i.touch = Field(about)))
    /\ sent' = IF ModeOf(SE, SelectMSO') = None THEN sent ELSE SelectMSO' = SE[about]
    /\ displayed' = IF Shown' = None THEN displayed ELSE Shown' = about
    /\ confirmed' = ((confirmed /\ ~Selects) \/ (i.touch = "confirm" /\ Shown # None))
    /\ away' = IF i.RA = 0 THEN Counted(away) ELSE 0
    /\ quiet' = IF i.RA = 0 /\ i.CM = 0 THEN Counted(quiet) ELSE 0
    /\ course' = Course(i)
    /\ stay' = IF course' = None THEN 0 ELSE IF course' = course THEN Counted(stay) ELSE 1
    /\ active' = IF i.RA = 0 /\ Displays(i) # i.ActiveMSO THEN i.ActiveMSO ELSE None
    /\ wrong' = IF i.RA # 0 \/ Displays(i) = i.ActiveMSO THEN 0
                ELSE IF i.ActiveMSO = active THEN Counted(wrong) ELSE 1

\* Two levels and three modes, and another active mode where nothing else happens
Inputs == {n \in 0..N - 1 :
    LET i == Alphabet[n]
    IN  /\ i.RA \in {0, RE[1], RE[3], OtherWord} /\ i.CM \in {0, OtherWord} \cup {CH[m] : m \in Asked}
        /\ i.touch \in {"", "confirm", "reject"} \cup {Field(m) : m \in Asked}
        /\ i.ActiveMSO = None \/ (i.ActiveMSO = 1 /\ i.RA = 0 /\ i.CM = 0 /\ i.touch = "")}

\* EKS-GP-3: a scan takes at most one step
ScanOrWait(i) == HmiScan(i)
DemandsNext ==
    \E n \in Inputs : \E i \in {Alphabet[n]} : ScanOrWait(i) /\ in' = n /\ beat' = ~beat /\ Watch(i)
DemandsSpec == DemandsInit /\ [][DemandsNext]_<<hmi, watched, step, in, beat>>

----------------------------------------------------------------------------
(* The demands.                                                            *)

Late == stay' > STEPS

\* EKS-2-14, EKS-3-1-HMI, EKS-9-1-HMI, EKS-SD-3, EKS-KS-8
ScreenNeedsAnAuthorization == [][Screen = "inhibited" /\ Screen' # "inhibited" => Scanned.RA # 0]_beat
\* EKS-2-14, EKS-SD-4, EKS-FD-4, EKS-T2-2
FieldsWithinTheLevel == [][\A m \in Enabled' : m <= highest']_beat
\* EKS-2-14, EKS-9-4-HMI, EKS-SD-4, EKS-FD-4, EKS-FD-1, EKS-T2, EKS-T2-2
FieldsOpen ==
    [][course' = 1 /\ Late => Screen' = "select" /\ Enabled' = {m \in MSO : Permitted(level', m)}]_beat
\* EKS-2-15, EKS-FD-1, EKS-KS-10, EKS-T2
SelectionWasTouched ==
    [][Selects => ModeOf(SE, SelectMSO') # None /\ (SelectMSO' = SE[about] => touched')]_beat
\* EKS-2-14, EKS-FD-4, EKS-T2-2
SelectionWithinTheLevel == [][Selects => ModeOf(SE, SelectMSO') <= highest']_beat
\* EKS-3-1-HMI, EKS-GP-4, EKS-SD-7
SelectionWithAnAuthorization == [][Selects => Scanned.RA # 0]_beat
\* EKS-2-14, EKS-2-15, EKS-3-2, EKS-GP-3
SelectionIsSent == [][(course' = 2 /\ Late) \/ course' \in {3, 4} => SelectMSO' = SE[about]]_beat
\* EKS-2-22, EKS-SD-5
DisplayIsTheEcho == [][Displayed => Scanned.CM = CH[Shown']]_beat
\* EKS-2-22, EKS-SD-5, EKS-T2
EchoIsDisplayed == [][course' = 4 /\ Late => Shown' = about /\ Screen' = "confirm"]_beat
\* EKS-2-23, EKS-2-24, EKS-2-25, EKS-SD-5
AcknowledgmentWasConfirmed == [][Acknowledges => confirmed']_beat
\* EKS-2-24, EKS-KS-10, EKS-T2
AcknowledgmentIsTheMode == [][Acknowledges /\ SwitchMSO' = SW[about] => sent' \/ displayed']_beat
\* EKS-2-23, EKS-2-24, EKS-T2
AcknowledgmentIsSent == [][course' = 5 /\ Late => SwitchMSO' = SW[about]]_beat
\* EKS-3-4-HMI, EKS-8-8, EKS-3-0, EKS-9-0, EKS-SD-7, EKS-GP-4, EKS-GP-5
ScreenCloses == [][away' > STEPS => Screen' = "inhibited" /\ Enabled' = {}]_beat
\* EKS-8-9, EKS-9-2
SelectionReturnsToZero == [][away' > STEPS => SelectMSO' = 0]_beat
\* EKS-8-16, EKS-9-2
AcknowledgmentReturnsToZero == [][quiet' > STEPS => SwitchMSO' = 0]_beat
\* EKS-8-8
ActiveModeIsDisplayed == [][wrong' <= STEPS]_beat
=============================================================================
