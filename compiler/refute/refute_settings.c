/*
 * refute_settings.c: values of parameters at which distances are searched, such as a state can
 * have.
 */
#include "compiler/refute/refute_settings.h"

#include <math.h>
#include <string.h>

#include "compiler/base/splitmix.h"
#include "compiler/graph/rewrite/simplify.h"
#include "compiler/shape/slope.h"

enum { SETTING_ATTEMPTS = 8 };

static const struct KrsFixed *fixed_value(const Refuter *r, const char *name)
{
    for (size_t i = 0; i < r->how->fixed_count; i++)
        if (strcmp(r->how->fixed[i].name, name) == 0)
            return &r->how->fixed[i];
    return NULL;
}

static double random_value(Refuter *r, double usual, double low, double high)
{
    double choice = splitmix_unit(&r->random), t = splitmix_unit(&r->random);
    if (!isfinite(low))
        low = fmin(usual, isfinite(high) ? high : usual) - 1 - fabs(usual);
    if (!isfinite(high))
        high = fmax(usual, low) + 1 + fabs(usual);
    return choice < 0.2 ? low : choice < 0.4 ? high : low + t * (high - low);
}

void choose_parameters(Refuter *r, uint32_t trial, NodeValue *values)
{
    const Scene *scene = r->in->scene;
    values[0].v[0]     = trial ? 10 * splitmix_unit(&r->random) : r->how->time;
    for (size_t i = 0; i < scene->parameters.count; i++) {
        const Parameter       *parameter = &scene->parameters.items[i];
        const struct KrsFixed *fixed     = fixed_value(r, parameter->name);
        double                *to        = values[parameter->slot].v;
        memcpy(to, fixed ? fixed->values : parameter->value, sizeof parameter->value);
        for (uint32_t k = 0; trial && !fixed && k < parameter->components; k++)
            to[k] = random_value(r, parameter->value[k], parameter->low[k], parameter->high[k]);
    }
}

/* Finds the slopes for the slots; false: one has no bound, and the state is refused. */
static bool find_slopes(const Refuter *r, NodeValue *values)
{
    const Scene *scene = r->in->scene;
    for (size_t i = 0; i < scene->slopes.count; i++) {
        const double(*parameters)[4] = (const double(*)[4])values;
        double slope                 = state_slope_upward(
                            slope_task_run(&r->slopes[i], parameters, r->workspace, NULL));
        values[scene->slopes.items[i].slot].v[0] = slope;
        if (!isfinite(slope))
            return false;
    }
    return true;
}

/* Prepares the slopes, simplified as in compiled scenes. */
void prepare_slopes(Refuter *r)
{
    const Scene *scene = r->in->scene;
    size_t       most  = 0;
    r->slopes          = arena_new_array(r->in->arena, SlopeTask, scene->slopes.count + 1);
    for (size_t i = 0; i < scene->slopes.count; i++) {
        const StateSlope *slope = &scene->slopes.items[i];
        Node              root  = slope->formula;
        Graph            *plain = graph_simplify(r->graph, &root, 1, r->in->arena);
        uint32_t          cells = state_slope_cells(slope->region);
        r->slopes[i]            = slope_task(plain, root, slope->region, cells, r->in->arena);
        size_t workspace        = slope_task_size(&r->slopes[i]);
        most                    = workspace > most ? workspace : most;
    }
    r->workspace = arena_alloc(r->in->arena, most, 1);
}

/* Prepares frames as states have them: all components outside of everything. */
void prepare_frames(Refuter *r)
{
    Arena *arena = r->in->arena;
    size_t count = 0;
    Node  *roots = arena_new_array(arena, Node, r->in->scene->components.count + 1);
    for (size_t i = 0; i < r->in->scene->components.count; i++) {
        Node plain = lower_alone(r, r->in->scene->components.items[i].shape, false, NULL);
        if (plain != NODE_NONE)
            roots[count++] = plain;
    }
    r->result->skipped = 0; /* they are lowered once more */
    Graph *simple      = graph_simplify(r->graph, roots, count, arena);
    r->state_tape      = tape_new(simple, roots, count, arena);
    r->state_values    = arena_new_array(arena, NodeValue, simple->count);
}

/* Tells whether a state can have these parameters; finds its slopes. */
static bool is_possible(const Refuter *r, NodeValue *parameters)
{
    if (!find_slopes(r, parameters))
        return false;
    tape_run_frame(&r->state_tape, parameters, r->state_values);
    return tape_frame_infinite(&r->state_tape, r->state_values) == NODE_NONE;
}

bool needs_parameters(const Tape *tape)
{
    for (size_t i = 0; i < tape->frame_count; i++)
        if (tape->graph->items[tape->nodes[i]].op == OP_PARAMETER)
            return true;
    return false;
}

bool choose_possible(Refuter *r, uint32_t trial, NodeValue *parameters)
{
    for (int i = 0; i < (trial ? SETTING_ATTEMPTS : 1); i++) {
        choose_parameters(r, trial, parameters);
        if (is_possible(r, parameters))
            return true;
    }
    return false;
}
