/* The names of SF_TestableSafetySensor on the wire, for adapter_block.c. */
#include "block.h"
#include "sf_testable_safety_sensor.h"

#include <stddef.h>

static sf_testable_safety_sensor_params set;
static sf_testable_safety_sensor_inputs in;
static sf_testable_safety_sensor_outputs out;
static sf_testable_safety_sensor_memory memory;

static const block_row inputs[] = {{.name = "Activate", .flag = &in.Activate},
                                   {.name = "S_OSSD_In", .flag = &in.S_OSSD_In},
                                   {.name = "StartTest", .flag = &in.StartTest},
                                   {.name = "NoExternalTest", .flag = &in.NoExternalTest},
                                   {.name = "S_StartReset", .flag = &in.S_StartReset},
                                   {.name = "S_AutoReset", .flag = &in.S_AutoReset},
                                   {.name = "Reset", .flag = &in.Reset},
                                   {0}};
static const block_row outputs[] = {{.name = "Ready", .flag = &out.Ready},
                                    {.name = "S_OSSD_Out", .flag = &out.S_OSSD_Out},
                                    {.name = "S_TestOut", .flag = &out.S_TestOut},
                                    {.name = "TestPossible", .flag = &out.TestPossible},
                                    {.name = "TestExecuted", .flag = &out.TestExecuted},
                                    {.name = "SafetyDemand", .flag = &out.SafetyDemand},
                                    {.name = "ResetRequest", .flag = &out.ResetRequest},
                                    {.name = "Error", .flag = &out.Error},
                                    {.name = "DiagCode", .word = &out.DiagCode},
                                    {0}};
static const block_row parameters[] = {{.name = "TestTime_ms", .signed_number = &set.TestTime_ms},
                                       {.name = "AUTO_RESET_ERRORS", .flag = &set.AUTO_RESET_ERRORS},
                                       {0}};

static void defaults(void)
{
    sf_testable_safety_sensor_defaults(&set);
}

static const char *power_up(void)
{
    sf_testable_safety_sensor_power_up(&memory, &set);
    return NULL;
}

static void call(void)
{
    sf_testable_safety_sensor_call(&memory, &in, &out);
}

const block served = {"sf_testable_safety_sensor", &in.dt_ms, inputs, outputs, parameters, defaults, power_up, call};
