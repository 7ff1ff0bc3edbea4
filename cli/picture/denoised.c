/*
 * denoised.c: the colours of a rendered frame with less noise.
 */
#include "cli/picture/denoised.h"

#include <stdlib.h>

#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

const char *const denoised_channels[3] = {"denoised.R", "denoised.G", "denoised.B"};

KrsStatus denoised_check(const Options *options, bool light_groups)
{
    if (options->how.crop.width > 0 || options->samples_divided)
        return say_usage(options, "--denoise needs all of a picture: render the parts without it, "
                                  "and `krs denoise` what `krs merge` makes of them");
    if (options->stereo >= 0)
        return say_usage(options, "--denoise would mix the two pictures of --stereo");
    if (light_groups)
        return say_usage(options, "--light-groups have no estimate of their noise, which --denoise "
                                  "takes");
    return KRS_OK;
}

typedef struct Denoising {
    Progress progress;
    bool     shown;
} Denoising;

static bool report(void *user, double fraction)
{
    Denoising *denoising = user;
    stage_note_progress();
    if (denoising->shown)
        progress_show(&denoising->progress, fraction);
    return !*interrupted();
}

KrsStatus denoised_make(const Options *options, const DenoisePicture *picture, float (**colors)[3])
{
    Denoising denoising = {.shown = options->command == COMMAND_DENOISE};
    *colors             = malloc(picture->width * picture->height * sizeof **colors);
    stage_enter(STAGE_DENOISE);
    if (denoising.shown)
        progress_start(&denoising.progress, options, 1);
    KrsStatus status = *colors ? denoise(picture, report, &denoising, *colors) : KRS_OUT_OF_MEMORY;
    if (denoising.shown)
        progress_end(&denoising.progress);
    if (status != KRS_OK) {
        free(*colors);
        *colors = NULL;
    }
    return status == KRS_OUT_OF_MEMORY ? say_status(status, options->files.items[0]) : status;
}

/* Makes the standard deviations of the colours' errors. */
static float *make_deviations(const KrsPicture *picture, double floor)
{
    const size_t pixels     = (size_t)picture->window.width * picture->window.height;
    float       *deviations = malloc(pixels * sizeof *deviations);
    for (size_t i = 0; deviations && i < pixels; i++) {
        const float *color = &picture->color[4 * i];
        deviations[i] = denoised_deviation(picture->noise[i], color[0], color[1], color[2], floor);
    }
    return deviations;
}

static void add_planes(DenoisePlane planes[3], const float *samples, size_t stride)
{
    for (size_t k = 0; k < 3; k++)
        planes[k] = (DenoisePlane){samples + k, stride};
}

KrsStatus denoised_frame(const Options *options, const KrsPicture *picture, double noise_floor,
                         float (**colors)[4])
{
    const size_t   pixels     = (size_t)picture->window.width * picture->window.height;
    float         *deviations = make_deviations(picture, noise_floor);
    DenoisePicture source     = {.width     = picture->window.width,
                                 .height    = picture->window.height,
                                 .deviation = {deviations, 1},
                                 .depth     = {picture->depth, 1}};
    float(*result)[3]         = NULL;
    add_planes(source.color, picture->color, 4);
    add_planes(source.normal, picture->normal, 3);
    add_planes(source.albedo, picture->albedo, 3);
    add_planes(source.position, picture->position, 3);
    *colors          = malloc(pixels * sizeof **colors);
    KrsStatus status = deviations && *colors
                           ? denoised_make(options, &source, &result)
                           : say_status(KRS_OUT_OF_MEMORY, options->files.items[0]);
    for (size_t i = 0; status == KRS_OK && i < pixels; i++) {
        for (int k = 0; k < 3; k++)
            (*colors)[i][k] = result[i][k];
        (*colors)[i][3] = picture->color[4 * i + 3];
    }
    free(result);
    free(deviations);
    if (status != KRS_OK) {
        free(*colors);
        *colors = NULL;
    }
    return status;
}
