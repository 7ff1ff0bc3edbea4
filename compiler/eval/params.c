/*
 * params.c: numbers of a scene that its user may set.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

/* Numbers of a `param`: its default, or a bound of its range; 0: reported. */
static uint32_t constants_of(Elaboration *e, Value value, const Syntax *syntax, double numbers[4])
{
    if (value.type == VALUE_NUMBER) {
        numbers[0] = value.number;
        return 1;
    }
    uint32_t count = value.type == VALUE_LIST && value.list->count <= 4
                         ? (uint32_t)value.list->count
                         : 0;
    for (uint32_t i = 0; i < count; i++) {
        if (value.list->items[i].type != VALUE_NUMBER)
            count = 0;
        else
            numbers[i] = value.list->items[i].number;
    }
    if (count >= 2)
        return count;
    if (value_time(e, value) != TIME_COMPILE) {
        Diag *diag  = diag_add(e->diags, DIAG_NOT_COMPILE_TIME, syntax->span,
                               "the value of a `param` must be a constant");
        diag->label = "this is not known at compile time";
    } else {
        Diag *diag = type_error(e, syntax, value, "a number, a vector or a colour");
        if (value.type == VALUE_BOOLEAN)
            diag->help = form_help(e->diags, FORM_TRUTH_PARAM);
    }
    return 0;
}

static void refuse_range(Elaboration *e, const Syntax *syntax, Value range)
{
    const Syntax *written = syntax->children[1];
    if (written->kind == SYNTAX_RANGE && range.type == VALUE_LIST && range.list->count != 2) {
        Diag *diag  = diag_add(e->diags, DIAG_RANGE_OF_PARAM, written->span,
                               "the range of `%s` is a list of %zu numbers", syntax->name,
                               range.list->count);
        diag->label = "two are needed, the lowest and the highest";
        diag->help  = form_help(e->diags, FORM_RANGE_ENDS);
        return;
    }
    Diag *diag  = diag_add(e->diags, DIAG_RANGE_OF_PARAM, written->span,
                           "the range of `%s` does not fit its default", syntax->name);
    diag->label = "[low, high] with low <= default <= high";
    diag_secondary(e->diags, diag, syntax->children[0]->span, "the default");
}

/* Finds the range of a `param`, endless when it has none; a number counts for all components. */
static bool param_range(Elaboration *e, const Environment *env, const Syntax *syntax,
                        Parameter *parameter)
{
    for (int i = 0; i < 4; i++) {
        parameter->low[i]  = -INFINITY;
        parameter->high[i] = INFINITY;
    }
    if (syntax->count < 2)
        return true;
    Value  range = evaluate(e, env, syntax->children[1]);
    double bounds[2][4];
    if (range.type == VALUE_ERROR)
        return false;
    bool good = range.type == VALUE_LIST && range.list->count == 2;
    for (uint32_t side = 0; good && side < 2; side++) {
        uint32_t count = constants_of(e, range.list->items[side], syntax->children[1],
                                      bounds[side]);
        if (!count)
            return false;
        for (uint32_t i = 0; count == 1 && i < 4; i++)
            bounds[side][i] = bounds[side][0];
        good = count == 1 || count == parameter->components;
    }
    for (uint32_t i = 0; good && i < parameter->components; i++) {
        parameter->low[i]  = bounds[0][i];
        parameter->high[i] = bounds[1][i];
        good = bounds[0][i] <= parameter->value[i] && parameter->value[i] <= bounds[1][i];
    }
    if (good)
        return true;
    refuse_range(e, syntax, range);
    return false;
}

/* The syntax tree does not live as long as the scene that is made of it. */
static const char *copy_doc(Elaboration *e, const char *doc)
{
    return doc ? arena_copy_text(e->arena, doc, strlen(doc)) : NULL;
}

static bool is_whole(const Syntax *param)
{
    return param->count > 1 && param->children[1]->kind == SYNTAX_RANGE;
}

Value define_param(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Parameter parameter = {.name         = syntax->name,
                           .degrees      = written_in_degrees(e, syntax),
                           .color        = syntax->children[0]->kind == SYNTAX_COLOUR,
                           .whole        = is_whole(syntax),
                           .doc          = copy_doc(e, syntax->doc),
                           .name_span    = syntax->name_span,
                           .default_span = syntax->children[0]->span};
    Value     value     = evaluate(e, env, syntax->children[0]);
    if (value.type == VALUE_ERROR)
        return value;
    if (strcmp(syntax->name, "angle") == 0)
        warn_of_revolutions(e, syntax->children[0], value);
    parameter.components = constants_of(e, value, syntax->children[0], parameter.value);
    if (!parameter.components || !param_range(e, env, syntax, &parameter))
        return value_error();
    parameter.slot       = (uint32_t)e->graph->parameters.count;
    GraphParameter range = {{0}, {0}};
    memcpy(range.low, parameter.low, sizeof range.low);
    memcpy(range.high, parameter.high, sizeof range.high);
    array_push(e->arena, &e->graph->parameters, range);
    array_push(e->arena, &e->scene->parameters, parameter);
    Node node = graph_parameter(e->graph, parameter.slot, (GraphType)parameter.components);
    return (Value){.type = VALUE_EXPRESSION, .node = node};
}
