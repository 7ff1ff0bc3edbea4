/*
 * primitives.h: what the primitives of the library are: points of their surface, and what is
 * inside.
 */
#ifndef ORACLE_PRIMITIVES_H
#define ORACLE_PRIMITIVES_H

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"
#include "tests/oracle/solids.h"

enum { ARGUMENTS = 12, SOLIDS = 28, FIGURES = 15 };

/* A primitive with its arguments chosen, and whatever defines it. */
typedef struct Solid {
    double a[ARGUMENTS];
    Hull   hull;
    Sweep  sweep;
    Figure figure;
} Solid;

/* One row per primitive: `text` has $a..$l for the arguments, which are drawn from the ranges. */
typedef struct Primitive {
    const char *name, *text;
    void (*make)(Solid *solid);
    Inside *inside;
    void (*surface)(const Solid *solid, Cloud *cloud, double step);
    bool   exact;
    double range[ARGUMENTS][2];
} Primitive;

extern const Primitive solid_primitives[SOLIDS];

/* Plane figures, extruded or revolved. */
extern const Primitive figure_primitives[FIGURES];

/* From where to where arguments are drawn: sizes, and places. */
#define SIZE     \
    {            \
        0.3, 1.5 \
    }
#define PLACE     \
    {             \
        -0.9, 0.9 \
    }

#endif
