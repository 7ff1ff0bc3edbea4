/*
 * mesher.h: the state of a run of the mesher.
 */
#ifndef KRS_MESH_MESHER_H
#define KRS_MESH_MESHER_H

#include <stdatomic.h>

#include "compiler/base/minmax.h"
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
    size_t        untidy;     /* locations at which the mesh was tidied last */
    size_t        handles;    /* in a mesh where nothing else is unresolved (handles.h) */
    double        unresolved_at[3];
    bool          drafted;     /* the mesh was tested in places only */
    double        flat;        /* of the work, what was done before flat faces were given up */
    double        fraction;    /* of the rest */
    double        begun, goal; /* where the present step began, and will end */
    double        bounded;     /* tetrahedra that were bounded */
    atomic_bool   stopped;
} Mesher;

/* Begins a step that is a part of what is left to be done. */
static inline void mesher_begin(Mesher *m, double part)
{
    m->begun = m->fraction;
    m->goal  = m->fraction + part * (1 - m->fraction);
}

/* Notes that a part of the present step is done. */
static inline void mesher_advance(Mesher *m, double part)
{
    m->fraction = max2(m->fraction, m->begun + part * (m->goal - m->begun));
}

/* Reports progress and tells whether to go on; only the caller's thread may ask, which runs the
   first part of all work. */
static inline bool mesher_is_wanted(const Mesher *m)
{
    double done = m->flat + (1 - m->flat) * m->fraction;
    return !m->options->progress || m->options->progress(m->options->user, done);
}

#endif
