/*
 * view.c: materials, cameras, lights, sky and image, and what stands in for those that a scene
 * leaves out.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>
#include <string.h>

/* Which blocks may have which property; `later` ones are known but not in this version. */
static const struct ViewProperty {
    SyntaxKind  block;
    const char *name;
    bool        later;
} view_properties[] = {
    {SYNTAX_MATERIAL, "color", false},
    {SYNTAX_MATERIAL, "roughness", false},
    {SYNTAX_MATERIAL, "metallic", false},
    {SYNTAX_MATERIAL, "emission", false},
    {SYNTAX_MATERIAL, "transmission", true},
    {SYNTAX_MATERIAL, "ior", true},
    {SYNTAX_MATERIAL, "absorption", true},
    {SYNTAX_CAMERA, "eye", false},
    {SYNTAX_CAMERA, "target", false},
    {SYNTAX_CAMERA, "up", false},
    {SYNTAX_CAMERA, "fov", false},
    {SYNTAX_CAMERA, "projection", false},
    {SYNTAX_CAMERA, "height", false},
    {SYNTAX_CAMERA, "aperture", true},
    {SYNTAX_CAMERA, "focus", true},
    {SYNTAX_CAMERA, "shutter", true},
    {SYNTAX_LIGHT, "direction", false},
    {SYNTAX_LIGHT, "position", false},
    {SYNTAX_LIGHT, "color", false},
    {SYNTAX_LIGHT, "intensity", false},
    {SYNTAX_LIGHT, "softness", false},
    {SYNTAX_LIGHT, "radius", false},
    {SYNTAX_LIGHT, "shadow", false},
    {SYNTAX_LIGHT, "size", true},
    {SYNTAX_SKY, "zenith", false},
    {SYNTAX_SKY, "horizon", false},
    {SYNTAX_SKY, "ground", false},
    {SYNTAX_SKY, "sun", false},
    {SYNTAX_SKY, "image", true},
    {SYNTAX_SKY, "rotation", true},
    {SYNTAX_IMAGE, "size", false},
    {SYNTAX_IMAGE, "samples", false},
    {SYNTAX_IMAGE, "integrator", false},
    {SYNTAX_IMAGE, "exposure", false},
    {SYNTAX_IMAGE, "tone_map", false},
    {SYNTAX_IMAGE, "error", false},
    {SYNTAX_IMAGE, "frames", true},
    {SYNTAX_IMAGE, "rate", true},
    {SYNTAX_IMAGE, "bounces", true},
    {SYNTAX_ZONE, "center", false},
    {SYNTAX_ZONE, "radius", false},
};
enum { VIEW_PROPERTY_COUNT = sizeof view_properties / sizeof *view_properties };

static const char *block_name(SyntaxKind kind)
{
    switch (kind) {
    case SYNTAX_MATERIAL: return "a material";
    case SYNTAX_CAMERA: return "a camera";
    case SYNTAX_LIGHT: return "a light";
    case SYNTAX_SKY: return "the sky";
    case SYNTAX_ZONE: return "a zone";
    default: return "the image";
    }
}

/* Whether a block may have a property; false: reported. */
static bool check_property(Elaboration *e, const Syntax *block, const Syntax *property)
{
    const char *names[VIEW_PROPERTY_COUNT];
    size_t      count = 0;
    for (size_t i = 0; i < VIEW_PROPERTY_COUNT; i++) {
        if (view_properties[i].block != block->kind)
            continue;
        names[count++] = view_properties[i].name;
        if (strcmp(view_properties[i].name, property->name) != 0)
            continue;
        if (!view_properties[i].later)
            return true;
        not_supported(e, property->name_span,
                      diag_text(e->diags, "`%s` of %s", property->name, block_name(block->kind)));
        return false;
    }
    const char *owner = block_name(block->kind);
    Diag       *diag  = diag_add(e->diags, DIAG_UNKNOWN_PROPERTY, property->name_span,
                                 "%s has no property `%s`", owner, property->name);
    diag->label       = "unknown property";
    diag->replacement = nearest_name(property->name, names, count);
    if (diag->replacement)
        diag->help = "a property with a similar name exists";
    return false;
}

static void check_block(Elaboration *e, const Syntax *block)
{
    for (uint32_t i = 0; i < block->count; i++) {
        const Syntax *property = block->children[i];
        if (property->kind != SYNTAX_PROPERTY || !check_property(e, block, property))
            continue;
        for (uint32_t k = 0; k < i; k++)
            if (block->children[k]->kind == SYNTAX_PROPERTY &&
                block->children[k]->name == property->name) {
                Diag *diag = diag_add(e->diags, DIAG_DUPLICATE_NAME, property->name_span,
                                      "`%s` is given twice", property->name);
                diag_secondary(e->diags, diag, block->children[k]->name_span, "given here first");
                break;
            }
    }
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

static Node number_property(Elaboration *e, const Environment *env, const Syntax *block,
                            const char *name, double otherwise)
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return graph_number(e->graph, otherwise);
    Node node = to_number(e, evaluate(e, env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    return node == NODE_NONE ? graph_number(e->graph, otherwise) : node;
}

static Node vector_property(Elaboration *e, const Environment *env, const Syntax *block,
                            const char *name, const double otherwise[3])
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return graph_constant(e->graph, TYPE_VEC3, otherwise);
    Node node = to_vector(e, evaluate(e, env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    return node == NODE_NONE ? graph_constant(e->graph, TYPE_VEC3, otherwise) : node;
}

/* A position.  A `param` without a range may be anything, and says so at its frame. */
static Node position_property(Elaboration *e, const Environment *env, const Syntax *block,
                              const char *name, const double otherwise[3])
{
    Node          position = vector_property(e, env, block, name, otherwise);
    const Syntax *syntax   = find_property(block, name);
    for (uint32_t i = 0; syntax && i < 3; i++) {
        Range  range = node_range(e, position, i);
        double far   = fmax(isfinite(range.low) ? fabs(range.low) : 0,
                          isfinite(range.high) ? fabs(range.high) : 0);
        if (far <= MOST_EXTENT)
            continue;
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span,
                               "`%s` reaches to %.3g on the %c axis", name, far, "xyz"[i]);
        diag->label = "farther than 1e12, which devices cannot compute with";
        break;
    }
    return position;
}

/* A number that must be known when the scene is compiled. */
static double constant_property(Elaboration *e, const Environment *env, const Syntax *block,
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

/* One of a few words, the last `later` of which are known but not in this version; NULL when it
   is not given, or not one that is there. */
static const char *word_property(Elaboration *e, const Environment *env, const Syntax *block,
                                 const char *name, const char *const *words, size_t count,
                                 size_t later)
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
    for (size_t i = 0; i < count; i++) {
        bool same = strcmp(words[i], value.string) == 0;
        if (same && i + later >= count) {
            not_supported(e, syntax->span, diag_text(e->diags, "`%s: \"%s\"`", name, words[i]));
            return NULL;
        }
        if (same)
            return words[i];
        if (i + later < count)
            text_format(&list, "%s\"%s\"", i ? ", " : "", words[i]);
    }
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span, "`%s` cannot be \"%s\"", name,
                           value.string);
    diag->label = diag_text(e->diags, "one of %s", list.bytes);
    return NULL;
}

/* ---- materials ---- */

/* A number or a colour that may depend on the point; *property stays when it is not given. */
static void material_property(Elaboration *e, const Environment *env, const Syntax *block,
                              const char *name, GraphType type, Node *property)
{
    const Syntax *syntax = find_property(block, name);
    if (!syntax)
        return;
    Value value = evaluate(e, env, syntax);
    Node  node  = value_node(e, value);
    if (node != NODE_NONE && type == TYPE_VEC3 && e->graph->items[node].type == TYPE_FLOAT)
        node = graph_op3(e->graph, OP_vec3, node, node, node);
    if (node != NODE_NONE && e->graph->items[node].type == type)
        *property = node;
    else
        type_error(e, syntax, value, type == TYPE_VEC3 ? "a colour" : "a number");
}

static Material *material_new(Elaboration *e, const char *name)
{
    Material *material  = arena_new(e->arena, Material);
    material->name      = name;
    material->color     = graph_vec3(e->graph, 0.6, 0.6, 0.6);
    material->roughness = graph_number(e->graph, 0.6);
    material->metallic  = graph_number(e->graph, 0);
    material->emission  = graph_vec3(e->graph, 0, 0, 0);
    return material;
}

Value elaborate_material(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    check_block(e, syntax);
    Material *material = material_new(e, syntax->name);
    bool      outer    = e->in_material;
    e->in_material     = true;
    material_property(e, env, syntax, "color", TYPE_VEC3, &material->color);
    material_property(e, env, syntax, "roughness", TYPE_FLOAT, &material->roughness);
    material_property(e, env, syntax, "metallic", TYPE_FLOAT, &material->metallic);
    material_property(e, env, syntax, "emission", TYPE_VEC3, &material->emission);
    e->in_material = outer;
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
        return material;
    }
    type_error(e, syntax, value, "a material or a colour");
    return NULL;
}

/* ---- cameras, lights, sky, image ---- */

static const double ORIGIN[3] = {0, 0, 0}, UP[3] = {0, 1, 0}, WHITE[3] = {1, 1, 1};

static void add_camera(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    static const char *const projections[] = {"perspective", "orthographic", "panorama"};
    static const double      eye[3]        = {4, 3, 6};
    SceneCamera              camera        = {.name = syntax->name};
    camera.eye                             = position_property(e, env, syntax, "eye", eye);
    camera.target                          = position_property(e, env, syntax, "target", ORIGIN);
    camera.up                              = vector_property(e, env, syntax, "up", UP);
    camera.fov       = number_property(e, env, syntax, "fov", 40 * M_PI / 180);
    camera.height    = number_property(e, env, syntax, "height", 4);
    const char *word = word_property(e, env, syntax, "projection", projections, 3, 0);
    while (word && projections[camera.projection] != word)
        camera.projection++;
    const Syntax *fov  = find_property(syntax, "fov");
    Range         span = node_range(e, camera.fov, 0);
    if (fov && (span.low <= 0 || span.high >= 3.14159)) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, fov->span,
                              "`fov` must lie between 0 and 180 degrees");
        diag->help = "angles are radians unless they end in `deg`: write `40deg`";
    }
    const Syntax *height = find_property(syntax, "height");
    if (height)
        check_positive(e, camera.height, height, "the height of the picture");
    Node          same   = graph_op2(e->graph, OP_sub, camera.eye, camera.target);
    const Syntax *target = find_property(syntax, "target");
    check_direction(e, same, target ? target : syntax, "the view of a camera, from eye to target,");
    array_push(e->arena, &e->scene->cameras, camera);
}

static void add_light(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Syntax *direction = find_property(syntax, "direction");
    const Syntax *position  = find_property(syntax, "position");
    SceneLight    light     = {.positional = position != NULL, .shadow = true};
    if (!direction == !position) {
        Diag *diag = diag_add(e->diags, direction ? DIAG_TOO_MANY_ARGUMENTS : DIAG_MISSING_ARGUMENT,
                              syntax->name_span,
                              "a light has either a `direction` or a `position`");
        diag->help = "for example `light sun { direction: [-1, 2, 1], intensity: 3 }`";
        return;
    }
    light.vector   = position ? position_property(e, env, syntax, "position", UP)
                              : vector_property(e, env, syntax, "direction", UP);
    Node color     = vector_property(e, env, syntax, "color", WHITE);
    Node intensity = number_property(e, env, syntax, "intensity", 1);
    light.color    = graph_op2(e->graph, OP_scale, color, intensity);
    light.softness = number_property(e, env, syntax, position ? "radius" : "softness", 0);
    if (direction)
        check_direction(e, light.vector, direction, "the direction of a light");
    const Syntax *shadow = find_property(syntax, "shadow");
    Value         value  = shadow ? evaluate(e, env, shadow) : value_boolean(true);
    if (value.type == VALUE_BOOLEAN)
        light.shadow = value.boolean;
    else
        type_error(e, shadow, value, "true or false");
    array_push(e->arena, &e->scene->lights, light);
}

static void set_sky(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    static const double zenith[3]  = {0.17, 0.26, 0.42};
    static const double horizon[3] = {0.56, 0.6, 0.66};
    static const double ground[3]  = {0.17, 0.165, 0.16};
    e->scene->zenith               = vector_property(e, env, syntax, "zenith", zenith);
    e->scene->horizon              = vector_property(e, env, syntax, "horizon", horizon);
    e->scene->ground               = vector_property(e, env, syntax, "ground", ground);
    /* `sun:` names the light that is the sun; every light is in the sky anyway. */
    const Syntax *sun = find_property(syntax, "sun");
    if (sun && sun->kind != SYNTAX_NAME)
        type_error(e, sun, evaluate(e, env, sun), "the name of a light");
}

static void set_size(Elaboration *e, const Syntax *size, Value value)
{
    Node node = value.type == VALUE_LIST ? value_node(e, value) : NODE_NONE;
    bool good = node != NODE_NONE && e->graph->items[node].type == TYPE_VEC2 &&
                graph_is_constant(e->graph, node);
    for (int i = 0; good && i < 2; i++) {
        double side = e->graph->items[node].number[i];
        good        = side >= 1 && side <= 16384 && side == floor(side);
    }
    if (good) {
        e->scene->image.width  = (uint32_t)e->graph->items[node].number[0];
        e->scene->image.height = (uint32_t)e->graph->items[node].number[1];
    } else if (value.type != VALUE_ERROR) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, size->span,
                              "`size` of the image must be two whole numbers from 1 to 16384");
        diag->help = "for example `size: [1280, 720]`";
    }
}

static void set_image(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    static const char *const integrators[] = {"preview", "direct", "path"};
    static const char *const tone_maps[]   = {"neutral", "aces", "none"};
    SceneImage              *image         = &e->scene->image;
    const Syntax            *size          = find_property(syntax, "size");
    if (size)
        set_size(e, size, evaluate(e, env, size));
    image->samples    = (uint32_t)constant_property(e, env, syntax, "samples", 1, 65536, 0);
    image->exposure   = constant_property(e, env, syntax, "exposure", -20, 20, 0);
    image->error      = constant_property(e, env, syntax, "error", 0.001, 1, 0);
    image->integrator = word_property(e, env, syntax, "integrator", integrators, 3, 2);
    image->tone_map   = word_property(e, env, syntax, "tone_map", tone_maps, 3, 0);
}

/* How deep a point is in the deepest of all zones: what the distance must not be below. */
static void add_zone(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Graph        *g      = e->graph;
    Scene        *scene  = e->scene;
    const Syntax *size   = find_property(syntax, "radius");
    Node          center = vector_property(e, env, syntax, "center", ORIGIN);
    Node          radius = number_property(e, env, syntax, "radius", 1);
    Range         range  = node_range(e, radius, 0);
    if (size && range.low < 0) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, size->span,
                               "the radius of a zone must not be negative");
        diag->label = diag_text(e->diags, range.low == range.high ? "this is %g" : "this can be %g",
                                range.low);
        if (range.low < range.high)
            diag->help = "give the `param` a range that is not negative, or use `max(..., 0)`";
        return;
    }
    g->here     = syntax->span;
    Node point  = graph_leaf(g, OP_POINT);
    Node offset = graph_op2(g, OP_sub, point, center);
    Node depth  = graph_op1(g, OP_length, offset);
    depth       = graph_op2(g, OP_sub, radius, depth);
    scene->zone = scene->zone == NODE_NONE ? depth : graph_op2(g, OP_max, scene->zone, depth);
    scene->zone_count++;
}

/* A scene has one sky, one image, and one camera without a name. */
static void check_single(Elaboration *e, const Syntax *syntax)
{
    if (syntax->kind == SYNTAX_LIGHT || syntax->kind == SYNTAX_ZONE || syntax->name)
        return;
    for (size_t i = 0; i < e->single.count; i++) {
        if (e->single.items[i]->kind != syntax->kind)
            continue;
        Diag *diag = diag_add(e->diags, DIAG_DUPLICATE_NAME, syntax->span, "%s is described twice",
                              block_name(syntax->kind));
        diag_secondary(e->diags, diag, e->single.items[i]->span, "described here first");
        if (syntax->kind == SYNTAX_CAMERA)
            diag->help = "give further cameras names: `camera side { ... }`";
        return;
    }
    array_push(e->arena, &e->single, syntax);
}

void elaborate_view(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    check_block(e, syntax);
    check_single(e, syntax);
    switch (syntax->kind) {
    case SYNTAX_CAMERA: add_camera(e, env, syntax); break;
    case SYNTAX_LIGHT: add_light(e, env, syntax); break;
    case SYNTAX_SKY: set_sky(e, env, syntax); break;
    case SYNTAX_ZONE: add_zone(e, env, syntax); break;
    default: set_image(e, env, syntax); break;
    }
}

/* ---- what a scene leaves out ---- */

/* Frames the bounded components, from above and to the right. */
static void default_camera(Elaboration *e)
{
    Box box = box_empty;
    for (size_t i = 0; i < e->scene->components.count; i++)
        if (box_is_finite(e->scene->components.items[i].shape->box))
            box = box_hull(box, e->scene->components.items[i].shape->box);
    double              target[3] = {0, 0, 0}, eye[3], radius = 2, fov = 35 * M_PI / 180;
    static const double towards[3] = {0.53, 0.37, 0.76};
    if (!box_is_empty(box)) {
        box_centre(box, target);
        radius = fmax(0.5 * box_diagonal(box), 1e-6);
    }
    for (int i = 0; i < 3; i++)
        eye[i] = target[i] + towards[i] * radius / sin(0.5 * fov);
    SceneCamera camera = {.standing_in = true,
                          .eye         = graph_constant(e->graph, TYPE_VEC3, eye),
                          .target      = graph_constant(e->graph, TYPE_VEC3, target),
                          .up          = graph_constant(e->graph, TYPE_VEC3, UP),
                          .fov         = graph_number(e->graph, fov),
                          .height      = graph_number(e->graph, 2 * radius)};
    array_push(e->arena, &e->scene->cameras, camera);
}

static void default_sun(Elaboration *e)
{
    SceneLight sun = {.shadow   = true,
                      .vector   = graph_vec3(e->graph, -0.5, 1, 0.6),
                      .color    = graph_vec3(e->graph, 2.9, 2.75, 2.5),
                      .softness = graph_number(e->graph, 0.02)};
    array_push(e->arena, &e->scene->lights, sun);
}

void complete_view(Elaboration *e)
{
    static const Syntax silent = {.kind = SYNTAX_SKY};
    if (e->scene->cameras.count == 0)
        default_camera(e);
    if (e->scene->lights.count == 0)
        default_sun(e);
    if (e->scene->zenith == NODE_NONE)
        set_sky(e, NULL, &silent);
}
