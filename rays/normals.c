/*
 * normals.c: normals by differences of the distance, as in runtime/shaders/distance_normals.glsl and
 * edge_normals.glsl, where they are described.
 *
 * Hits take the taps of a set together, and those that need a further one the taps of that.
 */
#include "rays/march.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"

/* These numbers are those of the two files. */
static const float NOISE = 1e-4f, MAX_WIDTH = 1.0f / 64, ROUNDING = 2.4e-7f, NEARER = 0.02f,
                   NOISE_NEARER = 4e-5f, OUTWARD_REACHES = 3, FLAT_ENOUGH = 0.0175f,
                   FLATTER = 0.008f, BESIDE_REACHES = 8, ABOVE_REACHES = 4, FACING_ALIKE = 0.3f,
                   ON_PLANE = 0.06f, FACING_SAME = 0.999f;

typedef enum TapSet {
    WIDE,
    AT_HIT,
    OUTSIDE,
    INSIDE,
    TO_EYE,
    ACROSS,
    BESIDE,
    ONE_SIDE,
    MEAN
} TapSet;

typedef struct Vector {
    float x, y, z;
} Vector;

static Vector plus(Vector a, Vector b) { return (Vector){a.x + b.x, a.y + b.y, a.z + b.z}; }
static Vector minus(Vector a, Vector b) { return (Vector){a.x - b.x, a.y - b.y, a.z - b.z}; }
static Vector times(float by, Vector a) { return (Vector){by * a.x, by * a.y, by * a.z}; }
static float  dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static float  length(Vector a) { return sqrtf(dot(a, a)); }
static Vector unit(Vector a) { return times(1 / length(a), a); }
static Vector absolute(Vector a) { return (Vector){fabsf(a.x), fabsf(a.y), fabsf(a.z)}; }
static float  largest(Vector a) { return fmaxf(fmaxf(fabsf(a.x), fabsf(a.y)), fabsf(a.z)); }
static Vector lesser(Vector a, Vector b)
{
    return (Vector){fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)};
}
static Vector cross(Vector a, Vector b)
{
    return (Vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* A hit, and its taps. */
typedef struct Hit {
    Vector position, backwards;
    float  side, rounding;
    TapSet set;
    Vector start, sum, level, sum_wide, level_wide, plane_normal;
    float  t, middle, reach, bend_wide, at_hit;
} Hit;

/* Returns how wide a pixel counts that is so wide at t. */
static float near_width(const RayRule *rule, float width, float t)
{
    return fmaxf(rule->from_surfaces ? width : fminf(width, MAX_WIDTH * t), 1e-30f);
}

float ray_normal_reach(const RayRule *rule, float width, float t, float coordinate)
{
    const float near = near_width(rule, width, t);
    return fmaxf(rule->normal_reach * near, NOISE * coordinate + 2 * ROUNDING * coordinate);
}

static Hit begin(const RayRule *rule, const RayBlock *block, int i)
{
    const Vector origin    = {block->origin[0][i], block->origin[1][i], block->origin[2][i]},
                 direction = {block->direction[0][i], block->direction[1][i],
                              block->direction[2][i]};
    const float t = block->t[i], width = block->width[i] + block->spread[i] * t;
    Hit         hit = {.position  = plus(origin, times(t, direction)),
                       .backwards = times(-1, direction),
                       .side      = block->side[i]};
    hit.start       = hit.position;
    hit.rounding    = ROUNDING * (largest(hit.position) + largest(origin));
    hit.t           = fmaxf(rule->normal_reach * near_width(rule, width, t),
                            NOISE * largest(hit.position) + hit.rounding);
    return hit;
}

static float find_bend(const Hit *hit)
{
    const Vector middle = {2 * hit->middle, 2 * hit->middle, 2 * hit->middle};
    return length(minus(hit->level, middle)) / length(hit->sum);
}

/* Returns two directions at right angles to a third: find_frame of frame.glsl gives the first. */
static Vector beside(Vector axis)
{
    const float side = axis.z < 0 ? -1.0f : 1.0f, a = -1 / (side + axis.z), b = axis.x * axis.y * a;
    return (Vector){1 + side * axis.x * axis.x * a, side * b, -side * axis.x};
}

static Vector find_place_across(const Hit *hit, bool turned)
{
    const Vector mean   = unit(hit->sum_wide);
    Vector       to_eye = minus(hit->backwards, times(dot(hit->backwards, mean), mean));
    const float  size   = length(to_eye);
    to_eye              = size > 1e-3f ? times(1 / size, to_eye) : beside(mean);
    return plus(times(BESIDE_REACHES, turned ? cross(mean, to_eye) : to_eye),
                times(ABOVE_REACHES, mean));
}

static void begin_set(Hit *hit, TapSet set)
{
    const float  outward = set == OUTSIDE ? OUTWARD_REACHES : set == INSIDE ? -OUTWARD_REACHES : 0;
    const Vector wide    = unit(hit->sum_wide);
    Vector       place   = times(outward, plus(wide, hit->backwards));
    hit->set             = set;
    hit->t = fmaxf(NEARER * hit->reach, NOISE_NEARER * largest(hit->position) + hit->rounding);
    if (set == TO_EYE || set == ACROSS)
        place = find_place_across(hit, set == ACROSS);
    Vector moved = times(hit->t, place);
    if (set == BESIDE) {
        hit->plane_normal    = unit(hit->sum);
        const Vector lateral = minus(wide, times(dot(wide, hit->plane_normal), hit->plane_normal));
        hit->t               = hit->reach;
        moved                = times(hit->reach / fmaxf(length(lateral), 1e-6f), lateral);
    }
    hit->start = plus(hit->position, moved);
    hit->sum = hit->level = (Vector){0, 0, 0};
}

static bool is_confirmed(const Hit *hit)
{
    const Vector rise      = times(hit->reach / hit->t * 0.5f, hit->sum),
                 at_hit    = {hit->at_hit, hit->at_hit, hit->at_hit};
    const Vector ahead     = minus(times(0.5f, plus(hit->level_wide, hit->sum_wide)), at_hit);
    const Vector behind    = minus(times(0.5f, minus(hit->level_wide, hit->sum_wide)), at_hit);
    const Vector deviation = lesser(absolute(minus(ahead, rise)), absolute(plus(behind, rise)));
    return largest(deviation) < ON_PLANE * length(rise);
}

static TapSet end_wide(Hit *hit, const RayRule *rule)
{
    const float sharp = rule->plain ? FLAT_ENOUGH : 0.5f, thin = rule->plain ? 4 : 1;
    hit->bend_wide  = find_bend(hit);
    hit->sum_wide   = hit->sum;
    hit->level_wide = hit->level;
    hit->reach      = hit->t;
    hit->at_hit     = 0;
    return hit->bend_wide > sharp && hit->bend_wide < thin ? rule->plain ? AT_HIT : OUTSIDE : WIDE;
}

static bool is_one_side(const Hit *hit, float bend)
{
    const bool alike = dot(hit->sum, hit->sum_wide) >
                       FACING_ALIKE * length(hit->sum) * length(hit->sum_wide);
    const bool visible = hit->set < TO_EYE || dot(hit->sum, hit->backwards) > 0;
    return visible && ((alike && hit->set != INSIDE && bend < FLATTER * fminf(hit->bend_wide, 1)) ||
                       (bend < FLAT_ENOUGH && is_confirmed(hit)));
}

static TapSet end_beside(Hit *hit)
{
    const bool same = find_bend(hit) < FLAT_ENOUGH &&
                      dot(hit->sum, hit->plane_normal) > FACING_SAME * length(hit->sum) &&
                      fabsf(hit->middle) < ON_PLANE * hit->t;
    hit->sum = hit->plane_normal;
    return same ? ONE_SIDE : MEAN;
}

static TapSet end_nearer(Hit *hit, const RayRule *rule)
{
    const TapSet last = rule->plain ? ACROSS : OUTSIDE;
    const float  bend = find_bend(hit);
    hit->at_hit       = hit->set == AT_HIT ? hit->middle : hit->at_hit;
    TapSet next       = bend < FLAT_ENOUGH && hit->set < INSIDE ? BESIDE : MEAN;
    next              = bend > FLAT_ENOUGH && hit->set < last ? hit->set + 1 : next;
    return is_one_side(hit, bend) ? ONE_SIDE : next;
}

/* Ends a set of taps, and begins the next; false: it was the last. */
static bool begin_next_set(Hit *hit, const RayRule *rule)
{
    const TapSet next = hit->set == WIDE     ? end_wide(hit, rule)
                        : hit->set == BESIDE ? end_beside(hit)
                                             : end_nearer(hit, rule);
    const bool   more = next != WIDE && next < ONE_SIDE;
    if (more)
        begin_set(hit, next);
    hit->set = next;
    if (next == MEAN) {
        hit->sum   = hit->sum_wide;
        hit->level = hit->level_wide;
    }
    return more;
}

/* The taps of the octahedron; the last is in the middle. */
enum { OCTAHEDRON = 6 };
static Vector tap_at(int tap)
{
    const float side = tap & 1 ? -1.0f : 1.0f;
    return tap == OCTAHEDRON
               ? (Vector){0, 0, 0}
               : (Vector){tap < 2 ? side : 0, tap > 1 && tap < 4 ? side : 0, tap > 3 ? side : 0};
}

/* Evaluates the first `taps` taps, from the last one on, of hits that take a set together; of the first set the one in the
   middle is not needed. */
static void take_taps(const RayCell *cell, Hit *const *hits, int count, int taps)
{
    static_assert((int)OCTAHEDRON < (int)CELL_BLOCKS, "all taps are evaluated at once");
    const int all = taps * count, blocks = (all + RAYS_OF_BLOCK - 1) / RAYS_OF_BLOCK;
    float     points[3][CELL_WIDE];
    for (int i = 0; i < blocks * RAYS_OF_BLOCK; i++) {
        const Hit   *hit = hits[i < all ? i % count : 0];
        const Vector at  = plus(hit->start, times(hit->t, tap_at(i < all ? i / count : 0)));
        points[0][i]     = at.x;
        points[1][i]     = at.y;
        points[2][i]     = at.z;
    }
    const float *distances = ray_cell_run_wide(cell, points, (size_t)blocks);
    for (int i = all - 1; i >= 0; i--) {
        Hit         *hit       = hits[i % count];
        const Vector direction = tap_at(i / count);
        const float  distance  = hit->side * distances[i];
        hit->middle            = i / count < OCTAHEDRON ? hit->middle : distance;
        hit->sum               = plus(hit->sum, times(distance, direction));
        hit->level             = plus(hit->level, times(distance, absolute(direction)));
    }
}

static float find_evenness(const Hit *hit)
{
    const float size = length(hit->sum), uneven = (float)real_hypot(size, length(hit->level));
    return hit->set == ONE_SIDE ? 1 : uneven > 0 && uneven < 1e38f ? size / uneven : 1;
}

static void store(const Hit *hit, RayBlock *block, int i)
{
    const float  size   = length(hit->sum);
    const Vector normal = size > 0 && size < 1e38f ? times(1 / size, hit->sum) : hit->backwards;
    block->normal[0][i] = normal.x;
    block->normal[1][i] = normal.y;
    block->normal[2][i] = normal.z;
    block->evenness[i]  = find_evenness(hit);
}

/* Finds the normals of up to as many hits as a block has rays. */
static uint64_t find_normals(const RayCell *cell, const RayRule *rule, const RayHit *found,
                             int count)
{
    Hit      hits[RAYS_OF_BLOCK], *takes[RAYS_OF_BLOCK];
    uint64_t evaluations = 0;
    int      taking      = count;
    for (int i = 0; i < count; i++) {
        hits[i]  = begin(rule, found[i].block, found[i].lane);
        takes[i] = &hits[i];
    }
    for (int taps = OCTAHEDRON, more; taking > 0; taking = more, taps = OCTAHEDRON + 1) {
        take_taps(cell, takes, taking, taps);
        evaluations += (uint64_t)(taking * taps);
        more = 0;
        for (int i = 0; i < taking; i++)
            if (begin_next_set(takes[i], rule))
                takes[more++] = takes[i];
    }
    for (int i = 0; i < count; i++)
        store(&hits[i], found[i].block, found[i].lane);
    return evaluations;
}

uint64_t ray_normals(const RayCell *cell, const RayRule *rule, const RayHit *found, size_t count)
{
    uint64_t evaluations = 0;
    for (size_t done = 0; done < count; done += RAYS_OF_BLOCK)
        evaluations += find_normals(cell, rule, found + done,
                                    count - done < RAYS_OF_BLOCK ? (int)(count - done)
                                                                 : RAYS_OF_BLOCK);
    return evaluations;
}
