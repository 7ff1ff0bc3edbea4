/*
 * points.h: queries in many points at once, by lane tapes (graph/lanes/lanes.h) and on all processors.
 *
 * Answers are equal to those point by point, bit for bit.
 */
#ifndef KRS_POINTS_H
#define KRS_POINTS_H

#include "compiler/scene/program.h"

/* The number of points from which lanes cost less. */
enum { FEWEST_POINTS = 4 };

/* Makes the lane tapes of a state that is up to date when the first questions come; false: memory
   has run out.  A scene without components has none. */
bool state_lanes(KrsState *state);
void state_lanes_free(KrsState *state);
/* Takes the changed values of the state. */
void state_lanes_refresh(KrsState *state);

/* Finds the least distances of all components, cut by the zones; `bound`: only bounds for it. */
KrsStatus points_distances(KrsState *state, const double (*points)[3], size_t count, bool bound,
                           double *distances);
/* Finds the normals by central differences. */
KrsStatus points_normals(KrsState *state, const double (*points)[3], size_t count,
                         double (*normals)[3]);

/* Finds what is known of up to LANES points on a surface: distances, numbers of the nearest
   components from 1, and roots of surfaces, which points_surface puts into state->values for one of
   the points. */
void points_look(KrsState *state, const double (*points)[3], const double (*normals)[3],
                 size_t count, double *distances, uint32_t *nearest);
void points_surface(KrsState *state, size_t point, uint32_t nearest);

#endif
