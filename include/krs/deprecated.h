/*
 * deprecated.h: names of version 0.2 that are others now, which stay for one more; krs.h includes it.
 */
#ifndef KRS_DEPRECATED_H
#define KRS_DEPRECATED_H

#ifdef __cplusplus
extern "C" {
#endif

/* A function that has another name now, and one that returns nothing. */
#define KRS_RENAMED(Type, was, is, parameters, arguments)  \
    KRS_DEPRECATED(#is) static inline Type was parameters; \
    static inline Type was                     parameters { return is arguments; }
#define KRS_RENAMED_VOID(was, is, parameters, arguments)   \
    KRS_DEPRECATED(#is) static inline void was parameters; \
    static inline void was                     parameters { is arguments; }

#define KRS_MOST_ZONES      KRS_MAX_ZONES
#define KRS_MOST_COORDINATE KRS_MAX_COORDINATE
#define KRS_MOST_STEPS      KRS_MAX_STEPS

typedef KrsState KrsFrame           KRS_DEPRECATED("KrsState");
typedef KrsStateSlope KrsFrameSlope KRS_DEPRECATED("KrsStateSlope");
KRS_RENAMED(KrsStatus, krs_frame_new, krs_state_new, (const KrsScene *scene, KrsState **state),
            (scene, state))
KRS_RENAMED_VOID(krs_frame_free, krs_state_free, (KrsState * state), (state))
KRS_RENAMED(KrsStatus, krs_frame_update, krs_state_update,
            (KrsState * state, const KrsScene *scene), (state, scene))
KRS_RENAMED(KrsStatus, krs_frame_set, krs_state_set,
            (KrsState * state, const char *name, const double *values, size_t count),
            (state, name, values, count))
KRS_RENAMED(KrsStatus, krs_frame_set_time, krs_state_set_time, (KrsState * state, double time),
            (state, time))
KRS_RENAMED(double, krs_frame_time, krs_state_time, (const KrsState *state), (state))
KRS_RENAMED(KrsStatus, krs_frame_place_camera, krs_state_fit_camera, (KrsState * state), (state))
KRS_RENAMED(const char *, krs_frame_unbounded, krs_state_unbounded, (const KrsState *state),
            (state))
KRS_RENAMED_VOID(krs_frame_parameters, krs_state_parameters,
                 (const KrsState *state, float (*block)[4]), (state, block))
KRS_RENAMED_VOID(krs_frame_values, krs_state_values, (const KrsState *state, float (*block)[4]),
                 (state, block))
KRS_RENAMED_VOID(krs_frame_tables, krs_state_tables,
                 (const KrsState *state, float (*rows)[4], uint32_t (*cells)[2]),
                 (state, rows, cells))
KRS_RENAMED(size_t, krs_frame_slope_count, krs_state_slope_count, (const KrsScene *scene), (scene))
KRS_RENAMED(KrsStatus, krs_frame_slope, krs_state_slope,
            (const KrsScene *scene, size_t index, KrsStateSlope *slope), (scene, index, slope))
KRS_RENAMED(KrsStatus, krs_frame_set_zones, krs_state_set_zones,
            (KrsState * state, const double (*zones)[4], size_t count), (state, zones, count))
KRS_RENAMED(KrsStatus, krs_frame_camera, krs_state_camera,
            (KrsState * state, size_t index, KrsCamera *camera), (state, index, camera))

KRS_RENAMED(KrsStatus, krs_format, krs_format_file,
            (const char *path, const KrsOptions *options, char **formatted, bool *same),
            (path, options, formatted, same))
typedef KrsLocation KrsPlace    KRS_DEPRECATED("KrsLocation");
typedef KrsTransform KrsPlacing KRS_DEPRECATED("KrsTransform");
KRS_RENAMED(KrsStatus, krs_camera_place, krs_camera_location,
            (const KrsScene *scene, size_t index, KrsLocation *location), (scene, index, location))
KRS_RENAMED(KrsStatus, krs_texture_places, krs_texture_uvs,
            (KrsState * state, const double (*points)[3], size_t count, double (*uvs)[2]),
            (state, points, count, uvs))

/* These do what those of camera.h do. */
void krs_camera_orbit(KrsCamera *camera, double right, double up);
KRS_RENAMED_VOID(krs_camera_turn, krs_camera_orbit, (KrsCamera * camera, double right, double up),
                 (camera, right, up))
bool krs_state_component_box(KrsState *state, size_t component, double low[3], double high[3]);
bool krs_state_box(KrsState *state, double low[3], double high[3]);
KRS_RENAMED(bool, krs_frame_component_box, krs_state_component_box,
            (KrsState * state, size_t component, double low[3], double high[3]),
            (state, component, low, high))
KRS_RENAMED(bool, krs_frame_box, krs_state_box, (KrsState * state, double low[3], double high[3]),
            (state, low, high))

#ifdef __cplusplus
}
#endif
#endif
