/*
 * precision.c: whether errors of single precision are visible, so that points must be
 * camera-relative.
 *
 * The error of a coordinate is a few units in its last place, so it grows with the coordinate.  It
 * is visible in two ways.  An outline moves where the error exceeds a fraction of a pixel.  A normal
 * is made of differences of distances, whose errors are as large: where the taps for it are near to one
 * another, the errors turn it.  So taps keep a distance that grows with the coordinate.  Where that is
 * more than a pixel, the normal is a mean over more than the pixel, and edges are blurred.
 *
 * Pixels are narrowest at the surface nearest to the eye, so the eye's coordinates and its distance
 * from that surface decide.  The renderer decides this for each frame.  The compiler has to find out
 * whether there may be such a frame.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/passes/compilation.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/bounds/facts.h"

/* The relative error of a coordinate that shaders assume (ROUNDING in frame.glsl). */
static const double ROUNDING = 2.4e-7;
/* The largest permitted error in pixels: the tolerance of a march (MAX_TOLERANCE in
   trace.comp). */
static const double MAX_OF_PIXEL = 1.0 / 64;

bool krs_needs_rebase(double coordinate, double pixel)
{
    return ROUNDING * coordinate > MAX_OF_PIXEL * pixel;
}

/* The least reach of taps for a normal, relative to coordinates, and their reach in pixels (NOISE in
   hit_lists.glsl; normal_reach in job.c). */
static const double NOISE = 1e-4, REACH_IN_PIXELS = 0.7;

double krs_normal_blur(double coordinate, double pixel)
{
    return NOISE * coordinate / (REACH_IN_PIXELS * pixel);
}

double krs_seen_reach(double distance, double pixel, double lines)
{
    return fmin(distance, 2 * pixel * lines);
}

bool krs_may_blur_normals(double coordinate, double distance, double pixel, double lines)
{
    return coordinate + distance > KRS_MIN_GAIN * krs_seen_reach(distance, pixel, lines) &&
           krs_normal_blur(coordinate + distance, pixel) > KRS_MIN_BLUR;
}

/* Answers of a device are relative to a nearer base where coordinates are so many times as large as what is
   seen, from its middle on (query.c of the runtime). */
static const double MAX_REACH = 10;

/* A moving eye may come near to any surface, so coordinates above this number need rebasing. */
static const double FAR_OUT = 64;
/* Pictures are assumed to have at most twice as many lines as the scene's image, or as usual. */
enum { USUAL_HEIGHT = 720, TIMES_HEIGHT = 2 };

/* Returns the largest coordinate of the sides of boxes of components; infinite sides do not count. */
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

/* The distances and the cameras' properties for the default values of parameters. */
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
        roots[count++] = s->cameras.items[i].nodes.eye;
        roots[count++] = s->cameras.items[i].nodes.fov;
        roots[count++] = s->cameras.items[i].nodes.height;
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

/* Returns the least distance of a component from the eye, for the defaults of the parameters. */
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

/* Returns the largest coordinate that the eye may have, for any values of the parameters. */
static double reach_of_eye(const ViewPrecision *view, Node eye)
{
    double reach = 0;
    for (uint32_t i = 0; i < 3; i++) {
        const Range range = graph_frame_range(view->graph, eye, i, view->scratch);
        reach             = fmax(reach, fmax(fabs(range.low), fabs(range.high)));
    }
    return reach;
}

static double lines_of(const Scene *s)
{
    return TIMES_HEIGHT * (s->image.height ? s->image.height : USUAL_HEIGHT);
}

/* Tells whether a camera needs rebasing with the default values of the parameters. */
static bool camera_needs_rebase(const ViewPrecision *view, const SceneCamera *camera)
{
    const double *eye     = view->values[camera->nodes.eye].v;
    double        nearest = nearest_to(view, eye), lines = lines_of(view->scene);
    double        pixel    = camera->projection == KRS_ORTHOGRAPHIC
                                 ? view->values[camera->nodes.height].v[0] / lines
                             : camera->projection == KRS_PANORAMA
                                 ? M_PI * nearest / lines
                                 : 2 * real_tan(view->values[camera->nodes.fov].v[0] / 2) * nearest / lines;
    const double  farthest = largest3(eye);
    return krs_needs_rebase(farthest, pixel) ||
           krs_may_blur_normals(farthest, nearest, pixel, lines);
}

/* Returns the longest side of the box of a scene that has an end. */
static double size_of(const Scene *s)
{
    double size = 0;
    for (int i = 0; i < 3; i++)
        if (isfinite(s->box.axis[i].high - s->box.axis[i].low))
            size = fmax(size, s->box.axis[i].high - s->box.axis[i].low);
    return size;
}

/* Tells whether a camera that the compiler places needs rebasing.  Its distance is about the size of the
   scene (framing.c). */
static bool scene_needs_rebase(const Scene *s)
{
    const double size  = size_of(s);
    const double reach = reach_of_boxes(s), lines = lines_of(s), pixel = 0.5 * size / lines;
    return krs_needs_rebase(reach, pixel) || krs_may_blur_normals(reach, 0.5 * size, pixel, lines);
}

bool may_need_rebase(const Scene *scene, Graph *graph, const Roots *roots, bool pictures,
                     Arena *scratch)
{
    ViewPrecision view  = {.scene = scene, .graph = graph, .roots = roots, .scratch = scratch};
    bool          needs = false, moves = scene->cameras.count == 0;
    run_defaults(&view);
    for (size_t i = 0; i < view.tape.count && !moves; i++)
        moves = graph->items[view.tape.nodes[i]].time == TIME_FRAME;
    for (size_t i = 0; i < scene->cameras.count && !needs; i++) {
        const SceneCamera *camera = &scene->cameras.items[i];
        if (camera->standing_in)
            needs = scene_needs_rebase(scene) || (moves && reach_of_boxes(scene) > FAR_OUT);
        else
            needs = camera_needs_rebase(&view, camera) ||
                    (moves && reach_of_eye(&view, camera->nodes.eye) > FAR_OUT);
    }
    if (!pictures && size_of(scene) > 0) /* a device may be asked about what no camera sees */
        needs = needs || reach_of_boxes(scene) > MAX_REACH * 0.5 * size_of(scene);
    arena_free(scratch);
    return needs;
}
