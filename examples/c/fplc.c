/* The F-PLC of the note: insert steps 6 to 29, Figures 3 to 7, removal steps 3 to 18, Figure 9.
 * Comments name clauses (EKS-..) and decisions (E-..); docs/mode_selection.md says why each was taken.
 * A functional model of an F-program, not an F-program. */
#include "fplc.h"

/* ------------------------------------------------------------------ Table 2 (EKS-T2); Table 1 has the same words */

static const uint16_t RE[FPLC_MODES] = {0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C}; /* MW01: authorization */
static const uint16_t SE[FPLC_MODES] = {0x0FF0, 0x3333, 0x33CC, 0x3C3C, 0x0F0F}; /* MW03: selection */
static const uint16_t CH[FPLC_MODES] = {0x3333, 0x33CC, 0x3C3C, 0x0F0F, 0x0FF0}; /* MW05: echo */
static const uint16_t SW[FPLC_MODES] = {0x33CC, 0x3C3C, 0x0F0F, 0x0FF0, 0x3333}; /* MW07: acknowledgment */

/* The mode that a word means in a range; none for zero and for every other word (EKS-T2-4, EKS-SD-14). */
static int8_t mode_of(const uint16_t range[FPLC_MODES], uint16_t word)
{
    for (int8_t m = 0; m < FPLC_MODES; m++) {
        if (word == range[m]) {
            return m;
        }
    }
    return FPLC_NONE;
}

/* ------------------------------------------------------------------ the five outputs of the key reader */

enum { NO_OUTPUT = 0x00, ALL_OUTPUTS = 0x1F };

/* A bit for each level whose output is set: A, B, C, D, STR are levels 0 to 4 (EKS-T2, E-02, E-06b). */
static uint8_t vector_of(const fplc_inputs *in)
{
    uint8_t vector = NO_OUTPUT;
    if (in->A) { vector |= 1u << 0; }
    if (in->B) { vector |= 1u << 1; }
    if (in->C) { vector |= 1u << 2; }
    if (in->D) { vector |= 1u << 3; }
    if (in->STR) { vector |= 1u << 4; }
    return vector;
}

static bool is_many(uint8_t vector) /* two or more (EKS-KS-6, EKS-2-11) */
{
    return (vector & (uint8_t)(vector - 1)) != 0;
}

static int8_t level_of(uint8_t vector) /* of a vector with one output */
{
    int8_t level = 0;
    while ((vector >> level) > 1) {
        level++;
    }
    return level;
}

/* ------------------------------------------------------------------ parameters and power-up */

fplc_parameters fplc_defaults(void)
{
    const fplc_parameters set = {
        .T_ON_ms = 1000, .T_SEQ_ms = 1000, .T_REM_ms = 1000, .T_DWELL_ms = 0,
        .T_SEQ_FROM_ones = true, .ON_ERROR_none = false, .SELECTIONS_once = true,
        .PERMITS = {0x01, 0x03, 0x07, 0x0F, 0x1F}, /* each level its own mode and all lower ones (EKS-T2-2) */
    };
    return set;
}

static bool is_time(uint32_t ms, uint32_t least)
{
    return ms >= least && ms <= 3600000u;
}

const char *fplc_power_up(fplc_memory *memory, const fplc_parameters *set)
{
    static const char *const permits[FPLC_MODES] = {
        "PERMITS_0", "PERMITS_1", "PERMITS_2", "PERMITS_3", "PERMITS_4"};
    if (!is_time(set->T_ON_ms, 1)) { return "T_ON_ms"; }
    if (!is_time(set->T_SEQ_ms, 1)) { return "T_SEQ_ms"; }
    if (!is_time(set->T_REM_ms, 1)) { return "T_REM_ms"; }
    if (!is_time(set->T_DWELL_ms, 0) || set->T_DWELL_ms >= set->T_REM_ms) { return "T_DWELL_ms"; } /* E-74 */
    if (!set->T_SEQ_FROM_ones && set->T_ON_ms > set->T_SEQ_ms) { return "T_SEQ_ms"; } /* E-38 */
    for (int8_t level = 0; level < FPLC_MODES; level++) {
        const uint8_t own = (uint8_t)(1u << level);
        if ((set->PERMITS[level] & own) == 0 || set->PERMITS[level] >= own << 1) {
            return permits[level]; /* its own mode, and none above it (E-47) */
        }
    }
    const fplc_memory fresh = {
        .set = *set, .state = Start,
        .accepted = FPLC_NONE, .authority = FPLC_NONE, .selection = FPLC_NONE,
        .mode = FPLC_NONE, .elapsed_ms = 0,
    };
    *memory = fresh;
    return 0;
}

/* ------------------------------------------------------------------ going from state to state */

static void go(fplc_memory *m, fplc_state next) /* and start its timer */
{
    m->state = next;
    m->elapsed_ms = 0;
}

static void go_on(fplc_memory *m, fplc_state next, uint32_t now) /* the timer goes on */
{
    m->state = next;
    m->elapsed_ms = now;
}

static void drop_key(fplc_memory *m)
{
    m->accepted = FPLC_NONE;
    m->authority = FPLC_NONE;
    m->selection = FPLC_NONE;
}

/* EKS-2-19, EKS-KS-6, E-22, E-24: one error mode; it holds the active mode, or clears it */
static void enter_error(fplc_memory *m)
{
    drop_key(m);
    if (m->set.ON_ERROR_none) {
        m->mode = FPLC_NONE;
    }
    go(m, Error);
}

/* EKS-3-4-FPLC, EKS-8-3, EKS-8-6, E-06, E-27: the timer of the removal starts, both words fall to zero at once */
static void enter_clear(fplc_memory *m)
{
    drop_key(m);
    go(m, Clear);
}

/* E-15, E-16, E-21: the selection is over, with or without a switchover; the key stays accepted */
static void enter_settle(fplc_memory *m)
{
    m->selection = FPLC_NONE;
    go(m, Settle);
}

/* ------------------------------------------------------------------ what a scan asks */

static bool no_words(const fplc_inputs *in)
{
    return in->MW03 == 0 && in->MW07 == 0;
}

/* EKS-8-12 to EKS-8-14, EKS-8-18, E-29, E-31, E-52: in one scan, and not before the dwell time is over */
static bool zeros_returned(const fplc_memory *m, const fplc_inputs *in, uint8_t vector, uint32_t now)
{
    const bool no_key = !in->LA && vector == NO_OUTPUT;
    return no_key && no_words(in) && now >= m->set.T_DWELL_ms;
}

/* Figure 5 (EKS-5-1 to EKS-5-10, E-12, E-47): the level permits the mode */
static bool permitted(const fplc_memory *m, int8_t mode)
{
    return (m->set.PERMITS[m->authority] & (1u << mode)) != 0;
}

/* Start, Idle and Error have rules of their own (E-63) */
static bool has_own_rules(fplc_state s)
{
    return s == Start || s == Idle || s == Error;
}

static bool is_pulse(fplc_state s) /* the only states in which many outputs are good (E-09) */
{
    return s == PulseOnes || s == PulseZeros;
}

static bool is_removal(fplc_state s)
{
    return s == Clear || s == AwaitZeros;
}

static bool is_accepted(fplc_state s) /* from the acceptance of the one output until it goes (E-07) */
{
    return s >= Authorize && s <= Settle;
}

static bool is_authorized(fplc_state s) /* MW01 shows the level; not in Settle (E-59) */
{
    return s >= AwaitSelection && s <= Complete;
}

static bool is_echoed(fplc_state s) /* MW05 shows the selection */
{
    return s >= AwaitAcknowledgment && s <= Complete;
}

/* EKS-2-8, EKS-4-4, EKS-4-6, EKS-8-11, E-64: late is at the deadline or after it */
static bool is_late(const fplc_memory *m, uint32_t now)
{
    switch (m->state) {
    case PulseOnes:
        return now >= m->set.T_ON_ms;
    case PulseZeros:
    case OneOutput:
        return now >= m->set.T_SEQ_ms;
    case Settle: /* E-15 */
    case Clear:
    case AwaitZeros:
        return now >= m->set.T_REM_ms;
    default: /* nobody can be made to touch a screen (E-25b); Start and Error wait for zeros */
        return false;
    }
}

/* The check before every step, Figures 3 and 9, in the order of E-63. False when it took the scan. */
static bool check_passes(fplc_memory *m, const fplc_inputs *in, uint8_t vector, uint32_t now)
{
    if (has_own_rules(m->state)) {
        return true;
    }
    if (is_many(vector) && !is_pulse(m->state)) { /* EKS-2-11, E-09; also without LA (E-62) */
        enter_error(m);
        return false;
    }
    if (!in->LA && !is_removal(m->state)) { /* EKS-3-1-FPLC, E-07, E-28, E-42 */
        enter_clear(m);
        return false;
    }
    if (is_accepted(m->state) && vector != 1u << m->accepted) { /* EKS-3-1-FPLC, E-41, E-68 */
        enter_clear(m);
        return false;
    }
    if (is_late(m, now)) { /* EKS-2-8, EKS-4-4, EKS-4-8, EKS-8-11, E-03, E-30, E-64: before success */
        enter_error(m);
        return false;
    }
    return true;
}

/* ------------------------------------------------------------------ the steps */

/* Steps 20 and 27 to 29, while the latched selection stands in MW03 */
static void transaction(fplc_memory *m, const fplc_inputs *in)
{
    if (in->MW03 != SE[m->selection]) { /* in any of the five states */
        if (in->MW03 != 0 && mode_of(SE, in->MW03) == FPLC_NONE) { /* EKS-2-19, E-61: no code */
            enter_error(m);
        } else { /* E-16, E-21: taken back or changed */
            enter_settle(m);
        }
        return;
    }
    switch (m->state) {
    case EchoSelection: /* EKS-2-20 */
        if (in->MW07 != 0) { /* E-65: nothing was echoed that could be acknowledged */
            enter_error(m);
        } else {
            go(m, AwaitAcknowledgment);
        }
        break;
    case AwaitAcknowledgment: /* E-11, E-25b: no deadline */
        if (in->MW07 != 0) {
            go(m, CheckAcknowledgment);
        }
        break;
    case CheckAcknowledgment: /* EKS-2-27; Figure 7, rows 1, 3, 5, 7, 9 */
        if (in->MW07 == 0) { /* E-66 */
            enter_settle(m);
        } else if (mode_of(SW, in->MW07) == FPLC_NONE) {
            enter_error(m);
        } else {
            go(m, Match);
        }
        break;
    default: /* Match and Switch: EKS-2-28, EKS-2-29; Figure 7, rows 2, 4, 6, 8, 10, in both scans (E-42, E-66) */
        if (in->MW07 == 0) {
            enter_settle(m);
        } else if (in->MW07 != SW[m->selection]) { /* E-01, E-13 */
            enter_error(m);
        } else if (m->state == Match) {
            go(m, Switch);
        } else {
            m->mode = m->selection; /* the latched selection, not a second decoding of MW07 (E-01) */
            if (m->set.SELECTIONS_once) { /* E-15 */
                go(m, Complete);
            } else {
                enter_settle(m);
            }
        }
        break;
    }
}

static void take_step(fplc_memory *m, const fplc_inputs *in, uint8_t vector, uint32_t now)
{
    switch (m->state) {
    case Start: /* E-25c, E-56: a key that is in must come out, and zeros must go round */
        if (is_many(vector)) {
            enter_error(m);
        } else if (zeros_returned(m, in, vector, now)) {
            go(m, Idle);
        } else {
            go_on(m, Start, now);
        }
        break;
    case Idle: /* EKS-2-6, EKS-9-4-FPLC */
        if (in->LA) { /* whatever the outputs show (E-40, E-73) */
            go(m, PulseOnes);
        } else if (is_many(vector)) {
            enter_error(m);
        }
        break;
    case PulseOnes: /* EKS-2-10, EKS-4-1; other vectors are waited out (E-10) */
        if (vector != ALL_OUTPUTS) {
            go_on(m, PulseOnes, now);
        } else if (m->set.T_SEQ_FROM_ones) {
            go(m, PulseZeros);
        } else {
            go_on(m, PulseZeros, now);
        }
        break;
    case PulseZeros: /* EKS-4-3 */
        go_on(m, vector == NO_OUTPUT ? OneOutput : PulseZeros, now);
        break;
    case OneOutput: /* EKS-4-5, EKS-4-7, EKS-2-11: more than one was an error before */
        if (vector == NO_OUTPUT) {
            go_on(m, OneOutput, now);
        } else {
            m->accepted = level_of(vector);
            go(m, Authorize);
        }
        break;
    case Authorize: /* EKS-2-12, EKS-SD-1 */
        if (!no_words(in)) { /* E-54 */
            enter_error(m);
        } else {
            m->authority = m->accepted;
            go(m, AwaitSelection);
        }
        break;
    case AwaitSelection: /* EKS-2-17, E-25b: no deadline */
        if (in->MW07 != 0) { /* E-65 */
            enter_error(m);
        } else if (in->MW03 != 0) {
            go(m, CheckSelection);
        }
        break;
    case CheckSelection: /* EKS-2-18, EKS-2-19, Figures 5 and 6 in one scan (E-12, E-14) */
        if (in->MW07 != 0) { /* E-65 */
            enter_error(m);
        } else if (in->MW03 == 0) { /* E-21 */
            enter_settle(m);
        } else {
            const int8_t selected = mode_of(SE, in->MW03);
            if (selected == FPLC_NONE || !permitted(m, selected)) {
                enter_error(m);
            } else {
                m->selection = selected; /* E-16 */
                go(m, EchoSelection);
            }
        }
        break;
    case EchoSelection:
    case AwaitAcknowledgment:
    case CheckAcknowledgment:
    case Match:
    case Switch:
        transaction(m, in);
        break;
    case Complete: /* EKS-GP-5, E-15: until the key goes, whatever the words show */
        break;
    case Settle: /* EKS-GP-5, E-15, E-52 */
        if (no_words(in) && now >= m->set.T_DWELL_ms) {
            go(m, AwaitSelection);
        } else {
            go_on(m, Settle, now);
        }
        break;
    case Clear: /* EKS-8-6, E-27: the zeros were written in the scan that saw the key go */
        go_on(m, AwaitZeros, now);
        break;
    case AwaitZeros: /* EKS-8-11 to EKS-8-18; a key that comes now waits for its removal (E-17, E-36) */
        if (zeros_returned(m, in, vector, now)) {
            go(m, Idle);
        } else {
            go_on(m, AwaitZeros, now);
        }
        break;
    case Error: /* EKS-3-0, EKS-9-0, E-23: the way out leads over zeros, never back into a transaction */
        if (zeros_returned(m, in, vector, now)) {
            go(m, Idle);
        } else {
            go_on(m, Error, now);
        }
        break;
    default: /* memory that no scan wrote */
        enter_error(m);
        break;
    }
}

void fplc_scan(const fplc_inputs *in, fplc_memory *memory, fplc_outputs *out)
{
    const uint8_t vector = vector_of(in);
    const uint32_t rest = UINT32_MAX - memory->elapsed_ms;
    const uint32_t now = in->dt_ms < rest ? memory->elapsed_ms + in->dt_ms : UINT32_MAX; /* no overflow */

    if (check_passes(memory, in, vector, now)) { /* EKS-GP-4 */
        take_step(memory, in, vector, now);
    }

    /* The row of the state after the step (EKS-2-12, EKS-2-20, EKS-2-29, EKS-8-6, E-27) */
    out->MW01 = is_authorized(memory->state) ? RE[memory->authority] : 0;
    out->MW05 = is_echoed(memory->state) ? CH[memory->selection] : 0;
    for (int8_t i = 0; i < FPLC_MODES; i++) {
        out->MSO[i] = memory->mode == i; /* one of five (EKS-SD-6) */
    }
    out->ERROR = memory->state == Error;
}
