/*
 * examples.c: a scene on this device and on lavapipe: whether both see the same, and the time.
 */
#include <stdio.h>
#include <string.h>

#include "bench/device/device.h"
#include "tests/support/agreement.h"

static const double PERMITTED = 0.5; /* widths of a pixel: as in tests/oracle/drivers.c */

typedef struct Timed {
    KrsPicture *picture;
    double      ready_ms, total_ms, wall_ms; /* compiling; of the second picture */
} Timed;

static Timed render_twice(KrsRenderer *renderer, const char *path, Size size)
{
    KrsRenderOptions options = {.width = size.width, .height = size.height, .samples = 1};
    double           start   = clock_ms();
    Fixture          fixture = fixture_open(renderer, path, NULL, false);
    krs_picture_free(fixture_render(&fixture, &options));
    double      ready   = clock_ms() - start;
    KrsPicture *picture = fixture_render(&fixture, &options);
    fixture_close(&fixture);
    return (Timed){picture, ready, picture->stats.total_ms, picture->stats.wall_ms};
}

void print_example(KrsRenderer *renderer, const char *path, Size size)
{
    KrsRenderer *lavapipe = NULL;
    const char  *name     = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    Timed        here     = render_twice(renderer, path, size);
    printf("| %s | %.0f | %.1f | %.1f | %llu ", name, here.ready_ms, here.total_ms, here.wall_ms,
           (unsigned long long)here.picture->stats.unresolved);
    fflush(stdout);
    bool same = strstr(here.picture->stats.device, "llvmpipe") != NULL;
    if (same ||
        krs_renderer_new(&(KrsRendererOptions){.device = "llvmpipe"}, &lavapipe) != KRS_OK) {
        printf("| | | %s |\n", same ? "this is lavapipe" : "there is no lavapipe");
    } else {
        Timed     there = render_twice(lavapipe, path, size);
        Agreement found = agreement_of(there.picture, here.picture, PERMITTED);
        printf("| %.1f | %zu, %zu | %s: hits %zu, components %zu, levels %zu, instances %zu,"
               " depths %zu, largest %.3f pixels |\n",
               there.total_ms, agreement_faults(&found), found.outline,
               agreement_faults(&found) ? "DIFFERENT" : "the same", found.hits, found.components,
               found.levels, found.instances, found.depths, found.deepest);
        krs_picture_free(there.picture);
    }
    krs_picture_free(here.picture);
    krs_renderer_free(lavapipe);
}
