/*
 * caustics.c: what a slab, a ball and a ring gather of the sun and of a lamp, held against closed forms and against
 * rays that are followed here, in the plane of a ball and between the walls of a ring.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

#define SUN      3.0
#define SHADE    0.5 /* of the floor */
#define SIDE     64  /* of pictures, in pixels */
#define BOUNDARY 1.5 /* index of refraction */

/* Paths end at the second surface, so the floor does not light itself by mirrors. */
static const KrsRenderOptions photons = {.width      = SIDE,
                                         .height     = SIDE,
                                         .samples    = 8,
                                         .bounces    = 1,
                                         .aovs       = KRS_AOV_COLOR,
                                         .integrator = KRS_INTEGRATOR_PATH,
                                         .caustics   = KRS_CAUSTICS_PHOTONS};

/* Each scene has a camera that looks straight down at the floor, 2 * `half` of which fill the picture. */
#define SCENE(eye, half)                                                         \
    "camera { eye: [0, " eye ", 0], target: [0, 0, 0], up: [0, 0, 1],\n"         \
    "         projection: \"orthographic\", height: 2 * " half " }\n"            \
    "sky { zenith: black, horizon: black, ground: black }\n"                     \
    "material glass { color: white, transmission: 1, roughness: 0, ior: 1.5 }\n" \
    "material silver { color: white, metallic: 1, roughness: 0 }\n"              \
    "material chalk { color: [0.5, 0.5, 0.5], specular: 0, roughness: 1 }\n"     \
    "show box([20, 1, 20]).move([0, -0.5, 0]).paint(chalk);\n"

static double fresnel(double sine, double cosine, double index)
{
    const double beyond = sqrt(fmax(1 - sine * sine / (index * index), 0));
    if (sine >= index)
        return 1;
    return 0.5 * (pow((cosine - index * beyond) / (cosine + index * beyond), 2) +
                  pow((index * cosine - beyond) / (index * cosine + beyond), 2));
}

/* ---- a slab ---- */

/* All ways from boundary to boundary together. */
static double left_by_slab(double cosine)
{
    const double mirrored = fresnel(sqrt(1 - cosine * cosine), cosine, BOUNDARY);
    return (1 - mirrored) / (1 + mirrored);
}

static void a_slab_lets_light_through(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(SCENE(
        "0.9",
        "0.05") "param sunny = 0 in [0, 9]; param lit = 0 in [0, 99]; param wide = 0 in [0, 1];\n"
                "light sun { direction: [0.28, 0.96, 0], intensity: sunny }\n"
                "light lamp { position: [0, 4, 0], intensity: lit, radius: wide }\n"
                "show box([1.5, 0.2, 1.5]).move([0, 1.1, 0]).paint(glass);\n");
    size_t      wrong   = 0;
    path_fixture_set(&fixture, "sunny", SUN);
    wrong += !must_be_near(path_fixture_estimate(&fixture, photons, everywhere, 5),
                           SUN * 0.96 * SHADE / M_PI * left_by_slab(0.96), 0.01, "a sun");
    path_fixture_set(&fixture, "sunny", 0);
    path_fixture_set(&fixture, "lit", 50);
    /* Head on the slab brings the lamp nearer by a third of its thickness. */
    const double lamp = 50 / pow(4 - 0.2 * (1 - 1 / BOUNDARY), 2) * SHADE / M_PI * left_by_slab(1);
    for (int i = 0; i < 2; i++) {
        path_fixture_set(&fixture, "wide", 0.1 * i);
        wrong += !must_be_near(path_fixture_estimate(&fixture, photons, everywhere, 5), lamp, 0.01,
                               i ? "a lamp" : "a point");
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* ---- irradiance in bins of the floor ---- */

enum { BINS = 8, IN_BIN = SIDE / BINS };

/* Returns the mean of the light of the pixels of a bin over several pictures. */
static void find_bins(const char *text, double bins[BINS][BINS], double *error)
{
    enum { PICTURES = 2 };
    PathFixture fixture = path_fixture_open(text);
    Estimate    all     = {0};
    memset(bins, 0, sizeof(double[BINS][BINS]));
    for (int i = 0; i < PICTURES; i++) {
        KrsRenderOptions options = photons;
        options.seed             = (uint64_t)i + 1;
        KrsPicture *picture      = path_fixture_render(&fixture, &options);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                bins[y / IN_BIN][x / IN_BIN] += (double)picture->color[4 * (y * SIDE + x) + 1] /
                                                (IN_BIN * IN_BIN * PICTURES);
        estimate_add(&all, mean_of_region(picture, everywhere, 1));
        krs_picture_free(picture);
    }
    *error = all.error;
    path_fixture_close(&fixture);
}

/* Tells how far bins are from what is expected, in parts of all light; only of those within the radius. */
static double find_difference(double found[BINS][BINS], double expected[BINS][BINS], double half,
                              double radius)
{
    double apart = 0, all = 0;
    for (int y = 0; y < BINS; y++)
        for (int x = 0; x < BINS; x++) {
            const double far = half * hypot(fabs(2 * (x + 0.5) / BINS - 1) + 1.0 / BINS,
                                            fabs(2 * (y + 0.5) / BINS - 1) + 1.0 / BINS);
            if (far > radius)
                continue;
            apart += fabs(found[y][x] - expected[y][x]);
            all += expected[y][x];
        }
    assert_true(all > 0);
    return apart / all;
}

/* ---- a ring ---- */

#define RING_HALF   1.0
#define RING_INNER  0.9
#define RING_HEIGHT 0.5

/* Follows light of the sun from the opening of a ring to its floor, from mirror to mirror. */
static void follow_in_ring(double bins[BINS][BINS])
{
    enum { ACROSS = 1500 };
    const double along = 0.8, down = 0.6; /* of the sun's direction, which is (0, down, along) */
    const double area = pow(2 * RING_INNER / ACROSS, 2), bin = pow(2 * RING_HALF / BINS, 2);
    memset(bins, 0, sizeof(double[BINS][BINS]));
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        double x  = RING_INNER * (2 * (i % ACROSS + 0.5) / ACROSS - 1);
        double z  = RING_INNER * (2 * (i / ACROSS + 0.5) / ACROSS - 1);
        double dx = 0, dz = -1, left = RING_HEIGHT * along / down; /* of the way over the floor */
        if (hypot(x, z) >= RING_INNER)
            continue;
        for (;;) {
            const double b    = x * dx + z * dz;
            const double wall = -b + sqrt(fmax(b * b - x * x - z * z + RING_INNER * RING_INNER, 0));
            const double step = fmin(left, wall);
            x += step * dx;
            z += step * dz;
            left -= step;
            if (left <= 0)
                break;
            const double across = (x * dx + z * dz) / (RING_INNER * RING_INNER);
            dx -= 2 * across * x;
            dz -= 2 * across * z;
        }
        const int column = (int)floor((x / RING_HALF + 1) * 0.5 * BINS);
        const int row    = (int)floor((1 - z / RING_HALF) * 0.5 * BINS);
        bins[row][column] += SUN * down * area / bin * SHADE / M_PI;
    }
}

static const char ring[] = SCENE(
    "5", "1") "light sun { direction: [0, 0.6, 0.8], intensity: 3 }\n"
              "show (cylinder(1, 0.7) - cylinder(0.9, 2)).move([0, 0.15, 0])\n"
              "    .paint(silver);\n";

/* Its cardioid has most of the light, and the rest is in shadow. */
static void a_ring_gathers_light(void **state)
{
    (void)state;
    double found[BINS][BINS], expected[BINS][BINS], error;
    find_bins(ring, found, &error);
    follow_in_ring(expected);
    const double apart = find_difference(found, expected, RING_HALF, RING_INNER);
    print_message("# a ring: %.4f of the light elsewhere\n", apart);
    assert_true(apart < 0.04);
    expected[BINS / 2][BINS / 2] *= 1.5; /* the check sees a bin that is wrong */
    expected[BINS / 2 - 1][BINS / 2] *= 1.5;
    assert_true(find_difference(found, expected, RING_HALF, RING_INNER) > 0.04);
}

/* ---- a ball ---- */

#define BALL_HALF 0.8
#define BALL      0.5
#define BALL_AT   0.8 /* height of its middle */

/* Adds light of a ring around the axis, `weight` of it, that ends so far from it. */
static void add_ring(double bins[BINS][BINS], double far, double weight)
{
    enum { AROUND = 64 };
    const double bin = pow(2 * BALL_HALF / BINS, 2);
    for (int i = 0; i < AROUND; i++) {
        const double angle  = 2 * M_PI * (i + 0.5) / AROUND;
        const double column = floor((far * cos(angle) / BALL_HALF + 1) * 0.5 * BINS);
        const double row    = floor((far * sin(angle) / BALL_HALF + 1) * 0.5 * BINS);
        if (column >= 0 && column < BINS && row >= 0 && row < BINS)
            bins[(int)row][(int)column] += weight / AROUND / bin * SHADE / M_PI;
    }
}

/* Follows light of a sun overhead through a ball, in the plane of its axis. */
static void follow_in_ball(double bins[BINS][BINS])
{
    enum { RINGS = 40000, MIRRORED = 12 };
    const double widest = BALL_HALF * 1.5;
    memset(bins, 0, sizeof(double[BINS][BINS]));
    for (int i = 0; i < RINGS; i++) {
        const double far    = widest * (i + 0.5) / RINGS;
        const double weight = SUN * 2 * M_PI * far * widest / RINGS, sine = far / BALL;
        if (sine >= 1) {
            add_ring(bins, far, weight);
            continue;
        }
        const double in = asin(sine), inner = asin(sine / BOUNDARY);
        const double mirrored = fresnel(sine, cos(in), BOUNDARY);
        double       left     = weight * (1 - mirrored);
        /* Angles of places on the ball, from the top; each chord turns by pi - 2 * inner. */
        double place = in;
        for (int k = 0; k < MIRRORED; k++) {
            place += M_PI - 2 * inner;
            const double out  = place + in; /* of the direction, from upwards */
            const double down = -cos(out), x = BALL * sin(place), y = BALL_AT + BALL * cos(place);
            if (down > 1e-3)
                add_ring(bins, fabs(x + y / down * sin(out)), left * (1 - mirrored));
            left *= mirrored;
        }
        /* The outside mirrors, too. */
        if (-cos(2 * in) > 1e-3 && mirrored > 0)
            add_ring(bins, BALL * sin(in) + (BALL_AT + BALL * cos(in)) / -cos(2 * in) * sin(2 * in),
                     weight * mirrored);
    }
}

static const char ball[] = SCENE("0.2", "0.8") "light sun { direction: [0, 1, 0], intensity: 3 }\n"
                                               "show sphere(0.5).move([0, 0.8, 0]).paint(glass);\n";

static void a_ball_gathers_light(void **state)
{
    (void)state;
    double found[BINS][BINS], expected[BINS][BINS], error;
    find_bins(ball, found, &error);
    follow_in_ball(expected);
    const double apart = find_difference(found, expected, BALL_HALF, BALL_HALF * 1.5);
    print_message("# a ball: %.4f of the light elsewhere\n", apart);
    assert_true(apart < 0.04);
}

/* ---- samples ---- */

/* Crops and further samples have the photons of the whole picture: numbers are the same bit by bit. */
static void photons_are_those_of_the_picture(void **state)
{
    (void)state;
    PathFixture      fixture = path_fixture_open(ring);
    KrsRenderOptions options = photons;
    options.samples          = 2;
    KrsPicture *whole        = path_fixture_render(&fixture, &options);
    options.crop             = (KrsWindow){24, 16, 16, 24};
    KrsPicture *part         = path_fixture_render(&fixture, &options);
    for (unsigned y = 0; y < 24; y++)
        assert_memory_equal(&part->color[4 * y * 16], &whole->color[4 * ((y + 16) * SIDE + 24)],
                            4 * 16 * sizeof(float));
    krs_picture_free(part);
    krs_picture_free(whole);
    path_fixture_close(&fixture);
}

/* Returns the mean square of the difference between two pictures of so many samples, within the ring. */
static double find_noise(const PathFixture *fixture, uint32_t samples)
{
    KrsRenderOptions options = photons;
    KrsPicture      *pictures[2];
    double           sum = 0;
    options.samples      = samples;
    for (uint64_t i = 0; i < 2; i++) {
        options.seed = i + 1;
        pictures[i]  = path_fixture_render(fixture, &options);
    }
    for (unsigned i = 0; i < SIDE * SIDE; i++)
        sum += pow((double)pictures[0]->color[4 * i] - (double)pictures[1]->color[4 * i], 2);
    krs_picture_free(pictures[0]);
    krs_picture_free(pictures[1]);
    return sum;
}

/* The radius shrinks by the power 0.15 of the number of samples, so the variance of a place falls by the power 0.7: eight
   times as many leave 0.23 of it. */
static void noise_falls_with_samples(void **state)
{
    (void)state;
    PathFixture  fixture = path_fixture_open(ring);
    const double left    = find_noise(&fixture, 16) / find_noise(&fixture, 2);
    print_message("# of 2 samples' variance 16 leave %.3f\n", left);
    assert_true(left < 0.35);
    path_fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_lets_light_through),
        cmocka_unit_test(a_ring_gathers_light),
        cmocka_unit_test(a_ball_gathers_light),
        cmocka_unit_test(photons_are_those_of_the_picture),
        cmocka_unit_test(noise_falls_with_samples),
    };
    return cmocka_run_group_tests_name("caustics", tests, renderer_open, renderer_close);
}
