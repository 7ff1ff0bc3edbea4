/*
 * methods.c: the ways to render a scene, side by side.
 */
#include <stdio.h>

#include "bench/device/device.h"
#include "tests/support/agreement.h"

enum { REPEATS = 3 };

typedef struct Method {
    const char      *name;
    KrsRenderOptions options;
    uint64_t         band; /* pixels of a band at most; 0: as the renderer has it */
} Method;

static const Method methods[] = {
    {"default", {0}, 0},
    {"schedule pixel", {.methods.schedule = KRS_SCHEDULE_PIXEL}, 0},
    {"schedule refill", {.methods.schedule = KRS_SCHEDULE_REFILL}, 0},
    {"schedule queue", {.methods.schedule = KRS_SCHEDULE_QUEUE}, 0},
    {"without beams", {.methods.no_beams = true}, 0},
    {"plain steps", {.methods.trace = KRS_TRACE_PLAIN}, 0},
    {"components together", {.methods.components = KRS_COMPONENTS_TOGETHER}, 0},
    {"components apart", {.methods.components = KRS_COMPONENTS_APART}, 0},
    {"components packed", {.methods.components = KRS_COMPONENTS_PACKED}, 0},
    {"bands of 2^14 pixels", {0}, 1 << 14},
    {"bands of 2^16 pixels", {0}, 1 << 16},
    {"slices of 5 ms", {.slice_ms = 5}, 0},
    {"slices of 500 ms", {.slice_ms = 500}, 0},
};

/* A band is as large as the buffer of its results may be: 80 bytes a pixel. */
static void limit_band(KrsRenderer *renderer, uint64_t pixels, uint32_t usual)
{
    uint32_t *limit = &renderer->gpu.limits.storage_bytes;
    *limit          = pixels > 0 ? (uint32_t)(pixels + 16) * RESULT_ROWS * RESULT_BYTES : usual;
}

/* Renders some pictures, and returns the one that took least. */
static KrsPicture *render_best(const Fixture *fixture, const KrsRenderOptions *options)
{
    KrsPicture *best = fixture_render(fixture, options); /* compiles what is new */
    for (int i = 0; i < REPEATS; i++) {
        KrsPicture *picture = fixture_render(fixture, options);
        bool        better  = i == 0 || picture->stats.total_ms < best->stats.total_ms;
        krs_picture_free(better ? best : picture);
        best = better ? picture : best;
    }
    return best;
}

static void print_row(const char *name, bool early_outs, const KrsPicture *picture,
                      const KrsPicture *first)
{
    const KrsRenderStats *stats = &picture->stats;
    Agreement             found = agreement_of(first, picture, 0.5);
    printf("| %s, early outs %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.1f | %zu |\n",
           name, early_outs ? "on" : "off", stats->phase_ms[KRS_PHASE_BEAMS],
           stats->phase_ms[KRS_PHASE_PRIMARY], stats->phase_ms[KRS_PHASE_NORMALS],
           stats->phase_ms[KRS_PHASE_SHADOWS], stats->phase_ms[KRS_PHASE_OCCLUSION],
           stats->total_ms, stats->wall_ms, stats->evaluations_per_ray, agreement_faults(&found));
    fflush(stdout);
}

void print_methods(KrsRenderer *renderer, const char *path, Size size, bool early_outs)
{
    uint32_t    usual    = renderer->gpu.limits.storage_bytes;
    KrsPicture *first    = NULL;
    renderer->early_outs = early_outs;
    Fixture fixture      = fixture_open(renderer, path, NULL, false);
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        KrsRenderOptions options = methods[i].options;
        options.width            = size.width;
        options.height           = size.height;
        options.samples          = 1;
        krs_rendering_free(fixture.rendering); /* and its band */
        limit_band(renderer, methods[i].band, usual);
        if (krs_rendering_new(renderer, fixture.scene, KRS_FOR_QUESTIONS, &fixture.rendering))
            give_up(path, krs_renderer_message(renderer));
        KrsPicture *picture = render_best(&fixture, &options);
        print_row(methods[i].name, early_outs, picture, first ? first : picture);
        if (first)
            krs_picture_free(picture);
        else
            first = picture;
    }
    krs_picture_free(first);
    fixture_close(&fixture);
}
