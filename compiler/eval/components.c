/*
 * components.c: `v.x`, `v.xy`, `c.rgb`: components of vectors by their letters.
 */
#include "compiler/eval/elaborate.h"

#include <string.h>

/* Letters of points and of colours, in the order of the components. */
static const char *const alphabets[] = {"xyzw", "rgba"};
enum { ALPHABETS = sizeof alphabets / sizeof *alphabets, MOST_LETTERS = 4 };

/* The alphabet that all letters of a name are from; NULL: no name of components. */
static const char *alphabet_of(const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < ALPHABETS; i++)
        if (length >= 1 && length <= MOST_LETTERS && strspn(name, alphabets[i]) == length)
            return alphabets[i];
    return NULL;
}

bool is_component(const Elaboration *e, Value value, const Syntax *syntax)
{
    return value_size(e, value) >= 2 && syntax->count == 1 && alphabet_of(syntax->name);
}

/* One component of a vector that is a list, or known only as a node. */
static Value component(Elaboration *e, Value vector, uint32_t index)
{
    if (vector.type == VALUE_LIST)
        return vector.list->items[index];
    return value_of_node(e, graph_component(e->graph, vector.node, index));
}

static Value missing_component(Elaboration *e, const Syntax *syntax, char letter, Value vector,
                               const char *alphabet)
{
    uint32_t size = value_size(e, vector);
    Diag    *diag = diag_add(e->diags, DIAG_INDEX_RANGE, syntax->name_span,
                             "a vector of %u has no `%c`", size, letter);
    diag->label   = diag_text(e->diags, "its components are `%.*s`", (int)size, alphabet);
    diag_secondary(e->diags, diag, syntax->children[0]->span,
                   diag_text(e->diags, "this is a vector of %u", size));
    return value_error();
}

Value value_components(Elaboration *e, const Syntax *syntax, Value vector)
{
    const char *name = syntax->name, *alphabet = alphabet_of(name);
    size_t      count = strlen(name);
    Value      *items = arena_new_array(e->arena, Value, count);
    for (size_t i = 0; i < count; i++) {
        uint32_t index = (uint32_t)(strchr(alphabet, name[i]) - alphabet);
        if (index >= value_size(e, vector))
            return missing_component(e, syntax, name[i], vector, alphabet);
        items[i] = component(e, vector, index);
    }
    return count == 1 ? items[0] : value_list(e, items, count);
}
