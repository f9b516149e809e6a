----------------------------- MODULE EksPrompt ------------------------------
(***************************************************************************)
(* The EKS alone, as in EksOpen: the order of its steps, what it rejects   *)
(* and latches and for what cause, and what it forgets.                    *)
(***************************************************************************)
EXTENDS EksOpen

Held == {"Empty", "TestOnes", "TestZeros", "Signal", "Rejected", "Fault"}
Order ==
    {<<s, s>> : s \in Held}
    \cup {<<"Empty", "Read">>, <<"Read", "CheckChecksum">>, <<"CheckChecksum", "CheckLevel">>,
          <<"CheckLevel", "SetLA">>, <<"SetLA", "StartTest">>, <<"StartTest", "TestOnes">>,
          <<"TestOnes", "TestZeros">>, <<"TestZeros", "Signal">>}
    \cup {<<"CheckChecksum", "Rejected">>, <<"CheckLevel", "Rejected">>}
    \cup {<<"Signal", "ClearOutputs">>, <<"ClearOutputs", "CheckRegisters">>,
          <<"CheckRegisters", "Empty">>, <<"CheckRegisters", "Fault">>}
    \cup {<<s, "CheckRegisters">> : s \in Working \ {"Signal"}}
\* EKS-2-1, EKS-2-2, EKS-2-3, EKS-2-4, EKS-2-5, EKS-2-7, EKS-2-10, EKS-8-1, EKS-8-4, EKS-8-5: no step is left
\* out
ReaderStepsInOrder == [][(<<eksState, eksState'>> \in Order)]_beat

\* EKS-2-5, EKS-2-10, E-40: LA stands before the first output does
LABeforeOutputs == [][Vector = {} /\ Vector' # {} => LA]_beat

\* EKS-2-3, EKS-2-4, EKS-KS-1, EKS-KS-2, EKS-KS-3, EKS-KS-4: no key that is right is rejected
RightKeysPass == [][eksState # "Rejected" /\ eksState' = "Rejected" => key \notin RightKeys]_beat

\* EKS-8-4, E-22, E-26: the latched fault has a cause
FaultNeedsCause ==
    [][eksState # "Fault" /\ eksState' = "Fault" =>
        eksState = "CheckRegisters" /\ ~Scanned.registers_zero]_beat

\* EKS-8-1, EKS-8-5: the reader remembers a key while that is in the reader, and time while the test pulse
\* runs
KeyIsForgotten ==
    /\ (key # None) = (eksState \in Working \cup {"ClearOutputs"})
    /\ eksElapsed # 0 => eksState \in {"TestOnes", "TestZeros"}

\* EKS-GP-3, EKS-2-1, EKS-4-2, EKS-4-3, EKS-8-1: a scan that changes nothing has seen nothing that it waits
\* for
ReaderAnswersAtOnce ==
    [][eks' = eks =>
        CASE eksState = "Empty" -> Scanned.key = None
          [] eksState \in {"Signal", "Rejected"} -> Scanned.key = key
          [] eksState \in {"TestOnes", "TestZeros"} -> Scanned.key = key /\ Scanned.dt = 0
          [] eksState = "Fault" -> TRUE
          [] OTHER -> FALSE]_beat
=============================================================================
