/*
 * precision.c: where single precision shows, so that points have to be relative to the camera.
 *
 * A coordinate is known to a few units in its last place, so the larger it is the less is known of
 * it.  That shows where it is more than a part of a pixel.  What is nearest to the eye is seen by
 * the narrowest pixels, so the eye and its distance decide.  The renderer asks this of the frame
 * that it has; the compiler has to tell before whether there may be such a frame, since the code
 * for it costs time.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/compilation.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/facts.h"

/* What a kernel takes a coordinate to be known to, relative (ROUNDING in frame.glsl). */
static const double ROUNDING = 2.4e-7;
/* Of a pixel: as much as a march leaves open (MOST_TOLERANCE in trace.comp). */
static const double MOST_OF_PIXEL = 1.0 / 64;

bool krs_needs_rebase(double coordinate, double pixel)
{
    return ROUNDING * coordinate > MOST_OF_PIXEL * pixel;
}

/* An eye that moves may come near to anything: then what is farther out than this, in units,
   needs it. */
static const double FAR_OUT = 64;
/* The narrowest pixels that pictures have: lines of twice the height that the scene says. */
enum { USUAL_HEIGHT = 720, TIMES_HEIGHT = 2 };

/* How far out the boxes of the components are, where they end. */
static double reach_of_boxes(const Scene *s)
{
    double reach = 0;
    for (size_t i = 0; i < 3 * s->components.count; i++) {
        Range side = s->components.items[i / 3].shape->box.axis[i % 3];
        if (isfinite(side.low) && isfinite(side.high))
            reach = fmax(reach, fmax(fabs(side.low), fabs(side.high)));
    }
    return reach;
}

/* All distances, and what is asked of the cameras. */
typedef struct ViewPrecision {
    const Scene *scene;
    Graph       *graph;
    const Roots *roots;
    Tape         tape;
    NodeValue   *values;
    Arena       *scratch;
} ViewPrecision;

static void run_defaults(ViewPrecision *view)
{
    const Scene *s     = view->scene;
    size_t       count = 0;
    Node        *roots = arena_new_array(view->scratch, Node,
                                         s->components.count + 3 * s->cameras.count + 1);
    for (size_t i = 0; i < s->components.count; i++)
        roots[count++] = distance_root(view->roots, i);
    for (size_t i = 0; i < s->cameras.count; i++) {
        roots[count++] = s->cameras.items[i].eye;
        roots[count++] = s->cameras.items[i].fov;
        roots[count++] = s->cameras.items[i].height;
    }
    size_t     slots      = view->graph->parameters.count;
    NodeValue *parameters = arena_new_array(view->scratch, NodeValue, slots + 1);
    for (size_t i = 0; i < s->parameters.count; i++)
        memcpy(parameters[s->parameters.items[i].slot].v, s->parameters.items[i].value,
               sizeof s->parameters.items[i].value);
    view->tape   = tape_new(view->graph, roots, count, view->scratch);
    view->values = arena_new_array(view->scratch, NodeValue, view->graph->count);
    tape_run_frame(&view->tape, parameters, view->values);
}

/* At the defaults of the parameters. */
static double nearest_to(const ViewPrecision *view, const double eye[3])
{
    double nearest = HUGE_VAL;
    tape_run_point(&view->tape, eye, view->values);
    for (size_t i = 0; i < view->scene->components.count; i++) {
        Node distance = distance_root(view->roots, i);
        nearest       = fmin(nearest, fabs(view->values[distance].v[0]));
    }
    return nearest;
}

/* How far out the eye may be for any values of the parameters. */
static double reach_of_eye(const ViewPrecision *view, Node eye)
{
    double reach = 0;
    Fact   fact  = graph_frame_fact(view->graph, eye, view->scratch);
    for (int i = 0; i < 3; i++)
        reach = fmax(reach, fmax(fabs(fact.value[i].low), fabs(fact.value[i].high)));
    return reach;
}

static double lines_of(const Scene *s)
{
    return TIMES_HEIGHT * (s->image.height ? s->image.height : USUAL_HEIGHT);
}

/* What the camera sees may be narrow as it is by default. */
static bool camera_needs_rebase(const ViewPrecision *view, const SceneCamera *camera)
{
    const double *eye     = view->values[camera->eye].v;
    double        nearest = nearest_to(view, eye), lines = lines_of(view->scene);
    double        pixel = camera->projection == KRS_ORTHOGRAPHIC
                              ? view->values[camera->height].v[0] / lines
                          : camera->projection == KRS_PANORAMA
                              ? M_PI * nearest / lines
                              : 2 * tan(view->values[camera->fov].v[0] / 2) * nearest / lines;
    return krs_needs_rebase(largest3(eye), pixel);
}

/* A camera that the compiler places stands as far away as the scene is large (framing.c). */
static bool scene_needs_rebase(const Scene *s)
{
    double size = 0;
    for (int i = 0; i < 3; i++)
        if (isfinite(s->box.axis[i].high - s->box.axis[i].low))
            size = fmax(size, s->box.axis[i].high - s->box.axis[i].low);
    return krs_needs_rebase(reach_of_boxes(s), 0.5 * size / lines_of(s));
}

bool may_need_rebase(const Scene *scene, Graph *graph, const Roots *roots, Arena *scratch)
{
    ViewPrecision view  = {.scene = scene, .graph = graph, .roots = roots, .scratch = scratch};
    bool          needs = false, moves = scene->cameras.count == 0;
    if (scene->zone_count > 0)
        return false;
    run_defaults(&view);
    for (size_t i = 0; i < view.tape.count && !moves; i++)
        moves = graph->items[view.tape.nodes[i]].time == TIME_FRAME;
    for (size_t i = 0; i < scene->cameras.count && !needs; i++) {
        const SceneCamera *camera = &scene->cameras.items[i];
        if (camera->standing_in)
            needs = scene_needs_rebase(scene) || (moves && reach_of_boxes(scene) > FAR_OUT);
        else
            needs = camera_needs_rebase(&view, camera) ||
                    (moves && reach_of_eye(&view, camera->eye) > FAR_OUT);
    }
    arena_free(scratch);
    return needs;
}
