/*
 * subject.c: scenes through the C interface, as another program would use it.
 */
#include "bench/subject.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a picture is asked for: what a hand-written shader writes as well. */
enum { AOVS = KRS_AOV_COLOR | KRS_AOV_DEPTH };

static void hear_message(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fprintf(stderr, "%s\n", diagnostic->text);
}

/* Returns the scene with another number of levels. */
static char *with_levels(Bench *bench, const char *text, const char *path, uint32_t levels)
{
    static const char before[] = "\nlet levels = ";
    const char       *place    = strstr(text, before);
    if (!place)
        fail("%s has no levels to be changed", path);
    place += sizeof before - 1;
    Text changed = {.arena = bench->arena};
    text_add_bytes(&changed, text, (size_t)(place - text));
    text_format(&changed, "%u", levels);
    text_add(&changed, strchr(place, ';'));
    return changed.bytes;
}

void subject_open(Bench *bench, Subject *subject, const char *path, uint32_t levels)
{
    *subject   = (Subject){0};
    char *text = read_file(bench->arena, path);
    if (levels > 0)
        text = with_levels(bench, text, path, levels);
    KrsOptions options = {.diagnostic = hear_message, .research = true};
    if (krs_compile_text(text, strlen(text), path, &options, &subject->scene) != KRS_OK)
        fail("%s does not compile", path);
    if (krs_state_new(subject->scene, &subject->state) != KRS_OK ||
        krs_state_view(subject->state, 0, &subject->view) != KRS_OK)
        fail("%s: out of memory", path);
    if (krs_rendering_new(bench->renderer, subject->scene, KRS_FOR_PICTURES, &subject->rendering) !=
        KRS_OK)
        fail("%s: %s", path, krs_renderer_message(bench->renderer));
    subject->program = krs_scene_program(subject->scene);
    subject->pixel   = 2 * tan(subject->view.camera.fov / 2) / bench->height;
}

void subject_close(Subject *subject)
{
    krs_rendering_free(subject->rendering);
    krs_state_free(subject->state);
    krs_scene_free(subject->scene);
    *subject = (Subject){0};
}

static KrsPicture *render(Bench *bench, Subject *subject, KrsRenderOptions options)
{
    KrsPicture *picture;
    options.width  = bench->width;
    options.height = bench->height;
    options.aovs   = AOVS;
    if (krs_render(subject->rendering, subject->state, &options, &picture) != KRS_OK)
        fail("cannot render: %s", krs_renderer_message(bench->renderer));
    return picture;
}

static void take_image(const KrsPicture *picture, Image *image)
{
    if (!image_create(image, picture->width, picture->height))
        fail("out of memory");
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        image->alpha[i] = picture->color[4 * i + 3];
        image->depth[i] = picture->depth[i];
    }
}

Times subject_render(Bench *bench, Subject *subject, const KrsRenderOptions *options,
                     KrsRenderStats *stats, Image *image)
{
    double      start = clock_ms(), used = cpu_ms();
    KrsPicture *picture = render(bench, subject, *options);
    Times       times   = {.cpu = cpu_ms() - used, .wall = clock_ms() - start};
    memcpy(times.phase, picture->stats.phase_ms, sizeof times.phase);
    times.total = picture->stats.total_ms;
    if (stats)
        *stats = picture->stats;
    if (image)
        take_image(picture, image);
    krs_picture_free(picture);
    return times;
}

void subject_prewarm(Bench *bench, Subject *subject, const KrsRenderOptions *options,
                     KrsRenderStats *stats)
{
    KrsRenderOptions third = *options;
    third.crop             = (KrsWindow){0, bench->height / 3, bench->width, bench->height / 3};
    KrsPicture *picture    = render(bench, subject, third);
    *stats                 = picture->stats;
    krs_picture_free(picture);
}
