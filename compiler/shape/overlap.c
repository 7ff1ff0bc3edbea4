/*
 * overlap.c: how many boxes have a point in common, by branch and bound.
 *
 * All that the boxes cover is halved again and again, with those boxes that meet each half.  There are no
 * more in any point of a part than meet the part, so a part with no more than have been found elsewhere is
 * left alone; and the half with more of them comes first.  Parts are halved to some depth.  The search is
 * repeated with greater depths until parts that deep change nothing or the time is up.
 */
#include "compiler/shape/overlap.h"

#include <math.h>

#include "compiler/base/far.h"
#include "compiler/shape/box.h"

enum { DEEPER = 4, DEEPEST = 40, TESTS_PER_BOX = 256, SPARE_TESTS = 1 << 16 };

typedef struct OverlapSearch {
    Arena   *scratch;
    double   tests;  /* of boxes that are left */
    uint32_t most;   /* so far */
    bool     coarse; /* a part that counts could be halved further */
} OverlapSearch;

static bool boxes_meet(const Box *a, const Box *b)
{
    for (int k = 0; k < 3; k++)
        if (!(a->axis[k].low <= b->axis[k].high && b->axis[k].low <= a->axis[k].high))
            return false;
    return true;
}

static bool box_holds(const Box *outer, const Box *inner)
{
    for (int k = 0; k < 3; k++)
        if (!(outer->axis[k].low <= inner->axis[k].low &&
              inner->axis[k].high <= outer->axis[k].high))
            return false;
    return true;
}

static void search(OverlapSearch *s, const Box *boxes, uint32_t count, Box region, int depth)
{
    uint32_t holding = 0;
    if (count <= s->most || s->tests < 0)
        return;
    for (uint32_t i = 0; i < count; i++)
        holding += box_holds(&boxes[i], &region);
    if (holding == count || depth == 0) {
        s->coarse = s->coarse || holding < count;
        s->most   = count;
        return;
    }
    ArenaMark mark = arena_mark(s->scratch);
    Box       halves[2], *lists[2];
    uint32_t  counts[2] = {0, 0};
    box_halve(region, halves);
    for (int half = 0; half < 2; half++) {
        lists[half] = arena_new_array(s->scratch, Box, count);
        for (uint32_t i = 0; i < count; i++)
            if (boxes_meet(&boxes[i], &halves[half]))
                lists[half][counts[half]++] = boxes[i];
    }
    s->tests -= 3.0 * count;
    int more = counts[1] > counts[0];
    search(s, lists[more], counts[more], halves[more], depth - 1);
    search(s, lists[!more], counts[!more], halves[!more], depth - 1);
    arena_rewind(s->scratch, mark);
}

/* Widens `whole` so that it has all ends of a box: some point of the most boxes is between ends. */
static void add_ends(Box *whole, const Box *box)
{
    for (int k = 0; k < 3; k++) {
        const double ends[2] = {box->axis[k].low, box->axis[k].high};
        for (int i = 0; i < 2; i++)
            if (fabs(ends[i]) < FAR_SIDE) {
                whole->axis[k].low  = fmin(whole->axis[k].low, ends[i]);
                whole->axis[k].high = fmax(whole->axis[k].high, ends[i]);
            }
    }
}

uint32_t max_overlap(const Box *boxes, uint32_t count, double grown, Arena *scratch)
{
    ArenaMark mark   = arena_mark(scratch);
    Box      *larger = arena_new_array(scratch, Box, count + (size_t)1), whole = box_empty;
    uint32_t  present = 0, least;
    for (uint32_t i = 0; i < count; i++)
        if (!box_is_empty(boxes[i])) {
            larger[present] = box_grow(boxes[i], grown);
            add_ends(&whole, &larger[present++]);
        }
    for (int k = 0; k < 3; k++)
        if (whole.axis[k].low > whole.axis[k].high)
            whole.axis[k] = range_of(0); /* all are endless */
    OverlapSearch s = {
        .scratch = scratch, .tests = (double)TESTS_PER_BOX * present + SPARE_TESTS, .coarse = true};
    least = present;
    for (int depth = DEEPER; depth <= DEEPEST && s.coarse && least > 1; depth += DEEPER) {
        s.most   = 0;
        s.coarse = false;
        search(&s, larger, present, whole, depth);
        if (s.tests < 0)
            break;
        least = s.most;
    }
    arena_rewind(scratch, mark);
    return least;
}
