/*
 * fillet.c: unions whose CSG nodes are rounded and never swell.
 *
 * Of two parts that is their circular blend, cut by a region that holds both: their convex hull or, where
 * that cannot be said, what is left by the planes of their faces, and by cylinders and balls about what
 * is round in them.  Of more parts it is the union of all pairs.  What is a sharp union counts as its
 * parts, without fillets between these.
 */
#include "compiler/eval/hulls/fillet.h"

#include <math.h>
#include <stdlib.h>

#include "compiler/eval/declared/declare.h"
#include "compiler/eval/hulls/hull_region.h"
#include "compiler/family/family.h"
#include "compiler/lower/instance_groups.h"

enum { MAX_PARTS = 20000, MAX_PAIRS = 20000 };

/* The numbers of points at which it is looked for what a fillet adds: for a pair of few, and of
   many. */
enum { POINTS_OF_FEW = 2000, POINTS_OF_MANY = 200 };

/* A part of a CSG node, and the number of the shape that it belongs to. */
typedef struct FilletPart {
    const Shape *shape;
    uint32_t     owner;
    bool         paired;
    Extents      extents;
    size_t       number; /* in the order of the text */
} FilletPart;

typedef struct FilletParts {
    FilletPart *items;
    size_t      count, capacity;
} FilletParts;

typedef struct Shapes {
    const Shape **items;
    size_t        count, capacity;
} Shapes;

/* Two of them that are near to each other, and a box around all that a fillet can add to them. */
typedef struct FilletPair {
    FilletPart *a, *b;
    Box         box;
} FilletPair;

typedef struct Filleting {
    Elaboration *e;
    const Call  *call;
    Blend        blend;
    double       widest;
    FilletParts  parts;
    struct {
        FilletPair *items;
        size_t      count, capacity;
    } pairs;
} Filleting;

/* ---- parts ---- */

static bool has_clip(const Shape *shape)
{
    bool found = shape->kind == SHAPE_CLIP;
    for (uint32_t i = 0; i < shape->child_count && !found; i++)
        found = has_clip(shape->children[i]);
    return found;
}

static const Shape *wrapped(Elaboration *e, const Shape *wrapper, const Shape *part)
{
    switch (wrapper->kind) {
    case SHAPE_PAINT: return make_paint(e->builder, part, wrapper->material, wrapper->span);
    case SHAPE_SMOOTH: return make_smooth(e->builder, part, wrapper->values[0], wrapper->span);
    default: return make_transform(e->builder, part, &wrapper->map, wrapper->span);
    }
}

/* Adds the parts of a sharp union, wherever it has been put and however it is painted. */
static bool add_parts(Elaboration *e, const Shape *shape, Shapes *parts)
{
    const size_t first   = parts->count;
    const bool   wrapper = shape->kind == SHAPE_PAINT || shape->kind == SHAPE_SMOOTH ||
                         shape->kind == SHAPE_TRANSFORM;
    const bool sharp = shape->kind == SHAPE_UNION && shape->blend.width == NODE_NONE;
    if (parts->count > MAX_PARTS)
        return true; /* reported below */
    shape = iteration_alone(e, shape);
    if (!shape)
        return false;
    if (sharp || wrapper) {
        for (uint32_t i = 0; i < shape->child_count; i++)
            if (!add_parts(e, shape->children[i], parts))
                return false;
        if (sharp)
            return true;
        if (parts->count != first + 1 || parts->items[first] != shape->children[0]) {
            for (size_t i = first; i < parts->count; i++)
                if (!(parts->items[i] = wrapped(e, shape, parts->items[i])))
                    return false;
            return true;
        }
        parts->count = first;
    }
    if (!box_is_empty(shape->box))
        array_push(e->values, parts, shape);
    return true;
}

static bool refuse_many(Filleting *f, const char *what)
{
    Diag *diag = diag_add(f->e->diags, DIAG_LIMIT, f->call->syntax->span, "%s", what);
    diag->help =
        "join sharply, with `|`, what needs no fillets in between: parts of such a union get "
        "none among themselves";
    return false;
}

static bool add_shape_parts(Filleting *f, const Shape *shape, uint32_t owner)
{
    Elaboration *e     = f->e;
    Shapes       parts = {0};
    if (!add_parts(e, shape, &parts))
        return false;
    for (size_t i = 0; i < parts.count; i++) {
        FilletPart part = {.shape = parts.items[i], .owner = owner};
        if (f->parts.count == MAX_PARTS)
            return refuse_many(f, "fillets between more than 20,000 parts");
        extents_add(e, part.shape, &part.extents);
        array_push(e->values, &f->parts, part);
    }
    return true;
}

/* ---- pairs ---- */

/* Makes the fillet of a pair; NULL: it adds nothing. */
static const Shape *make_pair(Filleting *f, const FilletPair *pair)
{
    Elaboration     *e       = f->e;
    const Span       span    = f->call->syntax->span;
    const Shape     *parts[] = {pair->a->shape, pair->b->shape};
    const bool       many    = f->pairs.count >= MIN_INSTANCES;
    const FilletZone zone    = fillet_zone(e, parts[0], parts[1], f->widest, pair->box,
                                        many ? POINTS_OF_MANY : POINTS_OF_FEW);
    if (zone.known && zone.cells.count == 0)
        return NULL;
    const Extents extents  = extents_of_both(e, &pair->a->extents, &pair->b->extents);
    const Shape  *region   = hull_region(e, f->call, &extents, &zone, many);
    const Shape  *csg_node = make_csg_node(e->builder, SHAPE_UNION, parts, 2, f->blend, span);
    Node          corners[2];
    bool          boxed = !many && extents_box(e, &extents, corners);
    pair->a->paired = pair->b->paired = true;
    return make_clip(e->builder, csg_node, region, boxed ? corners : NULL, span);
}

static bool refuse_endless(Filleting *f, const FilletPart *part)
{
    Diag *diag = diag_add(f->e->diags, DIAG_BAD_VALUE, f->call->syntax->span,
                          "a fillet needs to know how far its parts reach");
    diag->help = "cut what is endless, by `.within(box([10, 10, 10]))`, say";
    diag_secondary(f->e->diags, diag, part->shape->span, "this is endless");
    return false;
}

static int compare_parts(const void *first, const void *second)
{
    const FilletPart *a = first, *b = second;
    const double      from = a->shape->box.axis[0].low, of = b->shape->box.axis[0].low;
    if (from != of)
        return from < of ? -1 : 1;
    return (a->number > b->number) - (a->number < b->number);
}

static bool add_pair(Filleting *f, FilletPart *a, FilletPart *b)
{
    const Box box = box_common(box_grow(a->shape->box, f->widest),
                               box_grow(b->shape->box, f->widest));
    if (a->owner == b->owner || box_is_empty(box))
        return true;
    if (a->extents.endless || b->extents.endless)
        return refuse_endless(f, a->extents.endless ? a : b);
    if (f->pairs.count == MAX_PAIRS)
        return refuse_many(f, "fillets between more than 20,000 pairs of near parts");
    array_push(f->e->values, &f->pairs, ((FilletPair){a, b, box}));
    return true;
}

static bool add_pairs(Filleting *f)
{
    FilletPart *parts = f->parts.items;
    for (size_t i = 0; i < f->parts.count; i++)
        parts[i].number = i;
    qsort(parts, f->parts.count, sizeof *parts, compare_parts);
    for (size_t i = 0; i < f->parts.count; i++)
        for (size_t k = i + 1; k < f->parts.count; k++) {
            const Range after = parts[k].shape->box.axis[0], before = parts[i].shape->box.axis[0];
            if (after.low - f->widest > before.high + f->widest)
                break;
            if (!add_pair(f, &parts[i], &parts[k]))
                return false;
        }
    return true;
}

const Shape *make_fillet(Elaboration *e, const Call *call, const Shape *const *shapes,
                         uint32_t count, Blend blend)
{
    Filleting f = {.e = e, .call = call, .blend = blend};
    if (e->iterated)
        return NULL; /* which parts are near is known iteration by iteration */
    f.widest = fmax(node_range(e->builder, blend.width, 0).high, 0);
    for (uint32_t i = 0; i < count; i++)
        if (!add_shape_parts(&f, shapes[i], i))
            return NULL;
    if (!add_pairs(&f))
        return NULL;
    Shapes joined = {0};
    for (size_t i = 0; i < f.pairs.count && !is_stopped(e); i++) {
        const Shape *pair = make_pair(&f, &f.pairs.items[i]);
        if (pair)
            array_push(e->values, &joined, pair);
    }
    for (size_t i = 0; i < f.parts.count; i++) /* a region may cut what was a fillet by a hair */
        if (!f.parts.items[i].paired || has_clip(f.parts.items[i].shape))
            array_push(e->values, &joined, f.parts.items[i].shape);
    if (joined.count == 1)
        return joined.items[0];
    return value_of_csg_node(e,
                             make_csg_node(e->builder, SHAPE_UNION, joined.items,
                                           (uint32_t)joined.count, blend_sharp, call->syntax->span))
        .shape;
}
