/*
 * moebius.c: conformal maps that invert: x -> scale R (x - pole) / |x - pole|^2 + shift.
 *
 * With the similarities these are all conformal maps of space (math.md, section 2.2), and the
 * product of any two of them is again of one of the two forms.  What inversions do to distances
 * is in sequence.c.
 */
#include "compiler/shape/map.h"

#include <math.h>

/* The pole of f may be so near to where g takes infinity, in radii of their spheres, that they
   are one; or so near that the pole of the product is too far away to be computed with. */
static const double POLES_MEET = 1e-12, POLES_TOO_NEAR = 1.0 / 64;

/* Returns R^T. */
static Map *rotated_back(ShapeBuilder *builder, const Map *f)
{
    Map *map = map_new(builder);
    transpose_rows(builder->graph, f->rows, map->rows);
    return map;
}

const Map *map_inversion(ShapeBuilder *builder, Node center, Node radius)
{
    Map *map   = map_new(builder);
    map->scale = graph_op2(builder->graph, OP_mul, radius, radius);
    map->pole = map->shift = center;
    return map;
}

/* Returns x = pole + scale R^T (y - shift) / |y - shift|^2: of the same form. */
const Map *inversion_inverse(ShapeBuilder *builder, const Map *f)
{
    Map *map   = rotated_back(builder, f);
    map->scale = f->scale;
    map->pole  = f->shift;
    map->shift = f->pole;
    return map;
}

/* Returns an inversion after a similarity: |y - pole| = scale(g) |x - pole'|, pole' = g^-1(pole). */
static const Map *inversion_after_similarity(ShapeBuilder *builder, const Map *f, const Map *g)
{
    Map *map   = map_new(builder);
    map->scale = graph_op2(builder->graph, OP_div, f->scale, g->scale);
    rotate_product(builder, f->rows, g->rows, map->rows);
    map->pole  = map_apply(builder, map_inverse(builder, g), f->pole);
    map->shift = f->shift;
    return map;
}

static const Map *similarity_after_inversion(ShapeBuilder *builder, const Map *f, const Map *g)
{
    Map *map   = map_new(builder);
    map->scale = graph_op2(builder->graph, OP_mul, f->scale, g->scale);
    rotate_product(builder, f->rows, g->rows, map->rows);
    map->pole  = g->pole;
    map->shift = map_apply(builder, f, g->shift);
    return map;
}

/* The pole of f is where g takes infinity: what is left is a similarity,
   x -> scale(f) / scale(g) R(f) R(g) (x - pole(g)) + shift(f). */
static const Map *concentric_inversions(ShapeBuilder *builder, const Map *f, const Map *g)
{
    Graph *graph = builder->graph;
    Map   *map   = map_new(builder);
    map->scale   = graph_op2(graph, OP_div, f->scale, g->scale);
    rotate_product(builder, f->rows, g->rows, map->rows);
    Node moved = map_apply(builder, map, g->pole); /* while its shift is still 0 */
    map->shift = graph_op2(graph, OP_sub, f->shift, moved);
    return map;
}

/*
 * Returns the product of inversions with different poles.  With d from the pole of f to the shift
 * of g and M the mirror x - 2 (d.x) d / d.d: the pole is g^-1(pole(f)), infinity goes to
 * f(shift(g)), the scale is scale(f) scale(g) / d.d and the rows are R(f) M R(g), as both sides
 * near infinity show.
 */
static const Map *eccentric_inversions(ShapeBuilder *builder, const Map *f, const Map *g,
                                       Node offset, Node square)
{
    Graph     *graph  = builder->graph;
    Map       *map    = map_new(builder);
    Node       zero   = graph_number(graph, 0);
    Node       normal = graph_op1(graph, OP_normalize, offset);
    const Map *mirror = map_reflection(builder, normal, zero);
    Node       rows[3];
    rotate_product(builder, mirror->rows, g->rows, rows);
    rotate_product(builder, f->rows, rows, map->rows);
    map->scale = graph_op2(graph, OP_mul, f->scale, g->scale);
    map->scale = graph_op2(graph, OP_div, map->scale, square);
    map->pole  = map_apply(builder, inversion_inverse(builder, g), f->pole);
    map->shift = map_apply(builder, f, g->shift);
    return map;
}

static double largest_square(ShapeBuilder *builder, Node vector)
{
    double sum = 0;
    for (uint32_t i = 0; i < 3; i++)
        sum += range_square(node_range(builder, vector, i)).high;
    return sum;
}

const Map *moebius_product(ShapeBuilder *builder, const Map *f, const Map *g)
{
    Graph *graph = builder->graph;
    if (f->pole == NODE_NONE)
        return similarity_after_inversion(builder, f, g);
    if (g->pole == NODE_NONE)
        return inversion_after_similarity(builder, f, g);
    if (f->pole == g->shift)
        return concentric_inversions(builder, f, g);
    Node   offset = graph_op2(graph, OP_sub, g->shift, f->pole);
    Node   square = graph_op2(graph, OP_dot, offset, offset);
    Range  range  = node_range(builder, square, 0);
    double radius = fmax(node_range(builder, f->scale, 0).high,
                         node_range(builder, g->scale, 0).high);
    double size   = radius + largest_square(builder, f->pole) + largest_square(builder, g->shift);
    if (graph_is_constant(graph, square) && range.high <= POLES_MEET * POLES_MEET * size)
        return concentric_inversions(builder, f, g);
    if (range.low >= POLES_TOO_NEAR * POLES_TOO_NEAR * radius && isfinite(range.low))
        return eccentric_inversions(builder, f, g, offset, square);
    return NULL;
}

/* ---- quaternion matrices ---- */

typedef struct Quaternion {
    double re, i, j, k;
} Quaternion;

static Quaternion quaternion(const double n[4]) { return (Quaternion){n[0], n[1], n[2], n[3]}; }
static Quaternion conjugate(Quaternion q) { return (Quaternion){q.re, -q.i, -q.j, -q.k}; }
static double square_of(Quaternion q) { return q.re * q.re + q.i * q.i + q.j * q.j + q.k * q.k; }

static Quaternion times(Quaternion a, Quaternion b)
{
    return (Quaternion){a.re * b.re - a.i * b.i - a.j * b.j - a.k * b.k,
                        a.re * b.i + a.i * b.re + a.j * b.k - a.k * b.j,
                        a.re * b.j - a.i * b.k + a.j * b.re + a.k * b.i,
                        a.re * b.k + a.i * b.j - a.j * b.i + a.k * b.re};
}

static Quaternion plus(Quaternion a, Quaternion b)
{
    return (Quaternion){a.re + b.re, a.i + b.i, a.j + b.j, a.k + b.k};
}

static Node point_of(ShapeBuilder *builder, Quaternion q, double factor)
{
    return graph_vec3(builder->graph, factor * q.i, factor * q.j, factor * q.k);
}

/* Finds the rows of x -> q x q^-1, or of its opposite, orthonormal whatever the length of q. */
static void rows_of(ShapeBuilder *builder, Quaternion q, double sign, Node rows[3])
{
    double     factor = copysign(1, sign) / square_of(q);
    Quaternion columns[3];
    for (int i = 0; i < 3; i++) {
        Quaternion axis = {0, i == 0, i == 1, i == 2};
        columns[i]      = times(times(q, axis), conjugate(q));
    }
    rows[0] = graph_vec3(builder->graph, factor * columns[0].i, factor * columns[1].i,
                         factor * columns[2].i);
    rows[1] = graph_vec3(builder->graph, factor * columns[0].j, factor * columns[1].j,
                         factor * columns[2].j);
    rows[2] = graph_vec3(builder->graph, factor * columns[0].k, factor * columns[1].k,
                         factor * columns[2].k);
}

/* Returns why a matrix is refused (math.md, section 2.1): Re(a~ c) = Re(b~ d) = 0, and a~ d + c~ b
   real and not 0. */
static const char *refusal(ShapeBuilder *builder, Quaternion a, Quaternion b, Quaternion c,
                           Quaternion d)
{
    const double tolerance = 1e-9;
    double       ac = times(conjugate(a), c).re, bd = times(conjugate(b), d).re;
    double       sizes[]   = {sqrt(square_of(a)), sqrt(square_of(b)), sqrt(square_of(c)),
                              sqrt(square_of(d))};
    Quaternion   l         = plus(times(conjugate(a), d), times(conjugate(c), b));
    double       imaginary = sqrt(l.i * l.i + l.j * l.j + l.k * l.k);
    double       size      = sizes[0] * sizes[3] + sizes[1] * sizes[2];
    if (fabs(ac) > tolerance * sizes[0] * sizes[2])
        return diag_text(builder->diags, "the real part of conj(a) c is %g, not 0", ac);
    if (fabs(bd) > tolerance * sizes[1] * sizes[3])
        return diag_text(builder->diags, "the real part of conj(b) d is %g, not 0", bd);
    if (imaginary > tolerance * fabs(l.re) + 1e-15 * size)
        return diag_text(builder->diags, "conj(a) d + conj(c) b is [%g, %g, %g, %g], not real",
                         l.re, l.i, l.j, l.k);
    if (!(fabs(l.re) > 1e-14 * size))
        return "conj(a) d + conj(c) b is 0: all of space would go to one point";
    return NULL;
}

const Map *map_of_matrix(ShapeBuilder *builder, const double entries[4][4], const char **reason)
{
    Quaternion a = quaternion(entries[0]), b = quaternion(entries[1]);
    Quaternion c = quaternion(entries[2]), d = quaternion(entries[3]);
    *reason = refusal(builder, a, b, c, d);
    if (*reason)
        return NULL;
    Map   *map = map_new(builder);
    double l   = plus(times(conjugate(a), d), times(conjugate(c), b)).re;
    double cc  = square_of(c);
    if (cc <= 1e-24 * fmin(square_of(a), square_of(d))) {
        /* (a q + b) d^-1, where d^-1 = conj(a) / l. */
        map->scale = graph_number(builder->graph, square_of(a) / fabs(l));
        map->shift = point_of(builder, times(b, conjugate(a)), 1 / l);
        rows_of(builder, a, l, map->rows);
        return map;
    }
    /* (a q + b)(c q + d)^-1 = a c^-1 + k c z c^-1 / |z|^2, z = q + c^-1 d, and |k| is the scale. */
    Quaternion back = times(conjugate(c), d), to = times(a, conjugate(c));
    Quaternion rest = plus(times(to, d), times((Quaternion){-cc, 0, 0, 0}, b));
    map->scale      = graph_number(builder->graph, fabs(l) / cc);
    map->pole       = point_of(builder, back, -1 / cc);
    map->shift      = point_of(builder, to, 1 / cc);
    rows_of(builder, c, times(rest, conjugate(c)).re, map->rows);
    return map;
}
