-------------------------------- MODULE Gate --------------------------------
(***************************************************************************)
(* The gate of the sluice.  i = [OpenRequest, BeaconLit, dt]: two Booleans, and the  *)
(* ticks since the scan before.  Leaves out how the motor moves it.        *)
(***************************************************************************)
EXTENDS Integers, StepName

CONSTANTS
    T_OPEN      \* ticks for which the gate is open
VARIABLES
    gateState,  \* Shut, Calling or Open
    elapsed     \* ticks since the gate opened

gate == <<gateState, elapsed>>

GateOutputs == [BeaconCall |-> gateState # "Shut", GateMotor |-> gateState = "Open"]
GateTypeOK == gateState \in {"Shut", "Calling", "Open"} /\ elapsed \in 0..T_OPEN
GateInit == gateState = "Shut" /\ elapsed = 0
\* SL-1-1, SL-1-4: what the gate shows is what it does
MotorOnlyOpen == (GateOutputs.GateMotor => gateState = "Open") /\ (GateOutputs.BeaconCall => gateState \in {"Calling", "Open"})

\* SL-1-3, SLF-01: the gate waits for the beacon
Ready(i) == i.BeaconLit

\* SL-1-1
StayShut(i) == gateState = "Shut" /\ ~i.OpenRequest /\ UNCHANGED gate /\ Did("StayShut")
\* SL-1-1
CallBeacon(i) == gateState = "Shut" /\ i.OpenRequest /\ gateState' = "Calling" /\ UNCHANGED elapsed /\ Did("CallBeacon")
\* SL-1-3, SLF-01
AwaitBeacon(i) == gateState = "Calling" /\ ~Ready(i) /\ UNCHANGED gate /\ Did("AwaitBeacon")
\* SL-1-3, SLF-01
OpenGate(i) == gateState = "Calling" /\ Ready(i) /\ gateState' = "Open" /\ UNCHANGED elapsed /\ Did("OpenGate")
\* SL-1-4
StayOpen(i) ==
    /\ gateState = "Open" /\ elapsed + i.dt < T_OPEN
    /\ elapsed' = elapsed + i.dt /\ UNCHANGED gateState /\ Did("StayOpen")
\* SL-1-4
ShutGate(i) == gateState = "Open" /\ elapsed + i.dt >= T_OPEN /\ gateState' = "Shut" /\ elapsed' = 0 /\ Did("ShutGate")

GateScan(i) == StayShut(i) \/ CallBeacon(i) \/ AwaitBeacon(i) \/ OpenGate(i) \/ StayOpen(i) \/ ShutGate(i)
=============================================================================
