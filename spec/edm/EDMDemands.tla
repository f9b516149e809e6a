----------------------------- MODULE EDMDemands -----------------------------
(***************************************************************************)
(* What the sentences of the page demand of the block, read a second time: *)
(* demands.toml says the same for programs.  An observer keeps what stood  *)
(* on the inputs and on the outputs that the page prints, and no state of  *)
(* the block.  What must come has LATENCY calls; all else is asked in the  *)
(* call itself, for every block here shows there what it has read.         *)
(* Calls are one tick apart.                                               *)
(* Leaves out what the page leaves open: SafetyDemand, ResetRequest, codes.*)
(***************************************************************************)
EXTENDS EDMOpen

CONSTANT LATENCY    \* calls that may pass before what must come has come

VARIABLES
    freed,          \* since the activation an edge of Reset, or a call without inhibit: the inhibit may be gone
    free,           \* ... and must be gone: an edge at which nothing else happened, or never an inhibit
    uninhibited,    \* S_StartReset was TRUE in every call since the activation
    counted,        \* S_OutControl was FALSE since the last edge of Reset
    owed,           \* an error was there when Activate ended, and the output has not been on since
    mistrust,       \* the error came from the output, or without Reset: it is one about contactors
    welded,         \* ... and came while the output was off, over a contactor that was not dropped out
    since,          \* ticks since S_EDM_Out changed, up to MONITORING_TIME
    late,           \* of each contactor: ticks for which it has not followed; None: it has, or need not yet
    waits           \* of what must come: calls for which it has not

witness == <<resetWas, controlWas, freed, free, uninhibited, counted, owed, mistrust, welded, since, late, waits>>
DemandView == <<edm, witness>>

ASSUME LATENCY \in Nat

None == -1
Contactors == {1, 2}
MustCome == {"Ready", "trip", "drop_out", "reset", "request", "by_itself"}

DemandInit ==
    /\ OpenInit
    /\ freed = FALSE /\ free = FALSE /\ uninhibited = FALSE /\ counted = TRUE
    /\ owed = FALSE /\ mistrust = FALSE /\ welded = FALSE
    /\ since = MONITORING_TIME /\ late = [c \in Contactors |-> None] /\ waits = [m \in MustCome |-> 0]

Edge(i) == i.Reset /\ ~resetWas
DroppedOut(i) == i.S_EDM1 /\ i.S_EDM2
Shows(c, i) == IF c = 1 THEN i.S_EDM1 ELSE i.S_EDM2
\* EDM-IN-RESET-2, EDMF-11: an edge of a block that is ready and in no error, with S_OutControl as it was
Plain(i) == Edge(i) /\ Ready /\ ~Error /\ ~Error' /\ i.S_OutControl = controlWas
\* EDM-IN-RESET-1: an error about contactors ends
Ends(i) == i.Activate /\ Error /\ ~Error' /\ mistrust
\* EDM-SEQ-2, EDM-SEQ-4, EDM-SEQ-6: the monitoring time starts with the output off
Starts(i) == S_EDM_Out \/ (Plain(i) /\ ~freed /\ ~i.S_StartReset) \/ Ends(i)
\* EDM-IN-EDM-1: a contactor that should be picked up is not, or one that should have dropped out since then
Lags(c, i) ==
    IF S_EDM_Out' THEN Shows(c, i)
    ELSE /\ i.Activate /\ ~Error' /\ ~Shows(c, i)
         /\ Starts(i) \/ (~S_EDM_Out /\ late[c] # None)
Continues(c) == S_EDM_Out' = S_EDM_Out /\ late[c] # None
TooLate(c) == late'[c] > MONITORING_TIME
Asked(i) == i.Activate /\ i.S_OutControl /\ DroppedOut(i) /\ free' /\ counted' /\ ~Error' /\ ~owed'
\* EDM-IN-RESET-1: the edge comes over an error whose cause is gone
Answered(i) == Edge(i) /\ Error /\ i.S_OutControl = controlWas
Missing(m, i) ==
    CASE m = "Ready" -> i.Activate /\ ~Ready'
      [] m = "trip" -> i.Activate /\ i.S_OutControl /\ ~S_EDM_Out' /\ ~Error' /\ (S_EDM_Out \/ waits[m] > 0)
      [] m = "drop_out" -> ~S_EDM_Out' /\ \E c \in Contactors : TooLate(c)
      [] m = "reset" -> i.Activate /\ DroppedOut(i) /\ Error' /\ (Answered(i) \/ waits[m] > 0)
      [] m = "request" -> Asked(i) /\ ~uninhibited' /\ ~S_EDM_Out'
      [] m = "by_itself" -> Asked(i) /\ uninhibited' /\ ~S_EDM_Out'

Watch(i) ==
    /\ resetWas' = i.Reset /\ controlWas' = i.S_OutControl /\ UNCHANGED <<unchanged, released>>
    /\ freed' = (i.Activate /\ (freed \/ Edge(i) \/ i.S_StartReset))
    /\ uninhibited' = (i.Activate /\ i.S_StartReset /\ (uninhibited \/ ~Ready))
    /\ free' = (i.Activate /\ (free \/ Plain(i) \/ (uninhibited' /\ Ready)))
    /\ counted' = (~Edge(i) /\ (counted \/ ~i.S_OutControl))
    /\ owed' = IF i.Activate THEN owed /\ ~S_EDM_Out' ELSE owed \/ Error
    /\ mistrust' = (Error' /\ IF Error THEN mistrust ELSE S_EDM_Out \/ ~i.Reset)
    /\ welded' = (Error' /\ IF Error THEN welded ELSE ~S_EDM_Out /\ ~i.Reset /\ ~DroppedOut(i))
    /\ since' = IF S_EDM_Out' = S_EDM_Out THEN Counted(since, i.dt, MONITORING_TIME) ELSE 0
    /\ late' = [c \in Contactors |->
                    IF ~Lags(c, i) THEN None
                    ELSE IF Continues(c) /\ ~(~S_EDM_Out' /\ Starts(i)) THEN Counted(late[c], i.dt, MONITORING_TIME + 1)
                    ELSE 0]
    /\ waits' = [m \in MustCome |-> IF Missing(m, i) THEN Counted(waits[m], 1, LATENCY + 1) ELSE 0]

DemandNext ==
    \E n \in {m \in 0..N - 1 : Alphabet[m].dt = 1} : \E i \in {Alphabet[n]} :
        EDMCall(i) /\ in' = n /\ beat' = ~beat /\ Watch(i)
DemandSpec == DemandInit /\ [][DemandNext]_<<edm, observer, witness, step, in, beat>>

----------------------------------------------------------------------------
(* The demands.                                                            *)

Comes == ~S_EDM_Out /\ S_EDM_Out'
TimeIsOver == since + Scanned.dt >= MONITORING_TIME
HasCome(m) == waits'[m] <= LATENCY

\* EDM-IN-ACTIVATE, EDM-OUT-READY-1, EDM-OUT-EDM-1, EDM-OUT-ERROR, EDM-SEQ-0
InactiveShowsNothing == [][~Scanned.Activate => ~Ready' /\ ~S_EDM_Out' /\ ~Error']_beat
\* EDM-IN-ACTIVATE, EDM-OUT-READY-2
ActiveIsReady == [][HasCome("Ready")]_beat
\* EDM-IN-CONTROL-1, EDM-IN-CONTROL-2, EDM-OUT-EDM-1, EDM-SEQ-4
StopRequestIsFollowed == [][~Scanned.S_OutControl => ~S_EDM_Out']_beat
\* EDM-IN-EDM-1, EDM-IN-EDM-2, EDM-IN-CONTROL-3, EDM-OUT-EDM-1, EDM-SEQ-3, EDM-SEQ-5
OnlyOverDroppedContactors == [][Comes => DroppedOut(Scanned)]_beat
\* EDM-IN-START-1, EDM-IN-START-2, EDM-IN-RESET-2, EDM-IN-RESET-3, EDM-OUT-EDM-1, EDM-SEQ-1
InhibitGoesByHand == [][Comes => freed']_beat
\* EDM-IN-TIME-1, EDM-OUT-EDM-1, EDM-SEQ-5
NoOutputInError == [][Error' => ~S_EDM_Out']_beat
\* EDM-FB-1, EDM-IN-TIME-1, EDM-OUT-EDM-1, EDM-SEQ-5, EDMF-08
LateContactorSwitchesOff == [][S_EDM_Out' => \A c \in Contactors : ~TooLate(c)]_beat
\* EDM-IN-TIME-1, EDM-OUT-ERROR, EDM-SEQ-5
TripShowsError == [][HasCome("trip")]_beat
\* EDM-FB-1, EDM-IN-TIME-1, EDM-SEQ-2, EDM-SEQ-4, EDM-SEQ-6, EDMF-14
LateDropOutShowsError == [][HasCome("drop_out")]_beat
\* EDM-OUT-EDM-2, EDM-SEQ-3
OffOnlyWithReason ==
    [][S_EDM_Out /\ ~S_EDM_Out' =>
        \/ ~Scanned.Activate \/ ~Scanned.S_OutControl
        \/ TimeIsOver /\ \E c \in Contactors : Shows(c, Scanned)]_beat
\* EDM-IN-START-3, EDM-OUT-ERROR, EDM-SEQ-2, EDM-SEQ-3, EDM-SEQ-4, EDM-SEQ-6, EDMF-05, EDMF-10, EDMF-11
ErrorNeedsReason ==
    [][~Error /\ Error' =>
        \/ IF S_EDM_Out THEN TimeIsOver /\ \E c \in Contactors : Shows(c, Scanned)
           ELSE ~DroppedOut(Scanned) /\ (TimeIsOver \/ Scanned.S_OutControl)
        \/ Scanned.Reset /\ ~uninhibited'
        \/ owed']_beat
\* EDM-IN-RESET-1, EDM-IN-RESET-3
ErrorGoesByHand == [][Ends(Scanned) => Edge(Scanned)]_beat
\* EDM-IN-RESET-1, EDMF-07
CauseGoesFirst == [][Ends(Scanned) /\ welded => DroppedOut(Scanned)]_beat
\* EDM-IN-RESET-1, EDM-SEQ-6
ResetEndsError == [][HasCome("reset")]_beat
\* EDM-IN-CONTROL-1, EDM-IN-CONTROL-3, EDM-IN-START-2, EDM-IN-RESET-2, EDM-OUT-EDM-2, EDM-SEQ-2, EDM-SEQ-3, EDM-SEQ-5, EDMF-04
RequestIsServed == [][HasCome("request")]_beat
\* EDM-IN-START-1, EDM-IN-START-3, EDM-IN-CONTROL-3, EDM-OUT-EDM-2, EDMF-14
ComesByItself == [][HasCome("by_itself")]_beat
=============================================================================
