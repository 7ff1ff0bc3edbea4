/*
 * lying.c: finds how a part lies on a plate, and how it lies best.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "measure/measure.h"

enum { MAX_RESTS = 64 };
/* Faces are level within a degree (this is its cosine), and of one height within this part of the
   size. */
static const double LEVEL = 0.99984769515639127, SAME_HEIGHT = 1e-5;
/* Parts of the area: overhangs that differ by less count as equal, and on a smaller base nothing
   stands. */
static const double SAME_AREA = 1e-3, MIN_BASE = 1e-4;

/* ---- one orientation ---- */

typedef struct Lying {
    const Measurer *m;
    double          right[3], front[3];
    double         *angles; /* of the base, around the center as seen from above */
    size_t          count;
    KrsOrientation *result;
} Lying;

void measure_axes(const double up[3], double right[3], double front[3])
{
    double axis[3]                                          = {0};
    axis[fabs(up[0]) < 0.6 ? 0 : fabs(up[1]) < 0.6 ? 1 : 2] = 1;
    cross3(up, axis, right);
    normalize3(right);
    cross3(up, right, front);
}

static void find_heights(const Measurer *m, const double up[3], double *low, double *high)
{
    *low  = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < m->samples.count; i++) {
        double height = dot3(m->samples.items[i].at, up);
        *low          = min2(*low, height);
        *high         = max2(*high, height);
    }
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Tells whether the center is inside of the convex hull of the base, whose points are at these
   angles around it. */
static bool is_stable(Lying *lying)
{
    if (lying->count < 3 || lying->result->base < MIN_BASE * lying->m->measures->area)
        return false;
    qsort(lying->angles, lying->count, sizeof *lying->angles, compare_numbers);
    double widest = lying->angles[0] + 2 * M_PI - lying->angles[lying->count - 1];
    for (size_t i = 1; i < lying->count; i++)
        widest = max2(widest, lying->angles[i] - lying->angles[i - 1]);
    return widest < M_PI - 1e-9;
}

static void add_to_base(Lying *lying, const Sample *sample)
{
    double offset[3];
    add_scaled3(offset, sample->at, -1, lying->m->measures->center);
    lying->angles[lying->count++] = real_atan2(dot3(offset, lying->front),
                                               dot3(offset, lying->right));
    lying->result->base += sample->area;
}

static KrsOrientation lie(const Measurer *m, const double up[3], double *angles)
{
    KrsOrientation result = {0};
    Lying          lying  = {.m = m, .angles = angles, .result = &result};
    double low, high, steepest = real_sin(m->options->overhang > 0 ? m->options->overhang : M_PI_4);
    memcpy(result.up, up, sizeof result.up);
    measure_axes(up, lying.right, lying.front);
    find_heights(m, up, &low, &high);
    for (size_t i = 0; i < m->samples.count; i++) {
        const Sample *sample = &m->samples.items[i];
        double        down   = -dot3(sample->normal, up);
        if (down > LEVEL && dot3(sample->at, up) < low + SAME_HEIGHT * m->longest)
            add_to_base(&lying, sample);
        else if (down > steepest + 1e-9)
            result.overhang += sample->area;
    }
    double ends[2] = {0, 0};
    for (size_t i = 0; i < m->mesh->vertex_count; i++) {
        double height = dot3(m->mesh->vertices[i], up);
        ends[0]       = i == 0 ? height : min2(ends[0], height);
        ends[1]       = i == 0 ? height : max2(ends[1], height);
    }
    result.height = ends[1] - ends[0];
    result.stands = is_stable(&lying);
    return result;
}

/* ---- flat faces ---- */

typedef struct Face {
    int    key[4]; /* its normal and its height, rounded */
    double area, normal[3];
} Face;

/* Rounds with an offset, so that usual directions are not between two numbers. */
static int round_off(double number) { return (int)floor(number + 0.381966); }

static Face face_of(const Measurer *m, const Sample *sample)
{
    const double steps = 500;
    Face         face  = {.area = sample->area};
    for (int k = 0; k < 3; k++) {
        face.normal[k] = sample->normal[k];
        face.key[k]    = round_off(steps * sample->normal[k]);
    }
    face.key[3] = round_off(steps * dot3(sample->normal, sample->at) / m->longest);
    return face;
}

static int compare_keys(const void *a, const void *b)
{
    return memcmp(((const Face *)a)->key, ((const Face *)b)->key, sizeof((const Face *)a)->key);
}

static int compare_areas(const void *a, const void *b)
{
    double x = ((const Face *)a)->area, y = ((const Face *)b)->area;
    return x > y ? -1 : x < y ? 1 : compare_keys(a, b);
}

/* Joins samples of the same plane to faces; returns how many there are, the largest first. */
static size_t find_faces(Measurer *m, Face *faces)
{
    size_t count = 0, joined = 0;
    for (size_t i = 0; i < m->samples.count; i++)
        if (m->samples.items[i].snapped)
            faces[count++] = face_of(m, &m->samples.items[i]);
    qsort(faces, count, sizeof *faces, compare_keys);
    for (size_t i = 0; i < count; i++) {
        if (joined > 0 && compare_keys(&faces[joined - 1], &faces[i]) == 0)
            faces[joined - 1].area += faces[i].area;
        else
            faces[joined++] = faces[i];
    }
    qsort(faces, joined, sizeof *faces, compare_areas);
    return joined;
}

/* ---- the best orientation ---- */

static bool is_new(const KrsMeasures *measures, const double up[3])
{
    for (size_t i = 0; i < measures->orientation_count; i++)
        if (dot3(measures->orientations[i].up, up) > LEVEL)
            return false;
    return true;
}

static void add_orientation(Measurer *m, const double up[3], double *angles)
{
    if (is_new(m->measures, up))
        m->measures->orientations[m->measures->orientation_count++] = lie(m, up, angles);
}

/* Returns the overhang in whole numbers of SAME_AREA, so that the order is transitive. */
static double rank_of(const KrsOrientation *orientation, double area)
{
    return floor(orientation->overhang / (SAME_AREA * area) + 0.5);
}

typedef struct Ranked {
    KrsOrientation orientation;
    double         rank;
    size_t         number;
} Ranked;

/* Orders those that stand first, then by overhang, then as they were found. */
static int compare_orientations(const void *a, const void *b)
{
    const Ranked *x = a, *y = b;
    if (x->orientation.stands != y->orientation.stands)
        return x->orientation.stands ? -1 : 1;
    if (x->rank != y->rank)
        return x->rank < y->rank ? -1 : 1;
    return x->number < y->number ? -1 : x->number > y->number;
}

static void sort_orientations(Measurer *m)
{
    KrsMeasures *measures = m->measures;
    Ranked      *ranked   = arena_new_array(&m->arena, Ranked, measures->orientation_count + 1);
    for (size_t i = 0; i < measures->orientation_count; i++)
        ranked[i] = (Ranked){measures->orientations[i],
                             rank_of(&measures->orientations[i], measures->area), i};
    qsort(ranked, measures->orientation_count, sizeof *ranked, compare_orientations);
    for (size_t i = 0; i < measures->orientation_count; i++)
        measures->orientations[i] = ranked[i].orientation;
}

void measure_lying(Measurer *m)
{
    KrsMeasures *measures = m->measures;
    double      *angles   = arena_new_array(&m->arena, double, m->samples.count + 1);
    Face        *faces    = arena_new_array(&m->arena, Face, m->samples.count + 1);
    double       up[3];
    size_t       count = find_faces(m, faces);
    add_orientation(m, measures->as_is.up, angles);
    measures->as_is = measures->orientations[0];
    for (int i = 0; i < 6; i++) {
        memset(up, 0, sizeof up);
        up[i / 2] = i % 2 ? -1 : 1;
        add_orientation(m, up, angles);
    }
    for (size_t i = 0; i < count && i < MAX_RESTS; i++) {
        for (int k = 0; k < 3; k++)
            up[k] = -faces[i].normal[k];
        KrsOrientation lying = lie(m, up, angles);
        if (lying.base > 0.5 * faces[i].area && is_new(measures, up))
            measures->orientations[measures->orientation_count++] = lying;
    }
    sort_orientations(m);
}
