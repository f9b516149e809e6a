--------------------------- MODULE KeyFlowsCopies ---------------------------
(***************************************************************************)
(* The matrix of single copies between the flag words: a nominal selection *)
(* with every key and every mode, all devices in step (a round is one scan *)
(* of EKS and F-PLC, the four copies of the PLC, one scan of the panel),   *)
(* and in it one copy of a flag word over another, or one read that begins *)
(* a byte beside the flag word, at every step of the F-PLC.  What comes of *)
(* it is printed.  An enumeration in Python over the reference             *)
(* implementation must say the same (E-18, E-49, EKS-SD-17).               *)
(*                                                                         *)
(* A word written to MW03 or MW07 is there for the next scan of the F-PLC; *)
(* one written to MW01 or MW05 is what the PLC hands on, so it is there    *)
(* for the next scan of the panel.  It stands for one round, or for five   *)
(* (a PLC that is slower than the F-PLC), and is then written anew.        *)
(* Leaves out: other schedules (KeyFlowsFaults has them all), removal.     *)
(***************************************************************************)
EXTENDS KeyFlows, WrongWords

VARIABLES
    turnOf,     \* the device that scans next
    goal,       \* the mode that the user touches
    copy,       \* the copy that was made: <<what, over what, at which step of the F-PLC, for how long>>
    stays,      \* rounds in which the PLC does not yet write that word anew
    waited,     \* rounds in which the user has been asked to confirm
    made        \* what was switched, and whether the user wanted it

copies == <<turnOf, goal, copy, stays, waited>>
copyVars == <<vars, copies, made>>

CopiesInit ==
    /\ EksInit /\ FplcInit /\ PlcInit /\ HmiInit
    /\ reader \in LEVELS /\ goal \in {m \in MSO : Permitted(reader, m)}
    /\ touched = None /\ seen = None /\ confirmed = None
    /\ step = "" /\ took = 0
    /\ turnOf = "eks" /\ copy = <<>> /\ stays = 0 /\ waited = 0 /\ made = ""

----------------------------------------------------------------------------
FlagWord(name) ==
    CASE name = "MW01" -> MW01 [] name = "MW03" -> MW03 [] name = "MW05" -> MW05 [] name = "MW07" -> MW07
      [] name = "MW02" -> Straddled(MW01, MW03) [] name = "MW04" -> Straddled(MW03, MW05)
      [] name = "MW06" -> Straddled(MW05, MW07)
\* What can be there instead: each other flag word, and the words that begin one byte before or after it
Instead(name) ==
    CASE name = "MW01" -> {"MW03", "MW05", "MW07", "MW02"}
      [] name = "MW03" -> {"MW01", "MW05", "MW07", "MW02", "MW04"}
      [] name = "MW05" -> {"MW01", "MW03", "MW07", "MW04", "MW06"}
      [] name = "MW07" -> {"MW01", "MW03", "MW05", "MW06"}

\* EKS-SD-17: the one wrong copy; one that writes what is there is none
Overwrite(name, from, rounds) ==
    LET w == FlagWord(from) IN
    /\ copy = <<>> /\ fplcState \in Holding /\ waited \in {0, 1}
    /\ turnOf = (IF name \in {"MW03", "MW07"} THEN "fplc" ELSE "hmi")
    /\ w # (CASE name = "MW01" -> ReadAuthorization [] name = "MW03" -> MW03
              [] name = "MW05" -> CheckMSO [] name = "MW07" -> MW07)
    /\ copy' = <<from, name, fplcState, IF rounds = 1 THEN "one scan" ELSE "five scans">>
    /\ stays' = rounds - 1
    /\ ReadAuthorization' = IF name = "MW01" THEN w ELSE ReadAuthorization
    /\ MW03' = IF name = "MW03" THEN w ELSE MW03
    /\ CheckMSO' = IF name = "MW05" THEN w ELSE CheckMSO
    /\ MW07' = IF name = "MW07" THEN w ELSE MW07
    /\ UNCHANGED <<reader, eks, fplc, turn, hmi, history, turnOf, goal, waited, made>>
    /\ Took(0) /\ Did("Overwrite")

----------------------------------------------------------------------------
\* The user touches once, and confirms in the sixth round in which that is asked
Wanted ==
    IF hmiState = "Select" /\ touched = None THEN Field(goal)
    ELSE IF hmiState = "Confirm" /\ waited >= 6 THEN "confirm" ELSE ""

WhatWasMade(m) ==
    (IF made = "" THEN "" ELSE made \o ", ")
    \o (IF touched # m THEN "not touched"
        ELSE IF seen = m /\ confirmed = m THEN "as confirmed" ELSE "not confirmed")

\* The four copies; the wrong word is not yet written anew while it stays
Staying(name, there, sent) == IF stays > 0 /\ copy[2] = name THEN there ELSE sent
Inputs == [MW01 |-> Staying("MW01", ReadAuthorization, MW01), MW05 |-> Staying("MW05", CheckMSO, MW05),
           SelectMSO |-> Staying("MW03", MW03, SelectMSO), SwitchMSO |-> Staying("MW07", MW07, SwitchMSO)]

NextTurn == [eks |-> "fplc", fplc |-> "plc", plc |-> "hmi", hmi |-> "eks"]
\* The PLC makes its four copies in one step, the wrong one as long as it stays
CopyAll ==
    /\ ReadAuthorization' = Inputs.MW01 /\ MW03' = Inputs.SelectMSO
    /\ CheckMSO' = Inputs.MW05 /\ MW07' = Inputs.SwitchMSO
    /\ stays' = (IF stays > 0 THEN stays - 1 ELSE 0)
    /\ UNCHANGED turn
    /\ Did("CopyAll")
Scan ==
    /\ \/ turnOf = "eks" /\ EksScan([key |-> reader, registers_zero |-> TRUE, dt |-> 1])
            /\ UNCHANGED <<fplc, plc, hmi, history, stays, waited, made>>
       \/ turnOf = "fplc" /\ FplcScan(FplcInput(1))
            /\ made' = (IF step' = "SwitchMode" THEN WhatWasMade(CHOOSE m \in MSO : mode' = {m}) ELSE made)
            /\ UNCHANGED <<eks, plc, hmi, history, stays, waited>>
       \/ turnOf = "plc" /\ CopyAll /\ UNCHANGED <<eks, fplc, hmi, history, waited, made>>
       \/ turnOf = "hmi" /\ HmiScan(HmiInput(Wanted)) /\ Remember
            /\ waited' = (IF hmiState' = "Confirm" THEN waited + 1 ELSE 0)
            /\ UNCHANGED <<eks, fplc, plc, stays, made>>
    /\ turnOf' = NextTurn[turnOf] /\ UNCHANGED <<reader, goal, copy>> /\ Took(1)

\* The F-PLC has refused, or all are back where the next selection begins
Quiet ==
    /\ turnOf = "eks" /\ touched # None /\ fplcState = "AwaitSelection" /\ hmiState = "Select"
    /\ ReadAuthorization = MW01 /\ MW03 = 0 /\ CheckMSO = 0 /\ MW07 = 0 /\ stays = 0
Ended == fplcState = "Error" \/ Quiet

Outcome ==
    IF fplcState = "Error" THEN (IF made = "" THEN "refused" ELSE made \o ", refused")
    ELSE IF made = "" THEN "withdrawn" ELSE made
Wished == Outcome \in {"refused", "withdrawn", "as confirmed"}
Report ==
    PrintT(ToString(<<"REACHED",
        copy[1] \o " over " \o copy[2] \o " at " \o copy[3] \o ", " \o copy[4] \o ": " \o Outcome
        \o (IF Wished THEN "" ELSE " (level " \o ToString(reader) \o ", mode " \o ToString(goal) \o ")")>>))

CopiesNext ==
    /\ ~Ended
    /\ \/ Scan
       \/ \E name \in {"MW01", "MW03", "MW05", "MW07"} : \E from \in Instead(name) : \E rounds \in {1, 5} :
            Overwrite(name, from, rounds)
CopiesSpec == CopiesInit /\ [][CopiesNext]_copyVars

\* Every end of a selection with a wrong copy is printed, also one that has no outcome of the list
PrintOutcome == Ended /\ copy # <<>> => Report
CopiesView == <<View, copies, made>>
=============================================================================
