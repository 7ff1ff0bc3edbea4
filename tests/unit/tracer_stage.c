/*
 * tracer_stage.c: a renderer that the validation layers watch, and a scene on it.
 */
#include "tests/unit/tracer_stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/device.h"

#define assert_near(value, expected, within) assert_true(fabs((value) - (expected)) <= (within))
const char scene_text[] =
    "param size = 1 in [0.1, 1.5];\n"
    "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
    "camera flat { eye: [-2, 3, 4], target: [0.3, 0.2, -0.1],\n"
    "              projection: \"orthographic\", height: 3 }\n"
    "camera round { eye: [2, 0.5, 1], target: [0, 0, 0], projection: \"panorama\" }\n"
    "camera inner { eye: [0.2, 0.1, -0.3], target: [0, 1, 0], up: [0, 0, 1], fov: 60deg }\n"
    "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }\n"
    "show sphere(size).move([0.3, 0.2, -0.1]);\n";

const char landscape_text[] = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
                              "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }\n"
                              "show sphere(1).move([0, 1, 0]);\n"
                              "show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);\n"
                              "show plane([0, 1, 0], 0);\n";

const double CENTRE[3] = {0.3, 0.2, -0.1};

void note_complaint(void *user, const char *message)
{
    Stage *stage = user;
    stage->complaints++;
    snprintf(stage->complaint, sizeof stage->complaint, "%s", message);
}

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

static void open_with(Stage *stage, const char *text, KrsRendererOptions options)
{
    KrsOptions compiling = {.diagnostic = print_diagnostic};
    options.device       = tested_device();
    options.validation   = true;
    options.complaint    = note_complaint;
    options.user         = stage;
    *stage               = (Stage){0};
    KrsStatus status     = krs_renderer_new(&options, &stage->renderer);
    if (status != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage->renderer));
    assert_int_equal(krs_compile_text(text, strlen(text), "test.krs", &compiling, &stage->scene),
                     KRS_OK);
    assert_int_equal(krs_frame_new(stage->scene, &stage->frame), KRS_OK);
    if (krs_rendering_new(stage->renderer, stage->scene, &stage->rendering) != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage->renderer));
}

void stage_open(Stage *stage, const char *text, const KrsAllocator *allocator)
{
    KrsRendererOptions options = {0};
    if (allocator)
        options.allocator = *allocator;
    open_with(stage, text, options);
}

void stage_open_as(Stage *stage, const char *text, unsigned pretence)
{
    open_with(stage, text, (KrsRendererOptions){.pretence = pretence});
}

void stage_close(Stage *stage)
{
    krs_rendering_free(stage->rendering);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
    krs_renderer_free(stage->renderer);
}

void stage_close_watched(Stage *stage)
{
    assert_int_equal(krs_renderer_complaints(stage->renderer), 0);
    assert_int_equal(stage->complaints, 0);
    stage_close(stage);
}

KrsPicture *stage_render(Stage *stage, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (options.width == 0) {
        options.width  = WIDTH;
        options.height = HEIGHT;
    }
    if (krs_render(stage->rendering, stage->frame, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage->renderer));
    return picture;
}

int stage_set_up(void **state)
{
    static Stage stage;
    stage_open(&stage, scene_text, NULL);
    *state = &stage;
    return 0;
}

int stage_tear_down(void **state)
{
    Stage   *stage      = *state;
    uint64_t complaints = krs_renderer_complaints(stage->renderer);
    stage_close(stage);
    if (complaints != 0 || stage->complaints != 0)
        fprintf(stderr, "the validation layers complain: %s\n", stage->complaint);
    return complaints != 0 || stage->complaints != 0;
}
