----------------------------- MODULE FplcSmall ------------------------------
(***************************************************************************)
(* FplcOpen where only some of its inputs are tried: two levels, the words *)
(* of two modes, one other MW07, one tick or none.  For planted faults;    *)
(* whatever happens here happens with all inputs too.                      *)
(***************************************************************************)
EXTENDS FplcOpen

SmallInputs == {n \in 0..N - 1 :
    /\ Alphabet[n].vec \in {{}, {0}, {1}, {0, 1}, MSO}
    /\ Alphabet[n].MW03 \in {0, SE[0], SE[1]}
    /\ Alphabet[n].MW07 \in {0, SW[0], SW[1], OtherWord}
    /\ Alphabet[n].dt \in {0, 1}}

\* The same for VECTORS = "one", with every time: deadlines that are told apart need it
OneLevelInputs == {n \in 0..N - 1 :
    /\ Alphabet[n].vec \in {{}, {2}, MSO}
    /\ Alphabet[n].MW03 \in {0, SE[1]}
    /\ Alphabet[n].MW07 \in {0, SW[1], OtherWord}}
=============================================================================
