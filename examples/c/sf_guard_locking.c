/* SF_GuardLocking V1.0 from the clauses and decisions: no allocation, no library, one struct of memory, one call a cycle. */
#include "sf_guard_locking.h"
#include "cyclic_block.h"

enum {
    IDLE = 0x0000,
    CLOSED_AND_LOCKED = 0x8000,
    INIT = 0x8001,
    WAIT_FOR_RESET = 0x8003,
    WAIT_FOR_OPERATOR = 0x8011,
    OPEN_AND_UNLOCKED = 0x8012,
    CLOSED_BUT_UNLOCKED = 0x8013,
    SAFETY_RETURN = 0x8014,
    RESET_ERROR_1 = 0xC001,
    RESET_ERROR_2 = 0xC002,
    RESET_ERROR_3 = 0xC003,
    SAFETY_LOST = 0xC004,
    ERRORS = 0xC000
};

void sf_guard_locking_defaults(sf_guard_locking_params *set)
{
    set->UNLOCK_ON = UNLOCK_ON_LATCHED;
    set->UNLOCK_ENDS = UNLOCK_ENDS_WITH_REQUEST;
    set->ZONE_LOST = ZONE_LOST_ERROR;
    set->START_UP_INHIBIT = START_UP_INHIBIT_UNTIL_RESET;
    set->CAUSE_OF_LOSS = CAUSE_OF_LOSS_WHAT_WAS_LOST;
    set->MESSAGE_OF_LOSS = MESSAGE_OF_LOSS_UNTIL_RESET;
}

void sf_guard_locking_power_up(sf_guard_locking_memory *memory, const sf_guard_locking_params *set)
{
    *memory = (sf_guard_locking_memory){.set = *set, .code = IDLE};
}

/* GL-IN-UNLOCKREQUEST: what asks to unlock a locked guard */
static bool asked(const sf_guard_locking_memory *m, const sf_guard_locking_inputs *in)
{
    if (rises(in->UnlockRequest, m->request_before)) {
        return true;
    }
    if (m->set.UNLOCK_ON == UNLOCK_ON_LATCHED) {
        return in->UnlockRequest && m->request_pending;
    }
    return in->UnlockRequest && m->set.UNLOCK_ON == UNLOCK_ON_LEVEL;
}

/* A state that waits for an edge of Reset: where it may not go on alone, a static Reset comes before everything else (GLF-07) */
static uint16_t next(const sf_guard_locking_memory *m, const sf_guard_locking_inputs *in)
{
    const bool secured = in->S_GuardMonitoring && in->S_GuardLock;
    const bool zone_lost = !in->S_SafetyActive;
    const bool edge = rises(in->Reset, m->reset_before);
    const bool stuck = held(in->Reset, m->reset_before);
    const bool ends = !in->UnlockRequest && m->set.UNLOCK_ENDS == UNLOCK_ENDS_WITH_REQUEST; /* GL-SEQ-3, GLF-03 */
    const bool alone = in->S_AutoReset && !m->start_up_inhibit; /* GL-IN-AUTORESET, GLF-08 */

    switch (m->code) {
    case INIT: /* GL-SEQ-1, GL-SEQ-2 */
        if (stuck && !in->S_StartReset) {
            return RESET_ERROR_1;
        }
        if (!secured) {
            return WAIT_FOR_OPERATOR;
        }
        return edge || in->S_StartReset ? CLOSED_AND_LOCKED : INIT;

    case CLOSED_AND_LOCKED: /* GL-SEQ-2, GL-SEQ-3: the loss before the request (GLF-12) */
        if (!secured) {
            return SAFETY_LOST;
        }
        return asked(m, in) && in->S_SafetyActive ? CLOSED_BUT_UNLOCKED : CLOSED_AND_LOCKED;

    case CLOSED_BUT_UNLOCKED: /* GL-SEQ-3, GL-SEQ-4, GL-SEQ-5 */
        if (zone_lost && m->set.ZONE_LOST == ZONE_LOST_ERROR) {
            return SAFETY_LOST;
        }
        if (ends) {
            return WAIT_FOR_OPERATOR;
        }
        if (!in->S_GuardMonitoring) {
            return OPEN_AND_UNLOCKED;
        }
        return in->UnlockRequest ? CLOSED_BUT_UNLOCKED : WAIT_FOR_OPERATOR;

    case OPEN_AND_UNLOCKED: /* GL-SEQ-4 */
        if (zone_lost && (m->set.ZONE_LOST == ZONE_LOST_ERROR || !in->S_GuardMonitoring)) {
            return SAFETY_LOST;
        }
        if (ends) {
            return WAIT_FOR_OPERATOR;
        }
        return in->S_GuardMonitoring ? CLOSED_BUT_UNLOCKED : OPEN_AND_UNLOCKED;

    case WAIT_FOR_OPERATOR: /* GL-SEQ-5, GLF-10, GLF-11 */
        if (zone_lost && !secured) {
            return SAFETY_LOST;
        }
        if ((!in->S_GuardMonitoring && !ends) || (in->UnlockRequest && in->S_SafetyActive)) {
            return OPEN_AND_UNLOCKED;
        }
        return secured ? WAIT_FOR_RESET : WAIT_FOR_OPERATOR;

    case WAIT_FOR_RESET: /* GL-IN-AUTORESET */
        if (stuck && !alone) {
            return RESET_ERROR_3;
        }
        if (!secured) {
            return WAIT_FOR_OPERATOR;
        }
        return edge || alone ? CLOSED_AND_LOCKED : WAIT_FOR_RESET;

    case SAFETY_LOST: /* GLF-06, GLF-09 */
        return zone_lost ? SAFETY_LOST : SAFETY_RETURN;

    case SAFETY_RETURN: /* whatever S_AutoReset says (GLF-13) */
        if (stuck) {
            return RESET_ERROR_2;
        }
        if (zone_lost) {
            return SAFETY_LOST;
        }
        if (!secured && (m->guard_lost || m->set.CAUSE_OF_LOSS == CAUSE_OF_LOSS_GUARD_AND_ZONE)) {
            return SAFETY_RETURN; /* GLF-14 */
        }
        return edge ? WAIT_FOR_OPERATOR : SAFETY_RETURN;

    case RESET_ERROR_1:
        return in->Reset ? RESET_ERROR_1 : INIT;
    case RESET_ERROR_2:
        return in->Reset ? RESET_ERROR_2 : SAFETY_RETURN;
    case RESET_ERROR_3:
        return in->Reset ? RESET_ERROR_3 : WAIT_FOR_RESET;
    default: /* IDLE */
        return INIT;
    }
}

void sf_guard_locking_call(sf_guard_locking_memory *m, const sf_guard_locking_inputs *in, sf_guard_locking_outputs *out)
{
    const uint16_t was = m->code;
    const bool rose = rises(in->UnlockRequest, m->request_before);
    m->code = in->Activate ? next(m, in) : (uint16_t)IDLE; /* GL-IN-ACTIVATE: first of all */

    /* GLF-08: a start-up that finds the guard not locked carries its inhibit to the first enable */
    if (m->code == IDLE || m->code == CLOSED_AND_LOCKED) {
        m->start_up_inhibit = false;
    } else if (was == INIT && m->code == WAIT_FOR_OPERATOR) {
        m->start_up_inhibit = !in->S_StartReset && m->set.START_UP_INHIBIT == START_UP_INHIBIT_UNTIL_RESET;
    }
    /* GLF-14: what was lost, from the loss to its reset */
    if (m->code == SAFETY_LOST && was == CLOSED_AND_LOCKED) {
        m->guard_lost = m->set.CAUSE_OF_LOSS == CAUSE_OF_LOSS_WHAT_WAS_LOST;
    } else if (m->code != SAFETY_LOST && m->code != SAFETY_RETURN && m->code != RESET_ERROR_2) {
        m->guard_lost = false;
    }
    m->request_pending = m->code == CLOSED_AND_LOCKED && in->UnlockRequest && (rose || m->request_pending);
    m->request_before = in->UnlockRequest;
    m->reset_before = in->Reset; /* in every call, active or not */

    out->Ready = m->code != IDLE;
    out->S_GuardLocked = m->code == CLOSED_AND_LOCKED;
    out->S_UnlockGuard = m->code == OPEN_AND_UNLOCKED || m->code == CLOSED_BUT_UNLOCKED;
    out->Error = m->code > ERRORS || (m->code == SAFETY_RETURN && m->set.MESSAGE_OF_LOSS == MESSAGE_OF_LOSS_UNTIL_RESET);
    out->DiagCode = m->code;
}
