-------------------------- MODULE FplcOrderSmall --------------------------
(* FplcOrder where only the inputs of FplcSmall are tried.  For planted faults. *)
EXTENDS FplcSmall, FplcOrder

\* With a word in MW03 that is no code
NoCodeInputs == {n \in 0..N - 1 :
    /\ Alphabet[n].vec \in {{}, {1}, MSO}
    /\ Alphabet[n].MW03 \in {0, SE[1], OtherWord}
    /\ Alphabet[n].MW07 \in {0, SW[1]}
    /\ Alphabet[n].dt \in {0, 1}}
=============================================================================
