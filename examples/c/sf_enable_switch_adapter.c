/* The enable switch on the wire: see block.h. */
#include "block.h"
#include "sf_enable_switch.h"

static sf_enable_switch_parameters set;
static sf_enable_switch_inputs in;
static sf_enable_switch_outputs out;
static sf_enable_switch_memory memory;

static const block_row inputs[] = {
    {.name = "Activate", .flag = &in.Activate},
    {.name = "S_SafetyActive", .flag = &in.S_SafetyActive},
    {.name = "S_EnableSwitchCh1", .flag = &in.S_EnableSwitchCh1},
    {.name = "S_EnableSwitchCh2", .flag = &in.S_EnableSwitchCh2},
    {.name = "S_EnableSwitchCh3", .flag = &in.S_EnableSwitchCh3},
    {.name = "S_AutoReset", .flag = &in.S_AutoReset},
    {.name = "Reset", .flag = &in.Reset},
    {0},
};
static const block_row outputs[] = {
    {.name = "Ready", .flag = &out.Ready},
    {.name = "S_EnableSwitchOut", .flag = &out.S_EnableSwitchOut},
    {.name = "SafetyDemand", .flag = &out.SafetyDemand},
    {.name = "ResetRequest", .flag = &out.ResetRequest},
    {.name = "Error", .flag = &out.Error},
    {.name = "DiagCode", .word = &out.DiagCode},
    {0},
};
static const block_row parameters[] = {
    {.name = "DiscrepancyTimeCh1_Ch3_ms", .number = &set.DiscrepancyTimeCh1_Ch3_ms},
    {.name = "MODE_ENDS_ERROR", .flag = &set.MODE_ENDS_ERROR},
    {.name = "AUTO_RESET_ERRORS", .flag = &set.AUTO_RESET_ERRORS},
    {0},
};

static void defaults(void)
{
    set = sf_enable_switch_defaults();
}

static const char *power_up(void)
{
    const char *wrong = sf_enable_switch_power_up(&memory, &set);
    if (!wrong) {
        const sf_enable_switch_outputs nothing = {0};
        out = nothing;
    }
    return wrong;
}

static void call(void)
{
    out = sf_enable_switch_call(&memory, &in);
}

const block served = {"sf_enable_switch", &in.dt_ms, inputs, outputs, parameters, defaults, power_up, call};
