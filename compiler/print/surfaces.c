/*
 * surfaces.c: krs_surface: what is at a point.
 */
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/print/emitter.h"

/* Fields of KrsSurface are in the order of the roots. */
static const ComponentRoot FIRST_ROOT = ROOT_DISTANCE + 1;

static void emit_field(Emitter *e, GraphType type, const char *name)
{
    enum { LONGEST_TYPE = 5 };
    const char *words = e->printer->types[type], *blanks = "     ";
    size_t      length = strlen(words);
    emit_template(
        e, TEMPLATE_MEMBER,
        (Operands){words, name, blanks + (length < LONGEST_TYPE ? length : LONGEST_TYPE)});
}

void emit_struct(Emitter *e)
{
    text_add(e->out, "struct KrsSurface {\n");
    emit_field(e, TYPE_FLOAT, "distance");
    for (ComponentRoot r = FIRST_ROOT; r < ROOT_NORMAL; r++)
        emit_field(e, root_info[r].shown, root_info[r].name);
    emit_field(e, TYPE_VEC3, "normal");
    text_add(e->out, "};\n\n");
}

void need_surface(Emitter *e)
{
    if (emit_has_media(e))
        need_media(e);
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_SURFACE][i] = true;
}

/* Adds the value of a field, as the type that shaders have it in. */
static void add_value(Emitter *e, Text *fields, const RootInfo *info, const char *value)
{
    if (info->type == info->shown)
        text_format(fields, "%s, ", value);
    else
        text_format(fields, "%s(%s), ", e->printer->types[info->shown], value);
}

static const char *emit_distance_of_surface(Emitter *e, uint32_t component, const char *distance)
{
    if (!emit_has_tangent(e, component))
        return distance;
    emit_variable(e, TYPE_FLOAT, "tangent", distance);
    emit_local(e, TYPE_FLOAT, "outside", emit_box_distance(e, component));
    emit_template(e, TEMPLATE_SET_IF, (Operands){"outside > 0.0", "tangent", "outside"});
    return "tangent";
}

void emit_surface_of(Emitter *e, const ModuleFunction *function)
{
    const Node *root   = function->roots;
    NodeList    shared = {0};
    emit_head_of(e, OF_SURFACE, function->component);
    e->gathers_noises = e->variant->gathers_noises;
    if (emit_find_shared(e, function->component, &shared))
        emit_shared_rest(e, function, &shared);
    else
        emit_body(e, root, ROOT_COUNT);
    e->gathers_noises = false;
    Text fields       = {.arena = e->scratch};
    for (ComponentRoot r = FIRST_ROOT; r < ROOT_NORMAL; r++)
        add_value(e, &fields, &root_info[r], e->text[root[r]]);
    emit_line(e, "    return KrsSurface(%s, %s%s);\n}\n\n",
              emit_distance_of_surface(e, function->component, e->text[root[ROOT_DISTANCE]]),
              fields.bytes, e->text[root[ROOT_NORMAL]]);
}

/* Emits what is anywhere in a scene without components. */
void emit_nothing(Emitter *e)
{
    Text nothing = {.arena = e->scratch};
    text_add(&nothing, "KrsSurface(" NOWHERE_TEXT);
    for (ComponentRoot r = FIRST_ROOT; r < ROOT_NORMAL; r++) {
        double number = root_info[r].nothing;
        Expr   value  = {.op     = OP_CONSTANT,
                         .type   = (uint8_t)root_info[r].shown,
                         .number = {number, number, number, number}};
        text_format(&nothing, ", %s", emit_constant(e, &value));
    }
    text_add(&nothing, ", normal)");
    emit_template(e, TEMPLATE_VARIABLE, (Operands){"KrsSurface", "nearest", nothing.bytes});
}

void emit_surface(Emitter *e)
{
    if (emit_has_media(e)) {
        emit_media_surface(e);
        return;
    }
    uint32_t count = (uint32_t)e->module->components;
    if (count > 0)
        emit_template(e, TEMPLATE_VARIABLE,
                      (Operands){"KrsSurface", "nearest", emit_call_of(e, OF_SURFACE, 0)});
    else
        emit_nothing(e);
    if (count > 1)
        emit_template(e, TEMPLATE_LOCAL_UNSET, (Operands){"KrsSurface", "other"});
    for (uint32_t i = 1; i < count; i++) {
        text_format(e->out, "    other = %s;\n", emit_call_of(e, OF_SURFACE, i));
        emit_template(e, TEMPLATE_SET_IF,
                      (Operands){"other.distance < nearest.distance", "nearest", "other"});
    }
    if (count > 0 && e->cuts) {
        emit_local(e, TYPE_FLOAT, "cut", emit_cut(e, "nearest.distance"));
        emit_template(e, TEMPLATE_SET_IF,
                      (Operands){"cut > nearest.distance", "nearest.normal", "normal"});
        text_add(e->out, "    nearest.distance = cut;\n");
    }
    text_add(e->out, "    return nearest;\n");
}
