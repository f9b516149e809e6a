/* The fail-safe PLC of the note as a program for a soft PLC: no allocation, no library, one struct of memory,
 * one call a scan. Names are those of spec/mode_selection/interface.toml. Times are in ms. */
#ifndef FPLC_H
#define FPLC_H

#include <stdbool.h>
#include <stdint.h>

enum { FPLC_MODES = 5, FPLC_NONE = -1 }; /* modes and levels are 0..4; none is -1 */

typedef enum { /* the step that is executed next (EKS-GP-3) */
    Start, Idle,
    PulseOnes, PulseZeros, OneOutput,                                   /* Figure 4 */
    Authorize, AwaitSelection, CheckSelection,                          /* steps 12, 17, 18 and 19 */
    EchoSelection, AwaitAcknowledgment, CheckAcknowledgment, Match, Switch, /* steps 20, 27, 28, 29 */
    Complete, Settle,                                                   /* E-15 */
    Clear, AwaitZeros,                                                  /* removal, steps 3 to 18 */
    Error
} fplc_state;

typedef struct {
    uint32_t T_ON_ms;    /* 1..3600000: from LA to all outputs set (EKS-2-6) */
    uint32_t T_SEQ_ms;   /* 1..3600000: for the whole sequence of outputs (EKS-4-2) */
    uint32_t T_REM_ms;   /* 1..3600000: for the whole removal (EKS-8-3), and for Settle (E-15) */
    uint32_t T_DWELL_ms; /* 0..3600000: least time before zeros count as returned (E-52) */
    bool T_SEQ_FROM_ones; /* T_SEQ_ms counts from all outputs set; else from LA (E-38) */
    bool ON_ERROR_none;   /* Error clears the active mode; else it is held (E-24) */
    bool SELECTIONS_once; /* one switchover for each insertion; else another one may follow (E-15) */
    uint8_t PERMITS[FPLC_MODES]; /* for each level a bit for each mode that it permits (E-47) */
} fplc_parameters;

typedef struct {
    uint32_t dt_ms;           /* time since the previous scan */
    bool LA, A, B, C, D, STR; /* the key reader: switching channel and five outputs */
    uint16_t MW03, MW07;      /* selection and acknowledgment, from the PLC */
} fplc_inputs;

typedef struct {
    uint16_t MW01, MW05;   /* authorization level and echo, to the PLC */
    bool MSO[FPLC_MODES];  /* the active mode, at most one */
    bool ERROR;
} fplc_outputs;

typedef struct { /* all that one scan leaves for the next */
    fplc_parameters set;
    fplc_state state;
    int8_t accepted;  /* level of the one output accepted in this insertion */
    int8_t authority; /* authorization level of this insertion; MW01 is never read back (E-18) */
    int8_t selection; /* latched from MW03 (E-16) */
    int8_t mode;      /* the active mode; none until the first switchover */
    uint32_t elapsed_ms; /* since the timer of this state was started */
    uint8_t box;   /* of fplc_boxes.c alone: the diagram box that comes next in this step */
    uint16_t word; /* of fplc_boxes.c alone: the word that is being judged */
} fplc_memory;

/* The defaults of the interface. */
fplc_parameters fplc_defaults(void);

/* Power-up (E-25c). 0, or the name of a parameter that is out of range or does not go with another; then memory
 * stays as it is. */
const char *fplc_power_up(fplc_memory *memory, const fplc_parameters *set);

/* One scan: reads the inputs, takes at most one step, writes the outputs of the state after it. */
void fplc_scan(const fplc_inputs *in, fplc_memory *memory, fplc_outputs *out);

#endif
