/*
 * blends.c: what is known of blends, by the rows of blends.def.
 */
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/shape/shape.h"

const BlendInfo blend_info[BLEND_COUNT] = {
#define BLEND(name, signature, slope, bulge, most, ...) {#name, OP_smin_##name, slope, bulge, most},
#include "compiler/graph/blends.def"
};

double blend_bulge(BlendKind kind, uint32_t count)
{
    const BlendInfo *info = &blend_info[kind];
    return fmin(info->bulge * real_log2(count), info->most);
}

BlendMany blend_many(BlendKind kind)
{
    static const BlendMany ways[BLEND_COUNT] = {
#define BLEND_SHARES(name, ...) [BLEND_##name] = {MANY_SHARE, OP_smin4_##name, OP_smin8_##name},
#define BLEND_IN_ROW(name)      [BLEND_##name] = {.way = MANY_IN_ROW},
#include "compiler/graph/blends.def"
    };
    return ways[kind];
}

double blend_reach(BlendKind kind, double n)
{
    const double reaches[BLEND_COUNT] = {
#define BLEND(name, signature, slope, bulge, most, reach, ...) [BLEND_##name] = (reach),
#include "compiler/graph/blends.def"
    };
    return reaches[kind];
}

double blend_acts(BlendKind kind, double n)
{
    const double acts_within[BLEND_COUNT] = {
#define BLEND(name, signature, slope, bulge, most, reach, acts, ...) [BLEND_##name] = (acts),
#include "compiler/graph/blends.def"
    };
    (void)n;
    return acts_within[kind];
}

bool blend_fades(BlendKind kind)
{
    const bool fading[BLEND_COUNT] = {
#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, ...) \
    [BLEND_##name] = (fades),
#include "compiler/graph/blends.def"
    };
    return fading[kind];
}

const Blend blend_sharp = {.width = NODE_NONE, .steps = NODE_NONE};
