/* The names of SF_GuardLocking on the wire, for adapter_block.c. */
#include "block.h"
#include "sf_guard_locking.h"

#include <stddef.h>

static sf_guard_locking_params set;
static sf_guard_locking_inputs in;
static sf_guard_locking_outputs out;
static sf_guard_locking_memory memory;

static const block_row inputs[] = {{.name = "Activate", .flag = &in.Activate},
                                   {.name = "S_GuardMonitoring", .flag = &in.S_GuardMonitoring},
                                   {.name = "S_SafetyActive", .flag = &in.S_SafetyActive},
                                   {.name = "S_GuardLock", .flag = &in.S_GuardLock},
                                   {.name = "UnlockRequest", .flag = &in.UnlockRequest},
                                   {.name = "S_StartReset", .flag = &in.S_StartReset},
                                   {.name = "S_AutoReset", .flag = &in.S_AutoReset},
                                   {.name = "Reset", .flag = &in.Reset},
                                   {0}};
static const block_row outputs[] = {{.name = "Ready", .flag = &out.Ready},
                                    {.name = "S_GuardLocked", .flag = &out.S_GuardLocked},
                                    {.name = "S_UnlockGuard", .flag = &out.S_UnlockGuard},
                                    {.name = "Error", .flag = &out.Error},
                                    {.name = "DiagCode", .word = &out.DiagCode},
                                    {0}};
static const block_row parameters[] = {
    {.name = "UNLOCK_ON", .choice = &set.UNLOCK_ON, .values = {"edge", "latched", "level"}},
    {.name = "UNLOCK_ENDS", .choice = &set.UNLOCK_ENDS, .values = {"with_request", "when_closed"}},
    {.name = "MESSAGE_OF_LOSS", .choice = &set.MESSAGE_OF_LOSS, .values = {"until_reset", "until_safe"}},
    {.name = "ZONE_LOST", .choice = &set.ZONE_LOST, .values = {"error", "tolerated"}},
    {.name = "START_UP_INHIBIT", .choice = &set.START_UP_INHIBIT, .values = {"until_reset", "until_opened"}},
    {.name = "CAUSE_OF_LOSS", .choice = &set.CAUSE_OF_LOSS, .values = {"what_was_lost", "guard_and_zone", "zone"}},
    {0}};

static void defaults(void)
{
    sf_guard_locking_defaults(&set);
}

static const char *power_up(void)
{
    sf_guard_locking_power_up(&memory, &set);
    return NULL;
}

static void call(void)
{
    sf_guard_locking_call(&memory, &in, &out);
}

const block served = {"sf_guard_locking", &in.dt_ms, inputs, outputs, parameters, defaults, power_up, call};
