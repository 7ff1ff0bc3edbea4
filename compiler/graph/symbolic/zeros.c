/*
 * zeros.c: where a polynomial of the point may be 0, as a box.
 *
 * Two proofs by intervals, which help each other:
 *   leading form: along q t, q on the surface of the cube [-1, 1]^3, the polynomial is
 *     sum c_k(q) t^k.  Where c_n(q) keeps away from 0 over a cell of the cube's faces, there are no
 *     zeros beyond the t where c_n t^n outweighs the others.  If all cells have that, the zeros are
 *     bounded;
 *   slabs: what lies beyond a side is cut off where the range of the polynomial there, as it is
 *     written, does not hold 0.  That also finds (x^2 (1 - x^2) - y^2)^2 + z^2 = 0.01 bounded, whose
 *     leading form is x^8 alone.
 */
#include "compiler/graph/symbolic/zeros.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/symbolic/series.h"
#include "compiler/graph/range.h"

/* The work that is tried, in operations over boxes. */
static const double MAX_WORK = 1e5;

enum { MAX_DEPTH = 6, MIN_DEPTH = 2, SLAB_DEPTH = 5, MAX_ROUNDS = 40 };

typedef struct ZeroSearch {
    RangeTask task; /* of the forms; later of the polynomial */
    Node      root;
    Series    forms; /* c_k, of the point as q */
    double    work;  /* what is left */
    int       sign;  /* of the leading form; 0: not known yet */
} ZeroSearch;

static bool run(ZeroSearch *search, Box box)
{
    search->work -= (double)search->task.tape.count;
    if (search->work < 0)
        return false;
    range_task_run(&search->task, box);
    return true;
}

static int sign_of(Range a) { return a.low > 0 ? 1 : a.high < 0 ? -1 : 0; }

/* ---- by the leading form ---- */

/* Returns the t beyond which c_n t^n outweighs what the other terms may take away, over the last
   box. */
static double outweighed_until(const ZeroSearch *search)
{
    uint32_t n = search->forms.degree;
    double   falls[MAX_DEGREE + 1],
        lead   = range_least(range_task_value(&search->task, search->forms.c[n]));
    double low = 0, high = 0;
    for (uint32_t k = 0; k < n; k++) {
        Range c  = range_task_value(&search->task, search->forms.c[k]);
        falls[k] = fmax(search->sign > 0 ? -c.low : c.high, 0);
        high     = fmax(high, 2 * real_pow(falls[k] / lead, 1.0 / (n - k)));
    }
    for (int i = 0; i < 30 && isfinite(high); i++) {
        double t = 0.5 * (low + high), sum = 0;
        for (uint32_t k = 0; k < n; k++)
            sum += falls[k] * real_pow(t, (double)k - n);
        *(sum < lead ? &high : &low) = t;
    }
    return high;
}

static Box middle_of(Box box)
{
    for (int i = 0; i < 3; i++)
        box.axis[i] = range_of(0.5 * box.axis[i].low + 0.5 * box.axis[i].high);
    return box;
}

/* Tells whether the leading form can have no 0 in a cell: it has one sign in its middle. */
static bool may_be_definite(ZeroSearch *search, Box cell)
{
    if (!run(search, middle_of(cell)))
        return false;
    int sign     = sign_of(range_task_value(&search->task, search->forms.c[search->forms.degree]));
    search->sign = search->sign == 0 ? sign : search->sign;
    return sign != 0 && sign == search->sign;
}

/* Adds where zeros in the directions of a cell may be; false: they may be anywhere. */
static bool bound_cell(ZeroSearch *search, Box cell, int depth, Box *zeros)
{
    if (!run(search, cell))
        return false;
    int sign = sign_of(range_task_value(&search->task, search->forms.c[search->forms.degree]));
    if (sign != 0 && sign == search->sign && depth >= MIN_DEPTH) {
        double reach = outweighed_until(search);
        for (int i = 0; i < 3; i++)
            zeros->axis[i] = range_hull(
                zeros->axis[i],
                (Range){fmin(reach * cell.axis[i].low, 0), fmax(reach * cell.axis[i].high, 0)});
        return isfinite(reach);
    }
    if (depth == MAX_DEPTH || !may_be_definite(search, cell))
        return false;
    Box quarters[4] = {cell, cell, cell, cell};
    for (int i = 0, bit = 1; i < 3; i++) {
        if (range_is_single(cell.axis[i]))
            continue;
        double middle = 0.5 * (cell.axis[i].low + cell.axis[i].high);
        for (int quarter = 0; quarter < 4; quarter++)
            *(quarter & bit ? &quarters[quarter].axis[i].low
                            : &quarters[quarter].axis[i].high) = middle;
        bit = 2;
    }
    for (int quarter = 0; quarter < 4; quarter++)
        if (!bound_cell(search, quarters[quarter], depth + 1, zeros))
            return false;
    return true;
}

static bool bound_by_leading_form(ZeroSearch *search, Box *zeros)
{
    *zeros = (Box){{{0, 0}, {0, 0}, {0, 0}}};
    for (int face = 0; face < 6; face++) {
        Box cell            = {{{-1, 1}, {-1, 1}, {-1, 1}}};
        cell.axis[face / 2] = range_of(face % 2 ? 1 : -1);
        if (!may_be_definite(search, cell) || !bound_cell(search, cell, 0, zeros))
            return false;
    }
    return true;
}

/* ---- by slabs ---- */

/* Tells whether the polynomial has this sign all over a box. */
static bool has_sign(ZeroSearch *search, Box box, int sign, int depth)
{
    if (!run(search, box))
        return false;
    if (sign_of(range_task_value(&search->task, search->root)) == sign)
        return true;
    if (depth == 0)
        return false;
    const int    widest    = box_longest_axis(&box);
    const double cut       = range_cut(box.axis[widest]);
    Box          half      = box;
    half.axis[widest].high = cut;
    if (!has_sign(search, half, sign, depth - 1))
        return false;
    half                  = box;
    half.axis[widest].low = cut;
    return has_sign(search, half, sign, depth - 1);
}

/* Moves one side of the box inwards to `at` if there is no zero beyond. */
static bool cut_side(ZeroSearch *search, Box *box, int side, double at, int sign)
{
    Box     slab                                                       = *box;
    Range  *axis                                                       = &box->axis[side / 2];
    double *ends[2]                                                    = {&axis->low, &axis->high};
    *(side % 2 ? &slab.axis[side / 2].low : &slab.axis[side / 2].high) = at;
    if (!has_sign(search, slab, sign, SLAB_DEPTH))
        return false;
    *ends[side % 2] = at;
    return true;
}

/* Cuts an endless side from as far out as numbers of single precision can be squared inwards, by
   ever smaller steps. */
static bool cut_endless_side(ZeroSearch *search, Box *box, int side, int sign)
{
    double other = side % 2 ? box->axis[side / 2].low : box->axis[side / 2].high;
    bool   any   = false;
    for (double exponent = 40, step = 4; exponent > -20 && step >= 0.0625;) {
        double at  = side % 2 ? real_exp2(exponent) : -real_exp2(exponent);
        bool clear = (side % 2 ? at > other : at < other) && cut_side(search, box, side, at, sign);
        if (!clear && !any)
            return false;
        exponent += clear ? 0 : step;
        step *= clear ? 1 : 0.25;
        exponent -= step;
        any = true;
    }
    return any;
}

static bool cut_finite_side(ZeroSearch *search, Box *box, int side, int sign)
{
    static const double fractions[] = {0.5, 0.25, 0.1, 0.03};
    Range               axis        = box->axis[side / 2];
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions; i++) {
        double depth = fractions[i] * (axis.high - axis.low);
        double at    = side % 2 ? axis.high - depth : axis.low + depth;
        if (depth > 1e-6 * (fabs(axis.low) + fabs(axis.high)) &&
            cut_side(search, box, side, at, sign))
            return true;
    }
    return false;
}

/* Cuts sides as near to the zeros as ranges tell. */
static void cut_sides(ZeroSearch *search, Box *box, int sign)
{
    bool any = true;
    for (int round = 0; any && round < MAX_ROUNDS; round++) {
        any = false;
        for (int side = 0; side < 6; side++) {
            Range axis = box->axis[side / 2];
            bool  ends = isfinite(side % 2 ? axis.high : axis.low);
            if (ends && !isfinite(axis.high - axis.low))
                continue; /* no part of it is finite: the other side first */
            any = (ends ? cut_finite_side(search, box, side, sign)
                        : cut_endless_side(search, box, side, sign)) ||
                  any;
        }
    }
}

static bool is_endless(Box box)
{
    bool endless = true;
    for (int i = 0; i < 3; i++)
        endless = endless && !isfinite(box.axis[i].low) && !isfinite(box.axis[i].high);
    return endless;
}

/* Adds what ranges lose by rounding, and what single precision makes of the box. */
static void add_margin(Box *box)
{
    for (int i = 0; i < 3; i++) {
        Range *axis = &box->axis[i];
        double size = fmax(isfinite(axis->low) ? fabs(axis->low) : 0,
                           isfinite(axis->high) ? fabs(axis->high) : 0);
        axis->low -= 1e-4 * size;
        axis->high += 1e-4 * size;
    }
}

ZeroBox graph_zero_box(Graph *graph, Node polynomial, Arena *scratch)
{
    const Box   endless = {{ANYTHING, ANYTHING, ANYTHING}};
    ZeroBox     found   = {endless, 0};
    ZeroSearch  search  = {.root = polynomial};
    SeriesFault fault;
    Node        point = graph_leaf(graph, OP_POINT), origin = graph_vec3(graph, 0, 0, 0);
    if (!graph_line_series(graph, polynomial, origin, point, &search.forms, &fault, scratch))
        return found;
    search.task = range_task(graph, search.forms.c, search.forms.degree + 1, scratch);
    search.work = MAX_WORK;
    if (bound_by_leading_form(&search, &found.box))
        found.sign = search.sign;
    else
        found.box = endless;
    search.task = range_task(graph, &search.root, 1, scratch);
    for (int sign = 1; sign >= -1; sign -= 2) {
        search.work = MAX_WORK;
        if (found.sign == 0 || found.sign == sign)
            cut_sides(&search, &found.box, sign);
        if (found.sign == 0 && !is_endless(found.box))
            found.sign = sign;
    }
    if (found.sign != 0)
        add_margin(&found.box);
    return found;
}
