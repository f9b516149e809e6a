------------------------------- MODULE Sluice -------------------------------
(***************************************************************************)
(* Gate, beacon and whoever requests, in any interleaving.  What a device  *)
(* sends stands there for the other until it sends again.                  *)
(***************************************************************************)
EXTENDS TLC, Gate, Beacon

VARIABLES request, ticks    \* what the gate read in its last scan; nothing reads them
vars == <<gate, beaconState, request, ticks, step>>
View == <<gate, beaconState>>

Init == GateInit /\ BeaconInit /\ request = FALSE /\ ticks = 0 /\ step = ""
GateRuns ==
    \E r \in BOOLEAN : \E t \in 0..1 :
        /\ GateScan([OpenRequest |-> r, BeaconLit |-> BeaconOutputs.BeaconLit, dt |-> t])
        /\ request' = r /\ ticks' = t /\ UNCHANGED beaconState
BeaconRuns == BeaconScan([BeaconCall |-> GateOutputs.BeaconCall]) /\ UNCHANGED <<gate, request, ticks>>
Next == GateRuns \/ BeaconRuns
Spec == Init /\ [][Next]_vars

\* SL-2-1, SL-1-3
OpensOverBeacon == [][step' = "OpenGate" => BeaconOutputs.BeaconLit]_vars
PrintWitness == step = "OpenGate" => PrintT(ToString(<<"REACHED", "the gate opens">>))

\* For a reader of a trace: what stands on the wires, and what each device read
Wires == GateOutputs @@ BeaconOutputs @@ [OpenRequest |-> request, dt |-> ticks]
GateRead == [OpenRequest |-> request', BeaconLit |-> BeaconOutputs.BeaconLit, dt |-> ticks']
BeaconRead == [BeaconCall |-> GateOutputs.BeaconCall]
=============================================================================
