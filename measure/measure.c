/* measure.c: krs_measure checks what is asked for, and runs the steps. */
#include "measure/measure.h"

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "slice/extent.h"

enum { MAX_ORIENTATIONS = 72 };
/* Parts of the work that are done after the mesh and after the volume. */
static const double MESH_DONE = 0.4, VOLUME_DONE = 0.7;

bool measurer_progress(Measurer *m, size_t part, double fraction)
{
    const KrsMeasureOptions *options = m->options;
    if (part == 0 && options->progress &&
        !options->progress(options->user, m->begun + fraction * (m->goal - m->begun)))
        atomic_store(&m->stopped, true);
    return !atomic_load_explicit(&m->stopped, memory_order_relaxed);
}

static bool mesher_progress(void *user, double fraction)
{
    return measurer_progress(user, 0, fraction);
}

static KrsStatus make_mesh(Measurer *m, KrsState *state)
{
    const KrsMeasureOptions *options = m->options;
    KrsMeshOptions           how     = {.error        = options->error,
                                        .component    = options->component,
                                        .within       = options->within,
                                        .memory_limit = options->memory_limit,
                                        .progress     = mesher_progress,
                                        .user         = m};
    memcpy(how.low, options->low, sizeof how.low);
    memcpy(how.high, options->high, sizeof how.high);
    m->goal = MESH_DONE;
    return krs_mesh(state, &how, &m->mesh);
}

/* Finds the box around the mesh. */
static void find_box(Measurer *m)
{
    for (int k = 0; k < 3; k++) {
        m->low[k]  = INFINITY;
        m->high[k] = -INFINITY;
        for (size_t i = 0; i < m->mesh->vertex_count; i++) {
            m->low[k]  = min2(m->low[k], m->mesh->vertices[i][k]);
            m->high[k] = max2(m->high[k], m->mesh->vertices[i][k]);
        }
        m->longest = max2(m->longest, m->high[k] - m->low[k]);
    }
}

static KrsStatus open_fields(Measurer *m, KrsState *state)
{
    const KrsScene          *scene   = state->scene;
    const KrsMeasureOptions *options = m->options;
    bool *wanted = options->component ? arena_new_array(&m->arena, bool, scene->component_count + 1)
                                      : NULL;
    KrsStatus status = KRS_OK;
    m->solid.roots   = arena_alloc(&m->arena, 1, solid_root_bytes(scene));
    if (wanted)
        wanted[scene->lowered[options->component - 1]] = true;
    solid_of_components(scene, wanted, &m->solid);
    m->parts = parallel_parts();
    for (size_t i = 0; i < m->parts && status == KRS_OK; i++) {
        MeshField *field = &m->fields[i];
        *field           = (MeshField){.solid = &m->solid, .cut = options->within};
        for (int k = 0; k < 3; k++) {
            Range range    = m->solid.box.axis[k];
            field->low[k]  = options->within ? max2(range.low, options->low[k]) : range.low;
            field->high[k] = options->within ? min2(range.high, options->high[k]) : range.high;
        }
        status = state_copy_of(state, &field->state);
        if (status == KRS_OK) {
            state_refresh_points(field->state);
            field_open(field, &m->arena);
            field->ranges.unroll = true;
        }
    }
    return status;
}

/* Finds the box of the solid, whose sides are within the mesh's error of those of the mesh. */
static void measure_box(Measurer *m)
{
    double low[3], high[3], error = m->mesh->error;
    for (int k = 0; k < 3; k++) {
        m->low[k] -= error;
        m->high[k] += error;
        if (m->options->within) {
            m->low[k]  = max2(m->low[k], m->options->low[k]);
            m->high[k] = min2(m->high[k], m->options->high[k]);
        }
        low[k]  = m->low[k];
        high[k] = m->high[k];
    }
    narrow_box(&m->fields[0], low, high);
    for (int k = 0; k < 3; k++) {
        m->measures->low[k]  = min2(max2(low[k], m->low[k]), m->low[k] + 2 * error);
        m->measures->high[k] = max2(min2(high[k], m->high[k]), m->high[k] - 2 * error);
    }
}

static void measure_all(Measurer *m)
{
    measure_box(m);
    m->begun = MESH_DONE;
    m->goal  = VOLUME_DONE;
    measure_volume(m);
    m->begun = VOLUME_DONE;
    m->goal  = 1;
    measure_samples(m);
    if (measurer_progress(m, 0,
                          1)) /* reported here, since the first thread may have had no samples */
        measure_lying(m);
}

static KrsStatus run(Measurer *m, KrsState *state)
{
    KrsMeasures *measures = m->measures;
    jmp_buf      exhausted;
    KrsStatus    status      = make_mesh(m, state);
    measures->wall.thickness = INFINITY;
    if (status != KRS_OK)
        return status;
    measures->error      = m->mesh->error;
    measures->estimate   = m->mesh->estimate;
    measures->unresolved = m->mesh->unresolved;
    memcpy(measures->unresolved_at, m->mesh->unresolved_at, sizeof measures->unresolved_at);
    if (m->mesh->triangle_count == 0)
        return KRS_OK;
    m->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    find_box(m);
    status = open_fields(m, state);
    if (status == KRS_OK)
        measure_all(m);
    m->memory.exhausted = NULL;
    return status == KRS_OK && atomic_load(&m->stopped) ? KRS_INTERRUPTED : status;
}

static bool take_options(Measurer *m)
{
    const KrsMeasureOptions *options = m->options;
    double                  *up      = m->measures->as_is.up;
    memcpy(up, options->up, sizeof options->up);
    if (largest3(up) == 0)
        up[2] = 1;
    return normalize3(up) && options->nozzle >= 0 && isfinite(options->nozzle) &&
           options->overhang >= 0 && options->overhang <= M_PI_2;
}

static void close_measurer(Measurer *m)
{
    for (int i = 0; i < MAX_PARTS; i++)
        state_free(m->fields[i].state);
    krs_mesh_free(m->mesh);
    arena_free(&m->arena);
    free(m);
}

KrsStatus krs_measure(KrsState *state, const KrsMeasureOptions *options, KrsMeasures **measures)
{
    static const KrsMeasureOptions none   = {0};
    KrsStatus                      status = KRS_OUT_OF_MEMORY;
    Measurer                      *m      = calloc(1, sizeof *m);
    *measures                             = NULL;
    if (!m)
        return status;
    m->options      = options ? options : &none;
    m->memory       = state->scene->memory;
    m->memory.used  = 0;
    m->memory.limit = m->options->memory_limit ? m->options->memory_limit : KRS_USUAL_MEMORY;
    m->arena.memory = &m->memory;
    m->measures     = calloc(1, sizeof *m->measures);
    if (m->measures)
        m->measures->orientations = calloc(MAX_ORIENTATIONS, sizeof *m->measures->orientations);
    if (m->measures && m->measures->orientations)
        status = take_options(m) ? run(m, state) : KRS_BAD_ARGUMENT;
    if (status == KRS_OK)
        *measures = m->measures;
    else
        krs_measures_free(m->measures);
    close_measurer(m);
    return status;
}

void krs_measures_free(KrsMeasures *measures)
{
    if (!measures)
        return;
    free(measures->orientations);
    free(measures);
}
