/*
 * mesh_judge.cpp: what CGAL finds of meshes: mesh_judge FILE.off...
 *
 * For each file a line: its name, "good" or what is wrong, vertices, triangles, genus of all parts together,
 * parts, volume.  Status 1: one is not good.
 */
#include <cstdio>

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

#include "tests/oracle/mesh_faults.h"

int main(int argc, char **argv)
{
    bool good = true;
    for (int i = 1; i < argc; i++) {
        std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
        std::vector<std::array<double, 3>>                   vertices;
        std::vector<std::vector<std::size_t>>                faces;
        Judgement                                            judged;
        bool read = CGAL::IO::read_polygon_soup(argv[i], points, faces);
        for (const auto &p : points)
            vertices.push_back({p.x(), p.y(), p.z()});
        judged = judge_mesh(vertices, faces);
        if (!read)
            judged.fault = "unreadable";
        good = good && !judged.fault;
        if (judged.fault)
            std::printf("%s: %s\n", argv[i], judged.fault);
        else
            std::printf(
                "%s: good, %zu vertices, %zu triangles, genus %ld, %ld parts, volume %.9g\n",
                argv[i], judged.vertices, judged.triangles, judged.genus, judged.parts,
                judged.volume);
    }
    return good ? 0 : 1;
}
