/*
 * measure.h: the steps that measure a part.
 *
 * 1.  A mesh tells areas, and where the surface is. 2.  Cells tell the volume and the center: in a
 * cell where the derivatives are known to be in ranges, the solid is between two half-spaces, whose
 * volumes in the cell are exact (volume.c). 3.  Triangles are halved until they are small.  The
 * point of the surface at the middle of each is a sample, with its normal and the wall behind it
 * (samples.c). 4.  Samples tell what hangs over, and on which of its faces the part can lie
 * (lying.c).
 */
#ifndef KRS_MEASURE_MEASURE_H
#define KRS_MEASURE_MEASURE_H

#include <stdatomic.h>

#include "compiler/base/parallel.h"
#include "compiler/field/field.h"

/* A sample of the surface. */
typedef struct Sample {
    double at[3], normal[3];
    double area;    /* of its triangle */
    bool   snapped; /* `at` and `normal` are the surface's; else the triangle's */
    double wall;    /* behind it; INFINITY: none */
} Sample;

typedef struct Measurer {
    Memory                   memory;
    Arena                    arena;
    const KrsMeasureOptions *options;
    MeshSolid                solid;
    double                   low[3], high[3], longest; /* the box of what is measured */
    size_t                   parts;
    MeshField                fields[MAX_PARTS];
    KrsMesh                 *mesh;
    KrsMeasures             *measures;
    struct {
        Sample *items;
        size_t  count, capacity;
    } samples;
    double        begun, goal; /* parts of the work that are done before and after this step */
    atomic_bool   stopped;
    atomic_size_t next; /* of the items that threads share */
} Measurer;

/* Tells whether to go on; the first thread reports progress, and all stop if that says so. */
bool measurer_progress(Measurer *m, size_t part, double fraction);

/* Finds two unit vectors at right angles to a unit vector and to each other. */
void measure_axes(const double up[3], double right[3], double front[3]);

/* Each of these sets its members of the measures. */
void measure_volume(Measurer *m);
void measure_samples(Measurer *m);
void measure_lying(Measurer *m);

#endif
