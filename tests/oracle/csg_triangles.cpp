/*
 * csg_triangles.cpp: shells, Euler numbers, volumes and distances.
 */
#include "tests/oracle/csg_triangles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

/* ---- shape ---- */

static std::size_t leader(std::vector<std::size_t> &leaders, std::size_t i)
{
    while (leaders[i] != i)
        i = leaders[i] = leaders[leaders[i]];
    return i;
}

Shape shape_of(const Triangles &mesh)
{
    struct Side {
        double      angle;
        bool        forward;
        std::size_t face, from; /* the corner that it goes away from */
    };
    std::size_t                                                      n = mesh.faces.size();
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Side>> edges;
    std::vector<std::size_t>                                         corners(3 * n), shells(n);
    Shape                                                            shape;
    std::iota(corners.begin(), corners.end(), 0);
    std::iota(shells.begin(), shells.end(), 0);
    for (std::size_t f = 0; f < n; f++) {
        const auto &t = mesh.faces[f];
        shape.volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) /
                        6;
        for (std::size_t k = 0; k < 3; k++) {
            std::size_t a = t[k], b = t[(k + 1) % 3];
            edges[std::minmax(a, b)].push_back({0, a < b, f, k});
        }
    }
    for (auto &edge : edges) {
        std::vector<Side> &sides = edge.second;
        if (sides.size() > 2) {
            Vec from                             = mesh.vertices[edge.first.first],
                axis                             = mesh.vertices[edge.first.second] - from;
            axis                                 = 1 / std::sqrt(dot(axis, axis)) * axis;
            Vec x0                               = {0, 0, 0};
            x0[std::fabs(axis[0]) < 0.6 ? 0 : 1] = 1;
            Vec x = cross(axis, x0), y = cross(axis, x);
            for (Side &side : sides) {
                Vec to     = mesh.vertices[mesh.faces[side.face][(side.from + 2) % 3]] - from;
                side.angle = std::atan2(dot(to, y), dot(to, x));
            }
            std::sort(sides.begin(), sides.end(),
                      [](const Side &a, const Side &b) { return a.angle < b.angle; });
        }
        /* Backward triangles begin a wedge of the solid, and forward ones end it. */
        std::size_t count = sides.size();
        for (std::size_t i = 0; i < count; i++) {
            const Side &a = sides[i], &b = sides[(i + 1) % count];
            if (a.forward == b.forward)
                shape.closed = false;
            if (a.forward || a.forward == b.forward)
                continue;
            corners[leader(corners, 3 * a.face + a.from)]           = leader(corners,
                                                                             3 * b.face + (b.from + 1) % 3);
            corners[leader(corners, 3 * a.face + (a.from + 1) % 3)] = leader(corners,
                                                                             3 * b.face + b.from);
            shells[leader(shells, a.face)]                          = leader(shells, b.face);
        }
    }
    for (std::size_t i = 0; i < 3 * n; i++)
        shape.euler += leader(corners, i) == i;
    shape.euler -= long(n) / 2;
    for (std::size_t f = 0; f < n; f++)
        shape.shells += leader(shells, f) == f;
    return shape;
}

/* ---- distances ---- */

using Plain     = CGAL::Simple_cartesian<double>;
using Iterator  = std::vector<Plain::Triangle_3>::const_iterator;
using Primitive = CGAL::AABB_triangle_primitive<Plain, Iterator>;
using Nearest   = CGAL::AABB_tree<CGAL::AABB_traits<Plain, Primitive>>;

static Plain::Point_3 plain(const Vec &v) { return {v[0], v[1], v[2]}; }

double farthest(const Triangles &from, const Triangles &to)
{
    const std::size_t              MOST = 1500;
    std::vector<Plain::Triangle_3> list;
    double                         most = 0;
    for (const auto &t : to.faces)
        list.emplace_back(plain(to.vertices[t[0]]), plain(to.vertices[t[1]]),
                          plain(to.vertices[t[2]]));
    Nearest     tree(list.begin(), list.end());
    std::size_t step = from.faces.size() / MOST + 1;
    tree.accelerate_distance_queries();
    for (std::size_t f = 0; f < from.faces.size(); f += step) {
        const auto &t = from.faces[f];
        const Vec  &a = from.vertices[t[0]], &b = from.vertices[t[1]], &c = from.vertices[t[2]];
        for (const Vec &p : {a, 0.5 * (a + b), 1.0 / 3 * (a + b + c)})
            most = std::fmax(most, std::sqrt(tree.squared_distance(plain(p))));
    }
    return most;
}
