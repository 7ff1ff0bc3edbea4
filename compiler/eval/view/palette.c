/*
 * palette.c: `.color_by`: a surface coloured by a number.
 *
 * The colours stand at equal steps from 0 to 1, and between them light is mixed linearly.
 */
#include "compiler/eval/view/material.h"

#include "compiler/front/token.h"

enum { STOPS = 6, MAX_STOPS = 64 };

/* sRGB */
static const uint32_t palettes[][STOPS] = {
#define PALETTE(name, ...) {__VA_ARGS__},
#include "compiler/eval/view/palettes.def"
#undef PALETTE
};
static const char *const palette_spellings[] = {
#define PALETTE(name, ...) name,
#include "compiler/eval/view/palettes.def"
#undef PALETTE
};
static const Choices palette_names = {
    .noun    = "palette",
    .wanted  = "the name of a palette",
    .unknown = "unknown palette",
    .more    = "; a list of colours is one, too",
    .items   = palette_spellings,
    .count   = sizeof palettes / sizeof *palettes,
};

/* Returns the colours of a palette's name, the first one's without an argument; 0: reported. */
static uint32_t named_colors(Elaboration *e, const Argument *argument, Node *colors)
{
    uint32_t chosen;
    if (!want_name(e, argument, &palette_names, &chosen))
        return 0;
    for (uint32_t k = 0; k < STOPS; k++) {
        double linear[3];
        linear_from_srgb(palettes[chosen][k], linear);
        colors[k] = graph_constant(e->graph, TYPE_VEC3, linear);
    }
    return STOPS;
}

/* Returns where an element of a list is written, or all of the list. */
static const Syntax *stop_syntax(const Syntax *written, const List *list, size_t index)
{
    bool elements = written->kind == SYNTAX_LIST && written->count == list->count;
    return elements ? written->children[index] : written;
}

/* Returns the colours of a list of them; 0: reported. */
static uint32_t listed_colors(Elaboration *e, const Argument *argument, Node *colors)
{
    const List *list  = argument->value.type == VALUE_LIST ? argument->value.list : NULL;
    bool        right = list && list->count >= 2 && list->count <= MAX_STOPS;
    for (size_t i = 0; right && i < list->count; i++) {
        right     = value_size(e, list->items[i]) == 3;
        colors[i] = right ? value_node(e, list->items[i]) : NODE_NONE;
    }
    for (size_t i = 0; right && i < list->count; i++)
        warn_of_bright_colour(e, stop_syntax(argument->syntax, list, i), list->items[i],
                              "a surface reflects at most what it gets");
    if (right)
        return (uint32_t)list->count;
    type_error(e, argument->syntax, argument->value,
               "the name of a palette or a list of two colours or more");
    return 0;
}

/* Returns the first colour and, for each that follows, as much of the way there as the field is
   past. */
static Node color_at(Graph *g, Node field, const Node *colors, uint32_t count)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1), color = colors[0];
    Node at = graph_op2(g, OP_mul, field, graph_number(g, count - 1));
    for (uint32_t i = 0; i + 1 < count; i++) {
        Node past = graph_op2(g, OP_sub, at, graph_number(g, i));
        past      = graph_op3(g, OP_clamp, past, zero, one);
        color     = graph_op3(g, OP_mix, color, colors[i + 1], past);
    }
    return color;
}

Value method_color_by(Elaboration *e, const Shape *shape, Call *call)
{
    Node            colors[MAX_STOPS];
    const Argument *field = &call->arguments[0], *palette = &call->arguments[1];
    if (value_size(e, field->value) != 1) {
        type_error(e, field->syntax, field->value, "a number");
        return value_error();
    }
    bool     named = !palette->syntax || palette->value.type == VALUE_STRING;
    uint32_t count = named ? named_colors(e, palette, colors) : listed_colors(e, palette, colors);
    if (count == 0)
        return value_error();
    Material *material = arena_new(e->arena, Material);
    Node      number   = value_node(e, field->value);
    material->name     = "palette";
    material->bump     = NODE_NONE;
#define KRS_MATERIAL(property, type, otherwise, nothing, low, high, asked, blends) \
    material->property = NODE_NONE;
#include "krs/surface.def"
    material->color = color_at(e->graph, number, colors, count);
    return value_shape(make_paint(e->builder, shape, material, call->syntax->span));
}
