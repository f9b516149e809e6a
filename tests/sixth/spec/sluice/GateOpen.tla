------------------------------ MODULE GateOpen ------------------------------
(***************************************************************************)
(* The gate alone, with any inputs in every scan: the graph that           *)
(* implementations of target gate are compared with.                       *)
(***************************************************************************)
EXTENDS Sequences, TLC, Gate

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges
VARIABLES in            \* the number of the last scan's input; hidden by VIEW

View == gate
N == 8
Alphabet == [n \in 0..N - 1 |-> [OpenRequest |-> n % 2 = 1, BeaconLit |-> (n \div 2) % 2 = 1, dt |-> n \div 4]]

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Alphabet[n]>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, GateOutputs>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit == GateInit /\ step = "" /\ in = 0 /\ (PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>)))
OpenNext == \E n \in 0..N - 1 : GateScan(Alphabet[n]) /\ in' = n
OpenSpec == OpenInit /\ [][OpenNext]_<<gate, step, in>>
=============================================================================
