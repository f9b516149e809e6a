----------------------------- MODULE PlcDemands ------------------------------
(***************************************************************************)
(* What the sentences of the note demand of the PLC, read a second time:   *)
(* demands.toml says the same for programs.  An observer keeps what stood  *)
(* on the wires, and no state of the device.  What must come has the scans *)
(* of STEPS; a word is copied in the scan that reads it.                   *)
(* A reading may leave a scan without a step: such a scan changes nothing, *)
(* and counts like any other.                                              *)
(* Leaves out the order of the copies, and the check before each of them:  *)
(* the wires show neither.                                                 *)
(***************************************************************************)
EXTENDS PlcOpen

CONSTANT STEPS      \* scans for the way through the other routine (EKS-3-2, EKS-9-2)
ASSUME STEPS \in Nat \ {0}

VARIABLES
    lastLevel,      \* MW01 in the scan before
    rest,           \* scans for which every word that comes in has been zero, up to STEPS + 1
    course,         \* how far a good course has come: 0 rest, 1 level, 2 selection, 3 echo, 4 acknowledgment; None
    given,          \* in a good course: the words of its parts
    late            \* of each part that must be sent on: scans for which it has not been

watched == <<lastLevel, rest, course, given, late>>
DemandsView == <<View, watched>>

Parts == 1..4
Nothing == [p \in Parts |-> 0]
Counted(scans) == IF scans > STEPS THEN scans ELSE scans + 1

DemandsInit ==
    OpenInit /\ lastLevel = 0 /\ rest = 0 /\ course = None /\ given = Nothing /\ late = Nothing

\* The parts of a course as they come in, and as they are sent on
Comes(i) == <<i.MW01, i.SelectMSO, i.MW05, i.SwitchMSO>>
Sent == <<ReadAuthorization, MW03, CheckMSO, MW07>>
SentNow == <<ReadAuthorization', MW03', CheckMSO', MW07'>>
\* EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26: so many parts are there, one after the other; None where one is missing
Stage(words) ==
    IF \E k \in 0..4 : \A p \in Parts : (words[p] # 0) = (p <= k)
    THEN CHOOSE k \in 0..4 : \A p \in Parts : (words[p] # 0) = (p <= k) ELSE None
\* A part comes when the one before was sent on, and none that came changes
GoesOn(words, k) ==
    /\ course \in {k - 1, k}
    /\ \A p \in Parts : p <= course => words[p] = given[p]
    /\ course = k - 1 /\ course > 0 => Sent[course] = given[course]
Course(words) ==
    LET k == Stage(words)
    IN  IF rest' > STEPS THEN 0 ELSE IF k # None /\ k > 0 /\ GoesOn(words, k) THEN k ELSE None

Watch(i) ==
    \E words \in {Comes(i)} :
        /\ lastLevel' = i.MW01
        /\ rest' = IF words # Nothing THEN 0 ELSE Counted(rest)
        /\ course' = Course(words)
        /\ given' = IF course' \in Parts THEN words ELSE Nothing
        /\ late' = [p \in Parts |->
            IF SentNow[p] = words[p] \/ (p > 1 /\ course' # p) THEN 0
            ELSE IF p = 1 /\ words[p] # lastLevel THEN 1
            ELSE Counted(late[p])]

\* EKS-GP-3: a scan takes at most one step
ScanOrWait(i) == PlcScan(i) \/ (~ENABLED PlcScan(i) /\ UNCHANGED plc /\ Did("NoStep"))
Inputs == 0..N - 1
\* For a run that leaves the removal out
WithKey == {n \in 0..N - 1 : Alphabet[n].MW01 # 0}
DemandsNext ==
    \E n \in Inputs : \E i \in {Alphabet[n]} : ScanOrWait(i) /\ in' = n /\ beat' = ~beat /\ Watch(i)
DemandsSpec == DemandsInit /\ [][DemandsNext]_<<plc, watched, step, in, beat>>

----------------------------------------------------------------------------
(* The demands.                                                            *)

Stays(p) == SentNow[p] \in {Sent[p], Comes(Scanned)[p]}
HasCome(p) == late'[p] <= STEPS

\* EKS-2-13, EKS-8-7, EKS-GP-2, EKS-KS-10
LevelIsSentUnchanged == [][Stays(1)]_beat
\* EKS-2-16, EKS-8-10, EKS-GP-2, EKS-KS-10
SelectionIsCopied == [][Stays(2)]_beat
\* EKS-2-21, EKS-8-15, EKS-GP-2, EKS-KS-10
EchoIsSentUnchanged == [][Stays(3)]_beat
\* EKS-2-26, EKS-8-17, EKS-GP-2, EKS-KS-10
AcknowledgmentIsCopied == [][Stays(4)]_beat
\* EKS-2-13, EKS-8-7, EKS-3-1-PLC, EKS-3-4-PLC, EKS-9-1-PLC, EKS-9-4-PLC, EKS-3-0, EKS-9-0, EKS-GP-4, EKS-GP-5
LevelIsSent == [][HasCome(1)]_beat
\* EKS-2-16, EKS-3-2, EKS-3-3, EKS-GP-3
SelectionComes == [][HasCome(2)]_beat
\* EKS-2-21, EKS-3-2, EKS-3-3
EchoIsSent == [][HasCome(3)]_beat
\* EKS-2-26, EKS-3-2, EKS-3-3
AcknowledgmentComes == [][HasCome(4)]_beat
\* EKS-8-10, EKS-8-15, EKS-8-17, EKS-9-2, EKS-9-3
ZerosGoRound == [][rest' > STEPS => MW03' = 0 /\ CheckMSO' = 0 /\ MW07' = 0]_beat
=============================================================================
