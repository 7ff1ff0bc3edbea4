/*
 * media.c: distances and surfaces for rays that are inside of glass, or are not.
 *
 * Components that may let light through are media, numbered from 1 in the order of the scene.  The
 * global krs_medium is the number of the one that the ray is in, or 0.  Where several contain a
 * point the last of them is the medium there, so boundaries of those before it are not seen.  The
 * next boundary is that of the ray's own medium, from inside, or of a later one, or of a solid that
 * is no medium.  Where a scene has media, but texts do not know rays, glass is solid.
 */
#include "compiler/base/far.h"
#include "compiler/print/emitter.h"

bool emit_has_media(const Emitter *e)
{
    return e->variant->glass == KRS_GLASS_NESTED && e->module->is_medium != NULL;
}

bool emit_is_medium(const Emitter *e, uint32_t component)
{
    return emit_has_media(e) && e->module->is_medium[component];
}

static void emit_global(Emitter *e, GraphType type, const char *name)
{
    emit_template(e, TEMPLATE_GLOBAL, (Operands){e->printer->types[type], name});
}

/* Tells whether a function that is wanted knows the ray's medium. */
static bool reads_medium(const Emitter *e)
{
    static const KrsFunction functions[] = {KRS_FUNCTION_DISTANCE, KRS_FUNCTION_ALONG,
                                            KRS_FUNCTION_STEPS,    KRS_FUNCTION_DISTANCE_LOD,
                                            KRS_FUNCTION_GRADIENT, KRS_FUNCTION_TANGENT,
                                            KRS_FUNCTION_SURFACE,  KRS_FUNCTION_DENSITY};
    bool                     found       = false;
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        found = found || e->wanted[functions[i]];
    return found;
}

void emit_media_globals(Emitter *e)
{
    if (!emit_has_media(e) || !reads_medium(e))
        return;
    text_add(e->out, "// The medium that the ray is in: a number, or 0.  The caller sets it.\n");
    emit_global(e, TYPE_UINT, "krs_medium");
    if (!e->wanted[KRS_FUNCTION_SURFACE]) {
        text_add(e->out, "\n");
        return;
    }
    text_add(e->out,
             "// For krs_surface, at a boundary: how far beyond it the next medium is looked\n"
             "// for.  The caller sets it.\n");
    emit_global(e, TYPE_FLOAT, "krs_lift");
    text_add(e->out,
             "// What krs_surface tells of it: the number of the medium whose boundary it is\n"
             "// (0: that of a solid), the medium beyond it, indices of refraction on both\n"
             "// sides, and the absorption of the ray's medium.\n");
    emit_global(e, TYPE_UINT, "krs_struck");
    emit_global(e, TYPE_UINT, "krs_beyond");
    emit_global(e, TYPE_FLOAT, "krs_ior_here");
    emit_global(e, TYPE_FLOAT, "krs_ior_beyond");
    emit_global(e, TYPE_VEC3, "krs_absorption");
    text_add(e->out, "\n");
}

static const char *number_text(Emitter *e, uint32_t component)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%uu", component + 1);
    return text.bytes;
}

/* Returns a length to a component, as the ray sees its boundary. */
static const char *seen_text(Emitter *e, uint32_t component, const char *length)
{
    Text text = {.arena = e->scratch};
    emit_call(e, "krs_in_medium", TYPE_UINT, 3);
    text_format(&text, "krs_in_medium(krs_medium, %s, %s)", number_text(e, component), length);
    return text.bytes;
}

static const char *equals_text(Emitter *e, const char *variable, uint32_t component)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s == %s", variable, number_text(e, component));
    return text.bytes;
}

/* ---- lengths ---- */

void emit_seen_steps(Emitter    *e, FunctionKind (*kind_of)(const Emitter *e, uint32_t component),
                     const char *variable)
{
    if (e->cuts)
        text_format(e->out, "    %s = %s;\n", variable, emit_cut(e, variable));
    for (uint32_t i = 0; i < e->module->components; i++) {
        FunctionKind kind = kind_of(e, i);
        if (emit_is_medium(e, i) && e->needed_of[kind][i])
            text_format(e->out, "    %s = min(%s, %s);\n", variable, variable,
                        seen_text(e, i, emit_cut(e, emit_call_of(e, kind, i))));
    }
}

void emit_media_steps(Emitter    *e, FunctionKind (*kind_of)(const Emitter *e, uint32_t component),
                      const char *variable)
{
    if (emit_has_media(e))
        emit_seen_steps(e, kind_of, variable);
    text_format(e->out, "    return %s;\n", emit_has_media(e) ? variable : emit_cut(e, variable));
}

/* Emits the gradient of media: from inside, it and the distance are negated. */
void emit_media_gradient(Emitter *e, uint32_t component)
{
    if (!emit_is_medium(e, component))
        return;
    emit_call(e, "krs_gradient_in_medium", TYPE_UINT, 3);
    text_format(e->out, "    other = krs_gradient_in_medium(krs_medium, %s, other);\n",
                number_text(e, component));
}

void need_media(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_DISTANCE][i] |= e->module->is_medium && e->module->is_medium[i];
}

void emit_medium_at(Emitter *e)
{
    emit_variable(e, TYPE_UINT, "medium", "0u");
    for (uint32_t i = 0; i < e->module->components; i++) {
        Text inside = {.arena = e->scratch};
        if (!e->module->is_medium || !e->module->is_medium[i])
            continue;
        text_format(&inside, "%s < 0.0", emit_cut(e, emit_call_of(e, OF_DISTANCE, i)));
        emit_template(e, TEMPLATE_SET_IF, (Operands){inside.bytes, "medium", number_text(e, i)});
    }
    text_add(e->out, "    return medium;\n");
}

/* Emits the distance to the nearest of some components. */
static void emit_nearest_of(Emitter *e, const bool *of)
{
    emit_variable(e, TYPE_FLOAT, "d", NOWHERE_TEXT);
    for (uint32_t i = 0; i < e->module->components; i++)
        if (of && of[i])
            text_format(e->out, "    d = min(d, %s);\n", emit_call_of(e, OF_DISTANCE, i));
    text_format(e->out, "    return %s;\n", emit_cut(e, "d"));
}

void emit_glass(Emitter *e) { emit_nearest_of(e, e->module->is_medium); }

void need_subsurface(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        e->needed_of[OF_DISTANCE][i] |= e->module->is_subsurface && e->module->is_subsurface[i];
}

void emit_subsurface(Emitter *e) { emit_nearest_of(e, e->module->is_subsurface); }

/* ---- surfaces ---- */

/* Emits what of `other` is in no zone; the walls of zones have normals of their own. */
static void emit_cut_surface(Emitter *e, const char *normal)
{
    if (!e->cuts)
        return;
    text_format(e->out, "    cut = %s;\n", emit_cut(e, "other.distance"));
    emit_template(e, TEMPLATE_SET_IF, (Operands){"cut > other.distance", "other.normal", normal});
    text_add(e->out, "    other.distance = cut;\n");
}

static void emit_solid_surface(Emitter *e, uint32_t component)
{
    text_format(e->out, "    other = %s;\n", emit_call_of(e, OF_SURFACE, component));
    emit_cut_surface(e, "normal");
    emit_template(e, TEMPLATE_SET_IF,
                  (Operands){"other.distance < nearest.distance", "nearest", "other"});
}

/* Emits the surface of a medium.  The wall of the ray's own counts as a little farther: what touches it is
   seen. */
static void emit_medium_surface(Emitter *e, uint32_t component)
{
    const char *own = equals_text(e, "krs_medium", component), *normal = "turned";
    const char *nearer = "other.distance < nearest.distance";
    const char *struck = number_text(e, component);
    Text        ior    = {.arena = e->scratch};
    text_format(&ior, "ior_%u", component + 1);
    text_format(e->out, "    turned = %s;\n",
                template_text(e, TEMPLATE_CHOICE, (Operands){own, "-normal", "normal"}));
    text_format(e->out, "    other = %s;\n",
                emit_call_with(e, OF_SURFACE, component, "p, turned, footprint"));
    emit_cut_surface(e, normal);
    emit_local(e, TYPE_FLOAT, ior.bytes, "other.ior");
    emit_template(e, TEMPLATE_SET_IF, (Operands){own, "krs_ior_here", ior.bytes});
    emit_template(e, TEMPLATE_SET_IF, (Operands){own, "krs_absorption", "other.absorption"});
    text_format(e->out, "    other.distance = %s;\n", seen_text(e, component, "other.distance"));
    emit_template(e, TEMPLATE_SET_IF,
                  (Operands){own, "other.distance", "other.distance + krs_lift"});
    emit_template(e, TEMPLATE_SET_IF, (Operands){nearer, "krs_struck", struck});
    emit_template(e, TEMPLATE_SET_IF, (Operands){nearer, "nearest", "other"});
}

/* Emits the medium beyond.  Of the one whose boundary it is nobody need ask, however thin it is. */
static void emit_beyond(Emitter *e, uint32_t component)
{
    Text distance = {.arena = e->scratch}, inside = distance, changes = distance, ior = distance;
    text_format(&distance, e->cuts ? "krs_cut(beyond, %s) < 0.0" : "%s < 0.0",
                emit_call_with(e, OF_DISTANCE, component, "beyond"));
    text_format(&changes, "krs_medium != %s", number_text(e, component));
    text_add(&inside, template_text(e, TEMPLATE_CHOICE,
                                    (Operands){equals_text(e, "krs_struck", component),
                                               changes.bytes, distance.bytes}));
    text_format(&ior, "ior_%u", component + 1);
    emit_template(e, TEMPLATE_SET_IF,
                  (Operands){inside.bytes, "krs_beyond", number_text(e, component)});
    emit_template(e, TEMPLATE_SET_IF,
                  (Operands){equals_text(e, "krs_beyond", component), "krs_ior_beyond", ior.bytes});
}

static void emit_defaults(Emitter *e)
{
    Expr nothing = {.op = OP_CONSTANT, .type = TYPE_VEC3};
    emit_nothing(e);
    emit_template(e, TEMPLATE_LOCAL_UNSET, (Operands){"KrsSurface", "other"});
    emit_template(e, TEMPLATE_LOCAL_UNSET, (Operands){e->printer->types[TYPE_VEC3], "turned"});
    if (e->cuts)
        emit_template(e, TEMPLATE_LOCAL_UNSET, (Operands){e->printer->types[TYPE_FLOAT], "cut"});
    emit_local(e, TYPE_VEC3, "beyond", "p - krs_lift * normal");
    text_add(e->out, "    krs_struck = 0u;\n"
                     "    krs_beyond = 0u;\n"
                     "    krs_ior_here = 1.0;\n"
                     "    krs_ior_beyond = 1.0;\n");
    text_format(e->out, "    krs_absorption = %s;\n", emit_constant(e, &nothing));
}

void emit_media_surface(Emitter *e)
{
    emit_defaults(e);
    for (uint32_t i = 0; i < e->module->components; i++)
        if (emit_is_medium(e, i))
            emit_medium_surface(e, i);
        else
            emit_solid_surface(e, i);
    for (uint32_t i = 0; i < e->module->components; i++)
        if (emit_is_medium(e, i))
            emit_beyond(e, i);
    text_add(e->out, "    return nearest;\n");
}
