-------------------------- MODULE GuardLockingTrace --------------------------
(***************************************************************************)
(* What one line of a log says about a call of the block: w holds the      *)
(* inputs by their names, as GuardLocking reads them; it has no timer.     *)
(***************************************************************************)
EXTENDS GuardLocking

\* GL-IN-RESET, GL-IN-UNLOCKREQUEST, GLF-02, GLF-08, GLF-14: which memory goes with which state
GuardLockingAnywhere ==
    /\ state \in GuardLockingStates
    /\ resetBefore \in IF state \in ResetErrors THEN {TRUE} ELSE BOOLEAN
    /\ unlockRequestBefore \in
        IF UNLOCK_ENDS = "with_request" /\ state \in Unlocked THEN {TRUE} ELSE BOOLEAN
    /\ requestPending \in
        IF UNLOCK_ON = "latched" /\ state = "GuardClosedAndLocked" /\ unlockRequestBefore
            THEN BOOLEAN ELSE {FALSE}
    /\ startUpInhibit \in
        IF /\ START_UP_INHIBIT = "until_reset"
           /\ state \notin {"Idle", "Init", "ResetError1", "GuardClosedAndLocked"}
            THEN BOOLEAN ELSE {FALSE}
    /\ guardLost \in
        IF CAUSE_OF_LOSS = "what_was_lost" /\ state \in AfterLoss /\ ~startUpInhibit
            THEN BOOLEAN ELSE {FALSE}
    /\ step = ""
=============================================================================
