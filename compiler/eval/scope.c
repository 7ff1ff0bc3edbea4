/*
 * scope.c: the names that files define, and whose definitions each of them sees.
 */
#include "compiler/eval/elaborate.h"

static size_t slot_of(const Scope *scope, const char *name)
{
    return (size_t)(((uintptr_t)name >> 3) * 0x9E3779B97F4A7C15u >> 32) % scope->slot_count;
}

static Definition *find_own(const Scope *scope, const char *name)
{
    if (scope->slot_count == 0)
        return NULL;
    for (size_t i = slot_of(scope, name);; i = (i + 1) % scope->slot_count) {
        if (!scope->slots[i])
            return NULL;
        if (scope->slots[i]->name == name)
            return scope->slots[i];
    }
}

Definition *scope_find(const Scope *scope, const char *name)
{
    Definition *definition = find_own(scope, name);
    for (size_t i = 0; !definition && i < scope->used.count; i++)
        definition = find_own(scope->used.items[i], name);
    return definition;
}

static void define_all(Elaboration *e, Scope *scope)
{
    for (uint32_t i = 0; i < scope->file->count; i++) {
        const Syntax *syntax = scope->file->children[i];
        if (!syntax_defines(syntax))
            continue;
        Definition *definition = arena_new(e->arena, Definition);
        *definition = (Definition){.name = syntax->name, .syntax = syntax, .scope = scope};
        array_push(e->arena, &scope->definitions, definition);
    }
    scope->slot_count = 2 * scope->definitions.count + 1;
    scope->slots      = arena_new_array(e->arena, Definition *, scope->slot_count);
    for (size_t i = 0; i < scope->definitions.count; i++) {
        Definition *definition = scope->definitions.items[i];
        size_t      slot       = slot_of(scope, definition->name);
        while (scope->slots[slot] && scope->slots[slot]->name != definition->name)
            slot = (slot + 1) % scope->slot_count;
        if (!scope->slots[slot]) /* of two definitions the first counts; names_check reports */
            scope->slots[slot] = definition;
    }
}

static Scope *scope_new(Elaboration *e, const Syntax *file)
{
    Scope *scope       = arena_new(e->arena, Scope);
    scope->file        = file;
    scope->environment = (Environment){NULL, scope};
    return scope;
}

void scopes_make(Elaboration *e)
{
    const Files *files = e->files;
    e->library         = scope_new(e, NULL);
    for (size_t i = 0; i < files->count; i++) {
        Scope *scope = scope_new(e, files->items[i]->syntax);
        define_all(e, scope);
        array_push(e->arena, &e->scopes, scope);
        if (files->items[i]->library)
            array_push(e->arena, &e->library->used, scope);
    }
    for (size_t i = 0; i < files->count; i++) {
        const File *file = files->items[i];
        for (size_t k = 0; k < file->used.count; k++)
            array_push(e->arena, &e->scopes.items[i]->used,
                       e->scopes.items[file->used.items[k]->number]);
    }
}
