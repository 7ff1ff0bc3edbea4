/*
 * grid.h: the part of krs.h that is about grids; it is included there.
 */
#ifndef KRS_KRS_GRID_H
#define KRS_KRS_GRID_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/*
 * Grids: what a state shows, sampled at points whose coordinates are whole multiples of the side of the cells.
 *
 * A sample is a signed distance, negative inside: its sign is right, and its size never above the distance to the
 * nearest surface.  Or, with `fog`, it is the part of the cube around it that is solid, from 0 to 1.
 */
typedef struct KrsGridOptions {
    double cell; /* side of the cells, above 0 */
    /* Distances are told up to so many cells; where the surface is farther they are that, with
       their sign.  0: they are told everywhere. */
    double band;
    bool   fog;
    /* Distances are at most `error` below the true ones, as far as the mesh that they come from is proven
       (krs_mesh).  The error is a length, and without it a tenth of a cell. */
    bool   exact;
    double error;
    /* The first sample along each axis is a whole multiple of KRS_BRICK_SIDE, as OpenVDB has it. */
    bool   aligned;
    bool   materials; /* also colours, and numbers of materials */
    size_t component; /* from 1; 0: all */
    bool   within;    /* only what is in the box from `low` to `high`, for scenes without an end */
    double low[3], high[3];
    size_t memory_limit;           /* bytes; 0: KRS_USUAL_MEMORY */
    KrsProgressCallback *progress; /* may be NULL */
    void                *user;
} KrsGridOptions;

/* Samples are dealt out in bricks of so many along each axis. */
#define KRS_BRICK_SIDE    8
#define KRS_BRICK_SAMPLES 512
/* Along an axis. */
#define KRS_MAX_CELLS 1e9

/* Sample i, j, k is at (first[0] + i, first[1] + j, first[2] + k) times the cell. */
typedef struct KrsGridShape {
    double  cell, band; /* lengths; band 0: none */
    int64_t first[3];
    size_t  count[3]; /* of samples; 0: there is nothing solid */
    /* The length by which distances may be below the true ones where `exact` is asked for, else 0. */
    double error;
    /* The places of the mesh behind exact distances that have no proof of that, and the first of
       them. */
    size_t unresolved;
    double unresolved_at[3];
    bool   outside;  /* distances are exact outside of the solid, but for rounding */
    bool   estimate; /* of a component nothing is proven, as of its distance */
} KrsGridShape;

/* Samples at[0] to at[0] + 7 and so on, x first; where the grid ends within a brick, those behind are there, too. */
typedef struct KrsGridBrick {
    size_t at[3];
    /* False: the surface is farther away from all than the band, and all values are equal; colours and materials
       are 0. */
    bool         near;
    const float *values;
    const float (*colors)[3];  /* linear Rec.709, of the nearest part; NULL: not asked for */
    const uint32_t *materials; /* as in KrsHit; NULL: not asked for */
} KrsGridBrick;

typedef struct KrsGrid KrsGrid;

/*
 * Prepares a grid of what a state shows, which must stay as it is until the grid is freed.  The grid reaches beyond
 * what is solid by the band, or without one by 3 cells; with `fog` by one.  With `exact` this takes most of the time.
 * KRS_BAD_ARGUMENT: there is no such component; what is sampled has no end, or is no solid (surfaces without
 * thickness); the grid is longer than KRS_MAX_CELLS along an axis, or that far from the origin; or the error is below
 * what krs_mesh takes.
 */
KRS_SIZED KrsStatus    krs_grid_new(KrsState *state, const KrsGridOptions *options, KrsGrid **grid);
void                   krs_grid_free(KrsGrid *grid);
KRS_SIZED KrsGridShape krs_grid_shape(const KrsGrid *grid);

/* Sets another band and another alignment than those of the options, for other files of the same
   distances: what they come from stays.  KRS_BAD_ARGUMENT: as of krs_grid_new; then this is to be
   called again before the samples are visited. */
KrsStatus krs_grid_set_band(KrsGrid *grid, double band, bool aligned);

/* Told of a brick, which lives until it returns; false: stop, with KRS_IO_ERROR. */
typedef bool KrsVisitBrick(void *user, const KrsGridBrick *brick);

/*
 * Computes the samples, by all processors at once, and calls `visit` for each brick in the caller's thread: along x,
 * then y, then z.  Memory is that of some runs of bricks along x.  What is proven to be farther from the surface than
 * the band is not evaluated.
 */
KrsStatus krs_grid_visit(KrsGrid *grid, KrsVisitBrick *visit, void *user);
/* Tells how many bricks are near, without computing what is in them. */
KrsStatus krs_grid_count_near(KrsGrid *grid, size_t *count);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
