------------------------------- MODULE Beacon -------------------------------
(***************************************************************************)
(* The beacon of the sluice: lit while it is called.  i = [BeaconCall], a        *)
(* Boolean.  Leaves out the colour.                                        *)
(***************************************************************************)
EXTENDS Integers, StepName

VARIABLE beaconState    \* Dark or Lit

BeaconOutputs == [BeaconLit |-> beaconState = "Lit", LAMP_CODE |-> IF beaconState = "Lit" THEN 43690 ELSE 0]
BeaconTypeOK == beaconState \in {"Dark", "Lit"}
BeaconInit == beaconState = "Dark"

\* SL-1-2
StayDark(i) == beaconState = "Dark" /\ ~i.BeaconCall /\ UNCHANGED beaconState /\ Did("StayDark")
\* SL-1-2
LightUp(i) == beaconState = "Dark" /\ i.BeaconCall /\ beaconState' = "Lit" /\ Did("LightUp")
\* SL-1-2
StayLit(i) == beaconState = "Lit" /\ i.BeaconCall /\ UNCHANGED beaconState /\ Did("StayLit")
\* SL-1-2, SLF-02
GoDark(i) == beaconState = "Lit" /\ ~i.BeaconCall /\ beaconState' = "Dark" /\ Did("GoDark")

BeaconScan(i) == StayDark(i) \/ LightUp(i) \/ StayLit(i) \/ GoDark(i)
=============================================================================
