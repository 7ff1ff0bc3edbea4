/*
 * picture.c: the picture that the device traces is the one that exact rays see.
 *
 * The ray of every pixel is built here from the camera's definition (interface.md: pixel (i, j)
 * looks through (i + 0.5, j + 0.5), row 0 is the top, fov is vertical, right-handed) and cast in
 * double precision on the CPU.  Where the surface is seen well inside of its outline the hits
 * must agree to a small part of the pixel's cone; at outlines the picture may be off by a pixel.
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

#include "compiler/passes/compile.h"
#include "tests/support/renderer.h"

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };
static const KrsRenderOptions plain = {.width = WIDTH, .height = HEIGHT, .methods.no_filter = true};
/* By shaders, and by lanes of the host. */
static const KrsExecutor executors[] = {KRS_EXECUTOR_KERNELS, KRS_EXECUTOR_LANES};

typedef struct Vec {
    double x, y, z;
} Vec;

static Vec    of(const double v[3]) { return (Vec){v[0], v[1], v[2]}; }
static Vec    add(Vec a, Vec b) { return (Vec){a.x + b.x, a.y + b.y, a.z + b.z}; }
static Vec    sub(Vec a, Vec b) { return (Vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static Vec    times(Vec a, double s) { return (Vec){a.x * s, a.y * s, a.z * s}; }
static double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vec    cross(Vec a, Vec b)
{
    return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static Vec unit(Vec a) { return times(a, 1 / sqrt(dot(a, a))); }

/* Rays through the centres of all pixels; returns the size of a pixel at distance 1. */
static double make_rays(const KrsCamera *camera, double (*origins)[3], double (*directions)[3])
{
    Vec    eye = of(camera->eye), forward = unit(sub(of(camera->target), eye));
    Vec    right = unit(cross(forward, of(camera->up))), up = cross(right, forward);
    double half = tan(0.5 * camera->fov);
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++) {
            double u = ((i + 0.5) / WIDTH * 2 - 1) * half * WIDTH / HEIGHT;
            double v = (1 - (j + 0.5) / HEIGHT * 2) * half;
            Vec    d = unit(add(forward, add(times(right, u), times(up, v))));
            memcpy(origins[j * WIDTH + i], (double[]){eye.x, eye.y, eye.z}, sizeof *origins);
            memcpy(directions[j * WIDTH + i], (double[]){d.x, d.y, d.z}, sizeof *directions);
        }
    return 2 * half / HEIGHT;
}

/* Tells whether all pixels around see the same thing at nearly the same depth and angle. */
static bool is_inside(const KrsHit *hits, int i, int j)
{
    const KrsHit *here = &hits[j * WIDTH + i];
    for (int y = j - 1; y <= j + 1; y++)
        for (int x = i - 1; x <= i + 1; x++) {
            if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT)
                continue;
            const KrsHit *there = &hits[y * WIDTH + x];
            if (there->hit != here->hit || there->component != here->component ||
                there->instance != here->instance)
                return false;
            double turn = here->normal[0] * there->normal[0] + here->normal[1] * there->normal[1] +
                          here->normal[2] * there->normal[2];
            if (here->hit && (turn < 0.9 || fabs(here->t - there->t) > 0.05 * here->t))
                return false;
        }
    return true;
}

typedef struct Verdict {
    size_t inside, wrong, outline_wrong;
    double worst; /* distance of hits in pixels, well inside */
} Verdict;

static Verdict judge(const KrsPicture *picture, const KrsHit *hits, double pixel)
{
    Verdict verdict = {0};
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++) {
            int           k    = j * WIDTH + i;
            const KrsHit *hit  = &hits[k];
            bool          seen = picture->component[k] != 0;
            if (!is_inside(hits, i, j)) {
                verdict.outline_wrong += seen != hit->hit;
                continue;
            }
            verdict.inside++;
            if (seen != hit->hit) {
                verdict.wrong++;
                continue;
            }
            if (!seen)
                continue;
            double off = 0, turn = 0;
            for (int c = 0; c < 3; c++) {
                off = hypot(off, picture->position[3 * k + c] - hit->point[c]);
                turn += picture->normal[3 * k + c] * hit->normal[c];
            }
            off /= pixel * hit->t;
            verdict.worst = fmax(verdict.worst, off);
            verdict.wrong += picture->component[k] != hit->component ||
                             picture->level[k] != hit->level ||
                             picture->instance[k] != hit->instance || turn < 0.99;
        }
    return verdict;
}

/* `planted` moves the exact camera sideways, to show that a fault is found. */
static Verdict compare(const char *text, KrsExecutor executor, double planted)
{
    KrsRenderOptions options = plain;
    options.methods.executor = executor;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    KrsPicture   *picture;
    KrsView       view;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_render(rendering, state, &options, &picture), KRS_OK);
    assert_int_equal(picture->stats.unresolved, 0);
    assert_int_equal(krs_state_view(state, 0, &view), KRS_OK);

    double(*origins)[3]    = malloc(PIXELS * sizeof *origins);
    double(*directions)[3] = malloc(PIXELS * sizeof *directions);
    KrsHit *hits           = malloc(PIXELS * sizeof *hits);
    view.camera.eye[0] += planted;
    double pixel = make_rays(&view.camera, origins, directions);
    krs_raycast(state, (const double(*)[3])origins, (const double(*)[3])directions, PIXELS, 1e3,
                1e-8, hits);
    Verdict verdict = judge(picture, hits, pixel);
    free(origins);
    free(directions);
    free(hits);
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
    return verdict;
}

static void agrees_by(const char *text, KrsExecutor executor)
{
    Verdict verdict = compare(text, executor, 0);
    if (verdict.worst > 0.5 || verdict.wrong * 2000 > verdict.inside)
        fprintf(stderr, "%zu inside, %zu wrong, %zu outline, worst %.3g pixels: %s\n",
                verdict.inside, verdict.wrong, verdict.outline_wrong, verdict.worst, text);
    assert_true(verdict.inside > PIXELS / 3);
    /* A crease that the ring of neighbours misses may turn a normal: one pixel in 2,000. */
    assert_true(verdict.wrong * 2000 <= verdict.inside);
    assert_true(verdict.worst <= 0.5);
    assert_true(verdict.outline_wrong <= PIXELS / 50);
}

static void agrees(const char *text)
{
    for (size_t i = 0; i < sizeof executors / sizeof *executors; i++)
        agrees_by(text, executors[i]);
}

static void solids_agree(void **state)
{
    (void)state;
    agrees("camera { eye: [2, 3, 5] } show box([1, 1.4, 0.8]) - sphere(0.7).move([0.4, 0.3, 0.4]);"
           "show plane([0, 1, 0], -0.8) & box([8, 2, 8]);");
    agrees("camera { eye: [3, 2, 4], target: [0.2, 0, 0], fov: 35deg }"
           "show union([torus(1, 0.3), cylinder(0.4, 1.6)], blend: 0.2);"
           "show ellipsoid([0.4, 0.2, 0.3]).move([1.2, 0.7, 0]);");
    agrees("camera { eye: [0, 4, 6] }"
           "show capsule([0, 0, 0], [0, 0.6, 0], 0.15).repeat([0.8, 0, 0.8], [5, 1, 5]);"
           "show cone(0.3, 0.6).move([1.8, 0.9, 0]).repeat_polar(9);");
}

static void sequences_agree(void **state)
{
    (void)state;
    agrees("camera { eye: [0, 2, 9], fov: 50deg } show krs { kernel sphere(0.35);"
           "    for i in 0..6 { reflect plane(random_direction(i), 0.5 + 0.15 * i); } };");
    agrees("camera { eye: [1, 2, 7] }"
           "show krs { kernel box([0.5, 0.3, 0.4]).rotate([1, 1, 0], 0.5); for i in 0..5 {"
           "    reflect plane(random_direction(i + 20), 0.4 + 0.2 * i);"
           "    kernel sphere(0.2).move(0.5 * random_direction(i)); } };");
}

/* From inside every ray ends at a wall, at none that is only a seam, and nothing that is outside
   shines in. */
static void the_inside_of_solids_agrees(void **state)
{
    static const char *const lights[] = {"intensity: 3", "intensity: 0",
                                         "intensity: 3, shadow: false"};
    static const char inside[] = "camera { eye: [-0.3, 0.1, 0.2], target: [1.5, 0, 0], fov: 90deg }"
                                 "show box([1, 1, 1]); show box([1, 1, 1]).move([1, 0, 0]);"
                                 "light sun { direction: [-1, 2, 1], %s }";
    KrsPicture       *pictures[3];
    char              text[400];
    (void)state;
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, inside, lights[i]);
        agrees(text);
        pictures[i] = picture_of(text, &plain);
    }
    bool dark = memcmp(pictures[0]->color, pictures[1]->color, PIXELS * 16) == 0;
    bool same = memcmp(pictures[1]->color, pictures[2]->color, PIXELS * 16) == 0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < PIXELS; k++)
            assert_true(pictures[i]->component[k] != 0);
        krs_picture_free(pictures[i]);
    }
    assert_true(dark && !same);
}

static void a_fault_is_found(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof executors / sizeof *executors; i++) {
        Verdict verdict = compare("camera { eye: [2, 3, 5] } show box([2, 2, 2]);", executors[i],
                                  0.05);
        assert_true(verdict.worst > 0.5 || verdict.wrong * 2000 > verdict.inside);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_agree),
        cmocka_unit_test(sequences_agree),
        cmocka_unit_test(the_inside_of_solids_agrees),
        cmocka_unit_test(a_fault_is_found),
    };
    return cmocka_run_group_tests_name("pictures against exact rays", tests, renderer_open,
                                       renderer_close);
}
