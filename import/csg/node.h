/*
 * node.h: a node of OpenSCAD's tree, `name(arguments) { nodes }`, and who makes a part
 * of it.
 */
#ifndef KRS_IMPORT_CSG_NODE_H
#define KRS_IMPORT_CSG_NODE_H

#include "import/common/part.h"

typedef enum CsgValueKind { CSG_NUMBER, CSG_TRUTH, CSG_UNDEF, CSG_STRING, CSG_LIST } CsgValueKind;

typedef struct CsgValue {
    CsgValueKind kind;
    double       number; /* of a truth value 0 or 1 */
    const char  *string;
    struct {
        struct CsgValue *items;
        size_t           count, capacity;
    } list;
} CsgValue;

typedef struct CsgArgument {
    const char *name; /* "" for one without */
    CsgValue    value;
} CsgArgument;

typedef struct CsgNode {
    Import     *import;
    const char *name;
    unsigned    line;
    struct {
        CsgArgument *items;
        size_t       count, capacity;
    } arguments;
    Part *parts; /* its nodes, those that are anything, as a union; NULL: there is none */
    bool  lacks; /* one of its nodes is nothing */
    bool  lacks_first;
} CsgNode;

/* Makes a part; *part stays NULL where the node is nothing.  False after a refusal. */
typedef bool CsgBuild(const CsgNode *node, Part **part);

CsgBuild csg_cube, csg_sphere, csg_cylinder, csg_polyhedron, csg_square, csg_circle, csg_polygon,
    csg_linear_extrude, csg_rotate_extrude, csg_hull, csg_minkowski, csg_offset, csg_text,
    csg_resize, csg_projection, csg_import, csg_surface;

/* Returns an argument; NULL: there is none of this name. */
const CsgValue *csg_argument(const CsgNode *node, const char *name);
/* Reads a number or truth value; `otherwise` where it is missing.  Refuses what is none. */
bool csg_number(const CsgNode *node, const char *name, double otherwise, double *number);
/* Reads `count` numbers, or one for all. */
bool csg_vector(const CsgNode *node, const char *name, double *numbers, int count);
/* Reads a list of points of 2 or 3 numbers, as points of space. */
bool csg_points(const CsgNode *node, const CsgValue *list, size_t numbers, double (**points)[3]);
/* Reads the sides of what $fn asks to have few of; 0: it is round.  Notes what is round now. */
bool csg_sides(const CsgNode *node, int *sides);
/* Joins its nodes to one part, all solids or all figures; refuses a mixture. */
bool csg_joined(const CsgNode *node, bool figure, Part **part);
/* Returns a polygon, which keeps the points. */
Part *csg_polygon_part(const CsgNode *node, double (*points)[3], size_t count);
/* Leaves the corners of the convex hull in x and y, counterclockwise; at most 2 when it is a line. */
size_t csg_convex_corners(Import *import, PartBalls *balls);
/* Returns the text of an argument. */
const char *csg_string(const CsgNode *node, const char *name, const char *otherwise);
/* Returns a part and all that is nearer to it than the radius. */
Part *csg_grown(const CsgNode *node, Part *part, double radius);

#endif
