/*
 * emit.h: the graph as GLSL: the promised functions of compile.h.
 */
#ifndef KRS_EMIT_H
#define KRS_EMIT_H

#include "compiler/geometry/lower.h"

/* Text of a program with `component_count` components; the roots of component i are
   roots[i * ROOT_COUNT + ...], nodes of a simplified graph. */
void emit_glsl(const Graph *graph, const Sources *sources, const Node *roots,
               size_t component_count, Arena *scratch, Text *out);

#endif
