/*
 * truetype.h: outlines of glyphs in the file of a font, which is read here without FreeType.
 */
#ifndef KRS_TEST_TRUETYPE_H
#define KRS_TEST_TRUETYPE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { MAX_GLYPH_POINTS = 1000 };

/* Points that are not on the curve are control points; halfway between two of these is a point of the curve. */
typedef struct Glyph {
    double x[MAX_GLYPH_POINTS], y[MAX_GLYPH_POINTS]; /* in ems */
    bool   on[MAX_GLYPH_POINTS];
    size_t ends[MAX_GLYPH_POINTS], contours, points;
} Glyph;

/* Opens the font of the functions below; false: it cannot be read. */
bool truetype_open(const char *path);

/* Returns the glyph of a character, by a map of format 4; 0: none. */
unsigned truetype_glyph(unsigned character);

/* Returns false if it has parts, or nothing. */
bool truetype_read(unsigned number, Glyph *glyph);

#ifdef __cplusplus
}
#endif

#endif
