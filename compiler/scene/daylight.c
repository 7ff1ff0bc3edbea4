/*
 * daylight.c: light that air, haze and the ground scatter.
 *
 * Air scatters as Rayleigh found, haze as Henyey and Greenstein write it, and ozone absorbs.  Light
 * that is scattered once is summed up along each ray.  For light that is scattered more often the
 * air around a point is taken to be alike: then each further scattering is the same part of the one
 * before, and all together are a geometric series (Hillaire, A Scalable and Production Ready Sky and
 * Atmosphere Rendering Technique, 2020).  Haze scatters most light nearly
 * straight ahead.  This light is not taken to be lost, but what is scattered once has its exact angle
 * (Nakajima and Tanaka 1988).  Numbers of the air are those of Bruneton and Neyret 2008.
 * Lengths are in kilometres.
 */
#include "compiler/scene/daylight.h"

#include <math.h>
#include <stdlib.h>

#include "compiler/base/elementary.h"

#define GROUND     6360.0 /* radius of the earth, */
#define TOP        6460.0 /* and of the air around it */
#define EYE        0.002  /* height */
#define AIR_FALL   8.0    /* heights in which densities fall to 1 / e */
#define HAZE_FALL  1.2
#define OZONE_MID  25.0 /* its density falls linearly on both sides of this height */
#define OZONE_HALF 15.0
#define FORWARD    0.8                 /* mean cosine of what haze scatters */
#define AHEAD      (FORWARD * FORWARD) /* the part that it scatters so far ahead that it is not lost */
#define SUN_RADIUS 0.00465             /* radians */

/* The parts of red, green and blue that are lost on a kilometre: to air at the ground, and to ozone
   where it is densest.  That of haze is in parts of that of green. */
static const double air[3]         = {5.802e-3, 13.558e-3, 33.1e-3};
static const double ozone[3]       = {0.650e-3, 1.881e-3, 0.085e-3};
static const double haze[3]        = {0.759, 1, 1.337}; /* wavelength to the power of -1.3 */
static const double haze_scattered = 0.9;               /* the rest is absorbed */

/* The sizes of two tables: the part of the sun's light that reaches a height, by the direction; and
   what reaches a point from all around that was scattered twice or more often, by its height and
   the sun's. */
enum { HEIGHTS = 32, DIRECTIONS = 128, AROUND_HEIGHTS = 16, AROUND_SUNS = 32 };
enum { STEPS_OF_SUN = 64, STEPS_OF_VIEW = 40, STEPS_AROUND = 20, RAYS_AROUND = 64 };
typedef struct Air {
    const Daylight *light;
    double          haze_density; /* green light lost to haze on a kilometre */
    double          sun[HEIGHTS][DIRECTIONS][3];
    double          around[AROUND_HEIGHTS][AROUND_SUNS][3];
} Air;

/* ---- What the air is at a height ---- */

typedef struct Medium {
    double by_air[3], by_haze[3], lost[3]; /* scattered, and lost, on a kilometre */
} Medium;

static Medium medium_at(const Air *a, double radius)
{
    const double height = fmax(radius - GROUND, 0);
    const double thin   = real_exp(-height / AIR_FALL),
                 hazy   = a->haze_density * real_exp(-height / HAZE_FALL);
    const double high   = fmax(1 - fabs(height - OZONE_MID) / OZONE_HALF, 0);
    Medium       m;
    for (int k = 0; k < 3; k++) {
        m.by_air[k]  = air[k] * thin;
        m.by_haze[k] = haze_scattered * haze[k] * hazy;
        m.lost[k]    = m.by_air[k] + haze[k] * hazy + ozone[k] * high;
    }
    return m;
}

/* Returns the length of a ray up to the top of the air, by the cosine of its angle from the
   vertical. */
static double length_to_top(double radius, double cosine)
{
    return -radius * cosine + sqrt(fmax(radius * radius * (cosine * cosine - 1) + TOP * TOP, 0));
}

/* Returns the length up to the ground; negative: the ray does not meet it. */
static double length_to_ground(double radius, double cosine)
{
    const double square = radius * radius * (cosine * cosine - 1) + GROUND * GROUND;
    return cosine < 0 && square >= 0 ? fmax(-radius * cosine - sqrt(square), 0) : -1;
}

/* Returns the cosine of the horizon's angle from the vertical. */
static double horizon_at(double radius)
{
    const double sine = fmin(GROUND / radius, 1);
    return -sqrt(1 - sine * sine);
}

/* The place of a ray after a length: its radius, and the cosine to a direction that is given by its
   cosines to the vertical and to the ray. */
typedef struct Place {
    double radius, cosine;
} Place;

static Place place_after(double radius, double cosine, double to_vertical, double to_ray, double t)
{
    const double there = sqrt(fmax(radius * radius + t * t + 2 * radius * cosine * t, 1));
    return (Place){fmax(there, GROUND), (radius * to_vertical + t * to_ray) / there};
}

/* A step along a ray; they are the shorter the nearer they are. */
typedef struct Step {
    double middle, length;
} Step;

static Step step_of(double length, int i, int steps)
{
    const double from = (double)i / steps, to = (i + 1.0) / steps;
    return (Step){0.5 * length * (to * to + from * from), length * (to * to - from * from)};
}

/* ---- The sun ---- */

static void lose_light(const Air *a, double radius, double cosine, double ahead, double part[3])
{
    const double length  = length_to_top(radius, cosine);
    double       lost[3] = {0};
    for (int i = 0; i < STEPS_OF_SUN; i++) {
        const Step   s  = step_of(length, i, STEPS_OF_SUN);
        const Place  at = place_after(radius, cosine, cosine, 1, s.middle);
        const Medium m  = medium_at(a, at.radius);
        for (int k = 0; k < 3; k++)
            lost[k] += (m.lost[k] - ahead * m.by_haze[k]) * s.length;
    }
    for (int k = 0; k < 3; k++)
        part[k] = real_exp(-lost[k]);
}

/* Fills the table of the sun, whose rows and columns are even in the lengths along the ground's
   tangent, and along the ray. */
static void fill_sun(Air *a)
{
    const double highest = sqrt(TOP * TOP - GROUND * GROUND);
    for (int i = 0; i < HEIGHTS; i++)
        for (int k = 0; k < DIRECTIONS; k++) {
            const double tangent = highest * i / (HEIGHTS - 1);
            const double radius  = sqrt(tangent * tangent + GROUND * GROUND);
            const double least = TOP - radius, most = tangent + highest;
            const double length = least + (most - least) * k / (DIRECTIONS - 1);
            const double cosine = length > 0
                                      ? (highest * highest - tangent * tangent - length * length) /
                                            (2 * radius * length)
                                      : 1;
            lose_light(a, radius, fmin(fmax(cosine, -1), 1), AHEAD, a->sun[i][k]);
        }
}

/* Interpolates between four numbers of a table; x and y in rows and columns. */
static void mix_table(const double *table, int rows, int columns, double y, double x, double to[3])
{
    const double low  = fmin(fmax(floor(y), 0), rows - 2),
                 left = fmin(fmax(floor(x), 0), columns - 2);
    const double  b = fmin(fmax(y - low, 0), 1), c = fmin(fmax(x - left, 0), 1);
    const double *first = table + 3 * ((size_t)low * (size_t)columns + (size_t)left);
    const double *next  = first + 3 * (size_t)columns;
    for (int k = 0; k < 3; k++)
        to[k] = (1 - b) * ((1 - c) * first[k] + c * first[3 + k]) +
                b * ((1 - c) * next[k] + c * next[3 + k]);
}

/* Returns the part of the sun's disc that is above the horizon, which hides it bit by bit. */
static double part_of_disc(Place at)
{
    return fmin(fmax(0.5 + 0.5 * (at.cosine - horizon_at(at.radius)) / SUN_RADIUS, 0), 1);
}

/* Finds the part of the sun's light that reaches a place, by the cosine of the sun's angle from the
   vertical. */
static void find_sun(const Air *a, Place at, double part[3])
{
    const double highest = sqrt(TOP * TOP - GROUND * GROUND), horizon = horizon_at(at.radius);
    const double tangent = sqrt(fmax(at.radius * at.radius - GROUND * GROUND, 0));
    const double seen    = part_of_disc(at);
    const double length  = length_to_top(at.radius, fmax(at.cosine, horizon));
    const double least = TOP - at.radius, most = tangent + highest;
    mix_table(&a->sun[0][0][0], HEIGHTS, DIRECTIONS, tangent / highest * (HEIGHTS - 1),
              (length - least) / (most - least) * (DIRECTIONS - 1), part);
    for (int k = 0; k < 3; k++)
        part[k] *= seen;
}

/* ---- Light along a ray ---- */

/* A ray, and where the sun is. */
typedef struct View {
    double radius, cosine;      /* where it begins, and its direction from the vertical */
    double sun_cosine, between; /* of the sun from the vertical, and from the ray */
    int    steps;
    bool   alike; /* all directions are scattered alike, and that once */
} View;

typedef struct Gathered {
    double light[3], part[3]; /* of the light, and how much is left of what is behind */
    double scattered[3];      /* of an even light of 1 from all sides */
} Gathered;

static double phase_of_air(double cosine) { return 3 / (16 * M_PI) * (1 + cosine * cosine); }

static double phase_of_haze(double cosine)
{
    const double g = FORWARD, d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * M_PI * d * sqrt(d));
}

static void find_around(const Air *a, Place at, double light[3])
{
    const double y = sqrt((at.radius - GROUND) / (TOP - GROUND)) * (AROUND_HEIGHTS - 1);
    const double x = (0.5 + 0.5 * at.cosine) * (AROUND_SUNS - 1);
    mix_table(&a->around[0][0][0], AROUND_HEIGHTS, AROUND_SUNS, y, x, light);
}

/* Adds what is scattered on a step, which absorbs some of it already. */
static void add_step(const Air *a, const View *v, Place at, double step, Gathered *g)
{
    const Medium m       = medium_at(a, at.radius);
    double       by_air  = phase_of_air(v->between);
    double       by_haze = phase_of_haze(v->between);
    double       sun[3], around[3] = {0};
    find_sun(a, at, sun);
    if (!v->alike)
        find_around(a, at, around);
    for (int k = 0; k < 3; k++) {
        const double all  = m.by_air[k] + (1 - FORWARD) * m.by_haze[k];
        const double lost = m.lost[k] - (v->alike ? FORWARD : AHEAD) * m.by_haze[k];
        const double left = real_exp(-lost * step), along = lost > 1e-12 ? (1 - left) / lost : step;
        const double once  = v->alike ? all : m.by_air[k] * by_air + m.by_haze[k] * by_haze;
        const double sends = once * (v->alike ? 1 / (4 * M_PI) : 1) * sun[k] + all * around[k];
        g->light[k] += g->part[k] * sends * along;
        g->scattered[k] += g->part[k] * all * along;
        g->part[k] *= left;
    }
}

static Gathered gather(const Air *a, const View *v)
{
    const double ground = length_to_ground(v->radius, v->cosine);
    const double length = ground >= 0 ? ground : length_to_top(v->radius, v->cosine);
    Gathered     g      = {.part = {1, 1, 1}};
    for (int i = 0; i < v->steps; i++) {
        const Step s = step_of(length, i, v->steps);
        add_step(a, v, place_after(v->radius, v->cosine, v->sun_cosine, v->between, s.middle),
                 s.length, &g);
    }
    if (ground >= 0) {
        const Place at = place_after(v->radius, v->cosine, v->sun_cosine, v->between, ground);
        double      sun[3];
        find_sun(a, at, sun);
        for (int k = 0; k < 3; k++)
            g.light[k] += g.part[k] * sun[k] * fmax(at.cosine, 0) * a->light->ground[k] / M_PI;
    }
    return g;
}

/* ---- Light that is scattered often ---- */

/* Sums the series of all further scatterings at a height, for a height of the sun; rays are even
   over the sphere (a spiral of Fibonacci). */
static void sum_series(const Air *a, double radius, double sun_cosine, double light[3])
{
    double second[3] = {0}, again[3] = {0};
    for (int i = 0; i < RAYS_AROUND; i++) {
        const double cosine = 1 - (2 * i + 1.0) / RAYS_AROUND, angle = 2.399963229728653 * i;
        const double level     = sqrt(1 - cosine * cosine),
                     sun_level = sqrt(1 - sun_cosine * sun_cosine);
        const double between   = cosine * sun_cosine + level * sun_level * real_cos(angle);
        const View   view      = {radius, cosine, sun_cosine, between, STEPS_AROUND, true};
        Gathered     g         = gather(a, &view);
        for (int k = 0; k < 3; k++) {
            second[k] += g.light[k] / RAYS_AROUND;
            again[k] += g.scattered[k] / RAYS_AROUND;
        }
    }
    for (int k = 0; k < 3; k++)
        light[k] = second[k] / (1 - fmin(again[k], 0.99));
}

static void fill_around(Air *a)
{
    for (int i = 0; i < AROUND_HEIGHTS; i++)
        for (int k = 0; k < AROUND_SUNS; k++) {
            const double part = (double)i / (AROUND_HEIGHTS - 1);
            sum_series(a, GROUND + (TOP - GROUND) * part * part, 2.0 * k / (AROUND_SUNS - 1) - 1,
                       a->around[i][k]);
        }
}

/* ---- The sky ---- */

/* Returns the density of haze; turbidity is of green light, straight up. */
static double density_of_haze(const Daylight *light)
{
    return (fmax(light->turbidity, 1) - 1) * air[1] * AIR_FALL / HAZE_FALL;
}

void daylight_sun(const Daylight *light, double part[3])
{
    const Air   a  = {.light = light, .haze_density = density_of_haze(light)};
    const Place at = {GROUND + EYE, light->rise};
    lose_light(&a, at.radius, fmax(at.cosine, horizon_at(at.radius)), 0, part);
    for (int k = 0; k < 3; k++)
        part[k] *= part_of_disc(at);
}

static void find_row(const Air *a, int row, float (*texels)[3])
{
    const double height = M_PI * (0.5 - (row + 0.5) / DAYLIGHT_HEIGHT), rise = a->light->rise;
    const double level = sqrt(fmax(1 - rise * rise, 0));
    for (int i = 0; i < DAYLIGHT_WIDTH / 2; i++) {
        const double angle   = 2 * M_PI * (i + 0.5) / DAYLIGHT_WIDTH;
        const double between = real_sin(height) * rise + real_cos(height) * level * real_cos(angle);
        const View   view = {GROUND + EYE, real_sin(height), rise, between, STEPS_OF_VIEW, false};
        const Gathered g  = gather(a, &view);
        for (int k = 0; k < 3; k++)
            texels[DAYLIGHT_WIDTH / 2 + i][k] = texels[DAYLIGHT_WIDTH / 2 - 1 - i][k] =
                (float)g.light[k];
    }
}

/* Fills the ground below the horizon, which the sun and the sky light. */
static void fill_ground(const Air *a, float (*texels)[3])
{
    const int horizon = DAYLIGHT_HEIGHT / 2;
    double    lit[3], sun[3];
    daylight_sun(a->light, sun);
    for (int k = 0; k < 3; k++)
        lit[k] = sun[k] * fmax(a->light->rise, 0);
    for (int row = 0; row < horizon; row++) {
        const double from = M_PI * row / DAYLIGHT_HEIGHT, to = M_PI * (row + 1) / DAYLIGHT_HEIGHT;
        const double share = M_PI *
                             (real_cos(from) * real_cos(from) - real_cos(to) * real_cos(to)) /
                             DAYLIGHT_WIDTH;
        for (int i = 0; i < DAYLIGHT_WIDTH; i++)
            for (int k = 0; k < 3; k++)
                lit[k] += share * (double)texels[row * DAYLIGHT_WIDTH + i][k];
    }
    for (int i = horizon * DAYLIGHT_WIDTH; i < DAYLIGHT_HEIGHT * DAYLIGHT_WIDTH; i++)
        for (int k = 0; k < 3; k++)
            texels[i][k] = (float)(lit[k] * a->light->ground[k] / M_PI);
}

bool daylight_sky(const Daylight *light, float (*texels)[3])
{
    Air *a = calloc(1, sizeof *a);
    if (!a)
        return false;
    a->light        = light;
    a->haze_density = density_of_haze(light);
    fill_sun(a);
    fill_around(a);
    for (int row = 0; row < DAYLIGHT_HEIGHT / 2; row++)
        find_row(a, row, texels + row * DAYLIGHT_WIDTH);
    fill_ground(a, texels);
    free(a);
    return true;
}
