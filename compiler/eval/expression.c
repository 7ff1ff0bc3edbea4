/*
 * expression.c: the value of an expression.
 */
#include "compiler/base/nesting.h"
#include "compiler/eval/elaborate.h"

#include <math.h>

enum {
    MAX_STEPS = 200 * 1000 * 1000,
    MAX_NODES = 500 * 1000 /* from one shape to the next */
};

static Value limit_reached(Elaboration *e, Span span, const char *message)
{
    if (!is_stopped(e))
        diag_add(e->diags, DIAG_LIMIT, span, "%s", message);
    e->builder->stopped = true;
    return value_error();
}

bool count_steps(Elaboration *e, uint64_t count, Span span)
{
    e->steps += count;
    if (!is_stopped(e) && e->steps > (e->max_steps ? e->max_steps : MAX_STEPS))
        limit_reached(e, span, "the scene takes more than 200 million steps to elaborate");
    if (!is_stopped(e) && e->graph->count - e->builder->nodes_before > MAX_NODES)
        limit_reached(e, span, "the expressions of a shape have more than 500,000 operations");
    return !is_stopped(e);
}

bool check_shape_count(Elaboration *e, const List *list, Span span)
{
    if (list->total > MAX_TREE_SHAPES)
        limit_reached(e, span,
                      "a list of more than 4 million shapes, counted as often as they occur");
    return !is_stopped(e);
}

Environment bind(Elaboration *e, const Environment *env, const char *name, Value value)
{
    Binding *binding = arena_new(e->values, Binding);
    *binding         = (Binding){name, value, env->locals};
    return (Environment){binding, env->scope};
}

static Value evaluate_name(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    for (const Binding *b = env->locals; b; b = b->next)
        if (b->name == syntax->name)
            return b->value;
    Definition *definition = scope_find(env->scope, syntax->name);
    if (definition)
        return run_definition(e, definition, syntax->span);
    const BuiltinName *builtin = builtin_find(e, syntax->name);
    if (builtin->constant)
        return builtin_constant(e, syntax->name, syntax->span);
    if (builtin->function)
        return (Value){.type = VALUE_FUNCTION, .function = builtin->function};
    definition = scope_find(e->library, syntax->name);
    if (definition)
        return run_definition(e, definition, syntax->span);
    return value_error(); /* names_check has reported it */
}

static Value evaluate_list(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value *items = arena_new_array(e->values, Value, syntax->count);
    bool   wrong = false;
    for (uint32_t i = 0; i < syntax->count; i++) {
        EvaluationMark mark = evaluation_mark(e);
        items[i]            = evaluate(e, env, syntax->children[i]);
        wrong               = wrong || items[i].type == VALUE_ERROR;
        if (syntax->count > 4) /* not a vector */
            evaluation_forget(e, mark, &items[i]);
    }
    return wrong ? value_error() : value_list(e, items, syntax->count);
}

/* Finds a number that is known now: a bound of a range. */
static bool constant_number(Elaboration *e, const Environment *env, const Syntax *syntax,
                            const char *what, double *number)
{
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_NUMBER) {
        *number = value.number;
        return true;
    }
    if (value.type == VALUE_EXPRESSION) {
        Diag *diag  = diag_add(e->diags, DIAG_NOT_COMPILE_TIME, syntax->span,
                               "%s must be known at compile time", what);
        diag->label = value_time(e, value) == TIME_FRAME ? "this depends on a `param` or on `time`"
                                                         : "this depends on a coordinate";
        diag->help  = "use a constant; to show a part only, give the most there can be and choose "
                      "inside with `if`";
        point_at_definition(e, diag, syntax);
    } else
        type_error(e, syntax, value, "a number");
    return false;
}

static bool each_of_range(Elaboration *e, const Environment *env, const Syntax *syntax,
                          EachElement *each, void *user)
{
    double from, to;
    if (!constant_number(e, env, syntax->children[0], "the start of a range", &from) ||
        !constant_number(e, env, syntax->children[1], "the end of a range", &to))
        return false;
    if (to - from > MAX_ELEMENTS) {
        limit_reached(e, syntax->span,
                      diag_text(e->diags, "a range of %.0f elements; the limit is 4 million",
                                ceil(to - from)));
        return false;
    }
    for (uint32_t i = 0; from + i < to; i++)
        if (!count_steps(e, 1, syntax->span) || !each(e, value_number(from + i), user))
            return false;
    return true;
}

bool evaluate_each(Elaboration *e, const Environment *env, const Syntax *syntax, EachElement *each,
                   void *user)
{
    if (syntax->kind == SYNTAX_RANGE)
        return each_of_range(e, env, syntax, each, user);
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_ERROR)
        return false;
    if (value.type != VALUE_LIST) {
        type_error(e, syntax, value, "a list");
        return false;
    }
    for (size_t i = 0; i < value.list->count; i++)
        if (!count_steps(e, 1, syntax->span) || !each(e, value.list->items[i], user))
            return false;
    return true;
}

static bool run_clause(Elaboration *e, const Comprehension *c);

static bool comprehend_each(Elaboration *e, Value element, void *user)
{
    const Comprehension *outer  = user;
    const Syntax        *clause = outer->syntax->children[outer->clause];
    if (outer->loop && iterations_made(e, outer))
        return true;
    Comprehension inner = *outer;
    inner.mark          = evaluation_mark(e);
    Environment env     = bind(e, outer->env, clause->name, element);
    inner.env           = &env;
    inner.clause++;
    return run_clause(e, &inner);
}

static bool run_clause(Elaboration *e, const Comprehension *c)
{
    if (c->clause == c->syntax->count) {
        Value value = evaluate(e, c->env, c->syntax->children[0]);
        if (value.type == VALUE_ERROR)
            return false;
        evaluation_forget(e, c->mark, &value);
        if (c->result->count >= MAX_ELEMENTS) {
            limit_reached(e, c->syntax->span, "a list of more than 4 million elements");
            return false;
        }
        array_push_large(e->values, c->result, value);
        return true;
    }
    const Syntax *clause = c->syntax->children[c->clause];
    if (clause->kind == SYNTAX_FOR_CLAUSE)
        return evaluate_each(e, c->env, clause->children[0], comprehend_each, (void *)c);
    Value condition = evaluate(e, c->env, clause->children[0]);
    if (condition.type == VALUE_BOOLEAN) {
        Comprehension next = *c;
        next.clause++;
        if (condition.boolean)
            return run_clause(e, &next);
        evaluation_forget(e, c->mark, NULL);
        return true;
    }
    if (condition.type == VALUE_EXPRESSION)
        constant_error(e, clause->children[0],
                       "what a list leaves out must be known at compile time");
    else
        type_error(e, clause->children[0], condition, "a truth value");
    return false;
}

static Value evaluate_comprehension(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Values        result = {0};
    IterationLoop loop   = {0};
    Comprehension c      = {.env    = env,
                            .syntax = syntax,
                            .clause = 1,
                            .result = &result,
                            .mark   = evaluation_mark(e),
                            .loop   = iterations_possible(e, syntax) ? &loop : NULL};
    if (!run_clause(e, &c))
        return value_error();
    return value_list(e, result.items, result.count);
}

static bool push_element(Elaboration *e, Value element, void *user)
{
    Values *result = user;
    array_push_large(e->values, result, element);
    return true;
}

static Value evaluate_range(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Values result = {0};
    if (!each_of_range(e, env, syntax, push_element, &result))
        return value_error();
    return value_list(e, result.items, result.count);
}

static Value evaluate_if(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value condition = evaluate(e, env, syntax->children[0]);
    if (condition.type == VALUE_ERROR)
        return condition;
    if (condition.type == VALUE_BOOLEAN)
        return evaluate(e, env, syntax->children[condition.boolean ? 1 : 2]);
    if (condition.type != VALUE_EXPRESSION || e->graph->items[condition.node].type != TYPE_BOOL) {
        type_error(e, syntax->children[0], condition, "a truth value");
        return value_error();
    }
    Value yes = evaluate(e, env, syntax->children[1]);
    Value no  = evaluate(e, env, syntax->children[2]);
    return value_select(e, syntax, condition, yes, no);
}

static Value evaluate_index(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value list = evaluate(e, env, syntax->children[0]);
    return value_index(e, syntax, list, evaluate(e, env, syntax->children[1]));
}

static Value evaluate_call(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value callee = evaluate(e, env, syntax->children[0]);
    if (callee.type == VALUE_ERROR)
        return callee;
    if (callee.type == VALUE_FUNCTION)
        return call_function(e, env, syntax, callee.function);
    if (callee.type == VALUE_TEXTURE)
        return call_texture(e, env, syntax, callee.texture);
    Diag *diag  = diag_add(e->diags, DIAG_NOT_CALLABLE, syntax->children[0]->span,
                           "%s cannot be called", value_type_name(e, callee));
    diag->label = "neither a function nor a shape declaration";
    if (callee.type == VALUE_MAP)
        diag->help = form_help(e->diags, FORM_CALLED_MAP);
    point_at_definition(e, diag, syntax->children[0]);
    return value_error();
}

static Value evaluate_binary(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value a = evaluate(e, env, syntax->children[0]);
    /* `and` and `or` need their right side only when the left has not decided. */
    if (a.type == VALUE_BOOLEAN && syntax->op == TOKEN_AND && !a.boolean)
        return a;
    if (a.type == VALUE_BOOLEAN && syntax->op == TOKEN_OR && a.boolean)
        return a;
    Value b = evaluate(e, env, syntax->children[1]);
    return value_binary(e, syntax, a, b);
}

static Value evaluate_message_in(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    return run_message(e, env, syntax->children[0]) ? evaluate(e, env, syntax->children[1])
                                                    : value_error();
}

static Value evaluate_let(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value       value = evaluate(e, env, syntax->children[0]);
    Environment inner = bind(e, env, syntax->name, value);
    return evaluate(e, &inner, syntax->children[1]);
}

/* Returns a number of a text: that of the scene may be changed by its author, that of the library
   not. */
static Value written_number(Elaboration *e, double number, const Syntax *syntax)
{
    Value value = value_number(number);
    return is_of_author(e, syntax) ? value_authored(e, value) : value;
}

static Value written_colour(Elaboration *e, const Syntax *syntax)
{
    Value *items = arena_new_array(e->values, Value, 3);
    for (int i = 0; i < 3; i++)
        items[i] = written_number(e, syntax->number[i], syntax);
    return value_list(e, items, 3);
}

static Value evaluate_inner(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_NUMBER: return written_number(e, syntax->number[0], syntax);
    case SYNTAX_COLOUR: return written_colour(e, syntax);
    case SYNTAX_STRING: return (Value){.type = VALUE_STRING, .string = syntax->name};
    case SYNTAX_BOOLEAN: return value_boolean(syntax->number[0] != 0);
    case SYNTAX_NAME: return evaluate_name(e, env, syntax);
    case SYNTAX_LIST: return evaluate_list(e, env, syntax);
    case SYNTAX_COMPREHENSION: return evaluate_comprehension(e, env, syntax);
    case SYNTAX_RANGE: return evaluate_range(e, env, syntax);
    case SYNTAX_UNARY: return value_unary(e, syntax, evaluate(e, env, syntax->children[0]));
    case SYNTAX_BINARY: return evaluate_binary(e, env, syntax);
    case SYNTAX_IF: return evaluate_if(e, env, syntax);
    case SYNTAX_LET_IN: return evaluate_let(e, env, syntax);
    case SYNTAX_MESSAGE_IN: return evaluate_message_in(e, env, syntax);
    case SYNTAX_CALL: return evaluate_call(e, env, syntax);
    case SYNTAX_METHOD: return call_method(e, env, syntax);
    case SYNTAX_INDEX: return evaluate_index(e, env, syntax);
    case SYNTAX_KRS: return elaborate_krs(e, env, syntax);
    default: return value_error(); /* SYNTAX_ERROR: reported by the parser */
    }
}

static bool is_left_out(const Elaboration *e, Span span)
{
    const Span *without = &e->without;
    return span.start == without->start && span.end == without->end &&
           span.source == without->source && without->source != 0;
}

Value evaluate(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    if (!count_steps(e, 1, syntax->span))
        return value_error();
    if (e->depth >= nesting.evaluations)
        return limit_reached(e, syntax->span,
                             "evaluation is nested too deeply, perhaps by a function that calls "
                             "itself without end");
    e->depth++;
    Value value = evaluate_inner(e, env, syntax);
    e->depth--;
    return is_left_out(e, syntax->span) ? value_hollow(e, value) : value;
}
