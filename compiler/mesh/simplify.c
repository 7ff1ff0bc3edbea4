/*
 * simplify.c: krs_mesh_simplify: meshoptimizer proposes, and a proof accepts.
 *
 * meshoptimizer's error is a mean of squares, so it may be exceeded.  A triangle is within an error of a
 * mesh if its corners are within it of the same triangle of that mesh, since that is convex; if they are not, it is
 * cut into four.
 */
#include <meshoptimizer.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "compiler/krs.h"
#include "compiler/mesh/numbering.h"
#include "compiler/mesh/slivers.h"

enum { MOST_CUTS = 12, MOST_TRIALS = 14 };
/* From trial to trial triangles are kept so many times as far around faults.  Most faults are single
   triangles that cross others, and what is proposed next may have some elsewhere.  So steps are small. */
static const double GROWTH = 1.25;
/* The first error, in errors: with less, more trials leave no fewer triangles. */
static const double FIRST_ERROR = 0.125;

typedef struct Simplifier {
    Memory                memory;
    Arena                 arena, lasting; /* of a trial, and of all */
    const KrsMesh        *mesh;
    const KrsMeshOptions *options;
    double                error;
    float (*positions)[3];
    uint32_t (*triangles)[3]; /* of the mesh's vertices */
    bool  *kept;              /* of the best triangles: to stay as they are */
    size_t triangle_count;
    uint32_t (*best)[3]; /* triangles that have been good */
    size_t    best_count;
    Numbering near; /* triangles that were proven to be within the error of the mesh */
    double fraction, begun, goal; /* of the work: done, and before and after what is being done */
    atomic_bool stopped;
} Simplifier;

/* ---- how far two meshes are from each other ---- */

static void corners_of(const Bvh *bvh, uint32_t triangle, double corners[3][3])
{
    for (int c = 0; c < 3; c++)
        memcpy(corners[c], bvh->vertices[bvh->triangles[triangle][c]], sizeof *corners);
}

static bool are_near(const Bvh *bvh, uint32_t triangle, const double corners[3][3], double error)
{
    double of[3][3];
    corners_of(bvh, triangle, of);
    for (int c = 0; c < 3; c++) {
        double nearest[3];
        triangle_nearest((const double(*)[3])of, corners[c], nearest);
        if (distance3(nearest, corners[c]) > error)
            return false;
    }
    return true;
}

typedef struct Nearness {
    const double (*corners)[3];
    double     error;
    const Bvh *bvh;
    uint32_t   found;
} Nearness;

/* Stops at a triangle to which all corners are near. */
static bool look_on(void *user, uint32_t triangle, const double corners[3][3])
{
    Nearness *nearness = user;
    (void)corners;
    nearness->found = triangle;
    return !are_near(nearness->bvh, triangle, nearness->corners, nearness->error);
}

/* `last`: a triangle that may be near. */
static bool is_within(const Bvh *bvh, const double corners[3][3], double error, int cuts,
                      uint32_t *last)
{
    Nearness nearness = {corners, error, bvh, 0};
    if (are_near(bvh, *last, corners, error))
        return true;
    if (!bvh_visit(bvh, corners[0], error, look_on, &nearness)) {
        *last = nearness.found;
        return true;
    }
    if (cuts == 0)
        return false;
    double middles[3][3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            middles[c][k] = 0.5 * (corners[c][k] + corners[(c + 1) % 3][k]);
    for (int c = 0; c < 3; c++) {
        double corner[3][3];
        memcpy(corner[0], corners[c], sizeof corner[0]);
        memcpy(corner[1], middles[c], sizeof corner[1]);
        memcpy(corner[2], middles[(c + 2) % 3], sizeof corner[2]);
        if (!bvh_is_near(bvh, corner[0], error, last) ||
            !is_within(bvh, (const double(*)[3])corner, error, cuts - 1, last))
            return false;
    }
    return is_within(bvh, (const double(*)[3])middles, error, cuts - 1, last);
}

/* ---- what is proposed ---- */

/* Those that are kept stay as they are; the others are simplified up to their border. */
static void propose(Simplifier *s, double error)
{
    const KrsMesh *mesh = s->mesh;
    ArenaMark      mark = arena_mark(&s->arena);
    uint32_t(*rest)[3]  = arena_alloc(&s->arena, s->best_count + 1, sizeof *rest);
    float  scale        = meshopt_simplifyScale(&s->positions[0][0], mesh->vertex_count,
                                                sizeof *s->positions);
    size_t count        = 0;
    for (size_t i = 0; i < s->best_count; i++)
        if (!s->kept[i])
            memcpy(rest[count++], s->best[i], sizeof *rest);
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

/* ---- what is wrong with it ---- */

typedef struct Judgement {
    Simplifier *s;
    const Bvh  *best, *now; /* what was simplified, and the one whose triangles are reported */
    double      radius;
    size_t      faults;
} Judgement;

static bool keep_triangle(void *user, uint32_t triangle, const double corners[3][3])
{
    Simplifier *s = user;
    (void)corners;
    s->kept[triangle] = true;
    return true;
}

/* Triangles of the mesh near to the corners of one that is wrong are kept, and more of them in each trial. */
static void note_fault(void *user, uint32_t triangle)
{
    Judgement *judgement = user;
    double     corners[3][3];
    corners_of(judgement->now, triangle, corners);
    for (int c = 0; c < 3; c++)
        bvh_visit(judgement->best, corners[c], judgement->radius, keep_triangle, judgement->s);
    judgement->faults++;
}

/* All triangles of one mesh: whether they are far from another, or cross each other if there is none. */
typedef struct Check {
    Simplifier   *s;
    const Bvh    *triangles, *of;
    Numbering    *near; /* those that are known to be near; NULL: none */
    bool         *wrong;
    atomic_size_t next;
} Check;

static NumberKey key_of(const uint32_t triangle[3])
{
    return face_key(triangle[0], triangle[1], triangle[2]);
}

static bool is_wrong(const Check *check, uint32_t triangle, uint32_t *last)
{
    const Simplifier *s = check->s;
    double            corners[3][3];
    if (!check->of)
        return triangle_crosses(check->triangles, triangle);
    if (check->near &&
        numbering_find(check->near, key_of(check->triangles->triangles[triangle])) != NO_NUMBER)
        return false;
    corners_of(check->triangles, triangle, corners);
    return !is_within(check->of, (const double(*)[3])corners, s->error, MOST_CUTS, last);
}

static void ask(Simplifier *s, double part)
{
    const KrsMeshOptions *options = s->options;
    s->fraction                   = s->begun + part * (s->goal - s->begun);
    if (options->go_on && !options->go_on(options->user, s->fraction))
        atomic_store(&s->stopped, true);
}

/* The first part runs in the thread of the caller, so it asks. */
static void check_some(void *task, size_t part, size_t parts)
{
    enum { SOME = 64 };
    Check   *check = task;
    size_t   count = check->triangles->triangle_count;
    uint32_t last  = 0;
    (void)parts;
    while (!atomic_load(&check->s->stopped)) {
        size_t begin = atomic_fetch_add(&check->next, SOME);
        if (begin >= count)
            return;
        if (part == 0)
            ask(check->s, (double)begin / (double)count);
        for (size_t i = begin; i < begin + SOME && i < count; i++)
            check->wrong[i] = is_wrong(check, (uint32_t)i, &last);
    }
}

/* `goal`: the part of the work that is done then. */
static void check_all(Judgement *judgement, Check *check, double goal)
{
    Simplifier *s     = judgement->s;
    size_t      count = check->triangles->triangle_count;
    check->s          = s;
    check->wrong      = arena_new_array(&s->arena, bool, count + 1);
    s->begun          = s->fraction;
    s->goal           = goal;
    judgement->now    = check->triangles;
    run_in_parallel(check_some, check);
    for (uint32_t i = 0; i < count && !atomic_load(&s->stopped); i++)
        if (check->wrong[i])
            note_fault(judgement, i);
        else if (check->near)
            numbering_take(check->near, key_of(check->triangles->triangles[i]), 0);
}

static size_t count_faults(Simplifier *s, double radius, double goal)
{
    const KrsMesh *mesh     = s->mesh;
    const double(*at)[3]    = (const double(*)[3])mesh->vertices;
    const uint32_t(*new)[3] = (const uint32_t(*)[3])s->triangles;
    ArenaMark mark          = arena_mark(&s->arena);
    Bvh       from, best, to;
    bvh_new(&from, at, (const uint32_t(*)[3])mesh->triangles, mesh->triangle_count, &s->arena);
    bvh_new(&best, at, (const uint32_t(*)[3])s->best, s->best_count, &s->arena);
    bvh_new(&to, at, new, s->triangle_count, &s->arena);
    Judgement judgement = {s, &best, &to, radius, 0};
    report_open(new, s->triangle_count, note_fault, &judgement, &s->arena);
    Check  checks[] = {{.triangles = &to, .of = &from, .near = &s->near},
                       {.triangles = &to},
                       {.triangles = &from, .of = &to}};
    double begun    = s->fraction;
    for (int i = 0; i < 3; i++)
        check_all(&judgement, &checks[i], begun + (i + 1) / 3.0 * (goal - begun));
    arena_rewind(&s->arena, mark);
    return judgement.faults;
}

/* Simplifies the best further, unless all trials have faults or it is stopped. */
static void try_error(Simplifier *s, double error, double goal)
{
    double radius = s->error;
    memset(s->kept, 0, s->best_count * sizeof *s->kept);
    for (int trial = 0; trial < MOST_TRIALS; trial++, radius *= GROWTH) {
        propose(s, error);
        if (s->triangle_count == 0 || s->triangle_count >= s->best_count)
            return;
        size_t faults = count_faults(s, radius, 0.5 * (s->fraction + goal));
        if (atomic_load(&s->stopped))
            return;
        if (faults == 0) {
            memcpy(s->best, s->triangles, s->triangle_count * sizeof *s->best);
            s->best_count = s->triangle_count;
            return;
        }
    }
}

/* With more and more error.  Where one step is too far, the next ones go on from the last that was good. */
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
    s->best_count = count;
    if (count > 0)
        memcpy(s->best, mesh->triangles, count * sizeof *s->best);
    for (double error = FIRST_ERROR * s->error; error <= s->error && count > 0; error *= 2) {
        double goal = 0.5 * (s->fraction + 1);
        try_error(s, error, goal);
        s->fraction = goal;
    }
}

/* Without vertices that no triangle has. */
static KrsStatus copy_triangles(Simplifier *s, KrsMesh **result)
{
    const KrsMesh *mesh   = s->mesh;
    uint32_t      *number = arena_new_array(&s->arena, uint32_t, mesh->vertex_count + 1);
    KrsMesh       *copy   = malloc(sizeof *copy);
    if (!copy)
        return KRS_OUT_OF_MEMORY;
    *copy = *mesh;
    copy->error += s->error;
    copy->vertex_count   = 0;
    copy->triangle_count = s->best_count;
    copy->vertices       = malloc((mesh->vertex_count + 1) * sizeof *copy->vertices);
    copy->triangles      = malloc((s->best_count + 1) * sizeof *copy->triangles);
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
    s.near.arena     = &s.lasting;
    KrsStatus status = simplify(&s, simplified);
    arena_free(&s.arena);
    arena_free(&s.lasting);
    return status;
}
