/*
 * members.c: parts of values: `v.x` and `c.rgb` of vectors, `city.name` of records, and `list[i]`, of an index that
 * is known now or in each frame.
 */
#include <math.h>
#include <string.h>

#include "compiler/eval/elaborate.h"

/* Returns one element of a list, or of a vector known only as a node. */
static Value element(Elaboration *e, Value list, size_t index)
{
    if (list.type == VALUE_LIST)
        return list.list->items[index];
    return value_of_node(e, graph_component(e->graph, list.node, (uint32_t)index));
}

/* ---- components of vectors, by their letters ---- */

/* Letters of points and of colours, in the order of the components. */
static const char *const alphabets[] = {"xyzw", "rgba"};
enum { ALPHABETS = sizeof alphabets / sizeof *alphabets, MAX_LETTERS = 4 };

/* Returns the alphabet that all letters of a name are from; NULL: no name of components. */
static const char *alphabet_of(const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < ALPHABETS; i++)
        if (length >= 1 && length <= MAX_LETTERS && strspn(name, alphabets[i]) == length)
            return alphabets[i];
    return NULL;
}

bool is_component(const Elaboration *e, Value value, const Syntax *syntax)
{
    return value_size(e, value) >= 2 && syntax->count == 1 && alphabet_of(syntax->name);
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
        items[i] = element(e, vector, index);
    }
    return count == 1 ? items[0] : value_list(e, items, count);
}

/* ---- records: values with names, as JSON has them ---- */

Value value_record(Elaboration *e, const Value *names, const Value *values, size_t count)
{
    Record *record = arena_new(e->arena, Record);
    *record        = (Record){count, names, values};
    return (Value){.type = VALUE_RECORD, .record = record};
}

Value record_member(Elaboration *e, const Record *record, const char *name, Span span)
{
    for (size_t i = 0; i < record->count; i++)
        if (record->names[i].string == name)
            return record->values[i];
    const char **names = arena_new_array(e->diags->arena, const char *, record->count + 1);
    for (size_t i = 0; i < record->count; i++)
        names[i] = record->names[i].string;
    Diag *diag  = diag_add(e->diags, DIAG_UNKNOWN_PROPERTY, span, "the record has no member `%s`",
                           name);
    diag->label = "unknown member";
    diag->help  = nearest_name(name, names, record->count);
    if (diag->help)
        diag->help = diag_text(e->diags, "a member with a similar name exists: `%s`", diag->help);
    note_names(e, diag, "its members", names, record->count);
    return value_error();
}

/* ---- indices ---- */

/* An index of frames chooses from all elements, which are all computed. */
enum { MAX_CHOSEN = 256 };

static Value index_record(Elaboration *e, const Record *record, Value name, const Syntax *index)
{
    if (name.type == VALUE_STRING)
        return record_member(e, record, name.string, index->span);
    type_error(e, index, name, "the name of a member, a string");
    return value_error();
}

static void label_possible(Elaboration *e, Diag *diag, size_t count)
{
    diag->label = count ? diag_text(e->diags, "whole numbers from 0 to %zu are possible", count - 1)
                        : "the list is empty";
}

static Value known_index(Elaboration *e, const Syntax *syntax, Value list, size_t count,
                         double index)
{
    if (index >= 0 && index < (double)count && index == floor(index))
        return element(e, list, (size_t)index);
    label_possible(e,
                   diag_add(e->diags, DIAG_INDEX_RANGE, syntax->children[1]->span,
                            "index %g of a list of %zu", index, count),
                   count);
    return value_error();
}

/* ---- an index that frames know ---- */

/* Makes nodes of all elements, of one type; false: reported. */
static bool element_nodes(Elaboration *e, const Syntax *syntax, Value list, size_t count,
                          Node *nodes)
{
    for (size_t i = 0; i < count; i++) {
        const Value value = element(e, list, i);
        nodes[i]          = value_node(e, value);
        if (nodes[i] == NODE_NONE) {
            constant_error(e, syntax->children[1],
                           diag_text(e->diags,
                                     "an index must be known at compile time to choose %s",
                                     value_type_name(e, value)));
            return false;
        }
        if (e->graph->items[nodes[i]].type != e->graph->items[nodes[0]].type) {
            Diag *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->children[0]->span,
                                   "the elements have different types: %s and %s",
                                   value_type_name(e, element(e, list, 0)),
                                   value_type_name(e, value));
            diag->label = "an index that frames know chooses among values of one type";
            return false;
        }
    }
    return true;
}

static Range range_of_node(Elaboration *e, Node node)
{
    const Range range = graph_frame_range(e->graph, node, 0, e->scratch);
    arena_clear(e->scratch);
    return range;
}

/* Tells whether it is `floor(n * random)`.  The range of the product ends at n, as ranges are rounded up;
   in double precision n times the largest number below 1 is below n. */
static bool is_part_of(Elaboration *e, Node index, size_t count)
{
    const Expr *product = &e->graph->items[index];
    if (product->op == OP_floor)
        product = &e->graph->items[product->operands[0]];
    for (int k = 0; product->op == OP_mul && k < 2; k++) {
        const Range number = range_of_node(e, product->operands[k]);
        const Range part   = range_of_node(e, product->operands[1 - k]);
        if (number.low >= 0 && number.high <= (double)count && part.low >= 0 && part.high < 1)
            return true;
    }
    return false;
}

/* Demands that an index which depends on the iteration of a loop is one of the list's.  Iterations in which it
   is none are made by themselves. */
static bool is_required(Elaboration *e, Node index, size_t count)
{
    Graph     *g       = e->graph;
    const Node whole   = graph_op2(g, OP_equal, index, graph_op1(g, OP_floor, index));
    const Node from    = graph_op2(g, OP_less_equal, graph_number(g, 0), index);
    const Node to      = graph_op2(g, OP_less, index, graph_number(g, (double)count));
    const Node between = graph_op2(g, OP_and, from, to);
    return iterations_require(e, graph_op2(g, OP_and, whole, between));
}

/* Tells whether the index, rounded down, is one of the list in all frames; false: reported. */
static bool check_index_range(Elaboration *e, const Syntax *syntax, Node index, size_t count)
{
    if (is_required(e, index, count))
        return true;
    const Range range = range_of_node(e, index);
    if ((range.low >= 0 && range.high < (double)count) || is_part_of(e, index, count))
        return true;
    const char *limits = isfinite(range.low) && isfinite(range.high)
                             ? diag_text(e->diags, "from %g to %g", range.low, range.high)
                             : "without limits";
    Diag       *diag   = diag_add(e->diags, DIAG_INDEX_RANGE, syntax->children[1]->span,
                                  "an index %s of a list of %zu", limits, count);
    label_possible(e, diag, count);
    if (count > 0)
        diag->help = diag_text(e->diags, "`clamp(..., 0, %zu)` keeps it in the list", count - 1);
    return false;
}

/* Elements from..to-1, by halves.  A whole number needs no rounding down to be compared with. */
static Node choose_element(Graph *g, Node index, const Node *nodes, size_t from, size_t to)
{
    if (to - from == 1)
        return nodes[from];
    const size_t middle = from + (to - from) / 2;
    Node         low    = choose_element(g, index, nodes, from, middle);
    Node         high   = choose_element(g, index, nodes, middle, to);
    Node         bound  = graph_number(g, (double)middle);
    Node         below  = graph_op2(g, OP_less, index, bound);
    return graph_op3(g, OP_select, below, low, high);
}

/* Returns an index that may change with the frames. */
static Value frame_index(Elaboration *e, const Syntax *syntax, Value list, size_t count, Node index)
{
    const Syntax *where = syntax->children[1];
    if (e->graph->items[index].time == TIME_POINT) {
        point_error(e, where, "an index");
        return value_error();
    }
    if (count > MAX_CHOSEN) {
        constant_error(e, where,
                       "an index of a list of more than 256 must be known at compile time");
        return value_error();
    }
    Node *nodes = arena_new_array(e->values, Node, count + 1);
    if (!count_steps(e, count, syntax->span) || !check_index_range(e, syntax, index, count) ||
        !element_nodes(e, syntax, list, count, nodes))
        return value_error();
    e->graph->here = syntax->span;
    return value_of_node(e, choose_element(e->graph, index, nodes, 0, count));
}

Value value_index(Elaboration *e, const Syntax *syntax, Value list, Value index)
{
    if (list.type == VALUE_ERROR || index.type == VALUE_ERROR)
        return value_error();
    if (list.type == VALUE_RECORD)
        return index_record(e, list.record, index, syntax->children[1]);
    const uint32_t size = list.type == VALUE_LIST ? 0 : value_size(e, list);
    if (list.type != VALUE_LIST && size < 2) {
        type_error(e, syntax->children[0], list, "a list");
        return value_error();
    }
    const size_t count = size ? size : list.list->count;
    if (index.type == VALUE_NUMBER)
        return known_index(e, syntax, list, count, index.number);
    if (index.type == VALUE_EXPRESSION && e->graph->items[index.node].type == TYPE_FLOAT)
        return frame_index(e, syntax, list, count, index.node);
    type_error(e, syntax->children[1], index, "a number");
    return value_error();
}
