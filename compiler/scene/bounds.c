/*
 * bounds.c: what is known of the distance of every shape of a scene, and by which rule, for those
 * who ask after shapes are gone (`krs info`).
 *
 * A list of each tree, parents first.  Parts that were made in the same place of the text, as in a
 * loop, and have one structure, are one entry; a part that is met again refers to the first time.
 */
#include "compiler/scene/bounds.h"

#include <string.h>

typedef struct Listing {
    Arena           *arena, *scratch;
    const Sources   *sources;
    const KrsBounds *before; /* of another tree, whose entries may say the same; or NULL */
    struct {
        BoundEntry *items;
        size_t      count, capacity;
    } entries;
    struct {
        const Shape **items;
        size_t        count, capacity;
    } shapes; /* of the entries */
    size_t more;
} Listing;

static const char *box_text(Listing *l, Box box)
{
    Text text = {.arena = l->scratch};
    text_format(&text, "[%.4g, %.4g, %.4g] to [%.4g, %.4g, %.4g]", box.axis[0].low, box.axis[1].low,
                box.axis[2].low, box.axis[0].high, box.axis[1].high, box.axis[2].high);
    return text.bytes;
}

static void add_derived(Listing *l, const Shape *shape, Text *rule)
{
    const char *when = shape->per_frame ? " at first, derived for each frame" : " derived";
    if (box_is_finite(shape->field->region))
        text_format(rule, "slope %.4g%s by intervals over %s", shape->derived, when,
                    box_text(l, shape->field->region));
    else
        text_format(rule, "slope %.4g%s by norms over all space", shape->derived, when);
    text_add(rule, shape->derived > 1 ? ", divided out" : "");
}

static const char *primitive_rule(Listing *l, const Shape *shape)
{
    Text rule = {.arena = l->scratch};
    if (shape->estimate)
        text_add(&rule, "an estimate: measured, not proven");
    else if (shape->exact)
        text_add(&rule, "exact, by claim");
    else if (shape->claimed)
        text_format(&rule, "slope %.4g, by claim%s", shape->derived,
                    shape->derived > 1 ? ", divided out" : "");
    else if (shape->field->degree > 0)
        text_format(&rule, "polynomial of degree %u, by its series in balls", shape->field->degree);
    else if (shape->trapped)
        text_add(&rule, "a ball around an escaped iterate, stepped back");
    else
        add_derived(l, shape, &rule);
    if (shape->bound != NODE_NONE)
        text_add(&rule, "; a sharper bound below sharp joints");
    return rule.bytes;
}

static const char *rule_of(Listing *l, const Shape *shape)
{
    if (shape->kind == SHAPE_PRIMITIVE)
        return primitive_rule(l, shape);
    Text rule = {.arena = l->scratch};
    text_add(&rule, shape_info[shape->kind].rule);
    if (shape->blend.width != NODE_NONE)
        text_format(&rule, ", %s blend of factor %.4g", blend_info[shape->blend.kind].spelling,
                    blend_info[shape->blend.kind].slope);
    if (shape_info[shape->kind].divided)
        text_format(&rule, ", of factor %.4g %s", shape->derived,
                    shape->per_frame ? "at first, derived for each frame, divided out"
                                     : "at most, divided out");
    return rule.bytes;
}

/* Tells whether two shapes were made in the same place of the text, all through. */
static bool are_alike(const Shape *a, const Shape *b)
{
    a = shape_in_iterations(a);
    b = shape_in_iterations(b);
    if (a == b)
        return true;
    if (a->kind != b->kind || a->child_count != b->child_count ||
        a->span.source != b->span.source || a->span.start != b->span.start ||
        a->span.end != b->span.end || a->exact != b->exact || a->slope != b->slope)
        return false;
    for (uint32_t i = 0; i < a->child_count; i++)
        if (!are_alike(a->children[i], b->children[i]))
            return false;
    return true;
}

/* Returns the number, from 1, of the entry that a shape has already; 0: none. */
static size_t entry_of(const Listing *l, const Shape *shape)
{
    for (size_t i = 0; i < l->shapes.count; i++)
        if (l->shapes.items[i] == shape)
            return i + 1;
    return 0;
}

static bool say_the_same(const KrsBound *a, const KrsBound *b)
{
    return a->depth == b->depth && a->line == b->line && a->column == b->column &&
           a->slope == b->slope && a->exact == b->exact && a->estimate == b->estimate &&
           a->levels == b->levels && a->instances == b->instances && a->similar == b->similar &&
           a->same == b->same && a->start == b->start && a->end == b->end &&
           !a->given == !b->given && (!a->given || !strcmp(a->given, b->given)) &&
           !strcmp(a->name, b->name) && !strcmp(a->source, b->source) && !strcmp(a->rule, b->rule);
}

static const char *copy_text(Listing *l, const char *text)
{
    return arena_copy_text(l->arena, text, strlen(text));
}

/* Returns what is said of the next entry, where it stays. */
static const KrsBound *lasting(Listing *l, const KrsBound *about)
{
    size_t number = l->entries.count;
    if (l->before && number < l->before->count &&
        say_the_same(l->before->items[number].about, about))
        return l->before->items[number].about;
    KrsBound *copy = arena_new(l->arena, KrsBound);
    *copy          = *about;
    copy->name     = copy_text(l, about->name);
    copy->source   = copy_text(l, about->source);
    copy->rule     = copy_text(l, about->rule);
    copy->given    = about->given ? copy_text(l, about->given) : NULL;
    return copy;
}

static BoundEntry entry_for(Listing *l, const Shape *shape, Box box, uint32_t depth,
                            uint32_t similar, size_t same)
{
    const Source *source = &l->sources->items[shape->span.source];
    KrsBound      about  = {.depth     = depth,
                            .similar   = similar,
                            .same      = same,
                            .name      = shape->name,
                            .given     = shape->given,
                            .source    = source->name,
                            .rule      = rule_of(l, shape),
                            .slope     = shape->slope,
                            .exact     = shape->exact,
                            .estimate  = shape->estimate,
                            .levels    = shape->levels,
                            .instances = shape->instances};
    if (shape->span.source) {
        Position position = source_position(source, shape->span.start);
        about.line        = position.line;
        about.column      = position.column;
    }
    if (!source->library) {
        about.start = shape->span.start;
        about.end   = shape->span.end;
    }
    BoundEntry entry = {.about = lasting(l, &about)};
    for (int i = 0; i < 3; i++) {
        entry.low[i]  = box.axis[i].low;
        entry.high[i] = box.axis[i].high;
    }
    return entry;
}

static void list_shape(Listing *l, const Shape *shape, uint32_t depth, uint32_t similar)
{
    if (l->entries.count == KRS_MAX_BOUNDS) {
        l->more++;
        return;
    }
    const Box box    = shape->box;
    shape            = shape_in_iterations(shape);
    size_t     same  = entry_of(l, shape);
    BoundEntry entry = entry_for(l, shape, box, depth, similar, same);
    array_push(l->scratch, &l->entries, entry);
    array_push(l->scratch, &l->shapes, shape);
    for (uint32_t i = 0; i < shape->child_count && !same;) {
        uint32_t next = i + 1;
        while (next < shape->child_count && are_alike(shape->children[i], shape->children[next]))
            next++;
        list_shape(l, shape->children[i], depth + 1, next - i - 1);
        i = next;
    }
}

KrsBounds bounds_of(const Shape *shape, const Sources *sources, const KrsBounds *before,
                    Arena *arena, Arena *scratch)
{
    Listing l = {.arena = arena, .scratch = scratch, .sources = sources, .before = before};
    list_shape(&l, shape, 0, 0);
    KrsBounds list = {arena_new_array(arena, BoundEntry, l.entries.count), l.entries.count, l.more};
    memcpy(list.items, l.entries.items, l.entries.count * sizeof *list.items);
    return list;
}
