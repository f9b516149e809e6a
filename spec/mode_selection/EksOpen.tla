------------------------------ MODULE EksOpen -------------------------------
(***************************************************************************)
(* The EKS alone, with any of a set of keys in the reader in every scan:   *)
(* the graph that refimpl's EKS is compared with.  One key for each way in *)
(* which a key can be right or wrong, two that differ in KeyID only.       *)
(* Leaves out every other device.                                          *)
(***************************************************************************)
EXTENDS Sequences, FiniteSets, TLC, Eks

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges
VARIABLES in,           \* the number of the last scan's input; hidden by VIEW
          beat,         \* changes in every scan, so that no scan escapes an action property; hidden by VIEW
          lasted        \* ticks that this half of the test pulse has lasted, by the outputs alone; hidden too

View == eks

RightCRC == \h1234      \* what the device calculates for every key of this model
Key(os, level, code, crc, id) ==
    [operating_state |-> os, authorization_level |-> level, access_code |-> code,
     KEYCRC |-> crc, KeyID |-> id]
\* The device is set to OPERATING_STATE and DIP switches 0000000011
Good(level, id) == Key(OPERATING_STATE, level, 3, RightCRC, id)
KeyTable ==
    (0 :> Good(RE[0], 1) @@ 1 :> Good(RE[1], 1) @@ 2 :> Good(RE[2], 1) @@ 3 :> Good(RE[3], 1)
     @@ 4 :> Good(RE[4], 1)
     @@ 5 :> Good(RE[0], 2)                                    \* another key of the same level
     @@ 6 :> Good(0, 1) @@ 7 :> Good(OtherWord, 1)             \* no level (EKS-KS-8), no word of Table 1
     @@ 8 :> Key(13 - OPERATING_STATE, RE[4], 3, RightCRC, 1)  \* the other operating state
     @@ 9 :> Key(OPERATING_STATE, RE[4], 3, \h1235, 1)         \* wrong checksum
     @@ 10 :> Key(OPERATING_STATE, RE[4], 6, RightCRC, 1)      \* one common bit, not equal
     @@ 11 :> Key(OPERATING_STATE, RE[4], 12, RightCRC, 1)     \* no common bit
     @@ 12 :> Key(OPERATING_STATE, RE[4], 1027, RightCRC, 1))  \* right in ten bits, and one bit more
Calculated == [k \in DOMAIN KeyTable |-> RightCRC]
NK == Cardinality(DOMAIN KeyTable)

\* n: key or none, register check, ticks 0 to 2
N == (NK + 1) * 2 * 3
Alphabet == [n \in 0..N - 1 |->
    [key |-> (n % (NK + 1)) - 1, registers_zero |-> (n \div (NK + 1)) % 2 = 1, dt |-> n \div (2 * (NK + 1))]]

Wire(i) ==
    LET k == IF i.key = None THEN Key(0, 0, 0, 0, 0) ELSE KeyTable[i.key]
    IN  [inserted |-> i.key # None, operating_state |-> k.operating_state,
         authorization_level |-> k.authorization_level, access_code |-> k.access_code, KEYCRC |-> k.KEYCRC,
         KeyID |-> k.KeyID, registers_zero |-> i.registers_zero, dt |-> i.dt]
Row == EksOutputs

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Wire(Alphabet[n])>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit ==
    /\ EksInit /\ step = "" /\ in = 0 /\ beat = FALSE /\ lasted = 0
    /\ (PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>)))
\* All outputs, or none after all: while LA is on and the outputs stand, time goes on
InHalf == LA /\ (Vector = MSO \/ eksState = "TestZeros")
OpenNext ==
    \E n \in 0..N - 1 : \E i \in {Alphabet[n]} :
        /\ EksScan(i) /\ in' = n /\ beat' = ~beat
        /\ lasted' = IF InHalf /\ InHalf' /\ Vector' = Vector THEN lasted + i.dt ELSE 0
OpenSpec == OpenInit /\ [][OpenNext]_<<eks, step, in, beat, lasted>>

Scanned == Alphabet[in']
\* For a reader of a trace: what a scan found in the reader and what stands on the wires after it
Wires == Wire(Alphabet[in]) @@ EksOutputs
\* The keys of the table that are right, told apart from the guard that accepts them
RightKeys == 0..5 \cup (IF OPERATING_STATE = 7 THEN {10} ELSE {})
\* EKS-8-2, EKS-8-5, EKS-SD-2: LA is on only with a right key, and off in the scan in which it is gone or
\* another one is there
LADropsAtOnce ==
    [][/\ LA' => (Scanned.key \in RightKeys /\ Scanned.key = key')
       /\ (LA /\ Scanned.key # key) => ~LA'
       /\ (~LA /\ Vector # {}) => Vector' = {}]_beat
\* EKS-2-10, EKS-4-1, EKS-4-3, E-10: the single output comes only after all outputs and none, with LA
PulseBeforeOutput ==
    [][/\ (Cardinality(Vector') = 1 /\ Vector # Vector') =>
            (eksState = "TestZeros" /\ Vector = {} /\ LA /\ LA')
       /\ (eksState # "TestZeros" /\ eksState' = "TestZeros") => Vector = MSO]_beat
\* EKS-4-2, EKS-4-3: a half of the pulse ends in the first scan in which its time is over, unless the key goes
PulseHalvesLast ==
    [][InHalf /\ Scanned.key = key =>
        (Vector' = Vector /\ InHalf') = (lasted + Scanned.dt < T_PULSE)]_beat
\* EKS-8-4, E-22, E-26: registers that are not zero after a removal are a fault that stays
FaultIsLatched ==
    [][eksState = "Fault" \/ (eksState = "CheckRegisters" /\ ~Scanned.registers_zero) =>
        eksState' = "Fault"]_beat
\* EKS-GP-3: there is no input to which a scan has no answer
EveryScanIsAnswered == \A n \in 0..N - 1 : ENABLED EksScan(Alphabet[n])
\* EKS-8-2, EKS-SD-2: before the first step LA is off and no output is set
PowerUpIsSafe == step = "" => ~LA /\ Vector = {}
=============================================================================
