/*
 * march.c: what some marches need beside a distance: where rays meet planes, parts of the scene by
 * themselves, steps along a ray.
 */
#include <math.h>

#include "compiler/shader/emitter.h"

/* ---- planes ---- */

void emit_planes(Emitter *e, const EmitMarch *march)
{
    if (!march->is_plane)
        return;
    text_add(e->out, "#ifdef PLANES\n"
                     "// How far it is along a ray from outside to the nearest of the planes that\n"
                     "// krs_distance then leaves out, and how steeply it falls towards one: n.d.\n"
                     "float krs_plane_t(vec3 p, vec3 direction)\n{\n");
    emit_body(e, &march->plane_roots[0], 1);
    text_format(e->out, "    return %s;\n}\n\nfloat krs_plane_cosine(vec3 direction)\n{\n",
                e->text[march->plane_roots[0]]);
    emit_body(e, &march->plane_roots[1], 1);
    text_format(e->out, "    return %s;\n}\n#endif\n\n", e->text[march->plane_roots[1]]);
}

/* ---- scene parts: one component, or neighbours that share a distance function ---- */

/* With more components, neighbours share a scene part. */
enum { MOST_SCENE_PARTS = 64 };

uint32_t emit_scene_part_count(size_t components)
{
    return components < MOST_SCENE_PARTS ? (uint32_t)components : MOST_SCENE_PARTS;
}

/* The first component of a scene part; for the number of parts, the number of components. */
static size_t first_of_scene_part(size_t scene_part, size_t components)
{
    return scene_part * components / emit_scene_part_count(components);
}

/* A case of the switch over scene parts. */
static void emit_scene_part_distance(Emitter *e, size_t scene_part, const bool *is_plane,
                                     size_t components)
{
    text_format(e->out, "    case %zuu:\n", scene_part);
    for (int guarded = 1; guarded >= 0; guarded--) {
        text_add(e->out, guarded ? "#ifdef EARLY_OUTS\n" : "#else\n");
        for (size_t i = first_of_scene_part(scene_part, components);
             i < first_of_scene_part(scene_part + 1, components); i++) {
            text_add(e->out, is_plane && is_plane[i] ? "#ifndef PLANES\n" : "");
            text_format(e->out,
                        guarded ? "        d = min(d, krs_distance_lod_%zu(p, 0.0));\n"
                                : "        d = min(d, krs_distance_%zu(p));\n",
                        i + 1);
            text_add(e->out, is_plane && is_plane[i] ? "#endif\n" : "");
        }
    }
    text_add(e->out, "#endif\n        break;\n");
}

/* Its box, grown by what single precision may lose.  Of camera-relative points no box
   is known. */
static void emit_scene_part_box(Emitter *e, size_t scene_part, Box box, bool is_plane)
{
    if (box_is_empty(box))
        return;
    double corner[2][3], size = box_is_finite(box) ? box_diagonal(box) : 0;
    for (int i = 0; i < 3; i++) {
        double reach  = fmax(fabs(box.axis[i].low), fabs(box.axis[i].high));
        double margin = isfinite(reach) ? 1e-4 * size + 1e-6 * reach : 0;
        corner[0][i]  = fmax(box.axis[i].low - margin, -1e18);
        corner[1][i]  = fmin(box.axis[i].high + margin, 1e18);
    }
    text_add(e->out, is_plane ? "#ifndef PLANES\n" : "");
    text_format(e->out, "    case %zuu:\n        low = %s;\n        high = %s;\n        break;\n",
                scene_part, emit_vector(e, corner[0]), emit_vector(e, corner[1]));
    text_add(e->out, is_plane ? "#endif\n" : "");
}

void emit_scene_parts(Emitter *e, const Box *boxes, const bool *is_plane, size_t components)
{
    size_t scene_parts = emit_scene_part_count(components);
    if (scene_parts < 2)
        return;
    text_format(e->out,
                "#ifdef PACKED\n"
                "// Parts of the scene, most of them one component: the distance of one,"
                " and a box\n// around it; where there is none the box stays empty.\n"
                "const uint KRS_SCENE_PARTS = %zuu;\n\n"
                "float krs_scene_part_distance(uint scene_part, vec3 p)\n{\n"
                "    float d = 1e30;\n    switch (scene_part) {\n",
                scene_parts);
    for (size_t scene_part = 0; scene_part < scene_parts; scene_part++)
        emit_scene_part_distance(e, scene_part, is_plane, components);
    text_add(e->out,
             "    }\n    return krs_cut(p, d);\n}\n\n"
             "void krs_scene_part_box(uint scene_part, inout vec3 low, inout vec3 high)\n{\n"
             "    switch (scene_part) {\n");
    for (size_t scene_part = 0; scene_part < scene_parts; scene_part++) {
        Box  box        = box_empty;
        bool all_planes = true;
        for (size_t i = first_of_scene_part(scene_part, components);
             i < first_of_scene_part(scene_part + 1, components); i++) {
            box        = box_hull(box, boxes ? boxes[i] : box_infinite);
            all_planes = all_planes && is_plane && is_plane[i];
        }
        emit_scene_part_box(e, scene_part, box, all_planes);
    }
    text_add(e->out, "    }\n}\n#endif\n\n");
}

/* ---- along rays ---- */

/* What a component has to itself by one method, and where it joins the others. */
static void emit_one_along(Emitter *e, Node along, size_t component, const char *asked)
{
    text_format(e->out, "float krs_along_%zu(vec3 p, %s)\n{\n", component + 1, asked);
    emit_body(e, &along, 1);
    text_format(e->out, "    return %s;\n}\n\n", e->text[along]);
}

static void open_component(Emitter *e, const EmitMarch *march, size_t component)
{
    if (march->march_groups)
        text_format(e->out, "#if !defined MARCH_GROUP || MARCH_GROUP == %u\n",
                    march->march_groups[component]);
    if (march->is_plane && march->is_plane[component])
        text_add(e->out, "#ifndef PLANES\n");
}

static void close_component(Emitter *e, const EmitMarch *march, size_t component)
{
    text_add(e->out, march->is_plane && march->is_plane[component] ? "#endif\n" : "");
    text_add(e->out, march->march_groups ? "#endif\n" : "");
}

static const char about_probe[] =
    "// Whether the ball around p of this radius is empty: if it could be more than 1 times as\n"
    "// large, which is what this says, about.\n"
    "float krs_probe(vec3 p, float footprint)\n{\n    float t = 1e30;\n";
static const char about_along[] =
    "// How far a ray from p along a unit direction may go before it can meet a surface: at\n"
    "// least the distance, and farther where polynomials or maps tell; negative inside, and\n"
    "// where a surface without thickness lies between p and the last place, `footprint` behind.\n"
    "float krs_along(vec3 p, vec3 direction, float footprint)\n{\n    float t = 1e30;\n";

/* krs_along by one method, or krs_probe. */
static void emit_along_by(Emitter *e, AlongMethod method, const EmitMarch *march, const Node *roots,
                          size_t components)
{
    const Node *along = march->along + method * components;
    bool        probe = method == ALONG_PROBE;
    for (size_t i = 0; i < components; i++) {
        if (along[i] == roots[i * ROOT_COUNT + ROOT_DISTANCE])
            continue;
        open_component(e, march, i);
        emit_one_along(e, along[i], i,
                       probe ? "float footprint" : "vec3 direction, float footprint");
        close_component(e, march, i);
    }
    text_add(e->out, probe ? about_probe : about_along);
    for (size_t i = 0; i < components; i++) {
        bool plain = along[i] == roots[i * ROOT_COUNT + ROOT_DISTANCE];
        open_component(e, march, i);
        text_format(e->out, "    t = min(t, krs_%s_%zu(p%s));\n", plain ? "distance" : "along",
                    i + 1,
                    plain   ? ""
                    : probe ? ", footprint"
                            : ", direction, footprint");
        close_component(e, march, i);
    }
    text_format(e->out, "    return krs_cut(p, t)%s;\n}\n", probe ? " / footprint" : "");
    if (!probe)
        text_add(e->out, "\nfloat krs_along(vec3 p, vec3 direction)\n{\n"
                         "    return krs_along(p, direction, 0.0);\n}\n");
}

void emit_along(Emitter *e, const EmitMarch *march, const Node *roots, size_t components)
{
    for (AlongMethod method = 0; method < ALONG_COUNT; method++) {
        bool any = false;
        for (size_t i = 0; i < components; i++)
            any = any ||
                  march->along[method * components + i] != roots[i * ROOT_COUNT + ROOT_DISTANCE];
        if (!any)
            continue;
        text_format(e->out, "#if defined(ALONG) && ALONG == %d\n", (int)method);
        emit_along_by(e, method, march, roots, components);
        text_add(e->out, "#endif\n\n");
    }
}
