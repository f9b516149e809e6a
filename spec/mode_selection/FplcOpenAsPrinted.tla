--------------------------- MODULE FplcOpenAsPrinted --------------------------
(***************************************************************************)
(* Two readings take the level from the flag word MW01 (FplcAsPrinted).    *)
(* Here the scan that checks the selection may find MW01 overwritten.      *)
(***************************************************************************)
EXTENDS FplcOpen

\* E-12, E-18: by then MW01 is what was written, or one of these
LOCAL Overwritten == <<0, OtherWord, RE[4]>>
LOCAL FoundMW01(o) == IF o = 0 THEN MW01 ELSE Overwritten[o]
LOCAL NextOverwritten ==
    \E n \in InputsToTry : \E o \in IF fplcState = "CheckSelection" THEN 0..Len(Overwritten) ELSE {0} :
        \E i \in {[MW01 |-> FoundMW01(o)] @@ Alphabet[n]} :
            /\ FplcScan(i)
            /\ in' = n + N * o /\ beat' = ~beat
            /\ IF PRINT_GRAPH THEN UNCHANGED observer ELSE Observe(i)
LOCAL WiresAtRest == Wire(Alphabet[in % N]) @@ FplcOutputs
LOCAL WiresOverwritten ==
    IF in >= N THEN [MW01 |-> Overwritten[in \div N]] @@ WiresAtRest ELSE WiresAtRest

OpenNext_AuthorityFromMW01 == NextOverwritten
Scanned_AuthorityFromMW01 == Alphabet[in' % N]
FlagWordMW01_AuthorityFromMW01 == FoundMW01(in' \div N)
Wires_AuthorityFromMW01 == WiresOverwritten

OpenNext_Figure5ReadsMW01 == NextOverwritten
Scanned_Figure5ReadsMW01 == Alphabet[in' % N]
FlagWordMW01_Figure5ReadsMW01 == FoundMW01(in' \div N)
Wires_Figure5ReadsMW01 == WiresOverwritten
=============================================================================
