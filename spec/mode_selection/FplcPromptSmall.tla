-------------------------- MODULE FplcPromptSmall --------------------------
(* FplcPrompt where only the inputs of FplcSmall are tried.  For planted faults. *)
EXTENDS FplcSmall, FplcPrompt
=============================================================================
