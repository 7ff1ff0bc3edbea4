/*
 * rules_space.c: facts of maps of space, of noise, of identities, of fractals and of textures.
 */
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/bounds/rules.h"
#include "compiler/graph/fractal.h"
#include "compiler/graph/texture.h"

/* ---- maps of space ---- */

/* The rows are orthonormal by construction, so lengths and slopes stay as they are. */
Fact fact_rotate(const RuleInput *input)
{
    const Fact *p    = &input->operands[0];
    double      size = length_range(p->value, 3).high, rows = 0;
    Fact        fact = {0};
    for (uint32_t i = 0; i < 3; i++) {
        Jet jet   = jet_dot(&input->operands[i + 1], p, 3);
        jet.value = range_intersect(jet.value, loosened((Range){-size, size}, size));
        fact_set(&fact, i, jet);
        rows = hypot_upward(rows, input->operands[i + 1].slope);
    }
    fact.slope = sum_upward(p->slope, product_upward(size, rows));
    return fact;
}

/* Returns dot(u, p) - w, the height above a mirror. */
static Jet mirror_height(const RuleInput *input)
{
    Jet along = jet_dot(&input->operands[1], &input->operands[0], 3);
    return jet_sub(along, jet_of(&input->operands[2], 0));
}

/* A fold about a fixed mirror brings no two points further apart. */
Fact fact_fold(const RuleInput *input)
{
    Jet depth = mirror_height(input), none = {0};
    if (depth.value.high <= 0)
        depth = none;
    else if (depth.value.low < 0) {
        depth       = jet_hull(depth, none);
        depth.value = range_above(depth.value, 0);
    }
    Fact fact  = {.slope = HUGE_VAL};
    Jet  twice = jet_times(depth, range_of(2));
    for (uint32_t i = 0; i < 3; i++) {
        Jet back = jet_mul(twice, jet_of(&input->operands[1], i));
        fact_set(&fact, i, jet_sub(jet_of(&input->operands[0], i), back));
    }
    if (operands_constant(input, 1, 3))
        fact.slope = input->operands[0].slope;
    return fact;
}

Fact fact_front(const RuleInput *input)
{
    Range height = mirror_height(input).value;
    return fact_of_truth(input, 3, (Range){height.low > 0, height.high > 0});
}

/* Within a cell it is a translation. */
Fact fact_cell(const RuleInput *input)
{
    const Fact *o    = input->operands;
    Fact        fact = o[0];
    for (uint32_t i = 0; i < 3; i++)
        fact.value[i] = range_in_cell(o[0].value[i], o[1].value[i], o[2].value[i], o[3].value[i]);
    if (operands_constant(input, 1, 4))
        return fact;
    Fact unknown = fact_unknown(3);
    for (uint32_t i = 0; i < 3; i++)
        unknown.value[i] = fact.value[i];
    return unknown;
}

/* The rotated pair (x, z) has lengths in `radius`; so have its derivatives in x', z'. */
static void sector_bounds(const Fact *p, Range count, Fact *fact)
{
    Fact   plane   = {.value = {p->value[0], p->value[2]}};
    Range  radius  = length_range(plane.value, 2);
    double half    = M_PI / count.low;
    bool   narrow  = count.low >= 2;
    Range  x       = {narrow ? radius.low * real_cos(half) : -radius.high, radius.high};
    double z       = narrow ? radius.high * real_sin(half) : radius.high;
    fact->value[0] = loosened(x, radius.high);
    fact->value[2] = loosened((Range){-z, z}, radius.high);
    for (int j = 0; j < 3; j++) {
        double most          = hypot_upward(range_largest(p->gradient[0][j]),
                                            range_largest(p->gradient[2][j]));
        fact->gradient[0][j] = fact->gradient[2][j] = (Range){-most, most};
    }
}

/* Within a sector it is a rotation, and a known one when the box lies in one sector. */
Fact fact_cell_polar(const RuleInput *input)
{
    const Fact *p     = &input->operands[0];
    Range       count = input->operands[1].value[0];
    if (count.high < 1 || input->operands[1].slope != 0)
        return count.high < 1 ? *p : fact_unknown(3);
    Fact fact = *p;
    sector_bounds(p, range_above(count, 1), &fact);
    Range sector  = range_div(range_of(2 * M_PI), count);
    Range sectors = range_round(range_div(range_atan2(p->value[2], p->value[0]), sector));
    if (range_is_single(count) && range_is_single(sectors)) {
        Range angle = range_mul(sectors, sector), c = range_cos(angle), s = range_sin(angle);
        Jet   x = jet_add(jet_times(jet_of(p, 0), c), jet_times(jet_of(p, 2), s));
        Jet   z = jet_sub(jet_times(jet_of(p, 2), c), jet_times(jet_of(p, 0), s));
        x.value = range_intersect(fact.value[0], x.value);
        z.value = range_intersect(fact.value[2], z.value);
        fact_set(&fact, 0, x);
        fact_set(&fact, 2, z);
    }
    for (uint32_t i = 0; i < 3 && count.low < 1; i++)
        fact_set(&fact, i, jet_hull(jet_of(&fact, i), jet_of(p, i)));
    return fact;
}

/* ---- noise ---- */

/*
 * No value is above 1 in size and no derivative above `steepest`, along the axes as in any other
 * direction: proven by tests/property/noise.c for all directions of all gradients.  Over a small
 * part of space the value is near that in the middle.
 */
static Fact fact_noise(const RuleInput *input, double steepest)
{
    const Fact *p      = &input->operands[0];
    NodeValue   middle = {0};
    double      reach  = 0;
    Fact        fact   = {.slope = product_upward(steepest, p->slope)};
    Jet         jet    = {.value = {-1, 1}};
    for (uint32_t i = 0; i < input->size; i++) {
        Range side  = p->value[i];
        middle.v[i] = side.low / 2 + side.high / 2;
        reach       = hypot_upward(reach, fmax(side.high - middle.v[i], middle.v[i] - side.low));
        for (int j = 0; j < 3; j++) {
            Range term      = range_mul((Range){-steepest, steepest}, p->gradient[i][j]);
            jet.gradient[j] = range_add(jet.gradient[j], term);
        }
    }
    if (reach < 1) {
        double value = op_evaluate(input->op, TYPE_FLOAT, 0, input->types, &middle).v[0];
        double rise  = reach > 0 ? steepest * reach + 1e-12 : 0;
        jet.value    = range_intersect((Range){value - rise, value + rise}, jet.value);
    }
    fact_set(&fact, 0, jet);
    return fact;
}

Fact fact_noise2(const RuleInput *input) { return fact_noise(input, 2.84); }
Fact fact_noise3(const RuleInput *input) { return fact_noise(input, 3.64); }

/* ---- identities ---- */

static Fact fact_steps(const RuleInput *input, uint32_t count, double most)
{
    Fact fact     = fact_unknown(1);
    fact.value[0] = (Range){0, most};
    fact.slope    = operands_constant(input, 0, count) ? 0 : HUGE_VAL;
    return fact;
}

Fact fact_identity(const RuleInput *input) { return fact_steps(input, 2, UINT32_MAX); }
Fact fact_to_uint(const RuleInput *input) { return fact_steps(input, 1, UINT32_MAX); }
Fact fact_id_unit(const RuleInput *input) { return fact_steps(input, 1, 1 - 0x1p-24); }
Fact fact_seeded(const RuleInput *input) { return fact_steps(input, 1, 1 - 0x1p-53); }

Fact fact_seeded_direction(const RuleInput *input)
{
    Fact fact = fact_unknown(3);
    for (int i = 0; i < 3; i++)
        fact.value[i] = (Range){-1, 1};
    fact.slope = operands_constant(input, 0, 1) ? 0 : HUGE_VAL;
    return fact;
}

/* Rules do not look into tables. */
Fact fact_of_table(const RuleInput *input)
{
    Fact fact = fact_unknown(input->size);
    if (input->type == TYPE_UINT)
        fact.value[0] = (Range){0, UINT32_MAX};
    return fact;
}

/* Distances do not see pixels. */
Fact fact_footprint(const RuleInput *input)
{
    (void)input;
    return (Fact){0};
}

/* ---- fractals ---- */

/* Finds the value in the middle of the point's range, and how far from there the point can be;
   false where other operands move. */
static bool fractal_middle(const RuleInput *input, uint32_t others, double *middle, double *reach)
{
    NodeValue operands[MAX_OPERANDS] = {0};
    *reach                           = 0;
    for (uint32_t i = 0; i < 3; i++) {
        Range at         = input->operands[0].value[i];
        operands[0].v[i] = at.low / 2 + at.high / 2;
        *reach           = hypot_upward(*reach, fmax(sum_upward(at.high, -operands[0].v[i]),
                                                     sum_upward(operands[0].v[i], -at.low)));
    }
    for (uint32_t i = 1; i <= others; i++)
        for (uint32_t k = 0; k < components(input->types[i]); k++) {
            if (!range_is_single(input->operands[i].value[k]))
                return false;
            operands[i].v[k] = input->operands[i].value[k].low;
        }
    *middle = op_evaluate(input->op, TYPE_FLOAT, 0, input->types, operands).v[0];
    return isfinite(*middle) && isfinite(*reach);
}

/* 1-Lipschitz in the point (fractal.c), between |q| - R and |q| + R. */
Fact fact_julia(const RuleInput *input)
{
    Fact        fact  = fact_unknown(1);
    const Fact *point = &input->operands[0];
    Range       size = length_range(point->value, 3), radius = input->operands[3].value[1];
    double      middle, reach;
    fact.value[0] = (Range){size.low - radius.high, sum_upward(size.high, radius.high)};
    if (fractal_middle(input, 3, &middle, &reach)) {
        Range near    = {middle - reach, middle + reach};
        fact.value[0] = range_intersect(fact.value[0], loosened(near, fabs(middle) + reach));
    }
    if (operands_constant(input, 1, 4))
        fact.slope = point->slope;
    return fact;
}

/* Outside of a ball the distance to a smaller one, inside nothing but an estimate. */
Fact fact_mandelbulb(const RuleInput *input)
{
    Fact        fact  = fact_unknown(1);
    const Fact *point = &input->operands[0];
    Range       size = length_range(point->value, 3), radius = input->operands[2].value[1];
    Range       power = input->operands[1].value[0];
    if (!range_is_single(power) || !(power.low >= 2) || !(radius.low > 0))
        return fact; /* what no scene can write */
    double core  = mandelbulb_core(power.low);
    Range  value = {size.low - radius.high, fmax(size.high - core, 0)};
    bool   far   = size.low > MANDELBULB_NEAR * radius.high;
    if (far)
        value.high = sum_upward(size.high, -radius.low);
    fact.value[0] = loosened(value, size.high);
    if (operands_constant(input, 1, 3) && (far || point->slope == 0))
        fact.slope = point->slope;
    return fact;
}

Fact fact_trap(const RuleInput *input)
{
    Fact fact     = fact_unknown(2);
    fact.value[0] = fact.value[1] = (Range){0, 1};
    if (operands_constant(input, 0, input->op == OP_julia_trap ? 4 : 3))
        fact.slope = 0;
    return fact;
}

/* ---- textures ---- */

static Range either_sign(double size) { return (Range){-size, size}; }

/* Returns a bound with room for the rounding of sums and products. */
static double rounded_up(double bound) { return bound * (1 + 0x1p-48); }

static Jet channel_jet(const Texture *texture, int channel, const Fact *uv)
{
    const TextureLevel *size = &texture->levels[0];
    Range               by_u = either_sign(rounded_up(size->width * texture->across[channel]));
    Range               by_v = either_sign(rounded_up(size->height * texture->up[channel]));
    Jet sum   = jet_add(jet_times(jet_of(uv, 0), by_u), jet_times(jet_of(uv, 1), by_v));
    sum.value = texture->range[channel];
    return sum;
}

/* Returns the fact of a texture.  Coarser levels have the same range; of their slopes nothing is
   needed. */
static Fact texture_fact(const Texture *texture, bool one, const Fact *uv, const Fact *pixel)
{
    Fact fact = fact_unknown(TEXTURE_CHANNELS);
    for (int k = 0; k < TEXTURE_CHANNELS; k++)
        fact.value[k] = texture->range[k];
    if (!range_is_zero(pixel->value[TEXTURE_WIDTH]))
        return fact;
    for (int k = 0; k < TEXTURE_CHANNELS; k++)
        fact_set(&fact, (uint32_t)k, channel_jet(texture, k, uv));
    double slope = one ? texture->slope_of_first : texture->slope_of_all;
    fact.slope   = product_upward(rounded_up(slope), uv->slope);
    return fact;
}

Fact texture_fact_of(const Graph *graph, const Expr *e, const Fact *operands)
{
    bool           one     = e->op == OP_texture_gray;
    const Texture *texture = texture_of(graph, e);
    return fact_agreed(texture_fact(texture, one, &operands[0], &operands[1]),
                       one ? 1 : TEXTURE_CHANNELS);
}
