/*
 * sides.c: normals next to edges and where solids touch are those of one side.
 *
 * Boxes, balls, drums and cones stand on a floor and on each other, overlap, and lean on walls.
 * The normal of every pixel must be that of a side that passes within a pixel of where it hits,
 * by the definitions of the solids, to a degree: never something in between.
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
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

enum { WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT };
#define MAX_OFF   1.0  /* degrees */
#define MAX_WRONG 4e-4 /* of the pixels: an edge may be nearer than single precision shows */

/* ---- Solids, and the sides that they have ---- */

typedef enum SolidKind { FLOOR, BOX, BALL, DRUM, CONE } SolidKind;

typedef struct Solid {
    SolidKind kind;
    Vec       centre, axis; /* turned about the axis, then moved */
    double    angle;
    Vec       size; /* edges; radius; radius and height */
} Solid;

enum { MAX_SOLIDS = 40 };
typedef struct Scene {
    const char *name;
    bool        united; /* in one component */
    Vec         eye, target;
    double      fov;
    Solid       solids[MAX_SOLIDS];
    int         count;
} Scene;

/* How far a point is from a side, and its normal there. */
typedef struct Side {
    double distance;
    Vec    normal;
} Side;

enum { MAX_SIDES = 6 };

static int sides_of_box(Vec p, Vec size, Side *sides)
{
    const double at[3] = {p.x, p.y, p.z}, half[3] = {size.x / 2, size.y / 2, size.z / 2};
    for (int i = 0; i < 6; i++) {
        double sign       = i % 2 ? 1 : -1;
        sides[i].distance = sign * at[i / 2] - half[i / 2];
        sides[i].normal = vec(i / 2 == 0 ? sign : 0, i / 2 == 1 ? sign : 0, i / 2 == 2 ? sign : 0);
    }
    return 6;
}

/* In the space in which the solid is not turned. */
static int sides_of(const Solid *solid, Vec p, Side *sides)
{
    double radius = solid->size.x, half = solid->size.y / 2, distance = hypot(p.x, p.z);
    Vec    out = vec(p.x / distance, 0, p.z / distance);
    switch (solid->kind) {
    case FLOOR: sides[0] = (Side){p.y, vec(0, 1, 0)}; return 1;
    case BOX: return sides_of_box(p, solid->size, sides);
    case BALL: sides[0] = (Side){vec_length(p) - radius, vec_unit(p)}; return 1;
    case DRUM:
        sides[0] = (Side){distance - radius, out};
        sides[1] = (Side){p.y - half, vec(0, 1, 0)};
        sides[2] = (Side){-p.y - half, vec(0, -1, 0)};
        return 3;
    default: {
        Vec slope = vec_unit(vec(2 * half * out.x, radius, 2 * half * out.z));
        sides[0]  = (Side){vec_dot(slope, vec_sub(p, vec(0, half, 0))), slope};
        sides[1]  = (Side){-p.y - half, vec(0, -1, 0)};
        return 2;
    }
    }
}

/* Degrees between a normal and that of the side it is most like, of those near a point. */
static double find_off(const Scene *scene, Vec point, Vec normal, double near)
{
    double least = 180;
    for (int i = 0; i < scene->count; i++) {
        const Solid *solid = &scene->solids[i];
        Side         sides[MAX_SIDES];
        Vec          p     = vec_rotate(vec_sub(point, solid->centre), solid->axis, -solid->angle);
        int          count = sides_of(solid, p, sides);
        double       outside = -HUGE_VAL;
        for (int k = 0; k < count; k++)
            outside = fmax(outside, sides[k].distance);
        for (int k = 0; k < count && outside < near; k++) {
            Vec    facing = vec_rotate(sides[k].normal, solid->axis, solid->angle);
            double angle  = atan2(vec_length(vec_cross(facing, normal)), vec_dot(facing, normal));
            if (sides[k].distance > -near)
                least = fmin(least, angle * 180 / M_PI);
        }
    }
    return least;
}

/* ---- Scenes ---- */

#define UPRIGHT .axis = {0, 1, 0}

static Scene scenes[] = {
    {"a wall on a floor",
     false,
     {3, 5, 9},
     {0, 0.6, 1.5},
     36,
     {{FLOOR, UPRIGHT}, {BOX, {0, 1.5, 0}, UPRIGHT, 0, {6, 3, 0.3}}},
     2},
    {"solids on a floor",
     false,
     {1, 3.5, 6},
     {0, 0.6, 0},
     40,
     {{FLOOR, UPRIGHT},
      {BOX, {-1.2, 0.5, 0}, UPRIGHT, 0.4, {1, 1, 1}},
      {BALL, {0.2, 0.5, 0.6}, UPRIGHT, 0, {0.5, 0, 0}},
      {DRUM, {1.2, 0.6, 0}, UPRIGHT, 0, {0.4, 1.2, 0}},
      {CONE, {0.3, 0.6, -1}, UPRIGHT, 0, {0.6, 1.2, 0}},
      {BOX, {-1.2, 1.15, 0}, UPRIGHT, 1, {0.5, 0.3, 0.7}}},
     6},
    {"the same, united",
     true,
     {-2, 2.5, 6},
     {0, 0.6, 0},
     40,
     {{FLOOR, UPRIGHT},
      {BOX, {-1.2, 0.5, 0}, UPRIGHT, 0.4, {1, 1, 1}},
      {BALL, {0.2, 0.5, 0.6}, UPRIGHT, 0, {0.5, 0, 0}},
      {DRUM, {1.2, 0.6, 0}, UPRIGHT, 0, {0.4, 1.2, 0}},
      {CONE, {0.3, 0.6, -1}, UPRIGHT, 0, {0.6, 1.2, 0}},
      {BOX, {-1.2, 1.15, 0}, UPRIGHT, 1, {0.5, 0.3, 0.7}}},
     6},
    {"solids that overlap",
     false,
     {2, 3, 5},
     {0, 0.5, 0},
     40,
     {{FLOOR, UPRIGHT},
      {BOX, {0, 0.4, 0}, {1, 2, 3}, 0.7, {1.4, 1.2, 1}},
      {BALL, {0.6, 0.8, 0.3}, UPRIGHT, 0, {0.6, 0, 0}},
      {DRUM, {-0.6, 0.3, 0.5}, {3, 1, 1}, 0.9, {0.3, 1.8, 0}},
      {BOX, {-0.5, 0.5, -0.6}, {2, 1, 0}, 1.3, {0.4, 2, 0.8}}},
     5},
    {"steps and crates",
     true,
     {-3, 3, 5},
     {0, 0.6, 0},
     40,
     {{FLOOR, UPRIGHT},
      {BOX, {0, 0.15, 0}, UPRIGHT, 0.3, {3, 0.3, 2}},
      {BOX, {0, 0.45, 0}, UPRIGHT, 0.3, {2.2, 0.3, 1.4}},
      {BOX, {0, 0.75, 0}, UPRIGHT, 0.3, {1.4, 0.3, 0.8}},
      {BOX, {0, 1.2, 0}, UPRIGHT, 0.9, {0.6, 0.6, 0.6}},
      {BOX, {1.8, 0.3, 1}, UPRIGHT, 0.7, {0.6, 0.6, 0.6}}},
     6},
};
enum { SCENES = sizeof scenes / sizeof *scenes };

static void write_solid(SceneText *text, const Solid *s, const char *before, const char *after)
{
    Vec a = s->axis, c = s->centre;
    scene_write(text, "%s", before);
    switch (s->kind) {
    case FLOOR: scene_write(text, "plane([0, 1, 0], 0)"); break;
    case BOX: scene_write(text, "box([%g, %g, %g])", s->size.x, s->size.y, s->size.z); break;
    case BALL: scene_write(text, "sphere(%g)", s->size.x); break;
    case DRUM: scene_write(text, "cylinder(%g, %g)", s->size.x, s->size.y); break;
    case CONE: scene_write(text, "cone(%g, %g)", s->size.x, s->size.y); break;
    }
    scene_write(text, ".rotate([%g, %g, %g], %.17g).move([%g, %g, %g])%s\n", a.x, a.y, a.z,
                s->angle, c.x, c.y, c.z, after);
}

static KrsPicture *picture_of_scene(const Scene *scene, uint32_t samples)
{
    static SceneText text;
    Vec              e = scene->eye, t = scene->target;
    text.length = 0;
    scene_write(&text, "camera { eye: [%g, %g, %g], target: [%g, %g, %g], fov: %gdeg }\n", e.x, e.y,
                e.z, t.x, t.y, t.z, scene->fov);
    scene_write(&text, scene->united ? "show union([\n" : "");
    for (int i = 0; i < scene->count; i++)
        write_solid(&text, &scene->solids[i], scene->united ? "" : "show ",
                    scene->united ? "," : ";");
    if (scene->united)
        text.length -= 2;
    scene_write(&text, scene->united ? "]);\n" : "");
    return picture_of(text.bytes,
                      &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .samples = samples});
}

/* ---- Tests ---- */

static Lens lens_of(const Scene *scene)
{
    return lens_make(scene->eye, scene->target, tan(scene->fov * M_PI / 360), false, WIDTH, HEIGHT);
}

/* Pixels whose normal is that of no side nearby. */
static size_t count_wrong(const Scene *scene, const KrsPicture *picture)
{
    Lens   lens  = lens_of(scene);
    size_t wrong = 0;
    double worst = 0;
    for (int k = 0; k < PIXELS; k++) {
        const float *p = &picture->position[3 * k], *n = &picture->normal[3 * k];
        Vec          point  = vec((double)p[0], (double)p[1], (double)p[2]);
        Vec          normal = vec((double)n[0], (double)n[1], (double)n[2]);
        if (picture->component[k] == 0)
            continue;
        double pixel = lens_pixel(&lens, vec_dot(vec_sub(point, lens.eye), lens.forward));
        double off   = find_off(scene, point, normal, pixel);
        wrong += off > MAX_OFF;
        worst = fmax(worst, off);
    }
    print_message("# %s: %zu pixels wrong, the worst by %.1f degrees\n", scene->name, wrong, worst);
    return wrong;
}

static void normals_are_those_of_one_side(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < SCENES; i++)
        for (uint32_t samples = 1; samples <= 4; samples += 3) {
            KrsPicture *picture = picture_of_scene(&scenes[i], samples);
            size_t      here    = count_wrong(&scenes[i], picture);
            wrong += here > MAX_WRONG * PIXELS;
            krs_picture_free(picture);
        }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_are_those_of_one_side),
    };
    return cmocka_run_group_tests_name("sides", tests, renderer_open, renderer_close);
}
