----------------------------- MODULE PlcDemands ------------------------------
(***************************************************************************)
(* What the note demands of the PLC, seen on its wires: the demands of     *)
(* demands.toml on device plc, read from the clauses once more.  The       *)
(* observer keeps what came in before and counts scans; it reads no state  *)
(* of the PLC.  A reading of the note that meets all of them is one that   *)
(* the note leaves open.                                                   *)
(* Leaves out: words other than zero and one code.                         *)
(***************************************************************************)
EXTENDS PlcOpen

CONSTANTS STEPS,    \* scans within which a copy must come
          LATENCY   \* scans by which a program may be late in reading its inputs: 0 or 1

VARIABLES given,    \* what came in before this scan
          stood,    \* scans for which MW01 has been as it is
          rest,     \* scans for which all that comes in has been zero
          part,     \* the part of a good course: 0 rest, 1 level, 2 selection, 3 echo, 4 acknowledgment; -1 none
          lasted    \* scans for which it has been this part

watched == <<given, stood, rest, part, lasted>>
DemandView == <<View, watched>>

ASSUME STEPS \in Nat \ {0} /\ LATENCY \in {0, 1}

TwoWords == {n \in 0..N - 1 : \A name \in DOMAIN Alphabet[n] : Alphabet[n][name] \in {0, RE[3]}}
Nothing == [MW01 |-> 0, MW05 |-> 0, SelectMSO |-> 0, SwitchMSO |-> 0]
Capped(n) == IF n > STEPS + 1 THEN STEPS + 1 ELSE n

\* The part of a good course that the inputs i continue or begin; each word stays, and the next one comes only
\* when the one before was seen on the other side
SameAs(i, names) == \A name \in names : i[name] = given[name]
Zero(i, names) == \A name \in names : i[name] = 0
Begins1(i) == part = 0 \/ (part = 1 /\ SameAs(i, {"MW01"}))
Begins2(i) == (part = 1 /\ ReadAuthorization = i.MW01) \/ (part = 2 /\ SameAs(i, {"SelectMSO"}))
Begins3(i) == (part = 2 /\ MW03 = i.SelectMSO) \/ (part = 3 /\ SameAs(i, {"MW05"}))
Begins4(i) == (part = 3 /\ CheckMSO = i.MW05) \/ (part = 4 /\ SameAs(i, {"SwitchMSO"}))
PartOf(i, restNow) ==
    IF restNow > STEPS THEN 0
    ELSE IF i.MW01 = 0 THEN -1
    ELSE IF Begins1(i) /\ Zero(i, {"SelectMSO", "MW05", "SwitchMSO"}) THEN 1
    ELSE IF ~SameAs(i, {"MW01"}) \/ i.SelectMSO = 0 THEN -1
    ELSE IF Begins2(i) /\ Zero(i, {"MW05", "SwitchMSO"}) THEN 2
    ELSE IF ~SameAs(i, {"SelectMSO"}) \/ i.MW05 = 0 THEN -1
    ELSE IF Begins3(i) /\ i.SwitchMSO = 0 THEN 3
    ELSE IF Begins4(i) /\ SameAs(i, {"MW05"}) /\ i.SwitchMSO # 0 THEN 4
    ELSE -1

Watch(i) ==
    /\ given' = i
    /\ stood' = IF SameAs(i, {"MW01"}) THEN Capped(stood + 1) ELSE 1
    /\ rest' = IF i = Nothing THEN Capped(rest + 1) ELSE 0
    /\ part' = PartOf(i, rest')
    /\ lasted' = IF part' = part THEN Capped(lasted + 1) ELSE 1

DemandInit == OpenInit /\ given = Nothing /\ stood = 0 /\ rest = 0 /\ part = -1 /\ lasted = 0
\* A reading that has no step for an input changes nothing in that scan
Scan(i) == IF ENABLED PlcScan(i) THEN PlcScan(i) ELSE UNCHANGED <<plc, step>>
DemandNext ==
    \E n \in TwoWords : \E i \in {Alphabet[n]} : Scan(i) /\ in' = n /\ beat' = ~beat /\ Watch(i)
DemandSpec == DemandInit /\ [][DemandNext]_<<DemandView, step, in, beat>>

----------------------------------------------------------------------------
\* What a program may take for the value of an input in this scan
Read(name) == {given'[name]} \cup (IF LATENCY = 1 THEN {given[name]} ELSE {})
Late(p) == part' = p /\ lasted' > STEPS

\* EKS-2-13, EKS-8-7, EKS-GP-2, EKS-KS-10
LevelIsSentUnchanged ==
    [][ReadAuthorization' # ReadAuthorization => ReadAuthorization' \in Read("MW01")]_beat
\* EKS-2-16, EKS-8-10, EKS-GP-2, EKS-KS-10
SelectionIsCopied == [][MW03' # MW03 => MW03' \in Read("SelectMSO")]_beat
\* EKS-2-21, EKS-8-15, EKS-GP-2, EKS-KS-10
EchoIsSentUnchanged == [][CheckMSO' # CheckMSO => CheckMSO' \in Read("MW05")]_beat
\* EKS-2-26, EKS-8-17, EKS-GP-2, EKS-KS-10
AcknowledgmentIsCopied == [][MW07' # MW07 => MW07' \in Read("SwitchMSO")]_beat
\* EKS-2-13, EKS-8-7, EKS-3-1-PLC, EKS-3-4-PLC, EKS-9-1-PLC, EKS-9-4-PLC, EKS-3-0, EKS-9-0, EKS-GP-4, EKS-GP-5
LevelIsSent == [][stood' > STEPS => ReadAuthorization' = given'.MW01]_beat
\* EKS-2-16, EKS-3-2, EKS-3-3, EKS-GP-3
SelectionComes == [][Late(2) => MW03' = given'.SelectMSO]_beat
\* EKS-2-21, EKS-3-2, EKS-3-3
EchoIsSent == [][Late(3) => CheckMSO' = given'.MW05]_beat
\* EKS-2-26, EKS-3-2, EKS-3-3
AcknowledgmentComes == [][Late(4) => MW07' = given'.SwitchMSO]_beat
\* EKS-8-10, EKS-8-15, EKS-8-17, EKS-9-2, EKS-9-3
ZerosGoRound == [][rest' > STEPS => MW03' = 0 /\ CheckMSO' = 0 /\ MW07' = 0]_beat
=============================================================================
