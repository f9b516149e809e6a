------------------------------ MODULE Readings ------------------------------
(***************************************************************************)
(* The literal readings of the note that can be restored for a trial, each *)
(* by its name in LITERAL; {} is our reading (findings.toml, `switch`).    *)
(* One name a line: a reading belongs to the device that asks for it.      *)
(***************************************************************************)
CONSTANT LITERAL     \* literal readings that are switched on

Readings == {
    \* F-PLC
    "LITERAL_FIG7",
    "LIVE_MW03",
    "NO_SETTLE",
    "INSERT_DURING_REMOVAL",
    "NO_LA_AT_SWITCH",
    "NO_DWELL",
    "SETTLE_KEEPS_MW01",
    \* PLC, in KeyFlows
    "ATOMIC_COPY"
}

ASSUME LITERAL \subseteq Readings

Literal(reading) == reading \in LITERAL
=============================================================================
