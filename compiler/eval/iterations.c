/*
 * iterations.c: loops whose iterations differ in numbers only are evaluated once.
 *
 * The first iteration of a loop of shapes that are joined is evaluated as any other, and is the witness.  Then
 * the body is evaluated with a leaf of frame time in the place of the variable, a parameter with the
 * range of its values.  If that reports nothing, and gives a shape like the witness, it is what all
 * iterations have in common.  Their numbers, what the conditions of the loop leave, and their boxes are found
 * by lanes.  Else all is as if nothing had been tried, and each iteration is evaluated by itself.
 */
#include "compiler/eval/iterations.h"

#include <math.h>

#include "compiler/graph/instance_table.h"
#include "compiler/graph/instances/iterations.h"
#include "compiler/shape/iteration_boxes.h"

/* Loops whose iterations may be evaluated at once: each takes a slot of the parameter block. */
enum { MAX_LOOPS = 256, MAX_CONDITIONS = 8, MAX_SHARED_SHAPES = 4096 };

/* ---- what may be tried ---- */

/* Tells whether a statement shows the shapes, which are joined if they are many (shown.c). */
static bool is_shown(const Elaboration *e) { return e->joining && e->joining->kind == SYNTAX_SHOW; }

static bool is_joined(const Elaboration *e, const Syntax *comprehension)
{
    if (is_shown(e))
        return e->joining->children[0] == comprehension;
    for (uint32_t i = 1; e->joining && i < e->joining->count; i++) {
        const Syntax *argument = e->joining->children[i];
        if (argument->kind == SYNTAX_ARGUMENT && argument->children[0] == comprehension)
            return true;
    }
    return false;
}

bool iterations_are_tried(const Elaboration *e)
{
    return e->iterations && e->iterations->loops < MAX_LOOPS && !e->iterated;
}

bool iterations_possible(const Elaboration *e, const Syntax *comprehension)
{
    const Syntax *first = comprehension->children[1];
    if (!iterations_are_tried(e) || !is_joined(e, comprehension) ||
        first->kind != SYNTAX_FOR_CLAUSE || first->children[0]->kind != SYNTAX_RANGE ||
        comprehension->count > 2 + MAX_CONDITIONS)
        return false;
    for (uint32_t i = 2; i < comprehension->count; i++)
        if (comprehension->children[i]->kind == SYNTAX_FOR_CLAUSE)
            return false;
    return true;
}

/* ---- what is put back ---- */

/* The lists that a trial adds to, as they were before. */
typedef struct Before {
    EvaluationMark values;
    GraphMark      graph;
    Diags          diags;
    Scene          scene;
    ShapeBuilder   builder;
    size_t         parameters, checked, functions, defined;
    uint32_t       printed;
    Span           here;
} Before;

static size_t function_count(const Graph *graph)
{
    return graph->instances ? graph->instances->functions.count + graph->instances->tables.count
                            : 0;
}

static Before remember(Elaboration *e)
{
    e->iterations->depth++;
    return (Before){.values     = evaluation_mark(e),
                    .graph      = graph_mark(e->graph),
                    .diags      = *e->diags,
                    .scene      = *e->scene,
                    .builder    = *e->builder,
                    .parameters = e->graph->parameters.count,
                    .checked    = e->checked.count,
                    .functions  = function_count(e->graph),
                    .defined    = e->iterations->defined.count,
                    .printed    = e->printed,
                    .here       = e->graph->here};
}

/* Tells whether nothing was reported, and nothing made that an iteration by itself would not make. */
static bool is_silent(const Elaboration *e, const Before *before)
{
    const Diags *diags = &before->diags;
    return !is_stopped(e) && e->diags->count == diags->count && e->diags->errors == diags->errors &&
           e->diags->warnings == diags->warnings &&
           e->scene->slopes.count == before->scene.slopes.count &&
           e->scene->half_spaces.count == before->scene.half_spaces.count &&
           e->checked.count == before->checked && function_count(e->graph) == before->functions;
}

static void put_back(Elaboration *e, const Before *before)
{
    *e->diags                  = before->diags;
    *e->scene                  = before->scene;
    e->graph->parameters.count = before->parameters;
    e->checked.count           = before->checked;
    e->printed                 = before->printed;
    e->graph->here             = before->here;
    for (size_t i = before->defined; i < e->iterations->defined.count; i++)
        e->iterations->defined.items[i]->state = DEFINITION_NEW;
    ShapeBuilder builder = before->builder;
    if (function_count(e->graph) != before->functions) {
        /* Outlines know the functions that were made, and these have nodes: both stay. */
        builder.outlines = e->builder->outlines;
        graph_keep(e->graph);
    } else {
        graph_release(e->graph, before->graph);
    }
    *e->builder = builder;
}

bool iterations_require(Elaboration *e, Node condition)
{
    if (e->iterated)
        array_push(e->arena, &e->iterated->required, condition);
    return e->iterated != NULL;
}

Iterated *iterations_begin_definition(Elaboration *e, Definition *definition)
{
    Iterated *iterated = e->iterated;
    if (e->iterations && e->iterations->depth > 0)
        array_push(e->arena, &e->iterations->defined, definition);
    e->iterated = NULL;
    return iterated;
}

/* ---- what all iterations have in common ---- */

static Node iteration_leaf(Elaboration *e, const Iterated *t)
{
    const GraphParameter range = {{t->iterations[0]}, {t->iterations[t->count - 1]}};
    const uint32_t       slot  = (uint32_t)e->graph->parameters.count;
    array_push(e->arena, &e->graph->parameters, range);
    return graph_parameter(e->graph, slot, TYPE_FLOAT);
}

bool iteration_condition(Elaboration *e, Iterated *t, Value condition)
{
    t->early_required = t->required.count;
    t->early_end      = (Node)e->graph->count;
    if (condition.type == VALUE_BOOLEAN)
        return condition.boolean;
    if (condition.type != VALUE_EXPRESSION)
        return false;
    const Expr *expr = &e->graph->items[condition.node];
    if (expr->type != TYPE_BOOL || expr->time != TIME_FRAME || t->roots.count == MAX_CONDITIONS)
        return false;
    array_push(e->values, &t->roots, condition.node);
    return true;
}

bool iteration_shape(Iterated *t, Value value)
{
    if (value.type != VALUE_SHAPE || t->found == t->part_count)
        return false;
    t->parts[t->found++].shape = value.shape;
    return true;
}

static bool evaluate_iterated(Elaboration *e, Iterated *t)
{
    const IterationBody *body = t->body;
    t->leaf = t->early_end = iteration_leaf(e, t);
    e->iterated            = t;
    const Value variable   = {.type = VALUE_EXPRESSION, .node = t->leaf};
    Environment env        = bind(e, body->env, body->variable, variable);
    const bool  good       = body->evaluate(e, &env, t) && t->found == t->part_count;
    e->iterated            = NULL;
    t->conditions          = t->roots.count;
    for (size_t i = 0; i < t->required.count; i++)
        array_push(e->values, &t->roots, t->required.items[i]);
    return good;
}

/* ---- whether that is all ---- */

/* Tells whether iterations may share a shape.  Large CSG nodes in it would be instance groups by
   themselves, and a choice leaves different shapes in different iterations. */
static bool may_be_shared(const Elaboration *e, const Shape *shape)
{
    if (shape->kind == SHAPE_CHOICE || shape->kind == SHAPE_ITERATION ||
        shape->child_count >= e->iterations->least)
        return false;
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!may_be_shared(e, shape->children[i]))
            return false;
    return true;
}

/* Tells whether ranges over all iterations give a shape as good as the numbers of one; else each
   iteration is evaluated by itself. */
static bool is_like(const Shape *shape, const Shape *witness)
{
    return shape->kind == witness->kind && shape->figure == witness->figure &&
           shape->tree_shapes == witness->tree_shapes &&
           shape->slope <= witness->slope * (1 + 1e-9) &&
           shape->derived <= witness->derived * (1 + 1e-9) && (shape->exact || !witness->exact) &&
           shape->levels == witness->levels && !shape->fields && !shape->estimate &&
           !shape->per_frame && !shape->open_surfaces && box_is_finite(shape->box);
}

typedef struct Dependence {
    const Graph *graph;
    Node         leaf;
    bool        *depends; /* of the nodes from the leaf on */
} Dependence;

static bool depends(const Dependence *d, Node node)
{
    return node >= d->leaf && d->depends[node - d->leaf];
}

/* An operand of something at points is a number of a table. */
static bool can_be_in_table(const Dependence *d, const Expr *user, int operand)
{
    const Expr *expr = &d->graph->items[user->operands[operand]];
    return !depends(d, user->operands[operand]) || expr->time == TIME_POINT ||
           (expr->type <= TYPE_VEC4 && !op_has_setting((Op)user->op, operand));
}

static bool is_finite(Elaboration *e, Node node)
{
    const GraphType type = (GraphType)e->graph->items[node].type;
    bool            good = true;
    for (uint32_t k = 0; good && type <= TYPE_VEC4 && k < (uint32_t)type; k++) {
        const Range range = graph_frame_range(e->graph, node, k, e->scratch);
        good              = isfinite(range.low) && isfinite(range.high);
    }
    return good;
}

/* Gathers what numbers of iterations are found with, and what must be finite; false: tables cannot have
   it. */
static bool gather_node(Elaboration *e, const Dependence *d, Node node, Nodes *others,
                        Nodes *unbounded)
{
    const Expr *expr = &d->graph->items[node];
    if (op_has_traits((Op)expr->op, OF_HOST) && !depends(d, node))
        return false; /* of a seed that shaders know */
    if (!depends(d, node))
        return true;
    for (int k = 0; k < expr->operand_count; k++) {
        const Node operand = expr->operands[k];
        if (expr->time == TIME_POINT && !can_be_in_table(d, expr, k))
            return false;
        if (expr->time == TIME_FRAME && !depends(d, operand) &&
            d->graph->items[operand].time == TIME_FRAME)
            array_push(e->values, others, operand);
    }
    if (expr->time == TIME_FRAME && !is_finite(e, node))
        array_push(e->values, unbounded, node);
    return true;
}

static bool gather_nodes(Elaboration *e, Iterated *t)
{
    const size_t count  = e->graph->count;
    Dependence   d      = {e->graph, t->leaf, arena_new_array(e->values, bool, count - t->leaf)};
    Nodes        others = {0};
    bool         good   = true;
    const size_t truths = t->roots.count;
    graph_mark_iterated(e->graph, t->leaf, d.depends);
    for (Node node = t->leaf; good && node < count; node++) {
        good = gather_node(e, &d, node, &others, &t->roots);
        if (node < t->early_end)
            t->early_numbers = graph_numbers_of(e->graph, t->roots.items + truths,
                                                t->roots.count - truths);
    }
    for (size_t i = 0; i < t->roots.count; i++)
        array_push(e->values, &others, t->roots.items[i]);
    good = good &&
           !graph_needs_parameters(e->graph, others.items, others.count, t->leaf, e->scratch);
    arena_clear(e->scratch);
    return good;
}

/* ---- iterations ---- */

static void set_iterations(Elaboration *e, Iterated *t, double from, double to)
{
    t->iterations = arena_new_array(e->values, double, (size_t)ceil(to - from) + 1);
    for (uint32_t i = 0; from + i < to; i++)
        t->iterations[t->count++] = from + i;
}

static bool all_hold(const double *truths, size_t count)
{
    bool hold = true;
    for (size_t i = 0; i < count; i++)
        hold = hold && truths[i] != 0;
    return hold;
}

static bool all_finite(const double *numbers, size_t count)
{
    bool finite = true;
    for (size_t i = 0; i < count; i++)
        finite = finite && isfinite(numbers[i]);
    return finite;
}

/* Leaves those for which the conditions hold.  False: one of them must be made by itself. */
static bool choose_iterations(Elaboration *e, Iterated *t)
{
    const size_t width   = graph_numbers_of(e->graph, t->roots.items, t->roots.count);
    double      *numbers = arena_new_array(e->values, double, t->count *width + 1);
    size_t       left    = 0;
    graph_at_iterations(e->graph, t->roots.items, t->roots.count, t->leaf, t->iterations, t->count,
                        numbers, e->scratch);
    for (size_t i = 0; i < t->count; i++) {
        const double *of     = numbers + i * width;
        const size_t  truths = t->conditions + t->required.count;
        if (!all_hold(of + t->conditions, t->early_required) ||
            !all_finite(of + truths, t->early_numbers))
            return false;
        if (!all_hold(of, t->conditions))
            continue;
        if (!all_hold(of + t->conditions, t->required.count) ||
            !all_finite(of + truths, width - truths))
            return false;
        t->iterations[left++] = t->iterations[i];
    }
    t->count = left;
    return true;
}

/* The box that is found for the first iteration is that of the witness. */
static bool boxes_agree(const Box *box, const Box *witness)
{
    for (int k = 0; k < 3; k++) {
        const Range  a = box->axis[k], b = witness->axis[k];
        const double size = 1e-9 + 1e-6 * (fabs(b.low) + fabs(b.high));
        if (!(fabs(a.low - b.low) <= size && fabs(a.high - b.high) <= size))
            return false;
    }
    return true;
}

/* Tells whether a shape is joined by the CSG node.  A blend of bounds is cut to its box, part by
   part (group_iterations.c), and each empty shape that is shown is reported. */
static bool goes_with_csg_node(const IterationBody *body, const Shape *shape)
{
    return body->shown ? !may_vanish(shape) : shape->exact || !body->bounded;
}

static bool any_is_missed(const IterationBody *body, const Box *boxes, size_t count)
{
    bool found = false;
    for (size_t i = 0; body->shown && i < count; i++)
        found = found || box_is_empty(boxes[i]);
    return found;
}

static bool part_is_shared(const Elaboration *e, const Iterated *t, const IterationPart *part)
{
    return is_like(part->shape, part->witness) && goes_with_csg_node(t->body, part->shape) &&
           part->shape->tree_shapes <= MAX_SHARED_SHAPES && may_be_shared(e, part->shape);
}

static bool find_boxes(Elaboration *e, const Iterated *t, IterationPart *part)
{
    part->boxes = arena_new_array(e->values, Box, t->count);
    return iteration_boxes(e->builder, part->shape, t->leaf, t->iterations, t->count, part->boxes,
                           e->values) &&
           boxes_agree(&part->boxes[0], &part->witness->box) &&
           !any_is_missed(t->body, part->boxes, t->count);
}

static bool find_iterations(Elaboration *e, Iterated *t, const Before *before)
{
    bool good = evaluate_iterated(e, t) && is_silent(e, before);
    for (size_t k = 0; good && k < t->part_count; k++)
        good = part_is_shared(e, t, &t->parts[k]);
    good = good && gather_nodes(e, t) && choose_iterations(e, t) &&
           t->count >= e->iterations->least;
    for (size_t k = 0; good && k < t->part_count; k++)
        good = find_boxes(e, t, &t->parts[k]);
    return good;
}

/* The source from which the evaluator makes one iteration by itself. */
typedef struct IterationSource {
    IterationBody body;
    Environment   env; /* that of the body, kept */
    size_t        part, part_count;
} IterationSource;

static const IterationSource *source_of(Elaboration *e, const Iterated *t, size_t part)
{
    const Environment top    = {NULL, t->body->env->scope};
    IterationSource  *source = arena_new(e->arena, IterationSource);
    *source = (IterationSource){*t->body, keep_names(e, t->body->env, &top), part, t->part_count};
    source->body.env = &source->env;
    return source;
}

static void make_parts(Elaboration *e, Iterated *t)
{
    graph_keep(e->graph);
    for (size_t k = 0; k < t->part_count; k++) {
        IterationPart *part = &t->parts[k];
        part->iterations    = arena_new_array(e->arena, const Shape *, t->count);
        make_iterations(e->builder, part->shape, source_of(e, t, k), t->leaf, t->iterations,
                        part->boxes, t->count, part->iterations);
    }
    e->iterations->loops++;
}

const Shape *iteration_alone(Elaboration *e, const Shape *shape)
{
    if (shape->kind != SHAPE_ITERATION)
        return shape;
    const IterationSource *source   = shape->source;
    const EvaluationMark   mark     = evaluation_mark(e);
    Iterated              *iterated = e->iterated;
    const Syntax          *joining  = e->joining;
    const Span             here     = e->graph->here;
    Iterated               t        = {.body = &source->body, .part_count = source->part_count};
    Environment env = bind(e, &source->env, source->body.variable, value_number(shape->number));
    e->iterated     = NULL;
    e->joining      = NULL;
    const bool good = source->body.evaluate(e, &env, &t) && t.found == t.part_count;
    e->iterated     = iterated;
    e->joining      = joining;
    e->graph->here  = here;
    evaluation_forget(e, mark, NULL);
    return good ? t.parts[source->part].shape : NULL;
}

bool iterations_try(Elaboration *e, Iterated *t)
{
    const Syntax *range = t->body->range;
    const Value   from  = evaluate(e, t->body->env, range->children[0]);
    const Value   to    = evaluate(e, t->body->env, range->children[1]);
    if (from.type != VALUE_NUMBER || to.type != VALUE_NUMBER ||
        !(to.number - from.number >= e->iterations->least))
        return false;
    const Before before = remember(e);
    set_iterations(e, t, from.number, to.number);
    const bool found = find_iterations(e, t, &before);
    if (found)
        make_parts(e, t);
    else
        put_back(e, &before);
    e->iterations->depth--;
    if (e->iterations->depth == 0)
        e->iterations->defined.count = 0;
    evaluation_forget(e, before.values, NULL);
    return found;
}

/* ---- lists ---- */

static bool evaluate_element(Elaboration *e, const Environment *env, Iterated *t)
{
    const Syntax *syntax = t->body->syntax;
    for (uint32_t i = 2; i < syntax->count; i++)
        if (!iteration_condition(e, t, evaluate(e, env, syntax->children[i]->children[0])))
            return false;
    return iteration_shape(t, evaluate(e, env, syntax->children[0]));
}

static bool try_list(Elaboration *e, const Comprehension *c)
{
    const Syntax       *clause = c->syntax->children[1];
    const IterationBody body   = {.env      = c->env,
                                  .range    = clause->children[0],
                                  .syntax   = c->syntax,
                                  .variable = clause->name,
                                  .shown    = is_shown(e),
                                  .bounded  = e->joining->count > 2,
                                  .evaluate = evaluate_element};
    Iterated            t      = {.body = &body, .part_count = 1};
    t.parts[0].witness         = c->result->items[0].shape;
    if (c->result->items[0].type != VALUE_SHAPE || !iterations_try(e, &t))
        return false;
    c->result->items[0] = value_shape(t.parts[0].iterations[0]);
    for (size_t i = 1; i < t.count; i++)
        array_push_large(e->values, c->result, value_shape(t.parts[0].iterations[i]));
    return true;
}

Value evaluate_shown(Elaboration *e, const Environment *env, const Syntax *show)
{
    const Syntax *outer = e->joining;
    e->joining          = show;
    const Value value   = evaluate(e, env, show->children[0]);
    e->joining          = outer;
    return value;
}

bool iterations_made(Elaboration *e, const Comprehension *c)
{
    IterationLoop *loop = c->loop;
    if (c->result->count == 0 || loop->tried)
        return loop->made;
    loop->tried = true;
    loop->made  = try_list(e, c);
    return loop->made;
}
