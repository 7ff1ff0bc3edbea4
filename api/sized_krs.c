/*
 * sized_krs.c: the functions of krs.h and its parts that programs link with, for structs of any size.
 */
#include "krs/krs.h"

#include "api/sized.h"

KrsStatus krs_compile_text_sized(const char *text, size_t length, const char *name,
                                 const KrsOptions *options, size_t size, KrsScene **scene)
{
    KrsOptions own;
    *scene = NULL;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_compile_text(text, length, name, options ? &own : NULL, scene);
}

KrsStatus krs_compile_file_sized(const char *path, const KrsOptions *options, size_t size,
                                 KrsScene **scene)
{
    KrsOptions own;
    *scene = NULL;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_compile_file(path, options ? &own : NULL, scene);
}

KrsStatus krs_format_text_sized(const char *text, size_t length, const char *name,
                                const KrsOptions *options, size_t size, char **formatted,
                                bool *same)
{
    KrsOptions own;
    *formatted = NULL;
    *same      = false;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_format_text(text, length, name, options ? &own : NULL, formatted, same);
}

KrsStatus krs_format_file_sized(const char *path, const KrsOptions *options, size_t size,
                                char **formatted, bool *same)
{
    KrsOptions own;
    *formatted = NULL;
    *same      = false;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_format_file(path, options ? &own : NULL, formatted, same);
}

KrsStatus krs_scene_update_sized(const KrsScene *scene, const char *text, size_t length,
                                 KrsScene **updated, KrsChanges *changes, size_t size)
{
    KrsChanges      own    = {0};
    const KrsStatus status = krs_scene_update(scene, text, length, updated, &own);
    sized_give(changes, size, &own, sizeof own);
    return status;
}

KrsStatus krs_scene_reload_sized(const KrsScene *scene, KrsScene **updated, KrsChanges *changes,
                                 size_t size)
{
    KrsChanges      own    = {0};
    const KrsStatus status = krs_scene_reload(scene, updated, &own);
    sized_give(changes, size, &own, sizeof own);
    return status;
}

/* A function that tells the struct of an index. */
#define ASKED_BY_INDEX(function, Owner, Struct)                                         \
    KrsStatus function##_sized(Owner *owner, size_t index, Struct *answer, size_t size) \
    {                                                                                   \
        Struct          own;                                                            \
        const KrsStatus status = function(owner, index, &own);                          \
        if (status == KRS_OK)                                                           \
            sized_give(answer, size, &own, sizeof own);                                 \
        return status;                                                                  \
    }
ASKED_BY_INDEX(krs_parameter, const KrsScene, KrsParameter)
ASKED_BY_INDEX(krs_texture, const KrsScene, KrsTexture)
ASKED_BY_INDEX(krs_state_slope, const KrsScene, KrsStateSlope)
ASKED_BY_INDEX(krs_camera_location, const KrsScene, KrsLocation)
ASKED_BY_INDEX(krs_state_camera, KrsState, KrsCamera)
ASKED_BY_INDEX(krs_component, const KrsScene, KrsComponent)
ASKED_BY_INDEX(krs_state_light, KrsState, KrsLight)
ASKED_BY_INDEX(krs_component_motion, const KrsScene, KrsMotion)

/* A function that tells the only struct of a state. */
#define ASKED(function, Struct)                                              \
    KrsStatus function##_sized(KrsState *state, Struct *answer, size_t size) \
    {                                                                        \
        Struct          own;                                                 \
        const KrsStatus status = function(state, &own);                      \
        if (status == KRS_OK)                                                \
            sized_give(answer, size, &own, sizeof own);                      \
        return status;                                                       \
    }
ASKED(krs_state_sky, KrsSky)
ASKED(krs_state_fog, KrsFog)

MADE_BY_OPTIONS(krs_mesh, KrsState, KrsMeshOptions, KrsMesh)
MADE_BY_OPTIONS(krs_mesh_simplify, const KrsMesh, KrsMeshOptions, KrsMesh)
MADE_BY_OPTIONS(krs_assemble, KrsState, KrsMeshOptions, KrsAssembly)
MADE_BY_OPTIONS(krs_grid_new, KrsState, KrsGridOptions, KrsGrid)
MADE_BY_OPTIONS(krs_slicer_new, KrsState, KrsSliceOptions, KrsSlicer)
MADE_BY_OPTIONS(krs_measure, KrsState, KrsMeasureOptions, KrsMeasures)

KrsStatus krs_text_sized(const KrsScene *scene, KrsTarget target, const KrsTextOptions *options,
                         size_t size, char **text)
{
    KrsTextOptions own;
    *text = NULL;
    if (!sized_take(&own, sizeof own, options, size))
        return KRS_BAD_ARGUMENT;
    return krs_text(scene, target, options ? &own : NULL, text);
}

void krs_scene_image_sized(const KrsScene *scene, KrsImage *image, size_t size)
{
    const KrsImage own = krs_scene_image(scene);
    sized_give(image, size, &own, sizeof own);
}

KrsStatus krs_bound_sized(const KrsScene *scene, size_t component, size_t index, KrsBound *bound,
                          size_t size)
{
    KrsBound        own;
    const KrsStatus status = krs_bound(scene, component, index, &own);
    if (status == KRS_OK)
        sized_give(bound, size, &own, sizeof own);
    return status;
}

KrsStatus krs_probe_sized(KrsState *state, const double (*points)[3], size_t count, KrsHit *hits,
                          size_t size)
{
    SizedArray array;
    if (!sized_open(&array, hits, size, sizeof(KrsHit), count))
        return KRS_OUT_OF_MEMORY;
    const KrsStatus status = krs_probe(state, points, count, array.own);
    sized_close(&array, status == KRS_OK ? count : 0);
    return status;
}

KrsStatus krs_raycast_sized(KrsState *state, const double (*origins)[3],
                            const double (*directions)[3], size_t count, double farthest,
                            double tolerance, KrsHit *hits, size_t size)
{
    SizedArray array;
    if (!sized_open(&array, hits, size, sizeof(KrsHit), count))
        return KRS_OUT_OF_MEMORY;
    const KrsStatus status = krs_raycast(state, origins, directions, count, farthest, tolerance,
                                         array.own);
    sized_close(&array, status == KRS_OK ? count : 0);
    return status;
}

void krs_grid_shape_sized(const KrsGrid *grid, KrsGridShape *shape, size_t size)
{
    const KrsGridShape own = krs_grid_shape(grid);
    sized_give(shape, size, &own, sizeof own);
}
