/* SF_EDM V2.0 as a program for a soft PLC: no allocation, no library, one struct of memory, one call a cycle.
 * Names are those of spec/edm/interface.toml. Times are in ms. */
#ifndef SF_EDM_H
#define SF_EDM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t MonitoringTime_ms; /* 0..3600000: longest time for the contactors to change over (EDM-IN-TIME-1) */
    uint8_t AFTER_RESET;        /* 0 stop_first: S_OutControl must be FALSE before it counts; 1 at_once, the letter (EDMF-04) */
} sf_edm_parameters;

typedef struct {
    uint32_t dt_ms; /* since the call before */
    bool Activate, S_OutControl, S_EDM1, S_EDM2, S_StartReset, Reset;
} sf_edm_inputs;

typedef struct {
    bool Ready, S_EDM_Out, SafetyDemand, ResetRequest, Error;
    uint16_t DiagCode;
} sf_edm_outputs;

typedef struct {
    sf_edm_parameters set;
    uint16_t code; /* DiagCode is the state */
    bool reset_before, control_before;
    bool counts; /* with the output off on request: S_OutControl counts (EDMF-04) */
    uint32_t elapsed_ms;
} sf_edm_memory;

/* The defaults of the interface. */
sf_edm_parameters sf_edm_defaults(void);

/* 0, or the name of a parameter that is out of range; then memory stays as it is. */
const char *sf_edm_power_up(sf_edm_memory *memory, const sf_edm_parameters *set);

/* One call: at most one transition, then the outputs of the state after it. */
void sf_edm_call(const sf_edm_inputs *in, sf_edm_memory *memory, sf_edm_outputs *out);

#endif
