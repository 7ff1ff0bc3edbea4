/*
 * cover.c: covers of balls.  Everything here errs to the outside.
 */
#include "compiler/shape/cover.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

/* Cells that one box is cut into, about; cells of a cover, beyond which neighbours are merged. */
enum { BOX_CELLS = 64, MAX_CELLS = 1024, MAX_OUTSIDE = 16 };

/* Rounding, and how near to its surface the pole of an inversion counts as on it. */
static const double ROUNDING = 1e-12, ON_SURFACE = 1e-6;

/* A cell that reaches farther counts as endless: near a pole its ball is far too large. */
static const double FARTHEST = 1e9;

static const CoverCell everything = {.outside = true};

static double middle(Range range) { return 0.5 * (range.low + range.high); }

/* Returns the middle of three ranges; returns how far they leave it, rounding included. */
static double middle_of(const Range range[3], double centre[3])
{
    double leave = 0, size = 0;
    for (int i = 0; i < 3; i++) {
        centre[i] = middle(range[i]);
        leave     = real_hypot(leave, 0.5 * (range[i].high - range[i].low));
        size      = real_hypot(size, centre[i]);
    }
    return leave * (1 + ROUNDING) + ROUNDING * size;
}

/* Returns the cell that holds a ball for every centre in the given ranges. */
static CoverCell cell_about(const Range centre[3], double radius, bool outside)
{
    CoverCell cell   = {.outside = outside};
    double    leave  = middle_of(centre, cell.ball.centre);
    cell.ball.radius = outside ? radius * (1 - ROUNDING) - leave : radius * (1 + ROUNDING) + leave;
    bool finite      = cell.ball.radius >= 0 && cell.ball.radius <= FARTHEST &&
                  dot3(cell.ball.centre, cell.ball.centre) <= FARTHEST * FARTHEST;
    return finite ? cell : everything;
}

void cover_add(Arena *arena, Cover *cover, Box box)
{
    double sides[3], most = 0, volume = 1;
    size_t counts[3];
    if (box_is_empty(box))
        return;
    for (int i = 0; i < 3; i++) {
        sides[i] = box.axis[i].high - box.axis[i].low;
        most     = fmax(most, sides[i]);
    }
    for (int i = 0; i < 3; i++)
        volume *= fmax(sides[i], most / BOX_CELLS);
    double step = most > 0 ? real_cbrt(volume / BOX_CELLS) : 1;
    for (int i = 0; i < 3; i++)
        counts[i] = (size_t)fmax(1, fmin(round(sides[i] / step), BOX_CELLS));
    for (size_t k = 0; k < counts[0] * counts[1] * counts[2]; k++) {
        size_t cell[3] = {k % counts[0], k / counts[0] % counts[1], k / counts[0] / counts[1]};
        Box    piece;
        for (int i = 0; i < 3; i++) {
            double width  = sides[i] / (double)counts[i];
            piece.axis[i] = (Range){box.axis[i].low + width * (double)cell[i],
                                    box.axis[i].low + width * (double)(cell[i] + 1)};
        }
        Ball  ball      = ball_around(piece);
        Range centre[3] = {range_of(ball.centre[0]), range_of(ball.centre[1]),
                           range_of(ball.centre[2])};
        array_push(arena, cover, cell_about(centre, ball.radius, false));
    }
}

Box cover_box(const Cover *cover)
{
    Box box = box_empty;
    for (size_t i = 0; i < cover->count; i++) {
        if (cover->items[i].outside)
            return box_infinite;
        box = box_hull(box, ball_box(cover->items[i].ball));
    }
    return box;
}

/* ---- maps ---- */

/*
 * Returns the image under z -> s z / |z|^2: with D = |c|^2 - r^2 the ball of centre s c / D and
 * radius s r / |D|. A ball around the pole (D < 0) goes to what is outside of that ball, and what
 * is outside of a ball around the pole goes to the inside.
 */
static CoverCell invert(CoverCell cell, Range s)
{
    const double *c = cell.ball.centre;
    double        r = cell.ball.radius, square = dot3(c, c), d = square - r * r;
    if (!(fabs(d) > ON_SURFACE * (square + r * r)))
        return everything;
    Range centre[3];
    for (int i = 0; i < 3; i++)
        centre[i] = range_mul(s, range_of(c[i] / d));
    bool outside = cell.outside == (d > 0);
    return cell_about(centre, (outside ? s.low : s.high) * r / fabs(d), outside);
}

static CoverCell map_cell(CoverCell cell, const MapRange *map)
{
    Range  c[3], rotated[3];
    Range  scale  = map->scale;
    double radius = cell.ball.radius;
    for (int i = 0; i < 3; i++)
        c[i] = range_of(cell.ball.centre[i]);
    if (map->inverts) {
        for (int i = 0; i < 3; i++)
            c[i] = range_sub(c[i], map->pole[i]);
        cell = cell_about(c, radius, cell.outside);
        if (cell.outside && cell.ball.radius == 0)
            return everything;
        cell   = invert(cell, scale);
        scale  = range_of(1);
        radius = cell.ball.radius;
        for (int i = 0; i < 3; i++)
            c[i] = range_of(cell.ball.centre[i]);
    }
    for (int i = 0; i < 3; i++) {
        rotated[i] = range_mul(map->rows[i][0], c[0]);
        for (int j = 1; j < 3; j++)
            rotated[i] = range_add(rotated[i], range_mul(map->rows[i][j], c[j]));
        rotated[i] = range_add(range_mul(scale, rotated[i]), map->shift[i]);
    }
    if (cell.outside && radius == 0)
        return everything;
    return cell_about(rotated, radius * (cell.outside ? scale.low : scale.high), cell.outside);
}

void cover_map(Cover *cover, const MapRange *map)
{
    for (size_t i = 0; i < cover->count; i++)
        cover->items[i] = map_cell(cover->items[i], map);
}

/* ---- neighbours become one ---- */

/* Cells that stand side by side, and a ball around all of them. */
typedef struct Cluster {
    size_t from, to;
    Ball   ball;
    Range  centres[3];
} Cluster;

static Cluster cluster_of(const Cover *cover, size_t from, size_t to)
{
    Cluster cluster = {from, to, {{0, 0, 0}, 0}, {{0, 0}, {0, 0}, {0, 0}}};
    Box     box     = box_empty;
    for (size_t i = from; i < to; i++) {
        const Ball *ball = &cover->items[i].ball;
        box              = box_hull(box, ball_box(*ball));
        for (int k = 0; k < 3; k++) {
            Range centre       = range_of(ball->centre[k]);
            cluster.centres[k] = i == from ? centre : range_hull(cluster.centres[k], centre);
        }
    }
    box_centre(box, cluster.ball.centre);
    for (size_t i = from; i < to; i++) {
        const Ball *ball = &cover->items[i].ball;
        double      offset[3];
        for (int k = 0; k < 3; k++)
            offset[k] = ball->centre[k] - cluster.ball.centre[k];
        cluster.ball.radius = fmax(cluster.ball.radius, sqrt(dot3(offset, offset)) + ball->radius);
    }
    cluster.ball.radius *= 1 + ROUNDING;
    return cluster;
}

Ball cover_ball(const Cover *cover)
{
    if (cover->count == 0)
        return ball_around(box_empty);
    for (size_t i = 0; i < cover->count; i++)
        if (cover->items[i].outside)
            return ball_around(box_infinite);
    return cluster_of(cover, 0, cover->count).ball;
}

/* Parts the cells at the middle of the axis on which their centres are spread most; if all centres
   are one point, by their numbers. */
static size_t partition(Cover *cover, const Cluster *cluster)
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (cluster->centres[k].high - cluster->centres[k].low >
            cluster->centres[axis].high - cluster->centres[axis].low)
            axis = k;
    double cut = middle(cluster->centres[axis]);
    size_t low = cluster->from;
    for (size_t i = cluster->from; i < cluster->to; i++) {
        CoverCell cell = cover->items[i];
        if (cell.ball.centre[axis] > cut)
            continue;
        cover->items[i]     = cover->items[low];
        cover->items[low++] = cell;
    }
    bool split = low > cluster->from && low < cluster->to;
    return split ? low : cluster->from + (cluster->to - cluster->from) / 2;
}

/* Returns how much a cluster is worth parting: a single ball is not. */
static double size_of(const Cluster *cluster)
{
    return cluster->to - cluster->from > 1 ? cluster->ball.radius : -1;
}

/* Heaps, the largest cluster on top: puts one in from the top, or from the end. */
static void sink(Cluster *heap, size_t count, Cluster cluster)
{
    size_t hole = 0;
    for (size_t child; (child = 2 * hole + 1) < count; hole = child) {
        if (child + 1 < count && size_of(&heap[child + 1]) > size_of(&heap[child]))
            child++;
        if (size_of(&heap[child]) <= size_of(&cluster))
            break;
        heap[hole] = heap[child];
    }
    heap[hole] = cluster;
}

static void rise(Cluster *heap, size_t count, Cluster cluster)
{
    size_t hole = count;
    for (; hole && size_of(&heap[(hole - 1) / 2]) < size_of(&cluster); hole = (hole - 1) / 2)
        heap[hole] = heap[(hole - 1) / 2];
    heap[hole] = cluster;
}

/* Parts the largest cluster, from all balls in one, until there are enough. */
static void merge_balls(Arena *arena, Cover *cover, size_t from)
{
    size_t   count = 1, most = MAX_CELLS - from;
    Cluster *heap = arena_new_array(arena, Cluster, most);
    heap[0]       = cluster_of(cover, from, cover->count);
    while (count < most && size_of(&heap[0]) >= 0) {
        Cluster whole = heap[0];
        size_t  cut   = partition(cover, &whole);
        sink(heap, count, cluster_of(cover, whole.from, cut));
        rise(heap, count++, cluster_of(cover, cut, whole.to));
    }
    cover->count = from + count;
    for (size_t i = 0; i < count; i++)
        cover->items[from + i] = (CoverCell){.ball = heap[i].ball};
}

/* Leaves at most MAX_CELLS cells; what is outside of balls comes first. */
static void merge(Arena *arena, Cover *cover)
{
    size_t outside = 0;
    if (cover->count <= MAX_CELLS)
        return;
    for (size_t i = 0; i < cover->count; i++) {
        CoverCell cell = cover->items[i];
        if (!cell.outside)
            continue;
        cover->items[i]         = cover->items[outside];
        cover->items[outside++] = cell;
    }
    if (outside > MAX_OUTSIDE) {
        cover->items[0] = everything;
        cover->count    = 1;
        return;
    }
    merge_balls(arena, cover, outside);
}

/* ---- mirrors ---- */

static CoverCell mirrored(CoverCell cell, const Range u[3], Range e)
{
    Range centre[3];
    if (cell.outside && cell.ball.radius == 0)
        return cell;
    for (int i = 0; i < 3; i++)
        centre[i] = range_sub(range_of(cell.ball.centre[i]),
                              range_mul(range_of(2), range_mul(e, u[i])));
    return cell_about(centre, cell.ball.radius, cell.outside);
}

void cover_fold(Arena *arena, Cover *cover, const Range u[3], Range w)
{
    size_t retained = 0, count = cover->count;
    Cover  images = {0};
    for (size_t i = 0; i < count; i++) {
        CoverCell cell = cover->items[i];
        Range     e    = range_sub(range_of(0), w);
        for (int k = 0; k < 3; k++)
            e = range_add(e, range_mul(u[k], range_of(cell.ball.centre[k])));
        if (!cell.outside && e.low >= 0) {
            /* Less than half of a ball, and its image: one ball, or nothing. */
            cell.ball = ball_fold(cell.ball, u, w);
            if (cell.ball.radius >= 0)
                cover->items[retained++] = cell;
            continue;
        }
        cover->items[retained++] = cell;
        array_push(arena, &images, mirrored(cell, u, e));
    }
    cover->count = retained;
    for (size_t i = 0; i < images.count; i++)
        array_push(arena, cover, images.items[i]);
    merge(arena, cover);
}

/* ---- mirrors that are spheres ---- */

static MapRange inversion_in(const Range centre[3], Range radius)
{
    MapRange map = {.inverts = true, .scale = range_square(radius)};
    for (int i = 0; i < 3; i++) {
        map.pole[i] = map.shift[i] = centre[i];
        for (int j = 0; j < 3; j++)
            map.rows[i][j] = range_of(i == j);
    }
    return map;
}

/* Tells whether nothing of a cell is outside of a sphere. */
static bool is_swallowed(CoverCell cell, const double centre[3], double radius)
{
    double offset[3];
    for (int i = 0; i < 3; i++)
        offset[i] = cell.ball.centre[i] - centre[i];
    return !cell.outside && sqrt(dot3(offset, offset)) + cell.ball.radius <= radius;
}

void cover_fold_sphere(Arena *arena, Cover *cover, const Range centre[3], Range radius)
{
    MapRange  inversion = inversion_in(centre, radius);
    CoverCell sphere    = cell_about(centre, radius.high, false);
    Cover     images    = {0};
    size_t    retained  = 0;
    double    about[3], leave = middle_of(centre, about);
    for (size_t i = 0; i < cover->count; i++) {
        CoverCell cell = cover->items[i];
        if (is_swallowed(cell, about, radius.low - leave))
            continue;
        cover->items[retained++] = cell;
        CoverCell image          = map_cell(cell, &inversion);
        bool      smaller        = !image.outside && image.ball.radius < sphere.ball.radius;
        array_push(arena, &images, smaller || sphere.outside ? image : sphere);
    }
    cover->count = retained;
    for (size_t i = 0; i < images.count; i++)
        array_push(arena, cover, images.items[i]);
    merge(arena, cover);
}
