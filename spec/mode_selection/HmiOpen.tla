------------------------------ MODULE HmiOpen -------------------------------
(***************************************************************************)
(* The panel alone, with any words on the bus and any touch in every scan: *)
(* the graph that implementations of target hmi are compared with.         *)
(* Leaves out every other device.                                          *)
(***************************************************************************)
EXTENDS Sequences, TLC, Hmi

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges
VARIABLES in,           \* the number of the last scan's input; hidden by VIEW
          beat          \* changes in every scan, so that no scan escapes an action property; hidden by VIEW

View == hmi

Words == <<0, RE[0], RE[1], RE[2], RE[3], RE[4], OtherWord>>
TouchSeq == <<"", "select:0", "select:1", "select:2", "select:3", "select:4", "confirm", "reject">>
Modes == <<None, 0, 1, 2, 3, 4>>      \* EKS-8-8: the active mode is displayed, it decides nothing
N == 7 * 7 * 8 * 6
Alphabet == [n \in 0..N - 1 |->
    [RA |-> Words[(n % 7) + 1], CM |-> Words[((n \div 7) % 7) + 1], touch |-> TouchSeq[((n \div 49) % 8) + 1],
     ActiveMSO |-> Modes[(n \div 392) + 1]]]

Wire(i) ==
    [ReadAuthorization |-> i.RA, CheckMSO |-> i.CM, ActiveMSO |-> i.ActiveMSO, touch |-> i.touch, dt |-> 1]
Row == HmiOutputs

ASSUME \A t \in Touches : \E n \in 1..8 : TouchSeq[n] = t
ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit ==
    HmiInit /\ step = "" /\ in = 0 /\ beat = FALSE /\ (PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>)))
OpenNext == \E n \in 0..N - 1 : \E i \in {Alphabet[n]} : HmiScan(i) /\ in' = n /\ beat' = ~beat
OpenSpec == OpenInit /\ [][OpenNext]_<<hmi, step, in, beat>>

Scanned == Alphabet[in']
\* For a reader of a trace: what a scan found on the wires and what stands on them after it
Wires == Wire(Alphabet[in]) @@ HmiOutputs
\* EKS-2-14, EKS-8-8, EKS-SD-3, EKS-SD-4, E-57: the screen opens without an old echo; no selection without
\* authorization on the bus, none beyond it
SelectionNeedsEnable ==
    [][/\ SelectMSO' # 0 => Permitted(ModeOf(RE, Scanned.RA), ModeOf(SE, SelectMSO'))
       /\ (hmiState = "Inhibited" /\ hmiState' # "Inhibited") => Scanned.CM = 0]_beat
\* EKS-2-14, EKS-2-15, E-20, E-60: every selection that is sent was touched in that scan, on a screen that
\* offered it
SelectionNeedsTouch ==
    [][SelectMSO' \notin {0, SelectMSO} =>
        (\E m \in Enabled : SelectMSO' = SE[m] /\ Scanned.touch = Field(m))]_beat
\* EKS-2-22, EKS-2-23, EKS-2-24, EKS-SD-5: the acknowledgment is sent after the echo was on the screen and was
\* touched
AcknowledgmentNeedsConfirm ==
    [][(SwitchMSO' # 0 /\ SwitchMSO' # SwitchMSO) =>
        /\ hmiState = "Confirm" /\ Scanned.touch = "confirm"
        /\ ModeOf(CH, Scanned.CM) = ModeOf(SW, SwitchMSO') /\ Shown = ModeOf(SW, SwitchMSO')]_beat
\* EKS-3-1-HMI, EKS-3-4-HMI, EKS-8-9, EKS-8-16: without authorization both words are zero in that very scan
InhibitAtOnce ==
    [][ModeOf(RE, Scanned.RA) = None => (SelectMSO' = 0 /\ SwitchMSO' = 0 /\ Enabled' = {})]_beat
\* EKS-GP-3: there is no input to which a scan has no answer
EveryScanIsAnswered == \A n \in 0..N - 1 : ENABLED HmiScan(Alphabet[n])
\* EKS-8-8, EKS-8-9: before the first step the panel is inhibited and sends zeros
PowerUpIsSafe == step = "" => SelectMSO = 0 /\ SwitchMSO = 0 /\ Enabled = {}
=============================================================================
