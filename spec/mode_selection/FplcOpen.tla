------------------------------ MODULE FplcOpen ------------------------------
(***************************************************************************)
(* The F-PLC alone with arbitrary inputs in every scan: any LA, any output *)
(* vector, any MW03 and MW07 by word class, any elapsed time.  This is the *)
(* environment `arbitrary`, and with the vector classes of the OPEN_ model *)
(* it is the graph that implementations are compared with.                 *)
(* Models Figures 3 to 9 as far as the F-PLC goes; leaves out every other  *)
(* device.                                                                 *)
(***************************************************************************)
EXTENDS Sequences, TLC, Fplc

CONSTANTS
          VECTORS,        \* "all" 32 output vectors; "classes": none, each one, two, all five;
                          \* "few": of the ones only levels 2 to 4;
                          \* "least": levels 2 and 4, all words but 3333, up to the first switchover;
                          \* "one": of the ones only level 2, and every time in every state
          PRINT_GRAPH     \* TRUE: print inputs, states and edges

VARIABLES
          in,         \* the input of the last scan, by its number; hidden by VIEW
          beat,       \* changes in every scan, so that no scan escapes an action property; hidden by VIEW
          \* What an observer of the wires alone has seen in this insertion; nothing of the F-PLC reads it:
          cleared,    \* one output, LA and both words zero, since LA was off and the last echo was taken back
          pulse,      \* with LA: 0 no pulse, 1 all outputs seen, 2 then none
          selected,   \* then MW03 showed this mode, with MW07 still zero
          echoed,     \* then MW05 showed it
          waited      \* ticks since LA was seen (or all outputs, E-38), until one output is accepted; or
                      \* since the removal began, or Settle

observer == <<cleared, pulse, selected, echoed, waited>>
View == fplc
ObservedView == <<View, observer>>

----------------------------------------------------------------------------
(* The input alphabet, numbered.                                           *)

ASSUME VECTORS \in {"all", "classes", "few", "least", "one"}
Vectors == CASE VECTORS = "all" -> [n \in 1..32 |-> {l \in MSO : (((n - 1) \div (2^l)) % 2) = 1}]
             [] VECTORS = "classes" -> <<{}, {0}, {1}, {2}, {3}, {4}, {0, 1}, MSO>>
             [] VECTORS = "few" -> <<{}, {2}, {3}, {4}, {2, 4}, MSO>>
             [] VECTORS = "least" -> <<{}, {2}, {4}, {2, 4}, MSO>>
             [] OTHER -> <<{}, {2}, {2, 4}, MSO>>
Words == IF VECTORS = "least" THEN <<0, RE[0], RE[1], RE[3], RE[4], OtherWord>>
         ELSE <<0, RE[0], RE[1], RE[2], RE[3], RE[4], OtherWord>>
Times == <<0, 1, 2>>
NV == Len(Vectors)
NW == Len(Words)
N == 2 * NV * NW * NW * 3

Alphabet == [n \in 0..N - 1 |->
    [LA   |-> n % 2 = 1,
     vec  |-> Vectors[((n \div 2) % NV) + 1],
     MW03 |-> Words[((n \div (2 * NV)) % NW) + 1],
     MW07 |-> Words[((n \div (2 * NV * NW)) % NW) + 1],
     dt   |-> Times[(n \div (2 * NV * NW * NW)) + 1]]]

Wire(i) ==
    [LA |-> i.LA, A |-> 0 \in i.vec, B |-> 1 \in i.vec, C |-> 2 \in i.vec, D |-> 3 \in i.vec,
     STR |-> 4 \in i.vec, MW03 |-> i.MW03, MW07 |-> i.MW07, dt |-> i.dt]
Row == FplcOutputs

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

----------------------------------------------------------------------------
OpenInit ==
    /\ FplcInit /\ step = "" /\ in = 0
    /\ beat = FALSE /\ cleared = FALSE /\ pulse = 0 /\ selected = None /\ echoed = FALSE /\ waited = 0
    /\ PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>))

\* The stretches that have one deadline as a whole
Stretch(s) == IF s \in Inserting THEN "insertion" ELSE IF s \in Removing THEN "removal"
              ELSE IF s = "Settle" THEN "settling" ELSE "none"
\* The observer reads the wires i of a scan, and MW05 and the state as they stood before it and after it
LOCAL Waits(i) ==
    LET goes_on == /\ fplcState \in Timed /\ Stretch(fplcState') = Stretch(fplcState)
                   /\ T_SEQ_FROM = "ones" => ~(fplcState = "PulseOnes" /\ fplcState' # "PulseOnes")
        longest == T_SEQ + T_REM
    IN  waited' = IF ~goes_on THEN 0 ELSE IF waited + i.dt > longest THEN longest ELSE waited + i.dt
LOCAL SeesPulse(i) ==
    pulse' = IF ~i.LA THEN 0 ELSE IF i.vec = MSO THEN 1 ELSE IF pulse = 1 /\ i.vec = {} THEN 2 ELSE pulse
\* With LA and one output
LOCAL SeesWords(i) ==
    LET ended    == MW05 # 0 /\ MW05' = 0        \* a transaction is over: the next one needs zeros of its own
        standing == selected # None /\ i.MW03 = SE[selected]
    IN  IF ended THEN cleared' = FALSE /\ selected' = None /\ echoed' = FALSE
        ELSE /\ cleared' = (cleared \/ (i.MW03 = 0 /\ i.MW07 = 0))
             /\ selected' = IF standing THEN selected
                            ELSE IF cleared /\ i.MW07 = 0 THEN ModeOf(SE, i.MW03) ELSE None
             /\ echoed' = (standing /\ (echoed \/ MW05 = CH[selected]))
Observe(i) ==
    /\ Waits(i) /\ SeesPulse(i)
    /\ IF i.LA /\ Cardinality(i.vec) = 1 THEN SeesWords(i)
       ELSE cleared' = FALSE /\ selected' = None /\ echoed' = FALSE

\* The graph tries every time in every state; the properties need only those that the state can tell apart
LongestTime ==
    IF VECTORS = "one" THEN 2 ELSE IF fplcState \in Returning THEN T_REM
    ELSE IF fplcState \in Clocked THEN T_DWELL ELSE 0
ASSUME PRINT_GRAPH \/ VECTORS = "one" \/ (T_ON = T_DWELL /\ T_SEQ = T_DWELL)
Ended == VECTORS = "least" /\ mode # {}
InputsToTry ==
    IF PRINT_GRAPH THEN 0..N - 1 ELSE IF Ended THEN {} ELSE 0..(2 * NV * NW * NW) * (LongestTime + 1) - 1

OpenNext ==
    \E n \in InputsToTry :
        /\ FplcScan(Alphabet[n])
        /\ in' = n /\ beat' = ~beat
        /\ IF PRINT_GRAPH THEN UNCHANGED observer ELSE Observe(Alphabet[n])

OpenSpec == OpenInit /\ [][OpenNext]_<<View, observer, step, in, beat>>

----------------------------------------------------------------------------
(* Action properties, judged in every scan; Scanned is that scan's input.  *)
Scanned == Alphabet[in']
\* For a reader of a trace: what a scan found on the wires, and what stands on them after it
Wires == Wire(Alphabet[in]) @@ FplcOutputs
\* E-71: also a switchover to the mode that is active already
Switched == (step' = "SwitchMode" \/ mode' # mode) /\ mode' # {}
PulseWindow == fplcState \in Pulse \/ (fplcState = "Idle" /\ Scanned.LA)

\* EKS-2-28, EKS-2-29, EKS-SD-2, E-15, E-16: the pair stands on the wires in the scan that switches, and it
\* came after zeros, in this insertion
SwitchNeedsMatchingPair ==
    [][Switched =>
        \E m \in MSO : /\ mode' = {m}
                       /\ Scanned.MW03 = SE[m] /\ Scanned.MW07 = SW[m]
                       /\ cleared /\ selected = m /\ echoed]_beat

\* EKS-2-18, EKS-5-10, EKS-T2-2, E-18: never beyond the level that the EKS signals in that very scan
AuthorizationRespected ==
    [][Switched =>
        (\E m, a \in MSO : mode' = {m} /\ Scanned.vec = {a} /\ Permitted(a, m))]_beat

\* EKS-T2-2, E-47, A-03: for a machine whose levels are ordered only as far as the text says
AuthorizationByTheText ==
    [][Switched => (\E m, a \in MSO : mode' = {m} /\ Scanned.vec = {a} /\ m \in TextOrder[a])]_beat

\* E-12, E-18: what stands in the flag word MW01 when a scan reads its inputs: nothing but the F-PLC writes it
FlagWordMW01 == MW01
\* EKS-2-18, EKS-5-1, E-12: a selection is accepted only while the flag word MW01 shows a level that permits
\* it
SelectionNeedsLevel ==
    [][step' = "AcceptSelection" => Permitted(ModeOf(RE, FlagWordMW01), ModeOf(SE, Scanned.MW03))]_beat

\* EKS-SD-2, E-42
NoChangeWithoutLA == [][Switched => Scanned.LA]_beat

\* EKS-8-8, EKS-SD-7, E-24: insertion, removal, error and deadline leave the mode; under ON_ERROR = "none" the
\* error mode clears it
NoChangeBesideSwitchover ==
    [][mode' # mode =>
        \/ step' = "SwitchMode" /\ mode' # {}
        \/ ON_ERROR = "none" /\ fplcState' = "Error" /\ mode' = {}]_beat

\* EKS-KS-6, EKS-2-11, E-09: two outputs outside the pulse window lead to the error mode in that scan, and
\* nothing switches
TwoOutputsLeadToError ==
    [][Cardinality(Scanned.vec) >= 2 /\ ~PulseWindow =>
        ERROR' /\ fplcState' = "Error" /\ (mode' = mode \/ (ON_ERROR = "none" /\ mode' = {}))]_beat

\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-17, E-23, E-29: the way to an insertion leads over zeros
\* everywhere
IdleOnlyOverZeros ==
    [][fplcState # "Idle" /\ fplcState' = "Idle" =>
        /\ ~Scanned.LA /\ Scanned.vec = {} /\ Scanned.MW03 = 0 /\ Scanned.MW07 = 0
        /\ fplcElapsed + Scanned.dt >= T_DWELL]_beat

\* EKS-3-0, EKS-9-0, E-23b: the error mode is left only over the same zeros; its lamp does not go out before
ErrorOnlyOverZeros ==
    [][ERROR /\ ~ERROR' =>
        /\ ~Scanned.LA /\ Scanned.vec = {} /\ Scanned.MW03 = 0 /\ Scanned.MW07 = 0
        /\ fplcElapsed + Scanned.dt >= T_DWELL]_beat

\* EKS-8-3, EKS-8-11, E-36: whatever the key does, the timer of a removal goes on
RemovalTimerGoesOn ==
    [][(fplcState \in Removing /\ fplcState' \in Removing) => fplcElapsed' >= (fplcElapsed + Scanned.dt)]_beat

\* EKS-GP-4, EKS-3-1-FPLC: a transaction is left in the scan in which the key is not signalled
RemovalSeenAtOnce ==
    [][(fplcState \in Holding /\ (~Scanned.LA \/ Scanned.vec # {accepted})) =>
        MW01' = 0 /\ MW05' = 0 /\ fplcState' \in {"Clear", "Error"}]_beat

\* EKS-2-20, EKS-6-12, E-15: what MW05 shows stands in MW03 in the scan that shows it, or is the mode that was
\* switched, and the signalled level permits it
EchoNeedsSelection ==
    [][MW05' # 0 =>
        (\E a, m \in MSO :
            /\ MW05' = CH[m] /\ Scanned.vec = {a} /\ Permitted(a, m)
            /\ Scanned.MW03 = SE[m] \/ (fplcState' = "Complete" /\ mode' = {m}))]_beat

\* EKS-2-29, EKS-GP-5, E-15: where each insertion has one selection, the key must go before the next one
OneSelectionWhereSet ==
    [][SELECTIONS = "once" =>
        /\ Switched => fplcState' = "Complete"
        /\ fplcState = "Complete" => fplcState' \in {"Complete", "Clear", "Error"} /\ ~Switched]_beat

\* EKS-2-10, EKS-4-1, EKS-4-3, E-10: no level is published without the test pulse of this insertion
LevelNeedsPulse == [][(MW01' # 0 /\ MW01 = 0) => pulse = 2]_beat

\* EKS-2-8, EKS-4-4, EKS-4-6, EKS-8-11, E-03, E-30: no wait outlasts its deadline
NoWaitBeyondDeadline == fplcState \in Timed => fplcElapsed < Deadline

\* EKS-2-6, EKS-2-8, EKS-4-2, EKS-8-3, EKS-8-11, E-03, E-30, E-38: nor do several waits together that share
\* one
SharedDeadlineHolds ==
    /\ fplcState = "PulseOnes" => waited < T_ON
    /\ Stretch(fplcState) = "insertion" => waited < T_SEQ \/ (T_SEQ_FROM = "ones" /\ fplcState = "PulseOnes")
    /\ Stretch(fplcState) = "removal" => waited < T_REM

\* EKS-8-11, E-15: a word that does not go back to zero between two selections is reported within T_REM
StuckWordIsReported == Stretch(fplcState) = "settling" => waited < T_REM

\* EKS-KS-6, E-24: where the error mode is to drop the active mode, it does
ErrorDropsMode == ON_ERROR = "none" /\ fplcState = "Error" => mode = {}

\* EKS-GP-3: there is no input to which a scan has no answer
EveryScanIsAnswered == \A n \in InputsToTry : ENABLED FplcScan(Alphabet[n])

\* EKS-GP-5, E-25c: before the first step no mode is active, no level and no echo is sent, and no key is
\* waited for
PowerUpIsSafe == step = "" => fplcState = "Start" /\ mode = {} /\ MW01 = 0 /\ MW05 = 0 /\ ~ERROR
=============================================================================
