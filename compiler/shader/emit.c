/*
 * emit.c: the graph as GLSL: the functions that compile.h promises, in their order.
 *
 * What stands in a function is written by statements.c; some are in early_outs.c and march.c.
 */
#include "compiler/shader/emitter.h"

/* ---- distances ---- */

/* What the distance must not be below: how deep p is in zones, negative outside.  Those of the
   caller are in the slots behind the parameters, in a variant that has room for ZONES of them. */
static void emit_zones(Emitter *e, Node zone)
{
    if (zone != NODE_NONE) {
        text_add(e->out, "// How deep p is in the zones of the scene, where nothing is.\n"
                         "float krs_zone_depth(vec3 p)\n{\n");
        emit_body(e, &zone, 1);
        text_format(e->out, "    return %s;\n}\n\n", e->text[zone]);
    }
    text_add(e->out,
             "// The distance where zones have been cut out: those of the scene, and ZONES of\n"
             "// the caller, of which slot KRS_SLOTS holds the first: center and radius.\n"
             "float krs_cut(vec3 p, float d)\n{\n");
    if (zone != NODE_NONE)
        text_add(e->out, "    d = max(d, krs_zone_depth(p));\n");
    text_add(e->out, "#ifdef ZONES\n"
                     "    for (int i = 0; i < ZONES; i++)\n"
                     "        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));\n"
                     "#endif\n"
                     "    return d;\n}\n\n");
}

/* Kernels that intersect planes march the rest. */
static void emit_union(Emitter *e, size_t components, const bool *is_plane)
{
    if (is_plane) {
        text_add(e->out, "#ifdef PLANES\n    float d = 1e30;\n");
        for (size_t i = 0; i < components; i++)
            if (!is_plane[i])
                text_format(e->out, "    d = min(d, krs_distance_%zu(p));\n", i + 1);
        text_add(e->out, "#else\n");
    }
    text_add(e->out, components ? "    float d = krs_distance_1(p);\n" : "    float d = 1e30;\n");
    for (size_t i = 1; i < components; i++)
        text_format(e->out, "    d = min(d, krs_distance_%zu(p));\n", i + 1);
    if (is_plane)
        text_add(e->out, "#endif\n");
}

/* Of the march group that is defined, or of all. */
static void emit_march_group_distances(Emitter *e, size_t components, const uint32_t *march_groups,
                                       const bool *is_plane)
{
    text_add(e->out, "#ifdef MARCH_GROUP\n    float d = 1e30;\n");
    for (size_t i = 0; i < components; i++)
        text_format(e->out, "#if MARCH_GROUP == %u\n    d = min(d, krs_distance_%zu(p));\n#endif\n",
                    march_groups[i], i + 1);
    text_add(e->out, "#else\n");
    emit_union(e, components, is_plane);
    text_add(e->out, "#endif\n");
}

static void emit_distances(Emitter *e, const Node *roots, size_t components,
                           const uint32_t *march_groups, const bool *is_plane)
{
    for (size_t i = 0; i < components; i++) {
        Node root = roots[i * ROOT_COUNT + ROOT_DISTANCE];
        if (march_groups)
            text_format(e->out, "#if !defined MARCH_GROUP || MARCH_GROUP == %u\n", march_groups[i]);
        text_format(e->out, "float krs_distance_%zu(vec3 p)\n{\n", i + 1);
        emit_body(e, &root, 1);
        text_format(e->out, "    return %s;\n}\n%s\n", e->text[root],
                    march_groups ? "#endif\n" : "");
    }
    text_add(e->out, "// Never above the distance to the nearest surface; negative inside.\n"
                     "float krs_distance(vec3 p)\n{\n");
    if (march_groups)
        emit_march_group_distances(e, components, march_groups, is_plane);
    else
        emit_union(e, components, is_plane);
    text_add(e->out, "    return krs_cut(p, d);\n}\n\n");
}

/* ---- gradients ---- */

static bool has_gradient(const Emitter *e, const Node *roots)
{
    return e->graph->items[roots[0]].type == TYPE_VEC3;
}

/* Of one component: the gradient, and the distance. */
static void emit_gradient_of(Emitter *e, size_t component, const Node *roots)
{
    text_format(e->out, "vec4 krs_gradient_%zu(vec3 p, float reach)\n{\n", component + 1);
    if (has_gradient(e, roots)) {
        emit_body(e, roots, 2);
        text_format(e->out, "    return vec4(%s, %s);\n}\n\n", e->text[roots[0]],
                    e->text[roots[1]]);
        return;
    }
    text_format(e->out,
                "    vec4 found = vec4(0.0);\n"
                "    for (uint i = 0u; i < 7u; i++) {\n"
                "        vec3 offset = vec3(i >> 1u == 0u, i >> 1u == 1u, i >> 1u == 2u);\n"
                "        offset *= (i & 1u) == 0u ? reach : -reach;\n"
                "        float d = krs_distance_%zu(p + offset);\n"
                "        found += i < 6u ? vec4(d * offset, 0.0) : vec4(0.0, 0.0, 0.0, d);\n"
                "    }\n"
                "    return found;\n}\n\n",
                component + 1);
}

/* Where zones cut, their walls are the surface. */
static void emit_zone_gradients(Emitter *e, Node zone, const Node *roots)
{
    if (zone != NODE_NONE) {
        emit_body(e, roots, 2);
        text_format(e->out, "    if (%s > nearest.w)\n        nearest = vec4(%s, %s);\n",
                    e->text[roots[1]], e->text[roots[0]], e->text[roots[1]]);
    }
    text_add(e->out, "#ifdef ZONES\n"
                     "    for (int i = 0; i < ZONES; i++) {\n"
                     "        vec3 toward = krs_zones[i].xyz - p;\n"
                     "        float depth = krs_zones[i].w - length(toward);\n"
                     "        nearest = depth > nearest.w ? vec4(toward, depth) : nearest;\n"
                     "    }\n"
                     "#endif\n");
}

static void emit_gradients(Emitter *e, const EmitMarch *march, size_t components, Node zone)
{
    text_add(e->out, "#if defined(GRADIENT) && !defined(CAMERA_RELATIVE)\n");
    for (size_t i = 0; i < components; i++)
        emit_gradient_of(e, i, march->gradient + 2 * i);
    text_add(e->out,
             "// The direction in which krs_distance rises fastest at a surface, of any\n"
             "// length, by derivatives; by differences over `reach` where there are none.\n"
             "vec3 krs_gradient(vec3 p, float reach)\n{\n"
             "    vec4 nearest = vec4(0.0, 0.0, 0.0, 1e30), other;\n");
    for (size_t i = 0; i < components; i++)
        text_format(e->out,
                    "    other = krs_gradient_%zu(p, reach);\n"
                    "    nearest = other.w < nearest.w ? other : nearest;\n",
                    i + 1);
    emit_zone_gradients(e, zone, march->gradient + 2 * components);
    text_add(e->out, "    return nearest.xyz;\n}\n#endif\n\n");
}

/* ---- surfaces ---- */

static void emit_surfaces(Emitter *e, const Node *roots, size_t components)
{
    for (size_t i = 0; i < components; i++) {
        const Node *root = &roots[i * ROOT_COUNT];
        text_format(e->out, "KrsSurface krs_surface_%zu(vec3 p, vec3 normal, float footprint)\n{\n",
                    i + 1);
        emit_body(e, root, ROOT_COUNT);
        text_format(
            e->out, "    return KrsSurface(%s, %s, %s, %s, %s, %zuu, uint(%s), %s, %s);\n}\n\n",
            e->text[root[ROOT_DISTANCE]], e->text[root[ROOT_COLOR]], e->text[root[ROOT_ROUGHNESS]],
            e->text[root[ROOT_METALLIC]], e->text[root[ROOT_EMISSION]], i + 1,
            e->text[root[ROOT_LEVEL]], e->text[root[ROOT_INSTANCE]], e->text[root[ROOT_NORMAL]]);
    }
    const char *empty =
        "    return KrsSurface(1e30, vec3(0.0), 1.0, 0.0, vec3(0.0), 0u, 0u, 0u, normal);\n";
    text_add(e->out, "// What is at p: the component with the least distance.  `normal` is the\n"
                     "// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.\n"
                     "KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)\n{\n");
    text_add(e->out, components ? "    KrsSurface nearest = krs_surface_1(p, normal, footprint);\n"
                                : empty);
    if (components > 1)
        text_add(e->out, "    KrsSurface other;\n");
    for (size_t i = 1; i < components; i++)
        text_format(e->out,
                    "    other = krs_surface_%zu(p, normal, footprint);\n"
                    "    if (other.distance < nearest.distance)\n"
                    "        nearest = other;\n",
                    i + 1);
    if (components > 0)
        text_add(e->out, "    float cut = krs_cut(p, nearest.distance);\n"
                         "    if (cut > nearest.distance)\n"
                         "        nearest.normal = normal;\n"
                         "    nearest.distance = cut;\n"
                         "    return nearest;\n");
    text_add(e->out, "}\n");
}

static void emit_struct(Emitter *e)
{
    text_add(e->out, "struct KrsSurface {\n"
                     "    float distance;\n"
                     "    vec3  color;\n"
                     "    float roughness;\n"
                     "    float metallic;\n"
                     "    vec3  emission;\n"
                     "    uint  component;\n"
                     "    uint  level;\n"
                     "    uint  instance;\n"
                     "    vec3  normal;\n"
                     "};\n\n");
}

/* ---- the whole ---- */

/* The whole again for kernels far from the origin, with camera-relative points. */
static void emit_camera_relative(Emitter *e, const EmitMarch *march, size_t components,
                                 FrameValues *values)
{
    const Node *roots = march->camera_relative, *plane_roots = roots + components * ROOT_COUNT;
    EmitMarch   plain = {.is_plane = march->is_plane, .plane_roots = plane_roots};
    emit_lay_out(e, roots, components * ROOT_COUNT + 2, values);
    e->from_host = true;
    text_format(e->out,
                "#ifdef CAMERA_RELATIVE // p is relative to an origin near it: graph/rebase.h\n"
                "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                "{ vec4 krs_parameter[%u]; };\n\n",
                values->first_slot + values->slots + 1);
    emit_struct(e);
    emit_helpers(e, roots, components * ROOT_COUNT + 2);
    emit_frame(e, roots, components * ROOT_COUNT + 2, values);
    e->from_host = false;
    text_add(e->out, "float krs_cut(vec3 p, float d) { return d; }\n\n");
    emit_distances(e, roots, components, NULL, march->is_plane);
    emit_scene_parts(e, NULL, march->is_plane, components);
    emit_planes(e, &plain);
    emit_surfaces(e, roots, components);
    text_add(e->out, "#else\n");
}

/* Room for what is known of each node. */
static Emitter emitter_new(const Graph *graph, const Sources *sources, Arena *scratch, Text *out)
{
    size_t  count  = graph->count + 1;
    Emitter e      = {.graph = graph, .sources = sources, .scratch = scratch, .out = out};
    e.text         = arena_new_array(scratch, const char *, count);
    e.frame        = arena_new_array(scratch, const char *, count);
    e.nesting      = arena_new_array(scratch, uint8_t, count);
    e.uses         = arena_new_array(scratch, uint32_t, count);
    e.excess       = arena_new_array(scratch, const char *, count);
    e.found_index  = arena_new_array(scratch, uint32_t, count);
    e.feeds_mirror = arena_new_array(scratch, uint8_t, count);
    return e;
}

/* All that the functions of a program need, but for the camera-relative ones. */
static Node *gather_roots(const Node *roots, size_t plain, const EmitMarch *march,
                          size_t components, Arena *scratch, size_t *count)
{
    const struct {
        const Node *from;
        size_t      count;
    } kinds[] = {{roots, plain},
                 {march->guarded, components},
                 {march->along, ALONG_COUNT * components},
                 {march->plane_roots, march->is_plane ? 2 : 0},
                 {march->gradient, march->gradient ? 2 * (components + 1) : 0}};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    *count = 0;
    for (int i = 0; i < KINDS; i++)
        *count += kinds[i].count;
    Node *all = arena_new_array(scratch, Node, *count + 1), *next = all;
    for (int i = 0; i < KINDS; i++)
        for (size_t k = 0; k < kinds[i].count; k++)
            *next++ = kinds[i].from[k];
    return all;
}

static void emit_head(Emitter *e, const EmitMarch *march)
{
    text_add(e->out, "// Distance code of a scene; "
                     "slot 0 holds the time, then one slot for each `param`.\n");
    if (march->slopes)
        text_add(e->out, "// Behind them slopes that the host finds for each frame: "
                         "krs_frame_parameters in krs.h.\n");
    text_add(e->out, "// Where branches save work there are many threads, and operations count.\n"
                     "// Elsewhere what has to be waited for counts, and built-in min and max of\n"
                     "// variables are three instructions, since they mind what is not a number.\n"
                     "#ifdef EARLY_OUTS\n"
                     "#define KRS_MIN(a, b) min(a, b)\n"
                     "#define KRS_MAX(a, b) max(a, b)\n"
                     "#define KRS_BACK(back, here) here\n"
                     "#else\n"
                     "#define KRS_MIN(a, b) mix(a, b, (b) < (a))\n"
                     "#define KRS_MAX(a, b) mix(a, b, (a) < (b))\n"
                     "#define KRS_BACK(back, here) back\n"
                     "#endif\n");
}

static void emit_parameters(Emitter *e, const FrameValues *values)
{
    size_t slots = e->graph->parameters.count;
    if (values->slots > 0)
        text_format(e->out,
                    "// With FRAME_VALUES defined, %u more slots hold what else depends on the\n"
                    "// frame alone: krs_frame_values in krs.h.\n"
                    "#ifdef FRAME_VALUES\n"
                    "#define KRS_SLOTS %zu\n"
                    "#else\n"
                    "#define KRS_SLOTS %zu\n"
                    "#endif\n",
                    values->slots, slots + values->slots, slots);
    else
        text_format(e->out, "#define KRS_SLOTS %zu\n", slots);
    text_add(e->out, "#ifdef ZONES\n"
                     "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                     "{ vec4 krs_parameter[KRS_SLOTS + ZONES]; };\n"
                     "vec4 krs_zones[ZONES];\n"
                     "#else\n"
                     "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                     "{ vec4 krs_parameter[KRS_SLOTS]; };\n"
                     "#endif\n\n");
}

void emit_glsl(const Graph *graph, const Sources *sources, const Node *roots,
               size_t component_count, Node zone, const EmitMarch *march, Arena *scratch, Text *out,
               EmittedFrame *frame)
{
    Emitter e = emitter_new(graph, sources, scratch, out);
    size_t  count;
    Node   *all = gather_roots(roots, component_count * ROOT_COUNT + (zone != NODE_NONE), march,
                               component_count, scratch, &count);
    *frame      = (EmittedFrame){.plain.first_slot = (uint32_t)graph->parameters.count};
    emit_lay_out(&e, all, count, &frame->plain);
    frame->camera_relative.first_slot = frame->plain.first_slot + frame->plain.slots +
                                        march->zone_slots;
    emit_head(&e, march);
    if (march->camera_relative)
        emit_camera_relative(&e, march, component_count, &frame->camera_relative);
    emit_parameters(&e, &frame->plain);
    emit_struct(&e);
    emit_helpers(&e, all, count);
    emit_frame(&e, all, count, &frame->plain);
    emit_zones(&e, zone);
    emit_distances(&e, roots, component_count, march->march_groups, march->is_plane);
    emit_planes(&e, march);
    emit_along(&e, march, roots, component_count);
    if (march->march_groups)
        text_add(out, "#ifndef MARCH_GROUP\n");
    emit_early_outs(&e, march, roots, component_count);
    emit_scene_parts(&e, march->boxes, march->is_plane, component_count);
    if (march->gradient)
        emit_gradients(&e, march, component_count, zone);
    emit_surfaces(&e, roots, component_count);
    if (march->march_groups)
        text_add(out, "#endif\n");
    if (march->camera_relative)
        text_add(out, "#endif\n");
}
