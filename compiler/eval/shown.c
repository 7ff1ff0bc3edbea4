/*
 * shown.c: components that are alike, as one component.
 *
 * A component has functions of its own in the shaders.  Thousands of them would be as slow to compile as
 * thousands of shapes; as one they are as fast as a union.  Users still see each as a component with a
 * name and a number.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/eval/elaborate.h"

/* Fewer iterations of a `show` in a loop stay separate, and fewer shapes of one form: each is then
   marched for itself, and left out where it is far.  Forms become one only where an instance group
   may come of it. */
enum { MIN_ITERATIONS = 32, MIN_OF_A_FORM = 64 };
/* The form of a tree of shapes is told by no more of it than that. */
enum { MAX_FORM_SHAPES = 64 };

static bool can_be_gathered(const Component *component)
{
    return component->plane_normal == NODE_NONE && box_is_finite(component->shape->box);
}

/* ---- keys ---- */

typedef struct Key {
    uint64_t hash;
    size_t   shown;
} Key;

static uint64_t hash_with(uint64_t hash, uint64_t word)
{
    hash ^= word + 0x9E3779B97F4A7C15u + (hash << 6) + (hash >> 2);
    return hash * 0xD6E8FEB86659FD93u;
}

/* Hashes the place of a component, which is equal for iterations of one `show`. */
static uint64_t hash_of_place(const Component *component)
{
    uint64_t hash = hash_with(component->span.source, component->span.start);
    return hash_with(hash, component->span.end);
}

/* Places of texts tell which it is: addresses differ from run to run. */
static uint64_t hash_of_declaration(const Shape *shape)
{
    const Syntax *syntax = shape->declaration ? shape->declaration->syntax : NULL;
    return syntax ? hash_with(syntax->span.source, syntax->span.start) : 0;
}

/* Hashes the structure of a shape, without its numbers. */
static uint64_t hash_of_form(const Shape *shape, int *left)
{
    uint64_t hash = hash_with(shape->kind, shape->child_count);
    hash          = hash_with(hash, hash_of_declaration(shape));
    hash          = hash_with(hash, shape->blend.kind);
    hash          = hash_with(hash, shape->blend.width != NODE_NONE);
    hash          = hash_with(hash, shape->stage_count);
    for (uint32_t i = 0; *left > 0 && i < shape->child_count; i++) {
        --*left;
        hash = hash_with(hash, hash_of_form(shape->children[i], left));
    }
    return hash;
}

static int compare_keys(const void *a, const void *b)
{
    const Key *x = a, *y = b;
    if (x->hash != y->hash)
        return x->hash < y->hash ? -1 : 1;
    return (x->shown > y->shown) - (x->shown < y->shown);
}

/* ---- groups ---- */

/* The groups of what is shown: for each one the first of its group, and the next. */
typedef struct Gathering {
    const Component *shown;
    size_t           count;
    size_t          *first, *next;
    Key             *keys;
} Gathering;

static bool is_alone(const Gathering *g, size_t i)
{
    return g->first[i] == i && g->next[i] == NO_COMPONENT;
}

/* Makes groups of those with equal keys that are alone yet. */
static void group(Gathering *g, size_t key_count, size_t least)
{
    qsort(g->keys, key_count, sizeof *g->keys, compare_keys);
    for (size_t i = 0, end; i < key_count; i = end) {
        for (end = i + 1; end < key_count && g->keys[end].hash == g->keys[i].hash;)
            end++;
        for (size_t k = i; end - i >= least && k < end; k++) {
            g->first[g->keys[k].shown] = g->keys[i].shown;
            g->next[g->keys[k].shown]  = k + 1 < end ? g->keys[k + 1].shown : NO_COMPONENT;
        }
    }
}

static void find_groups(Gathering *g)
{
    size_t keys = 0;
    for (size_t i = 0; i < g->count; i++) {
        g->first[i] = i;
        g->next[i]  = NO_COMPONENT;
        if (can_be_gathered(&g->shown[i]))
            g->keys[keys++] = (Key){hash_of_place(&g->shown[i]), i};
    }
    group(g, keys, MIN_ITERATIONS);
    keys = 0;
    for (size_t i = 0; i < g->count; i++) {
        int left = MAX_FORM_SHAPES;
        if (can_be_gathered(&g->shown[i]) && is_alone(g, i))
            g->keys[keys++] = (Key){hash_of_form(g->shown[i].shape, &left), i};
    }
    group(g, keys, MIN_OF_A_FORM);
}

/* Joins a group, in which each knows its number. */
static const Shape *join_group(Elaboration *e, const Gathering *g, size_t first, size_t count)
{
    const Shape **shapes = arena_new_array(e->values, const Shape *, count);
    size_t        made   = 0;
    for (size_t i = first; i != NO_COMPONENT; i = g->next[i]) {
        Shape *shape   = arena_new(e->arena, Shape);
        *shape         = *g->shown[i].shape;
        shape->shown   = (uint32_t)i + 1;
        shapes[made++] = shape;
    }
    return make_csg_node(e->builder, SHAPE_UNION, shapes, (uint32_t)count, blend_sharp,
                         g->shown[first].span);
}

void gather_shown(Elaboration *e)
{
    Scene *scene            = e->scene;
    scene->shown            = scene->components;
    scene->components.items = NULL;
    scene->components.count = scene->components.capacity = 0;

    const size_t count = scene->shown.count;
    Gathering    g     = {.shown = scene->shown.items,
                          .count = count,
                          .first = arena_new_array(e->values, size_t, count + 1),
                          .next  = arena_new_array(e->values, size_t, count + 1),
                          .keys  = arena_new_array(e->values, Key, count + 1)};
    find_groups(&g);
    for (size_t i = 0; i < count; i++) {
        if (g.first[i] != i)
            continue;
        Component component = scene->shown.items[i];
        component.count     = 0;
        for (size_t k = i; k != NO_COMPONENT; k = g.next[k]) {
            scene->shown.items[k].lowered = scene->components.count;
            scene->shown.items[k].next    = g.next[k];
            scene->shown.items[k].rank    = component.count++;
        }
        if (component.count > 1)
            component.shape = join_group(e, &g, i, component.count);
        array_push_large(e->arena, &scene->components, component);
    }
}
