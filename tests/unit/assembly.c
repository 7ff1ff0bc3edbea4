/*
 * assembly.c: sequences as kernels and their copies: where they are by closed forms and by distances, and when a
 * sequence must be meshed as a whole.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "krs/krs.h"

typedef struct Taken {
    KrsScene    *scene;
    KrsState    *state;
    KrsAssembly *assembly;
} Taken;

static Taken take(const char *text, double error)
{
    Taken          t;
    KrsOptions     options = {.assembly = true};
    KrsMeshOptions how     = {.error = error};
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &t.scene), KRS_OK);
    assert_int_equal(krs_state_new(t.scene, &t.state), KRS_OK);
    assert_int_equal(krs_assemble(t.state, &how, &t.assembly), KRS_OK);
    return t;
}

static void leave(Taken t)
{
    krs_assembly_free(t.assembly);
    krs_state_free(t.state);
    krs_scene_free(t.scene);
}

static double determinant(const double m[3][4])
{
    double cross[3];
    cross3(m[0], m[1], cross);
    return dot3(cross, m[2]);
}

/* What visits find. */
typedef struct Found {
    KrsState      *state;
    double         volume, farthest; /* of a vertex from the surface */
    size_t         copies, reflections;
    const KrsMesh *last; /* mesh, and its volume */
    double         last_volume;
} Found;

static double volume_of(const KrsMesh *mesh)
{
    double volume = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        double cross[3];
        cross3(mesh->vertices[mesh->triangles[i][1]], mesh->vertices[mesh->triangles[i][2]], cross);
        volume += dot3(mesh->vertices[mesh->triangles[i][0]], cross) / 6;
    }
    return volume;
}

static void apply(const double m[3][4], const double p[3], double image[3])
{
    for (int i = 0; i < 3; i++)
        image[i] = dot3(m[i], p) + m[i][3];
}

static bool look_at(void *user, const KrsItem *item, const double matrix[3][4])
{
    Found         *found = user;
    const KrsMesh *mesh  = item->mesh;
    double         size  = determinant(matrix);
    if (found->last != mesh)
        found->last_volume = volume_of(mesh);
    found->last = mesh;
    for (size_t i = 0; found->state && i < mesh->vertex_count; i++) {
        double image[3], distance;
        apply(matrix, mesh->vertices[i], image);
        krs_distance(found->state, (const double(*)[3])image, 1, &distance);
        found->farthest = fmax(found->farthest, fabs(distance));
    }
    found->volume += fabs(size) * found->last_volume;
    found->copies++;
    found->reflections += size < 0;
    return true;
}

static const char bush[] =
    "show krs {"
    "    kernel torus(major: 0.3, minor: 0.1).move([0.45, 0.1, 0.45]);"
    "    reflect plane([-1, 0, 0], 0);"
    "    reflect plane([0, 1, 0], 0.6);"
    "    mobius translate([1, 2, 3]) * rotate([0, 1, 0], 30deg) * scale(0.5);"
    "    reflect plane([1, 0, 0], 3);"
    "    kernel sphere(0.4).move([0, 5, 0]);"
    "}.rotate([1, 0, 0], 20deg);"
    "show box([1, 1, 1]).move([0, 9, 0]);";

static void copies_are_where_the_sequence_is(void **context)
{
    (void)context;
    const double pi    = acos(-1);
    Taken        t     = take(bush, 0.02);
    Found        found = {.state = t.state};
    assert_non_null(t.assembly);
    assert_true(krs_assembly_visit(t.assembly, look_at, &found));
    double tori = 8 * 0.125 * 2 * pi * pi * 0.3 * 0.01, ball = 4 * pi / 3 * 0.064;
    assert_int_equal(found.copies, 10);
    assert_int_equal(found.reflections, 4);
    assert_true(t.assembly->copies == 10);
    assert_true(found.farthest <= 0.02);
    assert_true(fabs(found.volume - (tori + ball + 1)) < 0.06 * (tori + ball + 1));
    assert_true(t.assembly->high[1] >= 9.48 && t.assembly->high[1] <= 9.52);
    leave(t);
}

static void a_million_copies_are_one_mesh(void **context)
{
    (void)context;
    Taken  t      = take("show krs {"
                               "    kernel sphere(0.4).move([0.5, 0.5, 0.5]);"
                               "    for i in 0..7 { reflect plane([1, 0, 0], pow(2, i)); }"
                               "    for i in 0..7 { reflect plane([0, 1, 0], pow(2, i)); }"
                               "    for i in 0..6 { reflect plane([0, 0, 1], pow(2, i)); }"
                               "};",
                         0.02);
    Found  found  = {0};
    size_t meshes = 0;
    assert_non_null(t.assembly);
    assert_true(krs_assembly_visit(t.assembly, look_at, &found));
    for (size_t i = 0; i < t.assembly->item_count; i++)
        meshes += t.assembly->items[i].mesh != NULL;
    double volume = 1048576 * 4 * acos(-1) / 3 * 0.064;
    assert_int_equal(meshes, 1);
    assert_int_equal(found.copies, 1048576);
    assert_int_equal(found.reflections, 524288);
    assert_true(fabs(found.volume - volume) < 0.1 * volume);
    assert_true(fabs(t.assembly->low[0] - 0.1) <= 0.02 && fabs(t.assembly->high[2] - 63.9) <= 0.02);
    leave(t);
}

/* Mirrors that cut, inversions, blends and deformations. */
static void what_is_cut_is_meshed_whole(void **context)
{
    (void)context;
    static const char *const texts[] = {
        "show krs { kernel sphere(0.5).move([0.4, 0, 0]); reflect plane([-1, 0, 0], 0); };",
        "show krs { kernel sphere(0.5).move([2, 0, 0]); reflect sphere(1); };",
        "show krs { kernel sphere(0.5).move([2, 0, 0]); reflect plane([-1, 0, 0], 0); }"
        "    .twist([0, 1, 0], 0.3);",
        "let two = krs { kernel sphere(0.5).move([1, 0, 0]); reflect plane([-1, 0, 0], 0); };"
        "show union(two, box([1, 1, 1]), blend: 0.2);",
        "show sphere(1);"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Taken t = take(texts[i], 0.1);
        assert_null(t.assembly);
        leave(t);
    }
}

/* Where the mirror is depends on a parameter, so whether it cuts does, too. */
static void each_state_is_asked(void **context)
{
    (void)context;
    Taken t = take(
        "param at = 0 in [-1, 1];"
        "show krs { kernel sphere(0.5).move([0.6, 0, 0]); reflect plane([-1, 0, 0], at); };",
        0.1);
    KrsMeshOptions how = {.error = 0.1};
    double         at  = -0.3;
    assert_non_null(t.assembly);
    krs_assembly_free(t.assembly);
    assert_int_equal(krs_state_set(t.state, "at", &at, 1), KRS_OK);
    assert_int_equal(krs_assemble(t.state, &how, &t.assembly), KRS_OK);
    assert_null(t.assembly);
    at = 0.3;
    assert_int_equal(krs_state_set(t.state, "at", &at, 1), KRS_OK);
    assert_int_equal(krs_assemble(t.state, &how, &t.assembly), KRS_OK);
    assert_non_null(t.assembly);
    assert_true(fabs(t.assembly->low[0] + 1.7) <= 0.1);
    leave(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(copies_are_where_the_sequence_is),
                                       cmocka_unit_test(a_million_copies_are_one_mesh),
                                       cmocka_unit_test(what_is_cut_is_meshed_whole),
                                       cmocka_unit_test(each_state_is_asked)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
