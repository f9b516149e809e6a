----------------------------- MODULE FPLCShows ------------------------------
(***************************************************************************)
(* The F-PLC by the pins of the cell.  Our own design; the block is Fplc,  *)
(* unchanged.                                                              *)
(***************************************************************************)
EXTENDS Fplc

Starts == FplcInit
Call(i) ==
    FplcScan([LA |-> i.LA, MW03 |-> i.MW03, MW07 |-> i.MW07, dt |-> i.dt,
              vec |-> {l \in MSO : CASE l = 0 -> i.A [] l = 1 -> i.B [] l = 2 -> i.C [] l = 3 -> i.D
                                     [] l = 4 -> i.STR}])

\* What its contract speaks of
Row ==
    [MSO_0 |-> 0 \in mode, MSO_1 |-> 1 \in mode, MSO_2 |-> 2 \in mode, MSO_3 |-> 3 \in mode,
     MSO_4 |-> 4 \in mode, ERROR |-> ERROR, up |-> fplcState # "Start"]

\* What the refinement tries: two levels, none, two outputs and all; the words of three modes and another one
LOCAL Vector(vec) ==
    [A |-> 0 \in vec, B |-> 1 \in vec, C |-> 2 \in vec, D |-> 3 \in vec, STR |-> 4 \in vec]
Inputs ==
    {[LA |-> la, MW03 |-> mw03, MW07 |-> mw07, dt |-> dt] @@ Vector(vec) :
        la \in BOOLEAN, vec \in {{}, {1}, {4}, {1, 4}, MSO}, dt \in 0..1,
        mw03 \in {0, SE[0], SE[1], SE[4], OtherWord}, mw07 \in {0, SW[0], SW[1], SW[4], OtherWord}}

\* EKS-2-18, EKS-T2-2, E-18: of a call i: a mode comes only within the level that the key shows in that scan
WithinAuthorization(i) ==
    mode' # mode =>
        \E m, level \in MSO :
            /\ mode' = {m} /\ Permitted(level, m)
            /\ <<i.A, i.B, i.C, i.D, i.STR>> = [n \in 1..5 |-> n = level + 1]

\* The key is out and every word zero, for a tick a call; and where that leads
RestInputs == {[LA |-> FALSE, MW03 |-> 0, MW07 |-> 0, dt |-> 1] @@ Vector({})}
Rests ==
    /\ fplcState = "Idle" /\ accepted = None /\ authority = None /\ fplcSelection = None /\ fplcElapsed = 0
    /\ mode \in {{}, {0}, {1}, {2}, {3}, {4}}
=============================================================================
