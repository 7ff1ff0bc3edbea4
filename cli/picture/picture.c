/*
 * picture.c: which AOV of a rendered frame is which channel of a file, and the words beside.
 */
#include "cli/picture/picture.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include <unistd.h>

#include "cli/shell/console.h"
#include "cli/picture/cryptomatte.h"
#include "cli/picture/denoised.h"
#include "cli/shell/supervise.h"
#include "runtime/writer/exr.h"
#include "runtime/writer/picture_aovs.h"
#include "runtime/writer/png.h"

enum {
    CHANNELS = AOV_CHANNELS + MATTE_CHANNELS, /* at most */
    TEXTS    = 9 + MATTE_TEXTS
};

FileForm file_form(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (dot && strcasecmp(dot, ".exr") == 0)
        return FORM_EXR;
    if (strcmp(path, STANDARD_OUTPUT) == 0)
        return FORM_PNG;
    return dot && strcasecmp(dot, ".png") == 0 ? FORM_PNG : FORM_UNKNOWN;
}

uint32_t picture_aovs(const Options *options, bool exr)
{
    return KRS_AOV_COLOR | (exr ? options->aovs : 0);
}

/* Describes every param of the scene, in its order: "radius=0.5 tint=[1, 0.5, 0]". */
static const char *describe_parameters(const Options *options, const KrsScene *scene)
{
    Text text = {.arena = options->arena};
    text_add(&text, "");
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        const double *values = parameter.value;
        for (size_t s = 0; s < options->settings.count; s++)
            if (strcmp(options->settings.items[s].name, parameter.name) == 0)
                values = options->settings.items[s].values;
        text_format(&text, "%s%s=", i == 0 ? "" : " ", parameter.name);
        if (parameter.components == 1)
            text_number(&text, values[0]);
        else
            text_json_vector(&text, values, parameter.components);
    }
    return text.bytes;
}

/* Describes the zones by centers and radii: "[0, 1, 0, 0.5] [...]". */
static const char *describe_zones(const Options *options)
{
    Text text = {.arena = options->arena};
    for (size_t i = 0; i < options->zone_count; i++) {
        text_add(&text, i == 0 ? "" : " ");
        text_json_vector(&text, options->zones[i], 4);
    }
    return text.bytes;
}

static const char *describe_number(const Options *options, double number)
{
    Text text = {.arena = options->arena};
    text_number(&text, number);
    return text.bytes;
}

static const char *describe_now(const Options *options)
{
    char      date[32];
    time_t    now = time(NULL);
    struct tm utc;
    gmtime_r(&now, &utc);
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return arena_copy_text(options->arena, date, strlen(date));
}

/* Tells whether files have an estimate of the noise, or those of the first samples do. */
static bool writes_noise(const Options *options, const KrsPicture *source)
{
    return options->samples_divided ? options->aovs != KRS_AOV_ALL && options->aovs & KRS_AOV_NOISE
                                    : source->noise && picture_aovs(options, true) & KRS_AOV_NOISE;
}

static size_t collect_texts(const Options *options, const KrsPicture *source,
                            const PictureNotes *notes, PictureText texts[TEXTS + SAMPLE_TEXTS])
{
    size_t count   = 0;
    texts[count++] = (PictureText){"software", "krs " KRS_VERSION};
    texts[count++] = (PictureText){"krs:scene", krs_scene_hash(notes->scene)};
    texts[count++] = (PictureText){"krs:parameters", describe_parameters(options, notes->scene)};
    texts[count++] = (PictureText){"krs:time", describe_number(options, notes->time)};
    if (options->zone_count > 0)
        texts[count++] = (PictureText){"krs:zones", describe_zones(options)};
    if (options->stamp) {
        texts[count++] = (PictureText){"krs:date", describe_now(options)};
        texts[count++] = (PictureText){"krs:device", source->stats.device};
        texts[count++] = (PictureText){"krs:seconds",
                                       describe_number(options, source->stats.wall_ms / 1000)};
    }
    if (options->samples_divided)
        count = samples_texts(options, source->stats.device, texts, count);
    if (writes_noise(options, source))
        texts[count++] = (PictureText){NOISE_FLOOR_TEXT,
                                       describe_number(options, (double)(float)notes->noise_floor)};
    return count;
}

typedef struct Contents {
    const Options *options;
    const Picture *picture;
    const uint8_t *rgb; /* of a PNG */
} Contents;

/* The next edit replaces the pictures of `krs watch`: nobody should wait for the disk. */
static void begin_file(const Contents *contents, OutputFile *file)
{
    if (contents->options->command == COMMAND_WATCH)
        output_is_fleeting(file);
}

static bool fill_exr(const void *user, OutputFile *file, OutputError *error)
{
    const Contents *contents = user;
    begin_file(contents, file);
    return exr_write(contents->picture, file, error);
}

static bool fill_png(const void *user, OutputFile *file, OutputError *error)
{
    const Contents *contents = user;
    begin_file(contents, file);
    return png_write(contents->picture, contents->rgb, file, error);
}

/* Adds the channels and texts of mattes, whose values are for free() afterwards. */
static bool add_mattes(const Options *options, const KrsPicture *source, const PictureNotes *notes,
                       PictureChannel *channels, PictureText *texts, Picture *picture,
                       float **values)
{
    Cryptomatte matte;
    if (!source->mattes[0])
        return true;
    if (!cryptomatte_make(options->arena, source, notes->scene, &matte))
        return false;
    memcpy(channels + picture->channel_count, matte.channels, sizeof matte.channels);
    memcpy(texts + picture->text_count, matte.texts, sizeof matte.texts);
    picture->channel_count += MATTE_CHANNELS;
    picture->text_count += MATTE_TEXTS;
    *values = matte.values;
    return true;
}

enum { CAUGHT_CHANNELS = 6 };

static void add_colors(const char *const names[3], const float (*colors)[3],
                       PictureChannel *channels, Picture *picture)
{
    for (size_t i = 0; colors && i < 3; i++)
        channels[picture->channel_count++] = (PictureChannel){
            .name = names[i], .type = SAMPLE_HALF, .samples = colors[0] + i, .stride = 3};
}

/* Adds the channels of what a plate has caught. */
static void add_caught(const Options *options, const KrsPicture *source, PictureChannel *channels,
                       Picture *picture)
{
    static const char *const caught[3]   = {"caught.R", "caught.G", "caught.B"};
    static const char *const mirrored[3] = {"mirrored.R", "mirrored.G", "mirrored.B"};
    if (!options->aovs)
        return;
    add_colors(caught, (const float(*)[3])source->caught, channels, picture);
    add_colors(mirrored, (const float(*)[3])source->mirrored, channels, picture);
}

static void add_denoised(const PictureNotes *notes, PictureChannel *channels, Picture *picture)
{
    for (size_t i = 0; notes->denoised && i < 3; i++)
        channels[picture->channel_count++] = (PictureChannel){.name    = denoised_channels[i],
                                                              .type    = SAMPLE_HALF,
                                                              .samples = notes->denoised[0] + i,
                                                              .stride  = 4};
}

static KrsStatus write_exr(const Options *options, const KrsPicture *source,
                           const PictureNotes *notes, PictureText *texts, Picture *picture,
                           const char *path)
{
    const LightGroups *groups   = &notes->groups;
    PictureChannel    *channels = arena_new_array(options->arena, PictureChannel,
                                                  CHANNELS + groups->channel_count + CAUGHT_CHANNELS +
                                                      3 + SUM_AND_NOISE_NUMBERS);
    PictureMatrix      to_camera, to_ndc;
    float             *values = NULL;
    memcpy(to_camera.m, source->world_to_camera, sizeof to_camera.m);
    memcpy(to_ndc.m, source->world_to_ndc, sizeof to_ndc.m);
    picture->channels        = channels;
    picture->channel_count   = aov_channels(source, picture_aovs(options, true), channels);
    picture->world_to_camera = options->stereo >= 0 ? NULL : &to_camera; /* there are two cameras */
    picture->world_to_ndc    = options->stereo >= 0 ? NULL : &to_ndc;
    for (size_t i = 0; i < groups->channel_count; i++)
        channels[picture->channel_count++] = groups->channels[i];
    add_caught(options, source, channels, picture);
    add_denoised(notes, channels, picture);
    if (notes->sums.numbers)
        picture->channel_count += samples_channels(&notes->sums, channels + picture->channel_count);
    if (!add_mattes(options, source, notes, channels, texts, picture, &values))
        return say_status(KRS_OUT_OF_MEMORY, path);
    KrsStatus status = write_output(path, fill_exr, &(Contents){options, picture, NULL});
    free(values);
    return status;
}

/* Returns the pixels as a screen shows them, for free(); NULL: out of memory. */
static uint8_t *screen_pixels(const KrsPicture *source, const PictureNotes *notes, size_t *length)
{
    KrsPicture shown = *source;
    *length          = (size_t)source->window.width * source->window.height * 3;
    uint8_t *rgb     = malloc(*length);
    if (notes->denoised)
        shown.color = notes->denoised[0];
    if (rgb)
        display_to_srgb8(&shown, &notes->display, 3, rgb);
    return rgb;
}

/* Writes bytes to standard output.  A reader may stop early: an encoder that has enough, or that
   failed. */
static KrsStatus write_bytes(const uint8_t *bytes, size_t length)
{
    for (size_t done = 0; done < length;) {
        ssize_t wrote = write(STDOUT_FILENO, bytes + done, length - done);
        if (*interrupted())
            return KRS_INTERRUPTED;
        if (wrote < 0 && errno != EINTR) {
            say("cannot write to standard output: %s", strerror(errno));
            return KRS_IO_ERROR;
        }
        done += wrote > 0 ? (size_t)wrote : 0;
    }
    return KRS_OK;
}

KrsStatus picture_write_raw(const KrsPicture *picture, const PictureNotes *notes)
{
    size_t   length;
    uint8_t *rgb = screen_pixels(picture, notes, &length);
    if (!rgb)
        return say_status(KRS_OUT_OF_MEMORY, "standard output");
    stage_enter(STAGE_WRITE);
    signal(SIGPIPE, SIG_IGN); /* then writing fails, which is told */
    KrsStatus status = write_bytes(rgb, length);
    free(rgb);
    return status;
}

static KrsStatus write_png(const Options *options, const KrsPicture *source, const Picture *picture,
                           const PictureNotes *notes, const char *path)
{
    size_t   length;
    uint8_t *rgb = screen_pixels(source, notes, &length);
    if (!rgb)
        return say_status(KRS_OUT_OF_MEMORY, path);
    KrsStatus status = write_output(path, fill_png, &(Contents){options, picture, rgb});
    free(rgb);
    return status;
}

KrsStatus picture_write(const Options *options, const KrsPicture *source, const PictureNotes *notes,
                        const char *path)
{
    PictureText texts[TEXTS + SAMPLE_TEXTS];
    Picture     picture = {.width       = source->width,
                           .height      = source->height,
                           .crop_x      = source->window.x,
                           .crop_y      = source->window.y,
                           .crop_width  = source->window.width,
                           .crop_height = source->window.height,
                           .texts       = texts,
                           .text_count  = collect_texts(options, source, notes, texts)};
    return file_form(path) == FORM_EXR ? write_exr(options, source, notes, texts, &picture, path)
                                       : write_png(options, source, &picture, notes, path);
}
