/*
 * core.c: what a page calls of the compiler.
 */
#include "web/core/core.h"

#include <stdlib.h>

#include "web/core/answers.h"
#include "web/core/page.h"

const char *core_answer(void) { return answer_text(); }

/* The bytes that the page supplied last. */
static char *supplied;

const char *supply_text(void *user, const char *path, size_t *length)
{
    (void)user;
    free(supplied);
    return supplied = page_load(path, length);
}

static const char *font(void *user, const char *name, size_t *length, int *face)
{
    (void)user;
    free(supplied);
    return supplied = page_font(name, length, face);
}

static void end_supply(void)
{
    free(supplied);
    supplied = NULL;
}

static bool progress(void *user, double done)
{
    (void)user;
    return page_progress(done);
}

static KrsOptions options_of(uint32_t bits)
{
    return (KrsOptions){.diagnostic = answer_diagnostic,
                        .specialize = bits & CORE_STRUCTURE   ? KRS_SPECIALIZE_STRUCTURE
                                      : bits & CORE_AUTOMATIC ? KRS_SPECIALIZE_AUTO
                                                              : KRS_SPECIALIZE_NUMBERS,
                        .studio     = (bits & CORE_STUDIO) != 0,
                        .pictures   = (bits & CORE_PICTURES) != 0,
                        .gradients  = (bits & CORE_GRADIENTS) != 0,
                        .assembly   = (bits & CORE_ASSEMBLY) != 0,
                        .figures    = (bits & CORE_FIGURES) != 0,
                        .load       = supply_text,
                        .font       = font};
}

KrsScene *core_compile(const char *text, size_t length, const char *name, uint32_t options,
                       size_t memory)
{
    KrsOptions chosen = options_of(options);
    KrsScene  *scene;
    chosen.memory_limit = memory;
    answer_begin_compilation();
    const KrsStatus status = krs_compile_text(text, length, name, &chosen, &scene);
    end_supply();
    answer_end_compilation(status, NULL);
    return scene;
}

KrsScene *core_update(const KrsScene *scene, const char *text, size_t length)
{
    KrsScene  *updated;
    KrsChanges changes;
    answer_begin_compilation();
    const KrsStatus status = krs_scene_update(scene, text, length, &updated, &changes);
    end_supply();
    answer_end_compilation(status, &changes);
    return updated;
}

char *core_format(const char *text, size_t length, const char *name)
{
    const KrsOptions chosen = options_of(0);
    char            *formatted;
    bool             same;
    answer_begin_compilation();
    const KrsStatus status = krs_format_text(text, length, name, &chosen, &formatted, &same);
    end_supply();
    answer_end_compilation(status, NULL);
    return formatted;
}

char *core_text(const KrsScene *scene, uint32_t target, uint32_t options)
{
    char                *text;
    const KrsTextOptions how = {.state_values  = (options & 1) != 0,
                                .no_early_outs = (options & 2) != 0};
    krs_text(scene, (KrsTarget)target, &how, &text);
    return text;
}

KrsState *core_state(const KrsScene *scene)
{
    KrsState *state;
    krs_state_new(scene, &state);
    return state;
}

void core_describe(const KrsScene *scene) { answer_scene(scene); }

void core_view(const KrsScene *scene, KrsState *state) { answer_view(scene, state); }

void core_probe(KrsState *state, const double (*points)[3], size_t count)
{
    KrsHit   *hits   = calloc(count + 1, sizeof *hits);
    KrsStatus status = hits ? krs_probe(state, points, count, hits) : KRS_OUT_OF_MEMORY;
    answer_hits(status, hits, count);
    free(hits);
}

void core_raycast(KrsState *state, const double (*origins)[3], const double (*directions)[3],
                  size_t count, double farthest, double tolerance)
{
    KrsHit   *hits   = calloc(count + 1, sizeof *hits);
    KrsStatus status = KRS_OUT_OF_MEMORY;
    if (hits)
        status = krs_raycast(state, origins, directions, count, farthest, tolerance, hits);
    answer_hits(status, hits, count);
    free(hits);
}

KrsMesh *core_mesh(KrsState *state, double error, size_t component, bool simplify, bool draft)
{
    const KrsMeshOptions options = {.error     = error,
                                    .component = component,
                                    .simplify  = simplify,
                                    .draft     = draft,
                                    .progress  = progress};
    KrsMesh             *mesh    = NULL;
    const KrsStatus      status  = krs_mesh(state, &options, &mesh);
    answer_mesh(status, mesh);
    return mesh;
}
