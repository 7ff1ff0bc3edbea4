/*
 * places.c: places of the surface, their normals and walls.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/field/roots.h"
#include "measure/measure.h"

/* About as many places as there are if the mesh has fewer triangles. */
static const double MAX_PLACES = 20000;
/* Of the size: of steps by which normals are found, and how far roots are known.  Of the mesh's error: the least step inwards, so
   gaps of less are none. */
static const double NORMAL_STEP = 1e-6, ENOUGH = 1e-13, MIN_STEP = 1e-3;
/* Cosine of 30 degrees: of both sides of a wall. */
static const double OPPOSITE = 0.8660254037844386;

/* ---- triangles that are halved ---- */

static int longest_edge(const double corners[3][3], double *length)
{
    int longest = 0;
    *length     = 0;
    for (int k = 0; k < 3; k++) {
        double now = distance3(corners[k], corners[(k + 1) % 3]);
        if (now > *length) {
            *length = now;
            longest = k;
        }
    }
    return longest;
}

static void find_normal(const double corners[3][3], double normal[3])
{
    double a[3], b[3];
    add_scaled3(a, corners[1], -1, corners[0]);
    add_scaled3(b, corners[2], -1, corners[0]);
    cross3(a, b, normal);
}

static void add_place(Measurer *m, const double corners[3][3], const double normal[3], double area)
{
    Place place = {.area = area, .wall = INFINITY};
    for (int k = 0; k < 3; k++)
        place.at[k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3;
    memcpy(place.normal, normal, sizeof place.normal);
    array_push(&m->arena, &m->places, place);
}

static void halve_triangle(Measurer *m, const double corners[3][3], const double normal[3],
                           double area, double spacing)
{
    double length;
    int    k = longest_edge(corners, &length), next = (k + 1) % 3;
    if (length <= spacing) {
        add_place(m, corners, normal, area);
        return;
    }
    double part[3][3], middle[3];
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5 * (corners[k][i] + corners[next][i]);
    memcpy(part, corners, sizeof part);
    memcpy(part[next], middle, sizeof middle);
    halve_triangle(m, (const double(*)[3])part, normal, 0.5 * area, spacing);
    memcpy(part, corners, sizeof part);
    memcpy(part[k], middle, sizeof middle);
    halve_triangle(m, (const double(*)[3])part, normal, 0.5 * area, spacing);
}

typedef void VisitTriangle(Measurer *m, const double corners[3][3], const double normal[3],
                           double area);

static void visit_triangles(Measurer *m, VisitTriangle *visit)
{
    for (size_t i = 0; i < m->mesh->triangle_count; i++) {
        double corners[3][3], normal[3];
        for (int k = 0; k < 3; k++)
            memcpy(corners[k], m->mesh->vertices[m->mesh->triangles[i][k]], sizeof *corners);
        find_normal((const double(*)[3])corners, normal);
        double area = 0.5 * length3(normal);
        if (normalize3(normal))
            visit(m, (const double(*)[3])corners, normal, area);
    }
}

static void add_area(Measurer *m, const double corners[3][3], const double normal[3], double area)
{
    (void)corners;
    (void)normal;
    m->measures->area += area;
}

static void add_places(Measurer *m, const double corners[3][3], const double normal[3], double area)
{
    halve_triangle(m, corners, normal, area, m->measures->spacing);
}

/* ---- onto the surface, and inwards ---- */

typedef struct Searcher {
    const Measurer  *m;
    const MeshField *field;
    double           reach, enough, normal_step, min_step;
} Searcher;

static Searcher searcher_of(const Measurer *m, size_t part)
{
    double size = max2(m->longest, max2(largest3(m->low), largest3(m->high)));
    return (Searcher){m,
                      &m->fields[part],
                      1.5 * m->mesh->error,
                      ENOUGH * size,
                      NORMAL_STEP * m->longest,
                      MIN_STEP * m->mesh->error};
}

/* The place on the surface that a search along the normal found. */
static void settle_at(const Searcher *s, Place *place, const RootSearch *search)
{
    double normal[3];
    add_scaled3(place->at, search->from, search->low, search->along);
    place->settled = true;
    /* Over an edge the mean of both sides would be neither's. */
    if (field_normal(s->field, place->at, s->normal_step, normal) &&
        dot3(normal, place->normal) > 0)
        memcpy(place->normal, normal, sizeof normal);
}

/* Moves places that are not settled along their normals to the surface, if it is within reach. */
static void settle_within(const Searcher *s, Place *places, size_t count, double reach)
{
    RootSearch searches[MAX_FIELD_POINTS];
    bool       found[MAX_FIELD_POINTS];
    double     ends[2][MAX_FIELD_POINTS][3], values[2][MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        for (int side = 0; side < 2; side++)
            add_scaled3(ends[side][i], places[i].at, side ? reach : -reach, places[i].normal);
    for (int side = 0; side < 2; side++)
        field_distances(s->field, (const double(*)[3])ends[side], count, values[side]);
    for (size_t i = 0; i < count; i++) {
        found[i]    = !places[i].settled && values[0][i] <= 0 && values[1][i] > 0;
        searches[i] = (RootSearch){.length  = 1,
                                   .high    = 2 * reach,
                                   .at_low  = values[0][i],
                                   .at_high = values[1][i],
                                   .done    = !found[i]};
        memcpy(searches[i].from, ends[0][i], sizeof searches[i].from);
        memcpy(searches[i].along, places[i].normal, sizeof searches[i].along);
    }
    find_roots(s->field, searches, count, s->enough);
    for (size_t i = 0; i < count; i++)
        if (found[i])
            settle_at(s, &places[i], &searches[i]);
}

/* Gives places the surface's position and normal where it is near.  First nearby: behind a thin wall it is outside, too. */
static void settle(const Searcher *s, Place *places, size_t count)
{
    for (double part = 1.0 / 256; part <= 1; part *= 4)
        settle_within(s, places, count, part * s->reach);
}

/* Walks inwards from each place as far as it is inside; `searches` then have where it ends. */
static void walk_inwards(const Searcher *s, const Place *places, size_t count,
                         RootSearch searches[MAX_FIELD_POINTS])
{
    enum { MAX_STEPS = 2000 };
    for (size_t i = 0; i < count; i++) {
        searches[i] = (RootSearch){.length = 1, .high = s->min_step, .done = !places[i].settled};
        memcpy(searches[i].from, places[i].at, sizeof searches[i].from);
        for (int k = 0; k < 3; k++)
            searches[i].along[k] = -places[i].normal[k];
    }
    bool walking[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        walking[i] = places[i].settled;
    for (int step = 0; step < MAX_STEPS; step++) {
        double points[MAX_FIELD_POINTS][3], values[MAX_FIELD_POINTS];
        size_t open[MAX_FIELD_POINTS], left = 0;
        for (size_t i = 0; i < count; i++)
            if (walking[i]) {
                add_scaled3(points[left], searches[i].from, searches[i].high, searches[i].along);
                open[left++] = i;
            }
        if (left == 0)
            return;
        field_distances(s->field, (const double(*)[3])points, left, values);
        for (size_t i = 0; i < left; i++) {
            RootSearch *search = &searches[open[i]];
            if (values[i] > 0) {
                search->at_high  = values[i];
                walking[open[i]] = false;
                continue;
            }
            search->low    = search->high;
            search->at_low = values[i];
            search->high += max2(-values[i], s->min_step);
        }
    }
    for (size_t i = 0; i < count;
         i++) /* which never happens where distances are not far too short */
        searches[i].done = searches[i].done || walking[i];
}

static void find_walls(const Searcher *s, Place *places, size_t count)
{
    RootSearch searches[MAX_FIELD_POINTS];
    bool       ends[MAX_FIELD_POINTS];
    walk_inwards(s, places, count, searches);
    for (size_t i = 0; i < count; i++)
        ends[i] = !searches[i].done;
    find_roots(s->field, searches, count, s->enough);
    for (size_t i = 0; i < count; i++) {
        double end[3], normal[3];
        places[i].wall = INFINITY;
        if (!ends[i])
            continue;
        add_scaled3(end, searches[i].from, searches[i].high, searches[i].along);
        if (field_normal(s->field, end, s->normal_step, normal) &&
            dot3(normal, searches[i].along) >= OPPOSITE)
            places[i].wall = searches[i].high;
    }
}

static void take_places(void *task, size_t part, size_t parts)
{
    Measurer *m = task;
    Searcher  s = searcher_of(m, part);
    size_t    i;
    (void)parts;
    while (part < m->parts &&
           (i = atomic_fetch_add(&m->next, MAX_FIELD_POINTS)) < m->places.count) {
        size_t left  = m->places.count - i,
               count = left < MAX_FIELD_POINTS ? left : MAX_FIELD_POINTS;
        settle(&s, m->places.items + i, count);
        find_walls(&s, m->places.items + i, count);
        if (!measurer_goes_on(m, part, (double)i / (double)m->places.count))
            return;
    }
}

/* ---- the thinnest wall ---- */

/* Looks around a place for a thinner wall, by steps that become shorter.  Neighbours are looked at all at once. */
static void slide_to_thinnest(const Searcher *s, Place *place, double step)
{
    enum { DIRECTIONS = 8, HALVINGS = 40, MAX_SLIDES = 200 };
    for (int halvings = 0, slides = 0; halvings < HALVINGS && slides < MAX_SLIDES; slides++) {
        Place  around[DIRECTIONS];
        double u[3], v[3], least[3] = {0};
        int    axis = fabs(place->normal[0]) < 0.6 ? 0 : fabs(place->normal[1]) < 0.6 ? 1 : 2;
        int    best = -1;
        least[axis] = 1;
        cross3(place->normal, least, u);
        normalize3(u);
        cross3(place->normal, u, v);
        for (int i = 0; i < DIRECTIONS; i++) {
            double angle      = 2 * M_PI * i / DIRECTIONS;
            around[i]         = *place;
            around[i].settled = false;
            add_scaled3(around[i].at, around[i].at, step * cos(angle), u);
            add_scaled3(around[i].at, around[i].at, step * sin(angle), v);
        }
        settle(s, around, DIRECTIONS);
        find_walls(s, around, DIRECTIONS);
        for (int i = 0; i < DIRECTIONS; i++)
            if (around[i].wall < (best < 0 ? place->wall : around[best].wall))
                best = i;
        if (best >= 0) {
            *place = around[best];
        } else {
            step *= 0.5;
            halvings++;
        }
    }
}

static bool is_thinner(const void *a, const void *b)
{
    return ((const Place *)a)->wall < ((const Place *)b)->wall;
}

/* The thinnest of all places that are no neighbours of `count` others; NULL: no further wall. */
static const Place *thinnest_apart(const Measurer *m, const Place *others, size_t count,
                                   double apart)
{
    const Place *thinnest = NULL;
    for (size_t i = 0; i < m->places.count; i++) {
        const Place *place = &m->places.items[i];
        bool         near  = !isfinite(place->wall);
        for (size_t k = 0; k < count && !near; k++)
            near = distance3(place->at, others[k].at) < apart;
        if (!near && (!thinnest || is_thinner(place, thinnest)))
            thinnest = place;
    }
    return thinnest;
}

static void find_thinnest(Measurer *m)
{
    enum { STARTS = 12 };
    KrsMeasures *measures = m->measures;
    Searcher     s        = searcher_of(m, 0);
    Place        starts[STARTS];
    size_t       count = 0;
    for (const Place *next; count < STARTS; count++) {
        next = thinnest_apart(m, starts, count, 4 * measures->spacing);
        if (!next)
            break;
        starts[count] = *next;
    }
    for (size_t i = 0; i < count; i++) {
        slide_to_thinnest(&s, &starts[i], measures->spacing);
        if (starts[i].wall >= measures->wall.thickness)
            continue;
        measures->wall.thickness = starts[i].wall;
        memcpy(measures->wall.from, starts[i].at, sizeof starts[i].at);
        add_scaled3(measures->wall.to, starts[i].at, -starts[i].wall, starts[i].normal);
    }
}

void measure_places(Measurer *m)
{
    static const double EQUAL    = 1e-6; /* walls as thick as the nozzle are not thinner */
    KrsMeasures        *measures = m->measures;
    measures->wall.thickness     = INFINITY;
    visit_triangles(m, add_area);
    measures->spacing = 2 * sqrt(measures->area / MAX_PLACES);
    visit_triangles(m, add_places);
    atomic_store(&m->next, 0);
    run_in_parallel(take_places, m);
    if (atomic_load(&m->stopped))
        return;
    for (size_t i = 0; i < m->places.count; i++)
        if (m->places.items[i].wall < (1 - EQUAL) * m->options->nozzle)
            measures->thin_area += m->places.items[i].area;
    find_thinnest(m);
}
