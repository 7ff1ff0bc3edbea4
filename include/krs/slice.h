/*
 * slice.h: the part of krs.h that is about sections; it is included there.
 */
#ifndef KRS_SLICE_H
#define KRS_SLICE_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/*
 * Sections: where a plane cuts what a state shows, as closed contours.
 *
 * Contours have the solid on their left: outer ones are counter-clockwise, those of holes clockwise.  Points are on
 * the surface, and its corners are points.
 */
typedef struct KrsSliceOptions {
    /* Largest distance between contours and the outline of the section; 0: a 2000th of the longest side of the box. */
    double error;
    size_t component; /* from 1; 0: all */
    bool   within;    /* only what is in the box from `low` to `high`, for scenes without an end */
    double low[3], high[3];
    bool   arcs;  /* contours are of lines and arcs of circles, where these are within the error */
    bool   lines; /* with `arcs`: sections also have contours of lines */
    size_t memory_limit;           /* bytes; 0: KRS_USUAL_MEMORY */
    KrsProgressCallback *progress; /* may be NULL */
    void                *user;
} KrsSliceOptions;

/* A point of a plane, and the direction from which it is seen, of any length but 0. */
typedef struct KrsSectionPlane {
    double point[3], normal[3];
} KrsSectionPlane;

/* Finds the unit directions of a plane's x and y, as it is seen: y goes up as the scene's y does;
   where that is along the normal, x goes as the scene's. */
void krs_plane_axes(const KrsSectionPlane *plane, double right[3], double up[3]);

/* Points first to first + count - 1 of a section, of which the last is joined to the first. */
typedef struct KrsContour {
    size_t first, count;
    double area; /* negative: of a hole */
} KrsContour;

typedef struct KrsSection {
    double (*points)[2]; /* products of points in the scene with the plane's axes */
    /* The bulge of the piece behind each point, with `arcs`: the tangent of a quarter of the angle
       by which it turns, above 0 to the left; 0 is a line.  Else NULL. */
    double     *bulges;
    size_t      point_count;
    KrsContour *contours;
    size_t      contour_count;
    /* Places with something, solid or between solids, that is thinner than `thinnest` and not in the contours; the first
       of them is a point of the scene. */
    size_t lost;
    double lost_at[3], thinnest;
    /* The section without arcs, which is freed with this one, if `arcs` and `lines` are set; else
       NULL. */
    struct KrsSection *lines;
} KrsSection;

typedef struct KrsSlicer KrsSlicer;

/*
 * Makes what is needed to make sections of what a state shows, which must stay as it is until the
 * slicer is freed.  KRS_BAD_ARGUMENT: there is no such component; what is cut has no end, or is no
 * solid (surfaces without thickness); or the error is below a ten-millionth of the size.
 */
KRS_SIZED KrsStatus krs_slicer_new(KrsState *state, const KrsSliceOptions *options,
                                   KrsSlicer **slicer);
void                krs_slicer_free(KrsSlicer *slicer);
/* Sets another error than that of the options, which the box may tell: at least a ten-millionth of
   the size. */
KrsStatus krs_slicer_set_error(KrsSlicer *slicer, double error);
/* Finds the box around what is cut; false: there is nothing. */
bool krs_slicer_box(const KrsSlicer *slicer, double low[3], double high[3]);

/*
 * Sections by some planes, by all processors at once; memory is that for as many sections as there are processors,
 * and the results.  Two contours do not cross, nor does one itself, where what is between them is thicker than three
 * errors.  On KRS_OK the caller frees each with krs_section_free; it may have no contours.
 */
KrsStatus krs_slice(KrsSlicer *slicer, const KrsSectionPlane *planes, size_t count,
                    KrsSection **sections);
void      krs_section_free(KrsSection *section);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
