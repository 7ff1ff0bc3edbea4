/*
 * research.h: methods of papers that are compared with those that pictures are made by.
 *
 * The tracer asks here what a method needs; for those that are no research the answer is nothing.
 */
#ifndef KRS_TRACER_RESEARCH_H
#define KRS_TRACER_RESEARCH_H

#include "krs/vulkan.h"
#include "compiler/passes/compile.h"

/* A method by which rays advance. */
typedef struct ResearchTrace {
    bool        inverts;  /* it is for maps that invert; else for polynomials */
    KrsFunction function; /* of the scene, by which rays step */
    KrsRayStep  step;     /* of krs_along */
    const char *defines;
    KrsTrace    of_paths,
        from_inside; /* what does instead for paths, and for rays that may begin in solids */
} ResearchTrace;

/* Returns the research method of a trace; NULL: it is none of these. */
const ResearchTrace *research_trace(KrsTrace trace);
/* Tells whether a scene has what the method is for; else rays step by the distance. */
bool research_applies(const KrsProgram *program, const ResearchTrace *research);

/* A shader that changes the hits of camera rays before anything else is done with them. */
typedef struct ResearchPass {
    const char *shader;
    KrsFunction function; /* of the scene, which it calls */
    uint32_t    value;    /* its control.value */
} ResearchPass;

/* Finds the pass of a research method; false: there is none.  Open surfaces have no hits to even
   out: their distance is that of a shell around them. */
bool research_pass(const KrsRenderOptions *options, const KrsProgram *program, ResearchPass *pass);

/* Returns what scatter.comp is compiled with. */
const char *research_starts(KrsStarts starts);

#endif
