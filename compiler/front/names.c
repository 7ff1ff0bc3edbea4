/*
 * names.c: checks, before anything is evaluated, that every name is defined, and tells what each means.
 *
 * One walk over the tree, with a table of the current meaning of each name.  Entering a scope adds
 * its definitions, leaving it restores what they hid.  The walk also records which top-level
 * definitions need which others, and Tarjan's algorithm finds cycles in that graph at the end.
 */
#include "compiler/front/names.h"

#include <string.h>

#include "compiler/base/fnv.h"
#include "compiler/front/synonyms.h"

/* A top-level definition: a vertex of the graph whose edges are needs. */
typedef struct CheckedDefinition {
    const Syntax *syntax;
    struct {
        struct Need *items;
        size_t       count, capacity;
    } needs;
    const struct CheckedDefinition *user; /* the last one that recorded a need of this one */
    /* Tarjan's algorithm */
    uint32_t number, low; /* order of discovery, from 1; the least number that can be reached */
    size_t   next;        /* index of the need to follow next */
    uint32_t circle;      /* number of the strongly connected component, from 1 */
    /* the previous edge and vertex on the shortest path of find_cycle */
    const struct Need              *found_by;
    const struct CheckedDefinition *found_from;
} CheckedDefinition;

/* A use of one top-level definition in another. */
typedef struct Need {
    CheckedDefinition *of;
    Span               use; /* where the name stands */
} Need;

/* A definition of a name in some scope. */
typedef struct Meaning {
    struct NameSlot   *slot;
    Span               span;
    const Syntax      *syntax;     /* what defines it; NULL: it is built in, or a property */
    CheckedDefinition *definition; /* NULL unless it is a top-level name of this file */
    uint32_t           depth;      /* of the scope that defines it; 0: another file */
    struct Meaning    *hidden;     /* the name's meaning in the scopes around */
    struct Meaning    *older;      /* the meaning, of any name, that was added before this one */
} Meaning;

typedef struct NameSlot {
    const char *name;
    Meaning    *meaning;  /* NULL: not defined in the current scopes */
    bool        reported; /* as unknown */
} NameSlot;

typedef struct Checker {
    Arena             *arena;
    Diags             *diags;
    NameSlot         **slots; /* hash table; the capacity is a power of two */
    size_t             count, capacity;
    Meaning           *newest;
    uint32_t           depth;
    CheckedDefinition *current;    /* NULL outside of top-level definitions */
    bool               incomplete; /* names may be missing because of mistakes reported before */
    NameUses          *uses;       /* what is told, in the memory of `kept`; or NULL */
    Arena             *kept;
    struct {
        CheckedDefinition **items;
        size_t              count, capacity;
    } definitions;
} Checker;

/* ---- the table ---- */

static NameSlot **find_bucket(NameSlot **slots, size_t capacity, const char *name)
{
    size_t i = fnv_slot(name, strlen(name)) & (capacity - 1);
    while (slots[i] && slots[i]->name != name && strcmp(slots[i]->name, name) != 0)
        i = (i + 1) & (capacity - 1);
    return &slots[i];
}

static void grow_table(Checker *c)
{
    size_t     capacity = c->capacity ? 2 * c->capacity : 1024;
    NameSlot **slots    = arena_new_array(c->arena, NameSlot *, capacity);
    for (size_t i = 0; i < c->capacity; i++)
        if (c->slots[i])
            *find_bucket(slots, capacity, c->slots[i]->name) = c->slots[i];
    c->slots    = slots;
    c->capacity = capacity;
}

static NameSlot *find_slot(Checker *c, const char *name)
{
    if (2 * c->count >= c->capacity)
        grow_table(c);
    NameSlot **bucket = find_bucket(c->slots, c->capacity, name);
    if (!*bucket) {
        *bucket         = arena_new(c->arena, NameSlot);
        (*bucket)->name = name;
        c->count++;
    }
    return *bucket;
}

static void add_meaning(Checker *c, NameSlot *slot, Span span, const Syntax *syntax,
                        CheckedDefinition *definition)
{
    Meaning *meaning = arena_new(c->arena, Meaning);
    *meaning      = (Meaning){slot, span, syntax, definition, c->depth, slot->meaning, c->newest};
    slot->meaning = c->newest = meaning;
}

static void tell_use(Checker *c, NameUse use)
{
    if (c->uses)
        array_push_large(c->kept, c->uses, use);
}

static void enter_scope(Checker *c) { c->depth++; }

static void leave_scope(Checker *c)
{
    for (; c->newest && c->newest->depth == c->depth; c->newest = c->newest->older)
        c->newest->slot->meaning = c->newest->hidden;
    c->depth--;
}

/* ---- definitions ---- */

static void warn_of_coordinate(Checker *c, const char *name, Span span)
{
    if (strlen(name) != 1 || !strchr("xyzpuv", name[0]))
        return;
    Diag *diag  = diag_add(c->diags, DIAG_SHADOWED_COORDINATE, span,
                           "`%s` hides the coordinate `%s`", name, name);
    diag->label = "from here on it means this";
}

/* Defines a name; `seen` is where it is seen. */
static void define(Checker *c, const Syntax *syntax, Span seen, CheckedDefinition *definition)
{
    const char *name = syntax->name;
    const Span  span = syntax->name_span;
    NameSlot   *slot = find_slot(c, name);
    tell_use(c, (NameUse){span, name, syntax, true, seen});
    if (slot->meaning && slot->meaning->depth == c->depth) {
        Diag *diag  = diag_add(c->diags, DIAG_DUPLICATE_NAME, span, "`%s` is defined twice", name);
        diag->label = "defined again here";
        diag_secondary(c->diags, diag, slot->meaning->span, "defined here first");
        return;
    }
    warn_of_coordinate(c, name, span);
    add_meaning(c, slot, span, syntax, definition);
}

static void define_local(Checker *c, const Syntax *syntax, Span seen)
{
    define(c, syntax, seen, NULL);
}

/* ---- uses ---- */

/* Returns the nearest visible name; those of inner scopes come first. */
static const char *suggest(Checker *c, const char *name)
{
    struct {
        const char **items;
        size_t       count, capacity;
    } visible = {0};
    for (const Meaning *meaning = c->newest; meaning; meaning = meaning->older)
        array_push(c->arena, &visible, meaning->slot->name);
    return nearest_name(name, visible.items, visible.count);
}

static void report_unknown(Checker *c, NameSlot *slot, Span span)
{
    if (slot->reported || c->incomplete)
        return;
    slot->reported = true; /* further uses are the same mistake */
    Diag *diag     = diag_add(c->diags, DIAG_UNKNOWN_NAME, span, "the name `%s` is not defined",
                              slot->name);
    diag->label    = "unknown name";
    if (diags_full(c->diags) || explain_name(c->diags, diag, slot->name))
        return;
    diag->replacement = suggest(c, slot->name);
    if (diag->replacement)
        diag->help = "a name that is similar exists";
}

static void use_name(Checker *c, const Syntax *syntax)
{
    NameSlot *slot = find_slot(c, syntax->name);
    if (!slot->meaning) {
        report_unknown(c, slot, syntax->span);
        return;
    }
    tell_use(c, (NameUse){syntax->span, syntax->name, slot->meaning->syntax, false, {0}});
    CheckedDefinition *used = slot->meaning->definition;
    if (!used || !c->current || used->user == c->current)
        return;
    used->user = c->current;
    Need need  = {used, syntax->span};
    array_push(c->arena, &c->current->needs, need);
}

/* ---- the walk ---- */

static void walk(Checker *c, const Syntax *syntax);

/* Tells which parameters the names of arguments mean: those of a function that is called by its name. */
static void tell_arguments(Checker *c, const Syntax *call)
{
    const Syntax  *callee  = call->children[0];
    const Meaning *meaning = callee->kind == SYNTAX_NAME ? find_slot(c, callee->name)->meaning
                                                         : NULL;
    if (!meaning || !meaning->syntax || !syntax_is_function(meaning->syntax))
        return;
    for (uint32_t i = 1; i < call->count; i++)
        for (uint32_t k = 0; call->children[i]->name && k < meaning->syntax->count; k++) {
            const Syntax *argument = call->children[i], *parameter = meaning->syntax->children[k];
            if (parameter->kind == SYNTAX_PARAMETER && parameter->name == argument->name)
                tell_use(c, (NameUse){argument->name_span, argument->name, parameter, false, {0}});
        }
}

static void walk_children(Checker *c, const Syntax *syntax)
{
    for (uint32_t i = 0; i < syntax->count; i++)
        walk(c, syntax->children[i]);
}

/* Walks a comprehension: a clause sees the variables of the clauses before it, the element sees
   those of all clauses. */
static void walk_comprehension(Checker *c, const Syntax *syntax)
{
    for (uint32_t i = 1; i < syntax->count; i++) {
        const Syntax *clause = syntax->children[i];
        walk_children(c, clause);
        enter_scope(c);
        if (clause->kind == SYNTAX_FOR_CLAUSE)
            define_local(c, clause, syntax->span);
    }
    walk(c, syntax->children[0]);
    for (uint32_t i = 1; i < syntax->count; i++)
        leave_scope(c);
}

static void check_properties(Checker *c, const Syntax *syntax)
{
    enter_scope(c); /* a scope for names of properties, to find those that are given twice */
    for (uint32_t i = 0; i < syntax->count; i++) {
        const Syntax *property = syntax->children[i];
        if (property->kind != SYNTAX_PROPERTY)
            continue;
        NameSlot *slot = find_slot(c, property->name);
        if (slot->meaning && slot->meaning->depth == c->depth) {
            Diag *diag  = diag_add(c->diags, DIAG_DUPLICATE_NAME, property->name_span,
                                   "`%s` is given twice", property->name);
            diag->label = "given again here";
            diag_secondary(c->diags, diag, slot->meaning->span, "given here first");
        } else
            add_meaning(c, slot, property->name_span, NULL, NULL);
    }
    leave_scope(c);
}

/* Walks a function, shape or material.  A default sees the parameters before it, the body sees all
   of them. */
static void walk_function(Checker *c, const Syntax *syntax)
{
    enter_scope(c);
    for (uint32_t i = 0; i < syntax->count; i++) {
        walk(c, syntax->children[i]);
        if (syntax->children[i]->kind == SYNTAX_PARAMETER)
            define_local(c, syntax->children[i], syntax->span);
    }
    leave_scope(c);
    check_properties(c, syntax);
}

/* Walks a block, in which a name is known only behind its definition. */
static void walk_block(Checker *c, const Syntax *syntax)
{
    enter_scope(c);
    for (uint32_t i = 0; i < syntax->count; i++) {
        const Syntax *statement = syntax->children[i];
        SyntaxKind    kind      = statement->kind;
        walk(c, statement);
        if (kind == SYNTAX_LET || kind == SYNTAX_DEF || kind == SYNTAX_SHAPE)
            define_local(c, statement,
                         (Span){syntax->span.source, statement->span.end, syntax->span.end});
    }
    leave_scope(c);
}

static void walk(Checker *c, const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_NAME: use_name(c, syntax); break;
    case SYNTAX_CALL:
        if (c->uses)
            tell_arguments(c, syntax);
        walk_children(c, syntax);
        break;
    case SYNTAX_COMPREHENSION: walk_comprehension(c, syntax); break;
    case SYNTAX_KRS:
    case SYNTAX_BLOCK: walk_block(c, syntax); break;
    case SYNTAX_DEF:
    case SYNTAX_SHAPE:
    case SYNTAX_MATERIAL: walk_function(c, syntax); break;
    case SYNTAX_LET_IN:
    case SYNTAX_FOR:
        walk(c, syntax->children[0]);
        enter_scope(c);
        define_local(c, syntax, syntax->children[1]->span);
        walk(c, syntax->children[1]);
        leave_scope(c);
        break;
    case SYNTAX_CAMERA:
    case SYNTAX_LIGHT:
    case SYNTAX_SKY:
    case SYNTAX_FOG:
    case SYNTAX_MEDIUM:
    case SYNTAX_IMAGE:
    case SYNTAX_ZONE:
        walk_children(c, syntax);
        check_properties(c, syntax);
        break;
    default: walk_children(c, syntax); break;
    }
}

/* ---- circles ---- */

/* Tells whether a definition may need itself: functions may call themselves, other definitions may
   not need their own value. */
static bool may_need_itself(const CheckedDefinition *definition)
{
    return syntax_is_function(definition->syntax);
}

typedef struct DefinitionStack {
    CheckedDefinition **items;
    size_t              count, capacity;
} DefinitionStack;

static uint32_t least(uint32_t a, uint32_t b) { return a < b ? a : b; }

/* Removes a complete strongly connected component from the stack and gives it a number. */
static void close_circle(DefinitionStack *open, const CheckedDefinition *first, uint32_t circle)
{
    CheckedDefinition *last;
    do {
        last         = open->items[--open->count];
        last->circle = circle;
    } while (last != first);
}

/* Finds circles by Tarjan's algorithm from one definition.  It does not recurse, since chains of
   definitions may be long. */
static void find_components(Checker *c, CheckedDefinition *root, uint32_t *numbers,
                            uint32_t *circles)
{
    DefinitionStack path = {0}, open = {0};
    root->number = root->low = ++*numbers;
    array_push(c->arena, &path, root);
    array_push(c->arena, &open, root);
    while (path.count > 0) {
        CheckedDefinition *here = path.items[path.count - 1];
        if (here->next < here->needs.count) {
            CheckedDefinition *other = here->needs.items[here->next++].of;
            if (other->number == 0) {
                other->number = other->low = ++*numbers;
                array_push(c->arena, &path, other);
                array_push(c->arena, &open, other);
            } else if (other->circle == 0)
                here->low = least(here->low, other->number);
            continue;
        }
        path.count--;
        if (path.count > 0)
            path.items[path.count - 1]->low = least(path.items[path.count - 1]->low, here->low);
        if (here->low == here->number)
            close_circle(&open, here, ++*circles);
    }
}

/* Finds the shortest cycle through a definition, by breadth-first search.  Returns the last
   definition on it, from which `found_from` leads back; NULL when there is no cycle. */
static const CheckedDefinition *find_cycle(Checker *c, CheckedDefinition *start, const Need **last)
{
    DefinitionStack queue = {0};
    array_push(c->arena, &queue, start);
    for (size_t i = 0; i < queue.count; i++) {
        CheckedDefinition *here = queue.items[i];
        for (size_t k = 0; k < here->needs.count; k++) {
            const Need *need = &here->needs.items[k];
            if (need->of == start) {
                *last = need;
                return here;
            }
            if (need->of->circle == start->circle && !need->of->found_from) {
                need->of->found_from = here;
                need->of->found_by   = need;
                array_push(c->arena, &queue, need->of);
            }
        }
    }
    return NULL;
}

static void report_circle(Checker *c, CheckedDefinition *start)
{
    enum { MAX_CYCLE_LINES = 10 };
    const Need              *need = NULL;
    const CheckedDefinition *here = find_cycle(c, start, &need);
    if (!here)
        return;
    struct {
        const CheckedDefinition **items;
        size_t                    count, capacity;
    } cycle = {0};
    struct {
        const Need **items;
        size_t       count, capacity;
    } needs = {0};
    for (; here != start; need = here->found_by, here = here->found_from) {
        array_push(c->arena, &cycle, here);
        array_push(c->arena, &needs, need);
    }
    array_push(c->arena, &cycle, start);
    array_push(c->arena, &needs, need);

    const char *name = start->syntax->name;
    Diag       *diag = diag_add(c->diags, DIAG_CYCLE, start->syntax->name_span,
                                "the value of `%s` depends on itself", name);
    diag->label      = "this definition needs its own value";
    for (size_t i = cycle.count; i-- > 0;) {
        if (cycle.count - i > MAX_CYCLE_LINES) {
            diag_note(c->diags, diag, diag_text(c->diags, "and %zu more", i + 1));
            break;
        }
        const char *label = diag_text(c->diags, "`%s` needs `%s`", cycle.items[i]->syntax->name,
                                      needs.items[i]->of->syntax->name);
        diag_secondary(c->diags, diag, needs.items[i]->use, label);
    }
}

static void check_circles(Checker *c)
{
    uint32_t numbers = 0, circles = 0;
    for (size_t i = 0; i < c->definitions.count; i++)
        if (c->definitions.items[i]->number == 0)
            find_components(c, c->definitions.items[i], &numbers, &circles);
    bool *reported = arena_new_array(c->arena, bool, circles + 1);
    for (size_t i = 0; i < c->definitions.count && !diags_full(c->diags); i++) {
        CheckedDefinition *definition = c->definitions.items[i];
        if (may_need_itself(definition) || reported[definition->circle])
            continue;
        reported[definition->circle] = true;
        report_circle(c, definition);
    }
}

/* ---- the file ---- */

/* Tells whether a part of a statement could not be read: it may have defined names that the rest uses. */
static bool contains_error(const Syntax *syntax)
{
    bool found = syntax->kind == SYNTAX_ERROR;
    for (uint32_t i = 0; i < syntax->count && !found; i++)
        found = contains_error(syntax->children[i]);
    return found;
}

/* Tells whether a top-level statement could not be read.  It may have defined names that others use. */
static bool has_unread_statement(const Syntax *file)
{
    for (uint32_t i = 0; i < file->count; i++)
        if (file->children[i]->kind == SYNTAX_ERROR)
            return true;
    return false;
}

void names_check(const Syntax *file, const NameScope *scope, Diags *diags, Arena *arena,
                 NameUses *uses, Arena *kept)
{
    Checker checker = {.arena = arena, .diags = diags, .uses = uses, .kept = kept}, *c = &checker;
    const Span whole      = {file->span.source, 0, UINT32_MAX};
    bool       incomplete = scope->incomplete || has_unread_statement(file);
    for (size_t i = scope->known_count; i-- > 0;) /* backwards: suggestions prefer newer names */
        add_meaning(c, find_slot(c, scope->known[i].name), (Span){0}, scope->known[i].defined,
                    NULL);

    enter_scope(c);
    for (uint32_t i = 0; i < file->count; i++) {
        const Syntax      *syntax     = file->children[i];
        CheckedDefinition *definition = arena_new(arena, CheckedDefinition);
        definition->syntax            = syntax;
        array_push(arena, &c->definitions, definition);
        if (syntax_defines(syntax))
            define(c, syntax, whole, definition);
    }
    for (uint32_t i = 0; i < file->count; i++) {
        c->current    = c->definitions.items[i];
        c->incomplete = incomplete || contains_error(file->children[i]);
        walk(c, file->children[i]);
    }
    leave_scope(c);
    check_circles(c);
}
