/*
 * files.h: files of triangles.
 */
#ifndef KRS_MESH_FILES_H
#define KRS_MESH_FILES_H

#include "cli/mesh/copies.h"
#include "cli/shell/supervise.h"

/* The last place of a vertex in a texture, and the number of its line; 0: it had none yet. */
typedef struct ObjPlace {
    double   at[2];
    uint32_t number;
} ObjPlace;

/* A mesh that is being written. */
typedef struct MeshFile {
    const MeshParts *parts;
    size_t           vertex_count, triangle_count; /* of all copies */
    OutputFile      *file;
    char             buffer[1 << 16];
    size_t           length;
    size_t           base; /* vertices of the copies before this one */
    size_t           body;
    uint32_t         material; /* that was named last */
    ObjPlace        *places;   /* of vertices of parts, if corners of triangles have places */
    uint32_t         place_count;
} MeshFile;

typedef struct MeshFormat {
    const char *ending;
    bool        has_colors, has_parts, has_copies, has_lods, has_looks, has_motion, has_face_colors;
    bool        has_beams;
    bool        has_places, places_of_vertices; /* in textures: of corners, or of vertices only */
    bool (*write)(MeshFile *file);
    double rounding; /* of coordinates, relative */
} MeshFormat;

/* Returns the format by the ending of a path; NULL: there is none. */
const MeshFormat *mesh_format(const char *path);
#define MESH_ENDINGS ".stl, .ply, .obj, .glb or .3mf"

/* Writes a mesh in a format, to its last byte; false: file->error tells why not. */
bool mesh_file_write(MeshFile *file, const MeshFormat *format);

#endif
