/* See wire.h. One pass over the line, no allocation; a name or text with an escape is refused. */
#include "wire.h"

#include <stdio.h>
#include <string.h>

typedef struct {
    const char *at, *end;
} cursor;

static char buffer[WIRE_LINE];

/* ------------------------------------------------------------------ refusing */

/* What came from outside is printed without quotes, backslashes and control characters. */
static void append(char *text, size_t size, const char *more, size_t length)
{
    size_t n = strlen(text);
    for (size_t i = 0; i < length && n + 1 < size; i++) {
        const char c = more[i];
        text[n++] = c < ' ' || c > '~' || c == '"' || c == '\\' ? '?' : c;
    }
    text[n] = '\0';
}

void wire_refuse(wire_line *line, const char *name, const char *why)
{
    if (line->error[0] == '\0') {
        append(line->error, sizeof line->error, name, strlen(name));
        append(line->error, sizeof line->error, ": ", 2);
        append(line->error, sizeof line->error, why, strlen(why));
    }
}

bool wire_good(const wire_line *line)
{
    return line->error[0] == '\0';
}

void wire_answer_error(const wire_line *line)
{
    printf("{\"error\":\"%s\"}\n", line->error);
}

/* ------------------------------------------------------------------ taking a line apart */

static void skip_blanks(cursor *c)
{
    while (c->at < c->end && (*c->at == ' ' || *c->at == '\t' || *c->at == '\r' || *c->at == '\n')) {
        c->at++;
    }
}

static bool eat(cursor *c, char wanted)
{
    skip_blanks(c);
    if (c->at < c->end && *c->at == wanted) {
        c->at++;
        return true;
    }
    return false;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Moves over a string without escapes, its quotes included. */
static bool skip_text(cursor *c)
{
    if (!eat(c, '"')) {
        return false;
    }
    while (c->at < c->end && *c->at != '"' && *c->at != '\\' && (unsigned char)*c->at >= ' ') {
        c->at++;
    }
    return eat(c, '"');
}

static bool skip_integer(cursor *c)
{
    skip_blanks(c);
    if (c->at < c->end && *c->at == '-') {
        c->at++;
    }
    const char *first = c->at;
    while (c->at < c->end && is_digit(*c->at)) {
        c->at++;
    }
    return c->at > first && (*first != '0' || c->at == first + 1);
}

static bool skip_constant(cursor *c)
{
    static const char *const known[] = {"true", "false", "null"};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const size_t length = strlen(known[i]);
        if ((size_t)(c->end - c->at) >= length && memcmp(c->at, known[i], length) == 0) {
            c->at += length;
            return true;
        }
    }
    return false;
}

static bool skip_integers(cursor *c) /* [1,2] */
{
    if (!eat(c, '[')) {
        return false;
    }
    if (eat(c, ']')) {
        return true;
    }
    do {
        if (!skip_integer(c)) {
            return false;
        }
    } while (eat(c, ','));
    return eat(c, ']');
}

static bool skip_value(cursor *c)
{
    skip_blanks(c);
    if (c->at == c->end) {
        return false;
    }
    switch (*c->at) {
    case '"':
        return skip_text(c);
    case '[':
        return skip_integers(c);
    case 't': case 'f': case 'n':
        return skip_constant(c);
    default:
        return skip_integer(c);
    }
}

static wire_field *find(const wire_line *line, const char *name)
{
    for (int i = 0; i < line->count; i++) {
        if (strcmp(line->field[i].name, name) == 0) {
            return (wire_field *)&line->field[i];
        }
    }
    return NULL;
}

static bool add(wire_line *line, const char *prefix, const char *name, size_t length, const char *value, size_t size)
{
    wire_field *one = &line->field[line->count];
    if (line->count == WIRE_FIELDS || strlen(prefix) + length >= sizeof one->name || memchr(name, '.', length) != NULL) {
        wire_refuse(line, "line", "too many fields, or a name that is too long or has a dot");
        return false;
    }
    one->name[0] = '\0';
    append(one->name, sizeof one->name, prefix, strlen(prefix));
    append(one->name, sizeof one->name, name, length);
    one->value = value;
    one->length = size;
    one->taken = false;
    if (find(line, one->name) != NULL) {
        wire_refuse(line, one->name, "named twice");
        return false;
    }
    line->count++;
    return true;
}

/* An object at the cursor; inside the line's own object each field may be one more, with `prefix` before its names. */
static bool take_object(wire_line *line, cursor *c, const char *prefix)
{
    if (!eat(c, '{')) {
        return false;
    }
    if (eat(c, '}')) {
        return true;
    }
    do {
        skip_blanks(c);
        const char *name = c->at + 1;
        if (!skip_text(c)) {
            return false;
        }
        const size_t length = (size_t)(c->at - 1 - name);
        if (!eat(c, ':')) {
            return false;
        }
        skip_blanks(c);
        const char *value = c->at;
        if (prefix[0] == '\0' && value < c->end && *value == '{') {
            char inner[sizeof line->field[0].name] = "";
            append(inner, sizeof inner - 1, name, length);
            append(inner, sizeof inner, ".", 1);
            if (!add(line, "", name, length, value, 1) || !take_object(line, c, inner)) {
                return false;
            }
        } else if (!skip_value(c) || !add(line, prefix, name, length, value, (size_t)(c->at - value))) {
            return false;
        }
    } while (eat(c, ','));
    return eat(c, '}');
}

bool wire_read(wire_line *line)
{
    size_t length = 0;
    int c;
    line->count = 0;
    line->error[0] = '\0';
    while ((c = getchar()) != EOF && c != '\n') {
        if (length < sizeof buffer) {
            buffer[length] = (char)c;
        }
        length++;
    }
    if (c == EOF && length == 0) {
        return false;
    }
    if (length > sizeof buffer) {
        wire_refuse(line, "line", "too long");
        return true;
    }
    cursor at = {buffer, buffer + length};
    const bool taken = take_object(line, &at, "");
    skip_blanks(&at);
    if (!taken || at.at != at.end) {
        wire_refuse(line, "line", "not a JSON object of the protocol");
    }
    return true;
}

/* ------------------------------------------------------------------ taking fields */

static const wire_field *take(wire_line *line, const char *name)
{
    wire_field *one = find(line, name);
    if (one == NULL) {
        wire_refuse(line, name, "missing");
    } else {
        one->taken = true;
    }
    return one;
}

bool wire_has(const wire_line *line, const char *name)
{
    return find(line, name) != NULL;
}

bool wire_all_taken(wire_line *line)
{
    for (int i = 0; i < line->count; i++) {
        const wire_field *one = &line->field[i];
        if (!one->taken) {
            wire_refuse(line, one->name, "not expected here");
        }
    }
    return wire_good(line);
}

void wire_object(wire_line *line, const char *name)
{
    wire_field *one = find(line, name);
    if (one != NULL && *one->value == '{') {
        one->taken = true;
    }
}

static bool equals(const wire_field *one, const char *text)
{
    return one->length == strlen(text) && memcmp(one->value, text, one->length) == 0;
}

bool wire_bool(wire_line *line, const char *name)
{
    const wire_field *one = take(line, name);
    if (one == NULL) {
        return false;
    }
    if (!equals(one, "true") && !equals(one, "false")) {
        wire_refuse(line, name, "true or false expected");
    }
    return equals(one, "true");
}

uint16_t wire_word(wire_line *line, const char *name)
{
    static const char digits[] = "0123456789ABCDEF";
    const wire_field *one = take(line, name);
    uint16_t word = 0;
    if (one == NULL) {
        return 0;
    }
    if (one->length != 6 || one->value[0] != '"') {
        wire_refuse(line, name, "four upper-case hex digits expected");
        return 0;
    }
    for (size_t i = 1; i <= 4; i++) {
        const char *digit = memchr(digits, one->value[i], 16);
        if (digit == NULL) {
            wire_refuse(line, name, "four upper-case hex digits expected");
            return 0;
        }
        word = (uint16_t)(word << 4 | (digit - digits));
    }
    return word;
}

uint32_t wire_number(wire_line *line, const char *name)
{
    const wire_field *one = take(line, name);
    uint64_t number = 0;
    if (one == NULL) {
        return 0;
    }
    for (size_t i = 0; i < one->length; i++) {
        if (!is_digit(one->value[i]) || number > UINT32_MAX) {
            number = (uint64_t)UINT32_MAX + 1;
            break;
        }
        number = number * 10 + (uint64_t)(one->value[i] - '0');
    }
    if (number > UINT32_MAX) {
        wire_refuse(line, name, "an integer 0..4294967295 expected");
        return 0;
    }
    return (uint32_t)number;
}

int32_t wire_signed(wire_line *line, const char *name)
{
    const wire_field *one = take(line, name);
    int64_t number = 0;
    if (one == NULL) {
        return 0;
    }
    const bool negative = one->length > 1 && one->value[0] == '-';
    for (size_t i = negative ? 1 : 0; i < one->length; i++) {
        if (!is_digit(one->value[i]) || number > INT32_MAX) {
            number = (int64_t)INT32_MAX + 2;
            break;
        }
        number = number * 10 + (one->value[i] - '0');
    }
    if (number > (int64_t)INT32_MAX + (negative ? 1 : 0)) {
        wire_refuse(line, name, "an integer -2147483648..2147483647 expected");
        return 0;
    }
    return (int32_t)(negative ? -number : number);
}

uint8_t wire_modes(wire_line *line, const char *name)
{
    const wire_field *one = take(line, name);
    unsigned modes = 0;
    bool good = one != NULL && one->length >= 2 && one->value[0] == '[';
    for (size_t i = 1; good && i + 1 < one->length; i++) {
        const char c = one->value[i];
        if (is_digit(c)) { /* a single digit, and above the modes before it */
            good = c <= '4' && !is_digit(one->value[i - 1]) && one->value[i - 1] != '-' && modes >> (c - '0') == 0;
            modes |= good ? 1u << (c - '0') : 0;
        } else {
            good = c != '-';
        }
    }
    if (one != NULL && !good) {
        wire_refuse(line, name, "an ascending list of modes 0..4 expected");
    }
    return (uint8_t)modes;
}

bool wire_is(wire_line *line, const char *name, const char *text)
{
    wire_field *one = find(line, name);
    const size_t length = strlen(text);
    if (one == NULL || one->length != length + 2 || one->value[0] != '"' || memcmp(one->value + 1, text, length) != 0) {
        return false;
    }
    one->taken = true;
    return true;
}
