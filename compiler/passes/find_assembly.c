/*
 * find_assembly.c: finds the parts of components, and how they are placed, while there are shapes.
 *
 * Transforms, sharp unions and sequences are taken apart.  What else has copies in it is a part with
 * all of them.  Whether mirrors cut anything is asked for each state (mesh/assemble.c).
 *
 * With KrsOptions.motion so is what the time moves: transforms that depend on it, and the unions
 * and iterations of loops around them.  What stands still in a union is one part.
 */
#include <string.h>

#include "compiler/passes/compilation.h"
#include "compiler/graph/timed.h"
#include "compiler/graph/instances/iterations.h"

enum { MAX_ITEMS = 4096 };

/* A shape and its item, in an iteration of a loop and below the paint that counts. */
typedef struct Known {
    const Shape *shape, *iteration, *paint; /* NULL: in none */
    uint32_t     item;
} Known;

typedef struct Finder {
    Assembly    *assembly;
    Arena       *arena; /* of the assembly */
    Arena       *work, *scratch;
    Graph       *graph;
    bool        *timed;     /* nodes of shapes that depend on the time; NULL: nobody asks */
    const Shape *iteration; /* around the shape that is looked at; NULL: none, */
    const Shape *paint;     /* and above it, where the time moves something */
    const char  *name; /* of the nearest shape at it or above that has one, or of the component */
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

/* The transforms of an item follow each other, so what they place is found before. */
static uint32_t add_item(Finder *f, const AssemblyTransform *transforms, uint32_t count)
{
    Assembly    *assembly = f->assembly;
    AssemblyItem item     = {.first = (uint32_t)assembly->transforms.count, .count = count};
    for (uint32_t i = 0; i < count; i++)
        array_push(f->arena, &assembly->transforms, transforms[i]);
    array_push(f->arena, &assembly->items, item);
    return (uint32_t)assembly->items.count - 1;
}

static uint32_t add_part(Finder *f, const Shape *shape)
{
    static const Node later = NODE_NONE;
    AssemblyItem      item  = {.root     = add_roots(f, &later, 1),
                               .box      = shape->box,
                               .estimate = shape->estimate,
                               .name     = arena_copy_text(f->arena, f->name, strlen(f->name))};
    array_push(f->arena, &f->assembly->items, item);
    uint32_t number = (uint32_t)f->assembly->items.count - 1;
    array_push(f->work, &f->parts, ((Known){shape, f->iteration, f->paint, number}));
    return number;
}

static Node in_iteration(const Finder *f, Node node)
{
    return f->iteration ? graph_in_iteration(f->graph, node, f->iteration->iteration,
                                             f->iteration->number, f->scratch)
                        : node;
}

static AssemblyTransform mapped(Finder *f, uint32_t item, const Map *map)
{
    const MapRoots roots = {in_iteration(f, map->scale),
                            {in_iteration(f, map->rows[0]), in_iteration(f, map->rows[1]),
                             in_iteration(f, map->rows[2])},
                            in_iteration(f, map->shift)};
    return (AssemblyTransform){item, PLACED_MAPPED,
                               add_roots(f, (const Node *)&roots, NODES_OF(MapRoots))};
}

static AssemblyTransform mirrored(Finder *f, uint32_t item, const SequenceStage *stage)
{
    const MirrorRoots roots = {stage->normal, stage->offset};
    return (AssemblyTransform){item, PLACED_MIRRORED,
                               add_roots(f, (const Node *)&roots, NODES_OF(MirrorRoots))};
}

/* Returns what a stage makes of the item before it, which may be NO_ITEM. */
static uint32_t take_stage(Finder *f, const Shape *krs, const SequenceStage *stage, uint32_t before)
{
    AssemblyTransform transforms[2] = {{before, PLACED_STILL, 0}};
    if (stage->kind == SEQUENCE_KERNEL) {
        uint32_t kernel = find_item(f, krs->children[stage->kernel]);
        transforms[1]   = (AssemblyTransform){kernel, PLACED_STILL, 0};
        return before == NO_ITEM ? kernel : add_item(f, transforms, 2);
    }
    if (before == NO_ITEM)
        return NO_ITEM;
    if (stage->kind == SEQUENCE_REFLECT) {
        transforms[1] = mirrored(f, before, stage);
        return add_item(f, transforms, 2);
    }
    transforms[0] = mapped(f, before, &stage->map);
    return add_item(f, transforms, 1);
}

static uint32_t take_sequence(Finder *f, const Shape *krs)
{
    uint32_t item = NO_ITEM;
    for (uint32_t i = 0; i < krs->stage_count; i++)
        item = take_stage(f, krs, &krs->stages[i], item);
    return item == NO_ITEM ? add_part(f, krs) : item;
}

/* Tells whether the time moves parts of a shape. */
static bool moves(const Finder *f, const Shape *shape)
{
    const Map *map = &shape->map;
    switch (f->timed ? shape->kind : SHAPE_EMPTY) {
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: return moves(f, shape->children[0]);
    case SHAPE_TRANSFORM:
        return f->timed[map->shift] || f->timed[map->rows[0]] || f->timed[map->rows[1]] ||
               f->timed[map->rows[2]] || moves(f, shape->children[0]);
    case SHAPE_ITERATION: return moves(f, shape->iterated);
    case SHAPE_UNION:
        for (uint32_t i = 0; shape->blend.width == NODE_NONE && i < shape->child_count; i++)
            if (moves(f, shape->children[i]))
                return true;
        return false;
    default: return false;
    }
}

/* Parts of a union, and of unions in it of which parts move. */
typedef struct UnionParts {
    const Shape **items;
    size_t        count, capacity;
} UnionParts;

/* Sorts parts: those that neither move nor have copies go to `still`. */
static void sort_parts(Finder *f, const Shape *shape, UnionParts *still, UnionParts *others)
{
    for (uint32_t i = 0; i < shape->child_count; i++) {
        const Shape *part = shape->children[i];
        if (!moves(f, part) && part->levels == 0)
            array_push(f->work, still, part);
        else if (part->kind == SHAPE_UNION && moves(f, part))
            sort_parts(f, part, still, others);
        else
            array_push(f->work, others, part);
    }
}

/* Takes a union, of which all that stands still is one part. */
static uint32_t take_moving_union(Finder *f, const Shape *shape)
{
    UnionParts still = {0}, others = {0};
    sort_parts(f, shape, &still, &others);
    AssemblyTransform *transforms = arena_new_array(f->work, AssemblyTransform, others.count + 1);
    uint32_t           count      = 0;
    if (still.count > 0) {
        Shape *whole             = arena_new(f->work, Shape);
        *whole                   = *shape;
        whole->children          = still.items;
        whole->child_count       = (uint32_t)still.count;
        whole->levels            = 0;
        transforms[count++].item = find_item(f, still.count > 1 ? whole : still.items[0]);
    }
    for (size_t i = 0; i < others.count; i++)
        transforms[count++].item = find_item(f, others.items[i]);
    return add_item(f, transforms, count);
}

static uint32_t take_union(Finder *f, const Shape *shape)
{
    if (moves(f, shape))
        return take_moving_union(f, shape);
    AssemblyTransform *transforms = arena_new_array(f->work, AssemblyTransform, shape->child_count);
    for (uint32_t i = 0; i < shape->child_count; i++)
        transforms[i].item = find_item(f, shape->children[i]);
    return add_item(f, transforms, shape->child_count);
}

/* The outermost paint counts.  Copies of a part are alike below it only. */
static uint32_t take_paint(Finder *f, const Shape *shape)
{
    const Shape *above = f->paint;
    f->paint           = above || !f->timed ? above : shape;
    uint32_t item      = find_item(f, shape->children[0]);
    f->paint           = above;
    return item;
}

static uint32_t take_iteration(Finder *f, const Shape *shape)
{
    f->iteration  = shape;
    uint32_t item = find_item(f, shape->iterated);
    f->iteration  = NULL;
    return item;
}

static uint32_t take_transform(Finder *f, const Shape *shape)
{
    AssemblyTransform transform = mapped(f, find_item(f, shape->children[0]), &shape->map);
    return add_item(f, &transform, 1);
}

static bool is_rigid(const Shape *krs)
{
    for (uint32_t i = 0; i < krs->stage_count; i++)
        if (krs->stages[i].kind == SEQUENCE_SPHERE ||
            (krs->stages[i].kind == SEQUENCE_MAP && krs->stages[i].map.pole != NODE_NONE))
            return false;
    return true;
}

static uint32_t take_parts(Finder *f, const Shape *shape)
{
    bool sharp = shape->blend.width == NODE_NONE;
    if ((shape->levels == 0 && !moves(f, shape)) || f->assembly->items.count >= MAX_ITEMS)
        return add_part(f, shape);
    switch (shape->kind) {
    case SHAPE_PAINT: return take_paint(f, shape);
    case SHAPE_SMOOTH: return find_item(f, shape->children[0]);
    case SHAPE_TRANSFORM: return take_transform(f, shape);
    case SHAPE_UNION: return sharp ? take_union(f, shape) : add_part(f, shape);
    case SHAPE_KRS: return is_rigid(shape) ? take_sequence(f, shape) : add_part(f, shape);
    case SHAPE_ITERATION:
        return f->timed && !f->iteration ? take_iteration(f, shape) : add_part(f, shape);
    default: return add_part(f, shape);
    }
}

/* Tells whether a material differs from place to place. */
static bool is_local(const Graph *graph, const Material *material)
{
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends)          \
    if (material->name != NODE_NONE && graph->items[material->name].time == TIME_POINT) \
        return true;
#include "krs/surface.def"
    return false;
}

/* Returns what is known of a shape; one that is painted by its place differs in each copy. */
static const Known *find_known(const Finder *f, const Shape *shape)
{
    if (f->paint && is_local(f->graph, f->paint->material))
        return NULL;
    for (size_t i = 0; i < f->known.count; i++) {
        const Known *known = &f->known.items[i];
        if (known->shape == shape && known->iteration == f->iteration && known->paint == f->paint)
            return known;
    }
    return NULL;
}

static uint32_t find_item(Finder *f, const Shape *shape)
{
    const Known *known = find_known(f, shape);
    if (known)
        return known->item;
    const char *above = f->name;
    f->name           = shape->given ? shape->given : above;
    uint32_t item     = take_parts(f, shape);
    f->name           = above;
    array_push(f->work, &f->known, ((Known){shape, f->iteration, f->paint, item}));
    return item;
}

static void find_components(Finder *f, const Scene *s)
{
    f->assembly->of_component = arena_new_array(f->arena, uint32_t, s->components.count + 1);
    for (size_t i = 0; i < s->components.count; i++) {
        const Component *component   = &s->components.items[i];
        f->name                      = component->name;
        bool     loop                = component->count > 1 && !moves(f, component->shape);
        uint32_t item                = loop ? NO_ITEM : find_item(f, component->shape);
        bool     whole               = loop || f->assembly->items.items[item].count == 0;
        f->assembly->of_component[i] = whole ? NO_ITEM : item;
    }
}

static void keep_beams(Finder *f, const Compilation *c)
{
    const Scene *s = &c->elaborated;
    if (!c->options->beams)
        return;
    f->assembly->beams = arena_new_array(f->arena, AssemblyBeams, s->shown.count + 1);
    for (size_t i = 0; i < s->shown.count; i++) {
        const Component *shown = &s->shown.items[i];
        f->assembly->beams[i]  = (AssemblyBeams){
             add_roots(f, (const Node *)shown->beams, shown->beam_count * NODES_OF(SceneBeam)),
             shown->beam_count};
    }
}

/* Returns the part in its iteration. */
static const Shape *part_shape(Finder *f, const Known *part)
{
    if (!part->iteration)
        return part->shape;
    Shape *shape = arena_new(f->work, Shape);
    *shape       = *part->iteration;
    shape_takes_over(shape, part->shape);
    shape->iterated = part->shape;
    shape->box      = part->shape->box;
    return shape;
}

RootRange find_assembly(Compilation *c, struct LoweredGroups *groups)
{
    Finder f = {.assembly = &c->scene->assembly,
                .arena    = &c->scene->arena,
                .work     = &c->work,
                .scratch  = &c->scratch,
                .graph    = c->elaborated.graph};
    if (!c->options->assembly)
        return (RootRange){0};
    if (c->options->motion) {
        f.timed = arena_new_array(&c->work, bool, f.graph->count);
        graph_mark_timed(f.graph, f.timed);
    }
    find_components(&f, &c->elaborated);
    keep_beams(&f, c);
    for (size_t i = 0; i < f.parts.count; i++) {
        const Known *part = &f.parts.items[i];
        uint32_t     root = f.assembly->items.items[part->item].root;
        if (!lower_solid(f.graph, part_shape(&f, part), groups, &c->scratch,
                         &f.roots.items[root])) {
            *f.assembly = (Assembly){0}; /* too large: it is meshed as a whole */
            return (RootRange){0};
        }
    }
    return (RootRange){f.roots.items, f.roots.count};
}
