/*
 * simplifier.h: one simplification: simplify.c makes proposals, faults.c judges them.
 */
#ifndef KRS_MESH_SIMPLIFIER_H
#define KRS_MESH_SIMPLIFIER_H

#include <stdatomic.h>

#include "krs/krs.h"
#include "mesh/common/numbering.h"
#include "mesh/simplify/near.h"

/* The properties of triangles, for the rules of collapses. */
typedef struct Known {
    double   *off, *missed;
    uint32_t *below;
} Known;

typedef struct Simplifier {
    Memory                memory;
    Arena                 arena, lasting; /* of a trial, and of all */
    const KrsMesh        *mesh;
    const KrsMeshOptions *options;
    double                error;
    float (*positions)[3];
    uint32_t (*triangles)[3]; /* of the mesh's vertices */
    bool  *kept;              /* of the best triangles: they stay as they are */
    size_t triangle_count;
    uint32_t (*best)[3]; /* the best triangles without faults, or what blocks left */
    size_t    best_count;
    Known     known, best_known; /* of the last trial, if it collapsed edges, and of the best */
    bool      collapsed;
    Numbering judged; /* of new triangles, bounds of how far they are from the mesh, in steps */
    Numbering noted;  /* new triangles that are near, and in `facing` */
    NearMesh  original;
    /* The vertices of a triangle above or below each one of the mesh, in the last trial and in the
       best; all 0: none. */
    uint32_t (*facing)[3], (*best_facing)[3];
    NearQuery *queries;               /* of each part */
    double     fraction, begun, goal; /* of the work: done, and before and after the present step */
    atomic_bool stopped;
} Simplifier;

/* Distances are kept in so many steps of the error; one more step: it is more than the error. */
enum { STEPS = 1 << 16, FAR_STEP = STEPS + 1 };

static inline NumberKey key_of(const uint32_t triangle[3])
{
    return face_key(triangle[0], triangle[1], triangle[2]);
}

/* Counts the faults of a trial, not all of them if there are more than `most`; `goal` is the part of the work that is done
   then. */
size_t count_faults(Simplifier *s, double radius, size_t most, double goal);
/* Tells whether a new triangle is near the mesh, whose triangles at its corners are starts. */
bool is_near_original(const Simplifier *s, const uint32_t triangle[3], NearQuery *query);
/* Reports which part of a step is done, and notes whether the work is to end. */
void simplifier_progress(Simplifier *s, double part);

#endif
