/*
 * lower_krs.c: kernel-reflection sequences.
 */
#include "compiler/geometry/lowering.h"

enum { MOST_HEAP_MIRRORS = 31 };

/*
 * From the last statement to the first (math.md, section 1): a mirror folds the point and gives
 * the instance its next bit, a kernel joins with the level that it has: the mirrors before it.
 */
Lowered lower_krs(Lowering *l, const Shape *shape, Place place)
{
    Graph   *g      = l->graph;
    Lowered  result = lowered_nothing;
    Node     point  = place.point, scale = graph_number(g, 1);
    Node     id     = graph_uint(g, 1);
    uint32_t level  = shape->levels;
    Op       next_id = shape->levels <= MOST_HEAP_MIRRORS ? OP_push_id : OP_hash_id;
    for (uint32_t i = shape->stage_count; i-- > 0;) {
        const Stage *stage = &shape->stages[i];
        if (stage->kind == STAGE_REFLECT) {
            if (l->surfaces) {
                Node behind = graph_op3(g, OP_front, point, stage->normal, stage->offset);
                id          = graph_op2(g, next_id, id, behind);
            }
            point = graph_op3(g, OP_fold, point, stage->normal, stage->offset);
            level--;
        } else if (stage->kind == STAGE_SIMILARITY) {
            point = before_map(g, &stage->map, point);
            scale = graph_op2(g, OP_mul, scale, stage->map.scale);
        } else {
            Place inner = place_at(place, point);
            if (l->surfaces) {
                /* Within an outer sequence its level counts, and this instance is hashed in. */
                bool outer     = place.level != NODE_NONE;
                inner.level    = outer ? place.level : graph_number(g, level);
                inner.instance = outer ? graph_op2(g, OP_join_id, place.instance, id) : id;
            }
            Lowered kernel = lower_shape(l, shape->children[stage->kernel], inner);
            result         = join_two(l, blend_sharp, result, scale_distance(l, kernel, scale));
        }
    }
    return result;
}
