/*
 * op_values.c: what each operation of ops.def is, in double precision.
 *
 * Every definition is total, or not a number exactly where mathematics has no answer.
 */
#include "compiler/graph/op_values.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/blend_shares.h"
#include "compiler/graph/fractal.h"

/* ---- the `evaluate` column of OP rows: `size` is the number of components that matter ---- */

static NodeValue evaluate_splat(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    for (uint32_t i = 0; i < size; i++)
        result.v[i] = o[0].v[0];
    return result;
}

static NodeValue evaluate_vector(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    for (uint32_t i = 0; i < size; i++)
        result.v[i] = o[i].v[0];
    return result;
}

static double dot(const NodeValue *a, const NodeValue *b, uint32_t size)
{
    double sum = 0;
    for (uint32_t i = 0; i < size; i++)
        sum += a->v[i] * b->v[i];
    return sum;
}

static NodeValue evaluate_dot(const NodeValue *o, uint32_t size)
{
    return number(dot(&o[0], &o[1], size));
}

static NodeValue evaluate_cross(const NodeValue *o, uint32_t size)
{
    (void)size;
    const double *a = o[0].v, *b = o[1].v;
    return vector3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

/* Returns the length of a vector; where the sum of squares overflows or loses what is small, hypot
   goes on. */
static double length(const NodeValue *a, uint32_t size)
{
    double sum = 0, whole = fabs(a->v[0]);
    for (uint32_t i = 0; i < size; i++)
        sum += a->v[i] * a->v[i];
    if (sum > 1e-200 && sum < 1e200)
        return sqrt(sum);
    for (uint32_t i = 1; i < size; i++)
        whole = real_hypot(whole, a->v[i]);
    return whole;
}

static NodeValue evaluate_length(const NodeValue *o, uint32_t size)
{
    return number(length(&o[0], size));
}

static NodeValue evaluate_normalize(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    double    whole  = length(&o[0], size);
    for (uint32_t i = 0; i < size && whole != 0; i++)
        result.v[i] = o[0].v[i] / whole;
    return result;
}

static NodeValue evaluate_scale(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    for (uint32_t i = 0; i < size; i++)
        result.v[i] = o[0].v[i] * o[1].v[0];
    return result;
}

static NodeValue evaluate_front(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number(dot(&o[1], &o[0], 3) > o[2].v[0]);
}

static NodeValue evaluate_select(const NodeValue *o, uint32_t size)
{
    (void)size;
    return o[0].v[0] != 0 ? o[1] : o[2];
}

static NodeValue evaluate_guard(const NodeValue *o, uint32_t size)
{
    (void)size;
    double bound = o[0].v[0], least = o[1].v[0];
    return guard_decides(bound, least, o[3].v[0]) ? number(fmin(bound, least)) : o[2];
}

static NodeValue evaluate_rotate(const NodeValue *o, uint32_t size)
{
    (void)size;
    return vector3(dot(&o[1], &o[0], 3), dot(&o[2], &o[0], 3), dot(&o[3], &o[0], 3));
}

static NodeValue evaluate_fold(const NodeValue *o, uint32_t size)
{
    NodeValue result = o[0];
    double    depth  = fmax(dot(&o[1], &o[0], 3) - o[2].v[0], 0);
    for (uint32_t i = 0; i < size; i++)
        result.v[i] -= 2 * depth * o[1].v[i];
    return result;
}

static NodeValue evaluate_cell(const NodeValue *o, uint32_t size)
{
    NodeValue result = o[0];
    for (uint32_t i = 0; i < size; i++) {
        double period = o[1].v[i];
        if (period > 0) {
            double cell = floor(o[0].v[i] / period + 0.5);
            result.v[i] -= period * fmin(fmax(cell, o[2].v[i]), o[3].v[i]);
        }
    }
    return result;
}

static NodeValue evaluate_cell_polar(const NodeValue *o, uint32_t size)
{
    (void)size;
    const double *p = o[0].v, count = o[1].v[0];
    if (!(count >= 1))
        return o[0];
    double sector = 2 * M_PI / count;
    double angle  = sector * floor(value_atan2(p[2], p[0]) / sector + 0.5);
    double c = real_cos(angle), s = real_sin(angle);
    return vector3(c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]);
}

/*
 * Gradient noise (Perlin, "Improving noise", 2002): at each point of the lattice of whole numbers
 * stands a linear function, 0 there, in one of twelve directions (eight in the plane); between
 * them it is faded by 6 t^5 - 15 t^4 + 10 t^3.  Divided by the largest value there can be; the
 * bounds are proven in tests/property/noise.c.  Beyond 2^30 it goes on as it is there.
 */
static const double NOISE_END = 1073741824, NOISE_UNIT_2 = 0.99, NOISE_UNIT_3 = 0.96;

static double lattice_fraction(double p, uint32_t *cell)
{
    double clamped = fmin(fmax(p, -NOISE_END), NOISE_END), whole = floor(clamped);
    *cell = (uint32_t)(int32_t)whole;
    return clamped - whole;
}

static double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

/* Returns the direction of a lattice point, from what was scrambled of its other coordinates. */
static uint32_t lattice_bits(uint32_t row, uint32_t cell) { return scramble(row + cell) >> 28; }

static double slope_of_2(uint32_t h, double x, double y)
{
    double straight = (h & 2 ? y : x) * sqrt(2), diagonal = h & 2 ? x - y : x + y;
    double along = h & 4 ? straight : diagonal;
    return h & 1 ? -along : along;
}

static double slope_of_3(uint32_t h, double x, double y, double z)
{
    double u = h < 8 ? x : y, v = h < 4 ? y : h == 12 || h == 14 ? x : z;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

static double interpolate(double a, double b, double t) { return a + (b - a) * t; }

static NodeValue evaluate_noise2(const NodeValue *o, uint32_t size)
{
    uint32_t cell[2];
    double   f[2], rows[2];
    for (uint32_t i = 0; i < size; i++) {
        if (isnan(o[0].v[i]))
            return number(o[0].v[i]);
        f[i] = lattice_fraction(o[0].v[i], &cell[i]);
    }
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t column = scramble(cell[0] + i);
        double   x      = f[0] - i;
        double   low    = slope_of_2(lattice_bits(column, cell[1]), x, f[1]);
        double   high   = slope_of_2(lattice_bits(column, cell[1] + 1), x, f[1] - 1);
        rows[i]         = interpolate(low, high, fade(f[1]));
    }
    return number(NOISE_UNIT_2 * interpolate(rows[0], rows[1], fade(f[0])));
}

static NodeValue evaluate_noise3(const NodeValue *o, uint32_t size)
{
    uint32_t cell[3];
    double   f[3], planes[2], rows[2];
    for (uint32_t i = 0; i < size; i++) {
        if (isnan(o[0].v[i]))
            return number(o[0].v[i]);
        f[i] = lattice_fraction(o[0].v[i], &cell[i]);
    }
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t plane = scramble(cell[0] + i);
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t row = scramble(plane + cell[1] + k);
            double   x = f[0] - i, y = f[1] - k;
            double   low  = slope_of_3(lattice_bits(row, cell[2]), x, y, f[2]);
            double   high = slope_of_3(lattice_bits(row, cell[2] + 1), x, y, f[2] - 1);
            rows[k]       = interpolate(low, high, fade(f[2]));
        }
        planes[i] = interpolate(rows[0], rows[1], fade(f[1]));
    }
    return number(NOISE_UNIT_3 * interpolate(planes[0], planes[1], fade(f[0])));
}

static NodeValue evaluate_push_id(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number((uint32_t)o[0].v[0] * 2u + (o[1].v[0] != 0));
}

static NodeValue evaluate_hash_id(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number(scramble((uint32_t)o[0].v[0] + (o[1].v[0] != 0 ? 0x9e3779b9u : 0x7f4a7c15u)));
}

static NodeValue evaluate_join_id(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number(scramble(scramble((uint32_t)o[0].v[0]) + (uint32_t)o[1].v[0]));
}

static NodeValue evaluate_to_uint(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number((uint32_t)fmax(o[0].v[0], 0));
}

static NodeValue evaluate_id_unit(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number((scramble((uint32_t)o[0].v[0]) >> 8) / 16777216.0);
}

/* ---- random numbers of numbers: the same on every machine ---- */

/* Hashes the bits of the seed by SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom
   number generators", 2014); -0 and 0 are one seed. */
static uint64_t hash_seed(double seed, uint64_t stream)
{
    uint64_t bits;
    seed += 0.0;
    memcpy(&bits, &seed, sizeof bits);
    bits += (stream + 1) * 0x9E3779B97F4A7C15u;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    bits ^= bits >> 31;
    bits += 0x9E3779B97F4A7C15u;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    return bits ^ (bits >> 31);
}

/* Returns the number in [0, 1) that belongs to a seed. */
static double unit_of_seed(double seed, uint64_t stream)
{
    return (double)(hash_seed(seed, stream) >> 11) * 0x1p-53;
}

static NodeValue evaluate_seeded(const NodeValue *o, uint32_t size)
{
    const uint64_t stream = (uint64_t)o[1].v[0];
    (void)size;
    return number(unit_of_seed(o[0].v[0], stream ? stream + (UINT64_C(1) << 32) : 0));
}

/* Returns a random direction by Marsaglia (1972): a point of the unit disc gives a point of the
   sphere by products and roots only, which every machine computes alike. */
static NodeValue evaluate_seeded_direction(const NodeValue *o, uint32_t size)
{
    const double seed   = o[0].v[0];
    uint64_t     stream = 1 + ((uint64_t)o[1].v[0] << 32);
    double       a, b, s;
    (void)size;
    do {
        a = 2 * unit_of_seed(seed, stream) - 1;
        b = 2 * unit_of_seed(seed, stream + 1) - 1;
        s = a * a + b * b;
        stream += 2;
    } while (s >= 1);
    const double root = 2 * sqrt(1 - s);
    return vector3(a * root, 1 - 2 * s, b * root);
}

/* ---- smooth minima (math.md, section 4); a width of 0 leaves min(a, b) ---- */

/* Returns the difference in widths; infinite distances are as near as equal ones. */
static double widths_between(double a, double b, double width)
{
    return a == b ? 0 : fabs(a - b) / width;
}

static BlendShares shares_of_eight(FindShares *sharers, const NodeValue *o)
{
    double distances[8];
    memcpy(distances, o[0].v, 4 * sizeof *distances);
    memcpy(distances + 4, o[1].v, 4 * sizeof *distances);
    return sharers(distances, 8, o[2].v[0]);
}

#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              weights, meaning)                                                                  \
    static NodeValue evaluate_smin_##name(const NodeValue *o, uint32_t size)                     \
    {                                                                                            \
        (void)size;                                                                              \
        double a = o[0].v[0], b = o[1].v[0], k = o[2].v[0];                                      \
        if (!(k > 0))                                                                            \
            return number(fmin(a, b));                                                           \
        double t = widths_between(a, b, k), h = fmax(1 - t, 0);                                  \
        double n = sizeof signature > sizeof "fff>f" ? o[3].v[0] : 0;                            \
        (void)h, (void)n;                                                                        \
        return number(value);                                                                    \
    }
#include "compiler/graph/blends.def"

#define BLEND_SHARES(name, sharers, ...)                                           \
    static NodeValue evaluate_smin4_##name(const NodeValue *o, uint32_t size)      \
    {                                                                              \
        (void)size;                                                                \
        return number(sharers(o[0].v, 4, o[1].v[0]).result);                       \
    }                                                                              \
    static NodeValue evaluate_threshold4_##name(const NodeValue *o, uint32_t size) \
    {                                                                              \
        (void)size;                                                                \
        return number(sharers(o[0].v, 4, o[1].v[0]).threshold);                    \
    }                                                                              \
    static NodeValue evaluate_smin8_##name(const NodeValue *o, uint32_t size)      \
    {                                                                              \
        (void)size;                                                                \
        return number(shares_of_eight(sharers, o).result);                         \
    }                                                                              \
    static NodeValue evaluate_threshold8_##name(const NodeValue *o, uint32_t size) \
    {                                                                              \
        (void)size;                                                                \
        return number(shares_of_eight(sharers, o).threshold);                      \
    }
#include "compiler/graph/blends.def"

static NodeValue evaluate_blend_weight(const NodeValue *o, uint32_t size)
{
    (void)size;
    double a = o[0].v[0], b = o[1].v[0], k = o[2].v[0];
    if (!(k > 0))
        return number(b >= a);
    return number(a == b ? 0.5 : fmin(fmax(0.5 + 0.5 * (b - a) / k, 0), 1));
}

/* Evaluates a footprint, which is 0: the host has no pixels. */
static NodeValue evaluate_footprint(const NodeValue *o, uint32_t size)
{
    (void)o, (void)size;
    return number(0);
}

/* ---- tables ---- */

/* Refuses operations of tables and textures, which only a tape knows (evaluate.c). */
static NodeValue evaluate_of_table(const NodeValue *o, uint32_t size)
{
    (void)o, (void)size;
    assert(!"what reads tables is evaluated by tapes");
    return number(0);
}

/* ---- one operation ---- */

/* Truth values are numbers of one component. */
#define TRUTH(name, arity, value, ...)                                  \
    static NodeValue evaluate_##name(const NodeValue *o, uint32_t size) \
    {                                                                   \
        const double a = o[0].v[0], b = arity > 1 ? o[1].v[0] : 0;      \
        (void)size, (void)b;                                            \
        return number(value);                                           \
    }
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning)              \
    static void map_##name(const double *x, const double *y, const double *z, uint32_t size, \
                           double *to)                                                       \
    {                                                                                        \
        for (uint32_t i = 0; i < size; i++) {                                                \
            const double a = x[i], b = arity > 1 ? y[i] : 0, c = arity > 2 ? z[i] : 0;       \
            (void)b, (void)c, (void)y, (void)z;                                              \
            to[i] = (value) + 0.0;                                                           \
        }                                                                                    \
    }
#include "compiler/graph/ops.def"

MapValue *const map_values[OP_COUNT] = {
#define MAP(name, ...) [OP_##name] = map_##name,
#include "compiler/graph/ops.def"
};

static NodeValue (*const evaluates[OP_COUNT])(const NodeValue *o, uint32_t size) = {
#define OP(name, signature, glsl, evaluate, facts, meaning) [OP_##name] = evaluate,
#include "compiler/graph/ops.def"
};

/* Evaluates an operation.  Zero has no sign: -0 becomes 0, so that 1 / (-1 * 0) does not depend on
   who multiplied. */
NodeValue op_evaluate(Op op, GraphType type, uint32_t index, const GraphType *types,
                      const NodeValue *operands)
{
    NodeValue value = {0};
    uint32_t  size  = components(type);
    assert(map_values[op] || evaluates[op] || op == OP_COMPONENT);
    if (map_values[op])
        map_values[op](operands[0].v, operands[1].v, operands[2].v, size, value.v);
    else if (op == OP_COMPONENT)
        value = number(operands[0].v[index]);
    else
        value = evaluates[op](operands, components(types[0]) > size ? components(types[0]) : size);
    for (int i = 0; i < 4; i++)
        value.v[i] += 0.0;
    return value;
}
