/*
 * arithmetic.c: operators on values of every binding time.
 *
 * Constants are computed here and now; anything else becomes a node.  Vectors of numbers are
 * worked element by element, so that [x, 0, z] - [1, 0, 0] stays cheap and exact.
 */
#include "compiler/base/elementary.h"
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

Value value_of_node(Elaboration *e, Node node)
{
    const Expr *expr = &e->graph->items[node];
    if (expr->op != OP_CONSTANT || expr->type == TYPE_UINT)
        return (Value){.type = VALUE_EXPRESSION, .node = node};
    if (expr->type == TYPE_BOOL)
        return value_boolean(expr->number[0] != 0);
    if (expr->type == TYPE_FLOAT)
        return value_number(expr->number[0]);
    double numbers[4];
    memcpy(numbers, expr->number, sizeof numbers);
    return value_vector(e, numbers, expr->type);
}

Value value_list(Elaboration *e, Value *items, size_t count)
{
    List *list = arena_new(e->values, List);
    *list      = (List){count, items, TIME_COMPILE, 0};
    for (size_t i = 0; i < count; i++) {
        BindingTime time = value_time(e, items[i]);
        size_t      more = items[i].type == VALUE_LIST ? items[i].list->total : 0;
        list->time       = time > list->time ? time : list->time;
        list->total      = more < SIZE_MAX - list->total ? list->total + more + 1 : SIZE_MAX;
    }
    return (Value){.type = VALUE_LIST, .list = list};
}

Value value_vector(Elaboration *e, const double *numbers, uint32_t count)
{
    Value *items = arena_new_array(e->values, Value, count);
    for (uint32_t i = 0; i < count; i++)
        items[i] = value_number(numbers[i]);
    return value_list(e, items, count);
}

static bool is_scalar(const Elaboration *e, Value value)
{
    return value.type == VALUE_NUMBER ||
           (value.type == VALUE_EXPRESSION && e->graph->items[value.node].type == TYPE_FLOAT);
}

static bool is_truth(const Elaboration *e, Value value)
{
    return value.type == VALUE_BOOLEAN ||
           (value.type == VALUE_EXPRESSION && e->graph->items[value.node].type == TYPE_BOOL);
}

/* Returns 2 to 4 when the value is a vector, else 0. */
static uint32_t vector_length(const Elaboration *e, Value value)
{
    if (value.type == VALUE_EXPRESSION) {
        GraphType type = e->graph->items[value.node].type;
        return type >= TYPE_VEC2 && type <= TYPE_VEC4 ? (uint32_t)type : 0;
    }
    if (value.type != VALUE_LIST || value.list->count < 2 || value.list->count > 4)
        return 0;
    for (size_t i = 0; i < value.list->count; i++)
        if (!is_scalar(e, value.list->items[i]))
            return 0;
    return (uint32_t)value.list->count;
}

uint32_t value_size(const Elaboration *e, Value value)
{
    return is_scalar(e, value) ? 1 : vector_length(e, value);
}

static const char *function_type_name(const Function *function)
{
    switch (function->syntax ? function->syntax->kind : SYNTAX_DEF) {
    case SYNTAX_SHAPE: return "a shape declaration";
    case SYNTAX_MATERIAL: return "a material with parameters";
    default: return "a function";
    }
}

const char *value_type_name(Elaboration *e, Value value)
{
    switch (value.type) {
    case VALUE_ERROR: return "an error";
    case VALUE_NUMBER: return "a number";
    case VALUE_BOOLEAN: return "a truth value";
    case VALUE_STRING: return "a string";
    case VALUE_RECORD: return "a record";
    case VALUE_FUNCTION: return function_type_name(value.function);
    case VALUE_SHAPE: return "a shape";
    case VALUE_MAP: return "a map of space";
    case VALUE_MATERIAL: return "a material";
    case VALUE_TEXTURE: return "a texture";
    case VALUE_EXPRESSION:
    case VALUE_LIST: break;
    }
    if (is_scalar(e, value))
        return "a number";
    if (is_truth(e, value))
        return "a truth value";
    uint32_t length = vector_length(e, value);
    if (length)
        return diag_text(e->diags, "a vector of %u", length);
    return diag_text(e->diags, "a list of %zu", value.list->count);
}

uint32_t value_numbers(Value value, double numbers[4])
{
    if (value.type != VALUE_LIST || value.list->count < 2 || value.list->count > 4)
        return 0;
    for (size_t i = 0; i < value.list->count; i++) {
        const Value *item = &value.list->items[i];
        if (item->type != VALUE_NUMBER || !isfinite(item->number))
            return 0;
        numbers[i] = item->number + 0.0; /* -0 and 0 are one constant */
    }
    return (uint32_t)value.list->count;
}

Node value_node(Elaboration *e, Value value)
{
    Graph *g = e->graph;
    switch (value.type) {
    case VALUE_NUMBER:
        return value.number_id ? graph_parameterised(g, TYPE_FLOAT, &value.number, value.number_id)
                               : graph_number(g, value.number);
    case VALUE_BOOLEAN: return graph_bool(g, value.boolean);
    case VALUE_EXPRESSION: return value.node;
    case VALUE_LIST: break;
    default: return NODE_NONE;
    }
    double   numbers[4];
    uint32_t length = value_numbers(value, numbers);
    if (length && !value_is_authored(value))
        return graph_constant(g, (GraphType)length, numbers);
    length = vector_length(e, value);
    if (!length)
        return NODE_NONE;
    static const Op build[] = {[2] = OP_vec2, [3] = OP_vec3, [4] = OP_vec4};
    Node            elements[4];
    for (uint32_t i = 0; i < length; i++)
        elements[i] = value_node(e, value.list->items[i]);
    return graph_op(g, build[length], elements);
}

BindingTime value_time(const Elaboration *e, Value value)
{
    if (value.type == VALUE_EXPRESSION)
        return e->graph->items[value.node].time;
    return value.type == VALUE_LIST ? value.list->time : TIME_COMPILE;
}

static Value not_finite(Elaboration *e, const Syntax *syntax, bool by_zero)
{
    const char *what = by_zero ? "division by zero" : "the result is not a finite number";
    Diag       *diag = diag_add(e->diags, DIAG_NOT_A_NUMBER, syntax->span, "%s", what);
    diag->label      = "this has no finite value";
    return value_error();
}

/* Returns an operation on lists of `length` numbers, element by element: the result is such a
   list. */
static Value map_elements(Elaboration *e, Op op, const Value *arguments, uint32_t count,
                          uint32_t length, const Syntax *origin)
{
    Value *items = arena_new_array(e->values, Value, length);
    for (uint32_t k = 0; k < length; k++) {
        Value elements[MAX_OPERANDS];
        for (uint32_t i = 0; i < count; i++)
            elements[i] = arguments[i].type == VALUE_LIST ? arguments[i].list->items[k]
                                                          : arguments[i];
        items[k] = value_map_op(e, op, elements, count, origin);
        if (items[k].type == VALUE_ERROR)
            return value_error();
    }
    return value_list(e, items, length);
}

Value value_map_op(Elaboration *e, Op op, const Value *arguments, uint32_t count,
                   const Syntax *origin)
{
    double number;
    if (fold_op(op, arguments, count, &number))
        return value_from(e, value_number(number), op, arguments, count);
    uint32_t length = 0;
    bool     whole  = false; /* some operand is a vector known only as a node */
    for (uint32_t i = 0; i < count; i++) {
        uint32_t n = vector_length(e, arguments[i]);
        length     = n ? n : length;
        whole      = whole || (n && arguments[i].type == VALUE_EXPRESSION);
    }
    if (length && !whole)
        return map_elements(e, op, arguments, count, length, origin);
    Node nodes[MAX_OPERANDS];
    bool constant = true, known = true; /* now, though the author may change it */
    for (uint32_t i = 0; i < count; i++)
        known = known && (arguments[i].type == VALUE_NUMBER || arguments[i].type == VALUE_BOOLEAN);
    for (uint32_t i = 0; i < count; i++) {
        Value argument = arguments[i];
        if (known)
            argument.number_id = 0;
        nodes[i] = value_node(e, argument);
        constant = constant && e->graph->items[nodes[i]].op == OP_CONSTANT;
    }
    e->graph->here = origin->span;
    Node result    = graph_op(e->graph, op, nodes);
    if (constant && e->graph->items[result].op != OP_CONSTANT)
        return not_finite(e, origin, op == OP_div || op == OP_mod);
    Value value = value_of_node(e, result);
    return known ? value_from(e, value, op, arguments, count) : value;
}

/* Computes the common case, and the one that loops run through: numbers known now. */
static bool fold_numbers(TokenKind op, double a, double b, double *result)
{
    switch (op) {
    case TOKEN_PLUS: *result = a + b; break;
    case TOKEN_MINUS: *result = a - b; break;
    case TOKEN_STAR: *result = a * b; break;
    case TOKEN_SLASH: *result = a / b; break;
    case TOKEN_PERCENT: *result = a - b * floor(a / b); break;
    case TOKEN_CARET: *result = real_pow(a, b); break;
    default: return false;
    }
    return true;
}

static Value arithmetic(Elaboration *e, const Syntax *syntax, Value a, Value b)
{
    static const Op ops[TOKEN_KIND_COUNT] = {
        [TOKEN_PLUS] = OP_add,  [TOKEN_MINUS] = OP_sub,   [TOKEN_STAR] = OP_mul,
        [TOKEN_SLASH] = OP_div, [TOKEN_PERCENT] = OP_mod, [TOKEN_CARET] = OP_pow};
    double result;
    if (a.type == VALUE_NUMBER && b.type == VALUE_NUMBER &&
        fold_numbers(syntax->op, a.number, b.number, &result)) {
        if (isfinite(result))
            return value_from(e, value_number(result), ops[syntax->op], (Value[]){a, b}, 2);
        bool by_zero = (syntax->op == TOKEN_SLASH || syntax->op == TOKEN_PERCENT) && b.number == 0;
        return not_finite(e, syntax, by_zero);
    }
    uint32_t n = vector_length(e, a), m = vector_length(e, b);
    if (n && m && n != m) {
        Diag *diag = diag_add(e->diags, DIAG_LENGTH_MISMATCH, syntax->name_span,
                              "a vector of %u and a vector of %u do not go together", n, m);
        diag_secondary(e->diags, diag, syntax->children[0]->span,
                       diag_text(e->diags, "this has %u elements", n));
        diag_secondary(e->diags, diag, syntax->children[1]->span,
                       diag_text(e->diags, "this has %u elements", m));
        return value_error();
    }
    if (syntax->op == TOKEN_CARET && b.type == VALUE_NUMBER && a.type == VALUE_EXPRESSION) {
        e->graph->here = syntax->span;
        Node exponent  = graph_number(e->graph, b.number);
        return value_of_node(e, graph_power(e->graph, a.node, exponent));
    }
    if (syntax->op == TOKEN_CARET && b.type == VALUE_NUMBER && a.type == VALUE_LIST) {
        Value *items = arena_new_array(e->values, Value, n);
        for (uint32_t i = 0; i < n; i++) {
            items[i] = arithmetic(e, syntax, a.list->items[i], b);
            if (items[i].type == VALUE_ERROR)
                return value_error();
        }
        return value_list(e, items, n);
    }
    return value_map_op(e, ops[syntax->op], (Value[]){a, b}, 2, syntax);
}

/* Says of two expressions what type each has. */
static void label_types(Elaboration *e, Diag *diag, Syntax *const *pair, const char *left,
                        const char *right)
{
    diag_secondary(e->diags, diag, pair[0]->span, diag_text(e->diags, "this is %s", left));
    diag_secondary(e->diags, diag, pair[1]->span, diag_text(e->diags, "this is %s", right));
}

static Value mismatch(Elaboration *e, const Syntax *syntax, Value a, Value b)
{
    const char *left = value_type_name(e, a), *right = value_type_name(e, b);
    Diag       *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->name_span,
                                "%s does not go with %s and %s", token_kind_text(syntax->op), left,
                                right);
    label_types(e, diag, syntax->children, left, right);
    point_at_definition(e, diag, syntax->children[0]);
    point_at_definition(e, diag, syntax->children[1]);
    if (a.type == VALUE_SHAPE && is_scalar(e, b) &&
        (syntax->op == TOKEN_MINUS || syntax->op == TOKEN_PLUS))
        diag->help = "to shrink or grow a shape write `.offset(-0.1)` or `.offset(0.1)`";
    else if (a.type == VALUE_SHAPE && b.type == VALUE_SHAPE && syntax->op == TOKEN_PLUS)
        diag->help = "to join shapes write `a | b`";
    else if (a.type == VALUE_SHAPE && is_scalar(e, b) && syntax->op == TOKEN_STAR)
        diag->help = "to scale a shape write `.scale(2)`";
    else if ((a.type == VALUE_STRING || b.type == VALUE_STRING) && syntax->op == TOKEN_PLUS)
        diag->help = "to join texts write `str(a, b)`";
    return value_error();
}

static bool compare_numbers(TokenKind op, double a, double b)
{
    switch (op) {
    case TOKEN_LESS: return a < b;
    case TOKEN_LESS_EQUAL: return a <= b;
    case TOKEN_GREATER: return a > b;
    case TOKEN_GREATER_EQUAL: return a >= b;
    case TOKEN_EQUAL_EQUAL: return a == b;
    default: return a != b;
    }
}

/* Tells whether a comparison is decided now.  Of numbers that shaders read it is structure, and so
   it is where all that the numbers may be has the same answer. */
static bool is_decided(Elaboration *e, Op op, Node left, Node right, bool *answer)
{
    const Expr *items = e->graph->items;
    if (!e->parameterises || items[left].time == TIME_POINT || items[right].time == TIME_POINT)
        return false;
    Range a = node_range(e->builder, left, 0), b = node_range(e->builder, right, 0);
    bool  below = a.high < b.low;
    bool  above = b.high < a.low;
    *answer     = op == OP_not_equal || ((op == OP_less || op == OP_less_equal) && below);
    return below || above;
}

static Value compare(Elaboration *e, const Syntax *syntax, Value a, Value b)
{
    bool equality = syntax->op == TOKEN_EQUAL_EQUAL || syntax->op == TOKEN_NOT_EQUAL;
    if (equality && a.type == VALUE_STRING && b.type == VALUE_STRING)
        return value_boolean((a.string == b.string) == (syntax->op == TOKEN_EQUAL_EQUAL));
    if (equality && a.type == VALUE_BOOLEAN && b.type == VALUE_BOOLEAN)
        return value_boolean((a.boolean == b.boolean) == (syntax->op == TOKEN_EQUAL_EQUAL));
    if (!is_scalar(e, a) || !is_scalar(e, b))
        return mismatch(e, syntax, a, b);
    static const Op ops[TOKEN_KIND_COUNT] = {
        [TOKEN_LESS] = OP_less,         [TOKEN_LESS_EQUAL] = OP_less_equal,
        [TOKEN_GREATER] = OP_less,      [TOKEN_GREATER_EQUAL] = OP_less_equal,
        [TOKEN_EQUAL_EQUAL] = OP_equal, [TOKEN_NOT_EQUAL] = OP_not_equal};
    if (a.type == VALUE_NUMBER && b.type == VALUE_NUMBER) /* what is known now is decided now */
        return value_boolean(compare_numbers(syntax->op, a.number, b.number));
    bool swap  = syntax->op == TOKEN_GREATER || syntax->op == TOKEN_GREATER_EQUAL;
    Node left  = value_node(e, swap ? b : a);
    Node right = value_node(e, swap ? a : b);
    bool answer;
    if (is_decided(e, ops[syntax->op], left, right, &answer))
        return value_boolean(answer);
    e->graph->here = syntax->span;
    return value_of_node(e, graph_op2(e->graph, ops[syntax->op], left, right));
}

/* Multiplies maps that stay separate: the product has as many as both have. */
static Value multiply_maps(Elaboration *e, const Syntax *syntax, const Map *a, const Map *b)
{
    size_t count = 0;
    for (const Map *map = a; map; map = map->first)
        count++;
    for (const Map *map = b; map; map = map->first)
        count++;
    if (count <= MAX_SHAPE_DEPTH)
        return value_map(map_product(e->builder, a, b));
    diag_add(e->diags, DIAG_LIMIT, syntax->span,
             "a product of more than 1,000 inversions that cannot be one map");
    return value_error();
}

Value value_binary(Elaboration *e, const Syntax *syntax, Value a, Value b)
{
    if (a.type == VALUE_ERROR || b.type == VALUE_ERROR)
        return value_error();
    switch (syntax->op) {
    case TOKEN_BAR:
    case TOKEN_AMPERSAND:
        if (a.type == VALUE_SHAPE && b.type == VALUE_SHAPE)
            return join_shapes(e, syntax, a.shape, b.shape);
        break;
    case TOKEN_AND:
    case TOKEN_OR:
        if (is_truth(e, a) && is_truth(e, b)) {
            Op   op   = syntax->op == TOKEN_AND ? OP_and : OP_or;
            Node left = value_node(e, a), right = value_node(e, b);
            return value_of_node(e, graph_op2(e->graph, op, left, right));
        }
        break;
    case TOKEN_PLUS:
    case TOKEN_MINUS:
    case TOKEN_STAR:
    case TOKEN_SLASH:
    case TOKEN_PERCENT:
    case TOKEN_CARET:
        if (value_size(e, a) > 0 && value_size(e, b) > 0)
            return arithmetic(e, syntax, a, b);
        if (syntax->op == TOKEN_MINUS && a.type == VALUE_SHAPE && b.type == VALUE_SHAPE)
            return join_shapes(e, syntax, a.shape, b.shape);
        if (syntax->op == TOKEN_STAR && a.type == VALUE_MAP && b.type == VALUE_MAP)
            return multiply_maps(e, syntax, a.map, b.map);
        break;
    default: return compare(e, syntax, a, b);
    }
    return mismatch(e, syntax, a, b);
}

Value value_unary(Elaboration *e, const Syntax *syntax, Value a)
{
    if (a.type == VALUE_ERROR)
        return a;
    if (syntax->op == TOKEN_NOT && is_truth(e, a))
        return value_of_node(e, graph_op1(e->graph, OP_not, value_node(e, a)));
    if (syntax->op == TOKEN_MINUS && a.type == VALUE_NUMBER)
        return value_from(e, value_number(-a.number), OP_neg, &a, 1);
    if (syntax->op == TOKEN_MINUS && value_size(e, a) > 0)
        return value_map_op(e, OP_neg, &a, 1, syntax);
    Diag *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->span, "%s does not go with %s",
                          token_kind_text(syntax->op), value_type_name(e, a));
    point_at_definition(e, diag, syntax->children[0]);
    return value_error();
}

/* Evaluates an `if` on a condition that is not known yet: both branches are there, one is chosen. */
Value value_select(Elaboration *e, const Syntax *syntax, Value condition, Value yes, Value no)
{
    if (yes.type == VALUE_ERROR || no.type == VALUE_ERROR)
        return value_error();
    if (yes.type == VALUE_SHAPE && no.type == VALUE_SHAPE)
        return choose_shape(e, syntax, condition, yes.shape, no.shape);
    Node a = value_node(e, yes), b = value_node(e, no);
    if (a == NODE_NONE || b == NODE_NONE) {
        const char *other   = value_type_name(e, a == NODE_NONE ? yes : no);
        const char *message = diag_text(
            e->diags, "the condition must be known at compile time to choose %s", other);
        constant_error(e, syntax->children[0], message);
        return value_error();
    }
    if (e->graph->items[a].type != e->graph->items[b].type) {
        const char *left = value_type_name(e, yes), *right = value_type_name(e, no);
        Diag       *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->span,
                                    "the branches of `if` have different types: %s and %s", left, right);
        label_types(e, diag, syntax->children + 1, left, right);
        return value_error();
    }
    e->graph->here = syntax->span;
    return value_of_node(e, graph_op3(e->graph, OP_select, condition.node, a, b));
}
