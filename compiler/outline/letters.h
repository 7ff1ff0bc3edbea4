/*
 * letters.h: texts as contours: FreeType and HarfBuzz, for the rest of the compiler.
 *
 * HarfBuzz says which glyphs a text has and where they stand, with kerning and ligatures.  FreeType
 * reads their contours.
 */
#ifndef KRS_LETTERS_H
#define KRS_LETTERS_H

#include <stdint.h>

#include "compiler/base/text.h"
#include "compiler/outline/path.h"

/* A font as a file has it. */
typedef struct Font {
    const unsigned char *bytes;
    size_t               length;
    int                  face;
} Font;

typedef enum LineAlign { ALIGN_LEFT, ALIGN_CENTER, ALIGN_RIGHT } LineAlign;

typedef struct Lettering {
    double    size;        /* of the em */
    double    line_height; /* from one line to the next, in ems; 0: the font's */
    double    spacing;     /* more between letters, in ems */
    LineAlign align;       /* of lines, at x = 0 */
} Lettering;

/* Draws lines of UTF-8, the first on y = 0, and returns false where this is no font with outlines.
   *missing is the first character that the font does not have, or 0. */
bool letters_draw(Path *path, const Font *font, const char *text, const Lettering *lettering,
                  uint32_t *missing);

#endif
