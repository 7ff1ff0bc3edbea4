/*
 * builder.c: what all kinds of shapes have in common when they are made.
 */
#include "compiler/shape/builder.h"

#include <assert.h>
#include <math.h>

#include "compiler/graph/evaluate.h"

Range node_range(ShapeBuilder *builder, Node node, uint32_t component)
{
    double number;
    if (graph_known_component(builder->graph, node, component, &number))
        return range_of(number);
    Range range = graph_frame_range(builder->graph, node, component, builder->scratch);
    arena_clear(builder->scratch);
    return range;
}

static Range range_in_frames(const BoxNumbers *numbers, Node node, uint32_t component)
{
    return node_range(((const BuilderNumbers *)numbers)->builder, node, component);
}

BuilderNumbers builder_numbers(ShapeBuilder *builder)
{
    return (BuilderNumbers){{range_in_frames}, builder};
}

Box builder_box(ShapeBuilder *builder, const Shape *shape)
{
    const BuilderNumbers all = builder_numbers(builder);
    return shape_box(&(BoxInput){&all.numbers, shape, NULL, 0});
}

/* ---- kinds ---- */

static bool curved_always(const Shape *shape)
{
    (void)shape;
    return true;
}

static bool curved_primitive(const Shape *shape)
{
    return !shape->exact && shape->bound == NODE_NONE && !shape->claimed;
}

static bool curved_by_parts(const Shape *shape)
{
    return shape->blend.width != NODE_NONE || shape->levels > 0 || shape->curved_child;
}

const ShapeInfo shape_info[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, rays, step, image, restrict, \
              rule)                                                                              \
    {#name, rule, parts, divided, own, LEAVES_##leaves, curved_##curved},
#include "compiler/shape/shapes.def"
};

bool shape_is_curved(const Shape *shape) { return shape_info[shape->kind].curved(shape); }

/* ---- shapes ---- */

/* Takes over what a shape has from each of its parts, whatever its kind. */
static void take_over(Shape *shape, const Shape *part)
{
    shape->slope         = fmax(shape->slope, part->slope);
    shape->derived       = fmax(shape->derived, part->derived);
    shape->exact         = shape->exact && part->exact;
    shape->curved_child  = shape->curved_child || shape_is_curved(part);
    shape->estimate      = shape->estimate || part->estimate;
    shape->per_frame     = shape->per_frame || part->per_frame;
    shape->trapped       = shape->trapped || part->trapped;
    shape->figure        = shape->figure || part->figure;
    shape->nothing       = shape->nothing && part->nothing;
    shape->fields        = shape->fields || part->fields;
    shape->open_surfaces = shape->open_surfaces || part->open_surfaces;
    shape->smooth        = shape->smooth || part->smooth;
    shape->without_uv    = shape->without_uv ? shape->without_uv : part->without_uv;
    shape->depth         = part->depth >= shape->depth ? part->depth + 1 : shape->depth;
    shape->levels        = part->levels > shape->levels ? part->levels : shape->levels;
    shape->inversions = part->inversions > shape->inversions ? part->inversions : shape->inversions;
}

/* Counts what is in the tree, and reports a tree that is too large to be walked through. */
static void count_tree(ShapeBuilder *builder, Shape *shape)
{
    uint64_t tree_shapes = 1;
    double   sequences = 0; /* instances of the sequences in the tree; any other shape counts one */
    for (uint32_t i = 0; i < shape->child_count; i++) {
        const Shape *part = shape->children[i];
        tree_shapes += part->tree_shapes;
        sequences += part->levels > 0 ? part->instances : 0;
    }
    shape->instances   = sequences > 0 ? sequences : shape->kind != SHAPE_EMPTY;
    shape->tree_shapes = tree_shapes < UINT32_MAX ? (uint32_t)tree_shapes : UINT32_MAX;
    if ((shape->depth > MAX_SHAPE_DEPTH || tree_shapes > MAX_TREE_SHAPES) && !builder->stopped) {
        diag_add(builder->diags, DIAG_LIMIT, shape->span,
                 tree_shapes > MAX_TREE_SHAPES
                     ? "a shape of more than 4 million parts, each counted where it is used"
                     : "shapes are nested more than 1,000 deep");
        builder->stopped = true;
    }
}

static const Shape     *no_parts[1];
static const FieldFacts nothing_known = {.degree = 0};

Shape *shape_new(ShapeBuilder *builder, ShapeKind kind, const char *name, Span span,
                 const Shape *const *children, uint32_t count)
{
    assert(shape_info[kind].parts == SEVERAL || (uint32_t)shape_info[kind].parts == count);
    Shape *shape    = arena_new(builder->arena, Shape);
    shape->kind     = kind;
    shape->name     = name;
    shape->span     = span;
    shape->children = count > 0 ? arena_new_array(builder->arena, const Shape *, count) : no_parts;
    shape->child_count = count;
    shape->box         = count == 1 ? children[0]->box : box_empty;
    shape->slope       = 1;
    shape->derived     = 1;
    shape->exact       = true;
    shape->nothing     = count > 0 || kind == SHAPE_EMPTY || kind == SHAPE_UNION;
    shape->blend       = blend_sharp;
    shape->field       = &nothing_known;
    shape->distance = shape->bound = shape->uv = shape->trap = NODE_NONE;
    shape->formula = shape->declared = shape->corners[0] = shape->corners[1] = NODE_NONE;
    shape->plane_normal = shape->plane_offset = shape->ball_radius = NODE_NONE;
    shape->values[0] = shape->values[1] = shape->map.scale = shape->iteration = NODE_NONE;
    for (uint32_t i = 0; i < count; i++) {
        shape->children[i] = children[i];
        take_over(shape, children[i]);
    }
    count_tree(builder, shape);
    builder->nodes_before = builder->graph->count;
    return shape;
}

void shape_takes_over(Shape *shape, const Shape *part)
{
    take_over(shape, part);
    shape->instances = part->instances;
}

FieldFacts *own_field_facts(ShapeBuilder *builder, Shape *shape)
{
    FieldFacts *own = arena_new(builder->arena, FieldFacts);
    *own            = *shape->field;
    shape->field    = own;
    return own;
}

Shape *shape_around(ShapeBuilder *builder, ShapeKind kind, const char *name, const Shape *shape,
                    Span span)
{
    return shape_new(builder, kind, name, span, &shape, 1);
}

const Shape *shape_named(ShapeBuilder *builder, const Shape *shape, const char *given)
{
    if (!shape || shape->given || !given)
        return shape;
    Shape *named = arena_new(builder->arena, Shape);
    *named       = *shape;
    named->given = given;
    return named;
}

static const Shape *find_estimate(const Shape *shape)
{
    while (shape->child_count > 0) {
        uint32_t i = 0;
        while (i + 1 < shape->child_count && !shape->children[i]->estimate)
            i++;
        shape = shape->children[i];
    }
    return shape;
}

Box builder_region(const ShapeBuilder *builder, Box box)
{
    static const double ROOM = 0.25; /* of the longest side: cells are large in the beginning */
    if (!builder->for_meshes || !box_is_finite(box) || box_is_empty(box))
        return box;
    const Range *longest = &box.axis[box_longest_axis(&box)];
    return box_grow(box, ROOM * (longest->high - longest->low));
}

void check_lipschitz(ShapeBuilder *builder, const Shape *shape, const char *what, Span span)
{
    if (!shape->estimate)
        return;
    const Shape *source = find_estimate(shape);
    Diag        *diag   = diag_add(builder->diags, DIAG_ESTIMATE, span,
                                   "%s needs a distance whose slope is known", what);
    diag->label         = diag_text(builder->diags, "that of `%s` is an estimate", source->name);
    diag_secondary(builder->diags, diag, source->span, "nothing is proven of this distance");
    diag->help = "join it with `|`, `&` or `-`, which work with estimates, too";
}

bool require_direction(ShapeBuilder *builder, Node vector, Span span, const char *what)
{
    for (uint32_t i = 0; i < 3; i++) {
        Range range = node_range(builder, vector, i);
        if (range.low != 0 || range.high != 0)
            return true;
    }
    Diag *diag  = diag_add(builder->diags, DIAG_BAD_VALUE, span, "%s cannot be the zero vector",
                           what);
    diag->label = "no direction";
    return false;
}

bool require_positive(ShapeBuilder *builder, Node number, Span span, const char *what)
{
    Range range = node_range(builder, number, 0);
    if (range.low > 0)
        return true;
    Diag *diag  = diag_add(builder->diags, DIAG_BAD_VALUE, span, "%s must be greater than 0", what);
    diag->label = range.low == range.high ? diag_text(builder->diags, "this is %g", range.low)
                                          : diag_text(builder->diags, "this can be %g", range.low);
    if (range.low != range.high)
        diag->help = "give the `param` a range that keeps it positive, or use `max(..., 0.001)`";
    return false;
}
