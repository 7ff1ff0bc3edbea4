/*
 * cells.c: repetition: of a shape in all cells alike, and of a function that gets its cell.
 */
#include <math.h>
#include <string.h>

#include "compiler/eval/builtins/builtins.h"
#include "compiler/family/vary.h"

/* ---- the lattice ---- */

/* Copies per axis: a number for all, or a vector, in which 0 is endless. */
static bool cell_counts(Elaboration *e, const Call *call, uint32_t cells[3])
{
    const Argument *count = &call->arguments[1];
    cells[0] = cells[1] = cells[2] = 0;
    if (!count->syntax)
        return true;
    if (count->value.type != VALUE_LIST || count->value.list->count != 3) {
        if (!want_count(e, call, 1, 1, 1000000, 1, &cells[0]))
            return false;
        cells[1] = cells[2] = cells[0];
        return true;
    }
    for (uint32_t i = 0; i < 3; i++) {
        Call one               = *call;
        one.arguments[1].value = count->value.list->items[i];
        if (!want_count(e, &one, 1, 0, 1000000, 1, &cells[i]))
            return false;
    }
    return true;
}

bool want_lattice(Elaboration *e, const Call *call, Node *period, uint32_t cells[3])
{
    const Argument *argument = &call->arguments[0];
    bool            vector   = value_size(e, argument->value) >= 2;
    if (vector)
        *period = want_vector(e, call, 0, ORIGIN);
    else {
        Node number = want_number(e, call, 0, 1);
        *period     = number == NODE_NONE ? number
                                          : graph_op3(e->graph, OP_vec3, number, number, number);
    }
    return *period != NODE_NONE && cell_counts(e, call, cells) &&
           check_not_negative(e, *period, argument->syntax, "a period");
}

/* ---- a function in each cell ---- */

typedef struct Cells {
    const Call     *call;
    const Function *function;
    Node            period;
    uint32_t        counts[3]; /* 1: an axis that does not repeat */
    Values          shapes;
} Cells;

/* Finds the shape of a cell, in its middle; false: reported. */
static bool shape_of_cell(Elaboration *e, const Cells *cells, Value cell, Value *shape)
{
    *shape = call_with(e, cells->function, cell, cells->call->syntax);
    if (shape->type != VALUE_SHAPE)
        type_error(e, cells->call->syntax->children[0], *shape, "a function that makes a shape");
    return shape->type == VALUE_SHAPE;
}

/* Returns the vector from the middle of all cells to that of one. */
static Node place_of_cell(Elaboration *e, const Cells *cells, const double index[3])
{
    double steps[3];
    for (int i = 0; i < 3; i++)
        steps[i] = index[i] - 0.5 * (cells->counts[i] - 1);
    Node by = graph_constant(e->graph, TYPE_VEC3, steps);
    return graph_op2(e->graph, OP_mul, by, cells->period);
}

static bool add_cell(Elaboration *e, Cells *cells, const double index[3])
{
    Value shape;
    Span  span = cells->call->syntax->span;
    if (!count_steps(e, 1, span) || !shape_of_cell(e, cells, value_vector(e, index, 3), &shape))
        return false;
    const Map *map = map_translation(e->builder, place_of_cell(e, cells, index));
    shape          = value_shape(make_transform(e->builder, shape.shape, map, span));
    array_push_large(e->arena, &cells->shapes, shape);
    return shape.type == VALUE_SHAPE;
}

static bool add_cells(Elaboration *e, Cells *cells)
{
    double index[3];
    for (index[2] = 0; index[2] < cells->counts[2]; index[2]++)
        for (index[1] = 0; index[1] < cells->counts[1]; index[1]++)
            for (index[0] = 0; index[0] < cells->counts[0]; index[0]++)
                if (!add_cell(e, cells, index))
                    return false;
    return true;
}

static Value join_cells(Elaboration *e, const Cells *cells)
{
    const Syntax *syntax = cells->call->syntax;
    Argument      all    = {value_list(e, cells->shapes.items, cells->shapes.count), syntax};
    Call join = {.syntax = syntax, .name = cells->call->name, .rest = &all, .rest_count = 1};
    return builtin_union(e, &join);
}

/* Returns the union of all cells. */
static Value union_of_cells(Elaboration *e, Cells *cells)
{
    double total = 1;
    for (int i = 0; i < 3; i++)
        total *= cells->counts[i];
    if (total > MAX_ELEMENTS) {
        Diag *diag  = diag_add(e->diags, DIAG_LIMIT, cells->call->syntax->span,
                               "%.0f cells, each with a shape of its own", total);
        diag->label = "4 million are possible";
        return value_error();
    }
    return add_cells(e, cells) ? join_cells(e, cells) : value_error();
}

/* ---- a function in each sector ---- */

/* Adds one copy, rotated to its sector; false: reported. */
static bool add_sector(Elaboration *e, Cells *cells, Node axis, uint32_t index, uint32_t count)
{
    Value shape;
    Span  span = cells->call->syntax->span;
    if (!count_steps(e, 1, span) || !shape_of_cell(e, cells, value_number(index), &shape))
        return false;
    Node       angle = graph_number(e->graph, 2 * M_PI * index / count);
    const Map *map   = map_rotation(e->builder, axis, angle);
    shape            = value_shape(make_transform(e->builder, shape.shape, map, span));
    array_push_large(e->arena, &cells->shapes, shape);
    return shape.type == VALUE_SHAPE;
}

static Value union_of_sectors(Elaboration *e, Cells *cells)
{
    static const double UP[3] = {0, 1, 0};
    const Call         *call  = cells->call;
    uint32_t            count;
    Node                axis = want_vector(e, call, 1, UP);
    if (!want_count(e, call, 0, 1, 100000, 1, &count) || axis == NODE_NONE ||
        (is_given(call, 1) && !check_direction(e, axis, call->arguments[1].syntax, "an axis")))
        return value_error();
    for (uint32_t i = 0; i < count; i++)
        if (!add_sector(e, cells, axis, i, count))
            return value_error();
    return join_cells(e, cells);
}

/* ---- one function for all cells, where they have no end ---- */

/* Returns a parameter that no author sets: the numbers of a cell, in their range. */
static Node cell_leaf(Elaboration *e, const uint32_t counts[3])
{
    GraphParameter range = {{0}, {0}};
    for (int i = 0; i < 3; i++) {
        range.low[i]  = counts[i] ? 0 : -MAX_CELL_NUMBER;
        range.high[i] = counts[i] ? counts[i] - 1 : MAX_CELL_NUMBER;
    }
    uint32_t slot = (uint32_t)e->graph->parameters.count;
    array_push(e->arena, &e->graph->parameters, range);
    return graph_parameter(e->graph, slot, TYPE_VEC3);
}

/* A slope of the frame would be that of one cell. */
static bool check_slopes(Elaboration *e, const Cells *cells, size_t first, Node leaf)
{
    const StateSlopes *slopes = &e->scene->slopes;
    for (size_t i = first; i < slopes->count; i++) {
        if (!depends_on_leaf(e->graph, slopes->items[i].formula, leaf, e->scratch))
            continue;
        Diag *diag  = diag_add(e->diags, DIAG_STEEP, cells->call->syntax->span,
                               "a slope that depends on the time and on the cell");
        diag->label = "the cells have no end, and so no steepest one";
        diag_secondary(e->diags, diag, slopes->items[i].span, "this expression has it");
        diag->help = "give the repetition a count, or the `param` a range";
        return false;
    }
    return true;
}

/* Explains that a count does what the author tried. */
static void explain_count(Elaboration *e, size_t first)
{
    for (size_t i = first; i < e->diags->count; i++)
        if (e->diags->items[i]->code == DIAG_NOT_COMPILE_TIME)
            e->diags->items[i]->help = "cells without end are made at once, so that only numbers "
                                       "may differ; with a count, each is made by itself";
}

static Value endless_cells(Elaboration *e, const Cells *cells)
{
    Value  shape;
    size_t said   = e->diags->count;
    size_t slopes = e->scene->slopes.count;
    Node   leaf   = cell_leaf(e, cells->counts);
    bool   made = shape_of_cell(e, cells, (Value){.type = VALUE_EXPRESSION, .node = leaf}, &shape);
    explain_count(e, said);
    if (!made || !check_slopes(e, cells, slopes, leaf))
        return value_error();
    return value_shape(make_repeat(e->builder, shape.shape, cells->period, cells->counts, leaf,
                                   cells->call->syntax->span));
}

static bool check_takes_cell(Elaboration *e, const Syntax *syntax, const Function *function)
{
    if (function->syntax && function->syntax->count > 0 &&
        function->syntax->children[0]->kind == SYNTAX_PARAMETER)
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_TOO_MANY_ARGUMENTS, syntax->children[0]->span,
                           "`%s` cannot take a cell", function->name);
    diag->label = function->syntax ? "this has no parameter" : "this is a built-in function";
    diag->help  = "what repeats with variation is a function of its cell: `def house(cell) = ...;`";
    return false;
}

static Value repeat_in_lattice(Elaboration *e, Cells *cells)
{
    if (!want_lattice(e, cells->call, &cells->period, cells->counts))
        return value_error();
    bool endless = false;
    for (uint32_t i = 0; i < 3; i++) {
        if (node_range(e->builder, cells->period, i).high <= 0)
            cells->counts[i] = 1;
        endless = endless || cells->counts[i] == 0;
    }
    return endless ? endless_cells(e, cells) : union_of_cells(e, cells);
}

bool repeats_functions(const char *method)
{
    return strcmp(method, "repeat") == 0 || strcmp(method, "repeat_polar") == 0;
}

Value repeat_function(Elaboration *e, const Environment *env, const Syntax *syntax,
                      const Function *function)
{
    Call        call;
    Cells       cells      = {.call = &call, .function = function};
    bool        polar      = strcmp(syntax->name, "repeat_polar") == 0;
    const char *parameters = polar ? "n axis=" : "period count=";
    if (!check_takes_cell(e, syntax, function) ||
        !bind_arguments(e, env, syntax, 1, syntax->name, parameters, &call))
        return value_error();
    return polar ? union_of_sectors(e, &cells) : repeat_in_lattice(e, &cells);
}
