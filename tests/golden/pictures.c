/*
 * pictures.c: a line for each picture of scenes, under every method, schedule, way with components and
 * stencil of normals: `SCENE OPTION=NAME PLANE HASH PLANE HASH ...`.
 *
 *     pictures SCENE.krs...
 *
 * A change that should not be seen leaves all lines as they are (tests/golden/pictures.sh).
 */
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

#include "krs/krs.h"
#include "krs/vulkan.h"

enum { WIDTH = 192, HEIGHT = 108, PIXELS = WIDTH * HEIGHT };

typedef struct Show {
    const char   *path;
    KrsRenderer  *renderer;
    KrsRendering *rendering;
    KrsState     *state;
    bool          failed;
} Show;

static void render(Show *show, const char *option, const char *name,
                   const KrsRenderOptions *options)
{
    KrsPicture *picture;
    if (krs_render(show->rendering, show->state, options, &picture) != KRS_OK) {
        /* Such as analytic normals of a scene without derivatives. */
        printf("%s %s=%s: %s\n", show->path, option, name, krs_renderer_message(show->renderer));
        return;
    }
    const struct {
        const char *name;
        const void *numbers;
        size_t      each;
    } planes[] = {
        {"color", picture->color, 16},   {"position", picture->position, 12},
        {"depth", picture->depth, 4},    {"normal", picture->normal, 12},
        {"albedo", picture->albedo, 12}, {"component", picture->component, 4},
        {"level", picture->level, 4},    {"instance", picture->instance, 4},
        {"steps", picture->steps, 4},
    };
    printf("%s %s=%s", show->path, option, name);
    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++)
        printf(" %s %08x", planes[i].name,
               (unsigned)XXH3_64bits(planes[i].numbers, planes[i].each * PIXELS));
    putchar('\n');
    krs_picture_free(picture);
}

/* All of one option after the other, with the defaults of the others. */
static void render_all(Show *show)
{
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1};
    for (int i = 0; i < KRS_TRACE_COUNT; i++, options.methods.trace = (KrsTrace)i)
        render(show, "trace", krs_trace_names[i], &options);
    options.methods.trace = KRS_TRACE_DEFAULT;
    for (int i = 1; i < KRS_SCHEDULE_COUNT; i++) {
        options.methods.schedule = (KrsSchedule)i;
        render(show, "schedule", krs_schedule_names[i], &options);
    }
    options.methods.schedule = KRS_SCHEDULE_DEFAULT;
    for (int i = 1; i < KRS_COMPONENTS_COUNT; i++) {
        options.methods.components = (KrsComponents)i;
        render(show, "components", krs_components_names[i], &options);
    }
    options.methods.components = KRS_COMPONENTS_DEFAULT;
    for (int i = 1; i < KRS_NORMALS_COUNT; i++) {
        options.methods.normals = (KrsNormals)i;
        render(show, "normals", krs_normals_names[i], &options);
    }
}

static bool show_scene(KrsRenderer *renderer, const char *path)
{
    Show             show    = {.path = path, .renderer = renderer};
    const KrsOptions options = {.research = true};
    KrsScene        *scene;
    bool             good = krs_compile_file(path, &options, &scene) == KRS_OK &&
                krs_state_new(scene, &show.state) == KRS_OK &&
                krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &show.rendering) == KRS_OK;
    if (good)
        render_all(&show);
    else
        fprintf(stderr, "pictures: %s cannot be rendered\n", path);
    krs_rendering_free(show.rendering);
    krs_state_free(show.state);
    krs_scene_free(scene);
    return good;
}

int main(int count, char **words)
{
    KrsRenderer *renderer;
    bool         good = krs_renderer_new(NULL, &renderer) == KRS_OK;
    if (!good)
        fprintf(stderr, "pictures: %s\n", krs_renderer_message(renderer));
    for (int i = 1; i < count && good; i++)
        good = show_scene(renderer, words[i]);
    krs_renderer_free(renderer);
    return good ? 0 : 1;
}
