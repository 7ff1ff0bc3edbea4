/*
 * solids.h: solids by their definitions: what is inside, and points on the surface.
 *
 * Polyhedra are hulls of their vertices, tubes are swept by balls, solids of revolution by a
 * profile, prisms by a plane figure.  Samples are exact points of the surface.
 */
#ifndef ORACLE_SOLIDS_H
#define ORACLE_SOLIDS_H

#include "tests/oracle/brute.h"

/* The convex hull of a few points.  Zero is empty; add vertices, then close it. */
typedef struct Hull {
    Vec  vertices[48];
    int  vertex_count;
    Half faces[96];
    int  face_count;
} Hull;

void hull_add(Hull *hull, double x, double y, double z);
void hull_close(Hull *hull);
bool hull_contains(const Hull *hull, Vec point);
void hull_cloud(const Hull *hull, Cloud *cloud, double step);

/* A segment, the arc of a circle through three points, or a quadratic Bezier curve. */
typedef struct Curve {
    enum { CURVE_SEGMENT, CURVE_ARC, CURVE_BEZIER } kind;
    Vec    from, via, to;
    Vec    middle, right, up; /* of the arc's circle, scaled by its radius */
    double angle;
} Curve;

Curve curve_segment(Vec from, Vec to);
Curve curve_arc(Vec from, Vec via, Vec to); /* a segment when the three are on a line */
Curve curve_bezier(Vec from, Vec control, Vec to);
Vec   curve_at(const Curve *curve, double t);

/* The union of all balls along some curves; the radius goes linearly from one end of a curve
   to the other. */
typedef struct Sweep {
    Curve  curves[8];
    int    curve_count;
    double radius, radius_end;
} Sweep;

/* Least distance to a ball's centre less its radius: the distance, outside; < 0 inside. */
double sweep_depth(const Sweep *sweep, Vec point);
void   sweep_cloud(const Sweep *sweep, Cloud *cloud, double step);

/* Round patches about the y axis, or about the origin. */
void frustum_cloud(Cloud *cloud, double radius, double y, double radius_end, double y_end,
                   double step);
void torus_cloud(Cloud *cloud, double major, double minor, double step);
void ellipsoid_cloud(Cloud *cloud, Vec radii, double step);

/* A figure in the plane z = 0: a polygon (which may be concave), or a sweep cut by the plane. */
typedef struct Figure {
    Vec   corners[48];
    int   corner_count;
    Sweep stroke; /* used when there are no corners; constant radius */
} Figure;

void figure_add(Figure *figure, double x, double y);
bool figure_contains(const Figure *figure, double x, double y);
/* The figure's outline swept along z, with its two lids. */
void extrusion_cloud(const Figure *figure, double height, Cloud *cloud, double step);
/* The figure, `offset` away from the y axis, turned about it. */
void revolution_cloud(const Figure *figure, double offset, Cloud *cloud, double step);

#endif
