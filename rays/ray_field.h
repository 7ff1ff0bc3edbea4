/*
 * ray_field.h: distances of a state of a scene for rays.
 */
#ifndef KRS_RAYS_RAY_FIELD_H
#define KRS_RAYS_RAY_FIELD_H

#include "compiler/base/parallel.h"
#include "compiler/graph/lanes/lane_cells.h"
#include "compiler/scene/program.h"
#include "rays/lanes.h"
#include "rays/space.h"

/* The depths of cells: a tile, its quarters, and so on.  Rays are marched within cells of the last. */
enum { LEAF_DEPTH = 3 };

/* A number that rays ask for, and what each part of run_in_parallel needs for that. */
typedef struct RayTape {
    LaneTape  lanes;
    CellTape  cells;
    CellWork *works[MAX_PARTS];
} RayTape;

struct RayField {
    Memory        memory;
    Arena         arena;
    KrsState     *state;
    const RaySet *set;
    RayTape       distance; /* of all components but planes, if these are met at once */
    bool          planes;   /* they are: */
    RayTape       plane_t, plane_distance;
    float         low[3], high[3]; /* around what the distance is of */
    Space         space;           /* of rays of hits */
    Space         starts;          /* of balls that rays of pixels begin with */
    struct Wave  *waves[MAX_PARTS];
    float         margin; /* what rounding may make of coordinates */
};

/* Copies values of the frame for those who change them: tapes that read tables do. */
NodeValue *ray_copy_values(const KrsState *state, Arena *arena);
/* Returns what rounding may make of coordinates of what a scene shows, planes left out. */
float ray_margin(const KrsProgram *program);
/* Makes the least distance of the components that are planes, or of all others, for cells down to
   this depth. */
void ray_field_make_distance(RayField *field, bool planes, RayTape *tape, uint32_t depth);
/* Makes the tape of the length to the nearest plane along a ray. */
void ray_field_make_plane_t(RayField *field, RayTape *tape);

#endif
