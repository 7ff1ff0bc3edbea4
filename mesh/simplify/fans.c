/*
 * fans.c: bounds the distance between two fans over one border.
 *
 * Where both can be projected to a plane one-to-one, each point of one has a point of the other
 * above or below it.  Their distance is linear where a triangle of one is above a triangle of the
 * other.  So it is greatest at corners of such parts: at the vertex, or where an inner edge of one
 * goes over an inner edge of the other.
 */
#include "mesh/simplify/fans.h"

#include <stdbool.h>
#include <string.h>

#include "compiler/base/vec.h"

enum { MAX_SPOKES = 48 };

/* A point of the plane, and its height above it. */
typedef struct Above {
    double x, y, height;
} Above;

/* `from` is at the origin; the border goes from a[i] to b[i]. */
typedef struct Fans {
    Above  to, a[MAX_SPOKES], b[MAX_SPOKES];
    bool   stays[MAX_SPOKES]; /* the triangle does not have `to` */
    size_t count;
} Fans;

static double cross_of(const Above *p, const Above *q) { return p->x * q->y - p->y * q->x; }

static Above minus(const Above *p, const Above *q)
{
    return (Above){p->x - q->x, p->y - q->y, p->height - q->height};
}

/* Finds axes whose third is along the sum of all normals; returns false if that is 0. */
static bool find_axes(const double (*at)[3], const uint32_t (*triangles)[3], const uint32_t *star,
                      size_t count, double axes[3][3])
{
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const uint32_t *corners = triangles[star[i]];
        double          edges[2][3], normal[3];
        add_scaled3(edges[0], at[corners[1]], -1, at[corners[0]]);
        add_scaled3(edges[1], at[corners[2]], -1, at[corners[0]]);
        cross3(edges[0], edges[1], normal);
        add_scaled3(sum, sum, 1, normal);
    }
    memcpy(axes[2], sum, sizeof sum);
    if (!normalize3(axes[2]))
        return false;
    int    least                                       = fabs(sum[0]) <= fabs(sum[1]) ? 0 : 1;
    double other[3]                                    = {0, 0, 0};
    other[fabs(sum[2]) < fabs(sum[least]) ? 2 : least] = 1;
    cross3(other, axes[2], axes[0]);
    normalize3(axes[0]);
    cross3(axes[2], axes[0], axes[1]);
    return true;
}

static Above project(const double axes[3][3], const double origin[3], const double point[3])
{
    double offset[3];
    add_scaled3(offset, point, -1, origin);
    return (Above){dot3(axes[0], offset), dot3(axes[1], offset), dot3(axes[2], offset)};
}

/* Projects both fans; returns false if this is not one-to-one.  It is if the border goes once
   around `from`, and all triangles of both face up, so that both cover what is inside of the border
   once. */
static bool find_fans(const double (*at)[3], const uint32_t (*triangles)[3], const uint32_t *star,
                      size_t count, uint32_t from, uint32_t to, Fans *fans)
{
    double axes[3][3];
    int    rounds = 0;
    if (count > MAX_SPOKES || !find_axes(at, triangles, star, count, axes))
        return false;
    fans->count = count;
    fans->to    = project((const double(*)[3])axes, at[from], at[to]);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *corners = triangles[star[i]];
        int             own     = corners[0] == from ? 0 : corners[1] == from ? 1 : 2;
        uint32_t        a = corners[(own + 1) % 3], b = corners[(own + 2) % 3];
        Above          *p = &fans->a[i], *q = &fans->b[i];
        *p             = project((const double(*)[3])axes, at[from], at[a]);
        *q             = project((const double(*)[3])axes, at[from], at[b]);
        fans->stays[i] = a != to && b != to;
        Above first = minus(p, &fans->to), second = minus(q, &fans->to);
        if (!(cross_of(p, q) > 0) || (fans->stays[i] && !(cross_of(&first, &second) > 0)))
            return false;
        rounds += p->y <= 0 && q->y > 0;
    }
    return rounds == 1;
}

/* Returns the distance of the old vertex from the new fan. */
static double distance_at_vertex(const Fans *fans)
{
    static const double ROUNDING = 1e-9;
    for (size_t i = 0; i < fans->count; i++) {
        const Above *p = &fans->a[i], *q = &fans->b[i], *to = &fans->to;
        if (!fans->stays[i])
            continue;
        double parts[3] = {cross_of(p, q), cross_of(q, to), cross_of(to, p)};
        double whole    = parts[0] + parts[1] + parts[2];
        if (parts[0] >= -ROUNDING * whole && parts[1] >= -ROUNDING * whole &&
            parts[2] >= -ROUNDING * whole)
            return fabs(parts[0] * to->height + parts[1] * p->height + parts[2] * q->height) /
                   whole;
    }
    return INFINITY;
}

/* Returns the distance where the edge from `from` to p goes over that from `to` to q; 0 if it does
   not. */
static double distance_at_edges(const Above *to, const Above *p, const Above *q)
{
    Above  along       = minus(q, to);
    double determinant = cross_of(p, &along);
    if (determinant == 0)
        return 0;
    double s = cross_of(to, &along) / determinant, t = cross_of(to, p) / determinant;
    if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1))
        return 0;
    return fabs(s * p->height - (to->height + t * along.height));
}

double fan_distance(const double (*at)[3], const uint32_t (*triangles)[3], const uint32_t *star,
                    size_t count, uint32_t from, uint32_t to)
{
    Fans fans;
    if (!find_fans(at, triangles, star, count, from, to, &fans))
        return INFINITY;
    double most = distance_at_vertex(&fans);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < count; k++)
            if (fans.stays[k])
                most = fmax(most, distance_at_edges(&fans.to, &fans.a[i], &fans.a[k]));
    return most;
}
