/*
 * sequence_box.c: the box of a sequence, stage by stage.
 */
#include "compiler/shape/sequence_box.h"

#include <math.h>

static Range number(const BoxInput *in, Node node, uint32_t component)
{
    return in->numbers->range(in->numbers, node, component);
}

static Box kernel_box(const BoxInput *in, const SequenceStage *stage)
{
    return in->parts ? in->parts[stage->kernel * in->stride]
                     : in->shape->children[stage->kernel]->box;
}

/* Reads a number that does not move in its range, or none. */
static bool read_number(Range range, double *number)
{
    *number = 0.5 * (range.low + range.high);
    return range.high - range.low <= 1e-12 * (1 + fabs(*number));
}

/* Reads the numbers of a stage; false when some are not known. */
static bool read_stage(const BoxInput *in, const SequenceStage *stage, ReachStage *reach)
{
    bool known = true;
    if (stage->kind == SEQUENCE_KERNEL) {
        reach->kind   = REACH_KERNEL;
        reach->kernel = kernel_box(in, stage);
    } else if (stage->kind == SEQUENCE_REFLECT) {
        reach->kind = REACH_REFLECT;
        for (uint32_t i = 0; i < 3; i++)
            known = read_number(number(in, stage->normal, i), &reach->normal[i]) && known;
        known = read_number(number(in, stage->offset, 0), &reach->offset) && known;
    } else {
        double scale;
        reach->kind = REACH_MAP;
        known       = read_number(number(in, stage->map.scale, 0), &scale);
        for (uint32_t i = 0; i < 3; i++) {
            for (uint32_t j = 0; j < 3; j++) {
                double *entry = &reach->rows[i][j];
                known         = read_number(number(in, stage->map.rows[i], j), entry) && known;
                *entry *= scale;
            }
            known = read_number(number(in, stage->map.shift, i), &reach->shift[i]) && known;
        }
    }
    return known;
}

/* Grows by what all stages up to one have made, from what those before it had. */
static void grow(const BoxInput *in, const SequenceStage *stage, Box *box, Ball *ball)
{
    if (stage->kind == SEQUENCE_KERNEL) {
        const Box kernel = kernel_box(in, stage);
        *box             = box_hull(*box, kernel);
        *ball            = ball_hull(*ball, ball_around(kernel));
    } else if (stage->kind == SEQUENCE_REFLECT) {
        Range u[3], w = number(in, stage->offset, 0);
        for (uint32_t k = 0; k < 3; k++)
            u[k] = number(in, stage->normal, k);
        *box  = box_fold(*box, u, w);
        *ball = ball_fold(*ball, u, w);
    } else {
        const MapRange map = map_range_of(in->numbers, &stage->map);
        *box               = map_box_of(&map, *box);
        *ball              = ball_around(map_box_of(&map, ball_box(*ball)));
    }
}

/* Boxes and balls grow along the sequence side by side; each is tight where the other is not
   (rotated mirrors blow boxes up), so each is cut to the other's size at every level.  While all
   numbers are known, a search then finds how far the set really reaches. */
Box sequence_box(const BoxInput *in, ReachStage *reach, LevelBound *bounds)
{
    bool known = true;
    Box  box   = box_empty;
    Ball ball  = ball_around(box_empty);
    for (uint32_t i = 0; i < in->shape->stage_count; i++) {
        const SequenceStage *stage = &in->shape->stages[i];
        grow(in, stage, &box, &ball);
        box          = box_common(box, ball_box(ball));
        Ball tighter = ball_around(box);
        if (tighter.radius < ball.radius)
            ball = tighter;
        known         = known && read_stage(in, stage, &reach[i]);
        reach[i].box  = box;
        reach[i].ball = ball;
        if (known && stage->kind == SEQUENCE_REFLECT)
            reach_tighten(reach, i + 1);
        box  = reach[i].box;
        ball = reach[i].ball;
        if (bounds)
            bounds[i] = (LevelBound){box, ball};
    }
    return box;
}

uint32_t sequence_nodes(const Shape *krs, Node *nodes)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < krs->stage_count; i++) {
        const SequenceStage *stage = &krs->stages[i];
        if (stage->kind == SEQUENCE_REFLECT) {
            nodes[count++] = stage->normal;
            nodes[count++] = stage->offset;
        } else if (stage->kind == SEQUENCE_MAP)
            count = map_box_nodes(&stage->map, nodes, count);
    }
    return count;
}

bool sequence_is_rigid(const Shape *krs)
{
    bool spheres = false;
    for (uint32_t i = 0; i < krs->stage_count; i++)
        spheres = spheres || krs->stages[i].kind == SEQUENCE_SPHERE;
    return !spheres && krs->inversions == 0;
}
