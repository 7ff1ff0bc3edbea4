/*
 * mesh_faults.h: what CGAL finds of a mesh.
 */
#ifndef KRS_MESH_FAULTS_H
#define KRS_MESH_FAULTS_H

#include <array>
#include <cstddef>
#include <vector>

struct Judgement {
    const char *fault    = nullptr;
    std::size_t vertices = 0, triangles = 0;
    long        parts = 0, genus = 0; /* of all parts together */
    double      volume = 0;
    /* Pairs of triangles that cross or touch, and the farthest that one goes through another.  That is about 0 where solids
       touch and stay apart: their corners there are double, and are rounded in the file. */
    std::size_t           crossings = 0;
    double                deepest   = 0;
    std::array<double, 3> where     = {0, 0, 0};
};

/* Without a repair: what is no orientable manifold stays a soup, and a vertex where two sheets meet becomes two. */
Judgement judge_mesh(const std::vector<std::array<double, 3>>    &vertices,
                     const std::vector<std::vector<std::size_t>> &faces);

#endif
