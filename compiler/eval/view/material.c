/*
 * material.c: materials, and colours that stand for one.
 */
#include "compiler/eval/view/material.h"

#include <string.h>

#include "compiler/lower/lower.h"

/* Reports a value that is no colour; names of colours in quotes are a habit, as are textures alone. */
static void not_a_colour(Elaboration *e, const Syntax *syntax, Value value, const char *wanted)
{
    Diag *diag = type_error(e, syntax, value, wanted);
    if (value.type == VALUE_STRING)
        diag->help = form_help(e->diags, FORM_QUOTED_COLOUR);
    if (value.type == VALUE_TEXTURE)
        diag->help = "a texture has a colour at each place: `t(u, v)`, or `t(x, z)`";
}

/* Finds a direction that may depend on the point, of any length. */
static void direction_property(Elaboration *e, const Syntax *syntax, Value value, Node *property)
{
    Node node = value_node(e, value);
    if (node != NODE_NONE && e->graph->items[node].type == TYPE_VEC3)
        *property = node;
    else
        type_error(e, syntax, value, "a direction, such as `[1, 0, 0]`");
}

/* Finds a number or a colour that may depend on the point; *property stays when it is not given. */
static void material_property(Elaboration *e, const Environment *env, const Syntax *block,
                              const char *name, GraphType type, bool limited, Node *property)
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return;
    Value value = evaluate(e, env, syntax);
    Node  node  = value_node(e, value);
    if (strcmp(name, root_info[ROOT_tangent].name) == 0) {
        direction_property(e, syntax, value, property);
        return;
    }
    if (limited && type == TYPE_VEC3)
        warn_of_bright_colour(e, syntax, value, "what a surface sends out itself is `emission`");
    if (node != NODE_NONE && type == TYPE_VEC3 && e->graph->items[node].type == TYPE_FLOAT)
        node = graph_op3(e->graph, OP_vec3, node, node, node);
    if (node != NODE_NONE && e->graph->items[node].type == type)
        *property = node;
    else if (type == TYPE_VEC3)
        not_a_colour(e, syntax, value, "a colour");
    else
        type_error(e, syntax, value, "a number");
}

/* Returns the number of a material's name: each call of a material with parameters makes another. */
static uint32_t number_of_name(Elaboration *e, const char *name)
{
    Scene *scene = e->scene;
    for (size_t i = scene->materials.count; i > 0; i--)
        if (strcmp(scene->materials.items[i - 1], name) == 0)
            return (uint32_t)i;
    array_push(e->arena, &scene->materials, name);
    return (uint32_t)scene->materials.count;
}

static Material *material_new(Elaboration *e, const char *name)
{
    Material *material = arena_new(e->arena, Material);
    material->name     = name;
    material->bump     = NODE_NONE;
    material->number   = number_of_name(e, name);
#define KRS_MATERIAL(property, type, otherwise, nothing, low, high, asked, blends) \
    material->property = root_otherwise(e->graph, ROOT_##property);
#include "krs/surface.def"
    return material;
}

/* Returns the range of a property; at points it may be anything that pictures permit. */
static Range property_range(Elaboration *e, Node property)
{
    const bool varies = e->graph->items[property].time == TIME_POINT;
    return varies ? (Range){0, 1} : node_range(e->builder, property, 0);
}

/* Tells whether previews may have to follow a ray that this material mirrors or refracts (mirrors.glsl). */
static bool sends_rays(Elaboration *e, const Material *material)
{
    const bool metal = property_range(e, material->metallic).high > 0;
    return property_range(e, material->transmission).high > 0 ||
           property_range(e, material->roughness).low < (metal ? 0.3 : 0.12) ||
           (property_range(e, material->coat).high > 0 &&
            property_range(e, material->coat_roughness).low < 0.12);
}

/* Tells whether previews see more of this material than a body and a usual mirror (layers.glsl). */
static bool has_layers(Elaboration *e, const Material *material)
{
#define IS_USUAL(property) (material->property == root_otherwise(e->graph, ROOT_##property))
    return !(IS_USUAL(coat) && IS_USUAL(sheen) && IS_USUAL(specular) && IS_USUAL(ior) &&
             IS_USUAL(thin_film_weight) && IS_USUAL(specular_roughness_anisotropy));
}

Value elaborate_material(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    check_block(e, syntax);
    Material *material = material_new(e, syntax->name);
    bool      outer    = e->in_material;
    e->in_material     = true;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    material_property(e, env, syntax, #name, TYPE_##type, (high) <= 1, &material->name);
#include "krs/surface.def"
    material_property(e, env, syntax, "bump", TYPE_FLOAT, false, &material->bump);
    e->in_material        = outer;
    e->scene->mirrors     = e->scene->mirrors || sends_rays(e, material);
    e->scene->layers      = e->scene->layers || has_layers(e, material);
    e->scene->films       = e->scene->films || !IS_USUAL(thin_film_weight);
    e->scene->anisotropic = e->scene->anisotropic || !IS_USUAL(specular_roughness_anisotropy);
    return (Value){.type = VALUE_MATERIAL, .material = material};
}

const Material *to_material(Elaboration *e, Value value, const Syntax *syntax)
{
    if (value.type == VALUE_MATERIAL)
        return value.material;
    Node color = value.type == VALUE_LIST || value.type == VALUE_EXPRESSION ? value_node(e, value)
                                                                            : NODE_NONE;
    if (color != NODE_NONE && e->graph->items[color].type == TYPE_VEC3) {
        Material *material = material_new(e, "colour");
        material->color    = color;
        warn_of_bright_colour(e, syntax, value, "a surface reflects at most what it gets");
        return material;
    }
    not_a_colour(e, syntax, value, "a material or a colour");
    return NULL;
}
