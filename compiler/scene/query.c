/*
 * query.c: queries in double precision: what is known at a point, and where a ray ends.
 *
 * Queries on the device (runtime/tracer/query.c) follow the same rules in single precision.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/base/vec.h"
#include "compiler/graph/lanes/lanes.h"
#include "compiler/scene/points.h"
#include "compiler/scene/program.h"

static bool are_finite(const double (*vectors)[3], size_t count)
{
    if (!vectors)
        return count == 0;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(vectors[i][0]) || !isfinite(vectors[i][1]) || !isfinite(vectors[i][2]))
            return false;
    return true;
}

/* ---- points ---- */

/* Returns the largest depth of a point in a zone of the scene, whose value is in state->values, or
   of the caller; negative outside. */
static double zone_depth(const KrsState *state, const double point[3])
{
    Node   zone  = zone_root(state->scene);
    double depth = zone == NODE_NONE ? -INFINITY : state->values[zone].v[0];
    for (size_t i = 0; i < state->zone_count; i++) {
        const double *at = state->zones[i];
        depth            = fmax(depth, at[3] - distance3(point, at));
    }
    return depth;
}

/* Returns the least distance of all components by a tape of them, cut by the zones. *nearest is the
   number from 1 of that component, whether or not a zone cuts it. */
static double distance_by(KrsState *state, const Tape *tape, const double point[3],
                          uint32_t *nearest)
{
    const KrsScene *scene = state->scene;
    double          least = INFINITY;
    tape_run_point(tape, point, state->values);
    for (size_t i = 0; i < scene->component_count; i++) {
        double distance = state->values[distance_root(&scene->roots, i)].v[0];
        if (distance < least || i == 0) {
            least    = distance;
            *nearest = (uint32_t)i + 1;
        }
    }
    double depth = zone_depth(state, point);
    return least < depth ? depth : least;
}

static double distance_at(KrsState *state, const double point[3], uint32_t *nearest)
{
    return distance_by(state, &state->tapes.distance, point, nearest);
}

uint32_t state_nearest_component(KrsState *state, const double point[3])
{
    uint32_t nearest = 0;
    distance_at(state, point, &nearest);
    return nearest;
}

/* Returns the tape of a march: far from surfaces, short steps cost less than exact ones. */
static Tape march_tape(const KrsState *state, const Tape *tape)
{
    Tape march     = *tape;
    march.by_cells = !state->exact;
    return march;
}

/* Returns how far a ray may go from a point, in a scene with open surfaces.  `step` is the length
   from the previous point to it. */
static double step_ahead(KrsState *state, const double point[3], const double direction[3],
                         double step)
{
    const KrsScene *scene = state->scene;
    const Node     *exact = roots_of(&scene->roots, ROOTS_ALONG).items;
    Tape            ahead = march_tape(state, &state->tapes.ahead);
    double          least = INFINITY;
    tape_run_surface(&ahead, point, direction, step, state->values);
    for (size_t i = 0; i < scene->component_count; i++)
        least = fmin(least, state->values[exact[i]].v[0]);
    return fmax(least, zone_depth(state, point));
}

/* Returns a bound for the distance that costs less: far levels of sequences are skipped
   (lower_guarded). */
static double clearance_at(KrsState *state, const double point[3])
{
    const KrsScene *scene   = state->scene;
    RootRange       roots   = roots_of(&scene->roots, ROOTS_GUARDED);
    Tape            guarded = march_tape(state, &state->tapes.guarded);
    double          least   = INFINITY;
    tape_run_point(&guarded, point, state->values);
    for (size_t i = 0; i < roots.count; i++)
        least = fmin(least, state->values[roots.items[i]].v[0]);
    return fmax(least, zone_depth(state, point));
}

/* Tells whether questions are answered in many points at once. */
static bool by_lanes(const KrsState *state, size_t count)
{
    return count >= FEWEST_POINTS && state->scene->component_count > 0;
}

static KrsStatus find_distances(KrsState *state, const double (*points)[3], size_t count,
                                bool bound, double *distances)
{
    uint32_t nearest = 0;
    Tape     tape    = state->tapes.distance;
    tape.by_cells    = bound;
    if (!are_finite(points, count))
        return KRS_BAD_ARGUMENT;
    state_refresh_points(state);
    if (by_lanes(state, count))
        return points_distances(state, points, count, bound, distances);
    for (size_t i = 0; i < count; i++)
        distances[i] = distance_by(state, &tape, points[i], &nearest);
    return KRS_OK;
}

KrsStatus krs_distance_bound(KrsState *state, const double (*points)[3], size_t count,
                             double *distances)
{
    return find_distances(state, points, count, true, distances);
}

KrsStatus krs_distance(KrsState *state, const double (*points)[3], size_t count, double *distances)
{
    return find_distances(state, points, count, false, distances);
}

/* Finds a normal by derivatives, in scenes with open surfaces: differences would mix both sides of
   an open surface.  False if there is no derivative. */
static bool derived_normal(KrsState *state, const double point[3], double normal[3])
{
    const KrsScene *scene   = state->scene;
    uint32_t        nearest = 0;
    if (!scene->program.open_surfaces ||
        distance_at(state, point, &nearest) <= zone_depth(state, point))
        return false;
    Node gradient = gradient_roots(&scene->roots, nearest - 1)->gradient;
    if (scene->graph->items[gradient].type != TYPE_VEC3)
        return false;
    tape_run_point(&state->tapes.gradients, point, state->values);
    state_copy(state, gradient, normal);
    bool known = largest3(normal) > 0 && largest3(normal) < INFINITY;
    if (known)
        vector_normalize(normal);
    return known;
}

/* Finds a normal by central differences, whose error is negligible in double precision. */
static void normal_at(KrsState *state, const double point[3], double normal[3])
{
    double   step = 1e-6 * (1 + largest3(point));
    uint32_t nearest;
    if (derived_normal(state, point, normal))
        return;
    for (int i = 0; i < 3; i++) {
        double before[3] = {point[0], point[1], point[2]};
        double after[3]  = {point[0], point[1], point[2]};
        before[i] -= step;
        after[i] += step;
        normal[i] = distance_at(state, after, &nearest) - distance_at(state, before, &nearest);
    }
    double length = length3(normal);
    for (int i = 0; i < 3; i++)
        normal[i] = length > 1e-3 * step ? normal[i] / length : 0;
}

KrsStatus krs_normal(KrsState *state, const double (*points)[3], size_t count, double (*normals)[3])
{
    if (!are_finite(points, count))
        return KRS_BAD_ARGUMENT;
    state_refresh_points(state);
    if (by_lanes(state, count) && !state->scene->program.open_surfaces)
        return points_normals(state, points, count, normals);
    for (size_t i = 0; i < count; i++)
        normal_at(state, points[i], normals[i]);
    return KRS_OK;
}

/* Copies a property of the material at a point.  If queries limit it to its range, NaN becomes the
   lower limit. */
static void copy_property(const KrsState *state, const Node *roots, ComponentRoot root, double *to)
{
    const RootInfo *info = &root_info[root];
    for (int k = 0; k < (info->type == TYPE_VEC3 ? 3 : 1); k++) {
        double number = state->values[roots[root]].v[k];
        to[k] = !info->limited ? number : number > info->low ? fmin(number, info->high) : info->low;
    }
}

/* Puts what is known of the surface of a component into an answer: its roots are in state->values. */
static void copy_surface(const KrsState *state, uint32_t nearest, KrsHit *hit)
{
    const Node *root = surface_roots(&state->scene->roots, nearest - 1);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    copy_property(state, root, ROOT_##name, (double *)&hit->name);
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) \
    hit->name = (uint32_t)state->values[root[ROOT_##name]].v[0];
#include "krs/surface.def"
    /* Mirrors do not smooth the surface of a zone. */
    if (hit->distance > state->values[root[ROOT_DISTANCE]].v[0])
        memcpy(hit->shading, hit->normal, sizeof hit->shading);
    else
        state_copy(state, root[ROOT_NORMAL], hit->shading);
}

static KrsHit hit_at(const double point[3])
{
    KrsHit hit = {.hit = true};
    memcpy(hit.point, point, sizeof hit.point);
    return hit;
}

/* Flips a normal that does not face against the direction of a ray. */
static void face(const double view[3], double normal[3])
{
    bool flipped = dot3(view, normal) > 0;
    for (int k = 0; k < 3 && flipped; k++)
        normal[k] = -normal[k];
}

/* Probes a point; `view` is the direction of the ray that sees it, or NULL.  Materials of open
   surfaces have the normal that faces it. */
static void probe(KrsState *state, const double point[3], const double view[3], KrsHit *hit)
{
    uint32_t nearest = 0;
    *hit             = hit_at(point);
    normal_at(state, point, hit->normal);
    if (view && state->scene->program.open_surfaces)
        face(view, hit->normal);
    hit->distance = distance_at(state, point, &nearest);
    if (!nearest)
        return;
    tape_run_seen(&state->tapes.surface, point, hit->normal, view, state->values);
    copy_surface(state, nearest, hit);
}

/* Probes as many points as there are lanes. */
static KrsStatus probe_lanes(KrsState *state, const double (*points)[3], size_t count,
                             bool with_normals, KrsHit *hits)
{
    double    normals[LANES][3] = {{0}}, distances[LANES];
    uint32_t  nearest[LANES];
    KrsStatus status = with_normals ? krs_normal(state, points, count, normals) : KRS_OK;
    if (status != KRS_OK || !state_lanes(state))
        return KRS_OUT_OF_MEMORY;
    points_look(state, points, (const double(*)[3])normals, count, distances, nearest);
    for (size_t i = 0; i < count; i++) {
        hits[i]          = hit_at(points[i]);
        hits[i].distance = distances[i];
        memcpy(hits[i].normal, normals[i], sizeof normals[i]);
        points_surface(state, i, nearest[i]);
        copy_surface(state, nearest[i], &hits[i]);
    }
    return KRS_OK;
}

KrsStatus krs_probe(KrsState *state, const double (*points)[3], size_t count, KrsHit *hits)
{
    return state_probe(state, points, count, true, hits);
}

KrsStatus state_probe(KrsState *state, const double (*points)[3], size_t count, bool normals,
                      KrsHit *hits)
{
    if (!are_finite(points, count))
        return KRS_BAD_ARGUMENT;
    state_refresh_points(state);
    KrsStatus status = KRS_OK;
    size_t    i      = 0;
    for (size_t now; by_lanes(state, count - i) && status == KRS_OK; i += now) {
        now    = count - i < LANES ? count - i : LANES;
        status = probe_lanes(state, points + i, now, normals, hits + i);
    }
    for (; i < count && status == KRS_OK; i++)
        probe(state, points[i], NULL, &hits[i]);
    return status;
}

/* ---- rays ---- */

/* Clips a ray to the range of a box along one axis, enlarged by possible rounding errors. */
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
    KrsRay            ray     = {.end = NOWHERE};
    memcpy(ray.origin, origin, sizeof ray.origin);
    memcpy(ray.direction, direction, sizeof ray.direction);
    vector_normalize(ray.direction);
    for (int k = 0; k < 3; k++)
        clip_axis(program->low[k], program->high[k], origin[k], ray.direction[k], &ray);
    ray.walls = ray.end <= farthest && ray.end < NOWHERE;
    ray.end   = fmin(ray.end, farthest);
    return ray;
}

bool krs_rays_are_valid(const double (*origins)[3], const double (*directions)[3], size_t count,
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

typedef enum RayPhase { MARCHING, HIT, MISS } RayPhase;

enum { TOUCHING = 16 }; /* largest gap between solids that touch, in rounding errors */

/* A ray that is marched.  There is no surface before `t`, nor within `clearance` behind it.  The
   distance is evaluated next at t + step. */
typedef struct RayMarch {
    KrsState *state;
    KrsRay    ray;
    double    size; /* largest coordinate of the origin, to which rounding errors are relative */
    double    tolerance;
    double    side; /* 1: the ray begins outside; -1: inside of a solid; 0: not yet known */
    double    t, clearance, step;
    double    slope; /* moving average of the change of clearance per length of ray */
    RayPhase  phase;
} RayMarch;

static void march_point(const RayMarch *march, double t, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = march->ray.origin[k] + t * march->ray.direction[k];
}

static double rounding_at(const RayMarch *march, double t)
{
    return 4 * DBL_EPSILON * (march->size + t);
}

/* Returns the clearance at a point of the ray that has this distance.  Solids that touch count as
   one solid.  So for a ray from inside they are enlarged by the gap that rounding may leave between
   them. */
static double clearance_of(RayMarch *march, double t, double distance)
{
    if (march->side == 0)
        march->side = distance < 0 ? -1 : 1;
    return march->side < 0 ? TOUCHING * rounding_at(march, t) - distance : distance;
}

static double march_clearance(RayMarch *march, double t)
{
    double point[3];
    march_point(march, t, point);
    bool open_surfaces = march->state->scene->program.open_surfaces;
    /* Back to the previous point and a little farther, since rounding may put that point before a
       open surface in one evaluation and behind it in the next. */
    double back     = t > march->t ? t - march->t + 2 * rounding_at(march, t) : 0;
    double distance = open_surfaces ? step_ahead(march->state, point, march->ray.direction, back)
                                    : clearance_at(march->state, point);
    return clearance_of(march, t, distance);
}

/* Returns the t where the ray crosses the surface, between t, where the clearance is positive, and
   t + step, where it is `clearance` and not positive.  It is found by the Illinois method: false
   position, where the value at one end is halved when the other end has moved twice. */
static double find_crossing(RayMarch *march, double clearance)
{
    enum { MAX_ROUNDS = 100 };
    double low = march->t, high = march->t + march->step;
    double at_low = march->clearance, at_high = clearance;
    double enough = fmax(rounding_at(march, high), march->tolerance / 16);
    int    moved  = 0;
    for (int i = 0; i < MAX_ROUNDS && at_high < 0 && at_low > 0 && high - low > enough; i++) {
        double t    = low + (high - low) * at_low / (at_low - at_high);
        t           = fmin(fmax(t, low + 0.25 * enough), high - 0.25 * enough);
        double at_t = march_clearance(march, t);
        if (at_t > 0) {
            low    = t;
            at_low = at_t;
            at_high *= moved > 0 ? 0.5 : 1;
            moved = 1;
        } else {
            high    = t;
            at_high = at_t;
            at_low *= moved < 0 ? 0.5 : 1;
            moved = -1;
        }
    }
    return high;
}

/*
 * Takes one step, by the rule of trace.comp, to where the clearance is this.  The empty balls
 * around t and around t + step must meet; the length between them is unverified.  If it is more
 * than a sixteenth of the tolerance, the step is shortened to the middle of it.  So steps may be
 * longer than the clearance (automatic relaxation): as long as the balls meet if the clearance goes
 * on changing as before.
 */
static RayPhase march_step(RayMarch *march, double clearance)
{
    double at    = march->t + march->step;
    double least = rounding_at(march, at), permitted = march->tolerance / 16 + least;
    double unverified = march->step - march->clearance;
    if (clearance <= 0 && unverified <= march->tolerance + permitted) {
        march->t    = find_crossing(march, clearance);
        march->step = 0;
        return march->t <= march->ray.end ? HIT : MISS;
    }
    if (clearance > 0 && unverified <= clearance + 1.01 * permitted) {
        double slope = march->step > 0 ? (clearance - march->clearance) / march->step : -1;
        march->slope += 0.3 * (slope - march->slope);
        march->t         = at;
        march->clearance = clearance;
        /* The clearance is known only in the direction of the ray if there are open surfaces: there
           is no ball that reaches backwards. */
        double factor = march->state->scene->program.open_surfaces
                            ? 1
                            : fmax(1, 2 / (1 - fmin(march->slope, 0.98)));
        march->step   = clearance * factor + permitted;
        return at + clearance > march->ray.end ? MISS : MARCHING;
    }
    march->step  = fmax(0.5 * (march->step + march->clearance - fmax(clearance, 0)),
                        march->clearance + permitted);
    march->slope = -1;
    return MARCHING;
}

static RayMarch begin_march(KrsState *state, KrsRay ray, double tolerance)
{
    return (RayMarch){.state     = state,
                      .ray       = ray,
                      .size      = largest3(ray.origin),
                      .tolerance = tolerance > 0 ? tolerance : 1e-9,
                      .side      = ray.start > 0 ? 1 : 0,
                      .t         = ray.start,
                      .slope     = -1,
                      .phase     = ray.start <= ray.end ? MARCHING : MISS};
}

/* Ends a march; nothing is asked of the place where a ray remains that may run no more. */
static void end_march(RayMarch *march, RayLimits limits, KrsHit *hit)
{
    double point[3];
    *hit = (KrsHit){0};
    if (march->phase == MISS && march->side < 0 && march->ray.walls) {
        march->t     = march->ray.end;
        march->phase = HIT;
    }
    if (march->phase == MISS)
        return;
    march_point(march, march->t, point);
    if (march->phase == HIT || march->state->ran < limits.ran)
        probe(march->state, point, march->ray.direction, hit);
    hit->t          = march->t;
    hit->hit        = march->phase == HIT;
    hit->unresolved = march->phase == MARCHING;
}

/* Tells whether clearances of rays are distances, which lanes tell.  Open surfaces have other ones, and guards and
   cells of instance groups make them shorter. */
static bool march_by_lanes(const KrsState *state)
{
    const KrsScene *scene   = state->scene;
    const Node     *guarded = roots_of(&scene->roots, ROOTS_GUARDED).items;
    bool lanes = !scene->program.open_surfaces && state->tapes.distance.function_count == 0;
    for (size_t i = 0; i < scene->component_count && lanes; i++)
        lanes = guarded[i] == distance_root(&scene->roots, i);
    return lanes;
}

/* Takes the next step of each of some rays that are not at their end. */
static KrsStatus step_fused(KrsState *state, RayMarch *const *marches, size_t count)
{
    double points[LANES][3], distances[LANES];
    for (size_t i = 0; i < count; i++)
        march_point(marches[i], marches[i]->t + marches[i]->step, points[i]);
    KrsStatus status = points_distances(state, (const double(*)[3])points, count, false, distances);
    state->ran += state->tapes.distance.count - state->tapes.distance.frame_count;
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        marches[i]->phase = march_step(
            marches[i], clearance_of(marches[i], marches[i]->t + marches[i]->step, distances[i]));
    return status;
}

/* Marches up to LANES rays side by side: their answers are those of each by itself. */
static KrsStatus march_fused(KrsState *state, RayMarch *rays, size_t count, RayLimits limits)
{
    RayMarch *marches[LANES];
    KrsStatus status = KRS_OK;
    for (size_t step = 0; step < limits.steps && state->ran < limits.ran && status == KRS_OK;
         step++) {
        size_t left = 0;
        for (size_t i = 0; i < count; i++)
            if (rays[i].phase == MARCHING)
                marches[left++] = &rays[i];
        if (left == 0)
            break;
        status = step_fused(state, marches, left);
    }
    return status;
}

static void march_alone(RayMarch *ray, RayLimits limits)
{
    for (size_t step = 0; step < limits.steps && ray->state->ran < limits.ran; step++) {
        if (ray->phase != MARCHING)
            break;
        ray->phase = march_step(ray, march_clearance(ray, ray->t + ray->step));
    }
}

/* Casts up to LANES rays. */
static KrsStatus raycast(KrsState *state, RayMarch *rays, size_t count, bool fused,
                         RayLimits limits, KrsHit *hits)
{
    KrsStatus status = fused ? march_fused(state, rays, count, limits) : KRS_OK;
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        if (!fused)
            march_alone(&rays[i], limits);
        end_march(&rays[i], limits, &hits[i]);
    }
    return status;
}

KrsStatus state_raycast(KrsState *state, const double (*origins)[3], const double (*directions)[3],
                        size_t count, double farthest, double tolerance, RayLimits limits,
                        KrsHit *hits)
{
    if (!krs_rays_are_valid(origins, directions, count, farthest, tolerance))
        return KRS_BAD_ARGUMENT;
    state_refresh_points(state);
    const bool lanes  = march_by_lanes(state);
    KrsStatus  status = KRS_OK;
    for (size_t begin = 0, now; begin < count && status == KRS_OK; begin += now) {
        RayMarch rays[LANES];
        now = count - begin < LANES ? count - begin : LANES;
        for (size_t i = 0; i < now; i++)
            rays[i] = begin_march(
                state, krs_ray(state->scene, origins[begin + i], directions[begin + i], farthest),
                tolerance);
        status = raycast(state, rays, now, lanes && by_lanes(state, now), limits, hits + begin);
    }
    return status;
}

KrsStatus krs_raycast(KrsState *state, const double (*origins)[3], const double (*directions)[3],
                      size_t count, double farthest, double tolerance, KrsHit *hits)
{
    return state_raycast(state, origins, directions, count, farthest, tolerance,
                         (RayLimits){KRS_MAX_STEPS, UINT64_MAX}, hits);
}
