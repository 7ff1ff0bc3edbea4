/*
 * drivers.c: examples on the device of the tests, held against lavapipe.
 *
 * Depths, and what is hit, must be those of lavapipe: each picture may be off by the permitted
 * error, a quarter of a pixel's width, so depths may differ by twice that.  At outlines, where
 * lavapipe's picture shows something else beside a pixel, either side may be seen; a pixel in a
 * thousand may.  Drivers round differently where Vulkan lets them, and no more is let pass.
 *
 * `make test` runs it on SwiftShader, `make test DEVICE=...` on any device.  Both take one example of
 * each kind of geometry.  Others are named as arguments; all of them take ten minutes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <glob.h>

#include "compiler/passes/compile.h"
#include "tests/support/agreement.h"
#include "tests/support/renderer.h"

enum { WIDTH = 160, HEIGHT = 90 };
static const double PERMITTED = 0.5;   /* widths of a pixel */
static const double OUTLINES  = 0.001; /* of the pixels */

static KrsRenderer *lavapipe;

/* Both devices; lavapipe against itself shows nothing. */
static bool both_are_open(void)
{
    if (!lavapipe &&
        krs_renderer_new(&(KrsRendererOptions){.device = "llvmpipe"}, &lavapipe) != KRS_OK) {
        krs_renderer_free(lavapipe);
        lavapipe = NULL;
    }
    return lavapipe &&
           strcmp(krs_renderer_device(lavapipe).name, krs_renderer_device(renderer).name) != 0;
}

static KrsPicture *render_on(KrsRenderer *on, const KrsScene *scene)
{
    KrsRenderOptions options = {
        .width      = WIDTH,
        .height     = HEIGHT,
        .aovs       = AGREEMENT_AOVS,
        .samples    = 1,
        .integrator = KRS_INTEGRATOR_PREVIEW}; /* the planes are those of any */
    KrsRendering *rendering;
    KrsState     *state;
    KrsPicture   *picture = NULL;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    if (krs_rendering_new(on, scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, state, &options, &picture) != KRS_OK)
        print_message("# %s: %s\n", krs_renderer_device(on).name, krs_renderer_message(on));
    krs_rendering_free(rendering);
    krs_state_free(state);
    assert_non_null(picture);
    return picture;
}

static bool agree(const KrsPicture *expected, const KrsPicture *picture)
{
    Agreement found = agreement_list(expected, picture, PERMITTED, stdout, "# ", 10);
    print_message("# of %zu pixels %zu show something; %zu differ at outlines, elsewhere %zu in"
                  " hits, %zu components, %zu levels, %zu instances, %zu depths; %.3f pixels at"
                  " most\n",
                  found.pixels, found.solid, found.outline, found.hits, found.components,
                  found.levels, found.instances, found.depths, found.deepest);
    return agreement_faults(&found) == 0 && found.solid > found.pixels / 10 &&
           (double)found.outline <= OUTLINES * (double)found.pixels;
}

static void an_example_agrees(void **state)
{
    KrsScene *scene;
    if (!both_are_open())
        skip();
    assert_int_equal(krs_compile_file(*state, NULL, &scene), KRS_OK);
    KrsPicture *expected = render_on(lavapipe, scene), *picture = render_on(renderer, scene);
    bool        same = agree(expected, picture);
    krs_picture_free(expected);
    krs_picture_free(picture);
    krs_scene_free(scene);
    assert_true(same);
}

/* The comparison sees a single pixel, whatever of it is wrong. */
static void a_planted_fault_is_seen(void **state)
{
    (void)state;
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .aovs = AGREEMENT_AOVS};
    KrsPicture      *a       = picture_of("show sphere(1);", &options);
    KrsPicture      *b       = picture_of("show sphere(1);", &options);
    size_t           k       = (size_t)HEIGHT / 2 * WIDTH + WIDTH / 2;
    float            depth   = b->depth[k];
    Agreement        same    = agreement_of(a, b, 0);
    assert_int_equal(agreement_faults(&same) + same.outline, 0);

    b->depth[k] *= 1.02f;
    Agreement depths = agreement_of(a, b, PERMITTED);
    assert_true(depths.depths == 1 && depths.deepest > PERMITTED);
    b->depth[k] = depth;
    b->instance[k]++;
    assert_int_equal(agreement_of(a, b, PERMITTED).instances, 1);
    b->instance[k]--;
    b->level[k]++;
    assert_int_equal(agreement_of(a, b, PERMITTED).levels, 1);
    b->level[k]--;
    b->component[k]++;
    assert_int_equal(agreement_of(a, b, PERMITTED).components, 1);
    b->component[k] = 0;
    assert_int_equal(agreement_of(a, b, PERMITTED).hits, 1);
    krs_picture_free(a);
    krs_picture_free(b);
}

static int close_both(void **state)
{
    krs_renderer_free(lavapipe);
    return renderer_close(state);
}

/* CSG, sequences, noise, forests, fractals, inversions, instance groups, polynomials, fields, outlines. */
static const char *const kinds[] = {"examples/0[1-7]*.krs", "examples/1[2-5]*.krs",
                                    "examples/2[1238]*.krs", "examples/3[05]*.krs"};

int main(int argc, char **argv)
{
    enum { MOST = 64 };
    struct CMUnitTest tests[MOST + 1] = {cmocka_unit_test(a_planted_fault_is_seen)};
    size_t            count           = 1;
    glob_t            examples        = {0};
    if (argc == 1) {
        for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
            glob(kinds[i], i ? GLOB_APPEND : 0, NULL, &examples);
        argc = (int)examples.gl_pathc + 1;
        argv = examples.gl_pathv - 1;
    }
    for (int i = 1; i < argc && count <= MOST; i++)
        tests[count++] = (struct CMUnitTest){argv[i], an_example_agrees, NULL, NULL, argv[i]};
    int failed = _cmocka_run_group_tests("drivers", tests, count, renderer_open, close_both);
    globfree(&examples);
    return failed;
}
