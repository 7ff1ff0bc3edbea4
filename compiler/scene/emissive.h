/*
 * emissive.h: what emits light, and where it is in a state.
 */
#ifndef KRS_EMISSIVE_H
#define KRS_EMISSIVE_H

#include "compiler/graph/evaluate.h"
#include "compiler/shape/box.h"

/* A part of a component that may emit light for some values of the parameters. */
typedef struct EmissivePart {
    Box         box;                /* for all values of the parameters; may be infinite */
    Node        distance, emission; /* of the component */
    const Tape *tape;               /* of both */
    double      place;              /* that parts are sorted by */
    size_t      number;             /* where that is equal */
} EmissivePart;

typedef struct Compilation Compilation;

/* Retains what may emit light in a scene.  Parts that are next to each other are so in the array as well:
   each half of it is one side of them, and so on. */
void retain_emissive(Compilation *c);

#endif
