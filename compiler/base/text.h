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

/* The shortest decimal that reads back as the same double ("0.1", "1e+30", "inf"). */
void text_number(Text *text, double number);

/* A JSON string with its quotes; bytes that are not UTF-8 become U+FFFD. */
void text_json(Text *text, const char *string);

/* Decodes the UTF-8 character at `bytes`, of which `length` (at least 1) may be read, and returns
   how many bytes it has; 0, and U+FFFD, when they are not UTF-8. */
size_t text_character(const char *bytes, size_t length, uint32_t *character);

/* Every spelling of a name is kept once, so equal names are equal pointers. */
typedef struct Names {
    Arena       *arena;
    const char **slots;
    size_t       count, capacity;
} Names;

const char *name_intern(Names *names, const char *bytes, size_t length);

/* The candidate that a misspelt word most likely means, or NULL: restricted Damerau-Levenshtein
   distance (a swap counts once), at most 1 edit for words under 3 letters, else 2, and never as
   many as there are letters; nearest first, ties to the earlier candidate. */
const char *nearest_name(const char *word, const char *const *candidates, size_t count);

#endif
