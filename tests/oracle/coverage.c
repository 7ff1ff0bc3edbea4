/*
 * coverage.c: pictures show as much of thin things as there is of them.
 *
 * Twigs from a tenth of a pixel to three pixels wide are rendered with the default options, and
 * every ray through the centre of a pixel is cast again in closed form: hits that the picture
 * misses and hits that are none may both occur, but must cancel out to a percent.  Where the rays
 * are not the same, with several samples a pixel, mean coverages are compared.  A scene inflated
 * by as much as the usual stop of sphere tracing permits must fail by far.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/compile.h"
#include "tests/support/renderer.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"

/* What is asked for, and what a test must be able to see. */
#define MOST_NET_ERROR 0.01  /* of the coverage */
#define MOST_NOISE     0.003 /* one standard error, as a share of the coverage */
#define MOST_OFF       0.001 /* the share of hits whose depth is off by more than is permitted */
#define PLANTED_ERROR  0.1   /* a fault shows at least this much */

#define DEFAULT_ERROR 0.25 /* krs_vulkan.h */
#define ROUGH_ERROR   0.5  /* of a scene that asks for it */

enum { WIDTH = 400, HEIGHT = 225, PIXELS = WIDTH * HEIGHT };
enum { ROUND, FLAT, CAMERAS }; /* perspective and orthographic */

/* ---- Scenes ---- */

typedef enum SceneKind {
    THICKET,
    HEAP,
    WALLED_THICKET,
    WALLED_HEAP,
    TREE,
    ROUGH,
    SCENES
} SceneKind;

/* Capsules, known here copy by copy.  The scene's parameter `size` is the length of which all
   radii are multiples. */
typedef struct Scene {
    Vec           eye, target;
    double        fov;
    Rod          *rods;
    size_t        count;
    bool          walled;
    Vec           low, high; /* of the wall */
    SceneText     text;
    Product       product;
    KrsRendering *rendering;
} Scene;

static Scene scenes[SCENES];

static void write_view(Scene *scene, const char *more)
{
    Vec    eye = scene->eye, target = scene->target;
    double height = 2 * tan(scene->fov / 2) * vec_distance(eye, target);
    scene_write(&scene->text, "%sparam size = 0.01 in [1e-6, 0.1];\n", more);
    scene_write(&scene->text, "light sun { direction: [1, 2, 1], shadow: false }\n");
    for (int i = 0; i < CAMERAS; i++)
        scene_write(&scene->text,
                    "camera %s{ eye: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], "
                    "fov: %.17g, projection: \"%s\", height: %.17g }\n",
                    i == FLAT ? "flat " : "", eye.x, eye.y, eye.z, target.x, target.y, target.z,
                    scene->fov, i == FLAT ? "orthographic" : "perspective", height);
    if (scene->walled) {
        Vec sides  = vec_sub(scene->high, scene->low);
        Vec middle = vec_mix(scene->low, scene->high, 0.5);
        scene_write(&scene->text, "let wall = box([%.17g, %.17g, %.17g]);\n", sides.x, sides.y,
                    sides.z);
        scene_write(&scene->text, "let place = [%.17g, %.17g, %.17g];\n", middle.x, middle.y,
                    middle.z);
    }
}

static void write_capsule(SceneText *text, Vec from, Vec to, double radius)
{
    scene_write(text, "capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], %.17g * size)", from.x,
                from.y, from.z, to.x, to.y, to.z, radius);
}

static void show_wall(Scene *scene)
{
    if (scene->walled)
        scene_write(&scene->text, "show wall.move(place);\n");
}

/* Writes the sequence into the scene's text, and its copies into the scene's rods. */
static void show_sequence(Scene *scene, const Sequence *sequence)
{
    scene_write(&scene->text, "show krs {\n");
    for (int level = 0; level <= sequence->mirror_count; level++) {
        if (level > 0) {
            Half mirror = sequence->mirrors[level - 1];
            scene_write(&scene->text, "reflect plane([%.17g, %.17g, %.17g], %.17g);\n",
                        mirror.normal.x, mirror.normal.y, mirror.normal.z, mirror.offset);
        }
        for (int i = 0; i < sequence->body_count; i++) {
            const Body *body = &sequence->bodies[i];
            if (body->level != level)
                continue;
            scene_write(&scene->text, "kernel ");
            write_capsule(&scene->text, body->from, body->to, body->radius);
            scene_write(&scene->text, ";\n");
        }
    }
    scene_write(&scene->text, "};\n");

    Expansion expansion = expand(sequence);
    scene->count        = expansion.count;
    scene->rods         = calloc(scene->count, sizeof *scene->rods);
    assert_non_null(scene->rods);
    for (size_t i = 0; i < scene->count; i++)
        scene->rods[i] = rod_of_copy(&expansion.copies[i]);
    expansion_free(&expansion);
}

/* Twigs in a cell, and the cell mirrored 9 times into a cube of 8 x 8 x 8: nothing is cut. */
static void make_thicket(Scene *scene, const char *more)
{
    enum { TWIGS = 24, MIRRORS = 9 };
    const Vec axes[3]  = {vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)};
    Sequence  sequence = {.mirror_count = MIRRORS, .body_count = TWIGS};
    Random    random   = {7};
    for (int i = 0; i < MIRRORS; i++)
        sequence.mirrors[i] = (Half){axes[i % 3], (1 << i / 3) - 1};
    for (int i = 0; i < TWIGS; i++) {
        Body *body   = &sequence.bodies[i];
        Vec   middle = vec(-0.5, -0.5, -0.5);
        body->from   = vec_add(middle, random_in_cube(&random, 0.45));
        do
            body->to = vec_add(middle, random_in_cube(&random, 0.45));
        while (vec_distance(body->from, body->to) < 0.6);
        body->radius = 1;
    }
    scene->target = vec(3, 3, 3);
    scene->eye    = vec(11.3, 7.1, 18.2);
    scene->fov    = 0.45;
    scene->low    = vec(-20, -20, -2.3);
    scene->high   = vec(20, 20, -2);
    write_view(scene, more);
    show_sequence(scene, &sequence);
    show_wall(scene);
}

/* Twigs all over the picture, at depths that differ by a factor of two, and yet of the same
   apparent width. */
static void make_heap(Scene *scene)
{
    enum { TWIGS = 160 };
    Random random = {11};
    scene->eye    = vec(1, 2, 10);
    scene->fov    = 0.6;
    scene->low    = vec(-9, -7, -5.5);
    scene->high   = vec(9, 7, -5);
    Lens lens     = lens_make(scene->eye, scene->target, tan(scene->fov / 2), false, 16, 9);
    scene->count  = TWIGS;
    scene->rods   = calloc(TWIGS, sizeof *scene->rods);
    assert_non_null(scene->rods);
    write_view(scene, "");
    scene_write(&scene->text, "show union([\n");
    for (size_t i = 0; i < TWIGS; i++) {
        double across   = random_between(&random, 0, 16);
        Line   ray      = lens_ray(&lens, across, random_between(&random, 0, 9));
        double distance = random_between(&random, 7, 13), share = distance / vec_length(scene->eye);
        Vec middle = line_at(ray, distance), lateral = vec_scale(0.5 * share, random_unit(&random));
        Rod *rod    = &scene->rods[i];
        *rod        = (Rod){.from = vec_sub(middle, lateral), .to = vec_add(middle, lateral)};
        rod->radius = vec_dot(vec_sub(middle, lens.eye), lens.forward) / vec_length(scene->eye);
        write_capsule(&scene->text, rod->from, rod->to, rod->radius);
        scene_write(&scene->text, i + 1 < TWIGS ? ",\n" : "]);\n");
    }
    show_wall(scene);
}

/* A tree of 10 mirrors, as in bench/scenes/tree28.krs: what its mirrors cut away is not seen. */
static void make_tree(Scene *scene)
{
    enum { LEVELS = 11 };
    Sequence sequence = {.mirror_count = LEVELS - 1, .body_count = LEVELS};
    Vec      fork = vec(0, 0, 0), before = vec(0, 1, 0);
    for (int i = 0; i < LEVELS; i++) {
        double lean = 0.42 + 0.02 * i, turn = 2.4 * i;
        Vec    heading     = vec(sin(lean) * cos(turn), cos(lean), sin(lean) * sin(turn));
        Vec    end         = vec_add(fork, vec_scale(0.9 * pow(0.88, i), heading));
        sequence.bodies[i] = (Body){
            .from = fork, .to = end, .radius = pow(0.75, i - LEVELS + 1), .level = LEVELS - 1 - i};
        if (i > 0) {
            Vec lateral = vec_sub(vec_scale(vec_dot(heading, before), before), heading);
            Vec normal  = vec_unit(lateral);
            sequence.mirrors[LEVELS - 1 - i] = (Half){normal, vec_dot(normal, fork)};
        }
        fork   = end;
        before = heading;
    }
    scene->target = vec(0, 2.6, 0);
    scene->eye    = vec(2, 3.2, 11);
    scene->fov    = 0.5;
    write_view(scene, "");
    show_sequence(scene, &sequence);
}

static Scene *use_scene(SceneKind kind)
{
    Scene *scene = &scenes[kind];
    if (scene->rendering)
        return scene;
    scene->walled = kind == WALLED_THICKET || kind == WALLED_HEAP;
    switch (kind) {
    case HEAP:
    case WALLED_HEAP: make_heap(scene); break;
    case TREE: make_tree(scene); break;
    case ROUGH: make_thicket(scene, "image { error: 0.5 }\n"); break;
    default: make_thicket(scene, "");
    }
    scene->product = product_compile(scene->text.bytes);
    if (krs_rendering_new(renderer, scene->product.scene, &scene->rendering) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return scene;
}

/* ---- Pictures, and what is there ---- */

/* A picture to be taken.  `wide` is the width of twigs in pixels where the camera looks at. */
typedef struct Shot {
    SceneKind kind;
    double    wide;
    double    error; /* 0: the default */
    int       camera;
    double    grown; /* a fault: pixels more for all radii in the scene, but not in the truth */
    bool      uncut; /* a fault: the truth has what the mirrors cut away */
} Shot;

static Lens shot_lens(const Shot *shot, int width, int height)
{
    const Scene *scene = use_scene(shot->kind);
    double       half  = tan(scene->fov / 2);
    if (shot->camera == FLAT)
        half *= vec_distance(scene->eye, scene->target);
    return lens_make(scene->eye, scene->target, half, shot->camera == FLAT, width, height);
}

/* The parameter `size` for twigs of so many pixels. */
static double shot_size(const Scene *scene, const Lens *lens, double wide)
{
    return wide / 2 * lens_pixel(lens, vec_distance(scene->eye, scene->target));
}

/* The permitted error in pixels. */
static double shot_error(const Shot *shot)
{
    if (shot->error > 0)
        return shot->error;
    return shot->kind == ROUGH ? ROUGH_ERROR : DEFAULT_ERROR;
}

static KrsPicture *shot_render(const Shot *shot, const Lens *lens, uint32_t samples)
{
    Scene           *scene = use_scene(shot->kind);
    double           size  = shot_size(scene, lens, shot->wide + 2 * shot->grown);
    KrsPicture      *picture;
    KrsRenderOptions options = {.width   = (uint32_t)lens->width,
                                .height  = (uint32_t)lens->height,
                                .samples = samples,
                                .error   = shot->error,
                                .camera  = (size_t)shot->camera};
    assert_int_equal(krs_frame_set(scene->product.frame, "size", &size, 1), KRS_OK);
    if (krs_render(scene->rendering, scene->product.frame, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

/* Where the ray through (i + x, j + y) of each pixel meets a twig, unless the wall hides it;
   HUGE_VAL where it does not. */
static double *shot_truth(const Shot *shot, const Lens *lens, double x, double y)
{
    const Scene *scene = use_scene(shot->kind);
    double       size  = shot_size(scene, lens, shot->wide);
    double      *enter = calloc((size_t)(lens->width * lens->height), sizeof *enter);
    Rod         *rods  = calloc(scene->count, sizeof *rods);
    assert_non_null(enter);
    assert_non_null(rods);
    for (size_t i = 0; i < scene->count; i++) {
        rods[i] = scene->rods[i];
        rods[i].radius *= size;
        rods[i].cut_count = shot->uncut ? 0 : rods[i].cut_count;
    }
    rods_seen(rods, scene->count, lens, x, y, enter);
    free(rods);
    for (int k = 0; scene->walled && k < lens->width * lens->height; k++) {
        Line  ray  = lens_ray(lens, k % lens->width + x, k / lens->width + y);
        Chord wall = chord_of_box(ray, scene->low, scene->high);
        if (!chord_is_empty(wall) && wall.enter <= enter[k])
            enter[k] = HUGE_VAL;
    }
    return enter;
}

/* ---- Ray by ray ---- */

typedef struct Verdict {
    size_t hits;          /* that there are */
    size_t missed, extra; /* hits that are not seen, and those that are none */
    size_t common, off;   /* hits seen, and those at a depth that is off by too much */
} Verdict;

/* Component 1 are the twigs, 2 is the wall. */
static Verdict compare_rays(const KrsPicture *picture, const double *enter, const Lens *lens,
                            double error)
{
    Verdict verdict = {0};
    for (int k = 0; k < lens->width * lens->height; k++) {
        bool there = enter[k] < HUGE_VAL, seen = picture->component[k] == 1;
        verdict.hits += there;
        verdict.missed += there && !seen;
        verdict.extra += seen && !there;
        if (!there || !seen)
            continue;
        Line   ray     = lens_ray(lens, k % lens->width + 0.5, k / lens->width + 0.5);
        double stretch = vec_dot(ray.direction, lens->forward), depth = picture->depth[k];
        double pixels = (depth / stretch - enter[k]) / lens_pixel(lens, depth);
        verdict.common++;
        verdict.off += !(fabs(pixels) <= error);
    }
    return verdict;
}

static double net_error(const Verdict *verdict)
{
    return ((double)verdict->extra - (double)verdict->missed) / (double)verdict->hits;
}

/* The standard error of the net error if whether a ray hits were decided by lot wherever the
   picture and the truth disagree. */
static double net_noise(const Verdict *verdict)
{
    return sqrt((double)(verdict->extra + verdict->missed)) / (double)verdict->hits;
}

static void print_shot(const Shot *shot)
{
    static const char *const names[SCENES] = {"thicket",    "heap", "thicket, wall",
                                              "heap, wall", "tree", "thicket, error in scene"};
    print_message("# %s, %s, %g pixels wide, error %g%s: ", names[shot->kind],
                  shot->camera == FLAT ? "orthographic" : "perspective", shot->wide,
                  shot_error(shot),
                  shot->grown > 0 ? ", GROWN"
                  : shot->uncut   ? ", UNCUT"
                                  : "");
}

static Verdict judge_shot(const Shot *shot)
{
    Lens        lens    = shot_lens(shot, WIDTH, HEIGHT);
    double     *enter   = shot_truth(shot, &lens, 0.5, 0.5);
    KrsPicture *picture = shot_render(shot, &lens, 1);
    Verdict     verdict = compare_rays(picture, enter, &lens, shot_error(shot));
    krs_picture_free(picture);
    free(enter);
    print_shot(shot);
    print_message("%zu hits, missed %.2f %%, too many %.2f %%, net %+.2f %% (noise up to %.2f %%), "
                  "depth off %.3f %%\n",
                  verdict.hits, 100.0 * (double)verdict.missed / (double)verdict.hits,
                  100.0 * (double)verdict.extra / (double)verdict.hits, 100 * net_error(&verdict),
                  100 * net_noise(&verdict),
                  100.0 * (double)verdict.off / fmax(1, (double)verdict.common));
    assert_true(verdict.hits >= 2000);
    return verdict;
}

/* How many depths may be off: the permitted share, and those of rays that meet something else
   than they should.  Of the hits that are none as large a share is before another hit as of all
   rays, and so it is behind the hits that are missed; neither is counted as such. */
static double most_off(const Verdict *verdict)
{
    double hits = (double)verdict->hits, others = (double)(verdict->extra + verdict->missed);
    return MOST_OFF * (double)verdict->common + others * hits / (PIXELS - hits);
}

/* Whether a shot keeps what is promised; all shots of a test are looked at before it fails. */
static bool shot_is_right(Shot shot)
{
    Verdict verdict = judge_shot(&shot);
    return fabs(net_error(&verdict)) < MOST_NET_ERROR && net_noise(&verdict) < MOST_NOISE &&
           (double)verdict.off <= most_off(&verdict);
}

/* Every width with the default error, from both cameras, and with other errors. */
static size_t wrong_shots(SceneKind kind, const double *widths, size_t width_count)
{
    static const double errors[] = {0, 0.5, 0.1};
    size_t              wrong    = 0;
    for (size_t i = 0; i < width_count; i++) {
        for (size_t k = 0; k < sizeof errors / sizeof errors[0]; k++)
            wrong += !shot_is_right((Shot){.kind = kind, .wide = widths[i], .error = errors[k]});
        wrong += !shot_is_right((Shot){.kind = kind, .wide = widths[i], .camera = FLAT});
    }
    return wrong;
}

static const double THIN[] = {0.1, 0.3}, WIDE[] = {1, 3};

static void thin_twigs_are_covered(void **state)
{
    (void)state;
    assert_int_equal(wrong_shots(THICKET, THIN, 2), 0);
}

static void wide_twigs_are_covered(void **state)
{
    (void)state;
    assert_int_equal(wrong_shots(HEAP, WIDE, 2), 0);
}

static void twigs_before_a_wall_are_covered(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int camera = 0; camera < CAMERAS; camera++)
        for (int i = 0; i < 2; i++) {
            wrong += !shot_is_right(
                (Shot){.kind = WALLED_THICKET, .wide = THIN[i], .camera = camera});
            wrong += !shot_is_right((Shot){.kind = WALLED_HEAP, .wide = WIDE[i], .camera = camera});
        }
    assert_int_equal(wrong, 0);
}

static void a_tree_is_covered(void **state)
{
    (void)state;
    assert_int_equal(wrong_shots(TREE, (const double[]){0.2, 0.6}, 2), 0);
}

/* What the scene asks for is what the caller may ask for. */
static void the_error_of_a_scene_counts(void **state)
{
    (void)state;
    Shot        rough = {.kind = ROUGH, .wide = 0.3};
    Shot        asked = {.kind = THICKET, .wide = 0.3, .error = ROUGH_ERROR};
    Lens        lens  = shot_lens(&rough, WIDTH, HEIGHT);
    KrsPicture *a = shot_render(&rough, &lens, 1), *b = shot_render(&asked, &lens, 1);
    assert_memory_equal(a->depth, b->depth, PIXELS * sizeof *a->depth);
    assert_memory_equal(a->steps, b->steps, PIXELS * sizeof *a->steps);
    krs_picture_free(a);
    krs_picture_free(b);
    assert_true(shot_is_right(rough));
}

/* A scene that is as much too thick as the stop at a quarter of a pixel makes it. */
static void inflation_is_found(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        Verdict thin = judge_shot(
            &(Shot){.kind = THICKET, .wide = THIN[i], .grown = DEFAULT_ERROR});
        Verdict wide = judge_shot(
            &(Shot){.kind = HEAP, .wide = WIDE[i], .grown = DEFAULT_ERROR, .camera = FLAT});
        assert_true(net_error(&thin) > PLANTED_ERROR);
        assert_true(net_error(&wide) > PLANTED_ERROR);
    }
}

/* What the mirrors of the tree cut away is much of it. */
static void branches_beyond_mirrors_are_found(void **state)
{
    (void)state;
    Verdict verdict = judge_shot(&(Shot){.kind = TREE, .wide = 0.6, .uncut = true});
    assert_true(net_error(&verdict) < -PLANTED_ERROR);
}

/* ---- Several rays a pixel ---- */

/* The mean coverage of a picture, and how much it varies between pictures of one ray a pixel. */
typedef struct Coverage {
    double mean, spread;
} Coverage;

/* By rays through 8 x 8 places of each pixel. */
static Coverage true_coverage(const Shot *shot, const Lens *lens)
{
    enum { SIDE = 8 };
    double sum = 0, squares = 0;
    for (int place = 0; place < SIDE * SIDE; place++) {
        double *enter = shot_truth(shot, lens, (place % SIDE + 0.5) / SIDE,
                                   (place / SIDE + 0.5) / SIDE);
        double  share = 0;
        for (int k = 0; k < lens->width * lens->height; k++)
            share += enter[k] < HUGE_VAL;
        free(enter);
        share /= lens->width * lens->height;
        sum += share;
        squares += share * share;
    }
    double mean = sum / (SIDE * SIDE);
    return (Coverage){mean, sqrt(fmax(squares / (SIDE * SIDE) - mean * mean, 0))};
}

static bool samples_are_right(Shot shot, uint32_t samples)
{
    Lens        lens    = shot_lens(&shot, WIDTH / 2, HEIGHT / 2);
    Coverage    truth   = true_coverage(&shot, &lens);
    KrsPicture *picture = shot_render(&shot, &lens, samples);
    double      mean = 0, noise = truth.spread / sqrt(samples) / truth.mean;
    for (int k = 0; k < lens.width * lens.height; k++)
        mean += (double)picture->color[4 * k + 3] / (lens.width * lens.height);
    krs_picture_free(picture);
    print_shot(&shot);
    print_message("%u samples, coverage %.5f instead of %.5f, %+.2f %% (noise %.2f %%)\n", samples,
                  mean, truth.mean, 100 * (mean / truth.mean - 1), 100 * noise);
    return fabs(mean / truth.mean - 1) < MOST_NET_ERROR && noise < MOST_NOISE;
}

static void samples_converge_on_the_coverage(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2; i++) {
        wrong += !samples_are_right((Shot){.kind = THICKET, .wide = THIN[i]}, 16);
        wrong += !samples_are_right((Shot){.kind = HEAP, .wide = WIDE[i]}, 16);
    }
    wrong += !samples_are_right((Shot){.kind = THICKET, .wide = THIN[0], .camera = FLAT}, 64);
    wrong += !samples_are_right((Shot){.kind = TREE, .wide = 0.3}, 16);
    assert_int_equal(wrong, 0);
}

/* ---- The truth itself ---- */

/* Distance to a segment, by trisection: it is a convex function of the place on the segment. */
static double distance_to_segment(Vec from, Vec to, Vec point)
{
    double low = 0, high = 1;
    for (int i = 0; i < 100; i++) {
        double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (vec_distance(vec_mix(from, to, a), point) < vec_distance(vec_mix(from, to, b), point))
            high = b;
        else
            low = a;
    }
    return vec_distance(vec_mix(from, to, low), point);
}

static double excess_over_box(Vec low, Vec high, Vec p)
{
    double x = fmax(p.x - high.x, low.x - p.x), y = fmax(p.y - high.y, low.y - p.y);
    return fmax(x, fmax(y, fmax(p.z - high.z, low.z - p.z)));
}

/* The rod, or the box between the ends of its segment. */
static double excess(const Rod *rod, bool box, Vec p)
{
    if (box)
        return excess_over_box(rod->from, rod->to, p);
    double most = distance_to_segment(rod->from, rod->to, p) - rod->radius;
    for (int i = 0; i < rod->cut_count; i++)
        most = fmax(most, half_excess(rod->cuts[i], p));
    return most;
}

/* Marches along a line in small steps: the points inside are those of the chord.  Returns whether
   there is one. */
static bool check_chord(Line line, const Rod *rod, bool box)
{
    enum { STEPS = 300 };
    Chord chord = box ? chord_of_box(line, rod->from, rod->to) : chord_of_rod(line, rod);
    for (int i = 0; i <= STEPS; i++) {
        double t = 6.0 * i / STEPS - 3, over = excess(rod, box, line_at(line, t));
        if (fabs(over) > 1e-9)
            assert_int_equal(over<0, t> chord.enter && t < chord.leave);
    }
    if (chord_is_empty(chord))
        return false;
    assert_true(fabs(excess(rod, box, line_at(line, chord.enter))) < 1e-6);
    assert_true(fabs(excess(rod, box, line_at(line, chord.leave))) < 1e-6);
    return true;
}

static void chords_are_what_marching_finds(void **state)
{
    (void)state;
    enum { TRIALS = 600 };
    Random random = {3};
    int    met    = 0;
    for (int i = 0; i < TRIALS; i++) {
        bool box = i % 5 == 0;
        Rod  rod = {.from      = random_in_cube(&random, 1),
                    .to        = random_in_cube(&random, 1),
                    .radius    = random_between(&random, 0.01, 0.6),
                    .cut_count = i % 4};
        for (int k = 0; k < rod.cut_count; k++)
            rod.cuts[k] = (Half){random_unit(&random), random_between(&random, -0.3, 0.8)};
        if (box)
            rod.to = vec_add(rod.from, vec(0.5, random_between(&random, 0, 1), 0.7));
        Line line = {.direction = random_unit(&random)};
        if (i % 7 == 0) /* along the axis of a capsule, along a face of a box */
            line.direction = box ? vec(0, 0, 1) : vec_unit(vec_sub(rod.to, rod.from));
        line.origin = vec_mix(rod.from, rod.to, random_between(&random, -0.2, 1.2));
        line.origin = vec_add(line.origin, random_in_cube(&random, 0.3));
        met += check_chord(line, &rod, box);
    }
    assert_in_range(met, TRIALS / 3, TRIALS - TRIALS / 10);
}

/* The picture rod by rod is that of each ray against all rods. */
static void pictures_are_what_rays_see(void **state)
{
    (void)state;
    const Shot shots[] = {{.kind = TREE, .wide = 3},
                          {.kind = HEAP, .wide = 30},
                          {.kind = HEAP, .wide = 1, .camera = FLAT}};
    for (size_t n = 0; n < sizeof shots / sizeof shots[0]; n++) {
        const Scene *scene = use_scene(shots[n].kind);
        Lens         lens  = shot_lens(&shots[n], WIDTH, HEIGHT);
        double      *enter = shot_truth(&shots[n], &lens, 0.3, 0.8);
        double       size  = shot_size(scene, &lens, shots[n].wide);
        int          hits  = 0;
        for (int k = 0; k < PIXELS; k += 7) {
            Line   ray   = lens_ray(&lens, k % WIDTH + 0.3, k / WIDTH + 0.8);
            double first = HUGE_VAL;
            for (size_t i = 0; i < scene->count; i++) {
                Rod rod = scene->rods[i];
                rod.radius *= size;
                Chord chord = chord_of_rod(ray, &rod);
                first       = chord_is_empty(chord) ? first : fmin(first, chord.enter);
            }
            assert_true(enter[k] == first);
            hits += first < HUGE_VAL;
        }
        assert_true(hits > 300);
        free(enter);
    }
}

/* The expansion, and the compiler's distance in double precision, are about one scene. */
static void rods_are_those_of_the_scene(void **state)
{
    (void)state;
    for (SceneKind kind = 0; kind < SCENES; kind++) {
        Scene *scene = use_scene(kind);
        Shot   shot  = {.kind = kind, .wide = 2};
        Lens   lens  = shot_lens(&shot, WIDTH, HEIGHT);
        double size  = shot_size(scene, &lens, shot.wide);
        assert_int_equal(krs_frame_set(scene->product.frame, "size", &size, 1), KRS_OK);
        double *enter = shot_truth(&shot, &lens, 0.5, 0.5);
        for (int k = 0; k < PIXELS; k += 11) {
            Line ray = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
            if (enter[k] == HUGE_VAL)
                continue;
            double distance = product_distance(&scene->product, line_at(ray, enter[k]));
            assert_true(fabs(distance) < 1e-9);
        }
        free(enter);
    }
}

/* ---- All tests ---- */

static int close_all(void **state)
{
    for (int i = 0; i < SCENES; i++) {
        krs_rendering_free(scenes[i].rendering);
        product_free(&scenes[i].product);
        free(scenes[i].rods);
    }
    return renderer_close(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chords_are_what_marching_finds),
        cmocka_unit_test(rods_are_those_of_the_scene),
        cmocka_unit_test(pictures_are_what_rays_see),
        cmocka_unit_test(thin_twigs_are_covered),
        cmocka_unit_test(wide_twigs_are_covered),
        cmocka_unit_test(twigs_before_a_wall_are_covered),
        cmocka_unit_test(a_tree_is_covered),
        cmocka_unit_test(the_error_of_a_scene_counts),
        cmocka_unit_test(samples_converge_on_the_coverage),
        cmocka_unit_test(inflation_is_found),
        cmocka_unit_test(branches_beyond_mirrors_are_found),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests_name("coverage", tests, renderer_open, close_all);
    spirv_stop();
    return failed;
}
