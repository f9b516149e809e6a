/* The F-PLC of the note once more, as a program that takes one diagram box of the note in each cycle: every comparison
 * of Figures 5 to 7 and every question of the removal is a cycle of its own. It is as honest as fplc.c and slower: an
 * input needs up to FPLC_LATENCY cycles to have all its effects, so scan by scan its outputs are others.
 *
 * The check before every step (Figures 3 and 9, EKS-GP-4) is made in every cycle, before the box. A word that is judged
 * over several cycles is the one that was read first; when another one stands there the transaction is over (E-16), and
 * the cycle that switches judges all of it once more (E-42).
 * Comments name clauses (EKS-..) and decisions (E-..). A functional model of an F-program, not an F-program. */
#include "fplc.h"

/* ------------------------------------------------------------------ Table 2 (EKS-T2) */

static const uint16_t RE[FPLC_MODES] = {0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C};
static const uint16_t SE[FPLC_MODES] = {0x0FF0, 0x3333, 0x33CC, 0x3C3C, 0x0F0F};
static const uint16_t CH[FPLC_MODES] = {0x3333, 0x33CC, 0x3C3C, 0x0F0F, 0x0FF0};
static const uint16_t SW[FPLC_MODES] = {0x33CC, 0x3C3C, 0x0F0F, 0x0FF0, 0x3333};

/* ------------------------------------------------------------------ the reader, parameters, power-up */

/* How many of A, B, C, D, STR are set (EKS-KS-6, E-06b), and which one is the last of them (EKS-T2). */
static int8_t outputs_set(const fplc_inputs *in, int8_t *level)
{
    const bool output[FPLC_MODES] = {in->A, in->B, in->C, in->D, in->STR};
    int8_t count = 0;
    *level = FPLC_NONE;
    for (int8_t i = 0; i < FPLC_MODES; i++) {
        if (output[i]) {
            *level = i;
            count++;
        }
    }
    return count;
}

fplc_parameters fplc_defaults(void)
{
    const fplc_parameters set = {
        .T_ON_ms = 1000, .T_SEQ_ms = 1000, .T_REM_ms = 1000, .T_DWELL_ms = 0,
        .T_SEQ_FROM_ones = true, .SELECTIONS_once = true,
        .PERMITS = {0x01, 0x03, 0x07, 0x0F, 0x1F}, /* EKS-T2-2 */
    };
    return set;
}

const char *fplc_power_up(fplc_memory *memory, const fplc_parameters *set)
{
    static const char *const permits[FPLC_MODES] = {
        "PERMITS_0", "PERMITS_1", "PERMITS_2", "PERMITS_3", "PERMITS_4"};
    const uint32_t most = 3600000;
    if (set->T_ON_ms < 1 || set->T_ON_ms > most) { return "T_ON_ms"; }
    if (set->T_SEQ_ms < 1 || set->T_SEQ_ms > most) { return "T_SEQ_ms"; }
    if (set->T_REM_ms < 1 || set->T_REM_ms > most) { return "T_REM_ms"; }
    if (set->T_DWELL_ms > most || set->T_DWELL_ms >= set->T_REM_ms) { return "T_DWELL_ms"; } /* E-74 */
    if (!set->T_SEQ_FROM_ones && set->T_ON_ms > set->T_SEQ_ms) { return "T_SEQ_ms"; }        /* E-38 */
    for (int8_t level = 0; level < FPLC_MODES; level++) {
        if ((set->PERMITS[level] >> level) != 1) { /* its own mode, and none above it (E-47) */
            return permits[level];
        }
    }
    const fplc_memory fresh = {
        .set = *set, .state = Start,
        .accepted = FPLC_NONE, .authority = FPLC_NONE, .selection = FPLC_NONE, .mode = FPLC_NONE,
    };
    *memory = fresh;
    return 0;
}

/* ------------------------------------------------------------------ going on */

static void step(fplc_memory *m, fplc_state next) /* to the first box of a step, its timer going on */
{
    m->state = next;
    m->box = 0;
}

static void timed(fplc_memory *m, fplc_state next) /* and the timer starts */
{
    step(m, next);
    m->elapsed_ms = 0;
}

static void forget(fplc_memory *m)
{
    m->accepted = FPLC_NONE;
    m->authority = FPLC_NONE;
    m->selection = FPLC_NONE;
}

static void fault(fplc_memory *m) /* EKS-KS-6, E-22, E-24 */
{
    forget(m);
    if (m->set.ON_ERROR_none) {
        m->mode = FPLC_NONE;
    }
    timed(m, Error);
}

static void removal(fplc_memory *m) /* EKS-8-3, EKS-8-6, E-27 */
{
    forget(m);
    timed(m, Clear);
}

static void settle(fplc_memory *m) /* E-15, E-16, E-21 */
{
    m->selection = FPLC_NONE;
    timed(m, Settle);
}

/* ------------------------------------------------------------------ the check before every step */

static bool is_late(const fplc_memory *m) /* EKS-2-8, EKS-4-4, EKS-4-6, EKS-8-11, E-64 */
{
    switch (m->state) {
    case PulseOnes:
        return m->elapsed_ms >= m->set.T_ON_ms;
    case PulseZeros:
    case OneOutput:
        return m->elapsed_ms >= m->set.T_SEQ_ms;
    case Settle: /* E-15 */
    case Clear:
    case AwaitZeros:
        return m->elapsed_ms >= m->set.T_REM_ms;
    default:
        return false;
    }
}

/* Figures 3 and 9, in the order of E-63. False when it took the cycle. */
static bool check_passes(fplc_memory *m, const fplc_inputs *in, int8_t count, int8_t level)
{
    const bool removing = m->state == Clear || m->state == AwaitZeros;
    const bool pulse = m->state == PulseOnes || m->state == PulseZeros;
    if (m->state == Idle && in->LA) { /* EKS-9-4-FPLC: whatever the outputs show (E-40, E-73) */
        return true;
    }
    if (count > 1 && !pulse && m->state != Error) { /* EKS-2-11, E-09, E-62 */
        fault(m);
        return false;
    }
    if (m->state == Start || m->state == Idle || m->state == Error) {
        return true;
    }
    if (!in->LA && !removing) { /* EKS-3-1-FPLC, E-07 */
        removal(m);
        return false;
    }
    if (m->state >= Authorize && m->state <= Settle && level != m->accepted) { /* E-41, E-68 */
        removal(m);
        return false;
    }
    if (is_late(m)) {
        fault(m);
        return false;
    }
    return true;
}

/* ------------------------------------------------------------------ boxes that ask for zeros */

/* EKS-8-12 to EKS-8-18 one after the other; the last box asks everything again (E-31, E-52). */
static void zeros_box(fplc_memory *m, const fplc_inputs *in, int8_t count, fplc_state then, bool key_out)
{
    const bool words = in->MW03 == 0 && in->MW07 == 0;
    const bool key = !key_out || (!in->LA && count == 0);
    bool yes;
    switch (m->box) {
    case 0: /* EKS-8-12 */
        yes = in->MW03 == 0;
        break;
    case 1: /* EKS-8-13, EKS-8-14 */
        yes = key;
        break;
    default: /* EKS-8-18 */
        yes = words && key && m->elapsed_ms >= m->set.T_DWELL_ms;
        if (yes) {
            timed(m, then);
            return;
        }
        break;
    }
    m->box = yes ? (uint8_t)(m->box + 1) : 0;
}

/* ------------------------------------------------------------------ Figures 5, 6 and 7, a comparison a cycle */

enum { FIGURE_6 = 9 }; /* the first box of Figure 6 within the step */

/* MW03 shows another word than the one that is judged or was latched */
static void another_word(fplc_memory *m, const fplc_inputs *in)
{
    bool code = in->MW03 == 0;
    for (int8_t i = 0; i < FPLC_MODES; i++) {
        code = code || in->MW03 == SE[i];
    }
    if (code) { /* E-16, E-21: taken back or changed */
        settle(m);
    } else { /* EKS-2-19, E-61 */
        fault(m);
    }
}

static void check_selection_box(fplc_memory *m, const fplc_inputs *in)
{
    if (in->MW07 != 0) { /* E-65 */
        fault(m);
        return;
    }
    if (m->box == 0) {
        m->word = in->MW03;
    }
    if (in->MW03 == 0 || in->MW03 != m->word) { /* while it is judged */
        another_word(m, in);
        return;
    }
    if (m->box < FIGURE_6) {
        const int8_t row = (int8_t)(4 - m->box / 2);
        if (row == 0) { /* EKS-5-9: nothing but level 0 and mode 0 is left (E-12) */
            if (m->authority != 0 || m->word != SE[0]) {
                fault(m);
                return;
            }
            m->box = FIGURE_6;
        } else if (m->box % 2 == 0) { /* EKS-5-1, EKS-5-3, EKS-5-5, EKS-5-7 */
            m->box = m->authority == row ? (uint8_t)FIGURE_6 : (uint8_t)(m->box + 1);
        } else if (m->word == SE[row]) { /* EKS-5-2, EKS-5-4, EKS-5-6, EKS-5-8, EKS-5-10 */
            fault(m);
        } else {
            m->box++;
        }
        return;
    }
    const int8_t row = (int8_t)(4 - (m->box - FIGURE_6)); /* EKS-6-1, EKS-6-3, EKS-6-5, EKS-6-7, EKS-6-9 */
    if (row < 0) { /* EKS-6-12, E-12 */
        fault(m);
    } else if (m->word != SE[row]) {
        m->box++;
    } else if ((m->set.PERMITS[m->authority] & (1u << row)) == 0) { /* E-47 */
        fault(m);
    } else {
        m->selection = row; /* E-16 */
        timed(m, EchoSelection);
    }
}

static void transaction_box(fplc_memory *m, const fplc_inputs *in)
{
    if (in->MW03 != SE[m->selection]) {
        another_word(m, in);
        return;
    }
    if (m->state == EchoSelection) { /* EKS-2-20 */
        if (in->MW07 != 0) { /* E-65 */
            fault(m);
        } else {
            timed(m, AwaitAcknowledgment);
        }
        return;
    }
    if (in->MW07 == 0) {
        if (m->state != AwaitAcknowledgment) { /* E-66 */
            settle(m);
        }
        return;
    }
    const int8_t row = (int8_t)(4 - m->box); /* Figure 7, from its first row down */
    switch (m->state) {
    case AwaitAcknowledgment: /* E-11 */
        timed(m, CheckAcknowledgment);
        break;
    case CheckAcknowledgment: /* EKS-2-27; EKS-7-1, EKS-7-3, EKS-7-5, EKS-7-7, EKS-7-9 */
        if (row < 0) {
            fault(m);
        } else if (in->MW07 == SW[row]) {
            timed(m, Match);
        } else {
            m->box++;
        }
        break;
    case Match: /* EKS-2-28; each NO of an even row is the end (E-13) */
        if (row < 0) {
            fault(m);
        } else if (in->MW07 != SW[row]) {
            m->box++;
        } else if (row != m->selection) { /* EKS-7-2, EKS-7-4, EKS-7-6, EKS-7-8, EKS-7-10 */
            fault(m);
        } else {
            timed(m, Switch);
        }
        break;
    default: /* EKS-2-29: the pair is judged in the cycle that switches (E-42) */
        if (in->MW07 != SW[m->selection]) {
            fault(m);
        } else {
            m->mode = m->selection;
            if (m->set.SELECTIONS_once) { /* E-15 */
                timed(m, Complete);
            } else {
                settle(m);
            }
        }
        break;
    }
}

/* ------------------------------------------------------------------ one box */

static void take_box(fplc_memory *m, const fplc_inputs *in, int8_t count, int8_t level)
{
    switch (m->state) {
    case Start: /* E-25c, E-56 */
    case AwaitZeros:
    case Error: /* E-23 */
        zeros_box(m, in, count, Idle, true);
        break;
    case Idle:
        if (in->LA) { /* EKS-2-6 */
            timed(m, PulseOnes);
        }
        break;
    case PulseOnes: /* EKS-4-1 */
        if (count == FPLC_MODES) {
            if (m->set.T_SEQ_FROM_ones) { /* EKS-4-2, E-38 */
                m->elapsed_ms = 0;
            }
            step(m, PulseZeros);
        }
        break;
    case PulseZeros: /* EKS-4-3 */
        if (count == 0) {
            step(m, OneOutput);
        }
        break;
    case OneOutput: /* EKS-4-5, EKS-4-7 */
        if (count == 1) {
            m->accepted = level;
            timed(m, Authorize);
        }
        break;
    case Authorize: /* EKS-2-12: first the question, then the word */
        if (in->MW03 != 0 || in->MW07 != 0) { /* E-54 */
            fault(m);
        } else if (m->box == 0) {
            m->box = 1;
        } else {
            m->authority = m->accepted;
            timed(m, AwaitSelection);
        }
        break;
    case AwaitSelection: /* EKS-2-17 */
        if (in->MW07 != 0) { /* E-65 */
            fault(m);
        } else if (in->MW03 != 0) {
            timed(m, CheckSelection);
        }
        break;
    case CheckSelection: /* EKS-2-18, EKS-2-19 */
        check_selection_box(m, in);
        break;
    case EchoSelection:
    case AwaitAcknowledgment:
    case CheckAcknowledgment:
    case Match:
    case Switch:
        transaction_box(m, in);
        break;
    case Complete: /* EKS-GP-5, E-15 */
        break;
    case Settle: /* EKS-GP-5, E-15 */
        zeros_box(m, in, count, AwaitSelection, false);
        break;
    case Clear: /* EKS-8-6: the timer goes on */
        step(m, AwaitZeros);
        break;
    default:
        fault(m);
        break;
    }
}

void fplc_scan(const fplc_inputs *in, fplc_memory *m, fplc_outputs *out)
{
    int8_t level;
    const int8_t count = outputs_set(in, &level);
    const uint32_t rest = UINT32_MAX - m->elapsed_ms;
    m->elapsed_ms = in->dt_ms < rest ? m->elapsed_ms + in->dt_ms : UINT32_MAX;

    if (check_passes(m, in, count, count == 1 ? level : FPLC_NONE)) {
        take_box(m, in, count, level);
    }

    out->MW01 = m->state >= AwaitSelection && m->state <= Complete ? RE[m->authority] : 0;
    out->MW05 = m->state >= AwaitAcknowledgment && m->state <= Complete ? CH[m->selection] : 0;
    for (int8_t i = 0; i < FPLC_MODES; i++) {
        out->MSO[i] = m->mode == i;
    }
    out->ERROR = m->state == Error;
}
