/*
 * surface.c: what is known of the surface at a hit where two shapes are joined: that of one shape,
 * or a mixture where they blend.
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
    Surface chosen;
#define KRS_INNER(name, blends) chosen.name = choose(g, condition, a.name, b.name);

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "compiler/shape/surface.def"
    return chosen;
}

/* The weighted mean of a and b; weight 1 gives a. */
static Node mix_nodes(Graph *g, Node a, Node b, Node weight)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_mix, b, a, weight);
}

/* Materials are mixed where shapes blend.  Levels, instances and coordinates cannot be mixed. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b)
{
    Surface mixed;
#define MIXED(name)             mix_nodes(g, a.name, b.name, weight)
#define NEARER(name)            choose(g, nearer, a.name, b.name)
#define KRS_INNER(name, blends) mixed.name = blends(name);

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "compiler/shape/surface.def"
    return mixed;
}
