/*
 * csg_triangles.h: what is known of triangles: their shape, how far they are from others, and whether they cross.
 */
#ifndef KRS_CSG_TRIANGLES_H
#define KRS_CSG_TRIANGLES_H

#include <cstddef>

#include "tests/oracle/csg_random.h"

struct Triangles {
    std::vector<Vec>                        vertices;
    std::vector<std::array<std::size_t, 3>> faces;
};

struct Shape {
    bool   closed = true;
    long   shells = 0, euler = 0;
    double volume = 0;
    bool   same(const Shape &other) const { return shells == other.shells && euler == other.euler; }
};

/* At an edge each triangle continues in the one behind which the same solid lies: so what touches is apart. */
Shape shape_of(const Triangles &mesh);

/* Returns the farthest that points of the first are from the second. */
double farthest(const Triangles &from, const Triangles &to);

#endif
