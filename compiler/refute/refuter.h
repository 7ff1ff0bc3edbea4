/*
 * refuter.h: what a refutation knows, and one shape of it by itself: lowered, and searched.
 */
#ifndef KRS_REFUTER_H
#define KRS_REFUTER_H

#include "compiler/passes/compile.h"
#include "compiler/eval/declared/claim_pairs.h"
#include "compiler/passes/inspect.h"
#include "compiler/lower/context.h"
#include "compiler/refute/search_types.h"

/* A shape that is looked at, and where in the trees it was met first. */
typedef struct Suspect {
    const Shape *shape;
    uint32_t     component;
    size_t       parent; /* index of a suspect; SIZE_MAX of a component's whole shape */
} Suspect;

/* The claims of a shape that are searched: its distance, and of a whole component what marches
   instead. */
typedef enum Claim {
    CLAIM_DISTANCE,
    CLAIM_GUARDED, /* the distance that leaves out what is far */
    CLAIM_ALONG,   /* the step along a ray */
    CLAIM_RESEARCH /* the same by ResearchMethod, from here on */
} Claim;

/* Points that refute a shape, at these parameters. */
typedef struct Finding {
    size_t     suspect;
    Claim      claim;
    ShapeClaim pair;      /* `property` is NULL, or what is claimed beside the distance */
    bool       lipschitz; /* of the distance that has to be 1-Lipschitz, else of the other */
    Witness    witness;
    NodeValue *parameters;
} Finding;

typedef struct Refuter {
    const Inspected        *in;
    const KrsRefuteOptions *how;
    KrsRefutation          *result;
    Graph                  *graph;
    uint64_t                random, total, done;
    SlopeTask              *slopes; /* of the scene's, in its order */
    void                   *workspace;
    Tape                    state_tape; /* all components: what states are refused by */
    NodeValue              *state_values;
    struct {
        Suspect *items;
        size_t   count, capacity;
    } suspects;
    bool stopped;
} Refuter;

/* Tells whether a shape adds nothing to the distance of what it holds. */
bool is_wrapper(const Shape *shape);

/* Lowers the distance of a shape in its own space; NODE_NONE: of nothing, or of too much. */
Node lower_alone(Refuter *r, const Shape *shape, bool lipschitz, LoweredShapes *lowered_shapes);

/* Makes a search of one of the distances of a shape; false: there is nothing to search. */
bool search_of(Refuter *r, const Shape *shape, Node distance, bool lipschitz, Search *search);
/* Does the same of a step, beside the distance that tells on which side points are. */
bool search_step(Refuter *r, const Shape *shape, Node step, Node side, bool lipschitz,
                 Search *search);

#endif
