/*
 * space.h: cells of space, for rays that go anywhere: an octree of cubes with tapes of their own.
 *
 * A cube is made when a ray first asks for a distance in it.  Each part of run_in_parallel has its own.
 */
#ifndef KRS_RAYS_SPACE_H
#define KRS_RAYS_SPACE_H

#include "compiler/graph/lanes/lane_cells.h"

/* A cube; its children follow each other. */
typedef struct SpaceCube {
    CellTape tape;
    uint32_t first_child; /* 0: none */
    bool     leaf;        /* it will have none */
    int32_t  rays;        /* the first of those that ask now, -1: none */
} SpaceCube;

typedef struct Space {
    float      low[3], side; /* of the outermost cube; side 0: there is none but all of space */
    float      margin;
    CellWork  *work;
    SpaceCube *cubes; /* the first: all of space; the second: the outermost cube */
    uint32_t   count, most;
    CellStep  *steps;  /* of all tapes, */
    CellCall  *calls;  /* and their calls */
    uint32_t  *listed; /* and the instances of these */
    size_t     step_count, most_steps, call_count, most_calls, listed_count, most_listed;
    bool       full; /* a cube was not divided, since there was no room */
} Space;

/* Around what lies in the box. */
void space_new(Space *space, const CellTape *tape, CellWork *work, const float low[3],
               const float high[3], float margin, Arena *arena);
/* Makes room where there was none for a cube: those before are made again where rays go. */
void space_clear_full(Space *space);
/* The cube whose tape is right at a point. */
uint32_t space_find(Space *space, const float point[3]);

#endif
