---------------------------- MODULE EksAsPrinted ----------------------------
(***************************************************************************)
(* What the note could be taken to say of the EKS, and what we did not     *)
(* decide.  Op_Reading takes the place of Op of Eks where a run tries that *)
(* reading.                                                                *)
(***************************************************************************)
EXTENDS Eks

----------------------------------------------------------------------------
(* NoLevelCheck                                                            *)
\* EKS-2-4, EKS-KS-8, E-25e: step 4 has no negative exit: a key without a level of Table 1 goes on.
LevelAccepted_NoLevelCheck(k) == TRUE

----------------------------------------------------------------------------
(* NoAccessCheck                                                           *)
\* EKS-KS-2, EKS-KS-3, EKS-KS-4, E-67: no step looks at operating state and access code.
AccessAccepted_NoAccessCheck(k) == TRUE

----------------------------------------------------------------------------
(* CheckBeforeClear                                                        *)
\* EKS-8-4, EKS-8-5, E-26: the registers are checked in step 4, before step 5 clears them.
ResetOutputs_CheckBeforeClear(i) ==
    eksState = "ClearOutputs" /\ eksState' = "Fault" /\ eksElapsed' = 0 /\ UNCHANGED key /\ Did("LatchFault")

----------------------------------------------------------------------------
(* PulseBeforeLA                                                           *)
\* EKS-2-5, EKS-2-10, E-40: the pulse comes first, and LA with the output of the level.
LA_PulseBeforeLA == eksState = "Signal"

----------------------------------------------------------------------------
(* PulseRunsOn                                                             *)
\* EKS-8-2, EKS-8-5, E-58: when the key is pulled, a pulse that has begun outlasts LA, until step 5.
EksStates_PulseRunsOn == {"Empty", "ClearOutputs", "CheckRegisters", "Fault", "PulseRunsOn"} \cup Working
Vector_PulseRunsOn ==
    CASE eksState \in {"TestOnes", "PulseRunsOn"} -> MSO
      [] eksState \in {"Signal", "ClearOutputs"} -> {KeyLevel(key)} \cap MSO
      [] OTHER -> {}
SeeRemoval_PulseRunsOn(i) ==
    \/ /\ eksState \in Working /\ i.key # key
       /\ eksElapsed' = 0
       /\ CASE eksState = "Signal" -> eksState' = "ClearOutputs" /\ UNCHANGED key
            [] eksState = "TestOnes" -> eksState' = "PulseRunsOn" /\ UNCHANGED key
            [] OTHER -> eksState' = "CheckRegisters" /\ key' = None
       /\ Did("SeeRemoval")
    \/ /\ eksState = "PulseRunsOn"
       /\ eksState' = "CheckRegisters" /\ eksElapsed' = 0 /\ key' = None
       /\ Did("ResetOutputs")
=============================================================================
