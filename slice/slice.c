/* slice.c: krs_slice checks what is asked for, and makes sections by all threads. */
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "slice/extent.h"
#include "slice/section.h"

static const double DEFAULT_ERROR = 1.0 / 2000, MIN_ERROR = 1e-7;
/* Parts of coordinates: the accuracy of roots, and by how much solids are thickened, so that
   rounding does not decide faces that touch, and faces in the plane itself. */
static const double ENOUGH = 1e-14, SKIN = 1e-12;

struct KrsSlicer {
    Memory          memory;
    Arena           arena;
    KrsSliceOptions options;
    MeshSolid       solid;
    double    low[3], high[3], error, longest, size; /* the longest side, the largest coordinate */
    size_t    parts;
    MeshField fields[MAX_PARTS];
};

/* ---- the slicer ---- */

KrsStatus krs_slicer_set_error(KrsSlicer *slicer, double error)
{
    if (!(error >= MIN_ERROR * slicer->longest) || isinf(error))
        return KRS_BAD_ARGUMENT;
    slicer->error = error;
    return KRS_OK;
}

static bool find_box(KrsSlicer *slicer)
{
    const KrsSliceOptions *options = &slicer->options;
    double                 longest = 0;
    bool                   empty   = false;
    for (int k = 0; k < 3; k++) {
        Range range     = slicer->solid.box.axis[k];
        slicer->low[k]  = options->within ? max2(range.low, options->low[k]) : range.low;
        slicer->high[k] = options->within ? min2(range.high, options->high[k]) : range.high;
        empty           = empty || slicer->low[k] > slicer->high[k];
        longest         = max2(longest, slicer->high[k] - slicer->low[k]);
    }
    for (int k = 0; k < 3 && empty; k++)
        slicer->low[k] = slicer->high[k] = 0;
    slicer->size = max2(largest3(slicer->low), largest3(slicer->high));
    if (empty)
        slicer->parts = 0;
    if (!isfinite(slicer->size))
        return false;
    slicer->longest = empty ? 0 : longest;
    return krs_slicer_set_error(slicer, slicer->options.error > 0
                                            ? slicer->options.error
                                            : DEFAULT_ERROR * longest) == KRS_OK;
}

static KrsStatus open_fields(KrsSlicer *slicer, KrsState *state)
{
    jmp_buf            exhausted;
    volatile KrsStatus status = KRS_OK;
    slicer->memory.exhausted  = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    for (size_t i = 0; i < slicer->parts && status == KRS_OK; i++) {
        MeshField *field = &slicer->fields[i];
        *field           = (MeshField){
                      .solid = &slicer->solid, .cut = slicer->options.within, .skin = SKIN * slicer->size};
        memcpy(field->low, slicer->low, sizeof field->low);
        memcpy(field->high, slicer->high, sizeof field->high);
        status = state_copy_of(state, &field->state);
        if (status == KRS_OK) {
            state_refresh_points(field->state);
            field_open(field, &slicer->arena);
            /* Derivatives of instance groups have no bounds; those of few instances have. */
            field->ranges.unroll = true;
        }
    }
    return status;
}

static KrsStatus open_slicer(KrsSlicer *slicer, KrsState *state)
{
    const KrsScene *scene  = state->scene;
    size_t          number = slicer->options.component;
    bool           *wanted = number ? calloc(scene->component_count + 1, sizeof *wanted) : NULL;
    slicer->solid.roots    = malloc(solid_root_bytes(scene));
    if (!slicer->solid.roots || (number && !wanted)) {
        free(wanted);
        return KRS_OUT_OF_MEMORY;
    }
    if (wanted)
        wanted[scene->lowered[number - 1]] = true;
    solid_of_components(scene, wanted, &slicer->solid);
    free(wanted);
    slicer->parts = parallel_parts();
    if (!find_box(slicer))
        return KRS_BAD_ARGUMENT;
    KrsStatus status = open_fields(slicer, state);
    if (status == KRS_OK && slicer->parts > 0 &&
        !narrow_box(&slicer->fields[0], slicer->low, slicer->high))
        slicer->parts = 0;
    return status;
}

KrsStatus krs_slicer_new(KrsState *state, const KrsSliceOptions *options, KrsSlicer **result)
{
    static const KrsSliceOptions none  = {0};
    const KrsScene              *scene = state->scene;
    *result                            = NULL;
    if (options && (options->component > scene->shown_count || !(options->error >= 0) ||
                    isinf(options->error)))
        return KRS_BAD_ARGUMENT;
    if (scene->program.open_surfaces)
        return KRS_BAD_ARGUMENT;
    KrsSlicer *slicer = calloc(1, sizeof *slicer);
    if (!slicer)
        return KRS_OUT_OF_MEMORY;
    slicer->options      = options ? *options : none;
    slicer->memory.limit = slicer->options.memory_limit ? slicer->options.memory_limit
                                                        : KRS_USUAL_MEMORY;
    slicer->arena.memory = &slicer->memory;
    KrsStatus status     = open_slicer(slicer, state);
    if (status == KRS_OK)
        *result = slicer;
    else
        krs_slicer_free(slicer);
    return status;
}

void krs_slicer_free(KrsSlicer *slicer)
{
    if (!slicer)
        return;
    for (size_t i = 0; i < MAX_PARTS; i++)
        state_free(slicer->fields[i].state);
    arena_free(&slicer->arena);
    free(slicer->solid.roots);
    free(slicer);
}

bool krs_slicer_box(const KrsSlicer *slicer, double low[3], double high[3])
{
    memcpy(low, slicer->low, sizeof slicer->low);
    memcpy(high, slicer->high, sizeof slicer->high);
    return slicer->parts > 0;
}

/* ---- sections ---- */

/* Sections that are made by all threads: each takes the next. */
typedef struct Slicing {
    KrsSlicer             *slicer;
    const KrsSectionPlane *planes;
    size_t                 count;
    KrsSection           **sections;
    atomic_size_t          next;
    atomic_bool            stopped;
    KrsStatus              statuses[MAX_PARTS];
} Slicing;

static KrsStatus make_section(Section *s, const KrsSlicer *slicer, KrsSection **result)
{
    jmp_buf exhausted;
    s->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    section_root(s, slicer->low, slicer->high);
    if (!find_leaves(s))
        return KRS_INTERRUPTED;
    find_chords(s);
    bend_chords(s);
    return section_contours(s, result) ? KRS_OK : KRS_OUT_OF_MEMORY;
}

static bool plane_is_valid(const KrsSectionPlane *plane)
{
    double normal[3];
    memcpy(normal, plane->normal, sizeof normal);
    return normalize3(normal) && isfinite(dot3(plane->point, normal));
}

static KrsStatus slice_plane_of(Slicing *slicing, size_t part, size_t number)
{
    KrsSlicer *slicer     = slicing->slicer;
    Section    s          = {.field    = &slicer->fields[part],
                             .plane    = slice_plane(&slicing->planes[number]),
                             .error    = slicer->error,
                             .enough   = ENOUGH * slicer->size,
                             .arcs     = slicer->options.arcs,
                             .lines    = slicer->options.arcs && slicer->options.lines,
                             .skin     = SKIN * slicer->size,
                             .progress = part == 0 ? slicer->options.progress : NULL,
                             .user     = slicer->options.user,
                             .fraction = (double)number / (double)slicing->count,
                             .stopped  = &slicing->stopped};
    s.memory.limit        = slicer->memory.limit / slicer->parts;
    s.arena.memory        = &s.memory;
    KrsStatus status      = make_section(&s, slicer, &slicing->sections[number]);
    s.field->region_count = 0;
    arena_free(&s.arena);
    return status;
}

static void slice_some(void *task, size_t part, size_t parts)
{
    Slicing   *slicing = task;
    KrsStatus *status  = &slicing->statuses[part];
    size_t     number;
    (void)parts;
    while (part < slicing->slicer->parts && *status == KRS_OK &&
           (number = atomic_fetch_add(&slicing->next, 1)) < slicing->count)
        *status = slice_plane_of(slicing, part, number);
    if (*status != KRS_OK)
        atomic_store(&slicing->stopped, true);
}

static void free_sections(KrsSection **sections, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        krs_section_free(sections[i]);
        sections[i] = NULL;
    }
}

KrsStatus krs_slice(KrsSlicer *slicer, const KrsSectionPlane *planes, size_t count,
                    KrsSection **sections)
{
    Slicing   slicing = {.slicer = slicer, .planes = planes, .count = count, .sections = sections};
    KrsStatus status  = KRS_OK;
    for (size_t i = 0; i < count; i++) {
        sections[i] = NULL;
        if (!plane_is_valid(&planes[i]))
            status = KRS_BAD_ARGUMENT;
    }
    if (status != KRS_OK)
        return status;
    if (slicer->parts > 0)
        run_in_parallel(slice_some, &slicing);
    for (size_t i = 0; i < MAX_PARTS; i++)
        if (slicing.statuses[i] != KRS_OK && (status == KRS_OK || status == KRS_INTERRUPTED))
            status = slicing.statuses[i];
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        if (!sections[i] && !(sections[i] = calloc(1, sizeof **sections)))
            status = KRS_OUT_OF_MEMORY;
    if (status != KRS_OK)
        free_sections(sections, count);
    return status;
}
