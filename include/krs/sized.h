/*
 * sized.h: what programs link with of krs.h and its parts, for structs of any size; it is included there.
 *
 * Each function hands on how large its struct is for the program that calls it.
 */
#ifndef KRS_SIZED_H
#define KRS_SIZED_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

KrsStatus krs_compile_text_sized(const char *text, size_t length, const char *name,
                                 const KrsOptions *options, size_t size, KrsScene **scene);
KrsStatus krs_compile_file_sized(const char *path, const KrsOptions *options, size_t size,
                                 KrsScene **scene);
KrsStatus krs_format_text_sized(const char *text, size_t length, const char *name,
                                const KrsOptions *options, size_t size, char **formatted,
                                bool *same);
KrsStatus krs_format_file_sized(const char *path, const KrsOptions *options, size_t size,
                                char **formatted, bool *same);
KrsStatus krs_scene_update_sized(const KrsScene *scene, const char *text, size_t length,
                                 KrsScene **updated, KrsChanges *changes, size_t size);
KrsStatus krs_scene_reload_sized(const KrsScene *scene, KrsScene **updated, KrsChanges *changes,
                                 size_t size);
KrsStatus krs_parameter_sized(const KrsScene *scene, size_t index, KrsParameter *parameter,
                              size_t size);
void      krs_scene_image_sized(const KrsScene *scene, KrsImage *image, size_t size);
KrsStatus krs_texture_sized(const KrsScene *scene, size_t index, KrsTexture *texture, size_t size);
KrsStatus krs_state_slope_sized(const KrsScene *scene, size_t index, KrsStateSlope *slope,
                                size_t size);
KrsStatus krs_camera_location_sized(const KrsScene *scene, size_t index, KrsLocation *location,
                                    size_t size);
KrsStatus krs_state_camera_sized(KrsState *state, size_t index, KrsCamera *camera, size_t size);
KrsStatus krs_state_light_sized(KrsState *state, size_t index, KrsLight *light, size_t size);
KrsStatus krs_state_sky_sized(KrsState *state, KrsSky *sky, size_t size);
KrsStatus krs_state_fog_sized(KrsState *state, KrsFog *fog, size_t size);
KrsStatus krs_text_sized(const KrsScene *scene, KrsTarget target, const KrsTextOptions *options,
                         size_t size, char **text);
KrsStatus krs_component_sized(const KrsScene *scene, size_t index, KrsComponent *component,
                              size_t size);
KrsStatus krs_bound_sized(const KrsScene *scene, size_t component, size_t index, KrsBound *bound,
                          size_t size);
KrsStatus krs_probe_sized(KrsState *state, const double (*points)[3], size_t count, KrsHit *hits,
                          size_t size);
KrsStatus krs_raycast_sized(KrsState *state, const double (*origins)[3],
                            const double (*directions)[3], size_t count, double farthest,
                            double tolerance, KrsHit *hits, size_t size);
KrsStatus krs_mesh_sized(KrsState *state, const KrsMeshOptions *options, size_t size,
                         KrsMesh **mesh);
KrsStatus krs_mesh_simplify_sized(const KrsMesh *mesh, const KrsMeshOptions *options, size_t size,
                                  KrsMesh **simplified);
KrsStatus krs_assemble_sized(KrsState *state, const KrsMeshOptions *options, size_t size,
                             KrsAssembly **assembly);
KrsStatus krs_component_motion_sized(const KrsScene *scene, size_t index, KrsMotion *motion,
                                     size_t size);
KrsStatus krs_grid_new_sized(KrsState *state, const KrsGridOptions *options, size_t size,
                             KrsGrid **grid);
void      krs_grid_shape_sized(const KrsGrid *grid, KrsGridShape *shape, size_t size);
KrsStatus krs_slicer_new_sized(KrsState *state, const KrsSliceOptions *options, size_t size,
                               KrsSlicer **slicer);
KrsStatus krs_measure_sized(KrsState *state, const KrsMeasureOptions *options, size_t size,
                            KrsMeasures **measures);

#ifndef KRS_LIBRARY
KRS_SIZED KrsStatus krs_compile_text(const char *text, size_t length, const char *name,
                                     const KrsOptions *options, KrsScene **scene)
{
    return krs_compile_text_sized(text, length, name, options, sizeof *options, scene);
}
KRS_SIZED KrsStatus krs_compile_file(const char *path, const KrsOptions *options, KrsScene **scene)
{
    return krs_compile_file_sized(path, options, sizeof *options, scene);
}
KRS_SIZED KrsStatus krs_format_text(const char *text, size_t length, const char *name,
                                    const KrsOptions *options, char **formatted, bool *same)
{
    return krs_format_text_sized(text, length, name, options, sizeof *options, formatted, same);
}
KRS_SIZED KrsStatus krs_format_file(const char *path, const KrsOptions *options, char **formatted,
                                    bool *same)
{
    return krs_format_file_sized(path, options, sizeof *options, formatted, same);
}
KRS_SIZED KrsStatus krs_scene_update(const KrsScene *scene, const char *text, size_t length,
                                     KrsScene **updated, KrsChanges *changes)
{
    return krs_scene_update_sized(scene, text, length, updated, changes, sizeof *changes);
}
KRS_SIZED KrsStatus krs_scene_reload(const KrsScene *scene, KrsScene **updated, KrsChanges *changes)
{
    return krs_scene_reload_sized(scene, updated, changes, sizeof *changes);
}
KRS_SIZED KrsStatus krs_parameter(const KrsScene *scene, size_t index, KrsParameter *parameter)
{
    return krs_parameter_sized(scene, index, parameter, sizeof *parameter);
}
KRS_SIZED KrsImage krs_scene_image(const KrsScene *scene)
{
    KrsImage image;
    krs_scene_image_sized(scene, &image, sizeof image);
    return image;
}
KRS_SIZED KrsStatus krs_texture(const KrsScene *scene, size_t index, KrsTexture *texture)
{
    return krs_texture_sized(scene, index, texture, sizeof *texture);
}
KRS_SIZED KrsStatus krs_state_slope(const KrsScene *scene, size_t index, KrsStateSlope *slope)
{
    return krs_state_slope_sized(scene, index, slope, sizeof *slope);
}
KRS_SIZED KrsStatus krs_camera_location(const KrsScene *scene, size_t index, KrsLocation *location)
{
    return krs_camera_location_sized(scene, index, location, sizeof *location);
}
KRS_SIZED KrsStatus krs_state_camera(KrsState *state, size_t index, KrsCamera *camera)
{
    return krs_state_camera_sized(state, index, camera, sizeof *camera);
}
KRS_SIZED KrsStatus krs_state_light(KrsState *state, size_t index, KrsLight *light)
{
    return krs_state_light_sized(state, index, light, sizeof *light);
}
KRS_SIZED KrsStatus krs_state_sky(KrsState *state, KrsSky *sky)
{
    return krs_state_sky_sized(state, sky, sizeof *sky);
}
KRS_SIZED KrsStatus krs_state_fog(KrsState *state, KrsFog *fog)
{
    return krs_state_fog_sized(state, fog, sizeof *fog);
}
KRS_SIZED KrsStatus krs_text(const KrsScene *scene, KrsTarget target, const KrsTextOptions *options,
                             char **text)
{
    return krs_text_sized(scene, target, options, sizeof *options, text);
}
KRS_SIZED KrsStatus krs_component(const KrsScene *scene, size_t index, KrsComponent *component)
{
    return krs_component_sized(scene, index, component, sizeof *component);
}
KRS_SIZED KrsStatus krs_bound(const KrsScene *scene, size_t component, size_t index,
                              KrsBound *bound)
{
    return krs_bound_sized(scene, component, index, bound, sizeof *bound);
}
KRS_SIZED KrsStatus krs_probe(KrsState *state, const double (*points)[3], size_t count,
                              KrsHit *hits)
{
    return krs_probe_sized(state, points, count, hits, sizeof *hits);
}
KRS_SIZED KrsStatus krs_raycast(KrsState *state, const double (*origins)[3],
                                const double (*directions)[3], size_t count, double farthest,
                                double tolerance, KrsHit *hits)
{
    return krs_raycast_sized(state, origins, directions, count, farthest, tolerance, hits,
                             sizeof *hits);
}
KRS_SIZED KrsStatus krs_mesh(KrsState *state, const KrsMeshOptions *options, KrsMesh **mesh)
{
    return krs_mesh_sized(state, options, sizeof *options, mesh);
}
KRS_SIZED KrsStatus krs_mesh_simplify(const KrsMesh *mesh, const KrsMeshOptions *options,
                                      KrsMesh **simplified)
{
    return krs_mesh_simplify_sized(mesh, options, sizeof *options, simplified);
}
KRS_SIZED KrsStatus krs_assemble(KrsState *state, const KrsMeshOptions *options,
                                 KrsAssembly **assembly)
{
    return krs_assemble_sized(state, options, sizeof *options, assembly);
}
KRS_SIZED KrsStatus krs_component_motion(const KrsScene *scene, size_t index, KrsMotion *motion)
{
    return krs_component_motion_sized(scene, index, motion, sizeof *motion);
}
KRS_SIZED KrsStatus krs_grid_new(KrsState *state, const KrsGridOptions *options, KrsGrid **grid)
{
    return krs_grid_new_sized(state, options, sizeof *options, grid);
}
KRS_SIZED KrsGridShape krs_grid_shape(const KrsGrid *grid)
{
    KrsGridShape shape;
    krs_grid_shape_sized(grid, &shape, sizeof shape);
    return shape;
}
KRS_SIZED KrsStatus krs_slicer_new(KrsState *state, const KrsSliceOptions *options,
                                   KrsSlicer **slicer)
{
    return krs_slicer_new_sized(state, options, sizeof *options, slicer);
}
KRS_SIZED KrsStatus krs_measure(KrsState *state, const KrsMeasureOptions *options,
                                KrsMeasures **measures)
{
    return krs_measure_sized(state, options, sizeof *options, measures);
}
#endif

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
