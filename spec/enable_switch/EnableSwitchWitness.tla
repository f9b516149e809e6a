------------------------- MODULE EnableSwitchWitness -------------------------
(***************************************************************************)
(* What must be reachable, so that the properties are not vacuous:         *)
(* every step by its name, which only the step itself sets, every change   *)
(* of state, and every DiagCode.  Every name that is met is printed once;  *)
(* runs.toml lists the names that must be met.                             *)
(***************************************************************************)
EXTENDS EnableSwitchOpen

Report(name) ==
    IF name \in TLCGet(1) THEN TRUE
    ELSE TLCSet(1, TLCGet(1) \cup {name}) /\ PrintT(ToString(<<"REACHED", name>>))

LOCAL Digits == <<"0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "A", "B", "C", "D", "E", "F">>
LOCAL Digit(n) == Digits[(n % 16) + 1]
Hex(n) == Digit(n \div 4096) \o Digit(n \div 256) \o Digit(n \div 16) \o Digit(n)

Mark ==
    /\ Report(step')
    /\ Report("DiagCode" \o Hex(DiagCode'))
    /\ state' # state => Report(state \o "To" \o state')

ASSUME TLCSet(1, {})
=============================================================================
