-------------------------- MODULE GuardLockingZone --------------------------
(***************************************************************************)
(* The block with what it guards: a door, its bolt, a machine and a        *)
(* person.  What the document's warnings and its example take for granted  *)
(* can be taken away, one thing at a time, by BROKEN, ESCAPE, START and    *)
(* AUTO.                                                                   *)
(* Each step is one call of the block, or one thing that happens in the    *)
(* zone between two calls.  The bolt moves some time after the signal, and *)
(* is thrown only with the door closed; the machine runs down some time    *)
(* after the enable.  S_SafetyActive may be FALSE without a cause.         *)
(* Leaves out: a second person, a door that is forced, all durations.      *)
(***************************************************************************)
EXTENDS TLC, GuardLocking

CONSTANTS
    BROKEN,   \* what is not as it should be: a part of Broken
    ESCAPE,   \* the bolt can be drawn by hand from inside (GLA-05)
    START,    \* S_StartReset
    AUTO      \* S_AutoReset
Broken == {"RESET_WITH_SOMEBODY_INSIDE", "STANDSTILL_TOLD_WRONG", "LOCK_TOLD_WRONG"}
ASSUME BROKEN \subseteq Broken /\ {ESCAPE, START, AUTO} \subseteq BOOLEAN

VARIABLES
    open,     \* the door is open
    bolted,   \* the bolt is thrown
    inside,   \* a person is in the zone
    moving,   \* the machine moves
    told      \* what the last call was told; hidden by VIEW

zone == <<open, bolted, inside, moving>>
ZoneView == <<guardLocking, zone>>

ZoneInit ==
    /\ GuardLockingInit /\ step = ""
    /\ open = FALSE /\ bolted = TRUE /\ inside = FALSE /\ moving = FALSE
    /\ told = [Activate |-> FALSE, S_GuardMonitoring |-> TRUE, S_SafetyActive |-> TRUE, S_GuardLock |-> TRUE,
               UnlockRequest |-> FALSE, S_StartReset |-> START, S_AutoReset |-> AUTO, Reset |-> FALSE]

\* GL-EX-3: a standstill monitor that fails says FALSE; told wrong, it says anything
Standstill == IF "STANDSTILL_TOLD_WRONG" \in BROKEN THEN BOOLEAN ELSE {FALSE, ~moving}
\* GL-EX-1, GLF-16: told wrong, the contact says locked for ever
LockFeedback == "LOCK_TOLD_WRONG" \in BROKEN \/ (bolted /\ ~open)
\* GL-WARN-3
ResetButton == IF inside /\ "RESET_WITH_SOMEBODY_INSIDE" \notin BROKEN THEN {FALSE} ELSE BOOLEAN

BlockRuns ==
    \E on, request \in BOOLEAN : \E safe \in Standstill : \E reset \in ResetButton :
        /\ told' = [Activate |-> on, S_GuardMonitoring |-> ~open, S_SafetyActive |-> safe,
                    S_GuardLock |-> LockFeedback, UnlockRequest |-> request,
                    S_StartReset |-> START, S_AutoReset |-> AUTO, Reset |-> reset]
        /\ GuardLockingCall(told')
        /\ UNCHANGED zone

Between == UNCHANGED <<guardLocking, told>>
\* GL-OUT-UNLOCKGUARD, GL-EX-1: the coil
DrawBolt ==
    /\ S_UnlockGuard /\ bolted /\ bolted' = FALSE
    /\ UNCHANGED <<open, inside, moving>> /\ Between /\ Did("DrawBolt")
ThrowBolt ==
    /\ ~S_UnlockGuard /\ ~open /\ ~bolted /\ bolted' = TRUE
    /\ UNCHANGED <<open, inside, moving>> /\ Between /\ Did("ThrowBolt")
OpenDoor ==
    /\ ~bolted /\ ~open /\ open' = TRUE
    /\ UNCHANGED <<bolted, inside, moving>> /\ Between /\ Did("OpenDoor")
CloseDoor ==
    /\ open /\ open' = FALSE
    /\ UNCHANGED <<bolted, inside, moving>> /\ Between /\ Did("CloseDoor")
Enter ==
    /\ open /\ ~inside /\ inside' = TRUE
    /\ UNCHANGED <<open, bolted, moving>> /\ Between /\ Did("Enter")
Leave ==
    /\ open /\ inside /\ inside' = FALSE
    /\ UNCHANGED <<open, bolted, moving>> /\ Between /\ Did("Leave")
\* GLF-09: whatever the block asks for
Escape ==
    /\ ESCAPE /\ inside /\ bolted /\ bolted' = FALSE
    /\ UNCHANGED <<open, inside, moving>> /\ Between /\ Did("Escape")
\* GL-EX-4: nothing moves without the enable, but a machine that moves needs time to stop
Start ==
    /\ S_GuardLocked /\ ~moving /\ moving' = TRUE
    /\ UNCHANGED <<open, bolted, inside>> /\ Between /\ Did("Start")
Stop ==
    /\ moving /\ moving' = FALSE
    /\ UNCHANGED <<open, bolted, inside>> /\ Between /\ Did("Stop")

ZoneNext ==
    BlockRuns \/ DrawBolt \/ ThrowBolt \/ OpenDoor \/ CloseDoor \/ Enter \/ Leave \/ Escape \/ Start \/ Stop
zoneVars == <<ZoneView, step, told>>
ZoneSpec == ZoneInit /\ [][ZoneNext]_zoneVars
\* GLA-05: who is inside frees the door, opens it and goes, as often as there is a chance to; nobody else need
\* do anything
WayOutSpec == ZoneSpec /\ WF_zoneVars(Escape) /\ SF_zoneVars(OpenDoor) /\ SF_zoneVars(Leave)

\* For a reader of a trace
ZoneWires ==
    told @@ GuardLockingOutputs @@ [open |-> open, bolted |-> bolted, inside |-> inside, moving |-> moving]
BlockRead == told'

----------------------------------------------------------------------------
\* GL-DOC-2, GL-WARN-2, GL-WARN-3, GL-SEQ-3: nobody is in the zone while the machine moves
NobodyInMovingZone == ~(inside /\ moving)
\* GL-DOC-2, GL-SEQ-3, GL-SEQ-4: the machine does not move behind an open door
NoMotionBehindOpenDoor == ~(open /\ moving)
\* GL-OUT-ERROR, GL-OUT-UNLOCKGUARD, GLF-09: no error that stands keeps a person inside
NobodyShutInByAnError == inside /\ Error ~> ~(inside /\ Error)
=============================================================================
