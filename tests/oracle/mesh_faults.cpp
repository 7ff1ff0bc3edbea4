/*
 * mesh_faults.cpp: closed, a manifold, outwards, and without crossings.
 */
#include "tests/oracle/mesh_faults.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace process = CGAL::Polygon_mesh_processing;
using Kernel      = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point       = Kernel::Point_3;
using Vector      = Kernel::Vector_3;
using Mesh        = CGAL::Surface_mesh<Point>;
using Corners     = std::array<Point, 3>;

/* ---- how deep triangles cross ---- */

static Corners corners_of(const Mesh &mesh, Mesh::Face_index face)
{
    Corners corners;
    auto    h = mesh.halfedge(face);
    for (Point &corner : corners) {
        corner = mesh.point(mesh.target(h));
        h      = mesh.next(h);
    }
    return corners;
}

static Vector normal_of(const Corners &t)
{
    Vector n      = CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
    double length = std::sqrt(n.squared_length());
    return length > 0 ? n / length : n;
}

/* How far the middle of a part of an edge is from the border of a triangle of its plane; below 0: outside. */
static double inside_by(const Corners &t, const Vector &normal, const Point &p)
{
    double least = INFINITY;
    for (std::size_t k = 0; k < 3; k++) {
        Vector along  = t[(k + 1) % 3] - t[k];
        double length = std::sqrt(along.squared_length());
        if (length > 0)
            least = std::fmin(least, CGAL::cross_product(normal, along) * (p - t[k]) / length);
    }
    return least;
}

/* How far an edge of the first goes through the second. */
static double pierced_by(const Corners &from, const Corners &to, Point &where)
{
    Vector normal = normal_of(to);
    double most   = 0;
    for (std::size_t k = 0; k < 3; k++) {
        const Point &a = from[k], &b = from[(k + 1) % 3];
        double       above = normal * (a - to[0]), below = normal * (b - to[0]);
        if (!(above * below < 0))
            continue;
        Point  p    = a + (above / (above - below)) * (b - a);
        double deep = std::fmin(std::fmin(std::fabs(above), std::fabs(below)),
                                inside_by(to, normal, p));
        if (deep > most) {
            most  = deep;
            where = p;
        }
    }
    return most;
}

/* How wide the common part of two triangles of one plane is. */
static double covered_by(const Corners &from, const Corners &to, Point &where)
{
    Vector             normal = normal_of(to);
    std::vector<Point> part(from.begin(), from.end());
    double             flat = 0, around = 0;
    for (const Point &p : from)
        flat = std::fmax(flat, std::fabs(normal * (p - to[0])));
    for (std::size_t k = 0; k < 3; k++) {
        std::vector<Point> rest;
        Vector             in   = CGAL::cross_product(normal, to[(k + 1) % 3] - to[k]);
        auto               high = [&](const Point &p) { return in * (p - to[k]); };
        for (std::size_t i = 0; i < part.size(); i++) {
            const Point &a = part[i], &b = part[(i + 1) % part.size()];
            if (high(a) >= 0)
                rest.push_back(a);
            if (high(a) * high(b) < 0)
                rest.push_back(a + (high(a) / (high(a) - high(b))) * (b - a));
        }
        part = rest;
    }
    if (part.size() < 3)
        return 0;
    Vector area(0, 0, 0);
    for (std::size_t i = 0; i < part.size(); i++) {
        const Point &a = part[i], &b = part[(i + 1) % part.size()];
        area = area + CGAL::cross_product(a - part[0], b - part[0]) / 2;
        around += std::sqrt((b - a).squared_length());
    }
    double wide = around > 0 ? 2 * std::sqrt(area.squared_length()) / around : 0;
    where       = part[0];
    return flat < wide / 1000 ? wide : 0;
}

static void find_crossings(const Mesh &mesh, Judgement &judged)
{
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
    process::self_intersections(mesh, std::back_inserter(pairs));
    judged.crossings = pairs.size();
    for (const auto &pair : pairs) {
        Corners a = corners_of(mesh, pair.first), b = corners_of(mesh, pair.second);
        Point   where;
        if (pair.first == pair.second) /* it has no area */
            continue;
        for (auto deep_by : {pierced_by, covered_by})
            for (int turn = 0; turn < 2; turn++) {
                double deep = turn ? deep_by(b, a, where) : deep_by(a, b, where);
                if (deep > judged.deepest) {
                    judged.deepest = deep;
                    judged.where   = {where.x(), where.y(), where.z()};
                }
            }
    }
}

/* ---- a mesh ---- */

static const char *fault_of(const Mesh &mesh, Judgement &judged)
{
    if (!mesh.is_valid())
        return "invalid";
    if (!CGAL::is_closed(mesh))
        return "open";
    find_crossings(mesh, judged);
    judged.volume = process::volume(mesh);
    if (judged.crossings > 0)
        return "crosses itself";
    return !process::is_outward_oriented(mesh) && judged.volume <= 0 ? "inside out" : nullptr;
}

Judgement judge_mesh(const std::vector<std::array<double, 3>>    &vertices,
                     const std::vector<std::vector<std::size_t>> &faces)
{
    Judgement judged;
    Mesh      mesh;
    if (!process::is_polygon_soup_a_polygon_mesh(faces)) {
        judged.fault = "no manifold";
        return judged;
    }
    std::vector<Point> points;
    for (const auto &v : vertices)
        points.emplace_back(v[0], v[1], v[2]);
    process::polygon_soup_to_polygon_mesh(points, faces, mesh);
    judged.fault     = fault_of(mesh, judged);
    judged.vertices  = mesh.number_of_vertices();
    judged.triangles = mesh.number_of_faces();
    auto part        = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
    judged.parts     = (long)process::connected_components(mesh, part);
    judged.genus     = judged.parts -
                   ((long)judged.vertices - (long)mesh.number_of_edges() + (long)judged.triangles) /
                       2;
    return judged;
}
