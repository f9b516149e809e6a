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
    "FIG7_EXCLUSIVE",
    "FIG7_GOES_ON",
    "OUTPUT_C_IS_LEVEL_3",
    "EXPIRY_IS_SUCCESS",
    "NO_REMOVAL_TIMER",
    "STR_LEFT_OUT",
    "CHECK_IN_PULSE",
    "ONE_OUTPUT_CHECKED_ONCE",
    "ONE_OUTPUT_ALWAYS",
    "NO_PULSE_NEEDED",
    "NO_WAIT_FOR_MW07",
    "FIG5_FALLS_THROUGH",
    "FIG5_READS_MW01",
    "SPLIT_CHECK",
    "AUTHORITY_FROM_MW01",
    "RECOVER_INTO_TRANSACTION",
    "ERROR_INTO_REMOVAL",
    "KEY_AT_POWER_UP",
    "NO_INSERTION_TIMER",
    "MW05_KEPT",
    "LA_ENDS_REMOVAL",
    "LA_NOT_CHECKED",
    "ZEROS_ONE_BY_ONE",
    "MW07_TESTED_ONCE",
    "BOUNCE_RESTARTS_TIMER",
    "NO_DWELL_AT_START",
    "NO_DWELL_IN_SETTLE",
    "NO_DWELL_IN_REMOVAL",
    "NO_DWELL_IN_ERROR",
    "EARLY_WORDS_ACCEPTED",
    "LATER_NO_CODE_IS_ERROR",
    "KEY_BEFORE_FAULTS",
    "SUCCESS_BEFORE_EXPIRY",
    "EARLY_ACKNOWLEDGMENT_IGNORED",
    "ACKNOWLEDGMENT_READ_ONCE",
    "ONLY_NONE_IS_REMOVAL",
    "ACTIVE_MODE_SKIPPED",
    "NO_OUTPUT_BEFORE_LA",
    "OUTPUT_NEEDS_LA",
    "REMOVAL_RUNS_INSERT_STEPS",
    \* PLC
    "PLC_CHECKS_FIRST",
    "PLC_CHECKS_ZERO",
    "PLC_COUNTS_STEPS",
    "REMOVAL_FETCHES_NOTHING",
    \* PLC, in KeyFlows
    "ATOMIC_COPY",
    \* HMI
    "ACKNOWLEDGES_OWN_SELECTION",
    "PANEL_COMPARES_ALONE",
    "USER_COMPARES_ALONE",
    "REJECT_IS_SILENT",
    "REJECT_IS_A_WORD",
    "ENABLED_BY_ANY_WORD",
    "WITHDRAWS_AFTER_CONFIRM",
    "STAYS_OPEN_AT_NEW_LEVEL",
    "OPENS_OVER_ECHO",
    "SHOWS_ANY_ECHO",
    "TOUCH_BEFORE_ECHO_COUNTS",
    \* HMI, in KeyFlows
    "PANEL_REMEMBERS_MODE",
    \* PLC and HMI, in KeyFlows
    "PLC_RESTARTS",
    "PANEL_RESTARTS",
    \* EKS
    "NO_LEVEL_CHECK",
    "NO_ACCESS_CHECK",
    "CHECK_BEFORE_CLEAR",
    "PULSE_BEFORE_LA",
    "PULSE_RUNS_ON"
}

ASSUME LITERAL \subseteq Readings

Literal(reading) == reading \in LITERAL
=============================================================================
