/*
 * forget.c: frees values that nothing refers to any more.
 *
 * An element of a list, or an iteration of a loop, is evaluated by many lists and bindings.  What comes of
 * it is mostly a shape, which knows none of them.
 */
#include "compiler/eval/elaborate.h"

#include <string.h>

EvaluationMark evaluation_mark(const Elaboration *e)
{
    return (EvaluationMark){arena_mark(e->values), e->kept};
}

/* Tells whether it refers to no other values. */
static bool stands_alone(Value value)
{
    switch (value.type) {
    case VALUE_ERROR:
    case VALUE_NUMBER:
    case VALUE_BOOLEAN:
    case VALUE_EXPRESSION:
    case VALUE_STRING:
    case VALUE_SHAPE:
    case VALUE_MAP:
    case VALUE_MATERIAL:
    case VALUE_TEXTURE: return true;
    case VALUE_LIST:
    case VALUE_RECORD:
    case VALUE_FUNCTION: break;
    }
    return false;
}

/* Lists as long as a vector are copied. */
enum { MAX_COPIED = 4 };

static bool is_copied(Value value)
{
    if (value.type != VALUE_LIST || value.list->count > MAX_COPIED)
        return false;
    for (size_t i = 0; i < value.list->count; i++)
        if (!stands_alone(value.list->items[i]))
            return false;
    return true;
}

static Value copy_list(Arena *arena, List list, const Value *items)
{
    List *copy  = arena_new(arena, List);
    *copy       = list;
    copy->items = arena_new_array(arena, Value, list.count);
    memcpy(copy->items, items, list.count * sizeof *items);
    return (Value){.type = VALUE_LIST, .list = copy};
}

void evaluation_forget(Elaboration *e, EvaluationMark mark, Value *result)
{
    bool copied = result && is_copied(*result);
    if (e->kept != mark.kept || (result && !copied && !stands_alone(*result)))
        return;
    List  list = {0};
    Value items[MAX_COPIED];
    if (copied) {
        list = *result->list;
        memcpy(items, list.items, list.count * sizeof *items);
    }
    arena_rewind(e->values, mark.values);
    if (copied)
        *result = copy_list(e->values, list, items);
}

/* The innermost name comes first. */
Environment keep_names(Elaboration *e, const Environment *inner, const Environment *outer)
{
    Environment     kept = *outer;
    const Binding **last = &kept.locals;
    for (const Binding *b = inner->locals; b && b != outer->locals; b = b->next) {
        Binding *copy = arena_new(e->arena, Binding);
        *copy         = *b;
        copy->next    = outer->locals;
        if (is_copied(b->value))
            copy->value = copy_list(e->arena, *b->value.list, b->value.list->items);
        else if (!stands_alone(b->value))
            e->kept++;
        *last = copy;
        last  = &copy->next;
    }
    if (outer->locals)
        e->kept++;
    return kept;
}
