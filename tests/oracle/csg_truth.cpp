/*
 * csg_truth.cpp: set operations of polyhedra.
 */
#include "tests/oracle/csg_truth.h"

#include <stdexcept>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>

namespace process = CGAL::Polygon_mesh_processing;
using Kernel      = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh        = CGAL::Surface_mesh<Kernel::Point_3>;
using Nef         = CGAL::Nef_polyhedron_3<Kernel>;

static Mesh mesh_of(const Polyhedron &solid)
{
    Mesh                            mesh;
    std::vector<Mesh::Vertex_index> at;
    for (const Vec &v : solid.vertices)
        at.push_back(mesh.add_vertex({v[0], v[1], v[2]}));
    for (const auto &face : solid.faces) {
        std::vector<Mesh::Vertex_index> corners;
        for (std::size_t i : face)
            corners.push_back(at[i]);
        if (mesh.add_face(corners) == Mesh::null_face())
            throw std::runtime_error("a face does not fit");
    }
    process::triangulate_faces(mesh);
    return mesh;
}

/* What is grown by too much crosses itself, and CGAL may end by it. */
static Mesh grown_mesh_of(const Polyhedron &solid, double by)
{
    Mesh mesh = mesh_of(solid);
    if (by != 0 && process::does_self_intersect(mesh))
        throw std::runtime_error("it crosses itself where it is grown");
    return mesh;
}

static Mesh joined(char csg_node, Mesh a, Mesh b)
{
    if (a.is_empty() || b.is_empty())
        return csg_node == '|' ? (a.is_empty() ? b : a) : csg_node == '-' ? a : Mesh();
    Mesh result;
    bool done = csg_node == '|'   ? process::corefine_and_compute_union(a, b, result)
                : csg_node == '-' ? process::corefine_and_compute_difference(a, b, result)
                                  : process::corefine_and_compute_intersection(a, b, result);
    if (!done)
        throw std::runtime_error("not a manifold");
    result.collect_garbage();
    return result;
}

static Mesh joined(const Tree &tree, double by, int sides)
{
    if (tree.csg_node)
        return joined(tree.csg_node, joined(*tree.left, by, sides),
                      joined(*tree.right, tree.csg_node == '-' ? -by : by, sides));
    Mesh all;
    for (const Piece &piece : pieces_of(tree.part, by, sides))
        all = joined(piece.csg_node, all, grown_mesh_of(piece.solid, by));
    return all;
}

static Nef nef_of(const Polyhedron &solid)
{
    if (solid.faces.empty())
        return Nef(Nef::EMPTY);
    Mesh mesh = mesh_of(solid);
    return Nef(mesh);
}

static Nef joined_nef(const Tree &tree, double by, int sides)
{
    if (!tree.csg_node)
        return nef_of(pieces_of(tree.part, by, sides)[0].solid); /* level parts are one piece */
    Nef a      = joined_nef(*tree.left, by, sides),
        b      = joined_nef(*tree.right, tree.csg_node == '-' ? -by : by, sides);
    Nef result = tree.csg_node == '|' ? a + b : tree.csg_node == '-' ? a - b : a * b;
    return result.regularization();
}

static Vec vec_of(const Kernel::Point_3 &p)
{
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

static Triangles triangles_of(const Mesh &mesh)
{
    Triangles result;
    for (auto v : mesh.vertices())
        result.vertices.push_back(vec_of(mesh.point(v)));
    for (auto f : mesh.faces()) {
        std::array<std::size_t, 3> t;
        auto                       h = mesh.halfedge(f);
        for (std::size_t &corner : t) {
            corner = mesh.target(h);
            h      = mesh.next(h);
        }
        result.faces.push_back(t);
    }
    return result;
}

static Triangles triangles_of(Nef nef)
{
    std::vector<Kernel::Point_3>          points;
    std::vector<std::vector<std::size_t>> faces;
    Triangles                             result;
    CGAL::convert_nef_polyhedron_to_polygon_soup(nef, points, faces, true);
    for (const auto &p : points)
        result.vertices.push_back(vec_of(p));
    for (const auto &f : faces)
        result.faces.push_back({f[0], f[1], f[2]});
    return result;
}

Triangles truth_of(const Solid &solid, double by, int sides)
{
    if (solid.level)
        return triangles_of(joined_nef(*solid.tree, by, sides));
    return triangles_of(joined(*solid.tree, by, sides));
}
