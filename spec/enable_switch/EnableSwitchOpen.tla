------------------------- MODULE EnableSwitchOpen -------------------------
(***************************************************************************)
(* The block alone, with any inputs in every call: the graph that          *)
(* implementations of target sf_enable_switch are compared with, and what  *)
(* a single call promises.                                                 *)
(* Leaves out everything that the inputs come from (ESA-02).               *)
(***************************************************************************)
EXTENDS Sequences, TLC, EnableSwitch

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges
VARIABLES in,           \* the number of the last call's input; hidden by VIEW
          beat          \* changes in every call, so that no call escapes an action property; hidden by VIEW

View == block

\* ESF-04: all 8 patterns of the three channels, and every constant combination of S_AutoReset
N == 2 * 2 * 8 * 2 * 2 * 3
Bit(n, weight) == ((n \div weight) % 2) = 1
Alphabet == [n \in 0..N - 1 |->
    [S_EnableSwitchCh1 |-> Bit(n, 4), S_EnableSwitchCh2 |-> Bit(n, 2), S_EnableSwitchCh3 |-> Bit(n, 1),
     Reset |-> Bit(n, 8), S_SafetyActive |-> Bit(n, 16), Activate |-> Bit(n, 32), S_AutoReset |-> Bit(n, 64),
     dt |-> n \div 128]]

Row == BlockOutputs

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Alphabet[n]>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, Row>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit ==
    /\ BlockInit /\ step = "" /\ in = 0 /\ beat = FALSE
    /\ PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>))
OpenNext == \E n \in 0..N - 1 : \E i \in {Alphabet[n]} : BlockCall(i) /\ in' = n /\ beat' = ~beat
OpenSpec == OpenInit /\ [][OpenNext]_<<block, step, in, beat>>

Called == Alphabet[in']
\* For a reader of a trace: what a call found on the wires and what stands on them after it
Wires == Alphabet[in] @@ BlockOutputs

----------------------------------------------------------------------------
(* The outputs of every state.                                             *)

\* Whether this bit of the code is set; the family's meaning of the bits, ESF-01
CodeBit(weight) == ((DiagCode \div weight) % 2) = 1
\* ESF-01: the code says the same as the flags, and 8000 alone is the enable
OutputsFollowTheCode ==
    /\ Ready = CodeBit(32768) /\ Error = CodeBit(16384)
    /\ SafetyDemand = CodeBit(2048) /\ ResetRequest = CodeBit(1024)
    /\ S_EnableSwitchOut = (DiagCode = 32768)
\* ESF-01, ES-NOTE-3: the code of each state, and the outputs that are TRUE in it
RowOf == [
    Idle                      |-> <<\h0000, {}>>,
    BasicMode                 |-> <<\h8002, {"Ready"}>>,
    SafeMode                  |-> <<\h8004, {"Ready"}>>,
    Stage0                    |-> <<\h8802, {"Ready", "SafetyDemand"}>>,
    ChangeToStage1            |-> <<\h8812, {"Ready", "SafetyDemand"}>>,
    Stage1                    |-> <<\h8000, {"Ready", "S_EnableSwitchOut"}>>,
    ChangeToStage0            |-> <<\h8822, {"Ready", "SafetyDemand"}>>,
    Stage2                    |-> <<\h8832, {"Ready", "SafetyDemand"}>>,
    OperationError            |-> <<\hC020, {"Ready", "Error"}>>,
    OperationErrorAtStage0    |-> <<\hC420, {"Ready", "Error", "ResetRequest"}>>,
    PlausibilityError         |-> <<\hC030, {"Ready", "Error"}>>,
    PlausibilityErrorAtStage0 |-> <<\hC440, {"Ready", "Error", "ResetRequest"}>>,
    EquivalenceError          |-> <<\hC050, {"Ready", "Error"}>>,
    EquivalenceErrorAtStage0  |-> <<\hC450, {"Ready", "Error", "ResetRequest"}>>,
    ResetError1               |-> <<\hC001, {"Ready", "Error"}>>,
    ResetError2               |-> <<\hC011, {"Ready", "Error"}>>,
    ResetError3               |-> <<\hC021, {"Ready", "Error"}>>]
\* ESF-01, ES-SEQ-0, ES-SEQ-1, ES-SEQ-3, ES-SEQ-4, ES-SEQ-6, ES-SEQ-7: the outputs are the row of the state
EveryStateHasItsRow ==
    /\ DiagCode = RowOf[state][1]
    /\ \A name \in DOMAIN BlockOutputs \ {"DiagCode"} : BlockOutputs[name] = (name \in RowOf[state][2])
\* ES-SEQ-0: not active, every output is FALSE
IdleIsSilent ==
    state = "Idle" => BlockOutputs = [Ready |-> FALSE, S_EnableSwitchOut |-> FALSE, SafetyDemand |-> FALSE,
                                      ResetRequest |-> FALSE, Error |-> FALSE, DiagCode |-> 0]
\* ES-SEQ-3, ES-SEQ-4: never the enable beside an error, a reset that is waited for, or a stage that is not 1
EnableStandsAlone == S_EnableSwitchOut => Ready /\ ~Error /\ ~ResetRequest /\ ~SafetyDemand
\* There is no input to which a call has no answer
EveryCallIsAnswered == \A n \in 0..N - 1 : ENABLED BlockCall(Alphabet[n])
\* ES-SEQ-0: before the first call nothing is TRUE
PowerUpIsSilent == step = "" => state = "Idle" /\ elapsed = 0 /\ ~resetBefore

----------------------------------------------------------------------------
(* What one call promises.                                                 *)

\* ES-STAGE-1, ES-SEQ-1, ES-SEQ-7: the enable needs all of this in that very call
EnableNeedsItsConditions ==
    [][S_EnableSwitchOut' =>
        /\ Called.Activate /\ Called.S_SafetyActive
        /\ Called.S_EnableSwitchCh1 /\ ~Called.S_EnableSwitchCh2 /\ Called.S_EnableSwitchCh3]_beat
\* ES-SEQ-0: the end of Activate is answered before everything else
ActivateGoesFirst == [][Ready' = Called.Activate]_beat
\* ES-SEQ-1, ESF-08: without the mode there is no demand and no enable; an error is kept
ModeEndsOperation ==
    [][~Called.S_SafetyActive => /\ ~S_EnableSwitchOut' /\ ~SafetyDemand'
                                 /\ (~Error /\ Called.Activate) => DiagCode' = 32770]_beat
\* ES-RESTART, ESF-14: no edge is needed
Automatic == AUTO_RESET_ERRORS /\ Called.S_AutoReset
\* ES-STAGE-0, ES-SEQ-5, ES-RESTART, ESF-06: an error of an active block is left at stage 0 alone, by a reset
ErrorNeedsReset ==
    [][(Error /\ ~Error' /\ Called.Activate) =>
        /\ SeesStage0(Called) /\ ResetRequest
        /\ Automatic \/ (Called.Reset /\ ~resetBefore)]_beat
\* ES-SEQ-5, ESF-14: no error ends without an edge
ErrorNeedsEdge ==
    [][(Error /\ ~Error' /\ Called.Activate /\ (MODE_ENDS_ERROR => Called.S_SafetyActive)) =>
        Called.Reset /\ ~resetBefore]_beat
\* ESF-08: where the parameter lets the end of the mode end an error, nothing else does without a reset
ErrorNeedsResetInTheMode ==
    [][(Error /\ ~Error' /\ Called.Activate /\ Called.S_SafetyActive) =>
        /\ SeesStage0(Called) /\ ResetRequest
        /\ Automatic \/ (Called.Reset /\ ~resetBefore)]_beat
\* The three channels as the call found them
Shown == <<Called.S_EnableSwitchCh1, Called.S_EnableSwitchCh2, Called.S_EnableSwitchCh3>>
\* ES-SEQ-5, ES-RESTART, ESF-06, ESF-08: where a reset is waited for, it ends the error in that very call
ResetEndsTheError ==
    [][/\ ResetRequest /\ Called.Activate /\ Shown = <<FALSE, TRUE, FALSE>>
       /\ Automatic \/ (Called.Reset /\ ~resetBefore)
       /\ MODE_ENDS_ERROR => Called.S_SafetyActive
       => state' = IF Called.S_SafetyActive THEN "Stage0" ELSE "BasicMode"]_beat
\* ES-RESTART, ESF-08: what the parameter is for
EndOfModeEndsErrors ==
    [][(MODE_ENDS_ERROR /\ Error /\ Called.Activate /\ ~Called.S_SafetyActive) => state' = "BasicMode"]_beat
\* ES-SEQ-3, ESF-05, ESF-07: a change that is too late ends in the error of its cause
LateChangeHasItsError ==
    [][/\ state \in {"ChangeToStage1", "ChangeToStage0"} /\ elapsed + Called.dt >= DiscrepancyTimeCh1_Ch3
       /\ Called.Activate /\ Called.S_SafetyActive
       => state' = IF Shown = <<TRUE, TRUE, TRUE>> THEN "PlausibilityError" ELSE "EquivalenceError"]_beat
\* ESF-10: a Reset that is held where its edge is waited for is an error of its own, until it is released
HeldResetIsAnError ==
    [][Called.Activate =>
        /\ (ResetRequest /\ SeesStage0(Called) /\ Called.Reset /\ resetBefore /\ ~Automatic) =>
               (state' \in ResetErrors \/ (MODE_ENDS_ERROR /\ ~Called.S_SafetyActive))
        /\ (state \in ResetErrors /\ Called.Reset) =>
               (state' = state \/ (MODE_ENDS_ERROR /\ ~Called.S_SafetyActive))]_beat

----------------------------------------------------------------------------
(* One transition a call, whatever the inputs are: the pairs of states     *)
(* that a call may join.                                                   *)

LOCAL Stages == {"Stage0", "Stage1", "Stage2"}
\* ES-SEQ-0, ES-SEQ-1, ES-SEQ-2, ES-SEQ-5, ES-ORDER-2, ESF-02, ESF-06, ESF-08: the ways out of each state
WaysOut ==
    [s \in States |->
        {s, "Idle"} \cup
        (IF s \in Operating \/ (MODE_ENDS_ERROR /\ s \in Errors) THEN {"BasicMode"} ELSE {}) \cup
        (CASE s = "Idle" -> {"BasicMode"}
           [] s = "BasicMode" -> {"SafeMode"}
           [] s = "SafeMode" -> {"Stage0", "OperationError"}
           [] s = "Stage0" -> {"ChangeToStage1", "Stage1", "Stage2"}
           [] s = "ChangeToStage1" -> Stages \cup {"EquivalenceError", "PlausibilityError"}
           [] s = "Stage1" -> {"ChangeToStage0", "Stage0", "Stage2"}
           [] s = "ChangeToStage0" -> {"Stage0", "Stage2", "EquivalenceError", "PlausibilityError"}
           [] s = "Stage2" -> {"ChangeToStage0", "Stage0", "PlausibilityError"}
           [] s = "OperationError" -> {"OperationErrorAtStage0"}
           [] s = "PlausibilityError" -> {"PlausibilityErrorAtStage0"}
           [] s = "EquivalenceError" -> {"EquivalenceErrorAtStage0"}
           [] s = "OperationErrorAtStage0" -> {"OperationError", "ResetError1", "Stage0", "BasicMode"}
           [] s = "PlausibilityErrorAtStage0" -> {"PlausibilityError", "ResetError2", "Stage0", "BasicMode"}
           [] s = "EquivalenceErrorAtStage0" -> {"EquivalenceError", "ResetError3", "Stage0", "BasicMode"}
           [] s = "ResetError1" -> {"OperationErrorAtStage0"}
           [] s = "ResetError2" -> {"PlausibilityErrorAtStage0"}
           [] s = "ResetError3" -> {"EquivalenceErrorAtStage0"}
           [] OTHER -> {})]
\* ES-NOTE-1, ES-ORDER-2: a call joins two states that are neighbours, and no others
OneTransitionACall == [][state' \in WaysOut[state]]_beat

----------------------------------------------------------------------------
(* The 8 patterns of the channels in every state, where nothing else       *)
(* decides: the block is active, the mode is on, the time of a change is   *)
(* not over, Reset and S_AutoReset are FALSE.                              *)

\* ES-STAGE-0, ES-STAGE-1, ES-STAGE-2, ES-ORDER-2, ESF-02, ESF-03, ESF-04, ESF-05, ESF-06: the ways.
\* Columns: channels 1, 2, 3 as FFF, FFT, FTF, FTT, TFF, TFT, TTF, TTT.  "" is the state itself.
LOCAL Same == <<"", "", "", "", "", "", "", "">>
LOCAL Always(s) == <<s, s, s, s, s, s, s, s>>
LOCAL OnlyAtStage0(s, t) == <<t, t, s, t, t, t, t, t>>
PatternTable ==
    [s \in States |->
        CASE s = "Idle" -> Always("BasicMode")
          [] s = "BasicMode" -> Always("SafeMode")
          [] s = "SafeMode" -> OnlyAtStage0("Stage0", "OperationError")
          [] s = "Stage0" ->
                <<"Stage2", "ChangeToStage1", "", "ChangeToStage1",
                  "ChangeToStage1", "Stage1", "ChangeToStage1", "ChangeToStage1">>
          [] s = "ChangeToStage1" -> <<"Stage2", "", "Stage0", "", "", "Stage1", "", "">>
          [] s = "Stage1" ->
                <<"Stage2", "ChangeToStage0", "Stage0", "ChangeToStage0",
                  "ChangeToStage0", "", "ChangeToStage0", "ChangeToStage0">>
          [] s = "ChangeToStage0" -> <<"Stage2", "", "Stage0", "", "", "PlausibilityError", "", "">>
          [] s = "Stage2" ->
                <<"", "ChangeToStage0", "Stage0", "ChangeToStage0",
                  "ChangeToStage0", "PlausibilityError", "ChangeToStage0", "ChangeToStage0">>
          [] s = "OperationError" -> OnlyAtStage0("OperationErrorAtStage0", "")
          [] s = "PlausibilityError" -> OnlyAtStage0("PlausibilityErrorAtStage0", "")
          [] s = "EquivalenceError" -> OnlyAtStage0("EquivalenceErrorAtStage0", "")
          [] s = "OperationErrorAtStage0" -> OnlyAtStage0("", "OperationError")
          [] s = "PlausibilityErrorAtStage0" -> OnlyAtStage0("", "PlausibilityError")
          [] s = "EquivalenceErrorAtStage0" -> OnlyAtStage0("", "EquivalenceError")
          [] s = "ResetError1" -> Always("OperationErrorAtStage0")
          [] s = "ResetError2" -> Always("PlausibilityErrorAtStage0")
          [] s = "ResetError3" -> Always("EquivalenceErrorAtStage0")
          [] OTHER -> Same]
Column == 1 + (in' % 8)
Plain ==
    /\ Called.Activate /\ Called.S_SafetyActive /\ ~Called.Reset /\ ~Called.S_AutoReset
    /\ state \notin Timed \/ elapsed + Called.dt < DiscrepancyTimeCh1_Ch3
\* ES-STAGE-0, ES-STAGE-1, ES-STAGE-2, ES-SEQ-6, ES-SEQ-7, ES-SEQ-8, ESF-04: every pattern in every state
PatternsDecide ==
    [][Plain =>
        state' = (IF PatternTable[state][Column] = "" THEN state ELSE PatternTable[state][Column])]_beat
=============================================================================
