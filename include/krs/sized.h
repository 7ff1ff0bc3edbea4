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
KrsStatus krs_format_sized(const char *path, const KrsOptions *options, size_t size,
                           char **formatted, bool *same);
KrsStatus krs_scene_update_sized(const KrsScene *scene, const char *text, size_t length,
                                 KrsScene **updated, KrsChanges *changes, size_t size);
KrsStatus krs_scene_reload_sized(const KrsScene *scene, KrsScene **updated, KrsChanges *changes,
                                 size_t size);
KrsStatus krs_parameter_sized(const KrsScene *scene, size_t index, KrsParameter *parameter,
                              size_t size);
void      krs_scene_image_sized(const KrsScene *scene, KrsImage *image, size_t size);
KrsStatus krs_texture_sized(const KrsScene *scene, size_t index, KrsTexture *texture, size_t size);
KrsStatus krs_frame_slope_sized(const KrsScene *scene, size_t index, KrsFrameSlope *slope,
                                size_t size);
KrsStatus krs_camera_place_sized(const KrsScene *scene, size_t index, KrsPlace *place, size_t size);
KrsStatus krs_frame_camera_sized(KrsFrame *frame, size_t index, KrsCamera *camera, size_t size);
KrsStatus krs_component_sized(const KrsScene *scene, size_t index, KrsComponent *component,
                              size_t size);
KrsStatus krs_bound_sized(const KrsScene *scene, size_t component, size_t index, KrsBound *bound,
                          size_t size);
KrsStatus krs_probe_sized(KrsFrame *frame, const double (*points)[3], size_t count, KrsHit *hits,
                          size_t size);
KrsStatus krs_raycast_sized(KrsFrame *frame, const double (*origins)[3],
                            const double (*directions)[3], size_t count, double farthest,
                            double tolerance, KrsHit *hits, size_t size);
KrsStatus krs_mesh_sized(KrsFrame *frame, const KrsMeshOptions *options, size_t size,
                         KrsMesh **mesh);
KrsStatus krs_mesh_simplify_sized(const KrsMesh *mesh, const KrsMeshOptions *options, size_t size,
                                  KrsMesh **simplified);
KrsStatus krs_assemble_sized(KrsFrame *frame, const KrsMeshOptions *options, size_t size,
                             KrsAssembly **assembly);
KrsStatus krs_component_motion_sized(const KrsScene *scene, size_t index, KrsMotion *motion,
                                     size_t size);
KrsStatus krs_grid_new_sized(KrsFrame *frame, const KrsGridOptions *options, size_t size,
                             KrsGrid **grid);
void      krs_grid_shape_sized(const KrsGrid *grid, KrsGridShape *shape, size_t size);
KrsStatus krs_slicer_new_sized(KrsFrame *frame, const KrsSliceOptions *options, size_t size,
                               KrsSlicer **slicer);
KrsStatus krs_measure_sized(KrsFrame *frame, const KrsMeasureOptions *options, size_t size,
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
KRS_SIZED KrsStatus krs_format(const char *path, const KrsOptions *options, char **formatted,
                               bool *same)
{
    return krs_format_sized(path, options, sizeof *options, formatted, same);
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
KRS_SIZED KrsStatus krs_frame_slope(const KrsScene *scene, size_t index, KrsFrameSlope *slope)
{
    return krs_frame_slope_sized(scene, index, slope, sizeof *slope);
}
KRS_SIZED KrsStatus krs_camera_place(const KrsScene *scene, size_t index, KrsPlace *place)
{
    return krs_camera_place_sized(scene, index, place, sizeof *place);
}
KRS_SIZED KrsStatus krs_frame_camera(KrsFrame *frame, size_t index, KrsCamera *camera)
{
    return krs_frame_camera_sized(frame, index, camera, sizeof *camera);
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
KRS_SIZED KrsStatus krs_probe(KrsFrame *frame, const double (*points)[3], size_t count,
                              KrsHit *hits)
{
    return krs_probe_sized(frame, points, count, hits, sizeof *hits);
}
KRS_SIZED KrsStatus krs_raycast(KrsFrame *frame, const double (*origins)[3],
                                const double (*directions)[3], size_t count, double farthest,
                                double tolerance, KrsHit *hits)
{
    return krs_raycast_sized(frame, origins, directions, count, farthest, tolerance, hits,
                             sizeof *hits);
}
KRS_SIZED KrsStatus krs_mesh(KrsFrame *frame, const KrsMeshOptions *options, KrsMesh **mesh)
{
    return krs_mesh_sized(frame, options, sizeof *options, mesh);
}
KRS_SIZED KrsStatus krs_mesh_simplify(const KrsMesh *mesh, const KrsMeshOptions *options,
                                      KrsMesh **simplified)
{
    return krs_mesh_simplify_sized(mesh, options, sizeof *options, simplified);
}
KRS_SIZED KrsStatus krs_assemble(KrsFrame *frame, const KrsMeshOptions *options,
                                 KrsAssembly **assembly)
{
    return krs_assemble_sized(frame, options, sizeof *options, assembly);
}
KRS_SIZED KrsStatus krs_component_motion(const KrsScene *scene, size_t index, KrsMotion *motion)
{
    return krs_component_motion_sized(scene, index, motion, sizeof *motion);
}
KRS_SIZED KrsStatus krs_grid_new(KrsFrame *frame, const KrsGridOptions *options, KrsGrid **grid)
{
    return krs_grid_new_sized(frame, options, sizeof *options, grid);
}
KRS_SIZED KrsGridShape krs_grid_shape(const KrsGrid *grid)
{
    KrsGridShape shape;
    krs_grid_shape_sized(grid, &shape, sizeof shape);
    return shape;
}
KRS_SIZED KrsStatus krs_slicer_new(KrsFrame *frame, const KrsSliceOptions *options,
                                   KrsSlicer **slicer)
{
    return krs_slicer_new_sized(frame, options, sizeof *options, slicer);
}
KRS_SIZED KrsStatus krs_measure(KrsFrame *frame, const KrsMeasureOptions *options,
                                KrsMeasures **measures)
{
    return krs_measure_sized(frame, options, sizeof *options, measures);
}
#endif

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
