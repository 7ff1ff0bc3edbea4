/*
 * solid.h: what is asked about: some components of a scene, or a part of its assembly.
 */
#ifndef KRS_FIELD_SOLID_H
#define KRS_FIELD_SOLID_H

#include "compiler/scene/program.h"

typedef struct MeshSolid {
    const Tape *tape;  /* has the roots; NULL: that of the distance in the frame */
    Node       *roots; /* distances, whose least counts; room for all components and a zone */
    size_t      root_count;
    bool        zoned; /* behind them is the depth in zones */
    Box         box;
    bool        estimate;
    bool        plain;       /* of one material, which is the same everywhere */
    bool        steps;       /* of materials that change in steps (steps.h) */
    const double (*copy)[4]; /* where in the scene it is once; NULL: it is where it is */
} MeshSolid;

/* Makes a solid of all components, or of those that are `wanted`, by their index among the
   lowered. */
void solid_of_components(const KrsScene *scene, const bool *wanted, MeshSolid *solid);
/* Tells whether they have one material, which is the same everywhere. */
bool has_one_material(const KrsScene *scene, const bool *wanted);
/* Returns the bytes of `roots` that suffice. */
size_t solid_root_bytes(const KrsScene *scene);

#endif
