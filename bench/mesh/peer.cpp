/*
 * peer.cpp: meshes by CGAL of surfaces that krs meshes as well: peer SHAPE ERROR.
 *
 * Delaunay refinement of an implicit surface (Boissonnat and Oudot), which ends when the middle of each triangle is
 * within the error of the surface.  It proves nothing between, and knows no edges.  Printed are the triangles, and
 * the farthest from the surface of many points of them, in errors.
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

/* Around the y axis. */
static double ring(double x, double y, double z, double major, double minor)
{
    return std::hypot(std::hypot(x, z) - major, y) - minor;
}

static double torus(Point p) { return ring(p.x(), p.y(), p.z(), 1, 0.4); }

static double links(Point p)
{
    return std::fmin(ring(p.x() + 0.35, p.y(), p.z(), 0.7, 0.2),
                     ring(p.x() - 0.35, p.z(), p.y(), 0.7, 0.2));
}

static double gyroid(Point p)
{
    double k = 2 * M_PI, x = k * p.x(), y = k * p.y(), z = k * p.z();
    double wave = std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
    return std::fmax(
        wave, std::fmax(std::fabs(p.x()), std::fmax(std::fabs(p.y()), std::fabs(p.z()))) - 0.5);
}

static const struct Shape {
    const char *name;
    Function    function;
    double      radius; /* of a ball that it is in */
} shapes[] = {{"torus", torus, 1.5}, {"links", links, 1.5}, {"gyroid", gyroid, 1}};

/* To first order. */
static double distance(Function f, Point p)
{
    const double h  = 1e-5;
    double       dx = f({p.x() + h, p.y(), p.z()}) - f({p.x() - h, p.y(), p.z()});
    double       dy = f({p.x(), p.y() + h, p.z()}) - f({p.x(), p.y() - h, p.z()});
    double       dz = f({p.x(), p.y(), p.z() + h}) - f({p.x(), p.y(), p.z() - h});
    return std::fabs(f(p)) * 2 * h / std::hypot(dx, dy, dz);
}

static double farthest_of_triangle(Function f, const Point corners[3])
{
    const int steps = 6;
    double    most  = 0;
    for (int i = 0; i <= steps; i++)
        for (int k = 0; i + k <= steps; k++) {
            double a = double(i) / steps, b = double(k) / steps;
            most = std::fmax(most, distance(f, CGAL::barycenter(corners[0], a, corners[1], b,
                                                                corners[2], 1 - a - b)));
        }
    return most;
}

static void mesh(const Shape &shape, double error)
{
    Triangulation                              triangulation;
    Complex                                    complex(triangulation);
    CGAL::Implicit_surface_3<Traits, Function> surface(
        shape.function, Traits::Sphere_3(CGAL::ORIGIN, shape.radius * shape.radius), 1e-6);
    /* At least 30 degrees, as its manual has; no triangle is too large where the error permits it. */
    CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(30, shape.radius, error);
    CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());
    double most = 0;
    for (auto facet = complex.facets_begin(); facet != complex.facets_end(); ++facet) {
        Point corners[3];
        for (int i = 0; i < 3; i++)
            corners[i] = facet->first->vertex((facet->second + 1 + i) % 4)->point();
        most = std::fmax(most, farthest_of_triangle(shape.function, corners));
    }
    std::printf("%zu %.2f\n", std::size_t(complex.number_of_facets()), most / error);
}

int main(int argc, char **argv)
{
    for (const Shape &shape : shapes)
        if (argc == 3 && std::strcmp(shape.name, argv[1]) == 0) {
            mesh(shape, std::atof(argv[2]));
            return 0;
        }
    std::fputs("usage: peer torus|links|gyroid ERROR\n", stderr);
    return 64;
}
