/*
 * mesh_forms.c: genus, parts and volume of meshes against closed forms and against counts of small cubes.
 *
 * mesh_forms [FOLDER]: a Menger sponge of three levels as well; meshes are left in the folder, for
 * tests/oracle/mesh_judge.
 */
#include "tests/oracle/mesh_distance.h"
#include "tests/oracle/mesh_shape.h"
#include "tests/oracle/product.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double PI = 3.14159265358979323846;
static const char  *folder;

static void leave_mesh(const KrsMesh *mesh, const char *name)
{
    char path[4096];
    if (!folder)
        return;
    snprintf(path, sizeof path, "%s/%s.off", folder, name);
    write_off(mesh, path);
}

/* ---- closed forms ---- */

typedef struct Form {
    const char *name, *text;
    double      error, half; /* half of the cube around it */
    long        parts, genus;
    double      volume, tolerance; /* relative, of even meshes */
    double
                  area; /* of round faces, which polygons stand for in other ones; 0: there are none, or no polygons */
    SurfaceValue *value; /* its small cubes have this genus, too */
    int           cells;
    bool          thin; /* it has thin edges, which are reported */
} Form;

static double ring(Vec p, double major, double minor)
{
    return hypot(hypot(p.x, p.z) - major, p.y) - minor;
}

static double value_of_torus(const void *user, Vec p)
{
    (void)user;
    return ring(p, 0.7, 0.25);
}

/* Each goes through the other. */
static double value_of_links(const void *user, Vec p)
{
    (void)user;
    return fmin(ring(vec(p.x + 0.35, p.y, p.z), 0.7, 0.2),
                ring(vec(p.x - 0.35, p.z, p.y), 0.7, 0.2));
}

/* It changes its sign with p, so that it is half of any whole period.  Where it meets the edges of the cube it has
   edges that are thinner than any error. */
static double value_of_gyroid(const void *user, Vec p)
{
    double x = 2 * PI * (p.x + 0.11), y = 2 * PI * (p.y + 0.07), z = 2 * PI * (p.z + 0.19);
    (void)user;
    return fmax(sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x),
                fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) - 0.5);
}

/* Returns the value of a sponge of n levels: no two of the first n digits to base 3 at a place are 1.  Twenty
   of 27 cubes are left each time. */
static double value_of_sponge(Vec p, int levels)
{
    double at[3] = {p.x + 0.5, p.y + 0.5, p.z + 0.5};
    for (int k = 0; k < 3; k++)
        if (at[k] < 0 || at[k] >= 1)
            return 1;
    for (int i = 0; i < levels; i++) {
        int middle = 0;
        for (int k = 0; k < 3; k++) {
            double digit = floor(3 * at[k]);
            middle += digit == 1;
            at[k] = 3 * at[k] - digit;
        }
        if (middle >= 2)
            return 1;
    }
    return -1;
}

static double value_of_sponge_1(const void *user, Vec p)
{
    (void)user;
    return value_of_sponge(p, 1);
}

static double value_of_sponge_2(const void *user, Vec p)
{
    (void)user;
    return value_of_sponge(p, 2);
}

static double value_of_sponge_3(const void *user, Vec p)
{
    (void)user;
    return value_of_sponge(p, 3);
}

/* Returns a closed form with g_0 = 0 of what the levels take away: 5, 81, 1409, 26433. */
static long genus_of_sponge(int levels)
{
    return lround((21 * pow(20, levels) + 38 * pow(8, levels) - 59) / 133);
}

#define BARS(n, s)                                                                           \
    ", box([2, " s ", " s "]).repeat([0, 3 * " s ", 3 * " s "], [1, " n ", " n "]), box([" s \
    ", 2, " s "]).repeat([3 * " s ", 0, 3 * " s "], [" n ", 1, " n "]), box([" s ", " s      \
    ", 2]).repeat([3 * " s ", 3 * " s ", 0], [" n ", " n ", 1])"

static void check_form(const Form *form, bool even)
{
    clock_t        start   = clock();
    Product        product = product_compile(form->text);
    KrsMeshOptions options = {.error = form->error, .even = even};
    KrsMesh       *mesh;
    assert_int_equal(krs_mesh(product.state, &options, &mesh), KRS_OK);
    check_closed(mesh);
    if (!even)
        leave_mesh(mesh, form->name);
    MeshShape shape = mesh_shape(mesh);
    Surface   cubes = {form->value, NULL, vec(-form->half, -form->half, -form->half),
                       vec(form->half, form->half, form->half)};
    print_message("# %s: %zu triangles, genus %ld, volume %.6f of %.6f; %zu unresolved; %.1f s\n",
                  form->name, mesh->triangle_count, shape.parts - shape.euler / 2, shape.volume,
                  form->volume, mesh->unresolved, (double)(clock() - start) / CLOCKS_PER_SEC);
    assert_true(form->thin || mesh->unresolved == 0);
    assert_int_equal(shape.parts, form->parts);
    assert_int_equal(shape.parts - shape.euler / 2, form->genus);
    double off = form->area > 0 && !even ? form->area * form->error
                                         : form->tolerance * form->volume;
    assert_true(fabs(shape.volume - form->volume) < off);
    assert_int_equal(solid_euler(&cubes, form->cells), 2 * (form->parts - form->genus));
    krs_mesh_free(mesh);
    product_free(&product);
}

static void genus_and_volume_are_those_of_closed_forms(void **state)
{
    const Form forms[] = {
        {"torus", "show torus(0.7, 0.25);", 0.03, 1, 1, 1, 2 * PI * PI * 0.7 * 0.25 * 0.25, 0.015,
         4 * PI * PI * 0.7 * 0.25, value_of_torus, 50, false},
        {"links",
         "show torus(0.7, 0.2).move([-0.35, 0, 0]); "
         "show torus(0.7, 0.2).rotate([1, 0, 0], 90deg).move([0.35, 0, 0]);",
         0.02, 1.3, 2, 2, 4 * PI * PI * 0.7 * 0.2 * 0.2, 0.01, 8 * PI * PI * 0.7 * 0.2,
         value_of_links, 65, false},
        {"gyroid",
         "let k = tau; show box([1, 1, 1]) & field(sin(k * x) * cos(k * y) + "
         "sin(k * y) * cos(k * z) + sin(k * z) * cos(k * x)).move([-0.11, -0.07, -0.19]);",
         0.05, 0.5, 1, 3, 0.5, 0.01, 0, value_of_gyroid, 64, true},
        {"sponge-1", "show difference(box([1, 1, 1])" BARS("1", "1/3") ");", 0.05, 0.5, 1,
         genus_of_sponge(1), 20. / 27, 0.005, 0, value_of_sponge_1, 27, false},
        /* Faces meet at right angles about three errors apart, which is not thin. */
        {"sponge-2", "show difference(box([1, 1, 1])" BARS("1", "1/3") BARS("3", "1/9") ");", 0.04,
         0.5, 1, genus_of_sponge(2), pow(20. / 27, 2), 0.005, 0, value_of_sponge_2, 27, false},
        {"sponge-3",
         "show difference(box([1, 1, 1])" BARS("1", "1/3") BARS("3", "1/9") BARS("9", "1/27") ");",
         0.012, 0.5, 1, genus_of_sponge(3), pow(20. / 27, 3), 0.005, 0, value_of_sponge_3, 27,
         false},
    };
    size_t count = sizeof forms / sizeof *forms;
    (void)state;
    for (size_t i = 0; i < (folder ? count : count - 1); i++)
        check_form(&forms[i], false);
    check_form(&forms[0], true);
    check_form(&forms[1], true);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(genus_and_volume_are_those_of_closed_forms),
    };
    folder = argc > 1 ? argv[1] : NULL;

    return cmocka_run_group_tests_name("mesh_forms", tests, NULL, NULL);
}
