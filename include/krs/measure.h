/*
 * measure.h: the part of krs.h that is about the figures of a part that is to be made; it is included there.
 */
#ifndef KRS_MEASURE_H
#define KRS_MEASURE_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/*
 * Figures of what a state shows as a solid: volume, center, areas, walls, and how it lies best on a plate.  Lengths are
 * those of the scene, areas and volumes their powers.
 */
typedef struct KrsMeasureOptions {
    double error;     /* of the mesh by which areas and walls are found; as of KrsMeshOptions */
    size_t component; /* from 1; 0: all */
    bool   within;    /* only what is in the box from `low` to `high`, for scenes without an end */
    double low[3], high[3];
    double up[3]; /* away from the plate, of any length; 0, 0, 0: z */
    /* A face hangs over where it looks down, and leans from upright by more than this angle in radians: a wall leans by 0,
       a ceiling by a quarter turn.  0: an eighth of a turn. */
    double               overhang;
    double               nozzle;       /* thinner walls have `thin_area`; 0: none */
    size_t               memory_limit; /* bytes; 0: KRS_USUAL_MEMORY */
    KrsProgressCallback *progress;     /* may be NULL */
    void                *user;
} KrsMeasureOptions;

/* An orientation of a part on the plate. */
typedef struct KrsOrientation {
    double up[3];    /* unit; in the scene, away from the plate */
    double height;   /* along it */
    double base;     /* area that lies flat on the plate: within a degree */
    double overhang; /* area that hangs over, but for the base */
    bool
        stands; /* its center is above the inside of the convex hull of the base, which is no speck */
} KrsOrientation;

/* Says where the solid begins and ends along its inward normal. */
typedef struct KrsWall {
    double thickness;
    double from[3], to[3];
} KrsWall;

typedef struct KrsMeasures {
    double low[3], high[3];      /* a box around it, whose sides are off by `error` at most */
    double volume, volume_error; /* which is proven, unless `estimate` */
    double volume_change;        /* when cells were last made smaller: about how far it is off */
    double center[3],
        center_error; /* of mass, if it is the same everywhere; the error is proven likewise */
    double area;      /* of the mesh */
    double error;     /* proven distance of mesh and surface, as of KrsMesh */
    /* Walls are measured along the inward normals of places on the surface.  It is a wall where the other side faces away
       from the first by 30 degrees from opposite at most, so that edges are none.  The thinnest is looked for from the
       thinnest of these places on.  Its length is exact to rounding; what is narrower than `spacing` may be missed. */
    KrsWall wall; /* the thinnest; its thickness is infinite if there is none */
    double  spacing;
    double  thin_area; /* of places whose wall is thinner than the nozzle */
    /* The part as it is, and with each direction upwards that is along an axis or opposite to a
       flat face on which it can lie: first those that stand, and of these those with the least
       overhang. */
    KrsOrientation  as_is;
    KrsOrientation *orientations;
    size_t          orientation_count;
    size_t          unresolved; /* as of KrsMesh */
    double          unresolved_at[3];
    bool            estimate; /* of a component nothing is proven, as of its distance */
} KrsMeasures;

/*
 * Measures what a state shows.  On KRS_OK the caller frees *measures with krs_measures_free; where
 * nothing is solid, volume and area are 0.  KRS_BAD_ARGUMENT as of krs_mesh, and if an angle or a
 * length cannot be.
 */
KRS_SIZED KrsStatus krs_measure(KrsState *state, const KrsMeasureOptions *options,
                                KrsMeasures **measures);
void                krs_measures_free(KrsMeasures *measures);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
