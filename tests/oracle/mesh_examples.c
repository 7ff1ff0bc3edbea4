/*
 * mesh_examples.c: meshes of the examples are within the error of them, in both directions.
 *
 * mesh_examples [SECONDS SCENE...]: these scenes, each for so many seconds at most.  What has an end is meshed, within
 * the box of it, so that a floor is cut off there.  The error is a part of the box's longest side, twice as large
 * as long as a mesh takes too long.
 */
#include "tests/oracle/mesh_distance.h"
#include "tests/oracle/mesh_shape.h"
#include "tests/oracle/product.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double       seconds = 20;
static char       **scenes; /* NULL: one that is quick */
static char *const  quick[] = {"examples/38-dodecahedron.krs", NULL};
static const double FINEST = 1. / 100, COARSEST = 1. / 20; /* errors, in longest sides */

typedef struct Example {
    Product        product;
    KrsMeshOptions options;
    bool           estimate, floor; /* something of it has no end */
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

/* The box around all components that have an end; false: none has. */
static bool find_box(Example *e)
{
    bool any = false;
    for (int k = 0; k < 3; k++) {
        e->options.low[k]  = INFINITY;
        e->options.high[k] = -INFINITY;
    }
    for (size_t i = 0; i < krs_component_count(e->product.scene); i++) {
        KrsComponent component;
        bool         ends = true;
        assert_int_equal(krs_component(e->product.scene, i, &component), KRS_OK);
        for (int k = 0; k < 3; k++)
            ends = ends && isfinite(component.low[k]) && isfinite(component.high[k]);
        e->floor    = e->floor || !ends;
        e->estimate = e->estimate || component.estimate;
        any         = any || ends;
        for (int k = 0; ends && k < 3; k++) {
            e->options.low[k]  = fmin(e->options.low[k], component.low[k]);
            e->options.high[k] = fmax(e->options.high[k], component.high[k]);
        }
    }
    return any;
}

static bool go_on(void *user, double fraction)
{
    (void)fraction;
    return now() < *(const double *)user;
}

/* The finest mesh that takes no longer than is wanted. */
static KrsStatus make_mesh(Example *e, double side, KrsMesh **mesh)
{
    KrsStatus status = KRS_INTERRUPTED;
    double    end;
    e->options.go_on = go_on;
    e->options.user  = &end;
    for (double part = FINEST; status == KRS_INTERRUPTED && part <= COARSEST; part *= 2) {
        end              = now() + seconds;
        e->options.error = part * side;
        status           = krs_mesh(e->product.frame, &e->options, mesh);
    }
    return status;
}

static void judge(const char *path, const Example *e, const KrsMesh *mesh, double start)
{
    const KrsMeshOptions *o       = &e->options;
    Random                random  = {7};
    Surface               surface = {value_of_example, e, vec(o->low[0], o->low[1], o->low[2]),
                                     vec(o->high[0], o->high[1], o->high[2])};
    check_closed(mesh);
    Apart apart = mesh_apart(mesh, &surface, o->error, 300, 1500, &random);
    print_message("# %s%s%s: error %.3g, %zu triangles; %zu hits, at most %.3f errors away, %zu "
                  "lost; %zu points, %zu astray; %zu reported; %.0f s\n",
                  path, e->floor ? ", cut" : "", e->estimate ? ", an estimate" : "", o->error,
                  mesh->triangle_count, apart.hits, apart.farthest_hit, apart.lost, apart.points,
                  apart.astray, mesh->unresolved, now() - start);
    assert_true(e->estimate || apart.astray == 0);
    assert_true(e->estimate || mesh->unresolved > 0 || apart.lost == 0);
}

static bool try_example(const char *path)
{
    Example  e     = {.options = {.within = true}};
    KrsMesh *mesh  = NULL;
    double   start = now(), side = 0;
    bool     judged = false;
    assert_int_equal(krs_compile_file(path, NULL, &e.product.scene), KRS_OK);
    assert_int_equal(krs_frame_new(e.product.scene, &e.product.frame), KRS_OK);
    if (!find_box(&e))
        print_message("# %s: nothing of it has an end\n", path);
    else {
        for (int k = 0; k < 3; k++)
            side = fmax(side, e.options.high[k] - e.options.low[k]);
        KrsStatus status = make_mesh(&e, side, &mesh);
        judged           = status == KRS_OK;
        if (judged)
            judge(path, &e, mesh, start);
        else
            print_message("# %s: not meshed: %s\n", path,
                          status == KRS_INTERRUPTED     ? "it takes too long"
                          : status == KRS_OUT_OF_MEMORY ? "it takes too much memory"
                                                        : "it has surfaces without thickness");
        krs_mesh_free(mesh);
    }
    product_free(&e.product);
    return judged;
}

static void examples_are_within_the_error(void **state)
{
    size_t judged = 0, count = 0;
    (void)state;
    for (char *const *path = scenes ? scenes : quick; *path; path++, count++)
        judged += try_example(*path);
    print_message("# %zu of %zu scenes\n", judged, count);
    assert_true(judged > 0 && (scenes || judged == count));
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_are_within_the_error),
    };
    seconds = argc > 1 ? atof(argv[1]) : seconds;
    scenes  = argc > 2 ? argv + 2 : NULL;
    return cmocka_run_group_tests_name("mesh_examples", tests, NULL, NULL);
}
