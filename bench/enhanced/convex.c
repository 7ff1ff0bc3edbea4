/*
 * convex.c: rays through convex solids, from inside and from behind (see the header).
 */
#include "bench/enhanced/convex.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "bench/fixture.h"
#include "krs/krs.h"

enum { RAYS = 1000, MAX_STEPS = 1000 };

/* Within a ball of this radius are all solids below. */
static const double radius = 1.2;
/* The end of a ray may be as far from the surface as a quarter of a pixel of a solid 300 pixels
   wide; and a twentieth of that of a ray may stay unverified (trace.comp). */
static const double permitted = 0.25 * 2.0 / 300, tolerance = 0.05 * 0.25 * 2.0 / 300;

typedef struct Solid {
    const char *name, *text;
} Solid;
static const Solid solids[] = {
    {"dodecahedron", "show dodecahedron(1);"},
    {"dodecahedron by a generalised distance",
     "let g = 1.618;\n"
     "show convex(planes: [[v, 0.795 * length(v)] for v in [[0, 1, g], [0, 1, -g], [0, -1, g], [0, "
     "-1, -g],"
     " [1, g, 0], [1, -g, 0], [-1, g, 0], [-1, -g, 0], [g, 0, 1], [-g, 0, 1], [g, 0, -1], [-g, 0, "
     "-1]]], exponent: 20);"},
    {"ball", "show sphere(1);"},
    {"ellipsoid", "show ellipsoid([1, 0.6, 0.4]);"},
    {"slab", "show box([1.6, 0.1, 1.6]);"},
};

typedef struct Ray {
    double origin[3], direction[3];
} Ray;

static double distance_at(KrsState *state, const Ray *ray, double t)
{
    double p[1][3];
    KrsHit hit;
    for (int i = 0; i < 3; i++)
        p[0][i] = ray->origin[i] + t * ray->direction[i];
    if (krs_probe(state, (const double(*)[3])p, 1, &hit) != KRS_OK)
        give_up("convex", "a distance cannot be found");
    return hit.distance;
}

/* Numbers from 0 to 1: a linear congruence (Knuth). */
static double random_number(void)
{
    static uint64_t state = 1;
    state                 = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) / 9007199254740992.0;
}

static void random_direction(double v[3])
{
    double square;
    do {
        square = 0;
        for (int i = 0; i < 3; i++) {
            v[i] = 2 * random_number() - 1;
            square += v[i] * v[i];
        }
    } while (square > 1 || square < 1e-6);
    for (int i = 0; i < 3; i++)
        v[i] /= sqrt(square);
}

/* Returns where a ray leaves the ball around all. */
static double exit_of_ball(const Ray *ray)
{
    double along = 0, square = -radius * radius;
    for (int i = 0; i < 3; i++) {
        along += ray->origin[i] * ray->direction[i];
        square += ray->origin[i] * ray->origin[i];
    }
    return -along + sqrt(along * along - square);
}

/* Returns a ray from the ball around all towards a point near the middle. */
static Ray ray_inwards(void)
{
    Ray    ray;
    double target[3], square = 0;
    random_direction(ray.origin);
    random_direction(target);
    for (int i = 0; i < 3; i++) {
        ray.origin[i] *= radius;
        ray.direction[i] = 0.3 * target[i] - ray.origin[i];
        square += ray.direction[i] * ray.direction[i];
    }
    for (int i = 0; i < 3; i++)
        ray.direction[i] /= sqrt(square);
    return ray;
}

/* Returns a ray that has just entered the solid. */
static Ray entering_ray(KrsState *state)
{
    for (;;) {
        Ray    ray = ray_inwards();
        KrsHit hit;
        if (krs_raycast(state, (const double(*)[3])ray.origin, (const double(*)[3])ray.direction, 1,
                        2 * radius, 0, &hit) != KRS_OK)
            give_up("convex", "a ray cannot be followed");
        for (int i = 0; i < 3; i++)
            ray.origin[i] += (hit.t + permitted) * ray.direction[i];
        if (hit.hit && distance_at(state, &ray, 0) < -0.2 * permitted)
            return ray;
    }
}

/* How steps are taken, as by trace.comp: by the distance, by 1.2 of it, or as far as the slope of the
   last steps lets expect that balls meet, or behind a surface that is expected. */
typedef enum Steps { PLAIN, RELAXED, AUTOMATIC } Steps;

static double step_of(Steps steps, double distance, double last_slope, double slope)
{
    const double overshoot = 1.05;
    bool         crosses   = overshoot * distance <= -last_slope * (distance + permitted);
    double       factor    = crosses ? overshoot / -last_slope : 2 / (1 - fmin(slope, 0.98));
    if (steps == AUTOMATIC)
        return fmax(factor, 1) * distance + tolerance;
    return (steps == PLAIN ? 1 : 1.2) * distance + tolerance;
}

/* Marches from `t` towards `sign` to where the distance, positive there, has changed its sign.  `side`
   is -1 inside.  Where balls do not meet, a shorter step is tried.  Counts distances. */
static double march(KrsState *state, const Ray *ray, double t, double sign, double side,
                    Steps steps, int *evaluations)
{
    double last = 0, step = 0, slope = -1 / 0.7;
    for (int i = 0; i < MAX_STEPS; i++) {
        double distance   = side * distance_at(state, ray, t + sign * step);
        double unverified = step - last;
        ++*evaluations;
        if (distance <= 0 && unverified <= permitted + tolerance)
            return t + sign * (distance < last ? step * last / (last - distance) : step);
        if (unverified > fmax(distance, 0) + 1.01 * tolerance) {
            step  = fmax(0.4 * (step + last - fmax(distance, 0)), last + tolerance);
            slope = -1;
            continue;
        }
        double last_slope = step > 0 ? (distance - last) / step : 0;
        t += sign * step;
        slope = 0.7 * slope + 0.3 * last_slope;
        step  = step_of(steps, distance, last_slope, slope);
        last  = distance;
    }
    return t;
}

typedef struct Counts {
    int evaluations
        [5];         /* from inside by the three kinds of steps; from behind, plain and automatic */
    double farthest; /* of what is found from behind, from what is found inside */
} Counts;

static Counts count(KrsState *state)
{
    Counts counts = {0};
    for (int i = 0; i < RAYS; i++) {
        const Ray    ray    = entering_ray(state);
        const double exit   = exit_of_ball(&ray);
        const double inside = march(state, &ray, 0, 1, -1, PLAIN, &counts.evaluations[0]);
        march(state, &ray, 0, 1, -1, RELAXED, &counts.evaluations[1]);
        march(state, &ray, 0, 1, -1, AUTOMATIC, &counts.evaluations[2]);
        const double behind = march(state, &ray, exit, -1, 1, PLAIN, &counts.evaluations[3]);
        march(state, &ray, exit, -1, 1, AUTOMATIC, &counts.evaluations[4]);
        counts.farthest = fmax(counts.farthest, fabs(behind - inside));
    }
    return counts;
}

void compare_convex(const Sheet *sheet)
{
    sheet_print(
        sheet,
        "| convex solid, distances of a ray | through the inside: plain | relaxed | automatic | "
        "from the exit back: plain | automatic | farthest apart |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        KrsScene *scene;
        KrsState *state;
        if (krs_compile_text(solids[i].text, strlen(solids[i].text), solids[i].name, NULL,
                             &scene) != KRS_OK ||
            krs_state_new(scene, &state) != KRS_OK)
            give_up(solids[i].name, "it does not compile");
        const Counts counts = count(state);
        sheet_print(sheet, "| %s ", solids[i].name);
        for (int k = 0; k < 5; k++)
            sheet_print(sheet, "| %.1f ", counts.evaluations[k] / (double)RAYS);
        sheet_print(sheet, "| %.4f |\n", counts.farthest);
        krs_state_free(state);
        krs_scene_free(scene);
    }
}
