/*
 * family.h: all shapes that can be made.
 *
 * Each function states, for its kind, the box of the result and how its slope follows from the
 * children's (shapes.def has the table, math.md section 4 the proofs).  NULL: reported.
 */
#ifndef KRS_FAMILY_H
#define KRS_FAMILY_H

#include "compiler/lower/context.h"
#include "compiler/outline/outline.h"
#include "compiler/shape/map.h"
#include "compiler/shape/slope.h"

/* ---- primitive.c: shapes that hold no others ---- */
/* Makes a primitive; `distance` is an expression of the point, negative inside; all of that is in
   the box.  What else is known of it may be filled in; then comes one of the next two. */
Shape *primitive_new(ShapeBuilder *builder, const char *name, Node distance, Box box, Span span);
/* Makes the distance safe, by a slope that is claimed of it, or by a lesser one that is derived. */
void claim_slope(ShapeBuilder *builder, Shape *primitive, double slope);
/* Does the same, by a slope that is derived over all space or, where that has no bound, over the
   box; the distance outside of that is then brought out from the nearest point in it (field.c).
   False: there is no bound, and *blame is what changes too fast. */
bool         derive_slope(ShapeBuilder *builder, Shape *primitive, Span distance, Blame *blame);
const Shape *make_empty(ShapeBuilder *builder, Span span);

/* ---- outline.c: plane figures that contours fill ---- */
/* Makes an outline; NULL: reported. */
const Shape *make_outline(ShapeBuilder *builder, const char *name, const Curves *curves,
                          FillRule rule, Span span);
/* Returns the distance of an outline, as far as the context needs that. */
Node lower_outline_distance(Lowering *l, const Shape *shape, LowerContext context);

/* ---- shapes from shapes ---- */
/* Makes a moved shape; NULL: an inversion of something endless, which is reported. */
const Shape *make_transform(ShapeBuilder *builder, const Shape *shape, const Map *map, Span span);
const Shape *make_stretch(ShapeBuilder *builder, const Shape *shape, Node factors, Span span);
const Shape *make_csg_node(ShapeBuilder *builder, ShapeKind kind, const Shape *const *shapes,
                           uint32_t count, Blend blend, Span span);
/* Makes the part of a shape in a region, which is not seen; NULL: all is.  It is known to be
   between these two corners; NULL: to be in the box of the shape. */
const Shape *make_clip(ShapeBuilder *builder, const Shape *shape, const Shape *region,
                       const Node corners[2], Span span);
const Shape *make_morph(ShapeBuilder *builder, const Shape *a, const Shape *b, Node t, Span span);
/* The condition is a truth value that does not depend on the point. */
const Shape *make_choice(ShapeBuilder *builder, Node condition, const Shape *yes, const Shape *no,
                         Span span);
const Shape *make_offset(ShapeBuilder *builder, const Shape *shape, Node radius, Span span);
/* Makes `shape` with round edges: its core, grown. */
const Shape *make_rounded(ShapeBuilder *builder, const Shape *shape, const Shape *core, Node radius,
                          Span span);
const Shape *make_shell(ShapeBuilder *builder, const Shape *shape, Node thickness, Span span);
/* Makes the surface alone; thick only where something needs a distance to it. */
const Shape *make_open_surface(ShapeBuilder *builder, const Shape *shape, Node thickness,
                               Span span);
const Shape *make_elongate(ShapeBuilder *builder, const Shape *shape, Node half, Span span);
const Shape *make_extrude(ShapeBuilder *builder, const Shape *figure, Node height, Span span);
const Shape *make_revolve(ShapeBuilder *builder, const Shape *figure, Node offset, Span span);
/* Whole numbers of cells without end are from -2^23 to 2^23; beyond, all are called like the last. */
static const double MAX_CELL_NUMBER = 8388608;
/* The shape may depend on its cell: on a VEC3 parameter of its own, `cell`, whose range is that of the
   numbers of cells, from 0 on axes with a count; else `cell` is NODE_NONE.  NULL: the shape does not
   fit its cell, which is reported. */
const Shape *make_repeat(ShapeBuilder *builder, const Shape *shape, Node period,
                         const uint32_t cells[3], Node cell, Span span);
const Shape *make_repeat_polar(ShapeBuilder *builder, const Shape *shape, uint32_t count,
                               Span span);
const Shape *make_mirror(ShapeBuilder *builder, const Shape *shape, Node normal, Node offset,
                         Span span);
/* The width may be NODE_NONE: a pixel's. */
const Shape *make_smooth(ShapeBuilder *builder, const Shape *shape, Node width, Span span);
/* Makes a painted shape; NULL: the material needs what the shape has not, which is reported. */
const Shape *make_paint(ShapeBuilder *builder, const Shape *shape, const Material *material,
                        Span span);
/* Reports a shape that is endless, at the place of an inversion. */
bool check_invertible(ShapeBuilder *builder, const Shape *shape, Span span);
/* Makes a sequence; NULL: something endless is inverted, which is reported. */
const Shape *make_krs(ShapeBuilder *builder, const SequenceStage *stages, uint32_t stage_count,
                      const Shape *const *kernels, uint32_t kernel_count, Span span);
/* Finds the unit normal and offset of a shape that is a plane, also a moved, rotated or scaled
   one. */
bool shape_plane(ShapeBuilder *builder, const Shape *shape, Node *normal, Node *offset);
/* Finds the centre and radius of a shape that is a ball, also a moved, rotated or scaled one. */
bool shape_ball(ShapeBuilder *builder, const Shape *shape, Node *centre, Node *radius);

/* The sum of shapes that fade by a falloff with this reach is at least the level inside. */
const Shape *make_meta(ShapeBuilder *builder, const Shape *const *shapes, uint32_t count,
                       Node level, Node reach, FalloffKind falloff, Span span);

/* ---- iteration.c: shapes that a loop makes, which differ in numbers only ---- */
/* Makes the shapes of iterations in which the leaf is the number; the boxes are theirs. */
void make_iterations(ShapeBuilder *builder, const Shape *shared,
                     const struct IterationSource *source, Node leaf, const double *numbers,
                     const Box *boxes, size_t count, const Shape **iterations);

/* ---- fractal.c: iterations are a whole number of frame time, `most` the most there can be ---- */
/* Makes the Julia set of q -> q^power + c; c is a VEC4. */
const Shape *make_julia(ShapeBuilder *builder, Node c, uint32_t power, Node iterations, double most,
                        Span span);
const Shape *make_mandelbulb(ShapeBuilder *builder, uint32_t power, Node iterations, double most,
                             Span span);

/* ---- deform.c: deformations ---- */
/* The arguments of a deformation: a direction, numbers, and where they stand, for reports. */
typedef struct DeformArguments {
    const char *name;
    Node        axis, numbers[2];
    Span        span, shape_span, number_spans[2];
} DeformArguments;

/* NULL: reported. */
typedef const Shape *MakeDeformed(ShapeBuilder *builder, const Shape *shape,
                                  const DeformArguments *arguments);
#define DEFORMATION(KIND, name, parameters, rule, meaning) MakeDeformed make_##name;
#include "compiler/shape/shapes.def"
/* Makes a shape that is moved outwards by a formula of the point, times numbers[0]. */
const Shape *make_displace(ShapeBuilder *builder, const Shape *shape, Node formula,
                           Span formula_span, const DeformArguments *arguments);

/* ---- field.c: solids given by an expression that is negative inside ---- */
/* Makes a field; NULL: reported.  `algebraic`: it must be a polynomial. */
const Shape *make_field(ShapeBuilder *builder, Node formula, bool algebraic, Span span);
/* Returns a bound on the distance to where an expression is 0 in the region over which it has this
   slope: that of the nearest point in it, brought out. 1-Lipschitz everywhere. */
Node extend_from_region(ShapeBuilder *builder, Node formula, const Steepness *slope);
/* Returns the same shape where only what is in the box matters: fields in it get their bound
   there.  `uniform`: one that is about the distance near their surfaces, if possible. */
const Shape *restrict_shape(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform);
/* Reports a field in the tree that has no bound. */
bool check_bounded(ShapeBuilder *builder, const Shape *shape);

#endif
