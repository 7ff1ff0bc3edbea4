/*
 * traced_scenes.c: scenes on a renderer that the validation layers watch, and pictures of them that
 * are compared bit by bit.
 */
#include "tests/unit/traced_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/device.h"

/* ---- Scenes ---- */

Scene traced_scenes[SCENES] = {
    [LANDSCAPE] = {.name = "sphere and plane",
                   .fov  = 0.7,
                   .text = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 0.7 }"
                           "show sphere(1).move([0, 1, 0]); show plane([0, 1, 0], 0);"},
    [PART]      = {.name = "blends",
                   .fov  = 0.6,
                   .text = "camera { eye: [3, 2, 3], fov: 0.6 }"
                                "show difference(union([box([1.6, 1, 1.2]), cylinder(0.5, 1.8)], blend: 0.2),"
                                "                sphere(0.6).move([0.6, 0.5, 0.5]), blend: 0.1);"
                                "show union([torus(1.2, 0.1), sphere(0.3).move([1, 0.2, 0])], blend: 0.2, "
                                "kind: \"cubic\")"
                                "    .move([0, -0.7, 0]);"},
    [CLOUD]     = {.name = "12 mirrors",
                   .fov  = 0.6,
                   .text =
                       "camera { eye: [2, 6, 22], fov: 0.6 }"
                           "show krs { kernel sphere(0.45);"
                           "    for i in 0..12 { reflect plane(random_direction(i), 0.4 + 0.22 * i); } };"},
    [GRID]      = {.name = "grid of tori",
                   .fov  = 0.6,
                   .text = "camera { eye: [3, 4, 7], fov: 0.6 }"
                                "show torus(0.5, 0.15).repeat([1.4, 0.9, 1.4], [5, 3, 5]);"},
    [INSIDE]    = {.name = "from inside",
                   .fov  = 1.2,
                   .text = "camera { eye: [0.1, 0.2, 0.3], target: [1, 0.4, 0.2], fov: 1.2 }"
                              "show box([4, 3, 5]) - sphere(0.8).move([1.5, 0, 0.2])"
                              "                   - cylinder(0.2, 9).move([1, 0, 1]);"},
    [CORAL] =
        {.name = "coral",
         .fov  = 0.6,
         .text =
             "camera { eye: [0.3, 0.8, 1.5], target: [0.05, 0.5, 0], fov: 0.6 }"
             "show krs { kernel sphere(0.2);"
             "    for i in 0..5 {"
             "        mobius translate([0, 0.42, 0]) * rotate([0, 1, 0], -1.2) * rotate([1, 0, 0], "
             "0.5);"
             "        mobius reflect(plane([0, 1, 0], 0)) * invert(center: [0, -2, 0], radius: 2);"
             "        reflect plane([1, 0, 0], 0);"
             "        kernel capsule([0, 0, 0], [0, 0.42, 0], radius: 0.085); } };"
             "show sphere(0.25).move([0.5, 0.3, 0.3]);"},
    /* The pole is in the middle of the picture. */
    [LATTICE] =
        {.name = "lattice in a sphere",
         .fov  = 0.6,
         .text = "camera { eye: [0.2, 0.3, 3], fov: 0.6 }"
                 "show krs { kernel sphere(0.35); kernel box([1, 0.3, 0.3]);"
                 "    for i in 0..2 { reflect plane([1, 0, 0], 2 ^ i - 0.5);"
                 "        reflect plane([0, 1, 0], 2 ^ i - 0.5); reflect plane([0, 0, 1], 2 ^ i - "
                 "0.5); }"
                 "    mobius scale(1.2) * invert(radius: 1) * translate([-1.5, -1.5, 0.7]); };"},
};

bool is_spared(const Scene *scene, KrsTrace trace)
{
    bool inverts = scene == &traced_scenes[CORAL] || scene == &traced_scenes[LATTICE];
    return scene != &traced_scenes[LANDSCAPE] &&
           (inverts ? trace >= KRS_TRACE_EXACT && trace < KRS_TRACE_DIRECTIONAL
                    : trace >= KRS_TRACE_DIRECTIONAL);
}

KrsRenderer *watched_renderer;

static char validation_message[2048]; /* the last */

static void note_validation_message(void *user, const char *message)
{
    (void)user;
    snprintf(validation_message, sizeof validation_message, "%s", message);
}

KrsStatus open_scene(Scene *scene)
{
    const KrsOptions options = {.research = true};
    KrsStatus status = krs_compile_text(scene->text, strlen(scene->text), scene->name, &options,
                                        &scene->scene);
    if (status == KRS_OK)
        status = krs_state_new(scene->scene, &scene->state);
    if (status == KRS_OK)
        status = krs_rendering_new(watched_renderer, scene->scene, KRS_FOR_PICTURES,
                                   &scene->rendering);
    return status;
}

void close_scene(Scene *scene)
{
    krs_rendering_free(scene->rendering);
    krs_state_free(scene->state);
    krs_scene_free(scene->scene);
}

static int tell_failure(KrsStatus status)
{
    if (status != KRS_OK && watched_renderer)
        fprintf(stderr, "status %d: %s\n", (int)status, krs_renderer_message(watched_renderer));
    return status != KRS_OK;
}

int open_watched(void **state)
{
    (void)state;
    KrsRendererOptions options = {.device             = tested_device(),
                                  .validation         = true,
                                  .validation_message = note_validation_message};
    return tell_failure(krs_renderer_new(&options, &watched_renderer));
}

int close_watched(void **state)
{
    (void)state;
    krs_renderer_free(watched_renderer);
    return 0;
}

int open_scenes(void **state)
{
    KrsStatus status = KRS_OK;
    if (open_watched(state) != 0)
        return 1;
    for (int i = 0; i < SCENES && status == KRS_OK; i++)
        status = open_scene(&traced_scenes[i]);
    return tell_failure(status);
}

int close_scenes(void **state)
{
    for (int i = 0; i < SCENES; i++)
        close_scene(&traced_scenes[i]);
    return close_watched(state);
}

int hear_layers(void **state)
{
    (void)state;
    if (krs_renderer_validation_messages(watched_renderer) != 0)
        fprintf(stderr, "the validation layers complain: %s\n", validation_message);
    return krs_renderer_validation_messages(watched_renderer) != 0;
}

/* ---- Pictures ---- */

KrsPicture *render_scene(const Scene *scene, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (options.width == 0) {
        options.width  = WIDTH;
        options.height = HEIGHT;
    }
    if (krs_render(scene->rendering, scene->state, &options, &picture) != KRS_OK)
        fail_msg("%s: %s", scene->name, krs_renderer_message(watched_renderer));
    if (options.methods.max_steps == 0)
        assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

static const struct Plane {
    const char *name;
    size_t      offset, bytes; /* of the pointer in a KrsPicture; of a pixel */
} planes[] = {
    {"color", offsetof(KrsPicture, color), 4 * sizeof(float)},
    {"depth", offsetof(KrsPicture, depth), sizeof(float)},
    {"position", offsetof(KrsPicture, position), 3 * sizeof(float)},
    {"normal", offsetof(KrsPicture, normal), 3 * sizeof(float)},
    {"albedo", offsetof(KrsPicture, albedo), 3 * sizeof(float)},
    {"component", offsetof(KrsPicture, component), sizeof(uint32_t)},
    {"level", offsetof(KrsPicture, level), sizeof(uint32_t)},
    {"instance", offsetof(KrsPicture, instance), sizeof(uint32_t)},
    {"steps", offsetof(KrsPicture, steps), sizeof(uint32_t)},
};

/* Returns a row of a plane, from pixel (x, y) of the whole picture on. */
static const char *plane_row(const KrsPicture *picture, const struct Plane *plane, uint32_t x,
                             uint32_t y)
{
    const char      *bytes;
    const KrsWindow *window = &picture->window;
    memcpy(&bytes, (const char *)picture + plane->offset, sizeof bytes);
    assert_non_null(bytes);
    return bytes + ((size_t)(y - window->y) * window->width + x - window->x) * plane->bytes;
}

bool is_part_of(const Scene *scene, const KrsPicture *whole, KrsPicture *part, const char *what)
{
    const KrsWindow w    = part->window;
    size_t          rows = 0;
    const char     *name = NULL;
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++)
        for (uint32_t y = w.y; y < w.y + w.height; y++)
            if (memcmp(plane_row(whole, &planes[i], w.x, y), plane_row(part, &planes[i], w.x, y),
                       w.width * planes[i].bytes) != 0) {
                rows++;
                name = planes[i].name;
            }
    if (rows > 0)
        print_message("# %s: %s changes %zu rows of planes, in %s\n", scene->name, what, rows,
                      name);
    krs_picture_free(part);
    return rows == 0;
}

const char *words(const KrsRenderOptions *options)
{
    static char     text[200];
    const KrsWindow crop   = options->crop;
    int             length = snprintf(
                    text, sizeof text, "%s, %s, beams %s", krs_trace_names[options->methods.trace],
                    krs_schedule_names[options->methods.schedule], options->methods.no_beams ? "off" : "on");
    if (options->samples > 1 || crop.width > 0 || options->methods.steps_at_once > 0)
        snprintf(text + length, sizeof text - (size_t)length,
                 ", %u samples, from (%u, %u) %u by %u, %u steps at once, %g ms", options->samples,
                 crop.x, crop.y, crop.width, crop.height, options->methods.steps_at_once,
                 options->slice_ms);
    return text;
}
