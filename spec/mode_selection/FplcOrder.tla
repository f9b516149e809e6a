----------------------------- MODULE FplcOrder ------------------------------
(***************************************************************************)
(* The F-PLC alone, as in FplcOpen: the order of its steps, and what it    *)
(* answers to each word at each of them.  A machine that breaks one of     *)
(* these leaves a numbered step out, or has two answers to one scan.       *)
(***************************************************************************)
EXTENDS FplcOpen

\* The steps that wait
Waiting == {"Start", "Idle", "PulseOnes", "PulseZeros", "OneOutput", "AwaitSelection", "AwaitAcknowledgment",
            "Complete", "Settle", "AwaitZeros", "Error"}
\* The numbered steps one after another: of an insertion, of a selection, of a removal
Insertion == <<"Idle", "PulseOnes", "PulseZeros", "OneOutput", "Authorize", "AwaitSelection">>
Selection == <<"AwaitSelection", "CheckSelection", "EchoSelection", "AwaitAcknowledgment",
               "CheckAcknowledgment", "Match", "Switch", "Settle", "AwaitSelection">>
Removal == <<"Clear", "AwaitZeros", "Idle">>
Next(steps) == {<<steps[n], steps[n + 1]>> : n \in 1..Len(steps) - 1}
Order ==
    Next(Insertion) \cup Next(Selection) \cup Next(Removal)
    \cup {<<s, s>> : s \in Waiting} \cup {<<"Start", "Idle">>, <<"Error", "Idle">>, <<"Switch", "Complete">>}
    \cup {<<s, "Settle">> : s \in {"CheckSelection"} \cup Transaction}
    \cup {<<s, "Clear">> : s \in Inserting \cup Holding} \cup {<<s, "Error">> : s \in FplcStates}
\* EKS-GP-3, EKS-GP-5, EKS-2-6, EKS-2-12, EKS-2-17, EKS-2-20, EKS-2-27, EKS-2-28, EKS-2-29, EKS-4-1, EKS-4-3,
\* EKS-4-5, EKS-8-6, EKS-8-18: no numbered step is left out and none is taken back, but to Settle, Clear and
\* Error
StepsInOrder == [][(<<fplcState, fplcState'>> \in Order)]_beat

\* EKS-GP-3, EKS-8-3, E-36, E-52: time that a state counts goes on in every scan that stays there
TimeGoesOn ==
    [][fplcState' = fplcState /\ fplcState \in Clocked =>
        LET limit == IF fplcState \in Timed THEN Deadline ELSE T_DWELL
            time == fplcElapsed + Scanned.dt
        IN  fplcElapsed' >= IF time < limit THEN time ELSE limit]_beat

\* The key of this insertion is signalled, and nothing else
Signalled == fplcState \in Holding /\ Scanned.LA /\ Scanned.vec = {accepted}
Kept == fplcState \in Transaction /\ Scanned.MW03 = SE[fplcSelection]

\* EKS-2-17, EKS-2-20, E-65: an acknowledgment before the echo is an error
AcknowledgmentNeedsEcho ==
    [][Signalled /\ Scanned.MW07 # 0 =>
        (fplcState \in {"AwaitSelection", "CheckSelection"} \/ (fplcState = "EchoSelection" /\ Kept)
            => ERROR')]_beat

NoCode == Scanned.MW03 # 0 /\ ModeOf(SE, Scanned.MW03) = None
\* EKS-2-25, E-16, E-21: a selection that was taken back or changed to another one is withdrawn, whatever MW07
\* shows
ChangedSelectionIsWithdrawn ==
    [][Signalled /\ fplcState \in Transaction /\ ~Kept /\ ~NoCode => fplcState' = "Settle" /\ mode' = mode]_beat
\* EKS-2-19, E-61: from the check of the selection until the switchover a word in MW03 that is no code is an
\* error, whatever MW07 shows
NoCodeIsReported ==
    [][Signalled /\ fplcState \in {"CheckSelection"} \cup Transaction /\ NoCode => ERROR']_beat

WordIsJudged ==
    CASE Scanned.MW07 = 0 -> fplcState' = "Settle" /\ mode' = mode
      [] Scanned.MW07 = SW[fplcSelection] -> ~ERROR'
      [] /\ fplcState = "CheckAcknowledgment"
         /\ Scanned.MW07 # SW[fplcSelection] /\ ModeOf(SW, Scanned.MW07) # None -> fplcState' = "Match"
      [] OTHER -> ERROR'
\* EKS-2-27, EKS-2-28, EKS-7-12, E-11, E-13, E-21, E-66: nothing is judged before step 27; then zero takes the
\* acknowledgment back, the word of the selection goes on, the word of another mode passes step 27 and is
\* refused from step 28 on, and what is no code is refused in each
AcknowledgmentIsJudged ==
    [][Signalled /\ Kept =>
        /\ fplcState = "AwaitAcknowledgment" => ~ERROR'
        /\ fplcState \in {"CheckAcknowledgment", "Match", "Switch"} => WordIsJudged]_beat
=============================================================================
