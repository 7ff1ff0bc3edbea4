/*
 * sequence_bounds.c: sequences: their bounding volumes, level by level.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/shape/sequence_box.h"

/* Of a sequence with spheres or maps that invert: balls all the way (cover.h). */
static Box bound_inverted(ShapeBuilder *builder, const Shape *krs, LevelBound *bounds)
{
    Cover cover = {0};
    for (uint32_t i = 0; i < krs->stage_count; i++) {
        const SequenceStage *stage = &krs->stages[i];
        if (stage->kind == SEQUENCE_KERNEL) {
            const Shape *kernel = krs->children[stage->kernel];
            if (!box_is_finite(kernel->box) && !box_is_empty(kernel->box)) {
                for (; i < krs->stage_count; i++)
                    bounds[i] = (LevelBound){box_infinite, ball_around(box_infinite)};
                return box_infinite; /* after the last inversion: see check_kernels */
            }
            cover_add(builder->arena, &cover, kernel->box);
        } else if (stage->kind == SEQUENCE_REFLECT) {
            Range u[3];
            for (uint32_t k = 0; k < 3; k++)
                u[k] = node_range(builder, stage->normal, k);
            cover_fold(builder->arena, &cover, u, node_range(builder, stage->offset, 0));
        } else if (stage->kind == SEQUENCE_SPHERE) {
            Range centre[3];
            for (uint32_t k = 0; k < 3; k++)
                centre[k] = node_range(builder, stage->centre, k);
            cover_fold_sphere(builder->arena, &cover, centre,
                              node_range(builder, stage->radius, 0));
        } else {
            MapRange map = map_range(builder, &stage->map);
            cover_map(&cover, &map);
        }
        bounds[i].box  = cover_box(&cover);
        Ball around    = ball_around(bounds[i].box);
        bounds[i].ball = cover_ball(&cover);
        if (around.radius < bounds[i].ball.radius)
            bounds[i].ball = around;
    }
    return cover_box(&cover);
}

/* Of a sequence of reflections and similarities. */
static Box bound_sequence(ShapeBuilder *builder, const Shape *krs, LevelBound *bounds)
{
    ReachStage          *reach = arena_new_array(builder->arena, ReachStage, krs->stage_count + 1);
    const BuilderNumbers all   = builder_numbers(builder);
    return sequence_box(&(BoxInput){&all.numbers, krs, NULL, 0}, reach, bounds);
}

static uint32_t count_inversions(const Shape *krs)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < krs->stage_count; i++)
        count += krs->stages[i].kind == SEQUENCE_MAP && krs->stages[i].map.pole != NODE_NONE;
    return count;
}

/* What is inverted must not be endless; reported at the first inversion after it. */
static bool check_kernels(ShapeBuilder *builder, const Shape *krs)
{
    bool                 good      = true;
    const SequenceStage *inversion = NULL;
    for (uint32_t i = krs->stage_count; i-- > 0;) {
        const SequenceStage *stage = &krs->stages[i];
        if (stage->kind == SEQUENCE_MAP && stage->map.pole != NODE_NONE)
            inversion = stage;
        if (stage->kind == SEQUENCE_KERNEL && inversion)
            good = check_invertible(builder, krs->children[stage->kernel], inversion->span) && good;
    }
    return good;
}

const Shape *make_krs(ShapeBuilder *builder, const SequenceStage *stages, uint32_t stage_count,
                      const Shape *const *kernels, uint32_t kernel_count, Span span)
{
    Shape *krs       = shape_new(builder, SHAPE_KRS, "krs", span, kernels, kernel_count);
    krs->stages      = stages;
    krs->stage_count = stage_count;
    krs->exact       = false;
    krs->instances   = 0;
    krs->levels      = 0;
    bool spheres     = false;
    for (uint32_t i = 0; i < stage_count; i++) {
        if (stages[i].kind == SEQUENCE_KERNEL)
            krs->instances += kernels[stages[i].kernel]->instances;
        else if (stages[i].kind != SEQUENCE_MAP) {
            krs->instances *= 2;
            krs->levels++;
        }
        spheres = spheres || stages[i].kind == SEQUENCE_SPHERE;
    }
    krs->trapped    = krs->trapped || krs->levels > 0;
    krs->inversions = count_inversions(krs);
    if (krs->inversions && !check_kernels(builder, krs))
        return NULL;
    LevelBound *bounds = arena_new_array(builder->arena, LevelBound, stage_count + 1);
    krs->bounds        = bounds;
    krs->box           = krs->inversions || spheres ? bound_inverted(builder, krs, bounds)
                                                    : bound_sequence(builder, krs, bounds);
    return krs;
}
