----------------------------- MODULE FplcDemands -----------------------------
(***************************************************************************)
(* What the sentences of the note demand of the F-PLC, read a second time: *)
(* demands.toml says the same for programs.  An observer keeps what stood  *)
(* on the wires, and no state of the device.  It watches one mode: a       *)
(* demand that speaks of a mode is asked of that one.  What must never be  *)
(* is asked with any inputs in every scan.  What must come is asked in     *)
(* courses: the wires do what the note says, each part stands until the    *)
(* F-PLC must have answered, and any one scan may end the course; then key *)
(* and words are gone until the F-PLC must be ready again.                 *)
(* Leaves out a program that takes a row of a figure in a scan of its own: *)
(* what must come has the STEPS scans of a program that takes a numbered   *)
(* step in each, as all readings here do.  Leaves out other levels, modes  *)
(* and words than those of Tried.                                          *)
(***************************************************************************)
EXTENDS FplcOpen

CONSTANT STEPS      \* scans for what must come, one numbered step in a scan (EKS-3-2, EKS-9-2)
ASSUME STEPS \in Nat \ {0}

VARIABLES
    about,          \* the mode that is watched
    free,           \* any inputs in every scan, or courses; of mode 2 alone
    signalled,      \* the outputs that were set alone in this insertion, since the last test pulse began
    tested,         \* with LA: 0 no test pulse, 1 all outputs were set, 2 then none
    wasSelected,    \* since the level was published the selection of the mode stood in MW03
    wasEchoed,      \* ... an echo was given
    wasAcknowledged, \* ... and then the switchover word of the mode stood in MW07
    crowded,        \* scans for which two to four outputs have stood, from one in which a level was published
    away,           \* scans without LA
    \* of a course
    rest, restTime, \* scans without key and word, and ticks
    course,         \* its part, see Course; None
    stood,          \* what stands in it
    stay,           \* scans for which it has been there
    since,          \* ticks since LA
    late, over,     \* in the test pulse: ticks of this part, scans since they were too many
    came            \* in this part the mode was set, or the error mode

never == <<signalled, tested, wasSelected, wasEchoed, wasAcknowledged, crowded, away>>
ofCourse == <<rest, restTime, course, stood, stay, since, late, over, came>>
watched == <<about, free, never, ofCourse>>
DemandsView == <<View, watched>>

Asked == {2, 3}
Long == T_REM + T_REM + T_REM
LOCAL UpTo(n, limit) == IF n > limit THEN limit ELSE n
LOCAL Counted(scans) == UpTo(scans + 1, STEPS + 1)

DemandsInit ==
    /\ OpenInit /\ about \in Asked /\ free \in {TRUE, about = 3}
    /\ signalled = {} /\ tested = 0 /\ wasSelected = FALSE /\ wasEchoed = FALSE /\ wasAcknowledged = FALSE
    /\ crowded = 0 /\ away = 0
    /\ rest = 0 /\ restTime = 0 /\ course = None /\ stood = <<>> /\ stay = 0 /\ since = 0 /\ late = 0 /\ over = 0
    /\ came = FALSE

Key(i) == i.LA /\ i.vec # {}
\* The level that the reader signals
Level(i) == IF i.LA /\ Cardinality(i.vec) = 1 THEN CHOOSE l \in MSO : i.vec = {l} ELSE None
Zeros(i) == i.MW03 = 0 /\ i.MW07 = 0
Resting(i) == ~i.LA /\ i.vec = {} /\ Zeros(i)
Publishes == MW01' # 0 /\ MW01 = 0
Echoes == MW05' \notin {0, MW05}
Sets == mode' # mode /\ mode' # {}
SelectedNow(i) == wasSelected \/ (MW01 # 0 /\ i.MW03 = SE[about])
AcknowledgedNow(i) == wasAcknowledged \/ ((wasEchoed \/ MW05 # 0) /\ i.MW07 = SW[about])
SignalledNow(i) == (IF i.vec = MSO \/ ~i.LA THEN {} ELSE signalled) \cup ({Level(i)} \ {None})

WatchNever(i) ==
    /\ signalled' = SignalledNow(i)
    /\ tested' = IF ~i.LA THEN 0 ELSE IF i.vec = MSO THEN 1 ELSE IF i.vec = {} /\ tested = 1 THEN 2 ELSE tested
    /\ wasSelected' = (MW01' # 0 /\ SelectedNow(i))
    /\ wasEchoed' = (MW01' # 0 /\ (wasEchoed \/ MW05' # 0))
    /\ wasAcknowledged' = (MW01' # 0 /\ AcknowledgedNow(i))
    /\ crowded' = IF /\ i.LA /\ Cardinality(i.vec) \in 2..4 /\ ~ERROR'
                     /\ MW01 # 0 \/ crowded > 0 THEN UpTo(crowded + 1, 3) ELSE 0
    /\ away' = IF i.LA THEN 0 ELSE Counted(away)

----------------------------------------------------------------------------
(* A course.  0 rest.  1 LA, no output.  2 all outputs.  3 none again.     *)
(* 4 one output.  5 a selection that is permitted.  6 its acknowledgment.  *)
(* 7 another word in MW03 than a permitted selection.  8 after the echo    *)
(* another word in MW07 than its acknowledgment.                           *)

Least == IF T_ON < T_SEQ THEN T_ON ELSE T_SEQ
InTime(i) == since + i.dt < Least
May(i) == Level(i) # None /\ about \in PERMITS[Level(i)]
IsPart(k, i) ==
    CASE k = 1 -> i.LA /\ i.vec = {} /\ Zeros(i)
      [] k = 2 -> i.LA /\ i.vec = MSO /\ Zeros(i)
      [] k = 3 -> i.LA /\ i.vec = {} /\ Zeros(i)
      [] k = 4 -> Level(i) # None /\ Zeros(i) /\ InTime(i)
      [] k = 5 -> May(i) /\ i.MW03 = SE[about] /\ i.MW07 = 0
      [] k = 6 -> May(i) /\ i.MW03 = SE[about] /\ i.MW07 = SW[about]
      [] k = 7 -> /\ Level(i) # None /\ i.MW03 # 0 /\ i.MW07 = 0
                  /\ ModeOf(SE, i.MW03) = None \/ ModeOf(SE, i.MW03) > Level(i)
      [] k = 8 -> May(i) /\ i.MW03 = SE[about] /\ i.MW07 \notin {0, SW[about]}
Follows ==
    CASE course = 0 -> {1, 2} [] course \in 1..3 -> {course + 1} [] course = 4 -> {5, 7} [] course = 5 -> {6, 8}
      [] OTHER -> {}
\* What stands in a part; the level stands from part 4 on
Stands(i) == <<i.LA, i.vec, i.MW03, i.MW07>>
GoesOn(k, i) == (course = 0 \/ stay > STEPS) /\ IsPart(k, i) /\ (course >= 4 => i.vec = stood[2])
Course(i) ==
    IF rest' > STEPS /\ restTime' = Long THEN 0
    ELSE IF course > 0 /\ Stands(i) = stood THEN course
    ELSE IF \E k \in Follows : GoesOn(k, i) THEN CHOOSE k \in Follows : GoesOn(k, i)
    ELSE None

WatchCourse(i) ==
    /\ rest' = IF Resting(i) THEN Counted(rest) ELSE 0
    /\ restTime' = IF Resting(i) /\ rest > 0 THEN UpTo(restTime + i.dt, Long) ELSE 0
    /\ course' = Course(i)
    /\ stood' = IF course' > 0 THEN Stands(i) ELSE <<>>
    /\ stay' = IF course' <= 0 THEN 0 ELSE IF course' = course THEN Counted(stay) ELSE 1
    /\ since' = IF course \in 1..4 /\ course' \in 1..4 THEN UpTo(since + i.dt, Least) ELSE 0
    /\ late' = IF course' \in 1..3 /\ course' = course /\ ~ERROR /\ ~ERROR' THEN UpTo(late + i.dt, T_ON + T_SEQ) ELSE 0
    /\ over' = IF course' \in 1..3 /\ late' >= (IF course' = 1 THEN T_ON ELSE T_SEQ) THEN Counted(over) ELSE 0
    /\ came' = (/\ course' \in 6..8
                /\ (course' = course /\ came) \/ (IF course' = 6 THEN mode' = {about} ELSE ERROR'))

----------------------------------------------------------------------------
(* The inputs that are tried.                                              *)

Tried == {n \in 0..N - 1 : LET i == Alphabet[n] IN
    /\ i.vec \in {{}, {2}, {4}, {2, 4}, MSO} /\ i.dt \in {0, 1}
    /\ i.MW03 \in {0, SE[2], SE[3], OtherWord} /\ i.MW07 \in {0, SW[2], SW[3], OtherWord}
    /\ Level(i) = None => i.MW03 \in {0, SE[2]} /\ i.MW07 \in {0, SW[2]}}
TriedAtOnce == {n \in Tried : Alphabet[n].dt = 0}
TriedAtRest == {n \in Tried : Resting(Alphabet[n])}
\* Time passes only where it is counted
Inputs == IF ~free /\ course = None THEN TriedAtRest ELSE IF fplcState \in Clocked THEN Tried ELSE TriedAtOnce

\* What a scan reads
Read(n) == Alphabet[n]
DemandsNext ==
    \E n \in Inputs : \E i \in {Read(n)} :
        /\ FplcScan(i)
        /\ in' = n /\ beat' = ~beat /\ UNCHANGED <<observer, about, free>>
        /\ WatchNever(i)
        /\ IF free THEN UNCHANGED ofCourse ELSE WatchCourse(i)
DemandsSpec == DemandsInit /\ [][DemandsNext]_<<View, observer, watched, step, in, beat>>

----------------------------------------------------------------------------
(* The demands.                                                            *)

Stood(k) == course' = k /\ stay' > STEPS

\* EKS-SD-6
OneModeAtMost == Cardinality(mode) <= 1
\* EKS-2-12, EKS-2-10, EKS-2-11, EKS-4-5, EKS-FD-3, EKS-T2, EKS-KS-10
LevelIsTheSignalledOne == [][MW01' \notin {0, MW01} => \E l \in SignalledNow(Scanned) : MW01' = RE[l]]_beat
\* EKS-4-1, EKS-4-3, EKS-4-5, EKS-2-10
LevelAfterTheTestPulse == [][Publishes => tested' = 2]_beat
\* EKS-3-1-FPLC, EKS-GP-4
LevelWithAKey == [][Publishes => Key(Scanned)]_beat
\* EKS-2-12, EKS-4-7, EKS-T2, EKS-3-2, EKS-3-3, EKS-9-1-FPLC, EKS-9-4-FPLC
LevelComes == [][Stood(4) => MW01' = RE[Level(Scanned)]]_beat
\* EKS-2-19, EKS-2-20, EKS-6-1, EKS-6-2, EKS-6-3, EKS-6-4, EKS-6-5, EKS-6-6, EKS-6-7, EKS-6-8, EKS-6-9, EKS-6-10,
\* EKS-T2, EKS-T2-4, EKS-SD-14
EchoIsASelection ==
    [][Echoes => ModeOf(CH, MW05') # None /\ (MW05' = CH[about] => SelectedNow(Scanned))]_beat
\* EKS-2-18, EKS-2-20, EKS-5-2, EKS-5-4, EKS-5-6, EKS-5-8, EKS-5-10, EKS-T2-2, EKS-FD-4
EchoWithinTheLevel == [][Echoes => ModeOf(CH, MW05') <= ModeOf(RE, IF MW01 # 0 THEN MW01 ELSE MW01')]_beat
\* EKS-3-1-FPLC, EKS-GP-4
EchoWithAKey == [][Echoes => Key(Scanned)]_beat
\* EKS-2-17, EKS-2-18, EKS-2-20, EKS-5-1, EKS-5-3, EKS-5-5, EKS-5-7, EKS-5-9, EKS-6-11, EKS-T2, EKS-SD-5
EchoComes == [][Stood(5) => MW05' = CH[about]]_beat
\* EKS-2-28, EKS-7-2, EKS-7-4, EKS-7-6, EKS-7-8, EKS-7-10, EKS-7-12, EKS-FD-2, EKS-BD-5
ModeWasSelected == [][Sets /\ about \in mode' => SelectedNow(Scanned)]_beat
\* EKS-2-27, EKS-2-28, EKS-2-29, EKS-7-1, EKS-7-3, EKS-7-5, EKS-7-7, EKS-7-9, EKS-SD-5, EKS-SD-14, EKS-T2-4
ModeWasAcknowledged == [][Sets /\ about \in mode' => AcknowledgedNow(Scanned)]_beat
\* EKS-SD-2, EKS-3-1-FPLC, EKS-GP-4
ModeWithAKey == [][Sets => Key(Scanned)]_beat
\* EKS-2-28, EKS-2-29, EKS-7-11, EKS-T2, EKS-BD-5, EKS-GP-3
ModeComes == [][Stood(6) => came']_beat
\* EKS-SD-7, EKS-2-29
ModeStays == [][mode # {} => mode' # {} \/ ERROR']_beat
\* EKS-3-1-FPLC, EKS-3-4-FPLC, EKS-8-6, EKS-KS-8, EKS-GP-4, EKS-GP-5
RemovalClearsTheLevel == [][away' > STEPS => MW01' = 0]_beat
\* EKS-KS-6, EKS-2-11
TwoOutputsAreAFault == [][crowded' <= 2]_beat
\* EKS-2-6, EKS-2-8, EKS-4-2, EKS-4-4, EKS-4-6, EKS-4-8
PulseInTime == [][over' <= STEPS]_beat
\* EKS-2-19, EKS-6-9, EKS-6-12, EKS-SD-14, EKS-T2-4
NoCodeIsAFault == [][Stood(7) /\ ModeOf(SE, Scanned.MW03) = None => came']_beat
\* EKS-2-18, EKS-5-10
AboveTheLevelIsAFault == [][Stood(7) /\ ModeOf(SE, Scanned.MW03) # None => came']_beat
\* EKS-2-27, EKS-7-12, EKS-SD-14, EKS-T2-4
NoAcknowledgmentWordIsAFault == [][Stood(8) /\ ModeOf(SW, Scanned.MW07) = None => came']_beat
\* EKS-2-28, EKS-7-12, EKS-SD-16
AnotherAcknowledgmentIsAFault == [][Stood(8) /\ ModeOf(SW, Scanned.MW07) # None => came']_beat
\* EKS-4-7, EKS-5-9, EKS-6-11, EKS-7-11, EKS-3-0, EKS-9-0
NoErrorInAGoodCourse ==
    [][(course' \in 1..4 /\ InTime(Scanned)) \/ course' = 5 \/ (course' = 6 /\ ~came') => ~ERROR']_beat
=============================================================================
