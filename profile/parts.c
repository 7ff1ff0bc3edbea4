/*
 * parts.c: the parts of a scene, found in the lists of its bounds.
 */
#include "profile/parts.h"

#include <stdio.h>
#include <string.h>

#include "compiler/base/text.h"

/* The list of a component, while parts are made of it. */
typedef struct Walk {
    const KrsScene *scene;
    Arena          *arena;
    Parts          *parts;
    size_t          component;
} Walk;

static bool has_location(const KrsLocation *location) { return location->end > 0; }

static bool are_equal(const KrsLocation *a, const KrsLocation *b)
{
    return a->start == b->start && a->end == b->end && strcmp(a->source, b->source) == 0;
}

/* Returns the index of the part of this place, or NO_PART. */
static size_t find_part(const Parts *parts, const KrsLocation *location)
{
    for (size_t i = 0; i < parts->count; i++)
        if (are_equal(&parts->items[i].location, location))
            return i;
    return NO_PART;
}

static bool entry_of(const Walk *walk, size_t index, KrsBound *bound)
{
    return krs_bound(walk->scene, walk->component, index, bound) == KRS_OK;
}

/* Returns the entry behind all that are in this one. */
static size_t end_of(const Walk *walk, size_t index)
{
    KrsBound bound, next;
    if (!entry_of(walk, index, &bound))
        return index;
    size_t end = index + 1;
    while (entry_of(walk, end, &next) && next.depth > bound.depth)
        end++;
    return end;
}

/* Tells whether there is exactly one entry in this one, which is the next then. */
static bool has_one(const Walk *walk, size_t index)
{
    KrsBound bound, next;
    return entry_of(walk, index, &bound) && entry_of(walk, index + 1, &next) &&
           next.depth > bound.depth && next.similar == 0 &&
           end_of(walk, index + 1) == end_of(walk, index);
}

/* Returns the part of a shape.  What moves or paints something is the same part: its place is the
   outermost of the author's, its name that of the author, or else the innermost. */
static Part part_of(const Walk *walk, size_t index, size_t *innermost)
{
    Part     part = {.count = 1};
    KrsBound bound;
    for (bool more = true; more && entry_of(walk, index, &bound); index++) {
        more = has_one(walk, index);
        if (!has_location(&part.location))
            part.location = (KrsLocation){bound.source, bound.start, bound.end, bound.line,
                                          bound.column};
        if (!part.name)
            part.name = bound.given;
        if (!more && !part.name)
            part.name = bound.name;
        part.count += bound.similar;
        *innermost = index;
    }
    return part;
}

static void add_operands(const Walk *walk, size_t index, size_t parent);

/* Adds what an entry is, or what is in it where it has no place of its own. */
static void add_operand(const Walk *walk, size_t index, size_t parent)
{
    size_t       innermost = index;
    Part         part      = part_of(walk, index, &innermost);
    const size_t known     = has_location(&part.location) ? find_part(walk->parts, &part.location)
                                                          : parent;
    part.parent            = parent;
    if (known == NO_PART) {
        array_push(walk->arena, walk->parts, part);
        add_operands(walk, innermost, walk->parts->count - 1);
        return;
    }
    if (known == parent) {
        add_operands(walk, innermost, parent);
        return;
    }
    Part *before = &walk->parts->items[known];
    before->count += part.count;
    before->shared = before->shared || before->parent != parent;
}

static void add_operands(const Walk *walk, size_t index, size_t parent)
{
    const size_t end = end_of(walk, index);
    for (size_t i = index + 1; i < end; i = end_of(walk, i))
        add_operand(walk, i, parent);
}

const char *part_words(const Part *part, size_t length, Arena *arena)
{
    const KrsLocation *location = &part->location;
    FILE              *file     = fopen(location->source, "rb");
    Text               words    = {.arena = arena};
    int                last     = ' ';
    if (!file || fseek(file, (long)location->start, SEEK_SET) != 0)
        location = NULL;
    for (uint32_t i = 0; location && i < location->end - location->start; i++) {
        const int  byte  = fgetc(file);
        const bool blank = byte == ' ' || byte == '\n' || byte == '\r' || byte == '\t';
        if (byte == EOF)
            break;
        if (words.length >= length && (byte & 0xc0) != 0x80) { /* no character is cut */
            text_add(&words, "...");
            break;
        }
        if (!blank || last != ' ')
            text_add_bytes(&words, (const char[]){blank ? ' ' : (char)byte}, 1);
        last = blank ? ' ' : byte;
    }
    if (file)
        fclose(file);
    return words.length > 0 ? words.bytes : part->name;
}

Parts parts_of(const KrsScene *scene, Arena *arena)
{
    Parts parts = {0};
    for (size_t i = 0; i < krs_component_count(scene); i++) {
        const Walk   walk = {scene, arena, &parts, i};
        KrsComponent component;
        size_t       innermost = 0;
        krs_component(scene, i, &component);
        if (!has_location(&component.location))
            continue;
        size_t top = find_part(&parts, &component.location);
        if (top != NO_PART) {
            parts.items[top].count++;
            continue;
        }
        Part part     = part_of(&walk, 0, &innermost);
        part.location = component.location;
        part.parent   = NO_PART;
        part.count    = 1;
        if (strncmp(component.name, "component ", 10) != 0) /* the author has named it */
            part.name = component.name;
        array_push(arena, &parts, part);
        add_operands(&walk, innermost, parts.count - 1);
    }
    return parts;
}
