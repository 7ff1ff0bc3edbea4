/*
 * peer.cpp: meshes by CGAL of surfaces that krs meshes as well, and how far both are from the surface.
 *
 *     peer mesh SHAPE ERROR     mesh the shape by CGAL
 *     peer judge SHAPE FILE     read a mesh of it, binary STL
 *
 * CGAL refines a Delaunay triangulation (Boissonnat and Oudot), until the middle of each triangle is within the error
 * of the surface.  It proves nothing between, and knows no edges.  Printed are the number of triangles, and the
 * farthest from the surface of many points of them.
 */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <CGAL/Complex_2_in_triangulation_3.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>

using Triangulation = CGAL::Surface_mesh_default_triangulation_3;
using Complex       = CGAL::Complex_2_in_triangulation_3<Triangulation>;
using Traits        = Triangulation::Geom_traits;
using Point         = Traits::Point_3;
using Function      = double (*)(Point);

/* Rotates a point by -20 degrees around (1, 2, 3), so that no axis is that of a grid
   (Rodrigues). */
static Point rotated(Point p)
{
    const double angle = -20 * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
    const double length = std::sqrt(14), n[3] = {1 / length, 2 / length, 3 / length};
    double       along = n[0] * p.x() + n[1] * p.y() + n[2] * p.z();
    return {c * p.x() + s * (n[1] * p.z() - n[2] * p.y()) + (1 - c) * along * n[0],
            c * p.y() + s * (n[2] * p.x() - n[0] * p.z()) + (1 - c) * along * n[1],
            c * p.z() + s * (n[0] * p.y() - n[1] * p.x()) + (1 - c) * along * n[2]};
}

/* Around the y axis. */
static double ring(double x, double y, double z, double major, double minor)
{
    return std::hypot(std::hypot(x, z) - major, y) - minor;
}

static double torus(Point p)
{
    p = rotated(p);
    return ring(p.x(), p.y(), p.z(), 1, 0.4);
}

static double links(Point p)
{
    return std::fmin(ring(p.x() + 0.35, p.y(), p.z(), 0.7, 0.2),
                     ring(p.x() - 0.35, p.z(), p.y(), 0.7, 0.2));
}

/* The distance from the gyroid to first order, then the cube's. */
static double gyroid(Point p)
{
    const double k = 2 * M_PI, sx = std::sin(k * p.x()), cx = std::cos(k * p.x()),
                 sy = std::sin(k * p.y()), cy = std::cos(k * p.y()), sz = std::sin(k * p.z()),
                 cz = std::cos(k * p.z());
    double slope    = k * std::hypot(cx * cy - sz * sx, cy * cz - sx * sy, cz * cx - sy * sz);
    return std::fmax((sx * cy + sy * cz + sz * cx) / std::fmax(slope, 1),
                     std::fmax(std::fabs(p.x()), std::fmax(std::fabs(p.y()), std::fabs(p.z()))) -
                         0.5);
}

static const struct Shape {
    const char *name;
    Function    function;
    double      radius; /* of a ball that it is in */
} shapes[] = {{"torus", torus, 1.5}, {"links", links, 1.5}, {"gyroid", gyroid, 1}};

static double farthest_of_triangle(Function f, const Point corners[3])
{
    const int steps = 6;
    double    most  = 0;
    for (int i = 0; i <= steps; i++)
        for (int k = 0; i + k <= steps; k++) {
            double a = double(i) / steps, b = double(k) / steps;
            most = std::fmax(most, std::fabs(f(CGAL::barycenter(corners[0], a, corners[1], b,
                                                                corners[2], 1 - a - b))));
        }
    return most;
}

static void mesh(const Shape &shape, double error)
{
    Triangulation                              triangulation;
    Complex                                    complex(triangulation);
    CGAL::Implicit_surface_3<Traits, Function> surface(
        shape.function, Traits::Sphere_3(CGAL::ORIGIN, shape.radius * shape.radius), 1e-6);
    /* Angles are at least 30 degrees, as in CGAL's manual; no triangle is too large where the error
       permits it. */
    CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(30, shape.radius, error);
    CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());
    double most = 0;
    for (auto facet = complex.facets_begin(); facet != complex.facets_end(); ++facet) {
        Point corners[3];
        for (int i = 0; i < 3; i++)
            corners[i] = facet->first->vertex((facet->second + 1 + i) % 4)->point();
        most = std::fmax(most, farthest_of_triangle(shape.function, corners));
    }
    std::printf("%zu %.3g\n", std::size_t(complex.number_of_facets()), most);
}

/* A triangle of binary STL: its normal, three corners of three numbers, and two bytes that mean nothing. */
static int judge(const Shape &shape, const char *name)
{
    unsigned char triangle[50];
    FILE         *file  = std::fopen(name, "rb");
    double        most  = 0;
    std::size_t   count = 0;
    if (!file || std::fseek(file, 84, SEEK_SET) != 0) {
        std::perror(name);
        return 74;
    }
    for (; std::fread(triangle, sizeof triangle, 1, file) == 1; count++) {
        float v[9];
        std::memcpy(v, triangle + 12, sizeof v);
        const Point corners[3] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
        most                   = std::fmax(most, farthest_of_triangle(shape.function, corners));
    }
    std::fclose(file);
    std::printf("%zu %.3g\n", count, most);
    return 0;
}

int main(int argc, char **argv)
{
    for (const Shape &shape : shapes)
        if (argc == 4 && std::strcmp(shape.name, argv[2]) == 0) {
            if (std::strcmp(argv[1], "judge") == 0)
                return judge(shape, argv[3]);
            if (std::strcmp(argv[1], "mesh") == 0) {
                mesh(shape, std::atof(argv[3]));
                return 0;
            }
        }
    std::fputs("usage: peer mesh SHAPE ERROR | peer judge SHAPE FILE, of torus, links or gyroid\n",
               stderr);
    return 64;
}
