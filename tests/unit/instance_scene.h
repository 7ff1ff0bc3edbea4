/*
 * instance_scene.h: functions of instance groups of spheres with random numbers, and the same as plain loops.
 */
#ifndef UNIT_INSTANCE_SCENE_H
#define UNIT_INSTANCE_SCENE_H

#include "compiler/graph/instance_table.h"
#include "tests/support/bench.h"

/* Columns of a table of spheres: centre, radius, shade. */
enum { SPHERES = 50, COLUMNS = 5, RADIUS = 3, SHADE = 4, PLACES = 12 };

/* The radius is multiplied by the parameter, the time, which is: */
static const double TIME = 1.25;
/* The width of the smooth minimum. */
static const double WIDTH = 0.4;

/* The distance of spheres, the same of a smooth minimum, of copies of spheres at other places; the
   shade of the nearest sphere; a vector of the normal and the footprint as well. */
enum { SHARP, SMOOTH, NESTED, SHADED, LEAN, KINDS };

/* The numbers are those of functions. */
typedef struct Many {
    Graph   *graph;
    Node     roots[KINDS];
    uint32_t sharp, smooth, nested, inner;
} Many;

Many make_many(Bench *b);

Box box_around(const double centre[3], double reach);

/* ---- Plain loops ---- */

const InstanceTable *table_of(const Graph *g, uint32_t function);
const double        *row_of(const InstanceTable *table, uint32_t i);
double               clearance_at(const InstanceTable *table, const double p[3]);
/* Over all instances, whether they are listed or not; by cells it is at most the clearance. */
double   all_spheres(const InstanceTable *table, const double p[3], bool smooth, bool by_cells);
uint32_t nearest_sphere(const InstanceTable *table, const double p[3]);
double   all_copies(const InstanceTable *outer, const InstanceTable *inner, const double p[3],
                    bool by_cells);
void lean_there(const InstanceTable *table, const double p[3], const double normal[3], double size,
                double lean[3]);

#endif
