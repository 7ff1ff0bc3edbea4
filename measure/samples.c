/*
 * samples.c: samples the surface, and finds normals and walls.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/field/roots.h"
#include "measure/measure.h"

/* About the number of samples if the mesh has fewer triangles. */
static const double MAX_SAMPLES = 20000;
/* Parts of the size: the step of differences for normals, and the accuracy of roots.  A part of the
   mesh's error: the least step inwards, so that narrower gaps are missed. */
static const double NORMAL_STEP = 1e-6, ENOUGH = 1e-13, MIN_STEP = 1e-3;
/* Cosine of 30 degrees, the most between both sides of a wall. */
static const double OPPOSITE = 0.8660254037844386;

/* ---- samples of triangles ---- */

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

static void add_sample(Measurer *m, const double corners[3][3], const double normal[3], double area)
{
    Sample sample = {.area = area, .wall = INFINITY};
    for (int k = 0; k < 3; k++)
        sample.at[k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3;
    memcpy(sample.normal, normal, sizeof sample.normal);
    array_push(&m->arena, &m->samples, sample);
}

static void halve_triangle(Measurer *m, const double corners[3][3], const double normal[3],
                           double area, double spacing)
{
    double length;
    int    k = longest_edge(corners, &length), next = (k + 1) % 3;
    if (length <= spacing) {
        add_sample(m, corners, normal, area);
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

static void add_samples(Measurer *m, const double corners[3][3], const double normal[3],
                        double area)
{
    halve_triangle(m, corners, normal, area, m->measures->spacing);
}

/* ---- normals and walls ---- */

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

/* Moves a sample to where a search along the normal found the surface. */
static void snap_at(const Searcher *s, Sample *sample, const RootSearch *search)
{
    double normal[3];
    add_scaled3(sample->at, search->from, search->low, search->along);
    sample->snapped = true;
    /* Over an edge the gradient would be the mean of both sides. */
    if (field_normal(s->field, sample->at, s->normal_step, normal) &&
        dot3(normal, sample->normal) > 0)
        memcpy(sample->normal, normal, sizeof normal);
}

/* Moves samples that are not snapped along their normals to the surface, if it is within reach. */
static void snap_within(const Searcher *s, Sample *samples, size_t count, double reach)
{
    RootSearch searches[MAX_FIELD_POINTS];
    bool       found[MAX_FIELD_POINTS];
    double     ends[2][MAX_FIELD_POINTS][3], values[2][MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        for (int side = 0; side < 2; side++)
            add_scaled3(ends[side][i], samples[i].at, side ? reach : -reach, samples[i].normal);
    for (int side = 0; side < 2; side++)
        field_distances(s->field, (const double(*)[3])ends[side], count, values[side]);
    for (size_t i = 0; i < count; i++) {
        found[i]    = !samples[i].snapped && values[0][i] <= 0 && values[1][i] > 0;
        searches[i] = (RootSearch){.length  = 1,
                                   .high    = 2 * reach,
                                   .at_low  = values[0][i],
                                   .at_high = values[1][i],
                                   .done    = !found[i]};
        memcpy(searches[i].from, ends[0][i], sizeof searches[i].from);
        memcpy(searches[i].along, samples[i].normal, sizeof searches[i].along);
    }
    find_roots(s->field, searches, count, s->enough);
    for (size_t i = 0; i < count; i++)
        if (found[i])
            snap_at(s, &samples[i], &searches[i]);
}

/* Gives samples the surface's position and normal where it is near, first by short searches: behind
   a thin wall it is outside, too. */
static void snap(const Searcher *s, Sample *samples, size_t count)
{
    for (double part = 1.0 / 256; part <= 1; part *= 4)
        snap_within(s, samples, count, part * s->reach);
}

/* Walks inwards from each sample as far as it is inside; `searches` then have where it ends. */
static void walk_inwards(const Searcher *s, const Sample *samples, size_t count,
                         RootSearch searches[MAX_FIELD_POINTS])
{
    enum { MAX_STEPS = 2000 };
    for (size_t i = 0; i < count; i++) {
        searches[i] = (RootSearch){.length = 1, .high = s->min_step, .done = !samples[i].snapped};
        memcpy(searches[i].from, samples[i].at, sizeof searches[i].from);
        for (int k = 0; k < 3; k++)
            searches[i].along[k] = -samples[i].normal[k];
    }
    bool walking[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        walking[i] = samples[i].snapped;
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
    for (size_t i = 0; i < count; i++) /* only if distances are far too short */
        searches[i].done = searches[i].done || walking[i];
}

static void find_walls(const Searcher *s, Sample *samples, size_t count)
{
    RootSearch searches[MAX_FIELD_POINTS];
    bool       ends[MAX_FIELD_POINTS];
    walk_inwards(s, samples, count, searches);
    for (size_t i = 0; i < count; i++)
        ends[i] = !searches[i].done;
    find_roots(s->field, searches, count, s->enough);
    for (size_t i = 0; i < count; i++) {
        double end[3], normal[3];
        samples[i].wall = INFINITY;
        if (!ends[i])
            continue;
        add_scaled3(end, searches[i].from, searches[i].high, searches[i].along);
        if (field_normal(s->field, end, s->normal_step, normal) &&
            dot3(normal, searches[i].along) >= OPPOSITE)
            samples[i].wall = searches[i].high;
    }
}

static void take_samples(void *task, size_t part, size_t parts)
{
    Measurer *m = task;
    Searcher  s = searcher_of(m, part);
    size_t    i;
    (void)parts;
    while (part < m->parts &&
           (i = atomic_fetch_add(&m->next, MAX_FIELD_POINTS)) < m->samples.count) {
        size_t left  = m->samples.count - i,
               count = left < MAX_FIELD_POINTS ? left : MAX_FIELD_POINTS;
        snap(&s, m->samples.items + i, count);
        find_walls(&s, m->samples.items + i, count);
        if (!measurer_progress(m, part, (double)i / (double)m->samples.count))
            return;
    }
}

/* ---- the thinnest wall ---- */

/* Moves a sample to where the wall is thinner, by steps that become shorter; tests all neighbours
   at once. */
static void slide_to_thinnest(const Searcher *s, Sample *sample, double step)
{
    enum { DIRECTIONS = 8, HALVINGS = 40, MAX_SLIDES = 200 };
    for (int halvings = 0, slides = 0; halvings < HALVINGS && slides < MAX_SLIDES; slides++) {
        Sample around[DIRECTIONS];
        double u[3], v[3];
        int    best = -1;
        measure_axes(sample->normal, u, v);
        for (int i = 0; i < DIRECTIONS; i++) {
            double angle      = 2 * M_PI * i / DIRECTIONS;
            around[i]         = *sample;
            around[i].snapped = false;
            add_scaled3(around[i].at, around[i].at, step * real_cos(angle), u);
            add_scaled3(around[i].at, around[i].at, step * real_sin(angle), v);
        }
        snap(s, around, DIRECTIONS);
        find_walls(s, around, DIRECTIONS);
        for (int i = 0; i < DIRECTIONS; i++)
            if (around[i].wall < (best < 0 ? sample->wall : around[best].wall))
                best = i;
        if (best >= 0) {
            *sample = around[best];
        } else {
            step *= 0.5;
            halvings++;
        }
    }
}

static bool is_thinner(const void *a, const void *b)
{
    return ((const Sample *)a)->wall < ((const Sample *)b)->wall;
}

/* Returns the thinnest sample that is at least `separation` from `count` others; NULL if no other
   has a wall. */
static const Sample *thinnest_beyond(const Measurer *m, const Sample *others, size_t count,
                                     double separation)
{
    const Sample *thinnest = NULL;
    for (size_t i = 0; i < m->samples.count; i++) {
        const Sample *sample = &m->samples.items[i];
        bool          near   = !isfinite(sample->wall);
        for (size_t k = 0; k < count && !near; k++)
            near = distance3(sample->at, others[k].at) < separation;
        if (!near && (!thinnest || is_thinner(sample, thinnest)))
            thinnest = sample;
    }
    return thinnest;
}

static void find_thinnest(Measurer *m)
{
    enum { STARTS = 12 };
    KrsMeasures *measures = m->measures;
    Searcher     s        = searcher_of(m, 0);
    Sample       starts[STARTS];
    size_t       count = 0;
    for (const Sample *next; count < STARTS; count++) {
        next = thinnest_beyond(m, starts, count, 4 * measures->spacing);
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

void measure_samples(Measurer *m)
{
    static const double EQUAL    = 1e-6; /* by which a wall must be thinner than the nozzle */
    KrsMeasures        *measures = m->measures;
    measures->wall.thickness     = INFINITY;
    visit_triangles(m, add_area);
    measures->spacing = 2 * sqrt(measures->area / MAX_SAMPLES);
    visit_triangles(m, add_samples);
    atomic_store(&m->next, 0);
    run_in_parallel(take_samples, m);
    if (atomic_load(&m->stopped))
        return;
    for (size_t i = 0; i < m->samples.count; i++)
        if (m->samples.items[i].wall < (1 - EQUAL) * m->options->nozzle)
            measures->thin_area += m->samples.items[i].area;
    find_thinnest(m);
}
