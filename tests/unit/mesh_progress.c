/* mesh_progress.c: what is told while meshes are made and simplified, and what stops that. */
#include <math.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/unit/queried.h"

/* What was told. */
typedef struct Told {
    size_t count, most; /* it is stopped after the most */
    double last, largest_step;
} Told;

static bool hear(void *user, double fraction)
{
    Told *told = user;
    assert_true(fraction >= told->last && fraction <= 1);
    told->largest_step = fmax(told->largest_step, fraction - told->last);
    told->last         = fraction;
    return ++told->count < told->most;
}

static const char *const text = "show difference(union(box([1, 0.3, 0.8]).round(0.05), "
                                "cylinder(0.3, 0.8), blend: 0.15), cylinder(0.15, 2));";

/* One thread does all: among several, the one that tells may not come to it. */
static void work_in_one_thread(void)
{
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (size_t i = 0; CPU_COUNT(&one) == 0; i++)
        if (CPU_ISSET(i, &all))
            CPU_SET(i, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
}

static void work_goes_on_in_small_steps(void **state)
{
    Scene          s       = scene_of(text);
    Told           told    = {.most = SIZE_MAX};
    KrsMeshOptions options = {.error = 0.02, .progress = hear, .user = &told};
    KrsMesh       *mesh, *few;
    (void)state;
    work_in_one_thread();
    assert_int_equal(krs_mesh(s.state, &options, &mesh), KRS_OK);
    assert_true(told.count > 10 && told.last > 0.7 && told.largest_step < 0.5);
    told = (Told){.most = SIZE_MAX};
    assert_int_equal(krs_mesh_simplify(mesh, &options, &few), KRS_OK);
    assert_true(told.count > 10 && told.last > 0.7 && told.largest_step <= 0.5);
    krs_mesh_free(few);
    krs_mesh_free(mesh);
    scene_close(s);
}

static void simplifying_is_stopped(void **state)
{
    Scene          s       = scene_of(text);
    KrsMeshOptions options = {.error = 0.02};
    KrsMesh       *mesh, *few;
    (void)state;
    assert_int_equal(krs_mesh(s.state, &options, &mesh), KRS_OK);
    options.progress = hear;
    for (size_t most = 1; most < 40; most += 13) {
        Told told    = {.most = most};
        options.user = &told;
        assert_int_equal(krs_mesh_simplify(mesh, &options, &few), KRS_INTERRUPTED);
        assert_null(few);
        assert_int_equal(told.count, most);
    }
    krs_mesh_free(mesh);
    scene_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(work_goes_on_in_small_steps),
        cmocka_unit_test(simplifying_is_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
