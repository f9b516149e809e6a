/* Reads one line of adapter protocol 1: a JSON object whose values are true, false, integers, words, texts, lists of
 * modes, or one more object (its fields are named "in.LA" and so on). All else is refused: what is not JSON, a field
 * twice, a field that is missing or of another type, a field that nobody took. Standard library only. */
#ifndef WIRE_H
#define WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WIRE_FIELDS = 32, WIRE_LINE = 4096 }; /* more is refused */

typedef struct {
    char name[40];
    const char *value; /* in the line, as it stands there */
    size_t length;
    bool taken;
} wire_field;

typedef struct {
    wire_field field[WIRE_FIELDS];
    int count;
    char error[120]; /* empty while the line is good; the first fault stays */
} wire_line;

/* Reads a line from standard input and takes it apart. False at the end of the input. */
bool wire_read(wire_line *line);

bool wire_has(const wire_line *line, const char *name);
bool wire_good(const wire_line *line);
/* The line is good, and every field was taken. */
bool wire_all_taken(wire_line *line);
void wire_refuse(wire_line *line, const char *name, const char *why);

/* Each takes one field; where it is missing or of another type the line is refused and false, 0 comes back. */
bool wire_bool(wire_line *line, const char *name);
uint16_t wire_word(wire_line *line, const char *name);   /* four upper-case hex digits */
uint32_t wire_number(wire_line *line, const char *name); /* 0..4294967295 */
int32_t wire_signed(wire_line *line, const char *name);  /* -2147483648..2147483647 */
uint8_t wire_modes(wire_line *line, const char *name);   /* ascending list of 0..4, as bits */

/* The field is there and has this text; then it is taken. Nothing is refused. */
bool wire_is(wire_line *line, const char *name, const char *text);

/* The field may be there as an object, which may be empty. */
void wire_object(wire_line *line, const char *name);

/* {"error":".."} for a line that was refused. */
void wire_answer_error(const wire_line *line);

#endif
