/*
 * paint.c: what changes how a shape looks, not where it is: materials, and smooth mirrors.
 */
#include "compiler/family/family.h"

#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/bump.h"
#include "compiler/lower/footprint.h"
#include "compiler/lower/normal.h"
#include "compiler/lower/tangent.h"

/* ---- how it is made ---- */

const Shape *make_smooth(ShapeBuilder *builder, const Shape *shape, Node width, Span span)
{
    Shape *smooth     = shape_around(builder, SHAPE_SMOOTH, "smooth_mirrors", shape, span);
    smooth->values[0] = width;
    smooth->smooth    = true;
    return smooth;
}

/* Makes a tape of all that a material computes, its colour first. */
static Tape material_tape(const Graph *graph, const Material *material, Arena *arena)
{
    const Node all[] = {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) material->name,
#include "krs/surface.def"
        material->bump,
    };
    Node   roots[sizeof all / sizeof *all];
    size_t count = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i] != NODE_NONE)
            roots[count++] = all[i];
    return tape_new(graph, roots, count, arena);
}

/* Tells whether a material uses `u` or `v` (OP_UV), or `orbit_trap` (OP_TRAP). */
static bool material_needs(ShapeBuilder *builder, const Material *material, Op leaf)
{
    bool needed = false;
    Tape tape   = material_tape(builder->graph, material, builder->scratch);
    for (size_t i = 0; i < tape.count; i++)
        needed = needed || builder->graph->items[tape.nodes[i]].op == leaf;
    arena_clear(builder->scratch);
    return needed;
}

/* Tells whether a material has highlights whose length depends on a direction. */
static bool is_anisotropic(const Graph *graph, const Material *material)
{
    const Node roughness = material->specular_roughness_anisotropy;
    return roughness != NODE_NONE && !is_number(graph, roughness, 0);
}

static bool has_tangent(const Graph *graph, const Material *material)
{
    return material->tangent == NODE_NONE || !is_number(graph, material->tangent, 0);
}

const Shape *make_paint(ShapeBuilder *builder, const Shape *shape, const Material *material,
                        Span span)
{
    if (!shape->trapped && material_needs(builder, material, OP_TRAP)) {
        Diag *diag  = diag_add(builder->diags, DIAG_OUT_OF_PLACE, span,
                               "`orbit_trap` has no meaning on `%s`", shape->name);
        diag->label = "this needs a fractal or a sequence";
        diag->help  = "`julia` and `mandelbulb` are fractals, `krs` blocks with mirrors sequences";
        diag_secondary(builder->diags, diag, shape->span, "none in this shape");
        return NULL;
    }
    const bool by_u = is_anisotropic(builder->graph, material) &&
                      !has_tangent(builder->graph, material);
    if (shape->without_uv && (by_u || material_needs(builder, material, OP_UV))) {
        const Shape *without = shape->without_uv;
        Diag        *diag    = diag_add(builder->diags, DIAG_OUT_OF_PLACE, span,
                                        "`u` and `v` have no meaning on `%s`", without->name);
        diag->label          = "this material needs them";
        diag_secondary(builder->diags, diag, without->span, "declared without `uv`");
        diag->help = by_u ? "it is anisotropic along `u`: give the material a `tangent`"
                          : "give the declaration of the shape a `uv: [...]`";
        return NULL;
    }
    Shape *painted    = shape_around(builder, SHAPE_PAINT, "paint", shape, span);
    painted->material = material;
    painted->fronts   = material_needs(builder, material, OP_FRONT);
    painted->smooth   = painted->smooth || material->bump != NODE_NONE;
    return painted;
}

/* ---- how it is lowered ---- */

/* Paints with the properties that a material has; the others stay. */
static void paint_with(Lowering *l, Node *property, Node paint, Substitution with)
{
    if (paint == NODE_NONE)
        return;
    Node painted = graph_substitute(l->graph, paint, with, l->scratch);
    *property    = lower_footprints(l->graph, painted, l->scratch);
}

/* Sets the tangent: one that no material gives is that of `u`. */
static void paint_tangent(Lowering *l, const Material *material, Node point, Surface *surface)
{
    if (material->tangent == NODE_NONE)
        return;
    if (has_tangent(l->graph, material))
        surface->tangent = tangent_outwards(l->graph, surface->tangent, point, l->scratch);
    else if (is_anisotropic(l->graph, material) && surface->uv != NODE_NONE)
        surface->tangent = tangent_of_uv(l->graph, surface->uv, l->scratch);
}

/* Finds where a material reads the first of its textures.  What paints a colour without one hides
   that below. */
static void paint_place(Lowering *l, const Material *material, Substitution with, Surface *surface)
{
    Tape tape = material_tape(l->graph, material, l->scratch);
    if (material->color != NODE_NONE)
        surface->place = NODE_NONE;
    for (size_t i = 0; i < tape.count; i++) {
        const Expr *e = &l->graph->items[tape.nodes[i]];
        if (e->op != OP_texture && e->op != OP_texture_gray)
            continue;
        paint_with(l, &surface->place, e->operands[0], with);
        return;
    }
}

/* The outermost paint counts, as the last method of a chain does. */
Lowered lower_paint(Lowering *l, const Shape *shape, LowerContext context)
{
    context.fronts = context.fronts || shape->fronts;
    Lowered result = lower_shape(l, shape->children[0], context);
    if (!l->surfaces || result.distance == NODE_NONE)
        return result;
    Substitution with = {
        context.point, result.surface.instance, result.surface.level, result.surface.uv,
        NODE_NONE,     result.surface.trap,     result.surface.front};
    const Material *material = shape->material;
    with.normal              = unit_normal(l->graph, result.surface.normal, context.normal);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    paint_with(l, &result.surface.name, material->name, with);
#include "krs/surface.def"
    paint_tangent(l, material, context.point, &result.surface);
    if (l->places)
        paint_place(l, material, with, &result.surface);
    Node height = NODE_NONE;
    paint_with(l, &height, material->bump, with);
    if (height != NODE_NONE)
        result.surface.normal = bumped_normal(l->graph, height, context.point, with.normal,
                                              l->scratch);
    if (material->number > 0)
        result.surface.material = graph_uint(l->graph, material->number);
    return result;
}

/* The last of a chain counts, as with paint. */
Lowered lower_smooth_mirrors(Lowering *l, const Shape *shape, LowerContext context)
{
    if (l->surfaces && context.smoothing == NODE_NONE)
        context.smoothing = shape->values[0] != NODE_NONE
                                ? shape->values[0]
                                : graph_op2(l->graph, OP_add, context.footprint, context.footprint);
    return lower_shape(l, shape->children[0], context);
}
