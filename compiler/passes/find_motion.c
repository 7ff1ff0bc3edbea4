/*
 * find_motion.c: what the time does to each component, once it is lowered.
 */
#include "compiler/passes/compilation.h"
#include "compiler/graph/timed.h"

typedef struct MotionFinder {
    const Assembly *assembly;
    const Node     *roots; /* of the assembly */
    const bool     *timed; /* nodes that depend on the time */
    bool           *asked; /* items of the assembly that were looked at */
} MotionFinder;

static bool any_timed(const MotionFinder *f, uint32_t root, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (f->timed[f->roots[root + i]])
            return true;
    return false;
}

static void add_item(const MotionFinder *f, uint32_t number, KrsMotion *motion);

/* Adds a transform.  What grows has a larger error, so that is no motion. */
static void add_transform(const MotionFinder *f, const AssemblyTransform *transform,
                          KrsMotion *motion)
{
    if (transform->kind == PLACED_MIRRORED && any_timed(f, transform->root, NODES_OF(MirrorRoots)))
        motion->deforms = true;
    if (transform->kind == PLACED_MAPPED) {
        motion->deforms = motion->deforms || any_timed(f, transform->root, 1);
        motion->moves   = motion->moves || any_timed(f, transform->root, NODES_OF(MapRoots));
    }
    add_item(f, transform->item, motion);
}

static void add_item(const MotionFinder *f, uint32_t number, KrsMotion *motion)
{
    const AssemblyItem *item = &f->assembly->items.items[number];
    if (f->asked[number])
        return;
    f->asked[number] = true;
    if (item->count == 0)
        motion->deforms = motion->deforms || any_timed(f, item->root, 1);
    for (uint32_t i = item->first; i < item->first + item->count; i++)
        add_transform(f, &f->assembly->transforms.items[i], motion);
}

static bool is_timed_material(const MotionFinder *f, const Material *material)
{
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    if (material->name != NODE_NONE && f->timed[material->name])               \
        return true;
#include "krs/surface.def"
    return material->bump != NODE_NONE && f->timed[material->bump];
}

static bool recolors(const MotionFinder *f, const Shape *shape)
{
    if (shape->kind == SHAPE_ITERATION)
        return recolors(f, shape->iterated);
    if (shape->material && is_timed_material(f, shape->material))
        return true;
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (recolors(f, shape->children[i]))
            return true;
    return false;
}

void find_motions(Compilation *c)
{
    const Scene *s        = &c->elaborated;
    Assembly    *assembly = &c->scene->assembly;
    const size_t items    = assembly->items.count;
    bool        *timed    = arena_new_array(&c->work, bool, s->graph->count);
    MotionFinder f        = {.assembly = assembly,
                             .roots    = roots_of(&c->scene->roots, ROOTS_ASSEMBLY).items,
                             .timed    = timed};
    if (!c->options->motion)
        return;
    graph_mark_timed(s->graph, timed);
    assembly->motions = arena_new_array(&c->scene->arena, KrsMotion, s->components.count + 1);
    for (size_t i = 0; i < s->components.count; i++) {
        KrsMotion *motion = &assembly->motions[i];
        uint32_t   item   = items > 0 ? assembly->of_component[i] : NO_ITEM;
        f.asked           = arena_new_array(&c->work, bool, items + 1);
        if (item != NO_ITEM)
            add_item(&f, item, motion);
        else
            motion->deforms = timed[distance_root(&c->scene->roots, i)];
        motion->recolors = recolors(&f, s->components.items[i].shape);
    }
}
