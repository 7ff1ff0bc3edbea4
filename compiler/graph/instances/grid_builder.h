/*
 * grid_builder.h: what the steps share by which a grid is built.
 */
#ifndef KRS_GRID_BUILDER_H
#define KRS_GRID_BUILDER_H

#include "compiler/graph/instances/grid_of_boxes.h"

#define FLOAT_MISSES 0x1p-21 /* several roundings in single precision, of coordinates */
#define ROUNDED_DOWN (1 - 0x1p-22)

typedef struct Builder {
    Grid       *grid;
    const Box  *boxes;
    uint32_t    count, present; /* boxes; those that are not empty */
    double      reach, margin;
    double      given_margin;
    uint32_t    texels;      /* of an entry */
    bool        coarse, few; /* it will be refined; with half the cells, since lists are long */
    GridLimits  most;        /* 0: as for all frames */
    double      pad[3];
    double      listed, seen; /* boxes up to this distance are in the list, or are measured */
    float      *nearest;      /* of each cell: the square of the distance to the nearest box that is
                                seen and not listed */
    GridMembers flat;         /* of a flat grid */
    double      half;         /* and half the diagonal of its cells, */
    float      *centers;   /* and of each cell the distance from its center to the nearest member */
    bool        measuring; /* these distances */
    Arena      *scratch;
} Builder;

/* Cells from first to last along each axis. */
typedef struct Cover {
    uint32_t first[3], last[3];
} Cover;

/* Cells [low, high) along an axis, of which one processor fills the lists. */
typedef struct Slab {
    int      axis; /* z, or y in a flat grid */
    uint32_t low, high;
} Slab;

bool grid_box_is_empty(const Box *box);
/* The cells that are up to `distance` away from a box along each axis. */
Cover grid_cover_box(const Builder *b, const Box *box, double distance);
/* That of a processor. */
Slab  grid_slab_of_part(const Builder *b, size_t part, size_t parts);
Cover grid_cover_in_slab(Cover cover, Slab slab);

/* Lists are filled in three steps: first[] has the length of each; between these two the next place in it. */
void grid_begin_lists(Grid *grid, Arena *arena);
void grid_end_lists(Grid *grid);

/* Where the cells, or few, of a grid are that will be refined; false: there are too many boxes, or one is endless. */
bool grid_place_coarse(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       bool few, Arena *scratch);

/* When all lists are filled. */
void grid_find_clearances(const Builder *b, Arena *arena);

#endif
