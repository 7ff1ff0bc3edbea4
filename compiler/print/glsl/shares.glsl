/*
 * shares.glsl: smooth minima of several numbers that share the result: graph/blend_shares.c in single precision.
 */

// In ascending order.
vec4 krs_sort4(vec4 a)
{
    vec2 low = min(a.xz, a.yw), high = max(a.xz, a.yw);
    float middle = max(low.x, low.y), other = min(high.x, high.y);
    return vec4(min(low.x, low.y), min(middle, other), max(middle, other), max(high.x, high.y));
}

// In ascending order, of numbers that first rise and then fall, or the reverse.
vec4 krs_merge4(vec4 a)
{
    vec2 low = min(a.xy, a.zw), high = max(a.xy, a.zw);
    return vec4(min(low.x, low.y), max(low.x, low.y), min(high.x, high.y), max(high.x, high.y));
}

// How far the components are above the least of all, which is w.
vec4 krs_heights4(vec4 a, float width)
{
    vec4 all = krs_sort4(a);
    return vec4(min(all.yzw - all.x, vec3(width)), all.x);
}

// The threshold above the least, and what is taken from the least, times twice the width.
vec2 krs_share(vec2 threshold, float height, float j)
{
    float below = max(threshold.x - height, 0.0);
    return vec2(threshold.x - below / (j + 1.0), threshold.y + below * below * (j / (j + 1.0)));
}

// The same after three more operands, of which the first is operand j + 1.
vec2 krs_share3(vec2 threshold, vec3 heights, float j)
{
    vec2 next = krs_share(krs_share(threshold, heights.x, j), heights.y, j + 1.0);
    return krs_share(next, heights.z, j + 2.0);
}

float krs_smin4_quadratic(vec4 a, float width)
{
    vec4 heights = krs_heights4(a, max(width, 0.0));
    vec2 threshold = krs_share3(vec2(max(width, 0.0), 0.0), heights.xyz, 1.0);
    return heights.w - threshold.y * (0.5 / max(width, 1e-30));
}

float krs_threshold4_quadratic(vec4 a, float width)
{
    vec4 heights = krs_heights4(a, max(width, 0.0));
    return heights.w + krs_share3(vec2(max(width, 0.0), 0.0), heights.xyz, 1.0).x;
}

// Threshold and what is taken, as krs_share, of eight operands; the last is the least one.
vec3 krs_shares8(vec4 a, vec4 b, float width)
{
    vec4 first = krs_sort4(a), last = krs_sort4(b).wzyx;
    vec4 near = krs_merge4(min(first, last)), more = krs_merge4(max(first, last));
    more = min(more - near.x, vec4(width));
    vec2 threshold = krs_share3(vec2(width, 0.0), min(near.yzw - near.x, vec3(width)), 1.0);
    threshold = krs_share3(krs_share(threshold, more.x, 4.0), more.yzw, 5.0);
    return vec3(threshold, near.x);
}

float krs_smin8_quadratic(vec4 a, vec4 b, float width)
{
    vec3 threshold = krs_shares8(a, b, max(width, 0.0));
    return threshold.z - threshold.y * (0.5 / max(width, 1e-30));
}

float krs_threshold8_quadratic(vec4 a, vec4 b, float width)
{
    vec3 threshold = krs_shares8(a, b, max(width, 0.0));
    return threshold.z + threshold.x;
}

// Cubic shares of what is so many widths below the threshold, and how fast they grow with it.
vec2 krs_share_cubic(vec4 v)
{
    vec4 middle = clamp(v, 0.0, 1.0) - 0.5;
    return vec2(dot(0.5 + 2.0 * middle - 2.0 * middle * abs(middle), vec4(1.0)),
                dot(2.0 - 4.0 * abs(middle), vec4(1.0)));
}

// Their integrals.
float krs_sum_cubic(vec4 v)
{
    vec4 middle = clamp(v, 0.0, 1.0) - 0.5, rest = 0.5 - abs(middle);
    return dot(max(middle, 0.0) + rest * rest * rest / 1.5, vec4(1.0));
}

// The threshold above the least one, in widths, of heights in widths.
float krs_threshold_cubic(vec4 a, vec4 b, float second)
{
    float threshold = 0.5 + 0.5 * min(second, 1.0);
    for (int i = 0; i < 5; i++) {
        vec2 shares = krs_share_cubic(threshold - a) + krs_share_cubic(threshold - b);
        threshold -= (shares.x - 1.0) / max(shares.y, 1e-6);
    }
    return threshold;
}

float krs_least4(vec4 a)
{
    return min(min(a.x, a.y), min(a.z, a.w));
}

// The second least of all.
float krs_second8(vec4 a, vec4 b)
{
    vec4 low = min(a, b), high = max(a, b);
    return min(krs_sort4(low).y, krs_least4(high));
}

float krs_smin8_cubic(vec4 a, vec4 b, float width)
{
    float w = max(width, 1e-30), least = min(krs_least4(a), krs_least4(b));
    vec4 near = min((a - least) / w, vec4(1.0)), more = min((b - least) / w, vec4(1.0));
    float threshold = krs_threshold_cubic(near, more, krs_second8(near, more));
    return least + w * (threshold - 0.5 - krs_sum_cubic(threshold - near) - krs_sum_cubic(threshold - more));
}

float krs_threshold8_cubic(vec4 a, vec4 b, float width)
{
    float w = max(width, 1e-30), least = min(krs_least4(a), krs_least4(b));
    vec4 near = min((a - least) / w, vec4(1.0)), more = min((b - least) / w, vec4(1.0));
    return least + w * krs_threshold_cubic(near, more, krs_second8(near, more));
}

float krs_smin4_cubic(vec4 a, float width)
{
    return krs_smin8_cubic(a, vec4(1e30), width);
}

float krs_threshold4_cubic(vec4 a, float width)
{
    return krs_threshold8_cubic(a, vec4(1e30), width);
}
