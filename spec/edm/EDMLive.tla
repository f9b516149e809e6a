------------------------------ MODULE EDMLive -------------------------------
(***************************************************************************)
(* What must happen in the end: from whatever state and after whatever     *)
(* inputs, once the causes are gone and everybody does what the document   *)
(* asks for, the output is on and stays on.  From some call on             *)
(*  - the block is active, and the contactors follow S_EDM_Out,            *)
(*  - Reset is pressed when ResetRequest shows, and then let go,           *)
(*  - the machine control takes its request back once, and asks for the    *)
(*    output while SafetyDemand or S_EDM_Out shows (EDMA-06).              *)
(* Fairness: the block goes on being called.                               *)
(* Leaves out: how many calls it takes (a theorem says that).              *)
(***************************************************************************)
EXTENDS EDM

CONSTANT TAKES_BACK     \* the machine control takes its request back

VARIABLE calm           \* "no": any inputs; "first": everybody does his part from now on; "on": after it

liveVars == <<edm, calm>>

ASSUME TAKES_BACK \in BOOLEAN

AnyInput ==
    [Activate : BOOLEAN, S_OutControl : BOOLEAN, S_EDM1 : BOOLEAN, S_EDM2 : BOOLEAN,
     S_StartReset : BOOLEAN, Reset : BOOLEAN, dt : 0..2]
\* EDM-SEQ-2, EDM-SEQ-3, EDM-SEQ-6, EDM-APP-2, EDM-APP-3, EDMA-06
CalmInput ==
    {[Activate |-> TRUE, S_OutControl |-> (SafetyDemand \/ S_EDM_Out) /\ (calm = "first" => ~TAKES_BACK),
      S_EDM1 |-> ~S_EDM_Out, S_EDM2 |-> ~S_EDM_Out, S_StartReset |-> start,
      Reset |-> ResetRequest /\ ~resetBefore, dt |-> dt] : start \in BOOLEAN, dt \in 0..2}

AnyCall == calm = "no" /\ (\E i \in AnyInput : EDMCall(i)) /\ UNCHANGED calm
CalmDown == calm = "no" /\ calm' = "first" /\ UNCHANGED <<edm, step>>
CalmCall == calm # "no" /\ (\E i \in CalmInput : EDMCall(i)) /\ calm' = "on"

LiveNext == AnyCall \/ CalmDown \/ CalmCall
LiveSpec ==
    /\ EDMInit /\ step = "" /\ calm = "no"
    /\ [][LiveNext]_<<liveVars, step>>
    /\ WF_<<liveVars, step>>(CalmCall)

\* EDM-IN-START-2, EDM-IN-RESET-1, EDM-IN-RESET-2, EDM-OUT-EDM-2, EDM-SEQ-2, EDM-SEQ-3, EDM-SEQ-6
EnablesAgain == <>(calm = "first") => <>[]S_EDM_Out
=============================================================================
