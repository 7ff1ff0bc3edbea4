/*
 * minify.c: how well a pixel shows what is far smaller than a pixel.
 *
 * Pictures of one and four samples, as they are and without the filtering of surfaces, are held
 * against pictures of many samples without filtering: errors in what a screen shows, and flicker
 * over a short flight; what filtering costs; and what a wider filter of pixels would do.
 * bench/minify/README.md says what the columns mean.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/measure.h"
#include "bench/minify/pixel_filter.h"
#include "bench/sheet.h"
#include "bench/fixture.h"
#include "compiler/passes/compile.h"
#include "compiler/base/srgb.h"
#include "runtime/display/display.h"
#include "krs/vulkan.h"

enum { WIDTH = 320, HEIGHT = 180, PIXELS = WIDTH * HEIGHT, FRAMES = 3 };

static const struct Flight {
    const char *name, *path, *camera; /* the camera moves with `time`, one unit a frame */
} flights[] = {
#define FLIGHT(name, path, camera) {name, path, camera},
#include "bench/minify/flights.def"
#undef FLIGHT
};
enum { FLIGHTS = sizeof flights / sizeof *flights };

/* What is compared: samples, and whether surfaces are filtered. */
static const struct Setting {
    uint32_t samples;
    bool     plain;
} settings[] = {{1, true}, {1, false}, {4, false}};
enum { SETTINGS = sizeof settings / sizeof *settings };

typedef struct Shot {
    double color[PIXELS][3]; /* as a screen shows it, 0 to 255 */
    double linear[PIXELS][3];
    double alpha[PIXELS];
    double ms; /* normals, materials, shadows, occlusion, light */
} Shot;

static Sheet sheet;

/* Returns the scene's text with another camera. */
static char *text_of(const struct Flight *flight)
{
    static char text[20000];
    FILE       *file = fopen(flight->path, "rb");
    if (!file)
        give_up(flight->path, "cannot read it");
    size_t length = fread(text, 1, sizeof text - 1000, file);
    fclose(file);
    text[length] = '\0';
    char *camera = strstr(text, "\ncamera {");
    char *end    = camera ? strchr(camera, '}') : NULL;
    if (!end)
        give_up(flight->path, "it has no camera");
    memset(camera, ' ', (size_t)(end - camera) + 1);
    strcat(text, flight->camera);
    return text;
}

static Fixture fixture_of(KrsRenderer *renderer, const struct Flight *flight)
{
    return fixture_open(renderer, flight->path, text_of(flight), false);
}

static void shoot(const Fixture *fixture, int frame, uint32_t samples, bool plain, Shot *shot)
{
    KrsRenderOptions options = {.width             = WIDTH,
                                .height            = HEIGHT,
                                .samples           = samples,
                                .aovs              = KRS_AOV_COLOR,
                                .methods.no_filter = plain,
                                .seed              = samples > 16 ? 7 : 0};
    krs_state_set_time(fixture->state, frame);
    KrsPicture *picture = fixture_render(fixture, &options);
    shot->ms            = 0;
    for (int i = KRS_PHASE_NORMALS; i <= KRS_PHASE_SHADING; i++)
        shot->ms += picture->stats.phase_ms[i];
    for (int i = 0; i < PIXELS; i++) {
        double mapped[3];
        for (int k = 0; k < 3; k++)
            shot->linear[i][k] = picture->color[4 * i + k];
        tone_map_apply(TONE_NEUTRAL, shot->linear[i], mapped);
        for (int k = 0; k < 3; k++)
            shot->color[i][k] = 255 * srgb_of_linear(mapped[k]);
        shot->alpha[i] = picture->color[4 * i + 3];
    }
    krs_picture_free(picture);
}

/* Root mean square over the pixels that show something in either. */
static double error_of(const Shot *shot, const Shot *truth)
{
    double sum   = 0;
    size_t count = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (shot->alpha[i] == 0 && truth->alpha[i] == 0)
            continue;
        for (int k = 0; k < 3; k++) {
            double apart = shot->color[i][k] - truth->color[i][k];
            sum += apart * apart;
        }
        count += 3;
    }
    return sqrt(sum / (double)(count ? count : 1));
}

/* The truth with the coverage of a shot: what is left when only that is wrong. */
static void cover(const Shot *shot, const Shot *truth, const Shot *sky, Shot *covered)
{
    *covered = *shot;
    for (int i = 0; i < PIXELS; i++) {
        double mapped[3], seen[3];
        for (int k = 0; k < 3; k++) {
            double share  = truth->alpha[i];
            double behind = (1 - share) * sky->linear[i][k];
            double solid  = share > 0 ? (truth->linear[i][k] - behind) / share : shot->linear[i][k];
            seen[k]       = shot->alpha[i] * solid + (1 - shot->alpha[i]) * sky->linear[i][k];
        }
        tone_map_apply(TONE_NEUTRAL, seen, mapped);
        for (int k = 0; k < 3; k++)
            covered->color[i][k] = 255 * srgb_of_linear(mapped[k]);
    }
}

static double change_of(const Shot *a, const Shot *b)
{
    double sum   = 0;
    size_t count = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (a->alpha[i] == 0 && b->alpha[i] == 0)
            continue;
        for (int k = 0; k < 3; k++)
            sum += fabs(a->color[i][k] - b->color[i][k]);
        count += 3;
    }
    return sum / (double)(count ? count : 1);
}

static double mean_alpha(const Shot *shot)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += shot->alpha[i] / PIXELS;
    return sum;
}

static double mean_light(const Shot *shot)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++)
            sum += shot->linear[i][k] / (3 * PIXELS);
    return sum;
}

static void fly(KrsRenderer *renderer, const struct Flight *flight, uint32_t samples)
{
    static Shot   truth[FRAMES], shots[SETTINGS][FRAMES], sky, covered;
    Fixture       fixture = fixture_of(renderer, flight);
    struct Flight nothing = *flight;
    nothing.path          = "bench/minify/nothing.krs";
    Fixture empty         = fixture_of(renderer, &nothing);
    double  true_change   = 0;
    for (int f = 0; f < FRAMES; f++) {
        shoot(&fixture, f, samples, true, &truth[f]);
        for (int w = 0; w < SETTINGS; w++)
            shoot(&fixture, f, settings[w].samples, settings[w].plain, &shots[w][f]);
    }
    for (int f = 1; f < FRAMES; f++)
        true_change += change_of(&truth[f], &truth[f - 1]) / (FRAMES - 1);
    for (int w = 0; w < SETTINGS; w++) {
        double error = 0, cut = 0, change = 0, ms = 0;
        for (int f = 0; f < FRAMES; f++) {
            shoot(&empty, f, 1, true, &sky);
            cover(&shots[w][f], &truth[f], &sky, &covered);
            error += error_of(&shots[w][f], &truth[f]) / FRAMES;
            cut += error_of(&covered, &truth[f]) / FRAMES;
            ms += shots[w][f].ms / FRAMES;
            change += f ? change_of(&shots[w][f], &shots[w][f - 1]) / (FRAMES - 1) : 0;
        }
        sheet_print(&sheet, "| %s | %u | %s | %.2f | %.2f | %.2f | %+.2f %% | %+.2f %% | %.0f |\n",
                    flight->name, settings[w].samples, settings[w].plain ? "no" : "yes", error, cut,
                    change - true_change,
                    100 * (mean_alpha(&shots[w][0]) / mean_alpha(&truth[0]) - 1),
                    100 * (mean_light(&shots[w][0]) / mean_light(&truth[0]) - 1), ms);
    }
    fixture_close(&empty);
    fixture_close(&fixture);
}

/* ---- What filtering costs: one sample of a large picture, with it and without, in turns ---- */

enum { LARGE_WIDTH = 1280, LARGE_HEIGHT = 720, REPEATS = 7 };

static void time_once(const Fixture *fixture, bool plain, double *normals, double *all)
{
    KrsRenderOptions options = {.width             = LARGE_WIDTH,
                                .height            = LARGE_HEIGHT,
                                .samples           = 1,
                                .aovs              = KRS_AOV_COLOR,
                                .methods.no_filter = plain};
    KrsPicture      *picture = fixture_render(fixture, &options);
    *normals                 = picture->stats.phase_ms[KRS_PHASE_NORMALS];
    *all                     = picture->stats.total_ms;
    krs_picture_free(picture);
}

static void time_filter(KrsRenderer *renderer, const struct Flight *flight)
{
    Fixture fixture = fixture_of(renderer, flight);
    double  normals[2][REPEATS], all[2][REPEATS], prewarm;
    krs_state_set_time(fixture.state, 0);
    for (int plain = 0; plain < 2; plain++)
        time_once(&fixture, plain, &prewarm, &prewarm);
    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (int plain = 0; plain < 2; plain++)
            time_once(&fixture, plain, &normals[plain][repeat], &all[plain][repeat]);
    double filtered = median(all[0], REPEATS), unfiltered = median(all[1], REPEATS);
    sheet_print(&sheet, "| %s | %.1f | %.1f | %.0f | %.0f | %.2f |\n", flight->name,
                median(normals[1], REPEATS), median(normals[0], REPEATS), unfiltered, filtered,
                filtered / unfiltered);
    fixture_close(&fixture);
}

/* ---- What another filter of pixels would do ---- */

static void widen(KrsRenderer *renderer, const struct Flight *flight)
{
    Fixture          fixture = fixture_of(renderer, flight);
    KrsRenderOptions options = {.width             = FINE * WIDTH,
                                .height            = FINE * HEIGHT,
                                .samples           = 1,
                                .aovs              = KRS_AOV_COLOR,
                                .methods.no_filter = true};
    krs_state_set_time(fixture.state, 0);
    KrsPicture *fine = fixture_render(&fixture, &options);
    pixel_filter_rows(&sheet, flight->name, fine);
    krs_picture_free(fine);
    fixture_close(&fixture);
}

static bool is_wanted(const struct Flight *flight, int count, char **arguments)
{
    return count < 3 || strcmp(flight->name, arguments[2]) == 0;
}

/* minify [SAMPLES [NAME]]: of the reference; one flight.  With 0 samples only what it costs. */
int main(int count, char **arguments)
{
    uint32_t samples = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : 64;
    spirv_start();
    KrsRenderer *renderer = device_open();
    sheet = sheet_open("minify", "What is finer than a pixel", "make minify", renderer, count > 1);
    if (samples > 0)
        sheet_print(
            &sheet,
            "%dx%d, %d frames, against %u samples\n\n"
            "| scene | samples | filtered | error | of coverage | flicker | alpha | light | ms"
            " |\n"
            "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
            WIDTH, HEIGHT, FRAMES, samples);
    for (int i = 0; i < FLIGHTS && samples > 0; i++)
        if (is_wanted(&flights[i], count, arguments))
            fly(renderer, &flights[i], samples);
    sheet_print(&sheet,
                "\n%dx%d, one sample, medians of %d in turns, ms\n\n"
                "| scene | normals | normals, filtered | total | total, filtered | times |\n"
                "| --- | --- | --- | --- | --- | --- |\n",
                LARGE_WIDTH, LARGE_HEIGHT, REPEATS);
    for (int i = 0; i < FLIGHTS; i++)
        if (is_wanted(&flights[i], count, arguments))
            time_filter(renderer, &flights[i]);
    if (samples > 0)
        pixel_filter_titles(&sheet);
    for (int i = 0; i < FLIGHTS && samples > 0; i++)
        if (is_wanted(&flights[i], count, arguments))
            widen(renderer, &flights[i]);
    sheet_close(&sheet);
    krs_renderer_free(renderer);
    spirv_stop();
    return 0;
}
