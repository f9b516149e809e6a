/* What the function blocks share: edges of inputs, and a timer in ms that stops at its limit. */
#ifndef CYCLIC_BLOCK_H
#define CYCLIC_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

static inline bool rises(bool now, bool before)
{
    return now && !before;
}

static inline bool held(bool now, bool before)
{
    return now && before;
}

static inline uint32_t counted(uint32_t elapsed_ms, uint32_t dt_ms, uint32_t limit_ms)
{
    return dt_ms >= limit_ms - elapsed_ms ? limit_ms : elapsed_ms + dt_ms; /* elapsed_ms <= limit_ms */
}

#endif
