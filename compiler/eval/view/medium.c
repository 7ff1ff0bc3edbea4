/*
 * medium.c: media: smoke, mist and milk, which fill a shape and scatter light.
 */
#include "compiler/eval/view/view.h"

#include <math.h>

#include "compiler/base/splitmix.h"
#include "compiler/graph/bounds/facts.h"
#include "compiler/lower/lower.h"

typedef struct Row {
    const char *name;
    GraphType   type;
    double      otherwise, low, high;
} Row;

/* ---- values ---- */

static Node ask_row(Elaboration *e, const Environment *env, const Syntax *block, const Row *row)
{
    const Syntax *syntax = find_property(block, row->name);
    const double  same[] = {row->otherwise, row->otherwise, row->otherwise};
    Node          usual  = graph_constant(e->graph, row->type, same);
    if (!syntax)
        return usual;
    Value value = evaluate(e, env, syntax);
    Node  node  = value_node(e, value);
    if (node != NODE_NONE && row->type == TYPE_VEC3 && e->graph->items[node].type == TYPE_FLOAT)
        node = graph_op3(e->graph, OP_vec3, node, node, node);
    if (node != NODE_NONE && e->graph->items[node].type == row->type)
        return node;
    type_error(e, syntax, value, row->type == TYPE_VEC3 ? "a colour" : "a number");
    return usual;
}

/* ---- what is refused ---- */

static void refuse_value(Elaboration *e, const Syntax *syntax, const Row *row, double value,
                         const double *point)
{
    Diag *diag;
    if (isinf(row->high))
        diag = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span,
                        "`%s` of a medium must not be negative", row->name);
    else
        diag = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span,
                        "`%s` of a medium must be from %g to %g", row->name, row->low, row->high);
    diag->label = point ? diag_text(e->diags, "this is %.3g at [%.3g, %.3g, %.3g]", value, point[0],
                                    point[1], point[2])
                        : diag_text(e->diags, "this can be %g", value);
    diag->help = isinf(row->high) ? diag_text(e->diags, "`max(..., 0)` leaves out what is negative")
                                  : diag_text(e->diags, "`clamp(..., %g, %g)` keeps it there",
                                              row->low, row->high);
}

/* Tells whether a range is outside of what a row permits: all of it, where `all` is set. */
static bool is_outside(const Row *row, Range range, bool all, double *value)
{
    const double low = all ? range.high : range.low, high = all ? range.low : range.high;
    *value = low < row->low ? low : high;
    return low < row->low || high > row->high;
}

/* A medium whose properties are looked at. */
typedef struct Looking {
    Elaboration  *e;
    const Syntax *block;
    Box           box;
    Node          distance; /* of its shape; NODE_NONE: it is too large to be looked at */
} Looking;

/* Looks for a point in the shape where a property is not what it may be, whatever the parameters are: there all
   that interval arithmetic finds for the point is outside. */
static void check_points(const Looking *l, const Syntax *syntax, const Row *row, Node node)
{
    enum { POINTS = 2048 };
    Elaboration   *e       = l->e;
    const Node     roots[] = {node, l->distance};
    const uint32_t width   = row->type == TYPE_VEC3 ? 3 : 1;
    RangeTask      task    = range_task(e->graph, roots, 2, e->scratch);
    uint64_t       seed    = 1;
    bool           found   = false;
    for (int i = 0; i < POINTS && !found; i++) {
        double point[3], value = 0;
        Box    here;
        for (int k = 0; k < 3; k++) {
            const Range side = l->box.axis[k];
            point[k]         = side.low + splitmix_unit(&seed) * (side.high - side.low);
            here.axis[k]     = range_of(point[k]);
        }
        range_task_run(&task, here);
        const bool  inside = range_task_value(&task, l->distance).high < 0;
        const Fact *fact   = &task.facts[tape_index(&task.tape, node)];
        for (uint32_t k = 0; inside && k < width && !found; k++)
            found = is_outside(row, fact->value[k], true, &value);
        if (found)
            refuse_value(e, syntax, row, value, point);
    }
    arena_clear(e->scratch);
}

static void check_row(const Looking *l, const Row *row, Node node)
{
    const Syntax *syntax = find_property(l->block, row->name);
    double        value;
    if (!syntax)
        return;
    if (l->e->graph->items[node].time == TIME_POINT) {
        if (l->distance != NODE_NONE)
            check_points(l, syntax, row, node);
        return;
    }
    for (uint32_t k = 0; k < (row->type == TYPE_VEC3 ? 3u : 1u); k++)
        if (is_outside(row, node_range(l->e->builder, node, k), false, &value) && isfinite(value)) {
            refuse_value(l->e, syntax, row, value, NULL);
            return;
        }
}

/* Returns the shape that a medium is in; NULL, and it is reported. */
static const Shape *find_within(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Syntax *within = find_property(syntax, "within");
    Diag         *diag;
    if (!within) {
        diag       = diag_add(e->diags, DIAG_MISSING_ARGUMENT, syntax->span,
                              "a medium has no bounds without `within`");
        diag->help = "for example `medium { within: box([4, 2, 4]), density: 0.5 }`; the air of a "
                     "scene is a box around all of it";
        return NULL;
    }
    Value value = evaluate(e, env, within);
    if (value.type != VALUE_SHAPE) {
        type_error(e, within, value, "a shape");
        return NULL;
    }
    const bool thin = has_thin_open_surfaces(value.shape);
    if (box_is_finite(value.shape->box) && !thin)
        return value.shape;
    diag        = diag_add(e->diags, DIAG_BAD_VALUE, within->span,
                    thin ? "a medium cannot be within a surface without an inside"
                                : "a medium must be within a bounded shape");
    diag->label = thin ? "open" : box_is_empty(value.shape->box) ? "empty" : "endless";
    diag->help  = thin ? "a closed solid has an inside: `.shell(0.1)` makes one of a surface"
                       : "cut it, as in `half_space([0, 1, 0], 0).within(box([20, 10, 20]))`";
    return NULL;
}

/* ---- media ---- */

void elaborate_medium(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Syntax *density = find_property(syntax, "density");
    SceneVolume   volume  = {.before = e->scene->components.count,
                             .span   = density ? density->span : syntax->span};
    volume.within         = find_within(e, env, syntax);
    if (!volume.within)
        return;
    if (e->scene->volumes.count == MAX_VOLUMES) {
        Diag *diag = diag_add(e->diags, DIAG_LIMIT, syntax->span, "a scene has at most %d media",
                              MAX_VOLUMES);
        diag->help = "one medium may fill the union of many shapes: `within: union([...])`";
        return;
    }
    Looking looking = {e, syntax, volume.within->box, NODE_NONE};
    if (!lower_solid(e->graph, volume.within, NULL, e->scratch, &looking.distance))
        looking.distance = NODE_NONE;
    arena_clear(e->scratch);
#define KRS_MEDIUM(name, type, otherwise, low, high)                    \
    {                                                                   \
        const Row row     = {#name, TYPE_##type, otherwise, low, high}; \
        volume.nodes.name = ask_row(e, env, syntax, &row);              \
        check_row(&looking, &row, volume.nodes.name);                   \
    }
#include "compiler/shape/medium.def"
    array_push(e->arena, &e->scene->volumes, volume);
}
