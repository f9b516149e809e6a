----------------------------- MODULE BeaconOpen -----------------------------
(***************************************************************************)
(* The beacon alone, called or not in every scan: the graph that           *)
(* implementations of target beacon are compared with.                     *)
(***************************************************************************)
EXTENDS Sequences, TLC, Beacon

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges
VARIABLES in            \* the number of the last scan's input; hidden by VIEW

View == <<beaconState>>
Alphabet == [n \in 0..1 |-> [BeaconCall |-> n = 1, dt |-> 1]]

ASSUME PRINT_GRAPH => \A n \in 0..1 : PrintT(ToString(<<"INPUT", n, Alphabet[n]>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, BeaconOutputs>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit == BeaconInit /\ step = "" /\ in = 0 /\ (PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>)))
OpenNext == \E n \in 0..1 : BeaconScan(Alphabet[n]) /\ in' = n
OpenSpec == OpenInit /\ [][OpenNext]_<<beaconState, step, in>>
=============================================================================
