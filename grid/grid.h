/*
 * grid.h: how a grid is made.
 *
 * Runs of bricks along x are dealt out to threads (grid.c).  A run is halved down to bricks, as far as its distance from
 * the surface is not proven (row.c).  Exact distances are those to a mesh of proven error (samples.c).
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
    double near; /* samples that are farther from the surface have one value; infinite: none has */
    size_t parts;
    MeshField fields[MAX_PARTS];
    KrsMesh
        *mesh; /* for exact distances; NULL: not asked for, or nothing is as thick as its error */
    Bvh  bvh;
};

/* Where a sample is. */
static inline double grid_place(const KrsGrid *grid, int axis, size_t index)
{
    return (double)(grid->shape.first[axis] + (int64_t)index) * grid->shape.cell;
}

/* samples.c: the samples of a brick that begins at `at`; the field is in the box of them. */
void      fill_brick(const KrsGrid *grid, MeshField *field, const size_t at[3], uint32_t *triangle,
                     Brick *brick);
KrsStatus add_materials(const KrsGrid *grid, MeshField *field, const size_t at[3], Brick *brick);
/* The value of samples that are so far from the surface, told by one of them. */
float far_value(const KrsGrid *grid, double distance);

/* coverage.c: the part of the cube around a point that is solid. */
double coverage(const MeshField *field, const double point[3], double side);

/* Bricks that follow each other along x: the numbers of the first, and how many. */
typedef struct BrickRun {
    size_t first[3], count;
} BrickRun;

/* row.c: fills bricks that have room for their samples.  With `count_only` it only finds which are near. */
KrsStatus fill_run(const KrsGrid *grid, MeshField *field, const BrickRun *run, bool count_only,
                   Brick *bricks);

#endif
