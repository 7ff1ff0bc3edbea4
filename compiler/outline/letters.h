/*
 * letters.h: texts as contours: FreeType, HarfBuzz and fontconfig, for the rest of the compiler.
 *
 * HarfBuzz says which glyphs a text has and where they stand, with kerning and ligatures.  FreeType
 * reads their contours.  fontconfig knows the fonts of the system.
 */
#ifndef KRS_LETTERS_H
#define KRS_LETTERS_H

#include <stdint.h>

#include "compiler/base/text.h"
#include "compiler/outline/path.h"

/* A font of the system.  `path` is malloc'ed. */
typedef struct FoundFont {
    char *path;
    int   face; /* of several in the file */
} FoundFont;

typedef enum FontSearch {
    FONT_FOUND,
    FONT_UNKNOWN, /* there are fonts, but none of this name */
    FONT_NONE,    /* there are no fonts at all */
    FONT_NO_MEMORY
} FontSearch;

/* The font that a name means, as fontconfig reads it: "DejaVu Serif", "DejaVu Sans:bold".  NULL: a
   usual one without serifs. */
FontSearch font_find(const char *name, FoundFont *found);

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

/* Draws lines of UTF-8, the first on y = 0.  False: this is no font.  *missing is the first
   character that the font does not have, or 0. */
bool letters_draw(Path *path, const Font *font, const char *text, const Lettering *lettering,
                  uint32_t *missing);

#endif
