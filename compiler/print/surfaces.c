/*
 * surfaces.c: krs_surface: what is at a point.
 */
#include "compiler/print/emitter.h"

void need_surface(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_SURFACE][i] = true;
}

void emit_surface_of(Emitter *e, const ModuleFunction *function)
{
    const Node *root   = function->roots;
    NodeList    shared = {0};
    text_format(e->out, "KrsSurface krs_surface_%u(vec3 p, vec3 normal, float footprint)\n{\n",
                function->component + 1);
    if (emit_find_shared(e, function->component, &shared))
        emit_shared_rest(e, function, &shared);
    else
        emit_body(e, root, ROOT_COUNT);
    emit_line(e, "    return KrsSurface(%s, %s, %s, %s, %s, %uu, uint(%s), %s, %s);\n}\n\n",
              e->text[root[ROOT_DISTANCE]], e->text[root[ROOT_COLOR]],
              e->text[root[ROOT_ROUGHNESS]], e->text[root[ROOT_METALLIC]],
              e->text[root[ROOT_EMISSION]], function->component + 1, e->text[root[ROOT_LEVEL]],
              e->text[root[ROOT_INSTANCE]], e->text[root[ROOT_NORMAL]]);
}

void emit_surface(Emitter *e)
{
    size_t count = e->module->components;
    text_add(e->out, count ? "    KrsSurface nearest = krs_surface_1(p, normal, footprint);\n"
                           : "    KrsSurface nearest = KrsSurface(1e30, vec3(0.0), 1.0, 0.0, "
                             "vec3(0.0), 0u, 0u, 0u, normal);\n");
    if (count > 1)
        text_add(e->out, "    KrsSurface other;\n");
    for (size_t i = 1; i < count; i++)
        text_format(e->out,
                    "    other = krs_surface_%zu(p, normal, footprint);\n"
                    "    if (other.distance < nearest.distance)\n"
                    "        nearest = other;\n",
                    i + 1);
    if (count > 0 && e->cuts)
        text_add(e->out, "    float cut = krs_cut(p, nearest.distance);\n"
                         "    if (cut > nearest.distance)\n"
                         "        nearest.normal = normal;\n"
                         "    nearest.distance = cut;\n");
    text_add(e->out, "    return nearest;\n");
}
