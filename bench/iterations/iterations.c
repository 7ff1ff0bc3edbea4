/*
 * iterations.c: how many evaluations each pixel takes, as a picture: figure 13 of the KRS paper of
 * 2016, whose scale this is: white is 0, black is 70; what takes more is red.
 *
 * A palm leaf of Moebius fixtures, side by side by one way to trace after another: the paper's first.
 * All straightforward: a lane to a pixel and no beams.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/sheet.h"
#include "bench/fixture.h"
#include "compiler/passes/compile.h"
#include "krs/vulkan.h"
#include "runtime/writer/png.h"

static const char path[] = "bench/scenes/palm-leaf.krs";

enum { WIDTH = 480, HEIGHT = 320, PIXELS = WIDTH * HEIGHT, BLACK = 70 };

static const KrsTrace methods[] = {KRS_TRACE_BINARY, KRS_TRACE_PREDICTED, KRS_TRACE_PLAIN,
                                   KRS_TRACE_AUTO, KRS_TRACE_DIRECTIONAL};
enum { METHODS = sizeof methods / sizeof *methods };

static Sheet sheet;

static void shade(uint32_t steps, uint8_t *rgb)
{
    uint8_t gray = steps > BLACK ? 0 : (uint8_t)(255 - 255 * steps / BLACK);
    rgb[0]       = steps > BLACK ? 200 : gray;
    rgb[1] = rgb[2] = gray;
}

static uint8_t strip[3 * PIXELS * METHODS]; /* the pictures, side by side */

static void put(const KrsPicture *picture, int place)
{
    for (int i = 0; i < PIXELS; i++) {
        int x = place * WIDTH + i % WIDTH, y = i / WIDTH;
        shade(picture->steps[i], &strip[3 * (y * WIDTH * METHODS + x)]);
    }
}

static void write_strip(const char *name)
{
    OutputError   error = {0};
    const Picture frame = {.width       = WIDTH * METHODS,
                           .height      = HEIGHT,
                           .crop_width  = WIDTH * METHODS,
                           .crop_height = HEIGHT};
    OutputFile   *file  = output_open(name, NULL, &error);
    if (!file || !png_write(&frame, strip, file, &error) || output_commit(file) != KRS_OK)
        give_up(name, error.message);
}

/* Tells the steps of the pixels that cost something at all. */
static void tell(const KrsPicture *picture, KrsTrace method)
{
    double   sum   = 0;
    size_t   count = 0, dark = 0;
    uint32_t most = 0;
    for (int i = 0; i < PIXELS; i++) {
        uint32_t steps = picture->steps[i];
        sum += steps;
        count += steps > 0;
        dark += steps > BLACK;
        most = steps > most ? steps : most;
    }
    sheet_print(&sheet, "| %s | %.1f | %u | %.2f %% |\n", krs_trace_names[method],
                sum / (double)(count ? count : 1), most, 100.0 * (double)dark / PIXELS);
}

static void shoot(const Fixture *fixture, KrsTrace method, int place)
{
    KrsRenderOptions options = {.width            = WIDTH,
                                .height           = HEIGHT,
                                .samples          = 1,
                                .methods.no_beams = true,
                                .aovs             = KRS_AOV_COLOR | KRS_AOV_STEPS,
                                .methods.trace    = method,
                                .methods.schedule = KRS_SCHEDULE_PIXEL};
    KrsPicture      *picture = fixture_render(fixture, &options);
    put(picture, place);
    tell(picture, method);
    krs_picture_free(picture);
}

static const char *base_name(const char *file)
{
    const char *slash = strrchr(file, '/');
    return slash ? slash + 1 : file;
}

/* iterations [FILE.png] */
int main(int count, char **arguments)
{
    char name[256];
    spirv_start();
    KrsRenderer *renderer = device_open();
    Fixture      fixture  = fixture_open(renderer, path, NULL, false);
    sheet = sheet_open("iterations", "Iterations of a palm leaf's pixels", "make iterations",
                       renderer, count > 1);
    if (count > 1)
        snprintf(name, sizeof name, "%s", arguments[1]);
    else /* beside the table */
        snprintf(name, sizeof name, "%.*s.png", (int)(strlen(sheet.path) - 3), sheet.path);
    sheet_print(&sheet,
                "| %dx%d | iterations of a pixel that has any | most | more than %d |\n"
                "| --- | --- | --- | --- |\n",
                WIDTH, HEIGHT, BLACK);
    for (int i = 0; i < METHODS; i++)
        shoot(&fixture, methods[i], i);
    sheet_print(&sheet, "\n![iterations](%s)\n", base_name(name));
    write_strip(name);
    fixture_close(&fixture);
    sheet_close(&sheet);
    krs_renderer_free(renderer);
    spirv_stop();
    return 0;
}
