/*
 * reach_instances.h: random kernel-reflection sequences, and all their instances copied one by one.
 */
#ifndef PROPERTY_REACH_INSTANCES_H
#define PROPERTY_REACH_INSTANCES_H

#include <stddef.h>

#include "compiler/base/vec.h"
#include "compiler/shape/reach.h"
#include "tests/support/random.h"

/* ---- points, boxes and balls, the plain way ---- */

extern const Ball no_ball;

bool   is_empty(Box box);
double diagonal(Box box);
double middle(Range side);
void   include(Box *box, const double p[3]);
bool   in_box(Box box, const double p[3]);
bool   in_ball(Ball ball, const double p[3]);
/* How far a point is in front of a mirror, where nothing is kept. */
double excess(const ReachStage *mirror, const double p[3]);
void   reflect(const ReachStage *mirror, double p[3]);

/* ---- every instance by itself ---- */

enum { CORNERS = 8, POINTS = 16, MAX_STAGES = 12, MAX_INSTANCES = 1 << (MAX_STAGES - 1) };

/* Points of the copy of a kernel's box: its corners, and others. */
typedef struct Instance {
    double points[POINTS][3];
} Instance;

/* All instances after some stages; `clipped`: only what the mirrors keep. */
typedef struct InstanceTable {
    bool     clipped;
    size_t   count;
    Instance items[MAX_INSTANCES];
} InstanceTable;

void grow_group(InstanceTable *group, const ReachStage *stage, const Instance *kernel);

/* ---- sequences at random ---- */

/* Returns a kernel's copy: the corners of its box, and points within. */
Instance random_instance(Random *random, Box box);
/* A mirror that mostly cuts, or passes near to, what is in `before`. */
void       random_mirror(Random *random, Box before, ReachStage *stage);
ReachStage random_stage(Random *random, const ReachStage *before);
/* Gives a stage bounds that follow from those of the stage before (NULL: nothing is there). */
void bound_loosely(ReachStage *stage, const ReachStage *before, bool cut);

/* Makes the bounds of a stage larger than they have to be. */
void loosen(Random *random, ReachStage *stage);

/* How far out a side may be, in diagonals of the exact box. */
#define LOOSE 0.02

#endif
