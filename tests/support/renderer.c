/*
 * renderer.c: the renderer that all tests of a program share.
 */
#include "tests/support/renderer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/device.h"

KrsRenderer *renderer;

int renderer_open(void **state)
{
    (void)state;
    spirv_start();
    KrsRendererOptions options = {.device = tested_device()};
    KrsStatus          status  = krs_renderer_new(&options, &renderer);
    if (status != KRS_OK && renderer)
        fprintf(stderr, "%s\n", krs_renderer_message(renderer));
    return status != KRS_OK;
}

int renderer_close(void **state)
{
    (void)state;
    krs_renderer_free(renderer);
    renderer = NULL;
    spirv_stop();
    return 0;
}

KrsPicture *picture_of(const char *text, const KrsRenderOptions *options)
{
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    KrsPicture   *picture;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_render(rendering, state, options, &picture), KRS_OK);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
    return picture;
}
