/*
 * surface.c: what a hit knows of the surface: chosen from one of two shapes, mixed where they
 * blend, and painted with a material.
 */
#include "compiler/lower/surface.h"

static Node choose(Graph *g, Node condition, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_select, condition, a, b);
}

Surface choose_surface(Graph *g, Node condition, Surface a, Surface b)
{
    return (Surface){choose(g, condition, a.color, b.color),
                     choose(g, condition, a.roughness, b.roughness),
                     choose(g, condition, a.metallic, b.metallic),
                     choose(g, condition, a.emission, b.emission),
                     choose(g, condition, a.level, b.level),
                     choose(g, condition, a.instance, b.instance),
                     choose(g, condition, a.uv, b.uv),
                     choose(g, condition, a.normal, b.normal),
                     choose(g, condition, a.trap, b.trap)};
}

/* Weight 1 is a. */
static Node mix_nodes(Graph *g, Node a, Node b, Node weight)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_mix, b, a, weight);
}

/* Materials blend with the shapes; numbers of levels and instances cannot, nor can coordinates. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b)
{
    return (Surface){mix_nodes(g, a.color, b.color, weight),
                     mix_nodes(g, a.roughness, b.roughness, weight),
                     mix_nodes(g, a.metallic, b.metallic, weight),
                     mix_nodes(g, a.emission, b.emission, weight),
                     choose(g, nearer, a.level, b.level),
                     choose(g, nearer, a.instance, b.instance),
                     choose(g, nearer, a.uv, b.uv),
                     mix_nodes(g, a.normal, b.normal, weight),
                     choose(g, nearer, a.trap, b.trap)};
}
