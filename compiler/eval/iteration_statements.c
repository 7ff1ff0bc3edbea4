/*
 * iteration_statements.c: loops of statements that show shapes, evaluated once (iterations.c).
 *
 * Their bodies may have `let`, `show` of a shape, and `if`.  A condition that depends on the iteration stands
 * around all that the body shows: then the iterations for which it does not hold show nothing.
 */
#include "compiler/eval/iterations.h"

static bool take_block(Elaboration *e, const Environment *env, const Syntax *block, Iterated *t,
                       bool last);

/* Takes an `if`; `last`: no statement of the body follows. */
static bool take_if(Elaboration *e, const Environment *env, const Syntax *syntax, Iterated *t,
                    bool last)
{
    const Value condition = evaluate(e, env, syntax->children[0]);
    if (condition.type == VALUE_BOOLEAN) {
        const Syntax *branch = branch_taken(syntax, condition.boolean);
        if (branch && branch->kind == SYNTAX_IF_STATEMENT)
            return take_if(e, env, branch, t, last);
        return !branch || take_block(e, env, branch, t, last);
    }
    return last && t->found == 0 && syntax->count == 2 && iteration_condition(e, t, condition) &&
           take_block(e, env, syntax->children[1], t, last);
}

static bool take_show(Elaboration *e, const Environment *env, const Syntax *syntax, Iterated *t)
{
    const bool good = iteration_shape(t, evaluate(e, env, syntax));
    if (good)
        t->parts[t->found - 1].syntax = syntax;
    return good;
}

static bool take_statement(Elaboration *e, Environment *env, const Syntax *syntax, Iterated *t,
                           bool last)
{
    switch (syntax->kind) {
    case SYNTAX_LET:
        *env = bind(e, env, syntax->name, evaluate(e, env, syntax->children[0]));
        return true;
    case SYNTAX_SHOW: return take_show(e, env, syntax->children[0], t);
    case SYNTAX_IF_STATEMENT: return take_if(e, env, syntax, t, last);
    default: return false;
    }
}

static bool take_block(Elaboration *e, const Environment *env, const Syntax *block, Iterated *t,
                       bool last)
{
    Environment inner = *env;
    bool        good  = true;
    for (uint32_t i = 0; good && i < block->count && !is_stopped(e); i++)
        good = take_statement(e, &inner, block->children[i], t, last && i + 1 == block->count);
    return good;
}

static bool evaluate_body(Elaboration *e, const Environment *env, Iterated *t)
{
    return take_block(e, env, t->body->syntax, t, true);
}

/* Takes the witnesses of a loop; false: the first iteration shows too much. */
static bool take_witnesses(const Elaboration *e, size_t shown, Iterated *t)
{
    const size_t count = e->scene->components.count - shown;
    for (size_t k = 0; count <= MAX_ITERATION_PARTS && k < count; k++)
        t->parts[t->part_count++].witness = e->scene->components.items[shown + k].shape;
    return count <= MAX_ITERATION_PARTS;
}

bool statement_iterations_made(Elaboration *e, const Environment *env, const Syntax *loop,
                               size_t shown, ShowShape *show)
{
    const IterationBody body = {.env      = env,
                                .range    = loop->children[0],
                                .syntax   = loop->children[1],
                                .variable = loop->name,
                                .shown    = true,
                                .evaluate = evaluate_body};
    Iterated            t    = {.body = &body};
    if (!iterations_are_tried(e) || body.range->kind != SYNTAX_RANGE ||
        !take_witnesses(e, shown, &t) || !iterations_try(e, &t))
        return false;
    e->scene->components.count = shown;
    for (size_t i = 0; i < t.count; i++)
        for (size_t k = 0; k < t.part_count; k++)
            show(e, value_shape(t.parts[k].iterations[i]), t.parts[k].syntax);
    return true;
}
