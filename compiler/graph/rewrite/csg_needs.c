/*
 * csg_needs.c: which blends and sides of a tree of CSG nodes its surface needs.
 *
 * Boxes are halved across their longest side.  In a box, ranges of the leaves give ranges of all parts;
 * then, from the whole downwards, operands that have no influence are left aside.  A box where nothing
 * is in question is done with, as is one that the surface does not pass.
 *
 * This is done twice.  The first time tells what the surface needs.  The second time ranges are those of
 * the distance with or without each of what is not needed, in all combinations.  A box counts unless the
 * whole has one sign in all of them.  What turns out to have an influence is needed as well.
 */
#include "compiler/graph/rewrite/csg_needs.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/graph/lanes/lanes.h"

/* Relative to the longest side of all: the smallest boxes; those where only edges of tools are in
   question; what counts as the surface on both of its sides. */
static const double MIN_SIDE = 1.0 / 96, MIN_AT_EDGES = 1.0 / 192, MARGIN = 1.0 / 256;

/* Steps of lane tapes that are run over boxes, about ten milliseconds of them, before all others are taken
   for smallest ones. */
enum { MAX_STEPS = 1000000 };

typedef struct Search {
    CsgTree   *tree;
    LaneRanges ranges; /* of the lane tape at hand */
    Range     *range;  /* of each part */

    Range *other; /* room for other ranges */
    double longest;
    bool   in_all; /* ranges hold with and without what is not needed */
    size_t steps;  /* run so far */
    Arena *scratch;
} Search;

/* The leaves in a box, each an output of the lane tape; parts that may have an influence. */
typedef struct Cell {
    Box       box;
    LaneTape  tape;
    uint32_t *leaves;
    uint32_t  leaf_count;
    bool     *matters; /* by part */
} Cell;

/* ---- ranges ---- */

static double blend_at(const CsgTree *tree, const CsgPart *part, double a, double b)
{
    static const GraphType types[MAX_OPERANDS]    = {TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT};
    const NodeValue        operands[MAX_OPERANDS] = {{{a}}, {{b}}, {{part->number}}};
    if (!(fabs(a - b) < part->number))
        return fmin(a, b);
    return op_evaluate((Op)tree->graph->items[part->node].op, TYPE_FLOAT, 0, types, operands).v[0];
}

static double greatest(const double *sides, uint32_t count)
{
    double most = -HUGE_VAL;
    for (uint32_t k = 0; k < count; k++)
        most = fmax(most, sides[k]);
    return most;
}

/* Returns the value at the corner, which grows with each side. */
static double corner_at(const double *sides, uint32_t count)
{
    double square = 0;
    for (uint32_t k = 0; k < count; k++)
        square += fmax(sides[k], 0) * fmax(sides[k], 0);
    return sqrt(square) + fmin(greatest(sides, count), 0);
}

/* Finds the range of a corner, which is no larger with fewer sides.  The sides that are needed
   remain. */
static Range range_of_corner(const Search *s, const CsgPart *part)
{
    double   low[MAX_SIDES], high[MAX_SIDES];
    uint32_t lows = 0, highs = 0;
    for (uint32_t k = 0; k < part->side_count; k++) {
        Range side    = s->range[part->sides[k]];
        high[highs++] = side.high;
        if (!s->in_all || part->needed >> k & 1)
            low[lows++] = side.low;
    }
    bool may_be_sharp = s->in_all && !part->is_round;
    return (Range){may_be_sharp ? greatest(low, lows) : corner_at(low, lows),
                   corner_at(high, highs)};
}

static Range range_of_blend(const Search *s, const CsgPart *part)
{
    Range a = s->range[part->a], b = s->range[part->b];
    bool  may_be_sharp = s->in_all && !part->blends;
    return (Range){blend_at(s->tree, part, a.low, b.low),
                   may_be_sharp ? fmin(a.high, b.high) : blend_at(s->tree, part, a.high, b.high)};
}

/* Finds the range of shares, which without what is not needed is the least of what some of them
   make. */
static Range range_of_shares(const Search *s, const Cell *cell, const CsgPart *part)
{
    FindShares *find = sharing_op((Op)s->tree->graph->items[part->node].op).find;
    double      low[MAX_SHARERS], high[MAX_SHARERS], least = HUGE_VAL;
    uint32_t    count = 0;
    for (uint32_t k = 0; k < part->sharer_count; k++)
        if (cell->matters[part->sharers[k]]) {
            low[count]    = s->range[part->sharers[k]].low;
            high[count++] = s->range[part->sharers[k]].high;
            least         = fmin(least, high[count - 1]);
        }
    const double most = find(high, count, part->number).result;
    Range        all  = {find(low, count, part->number).result, s->in_all ? least : most};
    return isnan(all.low) || isnan(all.high) ? ANYTHING : all;
}

static Range range_of_part(const Search *s, const Cell *cell, const CsgPart *part)
{
    const Range *range = s->range;
    if (part->kind == CSG_SHARES)
        return range_of_shares(s, cell, part);
    const bool a = cell->matters[part->a], b = cell->matters[part->b];
    const bool two = part->kind == CSG_MIN || part->kind == CSG_MAX || part->kind == CSG_BLEND;
    if (two && !(a && b)) /* what does not matter has the range of another box */
        return range[a ? part->a : part->b];
    switch (part->kind) {
    case CSG_NEGATIVE: return range_neg(range[part->a]);
    case CSG_ADD: return range_add(range[part->a], range_of(part->number));
    case CSG_SCALE: return range_mul(range[part->a], range_of(part->number));
    case CSG_MIN: return range_min(range[part->a], range[part->b]);
    case CSG_MAX: return range_max(range[part->a], range[part->b]);
    case CSG_BLEND: return range_of_blend(s, part);
    default: return range_of_corner(s, part);
    }
}

static bool output_is_sure(const LaneTape *tape, const LaneRanges *ranges, size_t output)
{
    uint32_t operand = tape->outputs[output];
    return (operand & LANE_SCALAR) || ranges->sure[operand];
}

static Range find_ranges(const Search *s, const Cell *cell)
{
    const CsgTree *tree = s->tree;
    lane_ranges_run(&cell->tape, &s->ranges, cell->box);
    for (uint32_t i = 0; i < cell->leaf_count; i++)
        s->range[cell->leaves[i]] = output_is_sure(&cell->tape, &s->ranges, i)
                                        ? lane_ranges_output(&cell->tape, &s->ranges, i)
                                        : ANYTHING;
    for (uint32_t i = 0; i < tree->count; i++)
        if (cell->matters[i] && tree->parts[i].kind != CSG_LEAF)
            s->range[i] = range_of_part(s, cell, &tree->parts[i]);
    return s->range[tree->count - 1];
}

/* ---- influence ---- */

/* Sides below which another one always is, and which are not outside, count for nothing. */
static uint32_t sides_that_count(const Search *s, const CsgPart *part)
{
    uint32_t count = 0;
    double   most  = -HUGE_VAL; /* some side is always so high */
    for (uint32_t k = 0; k < part->side_count; k++)
        most = fmax(most, s->range[part->sides[k]].low);
    for (uint32_t k = 0; k < part->side_count; k++) {
        const double high = s->range[part->sides[k]].high;
        count |= (uint32_t)(high > 0 || high >= most) << k;
    }
    return count;
}

/* Finds which operands of two may be the result, or change it. */
static void find_operands(const Search *s, const CsgPart *part, bool *a_counts, bool *b_counts)
{
    Range  a = s->range[part->a], b = s->range[part->b];
    double width = part->kind == CSG_BLEND ? part->number : 0;
    bool   max   = part->kind == CSG_MAX;
    *a_counts    = max ? a.high >= b.low : a.low <= b.high + width;
    *b_counts    = max ? b.high >= a.low : b.low <= a.high + width;
}

static bool may_blend(const Search *s, const CsgPart *part)
{
    Range a = s->range[part->a], b = s->range[part->b];
    return fmax(b.low - a.high, a.low - b.high) <= part->number;
}

/* Returns which operands that mattered may have a share, as bits. */
static uint32_t find_sharers(const Search *s, const CsgPart *part, const bool *mattered)
{
    uint32_t bits  = 0;
    double   least = HUGE_VAL;
    for (uint32_t k = 0; k < part->sharer_count; k++)
        if (mattered[part->sharers[k]])
            least = fmin(least, s->range[part->sharers[k]].high);
    for (uint32_t k = 0; k < part->sharer_count; k++)
        if (mattered[part->sharers[k]] && s->range[part->sharers[k]].low <= least + part->number)
            bits |= 1u << k;
    return bits;
}

/* Tells whether two of those that matter may share where it was not needed yet; `mark`: now it is. */
static bool finds_shares(const Search *s, CsgPart *part, const bool *matters, bool mark)
{
    const uint32_t bits = find_sharers(s, part, matters);
    bool           more = false;
    for (uint32_t k = 0; k < part->sharer_count; k++)
        for (uint32_t l = 0; l < k; l++) {
            Range a = s->range[part->sharers[k]], b = s->range[part->sharers[l]];
            if (!(bits >> k & bits >> l & 1) || part->shares[k] >> l & 1 ||
                fmax(b.low - a.high, a.low - b.high) > part->number)
                continue;
            more = true;
            if (mark) {
                part->shares[k] |= (uint8_t)(1u << l);
                part->shares[l] |= (uint8_t)(1u << k);
            }
        }
    return more;
}

/* Marks the operands that matter in a box, if the part does. */
static void mark_operands(const Search *s, const CsgPart *part, const bool *mattered, bool *matters)
{
    bool a = true, b = false;
    if (part->kind == CSG_CORNER) {
        for (uint32_t k = 0; k < part->side_count; k++)
            matters[part->sides[k]] = true;
        return;
    }
    if (part->kind == CSG_LEAF)
        return;
    if (part->kind == CSG_SHARES) {
        const uint32_t bits = find_sharers(s, part, mattered);
        for (uint32_t k = 0; k < part->sharer_count; k++)
            matters[part->sharers[k]] |= bits >> k & 1;
        return;
    }
    if (part->kind == CSG_MIN || part->kind == CSG_MAX || part->kind == CSG_BLEND) {
        a = mattered[part->a], b = mattered[part->b];
        if (a && b)
            find_operands(s, part, &a, &b);
        matters[part->b] |= b;
    }
    matters[part->a] |= a;
}

/* Returns the most that the whole may be where a corner is not below 0. */
static double max_beside(Search *s, const Cell *cell, uint32_t corner)
{
    const CsgTree *tree = s->tree;
    Range         *kept = s->range;
    memcpy(s->other, kept, tree->count * sizeof *kept);
    s->range             = s->other;
    s->range[corner].low = fmax(s->range[corner].low, 0);
    for (uint32_t i = corner + 1; i < tree->count; i++)
        if (cell->matters[i] && tree->parts[i].kind < CSG_CORNER && tree->parts[i].kind > CSG_LEAF)
            s->range[i] = range_of_part(s, cell, &tree->parts[i]);
    s->range = kept;
    return s->other[tree->count - 1].high;
}

/* Tells whether a cell may be nearest to an edge of a corner: it is outside of two sides. */
static bool may_be_round(Search *s, const Cell *cell, uint32_t corner)
{
    const CsgPart *part    = &s->tree->parts[corner];
    uint32_t       outside = 0;
    for (uint32_t k = 0; k < part->side_count; k++)
        outside += s->range[part->sides[k]].high > 0;
    return !part->is_round && outside > 1 && !(max_beside(s, cell, corner) <= 0);
}

/* The size below which all of a box is needed. */
typedef struct Size {
    bool least, min_at_edges;
} Size;

/* Tells whether there is more to be found out about a part that matters. */
static bool is_in_question(Search *s, const Cell *cell, uint32_t i, const bool *matters, Size size)
{
    CsgPart *part = &s->tree->parts[i];
    if (!csg_node_is_candidate(part))
        return false;
    if (part->kind == CSG_CORNER) {
        const uint32_t more    = sides_that_count(s, part) & ~part->needed;
        const bool     rounder = may_be_round(s, cell, i);
        part->needed |= size.least ? more : 0;
        part->is_round |= size.min_at_edges && rounder;
        return (more && !size.least) || (rounder && !size.min_at_edges);
    }
    if (part->kind == CSG_SHARES)
        return finds_shares(s, part, matters, size.least) && !size.least;
    const bool more = !part->blends && matters[part->a] && matters[part->b] && may_blend(s, part);
    part->blends |= size.least && more;
    return more && !size.least;
}

/* Finds influences from the whole downwards; returns whether anything is in question for smaller
   boxes. */
static bool find_influences(Search *s, const Cell *cell, bool *matters, Size size)
{
    CsgTree *tree            = s->tree;
    bool     in_question     = false;
    matters[tree->count - 1] = true;
    for (uint32_t i = tree->count; i-- > 0;)
        if (matters[i]) {
            mark_operands(s, &tree->parts[i], cell->matters, matters);
            in_question |= is_in_question(s, cell, i, matters, size);
        }
    return in_question;
}

/* ---- boxes ---- */

static void visit(Search *s, const Cell *cell);

/* Returns the cell of a half; with a tape for the leaves that matter, where they are much fewer. */
static Cell prune_cell(const Search *s, const Cell *cell, bool *matters, Arena *arena)
{
    Cell      inner   = {.box = cell->box, .matters = matters};
    uint32_t *outputs = arena_new_array(arena, uint32_t, cell->leaf_count + 1);
    inner.leaves      = arena_new_array(arena, uint32_t, cell->leaf_count + 1);
    for (uint32_t i = 0; i < cell->leaf_count; i++)
        if (matters[cell->leaves[i]]) {
            outputs[inner.leaf_count]        = cell->tape.outputs[i];
            inner.leaves[inner.leaf_count++] = cell->leaves[i];
        }
    const bool fewer = 5 * inner.leaf_count <= 4 * cell->leaf_count;
    inner.tape       = cell->tape;
    if (!fewer) {
        inner.leaves     = cell->leaves;
        inner.leaf_count = cell->leaf_count;
        return inner;
    }
    inner.tape.outputs      = outputs;
    inner.tape.output_count = inner.leaf_count;
    inner.tape              = lane_prune(&inner.tape, &s->ranges, inner.leaf_count, arena);
    return inner;
}

static void visit_halves(Search *s, const Cell *cell, bool *matters, int axis, Arena *arena)
{
    Cell   half              = prune_cell(s, cell, matters, arena);
    Range  side              = cell->box.axis[axis];
    double middle            = 0.5 * (side.low + side.high);
    half.box.axis[axis].high = middle;
    visit(s, &half);
    half.box.axis[axis] = (Range){middle, side.high};
    visit(s, &half);
}

static void visit(Search *s, const Cell *cell)
{
    const Range  whole  = find_ranges(s, cell);
    const int    axis   = box_longest_axis(&cell->box);
    const double side   = cell->box.axis[axis].high - cell->box.axis[axis].low;
    const double margin = MARGIN * s->longest;
    const bool   late   = s->steps > MAX_STEPS;
    const Size   size   = {late || side <= MIN_SIDE * s->longest,
                           late || side <= MIN_AT_EDGES * s->longest};
    s->steps += cell->tape.count;
    if (whole.low > margin || whole.high < -margin)
        return;
    Arena arena   = {.memory = s->scratch->memory};
    bool *matters = arena_new_array(&arena, bool, s->tree->count);
    if (find_influences(s, cell, matters, size))
        visit_halves(s, cell, matters, axis, &arena);
    arena_free(&arena);
}

/* ---- all around ---- */

/* Tells whether a cell is outside of the box, where nothing may be inside of the solid. */
static bool is_outside(Search *s, Cell cell)
{
    const Box box = cell.box;
    for (int k = 0; k < 3; k++)
        cell.box.axis[k] = (Range){-FAR_SIDE, FAR_SIDE};
    for (int k = 0; k < 3; k++)
        for (int end = 0; end < 2; end++) {
            Cell beside        = cell;
            beside.box.axis[k] = end ? (Range){box.axis[k].high, FAR_SIDE}
                                     : (Range){-FAR_SIDE, box.axis[k].low};
            if (!(find_ranges(s, &beside).low > 0))
                return false;
        }
    return true;
}

/* The leaves are the roots of a lane tape. */
static Cell whole_cell(const CsgTree *tree, Box box, Tape *tape, Arena *scratch)
{
    Cell  cell  = {.box     = box,
                   .leaves  = arena_new_array(scratch, uint32_t, tree->count),
                   .matters = arena_new_array(scratch, bool, tree->count)};
    Node *roots = arena_new_array(scratch, Node, tree->count);
    for (uint32_t i = 0; i < tree->count; i++) {
        cell.matters[i] = true;
        if (tree->parts[i].kind == CSG_LEAF) {
            roots[cell.leaf_count]         = tree->parts[i].node;
            cell.leaves[cell.leaf_count++] = i;
        }
    }
    *tape     = tape_new(tree->graph, roots, cell.leaf_count, scratch);
    cell.tape = lane_tape_new(tape, roots, cell.leaf_count, false, 0, scratch);
    return cell;
}

/* Sets the lane tape's numbers: nothing depends on the frame. */
static void set_scalars(Cell *cell, const Tape *tape, Arena *scratch)
{
    NodeValue *values     = arena_new_array(scratch, NodeValue, tape->graph->count);
    NodeValue  parameters = {{0}};
    tape_run_frame(tape, &parameters, values);
    cell->tape.scalars = arena_new_array(scratch, double, cell->tape.scalar_count + 1);
    lane_tape_scalars(&cell->tape, values, cell->tape.scalars);
}

/* A corner that no surface needs stays as it is. */
static void keep_others(CsgTree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++)
        if (tree->parts[i].kind == CSG_CORNER && tree->parts[i].needed == 0) {
            tree->parts[i].needed   = (1u << tree->parts[i].side_count) - 1;
            tree->parts[i].is_round = true;
        }
}

bool csg_nodes_find_needs(CsgTree *tree, Box box, Arena *scratch)
{
    Tape   tape;
    double longest = 0;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, box.axis[k].high - box.axis[k].low);
    if (!(longest > 0 && longest < FAR_SIDE))
        return false;
    const double margin = MARGIN * longest;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){box.axis[k].low - 2 * margin, box.axis[k].high + 2 * margin};
    Cell cell = whole_cell(tree, box, &tape, scratch);
    set_scalars(&cell, &tape, scratch);
    Search s = {.tree    = tree,
                .ranges  = lane_ranges_new(&cell.tape, scratch),
                .range   = arena_new_array(scratch, Range, tree->count),
                .other   = arena_new_array(scratch, Range, tree->count),
                .longest = longest,
                .scratch = scratch};
    if (!is_outside(&s, cell))
        return false;
    visit(&s, &cell);
    keep_others(tree);
    s.in_all = true;
    s.steps  = 0;
    visit(&s, &cell);
    return is_outside(&s, cell);
}
