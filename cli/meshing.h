/*
 * meshing.h: one run of `krs mesh`: mesh.c makes the meshes, mesh_parts.c what files have of them.
 */
#ifndef KRS_MESHING_H
#define KRS_MESHING_H

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/mesh_files.h"

/* --split, in the order of split_choices. */
enum { SPLIT_NONE, SPLIT_COMPONENTS, SPLIT_MATERIALS };

/* Triangles that a file of copies may have where nobody asked for each of them, and one that is made in
   memory in any case. */
#define MOST_TRIANGLES 10e6
/* Copies that a file may have. */
#define MOST_INSTANCES 4194304

/* A mesh, or meshes with copies: one of both. */
typedef struct Body {
    KrsMesh     *mesh;
    KrsAssembly *assembly;
    size_t       component; /* from 1; 0: all that is shown */
} Body;

typedef struct Bodies {
    Body  *items;
    size_t count, capacity;
} Bodies;

typedef struct Meshing {
    const Options  *options;
    const KrsScene *scene;
    KrsFrame       *frame;
    KrsMeshOptions  how;
    double          scale; /* from the scene to the file */
    Progress        progress;
    Bodies          merged, assembled; /* each is made if some file is of it */
} Meshing;

/* mesh_parts.c: what files have of bodies. */
void find_parts(const Meshing *meshing, const Bodies *bodies, MeshParts *parts);
/* The same without copies: a part has all triangles of a body. */
void flatten_parts(const Meshing *meshing, MeshParts *parts);
/* What a length of 1 is in the file. */
void set_units(const Meshing *meshing, const MeshFormat *format, MeshParts *parts);

/* Calls `visit` for each mesh of a body. */
typedef void VisitMesh(void *user, const KrsMesh *mesh, const KrsItem *item);
void         visit_meshes(const Body *body, VisitMesh *visit, void *user);

#endif
