/*
 * builder.c: shapes from shapes.  Each function states, for its kind, the box of the result and
 * how the slope follows from the children's (shape.h has the table, math.md section 4 the
 * proofs); lower.c states the distance.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>

#include "compiler/graph/derive.h"

#include "compiler/graph/evaluate.h"

const BlendInfo blend_info[BLEND_COUNT] = {
#define BLEND(name, spelling, op, slope, bulge, meaning) {spelling, OP_##op, slope, bulge},
#include "compiler/shape/blends.def"
#undef BLEND
};
const Blend blend_sharp = {.width = NODE_NONE, .steps = NODE_NONE};

Range node_range(Elaboration *e, Node node, uint32_t component)
{
    const Expr *expr = &e->graph->items[node];
    if (expr->op == OP_CONSTANT)
        return range_of(expr->number[component]);
    Range range = graph_frame_fact(e->graph, node, e->scratch).value[component];
    arena_free(e->scratch);
    return range;
}

bool shape_is_curved(const Shape *shape)
{
    switch (shape->kind) {
    case SHAPE_PRIMITIVE: return !shape->exact && shape->bound == NODE_NONE && !shape->claimed;
    case SHAPE_STRETCH:
    case SHAPE_MORPH:
    case SHAPE_META:
    case SHAPE_TWIST:
    case SHAPE_BEND:
    case SHAPE_TAPER:
    case SHAPE_DISPLACE: return true;
    default: return shape->blend.width != NODE_NONE || shape->levels > 0 || shape->curved_child;
    }
}

Shape *shape_new(Elaboration *e, ShapeKind kind, const char *name, Span span,
                 const Shape *const *children, uint32_t count)
{
    Shape *shape       = arena_new(e->arena, Shape);
    shape->kind        = kind;
    shape->name        = name;
    shape->span        = span;
    shape->children    = arena_new_array(e->arena, const Shape *, count + 1);
    shape->child_count = count;
    shape->box         = box_empty;
    shape->slope       = 1;
    shape->derived     = 1;
    shape->exact       = true;
    shape->blend       = blend_sharp;
    shape->distance = shape->bound = shape->uv = shape->trap = NODE_NONE;
    shape->formula = shape->declared = NODE_NONE;
    shape->plane_normal = shape->plane_offset = NODE_NONE;
    shape->values[0] = shape->values[1] = NODE_NONE;
    uint64_t tree_shapes                = 1;
    double   sequences = 0; /* instances of the sequences in the tree; any other shape counts one */
    for (uint32_t i = 0; i < count; i++) {
        const Shape *child  = children[i];
        shape->children[i]  = child;
        shape->slope        = fmax(shape->slope, child->slope);
        shape->derived      = fmax(shape->derived, child->derived);
        shape->exact        = shape->exact && child->exact;
        shape->curved_child = shape->curved_child || shape_is_curved(child);
        shape->estimate     = shape->estimate || child->estimate;
        shape->per_frame    = shape->per_frame || child->per_frame;
        shape->trapped      = shape->trapped || child->trapped;
        shape->figure       = shape->figure || child->figure;
        shape->fields       = shape->fields || child->fields;
        shape->sheets       = shape->sheets || child->sheets;
        shape->smooth       = shape->smooth || child->smooth;
        shape->without_uv   = shape->without_uv ? shape->without_uv : child->without_uv;
        sequences += child->levels > 0 ? child->instances : 0;
        shape->depth = child->depth >= shape->depth ? child->depth + 1 : shape->depth;
        tree_shapes += child->tree_shapes;
        shape->levels = child->levels > shape->levels ? child->levels : shape->levels;
        if (child->inversions > shape->inversions)
            shape->inversions = child->inversions;
    }
    shape->instances = sequences > 0 ? sequences : kind != SHAPE_EMPTY;
    if (count == 1)
        shape->box = children[0]->box;
    shape->tree_shapes = tree_shapes < UINT32_MAX ? (uint32_t)tree_shapes : UINT32_MAX;
    if ((shape->depth > MOST_SHAPE_DEPTH || tree_shapes > MOST_TREE_SHAPES) && !e->stopped) {
        diag_add(e->diags, DIAG_LIMIT, span,
                 tree_shapes > MOST_TREE_SHAPES
                     ? "a shape of more than 100,000 parts, each counted where it is used"
                     : "shapes are nested more than 1,000 deep");
        e->stopped = true;
    }
    return shape;
}

static Shape *wrap(Elaboration *e, ShapeKind kind, const char *name, const Shape *shape, Span span)
{
    return shape_new(e, kind, name, span, &shape, 1);
}

const Shape *make_empty(Elaboration *e, Span span)
{
    return shape_new(e, SHAPE_EMPTY, "nothing", span, NULL, 0);
}

bool check_invertible(Elaboration *e, const Shape *shape, Span span)
{
    if (box_is_finite(shape->box) || box_is_empty(shape->box))
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_ENDLESS_INVERTED, span,
                           "something endless cannot be inverted");
    diag->label = "an inversion";
    diag->help  = "cut it first, with `.within(sphere(10))`, say";
    diag_secondary(e->diags, diag, shape->span, "this is endless");
    return false;
}

static const Shape *make_inversion(Elaboration *e, const Shape *shape, const Map *map, Span span)
{
    if (!check_invertible(e, shape, span))
        return NULL;
    Shape   *inverted = wrap(e, SHAPE_INVERSION, "transform", shape, span);
    MapRange range    = map_range(e, map);
    Cover    cover    = {0};
    cover_add(e->arena, &cover, shape->box);
    cover_map(&cover, &range);
    inverted->map   = *map;
    inverted->exact = false;
    inverted->inversions++;
    inverted->box = cover_box(&cover);
    return inverted;
}

/* By a map without `first`. */
static const Shape *transform_by(Elaboration *e, const Shape *shape, const Map *map, Span span)
{
    if (map->pole != NODE_NONE)
        return make_inversion(e, shape, map, span);
    Shape *moved = wrap(e, SHAPE_TRANSFORM, "transform", shape, span);
    moved->map   = *map;
    moved->box   = map_box(e, map, shape->box);
    return moved;
}

const Shape *make_transform(Elaboration *e, const Shape *shape, const Map *map, Span span)
{
    if (map->first)
        shape = make_transform(e, shape, map->first, span);
    if (!shape)
        return NULL;
    Map single   = *map;
    single.first = NULL;
    /* A chain of maps is one map, where it can be. */
    if (shape->kind == SHAPE_TRANSFORM || shape->kind == SHAPE_INVERSION) {
        const Map *product = map_product(e, &single, &shape->map);
        if (!product->first)
            return transform_by(e, shape->children[0], product, span);
    }
    return transform_by(e, shape, &single, span);
}

const Shape *make_stretch(Elaboration *e, const Shape *shape, Node factors, Span span)
{
    Shape *stretched     = wrap(e, SHAPE_STRETCH, "scale", shape, span);
    stretched->values[0] = factors;
    stretched->exact     = false;
    for (uint32_t i = 0; i < 3 && !box_is_empty(shape->box); i++)
        stretched->box.axis[i] = range_mul(shape->box.axis[i], node_range(e, factors, i));
    return stretched;
}

const Shape *make_joint(Elaboration *e, ShapeKind kind, const Shape *const *shapes, uint32_t count,
                        Blend blend, Span span)
{
    static const char *const names[] = {[SHAPE_UNION]        = "union",
                                        [SHAPE_INTERSECTION] = "intersection",
                                        [SHAPE_DIFFERENCE]   = "difference",
                                        [SHAPE_XOR]          = "xor"};
    Shape                   *joint   = shape_new(e, kind, names[kind], span, shapes, count);
    joint->blend                     = blend;
    if (blend.width != NODE_NONE)
        check_lipschitz(e, joint, "a blend", span);
    /* Outside, the least of exact distances is exact; every other joint only bounds it. */
    joint->exact = joint->exact && kind == SHAPE_UNION && blend.width == NODE_NONE;
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0)
            joint->box = shapes[0]->box;
        else if (kind == SHAPE_INTERSECTION)
            joint->box = box_common(joint->box, shapes[i]->box);
        else if (kind != SHAPE_DIFFERENCE)
            joint->box = box_hull(joint->box, shapes[i]->box);
    }
    if (blend.width != NODE_NONE && count > 1) {
        const BlendInfo *info = &blend_info[blend.kind];
        /* Each further operand adds a partial derivative; their squares sum to 1, so the sum of
           n of them is at most sqrt(n): for two operands the factor of the table. */
        joint->slope *= info->slope > 1 ? pow(info->slope, log2(count)) : 1;
        if (kind != SHAPE_INTERSECTION && kind != SHAPE_DIFFERENCE)
            joint->box = box_grow(joint->box,
                                  info->bulge * node_range(e, blend.width, 0).high * (count - 1));
    }
    return joint;
}

const Shape *make_morph(Elaboration *e, const Shape *a, const Shape *b, Node t, Span span)
{
    const Shape *children[] = {a, b};
    Shape       *morph      = shape_new(e, SHAPE_MORPH, "morph", span, children, 2);
    morph->values[0]        = t;
    check_lipschitz(e, morph, "`morph`", span);
    morph->exact = false;
    /* Where the mix is 0 one of the distances is at most 0, or both are. */
    morph->box = box_hull(a->box, b->box);
    return morph;
}

static Shape *new_offset(Elaboration *e, const Shape *shape, Node radius, Span span)
{
    Shape *offset     = wrap(e, SHAPE_OFFSET, "offset", shape, span);
    Range  range      = node_range(e, radius, 0);
    offset->values[0] = radius;
    offset->box       = box_grow(shape->box, fmax(range.high, 0));
    offset->exact     = shape->exact && range.low >= 0;
    check_lipschitz(e, offset, "an offset", span);
    return offset;
}

const Shape *make_offset(Elaboration *e, const Shape *shape, Node radius, Span span)
{
    return new_offset(e, shape, radius, span);
}

const Shape *make_rounded(Elaboration *e, const Shape *shape, const Shape *core, Node radius,
                          Span span)
{
    Shape *round   = new_offset(e, core, radius, span);
    round->rounded = shape;
    return round;
}

const Shape *make_shell(Elaboration *e, const Shape *shape, Node thickness, Span span)
{
    Shape *shell     = wrap(e, SHAPE_SHELL, "shell", shape, span);
    shell->values[0] = thickness;
    shell->box       = box_grow(shape->box, 0.5 * node_range(e, thickness, 0).high);
    check_lipschitz(e, shell, "a shell", span);
    return shell;
}

/* Whether normals follow from derivatives: differences see both sides of a sheet. */
static bool is_derivable(Elaboration *e, const Shape *shape)
{
    Node gradient, number = shape->formula != NODE_NONE ? shape->formula : shape->distance;
    if (shape->kind == SHAPE_PRIMITIVE &&
        graph_gradient(e->graph, number, &gradient, NULL, e->scratch) == DERIVED_NOT)
        return false;
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!is_derivable(e, shape->children[i]))
            return false;
    return true;
}

const Shape *make_sheet(Elaboration *e, const Shape *shape, Node thickness, Span span)
{
    Shape *sheet  = arena_new(e->arena, Shape);
    *sheet        = *make_shell(e, shape, thickness, span);
    sheet->name   = "sheet";
    sheet->sheet  = is_derivable(e, shape);
    sheet->sheets = sheet->sheets || sheet->sheet;
    return sheet;
}

const Shape *make_elongate(Elaboration *e, const Shape *shape, Node half, Span span)
{
    Shape *longer     = wrap(e, SHAPE_ELONGATE, "elongate", shape, span);
    longer->values[0] = half;
    Range sides[3];
    for (uint32_t i = 0; i < 3; i++) {
        double most = node_range(e, half, i).high;
        sides[i]    = (Range){-most, most};
    }
    longer->box = box_move(shape->box, sides);
    return longer;
}

const Shape *make_extrude(Elaboration *e, const Shape *figure, Node height, Span span)
{
    Graph *g           = e->graph;
    Shape *solid       = wrap(e, SHAPE_EXTRUDE, "extrude", figure, span);
    Node   half        = graph_number(g, 0.5);
    solid->values[0]   = graph_op2(g, OP_mul, height, half);
    double most        = node_range(e, solid->values[0], 0).high;
    solid->box.axis[2] = (Range){-most, most};
    solid->figure      = false;
    return solid;
}

const Shape *make_revolve(Elaboration *e, const Shape *figure, Node offset, Span span)
{
    Shape *solid     = wrap(e, SHAPE_REVOLVE, "revolve", figure, span);
    solid->values[0] = offset;
    solid->figure    = false;
    Range  x         = range_add(figure->box.axis[0], node_range(e, offset, 0));
    double most      = fmax(x.high, 0);
    /* What crosses the axis is cut by it: the distance inside the cut is only a bound. */
    solid->exact       = figure->exact && x.low >= 0;
    solid->box.axis[0] = solid->box.axis[2] = (Range){-most, most};
    return solid;
}

const Shape *make_repeat(Elaboration *e, const Shape *shape, Node period, const uint32_t cells[3],
                         const Syntax *origin)
{
    if (box_is_empty(shape->box))
        return shape;
    Shape *repeat     = wrap(e, SHAPE_REPEAT, "repeat", shape, origin->span);
    repeat->values[0] = period;
    repeat->exact     = false; /* walls of cells are bounds */
    for (uint32_t i = 0; i < 3; i++) {
        Range range      = node_range(e, period, i);
        bool  repeats    = cells[i] != 1 && range.high > 0;
        repeat->cells[i] = repeats ? cells[i] : 1;
        if (!repeats)
            continue;
        double margin = cell_margin(shape->box.axis[i], range.low);
        if (!(margin >= -1e-9 * range.low)) {
            Range is    = shape->box.axis[i];
            Diag *diag  = diag_add(e->diags, DIAG_OUTSIDE_CELL, origin->span,
                                   "the shape reaches from %.4g to %.4g on the %c axis, "
                                    "its cell from %.4g to %.4g",
                                   is.low, is.high, "xyz"[i], -0.5 * range.low, 0.5 * range.low);
            diag->label = "does not fit its cell";
            diag->help  = "use a larger period, or a smaller shape that is centred in its cell";
            return NULL;
        }
        double reach        = cells[i] ? 0.5 * (cells[i] - 1) * range.high : INFINITY;
        repeat->box.axis[i] = (Range){shape->box.axis[i].low - reach,
                                      shape->box.axis[i].high + reach};
    }
    return repeat;
}

const Shape *make_repeat_polar(Elaboration *e, const Shape *shape, uint32_t count,
                               const Syntax *origin)
{
    if (box_is_empty(shape->box))
        return shape;
    Shape *repeat    = wrap(e, SHAPE_REPEAT_POLAR, "repeat_polar", shape, origin->span);
    repeat->cells[0] = count;
    repeat->exact    = false;
    double most      = 0;
    for (int i = 0; i < 3; i += 2)
        most = hypot(most, fmax(fabs(shape->box.axis[i].low), fabs(shape->box.axis[i].high)));
    repeat->box.axis[0] = repeat->box.axis[2] = (Range){-most, most};
    return repeat;
}

const Shape *make_mirror(Elaboration *e, const Shape *shape, Node normal, Node offset, Span span)
{
    Shape *mirror     = wrap(e, SHAPE_MIRROR, "mirror", shape, span);
    mirror->values[0] = normal;
    mirror->values[1] = offset;
    mirror->exact     = false;
    Range u[3];
    for (uint32_t i = 0; i < 3; i++)
        u[i] = node_range(e, normal, i);
    mirror->box = box_fold(shape->box, u, node_range(e, offset, 0));
    return mirror;
}

const Shape *make_smooth(Elaboration *e, const Shape *shape, Node width, Span span)
{
    Shape *smooth     = wrap(e, SHAPE_SMOOTH, "smooth_mirrors", shape, span);
    smooth->values[0] = width;
    smooth->smooth    = true;
    return smooth;
}

/* Whether a material uses `u` or `v` (OP_UV), or `orbit_trap` (OP_TRAP). */
static bool material_needs(Elaboration *e, const Material *material, Op leaf)
{
    Node   all[] = {material->color, material->roughness, material->metallic, material->emission};
    Node   roots[sizeof all / sizeof *all];
    size_t count = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i] != NODE_NONE)
            roots[count++] = all[i];
    bool needed = false;
    Tape tape   = tape_new(e->graph, roots, count, e->scratch);
    for (size_t i = 0; i < tape.count; i++)
        needed = needed || e->graph->items[tape.nodes[i]].op == leaf;
    arena_free(e->scratch);
    return needed;
}

const Shape *make_paint(Elaboration *e, const Shape *shape, const Material *material, Span span)
{
    if (!shape->trapped && material_needs(e, material, OP_TRAP)) {
        Diag *diag  = diag_add(e->diags, DIAG_OUT_OF_PLACE, span,
                               "`orbit_trap` has no meaning on `%s`", shape->name);
        diag->label = "this needs a fractal";
        diag->help  = "`julia` and `mandelbulb` are fractals";
        diag_secondary(e->diags, diag, shape->span, "none in this shape");
        return NULL;
    }
    if (shape->without_uv && material_needs(e, material, OP_UV)) {
        const Shape *without = shape->without_uv;
        Diag        *diag    = diag_add(e->diags, DIAG_OUT_OF_PLACE, span,
                                        "`u` and `v` have no meaning on `%s`", without->name);
        diag->label          = "this material needs them";
        diag_secondary(e->diags, diag, without->span, "declared without `uv`");
        diag->help = "give the declaration of the shape a `uv: [...]`";
        return NULL;
    }
    Shape *painted    = wrap(e, SHAPE_PAINT, "paint", shape, span);
    painted->material = material;
    return painted;
}

/* ---- planes ---- */

bool shape_plane(Elaboration *e, const Shape *shape, Node *normal, Node *offset)
{
    Graph *g = e->graph;
    if (shape->kind == SHAPE_PAINT)
        return shape_plane(e, shape->children[0], normal, offset);
    if (shape->kind == SHAPE_PRIMITIVE && shape->plane_normal != NODE_NONE) {
        Node size = graph_op1(g, OP_length, shape->plane_normal);
        *normal   = graph_op1(g, OP_normalize, shape->plane_normal);
        *offset   = graph_op2(g, OP_div, shape->plane_offset, size);
        return true;
    }
    if (shape->kind != SHAPE_TRANSFORM || !shape_plane(e, shape->children[0], normal, offset))
        return false;
    /* n.x <= w becomes (R n).y <= s w + (R n).t for y = s R x + t. */
    *normal      = map_turn(e, &shape->map, *normal);
    Node scaled  = graph_op2(g, OP_mul, *offset, shape->map.scale);
    Node shifted = graph_op2(g, OP_dot, *normal, shape->map.shift);
    *offset      = graph_op2(g, OP_add, scaled, shifted);
    return true;
}
