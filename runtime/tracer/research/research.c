/*
 * research.c: what the methods of research need.
 */
#include "runtime/tracer/research/research.h"

const ResearchTrace *research_trace(KrsTrace trace)
{
    static const ResearchTrace methods[KRS_TRACE_COUNT] = {
        [KRS_TRACE_TAYLOR]      = {false, KRS_FUNCTION_ALONG, KRS_STEP_TAYLOR, "", KRS_TRACE_TAYLOR,
                                   KRS_TRACE_TAYLOR},
        [KRS_TRACE_ROOT_FREE]   = {false, KRS_FUNCTION_ALONG, KRS_STEP_ROOT_FREE, "",
                                   KRS_TRACE_ROOT_FREE, KRS_TRACE_ROOT_FREE},
        [KRS_TRACE_DIRECTIONAL] = {true, KRS_FUNCTION_ALONG, KRS_STEP_DIRECTIONAL, "",
                                   KRS_TRACE_AUTO, KRS_TRACE_DIRECTIONAL},
        [KRS_TRACE_BINARY]      = {true, KRS_FUNCTION_PROBE, KRS_STEP_EXACT, "#define PROBE 1\n",
                                   KRS_TRACE_AUTO, KRS_TRACE_PLAIN},
        [KRS_TRACE_PREDICTED]   = {true, KRS_FUNCTION_PROBE, KRS_STEP_EXACT, "#define PROBE 2\n",
                                   KRS_TRACE_AUTO, KRS_TRACE_PLAIN},
    };
    return methods[trace].defines ? &methods[trace] : NULL;
}

bool research_applies(const KrsProgram *program, const ResearchTrace *research)
{
    return research->inverts ? program->inverts : program->along;
}

bool research_pass(const KrsRenderOptions *options, const KrsProgram *program, ResearchPass *pass)
{
    *pass = (ResearchPass){"research/even_hits.comp", KRS_FUNCTION_DISTANCE,
                           options->methods.even_hits};
    return options->methods.even_hits > 0 && !program->open_surfaces;
}

const char *research_starts(KrsStarts starts)
{
    return starts == KRS_STARTS_DISTANCE ? "#define STARTS_BY_DISTANCE\n" : "";
}
