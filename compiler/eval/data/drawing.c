/*
 * drawing.c: the built-in function `svg`: drawings as plane figures with colours.
 */
#include <math.h>
#include <string.h>

#include "compiler/eval/data/from_files.h"
#include "compiler/eval/view/material.h"
#include "compiler/front/token.h"
#include "compiler/outline/svg.h"

/* ---- reports ---- */

static void report_notes(Elaboration *e, const Call *call, const SvgDrawing *drawing,
                         const char *name)
{
    if (drawing->notes.count == 0)
        return;
    Diag *diag  = diag_add(e->diags, DIAG_LEFT_OUT, call->arguments[0].syntax->span,
                           "something in `%s` is left out", name);
    diag->label = diag_text(e->diags, "%zu kind%s of it", drawing->notes.count,
                            drawing->notes.count == 1 ? "" : "s");
    for (size_t i = 0; i < drawing->notes.count; i++)
        diag_note(e->diags, diag,
                  diag_text(e->diags, "%s:%u: %s", name, drawing->notes.items[i].line,
                            drawing->notes.items[i].what));
    diag->help = "only areas and strokes are read; most editors turn texts into paths";
}

static void report_fault(Elaboration *e, const Call *call, const SvgDrawing *drawing,
                         const char *name)
{
    Diag *diag  = diag_add(e->diags, DIAG_BAD_DRAWING, call->arguments[0].syntax->span, "%s:%u: %s",
                           name, drawing->fault_line, drawing->fault);
    diag->label = "this drawing cannot be read";
}

/* ---- from the drawing to the plane ---- */

typedef struct Placing {
    double center[2], scale;
} Placing;

static void place_point(const Placing *placing, double p[2])
{
    p[0] = (p[0] - placing->center[0]) * placing->scale;
    p[1] = (placing->center[1] - p[1]) * placing->scale;
}

static void place_curves(const Placing *placing, Curves *curves)
{
    for (size_t i = 0; i < curves->count; i++) {
        place_point(placing, curves->items[i].from);
        place_point(placing, curves->items[i].via);
        place_point(placing, curves->items[i].to);
    }
}

/* Finds the box of the view, or of what is drawn where there is no view. */
static void find_view(SvgDrawing *drawing)
{
    if (drawing->low[0] <= drawing->high[0])
        return;
    for (int k = 0; k < 2; k++) {
        drawing->low[k]  = HUGE_VAL;
        drawing->high[k] = -HUGE_VAL;
    }
    for (size_t i = 0; i < drawing->figures.count; i++) {
        const Curves *curves = &drawing->figures.items[i].curves;
        for (size_t c = 0; c < curves->count; c++)
            for (int k = 0; k < 2; k++) {
                drawing->low[k]  = fmin(drawing->low[k], curves->items[c].from[k]);
                drawing->high[k] = fmax(drawing->high[k], curves->items[c].from[k]);
            }
    }
}

static Placing placing_of(SvgDrawing *drawing, double size)
{
    find_view(drawing);
    double  longest = fmax(drawing->high[0] - drawing->low[0], drawing->high[1] - drawing->low[1]);
    Placing placing = {.scale = longest > 0 ? size / longest : 1};
    for (int k = 0; k < 2; k++)
        placing.center[k] = drawing->figures.count ? 0.5 * (drawing->low[k] + drawing->high[k]) : 0;
    return placing;
}

/* ---- figures ---- */

static Value painted_figure(Elaboration *e, const Call *call, const SvgFigure *figure)
{
    Span         span  = call->syntax->span;
    const Shape *shape = make_outline(e->builder, "svg", &figure->curves, figure->rule, span);
    double       linear[3];
    if (!shape)
        return value_error();
    linear_from_srgb(figure->rgb, linear);
    const Material *paint = to_material(e, value_vector(e, linear, 3), call->syntax);
    return paint ? value_shape(make_paint(e->builder, shape, paint, span)) : value_error();
}

static Value figures_of(Elaboration *e, const Call *call, SvgDrawing *drawing, double size)
{
    Placing placing = placing_of(drawing, size);
    Value  *items   = arena_new_array(e->arena, Value, drawing->figures.count + 1);
    for (size_t i = 0; i < drawing->figures.count; i++) {
        place_curves(&placing, &drawing->figures.items[i].curves);
        items[i] = painted_figure(e, call, &drawing->figures.items[i]);
        if (items[i].type == VALUE_ERROR)
            return value_error();
    }
    return value_list(e, items, drawing->figures.count);
}

Value builtin_svg(Elaboration *e, Call *call)
{
    const Argument *file = &call->arguments[0];
    FileBytes       bytes;
    SvgDrawing      drawing = {.arena = e->arena};
    double          size    = 1;
    if (file->value.type != VALUE_STRING) {
        type_error(e, file->syntax, file->value, "the name of a file");
        return value_error();
    }
    if (!want_constant(e, call, 1, &size) || !read_beside(e, file, file->value.string, &bytes))
        return value_error();
    if (!(size > 0 && size < MAX_EXTENT)) {
        diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[1].syntax->span,
                 "the size of a drawing must be greater than 0, and below 1e12");
        return value_error();
    }
    if (!svg_read(&drawing, (const char *)bytes.bytes, bytes.length)) {
        report_fault(e, call, &drawing, bytes.path);
        return value_error();
    }
    report_notes(e, call, &drawing, bytes.path);
    return figures_of(e, call, &drawing, size);
}
