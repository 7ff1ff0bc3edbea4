/*
 * mesher.h: what a mesh is made with.
 */
#ifndef KRS_MESH_MESHER_H
#define KRS_MESH_MESHER_H

#include <stdatomic.h>

#include "compiler/base/parallel.h"
#include "mesh/contour/groups.h"
#include "mesh/proof/marks.h"
#include "mesh/proof/verify.h"

typedef struct Mesher {
    Memory                memory;
    Arena                 arena;
    const KrsMeshOptions *options;
    const MeshSolid      *solid;
    double                low[3], high[3], error, side;
    double                spared; /* of the error, for leaving out triangles */
    MeshField             fields[MAX_PARTS];
    Verifier              verifiers[MAX_PARTS];
    Tets                  tets;
    Contour               contour;
    Bvh                   bvh;
    Marks                 marks;      /* where the mesh is new since proofs were found */
    bool                  has_proofs; /* some were looked for */
    Arounds               around;
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } last;               /* tetrahedra that were fresh before the last refinement */
    Groups        groups; /* of tetrahedra to be looked at */
    atomic_size_t next_group;
    size_t        unresolved; /* tetrahedra */
    double        sharp;      /* as of Verifier */
    int           tidied;     /* how often sides of points were (sides.h) */
    size_t        handles;    /* places in a mesh that is thought to be right (handles.h) */
    double        unresolved_at[3];
    double        fraction;    /* of the work, as was last said, */
    double        begun, goal; /* where the round began, and will end */
    double        looked;      /* tetrahedra that were looked at by bounds */
    atomic_bool   stopped;
} Mesher;

#endif
