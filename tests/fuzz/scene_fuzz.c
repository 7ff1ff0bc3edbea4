/*
 * scene_fuzz.c: any bytes through the whole compiler but glslang, for libFuzzer.
 *
 * Whatever the text, compiling it ends in time and memory: with a program, or with at least one
 * error, or for want of memory.  A program can be asked for distances.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/passes/compile.h"

/* abort() is what libFuzzer takes for a finding. */
static void demand(bool holds)
{
    if (!holds)
        abort();
}

static void count_errors(void *user, const KrsDiagnostic *diagnostic)
{
    *(size_t *)user += diagnostic->error;
    demand(diagnostic->text[0] != '\0' && diagnostic->json[0] == '{');
}

/* Shows that a finding is noticed: the runner plants this text. */
static void check_planted(const char *bytes, size_t size)
{
    static const char planted[] = "krs-planted-fault";
    demand(!getenv("KRS_FUZZ_PLANTED") || size != sizeof planted - 1 ||
           memcmp(bytes, planted, size) != 0);
}

static void ask(const KrsScene *scene)
{
    static const double points[4][3] = {{0, 0, 0}, {1, 2, 3}, {-4, 0.5, 10}, {100, -100, 3}};
    double              distances[4];
    KrsState           *state;
    KrsView             view;
    if (krs_state_new(scene, &state) != KRS_OK)
        return;
    krs_distance(state, points, 4, distances);
    demand(krs_state_view(state, 0, &view) == KRS_OK);
    krs_state_free(state);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    size_t     errors  = 0;
    KrsOptions options = {
        .diagnostic = count_errors, .user = &errors, .memory_limit = (size_t)1 << 30};
    KrsScene *scene;
    check_planted((const char *)bytes, size);
    KrsStatus status = krs_compile_text((const char *)bytes, size, "fuzz.krs", &options, &scene);
    demand(status == KRS_OK || status == KRS_BAD_SCENE || status == KRS_OUT_OF_MEMORY);
    demand((status == KRS_OK) == (scene != NULL));
    demand(status != KRS_BAD_SCENE || errors > 0);
    demand(status != KRS_OK || errors == 0);
    if (scene)
        ask(scene);
    krs_scene_free(scene);
    return 0;
}
