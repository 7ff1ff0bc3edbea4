/*
 * svg_paint.h: colours, paints and strokes of elements.
 */
#ifndef KRS_SVG_PAINT_H
#define KRS_SVG_PAINT_H

#include "compiler/outline/svg_reader.h"
#include "compiler/outline/svg_stroke.h"

/* The paint of a fill or stroke.  Its colour is sRGB, 0xrrggbb. */
typedef struct SvgPaint {
    bool     drawn;
    uint32_t rgb;
} SvgPaint;

/* Reads a colour; false: it is unknown. */
bool svg_color(const char *text, uint32_t *rgb);
/* Reads a fill or stroke, which stays what it is if the element does not say; `current` is `currentColor`. */
void svg_read_paint(SvgReader *reader, const SvgElement *element, const char *name,
                    uint32_t current, SvgPaint *paint);
/* Reads what an element says of its stroke. */
void svg_read_stroke(SvgReader *reader, const SvgElement *element, SvgStroke *stroke);
/* Tells whether a property is a share of nothing: nothing in between is known of areas. */
bool svg_is_clear(SvgReader *reader, const SvgElement *element, const char *name);

#endif
