/*
 * mesh.h: the part of krs.h that is about meshes; it is included there.
 */
#ifndef KRS_MESH_H
#define KRS_MESH_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/*
 * Meshes: triangles near the surface.
 *
 * The mesh is closed, each edge is in two triangles with opposite directions, and no two triangles
 * cross.  Triangles are counter-clockwise seen from outside.  Edges and corners of the surface are kept.
 */
typedef struct KrsMeshOptions {
    double error; /* largest distance between mesh and surface; 0: a 200th of the longest side of
                            the box */
    size_t component; /* from 1; 0: all */
    bool   within;    /* only what is in the box from `low` to `high`, for scenes without an end */
    double low[3], high[3];
    /* Flat faces, too, are of about even triangles.  Without it a solid of flat and round faces has no more triangles
       than these need. */
    bool even;
    /* Leaves out triangles that the error permits to leave out, as krs_mesh_simplify does.  Half of the error is for
       that where not all faces are flat or round.  Where memory does not suffice for so small an error, none is left out. */
    bool simplify;
    /* The shape alone counts.  Without it triangles have one material each where materials change
       in steps, as from part to part (KrsMesh.steps).  Where they change evenly, or parts are
       blended, triangles stay as even as the mesher makes them, so that colours at their corners
       show it. */
    bool shape;
    /* Looks at points and proves nothing: several times as fast.  What is thinner than some errors may be missed, and the
       error is that of these points. */
    bool   draft;
    size_t memory_limit; /* bytes; 0: KRS_USUAL_MEMORY */
    KRS_WAS(KrsProgressCallback *progress, bool (*go_on)(void *user, double fraction),
            "progress"); /* may be NULL */
    void *user;
} KrsMeshOptions;

typedef struct KrsMesh {
    double (*vertices)[3];
    size_t vertex_count;
    uint32_t (*triangles)[3];
    size_t triangle_count;
    double
        error; /* largest distance, of a point of either from the nearest of the other, as far as it is
                     proven */
    /* Places where the surface may be farther from the mesh than that: what is thinner than the error,
       or solids that touch.  The first of them is at `unresolved_at`.  Voids that are thinner than
       it and nowhere longer than twice of it are closed. */
    size_t unresolved;
    double unresolved_at[3];
    bool   estimate; /* of a component nothing is proven, as of its distance; or it is a draft */
    bool
        colored; /* no triangle was left out, since colours at their corners count: KrsMeshOptions.shape */
    /* There are several materials, which change in steps, as from part to part, and the mesh is not even: each triangle has
       the material of its middle, but for what is nearer than about two errors to its edges.  At corners several meet. */
    bool         steps;
    KrsAllocator allocator; /* that of the scene, where the memory came from */
} KrsMesh;

/*
 * Makes a mesh of what a state shows.  What is thicker than the error everywhere is never missed.
 * On KRS_OK the caller frees *mesh with krs_mesh_free; it may have no triangles.  KRS_BAD_ARGUMENT:
 * there is no such component; what is meshed has no end, or is no solid (surfaces without
 * thickness); or the error is below a 500,000th of the size.
 */
KRS_SIZED KrsStatus krs_mesh(KrsState *state, const KrsMeshOptions *options, KrsMesh **mesh);
void                krs_mesh_free(KrsMesh *mesh);

/*
 * Leaves out triangles that are not needed for the mesh to stay within an error of what it was, in both
 * directions.  Of the options it asks for error, which must not be 0, progress and user.  That is proven, and so is that the mesh is still closed and does not cross itself; where
 * it cannot be, fewer are left out, or none.  mesh->error grows by it.  *simplified is a mesh of its own.
 */
KRS_SIZED KrsStatus krs_mesh_simplify(const KrsMesh *mesh, const KrsMeshOptions *options,
                                      KrsMesh **simplified);

/* The placing of an item: x -> matrix (x, 1), which rotates, moves, mirrors and scales evenly. */
typedef struct KrsTransform {
    size_t item;
    double matrix[3][4];
} KrsTransform;

/* A mesh, or transforms of items before it. */
typedef struct KrsItem {
    KrsMesh *mesh;             /* NULL: it has transforms, */
    size_t   first, count;     /* these of the assembly's */
    double   copies;           /* number of its copies in all that is shown; 0: not used */
    double   first_copy[3][4]; /* of a mesh: where one of them is */
    /* The name of the innermost `let`, or of the component, that a mesh is of; NULL: it is of several.  It
       lives as long as the scene. */
    const char *name;
} KrsItem;

/* The meshes that a state shows, and their copies; the last item is all of it. */
typedef struct KrsAssembly {
    KrsItem *items;
    KRS_WAS(KrsTransform *transforms, KrsTransform *placings, "transforms");
    size_t item_count;
    KRS_WAS(size_t transform_count, size_t placing_count, "transform_count");
    double       low[3], high[3];   /* a box around all vertices of all copies */
    double       copies, triangles; /* of meshes, and of those copies */
    KrsAllocator allocator;         /* that of the scene, where the memory came from */
} KrsAssembly;

/*
 * Makes meshes as krs_mesh does: one for each generator of sequences, with the transforms of its
 * copies, and one for all else.  The error is that of copies; 0: a 200th of the longest side of
 * each generator's box.  Where generators overlap, so do meshes.  *assembly may be NULL on KRS_OK:
 * there is no sequence that can be taken apart.  None can with zones or `within`; one whose mirrors
 * cut anything, or may, or that inverts, cannot.  The scene must have been compiled with
 * KrsOptions.assembly.  With KrsOptions.motion what the time moves is taken apart as well.  Then
 * KRS_BAD_SCENE: something that moves cannot be taken apart.
 */
KRS_SIZED KrsStatus krs_assemble(KrsState *state, const KrsMeshOptions *options,
                                 KrsAssembly **assembly);
void                krs_assembly_free(KrsAssembly *assembly);
/* Finds the transforms of an assembly anew, as they are at the values and the time of the state, of which it was made or of
   another of this scene.  KRS_BAD_SCENE: a mirror would cut something.  The box and `first_copy` stay. */
KrsStatus krs_assembly_transform(KrsState *state, KrsAssembly *assembly);
/* Calls `visit` for each copy of each mesh, one behind the other, until it returns false; then that is
   returned. */
typedef bool KrsVisitCopy(void *user, const KrsItem *item, const double matrix[3][4]);
bool         krs_assembly_visit(const KrsAssembly *assembly, KrsVisitCopy *visit, void *user);

/* The motion of a component, of a scene that was compiled with KrsOptions.motion.  All are false
   for one that stands still. */
typedef struct KrsMotion {
    bool moves;    /* parts of it are moved or rotated: krs_assemble takes it apart */
    bool deforms;  /* something changes its form, or its size: a mesh is that of one time */
    bool recolors; /* its material changes */
} KrsMotion;
/* Finds the motion of component `index`, from 0.  KRS_BAD_ARGUMENT: there is none, or nobody
   asked. */
KRS_SIZED KrsStatus krs_component_motion(const KrsScene *scene, size_t index, KrsMotion *motion);

/* The convex hull of two balls. */
typedef struct KrsBeam {
    double ends[2][3], radii[2];
} KrsBeam;
/* Capsules and balls that a component is the sharp union of, at the values and the time of the state: writes them, unless `beams`
   is NULL, and returns how many they are.  0: it is something else, zones cut the scene, or nobody asked
   (KrsOptions.beams). */
size_t krs_component_beams(KrsState *state, size_t index, KrsBeam *beams);

/*
 * Finds where the material of the surface reads its texture, the first if there are several, at
 * some points: 0, 0 is the lower left corner of the picture and 1, 1 the upper right one.  Not a
 * number: it reads none.  These are coordinates as meshes have them; they jump where those of the
 * surface do.  The scene must have been compiled with KrsOptions.assembly.
 */
KrsStatus krs_texture_uvs(KrsState *state, const double (*points)[3], size_t count,
                          double (*uvs)[2]);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
