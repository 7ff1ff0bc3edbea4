/* grown.c: figures of known outlines that are grown, as outlines of their own. */
#include "compiler/base/elementary.h"
#include "compiler/eval/builtins/builtins.h"
#include "compiler/family/family.h"
#include "compiler/lower/figure_outline.h"

/* The distance of parabolas from arcs that is permitted, in sizes of the figure. */
static const double TOLERANCE = 1e-6;
/* The angle by which a part of an arc may turn. */
static const double MAX_TURN = 0.8;

static void point_of_arc(const Curve *arc, double angle, double away, double point[2])
{
    point[0] = arc->centre[0] + away * real_cos(angle);
    point[1] = arc->centre[1] + away * real_sin(angle);
}

/* Adds an arc as parabolas with its tangents at their ends, which are radius turn^4 / 128 off in
   the middle. */
static void add_arc(Arena *arena, Curves *curves, const Curve *arc, double off)
{
    double begin = real_atan2(arc->from[1] - arc->centre[1], arc->from[0] - arc->centre[0]);
    double end   = real_atan2(arc->to[1] - arc->centre[1], arc->to[0] - arc->centre[0]);
    double turn  = remainder(end - begin, 2 * M_PI);
    double most  = fmin(real_pow(128 * off / arc->radius, 0.25), MAX_TURN);
    int    count = (int)fmax(ceil(fabs(turn) / most), 1);
    double part = turn / count, far = arc->radius / real_cos(0.5 * part);
    Curve  curve = {.to = {arc->from[0], arc->from[1]}};
    for (int i = 1; i <= count; i++) {
        for (int k = 0; k < 2; k++)
            curve.from[k] = curve.to[k];
        point_of_arc(arc, begin + (i - 0.5) * part, far, curve.via);
        point_of_arc(arc, begin + i * part, arc->radius, curve.to);
        for (int k = 0; k < 2 && i == count; k++)
            curve.to[k] = arc->to[k];
        array_push(arena, curves, curve);
    }
}

/* Tells whether it is an outline that is drawn, wherever it was moved. */
static bool is_drawn(const Shape *figure)
{
    while (figure->kind == SHAPE_TRANSFORM)
        figure = figure->children[0];
    return figure->outline != NULL;
}

const Shape *grown_outline(Elaboration *e, const Shape *figure, const Shape *grown)
{
    Curves found = {0}, curves = {0};
    bool   changed;
    if (!e->outlines || !grown->figure || !is_drawn(figure) ||
        !figure_outline(e->graph, grown, e->scratch, &found, &changed) || found.count == 0)
        return grown;
    double size = 0;
    for (size_t i = 0; i < found.count; i++)
        for (int k = 0; k < 2; k++)
            size = fmax(size, fabs(found.items[i].from[k]));
    for (size_t i = 0; i < found.count; i++)
        if (found.items[i].radius > 0)
            add_arc(e->scratch, &curves, &found.items[i], TOLERANCE * size);
        else
            array_push(e->scratch, &curves, found.items[i]);
    return make_outline(e->builder, grown->name, &curves, FILL_NONZERO, grown->span);
}
