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
          ALL_VECTORS,    \* TRUE: all 32 output vectors; FALSE: none, one, two, all
          PRINT_GRAPH     \* TRUE: print inputs, states and edges

VARIABLES
          in,         \* the input of the last scan, by its number; hidden by VIEW
          \* What an observer of the wires alone has seen in this insertion; nothing of the F-PLC reads it:
          cleared,    \* one output, LA and both words zero, since LA was last off and the last echo was taken back
          selected,   \* then MW03 showed this mode, with MW07 still zero
          echoed      \* then MW05 showed it

observer == <<cleared, selected, echoed>>
View == fplc
ObservedView == <<View, observer>>

----------------------------------------------------------------------------
(* The input alphabet, numbered.                                           *)

Vectors == IF ALL_VECTORS
           THEN [n \in 1..32 |-> {l \in MSO : (((n - 1) \div (2^l)) % 2) = 1}]
           ELSE <<{}, {0}, {1}, {2}, {3}, {4}, {0, 1}, MSO>>
Words == <<0, RE[0], RE[1], RE[2], RE[3], RE[4], OtherWord>>
Times == <<0, 1, 2>>
NV == Len(Vectors)
N == 2 * NV * 7 * 7 * 3

Alphabet == [n \in 0..N - 1 |->
    [LA   |-> n % 2 = 1,
     vec  |-> Vectors[((n \div 2) % NV) + 1],
     MW03 |-> Words[((n \div (2 * NV)) % 7) + 1],
     MW07 |-> Words[((n \div (14 * NV)) % 7) + 1],
     dt   |-> Times[(n \div (98 * NV)) + 1]]]

Wire(i) == [LA |-> i.LA, A |-> 0 \in i.vec, B |-> 1 \in i.vec, C |-> 2 \in i.vec, D |-> 3 \in i.vec, STR |-> 4 \in i.vec,
            MW03 |-> i.MW03, MW07 |-> i.MW07, dt |-> i.dt]
Row == [MW01 |-> MW01, MW05 |-> MW05, MSO_0 |-> 0 \in mode, MSO_1 |-> 1 \in mode, MSO_2 |-> 2 \in mode,
        MSO_3 |-> 3 \in mode, MSO_4 |-> 4 \in mode, ERROR |-> ERROR]

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

----------------------------------------------------------------------------
OpenInit ==
    /\ FplcInit /\ step = "" /\ in = 0
    /\ cleared = FALSE /\ selected = None /\ echoed = FALSE
    /\ PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>))

\* The observer reads the wires i of a scan, and MW05 as it stood before it and after it
Observe(i) ==
    LET present == i.LA /\ Cardinality(i.vec) = 1
        zeros   == present /\ i.MW03 = 0 /\ i.MW07 = 0
        chosen  == ModeOf(SE, i.MW03)
        ended   == MW05 # 0 /\ MW05' = 0          \* a transaction is over: the next one needs zeros of its own
        standing == present /\ selected # None /\ i.MW03 = SE[selected]
    IN  /\ cleared' = (~ended /\ (zeros \/ (present /\ cleared)))
        /\ selected' = IF ended THEN None ELSE IF standing THEN selected
                       ELSE IF cleared /\ present /\ i.MW07 = 0 THEN chosen ELSE None
        /\ echoed' = (~ended /\ standing /\ (echoed \/ MW05 = CH[selected]))

\* Where the clock stands the graph still tries every time; the properties need only one
TimesToTry == IF PRINT_GRAPH \/ fplcState \in Clocked THEN 0..N - 1 ELSE 0..(98 * NV) - 1

OpenNext ==
    \E n \in TimesToTry : \E i \in {Alphabet[n]} :
        /\ FplcScan(i)
        /\ in' = n
        /\ IF PRINT_GRAPH THEN UNCHANGED observer ELSE Observe(i)

OpenSpec == OpenInit /\ [][OpenNext]_<<View, observer, step, in>>

----------------------------------------------------------------------------
(* Action properties; Scanned is the input of the scan that is judged.     *)
Scanned == Alphabet[in']
PulseWindow == fplcState \in Pulse \/ (fplcState = "Idle" /\ Scanned.LA)

\* EKS-2-28, EKS-2-29, EKS-SD-2, E-15, E-16: the pair stands on the wires in the scan that switches, and it came after zeros, in this insertion
SwitchNeedsMatchingPair ==
    [][mode' # mode /\ mode' # {} =>
        \E m \in MSO : /\ mode' = {m}
                       /\ Scanned.MW03 = SE[m] /\ Scanned.MW07 = SW[m]
                       /\ cleared /\ selected = m /\ echoed]_ObservedView

\* EKS-2-18, EKS-5-10, EKS-T2-2, E-18: never beyond the level that the EKS signals in that very scan
AuthorizationRespected ==
    [][mode' # mode /\ mode' # {} =>
        (\E m, a \in MSO : mode' = {m} /\ Scanned.vec = {a} /\ Permitted(a, m))]_ObservedView

\* EKS-SD-2, E-42
NoChangeWithoutLA == [][mode' # mode /\ mode' # {} => Scanned.LA]_ObservedView

\* EKS-8-8, EKS-SD-7, E-24: insertion, removal, error and deadline leave the mode; under ON_ERROR = "none" the error mode clears it
NoChangeBesideSwitchover ==
    [][mode' # mode =>
        \/ fplcState = "Switch" /\ fplcState' = "Settle"
        \/ ON_ERROR = "none" /\ fplcState' = "Error" /\ mode' = {}]_ObservedView

\* EKS-KS-6, EKS-2-11, E-09: two outputs outside the pulse window lead to the error mode in that scan, and nothing switches
TwoOutputsLeadToError ==
    [][Cardinality(Scanned.vec) >= 2 /\ ~PulseWindow =>
        fplcState' = "Error" /\ (mode' = mode \/ (ON_ERROR = "none" /\ mode' = {}))]_ObservedView

\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-17, E-23, E-29: the way to a new insertion leads over zeros everywhere
IdleOnlyOverZeros ==
    [][fplcState # "Idle" /\ fplcState' = "Idle" =>
        /\ ~Scanned.LA /\ Scanned.vec = {} /\ Scanned.MW03 = 0 /\ Scanned.MW07 = 0
        /\ fplcElapsed + Scanned.dt >= T_DWELL]_ObservedView

\* EKS-GP-3, EKS-3-1-FPLC: a transaction is left in the scan in which the key is not signalled
RemovalSeenAtOnce ==
    [][(fplcState \in Holding /\ (~Scanned.LA \/ Scanned.vec # {accepted})) =>
        MW01' = 0 /\ MW05' = 0 /\ fplcState' \in {"Clear", "Error"}]_ObservedView

\* EKS-GP-3: every scan has exactly one step (the guards overlap nowhere and leave no gap)
ExactlyOneStep == \A n \in 0..N - 1 : ENABLED (in' = n /\ FplcScan(Alphabet[n]) /\ UNCHANGED observer)
=============================================================================
