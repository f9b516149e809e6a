----------------------------- MODULE CodeTables -----------------------------
(***************************************************************************)
(* The code words of the note: Table 1 and Table 2, one table per range.   *)
(* Every range uses the same five words and gives each another meaning.    *)
(* Leaves out: how a word is stored and sent; a word moves atomically      *)
(* (assumption A-01).  Compared by machine with refimpl's own copy.        *)
(***************************************************************************)
EXTENDS Integers, TLC

CONSTANT PERMITS   \* the modes that each level permits (E-47)

MSO == 0..4    \* modes of safe operation; the authorization levels have the same numbers (EKS-T2)
None == -1     \* no mode, no level

\* EKS-T1, EKS-T2: MW01 and ReadAuthorization, also the level on the key
RE == TLCEval([m \in MSO |-> CASE m = 0 -> \h0F0F [] m = 1 -> \h0FF0 [] m = 2 -> \h3333
                       [] m = 3 -> \h33CC [] m = 4 -> \h3C3C])
\* EKS-T2: MW03 and SelectMSO
SE == TLCEval([m \in MSO |-> CASE m = 0 -> \h0FF0 [] m = 1 -> \h3333 [] m = 2 -> \h33CC
                       [] m = 3 -> \h3C3C [] m = 4 -> \h0F0F])
\* EKS-T2: MW05 and CheckMSO
CH == TLCEval([m \in MSO |-> CASE m = 0 -> \h3333 [] m = 1 -> \h33CC [] m = 2 -> \h3C3C
                       [] m = 3 -> \h0F0F [] m = 4 -> \h0FF0])
\* EKS-T2: MW07 and SwitchMSO
SW == TLCEval([m \in MSO |-> CASE m = 0 -> \h33CC [] m = 1 -> \h3C3C [] m = 2 -> \h0F0F
                       [] m = 3 -> \h0FF0 [] m = 4 -> \h3333])

\* EKS-KS-10, E-12: the mode that a word means in a range; None for zero and for every word outside the range
ModeOf(range, word) ==
    IF word = range[0] THEN 0 ELSE IF word = range[1] THEN 1 ELSE IF word = range[2] THEN 2
    ELSE IF word = range[3] THEN 3 ELSE IF word = range[4] THEN 4 ELSE None

\* What a cfg puts in the place of a constant, TLC evaluates anew wherever the constant stands: so these are
\* second names of values that it evaluates once (a tenth of the time of the whole system).
LOCAL FigureFive == [l \in MSO |-> 0..l]
LOCAL AsTheText == [l \in MSO |-> IF l = 3 THEN {1, 2, 3} ELSE {l}]
\* EKS-T2-2, EKS-5-1, E-47: Figure 5 orders the levels totally: a level permits its own mode and all lower
\* ones
TotalOrder == FigureFive
\* EKS-T2-2, E-47: the stricter reading: what the text says, and each level its own mode
TextOrder == AsTheText
\* E-47: a machine may permit less, never more
ASSUME \A l \in MSO : l \in PERMITS[l] /\ PERMITS[l] \subseteq TotalOrder[l]
Permitted(level, m) == level # None /\ m # None /\ m \in PERMITS[level]

\* EKS-KS-8: zero is in no range; it says that no key is there
Codes == {RE[m] : m \in MSO}
OtherWord == \h0001                          \* stands for every word that is neither a code nor zero
LOCAL Classes == Codes \cup {0, OtherWord}
WordClasses == Classes

\* EKS-T1, EKS-T2, EKS-T2-1: every range has the five words of Table 1, and none gives a word the meaning it
\* has in another
ASSUME \A r \in {RE, SE, CH, SW} : {r[m] : m \in MSO} = Codes
ASSUME \A m \in MSO : \A r, s \in {RE, SE, CH, SW} : r # s => r[m] # s[m]
ASSUME OtherWord \notin Codes /\ 0 \notin Codes
=============================================================================
