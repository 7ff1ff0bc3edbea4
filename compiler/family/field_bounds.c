/*
 * field_bounds.c: which bound on the distance to a field's surface costs rays least.
 *
 * A field f is divided by its slope L over the region C in which it counts.  Where f is much
 * flatter than L almost everywhere, steps are much too short.  A table of slopes by cells would
 * cure that, but a look-up costs as much as 80 to 160 multiply-adds where a load is one a lane,
 * more than most formulas; so these bounds are computed where the ray is:
 *   heads: of a sum whose rest lies within m +- h over C, the whole can be 0 only where |head + m|
 *     is at most h, so (|head + m| - h) / slope of the head is a bound too, longer far away;
 *   second order: the r of |f| = |grad f| r + H r^2 / 2, H the slope of the gradient over C;
 *   local: the same with what f can change near the point alone (graph/symbolic/local.h).
 * All count only zeros in C, from points in C.  The first two are 1-Lipschitz, and so distances as
 * good as f / L: that of second order is, because on the way h to another point the gradient grows
 * by H h at most, so what can change within r there can change within r + h here, less what can
 * within h.  The local one has a trial radius, and serves where nothing above needs the slope.
 *
 * Rays are marched through the region in double precision by each, all at once, and the cheapest is
 * taken.
 */
#include "compiler/family/field_bounds.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/lanes/lanes.h"
#include "compiler/graph/rewrite/simplify.h"
#include "compiler/graph/symbolic/derive.h"
#include "compiler/graph/symbolic/local.h"
#include "compiler/shape/slope.h"

/* The numbers of cells into which a region is cut for slopes: of gradients, which decide how long
   all steps are, and of heads, of which there are many. */
enum { CELLS = 512, HEAD_CELLS = 32 };

/* Keeps quotients finite; below every coefficient that counts in single precision. */
static const double TINY = 1e-30;

/* Returns a slope over a box; inf when there is no bound. */
static double slope_over(ShapeBuilder *builder, Node node, Box box, uint32_t cells)
{
    Node   root  = node;
    Graph *plain = graph_simplify(builder->graph, &root, 1, builder->scratch);
    return graph_slope(plain, root, box, NULL, box_is_finite(box) ? cells : 1, NULL,
                       builder->scratch);
}

/* ---- heads of sums ---- */

enum { MAX_TERMS = 12 };

typedef struct Term {
    Node   node;
    Range  range;
    double slope;
} Term;

typedef struct Terms {
    Graph   *graph;
    uint32_t count;
    Term     items[MAX_TERMS];
} Terms;

/* Looks at no more than *nodes: expressions are shared, and there may be far more ways through one
   than it has nodes. */
static bool has_terms_among(const Graph *g, Node node, uint32_t *nodes)
{
    const Expr *e = &g->items[node];
    if (*nodes == 0)
        return false;
    --*nodes;
    if (e->op == OP_add || e->op == OP_sub)
        return e->type == TYPE_FLOAT;
    if (e->op != OP_neg && e->op != OP_div && e->op != OP_mul)
        return false;
    return has_terms_among(g, e->operands[0], nodes) ||
           (e->op == OP_mul && has_terms_among(g, e->operands[1], nodes));
}

/* Tells whether there are terms below products and signs; one that is not found is no mistake, as a
   product can be a term itself. */
static bool has_terms(const Graph *g, Node node)
{
    uint32_t nodes = 1000;
    return has_terms_among(g, node, &nodes);
}

/* Adds `factor` times an expression, term by term. */
static void add_terms(Terms *terms, Node node, Node factor)
{
    Graph *g = terms->graph;
    Expr   e = g->items[node];
    if (!has_terms(g, node) || terms->count + 2 > MAX_TERMS) {
        if (terms->count < MAX_TERMS)
            terms->items[terms->count].node = mul(g, factor, node);
        terms->count++;
        return;
    }
    Node opposite = neg(g, factor);
    int  inner    = e.op == OP_mul && !has_terms(g, e.operands[0]);
    if (e.op == OP_neg)
        add_terms(terms, e.operands[0], opposite);
    else if (e.op == OP_mul)
        add_terms(terms, e.operands[inner], mul(g, factor, e.operands[1 - inner]));
    else if (e.op == OP_div)
        add_terms(terms, e.operands[0], over(g, factor, e.operands[1]));
    else {
        add_terms(terms, e.operands[0], factor);
        add_terms(terms, e.operands[1], e.op == OP_add ? factor : opposite);
    }
}

static double steepness_for_size(const Term *term)
{
    return term->slope / (term->range.high - term->range.low);
}

/* The steepest for their size come last: those are left out first. */
static void sort_terms(Terms *terms)
{
    for (uint32_t i = 1; i < terms->count; i++)
        for (uint32_t k = i; k > 0; k--) {
            Term *left = &terms->items[k - 1], *right = &terms->items[k];
            if (!(steepness_for_size(left) > steepness_for_size(right)))
                break;
            Term swap = *left;
            *left     = *right;
            *right    = swap;
        }
}

static Terms terms_of(ShapeBuilder *builder, Node formula, Box box)
{
    Terms terms = {.graph = builder->graph};
    add_terms(&terms, formula, graph_number(builder->graph, 1));
    if (terms.count > MAX_TERMS)
        terms.count = 0;
    for (uint32_t i = 0; i < terms.count; i++) {
        Term  *term  = &terms.items[i];
        Node   root  = term->node;
        Graph *plain = graph_simplify(builder->graph, &root, 1, builder->scratch);
        term->range  = graph_facts(plain, box, NULL, builder->scratch)[root].value[0];
        term->slope  = slope_over(builder, term->node, box, 1);
    }
    sort_terms(&terms);
    return terms;
}

/* Returns (|head + m| - h) / slope for a rest in `range` = m +- h; NODE_NONE: the slope has no
   bound.  It is written by the ends of the range, since where one of them is small nothing may
   cancel. */
static Node head_distance(ShapeBuilder *builder, Node head, Range range, Box box)
{
    Graph *g     = builder->graph;
    double slope = slope_over(builder, head, box, HEAD_CELLS);
    if (!isfinite(slope))
        return NODE_NONE;
    Node low   = graph_number(g, range.low - 1e-12 * fabs(range.low));
    Node high  = graph_number(g, range.high + 1e-12 * fabs(range.high));
    Node above = add(g, head, low), below = add(g, head, high);
    Node size = graph_op2(g, OP_max, above, neg(g, below));
    return divide_by_slope(g, size, slope);
}

/* Returns the longest by all heads; NODE_NONE: the formula is not such a sum. */
static Node by_heads(ShapeBuilder *builder, Node formula, Box box)
{
    Graph *g     = builder->graph;
    Terms  terms = terms_of(builder, formula, box);
    Node   heads[MAX_TERMS], longest = NODE_NONE;
    Range  rest = {0, 0};
    for (uint32_t i = 0; i < terms.count; i++)
        heads[i] = i == 0 ? terms.items[0].node : add(g, heads[i - 1], terms.items[i].node);
    for (uint32_t i = terms.count; i-- > 1;) {
        rest.low += terms.items[i].range.low;
        rest.high += terms.items[i].range.high;
        if (!isfinite(rest.low) || !isfinite(rest.high))
            break;
        Node distance = head_distance(builder, heads[i - 1], rest, box);
        if (distance != NODE_NONE)
            longest = longest == NODE_NONE ? distance : graph_op2(g, OP_max, longest, distance);
    }
    return longest;
}

/* ---- second order, and local ---- */

static Node by_second_order(ShapeBuilder *builder, Node f, Box box)
{
    Graph *g = builder->graph;
    Node   gradient;
    if (graph_gradient(g, f, &gradient, NULL, builder->scratch) != DERIVED_SMOOTH)
        return NODE_NONE;
    double bend = slope_over(builder, gradient, box, CELLS);
    if (!isfinite(bend))
        return NODE_NONE;
    Node size    = graph_op1(g, OP_abs, f);
    Node steep   = graph_op1(g, OP_length, gradient);
    Node squared = graph_op2(g, OP_dot, gradient, gradient);
    Node margin  = mul(g, size, graph_number(g, 2 * bend));
    Node root    = graph_op1(g, OP_sqrt, add(g, squared, margin));
    Node sum     = at_least(g, add(g, steep, root), TINY);
    Node twice   = mul(g, size, graph_number(g, 2));
    return over(g, twice, sum);
}

static Node by_local_slope(ShapeBuilder *builder, Node f, Box box, double least)
{
    LocalBound local;
    if (!graph_local_bound(builder->graph, f, box, least, &local, builder->scratch))
        return NODE_NONE;
    return local_radius(builder->graph, f, &local);
}

/* ---- rays on trial ---- */

/* Rays through a box, in double precision, at the parameters' defaults. */
typedef struct TrialMarch {
    const Graph     *graph;
    Box              box;
    const NodeValue *parameters;
    double           least; /* step */
    Arena           *scratch;
} TrialMarch;

enum { MARCHED_RAYS = 24, MAX_STEPS = 96 };
/* Longer formulas, in multiply-adds, have no local bounds: one is several times as long. */
enum { MAX_LOCAL = 2048 };

/* A ray on its way. */
typedef struct TrialRay {
    double   from[3], direction[3];
    double   t, radius;    /* where it is, and the distance there */
    double   step, change; /* the step that it tries, and how the distance is expected to change */
    uint32_t count;        /* evaluations */
    bool     retreats;     /* its last step was too long */
} TrialRay;

/* Makes a ray from point to point of Roberts' sequence in six dimensions. */
static TrialRay trial_ray(Box box, uint32_t i)
{
    static const double root   = 1.1347241384015194;
    TrialRay            ray    = {.change = -1};
    double              length = 0, coordinates[6];
    for (int k = 0; k < 6; k++) {
        Range  side    = box.axis[k % 3];
        double t       = fmod(0.5 + (i + 1) * real_pow(root, -(k + 1)), 1);
        coordinates[k] = side.low + t * (side.high - side.low);
    }
    for (int k = 0; k < 3; k++) {
        ray.from[k]      = coordinates[k];
        ray.direction[k] = coordinates[k + 3] - coordinates[k];
        length           = real_hypot(length, ray.direction[k]);
    }
    for (int k = 0; k < 3; k++)
        ray.direction[k] /= length > 0 ? length : 1;
    return ray;
}

/* Tells how far a ray goes through the box. */
static double length_through(Box box, const TrialRay *ray)
{
    double length = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double side = ray->direction[k] > 0 ? box.axis[k].high : box.axis[k].low;
        if (ray->direction[k] != 0)
            length = fmin(length, (side - ray->from[k]) / ray->direction[k]);
    }
    return length;
}

static bool is_on_its_way(const TrialRay *ray)
{
    return ray->count == 0 || ray->retreats || (ray->radius > 0 && ray->count < MAX_STEPS);
}

/* Finds where the step of a ray ends; false: beyond the box. */
static bool step_end(const TrialMarch *m, const TrialRay *ray, double point[3])
{
    bool inside = true;
    for (int k = 0; k < 3; k++) {
        point[k] = ray->from[k] + (ray->t + ray->step) * ray->direction[k];
        inside   = inside && !(point[k] < m->box.axis[k].low || point[k] > m->box.axis[k].high);
    }
    return inside;
}

/* Takes the distance at the end of a step.  As the tracer's, a step is as long as balls of empty
   space around its ends are expected to meet, and is taken back if they do not. */
static void take_distance(const TrialMarch *m, TrialRay *ray, double distance)
{
    double usual = fmax(ray->radius, m->least);
    bool   first = ray->count++ == 0;
    if (!first && !ray->retreats && ray->step > usual && ray->step > ray->radius + fabs(distance)) {
        ray->step     = usual;
        ray->change   = -1;
        ray->retreats = true;
        return;
    }
    if (!first && !ray->retreats)
        ray->change = fmin(0.7 * ray->change + 0.3 * (distance - ray->radius) / ray->step, 0.98);
    ray->t += ray->step;
    ray->radius   = distance;
    ray->retreats = false;
    ray->step     = fmax(fmax(distance, m->least), 2 * distance / (1 - ray->change));
}

/* Moves all rays that are on their way by a step; returns how many were. */
static uint32_t step_rays(const TrialMarch *m, const LaneTape *tape, const LaneWork *work,
                          TrialRay *rays)
{
    double    points[MARCHED_RAYS][3], distances[MARCHED_RAYS];
    TrialRay *asking[MARCHED_RAYS];
    uint32_t  count = 0, stepping = 0;
    for (uint32_t i = 0; i < MARCHED_RAYS; i++) {
        if (!is_on_its_way(&rays[i]))
            continue;
        stepping++;
        if (step_end(m, &rays[i], points[count]))
            asking[count++] = &rays[i];
        else
            take_distance(m, &rays[i], -1);
    }
    lane_run(tape, work, LANE_DOUBLE,
             (LanePoints){.points = (const double(*)[3])points, .count = count}, 0, 1, distances);
    for (uint32_t i = 0; i < count; i++)
        take_distance(m, asking[i], distances[i]);
    return stepping;
}

/* Evaluations of a ray up to the surface or the sides of the box.  When MAX_STEPS did not suffice,
   the others are taken to be as long. */
static double all_evaluations(const TrialMarch *m, const TrialRay *ray)
{
    return ray->radius > 0 ? ray->count * fmax(length_through(m->box, ray) / ray->t, 1)
                           : ray->count;
}

/* A distance that is tried, by itself. */
typedef struct Trial {
    Node   distance;
    Tape   tape;
    double cost; /* multiply-adds of a step */
} Trial;

static Trial trial_new(const TrialMarch *m, Node distance)
{
    const double OVERHEAD = 20; /* of the tracer, a step */
    const Graph *graph    = graph_extract_with_instances(m->graph, &distance, 1, m->scratch);
    Trial        trial    = {distance, tape_new(graph, &distance, 1, m->scratch), OVERHEAD};
    trial.cost += tape_flops(&trial.tape);
    return trial;
}

/* Marches rays by no more than `most` steps together; false: these do not suffice. */
static bool march_rays(const TrialMarch *m, const Trial *trial, double most, TrialRay *rays)
{
    NodeValue *values = arena_new_array(m->scratch, NodeValue, trial->tape.graph->count);
    LaneTape   lanes  = lane_tape_new(&trial->tape, &trial->distance, 1, false, 0, m->scratch);
    LaneWork   work   = lane_work_in(arena_alloc(m->scratch, lane_work_bytes(&lanes), 1), values);
    lanes.scalars     = arena_new_array(m->scratch, double, lanes.scalar_count + 1);
    tape_run_frame(&trial->tape, m->parameters, values);
    lane_tape_scalars(&lanes, values, lanes.scalars);
    for (uint32_t i = 0; i < MARCHED_RAYS; i++)
        rays[i] = trial_ray(m->box, i);
    for (uint32_t count = 0, stepping = 1; stepping > 0; count += stepping) {
        if (count >= most)
            return false;
        stepping = step_rays(m, &lanes, &work, rays);
    }
    return true;
}

/* Returns the multiply-adds of all steps by a distance; infinite if they are `most` or more. */
static double trial_march_cost(const TrialMarch *m, Node distance, double most)
{
    const ArenaMark mark  = arena_mark(m->scratch);
    const Trial     trial = trial_new(m, distance);
    double          steps = 0;
    TrialRay        rays[MARCHED_RAYS];
    if (MARCHED_RAYS * trial.cost < most && march_rays(m, &trial, most / trial.cost, rays))
        for (uint32_t i = 0; i < MARCHED_RAYS; i++)
            steps += all_evaluations(m, &rays[i]);
    else
        steps = HUGE_VAL;
    arena_rewind(m->scratch, mark);
    return steps * trial.cost;
}

/* Returns the multiply-adds of a step. */
static double step_cost(const TrialMarch *m, Node distance)
{
    const ArenaMark mark = arena_mark(m->scratch);
    const double    cost = trial_new(m, distance).cost;
    arena_rewind(m->scratch, mark);
    return cost;
}

static TrialMarch trial_march_new(ShapeBuilder *builder, Box box)
{
    Box        tried      = box_is_finite(box) ? box : (Box){{{-10, 10}, {-10, 10}, {-10, 10}}};
    NodeValue *parameters = arena_new_array(builder->scratch, NodeValue,
                                            builder->graph->parameters.count);
    parameter_defaults(builder->parameters, parameters);
    return (TrialMarch){builder->graph, tried, parameters, 3e-5 * box_diagonal(tried),
                        builder->scratch};
}

/* ---- the choice ---- */

/* Returns the larger of a distance and a bound that knows no sign.  The sign is that of the
   formula, of which single precision may leave nothing in the distance. */
static Node lengthened(Graph *g, Node formula, Node distance, Node bound)
{
    Node size = graph_op2(g, OP_max, graph_op1(g, OP_abs, distance), bound);
    return mul(g, graph_op1(g, OP_sign, formula), size);
}

/* Returns the cheapest of some distances (NODE_NONE: not there), if it is clearly cheaper than the
   one that there is already; *cost follows. */
static Node cheapest(const TrialMarch *march, Node present, const Node *others, int count,
                     double *cost)
{
    const double LEAD  = 0.85;
    Node         best  = present;
    double       least = LEAD * *cost;
    for (int i = 0; i < count; i++) {
        double tried = others[i] == NODE_NONE ? HUGE_VAL
                                              : trial_march_cost(march, others[i], least);
        if (tried >= least)
            continue;
        least = *cost = tried;
        best          = others[i];
    }
    return best;
}

/* Returns the cheapest by local slopes; NODE_NONE: none is cheaper than the bound that there is. */
static Node cheapest_local(ShapeBuilder *builder, const TrialMarch *march, Node formula,
                           Node distance, Box box, double slope, double cost)
{
    /* A local slope may be one of these parts of the slope: fields may be flatter by far where the surface is. */
    static const double fractions[] = {0.25, 0x1p-6, 0x1p-11, 0x1p-17, 0x1p-24, 0x1p-32, 0x1p-42};
    enum { FRACTIONS = sizeof fractions / sizeof *fractions };
    Node sharp[FRACTIONS];
    if (step_cost(march, distance) > MAX_LOCAL)
        return NODE_NONE;
    for (int i = 0; i < FRACTIONS; i++) {
        Node local = by_local_slope(builder, formula, box, slope * fractions[i]);
        sharp[i]   = local == NODE_NONE ? local
                                        : lengthened(builder->graph, formula, distance, local);
    }
    return cheapest(march, NODE_NONE, sharp, FRACTIONS, &cost);
}

FieldBounds field_bounds(ShapeBuilder *builder, Node formula, double slope, Box box, bool uniform)
{
    Graph      *g      = builder->graph;
    TrialMarch  march  = trial_march_new(builder, box);
    FieldBounds bounds = {divide_by_slope(g, formula, slope), NODE_NONE};
    Node   heads = by_heads(builder, formula, box), order = by_second_order(builder, formula, box);
    Node   lipschitz[3] = {NODE_NONE, NODE_NONE, NODE_NONE};
    double cost         = HUGE_VAL;
    if (uniform && order != NODE_NONE)
        bounds.lipschitz = lengthened(g, formula, bounds.lipschitz, order);
    else if (order != NODE_NONE)
        lipschitz[0] = lengthened(g, formula, bounds.lipschitz, order);
    if (heads != NODE_NONE)
        lipschitz[1] = lengthened(g, formula, bounds.lipschitz, heads);
    if (heads != NODE_NONE && lipschitz[0] != NODE_NONE)
        lipschitz[2] = lengthened(g, formula, lipschitz[0], heads);
    cost             = trial_march_cost(&march, bounds.lipschitz, HUGE_VAL);
    bounds.lipschitz = cheapest(&march, bounds.lipschitz, lipschitz, 3, &cost);
    bounds.sharp     = cheapest_local(builder, &march, formula, bounds.lipschitz, box, slope, cost);
    return bounds;
}
