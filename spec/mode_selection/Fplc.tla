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
(* the previous scan.                                                      *)
(*                                                                         *)
(* This is what was decided.  What else the note could be taken to say is  *)
(* in FplcAsPrinted.  Leaves out: hardware faults of the F-PLC itself.     *)
(***************************************************************************)
EXTENDS Integers, FiniteSets, CodeTables, StepName

CONSTANTS
    T_ON,       \* ticks from LA to all outputs set (EKS-2-6)
    T_SEQ,      \* ticks of the sequence of outputs (EKS-4-2)
    T_SEQ_FROM, \* "LA" or "ones": what T_SEQ counts from (E-38)
    T_REM,      \* ticks for the whole removal (EKS-8-3, EKS-8-11), and for Settle (E-15)
    T_DWELL,    \* least ticks before returned zeros count (E-52)
    ON_ERROR,   \* "hold" or "none": what Error does to the active mode (E-24)
    SELECTIONS  \* "again" or "once": whether a switchover may be followed by another one with the key (E-15)

ASSUME T_ON \in Nat \ {0} /\ T_SEQ \in Nat \ {0}
ASSUME T_SEQ_FROM \in {"LA", "ones"} /\ (T_SEQ_FROM = "LA" => T_ON <= T_SEQ)
ASSUME T_DWELL \in Nat /\ T_REM \in Nat /\ T_DWELL < T_REM
ASSUME ON_ERROR \in {"hold", "none"} /\ SELECTIONS \in {"again", "once"}

VARIABLES
    fplcState,      \* the step that is executed next
    accepted,       \* the one output accepted in this insertion
    authority,      \* authorization level of this insertion
    fplcSelection,  \* the selection latched from MW03
    mode,           \* the mode outputs that are set, as a set of modes
    fplcElapsed     \* ticks since the timer of this state was started

fplc == <<fplcState, accepted, authority, fplcSelection, mode, fplcElapsed>>

Echoing == {"AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch"}
Transaction == {"EchoSelection"} \cup Echoing
Chosen == Transaction \cup {"Complete"}                \* a selection is latched
Authorized == {"AwaitSelection", "CheckSelection"} \cup Chosen
Holding == {"Authorize", "Settle"} \cup Authorized    \* an output has been accepted
Pulse == {"PulseOnes", "PulseZeros"}
Inserting == Pulse \cup {"OneOutput"}
WithKey == Inserting \cup Holding                     \* LA is expected
Removing == {"Clear", "AwaitZeros"}
OwnRules == {"Start", "Idle", "Error"}                \* left alone by the check before every step
Returning == Removing \cup {"Settle"}                 \* the words go back to zero, within T_REM
Timed == Inserting \cup Returning                     \* with a deadline
Clocked == Timed \cup {"Start", "Error"}              \* time is counted
FplcStates == OwnRules \cup WithKey \cup Removing

FplcTypeOK ==
    /\ fplcState \in FplcStates
    /\ accepted \in MSO \cup {None} /\ authority \in MSO \cup {None}
    /\ fplcSelection \in MSO \cup {None}
    /\ mode \subseteq MSO
    /\ fplcElapsed \in 0..T_ON + T_SEQ + T_REM

\* E-25c: at power-up no mode is active and nothing is authorized
FplcInit ==
    /\ fplcState = "Start" /\ accepted = None /\ authority = None /\ fplcSelection = None
    /\ mode = {} /\ fplcElapsed = 0

----------------------------------------------------------------------------
(* Outputs: the row of the state.                                          *)

\* EKS-2-12, EKS-8-6, E-15: published from AwaitSelection to Switch and in Complete, else zero.
\* E-59: also in Settle, so that the panel closes and the next selection cannot overtake the return to zero
MW01 == IF fplcState \in Authorized THEN RE[authority] ELSE 0
\* EKS-2-20, EKS-6-2, EKS-6-4, EKS-6-6, EKS-6-8, EKS-6-10, EKS-8-15, EKS-8-16, E-15, E-27: the echo is there
\* only while an acknowledgment may come, and in Complete
MW05 == IF fplcState \in Echoing \cup {"Complete"} THEN CH[fplcSelection] ELSE 0
\* EKS-2-19, EKS-KS-6, E-22: one error mode
ERROR == fplcState = "Error"
\* The outputs by their names; a mode output for each mode
FplcOutputs ==
    [MW01 |-> MW01, MW05 |-> MW05, MSO_0 |-> 0 \in mode, MSO_1 |-> 1 \in mode, MSO_2 |-> 2 \in mode,
     MSO_3 |-> 3 \in mode, MSO_4 |-> 4 \in mode, ERROR |-> ERROR]

----------------------------------------------------------------------------
(* What a scan sees.                                                       *)

Now(i) == fplcElapsed + i.dt
LOCAL Min(a, b) == IF a < b THEN a ELSE b

\* EKS-KS-6, EKS-SD-1, EKS-SD-8, EKS-SD-9, EKS-2-11, E-06b, E-09: A, B, C, D and STR alike, in every scan
\* outside the test pulse
Many(i) == Cardinality(i.vec) >= 2
\* EKS-3-1-FPLC, EKS-9-1-FPLC, E-28, E-29: LA and every output
NoSignal(i) == ~i.LA /\ i.vec = {}
NoWords(i) == i.MW03 = 0 /\ i.MW07 = 0
\* E-52: the zeros have had the time to go round
Dwelt(i) == Now(i) >= T_DWELL
\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-29, E-31, E-52: in one scan, not before the dwell time is over
ZerosReturned(i) == NoSignal(i) /\ NoWords(i) /\ Dwelt(i)

Deadline == CASE fplcState = "PulseOnes" -> T_ON [] fplcState \in Returning -> T_REM [] OTHER -> T_SEQ

\* The check before every single step (EKS-3-0, EKS-9-0, EKS-GP-4), by priority (E-63)
IsGone(i) == ~i.LA /\ fplcState \in WithKey
IsMany(i) == Many(i) /\ fplcState \notin OwnRules /\ fplcState \notin Pulse
IsChanged(i) == i.vec # {accepted} /\ fplcState \in Holding
IsExpired(i) == Now(i) >= Deadline /\ fplcState \in Timed
CheckPasses(i) == ~IsGone(i) /\ ~IsMany(i) /\ ~IsChanged(i) /\ ~IsExpired(i)

----------------------------------------------------------------------------
(* What a scan does.                                                       *)

KeepKey == UNCHANGED <<accepted, authority>>
DropKey == accepted' = None /\ authority' = None /\ fplcSelection' = None
LOCAL GoTo(s) == fplcState' = s /\ fplcElapsed' = 0
LOCAL Keep == KeepKey /\ UNCHANGED <<fplcSelection, mode>>
GoOn(s, i) == fplcState' = s /\ fplcElapsed' = Now(i) /\ Keep
Proceed(s) == GoTo(s) /\ Keep
Wait(i, limit) == UNCHANGED fplcState /\ fplcElapsed' = Min(Now(i), limit) /\ Keep
LOCAL Untimed == UNCHANGED fplc

EnterError == GoTo("Error") /\ DropKey /\ mode' = IF ON_ERROR = "none" THEN {} ELSE mode
EnterClear == GoTo("Clear") /\ DropKey /\ UNCHANGED mode
EnterSettle == GoTo("Settle") /\ KeepKey /\ fplcSelection' = None /\ UNCHANGED mode

----------------------------------------------------------------------------
(* The check before every step, Figures 3 and 9.                           *)

\* EKS-KS-6, EKS-2-11, E-09, E-62: several outputs outside the pulse are a fault of the EKS, also without LA
TooManyOutputs(i) ==
    /\ \/ IsMany(i)
       \/ fplcState = "Start" /\ Many(i)
       \/ fplcState = "Idle" /\ ~i.LA /\ Many(i)
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

\* EKS-2-8, EKS-4-4, EKS-4-6, EKS-4-8, EKS-8-11, E-03, E-06, E-15, E-25d, E-30, E-32, E-64: expiry is tested before
\* success
DeadlineExpired(i) ==
    /\ IsExpired(i) /\ ~IsGone(i) /\ ~IsMany(i) /\ ~IsChanged(i)
    /\ EnterError
    /\ Did("DeadlineExpired")

----------------------------------------------------------------------------
(* Power-up, waiting for a key.                                            *)

\* EKS-GP-5, E-25c, E-56: power-up; a key in the reader must be taken out first
LeaveStart(i) ==
    /\ fplcState = "Start" /\ ~Many(i) /\ ZerosReturned(i)
    /\ Proceed("Idle")
    /\ Did("LeaveStart")
\* E-25c
AwaitPowerUpZeros(i) ==
    /\ fplcState = "Start" /\ ~Many(i) /\ ~ZerosReturned(i)
    /\ Wait(i, T_DWELL)
    /\ Did("AwaitPowerUpZeros")

\* EKS-9-1-FPLC, EKS-9-2, EKS-9-3, E-36
AwaitKey(i) == fplcState = "Idle" /\ ~i.LA /\ ~Many(i) /\ Untimed /\ Did("AwaitKey")
\* EKS-2-6, EKS-9-4-FPLC, E-17, E-40, E-73: the pulse has its deadline from LA on, whatever the outputs show
DetectKey(i) == fplcState = "Idle" /\ i.LA /\ Proceed("PulseOnes") /\ Did("DetectKey")

----------------------------------------------------------------------------
(* The test pulse, Figure 4.                                               *)

\* EKS-2-6, EKS-2-7, EKS-2-10, EKS-4-1, E-10: patterns between are waited out
AwaitOnes(i) == fplcState = "PulseOnes" /\ i.vec # MSO /\ Wait(i, T_ON) /\ Did("AwaitOnes")
\* EKS-2-6, EKS-2-10, EKS-4-1, EKS-4-2, E-38: the sequence timer goes on from LA, or is started here
SeeOnes(i) ==
    /\ fplcState = "PulseOnes" /\ i.vec = MSO
    /\ IF T_SEQ_FROM = "LA" THEN GoOn("PulseZeros", i) ELSE Proceed("PulseZeros")
    /\ Did("SeeOnes")
\* EKS-4-3, EKS-4-4, E-39
AwaitPulseZeros(i) == fplcState = "PulseZeros" /\ i.vec # {} /\ Wait(i, T_SEQ) /\ Did("AwaitPulseZeros")
\* EKS-4-3, EKS-4-5: the timer goes on
SeePulseZeros(i) == fplcState = "PulseZeros" /\ i.vec = {} /\ GoOn("OneOutput", i) /\ Did("SeePulseZeros")
\* EKS-4-5, EKS-4-6
AwaitOneOutput(i) == fplcState = "OneOutput" /\ i.vec = {} /\ Wait(i, T_SEQ) /\ Did("AwaitOneOutput")
\* EKS-2-10, EKS-2-11, EKS-4-5, EKS-4-7, EKS-KS-5: one of five
AcceptOutput(i) ==
    /\ fplcState = "OneOutput" /\ i.vec # {}
    /\ \E a \in i.vec : accepted' = a
    /\ GoTo("Authorize")
    /\ UNCHANGED <<authority, fplcSelection, mode>>
    /\ Did("AcceptOutput")

----------------------------------------------------------------------------
(* Authorization and selection.                                            *)

\* E-54: a word that is there before anything was offered answers nothing
EarlyWord(i) == ~NoWords(i)
\* E-54
RefuseEarlyWord(i) == fplcState = "Authorize" /\ EarlyWord(i) /\ EnterError /\ Did("RefuseEarlyWord")
\* EKS-T2-3, E-02: A, B, C, D, STR are the levels 0 to 4, by Table 2
LevelOf(output) == output
\* EKS-2-12, EKS-SD-1, E-18: the level comes from the outputs and is kept in private memory
PublishAuthority(i) ==
    /\ fplcState = "Authorize" /\ ~EarlyWord(i)
    /\ \E a \in i.vec : authority' = LevelOf(a)
    /\ GoTo("AwaitSelection")
    /\ UNCHANGED <<accepted, fplcSelection, mode>>
    /\ Did("PublishAuthority")

\* EKS-2-17, EKS-2-20, E-65: nothing is acknowledged before the echo
Silent(i) == i.MW07 = 0
\* EKS-2-17
AwaitMW03(i) == fplcState = "AwaitSelection" /\ Silent(i) /\ i.MW03 = 0 /\ Untimed /\ Did("AwaitMW03")
\* EKS-2-17
SeeSelection(i) ==
    /\ fplcState = "AwaitSelection" /\ Silent(i) /\ i.MW03 # 0
    /\ Proceed("CheckSelection")
    /\ Did("SeeSelection")

\* E-16: the selection must stand unchanged until the switchover
SelectionStands(i) == i.MW03 = SE[fplcSelection]
StandsIn(s, i) == fplcState = s /\ SelectionStands(i)

\* E-11, E-15, E-65: an acknowledgment that nobody asked for
UnexpectedAcknowledgment(i) ==
    /\ fplcState \in {"AwaitSelection", "CheckSelection"} \/ StandsIn("EchoSelection", i)
    /\ ~Silent(i)
    /\ EnterError
    /\ Did("UnexpectedAcknowledgment")

\* EKS-2-12, EKS-2-18, EKS-5-1, E-12, E-18: range and authority, by the level in private memory
MayBeSelected(i) == Permitted(authority, ModeOf(SE, i.MW03))
\* EKS-2-19, E-61: neither zero, which takes the selection back, nor one of the five words
IsNoCode(i) == i.MW03 # 0 /\ ModeOf(SE, i.MW03) = None
\* EKS-2-18, EKS-2-19, EKS-5-1 to the end of Figure 5, EKS-5-9, EKS-6-1, EKS-6-3, EKS-6-5, EKS-6-7, EKS-6-9,
\* EKS-6-11, EKS-5-3, EKS-5-5, EKS-5-7, E-12, E-14, E-16, E-47: range and authority in one scan, then the
\* selection is latched.  E-71: also that of the mode that is active
AcceptSelection(i) ==
    /\ fplcState = "CheckSelection" /\ Silent(i) /\ MayBeSelected(i)
    /\ fplcSelection' = ModeOf(SE, i.MW03)
    /\ GoTo("EchoSelection")
    /\ KeepKey /\ UNCHANGED mode
    /\ Did("AcceptSelection")
\* EKS-2-18, EKS-2-19, EKS-5-2, EKS-5-4, EKS-5-6, EKS-5-8, EKS-5-10, EKS-6-12, E-12, E-14
\* E-61: from there until the switchover a word that is no code is refused as well, whatever MW07 shows
RefuseSelection(i) ==
    /\ \/ fplcState = "CheckSelection" /\ Silent(i) /\ i.MW03 # 0 /\ ~MayBeSelected(i)
       \/ fplcState \in Transaction /\ IsNoCode(i)
    /\ EnterError
    /\ Did("RefuseSelection")

----------------------------------------------------------------------------
(* Echo, acknowledgment, switchover.                                       *)

\* EKS-2-25, E-16, E-21, E-61: the panel took the selection back, or changed it to another one
WithdrawSelection(i) ==
    /\ \/ fplcState = "CheckSelection" /\ Silent(i) /\ i.MW03 = 0
       \/ fplcState \in Transaction /\ ~SelectionStands(i) /\ ~IsNoCode(i)
    /\ EnterSettle
    /\ Did("WithdrawSelection")

\* EKS-2-20
PublishEcho(i) ==
    /\ StandsIn("EchoSelection", i) /\ Silent(i)
    /\ Proceed("AwaitAcknowledgment")
    /\ Did("PublishEcho")
\* EKS-2-20, E-11: the wait that the text does not have
AwaitMW07(i) == StandsIn("AwaitAcknowledgment", i) /\ i.MW07 = 0 /\ Untimed /\ Did("AwaitMW07")
\* EKS-2-27, E-11
SeeAcknowledgment(i) ==
    /\ StandsIn("AwaitAcknowledgment", i) /\ i.MW07 # 0
    /\ Proceed("CheckAcknowledgment")
    /\ Did("SeeAcknowledgment")

\* EKS-2-27: one of the five words of MW07
IsAcknowledgment(i) == ModeOf(SW, i.MW07) # None
\* EKS-2-27, EKS-7-1, EKS-7-3, EKS-7-5, EKS-7-7, EKS-7-9, E-01, E-13
AcceptAcknowledgment(i) ==
    /\ StandsIn("CheckAcknowledgment", i) /\ IsAcknowledgment(i)
    /\ Proceed("Match")
    /\ Did("AcceptAcknowledgment")
\* EKS-2-27, EKS-7-12, E-13
RefuseAcknowledgment(i) ==
    /\ StandsIn("CheckAcknowledgment", i) /\ i.MW07 # 0 /\ ~IsAcknowledgment(i)
    /\ EnterError
    /\ Did("RefuseAcknowledgment")

\* E-21, E-66: the acknowledgment went away again
WithdrawAcknowledgment(i) ==
    /\ StandsIn("CheckAcknowledgment", i) \/ StandsIn("Match", i) \/ StandsIn("Switch", i)
    /\ i.MW07 = 0
    /\ EnterSettle
    /\ Did("WithdrawAcknowledgment")

\* EKS-2-28, E-01, E-13: the pair of Table 2, each row for itself
Matches(i) == i.MW07 = SW[fplcSelection]
\* EKS-2-28, EKS-7-2, EKS-7-4, EKS-7-6, EKS-7-8, EKS-7-10, EKS-7-11, E-01
MatchWords(i) == StandsIn("Match", i) /\ Matches(i) /\ Proceed("Switch") /\ Did("MatchWords")
\* EKS-2-28, EKS-7-12, E-13, E-66: also in the scan that would switch
RefuseMatch(i) ==
    /\ StandsIn("Match", i) \/ StandsIn("Switch", i)
    /\ i.MW07 # 0 /\ ~Matches(i)
    /\ EnterError
    /\ Did("RefuseMatch")

\* EKS-2-29, EKS-SD-2, E-01, E-15, E-16, E-18, E-42, E-71: every guard is evaluated again in the scan that switches
SwitchMode(i) ==
    /\ StandsIn("Switch", i) /\ Matches(i)
    /\ mode' = {fplcSelection}
    /\ GoTo(IF SELECTIONS = "once" THEN "Complete" ELSE "Settle")
    /\ KeepKey /\ fplcSelection' = IF SELECTIONS = "once" THEN fplcSelection ELSE None
    /\ Did("SwitchMode")
\* EKS-2-29, EKS-8-6, EKS-GP-5, EKS-KS-8, E-15: where each insertion has one selection, only the check before
\* every step goes on; MW01 and MW05 stay as steps 12 and 20 left them, whatever MW03 and MW07 show
AwaitRemoval(i) == fplcState = "Complete" /\ Untimed /\ Did("AwaitRemoval")

\* EKS-GP-5, E-15: before the next selection both words must have been zero
AwaitSettled(i) ==
    /\ fplcState = "Settle" /\ ~(NoWords(i) /\ Dwelt(i))
    /\ Wait(i, T_REM)
    /\ Did("AwaitSettled")
\* EKS-GP-5, E-15, E-52
LeaveSettle(i) ==
    /\ fplcState = "Settle" /\ NoWords(i) /\ Dwelt(i)
    /\ Proceed("AwaitSelection")
    /\ Did("LeaveSettle")

----------------------------------------------------------------------------
(* Removal, Figures 8 and 9, and the way out of the error mode.            *)

\* EKS-8-3, EKS-8-6, E-27, E-34: the words fell to zero in the scan that saw the key go; the timer goes on
ClearWords(i) == fplcState = "Clear" /\ GoOn("AwaitZeros", i) /\ Did("ClearWords")
\* EKS-8-11, EKS-8-12, EKS-9-4-FPLC, E-17, E-30, E-31, E-32, E-36: whatever the key does meanwhile
AwaitReturnedZeros(i) ==
    /\ fplcState = "AwaitZeros" /\ ~ZerosReturned(i)
    /\ Wait(i, T_REM)
    /\ Did("AwaitReturnedZeros")
\* EKS-8-12, EKS-8-13, EKS-8-14, EKS-8-18, E-29, E-31, E-52
LeaveAwaitZeros(i) ==
    /\ fplcState = "AwaitZeros" /\ ZerosReturned(i)
    /\ Proceed("Idle")
    /\ Did("LeaveAwaitZeros")

\* EKS-3-0, EKS-9-0, EKS-SD-9, E-22, E-23, E-23b
StayInError(i) == fplcState = "Error" /\ ~ZerosReturned(i) /\ Wait(i, T_DWELL) /\ Did("StayInError")
\* EKS-3-0, EKS-9-0, EKS-GP-4, E-23, E-52: the key is out and zeros went round; never back into a transaction
LeaveError(i) == fplcState = "Error" /\ ZerosReturned(i) /\ Proceed("Idle") /\ Did("LeaveError")

----------------------------------------------------------------------------
\* The steps, grouped by the states in which they can fire
FplcStep(i) ==
    CASE fplcState = "Start" -> LeaveStart(i) \/ AwaitPowerUpZeros(i) \/ TooManyOutputs(i)
      [] fplcState = "Idle" -> AwaitKey(i) \/ DetectKey(i) \/ TooManyOutputs(i)
      [] fplcState = "PulseOnes" -> AwaitOnes(i) \/ SeeOnes(i)
      [] fplcState = "PulseZeros" -> AwaitPulseZeros(i) \/ SeePulseZeros(i)
      [] fplcState = "OneOutput" -> AwaitOneOutput(i) \/ AcceptOutput(i)
      [] fplcState = "Authorize" -> RefuseEarlyWord(i) \/ PublishAuthority(i)
      [] fplcState = "AwaitSelection" -> AwaitMW03(i) \/ SeeSelection(i) \/ UnexpectedAcknowledgment(i)
      [] fplcState = "CheckSelection" ->
            AcceptSelection(i) \/ RefuseSelection(i) \/ WithdrawSelection(i) \/ UnexpectedAcknowledgment(i)
      [] fplcState = "EchoSelection" ->
            PublishEcho(i) \/ UnexpectedAcknowledgment(i) \/ WithdrawSelection(i) \/ RefuseSelection(i)
      [] fplcState = "AwaitAcknowledgment" ->
            AwaitMW07(i) \/ SeeAcknowledgment(i) \/ WithdrawSelection(i) \/ RefuseSelection(i)
      [] fplcState = "CheckAcknowledgment" ->
            \/ AcceptAcknowledgment(i) \/ RefuseAcknowledgment(i) \/ WithdrawAcknowledgment(i)
            \/ WithdrawSelection(i) \/ RefuseSelection(i)
      [] fplcState = "Match" ->
            \/ MatchWords(i) \/ RefuseMatch(i) \/ WithdrawAcknowledgment(i)
            \/ WithdrawSelection(i) \/ RefuseSelection(i)
      [] fplcState = "Switch" ->
            \/ SwitchMode(i) \/ RefuseMatch(i) \/ WithdrawAcknowledgment(i)
            \/ WithdrawSelection(i) \/ RefuseSelection(i)
      [] fplcState = "Complete" -> AwaitRemoval(i)
      [] fplcState = "Settle" -> AwaitSettled(i) \/ LeaveSettle(i)
      [] fplcState = "Clear" -> ClearWords(i)
      [] fplcState = "AwaitZeros" -> AwaitReturnedZeros(i) \/ LeaveAwaitZeros(i)
      [] fplcState = "Error" -> StayInError(i) \/ LeaveError(i)

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
    MW05 # 0 =>
        /\ fplcSelection # None /\ Permitted(authority, fplcSelection)
        /\ MW05 = CH[fplcSelection] /\ MW01 = RE[authority]

\* EKS-8-6, EKS-8-8, E-27: without an accepted key both words of the F-PLC are zero
WordsZeroWithoutKey == accepted = None => MW01 = 0 /\ MW05 = 0

\* EKS-2-18, EKS-T2-2: a latched selection never exceeds the level
SelectionWithinAuthority ==
    /\ fplcSelection # None => Permitted(authority, fplcSelection)
    /\ authority # None => authority = accepted
=============================================================================
