/*
 * builder.h: what shapes are made with.
 *
 * A builder knows no syntax: shapes are made of numbers, nodes and other shapes, and what is wrong
 * with them is reported at a span.  A function that returns NULL or false has reported.
 */
#ifndef KRS_BUILDER_H
#define KRS_BUILDER_H

#include "compiler/base/diag.h"
#include "compiler/shape/box_rules.h"
#include "compiler/shape/parameters.h"
#include "compiler/shape/shape.h"

typedef struct ShapeBuilder {
    Arena            *arena;   /* shapes and maps */
    Arena            *scratch; /* free to use, and to free */
    Diags            *diags;
    Graph            *graph;
    const Parameters *parameters; /* those that numbers may depend on */
    StateSlopes      *slopes;     /* gets those that no constant bounds */
    struct {
        struct OutlineShape **items;
        size_t                count, capacity;
    } outlines;          /* all that were made */
    size_t nodes_before; /* of the graph, when a shape was last made */
    bool   for_meshes;   /* distances are such that meshes see what is smooth */
    bool   stopped;      /* a limit was reached, and reported: nothing more is */
} ShapeBuilder;

/* Returns a shape with these children, and what most kinds take over from them. */
Shape *shape_new(ShapeBuilder *builder, ShapeKind kind, const char *name, Span span,
                 const Shape *const *children, uint32_t count);
/* Returns the same with one child. */
Shape *shape_around(ShapeBuilder *builder, ShapeKind kind, const char *name, const Shape *child,
                    Span span);
/* Returns the same shape by the name that the author gives it, unless it has one or that is NULL. */
const Shape *shape_named(ShapeBuilder *builder, const Shape *shape, const char *given);
/* Takes over what a shape has from a part that is not among its children. */
void shape_takes_over(Shape *shape, const Shape *part);
/* Returns what is known of its formula, to be changed: no other shape has the same. */
FieldFacts *own_field_facts(ShapeBuilder *builder, Shape *shape);

/* Returns the ranges of frame-time nodes over all values of the parameters. */
Range node_range(ShapeBuilder *builder, Node node, uint32_t component);
/* The same, for the rules of boxes; and the box by the rule of its kind. */
typedef struct BuilderNumbers {
    BoxNumbers    numbers;
    ShapeBuilder *builder;
} BuilderNumbers;
BuilderNumbers builder_numbers(ShapeBuilder *builder);
Box            builder_box(ShapeBuilder *builder, const Shape *shape);

/* Returns the region in which a distance is found, for the box of its surface: for meshes it is
   larger, so that no corner of the distance is at the surface. */
Box builder_region(const ShapeBuilder *builder, Box box);

/* Reports a distance of which nothing is proven, below something (`what`) that moves a surface. */
void check_lipschitz(ShapeBuilder *builder, const Shape *shape, const char *what, Span span);
/* Reports a number that can be 0 or less, or a direction that is always the zero vector. */
bool require_positive(ShapeBuilder *builder, Node number, Span span, const char *what);
bool require_direction(ShapeBuilder *builder, Node vector, Span span, const char *what);

#endif
