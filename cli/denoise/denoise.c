/*
 * denoise.c: `krs denoise`: a rendered picture, of any program, with less noise.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/denoise/layers.h"
#include "cli/picture/denoised.h"
#include "cli/picture/picture.h"
#include "cli/picture/sample_sums.h"
#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "runtime/writer/exr.h"
#include "runtime/writer/png.h"

typedef struct Denoising {
    const Options *options;
    AnyExr         exr;
    Layers         layers;
    float         *deviations;
    float (*result)[3];
} Denoising;

/* ---- what the file says ---- */

static const exr_attribute_t *find_attribute(const AnyExr *exr, const char *name,
                                             exr_attribute_type_t type)
{
    const exr_attribute_t *attribute;
    return exr_get_attribute_by_name(exr->context, 0, name, &attribute) == EXR_ERR_SUCCESS &&
                   attribute->type == type
               ? attribute
               : NULL;
}

static KrsStatus check_whole(const AnyExr *exr)
{
    const exr_attribute_t *samples = find_attribute(exr, SAMPLES_TEXT, EXR_ATTR_STRING);
    if (!samples)
        return KRS_OK;
    say("cannot denoise `%s`: it has samples %s alone; `krs merge` adds the others", exr->path,
        samples->string->str);
    return KRS_IO_ERROR;
}

/* Leaves out what an earlier run has added. */
static void drop_denoised(AnyExr *exr)
{
    size_t kept = 0;
    for (size_t i = 0; i < exr->count; i++) {
        bool earlier = false;
        for (int k = 0; k < 3; k++)
            earlier = earlier || strcmp(exr->channels[i].name, denoised_channels[k]) == 0;
        if (earlier)
            free(exr->planes[i]);
        else {
            exr->planes[kept]     = exr->planes[i];
            exr->channels[kept++] = exr->channels[i];
        }
    }
    exr->count = kept;
}

static const float *plane_of(const Denoising *d, LayerKind kind, int k)
{
    const int channel = d->layers.channels[kind][k];
    return channel < 0 ? NULL : d->exr.planes[channel];
}

/* Returns the number by which squares of deviations are multiplied; 0: the file does not say. */
static float scale_of_variance(const Denoising *d)
{
    const exr_attribute_t *samples = find_attribute(&d->exr, "samplesPerPixel", EXR_ATTR_INT);
    return samples && samples->i > 0 ? 1 / (float)samples->i : 0;
}

static double noise_floor(const Denoising *d)
{
    const exr_attribute_t *floor = find_attribute(&d->exr, NOISE_FLOOR_TEXT, EXR_ATTR_STRING);
    return floor ? strtod(floor->string->str, NULL) : KRS_DEFAULT_NOISE_FLOOR;
}

static bool knows_noise(const Denoising *d)
{
    return layers_have(&d->layers, LAYER_NOISE) ||
           (layers_have(&d->layers, LAYER_VARIANCE) && scale_of_variance(d) > 0);
}

/* Makes the standard deviations of colours where the file tells them. */
static KrsStatus make_deviations(Denoising *d)
{
    const size_t pixels = d->exr.width * d->exr.height;
    const double floor  = noise_floor(d);
    const float  scale  = scale_of_variance(d) / 3;
    const float *noise  = plane_of(d, LAYER_NOISE, 0);
    if (!knows_noise(d))
        return KRS_OK;
    d->deviations = malloc(pixels * sizeof *d->deviations);
    if (!d->deviations)
        return say_status(KRS_OUT_OF_MEMORY, d->exr.path);
    for (size_t i = 0; i < pixels; i++) {
        float numbers[3];
        for (int k = 0; k < 3; k++)
            numbers[k] = plane_of(d, noise ? LAYER_COLOR : LAYER_VARIANCE, k)[i];
        d->deviations[i] = noise ? denoised_deviation(noise[i], numbers[0], numbers[1], numbers[2],
                                                      floor)
                                 : sqrtf(scale * (numbers[0] + numbers[1] + numbers[2]));
    }
    return KRS_OK;
}

/* Says what would have helped. */
static void say_missing(const Denoising *d)
{
    Text text = {.arena = d->options->arena};
    text_add(&text, "");
    if (!layers_have(&d->layers, LAYER_NORMAL))
        text_add(&text, " no normals,");
    if (!layers_have(&d->layers, LAYER_ALBEDO))
        text_add(&text, " no albedo,");
    if (!layers_have(&d->layers, LAYER_POSITION) && !layers_have(&d->layers, LAYER_DEPTH))
        text_add(&text, " neither position nor depth,");
    if (text.bytes[0] && !d->options->quiet)
        say("`%s` has%s which would tell edges from noise", d->exr.path, text.bytes);
    if (!knows_noise(d) && !d->options->quiet)
        say("`%s` does not tell the noise of its pixels: it is estimated from their colours",
            d->exr.path);
}

/* ---- the result ---- */

static void add_planes(const Denoising *d, LayerKind kind, DenoisePlane planes[3])
{
    for (int k = 0; k < 3; k++)
        planes[k] = (DenoisePlane){plane_of(d, kind, k), 1};
}

static KrsStatus make_result(Denoising *d)
{
    DenoisePicture picture = {.width     = d->exr.width,
                              .height    = d->exr.height,
                              .deviation = {d->deviations, 1},
                              .depth     = {plane_of(d, LAYER_DEPTH, 0), 1}};
    add_planes(d, LAYER_COLOR, picture.color);
    add_planes(d, LAYER_NORMAL, picture.normal);
    add_planes(d, LAYER_ALBEDO, picture.albedo);
    if (layers_have(&d->layers, LAYER_NORMAL)) /* a plane has a normal */
        add_planes(d, LAYER_POSITION, picture.position);
    return denoised_make(d->options, &picture, &d->result);
}

typedef struct Contents {
    const Denoising *denoising;
    Picture          picture;
    const uint8_t   *rgb; /* of a PNG */
} Contents;

static bool fill_exr(const void *user, OutputFile *file, OutputError *error)
{
    const Contents *contents = user;
    return exr_write_like(&contents->picture, contents->denoising->exr.context, file, error);
}

static bool fill_png(const void *user, OutputFile *file, OutputError *error)
{
    const Contents *contents = user;
    return png_write(&contents->picture, contents->rgb, file, error);
}

static KrsStatus write_exr(const Denoising *d, const char *path)
{
    const AnyExr    *exr      = &d->exr;
    const SampleType type     = exr->channels[d->layers.channels[LAYER_COLOR][0]].type;
    Contents         contents = {.denoising = d,
                                 .picture   = {.crop_width    = (uint32_t)exr->width,
                                               .crop_height   = (uint32_t)exr->height,
                                               .channels      = exr->channels,
                                               .channel_count = exr->count + 3}};
    for (size_t k = 0; k < 3; k++)
        exr->channels[exr->count + k] = (PictureChannel){
            .name = denoised_channels[k], .type = type, .samples = d->result[0] + k, .stride = 3};
    return write_output(path, fill_exr, &contents);
}

static KrsStatus write_png(const Denoising *d, const char *path)
{
    const Options       *options = d->options;
    const size_t         pixels  = d->exr.width * d->exr.height;
    const uint32_t       width = (uint32_t)d->exr.width, height = (uint32_t)d->exr.height;
    const DisplayOptions display  = {.exposure = isnan(options->exposure) ? 0 : options->exposure,
                                     .tone_map = options->tone_map < 0 ? 0
                                                                       : (ToneMap)options->tone_map,
                                     .white_balance = options->white_balance};
    KrsPicture           shown    = {.width  = width,
                                     .height = height,
                                     .window = {0, 0, width, height},
                                     .color  = malloc(4 * pixels * sizeof(float))};
    uint8_t             *rgb      = malloc(3 * pixels);
    const Contents       contents = {
              .picture = {.width = width, .height = height, .crop_width = width, .crop_height = height},
              .rgb     = rgb};
    KrsStatus status = shown.color && rgb ? KRS_OK : say_status(KRS_OUT_OF_MEMORY, path);
    for (size_t i = 0; i < pixels && status == KRS_OK; i++) {
        memcpy(&shown.color[4 * i], d->result[i], sizeof d->result[i]);
        shown.color[4 * i + 3] = 1;
    }
    if (status == KRS_OK) {
        display_to_srgb8(&shown, &display, 3, rgb);
        status = write_output(path, fill_png, &contents);
    }
    free(shown.color);
    free(rgb);
    return status;
}

/* ---- the command ---- */

static KrsStatus check_outputs(Options *options)
{
    const char *input  = options->files.items[0];
    KrsStatus   status = KRS_OK;
    if (options->outputs.count == 0) {
        array_push(options->arena, &options->outputs, denoised_name(options));
    }
    for (size_t i = 0; i < options->outputs.count && status == KRS_OK; i++) {
        const char *path = options->outputs.items[i];
        if (file_form(path) == FORM_UNKNOWN)
            return say_usage(options, "the output `%s` ends in neither .exr nor .png", path);
        if (output_is_same(input, path))
            return say_usage(options, "the output `%s` is the picture that is read", path);
        status = check_output(options, path);
    }
    return status;
}

static KrsStatus read_picture(Denoising *d)
{
    KrsStatus status = any_exr_read(d->options, d->options->files.items[0], &d->exr);
    if (status == KRS_OK)
        status = check_whole(&d->exr);
    if (status != KRS_OK)
        return status;
    drop_denoised(&d->exr);
    status = layers_find(d->options, &d->exr, &d->layers);
    if (status != KRS_OK)
        return status;
    say_missing(d);
    return make_deviations(d);
}

KrsStatus command_denoise(Options *options)
{
    Denoising d      = {.options = options};
    KrsStatus status = check_outputs(options);
    if (status == KRS_OK)
        status = read_picture(&d);
    if (status == KRS_OK)
        status = make_result(&d);
    for (size_t i = 0; i < options->outputs.count && status == KRS_OK; i++) {
        const char *path = options->outputs.items[i];
        status           = file_form(path) == FORM_EXR ? write_exr(&d, path) : write_png(&d, path);
    }
    free(d.result);
    free(d.deviations);
    any_exr_free(&d.exr);
    return status;
}
