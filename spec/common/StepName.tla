------------------------------ MODULE StepName ------------------------------
(***************************************************************************)
(* A history variable: the name of the step that was just executed.  Only  *)
(* the step itself sets it, so a name that is seen is a step that fired.   *)
(* No action reads it.  A property reads step', or asks whether step is    *)
(* still "" as at power-up.  So a VIEW may hide it in safety runs: TLC     *)
(* judges every step that it makes, also one into a state that it knows,   *)
(* and initial states come first.  Liveness runs must not have a VIEW, so  *)
(* there it is switched off by RECORD_STEPS.                               *)
(***************************************************************************)
CONSTANT RECORD_STEPS
VARIABLE step

ASSUME RECORD_STEPS \in BOOLEAN

Did(name) == step' = IF RECORD_STEPS THEN name ELSE ""
=============================================================================
