/* What a function block tells adapter_block.c about itself: its names on the wire, and where each value lies.
 * A block SF brings three files: SF.c and SF.h, the program, and SF_adapter.c, which fills this in. */
#ifndef BLOCK_H
#define BLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum { BLOCK_CHOICES = 4 };

/* One signal or parameter, with one of five places for its value. A table ends with a row without name. */
typedef struct {
    const char *name;
    bool *flag;                        /* true or false */
    uint16_t *word;                    /* four upper-case hex digits */
    uint32_t *number;                  /* 0..4294967295, times in ms too */
    int32_t *signed_number;            /* -2147483648..2147483647: a time that may be out of its range */
    uint8_t *choice;                   /* one of these texts, by its place among them */
    const char *values[BLOCK_CHOICES]; /* at most so many */
} block_row;

typedef struct {
    const char *target;
    uint32_t *dt_ms;
    const block_row *inputs;
    const block_row *outputs;
    const block_row *parameters;
    void (*defaults)(void);        /* sets all parameters; the line may then change some */
    const char *(*power_up)(void); /* takes the parameters over; or names the one that is out of range, and does nothing */
    void (*call)(void);            /* one call: from the inputs to the outputs */
} block;

extern const block served;

#endif
