/* SF_TestableSafetySensor: shows what a safety sensor sees, and tests the sensor while the machine runs. */
#ifndef SF_TESTABLE_SAFETY_SENSOR_H
#define SF_TESTABLE_SAFETY_SENSOR_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int32_t TestTime_ms;    /* any TIME; outside 0..150 the block shows C000 */
    bool AUTO_RESET_ERRORS; /* TSSF-15 */
} sf_testable_safety_sensor_params;

typedef struct {
    uint32_t dt_ms;
    bool Activate, S_OSSD_In, StartTest, NoExternalTest, S_StartReset, S_AutoReset, Reset;
} sf_testable_safety_sensor_inputs;

typedef struct {
    bool Ready, S_OSSD_Out, S_TestOut, TestPossible, TestExecuted, SafetyDemand, ResetRequest, Error;
    uint16_t DiagCode;
} sf_testable_safety_sensor_outputs;

/* Between two calls; the state is its code, from which the outputs follow. */
typedef struct {
    sf_testable_safety_sensor_params set;
    uint16_t code;
    bool reset_before, start_test_before, sensor_before; /* the inputs of the call before */
    bool start_inhibit;                                  /* TSSF-19: still to be reset, after an interruption */
    uint32_t elapsed_ms;                                 /* in this phase of the test */
} sf_testable_safety_sensor_memory;

void sf_testable_safety_sensor_defaults(sf_testable_safety_sensor_params *set);
void sf_testable_safety_sensor_power_up(sf_testable_safety_sensor_memory *memory, const sf_testable_safety_sensor_params *set);
void sf_testable_safety_sensor_call(sf_testable_safety_sensor_memory *memory, const sf_testable_safety_sensor_inputs *in,
                                    sf_testable_safety_sensor_outputs *out);

#endif
