/*
 * lane_math.h: functions of numbers in single precision, for loops over lanes.
 *
 * The C library would be called for each number; these become vector instructions.  Formulas and constants are those of
 * shaders (print/glsl), where the reasons are; exponential and logarithm are those of the Cephes library
 * (Moshier 1989).  All are good to a few units in the last place.
 */
#ifndef KRS_LANE_MATH_H
#define KRS_LANE_MATH_H

#include <math.h>
#include <stdint.h>
#include <string.h>

static inline float lane_bits(uint32_t bits)
{
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static inline uint32_t lane_bits_of(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

/* ---- angles ---- */

static inline float lane_sine_small(float r, float turns)
{
    const float z    = r * r;
    const float odd  = turns - 2 * floorf(0.5f * turns);
    float       p    = 2.60831598e-6f * z - 1.98106907e-4f;
    p                = p * z + 8.33307859e-3f;
    p                = p * z - 1.66666597e-1f;
    const float sine = r + r * z * p;
    return odd != 0 ? -sine : sine;
}

static inline float lane_reduced(float a, float n)
{
    float r = a - n * 3.140625f;
    r       = r - n * 9.67025756836e-4f;
    r       = r - n * 6.27832947e-7f;
    return r < -1.6f ? -1.6f : r > 1.6f ? 1.6f : r;
}

static inline float lane_sin(float a)
{
    const float n = floorf(a * 0.318309886184f + 0.5f);
    return lane_sine_small(lane_reduced(a, n), n);
}

static inline float lane_cos(float a)
{
    const float n = floorf(a * 0.318309886184f);
    return lane_sine_small(lane_reduced(a, n + 0.5f), n + 1);
}

static inline float lane_tan(float a) { return lane_sin(a) / lane_cos(a); }

static inline float lane_asin_small(float x)
{
    const float z = x * x;
    float       p = 4.2163199048e-2f * z + 2.4181311049e-2f;
    p             = p * z + 4.5470025998e-2f;
    p             = p * z + 7.4953002686e-2f;
    p             = p * z + 1.6666752422e-1f;
    return x + x * z * p;
}

static inline float lane_asin(float a)
{
    const float x   = fabsf(a);
    const float s   = lane_asin_small(x > 0.5f ? sqrtf(0.5f - 0.5f * x) : x);
    const float all = x > 0.5f ? 1.57079632679f - 2 * s : s;
    return a < 0 ? -all : all;
}

static inline float lane_acos(float a)
{
    const float x    = fabsf(a);
    const float s    = lane_asin_small(x > 0.5f ? sqrtf(0.5f - 0.5f * x) : x);
    const float near = a < 0 ? 3.14159265359f - 2 * s : 2 * s;
    return x > 0.5f ? near : 1.57079632679f - (a < 0 ? -s : s);
}

static inline float lane_atan_unit(float x)
{
    const float y = x > 0.414213562373f ? (x - 1) / (x + 1) : x;
    const float z = y * y;
    float       p = 8.05374449538e-2f * z - 1.38776856032e-1f;
    p             = p * z + 1.99777106478e-1f;
    p             = p * z - 3.33329491539e-1f;
    const float s = y + y * z * p;
    return x > 0.414213562373f ? 0.785398163397f + s : s;
}

static inline float lane_atan(float a)
{
    const float x    = fabsf(a);
    const float s    = lane_atan_unit(x > 1 ? 1 / x : x);
    const float size = x > 1 ? 1.57079632679f - s : s;
    return a < 0 ? -size : size;
}

static inline float lane_atan2(float a, float b)
{
    const float x = fabsf(b), y = fabsf(a), most = x > y ? x : y, least = x > y ? y : x;
    float       s = lane_atan_unit(most > 0 ? least / most : 0);
    s             = y > x ? 1.57079632679f - s : s;
    s             = b < 0 ? 3.14159265359f - s : s;
    return a < 0 ? -s : s;
}

/* ---- powers ---- */

/* Returns x 2^n, by two factors, as either alone may overflow or underflow. */
static inline float lane_scaled(float x, float n)
{
    const int32_t whole = (int32_t)(n == n ? n : 0), half = whole >> 1;
    return x * lane_bits((uint32_t)(half + 127) << 23) *
           lane_bits((uint32_t)(whole - half + 127) << 23);
}

static inline float lane_exp_small(float r)
{
    float p = 1.9875691500e-4f * r + 1.3981999507e-3f;
    p       = p * r + 8.3334519073e-3f;
    p       = p * r + 4.1665795894e-2f;
    p       = p * r + 1.6666665459e-1f;
    p       = p * r + 5.0000001201e-1f;
    return p * r * r + r + 1;
}

static inline float lane_exp(float a)
{
    const float x = a < -104 ? -104 : a > 89 ? 89 : a;
    const float n = floorf(x * 1.44269504f + 0.5f);
    return lane_scaled(lane_exp_small(x - n * 0.693359375f + n * 2.12194440e-4f), n);
}

static inline float lane_exp2(float a)
{
    const float x = a < -150 ? -150 : a > 128 ? 128 : a;
    const float n = floorf(x + 0.5f);
    return lane_scaled(lane_exp_small((x - n) * 0.69314718f), n);
}

/* Returns a number above 0 as the power of 2 in *n times 1 + what is returned, which is from -0.3
   to 0.42. */
static inline float lane_split(float a, float *n)
{
    const float    tiny  = a < 1.17549435e-38f ? 1 : 0;
    const uint32_t bits  = lane_bits_of(tiny != 0 ? a * 33554432.0f : a);
    const float    part  = lane_bits((bits & 0x7fffffu) | 0x3f000000u);
    const float    lower = part < 0.70710678f ? 1 : 0;
    *n                   = (float)((int32_t)(bits >> 23 & 255) - 126) - lower - 25 * tiny;
    return (lower != 0 ? part + part : part) - 1;
}

/* Returns the logarithm of 1 + m, less m. */
static inline float lane_log_rest(float m)
{
    const float z = m * m;
    float       p = 7.0376836292e-2f * m - 1.1514610310e-1f;
    p             = p * m + 1.1676998740e-1f;
    p             = p * m - 1.2420140846e-1f;
    p             = p * m + 1.4249322787e-1f;
    p             = p * m - 1.6668057665e-1f;
    p             = p * m + 2.0000714765e-1f;
    p             = p * m - 2.4999993993e-1f;
    p             = p * m + 3.3333331174e-1f;
    return m * z * p - 0.5f * z;
}

/* Returns the logarithm where a is not above 0, or infinite. */
static inline float lane_log_odd(float a, float log)
{
    const float beyond = a == 0 ? -HUGE_VALF : a > 0 ? a : lane_bits(0x7fc00000u);
    return a > 0 && a <= 3.40282347e38f ? log : beyond;
}

static inline float lane_log(float a)
{
    float       n;
    const float m = lane_split(a, &n);
    return lane_log_odd(a, m + (lane_log_rest(m) - 2.12194440e-4f * n) + 0.693359375f * n);
}

static inline float lane_log2(float a)
{
    float       n;
    const float m = lane_split(a, &n);
    return lane_log_odd(a, (m + lane_log_rest(m)) * 1.44269504f + n);
}

static inline float lane_log1p(float a) { return lane_log(1 + a); }

static inline float lane_pow(float a, float b)
{
    const float size     = lane_exp2(b * lane_log2(fabsf(a)));
    const float half     = 0.5f * b;
    const float odd      = half != floorf(half) ? -size : size;
    const float negative = b != floorf(b) ? lane_bits(0x7fc00000u) : odd;
    const float power    = a == 0 ? (b > 0 ? 0 : HUGE_VALF) : a > 0 ? size : negative;
    return b == 0 ? 1 : power;
}

static inline float lane_sinh(float a)
{
    const float x = fabsf(a), z = a * a, e = lane_exp(x);
    const float far  = 0.5f * e - 0.5f / e;
    float       near = z * 2.75573192e-6f + 1.98412698e-4f;
    near             = near * z + 8.33333333e-3f;
    near             = near * z + 1.66666667e-1f;
    near             = near * z * x + x;
    const float size = x < 1 ? near : far;
    return a < 0 ? -size : size;
}

static inline float lane_cosh(float a)
{
    const float e = lane_exp(fabsf(a));
    return 0.5f * e + 0.5f / e;
}

static inline float lane_tanh(float a)
{
    const float x = fabsf(a), z = a * a, e = lane_exp(2 * (x > 15 ? 15 : x));
    const float far  = 1 - 2 / (e + 1);
    float       near = 2.06390887954e-2f - 5.70498872745e-3f * z;
    near             = near * z - 5.37397155531e-2f;
    near             = near * z + 1.33314422036e-1f;
    near             = near * z - 3.33332819422e-1f;
    near             = near * z * x + x;
    const float size = x < 0.625f ? near : far;
    return a < 0 ? -size : size;
}

static inline float lane_hypot(float a, float b) { return sqrtf(a * a + b * b); }

/* ---- those of op_values.h ---- */

static inline float lane_sign(float a) { return a > 0 ? 1.0f : a < 0 ? -1.0f : 0.0f; }

static inline float lane_unit(float a) { return a > 1 ? 1 : a > -1 ? a : -1; }

static inline float lane_mod(float a, float b) { return a - b * floorf(a / b); }

static inline float lane_smoothstep(float a, float b, float c)
{
    const float x = (c - a) / (b - a), part = x > 1 ? 1 : x > 0 ? x : 0;
    const float t = a == b ? (c < a ? 0.0f : 1.0f) : part;
    return t * t * (3 - 2 * t);
}

static inline float lane_stairs(float a, float b, float k, float n)
{
    const float s = k / (n > 1 ? n : 1), u = b - k, least = a < b ? a : b;
    const float wave = fabsf(lane_mod(u - a + s, 2 * s) - s), step = 0.5f * (u + a + wave);
    return step < least ? step : least;
}

#endif
