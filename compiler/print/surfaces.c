/*
 * surfaces.c: krs_surface: what is at a point.
 */
#include "compiler/print/emitter.h"

/* Fields of KrsSurface are in the order of the roots; the number of the component is between
   properties of the material and the other identities. */
static const ComponentRoot FIRST_ROOT = ROOT_DISTANCE + 1;

static bool is_first_identity(ComponentRoot root)
{
    return !root_info[root].material && (root == FIRST_ROOT || root_info[root - 1].material);
}

static void emit_field(Emitter *e, GraphType type, const char *name)
{
    text_format(e->out, "    %-5s %s;\n", e->printer->types[type], name);
}

void emit_struct(Emitter *e)
{
    text_add(e->out, "struct KrsSurface {\n");
    emit_field(e, TYPE_FLOAT, "distance");
    for (ComponentRoot r = FIRST_ROOT; r < ROOT_NORMAL; r++) {
        if (is_first_identity(r))
            emit_field(e, TYPE_UINT, "component");
        emit_field(e, root_info[r].shown, root_info[r].name);
    }
    emit_field(e, TYPE_VEC3, "normal");
    text_add(e->out, "};\n\n");
}

void need_surface(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_SURFACE][i] = true;
}

/* The value of a field, as the type that shaders have it in. */
static void add_value(Emitter *e, Text *fields, const RootInfo *info, const char *value)
{
    if (info->type == info->shown)
        text_format(fields, "%s, ", value);
    else
        text_format(fields, "%s(%s), ", e->printer->types[info->shown], value);
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
    Text fields = {.arena = e->scratch};
    for (ComponentRoot r = FIRST_ROOT; r < ROOT_NORMAL; r++) {
        if (is_first_identity(r))
            text_format(&fields, "%uu, ", function->component + 1);
        add_value(e, &fields, &root_info[r], e->text[root[r]]);
    }
    emit_line(e, "    return KrsSurface(%s, %s%s);\n}\n\n", e->text[root[ROOT_DISTANCE]],
              fields.bytes, e->text[root[ROOT_NORMAL]]);
}

/* What is anywhere in a scene without components. */
static void emit_nothing(Emitter *e)
{
    text_add(e->out, "    KrsSurface nearest = KrsSurface(1e30");
    for (ComponentRoot r = FIRST_ROOT; r < ROOT_NORMAL; r++) {
        if (is_first_identity(r))
            text_add(e->out, ", 0u");
        double nothing = root_info[r].nothing;
        switch (root_info[r].shown) {
        case TYPE_UINT: text_format(e->out, ", %uu", (unsigned)nothing); break;
        case TYPE_VEC3: text_format(e->out, ", vec3(%s)", emit_number(e, nothing)); break;
        default: text_format(e->out, ", %s", emit_number(e, nothing)); break;
        }
    }
    text_add(e->out, ", normal);\n");
}

void emit_surface(Emitter *e)
{
    size_t count = e->module->components;
    if (count > 0)
        text_add(e->out, "    KrsSurface nearest = krs_surface_1(p, normal, footprint);\n");
    else
        emit_nothing(e);
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
