/*
 * mesh_border.h: glTF and 3MF, by the libraries tinygltf and lib3mf.
 */
#ifndef KRS_MESH_BORDER_H
#define KRS_MESH_BORDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct MeshMaterial {
    const char   *name;
    unsigned char color[3]; /* sRGB */
    double        roughness, metallic;
} MeshMaterial;

/* A closed mesh with a name. */
typedef struct MeshPart {
    const char *name;
    size_t      first_vertex, vertex_count, first_triangle, triangle_count;
} MeshPart;

/* Parts, one behind the other, in the lengths of the file. */
typedef struct MeshParts {
    const double (*vertices)[3];
    const unsigned char (*colors)[3]; /* of vertices, sRGB */
    const uint32_t (*triangles)[3];   /* numbers count from the first vertex of all */
    const uint32_t     *material_of;  /* of triangles */
    const MeshPart     *parts;
    const MeshMaterial *materials;
    size_t              part_count, material_count;
    double              scale;  /* from vertices to the lengths of the file */
    const char         *unit;   /* of those: um, mm, cm, m, in or ft */
    double              metres; /* which is so long */
} MeshParts;

/* Takes the next bytes of the file; false: there has been a failure. */
typedef bool MeshSink(void *user, const void *bytes, size_t count);

/* False: the sink failed, or memory has run out. */
bool mesh_border_glb(const MeshParts *parts, MeshSink *sink, void *user);
bool mesh_border_3mf(const MeshParts *parts, MeshSink *sink, void *user);

#ifdef __cplusplus
}
#endif

#endif
