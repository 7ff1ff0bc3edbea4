/*
 * visible.h: characters that a terminal may get.
 *
 * Names of files and sources may have any bytes.  Control characters, characters that reverse the direction of
 * writing or hide, and bytes that are none, are replaced by visible ones.
 */
#ifndef KRS_VISIBLE_H
#define KRS_VISIBLE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The text that stands for a character. */
typedef struct Visible {
    char     text[4];
    size_t   length;
    uint32_t columns; /* of a terminal */
    size_t   used;    /* bytes that it stands for */
} Visible;

/* Finds how the first of `length` bytes is shown, of which there is one at least. */
Visible visible_next(const char *bytes, size_t length);
/* Writes a text so. */
void visible_print(FILE *out, const char *text);

#endif
