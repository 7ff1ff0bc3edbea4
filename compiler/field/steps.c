/* steps.c: which nodes of a graph change in steps: choices between what does, and all that is computed of such. */
#include "compiler/field/steps.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/graph/instance_table.h"

typedef struct Stepping {
    const Graph *graph;
    /* Of each node; a state of an instance group counts as one until its body tells otherwise. */
    bool *steps;
    bool  changed;
} Stepping;

static Node body_of(const Stepping *s, uint32_t function, uint32_t body)
{
    const Instances *instances = s->graph->instances;
    return instances->bodies.items[instances->functions.items[function].first_body + body];
}

/* Tells whether a call changes in steps, whose result is a state, or what joins the states; sums change
   evenly. */
static bool call_steps(const Stepping *s, const Expr *call)
{
    uint32_t                number   = (uint32_t)s->graph->items[call->operands[0]].number[0];
    const InstanceFunction *function = &s->graph->instances->functions.items[number];
    uint32_t                last     = body_count(function) - 1;
    return !function->sums && s->steps[body_of(s, number, 0)] &&
           (!function->joins || s->steps[body_of(s, number, last)]);
}

static bool node_steps(const Stepping *s, const Expr *e)
{
    bool all = e->operand_count > 0;
    if (e->time != TIME_POINT || e->type == TYPE_BOOL || e->type == TYPE_UINT)
        return true;
    if (e->op == OP_STATE)
        return s->steps[body_of(s, function_of(e->index), state_of(e->index))];
    if (is_call((Op)e->op))
        return call_steps(s, e);
    if (e->op == OP_sign || e->op == OP_floor || e->op == OP_ceil || e->op == OP_round)
        return true;
    if (e->op == OP_blend_weight && graph_is_constant(s->graph, e->operands[2]) &&
        s->graph->items[e->operands[2]].number[0] <= 0)
        return true;
    for (int k = e->op == OP_select ? 1 : 0; k < e->operand_count; k++)
        all = all && s->steps[e->operands[k]];
    return all;
}

/* States are of bodies that come later, so all nodes are looked at until nothing changes. */
static void find_steps(Stepping *s)
{
    memset(s->steps, 1, s->graph->count);
    do {
        s->changed = false;
        for (size_t i = 0; i < s->graph->count; i++)
            if (s->steps[i] && !node_steps(s, &s->graph->items[i])) {
                s->steps[i] = false;
                s->changed  = true;
            }
    } while (s->changed);
}

bool materials_step(const KrsScene *scene, const bool *wanted)
{
    Stepping s   = {.graph = scene->graph, .steps = malloc(scene->graph->count + 1)};
    bool     all = s.steps;
    if (all)
        find_steps(&s);
    for (size_t i = 0; all && i < scene->component_count; i++)
        for (size_t k = 0; (!wanted || wanted[i]) && k < ROOT_COUNT; k++)
            if (root_info[k].material)
                all = all && s.steps[surface_roots(&scene->roots, i)[k]];
    free(s.steps);
    return all;
}

/* Calls of instance groups always have a normal, which their bodies know as a leaf. */
static bool has_normal(const bool *has, bool instances, const Expr *e)
{
    static const Op LEAVES[] = {OP_NORMAL, OP_VIEW, OP_FRONT, OP_DIRECTION, OP_INSTANCE_NORMAL};
    for (size_t i = 0; i < sizeof LEAVES / sizeof *LEAVES; i++)
        if (e->op == LEAVES[i])
            return true;
    if (is_call((Op)e->op))
        return instances;
    for (int k = 0; k < e->operand_count; k++)
        if (has[e->operands[k]])
            return true;
    return false;
}

bool materials_have_normals(const KrsScene *scene)
{
    const Graph *graph     = scene->graph;
    bool        *has       = malloc(graph->count + 1);
    bool         instances = false, any = !has;
    for (size_t i = 0; i < graph->count; i++)
        instances = instances || graph->items[i].op == OP_INSTANCE_NORMAL;
    for (size_t i = 0; has && i < graph->count; i++)
        has[i] = has_normal(has, instances, &graph->items[i]);
    for (size_t i = 0; has && i < scene->component_count; i++)
        for (size_t k = 0; k < ROOT_COUNT; k++)
            any = any || (root_info[k].material && has[surface_roots(&scene->roots, i)[k]]);
    free(has);
    return any;
}
