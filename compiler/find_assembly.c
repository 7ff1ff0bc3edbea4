/*
 * find_assembly.c: finds the parts of components, and how they are placed, while there are shapes.
 *
 * Transforms, sharp unions and sequences are taken apart.  What else has copies in it is a part with
 * all of them.  Whether mirrors cut anything is asked for each frame (mesh/assemble.c).
 */
#include <string.h>

#include "compiler/compilation.h"

enum { MOST_ITEMS = 4096 };

/* A shape and its item. */
typedef struct Known {
    const Shape *shape;
    uint32_t     item;
} Known;

typedef struct Finder {
    Assembly *assembly;
    Arena    *arena; /* of the assembly */
    Arena    *work;
    struct {
        Node  *items;
        size_t count, capacity;
    } roots; /* of parts NODE_NONE until they are lowered */
    struct {
        Known *items;
        size_t count, capacity;
    } known, parts;
} Finder;

static uint32_t find_item(Finder *f, const Shape *shape);

static uint32_t add_roots(Finder *f, const Node *roots, size_t count)
{
    uint32_t first = (uint32_t)f->roots.count;
    for (size_t i = 0; i < count; i++)
        array_push(f->work, &f->roots, roots[i]);
    return first;
}

/* The placings of an item follow each other, so what they place is found before. */
static uint32_t add_item(Finder *f, const AssemblyPlacing *placings, uint32_t count)
{
    Assembly    *assembly = f->assembly;
    AssemblyItem item     = {.first = (uint32_t)assembly->placings.count, .count = count};
    for (uint32_t i = 0; i < count; i++)
        array_push(f->arena, &assembly->placings, placings[i]);
    array_push(f->arena, &assembly->items, item);
    return (uint32_t)assembly->items.count - 1;
}

static uint32_t add_part(Finder *f, const Shape *shape)
{
    static const Node later = NODE_NONE;
    AssemblyItem      item  = {
              .root = add_roots(f, &later, 1), .box = shape->box, .estimate = shape->estimate};
    array_push(f->arena, &f->assembly->items, item);
    uint32_t number = (uint32_t)f->assembly->items.count - 1;
    array_push(f->work, &f->parts, ((Known){shape, number}));
    return number;
}

static AssemblyPlacing mapped(Finder *f, uint32_t item, const Map *map)
{
    const MapRoots roots = {map->scale, {map->rows[0], map->rows[1], map->rows[2]}, map->shift};
    return (AssemblyPlacing){item, PLACED_MAPPED,
                             add_roots(f, (const Node *)&roots, NODES_OF(MapRoots))};
}

static AssemblyPlacing mirrored(Finder *f, uint32_t item, const SequenceStage *stage)
{
    const MirrorRoots roots = {stage->normal, stage->offset};
    return (AssemblyPlacing){item, PLACED_MIRRORED,
                             add_roots(f, (const Node *)&roots, NODES_OF(MirrorRoots))};
}

/* What a stage makes of the item before it, which may be NO_ITEM. */
static uint32_t take_stage(Finder *f, const Shape *krs, const SequenceStage *stage, uint32_t before)
{
    AssemblyPlacing placings[2] = {{before, PLACED_STILL, 0}};
    if (stage->kind == SEQUENCE_KERNEL) {
        uint32_t kernel = find_item(f, krs->children[stage->kernel]);
        placings[1]     = (AssemblyPlacing){kernel, PLACED_STILL, 0};
        return before == NO_ITEM ? kernel : add_item(f, placings, 2);
    }
    if (before == NO_ITEM)
        return NO_ITEM;
    if (stage->kind == SEQUENCE_REFLECT) {
        placings[1] = mirrored(f, before, stage);
        return add_item(f, placings, 2);
    }
    placings[0] = mapped(f, before, &stage->map);
    return add_item(f, placings, 1);
}

static uint32_t take_sequence(Finder *f, const Shape *krs)
{
    uint32_t item = NO_ITEM;
    for (uint32_t i = 0; i < krs->stage_count; i++)
        item = take_stage(f, krs, &krs->stages[i], item);
    return item == NO_ITEM ? add_part(f, krs) : item;
}

static uint32_t take_union(Finder *f, const Shape *shape)
{
    AssemblyPlacing *placings = arena_new_array(f->work, AssemblyPlacing, shape->child_count);
    for (uint32_t i = 0; i < shape->child_count; i++)
        placings[i].item = find_item(f, shape->children[i]);
    return add_item(f, placings, shape->child_count);
}

static uint32_t take_transform(Finder *f, const Shape *shape)
{
    AssemblyPlacing placing = mapped(f, find_item(f, shape->children[0]), &shape->map);
    return add_item(f, &placing, 1);
}

static bool is_rigid(const Shape *krs)
{
    for (uint32_t i = 0; i < krs->stage_count; i++)
        if (krs->stages[i].kind == SEQUENCE_SPHERE ||
            (krs->stages[i].kind == SEQUENCE_MAP && krs->stages[i].map.pole != NODE_NONE))
            return false;
    return true;
}

static uint32_t take_apart(Finder *f, const Shape *shape)
{
    bool sharp = shape->blend.width == NODE_NONE;
    if (shape->levels == 0 || f->assembly->items.count >= MOST_ITEMS)
        return add_part(f, shape);
    switch (shape->kind) {
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: return find_item(f, shape->children[0]);
    case SHAPE_TRANSFORM: return take_transform(f, shape);
    case SHAPE_UNION: return sharp ? take_union(f, shape) : add_part(f, shape);
    case SHAPE_KRS: return is_rigid(shape) ? take_sequence(f, shape) : add_part(f, shape);
    default: return add_part(f, shape);
    }
}

static uint32_t find_item(Finder *f, const Shape *shape)
{
    for (size_t i = 0; i < f->known.count; i++)
        if (f->known.items[i].shape == shape)
            return f->known.items[i].item;
    uint32_t item = take_apart(f, shape);
    array_push(f->work, &f->known, ((Known){shape, item}));
    return item;
}

static void find_components(Finder *f, const Scene *s)
{
    f->assembly->of_component = arena_new_array(f->arena, uint32_t, s->components.count + 1);
    for (size_t i = 0; i < s->components.count; i++) {
        const Component *component   = &s->components.items[i];
        bool             loop        = component->count > 1;
        uint32_t         item        = loop ? NO_ITEM : find_item(f, component->shape);
        bool             whole       = loop || f->assembly->items.items[item].count == 0;
        f->assembly->of_component[i] = whole ? NO_ITEM : item;
    }
}

RootRange find_assembly(Compilation *c, struct LoweredCrowds *crowds)
{
    Finder f = {.assembly = &c->scene->assembly, .arena = &c->scene->arena, .work = &c->work};
    if (!c->options->assembly)
        return (RootRange){0};
    find_components(&f, &c->elaborated);
    for (size_t i = 0; i < f.parts.count; i++) {
        const Known *part = &f.parts.items[i];
        uint32_t     root = f.assembly->items.items[part->item].root;
        if (!lower_solid(c->elaborated.graph, part->shape, crowds, &c->scratch,
                         &f.roots.items[root])) {
            *f.assembly = (Assembly){0}; /* too large: it is meshed as a whole */
            return (RootRange){0};
        }
    }
    return (RootRange){f.roots.items, f.roots.count};
}
