/*
 * methods.c: how rays advance, and how they are dealt out to the device, is not seen.
 *
 * Every way to trace, with beams and without, must give the picture of plain sphere tracing with
 * a hundredth of a pixel of error, but for its own permitted error and for outlines.  Schedules,
 * crops, bands and slices must not change a bit of any plane.  Rays that run out of steps are
 * counted, and what is drawn of them is near a surface.  All of it under the validation layers,
 * which must have nothing to say (tests/unit/tracer.c shows that they speak).
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
#include "runtime/krs_vulkan.h"
#include "tests/support/device.h"

enum { WIDTH = 160, HEIGHT = 100, PIXELS = WIDTH * HEIGHT };
/* Where bits are compared: twelve tiles, of which some are not whole. */
enum { SMALL_WIDTH = 100, SMALL_HEIGHT = 70 };

#define FINE_ERROR    0.01 /* of the pictures to compare with, in pixels */
#define DEFAULT_ERROR 0.25 /* krs_vulkan.h */

/* ---- Scenes ---- */

typedef struct Scene {
    const char   *name, *text;
    double        fov; /* of its camera, which is perspective */
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
} Scene;

enum { LANDSCAPE, PART, CLOUD, GRID, INSIDE, CORAL, LATTICE, SCENES };
static Scene scenes[SCENES] = {
    [LANDSCAPE] = {.name = "sphere and plane",
                   .fov  = 0.7,
                   .text = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
                           "show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);"},
    [PART]      = {.name = "blends",
                   .fov  = 0.6,
                   .text = "camera { eye: [3, 2, 3], fov: 0.6 }"
                                "show difference(union([box([1.6, 1, 1.2]), cylinder(0.5, 1.8)], blend: 0.2),"
                                "                sphere(0.6).move([0.6, 0.5, 0.5]), blend: 0.1);"
                                "show union([torus(1.2, 0.1), sphere(0.3).move([1, 0.2, 0])], blend: 0.2, "
                                "kind: \"cubic\")"
                                "    .move([0, -0.7, 0]);"},
    [CLOUD]     = {.name = "12 mirrors",
                   .fov  = 0.6,
                   .text =
                       "camera { eye: [2, 6, 22], fov: 0.6 }"
                           "show krs { kernel sphere(0.45);"
                           "    for i in 0..12 { reflect plane(random_direction(i), 0.4 + 0.22 * i); } };"},
    [GRID]      = {.name = "grid of tori",
                   .fov  = 0.6,
                   .text = "camera { eye: [3, 4, 7], fov: 0.6 }"
                                "show torus(0.5, 0.15).repeat([1.4, 0.9, 1.4], [5, 3, 5]);"},
    [INSIDE]    = {.name = "from inside",
                   .fov  = 1.2,
                   .text = "camera { eye: [0.1, 0.2, 0.3], target: [1, 0.4, 0.2], fov: 1.2 }"
                              "show box([4, 3, 5]) - sphere(0.8).move([1.5, 0, 0.2])"
                              "                   - cylinder(0.2, 9).move([1, 0, 1]);"},
    [CORAL] =
        {.name = "coral",
         .fov  = 0.6,
         .text =
             "camera { eye: [0.3, 0.8, 1.5], target: [0.05, 0.5, 0], fov: 0.6 }"
             "show krs { kernel sphere(0.2);"
             "    for i in 0..5 {"
             "        mobius translate([0, 0.42, 0]) * rotate([0, 1, 0], -1.2) * rotate([1, 0, 0], "
             "0.5);"
             "        mobius reflect(plane([0, 1, 0], 0)) * invert(center: [0, -2, 0], radius: 2);"
             "        reflect plane([1, 0, 0], 0);"
             "        kernel capsule([0, 0, 0], [0, 0.42, 0], radius: 0.085); } };"
             "show sphere(0.25).move([0.5, 0.3, 0.3]);"},
    /* The pole is in the middle of the picture. */
    [LATTICE] =
        {.name = "lattice in a sphere",
         .fov  = 0.6,
         .text = "camera { eye: [0.2, 0.3, 3], fov: 0.6 }"
                 "show krs { kernel sphere(0.35); kernel box([1, 0.3, 0.3]);"
                 "    for i in 0..2 { reflect plane([1, 0, 0], 2 ^ i - 0.5);"
                 "        reflect plane([0, 1, 0], 2 ^ i - 0.5); reflect plane([0, 0, 1], 2 ^ i - "
                 "0.5); }"
                 "    mobius scale(1.2) * invert(radius: 1) * translate([-1.5, -1.5, 0.7]); };"},
};

/* Methods that are plain steps where nothing is for them need not be tried on every scene. */
static bool is_spared(const Scene *scene, KrsTrace trace)
{
    bool inverts = scene == &scenes[CORAL] || scene == &scenes[LATTICE];
    return scene != &scenes[LANDSCAPE] &&
           (inverts ? trace >= KRS_TRACE_EXACT && trace < KRS_TRACE_DIRECTIONAL
                    : trace >= KRS_TRACE_DIRECTIONAL);
}

static KrsRenderer *renderer;
static char         complaint[2048]; /* the last */

static void note_complaint(void *user, const char *message)
{
    (void)user;
    snprintf(complaint, sizeof complaint, "%s", message);
}

static KrsStatus open_scene(Scene *scene)
{
    KrsStatus status = krs_compile_text(scene->text, strlen(scene->text), scene->name, NULL,
                                        &scene->scene);
    if (status == KRS_OK)
        status = krs_frame_new(scene->scene, &scene->frame);
    if (status == KRS_OK)
        status = krs_rendering_new(renderer, scene->scene, &scene->rendering);
    return status;
}

static void close_scene(Scene *scene)
{
    krs_rendering_free(scene->rendering);
    krs_frame_free(scene->frame);
    krs_scene_free(scene->scene);
}

static int open_scenes(void **state)
{
    (void)state;
    KrsRendererOptions options = {
        .device = tested_device(), .validation = true, .complaint = note_complaint};
    KrsStatus status = krs_renderer_new(&options, &renderer);
    for (int i = 0; i < SCENES && status == KRS_OK; i++)
        status = open_scene(&scenes[i]);
    if (status != KRS_OK && renderer)
        fprintf(stderr, "status %d: %s\n", (int)status, krs_renderer_message(renderer));
    return status != KRS_OK;
}

static int close_scenes(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++)
        close_scene(&scenes[i]);
    krs_renderer_free(renderer);
    return 0;
}

/* After every test. */
static int hear_layers(void **state)
{
    (void)state;
    if (krs_renderer_complaints(renderer) != 0)
        fprintf(stderr, "the validation layers complain: %s\n", complaint);
    return krs_renderer_complaints(renderer) != 0;
}

/* ---- Pictures ---- */

static KrsPicture *render(const Scene *scene, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (options.width == 0) {
        options.width  = WIDTH;
        options.height = HEIGHT;
    }
    if (krs_render(scene->rendering, scene->frame, &options, &picture) != KRS_OK)
        fail_msg("%s: %s", scene->name, krs_renderer_message(renderer));
    if (options.most_steps == 0)
        assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

static const struct Plane {
    const char *name;
    size_t      offset, bytes; /* of the pointer in a KrsPicture; of a pixel */
} planes[] = {
    {"color", offsetof(KrsPicture, color), 4 * sizeof(float)},
    {"depth", offsetof(KrsPicture, depth), sizeof(float)},
    {"position", offsetof(KrsPicture, position), 3 * sizeof(float)},
    {"normal", offsetof(KrsPicture, normal), 3 * sizeof(float)},
    {"albedo", offsetof(KrsPicture, albedo), 3 * sizeof(float)},
    {"component", offsetof(KrsPicture, component), sizeof(uint32_t)},
    {"level", offsetof(KrsPicture, level), sizeof(uint32_t)},
    {"instance", offsetof(KrsPicture, instance), sizeof(uint32_t)},
    {"steps", offsetof(KrsPicture, steps), sizeof(uint32_t)},
};

/* A row of a plane, from pixel (x, y) of the whole picture on. */
static const char *plane_row(const KrsPicture *picture, const struct Plane *plane, uint32_t x,
                             uint32_t y)
{
    const char      *bytes;
    const KrsWindow *window = &picture->window;
    memcpy(&bytes, (const char *)picture + plane->offset, sizeof bytes);
    assert_non_null(bytes);
    return bytes + ((size_t)(y - window->y) * window->width + x - window->x) * plane->bytes;
}

/* Whether `part` is, in all planes and bit by bit, what `whole` shows there; frees `part`. */
static bool is_part_of(const Scene *scene, const KrsPicture *whole, KrsPicture *part,
                       const char *what)
{
    const KrsWindow w    = part->window;
    size_t          rows = 0;
    const char     *name = NULL;
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++)
        for (uint32_t y = w.y; y < w.y + w.height; y++)
            if (memcmp(plane_row(whole, &planes[i], w.x, y), plane_row(part, &planes[i], w.x, y),
                       w.width * planes[i].bytes) != 0) {
                rows++;
                name = planes[i].name;
            }
    if (rows > 0)
        print_message("# %s: %s changes %zu rows of planes, in %s\n", scene->name, what, rows,
                      name);
    krs_picture_free(part);
    return rows == 0;
}

/* What a picture was asked for, in words. */
static const char *words(const KrsRenderOptions *options)
{
    static char     text[200];
    const KrsWindow crop = options->crop;
    int length = snprintf(text, sizeof text, "%s, %s, beams %s", krs_trace_names[options->trace],
                          krs_schedule_names[options->schedule], options->no_beams ? "off" : "on");
    if (options->samples > 1 || crop.width > 0 || options->steps_at_once > 0)
        snprintf(text + length, sizeof text - (size_t)length,
                 ", %u samples, from (%u, %u) %u by %u, %u steps at once, %g ms", options->samples,
                 crop.x, crop.y, crop.width, crop.height, options->steps_at_once,
                 options->slice_ms);
    return text;
}

/* ---- Every method sees the same ---- */

/* Whether the picture has an outline here: around the pixel is something else, or something far
   before or behind. */
static bool is_outline(const KrsPicture *picture, int x, int y)
{
    int here = y * WIDTH + x;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= WIDTH || j >= HEIGHT)
                continue;
            int    there = j * WIDTH + i;
            double depth = picture->depth[here], other = picture->depth[there];
            if (picture->component[there] != picture->component[here] ||
                (picture->component[here] && fabs(other - depth) > 0.05 * depth))
                return true;
        }
    return false;
}

/* The distance between what the ray of a pixel meets in two pictures, in widths of a pixel there;
   HUGE_VAL where only one of them shows something. */
static double apart(const Scene *scene, const KrsPicture *a, const KrsPicture *b, int k)
{
    if (a->component[k] != b->component[k])
        return HUGE_VAL;
    if (a->component[k] == 0)
        return 0;
    double half = tan(scene->fov / 2), pixel = 2 * half / HEIGHT * b->depth[k];
    double u = (2 * (k % WIDTH + 0.5) - WIDTH) / HEIGHT * half;
    double v = (1 - 2 * (k / WIDTH + 0.5) / HEIGHT) * half;
    return fabs((double)a->depth[k] - b->depth[k]) * sqrt(1 + u * u + v * v) / pixel;
}

/* Compares with the fine picture; what differs must be on outlines, and little. */
static bool agrees(const Scene *scene, const KrsPicture *fine, KrsRenderOptions options)
{
    KrsPicture *picture  = render(scene, options);
    double      most     = DEFAULT_ERROR + FINE_ERROR;
    int         outlines = 0, plain = 0, surface = 0;
    for (int k = 0; k < PIXELS; k++) {
        surface += fine->component[k] != 0;
        if (apart(scene, picture, fine, k) <= most)
            continue;
        if (is_outline(fine, k % WIDTH, k / WIDTH))
            outlines++;
        else
            plain++;
    }
    krs_picture_free(picture);
    print_message("# %s, %s: %d pixels differ at outlines (%.2f %%), %d elsewhere\n", scene->name,
                  words(&options), outlines, 100.0 * outlines / PIXELS, plain);
    assert_true(surface > PIXELS / 5);
    return plain == 0 && outlines * 200 < PIXELS;
}

static void methods_agree(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (const Scene *scene = scenes; scene < scenes + SCENES; scene++) {
        KrsPicture *fine = render(
            scene,
            (KrsRenderOptions){.trace = KRS_TRACE_PLAIN, .no_beams = true, .error = FINE_ERROR});
        for (KrsTrace trace = 0; trace < KRS_TRACE_COUNT; trace++)
            for (int beams = 0; beams < 2 && !is_spared(scene, trace); beams++)
                wrong += !agrees(scene, fine,
                                 (KrsRenderOptions){.trace = trace, .no_beams = !beams});
        krs_picture_free(fine);
    }
    assert_int_equal(wrong, 0);
}

/* The comparison above can fail: it sees half a pixel. */
static void half_a_pixel_is_found(void **state)
{
    (void)state;
    const Scene *scene  = &scenes[GRID];
    KrsPicture  *fine   = render(scene, (KrsRenderOptions){.error = FINE_ERROR});
    KrsPicture  *nearer = render(scene, (KrsRenderOptions){.error = FINE_ERROR});
    int          differ = 0;
    for (int k = 0; k < PIXELS; k++) /* as a coarse stop would leave it */
        nearer->depth[k] *= (float)(1 - tan(scene->fov / 2) / HEIGHT);
    for (int k = 0; k < PIXELS; k++)
        differ += apart(scene, nearer, fine, k) > DEFAULT_ERROR + FINE_ERROR;
    assert_true(differ > PIXELS / 5);
    krs_picture_free(fine);
    krs_picture_free(nearer);
}

/* ---- What must not change a bit ---- */

static void schedules_are_not_seen(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (const Scene *scene = scenes; scene < scenes + SCENES; scene++)
        for (unsigned variant = 0; variant < 2 * KRS_TRACE_COUNT; variant++) {
            if (is_spared(scene, variant / 2))
                continue;
            /* Automatic relaxation with several rays a pixel, too. */
            KrsRenderOptions options = {.width    = SMALL_WIDTH,
                                        .height   = SMALL_HEIGHT,
                                        .trace    = variant / 2,
                                        .no_beams = variant % 2,
                                        .samples  = variant / 2 == KRS_TRACE_AUTO ? 4 : 1,
                                        .schedule = KRS_SCHEDULE_PIXEL};
            KrsPicture      *whole   = render(scene, options);
            /* The default is one of the others, and one that is repeated is the same: once each. */
            KrsSchedule first = variant == 0 ? KRS_SCHEDULE_DEFAULT : KRS_SCHEDULE_REFILL;
            for (KrsSchedule i = first; i < KRS_SCHEDULE_COUNT; i++) {
                options.schedule = i;
                wrong += !is_part_of(scene, whole, render(scene, options), words(&options));
            }
            krs_picture_free(whole);
        }
    assert_int_equal(wrong, 0);
}

static void crops_are_not_seen(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {
        {33, 17, 41, 30}, {1, 2, 7, 5}, {101, 61, 59, 39}, {0, 99, 160, 1}, {159, 0, 1, 100}};
    size_t wrong = 0;
    for (const Scene *scene = scenes; scene < scenes + SCENES; scene++)
        for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
            KrsRenderOptions options = {.schedule = schedule, .samples = 4};
            KrsPicture      *whole   = render(scene, options);
            for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
                options.crop = crops[i];
                wrong += !is_part_of(scene, whole, render(scene, options), words(&options));
            }
            krs_picture_free(whole);
        }
    assert_int_equal(wrong, 0);
}

static void slices_are_not_seen(void **state)
{
    (void)state;
    static const struct {
        uint32_t  steps_at_once;
        double    slice_ms;
        KrsWindow crop; /* the shortest slices take long */
    } slices[] = {{3, 1e6, {0}}, {512, 1e6, {0}}, {8192, 1e6, {0}}, {512, 1e-3, {30, 20, 40, 40}}};
    size_t wrong = 0;
    for (const Scene *scene = scenes; scene < scenes + SCENES; scene++)
        for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
            KrsRenderOptions options = {
                .width = SMALL_WIDTH, .height = SMALL_HEIGHT, .schedule = schedule, .samples = 2};
            KrsPicture *whole = render(scene, options);
            for (size_t i = 0; i < sizeof slices / sizeof slices[0]; i++) {
                options.steps_at_once = slices[i].steps_at_once;
                options.slice_ms      = slices[i].slice_ms;
                options.crop          = slices[i].crop;
                wrong += !is_part_of(scene, whole, render(scene, options), words(&options));
            }
            krs_picture_free(whole);
        }
    assert_int_equal(wrong, 0);
}

/* Each slice as short as can be, and each ray three steps at a time. */
static void the_shortest_slices_are_not_seen(void **state)
{
    (void)state;
    const Scene *scene = &scenes[PART];
    size_t       wrong = 0;
    for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        KrsRenderOptions options = {.schedule = schedule, .steps_at_once = 3, .slice_ms = 1e-3};
        KrsPicture      *whole   = render(scene, (KrsRenderOptions){.schedule = schedule});
        options.crop             = (KrsWindow){30, 20, 100, 60};
        wrong += !is_part_of(scene, whole, render(scene, options), words(&options));
        krs_picture_free(whole);
    }
    assert_int_equal(wrong, 0);
}

/* A picture too large for one band, and parts of it that are in other bands when alone. */
static void bands_are_not_seen(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {
        {0, 243, 1000, 30}, {3, 500, 900, 9}, {0, 599, 1000, 1}, {490, 0, 13, 600}};
    const Scene *scene = &scenes[LANDSCAPE];
    size_t       wrong = 0;
    for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        KrsRenderOptions options = {.width = 1000, .height = 600, .schedule = schedule};
        KrsPicture      *whole   = render(scene, options);
        for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
            options.crop = crops[i];
            wrong += !is_part_of(scene, whole, render(scene, options), words(&options));
        }
        krs_picture_free(whole);
    }
    assert_int_equal(wrong, 0);
}

/* lavapipe ends the loops of a dispatch silently when they have had 65,535 turns together; those
   within a distance are a hundred and more for each of a ray's steps. */
static void loops_within_distances_count(void **state)
{
    (void)state;
    Scene scene = {.name = "64 iterations",
                   .text = "camera { eye: [0, 0, -6], projection: \"orthographic\", height: 2.6 }"
                           "show julia(c: [-0.083, 0, -0.83, -0.025], power: 2, iterations: 64);"};
    assert_int_equal(open_scene(&scene), KRS_OK);
    KrsRenderOptions options = {.width = 240, .height = 136, .schedule = KRS_SCHEDULE_PIXEL};
    KrsPicture      *whole   = render(&scene, options);
    options.schedule         = KRS_SCHEDULE_REFILL;
    assert_true(is_part_of(&scene, whole, render(&scene, options), words(&options)));
    krs_picture_free(whole);
    close_scene(&scene);
}

/* The comparison of planes sees a single bit. */
static void a_flipped_bit_is_found(void **state)
{
    (void)state;
    const Scene *scene = &scenes[GRID];
    KrsPicture  *whole = render(scene, (KrsRenderOptions){0});
    KrsWindow    crop  = {40, 30, 20, 20};
    KrsPicture  *part  = render(scene, (KrsRenderOptions){.crop = crop});
    part->steps[20 * 20 - 1] ^= 1;
    assert_false(is_part_of(scene, whole, part, "a planted fault"));
    krs_picture_free(whole);
}

/* ---- Rays that run out of steps ---- */

enum { FEW_STEPS = 8 };

/* Whether rays have run out, and what is seen all the same is what is there: a hit is one of rays
   that have all their steps, and at the same depth to a pixel's width. */
static bool ends_are_hits(const Scene *scene, const KrsPicture *full, const KrsPicture *picture,
                          const char *what)
{
    unsigned long long unresolved = picture->stats.unresolved;
    size_t             drawn = 0, invented = 0;
    for (int k = 0; k < SMALL_WIDTH * SMALL_HEIGHT; k++)
        if (picture->component[k] != 0) {
            double pixel = 2 * tan(scene->fov / 2) / picture->height * full->depth[k];
            drawn++;
            invented += full->component[k] == 0 ||
                        !(fabs(picture->depth[k] - full->depth[k]) <= pixel);
        }
    if (invented > 0 || unresolved == 0)
        print_message("# %s, %s: %llu rays ran out, %zu drawn, %zu of them where nothing is\n",
                      scene->name, what, unresolved, drawn, invented);
    return unresolved > 0 && invented == 0;
}

static void rays_that_run_out_show_nothing(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (const Scene *scene = scenes; scene < scenes + SCENES; scene++)
        for (unsigned variant = 0; variant < 2 * KRS_TRACE_COUNT; variant++) {
            if (is_spared(scene, variant / 2))
                continue;
            KrsRenderOptions options = {.width    = SMALL_WIDTH,
                                        .height   = SMALL_HEIGHT,
                                        .trace    = variant / 2,
                                        .no_beams = variant % 2,
                                        .schedule = KRS_SCHEDULE_PIXEL};
            KrsPicture      *full    = render(scene, options);
            options.most_steps       = FEW_STEPS;
            KrsPicture *whole        = render(scene, options);
            wrong += !ends_are_hits(scene, full, whole, words(&options));
            for (KrsSchedule i = KRS_SCHEDULE_REFILL; i < KRS_SCHEDULE_COUNT; i++) {
                options.schedule    = i;
                KrsPicture *picture = render(scene, options);
                wrong += picture->stats.unresolved != whole->stats.unresolved;
                wrong += !is_part_of(scene, whole, picture, words(&options));
            }
            krs_picture_free(whole);
            krs_picture_free(full);
        }
    assert_int_equal(wrong, 0);
}

/* With early outs a march sees bounds of what is far for its size, and near a surface of something
   else these are small, too. */
static void rays_with_early_outs_that_run_out_show_nothing(void **state)
{
    (void)state;
    KrsRendererOptions options = {.device = tested_device(), .early_outs = KRS_EARLY_OUTS_ON};
    KrsRenderer       *early;
    size_t             wrong = 0;
    assert_int_equal(krs_renderer_new(&options, &early), KRS_OK);
    for (int i = 0; i < SCENES; i++) {
        Scene scene = scenes[i];
        if (i == LANDSCAPE || i == INSIDE)
            continue; /* nothing in them is left out */
        assert_int_equal(krs_rendering_new(early, scene.scene, &scene.rendering), KRS_OK);
        for (int k = 0; k < 2 * KRS_COMPONENTS_COUNT; k++) {
            KrsRenderOptions rendering = {.width      = SMALL_WIDTH,
                                          .height     = SMALL_HEIGHT,
                                          .no_beams   = k % 2,
                                          .components = k / 2,
                                          .schedule   = KRS_SCHEDULE_PIXEL};
            KrsPicture      *full      = render(&scene, rendering);
            rendering.most_steps       = FEW_STEPS;
            KrsPicture *picture        = render(&scene, rendering);
            wrong += !ends_are_hits(&scene, full, picture, words(&rendering));
            krs_picture_free(picture);
            krs_picture_free(full);
        }
        krs_rendering_free(scene.rendering);
    }
    krs_renderer_free(early);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(methods_agree, hear_layers),
        cmocka_unit_test_teardown(half_a_pixel_is_found, hear_layers),
        cmocka_unit_test_teardown(schedules_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(crops_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(slices_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(the_shortest_slices_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(bands_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(loops_within_distances_count, hear_layers),
        cmocka_unit_test_teardown(a_flipped_bit_is_found, hear_layers),
        cmocka_unit_test_teardown(rays_that_run_out_show_nothing, hear_layers),
        cmocka_unit_test_teardown(rays_with_early_outs_that_run_out_show_nothing, hear_layers),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests_name("methods", tests, open_scenes, close_scenes);
    spirv_stop();
    return failed;
}
