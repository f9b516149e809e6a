/* SF_GuardLocking V1.0: a guard that is closed, locked, and unlocked on request. */
#ifndef SF_GUARD_LOCKING_H
#define SF_GUARD_LOCKING_H

#include <stdbool.h>
#include <stdint.h>

enum { UNLOCK_ON_EDGE, UNLOCK_ON_LATCHED, UNLOCK_ON_LEVEL };          /* GLF-02 */
enum { ZONE_LOST_ERROR, ZONE_LOST_TOLERATED };                        /* GLF-04 */
enum { START_UP_INHIBIT_UNTIL_RESET, START_UP_INHIBIT_UNTIL_OPENED }; /* GLF-08 */
enum { UNLOCK_ENDS_WITH_REQUEST, UNLOCK_ENDS_WHEN_CLOSED };            /* GLF-03 */
enum { CAUSE_OF_LOSS_WHAT_WAS_LOST, CAUSE_OF_LOSS_GUARD_AND_ZONE, CAUSE_OF_LOSS_ZONE }; /* GLF-14 */
enum { MESSAGE_OF_LOSS_UNTIL_RESET, MESSAGE_OF_LOSS_UNTIL_SAFE };      /* GLF-06 */

typedef struct {
    uint8_t UNLOCK_ON, UNLOCK_ENDS, ZONE_LOST, START_UP_INHIBIT, CAUSE_OF_LOSS, MESSAGE_OF_LOSS;
} sf_guard_locking_params;

typedef struct {
    uint32_t dt_ms; /* not used: the block has no timer */
    bool Activate, S_GuardMonitoring, S_SafetyActive, S_GuardLock, UnlockRequest, S_StartReset, S_AutoReset, Reset;
} sf_guard_locking_inputs;

typedef struct {
    bool Ready, S_GuardLocked, S_UnlockGuard, Error;
    uint16_t DiagCode;
} sf_guard_locking_outputs;

/* Between two calls; the state is its code, from which the outputs follow. */
typedef struct {
    sf_guard_locking_params set;
    uint16_t code;
    bool reset_before, request_before; /* the inputs of the call before */
    bool request_pending;              /* it rose while the guard is locked, and stands */
    bool start_up_inhibit;             /* carried from a start-up with a guard that was not locked */
    bool guard_lost;                   /* and not the zone alone: it must be back before a reset */
} sf_guard_locking_memory;

void sf_guard_locking_defaults(sf_guard_locking_params *set);
void sf_guard_locking_power_up(sf_guard_locking_memory *memory, const sf_guard_locking_params *set);
void sf_guard_locking_call(sf_guard_locking_memory *memory, const sf_guard_locking_inputs *in, sf_guard_locking_outputs *out);

#endif
