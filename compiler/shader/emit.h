/*
 * emit.h: the graph as GLSL: the promised functions of compile.h.
 */
#ifndef KRS_EMIT_H
#define KRS_EMIT_H

#include "compiler/lower/lower.h"
#include "compiler/shader/frame_values.h"

/* How components are to be marched. */
typedef struct EmitMarch {
    const Node     *guarded; /* of each component: lower_guarded */
    const Node     *along;   /* of each component, method by method: lower_along */
    const Box      *boxes;
    const uint32_t *march_groups; /* the group of each, or NULL: all together */
    const bool     *is_plane;    /* whether each is a plane that krs_plane_t knows; NULL: none is */
    const Node *camera_relative; /* all roots and `plane_roots` again, by graph_rebase; NULL: none
                               is rebased.  For kernels with #define CAMERA_RELATIVE */
    uint32_t    zone_slots;      /* before what the host finds for those */
    const Node *plane_roots; /* with `is_plane`: where a ray meets one, and how steeply it falls */
    bool        slopes;      /* there are slots of slopes */
    const Node *gradient;    /* of each component and of the zones: lower_gradient's two; FLOATs
                               where there is none; NULL: nobody wants any */
} EmitMarch;

/* In how many scene parts so many components are marched: each is one component or neighbours,
   where each ray goes on with the one that comes next. */
uint32_t emit_scene_part_count(size_t components);
/* What the host finds for each frame, and for each origin of camera-relative points. */
typedef struct EmittedFrame {
    FrameValues plain, camera_relative;
} EmittedFrame;

/* Text of a program with `component_count` components; the roots of component i are
   roots[i * ROOT_COUNT + ...], nodes of a simplified graph.  `zone`, the depth in zones, follows
   them, or is NODE_NONE. */
void emit_glsl(const Graph *graph, const Sources *sources, const Node *roots,
               size_t component_count, Node zone, const EmitMarch *march, Arena *scratch, Text *out,
               EmittedFrame *frame);

#endif
