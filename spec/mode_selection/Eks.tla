-------------------------------- MODULE Eks ---------------------------------
(***************************************************************************)
(* The EKS Light FSA: key structure (bytes 109 to 123), insert steps 1 to  *)
(* 5, 7, 9, 10, the device's side of Figure 4, removal steps 1, 2, 4, 5.   *)
(* One step is one scan.  i = [key, registers_zero, dt]: the number of the *)
(* key in the reader or None, the result of the device's own register      *)
(* check, ticks.                                                           *)
(* Leaves out: the checksum algorithm, which is not public; a key only has *)
(* a right or a wrong KEYCRC (assumption A-14).  What KEY[n] holds is told *)
(* by whoever instantiates this module.                                    *)
(***************************************************************************)
EXTENDS Integers, CodeTables, StepName

CONSTANTS
    KEY,       \* number -> [operating_state, authorization_level, access_code, KEYCRC, KeyID]
    OPERATING_STATE, DIP_SWITCHES,   \* set on the device
    CHECKSUM,  \* number -> what the device calculates for that key
    T_PULSE    \* ticks of each half of the test pulse

ASSUME OPERATING_STATE \in {6, 7} /\ DIP_SWITCHES \in 0..1023   \* EKS-KS-2
ASSUME T_PULSE \in Nat \ {0}

VARIABLES
    eksState,    \* the step that is executed next
    key,         \* number of the key as read, or None
    eksElapsed   \* ticks in this half of the pulse

eks == <<eksState, key, eksElapsed>>

Working == {"Read", "CheckChecksum", "CheckLevel", "SetLA",
            "StartTest", "TestOnes", "TestZeros", "Signal", "Rejected"}
EksStates == {"Empty", "ClearOutputs", "CheckRegisters", "Fault"} \cup Working

EksTypeOK == eksState \in EksStates /\ key \in DOMAIN KEY \cup {None} /\ eksElapsed \in 0..T_PULSE

EksInit == eksState = "Empty" /\ key = None /\ eksElapsed = 0

----------------------------------------------------------------------------
\* EKS-2-5, EKS-8-2, EKS-SD-2
LA == eksState \in {"StartTest", "TestOnes", "TestZeros", "Signal"}
KeyLevel(k) == ModeOf(RE, KEY[k].authorization_level)
\* EKS-2-7, EKS-2-10, EKS-KS-5, EKS-T2, EKS-SD-1, E-02: all in the pulse, then the one of the level
Vector == CASE eksState = "TestOnes" -> MSO
            [] eksState \in {"Signal", "ClearOutputs"} -> {KeyLevel(key)} \cap MSO
            [] OTHER -> {}
\* The outputs by their names
EksOutputs == [LA |-> LA, A |-> 0 \in Vector, B |-> 1 \in Vector, C |-> 2 \in Vector, D |-> 3 \in Vector,
               STR |-> 4 \in Vector]

----------------------------------------------------------------------------
LOCAL Bit(word, b) == (word \div (2^b)) % 2 = 1
\* EKS-KS-1, EKS-KS-3, EKS-KS-4, E-48: state 6 wants equal codes, state 7 one common bit
AccessCodeAccepted(code) ==
    IF OPERATING_STATE = 6 THEN code = DIP_SWITCHES
    ELSE code \in 0..1023 /\ {b \in 0..9 : Bit(code, b) /\ Bit(DIP_SWITCHES, b)} # {}
\* EKS-KS-2, E-67
AccessAccepted(k) == KEY[k].operating_state = OPERATING_STATE /\ AccessCodeAccepted(KEY[k].access_code)
\* EKS-2-4, EKS-KS-5, EKS-KS-8, EKS-T1, E-25e
LevelAccepted(k) == KeyLevel(k) # None
Accepted(k) == AccessAccepted(k) /\ LevelAccepted(k)

LOCAL Taken(i) == eksState \in Working /\ i.key # key
LOCAL At(s, i) == eksState = s /\ ~Taken(i)
LOCAL GoTo(s) == eksState' = s /\ eksElapsed' = 0 /\ UNCHANGED key
LOCAL Stay == UNCHANGED eks
LOCAL Over(i) == eksElapsed + i.dt >= T_PULSE
LOCAL Hold(i) == eksState' = eksState /\ eksElapsed' = eksElapsed + i.dt /\ UNCHANGED key

\* EKS-8-1
AwaitInsertion(i) == eksState = "Empty" /\ i.key = None /\ Stay /\ Did("AwaitInsertion")
\* EKS-2-1
SeeInsertion(i) ==
    /\ eksState = "Empty" /\ i.key # None
    /\ eksState' = "Read" /\ key' = i.key /\ eksElapsed' = 0
    /\ Did("SeeInsertion")
\* EKS-2-2, EKS-KS-1
ReadKey(i) == At("Read", i) /\ GoTo("CheckChecksum") /\ Did("ReadKey")
\* EKS-2-3, EKS-KS-7
AcceptChecksum(i) ==
    At("CheckChecksum", i) /\ KEY[key].KEYCRC = CHECKSUM[key] /\ GoTo("CheckLevel") /\ Did("AcceptChecksum")
\* EKS-2-3, EKS-2-9, E-25d
RefuseChecksum(i) ==
    At("CheckChecksum", i) /\ KEY[key].KEYCRC # CHECKSUM[key] /\ GoTo("Rejected") /\ Did("RefuseChecksum")
\* EKS-2-4, EKS-KS-2, EKS-KS-3, EKS-KS-4
AcceptLevel(i) == At("CheckLevel", i) /\ Accepted(key) /\ GoTo("SetLA") /\ Did("AcceptLevel")
\* EKS-2-4, EKS-2-9, EKS-KS-8, E-25e
RefuseLevel(i) == At("CheckLevel", i) /\ ~Accepted(key) /\ GoTo("Rejected") /\ Did("RefuseLevel")
\* EKS-2-5, E-40: LA comes before the pulse
RaiseLA(i) == At("SetLA", i) /\ GoTo("StartTest") /\ Did("RaiseLA")
\* EKS-2-10, EKS-4-1, E-10
StartOnes(i) == At("StartTest", i) /\ GoTo("TestOnes") /\ Did("StartOnes")
\* EKS-4-2
HoldOnes(i) == At("TestOnes", i) /\ ~Over(i) /\ Hold(i) /\ Did("HoldOnes")
\* EKS-4-2, EKS-4-3
StartZeros(i) == At("TestOnes", i) /\ Over(i) /\ GoTo("TestZeros") /\ Did("StartZeros")
\* EKS-4-3, E-39
HoldZeros(i) == At("TestZeros", i) /\ ~Over(i) /\ Hold(i) /\ Did("HoldZeros")
\* EKS-2-7, EKS-2-10, EKS-4-5, EKS-KS-5
SetOneOutput(i) == At("TestZeros", i) /\ Over(i) /\ GoTo("Signal") /\ Did("SetOneOutput")
\* EKS-2-7
HoldOneOutput(i) == At("Signal", i) /\ Stay /\ Did("HoldOneOutput")
\* EKS-2-9
StayRejected(i) == At("Rejected", i) /\ Stay /\ Did("StayRejected")

\* EKS-8-1, EKS-8-2, E-58: LA drops at once; a running pulse is broken off in the same scan
SeeRemoval(i) ==
    /\ Taken(i)
    /\ IF eksState = "Signal" THEN GoTo("ClearOutputs")
       ELSE eksState' = "CheckRegisters" /\ eksElapsed' = 0 /\ key' = None
    /\ Did("SeeRemoval")
\* EKS-8-5, EKS-SD-8, E-26, E-62: first cleared, then checked
ResetOutputs(i) ==
    /\ eksState = "ClearOutputs"
    /\ eksState' = "CheckRegisters" /\ eksElapsed' = 0 /\ key' = None
    /\ Did("ResetOutputs")
\* EKS-8-4, E-26
PassRegisterCheck(i) ==
    eksState = "CheckRegisters" /\ i.registers_zero /\ GoTo("Empty") /\ Did("PassRegisterCheck")
\* EKS-8-4, E-22, E-26
LatchFault(i) == eksState = "CheckRegisters" /\ ~i.registers_zero /\ GoTo("Fault") /\ Did("LatchFault")
\* EKS-8-4
StayInFault(i) == eksState = "Fault" /\ Stay /\ Did("StayInFault")

\* EKS-GP-3: grouped by the states in which the steps can fire
EksScan(i) ==
    \/ SeeRemoval(i)
    \/ eksState = "Empty" /\ (AwaitInsertion(i) \/ SeeInsertion(i))
    \/ eksState = "Read" /\ ReadKey(i)
    \/ eksState = "CheckChecksum" /\ (AcceptChecksum(i) \/ RefuseChecksum(i))
    \/ eksState = "CheckLevel" /\ (AcceptLevel(i) \/ RefuseLevel(i))
    \/ eksState \in {"SetLA", "StartTest"} /\ (RaiseLA(i) \/ StartOnes(i))
    \/ /\ eksState \in {"TestOnes", "TestZeros"}
       /\ HoldOnes(i) \/ StartZeros(i) \/ HoldZeros(i) \/ SetOneOutput(i)
    \/ eksState \in {"Signal", "Rejected"} /\ (HoldOneOutput(i) \/ StayRejected(i))
    \/ /\ eksState \in {"ClearOutputs", "CheckRegisters"}
       /\ ResetOutputs(i) \/ PassRegisterCheck(i) \/ LatchFault(i)
    \/ eksState = "Fault" /\ StayInFault(i)

----------------------------------------------------------------------------
(* What the EKS promises whatever is put into the reader.                  *)

\* EKS-KS-5, EKS-2-10: outside its test pulse the EKS sets at most one output
OneOutputOutsideThePulse == eksState # "TestOnes" => \A a, b \in Vector : a = b
\* EKS-2-3, EKS-2-9, EKS-8-5, EKS-SD-2: without LA no output, but for the scan between removal steps 2 and 5
NoOutputWithoutLA == ~LA /\ eksState # "ClearOutputs" => Vector = {}
\* EKS-2-4, EKS-2-5, EKS-2-7, EKS-KS-7, EKS-T1, EKS-T2: LA says that the key passed every check, the output
\* what is written on it
LAOnlyForAcceptedKeys ==
    /\ LA => /\ KEY[key].KEYCRC = CHECKSUM[key] /\ KEY[key].operating_state = OPERATING_STATE
             /\ AccessCodeAccepted(KEY[key].access_code) /\ KeyLevel(key) # None
    /\ eksState = "Signal" => \A l \in MSO : (l \in Vector) = (RE[l] = KEY[key].authorization_level)
=============================================================================
