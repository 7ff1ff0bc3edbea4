/*
 * daylight.c: the clear sky is, within a fifth, what light is that is followed through the air photon
 * by photon, and the sun is as dim as tables of astronomers say.
 *
 * The air is described here once more, by its numbers alone: Rayleigh's scattering, haze, ozone, and a
 * ground that scatters.  Paths begin at the eye, go free lengths by chance, and ask at each
 * scattering what comes from the sun.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/scene/daylight.h"
#include "tests/support/random.h"

#define EARTH  6360.0
#define AIR    6460.0
#define ALBEDO 0.3

typedef struct V {
    double x, y, z;
} V;

static V      add(V a, V b, double t) { return (V){a.x + t * b.x, a.y + t * b.y, a.z + t * b.z}; }
static double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static V      unit(V a)
{
    double length = sqrt(dot(a, a));
    return (V){a.x / length, a.y / length, a.z / length};
}

/* What is lost, and scattered by molecules and by haze, on a kilometre at a height, for green. */
typedef struct Here {
    double lost, molecules, particles;
} Here;

static double turbidity = 2.5;

static Here here(double height)
{
    double molecules = 0.013558 * exp(-height / 8);
    double depth     = (turbidity - 1) * 0.013558 * 8; /* of all haze above */
    double haze      = depth / 1.2 * exp(-height / 1.2);
    double ozone     = 0.001881 * fmax(0, 1 - fabs(height - 25) / 15);
    return (Here){molecules + haze + ozone, molecules, 0.9 * haze};
}

static double height_of(V p) { return sqrt(dot(p, p)) - EARTH; }

/* Where a ray leaves a ball, or enters it; negative: nowhere. */
static double meets(V p, V d, double radius, int leaves)
{
    double b = dot(p, d), square = b * b - dot(p, p) + radius * radius;
    return square < 0 ? -1 : leaves ? -b + sqrt(square) : -b - sqrt(square);
}

static double reaches_sun(V p, V sun)
{
    enum { STEPS = 60 };
    double length = meets(p, sun, AIR, 1), depth = 0;
    if (meets(p, sun, EARTH, 0) > 0)
        return 0;
    for (int i = 0; i < STEPS; i++) {
        double from = pow((double)i / STEPS, 3), to = pow((i + 1.0) / STEPS, 3);
        depth += here(height_of(add(p, sun, length * 0.5 * (from + to)))).lost * length *
                 (to - from);
    }
    return exp(-depth);
}

static double rayleigh(double c) { return 3 / (16 * M_PI) * (1 + c * c); }
static double haze_phase(double c) { return (1 - 0.64) / (4 * M_PI * pow(1.64 - 1.6 * c, 1.5)); }

static V cross(V a, V b)
{
    return (V){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Returns a direction at an angle from another, anywhere around it. */
static V turned(V d, double cosine, Random *state)
{
    V      side  = unit(cross(d, fabs(d.x) < 0.5 ? (V){1, 0, 0} : (V){0, 1, 0}));
    V      other = cross(d, side);
    double sine = sqrt(fmax(1 - cosine * cosine, 0)), angle = random_between(state, 0, 2 * M_PI);
    V      there = add((V){0, 0, 0}, d, cosine);
    return add(add(there, side, sine * cos(angle)), other, sine * sin(angle));
}

/* Returns the cosine of a scattering, by molecules (by rejection) or by haze. */
static double scattered(int haze, Random *state)
{
    double s = (1 - 0.64) / (1 - 0.8 + 1.6 * random_between(state, 0, 1));
    if (haze)
        return (1 + 0.64 - s * s) / 1.6;
    for (;;) {
        double c = random_between(state, -1, 1);
        if (random_between(state, 0, 2) < 1 + c * c)
            return c;
    }
}

/* Returns the length up to where a photon is lost (by a majorant, Woodcock 1965); negative: it is
   not. */
static double free_length(V p, V d, double end, Random *state)
{
    const double most = here(0).lost;
    for (double t = 0;;) {
        t -= log(1 - random_between(state, 0, 1)) / most;
        if (t >= end)
            return -1;
        if (random_between(state, 0, 1) * most < here(fmax(height_of(add(p, d, t)), 0)).lost)
            return t;
    }
}

/* Returns the light of one path. */
static double follow(V p, V d, V sun, Random *state)
{
    double light = 0, weight = 1;
    for (int bounce = 0; bounce < 60 && weight > 1e-4; bounce++) {
        double ground = meets(p, d, EARTH, 0);
        double t      = free_length(p, d, ground > 0 ? ground : meets(p, d, AIR, 1), state);
        V      old    = d;
        if (t < 0 && ground <= 0)
            return light;
        if (t < 0) { /* the ground: towards the cosine, which a ball on it gives */
            p    = add(p, old, ground);
            V up = unit(p);
            p    = add(p, up, 1e-6);
            light += weight * ALBEDO / M_PI * fmax(dot(up, sun), 0) * reaches_sun(p, sun);
            d = unit(add(up, turned(up, random_between(state, -1, 1), state), 1));
            weight *= ALBEDO;
            continue;
        }
        p        = add(p, old, t);
        Here   m = here(fmax(height_of(p), 0));
        double c = dot(old, sun), sum = m.molecules + m.particles;
        light += weight * (m.molecules * rayleigh(c) + m.particles * haze_phase(c)) / m.lost *
                 reaches_sun(p, sun);
        d = turned(old, scattered(random_between(state, 0, sum) > m.molecules, state), state);
        weight *= sum / m.lost;
    }
    return light;
}

static double brute_force(double view, double azimuth, double sun_height, double *error)
{
    enum { PATHS = 6000 };
    Random state = {7};
    V      eye = {0, EARTH + 0.002, 0}, sun = {0, sin(sun_height), cos(sun_height)};
    V      d   = {cos(view) * sin(azimuth), sin(view), cos(view) * cos(azimuth)};
    double sum = 0, squares = 0;
    for (int i = 0; i < PATHS; i++) {
        double light = follow(eye, d, sun, &state);
        sum += light / PATHS;
        squares += light * light / PATHS;
    }
    *error = sqrt((squares - sum * sum) / PATHS);
    return sum;
}

static float (*sky_of(double sun_height, double haze))[3]
{
    const Daylight light = {sin(sun_height), haze, {ALBEDO, ALBEDO, ALBEDO}};
    float(*texels)[3]    = calloc(DAYLIGHT_WIDTH * DAYLIGHT_HEIGHT, sizeof *texels);
    assert_true(daylight_sky(&light, texels));
    return texels;
}

/* Returns the texel at an angle above the horizon and one from where the sun is. */
static double texel_at(float (*texels)[3], double height, double azimuth, int channel)
{
    int row    = (int)((0.5 - height / M_PI) * DAYLIGHT_HEIGHT);
    int column = (int)((0.5 + azimuth / (2 * M_PI)) * DAYLIGHT_WIDTH);
    return (double)texels[row * DAYLIGHT_WIDTH + column][channel];
}

static void the_sky_is_what_photons_bring(void **state)
{
    (void)state;
    static const struct {
        double sun, view, azimuth; /* degrees */
    } cases[] = {{60, 89, 10}, {60, 30, 100}, {25, 89, 10}, {25, 10, 60}, {8, 60, 150}, {8, 5, 30}};
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double degree = M_PI / 180, sun = cases[i].sun * degree;
        float(*texels)[3] = sky_of(sun, turbidity);
        double error, view = cases[i].view * degree, azimuth = cases[i].azimuth * degree;
        double right = brute_force(view, azimuth, sun, &error);
        double found = texel_at(texels, view, azimuth, 1);
        print_message("# sun %g, view %g, %g: %.5f, photons bring %.5f +- %.5f\n", cases[i].sun,
                      cases[i].view, cases[i].azimuth, found, right, error);
        wrong += fabs(found - right) > 3 * error + 0.2 * right;
        free(texels);
    }
    assert_int_equal(wrong, 0);
}

/* Masses of air that the sun shines through, by its height (Kasten and Young 1989). */
static double air_mass(double degrees)
{
    return 1 / (sin(degrees * M_PI / 180) + 0.50572 * pow(degrees + 6.07995, -1.6364));
}

static void the_sun_is_dimmed_by_masses_of_air(void **state)
{
    (void)state;
    /* Pure air and ozone, straight up, for red, green and blue. */
    static const double depths[3] = {5.802e-3 * 8, 13.558e-3 * 8, 33.1e-3 * 8};
    static const double ozone[3]  = {0.650e-3 * 15, 1.881e-3 * 15, 0.085e-3 * 15};
    static const double heights[] = {90, 50, 30, 15, 8};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        const Daylight light = {sin(heights[i] * M_PI / 180), 1, {0, 0, 0}};
        double         part[3];
        daylight_sun(&light, part);
        for (int k = 0; k < 3; k++) {
            double right = exp(-(depths[k] + ozone[k]) * air_mass(heights[i]));
            assert_true(fabs(log(part[k]) / log(right) - 1) < 0.04);
        }
    }
}

/* Haze lets less light through: green is dimmed by the turbidity, and ozone. */
static void turbidity_is_what_it_says(void **state)
{
    (void)state;
    for (double t = 1; t < 8; t += 1.5) {
        const Daylight light = {1, t, {0, 0, 0}};
        double         part[3];
        daylight_sun(&light, part);
        double depth = -log(part[1]) - 0.001881 * 15;
        assert_true(fabs(depth / (0.013558 * 8) - t) < 0.02 * t);
    }
}

/* By day it is blue above; when the sun has set it is red where it was, and dark at night. */
static void skies_have_their_colours(void **state)
{
    (void)state;
    float(*day)[3] = sky_of(0.8, 2.5), (*dusk)[3] = sky_of(-0.03, 2.5),
    (*night)[3] = sky_of(-0.4, 2.5);
    assert_true(texel_at(day, 1.2, 2, 2) > 1.5 * texel_at(day, 1.2, 2, 0));
    assert_true(texel_at(dusk, 0.03, 0, 0) > 2 * texel_at(dusk, 0.03, 0, 2));
    assert_true(texel_at(dusk, 1.2, 0, 1) < 0.05 * texel_at(day, 1.2, 0, 1));
    for (size_t i = 0; i < DAYLIGHT_WIDTH * DAYLIGHT_HEIGHT; i++)
        assert_true(night[i][1] < 1e-5F);
    free(day);
    free(dusk);
    free(night);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sky_is_what_photons_bring),
        cmocka_unit_test(the_sun_is_dimmed_by_masses_of_air),
        cmocka_unit_test(turbidity_is_what_it_says),
        cmocka_unit_test(skies_have_their_colours),
    };
    return cmocka_run_group_tests_name("daylight", tests, NULL, NULL);
}
