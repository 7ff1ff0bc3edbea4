/*
 * text.h: text that is built piece by piece, and names that are compared by address.
 */
#ifndef KRS_TEXT_H
#define KRS_TEXT_H

#include <stdarg.h>
#include <stdint.h>

#include "compiler/base/arena.h"

/* A growing string in an arena; `bytes` is NUL-terminated after the first addition. */
typedef struct Text {
    Arena *arena;
    char  *bytes;
    size_t length, capacity;
} Text;

void text_add(Text *text, const char *string);
void text_add_bytes(Text *text, const char *bytes, size_t length);
void text_format(Text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_format_list(Text *text, const char *format, va_list arguments)
    __attribute__((format(printf, 2, 0)));

/* Adds the shortest decimal that reads back as the same double ("0.1", "1e+30", "inf"). */
void text_number(Text *text, double number);
/* Adds a number that printf has written, with a point in place of the locale's decimal separator. */
void text_printed_number(Text *text, const char *printed);

/* Returns the number that a decimal without a sign stands for: digits, perhaps a point and an
   exponent. */
double text_decimal(const char *bytes, size_t length);

/* Adds a JSON string with its quotes; bytes that are not UTF-8 become U+FFFD. */
void text_json(Text *text, const char *string);
/* Numbers in JSON; what is not finite becomes null. */
void text_json_number(Text *text, double number);
void text_json_vector(Text *text, const double *values, size_t count);

/* Decodes the UTF-8 character at `bytes` and returns how many bytes it has.  `length`, at least 1,
   is the number of bytes that may be read.  Returns 0, and U+FFFD, when they are not UTF-8. */
size_t text_character(const char *bytes, size_t length, uint32_t *character);

/* Tells whether a byte of UTF-8 is the first of a character. */
static inline bool text_begins_character(char byte) { return (byte & 0xC0) != 0x80; }

/* A hash table that stores each name once, so that equal names have equal addresses. */
typedef struct Names {
    Arena       *arena;
    const char **slots;
    size_t       count, capacity;
} Names;

const char *name_intern(Names *names, const char *bytes, size_t length);

/* Returns the candidate nearest to a misspelt word, or NULL.  The measure is the restricted
   Damerau-Levenshtein distance, in which a swap counts once.  Words of less than 4 letters may have
   1 edit, others 2, and never as many as letters; those of less than 5 keep the first or swap the
   first two.  Of equally near candidates the first is taken. */
const char *nearest_name(const char *word, const char *const *candidates, size_t count);

#endif
