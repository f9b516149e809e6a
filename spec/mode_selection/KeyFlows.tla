------------------------------ MODULE KeyFlows ------------------------------
(***************************************************************************)
(* The whole of the note: user, EKS, F-PLC, PLC and panel, each taking its *)
(* own scans at its own pace.  Insert steps 1 to 29, removal steps 1 to    *)
(* 18, Figures 2 to 9.  Environment `honest`: every device as in its       *)
(* module, any interleaving, a key that comes, goes or is swapped at any   *)
(* moment, not faster than A-07.                                           *)
(*                                                                         *)
(* Leaves out: how long a scan takes.  A deadline of the F-PLC may expire  *)
(* in any scan (A-09), except that the dwell time is only over when the    *)
(* words that the F-PLC wrote have reached the panel (A-06).               *)
(***************************************************************************)
EXTENDS Eks, Fplc, Plc, Hmi, Sequences, TLC

CONSTANTS
    LEVELS,        \* levels that occur on valid keys
    MERGE_READING, \* TRUE: what the EKS does without a change of LA or an output is no step of its own (A-16)
    BAD_KEY,       \* TRUE: a key with a wrong checksum occurs too
    FAST_SWAP,     \* TRUE: a key may be swapped within one scan of the F-PLC (breaks A-07)
    LATE_WORDS     \* TRUE: the dwell time may be over before the words have arrived (breaks A-06)

VARIABLES
    reader,        \* user: number of the key in the reader, or None
    took,          \* ticks of the scan that was just executed, for readers of a trace; hidden by VIEW
    touched, seen, confirmed    \* history: only the user and the panel set them

ASSUME LEVELS \subseteq MSO

BadKey == 9       \* a key whose checksum is wrong
Keys == LEVELS \cup (IF BAD_KEY THEN {BadKey} ELSE {})
\* As in CodeTables: evaluated once, and named a second time for the cfg
LOCAL Written == [k \in Keys |->
    [operating_state |-> 6, authorization_level |-> RE[IF k = BadKey THEN 4 ELSE k], access_code |-> 1,
     KEYCRC |-> IF k = BadKey THEN 0 ELSE 1, KeyID |-> k]]
LOCAL Ones == [k \in Keys |-> 1]
KeyTable == Written
Calculated == Ones

history == <<touched, seen, confirmed>>
View == <<reader, eks, fplc, plc, hmi, history>>
\* For five levels the active mode is hidden too: one step writes it and none reads it (A-17; with fewer
\* levels it is not hidden)
ViewWithoutMode ==
    <<reader, eks, fplcState, accepted, authority, fplcSelection, fplcElapsed, plc, hmi, history>>
vars == <<View, step, took>>
\* Liveness runs have no VIEW and record nothing
Took(dt) == took' = IF RECORD_STEPS THEN dt ELSE 0

TypeOK ==
    /\ reader \in DOMAIN KEY \cup {None}
    /\ EksTypeOK /\ FplcTypeOK /\ PlcTypeOK /\ HmiTypeOK
    /\ touched \in MSO \cup {None} /\ seen \in MSO \cup {None} /\ confirmed \in MSO \cup {None}

Init ==
    /\ reader = None
    /\ EksInit /\ FplcInit /\ PlcInit /\ HmiInit
    /\ touched = None /\ seen = None /\ confirmed = None
    /\ step = "" /\ took = 0

----------------------------------------------------------------------------
(* The user.                                                               *)

\* EKS-2-1: what was touched, seen and confirmed belongs to the insertion before
InsertKey(k) ==
    /\ reader = None
    /\ reader' = k
    /\ touched' = None /\ seen' = None /\ confirmed' = None
    /\ UNCHANGED <<eks, fplc, plc, hmi>>
    /\ Took(0) /\ Did("InsertKey")
\* EKS-8-1
RemoveKey ==
    /\ reader # None
    /\ reader' = None
    /\ UNCHANGED <<eks, fplc, plc, hmi, history>>
    /\ Took(0) /\ Did("RemoveKey")

----------------------------------------------------------------------------
(* The EKS.                                                                *)

\* A-07: the reader is empty, and LA low, for at least one scan of the EKS and one of the F-PLC between two
\* keys
RemovalNoticed == FAST_SWAP \/ fplcState \in {"Start", "Idle", "Clear", "AwaitZeros", "Error"}
SwapNoticed == FAST_SWAP \/ eksState \in {"Empty", "CheckRegisters"}

\* EKS-KS-1: the device reads its reader; its register check finds zeros (a faulty EKS is another environment)
EksInput(dt) == [key |-> reader, registers_zero |-> TRUE, dt |-> dt]
\* Insert steps 2 to 5 as one, and removal steps 5 and 4 as one: between them LA and the outputs do not change
ReadInOneStep ==
    /\ eksState = "Empty" /\ reader # None
    /\ eksState' = IF KEY[reader].KEYCRC = CHECKSUM[reader] /\ Accepted(reader)
                   THEN "StartTest" ELSE "Rejected"
    /\ key' = reader /\ UNCHANGED eksElapsed
    /\ Did("ReadInOneStep")
Clears ==
    \/ eksState = "ClearOutputs"
    \/ eksState \in Working \ {"Signal"} /\ reader # key
ClearInOneStep == Clears /\ eksState' = "Empty" /\ key' = None /\ eksElapsed' = 0 /\ Did("ClearInOneStep")
CanMerge == (eksState = "Empty" /\ reader # None) \/ Clears
EksRuns ==
    /\ IF MERGE_READING /\ CanMerge THEN (ReadInOneStep \/ ClearInOneStep) /\ Took(0)
       ELSE \E dt \in (IF eksState \in {"TestOnes", "TestZeros"} THEN {0, T_PULSE} ELSE {0}) :
                EksScan(EksInput(dt)) /\ Took(dt)
    /\ eksState' = "StartTest" /\ eksState # "StartTest" => RemovalNoticed
    /\ UNCHANGED <<reader, fplc, plc, hmi, history>>

----------------------------------------------------------------------------
(* The F-PLC.                                                              *)

FplcInput(dt) == [LA |-> LA, vec |-> Vector, MW03 |-> MW03, MW07 |-> MW07, dt |-> dt]

\* A-06, E-52: what the F-PLC wrote has reached the panel, and the panel has begun to react
WordsArrived ==
    /\ ReadAuthorization = MW01 /\ CheckMSO = MW05
    /\ hmiState = "Inhibited" \/ MW01 # 0
\* A-09: time is only let pass in a scan that it makes leave its state; any other time can be put off until
\* then.
\* A deadline may pass whatever has arrived, the dwell time only with the words.
Times == {0} \cup
    (IF fplcState \in Timed THEN {T_REM} ELSE {}) \cup
    (IF fplcState \in {"Start", "Settle", "AwaitZeros", "Error"} /\ (WordsArrived \/ LATE_WORDS)
     THEN {T_DWELL} ELSE {})

FplcRuns ==
    /\ \E dt \in Times : FplcScan(FplcInput(dt)) /\ (dt > 0 => fplcState' # fplcState) /\ Took(dt)
    /\ UNCHANGED <<reader, eks, plc, hmi, history>>

----------------------------------------------------------------------------
(* The PLC: four copies in any order, each a step of its own.              *)

PlcInput == [MW01 |-> MW01, MW05 |-> MW05, SelectMSO |-> SelectMSO, SwitchMSO |-> SwitchMSO]
\* A copy of what is there already changes nothing, and is no step here
PlcRuns ==
    /\ PlcScan(PlcInput)
    /\ plc' # plc
    /\ Took(0)
    /\ UNCHANGED <<reader, eks, fplc, hmi, history>>

----------------------------------------------------------------------------
(* The panel, and the user's finger on it.                                 *)

HmiInput(touch) == [RA |-> ReadAuthorization, CM |-> CheckMSO, touch |-> touch]
\* A finger can only meet a field that is on the screen, unless the screen changes in this very scan
Fields ==
    {""} \cup {Field(m) : m \in Enabled} \cup (IF hmiState = "Confirm" THEN {"confirm", "reject"} ELSE {})

\* EKS-2-14, EKS-2-22, EKS-2-23: what this user did and saw, recorded beside the panel's own memory.
\* An echo of what somebody touched before this key went in is not seen as an answer, and confirming it
\* confirms nothing.
Remember ==
    CASE hmiState' = hmiState -> UNCHANGED history
      [] hmiState = "Select" /\ hmiState' = "AwaitEcho" ->
            touched' = hmiSelection' /\ seen' = None /\ confirmed' = None
      [] hmiState # "Confirm" /\ hmiState' = "Confirm" ->
            seen' = (IF touched = Shown' THEN touched ELSE seen) /\ UNCHANGED <<touched, confirmed>>
      [] hmiState = "Confirm" /\ hmiState' = "AwaitSwitch" -> confirmed' = seen /\ UNCHANGED <<touched, seen>>
      [] OTHER -> UNCHANGED history

PanelRuns ==
    /\ \E touch \in Fields : HmiScan(HmiInput(touch))
    /\ Took(0)
    /\ Remember
    /\ UNCHANGED <<reader, eks, fplc, plc>>

----------------------------------------------------------------------------
(* For a reader of a trace; no run checks anything by these.               *)

\* All that stands on the wires
Wires == EksOutputs @@ FplcOutputs @@ PlcOutputs @@ HmiOutputs
\* What the panel read in the scan that was just executed; the touch is the one that explains it
PanelRead ==
    HmiInput(IF HmiScan(HmiInput("")) THEN "" ELSE CHOOSE touch \in Touches : HmiScan(HmiInput(touch)))

----------------------------------------------------------------------------
User == (SwapNoticed /\ \E k \in DOMAIN KEY : InsertKey(k)) \/ RemoveKey
Next == User \/ EksRuns \/ FplcRuns \/ PlcRuns \/ PanelRuns
Spec == Init /\ [][Next]_vars

----------------------------------------------------------------------------
(* Safety.                                                                 *)

Signalled == IF LA /\ Cardinality(Vector) = 1 THEN CHOOSE l \in Vector : TRUE ELSE None
Switched(m) == step' = "SwitchMode" /\ mode' = {m}      \* also where the mode was active before

\* EKS-2-28, EKS-2-29: here the pair alone; that it came after zeros and an echo is judged in FplcOpen, for
\* any inputs
SwitchNeedsMatchingPair ==
    [][step' = "SwitchMode" => \A m \in MSO : Switched(m) => MW03 = SE[m] /\ MW07 = SW[m]]_View
\* EKS-2-18, EKS-T2-2: by the level signalled, which is the one written on the key that the EKS has read
AuthorizationRespected ==
    [][step' = "SwitchMode" => \A m \in MSO :
        Switched(m) => Permitted(Signalled, m) /\ KEY[key].authorization_level = RE[Signalled]]_View
\* EKS-SD-2, E-42
NoChangeWithoutLA == [][step' = "SwitchMode" \/ mode' # mode => LA]_View
\* EKS-8-8, EKS-SD-7, E-24
NoChangeBesideSwitchover == [][mode' # mode => step' = "SwitchMode"]_View
\* EKS-2-14, EKS-2-22, EKS-2-23, EKS-SD-5: what the user touched, saw and confirmed, since this key went in
UserIntent ==
    [][step' = "SwitchMode" => \A m \in MSO : Switched(m) => touched = m /\ seen = m /\ confirmed = m]_View
\* EKS-2-20, EKS-2-22: the echo is of this user's touch, in this insertion
EchoIsTheTouch == MW05 # 0 /\ LA => MW05 = CH[touched]
\* EKS-8-6 to EKS-8-18, E-17, E-27: a new insertion begins with zero in every word of every device
IdleMeansZeros ==
    (fplcState \in {"Idle", "PulseOnes", "PulseZeros", "OneOutput", "Authorize"}) =>
        /\ MW01 = 0 /\ MW05 = 0 /\ ReadAuthorization = 0 /\ CheckMSO = 0
        /\ SelectMSO = 0 /\ SwitchMSO = 0 /\ MW03 = 0 /\ MW07 = 0 /\ hmiState = "Inhibited"

\* EKS-2-29: the mode whose output is set
ActiveMSO == IF mode = {} THEN None ELSE CHOOSE m \in mode : TRUE
\* EKS-FD-1, EKS-FD-2: the contract that an assessor reads
Contract == INSTANCE ModeSelection WITH level <- Signalled, mode <- ActiveMSO
RefinesModeSelection == Contract!Spec
=============================================================================
