/*
 * query.c: questions: what is at a point, and where a ray ends, in double precision.
 *
 * What is asked of the device (runtime/tracer/query.c) follows the same rules in single precision.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/program.h"

static bool are_finite(const double (*vectors)[3], size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(vectors[i][0]) || !isfinite(vectors[i][1]) || !isfinite(vectors[i][2]))
            return false;
    return true;
}

/* ---- points ---- */

/* How deep a point is in the deepest zone, those of the scene (in frame->values) and of the
   caller; negative outside. */
static double zone_depth(const KrsFrame *frame, const double point[3])
{
    Node   zone  = zone_root(frame->scene);
    double depth = zone == NODE_NONE ? -INFINITY : frame->values[zone].v[0];
    for (size_t i = 0; i < frame->zone_count; i++) {
        const double *at = frame->zones[i];
        depth            = fmax(depth, at[3] - distance3(point, at));
    }
    return depth;
}

/* The least distance of all components; *nearest is its component, from 1.  Zones cut what is
   there, and do not change whose it is. */
static double distance_at(KrsFrame *frame, const double point[3], uint32_t *nearest)
{
    const KrsScene *scene = frame->scene;
    double          least = INFINITY;
    tape_run_point(&scene->distance, point, frame->values);
    for (size_t i = 0; i < scene->component_count; i++) {
        Node   root     = scene->roots.components[i * ROOT_COUNT + ROOT_DISTANCE];
        double distance = frame->values[root].v[0];
        if (distance < least || i == 0) {
            least    = distance;
            *nearest = (uint32_t)i + 1;
        }
    }
    double depth = zone_depth(frame, point);
    return least < depth ? depth : least;
}

/* Where rays have to go from root to root: how far this one may go from a point, the last place
   having been `gap` behind. */
static double way_ahead(KrsFrame *frame, const double point[3], const double direction[3],
                        double gap)
{
    const KrsScene *scene = frame->scene;
    const Node     *ahead = scene->roots.along + ALONG_EXACT * scene->component_count;
    double          least = INFINITY;
    tape_run_surface(&scene->ahead, point, direction, gap, frame->values);
    for (size_t i = 0; i < scene->component_count; i++)
        least = fmin(least, frame->values[ahead[i]].v[0]);
    return fmax(least, zone_depth(frame, point));
}

/* No more than the distance, and cheaper: levels of sequences that are far for their size are not
   looked at (lower_guarded). */
static double room_at(KrsFrame *frame, const double point[3])
{
    const KrsScene *scene = frame->scene;
    double          least = INFINITY;
    tape_run_point(&scene->guarded, point, frame->values);
    for (size_t i = 0; i < scene->component_count; i++)
        least = fmin(least, frame->values[scene->roots.guarded[i]].v[0]);
    return fmax(least, zone_depth(frame, point));
}

KrsStatus krs_distance(KrsFrame *frame, const double (*points)[3], size_t count, double *distances)
{
    uint32_t nearest = 0;
    if (!are_finite(points, count))
        return KRS_BAD_ARGUMENT;
    frame_refresh(frame);
    for (size_t i = 0; i < count; i++)
        distances[i] = distance_at(frame, points[i], &nearest);
    return KRS_OK;
}

/* By derivatives, where differences would see both sides of a sheet.  False: there are none. */
static bool derived_normal(KrsFrame *frame, const double point[3], double normal[3])
{
    const KrsScene *scene   = frame->scene;
    uint32_t        nearest = 0;
    if (!scene->program.sheets || distance_at(frame, point, &nearest) <= zone_depth(frame, point))
        return false;
    Node gradient = scene->roots.gradients[(nearest - 1) * GRADIENT_ROOTS];
    if (scene->graph->items[gradient].type != TYPE_VEC3)
        return false;
    tape_run_point(&scene->turned, point, frame->values);
    frame_copy(frame, gradient, normal);
    bool known = largest3(normal) > 0 && largest3(normal) < INFINITY;
    if (known)
        vector_normalize(normal);
    return known;
}

/* Central differences: in double precision their error is far below what a normal needs. */
static void normal_at(KrsFrame *frame, const double point[3], double normal[3])
{
    double   step = 1e-6 * (1 + largest3(point));
    uint32_t nearest;
    if (derived_normal(frame, point, normal))
        return;
    for (int i = 0; i < 3; i++) {
        double before[3] = {point[0], point[1], point[2]};
        double after[3]  = {point[0], point[1], point[2]};
        before[i] -= step;
        after[i] += step;
        normal[i] = distance_at(frame, after, &nearest) - distance_at(frame, before, &nearest);
    }
    double length = length3(normal);
    for (int i = 0; i < 3; i++)
        normal[i] = length > 1e-3 * step ? normal[i] / length : 0;
}

KrsStatus krs_normal(KrsFrame *frame, const double (*points)[3], size_t count, double (*normals)[3])
{
    if (!are_finite(points, count))
        return KRS_BAD_ARGUMENT;
    frame_refresh(frame);
    for (size_t i = 0; i < count; i++)
        normal_at(frame, points[i], normals[i]);
    return KRS_OK;
}

/* Within 0 and 1, as pictures show it; what is not a number is 0. */
static double part(double number) { return number > 0 ? fmin(number, 1) : 0; }

static void probe(KrsFrame *frame, const double point[3], KrsHit *hit)
{
    const KrsScene *scene = frame->scene;
    *hit                  = (KrsHit){.hit = true};
    memcpy(hit->point, point, sizeof hit->point);
    normal_at(frame, point, hit->normal);
    hit->distance = distance_at(frame, point, &hit->component);
    if (!hit->component)
        return;
    tape_run_surface(&scene->surface, point, hit->normal, 0, frame->values);
    const Node *root = &scene->roots.components[(hit->component - 1) * ROOT_COUNT];
    hit->level       = (uint32_t)frame->values[root[ROOT_LEVEL]].v[0];
    hit->instance    = (uint32_t)frame->values[root[ROOT_INSTANCE]].v[0];
    frame_copy(frame, root[ROOT_COLOR], hit->color);
    hit->roughness = part(frame->values[root[ROOT_ROUGHNESS]].v[0]);
    hit->metallic  = part(frame->values[root[ROOT_METALLIC]].v[0]);
    for (int k = 0; k < 3; k++)
        hit->color[k] = part(hit->color[k]);
    /* No mirror is smooth where a zone cuts. */
    if (hit->distance > frame->values[root[ROOT_DISTANCE]].v[0])
        memcpy(hit->shading, hit->normal, sizeof hit->shading);
    else
        frame_copy(frame, root[ROOT_NORMAL], hit->shading);
}

KrsStatus krs_probe(KrsFrame *frame, const double (*points)[3], size_t count, KrsHit *hits)
{
    if (!are_finite(points, count))
        return KRS_BAD_ARGUMENT;
    frame_refresh(frame);
    for (size_t i = 0; i < count; i++)
        probe(frame, points[i], &hits[i]);
    return KRS_OK;
}

/* ---- rays ---- */

/* Grown by what rounding may take away from a box. */
static void clip_axis(double low, double high, double from, double along, KrsRay *ray)
{
    double margin = 1e-9 * (1 + fabs(from));
    low -= margin + (isfinite(low) ? 1e-9 * fabs(low) : 0);
    high += margin + (isfinite(high) ? 1e-9 * fabs(high) : 0);
    double a = (low - from) / along, b = (high - from) / along;
    if (along == 0) {
        a = from >= low && from <= high ? -INFINITY : INFINITY;
        b = -a;
    } else if (along < 0) {
        double swap = a;
        a           = b;
        b           = swap;
    }
    ray->start = fmax(ray->start, a);
    ray->end   = fmin(ray->end, b);
}

KrsRay krs_ray(const KrsScene *scene, const double origin[3], const double direction[3],
               double farthest)
{
    const KrsProgram *program = &scene->program;
    const double      nowhere = 1e30; /* farther than anything is; its square is a number */
    KrsRay            ray     = {.end = nowhere};
    memcpy(ray.origin, origin, sizeof ray.origin);
    memcpy(ray.direction, direction, sizeof ray.direction);
    vector_normalize(ray.direction);
    for (int k = 0; k < 3; k++)
        clip_axis(program->low[k], program->high[k], origin[k], ray.direction[k], &ray);
    ray.walls = ray.end <= farthest && ray.end < nowhere;
    ray.end   = fmin(ray.end, farthest);
    return ray;
}

bool krs_rays_are_sound(const double (*origins)[3], const double (*directions)[3], size_t count,
                        double farthest, double tolerance)
{
    if (!(farthest >= 0) || !(tolerance >= 0) || isinf(tolerance) || !are_finite(origins, count) ||
        !are_finite(directions, count))
        return false;
    for (size_t i = 0; i < count; i++)
        if (largest3(directions[i]) == 0)
            return false;
    return true;
}

enum { SEAM = 16 }; /* roundings */

/* A ray under way.  Nothing is before `t`, nor for `room` behind it; `gap` from there is the next
   place to look at. */
typedef struct March {
    KrsFrame *frame;
    KrsRay    ray;
    double    size; /* of the origin's coordinates: what rounding goes by */
    double    tolerance;
    double    side; /* -1 from inside of a solid; 0: not known */
    double    t, room, gap;
    double    slope; /* of the room along the ray, as it was on average */
} March;

static void march_point(const March *march, double t, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = march->ray.origin[k] + t * march->ray.direction[k];
}

static double rounding_at(const March *march, double t)
{
    return 4 * DBL_EPSILON * (march->size + t);
}

/* Solids that touch are one: from inside they count as grown by what rounding may leave open at
   the seam between two. */
static double march_room(March *march, double t)
{
    double point[3];
    march_point(march, t, point);
    bool sheets = march->frame->scene->program.sheets;
    /* Some roundings farther back: what was just before a sheet there must not be behind it here. */
    double back     = t > march->t ? t - march->t + 2 * rounding_at(march, t) : 0;
    double distance = sheets ? way_ahead(march->frame, point, march->ray.direction, back)
                             : room_at(march->frame, point);
    if (march->side == 0)
        march->side = distance < 0 ? -1 : 1;
    return march->side < 0 ? SEAM * rounding_at(march, t) - distance : distance;
}

/* Where the surface is crossed between t, where there is room, and t + gap, where there is `room`
   and so none: by false position, each end's weight halved when the other has moved twice
   (the Illinois method). */
static double find_crossing(March *march, double room)
{
    enum { MOST_ROUNDS = 100 };
    double low = march->t, high = march->t + march->gap, below = march->room, above = room;
    double enough = fmax(rounding_at(march, high), march->tolerance / 16);
    int    moved  = 0;
    for (int i = 0; i < MOST_ROUNDS && above < 0 && below > 0 && high - low > enough; i++) {
        double t = low + (high - low) * below / (below - above);
        t        = fmin(fmax(t, low + 0.25 * enough), high - 0.25 * enough);
        double r = march_room(march, t);
        if (r > 0) {
            low   = t;
            below = r;
            above *= moved > 0 ? 0.5 : 1;
            moved = 1;
        } else {
            high  = t;
            above = r;
            below *= moved < 0 ? 0.5 : 1;
            moved = -1;
        }
    }
    return high;
}

typedef enum Fate { MARCHING, HIT, MISS } Fate;

/*
 * One look, by the rule of trace.comp: the ball of empty space around t and the one around the
 * place looked at must meet; else the ray goes back to the middle of what they leave open, until
 * no more is open than a sixteenth of the tolerance.  So a gap may be as long as the balls are
 * expected to meet over if the room goes on as it did (automatic relaxation).
 */
static Fate march_step(March *march)
{
    double at = march->t + march->gap, room = march_room(march, at);
    double least = rounding_at(march, at), open = march->tolerance / 16 + least;
    double doubtful = march->gap - march->room;
    if (room <= 0 && doubtful <= march->tolerance + open) {
        march->t   = find_crossing(march, room);
        march->gap = 0;
        return march->t <= march->ray.end ? HIT : MISS;
    }
    if (room > 0 && doubtful <= room + 1.01 * open) {
        double slope = march->gap > 0 ? (room - march->room) / march->gap : -1;
        march->slope += 0.3 * (slope - march->slope);
        march->t    = at;
        march->room = room;
        /* Of roots nothing behind the place is known. */
        double factor = march->frame->scene->program.sheets
                            ? 1
                            : fmax(1, 2 / (1 - fmin(march->slope, 0.98)));
        march->gap    = room * factor + open;
        return at + room > march->ray.end ? MISS : MARCHING;
    }
    march->gap   = fmax(0.5 * (march->gap + march->room - fmax(room, 0)), march->room + open);
    march->slope = -1;
    return MARCHING;
}

void krs_face(const KrsRay *ray, KrsHit *hit)
{
    double along = 0;
    for (int k = 0; k < 3; k++)
        along += hit->normal[k] * ray->direction[k];
    for (int k = 0; k < 3 && along > 0; k++) {
        hit->normal[k]  = -hit->normal[k];
        hit->shading[k] = -hit->shading[k];
    }
}

static void trace(KrsFrame *frame, KrsRay ray, double tolerance, KrsHit *hit)
{
    March march = {.frame     = frame,
                   .ray       = ray,
                   .size      = largest3(ray.origin),
                   .tolerance = tolerance > 0 ? tolerance : 1e-9,
                   .side      = ray.start > 0 ? 1 : 0,
                   .t         = ray.start,
                   .slope     = -1};
    Fate  fate  = ray.start <= ray.end ? MARCHING : MISS;
    for (int i = 0; i < KRS_MOST_STEPS && fate == MARCHING; i++)
        fate = march_step(&march);
    *hit = (KrsHit){0};
    if (fate == MISS && march.side < 0 && ray.walls) {
        march.t = ray.end;
        fate    = HIT;
    }
    if (fate == MISS)
        return;
    double point[3];
    march_point(&march, march.t, point);
    probe(frame, point, hit);
    if (frame->scene->program.sheets)
        krs_face(&ray, hit);
    hit->t          = march.t;
    hit->hit        = fate == HIT;
    hit->unresolved = fate == MARCHING;
}

KrsStatus krs_raycast(KrsFrame *frame, const double (*origins)[3], const double (*directions)[3],
                      size_t count, double farthest, double tolerance, KrsHit *hits)
{
    if (!krs_rays_are_sound(origins, directions, count, farthest, tolerance))
        return KRS_BAD_ARGUMENT;
    frame_refresh(frame);
    for (size_t i = 0; i < count; i++)
        trace(frame, krs_ray(frame->scene, origins[i], directions[i], farthest), tolerance,
              &hits[i]);
    return KRS_OK;
}
