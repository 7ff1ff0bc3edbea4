/*
 * distances.c: krs_distance, what zones cut out of distances, and krs_gradient.
 */
#include "compiler/print/emitter.h"

/* ---- zones ---- */

/* How deep p is in the zones of the scene, and then what distances must not be below: that, and the
   depth in those of the caller. */
void emit_zones(Emitter *e)
{
    Node zone = e->variant->camera_relative ? NODE_NONE : e->module->zone;
    if (!e->cuts)
        return;
    if (zone != NODE_NONE) {
        text_add(e->out, "// How deep p is in the zones of the scene, where nothing is.\n"
                         "float krs_zone_depth(vec3 p)\n{\n");
        emit_body(e, &zone, 1);
        emit_line(e, "    return %s;\n}\n\n", e->text[zone]);
    }
    text_add(e->out, "// The distance where zones have been cut out.\n"
                     "float krs_cut(vec3 p, float d)\n{\n");
    if (zone != NODE_NONE)
        text_add(e->out, "    d = max(d, krs_zone_depth(p));\n");
    if (e->variant->zones > 0)
        text_format(e->out,
                    "    for (int i = 0; i < %u; i++)\n"
                    "        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));\n",
                    e->variant->zones);
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
    text_format(e->out, "float krs_distance_%u(vec3 p)\n{\n", function->component + 1);
    emit_body(e, function->roots, 1);
    emit_line(e, "    return %s;\n}\n\n", e->text[*function->roots]);
}

/* The least, which begins with the first component where none is left out. */
void emit_distance(Emitter *e)
{
    bool     some  = e->variant->march_group > 0 || (e->variant->planes && e->module->is_plane);
    uint32_t count = (uint32_t)e->module->components, first = !some && count > 0;
    text_add(e->out, first ? "    float d = krs_distance_1(p);\n" : "    float d = 1e30;\n");
    for (uint32_t i = first; i < count; i++)
        if (!emit_leaves_out(e, i))
            text_format(e->out, "    d = min(d, krs_distance_%u(p));\n", i + 1);
    text_format(e->out, "    return %s;\n", emit_cut(e, "d"));
}

/* ---- gradients ---- */

static bool has_gradient(const Emitter *e, Node gradient)
{
    return e->graph->items[gradient].type == TYPE_VEC3;
}

/* Planes that rays know have gradients as well. */
static bool is_of_group(const Emitter *e, uint32_t component)
{
    return e->variant->march_group == 0 ||
           e->module->march_groups[component] == e->variant->march_group;
}

void need_gradient(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++) {
        if (!is_of_group(e, i))
            continue;
        e->needed_of[OF_GRADIENT][i] = true;
        e->needed_of[OF_DISTANCE][i] |= !has_gradient(e, emit_root(e, OF_GRADIENT, i));
    }
}

/* Of one component: the gradient, and the distance. */
void emit_gradient_of(Emitter *e, const ModuleFunction *function)
{
    const Node *roots = function->roots;
    text_format(e->out, "vec4 krs_gradient_%u(vec3 p, float reach)\n{\n", function->component + 1);
    if (has_gradient(e, roots[0])) {
        emit_body(e, roots, 2);
        emit_line(e, "    return vec4(%s, %s);\n}\n\n", e->text[roots[0]], e->text[roots[1]]);
        return;
    }
    text_format(e->out,
                "    vec4 found = vec4(0.0);\n"
                "    for (uint i = 0u; i < 7u; i++) {\n"
                "        vec3 offset = vec3(i >> 1u == 0u, i >> 1u == 1u, i >> 1u == 2u);\n"
                "        offset *= (i & 1u) == 0u ? reach : -reach;\n"
                "        float d = krs_distance_%u(p + offset);\n"
                "        found += i < 6u ? vec4(d * offset, 0.0) : vec4(0.0, 0.0, 0.0, d);\n"
                "    }\n"
                "    return found;\n}\n\n",
                function->component + 1);
}

/* Where zones cut, their walls are the surface. */
static void emit_zone_gradients(Emitter *e, const Node *roots)
{
    if (e->module->zone != NODE_NONE) {
        emit_body(e, roots, 2);
        emit_line(e, "    if (%s > nearest.w)\n        nearest = vec4(%s, %s);\n",
                  e->text[roots[1]], e->text[roots[0]], e->text[roots[1]]);
    }
    if (e->variant->zones > 0)
        text_format(e->out,
                    "    for (int i = 0; i < %u; i++) {\n"
                    "        vec3 toward = krs_zones[i].xyz - p;\n"
                    "        float depth = krs_zones[i].w - length(toward);\n"
                    "        nearest = depth > nearest.w ? vec4(toward, depth) : nearest;\n"
                    "    }\n",
                    e->variant->zones);
}

void emit_gradient(Emitter *e)
{
    uint32_t count = (uint32_t)e->module->components;
    text_add(e->out, "    vec4 nearest = vec4(0.0, 0.0, 0.0, 1e30), other;\n");
    for (uint32_t i = 0; i < count; i++)
        if (is_of_group(e, i))
            text_format(e->out,
                        "    other = krs_gradient_%u(p, reach);\n"
                        "    nearest = other.w < nearest.w ? other : nearest;\n",
                        i + 1);
    emit_zone_gradients(e, e->module->gradients + 2 * count);
    text_add(e->out, "    return nearest.xyz;\n");
}
