/*
 * svg_reader.c: notes about a drawing, and attributes of its elements.
 */
#include "compiler/outline/svg_reader.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/outline/svg_shapes.h"

/* ---- notes ---- */

void svg_note(SvgReader *reader, const char *what)
{
    SvgDrawing *drawing = reader->drawing;
    for (size_t i = 0; i < drawing->notes.count; i++)
        if (strcmp(drawing->notes.items[i].what, what) == 0)
            return;
    SvgNote left = {what, reader->line};
    array_push(drawing->arena, &drawing->notes, left);
}

void svg_stop(SvgReader *reader, const char *fault)
{
    if (reader->fault)
        return;
    reader->fault      = fault;
    reader->fault_line = reader->line;
}

/* ---- attributes ---- */

const char *svg_given(const SvgReader *reader, const SvgElement *element, const char *name)
{
    const char *value = svg_property(&reader->tree, element, name);
    return value && strcmp(value, "inherit") == 0 ? NULL : value;
}

/* Returns a length in units of the drawing, of which the view has `whole`; what is measured in
   others is not known here. */
static double length_in(SvgReader *reader, const char *text, double whole, double otherwise)
{
    double number;
    if (!text || !svg_number(&text, &number))
        return otherwise;
    if (*text == '%' && whole > 0)
        return number / 100 * whole;
    if (*text && strncmp(text, "px", 2) != 0 && !svg_is_blank(*text))
        svg_note(reader, "units other than px, which count as px");
    return number;
}

double svg_view_size(const SvgReader *reader, int axis)
{
    return reader->drawing->high[axis] - reader->drawing->low[axis];
}

double svg_length(SvgReader *reader, const SvgElement *element, const char *name, int axis,
                  double otherwise)
{
    double whole = axis < 2
                       ? svg_view_size(reader, axis)
                       : real_hypot(svg_view_size(reader, 0), svg_view_size(reader, 1)) / sqrt(2);
    return length_in(reader, svg_property(&reader->tree, element, name), whole, otherwise);
}

const char *svg_link(const SvgElement *element)
{
    const char *link = svg_attribute(element, "href");
    return link ? link : svg_attribute(element, "xlink:href");
}
