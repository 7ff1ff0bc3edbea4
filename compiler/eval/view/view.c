/*
 * view.c: fog, image and zones, and defaults for those that a scene leaves out.
 */
#include "compiler/eval/view/view.h"

#include <math.h>

#include "compiler/base/elementary.h"

/* ---- fog, image, zones ---- */

/* Returns 1 over the height, unless that is 0: then the fog is as dense everywhere. */
static Node fog_fall(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Node          height = number_property(e, env, syntax, "height", 0);
    const Syntax *given  = find_property(syntax, "height");
    if (!given)
        return height;
    check_positive(e, height, given, "the height of the fog");
    return graph_op2(e->graph, OP_div, graph_number(e->graph, 1), height);
}

/* Sets the fog, whose color is that of the horizon, unless given. */
static void set_fog(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    static const double grey[3] = {0.56, 0.6, 0.66};
    const Syntax       *dense   = find_property(syntax, "density");
    SceneFog           *fog     = &e->scene->fog;
    fog->color                  = vector_property(e, env, syntax, "color", grey);
    fog->density                = number_property(e, env, syntax, "density", 0.05);
    fog->fall                   = fog_fall(e, env, syntax);
    fog->base                   = number_property(e, env, syntax, "base", 0);
    if (dense && node_range(e->builder, fog->density, 0).low < 0) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, dense->span,
                              "the density of the fog must not be negative");
        diag->help = "0 is no fog; 0.05 leaves a third of the light of what is 20 away";
    }
}

static void set_size(Elaboration *e, const Syntax *size, Value value)
{
    Node node = value.type == VALUE_LIST ? value_node(e, value) : NODE_NONE;
    bool good = node != NODE_NONE && e->graph->items[node].type == TYPE_VEC2 &&
                value.list->items[0].type == VALUE_NUMBER &&
                value.list->items[1].type == VALUE_NUMBER;
    for (int i = 0; good && i < 2; i++) {
        double side = value.list->items[i].number;
        good        = side >= 1 && side <= 16384 && side == floor(side);
    }
    if (good) {
        e->scene->image.width  = (uint32_t)value.list->items[0].number;
        e->scene->image.height = (uint32_t)value.list->items[1].number;
    } else if (value.type != VALUE_ERROR) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, size->span,
                              "`size` of the image must be two whole numbers from 1 to 16384");
        diag->help = "for example `size: [1280, 720]`";
    }
}

/* Kelvins, or a list of kelvins and tint; both are known at compile time. */
static void set_white_balance(Elaboration *e, const Syntax *white, Value value)
{
    Value        alone = value;
    const Value *given = value.type == VALUE_LIST ? value.list->items : &alone;
    size_t       count = value.type == VALUE_LIST ? value.list->count : 1;
    bool         good  = count == 1 || count == 2;
    for (size_t i = 0; good && i < count; i++)
        good = given[i].type == VALUE_NUMBER;
    if (good && given[0].number >= 1500 && given[0].number <= 15000 &&
        (count == 1 || fabs(given[1].number) <= 150)) {
        e->scene->image.white_balance[0] = given[0].number;
        e->scene->image.white_balance[1] = count == 2 ? given[1].number : 0;
    } else if (value.type != VALUE_ERROR) {
        Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, white->span,
                              "`white_balance` must be a temperature from 1500 to 15000 kelvins, "
                              "perhaps with a tint from -150 to 150");
        diag->help = "for example `white_balance: 3200` for light bulbs, or `[3200, 10]`";
    }
}

/* The words of choices.def; nobody asks for the filter "default". */
static const char *const integrators[] = {
#define KRS_INTEGRATOR(id, name, about) #name,
#include "krs/choices.def"
    NULL};
static const char *const tone_maps[] = {
#define KRS_TONE_MAP(id, name, about) #name,
#include "krs/choices.def"
    NULL};
static const char *const filters[] = {
#define KRS_PIXEL_FILTER(id, name, reach, integral, about) name,
#include "krs/choices.def"
    NULL};

static void set_image(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    SceneImage   *image = &e->scene->image;
    const Syntax *size  = find_property(syntax, "size");
    if (size)
        set_size(e, size, evaluate(e, env, size));
    image->samples      = (uint32_t)constant_property(e, env, syntax, "samples", 1, 65536, 0);
    image->bounces      = (uint32_t)constant_property(e, env, syntax, "bounces", 1, 1000, 0);
    image->exposure     = constant_property(e, env, syntax, "exposure", -20, 20, 0);
    image->error        = constant_property(e, env, syntax, "error", 0.001, 1, 0);
    image->noise        = constant_property(e, env, syntax, "noise", 0.0001, 1, 0);
    image->integrator   = word_property(e, env, syntax, "integrator", integrators);
    image->tone_map     = word_property(e, env, syntax, "tone_map", tone_maps);
    image->pixel_filter = word_property(e, env, syntax, "pixel_filter", filters + 1);
    const Syntax *white = find_property(syntax, "white_balance");
    if (white)
        set_white_balance(e, white, evaluate(e, env, white));
}

/* Tells how deep a point is in the deepest of all zones: what the distance must not be below. */
static void add_zone(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Graph        *g      = e->graph;
    Scene        *scene  = e->scene;
    const Syntax *size   = find_property(syntax, "radius");
    Node          center = vector_property(e, env, syntax, "center", ORIGIN);
    Node          radius = number_property(e, env, syntax, "radius", 1);
    Range         range  = node_range(e->builder, radius, 0);
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

/* A scene has one sky, one fog, one image, and one camera without a name. */
static void check_single(Elaboration *e, const Syntax *syntax)
{
    if (syntax->kind == SYNTAX_LIGHT || syntax->kind == SYNTAX_ZONE ||
        syntax->kind == SYNTAX_MEDIUM || syntax->name)
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
    bool known = check_block(e, syntax);
    check_single(e, syntax);
    switch (syntax->kind) {
    case SYNTAX_CAMERA: elaborate_camera(e, env, syntax); break;
    case SYNTAX_LIGHT:
        if (known) /* else what seems to be missing may have another name */
            elaborate_light(e, env, syntax);
        break;
    case SYNTAX_SKY: elaborate_sky(e, env, syntax); break;
    case SYNTAX_FOG: set_fog(e, env, syntax); break;
    case SYNTAX_MEDIUM:
        if (known)
            elaborate_medium(e, env, syntax);
        break;
    case SYNTAX_ZONE: add_zone(e, env, syntax); break;
    default: set_image(e, env, syntax); break;
    }
}

/* ---- what a scene leaves out ---- */

static const Syntax silent = {.kind = SYNTAX_SKY}; /* a block that says nothing */

/* Frames the bounded components and media, from above and to the right. */
static void default_camera(Elaboration *e)
{
    Box box = box_empty;
    for (size_t i = 0; i < e->scene->components.count; i++)
        if (box_is_finite(e->scene->components.items[i].shape->box))
            box = box_hull(box, e->scene->components.items[i].shape->box);
    for (size_t i = 0; i < e->scene->volumes.count; i++)
        box = box_hull(box, e->scene->volumes.items[i].within->box);
    double              target[3] = {0, 0, 0}, eye[3], radius = 2, fov = 35 * M_PI / 180;
    static const double towards[3] = {0.53, 0.37, 0.76};
    if (!box_is_empty(box)) {
        box_centre(box, target);
        radius = fmax(0.5 * box_diagonal(box), 1e-6);
    }
    for (int i = 0; i < 3; i++)
        eye[i] = target[i] + towards[i] * radius / real_sin(0.5 * fov);
    SceneCamera camera  = read_camera(e, NULL, &silent);
    camera.standing_in  = true;
    camera.nodes.eye    = graph_constant(e->graph, TYPE_VEC3, eye);
    camera.nodes.target = graph_constant(e->graph, TYPE_VEC3, target);
    camera.nodes.fov    = graph_number(e->graph, fov);
    camera.nodes.height = graph_number(e->graph, 2 * radius);
    array_push(e->arena, &e->scene->cameras, camera);
}

static void default_sun(Elaboration *e)
{
    SceneLight sun     = read_light(e, NULL, &silent);
    sun.nodes.vector   = graph_vec3(e->graph, -0.5, 1, 0.6);
    sun.nodes.color    = graph_vec3(e->graph, 2.9, 2.75, 2.5);
    sun.nodes.softness = graph_number(e->graph, 0.02);
    array_push(e->arena, &e->scene->lights, sun);
}

void complete_view(Elaboration *e)
{
    if (e->scene->cameras.count == 0)
        default_camera(e);
    const bool named = e->scene->sky.zenith != NODE_NONE || e->scene->sky.map;
    if (e->scene->sky.zenith == NODE_NONE)
        elaborate_sky(e, NULL, &silent);
    if (e->scene->lights.count == 0 && !named)
        default_sun(e);
    complete_sky(e);
    if (e->scene->fog.color == NODE_NONE) {
        set_fog(e, NULL, &silent);
        e->scene->fog.density = graph_number(e->graph, 0);
    }
}
