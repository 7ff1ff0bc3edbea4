/*
 * instance_parts.h: random parts of CSG nodes, and CSG nodes of them lowered in two ways: as instance groups, and each part
 * for itself.
 */
#ifndef PROPERTY_INSTANCE_PARTS_H
#define PROPERTY_INSTANCE_PARTS_H

#include "compiler/family/family.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/instance_groups.h"
#include "compiler/lower/lower.h"
#include "tests/support/random.h"

enum { PARTS = 200, POINTS = 2000, LEAST = 16 };

extern Arena        arena, scratch;
extern ShapeBuilder builder;
extern double       now, height; /* the time, and a parameter from 0 to 1 */
extern Random       randomness;
static const Span   no_place = {0, 0, 0};

/* Before and after each test of cmocka. */
int start(void **state);
int finish(void **state);

/* ---- parts ---- */

double between(double low, double high);
/* Returns a ball of a radius; a disc of a radius about a circle around y. */
const Shape *ball(double radius);
const Shape *ring(double radius, double thick);
const Shape *placed(const Shape *shape, double x, double y, double z, double turn, double scale);
/* With random properties. */
const Shape  *painted(const Shape *shape);
const Shape **random_parts(uint32_t count, bool paint);

/* ---- what is compared ---- */

typedef struct Seen {
    Tape       tape;
    Node       roots[ROOT_COUNT];
    NodeValue *values;
} Seen;

Seen lower(const Shape *shape, LoweredGroups *instances);
/* Finds the frame's values of all nodes that there are now. */
void prepare(Seen *seen);
/* Returns the distance; other values are in values[roots[]]. */
double look(const Seen *seen, const double p[3]);
/* The distance is right within this radius by what is listed at a point, and by no more than that. */
double clearance_at(const double p[3]);

typedef struct Difference {
    double below, above; /* where instance groups are right; how much more they say than is right */
    double color;        /* there, too */
    uint32_t right, inside, other_surfaces;
} Difference;

/* In the frame that is now, at points in a cube. */
Difference compare_lowered(const Shape *shape, Seen apart, Seen group, double side);
/* Wherever they should be right, and they are that at enough points. */
void assert_right(Difference found);
void assert_same(const Shape *shape, double side);

#endif
