/*
 * refuting.h: what the files of the refutation share: refute.c goes through the shapes,
 * refute_settings.c chooses parameters, refute_blame.c finds the smallest shape at fault, and
 * refute_report.c says what was found.
 */
#ifndef KRS_REFUTING_H
#define KRS_REFUTING_H

#include "compiler/eval/claims.h"
#include "compiler/lower/context.h"
#include "compiler/refute.h"
#include "compiler/search.h"

/* A shape that is looked at, and where in the trees it was met first. */
typedef struct Suspect {
    const Shape *shape;
    uint32_t     component;
    size_t       parent; /* index of a suspect; SIZE_MAX of a component's whole shape */
} Suspect;

/* What is searched of a shape: its distance, and of a whole component what marches instead. */
typedef enum Claim {
    CLAIM_DISTANCE,
    CLAIM_GUARDED, /* the distance that leaves out what is far */
    CLAIM_ALONG    /* the step along a ray, by AlongMethod from here on */
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
    Tape                    frames; /* all components: what frames are refused by */
    NodeValue              *frame_values;
    struct {
        Suspect *items;
        size_t   count, capacity;
    } suspects;
    bool stopped;
} Refuter;

/* ---- refute.c ---- */

/* Whether a shape adds nothing to the distance of what it holds. */
bool is_wrapper(const Shape *shape);

/* The distance of a shape in its own space; NODE_NONE: of nothing, or of too much. */
Node lower_alone(Refuter *r, const Shape *shape, bool lipschitz, LoweredShapes *lowered_shapes);

/* A search of one of the distances of a shape; false: there is nothing to search. */
bool search_of(Refuter *r, const Shape *shape, Node distance, bool lipschitz, Search *search);

/* ---- refute_settings.c ---- */

/* Slopes and frames of the scene, before any parameters are chosen. */
void prepare_slopes(Refuter *r);
void prepare_frames(Refuter *r);

/* Whether what it computes depends on parameters of the scene. */
bool needs_parameters(const Tape *tape);
/* Defaults in the first trial, then anything that is permitted. */
void choose_parameters(Refuter *r, uint32_t trial, NodeValue *values);
/* Chooses parameters that a frame can have, as good as any others but for the first; false: there
   are none to be found, or those of the first trial cannot be had, which is a finding. */
bool choose_possible(Refuter *r, uint32_t trial, NodeValue *parameters);

/* ---- refute_blame.c ---- */

/* From what was refuted to the smallest shape that is refuted too. */
void find_culprit(Refuter *r, Finding *finding);

/* ---- refute_report.c ---- */

/* The distance of a shape, found to be wrong in `whole`, is refuted in `finding`. */
void report_finding(Refuter *r, const Finding *whole, const Finding *finding);
/* A claim beside the distance is. */
void report_claim(Refuter *r, const Finding *finding);

#endif
