/*
 * signatures.c: the functions that texts have: their names, parameters, and their comments.
 */
#include "compiler/print/emitter.h"

/* Types of results besides those of the graph. */
enum { NOTHING = 0, SURFACE = TYPE_UINT + 1 };

typedef struct TextParameter {
    GraphType   type;
    const char *name;
    bool        changes; /* the function changes it */
} TextParameter;

typedef struct Signature {
    const char          *name;
    int                  type; /* of the result: a GraphType, NOTHING or SURFACE */
    const TextParameter *parameters[3];
    const char          *comment;
} Signature;

static const TextParameter point     = {TYPE_VEC3, "p", false},
                           direction = {TYPE_VEC3, "direction", false};
static const TextParameter normal    = {TYPE_VEC3, "normal", false},
                           reach     = {TYPE_FLOAT, "reach", false};
static const TextParameter footprint = {TYPE_FLOAT, "footprint", false};
static const TextParameter part      = {TYPE_UINT, "scene_part", false};
static const TextParameter medium    = {TYPE_UINT, "volume", false};
static const TextParameter low = {TYPE_VEC3, "low", true}, high = {TYPE_VEC3, "high", true};

/* The functions of the scene; what has no row has no function of its own. */
static const Signature of_scene[KRS_FUNCTION_COUNT] = {
    [KRS_FUNCTION_DISTANCE] =
        {"krs_distance",
         TYPE_FLOAT,
         {&point},
         "// Never above the distance to the nearest surface; negative inside.\n"},
    [KRS_FUNCTION_PLANE_T] =
        {"krs_plane_t",
         TYPE_FLOAT,
         {&point, &direction},
         "// How far it is along a ray from outside to the nearest of the planes that\n"
         "// krs_distance leaves out here.\n"},
    [KRS_FUNCTION_PLANE_COSINE] = {"krs_plane_cosine",
                                   TYPE_FLOAT,
                                   {&direction},
                                   "// How steeply a ray falls towards one of them: n.d.\n"},
    [KRS_FUNCTION_ALONG] =
        {"krs_along",
         TYPE_FLOAT,
         {&point, &direction, &footprint},
         "// How far a ray from p along a unit direction may go before it can meet a\n"
         "// surface: at least the distance, and farther where polynomials or maps tell;\n"
         "// negative inside, and where a surface without thickness lies between p and the\n"
         "// last place, `footprint` behind.\n"},
    [KRS_FUNCTION_STEPS] =
        {"krs_steps",
         TYPE_VEC2,
         {&point, &direction, &footprint},
         "// krs_along in two numbers, of which it is the least: how far a ray may go before\n"
         "// it can meet what polynomials or maps tell of, and the distance to all else.\n"},
    [KRS_FUNCTION_PROBE] =
        {"krs_probe",
         TYPE_FLOAT,
         {&point, &footprint},
         "// Whether the ball around p of this radius is empty: if it could be more than 1\n"
         "// times as large, which is what this says, about.\n"},
    [KRS_FUNCTION_DISTANCE_LOD] =
        {"krs_distance_lod",
         TYPE_FLOAT,
         {&point, &footprint},
         "// To march by: never above the distance to the nearest surface, and not above 0\n"
         "// in the same places as krs_distance.  What is far for its size is not looked\n"
         "// at, nor what is smaller than the footprint.\n"},
    [KRS_FUNCTION_SCENE_PART_DISTANCE] =
        {"krs_scene_part_distance",
         TYPE_FLOAT,
         {&part, &point},
         "// Parts of the scene, most of them one component: the distance of one.\n"},
    [KRS_FUNCTION_SCENE_PART_BOX] =
        {"krs_scene_part_box",
         NOTHING,
         {&part, &low, &high},
         "// A box around a part; where there is none the box stays empty.\n"},
    [KRS_FUNCTION_GRADIENT] =
        {"krs_gradient",
         TYPE_VEC3,
         {&point, &reach},
         "// The direction in which krs_distance rises fastest at a surface, of any\n"
         "// length, by derivatives; by differences over `reach` where there are none.\n"},
    [KRS_FUNCTION_TANGENT] =
        {"krs_tangent",
         TYPE_VEC4,
         {&point, &reach},
         "// krs_gradient, and the distance to the plane that has it; negative inside.\n"},
    [KRS_FUNCTION_SURFACE] =
        {"krs_surface",
         SURFACE,
         {&point, &normal, &footprint},
         "// What is at p: the component with the least distance.  `normal` is the\n"
         "// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.\n"},
    [KRS_FUNCTION_MEDIUM_AT] = {"krs_medium_at",
                                TYPE_UINT,
                                {&point},
                                "// The medium at p, as in krs_medium.\n"},
    [KRS_FUNCTION_GLASS]     = {"krs_glass",
                                TYPE_FLOAT,
                                {&point},
                                "// The distance to what may let light through; negative inside.\n"},
    [KRS_FUNCTION_DENSITY] =
        {"krs_volume_density",
         TYPE_FLOAT,
         {&medium, &point},
         "// How much of the light is lost or scattered by a medium, on a unit of length.\n"},
    [KRS_FUNCTION_ALBEDO]     = {"krs_volume_albedo",
                                 TYPE_VEC3,
                                 {&medium, &point},
                                 "// The part of that which is scattered.\n"},
    [KRS_FUNCTION_ANISOTROPY] = {"krs_volume_anisotropy",
                                 TYPE_FLOAT,
                                 {&medium, &point},
                                 "// The mean cosine of the angle by which it is scattered.\n"},
    [KRS_FUNCTION_EMISSION]   = {"krs_volume_emission",
                                 TYPE_VEC3,
                                 {&medium, &point},
                                 "// What a medium sends out itself where it is dense.\n"},
    [KRS_FUNCTION_SUBSURFACE] =
        {"krs_subsurface",
         TYPE_FLOAT,
         {&point},
         "// The distance to that below whose surface light may go on; negative inside.\n"},
};

/* The functions of a medium, whose number is the end of the name. */
static const Signature of_volume[VOLUME_FUNCTIONS] = {
    {"krs_volume_density", TYPE_FLOAT, {&point}, NULL},
    {"krs_volume_albedo", TYPE_VEC3, {&point}, NULL},
    {"krs_volume_anisotropy", TYPE_FLOAT, {&point}, NULL},
    {"krs_volume_emission", TYPE_VEC3, {&point}, NULL},
};

static const Signature zone_depth = {"krs_zone_depth", TYPE_FLOAT, {&point}, NULL};

static const Signature prepare = {
    "krs_prepare",
    NOTHING,
    {NULL},
    "// Everything that stays the same within a frame: call it first.\n"};

/* The functions of components, whose number is the end of the name. */
static const Signature of_component[FUNCTION_KINDS] = {
    [OF_DISTANCE] = {"krs_distance", TYPE_FLOAT, {&point}, NULL},
    [OF_ALONG]    = {"krs_along", TYPE_FLOAT, {&point, &direction, &footprint}, NULL},
    [OF_PROBE]    = {"krs_probe", TYPE_FLOAT, {&point, &footprint}, NULL},
    [OF_LOD]      = {"krs_distance_lod", TYPE_FLOAT, {&point, &footprint}, NULL},
    [OF_GRADIENT] = {"krs_gradient", TYPE_VEC4, {&point, &reach}, NULL},
    [OF_SURFACE]  = {"krs_surface", SURFACE, {&point, &normal, &footprint}, NULL},
};

const char *module_function_name(KrsFunction function) { return of_scene[function].name; }

/* ---- heads ---- */

static const char *parameters_text(Emitter *e, const TextParameter *const parameters[3])
{
    Text text = {.arena = e->scratch};
    text_add(&text, "");
    for (int i = 0; i < 3 && parameters[i]; i++) {
        TextTemplate template = parameters[i]->changes ? TEMPLATE_PARAMETER_INOUT
                                                       : TEMPLATE_PARAMETER;
        const char *type      = e->printer->types[parameters[i]->type];
        text_add(&text, i ? ", " : "");
        text_add(&text, template_text(e, template, (Operands){type, parameters[i]->name}));
    }
    return text.bytes;
}

static const char *head_text(Emitter *e, const Signature *signature, const char *name)
{
    const char *parameters = parameters_text(e, signature->parameters);
    if (signature->type == NOTHING)
        return template_text(e, TEMPLATE_PROCEDURE, (Operands){name, parameters});
    const char *type = signature->type == SURFACE ? "KrsSurface"
                                                  : e->printer->types[signature->type];
    return template_text(e, TEMPLATE_FUNCTION, (Operands){type, name, parameters});
}

static void emit_prototype(Emitter *e, const Signature *signature)
{
    const char *head = head_text(e, signature, signature->name);
    emit_template(e, TEMPLATE_PROTOTYPE, (Operands){signature->comment, head});
}

void emit_prepare_entry_point(Emitter *e) { emit_prototype(e, &prepare); }

void emit_entry_point(Emitter *e, KrsFunction function)
{
    if (of_scene[function].name)
        emit_prototype(e, &of_scene[function]);
}

static void begin(Emitter *e, const Signature *signature, const char *name)
{
    text_format(e->out, "%s\n{\n", head_text(e, signature, name));
}

void emit_prepare_head(Emitter *e) { begin(e, &prepare, prepare.name); }
void emit_zone_depth_head(Emitter *e) { begin(e, &zone_depth, zone_depth.name); }

static const char *name_of_volume(Emitter *e, uint32_t which, uint32_t volume)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s_%u", of_volume[which].name, volume + 1);
    return text.bytes;
}

void emit_head_of_volume(Emitter *e, uint32_t which, uint32_t volume)
{
    begin(e, &of_volume[which], name_of_volume(e, which, volume));
}

const char *emit_call_of_volume(Emitter *e, uint32_t which, uint32_t volume)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s(p)", name_of_volume(e, which, volume));
    return text.bytes;
}

void emit_head(Emitter *e, KrsFunction function)
{
    begin(e, &of_scene[function], of_scene[function].name);
}

static const char *name_of(Emitter *e, FunctionKind kind, uint32_t component)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s_%u", of_component[kind].name, component + 1);
    return text.bytes;
}

void emit_head_of(Emitter *e, FunctionKind kind, uint32_t component)
{
    begin(e, &of_component[kind], name_of(e, kind, component));
}

const char *emit_call_with(Emitter *e, FunctionKind kind, uint32_t component, const char *operands)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s(%s)", name_of(e, kind, component), operands);
    return text.bytes;
}

const char *emit_call_of(Emitter *e, FunctionKind kind, uint32_t component)
{
    Text                        operands   = {.arena = e->scratch};
    const TextParameter *const *parameters = of_component[kind].parameters;
    for (int i = 0; i < 3 && parameters[i]; i++)
        text_format(&operands, "%s%s", i ? ", " : "", parameters[i]->name);
    return emit_call_with(e, kind, component, operands.bytes);
}
