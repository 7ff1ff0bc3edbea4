/*
 * simplify.c: krs_mesh_simplify lets meshoptimizer propose triangles, and proofs judge them.
 *
 * meshoptimizer's error is a mean of squares, so it may be exceeded.  So each trial is judged: its
 * faults are open edges, and triangles that are far from the other mesh or cross others.
 */
#include <meshoptimizer.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/allocator.h"
#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "krs/krs.h"
#include "mesh/common/numbering.h"
#include "mesh/simplify/blocks.h"
#include "mesh/simplify/near.h"
#include "mesh/simplify/slivers.h"

enum { MAX_TRIALS = 14 };
/* Proposals of meshoptimizer with more faults are given up: with this number, plus this part of
   their triangles. */
static const double MANY_FAULTS = 16, PART_OF_FAULTS = 0.005;
/* The factor by which the radius of kept triangles around faults grows from trial to trial. */
static const double GROWTH = 1.25;
/* The first radius, in errors: around a collapse few triangles matter. */
static const double FIRST_RADIUS = 1, FIRST_RADIUS_OF_COLLAPSE = 0.25;
/* The errors of meshoptimizer's mean, in errors.  With less it simplifies less, and with more it
   goes too far in many places. */
static const double FIRST_ERROR = 0.25, LAST_ERROR = 0.5;

/* The properties of triangles, for the rules of collapses. */
typedef struct Known {
    double   *off, *missed;
    uint32_t *below;
} Known;

typedef struct Simplifier {
    Memory                memory;
    Arena                 arena, lasting; /* of a trial, and of all */
    const KrsMesh        *mesh;
    const KrsMeshOptions *options;
    double                error;
    float (*positions)[3];
    uint32_t (*triangles)[3]; /* of the mesh's vertices */
    bool  *kept;              /* of the best triangles: they stay as they are */
    size_t triangle_count;
    uint32_t (*best)[3]; /* the best triangles without faults, or what blocks left */
    size_t    best_count;
    Known     known, best_known; /* of the last trial, if it collapsed edges, and of the best */
    bool      collapsed;
    Numbering judged; /* of new triangles, bounds of how far they are from the mesh, in steps */
    Numbering noted;  /* new triangles that are near, and in `facing` */
    NearMesh  original;
    /* The vertices of a triangle above or below each one of the mesh, in the last trial and in the
       best; all 0: none. */
    uint32_t (*facing)[3], (*best_facing)[3];
    NearQuery *queries;               /* of each part */
    double     fraction, begun, goal; /* of the work: done, and before and after the present step */
    atomic_bool stopped;
} Simplifier;

/* Distances are kept in so many steps of the error; one more step: it is more than the error. */
enum { STEPS = 1 << 16, FAR_STEP = STEPS + 1 };

/* ---- proposals ---- */

/* Proposes triangles by meshoptimizer: kept ones stay, the others are simplified up to their
   border. */
static void propose(Simplifier *s, double error, double goal)
{
    (void)goal;
    const KrsMesh *mesh = s->mesh;
    ArenaMark      mark = arena_mark(&s->arena);
    uint32_t(*rest)[3]  = arena_alloc(&s->arena, s->best_count + 1, sizeof *rest);
    float  scale        = meshopt_simplifyScale(&s->positions[0][0], mesh->vertex_count,
                                                sizeof *s->positions);
    size_t count        = 0;
    for (size_t i = 0; i < s->best_count; i++)
        if (!s->kept[i])
            memcpy(rest[count++], s->best[i], sizeof *rest);
    s->collapsed      = false;
    s->triangle_count = meshopt_simplify(&s->triangles[0][0], &rest[0][0], 3 * count,
                                         &s->positions[0][0], mesh->vertex_count,
                                         sizeof *s->positions, 0, (float)error / scale,
                                         meshopt_SimplifyLockBorder, NULL) /
                        3;
    for (size_t i = 0; i < s->best_count; i++)
        if (s->kept[i])
            memcpy(s->triangles[s->triangle_count++], s->best[i], sizeof *rest);
    arena_rewind(&s->arena, mark);
    flip_slivers((const double(*)[3])mesh->vertices, s->triangles, s->triangle_count, &s->arena);
}

/* ---- faults ---- */

typedef struct Judgement {
    Simplifier *s;
    const Bvh  *now;  /* whose triangles are reported */
    Bvh         best; /* of what was simplified; made at the first fault */
    double      radius;
    size_t      faults;
} Judgement;

static void corners_of(const Bvh *bvh, uint32_t triangle, double corners[3][3])
{
    for (int c = 0; c < 3; c++)
        memcpy(corners[c], bvh->vertices[bvh->triangles[triangle][c]], sizeof *corners);
}

static bool keep_triangle(void *user, uint32_t triangle, const double corners[3][3])
{
    Simplifier *s = user;
    (void)corners;
    s->kept[triangle] = true;
    return true;
}

/* Counts a fault, and keeps triangles near to its corners. */
static void note_fault(void *user, uint32_t triangle)
{
    Judgement  *judgement = user;
    Simplifier *s         = judgement->s;
    double      corners[3][3];
    if (judgement->faults == 0)
        bvh_new(&judgement->best, (const double(*)[3])s->mesh->vertices,
                (const uint32_t(*)[3])s->best, s->best_count, &s->arena);
    corners_of(judgement->now, triangle, corners);
    for (int c = 0; c < 3; c++)
        bvh_visit(&judgement->best, corners[c], judgement->radius, keep_triangle, s);
    judgement->faults++;
}

/* A test of all triangles of one mesh. */
typedef struct Check Check;
typedef bool         IsWrong(const Check *check, uint32_t triangle, NearQuery *query);
struct Check {
    Simplifier *s;
    const Bvh  *triangles;
    IsWrong    *is_wrong;
    const NearMesh *new;
    const uint32_t *facing;       /* of triangles of the mesh, new ones; NO_TRIANGLE: none */
    atomic_uint    *found_facing; /* of triangles of the mesh, the first of the new ones */
    bool           *wrong;
    atomic_size_t   next;
};

static NumberKey key_of(const uint32_t triangle[3])
{
    return face_key(triangle[0], triangle[1], triangle[2]);
}

static bool crosses(const Check *check, uint32_t triangle, NearQuery *query)
{
    (void)query;
    return triangle_crosses(check->triangles, triangle, 0);
}

/* Lowers a number atomically, so that the least remains, whatever the order of threads. */
static void take_least(atomic_uint *least, uint32_t number)
{
    unsigned now = atomic_load_explicit(least, memory_order_relaxed);
    while (number < now && !atomic_compare_exchange_weak_explicit(
                               least, &now, number, memory_order_relaxed, memory_order_relaxed))
        ;
}

/* Tells whether a new triangle is near the mesh, whose triangles at its corners are starts. */
static bool is_near_original(const Simplifier *s, const uint32_t triangle[3], NearQuery *query)
{
    enum { MAX_AROUND = 32 };
    const TriangleEdges *edges = &s->original.edges;
    uint32_t             starts[MAX_AROUND];
    size_t               count = 0;
    double               corners[3][3];
    for (int c = 0; c < 3; c++) {
        memcpy(corners[c], s->mesh->vertices[triangle[c]], sizeof corners[c]);
        for (uint32_t i = edges->begins[triangle[c]]; i < edges->begins[triangle[c] + 1]; i++)
            if (count < MAX_AROUND)
                starts[count++] = edges->items[i].triangle;
    }
    return is_near_mesh(&s->original, (const double(*)[3])corners, s->error, starts, count, query);
}

static bool is_far_from_original(const Check *check, uint32_t triangle, NearQuery *query)
{
    const Simplifier *s   = check->s;
    const uint32_t   *own = check->triangles->triangles[triangle];
    if (numbering_find(&s->noted, key_of(own)) != NO_NUMBER)
        return false;
    bool near = is_near_original(s, own, query);
    for (size_t i = 0; i < query->faced_count; i++)
        take_least(&check->found_facing[query->faced[i]], triangle);
    return !near;
}

static bool is_far_from_new(const Check *check, uint32_t triangle, NearQuery *query)
{
    const Simplifier *s      = check->s;
    uint32_t          facing = check->facing[triangle], starts[4];
    size_t            count  = 0;
    double            corners[3][3];
    corners_of(check->triangles, triangle, corners);
    if (facing != NO_TRIANGLE) {
        if (is_near_triangle(check->new, facing, (const double(*)[3])corners, s->error))
            return false;
        starts[count++] = facing;
        for (int c = 0; c < 3; c++)
            if (check->new->beyond[facing][c] != NO_TRIANGLE)
                starts[count++] = check->new->beyond[facing][c];
    }
    return !is_near_mesh(check->new, (const double(*)[3])corners, s->error, starts, count, query);
}

static void ask(Simplifier *s, double part)
{
    const KrsMeshOptions *options = s->options;
    s->fraction                   = fmax(s->fraction, s->begun + part * (s->goal - s->begun));
    if (options->progress && !options->progress(options->user, s->fraction))
        atomic_store(&s->stopped, true);
}

/* Tests triangles until none is left; the first part reports progress, since it runs in the
   caller's thread. */
static void check_some(void *task, size_t part, size_t parts)
{
    enum { SOME = 64 };
    Check *check = task;
    size_t count = check->triangles->triangle_count;
    (void)parts;
    while (!atomic_load(&check->s->stopped)) {
        size_t begin = atomic_fetch_add(&check->next, SOME);
        if (begin >= count)
            return;
        if (part == 0)
            ask(check->s, (double)begin / (double)count);
        for (size_t i = begin; i < begin + SOME && i < count; i++)
            check->wrong[i] = check->is_wrong(check, (uint32_t)i, &check->s->queries[part]);
    }
}

/* Tests all triangles and notes faults; `goal` is the part of the work that is done then. */
static void check_all(Judgement *judgement, Check *check, double goal)
{
    Simplifier *s     = judgement->s;
    size_t      count = check->triangles->triangle_count;
    check->wrong      = arena_new_array(&s->arena, bool, count + 1);
    atomic_store(&check->next, 0);
    s->begun       = s->fraction;
    s->goal        = goal;
    judgement->now = check->triangles;
    run_in_parallel(check_some, check);
    for (uint32_t i = 0; i < count && !atomic_load(&s->stopped); i++)
        if (check->wrong[i])
            note_fault(judgement, i);
}

/* Tests whether new triangles are within the error of the mesh. */
static void check_new(Judgement *judgement, const NearMesh *new, double goal)
{
    Simplifier *s     = judgement->s;
    size_t      count = s->mesh->triangle_count;
    Check check = {.s = s, .triangles = &new->bvh, .is_wrong = is_far_from_original, .new = new};
    check.found_facing = arena_new_array(&s->arena, atomic_uint, count + 1);
    for (size_t i = 0; i < count; i++)
        atomic_init(&check.found_facing[i], NO_TRIANGLE);
    check_all(judgement, &check, goal);
    for (size_t i = 0; i < count; i++)
        if (check.found_facing[i] != NO_TRIANGLE)
            memcpy(s->facing[i], s->triangles[check.found_facing[i]], sizeof s->facing[i]);
    for (uint32_t i = 0; i < s->triangle_count && !atomic_load(&s->stopped); i++) {
        NumberKey key = key_of(s->triangles[i]);
        numbering_take(&s->judged, key, check.wrong[i] ? FAR_STEP : STEPS);
        if (!check.wrong[i])
            numbering_take(&s->noted, key, 0);
    }
}

static void check_crossings(Judgement *judgement, const NearMesh *new, double goal)
{
    Check check = {.s = judgement->s, .triangles = &new->bvh, .is_wrong = crosses, .new = new};
    check_all(judgement, &check, goal);
}

/* Tests whether triangles of the mesh are within the error of the new ones. */
static void check_original(Judgement *judgement, const NearMesh *new, double goal)
{
    Simplifier *s       = judgement->s;
    size_t      count   = s->mesh->triangle_count;
    Numbering   numbers = {.arena = &s->arena};
    uint32_t   *facing  = arena_new_array(&s->arena, uint32_t, count + 1);
    Check check  = {.s = s, .triangles = &s->original.bvh, .is_wrong = is_far_from_new, .new = new};
    check.facing = facing;
    for (uint32_t i = 0; i < s->triangle_count; i++)
        numbering_take(&numbers, key_of(s->triangles[i]), i);
    for (size_t i = 0; i < count; i++) {
        facing[i] = numbering_find(&numbers, key_of(s->facing[i]));
        if (facing[i] == NO_NUMBER)
            facing[i] = numbering_find(&numbers, key_of(s->best_facing[i]));
    }
    check_all(judgement, &check, goal);
}

/* Notes vertices at which several rings of triangles meet, but not in the mesh. */
static void check_rings(Judgement *judgement, const NearMesh *new)
{
    const TriangleEdges *edges = &new->edges, *original = &judgement->s->original.edges;
    for (uint32_t i = 0; i < edges->vertex_count; i++)
        if (!is_one_ring(edges, new->bvh.triangles, i) &&
            is_one_ring(original, (const uint32_t(*)[3])judgement->s->mesh->triangles, i))
            note_fault(judgement, edges->items[edges->begins[i]].triangle);
}

/* Counts the faults of a trial, not all of them if there are more than `most`. */
static size_t count_faults(Simplifier *s, double radius, size_t most, double goal)
{
    const double(*at)[3] = (const double(*)[3])s->mesh->vertices;
    ArenaMark mark       = arena_mark(&s->arena);
    double    begun      = s->fraction;
    NearMesh new;
    near_mesh_new(&new, at, (const uint32_t(*)[3])s->triangles, s->triangle_count, &s->arena);
    Judgement judgement = {.s = s, .now = &new.bvh, .radius = radius};
    report_open(&new.edges, note_fault, &judgement);
    check_rings(&judgement, &new);
    if (judgement.faults <= most)
        check_crossings(&judgement, &new, begun + (goal - begun) / 3);
    if (judgement.faults <= most) {
        check_new(&judgement, &new, begun + 2 * (goal - begun) / 3);
        check_original(&judgement, &new, goal);
    }
    arena_rewind(&s->arena, mark);
    return judgement.faults;
}

/* ---- collapses ---- */

/* Tells whether some points of a triangle are near, which rejects most bad ones in little time. */
static bool are_middles_near(const Simplifier *s, const uint32_t triangle[3], NearQuery *query)
{
    for (int c = 0; c < 4; c++) {
        double middle[3] = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            add_scaled3(middle, middle,
                        c == 3   ? 1.0 / 3
                        : k == c ? 0
                                 : 0.5,
                        s->mesh->vertices[triangle[k]]);
        if (!bvh_is_near(&s->original.bvh, middle, s->error, &query->last))
            return false;
    }
    return true;
}

/* Judges a triangle, or finds what was judged before; `*distance` bounds how far it is. */
static bool is_good(void *user, const uint32_t triangle[3], double *distance)
{
    Simplifier *s     = user;
    NearQuery  *query = &s->queries[0];
    uint32_t    step  = numbering_find(&s->judged, key_of(triangle));
    if (step == NO_NUMBER) {
        step = FAR_STEP;
        if (are_middles_near(s, triangle, query) && is_near_original(s, triangle, query))
            step = (uint32_t)ceil(STEPS * query->distance / s->error);
        numbering_take(&s->judged, key_of(triangle), step);
    }
    *distance = s->error * step / STEPS;
    return step <= STEPS;
}

static bool is_wanted(void *user, double part)
{
    Simplifier *s = user;
    if (!atomic_load(&s->stopped))
        ask(s, fmin(fmax(part, 0), 1));
    return !atomic_load(&s->stopped);
}

/* Finds the nearest triangle for each vertex of the mesh that the best triangles do not use. */
static void find_below(Simplifier *s, uint32_t *below)
{
    const double(*at)[3] = (const double(*)[3])s->mesh->vertices;
    ArenaMark mark       = arena_mark(&s->arena);
    bool     *used       = arena_new_array(&s->arena, bool, s->mesh->vertex_count + 1);
    Bvh       best;
    bvh_new(&best, at, (const uint32_t(*)[3])s->best, s->best_count, &s->arena);
    for (size_t i = 0; i < 3 * s->best_count; i++)
        used[s->best[i / 3][i % 3]] = true;
    for (size_t i = 0; i < s->mesh->vertex_count; i++) {
        below[i] = NO_TRIANGLE;
        if (!used[i])
            bvh_find_nearest(&best, at[i], s->error, &below[i]);
    }
    arena_rewind(&s->arena, mark);
}

static CollapseRules rules_of(Simplifier *s, const Known *known, double error)
{
    return (CollapseRules){.kept      = s->kept,
                           .below     = known->below,
                           .error     = error,
                           .off       = known->off,
                           .missed    = known->missed,
                           .is_good   = is_good,
                           .is_wanted = is_wanted,
                           .user      = s};
}

static void propose_collapses(Simplifier *s, double error, double goal)
{
    const KrsMesh *mesh = s->mesh;
    const Known   *best = &s->best_known, *now = &s->known;
    CollapseRules  rules = rules_of(s, now, error);
    s->begun             = s->fraction;
    s->goal              = goal;
    memcpy(s->triangles, s->best, s->best_count * sizeof *s->best);
    memcpy(now->off, best->off, s->best_count * sizeof *now->off);
    memcpy(now->missed, best->missed, s->best_count * sizeof *now->missed);
    memcpy(now->below, best->below, mesh->vertex_count * sizeof *now->below);
    s->triangle_count = collapse_edges((const double(*)[3])mesh->vertices, mesh->vertex_count,
                                       s->triangles, s->best_count, &rules, &s->arena);
    s->collapsed      = true;
}

static void begin_with_mesh(Simplifier *s)
{
    const KrsMesh *mesh = s->mesh;
    s->best_count       = mesh->triangle_count;
    memcpy(s->best, mesh->triangles, s->best_count * sizeof *s->best);
    memset(s->best_known.off, 0, s->best_count * sizeof *s->best_known.off);
    memset(s->best_known.missed, 0, s->best_count * sizeof *s->best_known.missed);
    memset(s->best_known.below, 0xff, mesh->vertex_count * sizeof *s->best_known.below);
}

/* Collapses edges of the mesh in blocks; what is left is the best then, though nothing was judged. */
static void collapse_in_blocks(Simplifier *s, double goal)
{
    const KrsMesh *mesh  = s->mesh;
    CollapseRules  rules = rules_of(s, &s->best_known, s->error);
    s->begun             = s->fraction;
    s->goal              = goal;
    size_t left          = collapse_blocks((const double(*)[3])mesh->vertices, mesh->vertex_count,
                                           (const uint32_t(*)[3])mesh->triangles, mesh->triangle_count,
                                           s->original.bvh.order, &rules, s->best, &s->arena);
    if (left > 0)
        s->best_count = left;
    else
        begin_with_mesh(s);
}

/* ---- trials ---- */

/* Makes what the last trial proposed the best. */
static void take_proposal(Simplifier *s)
{
    Known known = s->best_known;
    memcpy(s->best, s->triangles, s->triangle_count * sizeof *s->best);
    memcpy(s->best_facing, s->facing, s->mesh->triangle_count * sizeof *s->facing);
    s->best_count = s->triangle_count;
    if (s->collapsed) {
        s->best_known = s->known;
        s->known      = known;
        return;
    }
    for (size_t i = 0; i < s->best_count; i++)
        known.off[i] = known.missed[i] = s->error;
    find_below(s, known.below);
}

typedef struct Trial {
    void (*propose)(Simplifier *s, double error, double goal);
    double error, radius; /* in errors */
    bool   may_give_up, had_faults, gave_up, taken;
} Trial;

/* Simplifies the best triangles further, unless all trials have faults or it is stopped. */
static void try_until_right(Simplifier *s, Trial *trial, double goal)
{
    double radius = trial->radius * s->error;
    memset(s->kept, 0, s->best_count * sizeof *s->kept);
    for (int i = 0; i < MAX_TRIALS; i++, radius *= GROWTH) {
        trial->propose(s, trial->error * s->error, s->fraction + 0.4 * (goal - s->fraction));
        if (atomic_load(&s->stopped) || s->triangle_count == 0 ||
            s->triangle_count >= s->best_count)
            return;
        double most   = MANY_FAULTS + PART_OF_FAULTS * (double)s->triangle_count;
        size_t faults = count_faults(s, radius, trial->may_give_up ? (size_t)most : SIZE_MAX,
                                     s->fraction + 0.6 * (goal - s->fraction));
        trial->had_faults |= faults > 0;
        trial->gave_up = trial->may_give_up && (double)faults > most;
        if (atomic_load(&s->stopped) || trial->gave_up)
            return;
        if (faults == 0) {
            take_proposal(s);
            trial->taken = true;
            return;
        }
    }
}

/* Does that, and what is done of the work is `goal` then. */
static void try_all(Simplifier *s, Trial *trial, double goal)
{
    try_until_right(s, trial, goal);
    s->fraction = fmax(s->fraction, goal);
}

/* Makes room for what is known of as many triangles as the mesh has. */
static Known make_known(Simplifier *s)
{
    const KrsMesh *mesh = s->mesh;
    return (Known){arena_new_array(&s->arena, double, mesh->triangle_count + 1),
                   arena_new_array(&s->arena, double, mesh->triangle_count + 1),
                   arena_new_array(&s->arena, uint32_t, mesh->vertex_count + 1)};
}

/* Makes all trials. meshoptimizer removes most triangles in little time where the surface is
   smooth.  Single collapses remove half of what it leaves, and all where its proposals cross
   themselves, as flat faces do: most in blocks then, unless the rest of them has faults that stay.
   What was kept around faults is tried once more. */
static void find_all(Simplifier *s)
{
    Trial first = {.propose     = propose,
                   .error       = FIRST_ERROR,
                   .radius      = FIRST_RADIUS,
                   .may_give_up = true},
          next  = first,
          rest  = {.propose = propose_collapses, .error = 1, .radius = FIRST_RADIUS_OF_COLLAPSE},
          again = rest, once_more = rest;
    next.error = LAST_ERROR;
    begin_with_mesh(s);
    try_all(s, &first, 0.1);
    if (first.gave_up)
        collapse_in_blocks(s, 0.3);
    else
        try_all(s, &next, 0.3);
    try_all(s, &rest, 0.9);
    if (first.gave_up && !rest.taken && !atomic_load(&s->stopped)) {
        begin_with_mesh(s);
        try_all(s, &again, 0.97);
    }
    if (rest.had_faults)
        try_all(s, &once_more, 1);
}

static void find_triangles(Simplifier *s)
{
    const KrsMesh *mesh  = s->mesh;
    size_t         count = mesh->triangle_count;
    s->positions         = arena_alloc(&s->arena, mesh->vertex_count + 1, sizeof *s->positions);
    s->triangles         = arena_alloc(&s->arena, count + 1, sizeof *s->triangles);
    s->best              = arena_alloc(&s->arena, count + 1, sizeof *s->best);
    s->kept              = arena_new_array(&s->arena, bool, count + 1);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            s->positions[i][k] = (float)mesh->vertices[i][k];
    s->facing      = arena_alloc(&s->arena, count + 1, sizeof *s->facing);
    s->best_facing = arena_alloc(&s->arena, count + 1, sizeof *s->facing);
    s->queries     = arena_new_array(&s->arena, NearQuery, MAX_PARTS);
    near_mesh_new(&s->original, (const double(*)[3])mesh->vertices,
                  (const uint32_t(*)[3])mesh->triangles, count, &s->arena);
    s->known      = make_known(s);
    s->best_known = make_known(s);
    if (count > 0)
        find_all(s);
}

/* Copies the best triangles, with the vertices that they use. */
static KrsStatus copy_triangles(Simplifier *s, KrsMesh **result)
{
    const KrsMesh *mesh   = s->mesh;
    uint32_t      *number = arena_new_array(&s->arena, uint32_t, mesh->vertex_count + 1);
    KrsMesh       *copy   = allocator_new(&mesh->allocator, 1, sizeof *copy);
    if (!copy)
        return KRS_OUT_OF_MEMORY;
    *copy = *mesh;
    copy->error += s->error;
    copy->vertex_count   = 0;
    copy->triangle_count = s->best_count;
    copy->vertices  = allocator_new(&mesh->allocator, mesh->vertex_count, sizeof *copy->vertices);
    copy->triangles = allocator_new(&mesh->allocator, s->best_count, sizeof *copy->triangles);
    if (!copy->vertices || !copy->triangles) {
        krs_mesh_free(copy);
        return KRS_OUT_OF_MEMORY;
    }
    for (size_t i = 0; i < 3 * s->best_count; i++) {
        uint32_t from = s->best[i / 3][i % 3];
        if (number[from] == 0) {
            memcpy(copy->vertices[copy->vertex_count], mesh->vertices[from],
                   sizeof *copy->vertices);
            number[from] = (uint32_t)++copy->vertex_count;
        }
        copy->triangles[i / 3][i % 3] = number[from] - 1;
    }
    *result = copy;
    return KRS_OK;
}

static KrsStatus simplify(Simplifier *s, KrsMesh **simplified)
{
    jmp_buf exhausted;
    s->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    find_triangles(s);
    return atomic_load(&s->stopped) ? KRS_INTERRUPTED : copy_triangles(s, simplified);
}

KrsStatus krs_mesh_simplify(const KrsMesh *mesh, const KrsMeshOptions *options,
                            KrsMesh **simplified)
{
    Simplifier s = {.mesh = mesh, .options = options, .error = options->error};
    *simplified  = NULL;
    if (!(s.error > 0) || isinf(s.error))
        return KRS_BAD_ARGUMENT;
    s.arena.memory   = &s.memory;
    s.lasting.memory = &s.memory;
    s.judged.arena   = &s.lasting;
    s.noted.arena    = &s.lasting;
    KrsStatus status = simplify(&s, simplified);
    arena_free(&s.arena);
    arena_free(&s.lasting);
    return status;
}
