/*
 * mesh_judge.cpp: what CGAL finds of meshes: mesh_judge FILE.off...
 *
 * For each file a line: its name, "good" or what is wrong, vertices, triangles, genus of all parts together,
 * parts, volume.  Status 1: one is not good.
 */
#include <cmath>
#include <cstdio>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace process = CGAL::Polygon_mesh_processing;
using Kernel      = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh        = CGAL::Surface_mesh<Kernel::Point_3>;

struct Judged {
    const char *fault = nullptr;
    Mesh        mesh;
};

/* Without a repair: what is no orientable manifold stays a soup, and a vertex where two sheets meet becomes two. */
static Judged judge(const char *path)
{
    std::vector<Kernel::Point_3>          points;
    std::vector<std::vector<std::size_t>> faces;
    Judged                                judged;
    if (!CGAL::IO::read_polygon_soup(path, points, faces)) {
        judged.fault = "unreadable";
    } else if (!process::is_polygon_soup_a_polygon_mesh(faces)) {
        judged.fault = "no manifold";
    } else {
        process::polygon_soup_to_polygon_mesh(points, faces, judged.mesh);
        if (!judged.mesh.is_valid())
            judged.fault = "invalid";
        else if (!CGAL::is_closed(judged.mesh))
            judged.fault = "open";
        else if (process::does_self_intersect(judged.mesh))
            judged.fault = "crosses itself";
        else if (!process::is_outward_oriented(judged.mesh) && process::volume(judged.mesh) <= 0)
            judged.fault = "inside out";
    }
    return judged;
}

static std::size_t count_parts(Mesh &mesh)
{
    auto part = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
    return process::connected_components(mesh, part);
}

int main(int argc, char **argv)
{
    bool good = true;
    for (int i = 1; i < argc; i++) {
        Judged judged = judge(argv[i]);
        Mesh  &mesh   = judged.mesh;
        good          = good && !judged.fault;
        if (judged.fault) {
            std::printf("%s: %s\n", argv[i], judged.fault);
            continue;
        }
        long parts = (long)count_parts(mesh);
        long euler = (long)mesh.number_of_vertices() - (long)mesh.number_of_edges() +
                     (long)mesh.number_of_faces();
        std::printf("%s: good, %zu vertices, %zu triangles, genus %ld, %ld parts, volume %.9g\n",
                    argv[i], (std::size_t)mesh.number_of_vertices(),
                    (std::size_t)mesh.number_of_faces(), parts - euler / 2, parts,
                    process::volume(mesh));
    }
    return good ? 0 : 1;
}
