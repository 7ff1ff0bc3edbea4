/* lens.c: bounds heights of the surface above a disc by balls and by slopes. */
#include "mesh/proof/lens.h"

#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

/* Returns how high above the disc the surface may be, if a ball around a point above it has no
   surface. */
static double height_under_ball(double height, double ball, double radius)
{
    return ball > ROUNDING * radius ? height - sqrt(ball * ball - ROUNDING * radius * radius)
                                    : INFINITY;
}

/* Returns the distance of balls by which a lens at a flat surface has half of the error. */
static double lens_distance(const Verifier *verifier, double radius)
{
    return max2(radius * radius / verifier->error, 2 * radius);
}

bool find_lens_by_balls(const Verifier *verifier, Lens *lens)
{
    double far = lens_distance(verifier, lens->radius);
    double points[2][3], distances[2];
    add_scaled3(points[0], lens->center, far, lens->normal);
    add_scaled3(points[1], lens->center, -far, lens->normal);
    field_distances(verifier->field, (const double(*)[3])points, 2, distances);
    lens->above = height_under_ball(far, distances[0], lens->radius);
    lens->below = height_under_ball(far, -distances[1], lens->radius);
    return lens->above < verifier->error && lens->below < verifier->error;
}

/* Returns how high above a point with this value 0 may be. */
static double height_of_zero(const Gradient *gradient, double value)
{
    return -value / (value < 0 ? gradient->least : gradient->most);
}
static double depth_of_zero(const Gradient *gradient, double value)
{
    return value / (value > 0 ? gradient->least : gradient->most);
}

void find_lens_by_slope(const Gradient *gradient, const double center[3], double distance,
                        Lens *lens)
{
    double change = gradient->across * lens->radius * ROUNDING;
    double high   = height_of_zero(gradient, distance - change);
    double low    = -depth_of_zero(gradient, distance + change);
    memcpy(lens->normal, gradient->direction, sizeof lens->normal);
    add_scaled3(lens->center, center, 0.5 * (low + high), lens->normal);
    lens->above = lens->below = ROUNDING * 0.5 * (high - low);
}

/* The triangles that are near to a lens. */
typedef struct LensMesh {
    const Lens *lens;
    double      error, reach;
    bool        pierced; /* its axis meets one */
} LensMesh;

static bool axis_meets(const Lens *lens, const double corners[3][3])
{
    double sides[3];
    for (int i = 0; i < 3; i++) {
        double from[3], to[3], cross[3];
        add_scaled3(from, corners[i], -1, lens->center);
        add_scaled3(to, corners[(i + 1) % 3], -1, lens->center);
        cross3(from, to, cross);
        sides[i] = dot3(cross, lens->normal);
    }
    return sides[0] >= 0 && sides[1] >= 0 && sides[2] >= 0;
}

/* Tells whether a triangle is farther away than counts; asked last, since it costs most. */
static bool is_beyond_reach(const LensMesh *mesh, const double corners[3][3])
{
    double nearest[3];
    triangle_nearest(corners, mesh->lens->center, nearest);
    return distance3(nearest, mesh->lens->center) > mesh->reach;
}

/* Tells whether a triangle faces as the lens does and is within the error of all that is in the
   lens, or is too far away to count. */
static bool fits_lens(void *user, uint32_t triangle, const double corners[3][3])
{
    static const double STEEPEST = 0.3; /* least cosine between the normals */
    LensMesh           *mesh     = user;
    const Lens         *lens     = mesh->lens;
    double              edges[2][3], normal[3], offset[3], low = INFINITY, high = -INFINITY;
    (void)triangle;
    for (int i = 0; i < 3; i++) {
        add_scaled3(offset, corners[i], -1, lens->center);
        low  = min2(low, dot3(offset, lens->normal));
        high = max2(high, dot3(offset, lens->normal));
    }
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], normal);
    double cosine = normalize3(normal) ? dot3(normal, lens->normal) : 0;
    if (cosine > 0) {
        double middle = dot3(normal, offset) / cosine;
        double rise   = lens->radius * sqrt(max2(0, 1 - cosine * cosine)) / cosine;
        low           = max2(low, middle - rise);
        high          = min2(high, middle + rise);
    }
    double farthest = 2 * mesh->error;
    if (low > farthest || high < -farthest)
        return true;
    if (cosine < STEEPEST || high + lens->below > mesh->error || lens->above - low > mesh->error)
        return is_beyond_reach(mesh, corners);
    mesh->pierced = mesh->pierced || axis_meets(lens, corners);
    return true;
}

double lens_reach(const Verifier *verifier, const Lens *lens)
{
    return real_hypot(lens->radius, 2 * verifier->error);
}

/* Finds the box around the disc of the lens and twice the error to both sides of it.  It is a
   little larger, since the cosine of a normal that is about an axis is rounded. */
static void box_of_lens(const Verifier *verifier, const Lens *lens, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        double cosine = lens->normal[k];
        double extent = ROUNDING * (lens->radius * sqrt(max2(0, 1 - cosine * cosine)) +
                                    2 * verifier->error * fabs(cosine) + 1e-7 * lens->radius);
        low[k]        = lens->center[k] - extent;
        high[k]       = lens->center[k] + extent;
    }
}

bool mesh_fills_lens(const Verifier *verifier, const Lens *lens)
{
    LensMesh mesh = {.lens = lens, .error = verifier->error, .reach = lens_reach(verifier, lens)};
    double   low[3], high[3];
    box_of_lens(verifier, lens, low, high);
    return bvh_visit_box(verifier->mesh, low, high, fits_lens, &mesh) && mesh.pierced;
}

bool is_beside_lens(const Lens *lens, const double corners[4][3])
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 4; i++) {
        double offset[3];
        add_scaled3(offset, corners[i], -1, lens->center);
        low  = min2(low, dot3(offset, lens->normal));
        high = max2(high, dot3(offset, lens->normal));
    }
    return low > lens->above || high < -lens->below;
}
