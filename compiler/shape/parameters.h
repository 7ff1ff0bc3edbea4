/*
 * parameters.h: numbers of a scene that change from state to state: what its author may set, and
 * slopes that follow from that.
 */
#ifndef KRS_PARAMETERS_H
#define KRS_PARAMETERS_H

#include <string.h>

#include "compiler/base/source.h"
#include "compiler/graph/graph.h"
#include "compiler/shape/box.h"

/* A `param`: its slot in the parameter block and its range. */
typedef struct Parameter {
    const char *name;
    uint32_t    slot, components;
    double      value[4], low[4], high[4];
    bool        degrees; /* its default or range is written so */
    bool        color;   /* its default is written so */
    bool        whole;   /* its range is written as one of whole numbers, `0..2` */
    const char *doc;     /* lines of its `///` comment, or NULL */
    Span        name_span, default_span;
} Parameter;

typedef struct Parameters {
    Parameter *items;
    size_t     count, capacity;
} Parameters;

/* Sets the values of the parameter block, by slots, that are those of the parameters' defaults. */
static inline void parameter_defaults(const Parameters *parameters, NodeValue *values)
{
    for (size_t i = 0; i < parameters->count; i++)
        memcpy(values[parameters->items[i].slot].v, parameters->items[i].value,
               sizeof parameters->items[i].value);
}

/* The slope of an expression that no constant bounds, as parameters in it have no limits: it is
   found for the values of each state (slope.c), and stands in a slot of the parameter block. */
typedef struct StateSlope {
    uint32_t slot;
    Node     formula;
    Box      region; /* over which it is found; infinite: all space */
    Span     span;   /* of the formula */
} StateSlope;

typedef struct StateSlopes {
    StateSlope *items;
    size_t      count, capacity;
} StateSlopes;

/* The host finds each anew whenever anything changes. */
enum { MAX_FRAME_SLOPES = 256 };

#endif
