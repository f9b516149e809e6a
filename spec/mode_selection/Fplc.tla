-------------------------------- MODULE Fplc --------------------------------
(***************************************************************************)
(* The fail-safe PLC of the note: insert steps 6 to 29, Figures 3 to 7,    *)
(* removal steps 3 to 18 and Figure 9, as far as they are the F-PLC's.     *)
(* One step is one scan: the inputs `i` are read once, the key check comes *)
(* first, at most one numbered step is taken.  A state is named after the  *)
(* step that is executed next.  Outputs are a row of the state after the   *)
(* scan.                                                                   *)
(*                                                                         *)
(* i = [LA, vec, MW03, MW07, dt]: LA a boolean, vec the set of levels      *)
(* whose output A, B, C, D, STR is set, two words, and dt the ticks since  *)
(* the previous scan.  (Two readings also look at i.MW01, the flag word as *)
(* it stands.)                                                             *)
(*                                                                         *)
(* Leaves out: hardware faults of the F-PLC itself.  LITERAL names the     *)
(* readings of the note that are restored for a trial; {} is our reading.  *)
(***************************************************************************)
EXTENDS Integers, FiniteSets, CodeTables, StepName, Readings

CONSTANTS
    T_ON,       \* ticks from LA to all outputs set (EKS-2-6)
    T_SEQ,      \* ticks of the sequence of outputs (EKS-4-2)
    T_SEQ_FROM, \* "LA" or "ones": what T_SEQ counts from (E-38)
    T_REM,      \* ticks for the whole removal (EKS-8-3, EKS-8-11)
    T_DWELL,    \* least ticks before returned zeros count (E-52)
    ON_ERROR    \* "hold" or "none": what Error does to the active mode (E-24)

ASSUME T_ON \in Nat \ {0} /\ T_SEQ \in Nat \ {0}
ASSUME T_SEQ_FROM \in {"LA", "ones"} /\ (T_SEQ_FROM = "LA" => T_ON <= T_SEQ)
ASSUME T_DWELL \in Nat /\ T_REM \in Nat /\ T_DWELL < T_REM
ASSUME ON_ERROR \in {"hold", "none"}

VARIABLES
    fplcState,      \* the step that is executed next
    accepted,   \* the one output accepted in this insertion
    authority,  \* authorization level of this insertion
    fplcSelection,  \* the selection latched from MW03
    mode,       \* the mode outputs that are set, as a set of modes
    fplcElapsed     \* ticks since the timer of this state was started

fplc == <<fplcState, accepted, authority, fplcSelection, mode, fplcElapsed>>

Transaction == {"EchoSelection", "AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch"}
Authorized == {"AwaitSelection", "CheckSelection"} \cup Transaction
Holding == {"Authorize", "Settle"} \cup Authorized        \* states in which an output vector has been accepted
Pulse == {"PulseOnes", "PulseZeros"}
Inserting == Pulse \cup {"OneOutput"}
Removing == {"Clear", "AwaitZeros"}
OwnRules == {"Start", "Idle", "Error"}                    \* states that the check before every step leaves alone
Timed == Inserting \cup Removing                          \* states with a deadline
Clocked == Timed \cup {"Start", "Settle", "Error"}         \* states in which time is counted
FplcStates == {"Start", "Idle", "OneOutput", "Error"} \cup Holding \cup Pulse \cup Removing

FplcTypeOK ==
    /\ fplcState \in FplcStates
    /\ accepted \in MSO \cup {None} /\ authority \in MSO \cup {None} /\ fplcSelection \in MSO \cup {None}
    /\ mode \subseteq MSO
    /\ fplcElapsed \in 0..T_ON + T_SEQ + T_REM

\* E-25c: at power-up no mode is active and nothing is authorized
FplcInit ==
    /\ fplcState = "Start" /\ accepted = None /\ authority = None /\ fplcSelection = None
    /\ mode = {} /\ fplcElapsed = 0

----------------------------------------------------------------------------
(* Outputs: the row of the state.                                          *)

\* EKS-2-12, EKS-8-6, E-05: the level is published from AwaitSelection to Switch and is zero in every other state.
\* E-59: also in Settle, so that the panel closes and the next selection cannot overtake the return to zero.
MW01 == IF fplcState \in Authorized \/ (fplcState = "Settle" /\ SETTLE_KEEPS_MW01) THEN RE[authority] ELSE 0
\* EKS-8-15, E-27: as read, no step takes the last echo back
LOCAL KeptEcho == MW05_KEPT /\ fplcState \notin Transaction /\ fplcSelection # None
\* EKS-2-20, EKS-6-2, EKS-6-4, EKS-6-6, EKS-6-8, EKS-6-10, EKS-8-16, E-27: the echo is there only while an acknowledgment may come
MW05 == IF fplcState \in Transaction \ {"EchoSelection"} \/ KeptEcho THEN CH[fplcSelection] ELSE 0
\* EKS-2-19, EKS-KS-6, E-22: one error mode
ERROR == fplcState = "Error"
\* The outputs by their names; a mode output for each mode
FplcOutputs == [MW01 |-> MW01, MW05 |-> MW05, MSO_0 |-> 0 \in mode, MSO_1 |-> 1 \in mode, MSO_2 |-> 2 \in mode,
                MSO_3 |-> 3 \in mode, MSO_4 |-> 4 \in mode, ERROR |-> ERROR]

----------------------------------------------------------------------------
(* What a scan sees.                                                       *)

LOCAL Now(i) == fplcElapsed + i.dt
LOCAL Min(a, b) == IF a < b THEN a ELSE b

\* EKS-SD-1, EKS-SD-8, EKS-SD-9, E-06b: the safety description names four outputs
LOCAL Outputs(i) == IF STR_LEFT_OUT THEN i.vec \ {4} ELSE i.vec
\* EKS-KS-6, EKS-2-11, E-09, E-06b: A, B, C, D and STR alike, in every scan outside the test pulse
Many(i) == Cardinality(Outputs(i)) >= 2
\* EKS-3-1-FPLC, EKS-9-1-FPLC, E-28, E-29
LOCAL NoSignal(i) ==
    /\ ~i.LA \/ LA_NOT_CHECKED
    /\ Outputs(i) = {} \/ LA_ENDS_REMOVAL
LOCAL NoWords(i) == i.MW03 = 0 /\ i.MW07 = 0
LOCAL NoDwellHere ==
    \/ NO_DWELL
    \/ fplcState = "Start" /\ NO_DWELL_AT_START
    \/ fplcState = "Settle" /\ NO_DWELL_IN_SETTLE
    \/ fplcState = "AwaitZeros" /\ NO_DWELL_IN_REMOVAL
    \/ fplcState = "Error" /\ NO_DWELL_IN_ERROR
LOCAL Dwelt(i) == Now(i) >= T_DWELL \/ NoDwellHere
\* EKS-8-12, EKS-8-13, EKS-8-14, E-31: as read, these three are tested first, and step 18 then looks at MW07 alone
LOCAL FirstZeros(i) == ZEROS_ONE_BY_ONE /\ fplcState = "AwaitZeros"
\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-29, E-31, E-52: one conjunction, not before the dwell time is over
LOCAL ZerosReturned(i) == ((NoSignal(i) /\ NoWords(i)) \/ (FirstZeros(i) /\ i.MW07 = 0)) /\ Dwelt(i)

Deadline == CASE fplcState = "PulseOnes" -> T_ON [] fplcState \in Removing -> T_REM [] OTHER -> T_SEQ

\* What the state waits for stands on the wires
LOCAL Awaited(i) ==
    CASE fplcState = "PulseOnes" -> i.vec = MSO
      [] fplcState = "PulseZeros" -> i.vec = {}
      [] fplcState = "OneOutput" -> i.vec # {}
      [] fplcState = "AwaitZeros" -> ZerosReturned(i)
      [] OTHER -> FALSE

\* The check before every single step (EKS-3-0, EKS-9-0, EKS-GP-4), by priority (E-63)
UnguardedSwitch == fplcState = "Switch" /\ NO_LA_AT_SWITCH
\* EKS-3-1-FPLC, E-07: as printed, no output at 1 is a removal also while the pulse runs
LOCAL NoneInPulse(i) == CHECK_IN_PULSE /\ fplcState \in Inserting /\ i.vec = {}
IsGone(i) ==
    (~i.LA \/ NoneInPulse(i)) /\ fplcState \notin OwnRules /\ fplcState \notin Removing /\ ~UnguardedSwitch
\* E-62: as read, an output without LA is a fault
LOCAL OutputAlone(i) == OUTPUT_NEEDS_LA /\ ~i.LA /\ i.vec # {}
IsMany(i) ==
    /\ fplcState \notin OwnRules
    /\ fplcState \notin Pulse \/ ONE_OUTPUT_ALWAYS
    /\ Many(i) \/ OutputAlone(i)
    /\ (ONE_OUTPUT_CHECKED_ONCE => fplcState = "OneOutput")
    /\ ~(KEY_BEFORE_FAULTS /\ IsGone(i))
\* EKS-3-1-FPLC, E-68: as printed, only the loss of the output counts
LOCAL Lost(i) == IF ONLY_NONE_IS_REMOVAL THEN i.vec = {} ELSE i.vec # {accepted}
IsChanged(i) == fplcState \in Holding /\ Lost(i) /\ ~UnguardedSwitch
\* Timers that a reading leaves out (E-06, E-25d, E-30), and endings that it puts before the expiry (E-03, E-64)
LOCAL Expirable(i) ==
    /\ ~(NO_REMOVAL_TIMER /\ fplcState \in Removing)
    /\ ~(NO_INSERTION_TIMER /\ fplcState \in Inserting)
    /\ ~(EXPIRY_IS_SUCCESS /\ fplcState \in {"PulseZeros", "OneOutput"} /\ Cardinality(i.vec) = 1)
    /\ ~(SUCCESS_BEFORE_EXPIRY /\ Awaited(i))
IsExpired(i) == fplcState \in Timed /\ Now(i) >= Deadline /\ Expirable(i)
CheckPasses(i) == ~IsGone(i) /\ ~IsMany(i) /\ ~IsChanged(i) /\ ~IsExpired(i)

----------------------------------------------------------------------------
(* What a scan does.                                                       *)

LOCAL KeepKey == UNCHANGED <<accepted, authority>>
LOCAL GoTo(s) == fplcState' = s /\ fplcElapsed' = 0
LOCAL Stay(i, limit) == UNCHANGED <<fplcState, accepted, authority, fplcSelection, mode>> /\ fplcElapsed' = Min(Now(i), limit)
LOCAL Untimed == UNCHANGED fplc
LOCAL DropKey == accepted' = None /\ authority' = None /\ fplcSelection' = None

LOCAL EnterError ==
    /\ GoTo("Error")
    /\ IF RECOVER_INTO_TRANSACTION /\ fplcSelection # None THEN KeepKey /\ UNCHANGED fplcSelection ELSE DropKey
    /\ mode' = IF ON_ERROR = "none" THEN {} ELSE mode
LOCAL EnterClear ==
    /\ GoTo("Clear")
    /\ accepted' = None /\ authority' = None
    /\ fplcSelection' = IF MW05_KEPT THEN fplcSelection ELSE None
    /\ UNCHANGED mode
LOCAL EnterSettle == GoTo("Settle") /\ KeepKey /\ fplcSelection' = None /\ UNCHANGED mode
LOCAL Proceed(s) == GoTo(s) /\ KeepKey /\ UNCHANGED <<fplcSelection, mode>>

----------------------------------------------------------------------------
(* The check before every step, Figures 3 and 9.                           *)

\* E-73: as read, no output may be set when LA comes; E-09: at every moment, the pulse included
LOCAL OutputBeforeLA(i) ==
    \/ NO_OUTPUT_BEFORE_LA /\ i.vec # {}
    \/ ONE_OUTPUT_ALWAYS /\ Many(i)
\* EKS-KS-6, EKS-2-11, E-09: more than one output outside the pulse is a fault of the EKS, also without LA
TooManyOutputs(i) ==
    /\ \/ IsMany(i)
       \/ fplcState = "Start" /\ Many(i)
       \/ fplcState = "Idle" /\ ~i.LA /\ Many(i)
       \/ fplcState = "Idle" /\ i.LA /\ OutputBeforeLA(i)
    /\ EnterError
    /\ Did("TooManyOutputs")

\* EKS-3-1-FPLC, EKS-3-4-FPLC, EKS-8-3, E-06, E-07, E-42: LA is enough while the pulse runs
KeyGone(i) ==
    /\ IsGone(i) /\ ~IsMany(i)
    /\ EnterClear
    /\ Did("KeyGone")

\* EKS-3-1-FPLC, EKS-3-4-FPLC, E-28, E-41, E-68: once an output is accepted it must stay
VectorChanged(i) ==
    /\ IsChanged(i) /\ ~IsGone(i) /\ ~IsMany(i)
    /\ EnterClear
    /\ Did("VectorChanged")

\* EKS-2-8, EKS-4-4, EKS-4-6, EKS-4-8, EKS-8-11, E-03, E-25d, E-30, E-32, E-64: expiry is tested before success
DeadlineExpired(i) ==
    /\ IsExpired(i) /\ ~IsGone(i) /\ ~IsMany(i)
    /\ EnterError
    /\ Did("DeadlineExpired")

----------------------------------------------------------------------------
(* Power-up, waiting for a key.                                            *)

LOCAL ReadyAtStart(i) == ZerosReturned(i) \/ KEY_AT_POWER_UP
\* EKS-GP-5, E-25c, E-56: power-up; a key in the reader must be taken out first
LeaveStart(i) == fplcState = "Start" /\ ~Many(i) /\ ReadyAtStart(i) /\ Proceed("Idle") /\ Did("LeaveStart")
\* E-25c
AwaitPowerUpZeros(i) ==
    fplcState = "Start" /\ ~Many(i) /\ ~ReadyAtStart(i) /\ Stay(i, T_DWELL) /\ Did("AwaitPowerUpZeros")

\* EKS-9-1-FPLC, EKS-9-2, EKS-9-3, E-35, E-36
AwaitKey(i) == fplcState = "Idle" /\ ~i.LA /\ ~Many(i) /\ Untimed /\ Did("AwaitKey")
\* EKS-2-6, EKS-9-4-FPLC, E-17, E-40, E-73: the deadline for the pulse starts with LA, whatever the outputs show
DetectKey(i) == fplcState = "Idle" /\ i.LA /\ ~OutputBeforeLA(i) /\ Proceed("PulseOnes") /\ Did("DetectKey")

----------------------------------------------------------------------------
(* The test pulse, Figure 4.                                               *)

\* EKS-2-6, EKS-2-7, E-10: as read, one output within the time is enough
LOCAL OneAtOnce(i) == NO_PULSE_NEEDED /\ fplcState = "PulseOnes" /\ Cardinality(i.vec) = 1
\* EKS-4-6, EKS-4-8, E-03: as printed, the sequence has two good endings, expiry included
LOCAL EndedByExpiry(i) ==
    EXPIRY_IS_SUCCESS /\ fplcState = "PulseZeros" /\ Now(i) >= Deadline /\ Cardinality(i.vec) = 1
\* EKS-2-6, EKS-2-10, EKS-4-1, E-10: patterns between are waited out
AwaitOnes(i) == fplcState = "PulseOnes" /\ i.vec # MSO /\ ~OneAtOnce(i) /\ Stay(i, T_ON) /\ Did("AwaitOnes")
\* EKS-2-6, EKS-2-10, EKS-4-1, EKS-4-2, E-38: the sequence timer goes on from LA, or is started here
SeeOnes(i) ==
    /\ fplcState = "PulseOnes" /\ i.vec = MSO
    /\ fplcState' = "PulseZeros" /\ fplcElapsed' = IF T_SEQ_FROM = "LA" THEN Now(i) ELSE 0
    /\ KeepKey /\ UNCHANGED <<fplcSelection, mode>>
    /\ Did("SeeOnes")
\* EKS-4-3, EKS-4-4, E-39
AwaitPulseZeros(i) ==
    fplcState = "PulseZeros" /\ i.vec # {} /\ ~EndedByExpiry(i) /\ Stay(i, T_SEQ) /\ Did("AwaitPulseZeros")
\* EKS-4-3, EKS-4-5: the timer goes on
SeePulseZeros(i) ==
    /\ fplcState = "PulseZeros" /\ i.vec = {}
    /\ fplcState' = "OneOutput" /\ fplcElapsed' = Now(i)
    /\ KeepKey /\ UNCHANGED <<fplcSelection, mode>>
    /\ Did("SeePulseZeros")
\* EKS-4-5, EKS-4-6
AwaitOneOutput(i) == fplcState = "OneOutput" /\ i.vec = {} /\ Stay(i, T_SEQ) /\ Did("AwaitOneOutput")
\* EKS-2-10, EKS-2-11, EKS-4-5, EKS-4-7, EKS-KS-5: one of five
AcceptOutput(i) ==
    /\ (fplcState = "OneOutput" /\ i.vec # {}) \/ OneAtOnce(i) \/ EndedByExpiry(i)
    /\ \E a \in i.vec : accepted' = a
    /\ GoTo("Authorize")
    /\ UNCHANGED <<authority, fplcSelection, mode>>
    /\ Did("AcceptOutput")

----------------------------------------------------------------------------
(* Authorization and selection.                                            *)

LOCAL EarlyWord(i) == ~NoWords(i) /\ ~EARLY_WORDS_ACCEPTED
\* EKS-T2-3, E-02: the example after Table 2 gives level 3 the output C
LOCAL LevelOf(output) == IF OUTPUT_C_IS_LEVEL_3 /\ output = 2 THEN 3 ELSE output
\* E-54: a word that is there before anything was offered answers nothing
RefuseEarlyWord(i) == fplcState = "Authorize" /\ EarlyWord(i) /\ EnterError /\ Did("RefuseEarlyWord")
\* EKS-2-12, EKS-SD-1, E-05, E-18: the level comes from the outputs and is kept in private memory
PublishAuthority(i) ==
    /\ fplcState = "Authorize" /\ ~EarlyWord(i)
    /\ \E a \in i.vec : authority' = LevelOf(a)
    /\ GoTo("AwaitSelection")
    /\ UNCHANGED <<accepted, fplcSelection, mode>>
    /\ Did("PublishAuthority")

\* EKS-2-17, EKS-2-20, E-65: nothing is acknowledged before the echo
LOCAL Silent(i) == i.MW07 = 0 \/ EARLY_ACKNOWLEDGMENT_IGNORED
\* EKS-2-17
AwaitMW03(i) == fplcState = "AwaitSelection" /\ Silent(i) /\ i.MW03 = 0 /\ Untimed /\ Did("AwaitMW03")
\* EKS-2-17
SeeSelection(i) ==
    fplcState = "AwaitSelection" /\ Silent(i) /\ i.MW03 # 0 /\ Proceed("CheckSelection") /\ Did("SeeSelection")

\* E-16: the selection must stand unchanged until the switchover
LOCAL Stands(i) ==
    \/ i.MW03 = SE[fplcSelection]
    \/ LIVE_MW03 /\ ModeOf(SE, i.MW03) # None
    \/ SPLIT_CHECK /\ fplcState = "EchoSelection" /\ ModeOf(SE, i.MW03) # None
LOCAL Unchanged(s, i) == fplcState = s /\ Stands(i)

\* E-11, E-15, E-65: an acknowledgment that nobody asked for
UnexpectedAcknowledgment(i) ==
    /\ \/ fplcState = "AwaitSelection"
       \/ fplcState = "CheckSelection"
       \/ fplcState = "EchoSelection" /\ Stands(i)
    /\ ~Silent(i)
    /\ EnterError
    /\ Did("UnexpectedAcknowledgment")

\* EKS-5-1 to the end of Figure 5, E-12: row by row as printed; a selection is refused by a row, and nothing else is
LOCAL Figure5(level, word) ==
    \/ level = 4
    \/ /\ word # SE[4]
       /\ level = 3 \/ (word # SE[3] /\ (level = 2 \/ (word # SE[2] /\ (level = 1 \/ word # SE[1]))))
\* E-12: for a level that is one of five, with Figure 6 after it, the rows say what the total order says, for every word
ASSUME PERMITS # TotalOrder \/ \A level \in MSO : \A word \in WordClasses :
    (Figure5(level, word) /\ ModeOf(SE, word) # None) = Permitted(level, ModeOf(SE, word))
\* EKS-2-12, EKS-5-1, E-12, E-18: as read, the level is what stands in the flag word MW01, which something else may have overwritten
LOCAL LevelUsed(i) ==
    IF AUTHORITY_FROM_MW01 \/ FIG5_READS_MW01 THEN ModeOf(RE, i.MW01) ELSE authority
LOCAL MayBeSelected(i) ==
    IF FIG5_FALLS_THROUGH \/ FIG5_READS_MW01
    THEN Figure5(LevelUsed(i), i.MW03) /\ ModeOf(SE, i.MW03) # None
    ELSE Permitted(LevelUsed(i), ModeOf(SE, i.MW03))
\* E-71: as read, there is nothing to do for the mode that is active
LOCAL Skipped(i) == ACTIVE_MODE_SKIPPED /\ ModeOf(SE, i.MW03) \in mode
\* EKS-2-18, EKS-2-19, EKS-5-1 to the end of Figure 5, EKS-5-9, EKS-6-1, EKS-6-3, EKS-6-5, EKS-6-7, EKS-6-9, EKS-6-11,
\* EKS-5-3, EKS-5-5, EKS-5-7, E-12, E-14, E-16, E-47: range and authority in one scan, then the selection is latched
AcceptSelection(i) ==
    /\ fplcState = "CheckSelection" /\ Silent(i)
    /\ MayBeSelected(i) /\ ~Skipped(i)
    /\ fplcSelection' = ModeOf(SE, i.MW03)
    /\ GoTo("EchoSelection")
    /\ KeepKey /\ UNCHANGED mode
    /\ Did("AcceptSelection")
\* E-61: as read, a word that is no code is an error also after the selection was accepted
LOCAL LaterNoCode(i) == LATER_NO_CODE_IS_ERROR /\ i.MW03 # 0 /\ ModeOf(SE, i.MW03) = None
\* EKS-2-18, EKS-2-19, EKS-5-2, EKS-5-4, EKS-5-6, EKS-5-8, EKS-5-10, EKS-6-12, E-12, E-14
RefuseSelection(i) ==
    /\ \/ fplcState = "CheckSelection" /\ Silent(i) /\ i.MW03 # 0 /\ ~MayBeSelected(i)
       \/ fplcState \in Transaction /\ LaterNoCode(i)
    /\ EnterError
    /\ Did("RefuseSelection")

----------------------------------------------------------------------------
(* Echo, acknowledgment, switchover.                                       *)

\* EKS-2-25, E-16, E-21, E-61: the panel took the selection back or changed it
WithdrawSelection(i) ==
    /\ \/ fplcState = "CheckSelection" /\ Silent(i) /\ (i.MW03 = 0 \/ (MayBeSelected(i) /\ Skipped(i)))
       \/ fplcState \in Transaction /\ ~Stands(i) /\ ~LaterNoCode(i)
    /\ EnterSettle
    /\ Did("WithdrawSelection")

\* EKS-2-20
PublishEcho(i) ==
    /\ Unchanged("EchoSelection", i) /\ Silent(i)
    /\ fplcSelection' = IF SPLIT_CHECK THEN ModeOf(SE, i.MW03) ELSE fplcSelection   \* E-14: read once more
    /\ GoTo("AwaitAcknowledgment") /\ KeepKey /\ UNCHANGED mode
    /\ Did("PublishEcho")
\* EKS-2-20, E-11: the wait that the text does not have
AwaitMW07(i) ==
    Unchanged("AwaitAcknowledgment", i) /\ i.MW07 = 0 /\ ~NO_WAIT_FOR_MW07 /\ Untimed /\ Did("AwaitMW07")
\* EKS-2-27, E-11
SeeAcknowledgment(i) ==
    Unchanged("AwaitAcknowledgment", i) /\ i.MW07 # 0 /\ Proceed("CheckAcknowledgment") /\ Did("SeeAcknowledgment")

\* Figure 7 as printed has the word of MSO 3 in the row of MSO 2; in a chain that falls through, MSO 3 confirms MSO 2 (E-01)
LOCAL PrintedRow5 == LITERAL_FIG7 \/ FIG7_EXCLUSIVE
LOCAL PrintedMatch(i) == i.MW07 = SW[3] /\ fplcSelection = 2
LOCAL Matches(i) ==
    \/ i.MW07 = SW[fplcSelection] /\ ~(PrintedRow5 /\ fplcSelection = 2)
    \/ LITERAL_FIG7 /\ PrintedMatch(i)
    \/ FIG7_GOES_ON /\ \E m \in MSO : i.MW07 = SW[m] /\ fplcSelection = m       \* E-13: with the words of Table 2
    \/ LIVE_MW03 /\ ModeOf(SW, i.MW07) # None /\ ModeOf(SW, i.MW07) = ModeOf(SE, i.MW03)
\* E-66: as read, MW07 is judged in step 27 and not looked at again
LOCAL ReadOnce == ACKNOWLEDGMENT_READ_ONCE
LOCAL Confirmed(i) == Matches(i) \/ ReadOnce

\* EKS-2-27, EKS-7-1, EKS-7-3, EKS-7-5, EKS-7-7, EKS-7-9, E-01, E-13
AcceptAcknowledgment(i) ==
    /\ Unchanged("CheckAcknowledgment", i)
    /\ ModeOf(SW, i.MW07) # None /\ (ReadOnce => Matches(i))
    /\ Proceed("Match")
    /\ Did("AcceptAcknowledgment")
\* EKS-2-27, EKS-7-12, E-13
RefuseAcknowledgment(i) ==
    /\ \/ /\ Unchanged("CheckAcknowledgment", i)
          /\ i.MW07 # 0 /\ (ModeOf(SW, i.MW07) = None \/ (ReadOnce /\ ~Matches(i)))
       \/ NO_WAIT_FOR_MW07 /\ Unchanged("AwaitAcknowledgment", i) /\ i.MW07 = 0
    /\ EnterError
    /\ Did("RefuseAcknowledgment")

\* E-21, E-66: the acknowledgment went away again
WithdrawAcknowledgment(i) ==
    /\ Unchanged("CheckAcknowledgment", i) \/ (~ReadOnce /\ (Unchanged("Match", i) \/ Unchanged("Switch", i)))
    /\ i.MW07 = 0
    /\ EnterSettle
    /\ Did("WithdrawAcknowledgment")

\* EKS-2-28, EKS-7-2, EKS-7-4, EKS-7-6, EKS-7-8, EKS-7-10, EKS-7-11, E-01
MatchWords(i) == Unchanged("Match", i) /\ Confirmed(i) /\ Proceed("Switch") /\ Did("MatchWords")
\* EKS-2-28, EKS-7-12, E-13: also in the scan that would switch
RefuseMatch(i) ==
    /\ Unchanged("Match", i) \/ Unchanged("Switch", i)
    /\ i.MW07 # 0 /\ ~Confirmed(i)
    /\ EnterError
    /\ Did("RefuseMatch")

\* EKS-2-29, EKS-SD-2, E-01, E-16, E-18, E-42, E-71: every guard is evaluated again in the scan that switches
SwitchMode(i) ==
    /\ Unchanged("Switch", i) /\ Confirmed(i)
    /\ mode' = {IF LITERAL_FIG7 \/ LIVE_MW03 THEN ModeOf(SW, i.MW07) ELSE fplcSelection}
    /\ fplcSelection' = None
    /\ KeepKey
    /\ GoTo(IF NO_SETTLE THEN "AwaitSelection" ELSE "Settle")
    /\ Did("SwitchMode")

\* EKS-GP-5, E-15: before the next selection both words must have been zero
AwaitSettled(i) == fplcState = "Settle" /\ ~(NoWords(i) /\ Dwelt(i)) /\ Stay(i, T_DWELL) /\ Did("AwaitSettled")
\* EKS-GP-5, E-15, E-52
LeaveSettle(i) == fplcState = "Settle" /\ NoWords(i) /\ Dwelt(i) /\ Proceed("AwaitSelection") /\ Did("LeaveSettle")

----------------------------------------------------------------------------
(* Removal, Figures 8 and 9, and the way out of the error mode.            *)

\* EKS-8-12, EKS-8-13, EKS-8-14, E-31
LOCAL StaysInClear(i) == ZEROS_ONE_BY_ONE /\ ~(i.MW03 = 0 /\ NoSignal(i))
\* EKS-8-3, EKS-8-6, E-27: the words fell to zero in the scan that saw the key go; the timer goes on
ClearWords(i) ==
    /\ fplcState = "Clear" /\ ~StaysInClear(i)
    \* E-34: Figure 9 as printed goes on with the first step of the insertion
    /\ fplcState' = IF REMOVAL_RUNS_INSERT_STEPS THEN "PulseOnes" ELSE "AwaitZeros"
    /\ fplcElapsed' = IF REMOVAL_RUNS_INSERT_STEPS THEN 0 ELSE Now(i)
    /\ KeepKey /\ UNCHANGED <<fplcSelection, mode>>
    /\ Did("ClearWords")

LOCAL Reinserted(i) == INSERT_DURING_REMOVAL /\ i.LA
\* EKS-8-18, E-32: as printed, MW07 is tested once
LOCAL LateMW07(i) == MW07_TESTED_ONCE /\ NoSignal(i) /\ i.MW03 = 0 /\ i.MW07 # 0 /\ Dwelt(i)
LOCAL Bounced(i) == BOUNCE_RESTARTS_TIMER /\ i.LA      \* EKS-9-4-FPLC, E-36
\* EKS-8-11, EKS-8-12, E-30, E-31, E-36
AwaitReturnedZeros(i) ==
    /\ \/ fplcState = "AwaitZeros" /\ ~ZerosReturned(i) /\ ~Reinserted(i) /\ ~LateMW07(i)
       \/ fplcState = "Clear" /\ StaysInClear(i)
    /\ UNCHANGED <<fplcState, accepted, authority, fplcSelection, mode>>
    /\ fplcElapsed' = IF Bounced(i) THEN 0 ELSE Min(Now(i), T_REM)
    /\ Did("AwaitReturnedZeros")
\* EKS-8-18, E-32
RefuseLateZero(i) == fplcState = "AwaitZeros" /\ LateMW07(i) /\ EnterError /\ Did("RefuseLateZero")
\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-29, E-31, E-35, E-52
LeaveAwaitZeros(i) == fplcState = "AwaitZeros" /\ ZerosReturned(i) /\ Proceed("Idle") /\ Did("LeaveAwaitZeros")
\* The literal Figure 9: a key starts the insertion at once, the removal is not finished (E-17)
InsertDuringRemoval(i) ==
    fplcState = "AwaitZeros" /\ ~ZerosReturned(i) /\ Reinserted(i) /\ Proceed("PulseOnes") /\ Did("InsertDuringRemoval")

\* EKS-GP-4, E-23: as read, the same key goes on where it was;  EKS-3-0, EKS-9-0, E-23b: as read, into the removal, whose timer leads back
LOCAL Recovered(i) == RECOVER_INTO_TRANSACTION /\ fplcSelection # None /\ i.LA /\ i.vec = {accepted}
LOCAL Removed(i) == ERROR_INTO_REMOVAL /\ NoSignal(i)
\* EKS-3-0, EKS-9-0, EKS-SD-9, E-22, E-23
StayInError(i) ==
    /\ fplcState = "Error" /\ ~ZerosReturned(i) /\ ~Recovered(i) /\ ~Removed(i)
    /\ UNCHANGED <<fplcState, mode>> /\ DropKey /\ fplcElapsed' = Min(Now(i), T_DWELL)
    /\ Did("StayInError")
\* EKS-GP-4, E-23
ResumeTransaction(i) ==
    /\ fplcState = "Error" /\ Recovered(i)
    /\ Proceed("EchoSelection")
    /\ Did("ResumeTransaction")
\* EKS-9-0, E-23b
ErrorIntoRemoval(i) == fplcState = "Error" /\ Removed(i) /\ Proceed("AwaitZeros") /\ Did("ErrorIntoRemoval")
\* EKS-3-0, EKS-9-0, EKS-GP-4, E-23, E-52: the key is out and zeros went round; never back into a pending transaction
LeaveError(i) ==
    /\ fplcState = "Error" /\ ZerosReturned(i) /\ ~Removed(i)
    /\ GoTo("Idle") /\ DropKey /\ UNCHANGED mode
    /\ Did("LeaveError")

----------------------------------------------------------------------------
\* The steps, grouped by the states in which they can fire
FplcStep(i) ==
    CASE fplcState = "Start" -> LeaveStart(i) \/ AwaitPowerUpZeros(i) \/ TooManyOutputs(i)
      [] fplcState = "Idle" -> AwaitKey(i) \/ DetectKey(i) \/ TooManyOutputs(i)
      [] fplcState = "PulseOnes" -> AwaitOnes(i) \/ SeeOnes(i) \/ AcceptOutput(i)
      [] fplcState = "PulseZeros" -> AwaitPulseZeros(i) \/ SeePulseZeros(i) \/ AcceptOutput(i)
      [] fplcState = "OneOutput" -> AwaitOneOutput(i) \/ AcceptOutput(i)
      [] fplcState = "Authorize" -> RefuseEarlyWord(i) \/ PublishAuthority(i)
      [] fplcState = "AwaitSelection" -> AwaitMW03(i) \/ SeeSelection(i) \/ UnexpectedAcknowledgment(i)
      [] fplcState = "CheckSelection" ->
            AcceptSelection(i) \/ RefuseSelection(i) \/ WithdrawSelection(i) \/ UnexpectedAcknowledgment(i)
      [] fplcState = "EchoSelection" ->
            PublishEcho(i) \/ UnexpectedAcknowledgment(i) \/ RefuseSelection(i) \/ WithdrawSelection(i)
      [] fplcState = "AwaitAcknowledgment" ->
            AwaitMW07(i) \/ SeeAcknowledgment(i) \/ RefuseAcknowledgment(i) \/ RefuseSelection(i) \/ WithdrawSelection(i)
      [] fplcState = "CheckAcknowledgment" ->
            \/ AcceptAcknowledgment(i) \/ RefuseAcknowledgment(i) \/ WithdrawAcknowledgment(i)
            \/ RefuseSelection(i) \/ WithdrawSelection(i)
      [] fplcState = "Match" ->
            MatchWords(i) \/ RefuseMatch(i) \/ WithdrawAcknowledgment(i) \/ RefuseSelection(i) \/ WithdrawSelection(i)
      [] fplcState = "Switch" ->
            SwitchMode(i) \/ RefuseMatch(i) \/ WithdrawAcknowledgment(i) \/ RefuseSelection(i) \/ WithdrawSelection(i)
      [] fplcState = "Settle" -> AwaitSettled(i) \/ LeaveSettle(i)
      [] fplcState = "Clear" -> ClearWords(i) \/ AwaitReturnedZeros(i)
      [] fplcState = "AwaitZeros" ->
            AwaitReturnedZeros(i) \/ LeaveAwaitZeros(i) \/ InsertDuringRemoval(i) \/ RefuseLateZero(i)
      [] fplcState = "Error" -> StayInError(i) \/ LeaveError(i) \/ ResumeTransaction(i) \/ ErrorIntoRemoval(i)

\* EKS-GP-3, EKS-GP-4, EKS-3-2, EKS-3-3, EKS-9-2, EKS-9-3: first the check, then at most one step
FplcScan(i) ==
    IF CheckPasses(i) THEN FplcStep(i)
    ELSE TooManyOutputs(i) \/ KeyGone(i) \/ VectorChanged(i) \/ DeadlineExpired(i)

----------------------------------------------------------------------------
(* What the F-PLC promises whatever its inputs do.  `i` is the scan's.     *)

\* EKS-KS-5, EKS-SD-6: the mode outputs are one of five, none before the first switchover
AtMostOneModeOutput == Cardinality(mode) <= 1

\* EKS-2-20, EKS-6-12: MW05 shows only what was selected and permitted
EchoIsTheSelection ==
    MW05 # 0 => fplcSelection # None /\ MW05 = CH[fplcSelection] /\ Permitted(authority, fplcSelection) /\ MW01 = RE[authority]

\* EKS-8-6, EKS-8-8, E-27: without an accepted key both words of the F-PLC are zero
WordsZeroWithoutKey == accepted = None => MW01 = 0 /\ MW05 = 0

\* EKS-2-18, EKS-T2-2: a latched selection never exceeds the level
SelectionWithinAuthority ==
    /\ fplcSelection # None => Permitted(authority, fplcSelection)
    /\ authority # None => authority = accepted
=============================================================================
