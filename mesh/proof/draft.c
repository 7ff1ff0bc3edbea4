/*
 * draft.c: tests tetrahedra at points.
 *
 * Some points in a tetrahedron move along the gradient to the surface.  If they end in the
 * tetrahedron, its triangles must be near; if it has none, something was missed.
 */
#include "mesh/proof/draft.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "mesh/contour/weights.h"
#include "mesh/proof/bounds.h"

enum { PROBES = 5, STEPS = 3 };
/* Parts of the error: the distance at which a point is on the surface, the distance of triangles
   that are too far from it, and the depth in a tetrahedron without triangles at which a point
   counts. */
static const double ON_SURFACE = 0.1, OFF = 0.5, DEEP = 0.6;
/* Edges, in errors, of the smallest that are bisected, with triangles and without. */
static const double MIN_OFF_SURFACE = 1, MIN_MISSED = 2;

/* A point on the way to the surface. */
typedef struct Probe {
    double at[3], value;
    bool   found; /* it is on the surface */
} Probe;

/* Sets the centre, and a point nearer to each corner. */
static void place_probes(const double corners[4][3], Probe probes[PROBES])
{
    static const double NEARER = 0.55, OTHERS = 0.15;
    for (int i = 0; i < PROBES; i++) {
        memset(&probes[i], 0, sizeof probes[i]);
        for (int c = 0; c < 4; c++)
            add_scaled3(probes[i].at, probes[i].at,
                        i == 4   ? 0.25
                        : i == c ? NEARER
                                 : OTHERS,
                        corners[c]);
    }
}

static void step_probe(Probe *probe, const double values[4], double step)
{
    static const double MIN_SQUARE = 1e-2;
    double              gradient[3];
    for (int k = 0; k < 3; k++)
        gradient[k] = (values[k + 1] - values[0]) / step;
    double square = dot3(gradient, gradient);
    probe->value  = values[0];
    if (square > MIN_SQUARE)
        add_scaled3(probe->at, probe->at, -values[0] / square, gradient);
}

/* Makes one of Newton's steps for all probes. */
static void step_probes(const MeshField *field, double error, Probe probes[PROBES])
{
    double       points[4 * PROBES][3], values[4 * PROBES];
    const double step = 1e-3 * error;
    for (int i = 0; i < 4 * PROBES; i++) {
        memcpy(points[i], probes[i / 4].at, sizeof points[i]);
        if (i % 4 > 0)
            points[i][i % 4 - 1] += step;
    }
    field_distances(field, (const double(*)[3])points, 4 * PROBES, values);
    for (int i = 0; i < PROBES; i++) {
        probes[i].found = fabs(values[4 * i]) <= ON_SURFACE * error;
        if (!probes[i].found)
            step_probe(&probes[i], &values[4 * i], step);
    }
}

/* Tells whether a point is within the distance of the polygon `loop`, or of the fan between it and
   `apex`. */
static bool is_near_loop(const double *const *loop, size_t count, const double *apex,
                         const double point[3], double distance)
{
    for (size_t i = apex ? 0 : 1; i < count - (apex ? 0 : 1); i++) {
        double corners[3][3], nearest[3];
        memcpy(corners[0], apex ? apex : loop[0], sizeof corners[0]);
        memcpy(corners[1], loop[i], sizeof corners[1]);
        memcpy(corners[2], loop[(i + 1) % count], sizeof corners[2]);
        triangle_nearest((const double(*)[3])corners, point, nearest);
        if (distance3(nearest, point) <= distance)
            return true;
    }
    return false;
}

static bool is_near_patch(const Contour *contour, const Patch *patch, const double point[3],
                          double distance)
{
    const double *loop[8];
    size_t        count = 0;
    uint32_t      first = patch->fan ? 0 : patch_diagonal(contour, patch);
    for (uint32_t i = 0; i < patch->corner_count; i++) {
        uint32_t        corner = (i + first) % patch->corner_count;
        const FaceLine *line   = &contour->lines.items[patch->lines[corner]];
        loop[count++]          = contour->crossings.items[patch->crossings[corner]].at;
        if (line->bent)
            loop[count++] = line->at;
    }
    return is_near_loop(loop, count, patch->fan ? patch->apex : NULL, point, distance);
}

/* Tells whether a tetrahedron has surface where it has no triangles. */
static bool misses_surface(const Mesher *m, const MeshField *field, const Tet *tet,
                           const Patch *patch)
{
    double corners[4][3], weights[4];
    Probe  probes[PROBES];
    tets_corners(&m->tets, tet, corners);
    place_probes((const double(*)[3])corners, probes);
    double longest = tets_longest_edge(&m->tets, tet);
    double deep    = patch ? 0 : fmin(0.2, 2 * DEEP * m->error / longest);
    for (int i = 0; i < STEPS; i++)
        step_probes(field, m->error, probes);
    for (int i = 0; i < PROBES; i++) {
        bool inside = probes[i].found;
        tet_weights((const double(*)[3])corners, probes[i].at, weights);
        for (int c = 0; c < 4; c++)
            inside = inside && weights[c] >= deep;
        if (inside && !(patch && is_near_patch(&m->contour, patch, probes[i].at, OFF * m->error)))
            return true;
    }
    return false;
}

/* Points on edges whose ends are on one side, between which the surface may be. */
enum { EDGES = 6, INNER = 3 };
typedef struct Edges {
    double points[EDGES * INNER][3], ends[EDGES][2];
    size_t count; /* of edges */
} Edges;

static void find_edges(const Mesher *m, const Tet *tet, Edges *edges)
{
    double corners[4][3];
    tets_corners(&m->tets, tet, corners);
    edges->count = 0;
    for (int i = 0; i < 4; i++)
        for (int k = i + 1; k < 4; k++) {
            double a = m->tets.points.items[tet->points[i]].distance,
                   b = m->tets.points.items[tet->points[k]].distance;
            if ((a < 0) != (b < 0) || fabs(a) + fabs(b) >= distance3(corners[i], corners[k]))
                continue;
            for (int n = 0; n < INNER; n++)
                for (int c = 0; c < 3; c++)
                    edges->points[INNER * edges->count + (size_t)n][c] =
                        corners[i][c] + (corners[k][c] - corners[i][c]) * (n + 1) / (INNER + 1);
            edges->ends[edges->count][0]   = a;
            edges->ends[edges->count++][1] = b;
        }
}

/* Tells whether an edge goes through the surface and back, as through a wall.  Beside a plane the
   distance is linear, so a distance that is much less than between the ends counts, too. */
static bool goes_through(const Mesher *m, const MeshField *field, const Tet *tet)
{
    static const double BENT = 1, BENT_PART = 0.3;
    Edges               edges;
    double              values[EDGES * INNER];
    find_edges(m, tet, &edges);
    field_distances(field, (const double(*)[3])edges.points, INNER * edges.count, values);
    for (size_t i = 0; i < INNER * edges.count; i++) {
        const double *ends = edges.ends[i / INNER];
        double        part = (double)(i % INNER + 1) / (INNER + 1);
        double        even = fabs(ends[0] + part * (ends[1] - ends[0]));
        double        bent = fmax(BENT * m->error, BENT_PART * fmin(fabs(ends[0]), fabs(ends[1])));
        if ((values[i] < 0) != (ends[0] < 0) ? fabs(values[i]) > BENT * m->error
                                             : fabs(values[i]) < even - bent)
            return true;
    }
    return false;
}

static TetState draft_state(const Mesher *m, const MeshField *field, const Tet *tet)
{
    const Contour *contour = &m->contour;
    const Patch   *patch   = tet->triangle_count > 0 ? &contour->patches.items[tet->patch] : NULL;
    double         least   = (patch ? MIN_OFF_SURFACE : MIN_MISSED) * m->error;
    TetState       fits    = patch ? TET_FITS : TET_EMPTY;
    if (verify_is_far(&m->tets, tet))
        return TET_EMPTY;
    if (tets_longest_edge(&m->tets, tet) <= least)
        return fits;
    if (patch && patch_off(contour, patch) > OFF * m->error)
        return TET_REFUTED;
    return misses_surface(m, field, tet, patch) ? TET_REFUTED : fits;
}

void draft_group(Mesher *m, Verifier *verifier, const Group *group)
{
    for (uint32_t i = 0; i < group->count; i++) {
        Tet *tet   = tet_of_group(m, group, i);
        tet->state = (uint8_t)draft_state(m, verifier->field, tet);
        if ((tet->state == TET_FITS || tet->state == TET_EMPTY) &&
            tets_longest_edge(&m->tets, tet) > MIN_MISSED * m->error &&
            goes_through(m, verifier->field, tet))
            tet->state = TET_REFUTED;
    }
}
