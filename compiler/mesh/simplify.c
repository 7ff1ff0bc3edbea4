/*
 * simplify.c: krs_mesh_simplify: meshoptimizer proposes, and a proof accepts.
 *
 * meshoptimizer's error is a mean of squares, so it may be exceeded.  A triangle is within an error of a
 * mesh if its corners are within it of the same triangle of that mesh, since that is convex; if they are not, it is
 * cut into four.
 */
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/krs.h"
#include "compiler/mesh/slivers.h"

enum { MOST_CUTS = 12, MOST_TRIALS = 14 };
/* From trial to trial triangles are kept so many times as far around faults.  Most faults are single
   triangles that cross others, and what is proposed next may have some elsewhere.  So steps are small. */
static const double GROWTH = 1.25;

typedef struct Simplifier {
    Memory         memory;
    Arena          arena;
    const KrsMesh *mesh;
    double         error;
    float (*positions)[3];
    uint32_t (*triangles)[3]; /* of the mesh's vertices */
    bool  *kept;              /* of the best triangles: to stay as they are */
    size_t triangle_count;
    uint32_t (*best)[3]; /* triangles that have been good */
    size_t best_count;
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

static void report_far(const Bvh *triangles, const Bvh *of, double error, ReportTriangle *report,
                       void *user)
{
    uint32_t last = 0;
    for (uint32_t i = 0; i < triangles->triangle_count; i++) {
        double corners[3][3];
        corners_of(triangles, i, corners);
        if (!is_within(of, (const double(*)[3])corners, error, MOST_CUTS, &last))
            report(user, i);
    }
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

static size_t count_faults(Simplifier *s, double radius)
{
    Bvh            from, best, to;
    const KrsMesh *mesh     = s->mesh;
    const double(*at)[3]    = (const double(*)[3])mesh->vertices;
    const uint32_t(*new)[3] = (const uint32_t(*)[3])s->triangles;
    ArenaMark mark          = arena_mark(&s->arena);
    bvh_new(&from, at, (const uint32_t(*)[3])mesh->triangles, mesh->triangle_count, &s->arena);
    bvh_new(&best, at, (const uint32_t(*)[3])s->best, s->best_count, &s->arena);
    bvh_new(&to, at, new, s->triangle_count, &s->arena);
    Judgement judgement = {s, &best, &to, radius, 0};
    report_open(new, s->triangle_count, note_fault, &judgement, &s->arena);
    report_far(&to, &from, s->error, note_fault, &judgement);
    report_crossing(&to, note_fault, &judgement);
    judgement.now = &from;
    report_far(&from, &to, s->error, note_fault, &judgement);
    arena_rewind(&s->arena, mark);
    return judgement.faults;
}

/* Simplifies the best further, unless all trials have faults. */
static bool try_error(Simplifier *s, double error)
{
    double radius = s->error;
    memset(s->kept, 0, s->best_count * sizeof *s->kept);
    for (int trial = 0; trial < MOST_TRIALS; trial++, radius *= GROWTH) {
        propose(s, error);
        if (s->triangle_count == 0 || s->triangle_count >= s->best_count)
            return false;
        size_t faults = count_faults(s, radius);
        if (faults == 0) {
            memcpy(s->best, s->triangles, s->triangle_count * sizeof *s->best);
            s->best_count = s->triangle_count;
            return true;
        }
    }
    return false;
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
    for (double error = s->error / 32; error <= s->error && count > 0; error *= 2)
        try_error(s, error);
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
    return copy_triangles(s, simplified);
}

KrsStatus krs_mesh_simplify(const KrsMesh *mesh, double error, KrsMesh **simplified)
{
    Simplifier s = {.mesh = mesh, .error = error};
    *simplified  = NULL;
    if (!(error > 0) || isinf(error))
        return KRS_BAD_ARGUMENT;
    s.arena.memory   = &s.memory;
    KrsStatus status = simplify(&s, simplified);
    arena_free(&s.arena);
    return status;
}
