/* See sf_edm.h. The DiagCode is the state, and its digits are used: C0g0 is the error of group g, C0g1 the same with Reset
 * held in it. Groups 1 to 3: a contactor was not dropped out when the output was asked for; 4 to 6: not in time; 7 to 9: not
 * picked up in time; in each the first contactor, the second, both (EDMF-01). */
#include "sf_edm.h"
#include "cyclic_block.h"

enum {
    IDLE = 0x0000,
    INIT = 0x8401,
    DISABLED = 0x8810,
    ENABLED = 0x8000,
    RESET_ERROR_1 = 0xC001, /* Reset was held in INIT */
    INIT_ERROR = 0xC100,    /* Reset and S_OutControl rose together in INIT */
    FIRST_ERROR = 0xC010,
    AT_REQUEST = 0x0000, DROPPING_OUT = 0x0030, PICKING_UP = 0x0060 /* added to FIRST_ERROR */
};

sf_edm_parameters sf_edm_defaults(void)
{
    const sf_edm_parameters set = {.MonitoringTime_ms = 0, .AFTER_RESET = 1}; /* EDM-IN-TIME-2, EDMF-09; EDMF-04 */
    return set;
}

const char *sf_edm_power_up(sf_edm_memory *memory, const sf_edm_parameters *set)
{
    if (set->MonitoringTime_ms > 3600000) {
        return "MonitoringTime_ms";
    }
    const sf_edm_memory fresh = {.set = *set, .code = IDLE};
    *memory = fresh;
    return 0;
}

/* The timer starts with 0 in the call that enters. */
static void enter(sf_edm_memory *m, uint16_t code, bool counts)
{
    m->code = code;
    m->counts = counts;
    m->elapsed_ms = 0;
}

static void disable_by_hand(const sf_edm_inputs *in, sf_edm_memory *m)
{
    enter(m, DISABLED, m->set.AFTER_RESET == 1 || !in->S_OutControl); /* EDM-IN-RESET-4, EDMF-04 */
}

/* Which contactors do not show what they should. */
static void blame(const sf_edm_inputs *in, sf_edm_memory *m, uint16_t group, bool should)
{
    const bool first = in->S_EDM1 != should, second = in->S_EDM2 != should;
    enter(m, (uint16_t)(FIRST_ERROR + group + (first && second ? 0x20 : second ? 0x10 : 0)), false);
}

static void init(const sf_edm_inputs *in, sf_edm_memory *m)
{
    if (in->S_StartReset) {
        enter(m, DISABLED, true); /* EDM-IN-START-3 */
    } else if (held(in->Reset, m->reset_before)) {
        enter(m, RESET_ERROR_1, false); /* EDMF-10 */
    } else if (rises(in->Reset, m->reset_before)) {
        if (rises(in->S_OutControl, m->control_before)) {
            enter(m, INIT_ERROR, false); /* EDMF-11 */
        } else {
            disable_by_hand(in, m); /* EDM-IN-START-2 */
        }
    }
}

static void output_off(const sf_edm_inputs *in, sf_edm_memory *m)
{
    const uint32_t elapsed_ms = counted(m->elapsed_ms, in->dt_ms, m->set.MonitoringTime_ms);
    const bool right = in->S_EDM1 && in->S_EDM2;
    const bool requested = in->S_OutControl && m->counts;
    if (!right && elapsed_ms == m->set.MonitoringTime_ms) {
        blame(in, m, DROPPING_OUT, true); /* EDM-IN-TIME-1, EDM-SEQ-4 */
    } else if (!right && requested) {
        blame(in, m, AT_REQUEST, true); /* EDM-IN-EDM-2, EDMF-05 */
    } else if (requested) {
        enter(m, ENABLED, false); /* EDM-SEQ-3 */
    } else {
        m->elapsed_ms = elapsed_ms; /* EDM-SEQ-2, EDM-SEQ-6: it expires without result */
        m->counts = m->counts || !in->S_OutControl;
    }
}

static void output_on(const sf_edm_inputs *in, sf_edm_memory *m)
{
    const uint32_t elapsed_ms = counted(m->elapsed_ms, in->dt_ms, m->set.MonitoringTime_ms);
    if ((in->S_EDM1 || in->S_EDM2) && elapsed_ms == m->set.MonitoringTime_ms) {
        blame(in, m, PICKING_UP, false); /* EDM-SEQ-5, EDMF-06, EDMF-08 */
    } else if (!in->S_OutControl) {
        enter(m, DISABLED, true); /* EDM-SEQ-4 */
    } else {
        m->elapsed_ms = elapsed_ms;
    }
}

static void error(const sf_edm_inputs *in, sf_edm_memory *m)
{
    if (m->code & 0x0001) { /* Reset was held */
        if (!in->Reset) {
            enter(m, (uint16_t)(m->code & ~0x0001u), false);
        }
    } else if (held(in->Reset, m->reset_before)) {
        enter(m, m->code | 0x0001, false); /* EDMF-10 */
    } else if (rises(in->Reset, m->reset_before) && in->S_EDM1 && in->S_EDM2) {
        disable_by_hand(in, m); /* EDM-IN-RESET-1, EDM-SEQ-6, EDMF-07 */
    }
}

static void outputs(uint16_t code, sf_edm_outputs *out)
{
    out->Ready = code != IDLE;
    out->S_EDM_Out = code == ENABLED;
    out->SafetyDemand = code == DISABLED;
    out->Error = code >= RESET_ERROR_1;
    out->ResetRequest = code == INIT || (code >= FIRST_ERROR && code < INIT_ERROR && !(code & 0x0001)); /* EDMF-02 */
    out->DiagCode = code;
}

void sf_edm_call(const sf_edm_inputs *in, sf_edm_memory *m, sf_edm_outputs *out)
{
    if (!in->Activate) { /* EDM-IN-ACTIVATE */
        enter(m, IDLE, false);
    } else if (m->code == IDLE) {
        enter(m, INIT, false);
    } else if (m->code == INIT) {
        init(in, m);
    } else if (m->code == RESET_ERROR_1 || m->code == INIT_ERROR) {
        if (!in->Reset) {
            enter(m, INIT, false);
        }
    } else if (m->code == DISABLED) {
        output_off(in, m);
    } else if (m->code == ENABLED) {
        output_on(in, m);
    } else {
        error(in, m);
    }
    m->reset_before = in->Reset; /* in every call, active or not */
    m->control_before = in->S_OutControl;
    outputs(m->code, out);
}
