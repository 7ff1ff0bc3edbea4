/*
 * grid.h: the steps that make a grid.
 *
 * Threads take runs of bricks along x (grid.c).  A run is halved down to bricks, unless its
 * distance from the surface is proven (row.c).  Exact distances are those to a mesh of proven error
 * (samples.c).
 */
#ifndef KRS_GRID_GRID_H
#define KRS_GRID_GRID_H

#include "compiler/base/parallel.h"
#include "compiler/field/bvh.h"
#include "compiler/field/field.h"

enum { BRICK = KRS_BRICK_SIDE, BRICK_SAMPLES = KRS_BRICK_SAMPLES };

typedef struct Brick {
    bool   near;
    float  far; /* the value of all samples of one that is not near */
    float *values;
    float (*colors)[3];
    uint32_t *materials;
} Brick;

struct KrsGrid {
    Memory         memory;
    Arena          arena;
    KrsGridOptions options;
    KrsGridShape   shape;
    MeshSolid      solid;
    double         low[3], high[3]; /* around what is solid */
    size_t         bricks[3];
    uint32_t       chosen; /* number from 1 of the only component among the lowered; 0: all */
    double         near;   /* samples farther from the surface have one value; infinite: none has */
    size_t         parts;
    MeshField      fields[MAX_PARTS];
    KrsMesh       *mesh; /* for exact distances; NULL: none wanted, or it has no triangles */
    Bvh            bvh;
};

/* Returns the coordinate of a sample along an axis. */
static inline double grid_coordinate(const KrsGrid *grid, int axis, size_t index)
{
    return (double)(grid->shape.first[axis] + (int64_t)index) * grid->shape.cell;
}

/* Fills the samples of a brick that begins at `at`, and their materials; the field is in their box
   (samples.c). */
void      fill_brick(const KrsGrid *grid, MeshField *field, const size_t at[3], uint32_t *triangle,
                     Brick *brick);
KrsStatus add_materials(const KrsGrid *grid, MeshField *field, const size_t at[3], Brick *brick);
/* Returns the value of samples far from the surface, where one of them has this distance. */
float far_value(const KrsGrid *grid, double distance);

/* Returns the part of the cube around a point that is solid (coverage.c). */
double coverage(const MeshField *field, const double point[3], double side);

/* Bricks in a row along x: the numbers of the first, and how many. */
typedef struct BrickRun {
    size_t first[3], count;
} BrickRun;

/* Fills bricks that have room for their samples; with `count_only` it only finds which are near
   (row.c). */
KrsStatus fill_run(const KrsGrid *grid, MeshField *field, const BrickRun *run, bool count_only,
                   Brick *bricks);

#endif
