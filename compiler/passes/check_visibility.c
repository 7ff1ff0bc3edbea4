/*
 * check_visibility.c: warns of components that no camera has in its picture, of cameras inside of a solid, and of lights that
 * are too dim to be seen, or hidden.
 *
 * Only what holds for all parameters and times is said of components: their boxes do, and cameras
 * that move are left out.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/passes/compilation.h"

/* Components that are looked up by their place at most: those of a short loop have the same one. */
enum { MAX_FOUND = 100 };

/* The space in the picture of a camera: the points q with dot(normal, q) <= offset for all planes. */
typedef struct Pyramid {
    bool   everything;
    int    planes;
    double normals[5][3], offsets[5];
} Pyramid;

static void add_plane(Pyramid *pyramid, const double normal[3], const double point[3])
{
    const int at = pyramid->planes++;
    memcpy(pyramid->normals[at], normal, sizeof pyramid->normals[at]);
    pyramid->offsets[at] = dot3(normal, point);
}

/* Returns the greatest width by height.  The size of a picture may be given when it is rendered:
   then it may be wider. */
static double widest_aspect(const KrsImage *image)
{
    return image->width ? (double)image->width / image->height : 4;
}

/* Adds the two planes at the ends of a picture along one of its axes. */
static void add_ends(Pyramid *pyramid, const KrsCamera *camera, const double forward[3],
                     const double axis[3], double half)
{
    for (int side = -1; side <= 1; side += 2) {
        double normal[3], point[3];
        for (int k = 0; k < 3; k++) {
            bool flat = camera->projection == KRS_ORTHOGRAPHIC;
            normal[k] = side * axis[k] - (flat ? 0 : half * forward[k]);
            point[k]  = camera->eye[k] + (flat ? side * half * axis[k] : 0);
        }
        add_plane(pyramid, normal, point);
    }
}

static Pyramid pyramid_of(const KrsCamera *camera, double aspect)
{
    Pyramid pyramid = {.everything = camera->projection == KRS_PANORAMA};
    double  forward[3], right[3], up[3], backward[3];
    for (int k = 0; k < 3; k++)
        forward[k] = camera->target[k] - camera->eye[k];
    cross3(forward, camera->up, right);
    if (pyramid.everything || !normalize3(forward) || !normalize3(right)) {
        pyramid.everything = true;
        return pyramid;
    }
    cross3(right, forward, up);
    bool   flat = camera->projection == KRS_ORTHOGRAPHIC;
    double half = flat ? 0.5 * camera->height : real_tan(0.5 * camera->fov);
    for (int k = 0; k < 3; k++)
        backward[k] = -forward[k];
    add_plane(&pyramid, backward, camera->eye);
    add_ends(&pyramid, camera, forward, right, half * aspect);
    add_ends(&pyramid, camera, forward, up, half);
    return pyramid;
}

/* Tells whether all of a box is beyond one of the planes. */
static bool is_outside(const Pyramid *pyramid, Box box)
{
    for (int i = 0; i < pyramid->planes; i++) {
        double nearest = 0;
        for (int k = 0; k < 3; k++) {
            double n = pyramid->normals[i][k];
            if (n != 0)
                nearest += n > 0 ? n * box.axis[k].low : n * box.axis[k].high;
        }
        if (nearest > pyramid->offsets[i])
            return true;
    }
    return false;
}

static bool camera_moves(const Graph *graph, const SceneCamera *camera)
{
    return
#define KRS_CAMERA(name, kind, part, positive, counts, ...) \
    !graph_is_constant(graph, camera->nodes.name) ||
#include "krs/camera.def"
        false;
}

/* Returns the pictures of all cameras; 0: one of them moves, has a lens, or frames all there is. */
static size_t find_pyramids(const Compilation *c, KrsState *state, Pyramid *pyramids)
{
    KrsView view;
    size_t  count = c->elaborated.cameras.count;
    for (size_t i = 0; i < count; i++) {
        const SceneCamera *camera = &c->elaborated.cameras.items[i];
        if (camera->standing_in || camera->lens || camera_moves(c->elaborated.graph, camera) ||
            state_view(state, i, &view) != KRS_OK)
            return 0;
        pyramids[i] = pyramid_of(&view.camera, widest_aspect(&view.image));
    }
    return count;
}

static bool is_in_view(const Pyramid *pyramids, size_t count, Box box)
{
    bool in_view = count == 0 || box_is_empty(box);
    for (size_t i = 0; i < count && !in_view; i++)
        in_view = pyramids[i].everything || !is_outside(&pyramids[i], box);
    return in_view;
}

/* Tells whether another component of the same `show`, in a loop, is in view. */
static bool is_partly_in_view(const Scene *scene, const Pyramid *pyramids, size_t count, Span span)
{
    for (size_t i = 0; i < scene->components.count; i++) {
        const Component *other = &scene->components.items[i];
        if (other->span.source == span.source && other->span.start == span.start &&
            is_in_view(pyramids, count, other->shape->box))
            return true;
    }
    return false;
}

static void warn_of_unseen(Compilation *c, const Pyramid *pyramids, size_t count)
{
    const Scene *scene     = &c->elaborated;
    size_t       looked_up = 0;
    for (size_t i = 0; i < scene->components.count && looked_up < MAX_FOUND; i++) {
        const Component *component = &scene->components.items[i];
        if (is_in_view(pyramids, count, component->shape->box))
            continue;
        looked_up++;
        if (is_partly_in_view(scene, pyramids, count, component->span))
            continue;
        Diag *diag  = diag_add(&c->diags, DIAG_OUT_OF_VIEW, component->span,
                               "`%s` is in the picture of no camera", component->name);
        diag->label = "all of this is outside of every view";
        diag->help =
            "look at it, or leave out the `camera`: then one is placed that sees everything";
    }
}

static void warn_of_inside(Compilation *c, KrsState *state)
{
    for (size_t i = 0; i < c->elaborated.cameras.count; i++) {
        const SceneCamera *camera = &c->elaborated.cameras.items[i];
        KrsView            view;
        KrsHit             hit;
        double             distance;
        const double(*eye)[3] = (const double(*)[3])view.camera.eye;
        if (camera->standing_in || state_view(state, i, &view) != KRS_OK ||
            krs_distance(state, eye, 1, &distance) != KRS_OK || !(distance < 0) ||
            krs_probe(state, eye, 1, &hit) != KRS_OK || hit.component == 0)
            continue;
        const Component *around = &c->elaborated.shown.items[hit.component - 1];
        Diag            *diag   = diag_add(&c->diags, DIAG_CAMERA_INSIDE, camera->span,
                                           "the camera is inside of `%s`", around->name);
        diag->label             = camera_moves(c->elaborated.graph, camera)
                                      ? "here, at time 0 and the defaults of the parameters"
                                      : "so only the inside of a solid is seen";
        diag->help              = "move `eye` out of it, or cut a `zone` around the camera";
        diag_secondary(&c->diags, diag, around->span, "this solid");
    }
}

/* The part of the light that white sends back where less than this arrives is as good as black. */
static const double DIM = 0.02;

/* Returns the largest value that a light gives to white: that is 1 for an intensity of pi at a
   distance of 1. */
static double brightest_value(const KrsView *view, const KrsLight *light, double distance)
{
    double color = fmax(light->color[0], fmax(light->color[1], light->color[2]));
    return color * real_exp2(view->image.exposure) / (distance * distance * M_PI);
}

/* A bound on the distance makes a light brighter than it is, so it is not blamed without cause. */
static void warn_of_dim_light(Compilation *c, KrsState *state, const KrsView *view, size_t index)
{
    const SceneLight *light = &c->elaborated.lights.items[index];
    const Graph      *graph = c->elaborated.graph;
    double            distance;
    if (!light->positional || !graph_is_constant(graph, light->nodes.vector) ||
        !graph_is_constant(graph, light->nodes.color) ||
        krs_distance(state, &view->lights[index].vector, 1, &distance) != KRS_OK ||
        !(distance > 0) || !isfinite(distance))
        return;
    double value = brightest_value(view, &view->lights[index], distance);
    if (!(value > 0) || value >= DIM)
        return;
    Diag *diag  = diag_add(&c->diags, DIAG_DIM_LIGHT, light->span,
                           "this light is too dim to be seen: the nearest surface is %.3g away",
                           distance);
    diag->label = "its light falls with the square of the distance";
    diag->help  = diag_text(&c->diags, "`intensity: %.2g` is as bright there as a good sun",
                            3 * distance * distance);
}

/* Returns the plane that hides all that a light sends to one side. */
static const Component *plane_before(const Compilation *c, const double direction[3])
{
    const Graph *graph = c->elaborated.graph;
    for (size_t i = 0; i < c->elaborated.components.count && c->elaborated.zone_count == 0; i++) {
        const Component *component = &c->elaborated.components.items[i];
        double           along     = 0, normal;
        if (!component_is_plane(component) || !graph_is_constant(graph, component->plane_normal))
            continue;
        for (uint32_t k = 0; k < 3; k++)
            if (graph_known_component(graph, component->plane_normal, k, &normal))
                along += normal * direction[k];
        if (along < -1e-6)
            return component;
    }
    return NULL;
}

/* Returns the solid around a light, all of which is in it; what lets light through is none. */
static const Component *solid_around(const Compilation *c, KrsState *state, const KrsLight *light)
{
    const double reach = light->softness + 0.5 * real_hypot(light->size[0], light->size[1]);
    double       distance;
    KrsHit       hit;
    if (krs_distance(state, &light->vector, 1, &distance) != KRS_OK || !(distance < -reach) ||
        krs_probe(state, &light->vector, 1, &hit) != KRS_OK || hit.component == 0)
        return NULL;
    const Component *shown = &c->elaborated.shown.items[hit.component - 1];
    return c->is_medium[shown->lowered] ? NULL : shown;
}

static void warn_of_hidden_light(Compilation *c, KrsState *state, const KrsView *view, size_t index)
{
    const SceneLight *light = &c->elaborated.lights.items[index];
    const KrsLight   *now   = &view->lights[index];
    const Graph      *graph = c->elaborated.graph;
    if (!light->shadow || !graph_is_constant(graph, light->nodes.vector) ||
        !graph_is_constant(graph, light->nodes.softness) ||
        !graph_is_constant(graph, light->nodes.size))
        return;
    const Component *before = light->positional ? solid_around(c, state, now)
                                                : plane_before(c, now->vector);
    if (!before)
        return;
    Diag *diag  = diag_add(&c->diags, DIAG_HIDDEN_LIGHT, light->span,
                          light->positional
                               ? "this light lights nothing: it is inside of `%s`"
                               : "this light lights nothing: it shines from behind `%s`",
                           before->name);
    diag->label = "so all is in its shadow";
    diag->help  = light->positional
                      ? "move it out of there, or give it `shadow: false`"
                      : "`direction` goes to the light, as in `direction: [0, 1, 0]` of one above";
    diag_secondary(&c->diags, diag, before->span, light->positional ? "this solid" : "this plane");
}

static void warn_of_lights(Compilation *c, KrsState *state)
{
    KrsView view;
    if (c->elaborated.cameras.count == 0 || state_view(state, 0, &view) != KRS_OK)
        return;
    for (size_t i = 0; i < c->elaborated.lights.count; i++) {
        warn_of_dim_light(c, state, &view, i);
        warn_of_hidden_light(c, state, &view, i);
    }
}

KrsStatus pass_visibility(Compilation *c)
{
    Pyramid  *pyramids = arena_new_array(&c->scratch, Pyramid, c->elaborated.cameras.count + 1);
    KrsState *state;
    KrsStatus status = state_new(c->scene, &state);
    if (status != KRS_OK)
        return status;
    warn_of_unseen(c, pyramids, find_pyramids(c, state, pyramids));
    warn_of_inside(c, state);
    warn_of_lights(c, state);
    state_free(state);
    return KRS_OK;
}

void print_visibility(Compilation *c, Text *out)
{
    size_t before = out->length;
    for (size_t i = 0; i < c->diags.count; i++) {
        DiagCode code = c->diags.items[i]->code;
        if (code == DIAG_OUT_OF_VIEW || code == DIAG_CAMERA_INSIDE || code == DIAG_DIM_LIGHT ||
            code == DIAG_HIDDEN_LIGHT)
            text_format(out, "%s\n", c->diags.items[i]->message);
    }
    if (out->length == before)
        text_add(out,
                 "all cameras are free, and see all components; no light is too dim or hidden\n");
}
