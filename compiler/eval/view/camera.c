/*
 * camera.c: cameras: where they stand, their lens and shutter.
 */
#include "compiler/eval/view/view.h"

#include <math.h>

#include "krs/krs.h"

static void report(Elaboration *e, const Syntax *at, const char *words, const char *help)
{
    Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, at->span, "%s", words);
    diag->help = help;
}

/* ---- kinds of camera.def ---- */

static Node ask_angle(const Asked *a, const char *name, const double otherwise[4])
{
    return ask_number(a, name, otherwise);
}

/* Returns the length along the view up to a point. */
static Node length_up_to(Graph *g, Node point, const CameraNodes *camera)
{
    Node offset = graph_op2(g, OP_sub, point, camera->eye);
    Node view   = graph_op2(g, OP_sub, camera->target, camera->eye);
    view        = graph_op1(g, OP_normalize, view);
    return graph_op2(g, OP_dot, offset, view);
}

static Node ask_focus(const Asked *a, const char *name, const double otherwise[4])
{
    Elaboration  *e     = a->e;
    const Syntax *given = find_property(a->block, name);
    Graph        *g     = e->graph;
    Node          found = NODE_NONE;
    if (!given)
        return graph_number(g, otherwise[0]);
    Value value  = evaluate(e, a->env, given);
    bool  length = value.type == VALUE_NUMBER ||
                  (value.type == VALUE_EXPRESSION && g->items[value.node].type == TYPE_FLOAT);
    if (length) {
        found = to_number(e, value, given, "`focus`");
        if (found != NODE_NONE)
            check_positive(e, found, given, "the distance of the focus");
    } else {
        Node point = to_vector(e, value, given, "`focus`");
        if (point != NODE_NONE)
            found = length_up_to(g, point, a->camera);
    }
    return found == NODE_NONE ? graph_number(g, otherwise[0]) : found;
}

static KrsProjection ask_projection(const Asked *a)
{
    static const char *const words[] = {
#define KRS_PROJECTION(id, name) #name,
#include "krs/camera.def"
        NULL};
    const char *word = word_property(a->e, a->env, a->block, "projection", words);
    uint32_t    i    = 0;
    while (word && words[i] != word)
        i++;
    return (KrsProjection)i;
}

/* ---- what is refused ---- */

static void check_fov(Elaboration *e, const Syntax *given, Node fov)
{
    Range span = node_range(e->builder, fov, 0);
    if (span.low > 0 && span.high < 3.14159)
        return;
    Diag *diag        = diag_add(e->diags, DIAG_BAD_VALUE, given->span,
                                 "`fov` must lie between 0 and 180 degrees");
    diag->replacement = degrees_instead(e, given);
    diag->help        = diag->replacement ? "angles are radians unless they end in `deg`"
                                          : "angles are radians unless they end in `deg`, as in `40deg`";
}

static void check_aperture(Elaboration *e, const Syntax *given, Node aperture)
{
    if (node_range(e->builder, aperture, 0).low < 0)
        report(e, given, "the aperture must not be negative",
               "it is the radius of the lens; 0 makes everything sharp");
}

static void check_shutter(Elaboration *e, const Syntax *given, Node shutter)
{
    Range open = node_range(e->builder, shutter, 0), close = node_range(e->builder, shutter, 1);
    if (close.low < open.high)
        report(e, given, "the shutter must not close before it opens",
               "for example `shutter: [0, 0.5]`: open for half of the time between frames");
}

static void check_view(Elaboration *e, const Syntax *syntax, const CameraNodes *camera)
{
    Node          same   = graph_op2(e->graph, OP_sub, camera->eye, camera->target);
    const Syntax *target = find_property(syntax, "target");
    check_direction(e, same, target ? target : syntax, "the view of a camera, from eye to target,");
}

static void check_positive_row(Elaboration *e, const Syntax *syntax, const char *name, Node node,
                               const char *what)
{
    const Syntax *given = find_property(syntax, name);
    if (what && given)
        check_positive(e, node, given, what);
}

/* A panorama has no lens: its rays part in all directions. */
static void check_panorama(Elaboration *e, const Syntax *syntax)
{
    enum { BODY, LENS };
    static const struct {
        const char *name;
        bool        of_lens;
    } rows[] = {
#define KRS_CAMERA(name, kind, part, positive, counts, ...) {#name, part == LENS},
#define KRS_CAMERA_FIXED(name, type, part, counts)          {#name, part == LENS},
#include "krs/camera.def"
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].of_lens && find_property(syntax, rows[i].name))
            report(e, find_property(syntax, rows[i].name),
                   diag_text(e->diags, "a panorama has no `%s`", rows[i].name),
                   "`projection: \"perspective\"` has");
}

static void check_camera(Elaboration *e, const Syntax *syntax, const SceneCamera *camera)
{
    const CameraNodes *nodes = &camera->nodes;
    const Syntax *fov = find_property(syntax, "fov"), *shutter = find_property(syntax, "shutter");
    const Syntax *aperture = find_property(syntax, "aperture");
    if (fov)
        check_fov(e, fov, nodes->fov);
    check_view(e, syntax, nodes);
    if (aperture)
        check_aperture(e, aperture, nodes->aperture);
    if (shutter)
        check_shutter(e, shutter, nodes->shutter);
#define KRS_CAMERA(name, kind, part, positive, counts, ...) \
    check_positive_row(e, syntax, #name, nodes->name, positive);
#include "krs/camera.def"
    if (camera->projection == KRS_PANORAMA)
        check_panorama(e, syntax);
}

/* ---- cameras ---- */

SceneCamera read_camera(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    const Syntax *stands = find_property(syntax, "eye");
    SceneCamera   camera = {
          .name = syntax->name, .span = stands ? stands->span : syntax->span, .block = syntax->span};
    const Asked asked = {e, env, syntax, &camera.nodes};
#define KRS_CAMERA(name, kind, part, positive, counts, ...) \
    camera.nodes.name = ask_##kind(&asked, #name, (const double[4]){__VA_ARGS__});
#include "krs/camera.def"
    camera.projection = ask_projection(&asked);
    camera.blades     = (uint32_t)constant_property(e, env, syntax, "blades", 3, 64, 0);
    camera.lens       = find_property(syntax, "aperture") || find_property(syntax, "shift");
    return camera;
}

void elaborate_camera(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    SceneCamera camera = read_camera(e, env, syntax);
    check_camera(e, syntax, &camera);
    array_push(e->arena, &e->scene->cameras, camera);
}
