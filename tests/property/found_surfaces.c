/*
 * found_surfaces.c: surfaces that lanes of the host find for pictures are those of the scene's tape, which is run in double
 * precision at one point after the other: each number of them.
 *
 * Points are in patches of all sizes.  What is near an edge of a pattern may be on its other side by rounding.  A
 * scene that has another value of a property must be seen to differ.
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

#include "compiler/scene/program.h"
#include "rays/surfaces.h"
#include "tests/support/random.h"

enum { PATCHES = 60, POINTS = 400, SHAPES = 40 };

static Random chance = {39};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

static const char *const scenes[] = {
    /* Components, patterns, bumps, and what sees the normal. */
    "use \"std/patterns.krs\";"
    "material tiles { color: mix(#2c3a36, #efe9dd, checker([x, z] / 0.5)), roughness: 0.8 }"
    "material wall { color: mix(#9a9284, #7d3322, brick([x + z, y])), bump: 0.02 * soft_noise(5 * "
    "p) }"
    "material side { color: 0.5 + 0.5 * normal, emission: [2, x, 0] }"
    "show plane([0, 1, 0], -1).paint(tiles); show box([1, 2, 0.4]).move([1, 0, -1]).paint(wall);"
    "show union(sphere(0.7).paint(side), box([1, 1, 1]).move([0.9, 0.1, 0]).paint(#2040ff), blend: "
    "0.3);",
    /* Zones. */
    "show sphere(1).smooth_mirrors(0.1).paint(#ff2000); show box([3, 0.2, 3]).paint(#0020ff);"
    "zone { center: [0.5, 0.5, 0], radius: 0.8 }",
    /* Levels and instances. */
    "show krs { kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.1); for i in 0..6 { mobius "
    "translate([0, 0.4, 0]) * rotate([0, 1, 0], -70deg) * rotate([1, 0, 0], 28deg) * scale(0.8); "
    "reflect plane([1, 0, 0], 0); kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.1); } }"
    ".paint(mix(#804020, #20ff40, 0.1 * level + 0.3 * instance));",
    /* Numbers of copies of 32 bits: of copies within copies, and behind more than 31 mirrors. */
    "let twig = krs { kernel capsule([0, 0, 0], [0, 0.3, 0], radius: 0.1);"
    "for i in 0..4 { reflect plane([1, 0, 0.3 * i], -0.1); } };"
    "show krs { kernel twig.move([0.8, 0.2, 0.3]); for i in 0..3 { reflect plane([0.2 * i, 0.1, "
    "1], 0); } }"
    ".paint(mix(#804020, #20ff40, instance));",
    "show krs { kernel sphere(0.3).move([0.4, 0.9, 0]);"
    "for i in 0..36 { reflect plane([cos(40deg * i), sin(40deg * i), 0.1 * sin(i)], -0.02); } }"
    ".paint(mix(#804020, #20ff40, instance));",
    /* Instance groups. */
    "show union([box([0.2, 0.3 + 0.1 * i, 0.2]).rotate([0, 1, 0], i * 20deg).move([0.4 * i - 2, 0, "
    "0])"
    ".paint(mix(red, blue, i / 9)) for i in 0..10]);",
    /* The side from which it is seen. */
    "material both { color: if front then red else blue, roughness: 0.3 + 0.1 * x }"
    "show sphere(1).paint(both);",
};

/* Each property has a value of its own. */
static const char properties[] =
    "material all { color: [0.1, 0.2, 0.3], roughness: 0.4, metallic: 0.5, emission: [6, 7, 8], "
    "specular: 0.9,"
    " ior: 1.6, coat: 0.11, coat_roughness: 0.12, sheen: [0.13, 0.14, 0.15], sheen_roughness: 0.16,"
    " thin_film_weight: 0.17, thin_film_thickness: 0.18, thin_film_ior: 1.19,"
    " specular_roughness_anisotropy: 0.2, tangent: [0, 0.6, 0.8], subsurface_weight: 0.21,"
    " subsurface_color: [0.22, 0.23, 0.24], subsurface_radius: [25, 26, 27] }"
    "show sphere(1).paint(all);";

/* ---- random scenes ---- */

static void random_scene(char *text, size_t room)
{
    size_t at = (size_t)snprintf(text, room, "show plane([0, 1, 0], -1.5); show union([");
    for (int i = 0; i < SHAPES; i++)
        at += (size_t)snprintf(text + at, room - at,
                               "%s%s.rotate([%.3f, 1, %.3f], %.1fdeg).move([%.3f, %.3f, "
                               "%.3f]).paint([%.3f, %.3f, %.3f])",
                               i ? ", " : "", i % 2 ? "box([0.3, 0.5, 0.2])" : "torus(0.3, 0.1)",
                               uniform(-1, 1), uniform(-1, 1), uniform(0, 360), uniform(-1.5, 1.5),
                               uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(0, 1), uniform(0, 1),
                               uniform(0, 1));
    snprintf(text + at, room - at, "]%s);", random_below(&chance, 2) ? ", blend: 0.05" : "");
}

/* ---- the truth ---- */

/* At a point, from the values of the tape. */
static FoundSurface true_surface(KrsState *state, const SurfacePoint *point)
{
    const KrsScene *scene   = state->scene;
    const Node      zone    = zone_root(scene);
    FoundSurface    surface = {0};
    size_t          nearest = 0;
    double          at[3], normal[3], view[3];
    for (int k = 0; k < 3; k++) {
        at[k]     = (double)point->position[k];
        normal[k] = (double)point->normal[k];
        view[k]   = (double)point->view[k];
    }
    if (point->footprint > 0)
        tape_run_surface(&state->tapes.surface, at, normal, (double)point->footprint,
                         state->values);
    else
        tape_run_seen(&state->tapes.surface, at, normal, view, state->values);
    for (size_t i = 1; i < scene->component_count; i++)
        if (state->values[distance_root(&scene->roots, i)].v[0] <
            state->values[distance_root(&scene->roots, nearest)].v[0])
            nearest = i;
    const Node *root = surface_roots(&scene->roots, nearest);
#define FLOAT(name) surface.name = (float)state->values[root[ROOT_##name]].v[0];
#define VEC3(name)              \
    for (int k = 0; k < 3; k++) \
        surface.name[k] = (float)state->values[root[ROOT_##name]].v[k];
#define UINT(name)                                                             surface.name = (uint32_t)state->values[root[ROOT_##name]].v[0];
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) type(name)
#include "krs/surface.def"
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) shown(name)
#include "krs/surface.def"
    surface.distance = (float)state->values[root[ROOT_DISTANCE]].v[0];
    for (int k = 0; k < 3; k++)
        surface.normal[k] = (float)state->values[root[ROOT_NORMAL]].v[k];
    if (zone != NODE_NONE && (float)state->values[zone].v[0] > surface.distance) {
        surface.distance = (float)state->values[zone].v[0];
        memcpy(surface.normal, point->normal, sizeof surface.normal);
    }
    return surface;
}

/* ---- comparison ---- */

typedef struct Count {
    size_t points, other;
} Count;

static bool differs(const float *a, const float *b, size_t numbers)
{
    enum { FIRST_IDENTITY = 4, FIRST_MATERIAL = offsetof(FoundSurface, color) / sizeof(float) };
    bool any = memcmp(a + FIRST_IDENTITY, b + FIRST_IDENTITY,
                      (FIRST_MATERIAL - FIRST_IDENTITY) * sizeof *a) != 0;
    for (size_t i = 0; i < numbers; i++)
        any = any || ((i < FIRST_IDENTITY || i >= FIRST_MATERIAL) &&
                      !(fabsf(a[i] - b[i]) <= 2e-3f * (1 + fabsf(b[i]))));
    return any;
}

static void unit_vector(float to[3])
{
    double v[3], square;
    do {
        random_vector(&chance, 1, v);
        square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    } while (square < 0.01 || square > 1);
    for (int k = 0; k < 3; k++)
        to[k] = (float)(v[k] / sqrt(square));
}

/* Seen head on by a pixel, or by none from either side. */
static void random_patch(SurfacePoint *points, FoundSurface *found)
{
    const double size = 2 * exp(uniform(-6, 0));
    double       middle[3], offset[3];
    random_vector(&chance, 1.5, middle);
    for (int i = 0; i < POINTS; i++) {
        const bool pixel = random_below(&chance, 2) == 0;
        random_vector(&chance, size, offset);
        unit_vector(points[i].normal);
        unit_vector(points[i].view);
        for (int k = 0; k < 3; k++) {
            points[i].position[k] = (float)(middle[k] + offset[k]);
            points[i].view[k]     = pixel ? -points[i].normal[k] : points[i].view[k];
        }
        points[i].footprint = pixel ? (float)uniform(0.001, 0.1) : 0;
        points[i].found     = (float *)&found[i];
    }
}

/* Surfaces of one scene, and what another one has there. */
static Count compare(const char *text, const char *other, bool layers)
{
    static SurfacePoint points[POINTS];
    static FoundSurface found[POINTS];
    static float        colors[POINTS][3];
    const size_t        numbers = layers ? SURFACE_NUMBERS : PLAIN_SURFACE_NUMBERS;
    KrsScene           *scene, *truth;
    KrsState           *state, *true_state;
    Count               count = {0};
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_compile_text(other, strlen(other), "scene.krs", NULL, &truth), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_new(truth, &true_state), KRS_OK);
    state_refresh_points(true_state);
    SurfaceField *field = surface_field_new(state, layers);
    assert_non_null(field);
    for (int i = 0; i < PATCHES; i++) {
        random_patch(points, found);
        surface_field_find(field, 0, points, POINTS);
        for (int k = 0; k < POINTS; k++) {
            const FoundSurface here = true_surface(true_state, &points[k]);
            count.other += differs((const float *)&found[k], (const float *)&here, numbers);
            points[k].found = colors[k];
        }
        surface_field_find_colors(field, 0, points, POINTS);
        for (int k = 0; k < POINTS; k++)
            assert_memory_equal(colors[k], found[k].color, sizeof colors[k]);
        count.points += POINTS;
    }
    surface_field_free(field);
    krs_state_free(state);
    krs_state_free(true_state);
    krs_scene_free(scene);
    krs_scene_free(truth);
    return count;
}

static void expect_same(const char *text, bool layers)
{
    const Count count = compare(text, text, layers);
    print_message("%zu of %zu points differ\n", count.other, count.points);
    assert_true(count.other <= count.points / 200);
}

static void surfaces_are_those_of_the_tape(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (int layers = 0; layers < 2; layers++)
            expect_same(scenes[i], layers);
}

static void so_they_are_in_random_scenes(void **context)
{
    (void)context;
    static char text[16384];
    for (int i = 0; i < 8; i++) {
        random_scene(text, sizeof text);
        expect_same(text, i % 2);
    }
}

/* In the text of all properties each number is changed in turn. */
static void each_property_counts(void **context)
{
    (void)context;
    char   other[sizeof properties];
    size_t changed = 0;
    expect_same(properties, true);
    for (const char *at = strchr(properties, '0'); at; at = strpbrk(at + 1, "123456789")) {
        if (strncmp(at, "1).paint", 8) == 0)
            break;
        memcpy(other, properties, sizeof other);
        other[at - properties] = *at == '9' ? '8' : (char)(*at + 1);
        const Count count      = compare(properties, other, true);
        changed++;
        assert_int_equal(count.other, count.points);
    }
    assert_true(changed > 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_are_those_of_the_tape),
        cmocka_unit_test(so_they_are_in_random_scenes),
        cmocka_unit_test(each_property_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
