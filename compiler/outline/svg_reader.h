/*
 * svg_reader.h: a drawing that is read: what is left out of it, and attributes of its elements.
 */
#ifndef KRS_SVG_READER_H
#define KRS_SVG_READER_H

#include "compiler/outline/svg.h"
#include "compiler/outline/svg_tree.h"

typedef struct SvgReader {
    SvgDrawing *drawing;
    SvgTree     tree;
    unsigned    line; /* of the element at hand */
    const char *fault;
    unsigned    fault_line;
    unsigned    entered; /* elements so far */
} SvgReader;

/* Notes once for each kind what is left out. */
void svg_note(SvgReader *reader, const char *what);
/* Ends the reading by a fault of the element at hand. */
void svg_stop(SvgReader *reader, const char *fault);

/* Returns a property of an element; NULL: it has none of its own. */
const char *svg_given(const SvgReader *reader, const SvgElement *element, const char *name);
/* Returns a length; `axis`: 0 and 1 along the view's width and height, 2 neither. */
double svg_length(SvgReader *reader, const SvgElement *element, const char *name, int axis,
                  double otherwise);
double svg_view_size(const SvgReader *reader, int axis);
/* Returns the reference of an element to another one, or NULL. */
const char *svg_link(const SvgElement *element);

#endif
