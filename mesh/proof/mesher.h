/*
 * mesher.h: the state of a run of the mesher.
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
    double                reserved; /* of the error, for simplification */
    MeshField             fields[MAX_PARTS];
    Verifier              verifiers[MAX_PARTS];
    Tets                  tets;
    Contour               contour;
    Bvh                   bvh;
    Marks                 marks;      /* where the mesh is new since proofs were found */
    bool                  has_proofs; /* proofs have been searched */
    Arounds               around;
    Growths               new_growths; /* of what is bounded now, by its place in the order */
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } last;               /* tetrahedra that were fresh before the last refinement */
    Groups        groups; /* of tetrahedra to be worked on */
    atomic_size_t next_group;
    size_t        unresolved; /* tetrahedra */
    double        sharp;      /* as of Verifier */
    int           tidied;     /* how often sides of points were changed (sides.h) */
    size_t        handles;    /* in a mesh where nothing else is unresolved (handles.h) */
    double        unresolved_at[3];
    double        fraction;    /* of the work, as reported last */
    double        begun, goal; /* where the present step began, and will end */
    double        bounded;     /* tetrahedra that were bounded */
    atomic_bool   stopped;
} Mesher;

#endif
