/*
 * validate.c: `krs validate`: tries to refute what the compiler claims of a scene.
 *
 * Four attempts.  A directed search (compiler/refute/search.h) looks for points where the distance of a
 * component, or of a shape in it, breaks its bound, and blames a shape.  The SPIR-V validator
 * looks at every module.  On the processor, in double precision, a distance claims that the ball
 * around its point is empty, so anywhere inside the ball the sign must be the same; the places
 * tried are random, and straight towards the surface, which is where a distance that is too large
 * is found out first.  On the device the distance is compared with the one in double precision.
 *
 * Of estimates (of Mandelbulbs) nothing is proven: how much of the way to the surface they reach is
 * measured, straight towards it and in random directions, and reported; only more than all of it
 * is wrong.
 *
 * Half of the points are anywhere in and around the scene, half near a surface, found by
 * following random rays.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/modules.h"
#include "cli/shell/supervise.h"
#include "compiler/base/splitmix.h"

enum { BATCH = 1024, PROBES = 8, MARCH_STEPS = 64, MEASURE_STEPS = 96 };

/* The part of the ball that must be empty: the rest is left to the rounding of the sum. */
static const double BALL = 0.999;
/* The size of a scene that has no bounds of its own, in world units. */
static const double UNBOUNDED = 10;
/* Device against double precision.  Positions are rounded to float, 2^-24 of the scene's size,
   and reliability allows 16 of these times a condition near 10 for chains of foldings:
   160 * 2^-24 = 1e-5.  The relative part is the device's functions: the worst is good to 1e-4. */
static const double TOLERANCE_OF_SCALE = 1e-5, TOLERANCE_OF_VALUE = 1e-4;

typedef struct Validation {
    const Options *options;
    const char    *path, *name; /* the latter is printed */
    KrsScene      *scene;
    KrsState      *state;
    uint64_t       random;                /* state of the generator */
    double         low[3], high[3], size; /* the box that is tried, and its diagonal */
    uint64_t       balls;                 /* probes inside of balls so far */
    uint64_t       estimates;             /* distances compared with estimates, */
    double         reached;    /* and the largest ratio of the estimate to the true distance */
    double         difference; /* largest of the device so far, in tolerances */
    double         points[BATCH][3];
} Validation;

static void random_direction(uint64_t *state, double direction[3])
{
    double z = 2 * splitmix_unit(state) - 1, angle = 2 * acos(-1) * splitmix_unit(state);
    double radius = sqrt(fmax(0, 1 - z * z));
    direction[0]  = radius * cos(angle);
    direction[1]  = radius * sin(angle);
    direction[2]  = z;
}

/* Chooses the box around the scene, half as large again; where the scene goes on for ever, a cut;
   around nothing, any. */
static void choose_box(Validation *v)
{
    const KrsProgram *program = krs_scene_program(v->scene);
    double            square  = 0;
    for (int axis = 0; axis < 3; axis++) {
        double low  = fmax(program->low[axis], -UNBOUNDED);
        double high = fmin(program->high[axis], UNBOUNDED);
        if (isfinite(program->low[axis]) && isfinite(program->high[axis])) {
            low  = program->low[axis];
            high = program->high[axis];
        }
        if (program->low[axis] > program->high[axis])
            low = high = 0;
        double margin = low < high ? (high - low) / 4 : 1;
        v->low[axis]  = fmin(low, high) - margin;
        v->high[axis] = fmax(low, high) + margin;
        square += (v->high[axis] - v->low[axis]) * (v->high[axis] - v->low[axis]);
    }
    v->size = sqrt(square);
}

/* Moves every second point of the batch along a random ray until it is close to a surface. */
static void march_to_surface(Validation *v)
{
    double directions[BATCH][3], distances[BATCH];
    for (size_t i = 0; i < BATCH; i++)
        random_direction(&v->random, directions[i]);
    for (int step = 0; step < MARCH_STEPS; step++) {
        krs_distance_bound(v->state, (const double(*)[3])v->points, BATCH, distances);
        for (size_t i = 1; i < BATCH; i += 2) {
            double advance = 0.9 * distances[i]; /* arrives nearly, from either side */
            if (fabs(advance) > 1e-3 * v->size && isfinite(advance))
                for (int axis = 0; axis < 3; axis++)
                    v->points[i][axis] += advance * directions[i][axis];
        }
    }
}

static void choose_points(Validation *v)
{
    for (size_t i = 0; i < BATCH; i++)
        for (int axis = 0; axis < 3; axis++)
            v->points[i][axis] = v->low[axis] +
                                 splitmix_unit(&v->random) * (v->high[axis] - v->low[axis]);
    march_to_surface(v);
    /* Moves points outside of the box into it: rays that missed are far away, where nothing can be
       learned. */
    for (size_t i = 1; i < BATCH; i += 2)
        for (int axis = 0; axis < 3; axis++)
            if (!(v->points[i][axis] >= v->low[axis] && v->points[i][axis] <= v->high[axis]))
                v->points[i][axis] = v->low[axis] +
                                     splitmix_unit(&v->random) * (v->high[axis] - v->low[axis]);
}

static void print_point(const char *words, const double point[3])
{
    printf("%s [", words);
    for (int axis = 0; axis < 3; axis++) {
        print_number(stdout, point[axis]);
        fputs(axis < 2 ? ", " : "]", stdout);
    }
}

/* Prints " of component 2 (`ring`)" at the place of a counter-example. */
static void print_component(const Validation *v, const double point[3])
{
    KrsHit       hit;
    KrsComponent component;
    krs_probe(v->state, (const double(*)[3])point, 1, &hit);
    if (hit.component > 0 && krs_component(v->scene, hit.component - 1, &component) == KRS_OK)
        printf(" near component %u (%s)", hit.component, component.name);
}

static KrsStatus report_ball(const Validation *v, const double center[3], double distance,
                             const double inside[3], double found)
{
    printf("%s: refuted: the distance ", v->name);
    print_number(stdout, distance);
    print_point(" at", center);
    print_point(" is too large:", inside);
    fputs(" is nearer and has the other sign, ", stdout);
    print_number(stdout, found);
    print_component(v, inside);
    putchar('\n');
    return KRS_BAD_SCENE;
}

/* Chooses a place in the ball around hit->point: the first probe goes straight to the surface, the
   others half to the edge of the ball and half anywhere in it. */
static void choose_inside(Validation *v, const KrsHit *hit, int probe, double inside[3])
{
    double direction[3], radius = BALL * fabs(hit->distance);
    random_direction(&v->random, direction);
    if (probe == 0)
        for (int axis = 0; axis < 3; axis++)
            direction[axis] = hit->distance > 0 ? -hit->normal[axis] : hit->normal[axis];
    else if (probe % 2 == 0)
        radius *= cbrt(splitmix_unit(&v->random));
    for (int axis = 0; axis < 3; axis++)
        inside[axis] = hit->point[axis] + radius * direction[axis];
}

/* Tells whether a distance is more than rounding. */
static bool is_worth_trying(const Validation *v, double distance)
{
    return isfinite(distance) && fabs(distance) > 1e-9 * v->size;
}

static bool is_estimate(const Validation *v, const KrsHit *hit)
{
    KrsComponent component;
    return hit->component > 0 &&
           krs_component(v->scene, hit->component - 1, &component) == KRS_OK && component.estimate;
}

/* Goes on from half the distance, by half of what is found there, until the sign changes. */
static void measure_estimates(Validation *v, const KrsHit *hits, bool straight)
{
    double directions[BATCH][3], lengths[BATCH], points[BATCH][3], found[BATCH];
    bool   going[BATCH], any = false;
    for (size_t i = 0; i < BATCH; i++) {
        random_direction(&v->random, directions[i]);
        double side = hits[i].distance > 0 ? -1 : 1;
        for (int axis = 0; axis < 3 && straight; axis++)
            directions[i][axis] = side * hits[i].normal[axis];
        going[i]   = is_worth_trying(v, hits[i].distance) && is_estimate(v, &hits[i]);
        lengths[i] = 0.5 * fabs(hits[i].distance);
        any        = any || going[i];
    }
    for (int step = 0; any && step < MEASURE_STEPS; step++) {
        for (size_t i = 0; i < BATCH; i++)
            for (int axis = 0; axis < 3; axis++)
                points[i][axis] = hits[i].point[axis] + lengths[i] * directions[i][axis];
        krs_distance_bound(v->state, (const double(*)[3])points, BATCH, found);
        for (size_t i = 0; i < BATCH; i++) {
            if (!going[i])
                continue;
            going[i] = hits[i].distance > 0 ? found[i] > 0 : found[i] < 0;
            if (!going[i]) {
                v->estimates++;
                v->reached = fmax(v->reached, fabs(hits[i].distance) / lengths[i]);
            }
            lengths[i] += fmax(0.5 * fabs(found[i]), 1e-3 * fabs(hits[i].distance));
        }
    }
}

/* The part of the way over which an estimate may be too long: the rest is rounding. */
static const double ALL_OF_THE_WAY = 1.001;

static KrsStatus report_estimate(const Validation *v)
{
    printf("%s: refuted: an estimate is %.3f times as long as the way to the surface\n", v->name,
           v->reached);
    return KRS_BAD_SCENE;
}

static KrsStatus try_balls(Validation *v)
{
    KrsHit hits[BATCH];
    double inside[BATCH][3], found[BATCH];
    krs_probe(v->state, (const double(*)[3])v->points, BATCH, hits);
    for (size_t i = 0; i < BATCH; i++)
        if (isnan(hits[i].distance)) {
            printf("%s: refuted: the distance", v->name);
            print_point(" at", v->points[i]);
            puts(" is not a number");
            return KRS_BAD_SCENE;
        }
    for (int probe = 0; probe < PROBES; probe++) {
        for (size_t i = 0; i < BATCH; i++)
            if (is_worth_trying(v, hits[i].distance))
                choose_inside(v, &hits[i], probe, inside[i]);
            else
                memcpy(inside[i], v->points[i], sizeof inside[i]);
        krs_distance_bound(v->state, (const double(*)[3])inside, BATCH, found);
        for (size_t i = 0; i < BATCH; i++) {
            if (!is_worth_trying(v, hits[i].distance) || is_estimate(v, &hits[i]))
                continue;
            v->balls++;
            if (!(hits[i].distance > 0 ? found[i] >= 0 : found[i] <= 0))
                return report_ball(v, v->points[i], hits[i].distance, inside[i], found[i]);
        }
    }
    measure_estimates(v, hits, true);
    measure_estimates(v, hits, false);
    return v->reached > ALL_OF_THE_WAY ? report_estimate(v) : KRS_OK;
}

/* Tells whether shaders may have found a distance in a cell that is a little aside, as they compute in
   single precision. */
static bool is_of_cell_aside(Validation *v, const double point[3], double answered,
                             double tolerance)
{
    enum { CORNERS = 8 };
    const double aside = 0.1 * tolerance;
    double       around[CORNERS][3], bounds[CORNERS], least = INFINITY, most = -INFINITY;
    for (int i = 0; i < CORNERS; i++)
        for (int axis = 0; axis < 3; axis++)
            around[i][axis] = point[axis] + (i >> axis & 1 ? aside : -aside);
    krs_distance_bound(v->state, (const double(*)[3])around, CORNERS, bounds);
    for (int i = 0; i < CORNERS; i++) {
        least = fmin(least, bounds[i]);
        most  = fmax(most, bounds[i]);
    }
    return answered >= least - tolerance && answered <= most + tolerance;
}

/* Both sides are asked about the same float positions. */
static KrsStatus try_device(Validation *v, KrsRenderer *renderer, KrsRendering *rendering)
{
    float  given[BATCH][3], answered[BATCH];
    double rounded[BATCH][3], expected[BATCH];
    for (size_t i = 0; i < BATCH; i++)
        for (int axis = 0; axis < 3; axis++)
            rounded[i][axis] = given[i][axis] = (float)v->points[i][axis];
    KrsStatus status = krs_device_distance(rendering, v->state, (const float(*)[3])given, BATCH,
                                           answered);
    if (status != KRS_OK) {
        say("%s", krs_renderer_message(renderer));
        return status;
    }
    krs_distance_bound(v->state, (const double(*)[3])rounded, BATCH, expected);
    for (size_t i = 0; i < BATCH; i++) {
        double tolerance  = TOLERANCE_OF_SCALE * v->size + TOLERANCE_OF_VALUE * fabs(expected[i]);
        double difference = fabs(answered[i] - expected[i]) / tolerance;
        if (difference <= 1 || (isinf(expected[i]) && answered[i] > 1e30f)) {
            v->difference = fmax(v->difference, isfinite(difference) ? difference : 0);
            continue;
        }
        if (krs_table_cells(v->scene) > 0 &&
            is_of_cell_aside(v, rounded[i], answered[i], tolerance))
            continue;
        printf("%s: refuted: the device finds the distance %.9g", v->name, answered[i]);
        print_point(" at", rounded[i]);
        fputs(", double precision ", stdout);
        print_number(stdout, expected[i]);
        print_component(v, rounded[i]);
        putchar('\n');
        return KRS_BAD_SCENE;
    }
    return KRS_OK;
}

/* Tries all points, in batches; `rendering` is NULL without a device. */
static KrsStatus try_points(Validation *v, KrsRenderer *renderer, KrsRendering *rendering)
{
    Progress  progress;
    KrsStatus status = KRS_OK;
    uint64_t  tried  = 0;
    stage_enter(STAGE_VALIDATE);
    progress_start(&progress, v->options, 1);
    while (tried < v->options->points && status == KRS_OK) {
        choose_points(v);
        status = try_balls(v);
        if (status == KRS_OK && rendering)
            status = try_device(v, renderer, rendering);
        if (*interrupted())
            status = KRS_INTERRUPTED;
        tried += BATCH;
        progress_show(&progress, (double)tried / (double)v->options->points);
    }
    progress_end(&progress);
    if (status != KRS_OK)
        return status;
    printf("%s: %llu points: %llu places in empty balls are empty", v->name,
           (unsigned long long)tried, (unsigned long long)v->balls);
    if (rendering)
        printf("; %s agrees, at most %.2g of the tolerance apart",
               krs_renderer_device(renderer).name, v->difference);
    putchar('\n');
    if (v->estimates > 0)
        printf("%s: estimates reach at most %.3f of the way to the surface, of %llu ways\n",
               v->name, v->reached, (unsigned long long)v->estimates);
    return KRS_OK;
}

static KrsStatus try_modules(const Validation *v)
{
    Modules   modules;
    KrsStatus status = modules_compile(v->options, v->scene, &modules);
    if (status == KRS_OK)
        printf("%s: %zu modules are valid SPIR-V\n", v->name, modules.count);
    modules_free(&modules);
    return status;
}

/* ---- the search ---- */

static bool report_progress(void *user, double fraction)
{
    Progress *progress = user;
    progress_show(progress, fraction);
    return !*interrupted();
}

static KrsStatus report_search(const Validation *v, KrsStatus status, const KrsRefutation *result)
{
    if (result->refuted)
        printf("%s: refuted: the distance of a shape\n", v->name);
    if (status != KRS_OK)
        return status;
    printf("%s: %zu shapes searched, at %zu settings, by %llu distances: "
           "no slope above %.6g of 1\n",
           v->name, result->shapes, result->settings, (unsigned long long)result->evaluations,
           result->steepest);
    if (result->refused > 0)
        printf("%s: %zu times no setting was found that is finite everywhere\n", v->name,
               result->refused);
    if (result->skipped > 0)
        printf("%s: %zu shapes are too large to be searched\n", v->name, result->skipped);
    if (result->estimates > 0)
        printf("%s: %zu shapes are estimates, of at most %.3f of the way to the surface\n", v->name,
               result->estimates, result->longest);
    return KRS_OK;
}

static KrsStatus try_search(Validation *v)
{
    const Options   *options = v->options;
    size_t           count   = options->settings.count;
    DiagnosticSink   sink    = {.options = options};
    KrsOptions       with    = scene_options(&sink, v->path);
    struct KrsFixed *fixed   = arena_new_array(options->arena, struct KrsFixed, count + 1);
    for (size_t i = 0; i < count; i++) {
        const Setting *setting = &options->settings.items[i];
        fixed[i]               = (struct KrsFixed){.name = setting->name, .count = setting->count};
        memcpy(fixed[i].values, setting->values, sizeof fixed[i].values);
    }
    Progress         progress;
    KrsRefutation    result;
    KrsRefuteOptions how = {.seconds     = options->seconds,
                            .seed        = options->seed,
                            .time        = options->time,
                            .fixed       = fixed,
                            .fixed_count = count,
                            .progress    = report_progress,
                            .user        = &progress};
    stage_enter(STAGE_VALIDATE);
    progress_start(&progress, options, 1);
    KrsStatus status = krs_refute(scene_input(options, v->path), options->input_length, v->path,
                                  &with, &how, &result);
    progress_end(&progress);
    scene_print_counts(&sink);
    return report_search(v, status, &result);
}

/* Validates a scene; `renderer` is NULL without a device. */
static KrsStatus validate_scene(Validation *v, KrsRenderer *renderer)
{
    KrsRendering *rendering = NULL;
    KrsStatus     status    = scene_open(v->options, v->path, &v->scene);
    if (status != KRS_OK)
        return status;
    choose_box(v);
    status = scene_state(v->options, v->scene, &v->state);
    if (status == KRS_OK && v->options->seconds > 0)
        status = try_search(v);
    const bool shaders = !krs_scene_too_large(v->scene);
    if (status == KRS_OK && shaders)
        status = try_modules(v);
    if (status == KRS_OK && shaders && renderer) {
        stage_enter(STAGE_SHADERS);
        status = krs_rendering_new(renderer, v->scene, KRS_FOR_PICTURES, &rendering);
        if (status != KRS_OK)
            say("%s", krs_renderer_message(renderer));
    }
    if (status == KRS_OK)
        status = try_points(v, renderer, rendering);
    krs_rendering_free(rendering);
    krs_state_free(v->state);
    krs_scene_free(v->scene);
    return status;
}

/* Goes through all scenes and returns the status of the first that failed. */
KrsStatus command_validate(Options *options)
{
    KrsRenderer *renderer = NULL;
    KrsStatus    worst    = options->no_device ? KRS_OK : open_renderer(options, &renderer);
    if (worst != KRS_OK)
        return worst;
    for (size_t i = 0; i < options->files.count && !*interrupted(); i++) {
        Validation *v    = arena_new(options->arena, Validation);
        *v               = (Validation){.options = options,
                                        .path    = options->files.items[i],
                                        .name    = console_name(options, options->files.items[i]),
                                        .random  = options->seed};
        KrsStatus status = validate_scene(v, renderer);
        if (worst == KRS_OK)
            worst = status;
    }
    krs_renderer_free(renderer);
    return worst;
}
