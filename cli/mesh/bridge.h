/*
 * bridge.h: glTF and 3MF, by the libraries tinygltf and libzip.
 */
#ifndef KRS_MESH_BRIDGE_H
#define KRS_MESH_BRIDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/mesh/poses.h"
#include "krs/krs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All properties of a material, as KrsHit has them. */
typedef struct MeshLook {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    double name KRS_NUMBERS_##type;
#include "krs/surface.def"
} MeshLook;

/* The pictures: colors; the roughness in green and the metallic in blue; and the emission, of which
   `look` has the brightest. */
enum { PICTURE_COLOR, PICTURE_GLOSS, PICTURE_GLOW, PICTURES };

/* A PNG file; its length is 0 if there is none. */
typedef struct MeshPicture {
    const char *bytes;
    size_t      length;
} MeshPicture;

typedef struct MeshMaterial {
    const char   *name;
    unsigned char color[3];        /* of its first triangle, sRGB */
    MeshLook      look;            /* the mean over its triangles */
    bool          varies;          /* from place to place: color and look are not those of all */
    bool          even;            /* all its triangles have this color */
    bool          baked[PICTURES]; /* what a picture shows of it */
    double        thickness; /* of solids that it lets light into, as vertices have lengths; or 0 */
} MeshMaterial;

/* A closed mesh. */
typedef struct MeshPart {
    size_t first_vertex, vertex_count, first_triangle, triangle_count;
    const double (*first_copy)[4]; /* where one of its copies is; NULL: it is where it is */
    bool steps;                    /* each triangle has the color of its middle: KrsMesh.steps */
} MeshPart;

/* Unit vectors, across each other; zeros where no material asks for them. */
typedef struct MeshFrame {
    float normal[3], tangent[3];
} MeshFrame;

/* The pose of a copy at some time, in seconds from 0, and in lengths of the scene. */
typedef struct MeshKey {
    double   time;
    MeshPose pose;
} MeshKey;

/* Keyframes of a copy, one after the other; a single one: it stands still. */
typedef struct MeshTrack {
    const MeshKey *keys;
    size_t         count;
} MeshTrack;

/* A thing with a name: a part, or copies of several. */
typedef struct MeshBody {
    const char    *name;
    KrsAssembly   *assembly;   /* where copies are; NULL: it is its only part */
    const size_t  *part_of;    /* the part of each item of the assembly that is a mesh */
    size_t         first_part; /* of it, in the order of items */
    size_t         lod_count;  /* parts behind its only one, which show it in less detail */
    const KrsBeam *beams;      /* that it is, without a part; by beams.c */
    size_t         beam_count;
    unsigned char  color[3]; /* of the beams */
    const MeshTrack
        *tracks; /* of its copies, in the order of krs_assembly_visit; NULL: it does not move */
} MeshBody;

/* Parts, one behind the other, and bodies that are made of them. */
typedef struct MeshParts {
    const double (*vertices)[3];
    const unsigned char (*colors)[3]; /* of vertices, sRGB */
    const uint32_t (*triangles)[3];   /* numbers count from the first vertex of all */
    const uint32_t *material_of;      /* of triangles */
    const double (*in_scene)[3];      /* where vertices are there: in one of the copies */
    /* Colors of the corners of triangles; NULL: they are those of the vertices. */
    const unsigned char (*corner_colors)[3][3];
    /* The places of corners of triangles in a texture, v upwards, and their frames; NULL: there is
       none.  After split_corners that is told of vertices, as are colors. */
    const double (*corner_places)[3][2];
    const MeshFrame (*corner_frames)[3];
    const double (*vertex_places)[2];
    const MeshFrame    *vertex_frames;
    const MeshPart     *parts;
    const MeshBody     *bodies;
    const MeshMaterial *materials;
    const MeshPicture *pictures; /* all PICTURES, at the places of vertices; NULL: there are none */
    size_t             part_count, body_count, material_count;
    double             scale;  /* from vertices to the lengths of the file */
    const char        *unit;   /* of those: um, mm, cm, m, in or ft */
    double             metres; /* which is so long */
} MeshParts;

static inline const unsigned char *mesh_corner_color(const MeshParts *parts, size_t triangle,
                                                     int corner)
{
    return parts->corner_colors ? parts->corner_colors[triangle][corner]
                                : parts->colors[parts->triangles[triangle][corner]];
}

/* Tells whether corners of such triangles have frames. */
bool mesh_needs_frames(const MeshMaterial *material);
/* Tells whether a picture shows something of it. */
bool mesh_is_baked(const MeshMaterial *material);

/* Returns the roughness of glTF, which is that across the tangent. */
double glb_roughness(double roughness, double anisotropy);

/* Takes the next bytes of the file; false: there has been a failure. */
typedef bool MeshSink(void *user, const void *bytes, size_t count);

/* Writes a GLB; false: the sink failed, or memory has run out. */
bool mesh_bridge_glb(const MeshParts *parts, MeshSink *sink, void *user);
bool mesh_bridge_3mf(const MeshParts *parts, MeshSink *sink, void *user);

#ifdef __cplusplus
}
#endif

#endif
