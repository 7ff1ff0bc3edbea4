/*
 * expand.c: copies, cuts, and projections onto convex sets.
 */
#include "tests/oracle/expand.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

Vec isometry_apply(const Isometry *map, Vec p)
{
    Vec turned = vec(vec_dot(map->rows[0], p), vec_dot(map->rows[1], p), vec_dot(map->rows[2], p));
    return vec_add(turned, map->shift);
}

static Vec half_mirror(Half half, Vec p)
{
    return vec_sub(p, vec_scale(2 * half_excess(half, p), half.normal));
}

/* `map` followed by the mirror. */
static Isometry isometry_then_mirror(const Isometry *map, Half mirror)
{
    Vec axes[3] = {vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)}, columns[3];
    Vec shift   = half_mirror(mirror, map->shift);
    for (int i = 0; i < 3; i++) {
        Vec image  = isometry_apply(map, axes[i]);
        columns[i] = vec_sub(half_mirror(mirror, image), shift);
    }
    return (Isometry){{vec(columns[0].x, columns[1].x, columns[2].x),
                       vec(columns[0].y, columns[1].y, columns[2].y),
                       vec(columns[0].z, columns[1].z, columns[2].z)},
                      shift};
}

/* Returns the half-space of all x whose mirror image is in `half`. */
static Half half_behind_mirror(Half half, Half mirror)
{
    Vec origin = half_mirror(mirror, vec(0, 0, 0));
    Vec normal = vec_sub(half_mirror(mirror, half.normal), origin);
    return (Half){normal, half.offset - vec_dot(half.normal, origin)};
}

/* Returns the nearest point of a body that is made thinner by `shrink`. */
static Vec body_project(const Body *body, double shrink, Vec p)
{
    if (body->box) {
        Vec q = vec_rotate(vec_sub(p, body->from), body->axis, -body->angle);
        Vec s = vec_sub(body->sides, vec(shrink, shrink, shrink));
        q = vec(fmax(-s.x, fmin(q.x, s.x)), fmax(-s.y, fmin(q.y, s.y)), fmax(-s.z, fmin(q.z, s.z)));
        return vec_add(body->from, vec_rotate(q, body->axis, body->angle));
    }
    Vec    along  = vec_sub(body->to, body->from);
    double square = vec_dot(along, along), t = 0;
    if (square > 0)
        t = fmax(0, fmin(vec_dot(vec_sub(p, body->from), along) / square, 1));
    Vec    spine    = vec_mix(body->from, body->to, t);
    double distance = vec_distance(p, spine), radius = body->radius - shrink;
    return distance <= radius ? p : vec_mix(spine, p, radius / distance);
}

static double body_thickness(const Body *body)
{
    return body->box ? fmin(body->sides.x, fmin(body->sides.y, body->sides.z)) : body->radius;
}

static Vec body_middle(const Body *body)
{
    return body->box ? body->from : vec_mix(body->from, body->to, 0.5);
}

/* No point of the body is farther from its middle. */
static double body_reach(const Body *body)
{
    double reach = body->box ? vec_length(body->sides)
                             : vec_distance(body->from, body->to) / 2 + body->radius;
    return reach * (1 + 1e-9) + 1e-9;
}

/* Returns the point that an isometry takes to `point`. */
static Vec isometry_undo(const Isometry *map, Vec point)
{
    Vec at  = vec_sub(point, map->shift);
    Vec sum = vec_add(vec_scale(at.x, map->rows[0]), vec_scale(at.y, map->rows[1]));
    return vec_add(sum, vec_scale(at.z, map->rows[2]));
}

/* Tells whether one cut takes all of the body away. */
static bool copy_is_cut_off(const Copy *copy)
{
    for (int i = 0; i < copy->cut_count; i++)
        if (half_excess(copy->cuts[i], body_middle(copy->body)) > copy->reach)
            return true;
    return false;
}

/* Returns how far the point is from satisfying the worst of the body and the cuts; `worst` is where
   it would have to go. */
static double copy_violation(const Copy *copy, double margin, Vec p, Vec *better)
{
    Vec    q     = body_project(copy->body, margin, p);
    double worst = vec_distance(p, q);
    *better      = q;
    for (int i = 0; i < copy->cut_count; i++) {
        double excess = half_excess(copy->cuts[i], p) + margin;
        if (excess > worst) {
            worst   = excess;
            *better = vec_sub(p, vec_scale(excess, copy->cuts[i].normal));
        }
    }
    return worst;
}

/* Looks for a point that is inside everything by some margin: always towards the worst. */
static void copy_find_interior(Copy *copy)
{
    for (int halvings = 1; halvings <= 6; halvings++) {
        double margin = body_thickness(copy->body) * pow(0.5, halvings);
        Vec    p      = copy->body->from, better;
        for (int step = 0; step < 100; step++) {
            if (copy_violation(copy, margin, p, &better) < margin / 2) {
                copy->interior = p;
                return;
            }
            p = better;
        }
    }
    copy->empty = true;
}

static void add_copies(const Sequence *sequence, Expansion *expansion, const Copy *place, int level)
{
    for (int i = 0; i < sequence->body_count; i++)
        if (sequence->bodies[i].level == level) {
            Copy *copy   = &expansion->copies[expansion->count++];
            *copy        = *place;
            copy->body   = &sequence->bodies[i];
            copy->middle = isometry_undo(&copy->pull, body_middle(copy->body));
            copy->reach  = body_reach(copy->body);
            copy->empty  = copy_is_cut_off(copy);
            if (!copy->empty)
                copy_find_interior(copy);
        }
    if (level == 0)
        return;

    Half mirror = sequence->mirrors[level - 1];
    for (uint32_t bit = 0; bit < 2; bit++) {
        Copy inner = *place;
        inner.id   = 2 * place->id + bit;
        if (bit) {
            inner.pull = isometry_then_mirror(&place->pull, mirror);
            for (int i = 0; i < inner.cut_count; i++)
                inner.cuts[i] = half_behind_mirror(place->cuts[i], mirror);
        }
        inner.cuts[inner.cut_count++] = mirror;
        add_copies(sequence, expansion, &inner, level - 1);
    }
}

Expansion expand(const Sequence *sequence)
{
    size_t total = 1; /* never an empty block */
    for (int i = 0; i < sequence->body_count; i++)
        total += (size_t)1 << (sequence->mirror_count - sequence->bodies[i].level);
    Expansion expansion = {calloc(total, sizeof(Copy)), 0};
    if (!expansion.copies) {
        fprintf(stderr, "no memory for %zu copies\n", total);
        exit(EXIT_FAILURE);
    }
    Copy world         = {.id = 1};
    world.pull.rows[0] = vec(1, 0, 0);
    world.pull.rows[1] = vec(0, 1, 0);
    world.pull.rows[2] = vec(0, 0, 1);
    add_copies(sequence, &expansion, &world, sequence->mirror_count);
    return expansion;
}

void expansion_free(Expansion *expansion)
{
    free(expansion->copies);
    *expansion = (Expansion){0};
}

static bool copy_keeps(const Copy *copy, Vec q, double slack)
{
    for (int i = 0; i < copy->cut_count; i++)
        if (half_excess(copy->cuts[i], q) > slack)
            return false;
    return true;
}

/* Tells whether all of a copy is farther from a point than `distance`. */
static bool is_outside(const Copy *copy, Vec point, double distance)
{
    Vec    offset = vec_sub(point, copy->middle);
    double more   = copy->reach + distance;
    return vec_dot(offset, offset) > more * more;
}

bool expansion_contains(const Expansion *expansion, Vec point)
{
    for (size_t i = 0; i < expansion->count; i++) {
        const Copy *copy = &expansion->copies[i];
        if (is_outside(copy, point, 0))
            continue;
        Vec q = isometry_apply(&copy->pull, point);
        if (vec_distance(q, body_project(copy->body, 0, q)) <= 1e-12 && copy_keeps(copy, q, 1e-12))
            return true;
    }
    return false;
}

double copy_distance_uncut(const Copy *copy, Vec point, bool *survives)
{
    Vec q     = isometry_apply(&copy->pull, point);
    Vec foot  = body_project(copy->body, 0, q);
    *survives = copy_keeps(copy, foot, 1e-12);
    return vec_distance(q, foot);
}

/* The least share of the way to the interior point that brings `p` inside everything. */
static Vec move_inside(const Copy *copy, Vec p)
{
    Vec    better;
    double low = 0, high = 1;
    if (copy_violation(copy, 0, p, &better) <= 0)
        return p;
    for (int i = 0; i < 60; i++) {
        double t = (low + high) / 2;
        if (copy_violation(copy, 0, vec_mix(p, copy->interior, t), &better) <= 1e-13)
            high = t;
        else
            low = t;
    }
    return vec_mix(p, copy->interior, high);
}

/* Dykstra's projection onto an intersection of convex sets; the result, moved inside, is a
   point of the copy, so its distance is never below the true one. */
static double copy_distance(const Copy *copy, Vec point)
{
    Vec q = isometry_apply(&copy->pull, point), p = q, correction[EXPAND_MIRRORS + 1] = {{0}};
    for (int turn = 0; turn < 400; turn++) {
        Vec start = p;
        for (int i = 0; i <= copy->cut_count; i++) {
            Vec from = vec_add(p, correction[i]);
            if (i == copy->cut_count) {
                p = body_project(copy->body, 0, from);
            } else {
                double excess = fmax(half_excess(copy->cuts[i], from), 0);
                p             = vec_sub(from, vec_scale(excess, copy->cuts[i].normal));
            }
            correction[i] = vec_sub(from, p);
        }
        if (vec_distance(p, start) < 1e-12)
            break;
    }
    return vec_distance(q, move_inside(copy, p));
}

double expansion_distance(const Expansion *expansion, Vec point, bool *sure)
{
    double best = HUGE_VAL;
    *sure       = true;
    for (size_t i = 0; i < expansion->count; i++) {
        bool survives;
        if (is_outside(&expansion->copies[i], point, best))
            continue;
        double distance = copy_distance_uncut(&expansion->copies[i], point, &survives);
        if (survives)
            best = fmin(best, distance);
    }
    for (size_t i = 0; i < expansion->count; i++) {
        const Copy *copy = &expansion->copies[i];
        bool        survives;
        if (is_outside(copy, point, best))
            continue;
        double distance = copy_distance_uncut(copy, point, &survives);
        if (survives || distance >= best)
            continue;
        *sure = false;
        if (!copy->empty)
            best = fmin(best, copy_distance(copy, point));
    }
    return best;
}

/* Narrows [*enter, *leave] to where origin.x + t slope <= limit. */
static void clip_below(double origin, double slope, double limit, double *enter, double *leave)
{
    if (slope == 0) {
        if (origin > limit)
            *enter = HUGE_VAL;
    } else if (slope > 0) {
        *leave = fmin(*leave, (limit - origin) / slope);
    } else {
        *enter = fmax(*enter, (limit - origin) / slope);
    }
}

static void clip_body(const Body *body, Vec origin, Vec direction, double *enter, double *leave)
{
    Vec o = vec_sub(origin, body->from);
    if (body->box) {
        Vec    a = vec_rotate(o, body->axis, -body->angle);
        Vec    d = vec_rotate(direction, body->axis, -body->angle), s = body->sides;
        double from[3] = {a.x, a.y, a.z}, slope[3] = {d.x, d.y, d.z}, side[3] = {s.x, s.y, s.z};
        for (int i = 0; i < 3; i++) {
            clip_below(from[i], slope[i], side[i], enter, leave);
            clip_below(-from[i], -slope[i], side[i], enter, leave);
        }
        return;
    }
    assert(vec_distance(body->from, body->to) == 0);
    double half_b = vec_dot(o, direction);
    Vec    across = vec_sub(o, vec_scale(half_b, direction));
    double square = body->radius * body->radius - vec_dot(across, across);
    double chord  = square > 0 ? sqrt(square) : 0;
    *enter        = square > 0 ? fmax(*enter, -half_b - chord) : HUGE_VAL;
    *leave        = fmin(*leave, -half_b + chord);
}

double expansion_enter(const Expansion *expansion, Vec origin, Vec direction)
{
    double best = HUGE_VAL;
    for (size_t i = 0; i < expansion->count; i++) {
        const Copy *copy  = &expansion->copies[i];
        Vec         o     = isometry_apply(&copy->pull, origin);
        Vec         tip   = isometry_apply(&copy->pull, vec_add(origin, direction));
        Vec         d     = vec_unit(vec_sub(tip, o));
        double      enter = 0, leave = HUGE_VAL;
        clip_body(copy->body, o, d, &enter, &leave);
        for (int k = 0; k < copy->cut_count; k++)
            clip_below(vec_dot(copy->cuts[k].normal, o), vec_dot(copy->cuts[k].normal, d),
                       copy->cuts[k].offset, &enter, &leave);
        if (enter <= leave)
            best = fmin(best, enter);
    }
    return best;
}
