/*
 * distances.c: krs_distance, what zones cut out of distances, and krs_gradient.
 */
#include "compiler/base/far.h"
#include "compiler/print/emitter.h"

/* ---- zones ---- */

Node emit_zone(const Emitter *e)
{
    const Module *m = e->module;
    return m->zone != NODE_NONE && e->variant->camera_relative
               ? m->camera_relative[m->components * ROOT_COUNT + 2]
               : m->zone;
}

/* Emits krs_zone_depth, the depth of p in the zones of the scene; and krs_cut, which keeps a distance from
   being below that depth and the one in zones of the caller. */
void emit_zones(Emitter *e)
{
    const Node zone = emit_zone(e);
    if (!e->cuts)
        return;
    if (zone != NODE_NONE) {
        text_add(e->out, "// How deep p is in the zones of the scene, where nothing is.\n");
        emit_zone_depth_head(e);
        emit_body(e, &zone, 1);
        emit_line(e, "    return %s;\n}\n\n", e->text[zone]);
    }
    text_add(e->out, "// The distance where zones have been cut out.\n");
    emit_template(e, TEMPLATE_CUT, (Operands){0});
    if (zone != NODE_NONE)
        text_add(e->out, "    d = max(d, krs_zone_depth(p));\n");
    if (e->variant->zones > 0)
        emit_template(e, e->variant->camera_relative ? TEMPLATE_CUT_NEAR_ZONES : TEMPLATE_CUT_ZONES,
                      (Operands){emit_count(e, e->variant->zones)});
    text_add(e->out, "    return d;\n}\n\n");
}

const char *emit_cut(Emitter *e, const char *distance)
{
    Text text = {.arena = e->scratch};
    text_format(&text, e->cuts ? "krs_cut(p, %s)" : "%s", distance);
    return text.bytes;
}

/* ---- distances ---- */

void need_distance(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_DISTANCE][i] |= !emit_leaves_out(e, i);
}

void emit_distance_of(Emitter *e, const ModuleFunction *function)
{
    NodeList shared = {0};
    if (emit_find_shared(e, function->component, &shared) && shared.count > 0) {
        emit_shared_distance(e, function, &shared);
        return;
    }
    emit_head_of(e, OF_DISTANCE, function->component);
    emit_body(e, function->roots, 1);
    emit_line(e, "    return %s;\n}\n\n", e->text[*function->roots]);
}

static FunctionKind kind_of_distance(const Emitter *e, uint32_t component)
{
    (void)e;
    (void)component;
    return OF_DISTANCE;
}

/* Emits the least distance, which begins with the first component where none is left out. */
void emit_distance(Emitter *e)
{
    bool some = e->variant->march_group > 0 || (e->variant->planes && e->module->is_plane) ||
                (e->variant->glass && e->module->is_medium);
    uint32_t count = (uint32_t)e->module->components, first = !some && count > 0;
    emit_variable(e, TYPE_FLOAT, "d", first ? emit_call_of(e, OF_DISTANCE, 0) : NOWHERE_TEXT);
    for (uint32_t i = first; i < count; i++)
        if (!emit_leaves_out(e, i) && !emit_is_medium(e, i))
            text_format(e->out, "    d = min(d, %s);\n", emit_call_of(e, OF_DISTANCE, i));
    emit_media_steps(e, kind_of_distance, "d");
}

/* ---- gradients ---- */

bool emit_has_gradient(const Emitter *e, uint32_t component)
{
    return e->graph->items[e->module->gradients[2 * component]].type == TYPE_VEC3;
}

/* Tells whether the gradient needs a component: planes that rays know have gradients as well. */
static bool is_of_group(const Emitter *e, uint32_t component)
{
    return e->variant->march_group == 0 || emit_is_of_group(e, component);
}

void need_gradient(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++) {
        if (!is_of_group(e, i))
            continue;
        e->needed_of[OF_GRADIENT][i] = true;
        e->needed_of[OF_DISTANCE][i] |= !emit_has_gradient(e, i);
    }
}

bool emit_wants_gradient(const Emitter *e)
{
    return e->wanted[KRS_FUNCTION_GRADIENT] || e->wanted[KRS_FUNCTION_TANGENT];
}

/* Tells whether the distance to the gradient's plane may overflow: that of a polynomial, which is not the
   distance itself. */
static bool may_overflow(const Emitter *e, uint32_t component)
{
    return e->wanted[KRS_FUNCTION_TANGENT] && e->needed_of[OF_GRADIENT][component] &&
           emit_has_gradient(e, component) &&
           e->module->gradients[2 * component + 1] != emit_root(e, OF_DISTANCE, component);
}

bool emit_keeps_plane(const Emitter *e, uint32_t component)
{
    return may_overflow(e, component) && box_is_finite(e->module->boxes[component]);
}

/* Tells whether the safe distance takes the place of the plane's, as without a box. */
static bool has_safe_distance(const Emitter *e, uint32_t component)
{
    return may_overflow(e, component) && !emit_keeps_plane(e, component);
}

void need_tangent(Emitter *e)
{
    need_gradient(e);
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_DISTANCE][i] |= has_safe_distance(e, i);
}

/* Returns four numbers: a gradient, and the distance. */
static const char *with_distance(Emitter *e, const char *gradient, const char *distance)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s(%s, %s)", e->printer->types[TYPE_VEC4], gradient, distance);
    return text.bytes;
}

/* Emits the distance to the plane, or to the box around the component where that is larger, or
   where the other is not a number. */
static const char *emit_kept_distance(Emitter *e, uint32_t component, const char *distance)
{
    emit_variable(e, TYPE_FLOAT, "tangent", distance);
    emit_local(e, TYPE_FLOAT, "outside", emit_box_distance(e, component));
    emit_template(e, TEMPLATE_SET_IF,
                  (Operands){"outside > 0.0 && !(tangent > outside)", "tangent", "outside"});
    return "tangent";
}

/* Emits the gradient of one component, and its distance. */
void emit_gradient_of(Emitter *e, const ModuleFunction *function)
{
    const Node *roots = function->roots;
    if (!emit_has_gradient(e, function->component)) {
        emit_helper_of(e, "krs_gradient_N", function->component);
        return;
    }
    const uint32_t component = function->component;
    const bool     is_safe   = has_safe_distance(e, component);
    emit_head_of(e, OF_GRADIENT, component);
    emit_body(e, roots, is_safe ? 1 : 2);
    const char *distance = is_safe ? emit_call_of(e, OF_DISTANCE, component) : e->text[roots[1]];
    if (emit_keeps_plane(e, component))
        distance = emit_kept_distance(e, component, distance);
    emit_line(e, "    return %s;\n}\n\n", with_distance(e, e->text[roots[0]], distance));
}

/* Emits the gradients of zones, whose walls are the surface where they cut. */
static void emit_zone_gradients(Emitter *e, const Node *roots)
{
    if (e->module->zone != NODE_NONE) {
        emit_body(e, roots, 2);
        Text deeper = {.arena = e->scratch};
        text_format(&deeper, "%s > nearest.w", e->text[roots[1]]);
        emit_template(e, TEMPLATE_SET_IF,
                      (Operands){deeper.bytes, "nearest",
                                 with_distance(e, e->text[roots[0]], e->text[roots[1]])});
    }
    if (e->variant->zones > 0)
        emit_template(e, TEMPLATE_NEAREST_OF_ZONES, (Operands){emit_count(e, e->variant->zones)});
}

/* Finds the `nearest` gradient, and the distance. */
static void emit_nearest(Emitter *e)
{
    const Operands nearer = {"other.w < nearest.w", "other", "nearest"};
    uint32_t       count  = (uint32_t)e->module->components;
    emit_template(e, TEMPLATE_NEAREST_GRADIENT, (Operands){0});
    for (uint32_t i = 0; i < count; i++) {
        if (!is_of_group(e, i))
            continue;
        text_format(e->out, "    other = %s;\n", emit_call_of(e, OF_GRADIENT, i));
        emit_media_gradient(e, i);
        text_format(e->out, "    nearest = %s;\n", template_text(e, TEMPLATE_CHOICE, nearer));
    }
    emit_zone_gradients(e, e->module->gradients + 2 * count);
}

void emit_gradient(Emitter *e)
{
    emit_nearest(e);
    text_add(e->out, "    return nearest.xyz;\n");
}

void emit_tangent(Emitter *e)
{
    emit_nearest(e);
    text_add(e->out, "    return nearest;\n");
}
