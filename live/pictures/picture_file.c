/*
 * picture_file.c: pictures as files, in the forms of `krs render`.
 */
#include "live/pictures/picture_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "runtime/writer/exr.h"
#include "runtime/writer/picture_aovs.h"
#include "runtime/writer/png.h"

static bool write_exr(Picture *file, const KrsPicture *picture, OutputFile *output,
                      OutputError *error)
{
    PictureChannel channels[AOV_CHANNELS];
    PictureMatrix  to_camera, to_ndc;
    memcpy(to_camera.m, picture->world_to_camera, sizeof to_camera.m);
    memcpy(to_ndc.m, picture->world_to_ndc, sizeof to_ndc.m);
    file->channels        = channels;
    file->channel_count   = aov_channels(picture, UINT32_MAX, channels);
    file->world_to_camera = &to_camera;
    file->world_to_ndc    = &to_ndc;
    return exr_write(file, output, error);
}

static bool write_png(const Picture *file, const KrsPicture *picture, const View *view,
                      OutputFile *output, OutputError *error)
{
    uint8_t *rgb  = malloc((size_t)picture->window.width * picture->window.height * 3);
    bool     done = rgb &&
                krs_picture_to_srgb8(picture, version_scene(view->version), view->stops, 3, rgb) ==
                    KRS_OK &&
                png_write(file, rgb, output, error);
    if (!rgb)
        error->status = KRS_OUT_OF_MEMORY;
    free(rgb);
    return done;
}

KrsStatus picture_file_write(const KrsPicture *picture, const View *view, const char *path,
                             char why[300])
{
    const char       *dot      = strrchr(path, '.');
    char              time[32] = "";
    OutputError       error    = {.status = KRS_OK};
    OutputFile       *output   = output_open(path, NULL, &error);
    const PictureText texts[]  = {{"software", "krs " KRS_VERSION}, {"krs:time", time}};
    Picture           file     = {.width       = picture->width,
                                  .height      = picture->height,
                                  .crop_width  = picture->window.width,
                                  .crop_height = picture->window.height,
                                  .texts       = texts,
                                  .text_count  = 2};
    snprintf(time, sizeof time, "%.9g", view->time);
    const bool as_exr  = dot && strcasecmp(dot, ".exr") == 0;
    const bool written = output && (as_exr ? write_exr(&file, picture, output, &error)
                                           : write_png(&file, picture, view, output, &error));
    if (written)
        output_commit(output);
    else if (output)
        output_abandon(output);
    snprintf(why, 300, "%.299s", error.message[0] ? error.message : "out of memory");
    return error.status;
}
