/*
 * page.h: what the core asks of its page (page.js).  What comes in memory is for free().
 */
#ifndef KRS_PAGE_H
#define KRS_PAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "compiler/outline/letters.h"

/* These return the bytes of a file, or of a font (KrsLoadCallback, KrsFontCallback); NULL: there is
   none. */
char *page_load(const char *path, size_t *length);
char *page_font(const char *name, size_t *length, int *face);
/* Returns what letters_of returns (web/letters/letters.h), by the module that has it. */
double *page_letters(const unsigned char *font, size_t length, int face, const char *text,
                     const Lettering *lettering, size_t *count);
/* Takes which part of a mesh is done; false: it is not wanted any more. */
bool page_progress(double done);

/* core.c: page_load, with text that is freed when the next is asked for. */
const char *supply_text(void *user, const char *path, size_t *length);

#endif
