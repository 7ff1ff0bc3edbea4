/*
 * lane_cell_calls.h: operations that have no steps, as loops over the lanes of cell tapes, in single precision.
 *
 * Each is what op_values.c has point by point; formulas for single precision are those of print/glsl.  It is included by
 * lane_loop.h.  x[k] is the row of a component of an operand, in their order.
 */
#ifndef KRS_LANE_CELL_CALLS_H
#define KRS_LANE_CELL_CALLS_H

#include "compiler/graph/fractal.h"
#include "compiler/graph/lanes/lane_math.h"
#include "compiler/graph/op_values.h"

/* ---- numbers of copies ---- */

static inline float lane_push_id(float a, float b)
{
    return lane_bits(lane_bits_of(a) * 2 + (b != 0));
}

static inline float lane_hash_id(float a, float b)
{
    return lane_bits(scramble(lane_bits_of(a) + (b != 0 ? 0x9e3779b9u : 0x7f4a7c15u)));
}

static inline float lane_join_id(float a, float b)
{
    return lane_bits(scramble(scramble(lane_bits_of(a)) + lane_bits_of(b)));
}

static inline float lane_to_uint(float a)
{
    return lane_bits(a > 0 && a < 4294967296.0f ? (uint32_t)a : 0);
}

static inline float lane_id_unit(float a)
{
    return (float)(int32_t)(scramble(lane_bits_of(a)) >> 8) * (1.0f / 16777216);
}

/* ---- noise ---- */

static inline float lane_fade(float t) { return t * t * t * (t * (6 * t - 15) + 10); }

/* Returns the whole part of a coordinate as an integer, and the rest. */
static inline float lane_lattice(float p, uint32_t *cell)
{
    const float clamped = p < -1073741824.0f  ? -1073741824.0f
                          : p > 1073741824.0f ? 1073741824.0f
                                              : p;
    const float whole   = floorf(clamped);
    *cell               = (uint32_t)(int32_t)(whole == whole ? whole : 0);
    return clamped - whole;
}

static inline uint32_t lane_lattice_bits(uint32_t x) { return scramble(x) >> 28; }

static inline float lane_between(float a, float b, float t) { return a + (b - a) * t; }

static inline float lane_slope_2(uint32_t h, float x, float y)
{
    const float straight = (h & 2 ? y : x) * 1.41421356237f, diagonal = x + (h & 2 ? -y : y);
    const float along = h & 4 ? straight : diagonal;
    return h & 1 ? -along : along;
}

static inline float lane_slope_3(uint32_t h, float x, float y, float z)
{
    const float u = h < 8 ? x : y, other = (h | 2) == 14 ? x : z, v = h < 4 ? y : other;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

static inline float lane_noise2(float x, float y)
{
    uint32_t       cell_x, cell_y;
    const float    f = lane_lattice(x, &cell_x), g = lane_lattice(y, &cell_y), t = lane_fade(g);
    const uint32_t a = scramble(cell_x) + cell_y, b = scramble(cell_x + 1) + cell_y;
    const float    low  = lane_between(lane_slope_2(lane_lattice_bits(a), f, g),
                                       lane_slope_2(lane_lattice_bits(a + 1), f, g - 1), t);
    const float    high = lane_between(lane_slope_2(lane_lattice_bits(b), f - 1, g),
                                       lane_slope_2(lane_lattice_bits(b + 1), f - 1, g - 1), t);
    return 0.99f * lane_between(low, high, lane_fade(f));
}

static inline float lane_noise_row(uint32_t row, float x, float y, float z, float t)
{
    return lane_between(lane_slope_3(lane_lattice_bits(row), x, y, z),
                        lane_slope_3(lane_lattice_bits(row + 1), x, y, z - 1), t);
}

static inline float lane_noise3(float x, float y, float z)
{
    uint32_t    cell_x, cell_y, cell_z;
    const float f = lane_lattice(x, &cell_x), g = lane_lattice(y, &cell_y),
                h = lane_lattice(z, &cell_z), s = lane_fade(g), t = lane_fade(h);
    const uint32_t a = scramble(cell_x) + cell_y, b = scramble(cell_x + 1) + cell_y;
    const float    low  = lane_between(lane_noise_row(scramble(a) + cell_z, f, g, h, t),
                                       lane_noise_row(scramble(a + 1) + cell_z, f, g - 1, h, t), s);
    const float    high = lane_between(lane_noise_row(scramble(b) + cell_z, f - 1, g, h, t),
                                       lane_noise_row(scramble(b + 1) + cell_z, f - 1, g - 1, h, t),
                                       s);
    return 0.96f * lane_between(low, high, lane_fade(f));
}

/* ---- fractals ---- */

/* Raises (a, b), a number and an imaginary unit whose square is -square, to a power up to 16. */
static inline void lane_raise(float *a, float *b, int power, float square)
{
    float all = 1, other = 0, x = *a, y = *b;
    for (int bit = 0; bit < 5; bit++) {
        const float p = all * x - square * other * y, q = all * y + other * x;
        const bool  takes = power >> bit & 1;
        all               = takes ? p : all;
        other             = takes ? q : other;
        const float twice = 2 * x * y;
        x                 = x * x - square * y * y;
        y                 = twice;
    }
    *a = all;
    *b = other;
}

static inline float lane_step_back(float size, float x, int power)
{
    float raised = size, none = 0, sum = 1, lower = 1;
    lane_raise(&raised, &none, power, 0);
    const float root = power == 2 ? sqrtf(raised + x)
                                  : lane_exp2(lane_log2(raised + x > 1e-37f ? raised + x : 1e-37f) /
                                              (float)power);
    for (int i = 1; i < 16; i++) {
        const float next = lower * size;
        lower            = i < power ? next : lower;
        sum              = i < power ? sum * root + next : sum;
    }
    return sum > 0 ? x / sum : 0;
}

#endif

/* Returns the power, or the most iterations, of fractals, if it is the same in all lanes. */
static int LOCAL(same_whole)(const REAL *x, int most)
{
    return x[0] > 0 ? (x[0] < (REAL)most ? (int)x[0] : most) : 0;
}

/* Takes a step of all lanes of z^power + c. */
static void LOCAL(julia_step)(REAL z[4][CELL_LANES], const REAL *const *c, int power)
{
    const REAL *c0 = c[0], *c1 = c[1], *c2 = c[2], *c3 = c[3];
    ALL_LANES
    {
        REAL a = z[0][i], b = 1;
        lane_raise(&a, &b, power, z[1][i] * z[1][i] + z[2][i] * z[2][i] + z[3][i] * z[3][i]);
        z[0][i] = a + c0[i];
        z[1][i] = b * z[1][i] + c1[i];
        z[2][i] = b * z[2][i] + c2[i];
        z[3][i] = b * z[3][i] + c3[i];
    }
}

/* Evaluates what krs_julia of julia.glsl does. */
static void LOCAL(cell_julia)(const REAL *const *x, REAL *to)
{
    _Alignas(64) REAL z[4][CELL_LANES], sizes[MAX_ITERATIONS][CELL_LANES], norm[CELL_LANES],
        last[CELL_LANES];
    _Alignas(64) REAL taken[CELL_LANES];
    const REAL       *settings = x[9], *radius = x[10];
    const int         power = LOCAL(same_whole)(x[7], MAX_POWER),
              most          = LOCAL(same_whole)(x[8], MAX_ITERATIONS);
    int n                   = 0;
    for (int k = 0; k < 3; k++)
        memcpy(z[k], x[k], sizeof z[k]);
    ALL_LANES
    {
        z[3][i]  = 0;
        taken[i] = 0;
        norm[i] = last[i] = z[0][i] * z[0][i] + z[1][i] * z[1][i] + z[2][i] * z[2][i];
    }
    for (bool more = true; n < most && more; n += more) {
        REAL going = 0;
        for (int i = 0; i < CELL_LANES; i++)
            going += taken[i] == (REAL)n && (REAL)n < settings[i] &&
                     norm[i] <= 4 * radius[i] * radius[i];
        more = going > 0;
        if (!more)
            break;
        ALL_LANES
        {
            const REAL on = (taken[i] == (REAL)n ? 1 : 0) * ((REAL)n < settings[i] ? 1 : 0) *
                            (norm[i] <= 4 * radius[i] * radius[i] ? 1 : 0);
            sizes[n][i] = sqrtf(norm[i]);
            taken[i] += on;
        }
        LOCAL(julia_step)(z, x + 3, power);
        ALL_LANES
        {
            norm[i] = z[0][i] * z[0][i] + z[1][i] * z[1][i] + z[2][i] * z[2][i] + z[3][i] * z[3][i];
            last[i] = taken[i] > (REAL)n ? norm[i] : last[i];
        }
    }
    ALL_LANES { to[i] = fabsf(sqrtf(last[i]) - radius[i]); }
    while (n-- > 0)
        ALL_LANES
        {
            const REAL size = sizes[n][i], back = lane_step_back(size, to[i], power);
            const REAL next = back > size - radius[i] ? back : size - radius[i];
            to[i]           = (REAL)n < taken[i] ? next : to[i];
        }
    ALL_LANES { to[i] = last[i] > radius[i] * radius[i] ? to[i] : -to[i]; }
}

/* Evaluates what triplex_step of fractal.c does; the lengths of what the tilt is stretched by go to
   `lateral`. */
static void LOCAL(triplex_step)(REAL w[3][CELL_LANES], const REAL *const *c, int power,
                                REAL *lateral)
{
    const REAL *c0 = c[0], *c1 = c[1], *c2 = c[2];
    ALL_LANES
    {
        const REAL u = w[0][i], v = w[2][i], across = sqrtf(u * u + v * v);
        REAL       tilt = w[1][i], reach = 1;
        REAL       cosine = across > 0 ? v / across : 1, sine = across > 0 ? u / across : 0;
        lane_raise(&tilt, &reach, power, across * across);
        lane_raise(&cosine, &sine, power, 1);
        w[0][i]    = reach * across * sine + c0[i];
        w[1][i]    = tilt + c1[i];
        w[2][i]    = reach * across * cosine + c2[i];
        lateral[i] = reach;
    }
}

/* Evaluates what evaluate_mandelbulb of fractal.c does. */
static void LOCAL(cell_mandelbulb)(const REAL *const *x, REAL *to)
{
    _Alignas(64) REAL w[3][CELL_LANES], size[CELL_LANES], steep[CELL_LANES], sum[CELL_LANES];
    _Alignas(64) REAL lateral[CELL_LANES], last[CELL_LANES], stretch[CELL_LANES], going[CELL_LANES];
    const REAL       *settings = x[5], *radius = x[6], *cx = x[0], *cy = x[1], *cz = x[2];
    const int         power = LOCAL(same_whole)(x[3], MAX_POWER),
              most          = LOCAL(same_whole)(x[4], MAX_ITERATIONS);
    const REAL degree = (REAL)power, core = (REAL)mandelbulb_core(power);
    const REAL least = (REAL)real_pow(4 * degree, -1 / (degree - 1)),
               far   = fminf(16, (REAL)real_exp2(32 / degree));
    for (int k = 0; k < 3; k++)
        memcpy(w[k], x[k], sizeof w[k]);
    ALL_LANES
    {
        size[i] = last[i] = sqrtf(cx[i] * cx[i] + cy[i] * cy[i] + cz[i] * cz[i]);
        steep[i] = stretch[i] = 1;
        sum[i]                = 0;
        going[i]              = 1;
    }
    for (int n = 0; n < most; n++) {
        REAL some = 0;
        ALL_LANES { going[i] *= ((REAL)n < settings[i] ? 1 : 0) * (size[i] <= far ? 1 : 0); }
        for (int i = 0; i < CELL_LANES; i++)
            some += going[i];
        if (!(some > 0))
            break;
        LOCAL(triplex_step)(w, x, power, lateral);
        ALL_LANES
        {
            REAL radial = size[i] > least ? size[i] : least, none = 0;
            lane_raise(&radial, &none, power - 1, 0);
            const REAL even = radial * radial, mean = (2 * even + lateral[i] * lateral[i]) / 3;
            const REAL square = mean > 0.85f * even ? mean : 0.85f * even;
            sum[i] += going[i] > 0 ? steep[i] : 0;
            steep[i]   = degree * sqrtf(square) * steep[i] + 1;
            size[i]    = sqrtf(w[0][i] * w[0][i] + w[1][i] * w[1][i] + w[2][i] * w[2][i]);
            last[i]    = going[i] > 0 ? size[i] : last[i];
            stretch[i] = going[i] > 0 ? steep[i] : stretch[i];
        }
    }
    ALL_LANES
    {
        const REAL start = sqrtf(cx[i] * cx[i] + cy[i] * cy[i] + cz[i] * cz[i]);
        const REAL room = radius[i] - last[i], rim = start - radius[i];
        const REAL max_far = start > core ? start - core : 0;
        const REAL escapes = 0.5f * last[i] * lane_log(last[i] / radius[i]) / stretch[i];
        const REAL outside = escapes < max_far ? escapes : max_far;
        const REAL inside  = -0.5f * room /
                            (stretch[i] + (degree - 1) / (2 * least) * sum[i] * room);
        const REAL distance = room < 0 ? outside : inside;
        const REAL near     = distance > rim ? distance : rim;
        to[i]               = start > (REAL)MANDELBULB_NEAR * radius[i] ? rim : near;
    }
}

/* ---- sectors ---- */

static void LOCAL(cell_polar)(const REAL *const *x, REAL *const *to)
{
    const REAL *px = x[0], *py = x[1], *pz = x[2], *count = x[3];
    REAL       *tx = to[0], *ty = to[1], *tz = to[2];
    ALL_LANES
    {
        const REAL sector = 6.28318530718f / (count[i] >= 1 ? count[i] : 1);
        const REAL angle  = sector * floorf(lane_atan2(pz[i], px[i]) / sector + 0.5f);
        const REAL c = lane_cos(angle), s = lane_sin(angle), u = px[i], v = pz[i];
        tx[i] = count[i] >= 1 ? c * u + s * v : u;
        ty[i] = py[i];
        tz[i] = count[i] >= 1 ? c * v - s * u : v;
    }
}

/* ---- blends that share the result ---- */

/* Puts the lesser of two rows first. */
static inline void LOCAL(put_in_order)(REAL *a, REAL *b)
{
    ALL_LANES
    {
        const REAL low = a[i] < b[i] ? a[i] : b[i], high = a[i] < b[i] ? b[i] : a[i];
        a[i] = low;
        b[i] = high;
    }
}

/* Sorts `count` rows; all but the first then tell how far they are above it, in widths, 1 at most. */
static void LOCAL(cell_heights)(const REAL *const *x, uint32_t count, const REAL *width,
                                REAL rows[8][CELL_LANES])
{
    for (uint32_t k = 0; k < count; k++) {
        memcpy(rows[k], x[k], sizeof rows[k]);
        for (uint32_t j = k; j > 0; j--)
            LOCAL(put_in_order)(rows[j - 1], rows[j]);
    }
    for (uint32_t k = 1; k < count; k++)
        ALL_LANES
        {
            const REAL height = (rows[k][i] - rows[0][i]) / (width[i] > 1e-30f ? width[i] : 1e-30f);
            rows[k][i]        = height < 1 ? height : 1;
        }
}

/* Evaluates what shares_quadratic of blend_shares.c does. */
static void LOCAL(cell_shares)(const REAL *const *x, uint32_t count, bool threshold, REAL *to)
{
    _Alignas(64) REAL rows[8][CELL_LANES], left[CELL_LANES], taken[CELL_LANES];
    const REAL       *width = x[count];
    LOCAL(cell_heights)(x, count, width, rows);
    ALL_LANES
    {
        left[i]  = 1;
        taken[i] = 0;
    }
    for (uint32_t j = 1; j < count; j++) {
        const REAL share = (REAL)j / (REAL)(j + 1), one = 1 / (REAL)(j + 1);
        ALL_LANES
        {
            const REAL above = left[i] - rows[j][i], below = above > 0 ? above : 0;
            taken[i] += share * below * below;
            left[i] -= below * one;
        }
    }
    ALL_LANES
    {
        const REAL by = threshold ? left[i] : -0.5f * taken[i];
        to[i]         = rows[0][i] + (width[i] > 0 ? width[i] * by : 0);
    }
}

static void LOCAL(cell_noise2)(const REAL *x, const REAL *y, REAL *to)
{
    ALL_LANES { to[i] = lane_noise2(x[i], y[i]); }
}

static void LOCAL(cell_noise3)(const REAL *x, const REAL *y, const REAL *z, REAL *to)
{
    ALL_LANES { to[i] = lane_noise3(x[i], y[i], z[i]); }
}

static void LOCAL(cell_push_id)(const REAL *x, const REAL *y, REAL *to)
{
    ALL_LANES { to[i] = lane_push_id(x[i], y[i]); }
}

static void LOCAL(cell_hash_id)(const REAL *x, const REAL *y, REAL *to)
{
    ALL_LANES { to[i] = lane_hash_id(x[i], y[i]); }
}

static void LOCAL(cell_join_id)(const REAL *x, const REAL *y, REAL *to)
{
    ALL_LANES { to[i] = lane_join_id(x[i], y[i]); }
}

static void LOCAL(cell_to_uint)(const REAL *x, REAL *to)
{
    ALL_LANES { to[i] = lane_to_uint(x[i]); }
}

static void LOCAL(cell_id_unit)(const REAL *x, REAL *to)
{
    ALL_LANES { to[i] = lane_id_unit(x[i]); }
}

/* Operations that have a loop, and how it is called. */
#define LANE_LOOPS(LOOP)                                              \
    LOOP(cell_polar, LOCAL(cell_polar)(x, to))                        \
    LOOP(julia, LOCAL(cell_julia)(x, to[0]))                          \
    LOOP(mandelbulb, LOCAL(cell_mandelbulb)(x, to[0]))                \
    LOOP(noise2, LOCAL(cell_noise2)(x[0], x[1], to[0]))               \
    LOOP(noise3, LOCAL(cell_noise3)(x[0], x[1], x[2], to[0]))         \
    LOOP(push_id, LOCAL(cell_push_id)(x[0], x[1], to[0]))             \
    LOOP(hash_id, LOCAL(cell_hash_id)(x[0], x[1], to[0]))             \
    LOOP(join_id, LOCAL(cell_join_id)(x[0], x[1], to[0]))             \
    LOOP(to_uint, LOCAL(cell_to_uint)(x[0], to[0]))                   \
    LOOP(id_unit, LOCAL(cell_id_unit)(x[0], to[0]))                   \
    LOOP(smin4_quadratic, LOCAL(cell_shares)(x, 4, false, to[0]))     \
    LOOP(smin8_quadratic, LOCAL(cell_shares)(x, 8, false, to[0]))     \
    LOOP(threshold4_quadratic, LOCAL(cell_shares)(x, 4, true, to[0])) \
    LOOP(threshold8_quadratic, LOCAL(cell_shares)(x, 8, true, to[0]))

typedef void LOCAL(Loop)(const REAL *const *x, REAL *const *to);
#define LOOP_FUNCTION(op, call) \
    static void LOCAL(loop_##op)(const REAL *const *x, REAL *const *to) { call; }
LANE_LOOPS(LOOP_FUNCTION)
#define LOOP_ROW(op, call) [OP_##op] = LOCAL(loop_##op),
static LOCAL(Loop) *const LOCAL(loops)[OP_COUNT] = {LANE_LOOPS(LOOP_ROW)};
#undef LANE_LOOPS
#undef LOOP_FUNCTION
#undef LOOP_ROW

/* Runs the loop of an operation; false: there is no such loop. */
static bool LOCAL(call_of_lanes)(Op op, const REAL *const *x, REAL *const *to)
{
    LOCAL(Loop) *loop = op < OP_COUNT ? LOCAL(loops)[op] : NULL;
    if (loop)
        loop(x, to);
    return loop != NULL;
}
