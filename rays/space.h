/*
 * space.h: cells of space, for rays that go anywhere: an octree of cubes with tapes of their own.
 *
 * A cube is made when a ray first asks for a distance in it, by the thread of that ray.  All threads and all pictures of
 * the same values share cubes.
 */
#ifndef KRS_RAYS_SPACE_H
#define KRS_RAYS_SPACE_H

#include <pthread.h>
#include <stdatomic.h>

#include "compiler/graph/lanes/lane_cells.h"

/* A cube; its children follow each other. */
typedef struct SpaceCube {
    CellTape    tape;
    atomic_uint first_child; /* 0: none yet */
    atomic_bool leaf, made;  /* it will have none; it has a tape */
} SpaceCube;

/* Threads that make one cube wait for each other, at one of so many gates. */
enum { SPACE_GATES = 64 };

typedef struct Space {
    float low[3], side; /* of the outermost cube; side 0: there is none but all of space */
    float stretch; /* the tape of a cube is right in a ball so many times as large as the cube */
    float margin;
    SpaceCube      *cubes; /* the first: all of space; the second: the outermost cube */
    uint32_t        count, most, deepest;
    uint32_t        cells;      /* of the deepest level, in a row */
    atomic_uint    *leaf_of;    /* each of these cells: its cube; 0: not known yet */
    size_t          short_tape; /* a cube with a shorter tape has no children */
    CellStep       *steps;      /* of all tapes, */
    CellCall       *calls;      /* and their calls */
    uint32_t       *listed;     /* and the instances of these */
    size_t          step_count, max_steps, call_count, max_calls, listed_count, max_listed;
    atomic_bool     full; /* a cube was not divided, since there was no room */
    pthread_mutex_t room, gates[SPACE_GATES];
} Space;

/* The rules by which an octree is made. */
typedef struct SpaceRule {
    float    stretch, margin;
    uint32_t deepest; /* level of cubes */
    size_t   short_tape, max_steps;
} SpaceRule;

/* Makes the space around what lies in the box. */
void space_new(Space *space, const CellTape *tape, const float low[3], const float high[3],
               const SpaceRule *rule, Arena *arena);
void space_free(Space *space);
/* Makes room where there was none for a cube: those before are made again where rays go.  No other thread asks. */
void space_clear_full(Space *space);
/* Returns the cube whose tape is right at a point; the rows of depth 0 are written. */
uint32_t space_find(Space *space, CellWork *work, const float point[3]);
/* Returns the smallest cube whose tape is right in a ball. */
uint32_t space_find_ball(Space *space, CellWork *work, const float middle[3], float radius);

#endif
