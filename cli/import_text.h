/*
 * import_text.h: a file of another program, and the text of the scene that it becomes.
 */
#ifndef KRS_IMPORT_TEXT_H
#define KRS_IMPORT_TEXT_H

#include <stdbool.h>

#include "compiler/base/text.h"

typedef struct Import {
    const char *path;  /* of the file, for words about it */
    const char *name;  /* the same without folders, for a comment in the scene */
    const char *bytes; /* all of it, without a NUL but for the one behind it */
    size_t      length;
    const char *output; /* the file of the scene; NULL: standard output */
    Arena      *arena;
    Text        scene; /* what came of it */
} Import;

/* "krs: path:line: " and the words; returns false. */
bool import_refuse(const Import *import, unsigned line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* A number as the language writes it; NaN and infinities have no such form. */
void import_add_number(Text *text, double number);
void import_add_vector(Text *text, const double *numbers, int count);

#endif
