/*
 * tracer_fixture.c: a renderer that the validation layers watch, and a scene on it.
 */
#include "tests/unit/tracer_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/tracer/renderer.h"
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

void note_validation_message(void *user, const char *message)
{
    Fixture *fixture = user;
    fixture->validation_messages++;
    snprintf(fixture->validation_message, sizeof fixture->validation_message, "%s", message);
}

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

static void open_with(Fixture *fixture, const char *text, KrsRendererOptions options,
                      unsigned emulation)
{
    KrsOptions compiling       = {.diagnostic = print_diagnostic};
    options.device             = tested_device();
    options.validation         = true;
    options.validation_message = note_validation_message;
    options.user               = fixture;
    *fixture                   = (Fixture){0};
    KrsStatus status           = renderer_new_emulating(&options, emulation, &fixture->renderer);
    if (status != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    assert_int_equal(krs_compile_text(text, strlen(text), "test.krs", &compiling, &fixture->scene),
                     KRS_OK);
    assert_int_equal(krs_state_new(fixture->scene, &fixture->state), KRS_OK);
    if (krs_rendering_new(fixture->renderer, fixture->scene, KRS_FOR_PICTURES,
                          &fixture->rendering) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
}

void fixture_open(Fixture *fixture, const char *text, const KrsAllocator *allocator)
{
    KrsRendererOptions options = {0};
    if (allocator)
        options.allocator = *allocator;
    open_with(fixture, text, options, 0);
}

void fixture_open_as(Fixture *fixture, const char *text, unsigned emulation)
{
    open_with(fixture, text, (KrsRendererOptions){0}, emulation);
}

void fixture_close(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
    krs_renderer_free(fixture->renderer);
}

void fixture_close_watched(Fixture *fixture)
{
    assert_int_equal(krs_renderer_validation_messages(fixture->renderer), 0);
    assert_int_equal(fixture->validation_messages, 0);
    fixture_close(fixture);
}

KrsPicture *fixture_render(Fixture *fixture, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (options.width == 0) {
        options.width  = WIDTH;
        options.height = HEIGHT;
    }
    if (krs_render(fixture->rendering, fixture->state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    return picture;
}

int fixture_set_up(void **state)
{
    static Fixture fixture;
    fixture_open(&fixture, scene_text, NULL);
    *state = &fixture;
    return 0;
}

int fixture_tear_down(void **state)
{
    Fixture *fixture             = *state;
    uint64_t validation_messages = krs_renderer_validation_messages(fixture->renderer);
    fixture_close(fixture);
    if (validation_messages != 0 || fixture->validation_messages != 0)
        fprintf(stderr, "the validation layers complain: %s\n", fixture->validation_message);
    return validation_messages != 0 || fixture->validation_messages != 0;
}
