------------------------ MODULE EnableSwitchOrder -------------------------
(***************************************************************************)
(* The block alone, as in EnableSwitchOpen, watched over many calls: in *)
(* which order the stages came, and how long the channels disagreed.  What *)
(* is remembered here is taken from inputs and outputs, not from the       *)
(* block's memory.                                                         *)
(* Leaves out the graph, which EnableSwitchOpen prints.                 *)
(***************************************************************************)
EXTENDS EnableSwitchOpen

VARIABLES
    lastStage,    \* the last stage that an active block without error saw in this run of the mode; -1: none
    apart,        \* ticks for which channels 1 and 3 have differed by now; -1 where they do not
    contrary,     \* ticks for which all three channels have been TRUE by now; -1 where they are not
    lastReset     \* Reset in the call before this one

None == -1
ViewWithHistory == <<block, lastStage, apart, contrary, lastReset>>

Stage(i) ==
    LET channels == <<i.S_EnableSwitchCh1, i.S_EnableSwitchCh2, i.S_EnableSwitchCh3>>
    IN  CASE channels = <<FALSE, TRUE, FALSE>> -> 0
          [] channels = <<TRUE, FALSE, TRUE>> -> 1
          [] channels = <<FALSE, FALSE, FALSE>> -> 2
          [] OTHER -> None

\* A call in which the channels are watched: the block was ready, and in the mode, before it
Watched(i) == Ready /\ DiagCode # 32770 /\ i.Activate /\ i.S_SafetyActive
\* The time of what lasts; it begins with 0, and stops at the limit
Lasted(was, lasts, i) ==
    IF ~lasts THEN None ELSE IF was = None THEN 0 ELSE Counted(was, i.dt, DiscrepancyTimeCh1_Ch3)

OrderInit == OpenInit /\ lastStage = None /\ apart = None /\ contrary = None /\ lastReset = FALSE
Remember(i) ==
    /\ lastStage' = IF ~Watched(i) \/ Error' THEN None ELSE IF Stage(i) = None THEN lastStage ELSE Stage(i)
    /\ apart' = Lasted(apart, Watched(i) /\ i.S_EnableSwitchCh1 # i.S_EnableSwitchCh3, i)
    /\ contrary' = Lasted(contrary, Watched(i) /\ SeesContradiction(i), i)
    /\ lastReset' = i.Reset
OrderNext ==
    \E n \in 0..N - 1 : \E i \in {Alphabet[n]} : BlockCall(i) /\ in' = n /\ beat' = ~beat /\ Remember(i)
OrderSpec == OrderInit /\ [][OrderNext]_<<block, step, in, beat, lastStage, apart, contrary, lastReset>>

----------------------------------------------------------------------------
\* ES-SEQ-6, ES-SEQ-8, ES-SEQ-9, ES-ORDER-2, ESF-02, ESF-03: the enable comes out of stage 0 alone,
\* seen in this run of the mode, since the last error
EnableNeedsStage0 == [][(S_EnableSwitchOut' /\ ~S_EnableSwitchOut) => lastStage = 0]_beat
\* ES-SEQ-3, ESF-04, ESF-07: channels 1 and 3 never differ for the discrepancy time without an error,
\* whichever of them is late
DisagreementEndsInError ==
    [][(apart # None /\ apart' # None /\ apart + Called.dt >= DiscrepancyTimeCh1_Ch3) => Error']_beat
\* ESF-05: channel 2 never contradicts both others for that time without an error
ContradictionEndsInError ==
    [][(contrary # None /\ contrary' # None /\ contrary + Called.dt >= DiscrepancyTimeCh1_Ch3) => Error']_beat
\* ES-SEQ-3, ESF-07: and a call that finds them together again after that time does not enable
EnableComesInTime ==
    [][(apart # None /\ apart + Called.dt >= DiscrepancyTimeCh1_Ch3) => ~S_EnableSwitchOut']_beat
\* ES-SEQ-5, ES-RESTART, ESF-10: only a Reset that was FALSE in the call before resets
HeldResetNeverResets ==
    [][/\ Error /\ ~Error' /\ Called.Activate /\ ~Automatic
       /\ MODE_ENDS_ERROR => Called.S_SafetyActive
       => Called.Reset /\ ~lastReset]_beat
=============================================================================
