/* The enable switch with three channels, from its clauses and decisions (spec/enable_switch). */
#ifndef SF_ENABLE_SWITCH_H
#define SF_ENABLE_SWITCH_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t DiscrepancyTimeCh1_Ch3_ms; /* 0..3600000: how long a change between two stages may last (ESF-07) */
    bool MODE_ENDS_ERROR;               /* the end of the mode also ends an error (ESF-08) */
    bool AUTO_RESET_ERRORS;             /* S_AutoReset takes the place of the edge that ends an error (ESF-14) */
} sf_enable_switch_parameters;

typedef struct {
    uint32_t dt_ms; /* since the call before */
    bool Activate;
    bool S_SafetyActive;
    bool S_EnableSwitchCh1;
    bool S_EnableSwitchCh2;
    bool S_EnableSwitchCh3;
    bool S_AutoReset;
    bool Reset;
} sf_enable_switch_inputs;

typedef struct {
    bool Ready;
    bool S_EnableSwitchOut;
    bool SafetyDemand;
    bool ResetRequest;
    bool Error;
    uint16_t DiagCode;
} sf_enable_switch_outputs;

typedef struct {
    sf_enable_switch_parameters set;
    uint16_t code;       /* the state, as its DiagCode (ESF-01) */
    bool reset_before;   /* Reset in the call before */
    uint32_t elapsed_ms; /* of a change; 0 outside one */
} sf_enable_switch_memory;

sf_enable_switch_parameters sf_enable_switch_defaults(void);
/* Takes the parameters over; or names the one that is out of range, and does nothing. */
const char *sf_enable_switch_power_up(sf_enable_switch_memory *m, const sf_enable_switch_parameters *set);
/* One call: at most one transition. */
sf_enable_switch_outputs sf_enable_switch_call(sf_enable_switch_memory *m, const sf_enable_switch_inputs *in);

#endif
