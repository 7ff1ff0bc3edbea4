/*
 * faults.c: judges a trial: its faults are open edges, and triangles that are far from the other mesh or cross others.
 */
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "mesh/simplify/simplifier.h"

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

bool is_near_original(const Simplifier *s, const uint32_t triangle[3], NearQuery *query)
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

void simplifier_progress(Simplifier *s, double part)
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
            simplifier_progress(check->s, (double)begin / (double)count);
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

size_t count_faults(Simplifier *s, double radius, size_t most, double goal)
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
