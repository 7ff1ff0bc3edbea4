/*
 * texture_facts.c: ranges and slopes of textures.
 */
#include "compiler/graph/bounds/rules.h"
#include "compiler/graph/texture.h"

static Range either_sign(double size) { return (Range){-size, size}; }

/* Room for the rounding of sums and products. */
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

/* Coarser levels have the same range; of their slopes nothing is needed. */
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
