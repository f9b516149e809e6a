--------------------------- MODULE MachineHelper ---------------------------
(***************************************************************************)
(* What somebody does who wants the machine to move in the mode `goal`,    *)
(* scan by scan.  Our own design.  First everything rests: the key is out, *)
(* Stop is held, the door is closed and bolted, the switch is released.    *)
(* Then come two presses of every reset, the key with the highest level,   *)
(* selection and confirmation, a reset, the enable switch where the mode   *)
(* wants it, and Start.                                                    *)
(* Leaves out: a lasting fault; what he does in any other order.           *)
(***************************************************************************)
EXTENDS Integers, TLC

Rest ==
    [LA |-> FALSE, A |-> FALSE, B |-> FALSE, C |-> FALSE, D |-> FALSE, STR |-> FALSE, MW03 |-> 0, MW07 |-> 0,
     S_GuardClosed |-> TRUE, S_GuardBolt |-> TRUE, UnlockButton |-> FALSE, ResetGuard |-> FALSE,
     S_BeamFree |-> TRUE, BeamTest |-> FALSE, ResetBeam |-> FALSE,
     S_Enable1 |-> FALSE, S_Enable2 |-> TRUE, S_Enable3 |-> FALSE, Start |-> FALSE, Stop |-> FALSE,
     S_EmergencyStop |-> TRUE, Reset |-> FALSE, S_Standstill |-> TRUE, S_Contactor1 |-> TRUE, S_Contactor2 |-> TRUE, dt |-> 1]

Resets == [ResetGuard |-> TRUE, ResetBeam |-> TRUE, Reset |-> TRUE]
\* The highest level: it permits every mode (EKS-T2-2)
Key == [LA |-> TRUE, STR |-> TRUE, dt |-> 0]
All == [A |-> TRUE, B |-> TRUE, C |-> TRUE, D |-> TRUE]
\* EKS-T2: MW03 and MW07 of each mode
Selects(goal) == [MW03 |-> <<\h0FF0, \h3333, \h33CC, \h3C3C, \h0F0F>>[goal + 1]]
Confirms(goal) == [MW07 |-> <<\h33CC, \h3C3C, \h0F0F, \h0FF0, \h3333>>[goal + 1]]
Released == [Stop |-> TRUE, LA |-> TRUE, STR |-> TRUE]
\* In its middle position, but in automatic mode
Held(goal) == IF goal = 1 THEN <<>> ELSE [S_Enable1 |-> TRUE, S_Enable2 |-> FALSE, S_Enable3 |-> TRUE]
Moves == [S_Standstill |-> FALSE, S_Contactor1 |-> FALSE, S_Contactor2 |-> FALSE]

Last == 23
\* The inputs of a scan, 1 to Last
Gives(scan, goal) ==
    (CASE scan \in {2, 4} -> Resets
       [] scan = 6 -> [LA |-> TRUE, dt |-> 0]
       [] scan = 7 -> Key @@ All
       [] scan = 8 -> [LA |-> TRUE, dt |-> 0]
       [] scan \in {9, 10} -> Key
       [] scan \in 11..13 -> Key @@ Selects(goal)
       [] scan \in 14..17 -> Key @@ Selects(goal) @@ Confirms(goal)
       [] scan \in {18, 19} -> [LA |-> TRUE, STR |-> TRUE]
       [] scan = 20 -> Released @@ [Reset |-> TRUE]
       [] scan = 21 -> Released @@ Held(goal)
       [] scan = 22 -> Released @@ Held(goal) @@ [Start |-> TRUE]
       [] scan = 23 -> Released @@ Held(goal) @@ Moves
       [] OTHER -> <<>>) @@ Rest
\* He makes up his mind before he selects
Goals(scan, goal) == IF scan = 10 THEN 0..4 ELSE {goal}
============================================================================
