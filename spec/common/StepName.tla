------------------------------ MODULE StepName ------------------------------
(***************************************************************************)
(* A history variable: the name of the step that was just executed.  Only  *)
(* the step itself sets it, so a name that is seen is a step that fired.   *)
(* Nothing reads it.  Safety runs hide it by VIEW; liveness runs must not, *)
(* so there it is switched off by RECORD_STEPS.                            *)
(***************************************************************************)
CONSTANT RECORD_STEPS
VARIABLE step

ASSUME RECORD_STEPS \in BOOLEAN

Did(name) == step' = IF RECORD_STEPS THEN name ELSE ""
=============================================================================
