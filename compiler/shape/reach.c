/*
 * reach.c: the support of a sequence, by best-first search.
 *
 * The largest u.x over a set after a mirror is the larger of two: over the set before it, in the
 * direction u and in the mirrored one.  So it is the largest over a tree of 2^levels instances,
 * of which box and ball of each stage bound whole branches: the branch that may reach farthest is
 * opened first, and the search ends when an instance reaches as far as any branch still might,
 * nearly.  Wherever it ends, the bound of the best branch left holds for all.
 */
#include "compiler/shape/reach.h"

#include <math.h>

#include "compiler/base/vec.h"

enum { MAX_BRANCHES = 512, MAX_OPENED = 2000 };

/* The search ends when no more than this fraction of the set's radius can be gained. */
static const double TOLERANCE = 0.005;

/* The largest direction.x + offset over the set after the first `stages` stages. */
typedef struct Branch {
    uint32_t stages;
    double   direction[3], offset;
    double   bound;
} Branch;

/* A heap, the branch with the largest bound on top. */
typedef struct ReachSearch {
    const ReachStage *stages;
    Branch            heap[MAX_BRANCHES];
    uint32_t          count;
    double            reached; /* by a kernel's box */
} ReachSearch;

static double box_support(Box box, const double direction[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        Range side = box.axis[i];
        if (direction[i] != 0)
            sum += direction[i] * (direction[i] > 0 ? side.high : side.low);
    }
    return sum;
}

static double bound_of(const ReachStage *stage, const Branch *branch)
{
    const double *u = branch->direction;
    if (box_is_empty(stage->box) || stage->ball.radius < 0)
        return -INFINITY;
    double by_box  = box_support(stage->box, u);
    double by_ball = dot3(u, stage->ball.centre) + stage->ball.radius * sqrt(dot3(u, u));
    return fmin(by_box, by_ball) + branch->offset;
}

static void swap(Branch *a, Branch *b)
{
    Branch c = *a;
    *a       = *b;
    *b       = c;
}

/* Adds a branch; false when the heap is full: then no more branches may be opened. */
static bool push(ReachSearch *search, Branch branch)
{
    if (branch.stages == 0)
        return true;
    branch.bound = bound_of(&search->stages[branch.stages - 1], &branch);
    if (branch.bound <= search->reached)
        return true;
    if (search->count == MAX_BRANCHES)
        return false;
    uint32_t at      = search->count++;
    search->heap[at] = branch;
    for (; at > 0 && search->heap[(at - 1) / 2].bound < search->heap[at].bound; at = (at - 1) / 2)
        swap(&search->heap[at], &search->heap[(at - 1) / 2]);
    return true;
}

static Branch pop(ReachSearch *search)
{
    Branch top      = search->heap[0];
    search->heap[0] = search->heap[--search->count];
    for (uint32_t at = 0, child; (child = 2 * at + 1) < search->count; at = child) {
        if (child + 1 < search->count && search->heap[child + 1].bound > search->heap[child].bound)
            child++;
        if (search->heap[at].bound >= search->heap[child].bound)
            break;
        swap(&search->heap[at], &search->heap[child]);
    }
    return top;
}

/* Opens what the set after the branch's last stage is made of. */
static bool open_branch(ReachSearch *search, const Branch *branch)
{
    const ReachStage *stage  = &search->stages[branch->stages - 1];
    Branch            before = *branch;
    before.stages--;
    if (stage->kind == REACH_KERNEL) {
        if (!box_is_empty(stage->kernel))
            search->reached = fmax(search->reached,
                                   box_support(stage->kernel, branch->direction) + branch->offset);
    } else if (stage->kind == REACH_REFLECT) {
        Branch mirrored = before;
        double along    = dot3(branch->direction, stage->normal);
        for (int i = 0; i < 3; i++)
            mirrored.direction[i] -= 2 * along * stage->normal[i];
        mirrored.offset += 2 * along * stage->offset;
        if (!push(search, mirrored))
            return false;
    } else {
        for (int i = 0; i < 3; i++) {
            before.direction[i] = 0;
            for (int j = 0; j < 3; j++)
                before.direction[i] += branch->direction[j] * stage->rows[j][i];
        }
        before.offset += dot3(branch->direction, stage->shift);
    }
    return push(search, before);
}

/* Returns no less than the largest u.x over the set after `count` stages. */
static double find_support(const ReachStage *stages, uint32_t count, const double u[3],
                           double tolerance)
{
    ReachSearch search = {.stages = stages, .reached = -INFINITY};
    Branch      whole  = {.stages = count, .direction = {u[0], u[1], u[2]}};
    push(&search, whole);
    for (int opened = 0; search.count > 0 && opened < MAX_OPENED; opened++) {
        Branch top = pop(&search);
        if (top.bound <= search.reached + tolerance || !open_branch(&search, &top))
            return fmax(top.bound, search.reached);
    }
    return fmax(search.count > 0 ? search.heap[0].bound : -INFINITY, search.reached);
}

void reach_tighten(ReachStage *stages, uint32_t count)
{
    ReachStage *last = &stages[count - 1];
    if (box_is_empty(last->box) || !box_is_finite(last->box))
        return;
    double tolerance = TOLERANCE * 0.5 * box_diagonal(last->box);
    Box    box       = last->box;
    for (int i = 0; i < 3; i++) {
        double u[3] = {0};
        u[i]        = 1;
        double high = find_support(stages, count, u, tolerance);
        u[i]        = -1;
        double low  = -find_support(stages, count, u, tolerance);
        box.axis[i] = (Range){fmax(box.axis[i].low, low), fmin(box.axis[i].high, high)};
    }
    /* Rounding of at most some thousand sums of such numbers. */
    double reach = 0;
    for (int i = 0; i < 3; i++)
        reach = fmax(reach, fmax(fabs(box.axis[i].low), fabs(box.axis[i].high)));
    last->box = box_common(last->box, box_grow(box, 1e-12 * (reach + box_diagonal(box))));
    Ball ball = ball_around(last->box);
    if (ball.radius < last->ball.radius)
        last->ball = ball;
}
