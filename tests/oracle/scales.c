/*
 * scales.c: pictures of balls, boxes and plates of any size, anywhere, against their projections.
 *
 * Every ray through the centre of a pixel is cast again in closed form and in double precision, at
 * the solid a little smaller and a little larger: it must hit where the smaller one is, and may not
 * where the larger one is not.  That little is a part of a pixel, the same at all sizes and at all
 * distances from the origin.  Solids stand anywhere from the origin to a hundred thousand units
 * away, sizes go from hundreds down to what single precision does not even know there.
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

#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

/* Parts of a pixel: what a march leaves open, and as much again for rounding (compiler/passes/precision.c). */
#define SLACK (2.0 / 64)

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };
static const double FOV = 0.7;

typedef enum Kind { BALL, POLYNOMIAL, BLOCK, KINDS } Kind;

/* Its numbers are parameters, so that one program shows it at all sizes and places. */
static const char *const texts[KINDS] = {
    [BALL]       = "show sphere(size).move(at);\n",
    [POLYNOMIAL] = "show algebraic(x^2 + y^2 + z^2 == 1).within(box([3, 3, 3]))"
                   ".scale(size).move(at);\n",
    [BLOCK]      = "param sides = [1, 1, 1]; param axis = [0, 0, 1]; param angle = 0;\n"
                   "show box(sides).rotate(axis, angle).move(at);\n",
};

typedef struct Scene {
    Product       product;
    KrsRendering *rendering;
} Scene;
static Scene scenes[KINDS];

static Scene *use_scene(Kind kind)
{
    Scene *scene = &scenes[kind];
    if (scene->rendering)
        return scene;
    scene->product = product_format(
        "param at = [0, 0, 0]; param eye = [0, 0, 3]; param size = 1 in [1e-4, 1e4];\n"
        "camera { eye: eye, target: at, fov: %.17g }\n"
        "light sun { direction: [1, 2, 1], shadow: false }\n%s",
        FOV, texts[kind]);
    if (krs_rendering_new(renderer, scene->product.scene, KRS_FOR_PICTURES, &scene->rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return scene;
}

/* What is seen, and from where. */
typedef struct Shot {
    Kind     kind;
    Vec      at, eye;
    double   size;        /* radius of the ball */
    Vec      sides, axis; /* of the box */
    double   angle;
    KrsTrace trace;
} Shot;

static void set_vector(const Scene *scene, const char *name, Vec v)
{
    const double values[3] = {v.x, v.y, v.z};
    assert_int_equal(krs_state_set(scene->product.state, name, values, 3), KRS_OK);
}

static KrsPicture *shot_render(const Shot *shot)
{
    Scene           *scene   = use_scene(shot->kind);
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .methods.trace = shot->trace};
    KrsPicture *picture;
    set_vector(scene, "at", shot->at);
    set_vector(scene, "eye", shot->eye);
    if (shot->kind == BLOCK) {
        set_vector(scene, "sides", shot->sides);
        set_vector(scene, "axis", shot->axis);
        krs_state_set(scene->product.state, "angle", &shot->angle, 1);
    } else
        krs_state_set(scene->product.state, "size", &shot->size, 1);
    if (krs_render(scene->rendering, scene->product.state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return picture;
}

/* Tells whether a ray meets the solid, larger by `more` on all sides. */
static bool is_met(const Shot *shot, Line ray, double more)
{
    ray.origin = vec_sub(ray.origin, shot->at);
    if (shot->kind != BLOCK) {
        Chord chord = chord_of_ball(ray, vec(0, 0, 0), shot->size + more);
        return !chord_is_empty(chord) && chord.leave > 0;
    }
    Line turned = {vec_rotate(ray.origin, shot->axis, -shot->angle),
                   vec_rotate(ray.direction, shot->axis, -shot->angle)};
    /* A tenth of what is thinner than a pixel may be missing. */
    double half[3] = {shot->sides.x / 2, shot->sides.y / 2, shot->sides.z / 2};
    for (int i = 0; i < 3; i++)
        half[i] += fmax(more, -0.1 * half[i]);
    Vec   corner = vec(half[0], half[1], half[2]);
    Chord chord  = chord_of_box(turned, vec_scale(-1, corner), corner);
    return !chord_is_empty(chord) && chord.leave > 0;
}

static double shot_distance(const Shot *shot) { return vec_distance(shot->eye, shot->at); }

/* Returns how many pixels are wrong. */
static size_t judge_shot(const Shot *shot, size_t *hits)
{
    Lens        lens    = lens_make(shot->eye, shot->at, tan(FOV / 2), false, WIDTH, HEIGHT);
    KrsPicture *picture = shot_render(shot);
    double      slack   = SLACK * lens_pixel(&lens, shot_distance(shot));
    size_t      missed = 0, extra = 0;
    *hits = 0;
    for (int k = 0; k < PIXELS; k++) {
        Line ray  = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        bool seen = picture->component[k] != 0;
        missed += !seen && is_met(shot, ray, -slack);
        extra += seen && !is_met(shot, ray, slack);
        *hits += seen;
    }
    extra += picture->stats.unresolved;
    if (missed + extra > 0)
        print_message(
            "# kind %d, trace %s, %.3g units out, %.3g away: %zu hits, %zu missed, %zu too "
            "many, %llu unresolved\n",
            shot->kind, krs_trace_names[shot->trace], vec_length(shot->at), shot_distance(shot),
            *hits, missed, extra, (unsigned long long)picture->stats.unresolved);
    krs_picture_free(picture);
    return missed + extra;
}

/* Numbers that single precision knows: what the device is given is then what the oracle has. */
static double rounded(double x) { return (double)(float)x; }

static Vec rounded_vec(Vec v) { return vec(rounded(v.x), rounded(v.y), rounded(v.z)); }

/* Places an eye some way from what it looks at. */
static void place(Shot *shot, Random *random, double far, double distance)
{
    Vec heading = random_unit(random);
    shot->at    = rounded_vec(vec_scale(far, random_unit(random)));
    shot->eye   = vec_add(shot->at, vec_scale(distance, heading));
}

static const double OUT[]   = {0, 1, 30, 64, 300, 900, 1100, 5000, 1e5};
static const double SIZES[] = {1e-3, 0.01, 0.3, 20, 400};
enum { OUTS = sizeof OUT / sizeof *OUT, SIZE_COUNT = sizeof SIZES / sizeof *SIZES };

static size_t wrong_balls(Kind kind, KrsTrace trace)
{
    Random random = {5};
    size_t wrong = 0, hits = 0, all = 0;
    for (int i = 0; i < OUTS; i++)
        for (int k = 0; k < SIZE_COUNT; k++) {
            Shot shot = {.kind = kind, .size = rounded(SIZES[k]), .trace = trace};
            place(&shot, &random, OUT[i], random_between(&random, 2.5, 8) * SIZES[k]);
            wrong += judge_shot(&shot, &hits);
            all += hits;
        }
    assert_true(all > OUTS * SIZE_COUNT * 300);
    return wrong;
}

static void balls_are_as_large_as_they_are(void **state)
{
    (void)state;
    assert_int_equal(wrong_balls(BALL, KRS_TRACE_DEFAULT), 0);
}

static void balls_are_so_by_roots(void **state)
{
    (void)state;
    static const KrsTrace methods[] = {KRS_TRACE_EXACT, KRS_TRACE_TAYLOR, KRS_TRACE_ROOT_FREE};
    size_t                wrong     = 0;
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
        wrong += wrong_balls(POLYNOMIAL, methods[i]);
    assert_int_equal(wrong, 0);
}

/* From any side, but every second from the front or from a side. */
static void place_block(Shot *shot, Random *random, double far, double size, int number)
{
    shot->axis  = random_unit(random);
    shot->angle = random_between(random, 0, 6);
    shot->sides = vec(size, size * random_between(random, 0.5, 2), size);
    place(shot, random, far, random_between(random, 1.5, 6) * size);
    if (number % 2 == 0)
        return;
    double lean    = number == 1 ? 0 : random_between(random, 1.2, M_PI / 2);
    Vec    heading = vec_rotate(vec(0, sin(lean), cos(lean)), shot->axis, shot->angle);
    shot->eye      = vec_add(shot->at, vec_scale(3 * size, heading));
}

/* `thinnest` and `thickest` in pixels; 0: thick. */
static size_t wrong_blocks(double thinnest, double thickest)
{
    static const KrsTrace methods[] = {KRS_TRACE_PLAIN, KRS_TRACE_RELAXED, KRS_TRACE_AUTO};
    enum { METHODS = sizeof methods / sizeof *methods };
    Random random = {9};
    size_t wrong = 0, hits = 0, all = 0;
    for (int i = 0; i < OUTS; i++)
        for (int k = 0; k < SIZE_COUNT; k++) {
            Shot   shot  = {.kind = BLOCK};
            double share = random_between(&random, 0, 1);
            place_block(&shot, &random, OUT[i], SIZES[k], k);
            double pixel = 2 * tan(FOV / 2) / HEIGHT * shot_distance(&shot);
            if (thickest > 0)
                shot.sides.z = pixel * thinnest * pow(thickest / thinnest, share);
            shot.sides = rounded_vec(shot.sides);
            for (int m = 0; m < METHODS; m++) {
                shot.trace = methods[m];
                wrong += judge_shot(&shot, &hits);
                all += hits;
            }
        }
    assert_true(all > METHODS * OUTS * SIZE_COUNT * 100);
    return wrong;
}

static void blocks_are_as_large_as_they_are(void **state)
{
    (void)state;
    assert_int_equal(wrong_blocks(0, 0), 0);
}

/* Down to a thirty-second of a pixel: what a march may leave open is half of that. */
static void thin_plates_lose_nothing_at_any_angle(void **state)
{
    (void)state;
    assert_int_equal(wrong_blocks(1.0 / 32, 3), 0);
}

/* A ball that is larger by a tenth of a pixel does not pass. */
static void the_oracle_sees_a_tenth_of_a_pixel(void **state)
{
    (void)state;
    Shot        shot = {.kind = BALL, .size = 1, .eye = {0.83, 0.51, 3.9}};
    Lens        lens = lens_make(shot.eye, shot.at, tan(FOV / 2), false, WIDTH, HEIGHT);
    KrsPicture *picture;
    double      more = 0.1 * lens_pixel(&lens, 4), slack = SLACK * lens_pixel(&lens, 4);
    size_t      extra = 0;
    shot.size += more;
    picture = shot_render(&shot);
    shot.size -= more;
    for (int k = 0; k < PIXELS; k++) {
        Line ray = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        extra += picture->component[k] && !is_met(&shot, ray, slack);
    }
    krs_picture_free(picture);
    assert_true(extra > 0);
}

static int close_all(void **state)
{
    for (int i = 0; i < KINDS; i++) {
        krs_rendering_free(scenes[i].rendering);
        product_free(&scenes[i].product);
    }
    return renderer_close(state);
}

int main(void)
{
    product_wants_research();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_oracle_sees_a_tenth_of_a_pixel),
        cmocka_unit_test(balls_are_as_large_as_they_are),
        cmocka_unit_test(balls_are_so_by_roots),
        cmocka_unit_test(blocks_are_as_large_as_they_are),
        cmocka_unit_test(thin_plates_lose_nothing_at_any_angle),
    };
    return cmocka_run_group_tests_name("scales", tests, renderer_open, close_all);
}
