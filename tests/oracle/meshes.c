/*
 * meshes.c: meshes of random scenes are within the error of them, in both directions.
 *
 * What is inside of two thirds of them is known from the meaning of their words alone (known_solid.h); of the
 * others, which have more kinds of shapes, from distances of single points (krs_distance).
 *
 * meshes [COUNT FOLDER]: so many scenes, two thirds of the error, more rays; their meshes are left in the folder, for
 * tests/oracle/mesh_judge.
 */
#include "tests/oracle/known_solid.h"
#include "tests/oracle/mesh_distance.h"
#include "tests/oracle/mesh_shape.h"
#include "tests/oracle/random_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static int         wanted = 36; /* scenes */
static const char *folder;      /* for meshes, or NULL */

static size_t rays = 250, points = 1000; /* of each */
/* Half of the box that is looked at. */
static const double SIDE = 1.8;

static KrsMesh *mesh_by(const Product *product, double error, bool draft)
{
    KrsMeshOptions options = {.error  = error,
                              .draft  = draft,
                              .within = true,
                              .low    = {-SIDE, -SIDE, -SIDE},
                              .high   = {SIDE, SIDE, SIDE}};
    KrsMesh       *mesh;
    assert_int_equal(krs_mesh(product->state, &options, &mesh), KRS_OK);
    return mesh;
}

static KrsMesh *mesh_of(const Product *product, double error)
{
    return mesh_by(product, error, false);
}

/* ---- random solids ---- */

/* What was found of many. */
typedef struct Tally {
    size_t scenes, empty, reported, hits, points, lost, triangles;
    double farthest;
} Tally;

/* Where nothing is reported, nothing may be lost, and nowhere what is thick; points of a mesh are never off the surface. */
static void judge_mesh(const KrsMesh *mesh, const Surface *surface, double error, Random *random,
                       const char *text, Tally *tally)
{
    check_closed(mesh);
    Apart apart = mesh_apart(mesh, surface, error, rays, points, random);
    if (apart.off_surface > 0)
        fail_msg("%s\n%zu of %zu points of the mesh are farther than %g from the solid, as at "
                 "(%.9g, %.9g, %.9g)",
                 text, apart.off_surface, apart.points, error, apart.off_surface_at.x,
                 apart.off_surface_at.y, apart.off_surface_at.z);
    if (apart.lost > 0 && mesh->unresolved == 0)
        fail_msg("%s\n%zu of %zu hits are farther than %g from the mesh, as at (%.9g, %.9g, %.9g)",
                 text, apart.lost, apart.hits, error, apart.lost_at.x, apart.lost_at.y,
                 apart.lost_at.z);
    if (apart.thick > 0)
        fail_msg(
            "%s\n%zu of %zu hits are farther than %g from the mesh where nothing is thin, as at "
            "(%.9g, %.9g, %.9g)",
            text, apart.thick, apart.hits, error, apart.lost_at.x, apart.lost_at.y,
            apart.lost_at.z);
    if (mesh->unresolved == 0)
        tally->farthest = fmax(tally->farthest, apart.farthest_hit);
    tally->scenes++;
    tally->empty += mesh->triangle_count == 0;
    tally->reported += mesh->unresolved > 0;
    tally->hits += apart.hits;
    tally->points += apart.points;
    tally->lost += apart.lost;
    tally->triangles += mesh->triangle_count;
}

static double error_of(int turn)
{
    static const double errors[] = {0.08, 0.05, 0.1};
    return (folder ? 2 : 3) * errors[turn % 3];
}

/* What is meshed is cut by the box. */
static double cut_by_box(Vec p, double value)
{
    return fmax(value, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) - SIDE);
}

static double value_of_solid(const void *user, Vec p)
{
    return cut_by_box(p, known_solid_value(user, p));
}

static double value_of_scene(const void *user, Vec p)
{
    return cut_by_box(p, product_distance(user, p));
}

static void leave_mesh(const KrsMesh *mesh, const char *kind, int number)
{
    char path[4096];
    if (!folder)
        return;
    snprintf(path, sizeof path, "%s/%s-%03d.off", folder, kind, number);
    write_off(mesh, path);
}

static void print_tally(const char *what, const Tally *tally, clock_t start)
{
    print_message("# %s: %zu scenes, %zu triangles; %zu points of surfaces, at most %.3f errors "
                  "from the mesh; %zu points of meshes; %zu scenes with reports, %zu points lost "
                  "there; %zu empty; %.1f s\n",
                  what, tally->scenes, tally->triangles, tally->hits, tally->farthest,
                  tally->points, tally->reported, tally->lost, tally->empty,
                  (double)(clock() - start) / CLOCKS_PER_SEC);
}

static void random_solids_are_within_the_error(void **state)
{
    static SceneText text;
    Tally            tally = {0};
    clock_t          start = clock();
    (void)state;
    for (int turn = 0; turn < wanted * 2 / 3; turn++) {
        Random      random = {1000 + (uint64_t)turn};
        double      error  = error_of(turn);
        KnownSolid *solid  = known_solid_random(&random, error);
        text.length        = 0;
        scene_write(&text, "show ");
        known_solid_write(solid, &text);
        scene_write(&text, ";");
        Product  product = product_compile(text.bytes);
        KrsMesh *mesh    = mesh_of(&product, error);
        Surface  surface = {value_of_solid, solid, vec(-2, -2, -2), vec(2, 2, 2)};
        judge_mesh(mesh, &surface, error, &random, text.bytes, &tally);
        leave_mesh(mesh, "solid", turn);
        krs_mesh_free(mesh);
        product_free(&product);
        known_solid_free(solid);
    }
    print_tally("random solids", &tally, start);
    assert_true(tally.empty < tally.scenes / 4 && tally.reported < tally.scenes * 3 / 4);
}

/* ---- drafts ---- */

/* Nothing is promised of single points, but of nearly all. */
static void nearly_all_of_a_draft_is_within_the_error(void **state)
{
    enum { SCENES = 24 };
    static const double MAX_FAR = 0.0005; /* part of all points */
    static SceneText    text;
    size_t              looked = 0, far = 0;
    (void)state;
    for (int turn = 0; turn < SCENES; turn++) {
        Random      random = {9000 + (uint64_t)turn};
        double      error  = error_of(turn);
        KnownSolid *solid  = known_solid_random(&random, error);
        text.length        = 0;
        scene_write(&text, "show ");
        known_solid_write(solid, &text);
        scene_write(&text, ";");
        Product  product = product_compile(text.bytes);
        KrsMesh *mesh    = mesh_by(&product, error, true);
        Surface  surface = {value_of_solid, solid, vec(-2, -2, -2), vec(2, 2, 2)};
        check_closed(mesh);
        Apart apart = mesh_apart(mesh, &surface, error, rays, 1000, &random);
        looked += apart.hits + apart.points;
        far += apart.thick + apart.off_surface;
        krs_mesh_free(mesh);
        product_free(&product);
        known_solid_free(solid);
    }
    print_message("# drafts: %zu of %zu points are farther than the error\n", far, looked);
    assert_true((double)far < MAX_FAR * (double)looked);
}

/* ---- random scenes ---- */

/* Returns false if the compiler refuses what was drawn, as what does not fit its cell. */
static bool open_scene(const SceneText *text, Product *product)
{
    *product = (Product){0};
    if (krs_compile_text(text->bytes, text->length, "oracle.krs", NULL, &product->scene) != KRS_OK)
        return false;
    assert_int_equal(krs_state_new(product->scene, &product->state), KRS_OK);
    return true;
}

static void random_scenes_are_within_the_error(void **state)
{
    static SceneText text;
    Tally            tally = {0};
    clock_t          start = clock();
    int              turns = folder ? wanted / 3 : 6;
    (void)state;
    for (int turn = 0; turn < turns; turn++) {
        Random random = {5005 + (uint64_t)turn};
        double error  = error_of(turn);
        text.length   = 0;
        write_random_scene(&text, &random, vec(0, 0, 0), 1);
        Product product;
        if (!open_scene(&text, &product))
            continue;
        KrsMesh *mesh    = mesh_of(&product, error);
        Surface  surface = {value_of_scene, &product, vec(-2, -2, -2), vec(2, 2, 2)};
        judge_mesh(mesh, &surface, error, &random, text.bytes, &tally);
        leave_mesh(mesh, "scene", turn);
        krs_mesh_free(mesh);
        product_free(&product);
    }
    print_tally("random scenes", &tally, start);
    assert_true(tally.scenes > (size_t)turns * 3 / 4);
}

/* ---- planted faults ---- */

static double value_of_ring(const void *user, Vec p)
{
    (void)user;
    return hypot(hypot(p.x, p.z) - 0.8, p.y) - 0.3;
}

static double value_of_both(const void *user, Vec p)
{
    return fmin(value_of_ring(user, p), vec_distance(p, vec(0, 0.1, 0)) - 0.2);
}

/* With a plate that is thinner than the error. */
static double value_of_ring_and_plate(const void *user, Vec p)
{
    return fmin(value_of_ring(user, p), fmax(fabs(p.y) - 0.015, hypot(p.x, p.z) - 0.3));
}

/* Each vertex away from the middle of the ring's tube. */
static void grow_ring(KrsMesh *mesh, double by)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        double *v = mesh->vertices[i], far = hypot(v[0], v[2]);
        Vec     p = vec(v[0], v[1], v[2]), middle = vec(0.8 * v[0] / far, 0, 0.8 * v[2] / far);
        Vec     to = vec_add(p, vec_scale(by, vec_unit(vec_sub(p, middle))));
        v[0]       = to.x;
        v[1]       = to.y;
        v[2]       = to.z;
    }
}

static void what_is_farther_than_the_error_is_seen(void **state)
{
    const double error  = 0.05;
    Random       random = {20};
    Product      ring   = product_compile("show torus(0.8, 0.3);");
    KrsMesh     *mesh   = mesh_of(&ring, error);
    Surface      own    = {value_of_ring, NULL, vec(-1.2, -0.4, -1.2), vec(1.2, 0.4, 1.2)};
    Surface      both   = {value_of_both, NULL, own.low, own.high};
    (void)state;
    Apart good = mesh_apart(mesh, &own, error, rays, points, &random);
    assert_true(good.hits > rays && good.points > points);
    assert_true(good.crossings[0] == good.crossings[1]);
    assert_int_equal(good.lost + good.off_surface, 0);
    Apart without = mesh_apart(mesh, &both, error, rays, points, &random);
    assert_true(without.lost > 5 && without.off_surface == 0);
    assert_int_equal(without.thick, without.lost);
    Surface plate = {value_of_ring_and_plate, NULL, own.low, own.high};
    without       = mesh_apart(mesh, &plate, error, rays, points, &random);
    assert_true(without.lost > 5 && without.thick == 0);
    grow_ring(mesh, 1.5 * error);
    Apart grown = mesh_apart(mesh, &own, error, rays, points, &random);
    assert_true(grown.lost > good.hits / 2 && grown.off_surface > good.points / 2);
    krs_mesh_free(mesh);
    product_free(&ring);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_solids_are_within_the_error),
        cmocka_unit_test(nearly_all_of_a_draft_is_within_the_error),
        cmocka_unit_test(random_scenes_are_within_the_error),
        cmocka_unit_test(what_is_farther_than_the_error_is_seen),
    };
    wanted = argc > 1 ? atoi(argv[1]) : wanted;
    folder = argc > 2 ? argv[2] : NULL;
    rays   = folder ? 1500 : rays;
    points = folder ? 6000 : points;
    return cmocka_run_group_tests_name("meshes", tests, NULL, NULL);
}
