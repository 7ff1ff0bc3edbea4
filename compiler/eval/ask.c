/*
 * ask.c: the value of one expression of a scene, for editors.
 */
#include "compiler/eval/ask.h"

#include <math.h>

#include "compiler/eval/elaborate.h"
#include "compiler/eval/kinds.h"

/* The steps that an answer may take: some ten milliseconds. */
enum { MAX_STEPS = 200 * 1000 };

/* An evaluation with all that it works on. */
struct Asking {
    Elaboration  e;
    ShapeBuilder builder;
    Scene        scene;
    Diags        diags; /* of nobody */
};

Asking *asking_new(Files *files, const Loader *loader, Arena *arena, Arena *values, Arena *scratch)
{
    Asking *a = arena_new(arena, Asking);
    Graph  *g = graph_new(arena);
    a->diags  = (Diags){.arena = arena, .sources = files->sources};
    a->scene  = (Scene){
         .graph = g, .sky = {.zenith = NODE_NONE}, .zone = NODE_NONE, .fog = {.color = NODE_NONE}};
    a->builder = (ShapeBuilder){.arena      = arena,
                                .scratch    = scratch,
                                .diags      = &a->diags,
                                .graph      = g,
                                .parameters = &a->scene.parameters,
                                .slopes     = &a->scene.slopes};
    a->e       = (Elaboration){.builder     = &a->builder,
                               .arena       = arena,
                               .values      = values,
                               .scratch     = scratch,
                               .diags       = &a->diags,
                               .sources     = files->sources,
                               .files       = files,
                               .graph       = g,
                               .scene       = &a->scene,
                               .loader      = loader,
                               .figures     = true,
                               .in_material = true,
                               .rounding    = NODE_NONE,
                               .max_steps   = MAX_STEPS,
                               .textures    = {.arena = arena}};
    scopes_make(&a->e);
    return a;
}

/* ---- examples ---- */

static bool take_first(Elaboration *e, Value element, void *user)
{
    (void)e;
    *(Value *)user = element;
    return false;
}

static Value first_element(Elaboration *e, const Environment *env, const Syntax *list)
{
    Value first = value_error();
    evaluate_each(e, env, list, take_first, &first);
    return first;
}

/* Returns a shape of the library with its defaults. */
static Value example_shape(Elaboration *e, const char *name, const Syntax *parameter)
{
    return call_library(e, name, value_number(1), parameter);
}

/* Returns a value that a parameter without default takes. */
static Value example_of_kind(Elaboration *e, const Syntax *parameter)
{
    switch ((ParameterKind)parameter->number[0]) {
    case KIND_number:
    case KIND_size:
    case KIND_known:
    case KIND_count:
    case KIND_value: return value_number(1);
    case KIND_flag: return value_boolean(true);
    case KIND_pair: return value_vector(e, (const double[]){1, 1}, 2);
    case KIND_vector:
    case KIND_place:
    case KIND_point: return value_vector(e, (const double[]){1, 1, 1}, 3);
    case KIND_shape:
    case KIND_solid:
    case KIND_region: return example_shape(e, "sphere", parameter);
    case KIND_figure: return example_shape(e, "circle", parameter);
    default: return value_error();
    }
}

static Value example_argument(Elaboration *e, const Environment *env, const Syntax *parameter)
{
    return parameter->count ? value_as_kind(e, (ParameterKind)parameter->number[0],
                                            evaluate(e, env, parameter->children[0]), parameter)
                            : example_of_kind(e, parameter);
}

/* ---- names around an expression ---- */

static Environment with_name(Elaboration *e, const Environment *env, const Syntax *syntax,
                             Value value)
{
    return syntax->name ? bind(e, env, syntax->name, value) : *env;
}

static Environment with_parameters(Elaboration *e, Environment env, const Syntax *function,
                                   const Syntax *next)
{
    for (uint32_t i = 0; i < function->count && function->children[i] != next; i++)
        if (function->children[i]->kind == SYNTAX_PARAMETER)
            env = with_name(e, &env, function->children[i],
                            example_argument(e, &env, function->children[i]));
    return env;
}

static Environment with_clauses(Elaboration *e, Environment env, const Syntax *comprehension,
                                const Syntax *next)
{
    for (uint32_t i = 1; i < comprehension->count && comprehension->children[i] != next; i++) {
        const Syntax *clause = comprehension->children[i];
        if (clause->kind == SYNTAX_FOR_CLAUSE)
            env = with_name(e, &env, clause, first_element(e, &env, clause->children[0]));
    }
    return env;
}

static Environment with_statements(Elaboration *e, Environment env, const Syntax *block,
                                   const Syntax *next)
{
    for (uint32_t i = 0; i < block->count && block->children[i] != next; i++) {
        const Syntax *syntax = block->children[i];
        if (syntax->kind == SYNTAX_LET)
            env = with_name(e, &env, syntax, evaluate(e, &env, syntax->children[0]));
        else if (syntax->kind == SYNTAX_DEF || syntax->kind == SYNTAX_SHAPE)
            env = with_name(e, &env, syntax, value_function(e, &env, syntax));
    }
    return env;
}

/* Returns the environment of `next`, a child of `node`. */
static Environment inside(Elaboration *e, Environment env, const Syntax *node, const Syntax *next)
{
    switch (node->kind) {
    case SYNTAX_DEF:
    case SYNTAX_SHAPE:
    case SYNTAX_MATERIAL: return with_parameters(e, env, node, next);
    case SYNTAX_COMPREHENSION: return with_clauses(e, env, node, next);
    case SYNTAX_KRS:
    case SYNTAX_BLOCK: return with_statements(e, env, node, next);
    case SYNTAX_LET_IN:
        if (next == node->children[1])
            return with_name(e, &env, node, evaluate(e, &env, node->children[0]));
        return env;
    case SYNTAX_FOR:
        if (next == node->children[1])
            return with_name(e, &env, node, first_element(e, &env, node->children[0]));
        return env;
    default: return env;
    }
}

/* Returns the environment of the last node.  Names of the whole file are found by its scope. */
static Environment around(Asking *a, size_t file, const Syntax *const *nodes, size_t count)
{
    Environment env = a->e.scopes.items[file]->environment;
    for (size_t i = 1; i + 1 < count; i++)
        env = inside(&a->e, env, nodes[i], nodes[i + 1]);
    return env;
}

Value ask_value(Asking *a, size_t file, const Syntax *const *nodes, size_t count)
{
    Environment env = around(a, file, nodes, count);
    return evaluate(&a->e, &env, nodes[count - 1]);
}

Value ask_definition(Asking *a, size_t file, const Syntax *const *nodes, size_t count)
{
    const Syntax *syntax = nodes[count - 1];
    Environment   env    = around(a, file, nodes, count);
    if (count == 2 && syntax_defines(syntax)) {
        Definition *definition = scope_find(env.scope, syntax->name);
        return definition && definition->syntax == syntax
                   ? run_definition(&a->e, definition, syntax->span)
                   : value_error();
    }
    switch (syntax->kind) {
    case SYNTAX_PARAMETER: return example_argument(&a->e, &env, syntax);
    case SYNTAX_FOR:
    case SYNTAX_FOR_CLAUSE: return first_element(&a->e, &env, syntax->children[0]);
    case SYNTAX_LET:
    case SYNTAX_LET_IN: return evaluate(&a->e, &env, syntax->children[0]);
    default: return value_error();
    }
}

size_t ask_mistakes(Asking *a)
{
    run_file(&a->e, a->e.scopes.items[0]);
    return a->diags.errors - (is_stopped(&a->e) && a->diags.errors > 0 ? 1 : 0); /* the steps */
}

/* ---- words ---- */

/* Adds a corner of a box with six digits: it is for orientation. */
static void add_corner(Text *out, const Shape *shape, bool high)
{
    for (int i = 0; i < 3; i++)
        text_format(out, "%s%.6g", i ? ", " : "[",
                    high ? shape->box.axis[i].high : shape->box.axis[i].low);
    text_add(out, "]");
}

static void add_shape(Text *out, const Shape *shape)
{
    text_add(out, shape->figure ? "a plane figure" : "a shape");
    if (box_is_empty(shape->box)) {
        text_add(out, ", empty");
        return;
    }
    text_add(out, " from ");
    add_corner(out, shape, false);
    text_add(out, " to ");
    add_corner(out, shape, true);
    text_add(out, shape->exact ? "; its distance is exact" : "; its distance is a bound");
    if (isfinite(shape->derived) && shape->derived > 1)
        text_format(out, ", of a field that rises %.3g times as fast", shape->derived);
}

void ask_text(Asking *a, Value value, Text *out)
{
    enum { MOST = 200 }; /* bytes, of what has many elements */
    if (value.type == VALUE_ERROR || value.type == VALUE_FUNCTION)
        return;
    if (value.type == VALUE_SHAPE) {
        add_shape(out, value.shape);
        return;
    }
    const size_t before = out->length;
    value_text(&a->e, value, out, before + MOST);
    if (out->length > before + MOST)
        text_add(out, " ...");
}

uint32_t ask_size(Asking *a, Value value) { return value_size(&a->e, value); }
