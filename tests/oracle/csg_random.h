/*
 * csg_random.h: random solids: trees of set operations on parts that are turned and moved.
 *
 * The number of a solid tells all of it.  Of each four one is level: its sizes and places are multiples of an eighth, so
 * faces lie in one plane, edges touch, and columns touch faces.  One is rich: half of its parts are letters, polygons with a
 * hole, what polygons revolve to, threads, columns that are blended with their plate, and sweeps.
 */
#ifndef KRS_CSG_RANDOM_H
#define KRS_CSG_RANDOM_H

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

using Vec     = std::array<double, 3>;
using Outline = std::vector<std::array<double, 2>>;

inline Vec operator+(const Vec &a, const Vec &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec &a, const Vec &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(double s, const Vec &a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vec &a, const Vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec    cross(const Vec &a, const Vec &b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/* About an axis of length 1, by Rodrigues' formula; quarter turns are exact. */
struct Turn {
    Vec    axis  = {0, 1, 0};
    double angle = 0, c = 1, s = 0;
    Vec    operator()(const Vec &p) const
    {
        return c * p + s * cross(axis, p) + (1 - c) * dot(axis, p) * axis;
    }
};

enum Kind {
    BOX,
    CYLINDER,
    PRISM,
    POLYGON,
    BALL,
    CONE,
    FRUSTUM,
    RING,
    SIMPLE, /* kinds before this one */
    LETTER = SIMPLE,
    HOLED,
    REVOLVED,
    THREAD,
    BLENDED,
    SWEPT,
    KINDS
};

/* How the column of a BLENDED part is joined with its plate. */
enum Blend { QUADRATIC, CUBIC, CIRCULAR, CHAMFER, FILLET, BLENDS };

/*
 * What sizes mean:
 *   LETTER      of the em, of the extrusion
 *   HOLED       of the extrusion
 *   REVOLVED    how far the polygon is moved outwards; 0: it begins and ends on the axis
 *   THREAD      diameter, pitch (below 0: left-handed), length, what the ends lose of the radius
 *   BLENDED     radius of the column, its height over the plate, width of the blend, thickness of the plate
 *   SWEPT       of the rectangle, beside the path and upwards
 */
struct Part {
    Kind    kind;
    double  size[4] = {0, 0, 0, 0};
    Outline corners, hole; /* counter-clockwise; of a sweep its path in x and z */
    char    letter = 0;
    int     starts = 1;
    Blend   blend  = QUADRATIC;
    Turn    turn;
    Vec     shift;
};

struct Tree {
    Part                  part;         /* of a leaf */
    char                  csg_node = 0; /* of others: | - & */
    std::unique_ptr<Tree> left, right;
};

struct Solid {
    std::unique_ptr<Tree> tree;
    double                error;
    bool                  level, rich;
    Turn                  turn; /* of the whole, for krs alone */
};

Solid random_solid(uint64_t number);

/* As a scene. */
std::string text_of(const Solid &solid);

/* Returns half of the plate of a BLENDED part, how deep the column stands in it, and how far a
   thread's ridge is from its core. */
inline double       half_plate(const Part &part) { return part.size[0] + part.size[2] + 0.15; }
static const double DEEP = 0.1;
inline double       thread_depth(const Part &part)
{
    return 0.54 * (part.size[1] < 0 ? -part.size[1] : part.size[1]);
}

#endif
