/*
 * light.h: the part of krs.h that is about what lights a scene; it is included there.
 */
#ifndef KRS_LIGHT_H
#define KRS_LIGHT_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* The numbers of a member, by its kind in lights.def. */
#define KRS_LIGHT_NUMBERS_vector [3]
#define KRS_LIGHT_NUMBERS_color  [3]
#define KRS_LIGHT_NUMBERS_axis   [3]
#define KRS_LIGHT_NUMBERS_sides  [2]
#define KRS_LIGHT_NUMBERS_number

/* The types of lights, which have other shapes: a row of light_types.def each. */
typedef enum KrsLightType {
    KRS_LIGHT_ROUND, /* a ball, or a disc in the sky */
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc) KRS_LIGHT_##id = number,
#include "krs/light_types.def"
} KrsLightType;

typedef struct KrsLight {
    bool     positional; /* else directional */
    bool     shadow;
    bool     spot; /* it shines within a cone alone, of this `angle` from side to side */
    uint32_t type; /* a KrsLightType */
    double axis[3], right[3], up[3]; /* unit vectors where it shines, to its right, and up; or 0 */
    /* A member for each row of lights.def.  vector: position, or unit direction towards the light;
       color[3]: linear, already times the intensity; softness: angular diameter, or radius; angle: up
       to 2 pi; edge: the part of the cone over which the light fades, 0 to 1. */
#define KRS_LIGHT(member, kind, of_direction, of_position, ...) \
    double member KRS_LIGHT_NUMBERS_##kind;
#include "krs/lights.def"
} KrsLight;

/* A sky that is a picture of all directions: longitude from left to right, latitude from top to bottom.
   Its middle is the direction -z, and y is up. */
typedef struct KrsSkyMap {
    uint32_t width, height;
    uint64_t version;         /* others have another one, unless they are equal */
    const float (*texels)[3]; /* radiance, linear and not negative; rows from the top */
} KrsSkyMap;

typedef struct KrsSky {
    double zenith[3], horizon[3], ground[3]; /* linear radiance */
    const KrsSkyMap
        *map; /* NULL: there are these colours; lives until the state changes, or is asked again */
    double rotation;  /* of the map, radians, counterclockwise from above */
    double intensity; /* a factor for the map */
} KrsSky;

/* Fog takes the part density * exp(-fall * (y - base)) of the light away on a unit of length, and
   adds its color instead.  Without fog the density is 0. */
typedef struct KrsFog {
    double color[3]; /* linear radiance */
    double density, fall, base;
} KrsFog;

/* Return the lights of the scene or, if it has none, one that the compiler places.  The name is NULL
   if the light has none. */
size_t      krs_light_count(const KrsScene *scene);
const char *krs_light_name(const KrsScene *scene, size_t index);
/* Return a light, the sky and the fog at the state's parameters and time, as pictures have them.  KRS_BAD_ARGUMENT: there is
   no such light; KRS_OUT_OF_MEMORY: the map of a sky of daylight is made then. */
KRS_SIZED KrsStatus krs_state_light(KrsState *state, size_t index, KrsLight *light);
KRS_SIZED KrsStatus krs_state_sky(KrsState *state, KrsSky *sky);
KRS_SIZED KrsStatus krs_state_fog(KrsState *state, KrsFog *fog);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
