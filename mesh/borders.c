/*
 * borders.c: samples triangles at many points, and splits edges where the material changes along
 * them.
 *
 * Both triangles of an edge are split at the same vertex, so the mesh stays closed.  A straight
 * border through a triangle is an edge at once; where one bends, its triangles are halved until it
 * is near enough.
 */
#include "mesh/borders.h"

#include <setjmp.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/allocator.h"
#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "compiler/field/steps.h"
#include "mesh/common/numbering.h"

enum { MAX_ROUNDS = 64, PROBES = 64, HALVINGS = 45 };
/* Lengths in errors: the spacing of samples, their margin to edges, where the mesh may belong to
   the neighbour, and how near to a vertex no edge is split. */
static const double SPACING = 2, MARGIN = 1.5, NEAR_VERTEX = 0.25;
/* The least spacing, as a part of the size of the mesh. */
static const double MIN_SPACING = 1.0 / 500;
/* Parts of the height of a triangle: the largest margin, and the distance to an edge at which its
   split is searched. */
static const double MAX_MARGIN = 1.0 / 3, AT_EDGE = 1e-4;

/* The places at which the edges of a triangle are split, from corner k to the next; 0: nowhere. */
typedef struct SplitPoints {
    double at[3];
} SplitPoints;

typedef struct Borders {
    Memory                memory;
    Arena                 arena;
    const KrsMeshOptions *options;
    const double (*copy)[4];
    KrsState *states[MAX_PARTS];
    struct {
        double (*items)[3];
        size_t count, capacity;
    } vertices;
    struct {
        uint32_t (*items)[3];
        size_t count, capacity;
    } triangles;
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } fresh;             /* triangles to be sampled */
    bool         *mixed; /* of all triangles */
    SplitPoints  *split_points;
    double        error, spacing; /* in the scene: the mesh's, and that of samples */
    bool          normals;        /* materials depend on them */
    int           round;
    atomic_size_t next;
    atomic_bool   stopped, failed;
} Borders;

/* ---- materials at points ---- */

/* A triangle in the scene; `margin` is the least weight of each corner in a sample. */
typedef struct Sampling {
    Borders  *b;
    KrsState *state;
    bool      asks; /* reports progress, and stops if that says so */
    double    corners[3][3], margin[3], heights[3]; /* of the corners */
    double    lengths[3];                           /* of the edges from them */
    int       longest;
} Sampling;

static uint64_t mix_in(uint64_t label, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        label = (label ^ ((const unsigned char *)bytes)[i]) * 1099511628211u;
    return label;
}

/* Returns a hash (FNV-1a) of all properties of the material. */
static uint64_t label_of(const KrsHit *hit)
{
    uint64_t label = 14695981039346656037u;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    label = mix_in(label, &hit->name, sizeof hit->name);
#include "krs/surface.def"
    return mix_in(label, &hit->material, sizeof hit->material);
}

static void find_labels(Sampling *sampling, const double (*weights)[3], size_t count,
                        uint64_t *labels)
{
    double points[PROBES][3];
    KrsHit hits[PROBES];
    for (size_t i = 0; i < count; i++) {
        memset(points[i], 0, sizeof points[i]);
        for (int k = 0; k < 3; k++)
            add_scaled3(points[i], points[i], weights[i][k], sampling->corners[k]);
    }
    if (state_probe(sampling->state, (const double(*)[3])points, count, sampling->b->normals,
                    hits) != KRS_OK)
        atomic_store(&sampling->b->failed, true);
    else
        for (size_t i = 0; i < count; i++)
            labels[i] = label_of(&hits[i]);
}

/* Points on a line between two. */
typedef struct Row {
    double from[3], to[3];
    size_t steps;
} Row;

static void point_of_row(const Row *row, double share, double weights[3])
{
    for (int k = 0; k < 3; k++)
        weights[k] = row->from[k] + share * (row->to[k] - row->from[k]);
}

/* Returns the first step whose label is not `label`; the number of steps + 1 if all have it. */
static size_t find_change(Sampling *sampling, const Row *row, uint64_t label)
{
    double   weights[PROBES][3];
    uint64_t labels[PROBES];
    for (size_t first = 0, now; first <= row->steps; first += now) {
        now = row->steps + 1 - first < PROBES ? row->steps + 1 - first : PROBES;
        for (size_t i = 0; i < now; i++)
            point_of_row(row, row->steps ? (double)(first + i) / (double)row->steps : 0.5,
                         weights[i]);
        find_labels(sampling, (const double(*)[3])weights, now, labels);
        for (size_t i = 0; i < now; i++)
            if (labels[i] != label || atomic_load(&sampling->b->failed))
                return first + i;
    }
    return row->steps + 1;
}

static uint64_t label_in(Sampling *sampling, const Row *row, double share)
{
    double   weights[1][3];
    uint64_t label = 0;
    point_of_row(row, share, weights[0]);
    find_labels(sampling, (const double(*)[3])weights, 1, &label);
    return label;
}

/* ---- a triangle ---- */

static size_t steps_along(const Sampling *sampling, double length)
{
    return (size_t)ceil(length / sampling->b->spacing);
}

/* Returns a row along the edge from a corner, with this weight of the opposite corner, up to parts
   of the margins. */
static Row row_along(const Sampling *sampling, int corner, double weight, double part)
{
    int    next = (corner + 1) % 3, across = (corner + 2) % 3;
    double least = part * sampling->margin[corner], min_next = part * sampling->margin[next];
    Row    row       = {{0, 0, 0}, {0, 0, 0}, 0};
    row.from[across] = row.to[across] = weight;
    row.from[next]                    = min_next;
    row.to[corner]                    = least;
    row.from[corner]                  = 1 - weight - min_next;
    row.to[next]                      = 1 - weight - least;
    double share                      = row.from[corner] - row.to[corner];
    row.steps = share > 0 ? steps_along(sampling, share * sampling->lengths[corner]) : 0;
    return row;
}

static void open_sampling(Sampling *sampling, const uint32_t triangle[3])
{
    const Borders *b = sampling->b;
    double         along[3], across[3], product[3];
    for (int k = 0; k < 3; k++) {
        const double *at = b->vertices.items[triangle[k]];
        for (int i = 0; i < 3; i++)
            sampling->corners[k][i] = b->copy ? dot3(b->copy[i], at) + b->copy[i][3] : at[i];
    }
    add_scaled3(along, sampling->corners[1], -1, sampling->corners[0]);
    add_scaled3(across, sampling->corners[2], -1, sampling->corners[0]);
    cross3(along, across, product);
    sampling->longest = 0;
    for (int k = 0; k < 3; k++) {
        sampling->lengths[k] = distance3(sampling->corners[k], sampling->corners[(k + 1) % 3]);
        if (sampling->lengths[k] > sampling->lengths[sampling->longest])
            sampling->longest = k;
    }
    for (int k = 0; k < 3; k++) {
        double length        = sampling->lengths[(k + 1) % 3];
        double height        = length > 0 ? length3(product) / length : 0;
        sampling->heights[k] = height;
        sampling->margin[k]  = height * MAX_MARGIN > MARGIN * b->error ? MARGIN * b->error / height
                                                                       : MAX_MARGIN;
    }
}

/* Reports progress, where each round counts as half of the work that is left. */
static void ask(const Sampling *sampling)
{
    Borders              *b       = sampling->b;
    const KrsMeshOptions *options = b->options;
    double                sampled = fmin(1, (double)atomic_load(&b->next) / (double)b->fresh.count);
    if (sampling->asks && options->progress &&
        !options->progress(options->user, 1 - ldexp(1 - 0.5 * sampled, -b->round)))
        atomic_store(&b->stopped, true);
}

/* Tells whether some sample has another material than the middle. */
static bool has_two(Sampling *sampling)
{
    static const Row MIDDLE = {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {1.0 / 3, 1.0 / 3, 1.0 / 3}, 0};
    int              base = sampling->longest, across = (base + 2) % 3;
    double           least = sampling->margin[across];
    double           most  = 1 - sampling->margin[base] - sampling->margin[(base + 1) % 3];
    size_t           rows  = steps_along(sampling, (most - least) * sampling->heights[across]);
    uint64_t         label = label_in(sampling, &MIDDLE, 0);
    for (size_t i = 0; i <= rows && !atomic_load(&sampling->b->stopped); i++) {
        double share = rows ? (double)i / (double)rows : 0;
        Row    row   = row_along(sampling, base, least + share * (most - least), 1);
        ask(sampling);
        if (find_change(sampling, &row, label) <= row.steps)
            return true;
    }
    return false;
}

/* Returns where the material changes between two points of a row, of which the first has this
   label. */
static double halve(Sampling *sampling, const Row *row, double low, double high, uint64_t label)
{
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (low + high);
        if (label_in(sampling, row, middle) == label)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

/* Returns where the material changes before a step of a row. */
static double halve_step(Sampling *sampling, const Row *row, size_t step, uint64_t label)
{
    double part = 1 / (double)row->steps;
    return halve(sampling, row, (double)(step - 1) * part, (double)step * part, label);
}

/* Returns where to split an edge: where the material first changes along it, or a margin away from
   it; 0: nowhere. */
static double find_split(Sampling *sampling, int corner)
{
    int    next   = (corner + 1) % 3;
    double least  = NEAR_VERTEX * sampling->b->error / sampling->lengths[corner];
    double inner  = sampling->margin[(corner + 2) % 3];
    Row    rows[] = {row_along(sampling, corner, AT_EDGE * inner, AT_EDGE),
                     row_along(sampling, corner, inner, 1)};
    for (int i = 0; i < 2; i++) {
        uint64_t label = label_in(sampling, &rows[i], 0);
        size_t   step  = rows[i].steps ? find_change(sampling, &rows[i], label) : 1;
        double   weights[3];
        if (step == 0 || step > rows[i].steps)
            continue;
        point_of_row(&rows[i], halve_step(sampling, &rows[i], step, label), weights);
        double at = weights[next] / (weights[corner] + weights[next]);
        if (at > least && at < 1 - least)
            return at;
    }
    return 0;
}

/* Splits edges where the material changes along them; if there are none, the longest in its
   middle. */
static void find_split_points(Sampling *sampling, SplitPoints *points)
{
    bool any = false;
    for (int k = 0; k < 3; k++) {
        points->at[k] = find_split(sampling, k);
        any           = any || points->at[k] > 0;
    }
    if (!any)
        points->at[sampling->longest] = 0.5;
}

static void examine(Sampling *sampling, uint32_t triangle)
{
    Borders *b = sampling->b;
    open_sampling(sampling, b->triangles.items[triangle]);
    memset(&b->split_points[triangle], 0, sizeof(SplitPoints));
    b->mixed[triangle] = sampling->lengths[sampling->longest] > b->spacing && has_two(sampling);
    if (b->mixed[triangle])
        find_split_points(sampling, &b->split_points[triangle]);
}

static void examine_some(void *task, size_t part, size_t parts)
{
    enum { SOME = 16 };
    Borders *b        = task;
    Sampling sampling = {.b = b, .state = b->states[part], .asks = part == 0};
    (void)parts;
    while (!atomic_load(&b->stopped) && !atomic_load(&b->failed)) {
        size_t begin = atomic_fetch_add(&b->next, SOME);
        if (begin >= b->fresh.count)
            return;
        for (size_t i = begin; i < begin + SOME && i < b->fresh.count; i++)
            examine(&sampling, b->fresh.items[i]);
    }
}

/* ---- all triangles ---- */

/* Adds the new vertices, and numbers them by their edges. */
static void split_edges(Borders *b, Numbering *splits)
{
    for (size_t i = 0; i < b->fresh.count; i++) {
        uint32_t triangle = b->fresh.items[i];
        for (int k = 0; k < 3 && b->mixed[triangle]; k++) {
            uint32_t from  = b->triangles.items[triangle][k];
            uint32_t to    = b->triangles.items[triangle][(k + 1) % 3];
            uint32_t fresh = (uint32_t)b->vertices.count;
            double   at    = b->split_points[triangle].at[k], point[3], along[3];
            if (at == 0 || numbering_take(splits, edge_key(from, to), fresh) != fresh)
                continue;
            add_scaled3(along, b->vertices.items[to], -1, b->vertices.items[from]);
            add_scaled3(point, b->vertices.items[from], at, along);
            array_reserve_large(&b->arena, &b->vertices);
            memcpy(b->vertices.items[b->vertices.count++], point, sizeof point);
        }
    }
}

/* A triangle that is split. */
typedef struct Parent {
    uint32_t slot; /* triangle that the next part replaces; NO_NUMBER: it is added */
    bool     mixed;
} Parent;

static void add_triangle(Borders *b, Parent *parent, uint32_t x, uint32_t y, uint32_t z)
{
    const uint32_t corners[3] = {x, y, z};
    uint32_t       number     = parent->slot;
    if (number == NO_NUMBER) {
        array_reserve_large(&b->arena, &b->triangles);
        number = (uint32_t)b->triangles.count++;
    }
    memcpy(b->triangles.items[number], corners, sizeof corners);
    if (parent->mixed)
        array_push_large(&b->arena, &b->fresh, number);
    parent->slot = NO_NUMBER;
}

static double length_between(const Borders *b, uint32_t from, uint32_t to)
{
    return distance3(b->vertices.items[from], b->vertices.items[to]);
}

/* Splits a triangle at two edges: cuts off the first corner, and the rest along its shorter
   diagonal. */
static void split_two(Borders *b, Parent *parent, const uint32_t c[3], uint32_t first,
                      uint32_t last)
{
    add_triangle(b, parent, c[0], first, last);
    if (length_between(b, first, c[2]) < length_between(b, last, c[1])) {
        add_triangle(b, parent, first, c[1], c[2]);
        add_triangle(b, parent, first, c[2], last);
    } else {
        add_triangle(b, parent, first, c[1], last);
        add_triangle(b, parent, last, c[1], c[2]);
    }
}

static void split_triangle(Borders *b, const Numbering *splits, uint32_t number)
{
    uint32_t c[3], middles[3], count = 0;
    Parent   parent = {number, b->mixed[number]};
    memcpy(c, b->triangles.items[number], sizeof c);
    for (int k = 0; k < 3; k++) {
        middles[k] = numbering_find(splits, edge_key(c[k], c[(k + 1) % 3]));
        count += middles[k] != NO_NUMBER;
    }
    for (int k = 0; k < 3; k++) {
        const uint32_t rotated[3] = {c[k], c[(k + 1) % 3], c[(k + 2) % 3]};
        uint32_t       own = middles[k], before = middles[(k + 2) % 3];
        if (count == 1 && own != NO_NUMBER) {
            add_triangle(b, &parent, rotated[0], own, rotated[2]);
            add_triangle(b, &parent, own, rotated[1], rotated[2]);
        } else if (count == 2 && own != NO_NUMBER && before != NO_NUMBER)
            split_two(b, &parent, rotated, own, before);
        else if (count == 3)
            add_triangle(b, &parent, rotated[0], own, before);
    }
    if (count == 3)
        add_triangle(b, &parent, middles[0], middles[1], middles[2]);
}

static void split_all(Borders *b)
{
    Numbering splits = {.arena = &b->arena};
    size_t    count  = b->triangles.count;
    split_edges(b, &splits);
    b->fresh.count = 0;
    for (uint32_t i = 0; i < count && splits.count > 0; i++)
        split_triangle(b, &splits, i);
}

static KrsStatus open_borders(Borders *b, KrsState *state, const KrsMesh *mesh)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < parallel_parts() && status == KRS_OK; i++) {
        status = state_copy_of(state, &b->states[i]);
        if (status == KRS_OK)
            state_refresh_points(b->states[i]);
    }
    for (size_t i = 0; i < mesh->vertex_count && status == KRS_OK; i++) {
        array_reserve_large(&b->arena, &b->vertices);
        memcpy(b->vertices.items[b->vertices.count++], mesh->vertices[i], sizeof *mesh->vertices);
    }
    for (uint32_t i = 0; i < mesh->triangle_count && status == KRS_OK; i++) {
        array_reserve_large(&b->arena, &b->triangles);
        memcpy(b->triangles.items[b->triangles.count++], mesh->triangles[i],
               sizeof *mesh->triangles);
        array_push_large(&b->arena, &b->fresh, i);
    }
    return status;
}

static KrsStatus replace_mesh(const Borders *b, KrsMesh *mesh)
{
    const KrsAllocator *allocator = &mesh->allocator;
    double(*at)[3]                = allocator_new(allocator, b->vertices.count, sizeof *at);
    uint32_t(*corners)[3]         = allocator_new(allocator, b->triangles.count, sizeof *corners);
    if (!at || !corners) {
        allocator_release(allocator, at);
        allocator_release(allocator, corners);
        return KRS_OUT_OF_MEMORY;
    }
    memcpy(at, b->vertices.items, b->vertices.count * sizeof *at);
    memcpy(corners, b->triangles.items, b->triangles.count * sizeof *corners);
    allocator_release(allocator, mesh->vertices);
    allocator_release(allocator, mesh->triangles);
    mesh->vertices       = at;
    mesh->triangles      = corners;
    mesh->vertex_count   = b->vertices.count;
    mesh->triangle_count = b->triangles.count;
    return KRS_OK;
}

static KrsStatus split(Borders *b, KrsState *state, KrsMesh *mesh)
{
    jmp_buf exhausted;
    b->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    KrsStatus status = open_borders(b, state, mesh);
    for (; status == KRS_OK && b->round < MAX_ROUNDS && b->fresh.count > 0; b->round++) {
        b->mixed        = arena_new_array(&b->arena, bool, b->triangles.count);
        b->split_points = arena_new_array(&b->arena, SplitPoints, b->triangles.count);
        atomic_store(&b->next, 0);
        run_in_parallel(examine_some, b);
        if (atomic_load(&b->stopped) || atomic_load(&b->failed))
            return atomic_load(&b->stopped) ? KRS_INTERRUPTED : KRS_OUT_OF_MEMORY;
        split_all(b);
    }
    return status == KRS_OK ? replace_mesh(b, mesh) : status;
}

static double size_of(const KrsMesh *mesh)
{
    double size = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            low  = fmin(low, mesh->vertices[i][k]);
            high = fmax(high, mesh->vertices[i][k]);
        }
        size = fmax(size, high - low);
    }
    return size;
}

KrsStatus mesh_split_at_borders(KrsState *state, const KrsMeshOptions *options,
                                const double (*copy)[4], KrsMesh      *mesh)
{
    Borders b        = {.options = options, .copy = copy};
    double  scale    = copy ? length3(copy[0]) : 1;
    b.error          = scale * mesh->error;
    b.spacing        = fmax(SPACING * b.error, MIN_SPACING * scale * size_of(mesh));
    b.memory.limit   = options->memory_limit ? options->memory_limit : KRS_USUAL_MEMORY;
    b.arena.memory   = &b.memory;
    KrsStatus status = mesh->triangle_count > 0 ? split(&b, state, mesh) : KRS_OK;
    for (int i = 0; i < MAX_PARTS; i++)
        state_free(b.states[i]);
    arena_free(&b.arena);
    return status;
}
