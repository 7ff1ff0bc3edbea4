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
#include "mesh/simplify/blocks.h"
#include "mesh/simplify/simplifier.h"
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
        simplifier_progress(s, fmin(fmax(part, 0), 1));
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
