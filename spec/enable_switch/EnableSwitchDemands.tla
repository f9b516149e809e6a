------------------------ MODULE EnableSwitchDemands -------------------------
(***************************************************************************)
(* What the sentences of the page demand of the block, seen from outside:  *)
(* a second reading beside demands.toml, written from the clauses.  The    *)
(* observer reads inputs and the two outputs that the page prints, never   *)
(* the state of the block.  What must never be is judged in the very call, *)
(* as a call reads its inputs at once; what must come has LATENCY calls,   *)
(* and a block may take as many for the activation and for the mode.  A    *)
(* time counts from the last call before a change where it must be         *)
(* granted, from the first call that sees the change where it must not be  *)
(* exceeded, and a time that is just reached is neither (ESF-07).          *)
(* Leaves out what the page leaves open: ES-NOTE-1 and the findings.       *)
(***************************************************************************)
EXTENDS EnableSwitchOpen

CONSTANT LATENCY    \* calls that a block may take for a step
ASSUME LATENCY \in Nat

VARIABLES
    lastReset,      \* Reset in the call before
    still,          \* calls at stage 0 in the mode, since Error changed; with Error only without S_AutoReset
    shown,          \* how far the steps of the sequence have come; "" where it is not what the steps show
    since,          \* ticks since the last call that saw a stage, on the way to the next one
    late,           \* ticks for which channel 3 has not followed channel 1 out of stage 0; -1: it need not
    fromStage0,     \* stage 0 was seen, and after it neither stage 2 nor an error
    gripped,        \* after that stage 0 stage 1 was seen
    through,        \* after that stage 0 all channels are FALSE for so many ticks
    outside,        \* ticks for which the enable has outlived stage 1
    waits           \* of what must come: calls for which it has not

watched == <<lastReset, still, shown, since, late, fromStage0, gripped, through, outside, waits>>
DemandsView == <<block, watched>>

MustCome == {"error", "reset", "enable"}
LOCAL NotYet == -1

DemandsInit ==
    /\ OpenInit
    /\ lastReset = FALSE /\ still = 0 /\ shown = "" /\ since = 0 /\ late = NotYet
    /\ fromStage0 = FALSE /\ gripped = FALSE /\ through = 0 /\ outside = 0
    /\ waits = [m \in MustCome |-> 0]

----------------------------------------------------------------------------
(* What a call shows.                                                      *)

\* ES-STAGE-0, ES-STAGE-1, ES-STAGE-2; -1: none of them
StageIs(n, i) ==
    /\ i.S_EnableSwitchCh1 = (n = 1) /\ i.S_EnableSwitchCh3 = (n = 1)
    /\ i.S_EnableSwitchCh2 = (n = 0)
NoStage(i) == \A n \in 0..2 : ~StageIs(n, i)
\* ES-SEQ-1, ES-SEQ-2
InMode(i) == i.Activate /\ i.S_SafetyActive
\* ES-SEQ-3, ES-SEQ-6: channel 1 is TRUE and channel 2 FALSE, and channel 3 has not followed
Ch3Lags(i) == i.S_EnableSwitchCh1 /\ ~i.S_EnableSwitchCh2 /\ ~i.S_EnableSwitchCh3
\* ES-SEQ-5
Edge(i) == i.Reset /\ ~lastReset

\* Calls at stage 0 by now; the sequence begins there, and so does what a Reset ends
LOCAL Still(i) ==
    IF ~InMode(i) \/ ~StageIs(0, i) \/ (Error' /\ i.S_AutoReset) THEN 0
    ELSE IF Error' # Error THEN 1 ELSE Counted(still, 1, 2 * LATENCY + 1)
AtRest(i) == ~Error' /\ Still(i) > 2 * LATENCY
\* ES-SEQ-6, ES-SEQ-8: a change that no call found under way, or one that has surely not taken the time
WithinTime(i) ==
    \/ since = 0 /\ ~NoStage(i)
    \/ since + i.dt < DiscrepancyTimeCh1_Ch3

\* ES-SEQ-1, ES-SEQ-2, ES-SEQ-6, ES-SEQ-7, ES-SEQ-8, ES-SEQ-9: how far the steps have come with this call, if
\* no error comes: released, closing on the way from stage 0 to 1, pressed, grasped in stage 2, or opening on
\* the way out of stage 1 or 2
Step(i) ==
    IF ~InMode(i) \/ ~WithinTime(i) THEN ""
    ELSE CASE StageIs(0, i) /\ shown # "" -> "released"
           [] StageIs(1, i) /\ shown \in {"released", "closing", "pressed"} -> "pressed"
           [] StageIs(2, i) /\ shown \in {"pressed", "opening", "grasped"} -> "grasped"
           [] Ch3Lags(i) /\ shown \in {"released", "closing"} -> "closing"
           [] NoStage(i) /\ ~i.S_EnableSwitchCh2 /\ shown \in {"pressed", "opening", "grasped"} -> "opening"
           [] OTHER -> ""

----------------------------------------------------------------------------
(* The observer.                                                           *)

LOCAL Missing(m, i) ==
    CASE m = "error" -> late' > DiscrepancyTimeCh1_Ch3 /\ ~Error'
      [] m = "reset" -> still' > 0 /\ Error' /\ ((Edge(i) /\ Error /\ still > LATENCY) \/ waits[m] > 0)
      [] m = "enable" -> shown' = "pressed" /\ ~S_EnableSwitchOut'

Watch(i) ==
    /\ lastReset' = i.Reset
    /\ still' = Still(i)
    /\ shown' = IF Error' THEN "" ELSE IF AtRest(i) THEN "released" ELSE Step(i)
    /\ since' = IF shown' \in {"closing", "opening"} THEN since + i.dt ELSE 0
    /\ late' =
        IF ~InMode(i) \/ ~Ch3Lags(i) \/ Error' THEN NotYet
        ELSE IF late # NotYet THEN Counted(late, i.dt, DiscrepancyTimeCh1_Ch3 + 1)
        ELSE IF shown = "released" THEN 0 ELSE NotYet
    /\ through' =
        IF ~StageIs(2, i) \/ ~fromStage0 THEN 0
        ELSE IF through = 0 THEN 1 ELSE Counted(through, i.dt, DiscrepancyTimeCh1_Ch3 + 2)
    /\ fromStage0' =
        \/ StageIs(0, i)
        \/ /\ fromStage0 /\ ~Error'
           /\ ~(StageIs(2, i) /\ (gripped \/ through' > DiscrepancyTimeCh1_Ch3 + 1))
    /\ gripped' = (fromStage0' /\ ~StageIs(0, i) /\ (gripped \/ StageIs(1, i)))
    /\ outside' = IF S_EnableSwitchOut' /\ ~StageIs(1, i)
                  THEN Counted(outside, i.dt, DiscrepancyTimeCh1_Ch3 + 1) ELSE 0
    /\ waits' = [m \in MustCome |-> IF Missing(m, i) THEN Counted(waits[m], 1, LATENCY + 1) ELSE 0]

DemandsNext ==
    \E n \in 0..N - 1 : \E i \in {Alphabet[n]} :
        BlockCall(i) /\ in' = n /\ beat' = ~beat /\ Watch(i)
DemandsSpec == DemandsInit /\ [][DemandsNext]_<<block, step, in, beat, watched>>

----------------------------------------------------------------------------
(* The demands.                                                            *)

Enables == ~S_EnableSwitchOut /\ S_EnableSwitchOut'
Ends == Error /\ ~Error' /\ InMode(Called)
HasCome(m) == waits'[m] <= LATENCY

\* ES-SEQ-0
InactiveShowsNothing == [][~Called.Activate => ~S_EnableSwitchOut' /\ ~Error']_beat
\* ES-SEQ-1, ES-SEQ-2
NothingWithoutMode == [][~Called.S_SafetyActive => ~S_EnableSwitchOut']_beat
\* ES-STAGE-1, ES-SEQ-1, ES-SEQ-6
EnablesInStage1 == [][Enables => StageIs(1, Called)]_beat
\* ES-STAGE-0, ES-STAGE-2, ES-SEQ-1, ES-SEQ-5, ES-SEQ-7, ES-SEQ-8
OffInOtherStages == [][StageIs(0, Called) \/ StageIs(2, Called) => ~S_EnableSwitchOut']_beat
\* ES-STAGE-1, ES-SEQ-3
OffWithoutStage1 == [][outside' <= DiscrepancyTimeCh1_Ch3]_beat
\* ES-ORDER-2, ES-SEQ-5, ES-SEQ-6, ES-SEQ-8, ES-SEQ-9
EnableComesFromStage0 == [][Enables => fromStage0]_beat
\* ES-SEQ-3, ES-SEQ-4
NoEnableInError == [][Error' => ~S_EnableSwitchOut']_beat
\* ES-SEQ-3
Channel3TooLateIsAnError == [][HasCome("error")]_beat
\* ES-SEQ-1, ES-SEQ-2, ES-SEQ-6, ES-SEQ-7, ES-SEQ-8, ES-SEQ-9
ErrorNeedsReason == [][~Error /\ Error' => Step(Called) = ""]_beat
\* ES-RESTART, ES-SEQ-4, ES-SEQ-5
ErrorStaysUntilReset == [][Ends => Edge(Called) \/ Called.S_AutoReset]_beat
\* ES-SEQ-5
CauseGoesFirst == [][Ends => Called.S_EnableSwitchCh1 = Called.S_EnableSwitchCh3]_beat
\* ES-RESTART, ES-SEQ-5
ResetEndsError == [][HasCome("reset")]_beat
\* ES-STAGE-0, ES-STAGE-1, ES-SEQ-2, ES-SEQ-6, ES-SEQ-9
Stage1Enables == [][HasCome("enable")]_beat
=============================================================================
