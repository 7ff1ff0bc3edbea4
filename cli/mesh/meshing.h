/*
 * meshing.h: one run of `krs mesh`, or one of an edit that `krs watch` makes: mesh.c makes the meshes, parts.c what
 * files have of them.
 */
#ifndef KRS_MESHING_H
#define KRS_MESHING_H

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/mesh/files.h"

/* --split, in the order of split_choices. */
enum { SPLIT_NONE, SPLIT_COMPONENTS, SPLIT_MATERIALS };

/* Triangles that a file of copies may have where nobody asked for each of them, and one that is made in
   memory in any case. */
#define MAX_TRIANGLES 10e6
/* Copies that a file may have. */
#define MAX_INSTANCES 4194304

/* A mesh, or meshes with copies: one of both. */
typedef struct Body {
    KrsMesh     *mesh;
    KrsAssembly *assembly;
    size_t       component;      /* from 1; 0: all that is shown */
    KrsMesh     *lods[MAX_LODS]; /* levels of detail of the mesh, each coarser */
    size_t       lod_count;
    KrsBeam     *beams; /* instead of a mesh, with --beams */
    size_t       beam_count;
} Body;

typedef struct Bodies {
    Body  *items;
    size_t count, capacity;
} Bodies;

/* The sizes of bodies. */
typedef struct Summary {
    double low[3], high[3];
    double error, triangles, vertices, copies;
    size_t unresolved;
    double unresolved_at[3];
    bool   estimate, colored;
    size_t beams;
} Summary;

typedef struct Meshing {
    const Options  *options;
    const KrsScene *scene;
    KrsState       *state;
    KrsMeshOptions  how;
    double          scale; /* from the scene to the file */
    Progress        progress;
    double          done, begun, goal; /* of all work: done, and before and after this step of it */
    Bodies          merged, assembled; /* each is made if some file is of it */
    size_t          moving, keys;      /* copies that move, and their keyframes */
    double
        farthest; /* from where they belong that these are between keyframes, as far as samples tell, */
    size_t jumps; /* but for so many times between two of the nearest */
    double pixel; /* how long one of --bake is in the scene; 0: there is none */
    bool (*outdated)(
        void *user); /* asked by one thread at a time: true ends the work; NULL: it never is */
    void *user;      /* handed to `outdated` */
} Meshing;

/* mesh.c: the steps of `krs mesh`, which `krs watch` takes again and again: whether the files can be written; then makes
   the meshes of the scene, writes them, and says what they are.  A Meshing is for one scene. */
KrsStatus check_mesh_outputs(const Meshing *meshing);
KrsStatus write_meshes(Meshing *meshing);

/* options.c: the files that are written. */
size_t      output_count(const Meshing *meshing);
const char *output_path(const Meshing *meshing, size_t index);
/* Tells how long what is meshed is; false: it has no end. */
bool find_end(const Meshing *meshing, double *longest);
/* Fills in what is meshed, as of all commands that take a solid; and how, as of `krs mesh` alone. */
KrsStatus check_common_options(Meshing *meshing);
KrsStatus check_mesh_options(Meshing *meshing);
/* Tells whether files have neither colors nor parts with names. */
bool has_shapes_alone(const Meshing *meshing);
/* Reports that there is nothing to `what`: where, unless that is all or the box of --within, and
   which error may have left out what there is (0: none).  Returns KRS_BAD_SCENE. */
KrsStatus say_nothing(const Meshing *meshing, const char *what, const char *where, double error);

/* summary.c: of all bodies; lengths are those of the scene. */
Summary summarize(const Bodies *bodies);
double  longest_side(const Bodies *bodies);
/* Returns the largest of its copies. */
double assembly_error(const KrsAssembly *assembly);

/* parts.c: what files have of bodies. */
size_t parts_vertex_count(const MeshParts *parts);
size_t parts_triangle_count(const MeshParts *parts);
void   find_parts(const Meshing *meshing, const Bodies *bodies, MeshParts *parts);
/* Returns the sRGB byte of a linear number. */
unsigned char color_byte(double linear);
/* Does the same without copies: a part has all triangles of a body. */
void flatten_parts(const Meshing *meshing, MeshParts *parts);
/* looks.c: the materials of triangles, as a format has them; warns of what a file is without. */
void find_materials(const Meshing *meshing, const MeshFormat *format, const char *path,
                    MeshParts *parts);
/* The name of a material that is only a color, in krs_material_name. */
#define PLAIN_COLOR "colour"
/* Gives each vertex a number that is the same for all of a connected surface. */
const uint32_t *mesh_shells(Arena *arena, const MeshParts *parts);
/* Finds where the middle of a triangle is in the scene. */
void mesh_middle(const MeshParts *parts, size_t triangle, double middle[3]);
/* uvs.c: where triangles are in textures, if there are any. */
KrsStatus find_uvs(const Meshing *meshing, MeshParts *parts);
/* frames.c: frames of the corners of triangles whose materials ask for them. */
void find_frames(const Meshing *meshing, MeshParts *parts);
/* split.c: tells of vertices what is known of corners, by doubling those of which corners differ: colors, and
   with `all` places and frames. */
void split_corners(Arena *arena, MeshParts *parts, bool all);
/* bake.c: with --bake, pictures of what varies, at places of corners.  Points are at most by `error` off the surface. */
KrsStatus bake_materials(Meshing *meshing, MeshParts *parts, double error);
/* The units of unit_choices in metres. */
extern const double metres_of_units[];
/* Sets the unit of length of the file. */
void set_units(const Meshing *meshing, const MeshFormat *format, MeshParts *parts);

/* steps.c: the next step of the work, which is done to `goal` behind it; and the goal of the first of so many until one. */
void   enter_step(Meshing *meshing, double goal);
double step_of(const Meshing *meshing, double goal, double steps);
/* Tells whether the mesh is wanted still; false: the work ends with KRS_INTERRUPTED. */
bool mesh_is_wanted(const Meshing *meshing);

/* beams.c: with --beams, whether files have them; a body of beams, if a component is made of them (from 1; 0: the only
   one); and what files have of it. */
KrsStatus check_beams(const Meshing *meshing);
bool      add_beams(const Meshing *meshing, size_t component, Bodies *bodies);
void      take_beams(const Meshing *meshing, const Body *body, MeshBody *to);

/* lods.c: levels of detail of a body that has triangles, as many as options ask for. */
KrsStatus make_lods(Meshing *meshing, Body *body, double goal);

/* motion.c: with --frames, whether the scene has what is asked for; and the tracks of bodies. */
KrsStatus check_motion(const Meshing *meshing);
KrsStatus find_motion(Meshing *meshing, MeshParts *parts);

/* Calls `visit` for each mesh of a body. */
typedef void VisitMesh(void *user, const KrsMesh *mesh, const KrsItem *item);
void         visit_meshes(const Body *body, VisitMesh *visit, void *user);

#endif
