/*
 * properties.c: the properties that blocks of a scene may have, and their values.
 *
 * Blocks are materials, cameras, lights, the sky, fog, media, the image and zones.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

/* The blocks that may have each property; `later` ones are known but not in this version. */
static const struct BlockProperty {
    SyntaxKind  block;
    const char *name;
    bool        later;
} block_properties[] = {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    {SYNTAX_MATERIAL, #name, false},
#include "krs/surface.def"
#define KRS_CAMERA(name, kind, part, positive, counts, ...) {SYNTAX_CAMERA, #name, false},
#define KRS_CAMERA_FIXED(name, type, part, counts)          {SYNTAX_CAMERA, #name, false},
#include "krs/camera.def"
#define KRS_MEDIUM(name, type, otherwise, low, high) {SYNTAX_MEDIUM, #name, false},
#include "compiler/shape/medium.def"
    {SYNTAX_LIGHT, "direction", false},
#define KRS_LIGHT(member, kind, of_direction, of_position, ...) {SYNTAX_LIGHT, of_position, false},
#include "krs/lights.def"
    /* clang-format off */
    {SYNTAX_MATERIAL, "bump", false},
    {SYNTAX_LIGHT, "softness", false},
    {SYNTAX_LIGHT, "shadow", false},
    {SYNTAX_SKY, "zenith", false},
    {SYNTAX_SKY, "horizon", false},
    {SYNTAX_SKY, "ground", false},
    {SYNTAX_SKY, "sun", false},
    {SYNTAX_SKY, "turbidity", false},
    {SYNTAX_SKY, "image", false},
    {SYNTAX_SKY, "rotation", false},
    {SYNTAX_SKY, "intensity", false},
    {SYNTAX_FOG, "color", false},
    {SYNTAX_FOG, "density", false},
    {SYNTAX_FOG, "height", false},
    {SYNTAX_FOG, "base", false},
    {SYNTAX_MEDIUM, "within", false},
    {SYNTAX_IMAGE, "size", false},
    {SYNTAX_IMAGE, "samples", false},
    {SYNTAX_IMAGE, "integrator", false},
    {SYNTAX_IMAGE, "exposure", false},
    {SYNTAX_IMAGE, "tone_map", false},
    {SYNTAX_IMAGE, "error", false},
    {SYNTAX_IMAGE, "noise", false},
    {SYNTAX_IMAGE, "pixel_filter", false},
    {SYNTAX_IMAGE, "white_balance", false},
    {SYNTAX_IMAGE, "frames", true},
    {SYNTAX_IMAGE, "rate", true},
    {SYNTAX_IMAGE, "bounces", false},
    {SYNTAX_ZONE, "center", false},
    {SYNTAX_ZONE, "radius", false},
    /* clang-format on */
};
enum { BLOCK_PROPERTY_COUNT = sizeof block_properties / sizeof *block_properties };

const char *property_of_block(SyntaxKind block, size_t index)
{
    if (block == SYNTAX_SHAPE)
        return property_of_shape(index);
    for (size_t i = 0; i < BLOCK_PROPERTY_COUNT; i++)
        if (block_properties[i].block == block && !block_properties[i].later && index-- == 0)
            return block_properties[i].name;
    return NULL;
}

const char *block_name(SyntaxKind kind)
{
    switch (kind) {
    case SYNTAX_MATERIAL: return "a material";
    case SYNTAX_CAMERA: return "a camera";
    case SYNTAX_LIGHT: return "a light";
    case SYNTAX_SKY: return "the sky";
    case SYNTAX_FOG: return "the fog";
    case SYNTAX_MEDIUM: return "a medium";
    case SYNTAX_ZONE: return "a zone";
    default: return "the image";
    }
}

static void unknown_property(Elaboration *e, const Syntax *block, const Syntax *property)
{
    const char *names[BLOCK_PROPERTY_COUNT];
    size_t      count = 0;
    for (size_t i = 0; i < BLOCK_PROPERTY_COUNT; i++)
        if (block_properties[i].block == block->kind && !block_properties[i].later)
            names[count++] = block_properties[i].name;
    Diag *diag            = diag_add(e->diags, DIAG_UNKNOWN_PROPERTY, property->name_span,
                                     "%s has no property `%s`", block_name(block->kind), property->name);
    diag->label           = "unknown property";
    const char *owner     = strchr(block_name(block->kind), ' ') + 1; /* without the article */
    bool        explained = explain_word(e->diags, diag, SYNONYM_PROPERTY, property->name, owner);
    if (!explained)
        diag->replacement = nearest_name(property->name, names, count);
    if (diag->replacement && !explained)
        diag->help = "a property with a similar name exists";
    note_names(e, diag, "its properties", names, count);
}

/* Tells whether a block may have a property; false: reported. */
static bool check_property(Elaboration *e, const Syntax *block, const Syntax *property)
{
    for (size_t i = 0; i < BLOCK_PROPERTY_COUNT; i++) {
        if (block_properties[i].block != block->kind ||
            strcmp(block_properties[i].name, property->name) != 0)
            continue;
        if (!block_properties[i].later)
            return true;
        not_supported(e, property->name_span,
                      diag_text(e->diags, "`%s` of %s", property->name, block_name(block->kind)));
        return false;
    }
    unknown_property(e, block, property);
    return false;
}

bool check_block(Elaboration *e, const Syntax *block)
{
    bool known = true;
    e->block   = block;
    for (uint32_t i = 0; i < block->count; i++) {
        const Syntax *property = block->children[i];
        if (property->kind != SYNTAX_PROPERTY || !check_property(e, block, property))
            known = false;
    }
    return known;
}

const Syntax *find_property(const Syntax *block, const char *name)
{
    for (uint32_t i = 0; i < block->count; i++)
        if (block->children[i]->kind == SYNTAX_PROPERTY &&
            strcmp(block->children[i]->name, name) == 0)
            return block->children[i]->children[0];
    return NULL;
}

/* ---- values of properties: frame time, except in materials ---- */

Node number_property(Elaboration *e, const Environment *env, const Syntax *block, const char *name,
                     double otherwise)
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return graph_number(e->graph, otherwise);
    Node node = to_number(e, evaluate(e, env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    return node == NODE_NONE ? graph_number(e->graph, otherwise) : node;
}

Node vector_property(Elaboration *e, const Environment *env, const Syntax *block, const char *name,
                     const double otherwise[3])
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return graph_constant(e->graph, TYPE_VEC3, otherwise);
    Node node = to_vector(e, evaluate(e, env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    return node == NODE_NONE ? graph_constant(e->graph, TYPE_VEC3, otherwise) : node;
}

/* Returns a position.  A `param` without a range may be anything, and says so at its frame. */
Node position_property(Elaboration *e, const Environment *env, const Syntax *block,
                       const char *name, const double otherwise[3])
{
    Node          position = vector_property(e, env, block, name, otherwise);
    const Syntax *syntax   = find_property(block, name);
    const char   *what     = diag_text(e->diags, "`%s`", name);
    for (uint32_t i = 0; syntax && i < 3; i++)
        if (!check_extent(e, node_range(e->builder, position, i), i, syntax, what))
            break;
    return position;
}

double constant_property(Elaboration *e, const Environment *env, const Syntax *block,
                         const char *name, double least, double most, double otherwise)
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return otherwise;
    Node node = to_number(e, evaluate(e, env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    if (node == NODE_NONE)
        return otherwise;
    double number = e->graph->items[node].number[0];
    if (!graph_is_constant(e->graph, node)) {
        Diag *diag  = diag_add(e->diags, DIAG_NOT_COMPILE_TIME, syntax->span,
                               "`%s` must be known at compile time", name);
        diag->label = "this depends on a `param` or on `time`";
        return otherwise;
    }
    if (!(number >= least && number <= most)) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span, "`%s` cannot be %g", name,
                               number);
        diag->label = diag_text(e->diags, "from %g to %g is possible", least, most);
        return otherwise;
    }
    return number;
}

const char *word_property(Elaboration *e, const Environment *env, const Syntax *block,
                          const char *name, const char *const *words)
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return NULL;
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_ERROR)
        return NULL;
    if (value.type != VALUE_STRING) {
        type_error(e, syntax, value, "a string");
        return NULL;
    }
    Text list = {.arena = e->diags->arena};
    for (size_t i = 0; words[i]; i++) {
        if (strcmp(words[i], value.string) == 0)
            return words[i];
        text_format(&list, "%s\"%s\"", i ? ", " : "", words[i]);
    }
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span, "`%s` cannot be \"%s\"", name,
                           value.string);
    diag->label = diag_text(e->diags, "one of %s", list.bytes);
    return NULL;
}
