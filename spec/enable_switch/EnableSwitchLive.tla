-------------------------- MODULE EnableSwitchLive ---------------------------
(***************************************************************************)
(* From any state the block enables again: the block is active, the mode   *)
(* is on, the switch works, and a person releases it, presses Reset, and   *)
(* presses the switch halfway, over and over, each for as long as she      *)
(* likes, and with any of the five patterns in between.                    *)
(* Leaves out faults, which EnableSwitchOpen has, and time: a change is    *)
(* over in one tick here.                                                  *)
(***************************************************************************)
EXTENDS EnableSwitch

CONSTANT USER_RESETS     \* FALSE: nobody presses Reset
VARIABLES
    hand,                \* what the person does now
    automatic            \* S_AutoReset; it does not change in operation

Hands == {"release", "reset", "move", "press"}
vars == <<block, step, hand, automatic>>

\* What the channels show: channel 1, 2, 3
Shown(h) == CASE h \in {"release", "reset"} -> {<<FALSE, TRUE, FALSE>>}
              [] h = "press" -> {<<TRUE, FALSE, TRUE>>}
              [] h = "move" ->
                    {c \in BOOLEAN \X BOOLEAN \X BOOLEAN :
                        c \notin {<<FALSE, TRUE, FALSE>>, <<TRUE, FALSE, TRUE>>, <<FALSE, FALSE, FALSE>>}}
Call(h, c) ==
    [Activate |-> TRUE, S_SafetyActive |-> TRUE, S_AutoReset |-> automatic,
     Reset |-> (h = "reset" /\ USER_RESETS), dt |-> 1,
     S_EnableSwitchCh1 |-> c[1], S_EnableSwitchCh2 |-> c[2], S_EnableSwitchCh3 |-> c[3]]

\* She goes on; a movement is over after one call
After(h) == CASE h = "release" -> {"release", "reset"} [] h = "reset" -> {"reset", "move", "press"}
              [] h = "move" -> {"press"} [] h = "press" -> {"press", "release"}

LiveInit ==
    /\ state \in States /\ resetBefore \in BOOLEAN
    /\ elapsed \in IF state \in Timed THEN 0..DiscrepancyTimeCh1_Ch3 - 1 ELSE {0}
    /\ step = "" /\ automatic \in BOOLEAN /\ hand \in Hands
Acts(h) == /\ \E c \in Shown(hand) : \E i \in {Call(hand, c)} : BlockCall(i)
           /\ hand' = h /\ UNCHANGED automatic
LiveNext == \E h \in After(hand) : Acts(h)
\* She does each of these some time
GoesOn == \E h \in After(hand) \ {hand} : Acts(h)
LiveSpec == LiveInit /\ [][LiveNext]_vars /\ WF_vars(GoesOn)

\* ES-SEQ-5, ES-SEQ-6, ES-SEQ-9, ES-RESTART: from any state, again and again
EnablesAgain == []<>S_EnableSwitchOut
=============================================================================
