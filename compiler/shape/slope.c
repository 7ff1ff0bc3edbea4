/*
 * slope.c: how fast an expression changes at most, by which its value becomes a distance.
 *
 * A bound that holds for all values of the parameters and of the time is a constant.  Where there
 * is none because they have no limits, as in sin(time * x), the slope is a number of the state:
 * the host finds it by the same rules, at the values of the state, and puts it into a slot of the
 * parameter block.  That is guaranteed only if the slope has a bound at first, at time 0 and the
 * defaults, and at other values tried here; a state that has none is refused when it comes.
 *
 * The slope is a number of the state, too, where that of all states is many times as large: a value
 * that is divided by so much says little about the surface.  Where it meets others, as the sides of a
 * region, these are greater beside the edge, and normals are theirs.
 */
#include "compiler/shape/slope.h"

#include <math.h>
#include <string.h>

#include "compiler/graph/rewrite/simplify.h"

enum { CELLS = 512, FRAME_CELLS = 64, TRIALS = 3, FIRST_TRIALS = 2 };

/* A constant slope may be so many times as large as those of the first states.  Normals beside edges
   are wrong from some thirty on.  Half of the slots are left to expressions that have no constant. */
static const double MAX_EXCESS = 16;
enum { MAX_PREFERRED = MAX_FRAME_SLOPES / 2 };

/* The time, and what is added to parameters without limits.  Numbers of no significance: what is
   bounded there is nowhere unbounded but by accident. */
static const double trial_times[TRIALS] = {0, 1.618, 100.7}, trial_steps[TRIALS] = {0, 0.732, 14.1};

uint32_t state_slope_cells(Box box) { return box_is_finite(box) ? FRAME_CELLS : 1; }

/* Returns a slope; above this, single precision has no room for quotients by it. */
double state_slope_upward(double slope)
{
    const double MOST = 1e30, SLACK = 1 + 0x1p-20; /* parameters are rounded, too */
    if (!(slope <= MOST))
        return HUGE_VAL;
    return slope > 0 ? (double)nextafterf((float)(slope * SLACK), HUGE_VALF) : 0;
}

/* Tells whether some value of the state that the expression needs can be any number. */
static bool needs_the_endless(const Graph *graph, Node root, Arena *scratch)
{
    Tape tape = tape_new(graph, &root, 1, scratch);
    for (size_t i = 0; i < tape.frame_count; i++) {
        const Expr *e = &graph->items[tape.nodes[i]];
        if (e->op != OP_PARAMETER)
            continue;
        const GraphParameter *range = &graph->parameters.items[e->index];
        for (int k = 0; k < (int)e->type; k++)
            if (!isfinite(range->low[k]) || !isfinite(range->high[k]))
                return true;
    }
    return false;
}

/* Gives every parameter that has no limits, or every one, a single value; other ranges stay. */
static void try_values(const Parameters *parameters, Graph *plain, int trial, bool every)
{
    GraphParameter *ranges = plain->parameters.items;
    ranges[0].low[0] = ranges[0].high[0] = trial_times[trial];
    for (size_t i = 0; i < parameters->count; i++) {
        const Parameter *parameter = &parameters->items[i];
        GraphParameter  *range     = &ranges[parameter->slot];
        for (uint32_t k = 0; k < parameter->components; k++) {
            double low = parameter->low[k], high = parameter->high[k];
            if (!every && isfinite(low) && isfinite(high))
                continue;
            double value  = parameter->value[k] + trial_steps[trial];
            range->low[k] = range->high[k] = fmin(fmax(value, low), high);
        }
    }
}

#define CHOICE                                                                                    \
    "a choice may jump from one value to the other; `min`, `max`, `abs` and `clamp` do not, nor " \
    "does `mix(a, b, smoothstep(-0.1, 0.1, x))`"

/* The operations that are steep, with what has a bound instead. */
static const struct {
    Op          op;
    const char *why;
} steep_operations[] = {
    {OP_asin,
     "`asin` is infinitely steep at -1 and 1; `asin(0.99 * sin(a))` is a zigzag that is not"},
    {OP_acos,
     "`acos` is infinitely steep at -1 and 1; `acos(0.99 * cos(a))` is a zigzag that is not"},
    {OP_atan2,
     "an angle changes arbitrarily fast near its axis, where it also jumps; `.repeat_polar` and "
     "`.twist` go about an axis, and `2 * c ^ 2 - 1` is the "
     "cosine of twice the angle, with `c = clamp(x / max(length([x, z]), 0.2), -1, 1)`"},
    {OP_div,
     "a quotient grows without limit where the divisor is near 0; `a / max(b, 0.1)` does not"},
    {OP_sqrt, "a root is infinitely steep at 0; `sqrt(max(a, 0.01))` is not"},
    {OP_inversesqrt, "this grows without limit near 0; `inversesqrt(max(a, 0.01))` does not"},
    {OP_pow, "a power below 1 is infinitely steep at 0; `pow(max(a, 0.01), b)` is not"},
    {OP_log, "a logarithm falls without limit near 0; `log(max(a, 0.1))` does not"},
    {OP_log2, "a logarithm falls without limit near 0; `log2(max(a, 0.1))` does not"},
    {OP_tan, "`tan` has poles; `sin` has none"},
    {OP_floor, "this jumps at whole numbers; `smoothstep` goes from one value to another"},
    {OP_ceil, "this jumps at whole numbers; `smoothstep` goes from one value to another"},
    {OP_round, "this jumps between whole numbers; `smoothstep` goes from one value to another, and "
               "`asin(0.99 * sin(a))` is a zigzag"},
    {OP_fract, "this jumps at whole numbers; `.repeat` makes copies of a shape"},
    {OP_mod, "a remainder jumps; `.repeat` makes copies of a shape"},
    {OP_step, "a step jumps; `smoothstep` goes from 0 to 1 within a width"},
    {OP_sign, "a sign jumps at 0; `clamp(10 * a, -1, 1)` does not"},
    {OP_less, CHOICE},
    {OP_less_equal, CHOICE},
    {OP_select, CHOICE},
};

void explain_steep(ShapeBuilder *builder, Diag *diag, Blame blame)
{
    for (size_t i = 0; i < sizeof steep_operations / sizeof *steep_operations; i++)
        if (steep_operations[i].op == blame.op)
            diag_note(builder->diags, diag, steep_operations[i].why);
}

/* Finds whom to blame.  The first place of equal expressions is known, which may be in the library: then it is
   `otherwise`, which is the author's. */
static Blame blame_of(ShapeBuilder *builder, const Graph *plain, Node node, Span otherwise)
{
    if (node == NODE_NONE)
        return (Blame){.op = OP_COUNT};
    Blame blame = {plain->items[node].span, plain->items[node].op};
    if (blame.span.source == 0 || otherwise.source == 0)
        return blame;
    const Source *sources = builder->diags->sources->items;
    if (sources[blame.span.source].library && !sources[otherwise.source].library)
        blame.span = otherwise;
    return blame;
}

/* Returns the graph with ranges of its own, for try_values. */
static Graph with_own_ranges(const Graph *plain, Arena *scratch)
{
    Graph own            = *plain;
    own.parameters.items = arena_new_array(scratch, GraphParameter, plain->parameters.count);
    memcpy(own.parameters.items, plain->parameters.items,
           plain->parameters.count * sizeof *plain->parameters.items);
    return own;
}

/* Tells whether states have a slope over a region; `found` gets the first one, or whom to blame. */
static bool bounded_in_frames(ShapeBuilder *builder, const Graph *plain, Node root, Box region,
                              Span span, Steepness *found)
{
    Graph tried = with_own_ranges(plain, builder->scratch);
    for (int trial = TRIALS; trial-- > 0;) {
        Node blame = NODE_NONE;
        try_values(builder->parameters, &tried, trial, false);
        found->bound = graph_slope(&tried, root, region, NULL, state_slope_cells(region), &blame,
                                   builder->scratch);
        if (isfinite(found->bound) && (trial > 0 || isfinite(state_slope_upward(found->bound))))
            continue;
        found->blame = blame_of(builder, plain, blame, span);
        found->bound = HUGE_VAL;
        return false;
    }
    return true;
}

static bool same_box(Box a, Box b)
{
    bool same = true;
    for (int i = 0; i < 3; i++)
        same = same && a.axis[i].low == b.axis[i].low && a.axis[i].high == b.axis[i].high;
    return same;
}

/* Returns the slot of the slope of a formula over a region: equal ones have one. */
static Node slope_slot(ShapeBuilder *builder, Node formula, Box region, Span span)
{
    StateSlopes *slopes = builder->slopes;
    for (size_t i = 0; i < slopes->count; i++)
        if (slopes->items[i].formula == formula && same_box(slopes->items[i].region, region))
            return graph_parameter(builder->graph, slopes->items[i].slot, TYPE_FLOAT);
    if (slopes->count == MAX_FRAME_SLOPES && !builder->stopped) {
        Diag *diag       = diag_add(builder->diags, DIAG_LIMIT, span,
                                    "more than %d expressions have a slope of each frame",
                                    MAX_FRAME_SLOPES);
        diag->label      = "this one too changes faster and faster with a `param` or with `time`";
        diag->help       = "give the `param` a range, or use one expression for several shapes";
        builder->stopped = true;
    }
    StateSlope     slope = {(uint32_t)builder->graph->parameters.count, formula, region, span};
    GraphParameter range = {{0}, {HUGE_VAL}};
    array_push(builder->arena, &builder->graph->parameters, range);
    array_push(builder->arena, slopes, slope);
    return graph_parameter(builder->graph, slope.slot, TYPE_FLOAT);
}

/* Tells whether the expression depends on the state by nothing but the time and the author's parameters.
   Cells and iterations have slots as well, but no single value in a state. */
static bool needs_the_frame_alone(const Parameters *parameters, const Graph *plain, Node root,
                                  Arena *scratch)
{
    Tape   tape  = tape_new(plain, &root, 1, scratch);
    size_t known = 0, all = 0;
    for (size_t i = 0; i < tape.frame_count; i++) {
        const Expr *e = &plain->items[tape.nodes[i]];
        if (e->op != OP_PARAMETER)
            continue;
        all++;
        bool found = e->index == 0; /* the time */
        for (size_t k = 0; k < parameters->count && !found; k++)
            found = parameters->items[k].slot == e->index;
        known += found;
    }
    return all > 0 && known == all;
}

/* The slope of the first states: the steepest, and with time 0 and the defaults. */
typedef struct FirstSlopes {
    double most, first;
} FirstSlopes;

static FirstSlopes slopes_at_first(ShapeBuilder *builder, const Graph *plain, Node root, Box region)
{
    FirstSlopes slopes = {0};
    Graph       tried  = with_own_ranges(plain, builder->scratch);
    for (int trial = FIRST_TRIALS; trial-- > 0;) {
        Node blame = NODE_NONE;
        try_values(builder->parameters, &tried, trial, true);
        slopes.first = graph_slope(&tried, root, region, NULL, state_slope_cells(region), &blame,
                                   builder->scratch);
        slopes.most  = fmax(slopes.most, slopes.first);
    }
    return slopes;
}

/* Takes slopes of states where the constant is far above them. */
static void prefer_frames(ShapeBuilder *builder, const Graph *plain, Node root, Node formula,
                          Span span, Steepness *found)
{
    if (found->bound <= MAX_EXCESS || builder->slopes->count >= MAX_PREFERRED ||
        !needs_the_frame_alone(builder->parameters, plain, root, builder->scratch))
        return;
    FirstSlopes slopes = slopes_at_first(builder, plain, root, found->region);
    if (found->bound <= MAX_EXCESS * fmax(slopes.most, 1))
        return;
    found->bound = slopes.first;
    found->slot  = slope_slot(builder, formula, found->region, span);
}

bool find_slope(ShapeBuilder *builder, Node formula, const Box *regions, int count, Span span,
                Steepness *found)
{
    /* Simplified, sqrt(x * x + ...) is a length, whose slope is known. */
    Node   root  = formula;
    Graph *plain = graph_simplify(builder->graph, &root, 1, builder->scratch);
    *found       = (Steepness){.slot = NODE_NONE};
    for (int i = 0; i < count; i++) {
        Node blame    = NODE_NONE;
        found->region = regions[i];
        found->bound  = graph_slope(plain, root, regions[i], NULL,
                                   box_is_finite(regions[i]) ? CELLS : 1, &blame, builder->scratch);
        found->blame  = blame_of(builder, plain, blame, span);
        if (isfinite(found->bound)) {
            prefer_frames(builder, plain, root, formula, span, found);
            return true;
        }
    }
    bool frames = needs_the_endless(plain, root, builder->scratch);
    for (int i = 0; frames && i < count; i++) {
        found->region = regions[i];
        if (bounded_in_frames(builder, plain, root, regions[i], span, found)) {
            found->slot = slope_slot(builder, formula, regions[i], span);
            return true;
        }
    }
    return false;
}

double slope_everywhere(ShapeBuilder *builder, Node formula)
{
    Node   root  = formula, blame;
    Graph *plain = graph_simplify(builder->graph, &root, 1, builder->scratch);
    return graph_slope(plain, root, box_infinite, NULL, 1, &blame, builder->scratch);
}

Node steepness_node(Graph *graph, const Steepness *slope)
{
    return slope->slot != NODE_NONE ? slope->slot : graph_number(graph, slope->bound);
}

Node divide_by_steepness(Graph *graph, Node distance, const Steepness *slope)
{
    if (slope->slot == NODE_NONE)
        return divide_by_slope(graph, distance, slope->bound);
    Node one    = graph_number(graph, 1);
    Node factor = graph_op2(graph, OP_div, one, graph_op2(graph, OP_max, slope->slot, one));
    return graph_op2(graph, OP_mul, distance, factor);
}

Node divide_by_slope(Graph *g, Node distance, double slope)
{
    if (slope <= 1 + 1e-9)
        return distance;
    Node factor = graph_number(g, 1 / slope);
    return graph_op2(g, OP_mul, distance, factor);
}
