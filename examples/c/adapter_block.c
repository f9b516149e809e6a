/* Adapter protocol 1 for any function block over standard input and output: one line in, one line out.
 * It knows no block; what it serves, block.h describes. */
#include "block.h"
#include "wire.h"

#include <stdio.h>
#include <string.h>

static bool is_reset;

/* The name of a field inside an object of the line. */
static const char *inside(const char *object, const char *name)
{
    static char text[64];
    snprintf(text, sizeof text, "%s.%s", object, name);
    return text;
}

static void take(wire_line *line, const char *name, const block_row *row)
{
    if (row->flag != NULL) {
        *row->flag = wire_bool(line, name);
    } else if (row->word != NULL) {
        *row->word = wire_word(line, name);
    } else if (row->number != NULL) {
        *row->number = wire_number(line, name);
    } else if (row->signed_number != NULL) {
        *row->signed_number = wire_signed(line, name);
    } else {
        for (uint8_t n = 0; n < BLOCK_CHOICES && row->values[n] != NULL; n++) {
            if (wire_is(line, name, row->values[n])) {
                *row->choice = n;
                return;
            }
        }
        wire_refuse(line, name, "missing, or an unknown value");
    }
}

static void reset(wire_line *line)
{
    wire_object(line, "params");
    served.defaults();
    for (const block_row *row = served.parameters; row->name != NULL; row++) {
        const char *name = inside("params", row->name);
        if (wire_has(line, name)) {
            take(line, name, row);
        }
    }
    if (!wire_all_taken(line)) {
        return;
    }
    const char *wrong = served.power_up();
    if (wrong != NULL) {
        wire_refuse(line, wrong, "out of range, or does not go with another parameter");
        return;
    }
    is_reset = true;
    puts("{\"ok\":true}");
}

static void answer(void)
{
    const char *before = "{\"out\":{";
    for (const block_row *row = served.outputs; row->name != NULL; row++) {
        printf("%s\"%s\":", before, row->name);
        before = ",";
        if (row->flag != NULL) {
            printf(*row->flag ? "true" : "false");
        } else if (row->word != NULL) {
            printf("\"%04X\"", (unsigned)*row->word);
        } else if (row->number != NULL) {
            printf("%lu", (unsigned long)*row->number);
        } else if (row->signed_number != NULL) {
            printf("%ld", (long)*row->signed_number);
        } else {
            printf("\"%s\"", row->values[*row->choice]);
        }
    }
    puts("}}");
}

static void scan(wire_line *line)
{
    *served.dt_ms = wire_number(line, "dt_ms");
    for (const block_row *row = served.inputs; row->name != NULL; row++) {
        take(line, inside("in", row->name), row);
    }
    wire_object(line, "in");
    if (!is_reset) {
        wire_refuse(line, "op", "scan before reset");
    }
    if (wire_all_taken(line)) {
        served.call();
        answer();
    }
}

static void hello(wire_line *line)
{
    if (wire_number(line, "protocol") != 1 || !wire_is(line, "target", served.target)) {
        wire_refuse(line, "hello: protocol 1 only, target", served.target);
    }
    if (wire_all_taken(line)) {
        printf("{\"ok\":true,\"name\":\"%s.c\",\"version\":\"1\",\"time\":\"virtual\",\"relations\":[\"exact\"],"
               "\"max_latency_scans\":0,\"unobserved\":[]}\n", served.target);
    }
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
            hello(&line);
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
