/* The names of sf_edm.c on the wire; adapter_block.c does the rest. */
#include "block.h"
#include "sf_edm.h"

static sf_edm_parameters set;
static sf_edm_inputs in;
static sf_edm_outputs out;
static sf_edm_memory memory;

static void defaults(void)
{
    set = sf_edm_defaults();
}

static const char *power_up(void)
{
    return sf_edm_power_up(&memory, &set);
}

static void call(void)
{
    sf_edm_call(&in, &memory, &out);
}

static const block_row inputs[] = {
    {.name = "Activate", .flag = &in.Activate},
    {.name = "S_OutControl", .flag = &in.S_OutControl},
    {.name = "S_EDM1", .flag = &in.S_EDM1},
    {.name = "S_EDM2", .flag = &in.S_EDM2},
    {.name = "S_StartReset", .flag = &in.S_StartReset},
    {.name = "Reset", .flag = &in.Reset},
    {0}};
static const block_row outputs[] = {
    {.name = "Ready", .flag = &out.Ready},
    {.name = "S_EDM_Out", .flag = &out.S_EDM_Out},
    {.name = "SafetyDemand", .flag = &out.SafetyDemand},
    {.name = "ResetRequest", .flag = &out.ResetRequest},
    {.name = "Error", .flag = &out.Error},
    {.name = "DiagCode", .word = &out.DiagCode},
    {0}};
static const block_row parameters[] = {
    {.name = "MonitoringTime_ms", .number = &set.MonitoringTime_ms},
    {.name = "AFTER_RESET", .choice = &set.AFTER_RESET, .values = {"stop_first", "at_once"}},
    {0}};
const block served = {"sf_edm", &in.dt_ms, inputs, outputs, parameters, defaults, power_up, call};
