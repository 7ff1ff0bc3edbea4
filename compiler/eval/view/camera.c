/*
 * camera.c: cameras: where they stand, their lens and shutter.
 */
#include "compiler/eval/view/view.h"

#include <math.h>

static const double ORIGIN[3] = {0, 0, 0}, UP[3] = {0, 1, 0};

/* ---- lens and shutter ---- */

/* Two numbers; [0, 0] when they are not given. */
static Node pair_property(Elaboration *e, const Environment *env, const Syntax *block,
                          const char *name)
{
    static const double none[4] = {0};
    const Syntax       *syntax  = find_property(block, name);
    Node                node    = NODE_NONE;
    if (syntax)
        node = to_pair(e, evaluate(e, env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    return node == NODE_NONE ? graph_constant(e->graph, TYPE_VEC2, none) : node;
}

static void report(Elaboration *e, const Syntax *at, const char *words, const char *help)
{
    Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, at->span, "%s", words);
    diag->help = help;
}

/* The length along the view up to what is sharp; 0: up to the target. */
static Node focus_of(Elaboration *e, const Environment *env, const Syntax *syntax,
                     const SceneCamera *camera)
{
    const Syntax *given = find_property(syntax, "focus");
    Graph        *g     = e->graph;
    if (!given)
        return graph_number(g, 0);
    Value value  = evaluate(e, env, given);
    bool  length = value.type == VALUE_NUMBER ||
                  (value.type == VALUE_EXPRESSION && g->items[value.node].type == TYPE_FLOAT);
    if (length) {
        Node node = to_number(e, value, given, "`focus`");
        if (node != NODE_NONE)
            check_positive(e, node, given, "the distance of the focus");
        return node == NODE_NONE ? graph_number(g, 0) : node;
    }
    Node point = to_vector(e, value, given, "`focus`");
    if (point == NODE_NONE)
        return graph_number(g, 0);
    Node offset = graph_op2(g, OP_sub, point, camera->eye);
    Node view   = graph_op2(g, OP_sub, camera->target, camera->eye);
    view        = graph_op1(g, OP_normalize, view);
    return graph_op2(g, OP_dot, offset, view);
}

static void check_shutter(Elaboration *e, const Syntax *given, Node shutter)
{
    Range open = node_range(e->builder, shutter, 0), close = node_range(e->builder, shutter, 1);
    if (close.low < open.high)
        report(e, given, "the shutter must not close before it opens",
               "for example `shutter: [0, 0.5]`: open for half of the time between frames");
}

/* A panorama has no lens: its rays part in all directions. */
static void check_projection(Elaboration *e, const Syntax *syntax, const SceneCamera *camera)
{
    static const char *const of_lens[] = {"aperture", "focus", "blades", "shift"};
    for (size_t i = 0; camera->projection == 2 && i < sizeof of_lens / sizeof *of_lens; i++)
        if (find_property(syntax, of_lens[i]))
            report(e, find_property(syntax, of_lens[i]),
                   diag_text(e->diags, "a panorama has no `%s`", of_lens[i]),
                   "`projection: \"perspective\"` has");
}

void camera_without_lens(Elaboration *e, SceneCamera *camera)
{
    const double none[3] = {0};
    camera->aperture = camera->focus = camera->eyes = graph_number(e->graph, 0);
    camera->shift = camera->shutter = graph_constant(e->graph, TYPE_VEC2, none);
}

static void add_lens(Elaboration *e, const Environment *env, const Syntax *syntax,
                     SceneCamera *camera)
{
    const Syntax *aperture = find_property(syntax, "aperture");
    const Syntax *shutter  = find_property(syntax, "shutter");
    const Syntax *eyes     = find_property(syntax, "eyes");
    camera->aperture       = number_property(e, env, syntax, "aperture", 0);
    camera->focus          = focus_of(e, env, syntax, camera);
    camera->blades         = (uint32_t)constant_property(e, env, syntax, "blades", 3, 64, 0);
    camera->shift          = pair_property(e, env, syntax, "shift");
    camera->shutter        = pair_property(e, env, syntax, "shutter");
    camera->eyes           = number_property(e, env, syntax, "eyes", 0);
    camera->lens           = aperture || find_property(syntax, "shift");
    if (aperture && node_range(e->builder, camera->aperture, 0).low < 0)
        report(e, aperture, "the aperture must not be negative",
               "it is the radius of the lens; 0 makes everything sharp");
    if (eyes)
        check_positive(e, camera->eyes, eyes, "the distance of the eyes");
    if (shutter)
        check_shutter(e, shutter, camera->shutter);
    check_projection(e, syntax, camera);
}

/* ---- cameras ---- */

void elaborate_camera(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    static const char *const projections[] = {"perspective", "orthographic", "panorama", NULL};
    static const double      eye[3]        = {4, 3, 6};
    const Syntax            *stands        = find_property(syntax, "eye");
    SceneCamera              camera        = {
                            .name = syntax->name, .span = stands ? stands->span : syntax->span, .block = syntax->span};
    camera.eye       = position_property(e, env, syntax, "eye", eye);
    camera.target    = position_property(e, env, syntax, "target", ORIGIN);
    camera.up        = vector_property(e, env, syntax, "up", UP);
    camera.fov       = number_property(e, env, syntax, "fov", 40 * M_PI / 180);
    camera.height    = number_property(e, env, syntax, "height", 4);
    const char *word = word_property(e, env, syntax, "projection", projections);
    while (word && projections[camera.projection] != word)
        camera.projection++;
    const Syntax *fov  = find_property(syntax, "fov");
    Range         span = node_range(e->builder, camera.fov, 0);
    if (fov && (span.low <= 0 || span.high >= 3.14159)) {
        Diag *diag        = diag_add(e->diags, DIAG_BAD_VALUE, fov->span,
                                     "`fov` must lie between 0 and 180 degrees");
        diag->help        = "angles are radians unless they end in `deg`";
        diag->replacement = degrees_instead(e, fov);
        if (!diag->replacement)
            diag->help = "angles are radians unless they end in `deg`, as in `40deg`";
    }
    const Syntax *height = find_property(syntax, "height");
    if (height)
        check_positive(e, camera.height, height, "the height of the picture");
    Node          same   = graph_op2(e->graph, OP_sub, camera.eye, camera.target);
    const Syntax *target = find_property(syntax, "target");
    check_direction(e, same, target ? target : syntax, "the view of a camera, from eye to target,");
    add_lens(e, env, syntax, &camera);
    array_push(e->arena, &e->scene->cameras, camera);
}
