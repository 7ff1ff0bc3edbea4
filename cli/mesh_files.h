/*
 * mesh_files.h: files of triangles.
 */
#ifndef KRS_MESH_FILES_H
#define KRS_MESH_FILES_H

#include "cli/supervise.h"

/* A mesh as it is written: in the units of the file. */
typedef struct MeshFile {
    const KrsMesh *mesh;
    double         scale;
    const unsigned char (*colors)[3]; /* of vertices, sRGB */
    OutputFile *file;
    char        buffer[1 << 16];
    size_t      length;
} MeshFile;

typedef struct MeshFormat {
    const char *ending;
    bool (*write)(MeshFile *file);
} MeshFormat;

/* The format by the ending of a path; NULL: there is none. */
const MeshFormat *mesh_format(const char *path);
/* ".stl, .ply or .obj" */
#define MESH_ENDINGS ".stl, .ply or .obj"

/* Writes all but what the writer left in the buffer, and that. */
bool mesh_file_write(MeshFile *file, const MeshFormat *format);

#endif
