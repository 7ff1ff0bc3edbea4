/*
 * instance_pictures.c: pictures of scenes with instance groups are pictures of the same parts apart.
 *
 * Both are as deep as the permitted error says; rays that graze something may hit it in one of them
 * only.
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
#include "compiler/passes/inspect.h"
#include "runtime/tracer/query.h"
#include "tests/support/instance_texts.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

enum {
    WIDTH    = 400,
    HEIGHT   = 240,
    PIXELS   = WIDTH * HEIGHT,
    SEED     = 23,
    SAMPLED  = 256,
    LEAST    = 16,
    TOGETHER = 3
};

/* Without colours, there are no shaders for light. */
enum { SHOWN = KRS_AOV_DEPTH | KRS_AOV_NORMAL | KRS_AOV_ALBEDO | KRS_AOV_IDS };

typedef struct Seen {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    KrsPicture   *picture;
} Seen;

static void look(Seen *seen, const InstanceText *scenes, size_t count, bool apart)
{
    char            *text    = instance_text(scenes, count, SEED);
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1, .aovs = SHOWN};
    KrsStatus status = compile_with_instances(text, strlen(text), apart ? UINT32_MAX : LEAST, NULL,
                                              &seen->scene);
    free(text);
    assert_int_equal(status, KRS_OK);
    assert_int_equal(krs_state_new(seen->scene, &seen->state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, seen->scene, KRS_FOR_PICTURES, &seen->rendering),
                     KRS_OK);
    if (krs_render(seen->rendering, seen->state, &options, &seen->picture) != KRS_OK)
        fail_msg("%s: %s", scenes->name, krs_renderer_message(renderer));
}

static void forget(Seen *seen)
{
    krs_picture_free(seen->picture);
    krs_rendering_free(seen->rendering);
    krs_state_free(seen->state);
    krs_scene_free(seen->scene);
}

/* ---- pictures ---- */

/* Pixels where something else is hit, or nothing; and of the others those with another depth or
   shading. */
typedef struct Different {
    int    hits, depths, shadings, covered;
    double mean; /* difference of shading */
} Different;

static bool is_hit(const KrsPicture *picture, int pixel) { return picture->component[pixel] != 0; }

/* Returns the largest difference of normals and of albedos. */
static double shading_difference(const KrsPicture *a, const KrsPicture *b, int pixel)
{
    double most = 0;
    for (int k = 3 * pixel; k < 3 * pixel + 3; k++) {
        most = fmax(most, fabs((double)a->normal[k] - (double)b->normal[k]));
        most = fmax(most, fabs((double)a->albedo[k] - (double)b->albedo[k]));
    }
    return most;
}

static Different compare(const KrsPicture *apart, const KrsPicture *group)
{
    Different found = {0};
    for (int i = 0; i < PIXELS; i++) {
        double shading = shading_difference(apart, group, i);
        found.covered += is_hit(apart, i);
        found.mean += shading / PIXELS;
        if (is_hit(apart, i) != is_hit(group, i) || apart->instance[i] != group->instance[i])
            found.hits++;
        else if (is_hit(apart, i)) {
            double depth = (double)apart->depth[i];
            found.depths += !(fabs((double)group->depth[i] - depth) < 2e-3 * depth);
            found.shadings += !(shading < 0.05);
        }
    }
    return found;
}

/* One pixel in 500 may graze something, and one in 25 be shaded otherwise: where parts have the size of
   pixels, taps for normals are as far from surfaces as the clearance. */
static bool are_same(const Different *d)
{
    return d->covered > 200 && d->hits + d->depths <= 1 + d->covered / 500 &&
           d->shadings <= d->covered / 25 && d->mean < 1e-3;
}

static void pictures_are_as_apart(void **context)
{
    (void)context;
    for (size_t i = 0; i < PICTURED_GROUPS; i += TOGETHER) {
        Seen apart, group;
        look(&apart, &instance_texts[i], TOGETHER, true);
        look(&group, &instance_texts[i], TOGETHER, false);
        Different d = compare(apart.picture, group.picture);
        if (!are_same(&d))
            fail_msg("from %s: of %d pixels %d hits, %d depths, %d shadings, mean %.1e",
                     instance_texts[i].name, d.covered, d.hits, d.depths, d.shadings, d.mean);
        forget(&apart);
        forget(&group);
    }
}

/* ---- queries ---- */

/* Far from all parts the distance on the device may be less, and has a normal of length 0 or 1. */
static void answers_of_the_device_are_bounds(void **context)
{
    static double       points[SAMPLED][3], wanted[SAMPLED];
    static float        places[SAMPLED][3], sampled[SAMPLED];
    static SurfacePoint surfaces[SAMPLED];
    static KrsHit       hits[SAMPLED];
    Random              random = {SEED};
    Seen                seen;
    int                 less = 0, flat = 0;
    (void)context;
    look(&seen, &instance_texts[0], 1, false);
    for (int i = 0; i < SAMPLED * 3; i++)
        points[i / 3][i % 3] = places[i / 3][i % 3] = (float)random_between(&random, -2, 2);
    assert_int_equal(krs_distance(seen.state, (const double(*)[3])points, SAMPLED, wanted), KRS_OK);
    assert_int_equal(point_query_sample(seen.rendering, seen.state, (const float(*)[3])places,
                                        SAMPLED, sampled, surfaces),
                     KRS_OK);
    assert_int_equal(
        krs_device_probe(seen.rendering, seen.state, (const double(*)[3])points, SAMPLED, hits),
        KRS_OK);
    for (int i = 0; i < SAMPLED; i++) {
        double length = length3(hits[i].normal);
        assert_true((double)sampled[i] < wanted[i] + 1e-5 && hits[i].distance < wanted[i] + 1e-5);
        assert_true((sampled[i] > 0) == (wanted[i] > 0));
        assert_true(length == 0 || fabs(length - 1) < 1e-5);
        for (int k = 0; k < 3; k++)
            assert_true(isfinite(hits[i].shading[k]) && isfinite(surfaces[i].normal[k]) &&
                        isfinite(surfaces[i].color[k]));
        less += (double)sampled[i] < wanted[i] - 1e-3;
        flat += length == 0;
    }
    assert_in_range(less, 1, SAMPLED - 1);
    assert_in_range(flat, 1, less);
    forget(&seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_as_apart),
        cmocka_unit_test(answers_of_the_device_are_bounds),
    };
    return cmocka_run_group_tests_name("pictures of instance groups", tests, renderer_open,
                                       renderer_close);
}
