---------------------- MODULE TestableSafetySensorField ----------------------
(***************************************************************************)
(* The block with its sensor, and people who may step into the field.      *)
(* What a test masks: the block sees a dark sensor, and cannot tell the    *)
(* answer to its test from a person.  The three phases of a test, and      *)
(* what the text leaves to the user.                                       *)
(* The sensor is dark while somebody is in the field; in a test it may     *)
(* answer in any call, or late; a sender that is stuck never answers.      *)
(* Leaves out: inputs that change besides (TestableSafetySensorOpen), and  *)
(* the way from the field to the hazard.                                   *)
(***************************************************************************)
EXTENDS TestableSafetySensor

CONSTANT QUIET     \* TRUE: nobody is in the field during a test (TSSA-04)

VARIABLES
    stuck,         \* the sender of the sensor cannot be switched off
    inField,       \* ms for which somebody has been in the field, as calls see it; -1 for nobody
    shown,         \* S_OSSD_Out was FALSE since this person came
    wires          \* the inputs of the last call; hidden by VIEW

FieldView == <<block, stuck, inField, shown>>
ASSUME QUIET \in BOOLEAN

FieldInit ==
    /\ SensorInit /\ step = "" /\ stuck \in BOOLEAN /\ inField = -1 /\ shown = TRUE
    /\ wires = [Activate |-> FALSE, S_OSSD_In |-> FALSE, StartTest |-> FALSE, NoExternalTest |-> TRUE,
                S_StartReset |-> FALSE, S_AutoReset |-> FALSE, Reset |-> FALSE, dt |-> 0]

\* TSS-TEST-2, TSS-TEST-3: what the sensor may show
Shows(person) == IF person THEN {FALSE} ELSE IF stuck \/ state \notin Testing THEN {TRUE} ELSE BOOLEAN
People == IF QUIET /\ state \in Testing THEN {FALSE} ELSE BOOLEAN
LongEnough == TEST_TIME + 1
FieldCall ==
    \E person \in People : \E free \in Shows(person) :
    \E start \in BOOLEAN : \E reset \in BOOLEAN : \E dt \in 0..TEST_TIME :
        /\ wires' = [Activate |-> TRUE, S_OSSD_In |-> free, StartTest |-> start, NoExternalTest |-> TRUE,
                     S_StartReset |-> FALSE, S_AutoReset |-> FALSE, Reset |-> reset, dt |-> dt]
        /\ SensorScan(wires')
        /\ inField' = IF ~person THEN -1 ELSE IF inField < 0 THEN 0 ELSE Counted(inField, dt, LongEnough)
        /\ shown' = (~person \/ ~Rows[state'].S_OSSD_Out \/ (inField >= 0 /\ shown))
        /\ UNCHANGED stuck
FieldSpec == FieldInit /\ [][FieldCall]_<<FieldView, step, wires>>
\* For a reader of a trace
FieldWires == wires @@ SensorOutputs
FieldRead == wires'

\* TSS-FN-1, TSS-FN-5, TSS-FN-7, TSSF-09: who stays in the field for TestTime stops the machine, whatever test
\* runs
PersonStopsMachine == inField >= TEST_TIME => ~SensorOutputs.S_OSSD_Out
\* TSS-FN-1, TSS-OUT-OSSD, TSSF-09: who was in the field has stopped the machine
EveryPersonIsShown == [][inField >= 0 /\ inField' < 0 => shown]_<<FieldView, step, wires>>
\* TSS-FN-6C, TSS-OUT-EXECUTED, TSSF-09: a sensor that does not react to its test does not pass it
StuckSenderFails == stuck => ~SensorOutputs.TestExecuted
=============================================================================
