/* The enable switch with three channels: its state is the code of its state. ES-SEQ-0 to ES-SEQ-9, ESF-01 to ESF-11. */
#include "sf_enable_switch.h"
#include "cyclic_block.h"

enum { TIME_MAX_MS = 3600000 };

enum {
    IDLE = 0x0000,
    BASIC_MODE = 0x8002,
    SAFE_MODE = 0x8004,
    STAGE_0 = 0x8802,
    CHANGE_TO_1 = 0x8812,
    STAGE_1 = 0x8000,
    CHANGE_TO_0 = 0x8822,
    STAGE_2 = 0x8832,
    OPERATION_ERROR = 0xC020,
    PLAUSIBILITY_ERROR = 0xC030,
    EQUIVALENCE_ERROR = 0xC050,
    ERROR_BIT = 0x4000,
    DEMAND_BIT = 0x0800,
    REQUEST_BIT = 0x0400
};

/* The three kinds of error: the cause is there, stage 0 is back, Reset is held (ESF-06, ESF-10). */
static const uint16_t errors[3][3] = {
    {OPERATION_ERROR, 0xC420, 0xC001},
    {PLAUSIBILITY_ERROR, 0xC440, 0xC011},
    {EQUIVALENCE_ERROR, 0xC450, 0xC021},
};

/* Channels 1, 2, 3 as a number of three bits. ES-STAGE-0, ES-STAGE-1, ES-STAGE-2 */
enum { RELEASED = 2, ENABLED = 5, PRESSED_THROUGH = 0, ALL_TRUE = 7 };

static int pattern(const sf_enable_switch_inputs *in)
{
    return (in->S_EnableSwitchCh1 ? 4 : 0) + (in->S_EnableSwitchCh2 ? 2 : 0) + (in->S_EnableSwitchCh3 ? 1 : 0);
}

/* Whatever begins a change, the stages are the same; what differs is the change, and whether stage 1 enables (ESF-02). */
static uint16_t stage(int shown, uint16_t change, uint16_t if_enabled)
{
    switch (shown) {
    case RELEASED:
        return STAGE_0;
    case ENABLED:
        return if_enabled;
    case PRESSED_THROUGH: /* also what is not plugged in (ESF-03) */
        return STAGE_2;
    default:
        return change; /* ESF-04 */
    }
}

/* ES-SEQ-3: equality is too late (ESF-07); then channel 2 or another is the fault (ESF-05) */
static bool late(const sf_enable_switch_memory *m, const sf_enable_switch_inputs *in)
{
    return in->dt_ms >= m->set.DiscrepancyTimeCh1_Ch3_ms - m->elapsed_ms; /* elapsed_ms <= the time */
}

static uint16_t change(const sf_enable_switch_memory *m, const sf_enable_switch_inputs *in, uint16_t if_enabled)
{
    const int shown = pattern(in);
    if (late(m, in)) {
        return shown == ALL_TRUE ? PLAUSIBILITY_ERROR : EQUIVALENCE_ERROR;
    }
    return stage(shown, m->code, if_enabled);
}

static uint16_t of_error(const sf_enable_switch_memory *m, const sf_enable_switch_inputs *in)
{
    const bool released = pattern(in) == RELEASED;
    const bool automatic = m->set.AUTO_RESET_ERRORS && in->S_AutoReset; /* ESF-14 */
    for (int kind = 0; kind < 3; kind++) {
        if (m->code == errors[kind][0]) { /* ES-SEQ-4: stage 0, and nothing else, shows that the cause is gone */
            return released ? errors[kind][1] : m->code;
        }
        if (m->code == errors[kind][1]) { /* ES-SEQ-5, ES-RESTART: first the stage, then a held Reset, then the edge */
            if (!released) {
                return errors[kind][0];
            }
            if (!automatic && held(in->Reset, m->reset_before)) {
                return errors[kind][2];
            }
            if (automatic || rises(in->Reset, m->reset_before)) {
                return in->S_SafetyActive ? STAGE_0 : BASIC_MODE;
            }
            return m->code;
        }
        if (m->code == errors[kind][2]) { /* ESF-10 */
            return in->Reset ? m->code : errors[kind][1];
        }
    }
    return m->code;
}

static uint16_t next(const sf_enable_switch_memory *m, const sf_enable_switch_inputs *in)
{
    if (!in->Activate) { /* ES-SEQ-0 */
        return IDLE;
    }
    if (m->code == IDLE) {
        return BASIC_MODE; /* ES-SEQ-1 */
    }
    if (m->code & ERROR_BIT) {
        return m->set.MODE_ENDS_ERROR && !in->S_SafetyActive ? BASIC_MODE : of_error(m, in); /* ESF-08 */
    }
    if (!in->S_SafetyActive) {
        return BASIC_MODE; /* ES-SEQ-1 */
    }
    switch (m->code) {
    case BASIC_MODE:
        return SAFE_MODE; /* ES-SEQ-2 */
    case SAFE_MODE:
        return pattern(in) == RELEASED ? STAGE_0 : OPERATION_ERROR; /* ESF-02 */
    case STAGE_0:
        return stage(pattern(in), CHANGE_TO_1, STAGE_1); /* ES-SEQ-6, ES-SEQ-9 */
    case CHANGE_TO_1:
        return change(m, in, STAGE_1);
    case STAGE_1:
        return stage(pattern(in), CHANGE_TO_0, STAGE_1); /* ES-SEQ-7 */
    case STAGE_2:
        return stage(pattern(in), CHANGE_TO_0, PLAUSIBILITY_ERROR); /* ES-SEQ-8, ES-ORDER-2 */
    default: /* CHANGE_TO_0 */
        return change(m, in, PLAUSIBILITY_ERROR);
    }
}

static sf_enable_switch_outputs row(uint16_t code)
{
    const sf_enable_switch_outputs out = {
        .Ready = code != IDLE,
        .S_EnableSwitchOut = code == STAGE_1,
        .SafetyDemand = (code & DEMAND_BIT) != 0,
        .ResetRequest = (code & REQUEST_BIT) != 0,
        .Error = (code & ERROR_BIT) != 0,
        .DiagCode = code,
    };
    return out;
}

sf_enable_switch_parameters sf_enable_switch_defaults(void)
{
    const sf_enable_switch_parameters set = {
        .DiscrepancyTimeCh1_Ch3_ms = 0, .MODE_ENDS_ERROR = false, .AUTO_RESET_ERRORS = true};
    return set;
}

const char *sf_enable_switch_power_up(sf_enable_switch_memory *m, const sf_enable_switch_parameters *set)
{
    if (set->DiscrepancyTimeCh1_Ch3_ms > TIME_MAX_MS) {
        return "DiscrepancyTimeCh1_Ch3_ms";
    }
    m->set = *set;
    m->code = IDLE;
    m->reset_before = false;
    m->elapsed_ms = 0;
    return 0;
}

sf_enable_switch_outputs sf_enable_switch_call(sf_enable_switch_memory *m, const sf_enable_switch_inputs *in)
{
    const uint16_t after = next(m, in);
    const bool goes_on = after == m->code && (after == CHANGE_TO_1 || after == CHANGE_TO_0);
    m->elapsed_ms = goes_on ? m->elapsed_ms + in->dt_ms : 0;
    m->code = after;
    m->reset_before = in->Reset;
    return row(after);
}
