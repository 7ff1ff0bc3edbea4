/*
 * cornell.c: light that bounces in a box of coloured walls, with a block and a ball in it, held
 * against Monte Carlo in double precision.
 *
 * The reference knows where rays meet blocks and balls in closed form.  It meets a panel that emits
 * by chance, and of a lamp it chooses points of the whole surface.  What is seen of the surface from
 * a place follows from that, where the integrator knows the solid angle.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

/* ---- The room ---- */

static const char room_text[] =
    "param glow = 0 in [0, 99]; param power = 0 in [0, 99];\n"
    "camera { eye: [0, 0, 3.6], fov: 30deg }\n"
    "sky { zenith: black, horizon: black, ground: black }\n"
    "light lamp { position: [0.25, 0.3, 0.35], radius: 0.2, intensity: power }\n"
    "material white { color: [0.75, 0.75, 0.75], specular: 0 }\n"
    "material red { color: [0.65, 0.1, 0.1], specular: 0 }\n"
    "material green { color: [0.1, 0.5, 0.1], specular: 0 }\n"
    "material panel { color: black, specular: 0, emission: [glow, glow, glow] }\n"
    "show box([2.4, 0.2, 2]).move([0, -1.1, 0]).paint(white);\n"
    "show box([2.4, 0.2, 2]).move([0, 1.1, 0]).paint(white);\n"
    "show box([2.4, 2.4, 0.2]).move([0, 0, -1.1]).paint(white);\n"
    "show box([0.2, 2, 2]).move([-1.1, 0, 0]).paint(red);\n"
    "show box([0.2, 2, 2]).move([1.1, 0, 0]).paint(green);\n"
    "show box([0.6, 0.9, 0.6]).move([-0.4, -0.55, -0.3]).paint(white);\n"
    "show sphere(0.35).move([0.45, -0.65, 0.2]).paint(white);\n"
    "show box([1.4, 0.04, 1.4]).move([0, 0.98, 0]).paint(panel);\n";

/* The same once more: blocks by their middle and half sides, a ball by its radius. */
typedef struct Solid {
    Vec    middle, half;
    double radius;
    double color[3];
} Solid;

#define WHITE 0.75
#define WHITES              \
    {                       \
        WHITE, WHITE, WHITE \
    }
static const Solid solids[] = {
    {{0, -1.1, 0}, {1.2, 0.1, 1}, 0, WHITES},
    {{0, 1.1, 0}, {1.2, 0.1, 1}, 0, WHITES},
    {{0, 0, -1.1}, {1.2, 1.2, 0.1}, 0, WHITES},
    {{-1.1, 0, 0}, {0.1, 1, 1}, 0, {0.65, 0.1, 0.1}},
    {{1.1, 0, 0}, {0.1, 1, 1}, 0, {0.1, 0.5, 0.1}},
    {{-0.4, -0.55, -0.3}, {0.3, 0.45, 0.3}, 0, WHITES},
    {{0.45, -0.65, 0.2}, {0, 0, 0}, 0.35, WHITES},
    {{0, 0.98, 0}, {0.7, 0.02, 0.7}, 0, {0, 0, 0}},
};
enum { SOLIDS = sizeof solids / sizeof *solids, PANEL = SOLIDS - 1, BOUNCES = 10 };
static const Vec    lamp_middle = {0.25, 0.3, 0.35};
static const double lamp_radius = 0.2;

/* What a light sends from each point of its surface. */
typedef struct Lit {
    double panel, lamp; /* radiances */
    double white;       /* what white things are multiplied by, to plant a fault */
} Lit;

typedef struct Meeting {
    double t;
    int    solid; /* -1: none */
    Vec    point, normal;
} Meeting;

/* ---- Rays ---- */

static Vec normal_of(const Solid *solid, Vec point)
{
    Vec apart = vec_sub(point, solid->middle);
    if (solid->radius > 0)
        return vec_unit(apart);
    double x = fabs(apart.x) - solid->half.x, y = fabs(apart.y) - solid->half.y,
           z = fabs(apart.z) - solid->half.z;
    if (x >= y && x >= z)
        return vec(copysign(1, apart.x), 0, 0);
    return y >= z ? vec(0, copysign(1, apart.y), 0) : vec(0, 0, copysign(1, apart.z));
}

static Meeting meet(Line line)
{
    Meeting first = {.t = HUGE_VAL, .solid = -1};
    for (int i = 0; i < SOLIDS; i++) {
        const Solid *s     = &solids[i];
        Chord        chord = s->radius > 0 ? chord_of_ball(line, s->middle, s->radius)
                                           : chord_of_box(line, vec_sub(s->middle, s->half),
                                                          vec_add(s->middle, s->half));
        if (!chord_is_empty(chord) && chord.enter > 1e-9 && chord.enter < first.t) {
            first.t     = chord.enter;
            first.solid = i;
        }
    }
    if (first.solid >= 0) {
        first.point  = line_at(line, first.t);
        first.normal = normal_of(&solids[first.solid], first.point);
    }
    return first;
}

/* Tells whether nothing lies between two points. */
static bool sees(Vec from, Vec to)
{
    Vec apart = vec_sub(to, from);
    return meet((Line){from, vec_unit(apart)}).t > vec_length(apart);
}

/* ---- Light ---- */

/* Returns the light of a small part of a surface, over the probability density of having chosen
   it. */
static double sent(const Meeting *at, Vec point, Vec normal, double area)
{
    Vec    apart    = vec_sub(point, at->point);
    double distance = vec_length(apart);
    Vec    toward   = vec_scale(1 / distance, apart);
    double facing = vec_dot(toward, at->normal), leaving = -vec_dot(toward, normal);
    Vec    start = vec_add(at->point, vec_scale(1e-7, at->normal));
    if (facing <= 0 || leaving <= 0 || !sees(start, point))
        return 0;
    return area * facing * leaving / (M_PI * distance * distance);
}

/* What the lamp sends there, by a point of its surface; nothing hides it but the solids. */
static double light_of_lamp(const Meeting *at, Random *random)
{
    double z = random_between(random, -1, 1), turn = random_between(random, 0, 2 * M_PI);
    double ring   = sqrt(1 - z * z);
    Vec    normal = vec(ring * cos(turn), ring * sin(turn), z);
    Vec    point  = vec_add(lamp_middle, vec_scale(lamp_radius, normal));
    return sent(at, point, normal, 4 * M_PI * lamp_radius * lamp_radius);
}

static Vec scattered(Vec normal, Random *random)
{
    double square = random_between(random, 0, 1), turn = random_between(random, 0, 2 * M_PI);
    Vec    right = vec_across(normal), up = vec_cross(normal, right);
    Vec    flat = vec_add(vec_scale(cos(turn), right), vec_scale(sin(turn), up));
    return vec_add(vec_scale(sqrt(square), flat), vec_scale(sqrt(1 - square), normal));
}

/* Adds what one path finds. */
static void follow(const Lit *lit, Line line, Random *random, double sum[3])
{
    double weight[3] = {1, 1, 1};
    for (int bounce = 0; bounce <= BOUNCES; bounce++) {
        Meeting at = meet(line);
        if (at.solid < 0)
            return;
        double lamp = lit->lamp > 0 && bounce < BOUNCES ? lit->lamp * light_of_lamp(&at, random)
                                                        : 0;
        for (int i = 0; i < 3; i++) {
            double color = solids[at.solid].color[i];
            sum[i] += at.solid == PANEL ? weight[i] * lit->panel : 0;
            weight[i] *= color == WHITE ? color * lit->white : color;
            sum[i] += weight[i] * lamp;
        }
        line = (Line){vec_add(at.point, vec_scale(1e-7, at.normal)), scattered(at.normal, random)};
    }
}

/* ---- Means of blocks ---- */

enum { ACROSS = 8, DOWN = 6, BLOCKS = ACROSS * DOWN, PARTS = 8 };
enum { WIDTH = 256, HEIGHT = 192, SIDE = WIDTH / ACROSS };

enum { PATHS = 1200, SAMPLES = 2 }; /* of a block of the reference, of a pixel */

/* Estimates of red, green and blue in each block; and of all together. */
typedef struct Blocks {
    Estimate of[BLOCKS][3], all;
} Blocks;

/* Adds a picture, or a part of the reference. */
static void add_part(Blocks *blocks, double means[BLOCKS][3])
{
    double all = 0;
    for (int k = 0; k < BLOCKS; k++)
        for (int i = 0; i < 3; i++) {
            estimate_add(&blocks->of[k][i], means[k][i]);
            all += means[k][i] / (3 * BLOCKS);
        }
    estimate_add(&blocks->all, all);
}

static void reference(const Lit *lit, int paths, Blocks *blocks)
{
    Lens lens = lens_make(vec(0, 0, 3.6), vec(0, 0, 0), tan(15 * M_PI / 180), false, ACROSS, DOWN);
    Random random = {7};
    *blocks       = (Blocks){0};
    for (int part = 0; part < PARTS; part++) {
        double means[BLOCKS][3] = {{0}};
        for (int k = 0; k < BLOCKS; k++) {
            for (int i = 0; i < paths; i++)
                follow(lit,
                       lens_ray(&lens, k % ACROSS + random_between(&random, 0, 1),
                                k / ACROSS + random_between(&random, 0, 1)),
                       &random, means[k]);
            for (int i = 0; i < 3; i++)
                means[k][i] /= paths;
        }
        add_part(blocks, means);
    }
}

static void add_picture(const KrsPicture *picture, Blocks *blocks)
{
    double means[BLOCKS][3] = {{0}};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int i = 0; i < 3; i++)
                means[y / SIDE * ACROSS + x / SIDE][i] +=
                    (double)picture->color[4 * (y * WIDTH + x) + i] / (SIDE * SIDE);
    add_part(blocks, means);
}

static void take_pictures(PathFixture *fixture, const Lit *lit, Blocks *blocks)
{
    *blocks = (Blocks){0};
    path_fixture_set(fixture, "glow", lit->panel);
    path_fixture_set(fixture, "power", lit->lamp * M_PI * lamp_radius * lamp_radius);
    for (uint64_t seed = 1; seed <= PARTS; seed++) {
        KrsPicture *picture = path_fixture_render(
            fixture, &(KrsRenderOptions){.width      = WIDTH,
                                         .height     = HEIGHT,
                                         .samples    = SAMPLES,
                                         .seed       = seed,
                                         .bounces    = BOUNCES,
                                         .aovs       = KRS_AOV_COLOR,
                                         .integrator = KRS_INTEGRATOR_PATH});
        add_picture(picture, blocks);
        krs_picture_free(picture);
    }
}

/* ---- The comparison ---- */

/* What may be wrong in a block beside noise, as rays begin a bit above surfaces; and in all. */
#define MAX_WRONG     0.01
#define MAX_WRONG_ALL 0.005

static bool agrees(Estimate found, Estimate right, double part)
{
    found.error = hypot(found.error, right.error);
    return is_near(found, right.mean, part);
}

/* Returns the blocks that differ, in any of their colours, and whether all together do. */
static size_t count_wrong(const Blocks *found, const Blocks *right)
{
    size_t wrong = !agrees(found->all, right->all, MAX_WRONG_ALL);
    for (int k = 0; k < BLOCKS; k++)
        for (int i = 0; i < 3; i++)
            wrong += !agrees(found->of[k][i], right->of[k][i], MAX_WRONG);
    return wrong;
}

static void compare(const Lit *lit)
{
    static Blocks found, right, darker;
    PathFixture   fixture = path_fixture_open(room_text);
    Lit           gray    = *lit;
    gray.white            = 0.95; /* a planted fault */
    take_pictures(&fixture, lit, &found);
    path_fixture_close(&fixture);
    reference(lit, PATHS, &right);
    reference(&gray, PATHS, &darker);
    assert_int_equal(count_wrong(&found, &right), 0);
    assert_true(count_wrong(&found, &darker) > 0);
}

static void a_lamp_lights_a_room(void **state)
{
    (void)state;
    compare(&(Lit){.lamp = 20, .white = 1});
}

static void a_panel_lights_a_room(void **state)
{
    (void)state;
    compare(&(Lit){.panel = 1, .white = 1});
}

/* ---- The error falls with the samples ---- */

/* The root of the mean square of what pictures of this many samples differ from their mean. */
static double find_noise(PathFixture *fixture, uint32_t samples)
{
    enum { SMALL = 48 * 36 };
    KrsPicture      *pictures[2];
    double           sum     = 0;
    KrsRenderOptions options = {.width      = 48,
                                .height     = 36,
                                .samples    = samples,
                                .aovs       = KRS_AOV_COLOR,
                                .integrator = KRS_INTEGRATOR_PATH};
    for (int i = 0; i < 2; i++) {
        options.seed = (uint64_t)i + 1;
        pictures[i]  = path_fixture_render(fixture, &options);
    }
    for (int k = 0; k < 4 * SMALL; k++) {
        double apart = (double)pictures[0]->color[k] - (double)pictures[1]->color[k];
        sum += apart * apart / 2;
    }
    krs_picture_free(pictures[0]);
    krs_picture_free(pictures[1]);
    return sqrt(sum / (3 * SMALL));
}

/* Where nothing else is smooth, noise falls as the root of the number of samples; points that fill
   the square evenly do better.  Estimates of it from so many pixels are right to a few hundredths. */
static void more_samples_have_less_noise(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(room_text);
    for (int panel = 0; panel < 2; panel++) {
        path_fixture_set(&fixture, "glow", panel ? 1 : 0);
        path_fixture_set(&fixture, "power", panel ? 0 : 2);
        double before = find_noise(&fixture, 2);
        for (uint32_t samples = 8; samples <= 32; samples *= 4) {
            double noise = find_noise(&fixture, samples);
            assert_true(noise > 0 && noise < 0.5 * 1.1 * before);
            before = noise;
        }
    }
    path_fixture_close(&fixture);
}

/* A varnished floor: rays choose between the varnish, what it mirrors below, and the body. */
static const char floor_text[] =
    "camera { eye: [0, 4, 14], target: [0, 0.7, 0], fov: 30deg }\n"
    "light none { direction: [0, 1, 0], intensity: 0 }\n"
    "sky { zenith: #6080b0, horizon: #c0c8d0, ground: #504840 }\n"
    "material varnished { color: gray, coat: 1, coat_roughness: 0.3 }\n"
    "show plane().paint(varnished);\n";

/* Rays of a pixel that choose the same layer fill its directions evenly, too.  If they were a random
   choice of all points, noise would fall as the root of the number of samples. */
static void rays_of_each_layer_are_even(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(floor_text);
    double      before = find_noise(&fixture, 16), after = find_noise(&fixture, 256);
    assert_true(after > 0 && after < 0.6 * 0.25 * before);
    path_fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_lights_a_room),
        cmocka_unit_test(a_panel_lights_a_room),
        cmocka_unit_test(more_samples_have_less_noise),
        cmocka_unit_test(rays_of_each_layer_are_even),
    };
    return cmocka_run_group_tests_name("cornell", tests, renderer_open, renderer_close);
}
