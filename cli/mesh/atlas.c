/*
 * atlas.c: an atlas of charts.
 *
 * A chart is a group of triangles that lie beside each other and face about one way.  It is seen
 * from there, so it is a height field: a triangle that would lie above or below another of its
 * chart begins one of its own.  Charts are rotated so that their rectangles are small, and these
 * stand on shelves.  Pixels are as small as the picture permits.
 */
#include "cli/mesh/atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/mesh/meshing.h"
#include "compiler/base/vec.h"

/* Pixels around a triangle that are its own: a bilinear look at a point of it reaches as far. */
enum { MARGIN = 2 };
enum { ROTATIONS = 16, MAX_TRIES = 400 };
/* The cosine of the angle between a triangle of a chart and its first one. */
static const double MIN_COSINE = 0.7;
/* Heights that differ by more pixels are of two layers, one above the other. */
static const double ONE_SHEET = 8;
/* The picture is about full at first; then pixels grow until it suffices. */
static const double MAX_FILLED = 0.9, GROWTH = 1.04;

typedef struct Chart {
    size_t   first, count; /* of Layout.list */
    double   cosine, sine; /* it is rotated by this */
    double   low[2];       /* then, of its triangles */
    uint32_t width, height;
    uint32_t at[2];
} Chart;

typedef struct Layout {
    Arena           *arena;
    const MeshParts *parts;
    const float     *fineness;
    size_t           count; /* of triangles */
    uint32_t         side;
    double           pixel;
    double (*normals)[3];
    uint32_t (*neighbours)[3]; /* across the edge from corner k to the next */
    uint32_t *order;           /* the largest first */
    size_t    ordered;
    double   *areas;
    bool     *placed;
    uint32_t *list; /* triangles, chart by chart */
    size_t    listed;
    double (*corners)[3][2];
    float    *heights; /* of the pixels of the chart that is growing */
    uint32_t *stamps;  /* whose height it is: a chart's, from 1 */
    struct {
        Chart *items;
        size_t count, capacity;
    } charts;
} Layout;

/* ---- triangles ---- */

double atlas_nearest(const double c[3][2], const double point[2], double weights[3])
{
    double least = HUGE_VAL, areas[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = c[(k + 1) % 3], *b = c[(k + 2) % 3];
        areas[k] = (a[0] - point[0]) * (b[1] - point[1]) - (a[1] - point[1]) * (b[0] - point[0]);
        sum += areas[k];
    }
    for (int k = 0; k < 3; k++)
        weights[k] = areas[k] / sum;
    if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0)
        return 0;
    for (int k = 0; k < 3; k++) {
        const double *a = c[k], *b = c[(k + 1) % 3];
        const double  along[2] = {b[0] - a[0], b[1] - a[1]};
        const double  to[2]    = {point[0] - a[0], point[1] - a[1]};
        const double  square   = along[0] * along[0] + along[1] * along[1];
        const double  share    = square > 0 ? (along[0] * to[0] + along[1] * to[1]) / square : 0;
        const double  t        = fmin(fmax(share, 0), 1);
        const double  away     = hypot(to[0] - t * along[0], to[1] - t * along[1]);
        if (away >= least)
            continue;
        least                = away;
        weights[k]           = 1 - t;
        weights[(k + 1) % 3] = t;
        weights[(k + 2) % 3] = 0;
    }
    return least;
}

static const double *corner_of(const Layout *l, size_t triangle, int k)
{
    return l->parts->in_scene[l->parts->triangles[triangle][k]];
}

static void find_normals(Layout *l)
{
    for (size_t t = 0; t < l->count; t++) {
        double along[3], across[3];
        add_scaled3(along, corner_of(l, t, 1), -1, corner_of(l, t, 0));
        add_scaled3(across, corner_of(l, t, 2), -1, corner_of(l, t, 0));
        cross3(along, across, l->normals[t]);
        l->areas[t] = 0.5 * length3(l->normals[t]) * l->fineness[t] * l->fineness[t];
        normalize3(l->normals[t]);
    }
}

typedef struct Ranked {
    double   area;
    uint32_t triangle;
} Ranked;

static int compare_ranked(const void *a, const void *b)
{
    const Ranked *x = a, *y = b;
    if (x->area != y->area)
        return x->area < y->area ? 1 : -1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void find_order(Layout *l)
{
    Ranked *ranked = arena_alloc(l->arena, l->count, sizeof *ranked);
    for (uint32_t t = 0; t < l->count; t++)
        if (l->fineness[t] > 0)
            ranked[l->ordered++] = (Ranked){l->areas[t], t};
    qsort(ranked, l->ordered, sizeof *ranked, compare_ranked);
    for (size_t i = 0; i < l->ordered; i++)
        l->order[i] = ranked[i].triangle;
}

typedef struct Edge {
    uint32_t low, high, triangle, corner;
} Edge;

static int compare_edges(const void *a, const void *b)
{
    const Edge *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void find_neighbours(Layout *l)
{
    Edge *edges = arena_alloc(l->arena, 3 * l->count, sizeof *edges);
    memset(l->neighbours, 0xff, l->count * sizeof *l->neighbours);
    for (uint32_t i = 0; i < 3 * l->count; i++) {
        const uint32_t *corners = l->parts->triangles[i / 3];
        uint32_t        a = corners[i % 3], b = corners[(i + 1) % 3];
        edges[i] = (Edge){a < b ? a : b, a < b ? b : a, i / 3, i % 3};
    }
    qsort(edges, 3 * l->count, sizeof *edges, compare_edges);
    for (size_t i = 1; i < 3 * l->count; i++) {
        const Edge *a = &edges[i - 1], *b = &edges[i];
        if (a->low != b->low || a->high != b->high)
            continue;
        l->neighbours[a->triangle][a->corner] = b->triangle;
        l->neighbours[b->triangle][b->corner] = a->triangle;
    }
}

/* ---- rows of pixels ---- */

typedef struct Rows {
    long first, last;
} Rows;

static Rows rows_of(const double c[3][2])
{
    double low  = fmin(c[0][1], fmin(c[1][1], c[2][1]));
    double high = fmax(c[0][1], fmax(c[1][1], c[2][1]));
    return (Rows){lrint(ceil(low - MARGIN - 0.5)), lrint(floor(high + MARGIN - 0.5))};
}

/* Returns the pixels of a row that are not farther from a triangle than the margin, and some more. */
static Rows pixels_of(const double c[3][2], long row)
{
    double low = (double)row + 0.5 - MARGIN, high = (double)row + 0.5 + MARGIN;
    double left = HUGE_VAL, right = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double *a = c[k], *b = c[(k + 1) % 3];
        if (fmax(a[1], b[1]) < low || fmin(a[1], b[1]) > high)
            continue;
        for (int end = 0; end < 2; end++) {
            const double *here = end ? b : a, *there = end ? a : b;
            double        y = fmin(fmax(here[1], low), high);
            double        x = here[1] == there[1]
                                  ? here[0]
                                  : here[0] + (there[0] - here[0]) * (y - here[1]) / (there[1] - here[1]);
            left            = fmin(left, x);
            right           = fmax(right, x);
        }
    }
    if (left > right)
        return (Rows){0, -1};
    return (Rows){lrint(ceil(left - MARGIN - 0.5)), lrint(floor(right + MARGIN - 0.5))};
}

/* ---- charts ---- */

/* The directions from which a chart is seen: right, down and towards the eye, from the first corner
   of its first triangle. */
typedef struct View {
    double axes[3][3], origin[3];
    double scale; /* pixels of a length of 1 */
    float  fineness;
    double low[2], high[2];
} View;

static void view_triangle(const Layout *l, uint32_t seed, View *view)
{
    int    longest = 0;
    double edges[3][3], *normal = view->axes[2];
    for (int k = 0; k < 3; k++) {
        add_scaled3(edges[k], corner_of(l, seed, (k + 1) % 3), -1, corner_of(l, seed, k));
        if (length3(edges[k]) > length3(edges[longest]))
            longest = k;
    }
    memcpy(view->axes[0], edges[longest], sizeof view->axes[0]);
    memcpy(normal, l->normals[seed], sizeof view->axes[2]);
    if (!normalize3(view->axes[0]))
        view->axes[0][0] = 1;
    if (length3(normal) == 0) { /* it has no area: any that is across */
        double axis[3]                             = {0, 0, 0};
        axis[fabs(view->axes[0][0]) < 0.7 ? 0 : 1] = 1;
        cross3(view->axes[0], axis, normal);
        normalize3(normal);
    }
    cross3(normal, view->axes[0], view->axes[1]);
    memcpy(view->origin, corner_of(l, seed, 0), sizeof view->origin);
    view->fineness = l->fineness[seed];
    view->scale    = view->fineness / l->pixel;
    for (int k = 0; k < 2; k++) {
        view->low[k]  = HUGE_VAL;
        view->high[k] = -HUGE_VAL;
    }
}

/* A triangle in a view: corners in pixels, and heights as those of a plane between two limits. */
typedef struct Seen {
    double corners[3][2], heights[3], slope[2], low, high;
} Seen;

static void see(const Layout *l, const View *view, uint32_t triangle, Seen *seen)
{
    const double *normal = l->normals[triangle];
    const double  facing = dot3(normal, view->axes[2]);
    seen->low            = HUGE_VAL;
    seen->high           = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double from[3];
        add_scaled3(from, corner_of(l, triangle, k), -1, view->origin);
        for (int i = 0; i < 2; i++)
            seen->corners[k][i] = view->scale * dot3(from, view->axes[i]);
        seen->heights[k] = view->scale * dot3(from, view->axes[2]);
        seen->low        = fmin(seen->low, seen->heights[k]);
        seen->high       = fmax(seen->high, seen->heights[k]);
    }
    for (int i = 0; i < 2; i++)
        seen->slope[i] = facing > 0 ? -dot3(normal, view->axes[i]) / facing : 0;
}

static double height_at(const Seen *seen, long row, long column)
{
    double height = seen->heights[0] +
                    seen->slope[0] * ((double)column + 0.5 - seen->corners[0][0]) +
                    seen->slope[1] * ((double)row + 0.5 - seen->corners[0][1]);
    return fmin(fmax(height, seen->low), seen->high);
}

/* No chart is larger than the picture, so places that differ by its side are not both in one. */
static size_t pixel_at(const Layout *l, long row, long column)
{
    long side = l->side;
    return (size_t)(((row % side + side) % side) * side + (column % side + side) % side);
}

/* Tells whether no other layer of the chart is where a triangle is seen.  `keep`: the chart has the
   triangle, and its heights are noted. */
static bool is_free(Layout *l, const Seen *seen, uint32_t stamp, bool keep)
{
    const double(*c)[2] = (const double(*)[2])seen->corners;
    Rows rows           = rows_of(c);
    for (long row = rows.first; row <= rows.last; row++) {
        Rows pixels = pixels_of(c, row);
        for (long column = pixels.first; column <= pixels.last; column++) {
            size_t at     = pixel_at(l, row, column);
            double height = height_at(seen, row, column);
            bool   known  = l->stamps[at] == stamp;
            if (!keep && known && fabs(height - l->heights[at]) > ONE_SHEET)
                return false;
            if (keep && !known) {
                l->stamps[at]  = stamp;
                l->heights[at] = (float)height;
            }
        }
    }
    return true;
}

static bool widen(const Layout *l, View *view, const Seen *seen)
{
    const double most = (double)l->side - 2 * MARGIN - 2;
    double       low[2], high[2];
    for (int i = 0; i < 2; i++) {
        const double a = seen->corners[0][i], b = seen->corners[1][i], c = seen->corners[2][i];
        low[i]  = fmin(view->low[i], fmin(a, fmin(b, c)));
        high[i] = fmax(view->high[i], fmax(a, fmax(b, c)));
        if (high[i] - low[i] > most)
            return false;
    }
    memcpy(view->low, low, sizeof low);
    memcpy(view->high, high, sizeof high);
    return true;
}

/* Tells whether a triangle faces the view; one without an area fits everywhere. */
static bool faces(const Layout *l, const View *view, uint32_t triangle)
{
    const double *normal = l->normals[triangle];
    return length3(normal) == 0 || dot3(normal, view->axes[2]) >= MIN_COSINE;
}

static bool take_triangle(Layout *l, View *view, uint32_t triangle, uint32_t stamp)
{
    Seen seen;
    if (triangle == ATLAS_NONE || l->placed[triangle] || l->fineness[triangle] != view->fineness ||
        !faces(l, view, triangle))
        return false;
    see(l, view, triangle, &seen);
    if (!is_free(l, &seen, stamp, false) || !widen(l, view, &seen))
        return false;
    is_free(l, &seen, stamp, true);
    memcpy(l->corners[triangle], seen.corners, sizeof seen.corners);
    l->placed[triangle]  = true;
    l->list[l->listed++] = triangle;
    return true;
}

/* Grows a chart from a triangle; false: that is larger than the picture. */
static bool grow_chart(Layout *l, uint32_t seed)
{
    View     view;
    Chart    chart = {.first = l->listed, .cosine = 1};
    uint32_t stamp = (uint32_t)l->charts.count + 1;
    view_triangle(l, seed, &view);
    if (!take_triangle(l, &view, seed, stamp))
        return false;
    for (size_t i = chart.first; i < l->listed; i++)
        for (int k = 0; k < 3; k++)
            take_triangle(l, &view, l->neighbours[l->list[i]][k], stamp);
    chart.count = l->listed - chart.first;
    array_push(l->arena, &l->charts, chart);
    return true;
}

/* ---- rectangles ---- */

static void rotate(const Chart *chart, const double point[2], double rotated[2])
{
    rotated[0] = chart->cosine * point[0] - chart->sine * point[1];
    rotated[1] = chart->sine * point[0] + chart->cosine * point[1];
}

static void find_size(const Layout *l, const Chart *chart, double low[2], double size[2])
{
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    low[0] = low[1] = HUGE_VAL;
    for (size_t i = chart->first; i < chart->first + chart->count; i++)
        for (int k = 0; k < 3; k++) {
            double at[2];
            rotate(chart, l->corners[l->list[i]][k], at);
            for (int n = 0; n < 2; n++) {
                low[n]  = fmin(low[n], at[n]);
                high[n] = fmax(high[n], at[n]);
            }
        }
    for (int n = 0; n < 2; n++)
        size[n] = high[n] - low[n];
}

/* Takes another rotation if that makes the rectangle smaller; rectangles lie. */
static void try_rotation(const Layout *l, Chart *best, double *least, double x, double y)
{
    Chart  chart  = *best;
    double length = hypot(x, y), low[2], size[2];
    if (length == 0)
        return;
    chart.cosine = x / length;
    chart.sine   = -y / length;
    find_size(l, &chart, low, size);
    if (size[1] > size[0]) {
        double cosine = chart.cosine;
        chart.cosine  = -chart.sine;
        chart.sine    = cosine;
        find_size(l, &chart, low, size);
    }
    double area = (size[0] + 2 * MARGIN) * (size[1] + 2 * MARGIN);
    if (area >= *least * (1 - 1e-9))
        return;
    *least = area;
    *best  = chart;
    memcpy(best->low, low, sizeof low);
    best->width  = (uint32_t)ceil(size[0]) + 2 * MARGIN;
    best->height = (uint32_t)ceil(size[1]) + 2 * MARGIN;
}

/* The first triangle is the largest; on flat faces one of its edges is often a side. */
static void rotate_chart(const Layout *l, Chart *chart)
{
    const double(*c)[2] = (const double(*)[2])l->corners[l->list[chart->first]];
    double least        = HUGE_VAL;
    for (int k = 0; k < 3; k++)
        try_rotation(l, chart, &least, c[(k + 1) % 3][0] - c[k][0], c[(k + 1) % 3][1] - c[k][1]);
    for (int i = 0; i < ROTATIONS; i++)
        try_rotation(l, chart, &least, cos(M_PI_2 * i / ROTATIONS), sin(M_PI_2 * i / ROTATIONS));
}

static int compare_charts(const void *a, const void *b)
{
    const Chart *x = a, *y = b;
    if (x->height != y->height)
        return x->height < y->height ? 1 : -1;
    if (x->width != y->width)
        return x->width < y->width ? 1 : -1;
    return x->first < y->first ? -1 : 1;
}

/* Puts the charts into rows, from the highest on; false: they do not fit. */
static bool shelve(Layout *l)
{
    uint32_t x = 0, y = 0, shelf = 0;
    qsort(l->charts.items, l->charts.count, sizeof *l->charts.items, compare_charts);
    for (size_t i = 0; i < l->charts.count; i++) {
        Chart *chart = &l->charts.items[i];
        if (x + chart->width > l->side) {
            y += shelf;
            x = shelf = 0;
        }
        if (chart->width > l->side || y + chart->height > l->side)
            return false;
        chart->at[0] = x;
        chart->at[1] = y;
        x += chart->width;
        shelf = chart->height > shelf ? chart->height : shelf;
    }
    return true;
}

static bool lay_out(Layout *l)
{
    memset(l->placed, 0, l->count * sizeof *l->placed);
    memset(l->stamps, 0, (size_t)l->side * l->side * sizeof *l->stamps);
    l->listed = l->charts.count = 0;
    for (size_t i = 0; i < l->ordered; i++)
        if (!l->placed[l->order[i]] && !grow_chart(l, l->order[i]))
            return false;
    for (size_t i = 0; i < l->charts.count; i++)
        rotate_chart(l, &l->charts.items[i]);
    return shelve(l);
}

/* ---- the picture ---- */

static void place_charts(Layout *l)
{
    for (size_t n = 0; n < l->charts.count; n++) {
        const Chart *chart = &l->charts.items[n];
        for (size_t i = chart->first; i < chart->first + chart->count; i++)
            for (int k = 0; k < 3; k++) {
                double *corner = l->corners[l->list[i]][k], rotated[2];
                rotate(chart, corner, rotated);
                for (int m = 0; m < 2; m++)
                    corner[m] = rotated[m] - chart->low[m] + chart->at[m] + MARGIN;
            }
    }
}

/* Finds the nearest triangle for each pixel that is near to one; `heights` become distances. */
static void find_owners(Layout *l, Atlas *atlas)
{
    float *away = l->heights;
    for (size_t i = 0; i < (size_t)l->side * l->side; i++) {
        atlas->owner[i] = ATLAS_NONE;
        away[i]         = MARGIN;
    }
    for (size_t i = 0; i < l->listed; i++) {
        const double(*c)[2] = (const double(*)[2])l->corners[l->list[i]];
        Rows rows           = rows_of(c);
        for (long row = rows.first; row <= rows.last; row++) {
            Rows pixels = pixels_of(c, row);
            for (long column = pixels.first; column <= pixels.last; column++) {
                const double point[2] = {(double)column + 0.5, (double)row + 0.5};
                double       weights[3], distance = atlas_nearest(c, point, weights);
                size_t       at = pixel_at(l, row, column);
                if (!(distance < away[at]))
                    continue;
                away[at]         = (float)distance;
                atlas->owner[at] = l->list[i];
            }
        }
    }
}

static double total_area(const Layout *l)
{
    double area = 0;
    for (size_t i = 0; i < l->ordered; i++)
        area += l->areas[l->order[i]];
    return area;
}

/* Charts have margins, however small they are; larger pixels do not make them fewer. */
static bool may_fit(const Layout *l)
{
    return l->charts.count * 4 * MARGIN * MARGIN <= (size_t)l->side * l->side;
}

bool atlas_make(Arena *arena, const MeshParts *parts, const float *fineness, uint32_t side,
                Atlas *atlas)
{
    size_t count = parts_triangle_count(parts), pixels = (size_t)side * side;
    Layout l    = {.arena      = arena,
                   .parts      = parts,
                   .fineness   = fineness,
                   .count      = count,
                   .side       = side,
                   .normals    = arena_alloc(arena, count, sizeof *l.normals),
                   .neighbours = arena_alloc(arena, count, sizeof *l.neighbours),
                   .order      = arena_new_array(arena, uint32_t, count),
                   .areas      = arena_new_array(arena, double, count),
                   .placed     = arena_new_array(arena, bool, count),
                   .list       = arena_new_array(arena, uint32_t, count),
                   .corners    = arena_alloc(arena, count, sizeof *l.corners),
                   .heights    = arena_new_array(arena, float, pixels),
                   .stamps     = arena_new_array(arena, uint32_t, pixels)};
    bool   done = false;
    find_normals(&l);
    find_neighbours(&l);
    find_order(&l);
    l.pixel = sqrt(total_area(&l) / MAX_FILLED) / side;
    for (int i = 0; i < MAX_TRIES && l.pixel > 0 && !done && may_fit(&l); i++) {
        l.pixel *= GROWTH;
        done = lay_out(&l);
    }
    if (!done)
        return false;
    *atlas = (Atlas){side, l.pixel, l.corners, arena_new_array(arena, uint32_t, pixels),
                     l.charts.count};
    place_charts(&l);
    find_owners(&l, atlas);
    return true;
}
