------------------------------ MODULE PlcOpen -------------------------------
(***************************************************************************)
(* The PLC alone, with any words at its inputs: the graph that             *)
(* implementations of target plc are compared with.  The order of the      *)
(* copies is fixed here; KeyFlows allows any.                              *)
(* Leaves out every other device, and all words but three: the PLC only    *)
(* compares two words, so zero, one code and one other word stand for all  *)
(* (A-10).                                                                 *)
(***************************************************************************)
EXTENDS Sequences, TLC, Plc

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges
VARIABLES in,           \* the number of the last scan's input; hidden by VIEW
          beat          \* changes in every scan, so that no scan escapes an action property; hidden by VIEW

View == plc

Words == <<0, RE[3], OtherWord>>
WordSet == {0, RE[3], OtherWord}
N == 81
Alphabet == [n \in 0..N - 1 |->
    [MW01 |-> Words[(n % 3) + 1], MW05 |-> Words[((n \div 3) % 3) + 1],
     SelectMSO |-> Words[((n \div 9) % 3) + 1], SwitchMSO |-> Words[(n \div 27) + 1]]]

Wire(i) == [MW01 |-> i.MW01, MW05 |-> i.MW05, SelectMSO |-> i.SelectMSO, SwitchMSO |-> i.SwitchMSO, dt |-> 1]
Row == PlcOutputs

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit ==
    PlcInit /\ step = "" /\ in = 0 /\ beat = FALSE /\ (PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>)))
OpenNext == \E n \in 0..N - 1 : \E i \in {Alphabet[n]} : PlcScan(i) /\ in' = n /\ beat' = ~beat
OpenSpec == OpenInit /\ [][OpenNext]_<<plc, step, in, beat>>

Scanned == Alphabet[in']
\* For a reader of a trace: what a scan found on the wires and what stands on them after it
Wires == Wire(Alphabet[in]) @@ PlcOutputs
\* EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26: a word only ever becomes what its source is in that scan
CopiesUnchanged ==
    [][/\ ReadAuthorization' \in {ReadAuthorization, Scanned.MW01} /\ MW03' \in {MW03, Scanned.SelectMSO}
       /\ CheckMSO' \in {CheckMSO, Scanned.MW05} /\ MW07' \in {MW07, Scanned.SwitchMSO}]_beat
\* EKS-GP-3: there is no input to which a scan has no answer
EveryScanIsAnswered == \A n \in 0..N - 1 : ENABLED PlcScan(Alphabet[n])
\* EKS-GP-5: before the first copy all words are zero
PowerUpIsSafe == step = "" => ReadAuthorization = 0 /\ MW03 = 0 /\ CheckMSO = 0 /\ MW07 = 0
\* What the note has after each copy
Following == [CopyReadAuthorization |-> "CopyMW03", CopyMW03 |-> "CopyCheckMSO",
              CopyCheckMSO |-> "CopyMW07", CopyMW07 |-> "CopyReadAuthorization"]
\* EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26, EKS-3-4-PLC, EKS-9-4-PLC: where the order is fixed, the copies follow
\* one another as the steps of the note do, from the first on; only that may come at any time
CopiesTakeTurns ==
    [][~ANY_ORDER =>
        /\ step' \in {"CopyReadAuthorization", IF step = "" THEN "CopyReadAuthorization" ELSE turn}
        /\ turn' = Following[step']]_beat
\* EKS-3-1-PLC, EKS-3-4-PLC, EKS-9-1-PLC, EKS-9-4-PLC, EKS-GP-4, E-08: where ReadAuthorization is no longer MW01
\* it is copied again before any other word; where it is, no turn is skipped
LevelGoesFirst ==
    [][~ANY_ORDER =>
        IF ReadAuthorization = Scanned.MW01
        THEN step' = "CopyReadAuthorization" => turn = "CopyReadAuthorization"
        ELSE step' = "CopyReadAuthorization"]_beat
=============================================================================
