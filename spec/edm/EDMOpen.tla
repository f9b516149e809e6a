------------------------------ MODULE EDMOpen -------------------------------
(***************************************************************************)
(* The block alone with arbitrary inputs in every call: the environment    *)
(* `arbitrary`, and the graph that implementations are compared with.      *)
(* An observer of the wires keeps what the properties speak about; nothing *)
(* of the block reads it.                                                  *)
(* Leaves out contactors that behave in any particular way.                *)
(***************************************************************************)
EXTENDS TLC, EDM

CONSTANT PRINT_GRAPH    \* TRUE: print inputs, states and edges

VARIABLES
    in,           \* the number of the last call's input; hidden by VIEW
    beat,         \* changes in every call, so that no call escapes an action property; hidden by VIEW
    resetWas,     \* Reset in the last call
    controlWas,   \* S_OutControl in the last call
    unchanged,    \* ticks since S_EDM_Out or SafetyDemand last changed, while one of them is TRUE
    released      \* while SafetyDemand: S_OutControl was FALSE since a Reset by hand, or there was none

observer == <<resetWas, controlWas, unchanged, released>>
View == edm
ObservedView == <<edm, observer>>

Bit(n, b) == (n \div b) % 2 = 1
N == 64 * 3
Alphabet == [n \in 0..N - 1 |->
    [Activate |-> Bit(n, 1), S_OutControl |-> Bit(n, 2), S_EDM1 |-> Bit(n, 4), S_EDM2 |-> Bit(n, 8),
     S_StartReset |-> Bit(n, 16), Reset |-> Bit(n, 32), dt |-> n \div 64]]

ASSUME PRINT_GRAPH => \A n \in 0..N - 1 : PrintT(ToString(<<"INPUT", n, Alphabet[n]>>))
PrintState == PRINT_GRAPH => PrintT(ToString(<<"STATE", View, EDMOutputs>>))
PrintEdge == PRINT_GRAPH => PrintT(ToString(<<"EDGE", View, step', in', View'>>))

OpenInit ==
    /\ EDMInit /\ step = "" /\ in = 0 /\ beat = FALSE
    /\ resetWas = FALSE /\ controlWas = FALSE /\ unchanged = 0 /\ released = FALSE
    /\ PRINT_GRAPH => PrintT(ToString(<<"INIT", View>>))

\* Reset by hand: the request for it goes in a call with an edge, which the start-up inhibit needs only where
\* there is one
ByHand(i) == ResetRequest /\ SafetyDemand' /\ i.Reset /\ ~resetWas /\ (Error \/ ~i.S_StartReset)
Observe(i) ==
    /\ resetWas' = i.Reset
    /\ controlWas' = i.S_OutControl
    /\ unchanged' = IF (S_EDM_Out /\ S_EDM_Out') \/ (SafetyDemand /\ SafetyDemand')
                    THEN Counted(unchanged, i.dt, MONITORING_TIME) ELSE 0
    /\ released' = (SafetyDemand' /\ IF ByHand(i) THEN ~i.S_OutControl
                                     ELSE ~SafetyDemand \/ released \/ ~i.S_OutControl)

OpenNext == \E n \in 0..N - 1 : \E i \in {Alphabet[n]} : EDMCall(i) /\ in' = n /\ beat' = ~beat /\ Observe(i)
OpenSpec == OpenInit /\ [][OpenNext]_<<edm, observer, step, in, beat>>

----------------------------------------------------------------------------
(* Action properties, judged in every call.                                *)

\* The input of the call that is judged
Scanned == Alphabet[in']
\* For a reader of a trace: what a call found on the wires and what stands on them after it
Wires == Alphabet[in] @@ EDMOutputs

ResetEdge == Scanned.Reset /\ ~resetWas
BothAre(dropped) == Scanned.S_EDM1 = dropped /\ Scanned.S_EDM2 = dropped
OnTime == unchanged + Scanned.dt < MONITORING_TIME
\* EDM-IN-RESET-4, EDMF-04: S_OutControl counts as it stands, or once it was FALSE since a reset by hand
Counts == AFTER_RESET = "at_once" \/ released

\* EDM-IN-ACTIVATE, EDM-IN-CONTROL-2, EDM-OUT-EDM-1: in the very call that is not active, or asks for the stop
StopAtOnce == [][~Scanned.Activate \/ ~Scanned.S_OutControl => ~S_EDM_Out']_beat
\* EDM-OUT-READY-1
InactiveAtOnce == [][Ready' = Scanned.Activate]_beat
\* EDM-IN-EDM-2, EDM-OUT-EDM-2, EDM-SEQ-3: in the very call that switches on
SwitchOnNeedsInitialState ==
    [][~S_EDM_Out /\ S_EDM_Out' => SafetyDemand /\ BothAre(TRUE) /\ Scanned.S_OutControl]_beat
\* EDM-IN-TIME-1, EDM-OUT-EDM-2, EDMF-08: the output stays on over a wrong feedback only for MonitoringTime
FeedbackWrongOnlyForATime == [][S_EDM_Out /\ S_EDM_Out' => OnTime \/ BothAre(FALSE)]_beat
\* EDM-IN-TIME-1, EDM-SEQ-5, EDMF-06: whatever else happens in that call, but the end of Activate
MissedPickUpIsAnError ==
    [][S_EDM_Out /\ Scanned.Activate /\ ~OnTime /\ ~BothAre(FALSE) => Error']_beat
\* EDM-IN-TIME-1, EDM-SEQ-4
MissedDropOutIsAnError ==
    [][SafetyDemand /\ Scanned.Activate /\ ~OnTime /\ ~BothAre(TRUE) => Error']_beat
\* EDM-IN-START-1, EDM-IN-START-2, EDM-IN-RESET-1, EDM-IN-RESET-3: neither the inhibit nor an error goes
\* without a fresh edge
ResetNeedsEdge ==
    [][ResetRequest /\ Ready' /\ ~ResetRequest' /\ ~Error'
        => ResetEdge \/ (~Error /\ Scanned.S_StartReset)]_beat
\* EDM-IN-RESET-1, EDMF-07: an error is reset only with both contactors dropped out
CauseIsGone == [][Error /\ ResetRequest /\ Ready' /\ ~Error' => BothAre(TRUE)]_beat
\* EDM-OUT-ERROR, EDM-IN-RESET-1, EDM-SEQ-6: out of an error lead the reset, and the way back to the inhibit
\* once Reset is released
ErrorsAreLeftAsDocumented ==
    [][Error /\ Ready' /\ ~Error'
        => IF ResetRequest THEN SafetyDemand' ELSE ResetRequest' /\ ~Scanned.Reset]_beat
\* EDM-IN-RESET-4, EDMF-04: with stop_first the reset button does not start the machine
ResetNeverStarts == [][~S_EDM_Out /\ S_EDM_Out' => released]_beat
\* EDM-IN-RESET-1, EDMF-10
HeldResetIsAnError ==
    [][ResetRequest /\ Scanned.Activate /\ Scanned.Reset /\ resetWas /\ (Error \/ ~Scanned.S_StartReset)
        => Error' /\ ~ResetRequest']_beat
\* EDM-IN-START-2, EDM-IN-RESET-4, EDMF-11
TwoEdgesAreAnError ==
    [][/\ ResetRequest /\ ~Error /\ Scanned.Activate /\ ~Scanned.S_StartReset
       /\ ResetEdge /\ Scanned.S_OutControl /\ ~controlWas
       => Error' /\ ~ResetRequest']_beat
\* EDM-INST-1, EDM-SEQ-1: from inactive comes the inhibit, for one call at least
StartsWithInhibit == [][~Ready /\ Ready' => ResetRequest' /\ ~Error']_beat
\* Where one transition leads from each state, besides to Idle
Follows ==
    CASE state = "Idle" -> {"Init"}
      [] state = "Init" -> {"OutputDisable", "ResetError1", "InitError"}
      [] state \in {"ResetError1", "InitError"} -> {"Init"}
      [] state = "OutputDisable" -> {"OutputEnable"} \cup {EDMErrors[n] : n \in 1..6}
      [] state = "OutputEnable" -> {"OutputDisable"} \cup {EDMErrors[n] : n \in 7..9}
      [] InEDMError -> {"OutputDisable"} \cup {ResetErrors[n] : n \in {m \in 1..9 : EDMErrors[m] = state}}
      [] InResetError -> {EDMErrors[n] : n \in {m \in 1..9 : ResetErrors[m] = state}}
\* EDM-INST-1, EDM-IN-ACTIVATE, EDMF-12
OneTransitionACall == [][state' \in {state, "Idle"} \cup Follows]_beat
\* EDM-IN-CONTROL-3, EDM-OUT-EDM-2, EDM-SEQ-3: what may switch on does so in that call
SwitchesOnAtOnce ==
    [][SafetyDemand /\ Scanned.Activate /\ BothAre(TRUE) /\ Scanned.S_OutControl /\ Counts
        => S_EDM_Out']_beat
\* EDM-IN-START-1, EDM-IN-START-3: without inhibit nothing is waited for
StartsByItself ==
    [][ResetRequest /\ ~Error /\ Scanned.Activate /\ Scanned.S_StartReset => SafetyDemand']_beat
\* EDM-IN-START-2, EDM-IN-RESET-2, EDM-SEQ-2: the edge of Reset that removes the inhibit
RemovesInhibitAtOnce ==
    [][ResetRequest /\ ~Error /\ Scanned.Activate /\ ResetEdge /\ (controlWas \/ ~Scanned.S_OutControl)
        => SafetyDemand']_beat
\* EDM-IN-RESET-1, EDM-SEQ-6, EDMF-07: the edge of Reset that resets an error whose cause is gone
ResetsAtOnce ==
    [][Error /\ ResetRequest /\ Scanned.Activate /\ ResetEdge /\ BothAre(TRUE) => SafetyDemand']_beat
\* EDM-OUT-ERROR, EDM-SEQ-2, EDM-SEQ-3, EDM-SEQ-6: expiry over the right feedback has no effect, and no error
\* comes without a cause
ErrorNeedsCause ==
    [][~Error /\ Error' =>
        CASE S_EDM_Out -> ~OnTime /\ ~BothAre(FALSE)
          [] SafetyDemand -> ~BothAre(TRUE) /\ (~OnTime \/ (Scanned.S_OutControl /\ Counts))
          [] OTHER -> /\ ~Scanned.S_StartReset /\ Scanned.Reset
                      /\ resetWas \/ (Scanned.S_OutControl /\ ~controlWas)]_beat
\* EDM-OUT-DIAG, EDMF-01, EDMF-10, EDMF-11: the code of an error names the contactor that did not follow, and
\* when; at the inhibit it says whether Reset was held, or rose with the request
CodeNamesTheCause ==
    [][/\ Error' /\ (S_EDM_Out \/ SafetyDemand) =>
            LET dropped == SafetyDemand
                which == IF Scanned.S_EDM2 = dropped THEN 1 ELSE IF Scanned.S_EDM1 = dropped THEN 2 ELSE 3
                group == IF S_EDM_Out THEN 6 ELSE IF OnTime THEN 0 ELSE 3
            IN  DiagCode' = \hC000 + 16 * (group + which)
       /\ Error' /\ ResetRequest /\ ~Error => DiagCode' = IF resetWas THEN \hC001 ELSE InitErrorCode]_beat
\* EDM-IN-RESET-1, EDMF-10: a reset error comes from its error and goes back to it
ResetErrorKeepsTheCode ==
    [][DiagCode >= \hC010 /\ DiagCode # InitErrorCode /\ DiagCode' >= \hC000 =>
        /\ DiagCode' \div 16 = DiagCode \div 16
        /\ DiagCode' % 16 = (IF Scanned.Reset /\ (resetWas \/ ~ResetRequest) THEN 1 ELSE 0)]_beat
\* EDM-INST-1: there is no input to which a call has no answer
EveryCallIsAnswered == \A n \in 0..N - 1 : ENABLED EDMCall(Alphabet[n])
\* EDM-OUT-READY-1, EDM-SEQ-0: before the first call
PowerUpIsSafe == step = "" => ~Ready /\ ~S_EDM_Out
=============================================================================
