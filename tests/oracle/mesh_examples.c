/*
 * mesh_examples.c: meshes of the examples are within the error of them, in both directions.
 *
 * mesh_examples [SCENE...]: these scenes, as mesh_examples.def tells; one that is quick without any.
 */
#include "tests/oracle/mesh_distance.h"
#include "tests/oracle/mesh_shape.h"
#include "tests/oracle/product.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { RAYS = 400, POINTS = 2000 };
static const double LONGEST = 600; /* seconds for a mesh; beyond, it fails */

typedef struct Row {
    const char *name;
    double      box[6], error;
} Row;

#define BOX(...)    \
    {               \
        __VA_ARGS__ \
    }
#define EXAMPLE(name, box, error) {name, box, error},
static const Row rows[] = {
#include "tests/oracle/mesh_examples.def"
};
static const size_t row_count = sizeof rows / sizeof *rows;

static char      **scenes; /* NULL: one that is quick */
static char *const quick[] = {"examples/38-dodecahedron.krs", NULL};

typedef struct Example {
    Product        product;
    KrsMeshOptions options;
    bool           estimate, endless;
    double         start, seconds; /* of the mesh */
} Example;

static double now(void) { return (double)clock() / CLOCKS_PER_SEC; }

/* What is meshed is cut by the box. */
static double value_of_example(const void *user, Vec p)
{
    const Example        *example = user;
    const KrsMeshOptions *o       = &example->options;
    const double          at[3]   = {p.x, p.y, p.z};
    double                value   = product_distance(&example->product, p);
    for (int k = 0; k < 3; k++)
        value = fmax(value, fmax(o->low[k] - at[k], at[k] - o->high[k]));
    return value;
}

static void look_at_components(Example *e)
{
    for (size_t i = 0; i < krs_component_count(e->product.scene); i++) {
        KrsComponent component;
        assert_int_equal(krs_component(e->product.scene, i, &component), KRS_OK);
        e->estimate = e->estimate || component.estimate;
        for (int k = 0; k < 3; k++)
            e->endless = e->endless || isinf(component.high[k] - component.low[k]);
    }
}

static bool report_progress(void *user, double fraction)
{
    const Example *example = user;
    (void)fraction;
    return now() < example->start + LONGEST;
}

static Example open_example(const char *path, const Row *row)
{
    Example e = {.start = now()};
    memcpy(e.options.low, row->box, sizeof e.options.low);
    memcpy(e.options.high, row->box + 3, sizeof e.options.high);
    e.options.within = true;
    e.options.error  = row->error;
    assert_int_equal(krs_compile_file(path, NULL, &e.product.scene), KRS_OK);
    assert_int_equal(krs_state_new(e.product.scene, &e.product.state), KRS_OK);
    look_at_components(&e);
    return e;
}

/* What has no end has no mesh without a box. */
static void check_refusal(const Example *e)
{
    KrsMeshOptions options = {.error = e->options.error};
    KrsMesh       *mesh;
    if (e->endless)
        assert_int_equal(krs_mesh(e->product.state, &options, &mesh), KRS_BAD_ARGUMENT);
}

static void judge(const Row *row, const Example *e, const KrsMesh *mesh)
{
    const double *box     = row->box;
    Random        random  = {7};
    Surface       surface = {value_of_example, e, vec(box[0], box[1], box[2]),
                             vec(box[3], box[4], box[5])};
    check_closed(mesh);
    Apart apart = mesh_apart(mesh, &surface, row->error, RAYS, POINTS, &random);
    print_message("| %s%s | %g, %g, %g to %g, %g, %g | %g | %zu | %zu | %.3f | %zu | %zu | %zu | "
                  "%zu | %.0f s "
                  "|\n",
                  row->name, e->estimate ? ", an estimate" : "", box[0], box[1], box[2], box[3],
                  box[4], box[5], row->error, mesh->triangle_count, apart.hits, apart.farthest_hit,
                  apart.lost, apart.points, apart.off_surface, mesh->unresolved, e->seconds);
    if (apart.lost > 0)
        print_message("# lost at (%.9g, %.9g, %.9g), %zu where nothing is thin\n", apart.lost_at.x,
                      apart.lost_at.y, apart.lost_at.z, apart.thick);
    if (apart.off_surface > 0)
        print_message("# off the surface at (%.9g, %.9g, %.9g)\n", apart.off_surface_at.x,
                      apart.off_surface_at.y, apart.off_surface_at.z);
    assert_true(apart.hits > RAYS / 10); /* a plane that a box cuts has 12 triangles */
    assert_true(e->estimate || apart.off_surface == 0);
    assert_true(e->estimate || apart.thick == 0);
    assert_true(e->estimate || mesh->unresolved > 0 || apart.lost == 0);
}

static const Row *find_row(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    size_t      length = strcspn(name, ".");
    for (size_t i = 0; i < row_count; i++)
        if (strlen(rows[i].name) == length && strncmp(rows[i].name, name, length) == 0)
            return &rows[i];
    fail_msg("mesh_examples.def has no row for %s", path);
    return NULL;
}

static void try_example(const char *path)
{
    const Row *row = find_row(path);
    Example    e   = open_example(path, row);
    KrsMesh   *mesh;
    e.options.progress = report_progress;
    e.options.user     = &e;
    assert_int_equal(krs_mesh(e.product.state, &e.options, &mesh), KRS_OK);
    e.seconds = now() - e.start;
    check_refusal(&e);
    judge(row, &e, mesh);
    krs_mesh_free(mesh);
    product_free(&e.product);
}

static void examples_are_within_the_error(void **state)
{
    (void)state;
    for (char *const *path = scenes ? scenes : quick; *path; path++)
        try_example(*path);
}

/* So none can be forgotten. */
static void each_example_has_a_row(void **state)
{
    DIR   *folder = opendir("examples");
    size_t found  = 0;
    (void)state;
    assert_non_null(folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        const char *dot = strrchr(entry->d_name, '.');
        if (!dot || strcmp(dot, ".krs") != 0)
            continue;
        find_row(entry->d_name);
        found++;
    }
    closedir(folder);
    assert_int_equal(found, row_count);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_example_has_a_row),
        cmocka_unit_test(examples_are_within_the_error),
    };
    scenes = argc > 1 ? argv + 1 : NULL;
    return cmocka_run_group_tests_name("mesh_examples", tests, NULL, NULL);
}
