/*
 * texture.c: pyramids of texels, what is known of them, and how they are read in double precision.
 *
 * print/glsl/textures.glsl reads them by the same formulas.
 */
#include "compiler/graph/texture.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/half.h"

/* ---- texels ---- */

static uint32_t bits_of_float(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static float float_of_bits(uint32_t bits)
{
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static uint32_t two_halves(const float *numbers)
{
    return half_from_float(numbers[0]) | (uint32_t)half_from_float(numbers[1]) << 16;
}

static double low_half(uint32_t bits) { return float_from_half((uint16_t)bits); }
static double high_half(uint32_t bits) { return float_from_half((uint16_t)(bits >> 16)); }

/* Packs two samples of a gray picture, four of a colour. */
static void pack_texel(bool gray, const float *samples, TexelBits bits)
{
    bits[0] = gray ? bits_of_float(samples[0]) : two_halves(samples);
    bits[1] = gray ? bits_of_float(samples[1]) : two_halves(samples + 2);
}

static NodeValue unpack_texel(bool gray, const TexelBits bits)
{
    if (gray) {
        double level = float_of_bits(bits[0]);
        return (NodeValue){{level, level, level, float_of_bits(bits[1])}};
    }
    return (NodeValue){
        {low_half(bits[0]), high_half(bits[0]), low_half(bits[1]), high_half(bits[1])}};
}

static NodeValue texel_at(const Texture *texture, uint32_t level, uint32_t x, uint32_t y)
{
    const TextureLevel *at = &texture->levels[level];
    return unpack_texel(texture->gray, texture->texels[at->first + (size_t)y * at->width + x]);
}

/* ---- levels ---- */

/* A picture of floats, the rows from the bottom upwards. */
typedef struct Samples {
    float   *items;
    uint32_t width, height, size; /* floats of a pixel */
} Samples;

static float *sample_at(const Samples *samples, uint32_t x, uint32_t y)
{
    return samples->items + ((size_t)y * samples->width + x) * samples->size;
}

static Samples samples_new(uint32_t width, uint32_t height, uint32_t size, Arena *arena)
{
    return (Samples){arena_new_array(arena, float, (size_t)width *height *size), width, height,
                     size};
}

/* The part of the `count` texels of the finer level that texel `to` covers: from, and until, where
   half as many are in the level. */
typedef struct Cover {
    double   low, high;
    uint32_t first, end;
} Cover;

static Cover cover_of(uint32_t to, uint32_t count, uint32_t coarse)
{
    Cover cover = {.low = (double)to * count / coarse, .high = (double)(to + 1) * count / coarse};
    cover.first = (uint32_t)cover.low;
    cover.end   = (uint32_t)ceil(cover.high);
    return cover;
}

static double share(const Cover *cover, uint32_t i)
{
    return fmin(cover->high, i + 1.0) - fmax(cover->low, i);
}

static void put_mean(const Samples *fine, Cover across, Cover up, float *mean)
{
    double sum[TEXTURE_CHANNELS] = {0}, area = 0;
    for (uint32_t y = up.first; y < up.end; y++)
        for (uint32_t x = across.first; x < across.end; x++) {
            double weight = share(&across, x) * share(&up, y);
            area += weight;
            for (uint32_t k = 0; k < fine->size; k++)
                sum[k] += weight * (double)sample_at(fine, x, y)[k];
        }
    for (uint32_t k = 0; k < fine->size; k++)
        mean[k] = (float)(sum[k] / area);
}

static uint32_t halved(uint32_t side) { return side > 1 ? side / 2 : 1; }

static Samples next_level(const Samples *fine, Arena *arena)
{
    Samples coarse = samples_new(halved(fine->width), halved(fine->height), fine->size, arena);
    for (uint32_t y = 0; y < coarse.height; y++)
        for (uint32_t x = 0; x < coarse.width; x++)
            put_mean(fine, cover_of(x, fine->width, coarse.width),
                     cover_of(y, fine->height, coarse.height), sample_at(&coarse, x, y));
    return coarse;
}

static void place_levels(Texture *texture, uint32_t width, uint32_t height)
{
    for (;;) {
        assert(texture->level_count < MAX_TEXTURE_LEVELS);
        texture->levels[texture->level_count++] = (TextureLevel){width, height,
                                                                 texture->texel_count};
        texture->texel_count += (size_t)width * height;
        if (width == 1 && height == 1)
            return;
        width  = halved(width);
        height = halved(height);
    }
}

static void put_level(Texture *texture, uint32_t level, const Samples *samples)
{
    const size_t first = texture->levels[level].first;
    const size_t count = (size_t)samples->width * samples->height;
    for (size_t i = 0; i < count; i++)
        pack_texel(texture->gray, samples->items + i * samples->size, texture->texels[first + i]);
}

/* ---- what is known of level 0 ---- */

/* Returns the texel beside the last one of `count`. */
static uint32_t beside(TextureWrap wrap, uint32_t i, uint32_t count)
{
    return i + 1 < count ? i + 1 : wrap == WRAP_REPEAT ? 0 : i;
}

/* Notes the slope in a square between the middles of four texels.  The gradient is largest in a
   corner: it is made of the difference of a side and that of one across to it. */
static void note_square(Texture *texture, const NodeValue corners[2][2])
{
    const TextureLevel *size = &texture->levels[0];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            double squares = 0;
            for (int k = 0; k < TEXTURE_CHANNELS; k++) {
                double across = fabs(corners[i][1].v[k] - corners[i][0].v[k]);
                double up     = fabs(corners[1][j].v[k] - corners[0][j].v[k]);
                double square = real_pow(size->width * across, 2) + real_pow(size->height * up, 2);
                texture->across[k] = fmax(texture->across[k], across);
                texture->up[k]     = fmax(texture->up[k], up);
                squares += square;
                if (k == 0)
                    texture->slope_of_first = fmax(texture->slope_of_first, sqrt(square));
            }
            texture->slope_of_all = fmax(texture->slope_of_all, sqrt(squares));
        }
}

static void note_range(Texture *texture, NodeValue texel)
{
    for (int k = 0; k < TEXTURE_CHANNELS; k++) {
        texture->range[k].low  = fmin(texture->range[k].low, texel.v[k]);
        texture->range[k].high = fmax(texture->range[k].high, texel.v[k]);
    }
}

static void find_facts(Texture *texture)
{
    const TextureLevel *size = &texture->levels[0];
    for (int k = 0; k < TEXTURE_CHANNELS; k++)
        texture->range[k] = (Range){HUGE_VAL, -HUGE_VAL};
    for (uint32_t y = 0; y < size->height; y++)
        for (uint32_t x = 0; x < size->width; x++) {
            uint32_t  right         = beside(texture->wrap, x, size->width);
            uint32_t  above         = beside(texture->wrap, y, size->height);
            NodeValue corners[2][2] = {
                {texel_at(texture, 0, x, y), texel_at(texture, 0, right, y)},
                {texel_at(texture, 0, x, above), texel_at(texture, 0, right, above)}};
            note_range(texture, corners[0][0]);
            note_square(texture, (const NodeValue(*)[2])corners);
        }
}

/* ---- making ---- */

static Samples upside_down(const float *samples, uint32_t width, uint32_t height, uint32_t size,
                           Arena *arena)
{
    Samples turned = samples_new(width, height, size, arena);
    size_t  row    = (size_t)width * size;
    for (uint32_t y = 0; y < height; y++)
        memcpy(turned.items + y * row, samples + (height - 1 - y) * row, row * sizeof *samples);
    return turned;
}

Texture texture_new(const float *samples, uint32_t width, uint32_t height, bool gray,
                    TextureWrap wrap, Arena *arena, Arena *scratch)
{
    Texture texture = {.wrap = wrap, .gray = gray};
    Samples level   = upside_down(samples, width, height, gray ? 2 : TEXTURE_CHANNELS, scratch);
    place_levels(&texture, width, height);
    texture.texels = arena_new_array(arena, TexelBits, texture.texel_count);
    for (uint32_t i = 0; i < texture.level_count; i++) {
        put_level(&texture, i, &level);
        if (i + 1 < texture.level_count)
            level = next_level(&level, scratch);
    }
    find_facts(&texture);
    return texture;
}

/* ---- reading ---- */

/* Beyond this single precision has no fractions. */
static const double FARTHEST_PLACE = 1073741824;

/* Returns a coordinate in [0, 1] of the picture that stands there. */
static double wrapped(TextureWrap wrap, double t)
{
    t = fmin(fmax(t, -FARTHEST_PLACE), FARTHEST_PLACE);
    if (wrap == WRAP_REPEAT)
        return t - floor(t);
    if (wrap == WRAP_MIRROR)
        return fabs(t - 2 * floor(0.5 * t + 0.5));
    return fmin(fmax(t, 0), 1);
}

/* The two texels around a coordinate of [0, 1], and the share of the second. */
typedef struct Neighbours {
    uint32_t first, second;
    double   share;
} Neighbours;

static Neighbours neighbours_of(TextureWrap wrap, double t, uint32_t count)
{
    double     place = t * count - 0.5, whole = floor(place);
    Neighbours near  = {.share = place - whole};
    bool       round = wrap == WRAP_REPEAT;
    near.first       = whole >= 0 ? (uint32_t)whole : round ? count - 1 : 0;
    near.second      = whole + 1 < count ? (uint32_t)(whole + 1) : round ? 0 : count - 1;
    return near;
}

static NodeValue mix_values(NodeValue a, NodeValue b, double share)
{
    for (int k = 0; k < TEXTURE_CHANNELS; k++)
        a.v[k] = a.v[k] * (1 - share) + b.v[k] * share;
    return a;
}

/* Interpolates a level bilinearly. */
static NodeValue level_value(const Texture *texture, uint32_t level, const double uv[2])
{
    const TextureLevel *at = &texture->levels[level];
    Neighbours          x  = neighbours_of(texture->wrap, uv[0], at->width);
    Neighbours          y  = neighbours_of(texture->wrap, uv[1], at->height);
    NodeValue           rows[2];
    for (int i = 0; i < 2; i++) {
        uint32_t row = i ? y.second : y.first;
        rows[i]      = mix_values(texel_at(texture, level, x.first, row),
                                  texel_at(texture, level, x.second, row), x.share);
    }
    return mix_values(rows[0], rows[1], y.share);
}

/* Finds the level for a pixel of a width, which may be no number where a place has no derivative. */
static double level_of(double width)
{
    const double widest = 1 << MAX_TEXTURE_LEVELS;
    return !(width < widest) ? real_log2(widest) : width > 1 ? real_log2(width) : 0;
}

NodeValue texture_value(const Texture *texture, const double uv[2], double width)
{
    double    place[2] = {wrapped(texture->wrap, uv[0]), wrapped(texture->wrap, uv[1])};
    double    most     = texture->level_count - 1;
    double    level    = fmin(level_of(width), most);
    uint32_t  fine     = (uint32_t)level;
    NodeValue value    = {{NAN, NAN, NAN, NAN}};
    if (isnan(uv[0]) || isnan(uv[1]))
        return value;
    value = level_value(texture, fine, place);
    if (level > fine)
        value = mix_values(value, level_value(texture, fine + 1, place), level - fine);
    return value;
}

/* Takes the mean of several taps: as large a share of them reads the coarser level as a mixture would have. */
NodeValue texture_mean(const Texture *texture, const double uv[2], const double pixel[4])
{
    const double asked = pixel[TEXTURE_TAPS];
    const int    taps  = asked > 1 ? (int)fmin(asked, MAX_TEXTURE_TAPS) : 1; /* also of no number */
    const double level = fmin(level_of(pixel[TEXTURE_WIDTH]), texture->level_count - 1);
    const double fine = floor(level), share = level - fine;
    NodeValue    mean = {{0}};
    if (taps == 1 || isnan(uv[0]) || isnan(uv[1]))
        return texture_value(texture, uv, pixel[TEXTURE_WIDTH]);
    for (int i = 0; i < taps; i++) {
        const double    aside    = (i + 0.5) / taps - 0.5;
        const bool      coarse   = floor((i + 1) * share + 0.5) > floor(i * share + 0.5);
        const double    place[2] = {wrapped(texture->wrap, uv[0] + aside * pixel[TEXTURE_LONG_U]),
                                    wrapped(texture->wrap, uv[1] + aside * pixel[TEXTURE_LONG_V])};
        const NodeValue value    = level_value(texture, (uint32_t)fine + coarse, place);
        for (int k = 0; k < TEXTURE_CHANNELS; k++)
            mean.v[k] += value.v[k] / taps;
    }
    return mean;
}

/* ---- nodes ---- */

const Texture *texture_of(const Graph *graph, const Expr *e)
{
    uint32_t number = (uint32_t)graph->items[e->operands[2]].number[0];
    assert(graph->textures && number < graph->textures->list.count);
    return &graph->textures->list.items[number];
}

Node graph_texture(Graph *graph, Op op, uint32_t texture, Node uv, Node pixel)
{
    Node number = graph_uint(graph, texture);
    return graph_op3(graph, op, uv, pixel, number);
}
