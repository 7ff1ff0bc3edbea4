/*
 * research.c: which method is where.
 */
#include "compiler/lower/research/research.h"

#include "compiler/lower/ray_step.h"
#include "compiler/lower/research/methods.h"

Node lower_research(Graph *graph, const Shape *shape, Node plain, ResearchMethod method,
                    struct LoweredGroups *groups, Arena *scratch)
{
    switch (method) {
    case RESEARCH_TAYLOR:
        return lower_along_by(graph, shape, plain, series_step_of_taylor, groups, scratch);
    case RESEARCH_ROOT_FREE:
        return lower_along_by(graph, shape, plain, series_step_of_root_free, groups, scratch);
    case RESEARCH_DIRECTIONAL: return lower_image(graph, shape, plain, false, groups, scratch);
    case RESEARCH_PROBE: return lower_image(graph, shape, plain, true, groups, scratch);
    case RESEARCH_COUNT: break;
    }
    return plain;
}
