--------------------------- MODULE KeyFlowsFaults ---------------------------
(***************************************************************************)
(* The whole of the note with faults: environments `corrupting` (words on  *)
(* their way, by the communication error list) and `faulty_eks` (LA, the   *)
(* five outputs and their wires, the reader's register check).             *)
(* Insert steps 1 to 29 and removal steps 1 to 18, as in KeyFlows; the     *)
(* classes are those that EKS-SD-10, EKS-SD-11 and EKS-SD-17 speak of.     *)
(*                                                                         *)
(* A fault on a word is one wrong copy: it stands until the next copy.  It *)
(* happens in the scan that reads it first and in which it makes a         *)
(* difference (A-30): a fault before that would change nothing else.       *)
(* MW01, MW05 and the words of the panel are outputs; they are wrong where *)
(* they are copied to, so four places stand for eight words (A-30).        *)
(* A fault of the wires begins and may end, again where it is seen first.  *)
(* Leaves out: faults inside the F-PLC (A-18), in the PLC's or the panel's *)
(* program (A-12, A-13), on keys (A-24); more than FAULTS faults.          *)
(***************************************************************************)
EXTENDS KeyFlows, WrongWords

CONSTANTS
    FAULTS,         \* how many faults may happen
    FAULT_CLASSES,  \* which classes of faults may happen
    SLOW_READER     \* TRUE: a user may touch the screen while the reader is in its test pulse (breaks A-31)

VARIABLES
    faults,         \* how many faults have happened
    past,           \* for each of the four words the last one before it that was not zero, where it counts
    broken,         \* what is broken between the reader and the F-PLC
    low,            \* something is broken, and the F-PLC has scanned since LA and the outputs fell
    wrong           \* the words that this scan read wrong, for readers of a trace; hidden by VIEW

WordClassesOfFaults ==
    {"corruption", "repetition", "wrong sequence", "loss", "insertion", "masquerade", "wrong address",
     "straddled read", "torn word"}
WireClasses ==
    {"output stuck at 1", "output stuck at 0", "LA stuck at 1", "LA stuck at 0", "extra wire",
     "crossed wires", "no pulse"}
RegisterClass == "register check fails"

ASSUME FAULTS \in 0..2 /\ SLOW_READER \in BOOLEAN
ASSUME FAULT_CLASSES \subseteq WordClassesOfFaults \cup WireClasses \cup {RegisterClass}

Class(c) == c \in FAULT_CLASSES
AllWordClasses == WordClassesOfFaults
\* Crossed wires are found by nothing (A-20)
LOCAL Uncrossed == (WireClasses \ {"crossed wires"}) \cup {RegisterClass}
AllButCrossedWires == Uncrossed
\* With these every word can be anywhere, and no memory of old words is needed
EveryWord == {"corruption", "loss", "masquerade"} \subseteq FAULT_CLASSES

Places == {"ReadAuthorization", "MW03", "CheckMSO", "MW07"}
faultVars == <<faults, past, broken, low>>
FaultView == <<View, faultVars>>
FaultViewWithoutMode == <<ViewWithoutMode, faultVars>>
\* Where no property speaks of what the user did, that is hidden like the mode: no device reads it (A-17)
DevicesView ==
    <<reader, eks, fplcState, accepted, authority, fplcSelection, fplcElapsed, plc, hmi, faultVars>>
everything == <<vars, faultVars, wrong>>

FaultInit ==
    /\ Init
    /\ faults = 0 /\ past = [p \in Places |-> 0] /\ broken = {} /\ low = FALSE /\ wrong = {}

----------------------------------------------------------------------------
(* Words: what may stand in a place instead of what stands there.          *)

\* A-30: of the modes that no key permits, the lowest stands for all: the F-PLC refuses each of them
Modes == {m \in MSO : \A l \in 0..m-1 : \E k \in LEVELS : l <= k}
\* The codes that say something in a place about one of these modes or levels
CodesFor(p) ==
    LET range == CASE p = "ReadAuthorization" -> RE [] p = "MW03" -> SE
                   [] p = "CheckMSO" -> CH [] p = "MW07" -> SW
    IN  {range[m] : m \in Modes}

Stands(p) ==
    CASE p = "ReadAuthorization" -> ReadAuthorization [] p = "MW03" -> MW03
      [] p = "CheckMSO" -> CheckMSO [] p = "MW07" -> MW07
Sent(p) ==
    CASE p = "ReadAuthorization" -> MW01 [] p = "MW03" -> SelectMSO
      [] p = "CheckMSO" -> MW05 [] p = "MW07" -> SwitchMSO
\* The flag word that is read for the place
Flag(p) ==
    CASE p = "ReadAuthorization" -> MW01 [] p = "MW03" -> MW03 [] p = "CheckMSO" -> MW05 [] p = "MW07" -> MW07

StraddledReads(p) ==
    LET MW02 == Straddled(MW01, MW03)
        MW04 == Straddled(MW03, MW05)
        MW06 == Straddled(MW05, MW07)
    IN  CASE p = "ReadAuthorization" -> {MW02} [] p = "MW03" -> {MW02, MW04}
          [] p = "CheckMSO" -> {MW04, MW06} [] p = "MW07" -> {MW06}

\* EKS-SD-10, EKS-SD-11, EKS-SD-17, E-18, E-49: by class of the communication error list
Instead(p) ==
    ((IF Class("corruption") THEN {OtherWord} ELSE {})
     \cup (IF Class("loss") THEN {0} ELSE {})
     \cup (IF Class("masquerade") THEN CodesFor(p) ELSE {})
     \cup (IF Class("insertion") /\ Stands(p) = 0 THEN CodesFor(p) \cup {OtherWord} ELSE {})
     \cup (IF Class("repetition") /\ ~EveryWord THEN {past[p]} ELSE {})
     \cup (IF Class("wrong address") /\ ~EveryWord THEN {Flag(q) : q \in Places \ {p}} ELSE {})
     \cup (IF Class("straddled read") /\ ~EveryWord THEN StraddledReads(p) ELSE {})
     \cup (IF Class("torn word") /\ ~EveryWord
           THEN {Mixed(Stands(p), Sent(p)), Mixed(Sent(p), Stands(p))} ELSE {}))
    \ {Stands(p)}

\* What a device may read in two places, and what that costs; two copies in each other's place are one fault
Reads(p, q) ==
    LET left == FAULTS - faults
        one == {<<w, Stands(q), 1>> : w \in Instead(p)} \cup {<<Stands(p), w, 1>> : w \in Instead(q)}
        two == {<<v, w, 2>> : v \in Instead(p), w \in Instead(q)}
        exchanged == IF Class("wrong sequence") /\ <<Sent(q), Sent(p)>> # <<Stands(p), Stands(q)>>
                     THEN {<<Sent(q), Sent(p), 1>>} ELSE {}
    IN  IF left = 0 THEN {<<Stands(p), Stands(q), 0>>} ELSE
        {<<Stands(p), Stands(q), 0>>}
        \cup (IF left >= 1 THEN one \cup exchanged ELSE {}) \cup (IF left >= 2 THEN two ELSE {})

\* A wrong word that makes a device wait is a delay, which is there anyway
FplcCares(r) ==
    CASE fplcState \in {"Start", "Settle", "AwaitZeros", "Error"} -> r[1] = 0 /\ r[2] = 0
      [] fplcState \in {"Idle", "OneOutput", "Clear"} \cup Pulse -> FALSE
      [] OTHER -> TRUE
PanelCares(r) == hmiState = "Inhibited" => ModeOf(RE, r[1]) # None /\ r[2] = 0
Wrong(p, q, r) == (IF r[1] # Stands(p) THEN {p} ELSE {}) \cup (IF r[2] # Stands(q) THEN {q} ELSE {})
\* Liveness runs record nothing
WrongWas(p, q, r) == wrong' = IF RECORD_STEPS /\ r[3] > 0 THEN Wrong(p, q, r) ELSE {}

----------------------------------------------------------------------------
(* Wires: what the F-PLC sees of LA and the five outputs.                  *)

\* EKS-KS-6, EKS-2-11, EKS-4-4, E-09, E-28, E-49: what can be broken
Elements ==
    {<<"on", l, l>> : l \in IF Class("output stuck at 1") THEN MSO ELSE {}}
    \cup {<<"off", l, l>> : l \in IF Class("output stuck at 0") THEN MSO ELSE {}}
    \cup (IF Class("LA stuck at 1") THEN {<<"LA", 1, 1>>} ELSE {})
    \cup (IF Class("LA stuck at 0") THEN {<<"LA", 0, 0>>} ELSE {})
    \cup (IF Class("extra wire")
          THEN {<<"extra", a, b>> : a, b \in MSO} \ {<<"extra", a, a>> : a \in MSO} ELSE {})
    \cup (IF Class("crossed wires") THEN {e \in {<<"crossed", a, b>> : a, b \in MSO} : e[2] < e[3]} ELSE {})
    \cup (IF Class("no pulse") THEN {<<"no pulse", 0, 0>>} ELSE {})

SeenLA(b) == (LA \/ <<"LA", 1, 1>> \in b) /\ <<"LA", 0, 0>> \notin b
\* Output l seen where another is wired to it
Crossed(b, l) ==
    LET c == {e \in b : e[1] = "crossed" /\ l \in {e[2], e[3]}}
    IN  IF c = {} THEN l ELSE LET e == CHOOSE e \in c : TRUE IN IF e[2] = l THEN e[3] ELSE e[2]
SeenVector(b) ==
    IF b = {} THEN Vector ELSE
    LET sent == IF <<"no pulse", 0, 0>> \in b /\ eksState = "TestOnes" THEN {}
                ELSE {Crossed(b, l) : l \in Vector}
        extra == {e[3] : e \in {e \in b : e[1] = "extra" /\ e[2] \in sent}}
        on == {e[2] : e \in {e \in b : e[1] = "on"}}
        off == {e[2] : e \in {e \in b : e[1] = "off"}}
    IN  (sent \cup extra \cup on) \ off
Seen(b) == <<SeenLA(b), SeenVector(b)>>

\* What is broken in the next scan: as before, more, or less, where that is seen
Wirings ==
    LET left == FAULTS - faults
        more == IF left >= 1 THEN {broken \cup {e} : e \in Elements} ELSE {}
        most == IF left >= 2 THEN {broken \cup {e, f} : e, f \in Elements} ELSE {}
        less == {broken \ {e} : e \in broken}
    IN  IF Elements = {} THEN {broken}
        ELSE {broken} \cup {b \in more \cup most \cup less : Seen(b) # Seen(broken)}

----------------------------------------------------------------------------
(* The devices, with what is broken.                                       *)

Remembered == Class("repetition") /\ ~EveryWord
\* EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26
PlcRunsFaulty ==
    /\ PlcRuns
    /\ past' = IF ~Remembered THEN past
               ELSE [p \in Places |-> IF Stands(p) # 0 /\ Stands(p)' # Stands(p) THEN Stands(p) ELSE past[p]]
    /\ wrong' = {} /\ UNCHANGED <<faults, broken, low>>

\* EKS-GP-3, EKS-KS-6, EKS-2-19, EKS-2-27: the scan that meets a fault
FplcRunsFaulty ==
    /\ \E dt \in Times, b \in Wirings, r \in Reads("MW03", "MW07") :
        LET cost == r[3] + Cardinality(b \ broken) IN
        /\ faults + cost <= FAULTS /\ (r[3] > 0 => FplcCares(r))
        /\ FplcScan([LA |-> SeenLA(b), vec |-> SeenVector(b), MW03 |-> r[1], MW07 |-> r[2], dt |-> dt])
        /\ dt > 0 => fplcState' # fplcState
        /\ MW03' = r[1] /\ MW07' = r[2] /\ WrongWas("MW03", "MW07", r)
        /\ faults' = faults + cost /\ broken' = b /\ low' = (b # {} /\ ~LA /\ Vector = {})
        /\ Took(dt)
    /\ UNCHANGED <<reader, eks, turn, ReadAuthorization, CheckMSO, hmi, history, past>>

\* A-31: a user is slower than the test pulse of the reader
InPulse == eksState \in {"StartTest", "TestOnes", "TestZeros"}
Touchable == IF InPulse /\ ~SLOW_READER /\ Elements # {} THEN {""} ELSE Fields
\* EKS-2-14, EKS-2-22
PanelRunsFaulty ==
    /\ \E r \in Reads("ReadAuthorization", "CheckMSO"), touch \in Touchable :
        /\ r[3] > 0 => PanelCares(r)
        /\ HmiScan([RA |-> r[1], CM |-> r[2], touch |-> touch])
        /\ ReadAuthorization' = r[1] /\ CheckMSO' = r[2] /\ WrongWas("ReadAuthorization", "CheckMSO", r)
        /\ faults' = faults + r[3]
    /\ Took(0)
    /\ Remember
    /\ UNCHANGED <<reader, eks, fplc, turn, MW03, MW07, past, broken, low>>

\* EKS-8-4, E-26: channel B finds a register that is not zero
RegisterCheckFails ==
    /\ Class(RegisterClass) /\ faults < FAULTS
    /\ Clears
    /\ eksState' = "Fault" /\ key' = None /\ eksElapsed' = 0
    /\ faults' = faults + 1 /\ wrong' = {} /\ UNCHANGED <<reader, fplc, plc, hmi, history, past, broken, low>>
    /\ Took(0) /\ Did("LatchFault")
\* A-07: as in KeyFlows; where LA is not seen to be low, a scan while it is low is enough
EksRunsFaulty ==
    \/ /\ IF MERGE_READING /\ CanMerge THEN (ReadInOneStep \/ ClearInOneStep) /\ Took(0)
          ELSE \E dt \in (IF eksState \in {"TestOnes", "TestZeros"} THEN {0, T_PULSE} ELSE {0}) :
                EksScan(EksInput(dt)) /\ Took(dt)
       /\ LET raises == eksState' = "StartTest" /\ eksState # "StartTest" IN
            /\ raises => RemovalNoticed \/ low
            /\ low' = (low /\ ~raises)
       /\ wrong' = {} /\ UNCHANGED <<reader, fplc, plc, hmi, history, faults, past, broken>>
    \/ RegisterCheckFails

UserFaulty == User /\ wrong' = {} /\ UNCHANGED faultVars

FaultNext == UserFaulty \/ EksRunsFaulty \/ FplcRunsFaulty \/ PlcRunsFaulty \/ PanelRunsFaulty
FaultSpec == FaultInit /\ [][FaultNext]_everything

----------------------------------------------------------------------------
(* What holds with faults too.                                             *)

FaultTypeOK ==
    /\ TypeOK
    /\ faults \in 0..FAULTS /\ past \in [Places -> WORDS] /\ broken \subseteq Elements /\ low \in BOOLEAN

\* EKS-2-18, EKS-T2-2, EKS-FD-3: never a mode beyond the key that the reader holds, whatever LA and the
\* outputs say
NeverBeyondTheKey ==
    [][step' = "SwitchMode" => \A m \in MSO :
        Switched(m) => key # None /\ Permitted(KeyLevel(key), m)]_everything
\* EKS-2-14, EKS-SD-5: less than UserIntent: nothing but what this user touched
NothingButTheTouch == [][step' = "SwitchMode" => \A m \in MSO : Switched(m) => touched = m]_everything
\* EKS-2-14, EKS-SD-4, E-51: the panel offers no mode that the F-PLC would refuse
NoOfferBeyondTheLevel == [][authority # None => \A m \in Enabled : Permitted(authority, m)]_everything
\* EKS-2-19, EKS-2-27: no word of an honest panel is refused
NoWordIsRefused ==
    [][step' \notin {"RefuseEarlyWord", "RefuseSelection", "RefuseAcknowledgment", "RefuseMatch",
                     "UnexpectedAcknowledgment"}]_everything

----------------------------------------------------------------------------
(* For a reader of a trace; no run checks anything by these.               *)

\* All that stands on the wires, LA and the outputs as the F-PLC sees them
WiresSeen ==
    LET vec == SeenVector(broken)
    IN  [LA |-> SeenLA(broken), A |-> 0 \in vec, B |-> 1 \in vec, C |-> 2 \in vec, D |-> 3 \in vec,
         STR |-> 4 \in vec] @@ Wires
\* What the F-PLC and the panel read in the scan that was just executed; a wrong word stands afterwards
FplcReadWrong ==
    [LA |-> SeenLA(broken'), vec |-> SeenVector(broken'), MW03 |-> MW03', MW07 |-> MW07', dt |-> took']
PanelReadWrong ==
    LET with(touch) == [RA |-> ReadAuthorization', CM |-> CheckMSO', touch |-> touch]
    IN  with(IF HmiScan(with("")) THEN "" ELSE CHOOSE touch \in Touches : HmiScan(with(touch)))
=============================================================================
