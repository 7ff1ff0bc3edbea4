/*
 * find_emissive.c: finds what may emit light, and sorts it by its places.
 */
#include <math.h>
#include <stdlib.h>

#include "compiler/passes/compilation.h"
#include "compiler/graph/bounds/facts.h"

/* ---- which components ---- */

static bool has_light(const Fact *emission)
{
    bool found = false;
    for (int k = 0; k < 3; k++)
        found = found || !(emission->value[k].high <= 0);
    return found;
}

/* Tells whether light is emitted at some point of a box, for some values of the parameters. */
static bool may_emit(const Graph *graph, Node emission, Box box, Arena *scratch)
{
    if (graph->items[emission].time != TIME_POINT) {
        Fact fact = {0};
        for (uint32_t k = 0; k < 3; k++)
            fact.value[k] = graph_frame_range(graph, emission, k, scratch);
        return has_light(&fact);
    }
    RangeTask task = range_task(graph, &emission, 1, scratch);
    range_task_run(&task, box);
    return has_light(&task.facts[tape_index(&task.tape, emission)]);
}

/* ---- their parts ---- */

typedef struct Parts {
    EmissivePart *items;
    size_t        count, capacity;
} Parts;

/* Adds a shape, or what it is the union of.  Blends reach beyond the boxes of what they join. */
static void add_parts(Compilation *c, Parts *parts, EmissivePart part, const Shape *shape)
{
    const bool joins = shape->kind == SHAPE_UNION && shape->blend.width == NODE_NONE;
    if (joins || shape->kind == SHAPE_PAINT)
        for (uint32_t i = 0; i < shape->child_count; i++)
            add_parts(c, parts, part, shape->children[i]);
    part.box = shape->box;
    if (!joins && shape->kind != SHAPE_PAINT && !box_is_empty(part.box))
        array_push(&c->scratch, parts, part);
}

static void add_component(Compilation *c, Parts *parts, size_t number)
{
    KrsScene        *scene     = c->scene;
    const Component *component = &c->elaborated.components.items[number];
    const Node      *roots     = surface_roots(&scene->roots, number);
    EmissivePart     part    = {.distance = roots[ROOT_DISTANCE], .emission = roots[ROOT_emission]};
    const Node       nodes[] = {part.distance, part.emission};
    if (!may_emit(scene->graph, part.emission, component->shape->box, &c->scratch))
        return;
    Tape *tape = arena_new(&scene->arena, Tape);
    *tape      = tape_new(scene->graph, nodes, 2, &scene->arena);
    part.tape  = tape;
    for (size_t i = component->first; i != NO_COMPONENT; i = c->elaborated.shown.items[i].next)
        add_parts(c, parts, part, c->elaborated.shown.items[i].shape);
}

/* ---- their order ---- */

static int compare_places(const void *a, const void *b)
{
    const EmissivePart *x = a, *y = b;
    if (x->place != y->place)
        return x->place < y->place ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

static double find_middle(Range side)
{
    const double middle = 0.5 * side.low + 0.5 * side.high;
    return isfinite(middle) ? middle : 0;
}

/* Returns the axis along which the middles of boxes are farthest apart. */
static int find_axis(const EmissivePart *parts, size_t count)
{
    double widest = -1;
    int    axis   = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (size_t i = 0; i < count; i++) {
            low  = fmin(low, find_middle(parts[i].box.axis[k]));
            high = fmax(high, find_middle(parts[i].box.axis[k]));
        }
        axis   = high - low > widest ? k : axis;
        widest = fmax(widest, high - low);
    }
    return axis;
}

static void sort_by_places(EmissivePart *parts, size_t count)
{
    if (count < 2)
        return;
    const int axis = find_axis(parts, count);
    for (size_t i = 0; i < count; i++) {
        parts[i].place  = find_middle(parts[i].box.axis[axis]);
        parts[i].number = i;
    }
    qsort(parts, count, sizeof *parts, compare_places);
    sort_by_places(parts, count / 2);
    sort_by_places(parts + count / 2, count - count / 2);
}

/* ---- all of them ---- */

void retain_emissive(Compilation *c)
{
    KrsScene *scene = c->scene;
    Parts     parts = {0};
    for (size_t i = 0; i < scene->component_count; i++)
        add_component(c, &parts, i);
    sort_by_places(parts.items, parts.count);
    scene->emissive       = arena_new_array(&scene->arena, EmissivePart, parts.count + 1);
    scene->emissive_count = parts.count;
    for (size_t i = 0; i < parts.count; i++)
        scene->emissive[i] = parts.items[i];
}
