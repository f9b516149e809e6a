/* Adapter protocol 1 over standard input and output: one line in, one line out. It serves fplc.c.
 * For a program of your own, replace the lines marked <--; wire.c stays as it is. */
#include "fplc.h"
#include "wire.h"

#include <stdio.h>

#ifndef FPLC_NAME /* what it says of itself: here of fplc.c, which answers scan by scan; the Makefile has that of fplc_boxes.c */
#define FPLC_NAME "fplc.c"
#define FPLC_RELATION "exact"
#define FPLC_LATENCY "0" /* most scans after which an input that is held has had all its effects */
#endif

static fplc_memory memory; /* <-- */
static fplc_outputs out;   /* <-- as it stands on the terminals between two scans */
static bool is_reset;

static void time_ms(wire_line *line, const char *name, uint32_t *ms)
{
    if (wire_has(line, name)) {
        *ms = wire_number(line, name);
    }
}

static void choice(wire_line *line, const char *name, const char *no, const char *yes, bool *value)
{
    if (wire_is(line, name, yes)) {
        *value = true;
    } else if (wire_is(line, name, no)) {
        *value = false;
    } else if (wire_has(line, name)) {
        wire_refuse(line, name, "unknown value");
    }
}

static void reset(wire_line *line)
{
    static const char *const permits[FPLC_MODES] = {
        "params.PERMITS_0", "params.PERMITS_1", "params.PERMITS_2", "params.PERMITS_3", "params.PERMITS_4"};
    fplc_parameters set = fplc_defaults(); /* <-- parameters that the line leaves out */
    wire_object(line, "params");
    time_ms(line, "params.T_ON_ms", &set.T_ON_ms);
    time_ms(line, "params.T_SEQ_ms", &set.T_SEQ_ms);
    time_ms(line, "params.T_REM_ms", &set.T_REM_ms);
    time_ms(line, "params.T_DWELL_ms", &set.T_DWELL_ms);
    choice(line, "params.T_SEQ_FROM", "LA", "ones", &set.T_SEQ_FROM_ones);
    choice(line, "params.ON_ERROR", "hold", "none", &set.ON_ERROR_none);
    choice(line, "params.SELECTIONS", "again", "once", &set.SELECTIONS_once);
    for (int level = 0; level < FPLC_MODES; level++) {
        if (wire_has(line, permits[level])) {
            set.PERMITS[level] = wire_modes(line, permits[level]);
        }
    }
    if (!wire_all_taken(line)) {
        return;
    }
    const char *wrong = fplc_power_up(&memory, &set); /* <-- power-up */
    if (wrong) {
        wire_refuse(line, wrong, "out of range, or does not go with another parameter");
        return;
    }
    is_reset = true;
    printf("{\"ok\":true}\n");
}

static const char *truth(bool value)
{
    return value ? "true" : "false";
}

static void scan(wire_line *line)
{
    const fplc_inputs in = {
        .dt_ms = wire_number(line, "dt_ms"),
        .LA = wire_bool(line, "in.LA"), .A = wire_bool(line, "in.A"), .B = wire_bool(line, "in.B"),
        .C = wire_bool(line, "in.C"), .D = wire_bool(line, "in.D"), .STR = wire_bool(line, "in.STR"),
        .MW03 = wire_word(line, "in.MW03"), .MW07 = wire_word(line, "in.MW07"),
    };
    wire_object(line, "in");
    if (!is_reset) {
        wire_refuse(line, "op", "scan before reset");
    }
    if (!wire_all_taken(line)) {
        return;
    }
    fplc_scan(&in, &memory, &out); /* <-- one scan */
    printf("{\"out\":{\"MW01\":\"%04X\",\"MW05\":\"%04X\",\"MSO_0\":%s,\"MSO_1\":%s,\"MSO_2\":%s,\"MSO_3\":%s,"
           "\"MSO_4\":%s,\"ERROR\":%s}}\n",
           (unsigned)out.MW01, (unsigned)out.MW05, truth(out.MSO[0]), truth(out.MSO[1]), truth(out.MSO[2]),
           truth(out.MSO[3]), truth(out.MSO[4]), truth(out.ERROR));
}

int main(void)
{
    static wire_line line;
    bool leaving = false;
    while (!leaving && wire_read(&line)) {
        if (wire_is(&line, "op", "scan")) {
            scan(&line);
        } else if (wire_is(&line, "op", "reset")) {
            reset(&line);
        } else if (wire_is(&line, "op", "hello")) {
            if (wire_number(&line, "protocol") != 1 || !wire_is(&line, "target", "fplc")) { /* <-- */
                wire_refuse(&line, "hello", "protocol 1 and target fplc only");
            }
            if (wire_all_taken(&line)) {
                puts("{\"ok\":true,\"name\":\"" FPLC_NAME "\",\"version\":\"1\",\"time\":\"virtual\"," /* <-- */
                     "\"relations\":[\"" FPLC_RELATION "\"],\"max_latency_scans\":" FPLC_LATENCY ",\"unobserved\":[]}");
            }
        } else if (wire_is(&line, "op", "bye")) {
            leaving = wire_all_taken(&line);
            if (leaving) {
                puts("{\"ok\":true}");
            }
        } else {
            wire_refuse(&line, "op", "hello, reset, scan or bye expected");
        }
        if (!wire_good(&line)) {
            wire_answer_error(&line);
        }
        fflush(stdout);
    }
    return 0;
}
