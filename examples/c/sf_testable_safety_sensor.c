/* SF_TestableSafetySensor from the clauses and decisions: no allocation, no library, one struct of memory, one call a cycle. */
#include "sf_testable_safety_sensor.h"
#include "cyclic_block.h"

enum {
    IDLE = 0x0000,
    TEST_OK = 0x8000,
    EXTERNAL_TEST = 0x8002,
    NO_TEST = 0x8010,
    TEST_REQUEST = 0x8020,
    TEST_ACTIVE = 0x8030,
    INIT = 0x8401,
    WAIT_1 = 0x8402,
    END_EXTERNAL = 0x8404,
    WAIT_2 = 0x8406,
    INTERRUPTED_1 = 0x8802,
    INTERRUPTED_EXTERNAL = 0x8804,
    INTERRUPTED_2 = 0x8806,
    PARAMETER_ERROR = 0xC000,
    RESET_ERROR_1 = 0xC001, /* in INIT */
    TEST_ERROR_X0 = 0xC010,
    RESET_ERROR_2 = 0xC011, /* in WAIT_1 */
    RESET_ERROR_3 = 0xC021, /* in the test error */
    RESET_ERROR_4 = 0xC031, /* in END_EXTERNAL (TSSF-02) */
    RESET_ERROR_5 = 0xC041, /* in PARAMETER_ERROR */
    RESET_ERROR_6 = 0xC051, /* in WAIT_2 (TSSF-03) */
    TEST_ERROR_X4 = 0xC410,
    LONGEST_MS = 150
};

typedef sf_testable_safety_sensor_memory memory_t;
typedef sf_testable_safety_sensor_inputs inputs_t;

void sf_testable_safety_sensor_defaults(sf_testable_safety_sensor_params *set)
{
    set->TestTime_ms = 10;
    set->AUTO_RESET_ERRORS = true;
}

void sf_testable_safety_sensor_power_up(sf_testable_safety_sensor_memory *memory, const sf_testable_safety_sensor_params *set)
{
    *memory = (sf_testable_safety_sensor_memory){.set = *set, .code = IDLE};
}

/* TSS-CX10: x is 4 exactly if the sensor is free and there is no manual test, in every call (TSSF-17) */
static uint16_t test_error(const inputs_t *in)
{
    return in->S_OSSD_In && in->NoExternalTest ? TEST_ERROR_X4 : TEST_ERROR_X0;
}

/* TSS-IN-TESTTIME */
static bool time_fits(const memory_t *m)
{
    return m->set.TestTime_ms >= 0 && m->set.TestTime_ms <= LONGEST_MS;
}

/* TSS-TEST-0: this phase has lasted TestTime (TSSF-08); only asked where TestTime is valid */
static bool expired(const memory_t *m, const inputs_t *in)
{
    const uint32_t limit = (uint32_t)m->set.TestTime_ms;
    return counted(m->elapsed_ms, in->dt_ms, limit) >= limit;
}

/* The waits for Reset: a static one first, then the loss of the sensor, then the edge (TSSF-21) */
static uint16_t wait_for_reset(const memory_t *m, const inputs_t *in, bool alone, uint16_t here, uint16_t found, uint16_t lost,
                               uint16_t enabled)
{
    if (held(in->Reset, m->reset_before) && !alone) {
        return found;
    }
    if (!in->S_OSSD_In) {
        return lost;
    }
    return rises(in->Reset, m->reset_before) || alone ? enabled : here;
}

/* TSS-8020, TSS-8030, TSS-8010, TSS-8000: the sensor is free, or under test */
static uint16_t enabled(const memory_t *m, const inputs_t *in)
{
    switch (m->code) {
    case TEST_REQUEST:
        if (expired(m, in)) { /* before the reaction (TSSF-07) */
            return test_error(in);
        }
        return in->S_OSSD_In ? TEST_REQUEST : TEST_ACTIVE;
    case TEST_ACTIVE:
        if (expired(m, in)) {
            return test_error(in);
        }
        return in->S_OSSD_In ? TEST_OK : TEST_ACTIVE;
    default: /* NO_TEST, TEST_OK: the loss before the test (TSSF-22) */
        if (!in->S_OSSD_In) {
            return m->code == TEST_OK ? INTERRUPTED_2 : INTERRUPTED_1;
        }
        return rises(in->StartTest, m->start_test_before) ? TEST_REQUEST : m->code;
    }
}

/* TSS-CX10, TSS-8002, TSS-8804, TSS-8404: after a failed test */
static uint16_t failed(const memory_t *m, const inputs_t *in)
{
    const bool alone = m->set.AUTO_RESET_ERRORS && in->S_AutoReset; /* TSSF-15 */
    const bool ends = rises(in->Reset, m->reset_before) || alone;
    switch (m->code) {
    case EXTERNAL_TEST: /* a falling edge (TSSF-16) */
        return m->sensor_before && !in->S_OSSD_In ? INTERRUPTED_EXTERNAL : EXTERNAL_TEST;
    case INTERRUPTED_EXTERNAL:
        return in->S_OSSD_In ? END_EXTERNAL : INTERRUPTED_EXTERNAL;
    case END_EXTERNAL:
        return wait_for_reset(m, in, alone, END_EXTERNAL, RESET_ERROR_4, INTERRUPTED_EXTERNAL, NO_TEST);
    default:
        if (held(in->Reset, m->reset_before) && !alone) {
            return RESET_ERROR_3;
        }
        if (ends && !in->NoExternalTest) { /* TSSF-13, TSSF-14 */
            return EXTERNAL_TEST;
        }
        if (ends && in->S_OSSD_In && m->code == TEST_ERROR_X4) { /* TSSF-18 */
            return NO_TEST;
        }
        return test_error(in);
    }
}

/* The end of Reset leads back to where it was found static. */
static uint16_t reset_error(const memory_t *m, const inputs_t *in)
{
    if (in->Reset) {
        return m->code;
    }
    switch (m->code) {
    case RESET_ERROR_1:
        return INIT;
    case RESET_ERROR_2:
        return WAIT_1;
    case RESET_ERROR_3:
        return test_error(in);
    case RESET_ERROR_4:
        return END_EXTERNAL;
    case RESET_ERROR_5:
        return PARAMETER_ERROR;
    default:
        return WAIT_2;
    }
}

static uint16_t next(const memory_t *m, const inputs_t *in)
{
    const bool alone = in->S_AutoReset && !m->start_inhibit; /* TSSF-19 */
    switch (m->code) {
    case IDLE:
        return INIT;
    case INIT: /* TSSF-11 */
        if (!time_fits(m)) {
            return PARAMETER_ERROR;
        }
        return wait_for_reset(m, in, in->S_StartReset, INIT, RESET_ERROR_1, INTERRUPTED_1, NO_TEST);
    case INTERRUPTED_1:
        if (!in->S_OSSD_In) {
            return INTERRUPTED_1;
        }
        return alone ? NO_TEST : WAIT_1;
    case INTERRUPTED_2:
        if (!in->S_OSSD_In) {
            return INTERRUPTED_2;
        }
        return alone ? TEST_OK : WAIT_2;
    case WAIT_1:
        return wait_for_reset(m, in, alone, WAIT_1, RESET_ERROR_2, INTERRUPTED_1, NO_TEST);
    case WAIT_2:
        return wait_for_reset(m, in, alone, WAIT_2, RESET_ERROR_6, INTERRUPTED_2, TEST_OK);
    case NO_TEST:
    case TEST_OK:
    case TEST_REQUEST:
    case TEST_ACTIVE:
        return enabled(m, in);
    case PARAMETER_ERROR: /* TSSF-12 */
        return held(in->Reset, m->reset_before) ? RESET_ERROR_5 : PARAMETER_ERROR;
    case TEST_ERROR_X0:
    case TEST_ERROR_X4:
    case EXTERNAL_TEST:
    case INTERRUPTED_EXTERNAL:
    case END_EXTERNAL:
        return failed(m, in);
    default:
        return reset_error(m, in);
    }
}

void sf_testable_safety_sensor_call(sf_testable_safety_sensor_memory *memory, const sf_testable_safety_sensor_inputs *in,
                                    sf_testable_safety_sensor_outputs *out)
{
    const uint16_t before = memory->code;
    const uint16_t code = in->Activate ? next(memory, in) : IDLE;
    const bool free = code == NO_TEST || code == TEST_OK;
    const bool in_test = code == TEST_REQUEST || code == TEST_ACTIVE;

    if (in_test && code == before) {
        memory->elapsed_ms = counted(memory->elapsed_ms, in->dt_ms, (uint32_t)memory->set.TestTime_ms);
    } else {
        memory->elapsed_ms = 0; /* each phase has its own TestTime (TSSF-06) */
    }
    if (before == INIT) {
        memory->start_inhibit = code == INTERRUPTED_1 && !in->S_StartReset;
    } else if (free || code == IDLE) {
        memory->start_inhibit = false;
    }
    memory->reset_before = in->Reset;
    memory->start_test_before = in->StartTest;
    memory->sensor_before = in->S_OSSD_In;
    memory->code = code;

    /* TSS-OUT-DIAG: four bits of the code are outputs; the others follow from the state */
    out->DiagCode = code;
    out->Ready = code != IDLE;
    out->Error = code >= PARAMETER_ERROR;
    out->SafetyDemand = (code & 0x0800) != 0;
    out->ResetRequest = (code & 0x0400) != 0;
    out->S_OSSD_Out = free || in_test;
    out->S_TestOut = code != TEST_REQUEST;
    out->TestPossible = free;
    out->TestExecuted = code == TEST_OK || code == INTERRUPTED_2 || code == WAIT_2 || code == RESET_ERROR_6;
}
