/*
 * search.c: points that refute a distance: from the best of many starts, uphill.
 */
#include "compiler/refute/search.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/splitmix.h"
#include "compiler/base/vec.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/rewrite/simplify.h"
#include "compiler/refute/search_pairs.h"
#include "compiler/refute/search_starts.h"
#include "compiler/refute/search_targets.h"

enum { BATCH = 24, BEST = 4, CLIMB_STEPS = 48 };

/* The box that stands for a side without end, in world units. */
static const double UNBOUNDED = 10;

/* The relative part of what rounding may do. */
static const double RELATIVE = 1e-6;

/* ---- climbing ---- */

/* Returns a pair near another one: both points moved, rotated about p, or nearer and farther. */
static PointPair changed(Search *s, const PointPair *pair)
{
    PointPair next = *pair;
    double    shift[3], length = distance3(pair->p, pair->q), move = any_scale(s, 1e-6);
    random_direction(s, shift);
    switch (search_index(s, 3)) {
    case 0:
        add_scaled3(next.p, next.p, move, shift);
        add_scaled3(next.q, next.q, move, shift);
        break;
    case 1: add_scaled3(next.q, next.q, length * splitmix_unit(&s->random), shift); break;
    default: {
        double factor = real_exp2(search_between(s, -2, 1));
        for (int i = 0; i < 3; i++)
            next.q[i] = next.p[i] + factor * (next.q[i] - next.p[i]);
    }
    }
    return next;
}

static void climb(Search *s, PointPair pair, int steps)
{
    for (int i = 0; i < steps && !is_decided(s); i++) {
        PointPair next = pair;
        if (s->steep && i % 4 == 0) {
            if (halve_pair(s, &next) && next.ratio >= pair.ratio)
                pair = next;
            continue;
        }
        next = changed(s, &pair);
        judge_pair(s, &next);
        if (!s->steep && next.ratio > 0)
            tighten_pair(s, &next);
        if (next.ratio > pair.ratio)
            pair = next;
    }
}

/* ---- the search ---- */

/* Chooses the box and what is next to it, cut where it goes on for ever, and anything for an empty
   one; with guards as far as half the radius of the box, where the outermost begins. */
static void choose_around(Search *search)
{
    Box box = box_is_empty(search->box) ? box_infinite : search->box;
    for (int i = 0; i < 3; i++)
        if (!isfinite(box.axis[i].low) || !isfinite(box.axis[i].high)) {
            box.axis[i].low  = fmax(box.axis[i].low, -UNBOUNDED);
            box.axis[i].high = fmin(box.axis[i].high, UNBOUNDED);
        }
    double outer = search->guards.count > 0 ? 0.3 * box_diagonal(box) : 0;
    for (int i = 0; i < 3; i++) {
        double low = box.axis[i].low, high = box.axis[i].high;
        double margin          = fmax(0.25 * fabs(high - low), outer) + 1e-3;
        search->around.axis[i] = (Range){fmin(low, high) - margin, fmax(low, high) + margin};
    }
    search->size = box_diagonal(search->around);
}

/* Returns the cost of a node.  On the host an instance function looks at more instances than those
   of one cell: from afar, at about as many as a circle of that many dots has at its edge. */
static double node_cost(const Tape *tape, Node node)
{
    const Expr *e     = &tape->graph->items[node];
    double      flops = tape_node_flops(tape, node);
    if (!is_call((Op)e->op))
        return flops;
    const Instances *instances = tape->graph->instances;
    uint32_t         function  = (uint32_t)tape->graph->items[e->operands[0]].number[0];
    uint32_t rows = instances->tables.items[instances->functions.items[function].table_number].rows;
    return flops * (1 + 4 * sqrt(rows));
}

bool search_new(Search *search, const Graph *graph, Node distance, Node side, Box box, Arena *arena)
{
    *search = (Search){.distance = distance, .side = side, .box = box, .aim = {1}, .cost = 1};
    if (graph->items[distance].time != TIME_POINT)
        return false;
    search->tape   = tape_new(graph, (Node[]){distance, side}, 2, arena);
    search->values = arena_new_array(arena, NodeValue, graph->count);
    for (size_t i = search->tape.frame_count; i < search->tape.count; i++) {
        const Expr *e = &graph->items[search->tape.nodes[i]];
        add_targets(search, arena, graph, e);
        search->cost += 1 + (uint64_t)node_cost(&search->tape, search->tape.nodes[i]);
        for (int k = 0; k < e->operand_count; k++) {
            const Expr *of = &graph->items[e->operands[k]];
            if (of->type == TYPE_VEC3 && of->time != TIME_POINT)
                array_push(arena, &search->landmarks, e->operands[k]);
        }
    }
    choose_around(search);
    return isfinite(search->size) && search->size < 1e100;
}

bool search_new_claim(Search *search, Graph *graph, Node a, Node b, Box box, Arena *arena)
{
    Node   roots[3] = {a, b, graph_op2(graph, OP_min, a, b)};
    Graph *simple   = graph_simplify(graph, roots, 3, arena);
    if (!search_new(search, simple, roots[2], roots[2], box, arena))
        return false;
    search->claim = true;
    for (int i = 0; i < 2; i++) { /* what is wrong may be thin, but lies at a surface */
        Target target = {GOAL_ZERO, roots[i], roots[i], roots[i], 0};
        for (int times = 0; times < 4; times++)
            array_push(arena, &search->targets, target);
    }
    return true;
}

bool search_start(Search *search, const NodeValue *parameters)
{
    tape_run_frame(&search->tape, parameters, search->values);
    return tape_frame_infinite(&search->tape, search->values) == NODE_NONE;
}

/* Searches uphill from the best few of a batch of starts. */
static void search_batch(Search *s, uint64_t end)
{
    PointPair best[BEST];
    for (int i = 0; i < BEST; i++)
        best[i].ratio = -1;
    for (int i = 0; i < BATCH && s->spent < end && !is_decided(s); i++) {
        PointPair pair = s->guards.count > 0 && search_index(s, 2) ? best_past_guard(s)
                                                                   : best_pair(s);
        for (int k = 0; k < BEST; k++)
            if (pair.ratio > best[k].ratio) {
                PointPair less = best[k];
                best[k]        = pair;
                pair           = less;
            }
    }
    for (int i = 0; i < BEST && s->spent < end; i++)
        if (best[i].ratio > 0)
            climb(s, best[i], CLIMB_STEPS);
}

void search_run(Search *search, uint64_t operations)
{
    uint64_t end = search->spent + operations;
    while (search->spent < end && !is_decided(search))
        search_batch(search, end);
}

void search_from(Search *search, const double p[3], const double q[3], uint64_t operations)
{
    uint64_t  end = search->spent + operations;
    PointPair pair;
    memcpy(pair.p, p, sizeof pair.p);
    memcpy(pair.q, q, sizeof pair.q);
    judge_pair(search, &pair);
    do
        climb(search, pair, CLIMB_STEPS);
    while (search->spent < end && !is_decided(search));
}

bool search_refuted(const Search *search)
{
    return is_decided(search) || search->worst.ratio > 1 + RELATIVE;
}

bool search_surface(Search *search, const double p[3], double surface[3])
{
    PointPair pair, best = {.ratio = -1};
    double    direction[3];
    memcpy(pair.p, p, sizeof pair.p);
    pair.at_p = distance_at(search, pair.p);
    for (int i = 0; i < 200 && isfinite(pair.at_p); i++) {
        random_direction(search, direction);
        if (i == 0)
            (void)gradient_at(search, p, direction);
        for (int k = 0; k < 3 && i == 0; k++)
            direction[k] *= pair.at_p > 0 ? -1 : 1;
        PointPair candidate = pair;
        if (reach_surface(search, &candidate, direction, 0.999999 * fabs(pair.at_p)) &&
            (best.ratio < 0 || distance3(p, candidate.q) < distance3(p, best.q))) {
            best       = candidate;
            best.ratio = 1;
        }
    }
    memcpy(surface, best.q, 3 * sizeof *surface);
    return best.ratio > 0;
}
