/*
 * deformed.h: random chains of twists, bends and tapers, and what they mean for points.
 *
 * A twist, a bend and a taper are closed formulas that move points, written here once forwards and
 * once backwards.  Backwards they answer "is this point inside?" for the judge; forwards they move
 * clouds of points of the surface.
 */
#ifndef ORACLE_DEFORMED_H
#define ORACLE_DEFORMED_H

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

static const double PI = 3.14159265358979323846;

typedef struct Solid {
    enum { SOLID_BOX, SOLID_BALL, SOLID_ROD } kind;
    Vec centre, half; /* the half size on each axis; the rod is round about y */
} Solid;

bool  solid_contains(const Solid *solid, Vec p);
Solid solid_random(Random *random);
void  solid_write(SceneText *text, const Solid *solid);

typedef struct Deed {
    enum { DEED_TWIST, DEED_BEND, DEED_TAPER } kind;
    Vec    axis; /* of unit length; of a taper x, y or z */
    double rate;
    double from, to;  /* factors at the ends of the taper */
    double low, high; /* where they are on the axis */
} Deed;

/* What stands upright for an axis of a bend, and the direction to which it bends. */
void   bend_frame(Vec axis, Vec *along, Vec *lateral);
double taper_factor(const Deed *deed, double height);
Vec    deed_forward(const Deed *deed, Vec p);
/* Returns where a point was before; `turn` counts turns about the axis of a bend. */
Vec deed_backward(const Deed *deed, Vec p, int turn);

enum { MAX_DEEDS = 3, MAX_MIRRORS = 4 };

/* A solid, deformed, mirrored, and deformed again. */
typedef struct Deformed {
    Solid solid;
    Deed  deeds[MAX_DEEDS];
    int   deed_count;
    Half  mirrors[MAX_MIRRORS]; /* after the first `before` deeds */
    int   mirror_count, before;
} Deformed;

/* Tells whether a point is inside; `chain` is a Deformed. */
bool deformed_contains(const void *chain, Vec p);
/* Only of the first is it known how far what it deforms reaches: others do not bend so much that
   they could meet the axis, and do not taper. */
Deed     deed_random(Random *random, const Solid *solid, bool first);
void     deed_write(SceneText *text, const Deed *deed, const char *rate);
void     deformed_write(SceneText *text, const Deformed *chain, const char *rate);
Deformed deformed_random(Random *random, int deeds, int mirrors);
Trial    deformed_trial(const Product *product, const Deformed *chain, uint64_t seed);

#endif
