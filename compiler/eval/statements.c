/*
 * statements.c: files and `krs` blocks, statement by statement.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

/* The place where the statements of a `krs` block go; those at the top level have none (NULL). */
typedef struct Sequence {
    struct {
        SequenceStage *items;
        size_t         count, capacity;
    } stages;
    struct {
        const Shape **items;
        size_t        count, capacity;
    } kernels;
    bool wrong; /* a mistake was reported: the block has no value */
} Sequence;

/* ---- definitions ---- */

Value value_function(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Environment *closure = arena_new(e->values, Environment);
    *closure             = *env;
    Function *function   = arena_new(e->values, Function);
    *function            = (Function){.name = syntax->name, .syntax = syntax, .closure = closure};
    return (Value){.type = VALUE_FUNCTION, .function = function};
}

Value run_definition(Elaboration *e, Definition *definition, Span use)
{
    if (definition->state == DEFINITION_DONE)
        return definition->value;
    if (definition->state == DEFINITION_RUNNING) {
        /* names_check reports circles it can see; this is the one through a function. */
        Diag *diag  = diag_add(e->diags, DIAG_CYCLE, definition->syntax->name_span,
                               "`%s` needs itself", definition->name);
        diag->label = "defined here";
        diag_secondary(e->diags, diag, use, "needed here");
        return value_error();
    }
    definition->state = DEFINITION_RUNNING;
    e->kept++;
    const Syntax    *syntax   = definition->syntax;
    Environment     *env      = &definition->scope->environment;
    Span             caller   = e->graph->here;
    struct Iterated *iterated = iterations_begin_definition(e, definition);
    switch (syntax->kind) {
    case SYNTAX_LET:
        definition->value = evaluate(e, env, syntax->children[0]);
        if (definition->value.type == VALUE_SHAPE)
            definition->value.shape = shape_named(e->builder, definition->value.shape,
                                                  syntax->name);
        break;
    case SYNTAX_PARAM: definition->value = define_param(e, env, syntax); break;
    case SYNTAX_MATERIAL:
        definition->value = syntax_is_function(syntax) ? value_function(e, env, syntax)
                                                       : elaborate_material(e, env, syntax);
        break;
    case SYNTAX_DEF:
    case SYNTAX_SHAPE: definition->value = value_function(e, env, syntax); break;
    default: definition->value = value_number(0); break; /* cameras, lights: names */
    }
    e->graph->here    = caller;
    e->iterated       = iterated;
    definition->state = DEFINITION_DONE;
    return definition->value;
}

/* ---- show ---- */

static const char *component_name(Elaboration *e, const Syntax *syntax)
{
    if (syntax->kind == SYNTAX_NAME)
        return syntax->name;
    /* `show oak.move(...)` shows the oak. */
    if (syntax->kind == SYNTAX_METHOD)
        return component_name(e, syntax->children[0]);
    return diag_text(e->diags, "component %zu", e->scene->components.count + 1);
}

static bool check_box(Elaboration *e, Box box, const Syntax *syntax)
{
    for (uint32_t i = 0; i < 3; i++)
        if (!check_extent(e, box.axis[i], i, syntax, "the shape"))
            return false;
    return true;
}

/* Returns a figure as a solid, about as high as it is long. */
static const Shape *thicken(const Elaboration *e, const Shape *figure, Span span)
{
    double height = 1;
    for (int i = 0; i < 2; i++) {
        double side = figure->box.axis[i].high - figure->box.axis[i].low;
        height      = isfinite(side) ? fmax(height, side) : height;
    }
    return make_extrude(e->builder, figure, graph_number(e->builder->graph, height), span);
}

/* Shows a shape, or all shapes of a list; `syntax` is the expression shown. */
static bool show_one(Elaboration *e, Value value, const Syntax *syntax)
{
    if (value.type == VALUE_LIST) {
        if (!check_shape_count(e, value.list, syntax->span))
            return false;
        for (size_t i = 0; i < value.list->count; i++)
            if (!show_one(e, value.list->items[i], syntax))
                return false;
        return true;
    }
    if (value.type != VALUE_SHAPE) {
        type_error(e, syntax, value, "a shape");
        return false;
    }
    bool figure = value.shape->figure;
    if (figure && e->figures)
        value.shape = thicken(e, value.shape, syntax->span);
    if (value.shape->figure) {
        Diag *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->span,
                               "a plane figure cannot be shown");
        diag->label = "this has no thickness";
        diag->help = "make it solid with `.extrude(height)` or `.revolve()`; `krs slice` writes it "
                     "as it is";
        return false;
    }
    if (!check_bounded(e->builder, value.shape) || !check_box(e, value.shape->box, syntax))
        return false;
    Component component = {.name   = component_name(e, syntax),
                           .first  = e->scene->components.count,
                           .count  = 1,
                           .shape  = value.shape,
                           .figure = figure,
                           .span   = syntax->span};
    if (!shape_plane(e->builder, value.shape, &component.plane_normal, &component.plane_offset))
        component.plane_normal = component.plane_offset = NODE_NONE;
    find_beams(e, &component);
    array_push_large(e->arena, &e->scene->components, component);
    warn_if_nothing_is_left(e, value.shape, component.name, syntax->span);
    return true;
}

/* ---- krs blocks ---- */

static void add_kernel(Elaboration *e, const Environment *env, const Syntax *syntax,
                       Sequence *sequence)
{
    Value value = evaluate(e, env, syntax->children[0]);
    if (value.type == VALUE_SHAPE && !value.shape->figure) {
        SequenceStage stage = {.kind   = SEQUENCE_KERNEL,
                               .kernel = (uint32_t)sequence->kernels.count,
                               .span   = syntax->span};
        array_push(e->arena, &sequence->kernels, value.shape);
        array_push(e->arena, &sequence->stages, stage);
        return;
    }
    sequence->wrong = true;
    if (value.type == VALUE_SHAPE) {
        Diag *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->children[0]->span,
                              "a kernel must be solid, found a plane figure");
        diag->help = "make it solid with `.extrude(height)` or `.revolve()`";
    } else
        type_error(e, syntax->children[0], value, "a shape");
}

/* Reads a mirror; false: it is neither a plane nor a sphere. */
static bool read_mirror(Elaboration *e, const Shape *shape, SequenceStage *stage)
{
    if (shape_plane(e->builder, shape, &stage->normal, &stage->offset))
        return true;
    stage->kind = SEQUENCE_SPHERE;
    return shape_ball(e->builder, shape, &stage->centre, &stage->radius);
}

static void add_mirror(Elaboration *e, const Environment *env, const Syntax *syntax,
                       Sequence *sequence)
{
    const Syntax *argument = syntax->children[0];
    Value         value    = evaluate(e, env, argument);
    SequenceStage stage    = {.kind = SEQUENCE_REFLECT, .span = syntax->span};
    bool          shape    = value.type == VALUE_SHAPE;
    if (shape && read_mirror(e, value.shape, &stage)) {
        sequence->wrong = sequence->wrong ||
                          (stage.kind == SEQUENCE_SPHERE &&
                           !check_positive(e, stage.radius, argument, "the radius of a mirror"));
        array_push(e->arena, &sequence->stages, stage);
        return;
    }
    sequence->wrong = true;
    if (value.type == VALUE_ERROR)
        return;
    const char *type = value_type_name(e, value);
    Diag       *diag = diag_add(e->diags, DIAG_NEEDS_PLANE, argument->span,
                                "`reflect` needs a plane or a sphere, found %s", type);
    diag->label      = diag_text(e->diags, "this is %s", type);
    if (shape)
        diag->help = "planes are written `plane(normal: [1, 0, 0], offset: 2)`, spheres "
                     "`sphere(2).move([1, 0, 0])`; they may be moved, turned and scaled evenly";
    point_at_definition(e, diag, argument);
}

/* Adds one stage for each map of a chain, the innermost first. */
static void push_map(Elaboration *e, Sequence *sequence, const Map *map, Span span)
{
    SequenceStage stage = {.kind = SEQUENCE_MAP, .map = *map, .span = span};
    if (map->first)
        push_map(e, sequence, map->first, span);
    stage.map.first = NULL;
    array_push(e->arena, &sequence->stages, stage);
}

/* Maps with nothing between them are one. */
static void add_map(Elaboration *e, const Environment *env, const Syntax *syntax,
                    Sequence *sequence)
{
    Value  value = evaluate(e, env, syntax->children[0]);
    size_t count = sequence->stages.count;
    if (value.type == VALUE_MAP) {
        const Map    *map  = value.map;
        SequenceStage last = count ? sequence->stages.items[count - 1] : (SequenceStage){0};
        if (count && last.kind == SEQUENCE_MAP) {
            map = map_product(e->builder, map, &last.map);
            sequence->stages.count--;
        }
        push_map(e, sequence, map, syntax->span);
        return;
    }
    sequence->wrong = true;
    type_error(e, syntax->children[0], value, "a map of space");
}

/* ---- blocks ---- */

typedef struct Loop {
    const Environment *env;
    const Syntax      *syntax;
    Sequence          *sequence; /* NULL at the top level */
    size_t             shown;    /* components before it */
    bool tries, made;            /* to show all iterations at once: is still possible; it is done */
} Loop;

static void run_block(Elaboration *e, const Environment *env, const Syntax *block,
                      Sequence *sequence);

static bool run_iteration(Elaboration *e, Value element, void *user)
{
    Loop *loop = user;
    if (loop->tries && e->scene->components.count > loop->shown) {
        loop->tries = false;
        loop->made  = statement_iterations_made(e, loop->env, loop->syntax, loop->shown, show_one);
    }
    if (loop->made)
        return !is_stopped(e);
    EvaluationMark mark = evaluation_mark(e);
    Environment    env  = bind(e, loop->env, loop->syntax->name, element);
    run_block(e, &env, loop->syntax->children[1], loop->sequence);
    evaluation_forget(e, mark, NULL);
    return !is_stopped(e) && !(loop->sequence && loop->sequence->wrong);
}

/* A loop in another is run iteration by iteration: all iterations of both are to be one instance group. */
static void run_for(Elaboration *e, const Environment *env, const Syntax *syntax,
                    Sequence *sequence)
{
    Loop loop = {.env      = env,
                 .syntax   = syntax,
                 .sequence = sequence,
                 .shown    = e->scene->components.count,
                 .tries    = !sequence && e->iterations && e->iterations->statements == 0};
    if (e->iterations)
        e->iterations->statements++;
    if (!evaluate_each(e, env, syntax->children[0], run_iteration, &loop) && sequence)
        sequence->wrong = true;
    if (e->iterations)
        e->iterations->statements--;
}

static void run_if(Elaboration *e, const Environment *env, const Syntax *syntax,
                   Sequence *sequence);

static void run_statement(Elaboration *e, Environment *env, const Syntax *syntax,
                          Sequence *sequence)
{
    switch (syntax->kind) {
    case SYNTAX_LET:
        *env = bind(e, env, syntax->name, evaluate(e, env, syntax->children[0]));
        break;
    case SYNTAX_DEF:
    case SYNTAX_SHAPE: *env = bind(e, env, syntax->name, value_function(e, env, syntax)); break;
    case SYNTAX_FOR: run_for(e, env, syntax, sequence); break;
    case SYNTAX_IF_STATEMENT: run_if(e, env, syntax, sequence); break;
    case SYNTAX_MESSAGE:
        if (!run_message(e, env, syntax) && sequence)
            sequence->wrong = true;
        break;
    case SYNTAX_SHOW: show_one(e, evaluate_shown(e, env, syntax), syntax->children[0]); break;
    case SYNTAX_KERNEL: add_kernel(e, env, syntax, sequence); break;
    case SYNTAX_REFLECT: add_mirror(e, env, syntax, sequence); break;
    case SYNTAX_MOBIUS: add_map(e, env, syntax, sequence); break;
    case SYNTAX_CAMERA:
    case SYNTAX_LIGHT:
    case SYNTAX_SKY:
    case SYNTAX_FOG:
    case SYNTAX_MEDIUM:
    case SYNTAX_IMAGE:
    case SYNTAX_ZONE: elaborate_view(e, env, syntax); break;
    default: break; /* errors of the parser */
    }
}

static void run_block(Elaboration *e, const Environment *env, const Syntax *block,
                      Sequence *sequence)
{
    Environment inner = *env;
    for (uint32_t i = 0; i < block->count && !is_stopped(e); i++)
        run_statement(e, &inner, block->children[i], sequence);
}

const Syntax *branch_taken(const Syntax *syntax, bool condition)
{
    const uint32_t taken = condition ? 1 : 2;
    return taken < syntax->count ? syntax->children[taken] : NULL;
}

static void run_if(Elaboration *e, const Environment *env, const Syntax *syntax, Sequence *sequence)
{
    Value condition = evaluate(e, env, syntax->children[0]);
    if (condition.type == VALUE_BOOLEAN) {
        const Syntax *branch = branch_taken(syntax, condition.boolean);
        if (branch && branch->kind == SYNTAX_IF_STATEMENT)
            run_if(e, env, branch, sequence);
        else if (branch)
            run_block(e, env, branch, sequence);
        return;
    }
    if (sequence)
        sequence->wrong = true;
    if (condition.type == VALUE_EXPRESSION)
        constant_error(e, syntax->children[0],
                       "the condition of a statement must be known at compile time");
    else
        type_error(e, syntax->children[0], condition, "a truth value");
}

Value elaborate_krs(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Sequence sequence = {0};
    run_block(e, env, syntax, &sequence);
    if (sequence.wrong || is_stopped(e))
        return value_error();
    if (sequence.kernels.count == 0) {
        Diag *diag  = diag_add(e->diags, DIAG_NO_EFFECT, syntax->span,
                               "a sequence without a kernel is empty");
        diag->label = "no `kernel` in here";
        return value_shape(make_empty(e->builder, syntax->span));
    }
    const Shape *krs = make_krs(e->builder, sequence.stages.items, (uint32_t)sequence.stages.count,
                                sequence.kernels.items, (uint32_t)sequence.kernels.count,
                                syntax->span);
    return value_shape(krs);
}

/* ---- the file ---- */

/* Tells whether materials use the coordinates `u` and `v`, or are anisotropic along them.
   `declared`: a declaration of them counts as well. */
static bool mentions_uv(const Syntax *syntax, bool declared)
{
    const char *name  = syntax->name;
    bool        found = name &&
                 (strcmp(name, "u") == 0 || strcmp(name, "v") == 0 ||
                  (declared && strcmp(name, "uv") == 0) || strstr(name, "anisotrop") != NULL);
    for (uint32_t i = 0; i < syntax->count && !found; i++)
        found = mentions_uv(syntax->children[i], declared);
    return found;
}

/* Tells whether files use the coordinates on surfaces.  Declarations of a scene count, since their
   claims are checked; those of the library are true. */
static bool files_mention_uv(const Files *files)
{
    bool found = false;
    for (size_t i = 0; i < files->count && !found; i++)
        found = mentions_uv(files->items[i]->syntax, !files->items[i]->library);
    return found;
}

void run_file(Elaboration *e, Scope *scope)
{
    Environment env = scope->environment;
    for (uint32_t i = 0; i < scope->file->count && !is_stopped(e); i++) {
        const Syntax *syntax = scope->file->children[i];
        switch (syntax->kind) {
        case SYNTAX_LET:
        case SYNTAX_PARAM:
        case SYNTAX_MATERIAL:
        case SYNTAX_DEF:
        case SYNTAX_SHAPE: {
            Definition *definition = scope_find(scope, syntax->name);
            if (definition && definition->syntax == syntax)
                run_definition(e, definition, syntax->name_span);
            break;
        }
        case SYNTAX_USE: break;
        default: {
            EvaluationMark mark = evaluation_mark(e);
            run_statement(e, &env, syntax, NULL);
            evaluation_forget(e, mark, NULL);
        }
        }
    }
}

/* Runs the messages of used files; their other statements are for whoever shows them. */
static void run_messages(Elaboration *e, const Scope *scope)
{
    for (uint32_t i = 0; scope->file && i < scope->file->count; i++)
        if (scope->file->children[i]->kind == SYNTAX_MESSAGE)
            run_message(e, &scope->environment, scope->file->children[i]);
}

/* Gives parameters their slots in the order of the text, whoever needs them first. */
static void run_params(Elaboration *e, Scope *scope)
{
    for (size_t i = 0; i < scope->definitions.count; i++) {
        Definition *definition = scope->definitions.items[i];
        if (definition->syntax->kind == SYNTAX_PARAM)
            run_definition(e, definition, definition->syntax->name_span);
    }
}

void elaborate(Elaboration *e)
{
    e->rounding = NODE_NONE;
    e->uses_uv  = files_mention_uv(e->files);
    scopes_make(e);
    Scope *scope = e->scopes.items[0];
    for (size_t i = 0; i < e->scopes.count; i++)
        run_params(e, e->scopes.items[i]);
    for (size_t i = 1; i < e->scopes.count; i++)
        run_messages(e, e->scopes.items[i]);
    run_file(e, scope);
    plan_boxes(e);
    run_studio(e);
    gather_shown(e);
    e->scene->box = box_empty;
    for (size_t i = 0; i < e->scene->components.count; i++)
        e->scene->box = box_hull(e->scene->box, e->scene->components.items[i].shape->box);
    complete_view(e);
    if (e->scene->components.count == 0 && e->diags->errors == 0) {
        Diag *diag = diag_add(e->diags, DIAG_NOTHING_SHOWN, scope->file->span,
                              "the scene shows nothing");
        diag->help = "write `show` and a shape, for example `show sphere(1);`";
    }
}
